//! Generates cube maps that hold directions of unit length, half vectors, or the light of a sky.
//!
//! A texel's direction is the one that passes through its centre (TEX-12). Vectors are stored as in [`normal_map`], colours as
//! 0..255 for 0..1; alpha is 255.
#![allow(clippy::float_arithmetic, reason = "input data: f64, + - * / and roots in a fixed order, rounded")]

use super::normal_map::encode;
use super::sky::HemisphereLight;
use super::*;
use crate::vector::{minus, plus, unit_or_zero};
use ninebit::state::Named;
use ninebit::texture::cube::Face;

/// Permitted sides of a face, in texels.
pub const CUBE_SIDES: std::ops::RangeInclusive<u32> = 1..=1024;

/// What the texels of a cube map hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Content {
    /// The texel's direction.
    Direction,
    /// The texel's direction, with sixteen bits each for x and y: two's complement, where 32768 stands for 1. This is the layout of `R16B16`, and
    /// the mapping `HiloHemisphere` reads it (TSH-3). That mapping takes z for positive.
    Halves,
    /// The unit vector half-way between the direction, which points to the viewer, and the direction to a light.
    Half {
        /// Direction toward the light, of any length but zero.
        light: [f64; 3],
        /// Whether the map is looked up with the direction *from* the viewer instead, as positions in camera space are.
        from_viewer: bool,
    },
    /// The light that falls on a surface whose normal is the texel's direction.
    Sky(HemisphereLight),
}

/// Generates the six faces, in the order in which a cube map stores them. `side` is clamped to [`CUBE_SIDES`].
pub fn faces(side: u32, content: Content) -> Vec<Rgba> {
    let side = side.clamp(*CUBE_SIDES.start(), *CUBE_SIDES.end());
    let face = |face: &Face| {
        let texels = (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
        let pixels = texels.map(|(column, row)| texel(direction(*face, column, row, side), content));
        Rgba { width: side, height: side, pixels: pixels.collect() }
    };
    Face::ALL.iter().map(face).collect()
}

/// Returns the unit direction through the centre of a texel.
fn direction(face: Face, column: u32, row: u32, side: u32) -> Vector {
    let along = |index: u32| (2.0 * f64::from(index) + 1.0 - f64::from(side)) / f64::from(side);
    let mut direction = [0.0; 3];
    for (signed, value) in face.components().into_iter().zip([along(column), along(row), 1.0]) {
        direction[signed.axis] = if signed.negative { -value } else { value };
    }
    unit_or_zero(direction)
}

/// Returns the bytes of a texel with the given unit direction.
fn texel(direction: Vector, content: Content) -> [u8; 4] {
    let [r, g, b] = match content {
        Content::Halves => return halves(direction),
        Content::Direction => encode(direction),
        Content::Half { light, from_viewer } => encode(half(direction, light, from_viewer)),
        Content::Sky(light) => light.at(direction).map(byte),
    };
    [r, g, b, 255]
}

/// Stores x in alpha and red and y in green and blue, the high byte first. The sign of z is lost.
fn halves([x, y, _]: Vector) -> [u8; 4] {
    // All values are in range but 1 itself, where the conversion saturates. The offset turns truncation into a floor.
    let half = |n: f64| (((n * 32768.0 + 32768.5) as u32).min(65535) as u16 ^ 0x8000).to_be_bytes();
    let ([x_high, x_low], [y_high, y_low]) = (half(x), half(y));
    [x_low, y_high, y_low, x_high]
}

/// Returns the unit vector half-way between a direction, toward the viewer or from it, and the direction to a light; zero if they are opposite.
fn half(direction: Vector, light: [f64; 3], from_viewer: bool) -> Vector {
    let combine = if from_viewer { minus } else { plus };
    unit_or_zero(combine(unit_or_zero(light), direction))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::dot;

    #[test]
    fn a_texel_holds_the_direction_that_meets_it() {
        for face in Face::ALL {
            for (column, row) in [(0, 0), (3, 0), (1, 2), (3, 3)] {
                let d = direction(*face, column, row, 4);
                assert!((dot(d, d) - 1.0).abs() < 1e-12);
                assert_eq!(Face::from_direction(d, d.map(f64::abs), 0.0), *face);
                let [s, t, m] = face.components().map(|c| if c.negative { -d[c.axis] } else { d[c.axis] });
                let place = [s, t].map(|c| (c / m + 1.0) / 2.0 * 4.0);
                assert!((place[0] - f64::from(column) - 0.5).abs() < 1e-12, "{place:?}");
                assert!((place[1] - f64::from(row) - 0.5).abs() < 1e-12, "{place:?}");
            }
        }
    }

    #[test]
    fn halves_are_two_s_complement() {
        let of = |x: f64, y: f64| {
            let [r, g, b, a] = halves([x, y, 0.0]);
            [[a, r], [g, b]].map(i16::from_be_bytes)
        };
        assert_eq!(of(0.0, 0.0), [0, 0]);
        assert_eq!(of(0.6, -0.8), [19661, -26214]);
        assert_eq!(of(1.0, -1.0), [32767, -32768]);
        assert_eq!(faces(1, Content::Halves)[4].pixels[0], [0; 4]);
    }

    #[test]
    fn half_vectors_lie_half_way() {
        let light = [0.0, 0.0, 5.0];
        let between = half([1.0, 0.0, 0.0], light, false);
        assert!((between[0] - between[2]).abs() < 1e-12 && between[0] > 0.7);
        assert_eq!(half([-1.0, 0.0, 0.0], light, true), between);
        // The light is behind the viewer's line of sight: nothing lies half-way.
        assert_eq!(half([0.0, 0.0, -1.0], light, false), [0.0; 3]);
    }

    #[test]
    fn the_middle_of_a_face_is_its_axis() {
        let faces = faces(1, Content::Direction);
        let middles: Vec<[u8; 4]> = faces.iter().map(|face| face.pixels[0]).collect();
        assert_eq!(middles[0], [255, 128, 128, 255]);
        assert_eq!(middles[1], [1, 128, 128, 255]);
        assert_eq!(middles[3], [128, 1, 128, 255]);
        assert_eq!(middles[4], [128, 128, 255, 255]);
    }

    #[test]
    fn a_sky_shows_on_the_faces_of_its_cube() {
        use crate::generate::sky::Integral;
        let light = HemisphereLight {
            axis: [0.0, 1.0, 0.0],
            sky: [1.0, 0.5, 0.0],
            ground: [0.0; 3],
            integral: Integral::Exact,
        };
        let faces = faces(1, Content::Sky(light));
        let middles: Vec<[u8; 4]> = faces.iter().map(|face| face.pixels[0]).collect();
        assert_eq!(middles[2], [255, 128, 0, 255]);
        assert_eq!(middles[3], [0, 0, 0, 255]);
        assert_eq!(middles[4], [128, 64, 0, 255]);
    }
}
