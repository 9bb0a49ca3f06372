//! The ideal of the texture shader: its stages in real numbers.
#![allow(clippy::float_arithmetic, reason = "the real-number reference; it never feeds a stored byte")]

use super::coordinates::{Real, real_direction};
use super::cube::Face;
use super::dot::Vector;
use crate::state::{DotMapping, TextureKind};

/// A colour as the ideal reads it, in bytes and in halves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RealColor {
    /// R, G, B, A in steps of a byte, 0 to 256.
    pub bytes: [f64; 4],
    /// A R and G B as one number each, 0 to 65536.
    pub halves: [f64; 2],
}

impl RealColor {
    /// Returns the colour of these bytes.
    pub(crate) fn from_bytes(bytes: [f64; 4]) -> RealColor {
        let [r, g, b, a] = bytes;
        RealColor { bytes, halves: [256.0 * a + r, 256.0 * g + b] }
    }

    /// Returns the colour that registers hold in steps of 1/255. Channels that are `doubled` hold a signed byte s as
    /// s/128 (TEX-18). If the unit filters halves (`wide`), the registers of the high bytes hold whole halves.
    pub(crate) fn of_registers(registers: [f64; 4], doubled: [bool; 4], wide: bool) -> RealColor {
        let part = |n: usize, signed: f64, unsigned: f64| {
            let value = registers[n] / 255.0 * if doubled[n] { signed } else { unsigned };
            if value < 0.0 { value + 2.0 * signed } else { value }
        };
        let mut color = RealColor::from_bytes([0, 1, 2, 3].map(|n| part(n, 128.0, 255.0)));
        if wide {
            color.halves = [3, 1].map(|n| part(n, 32768.0, 65535.0));
        }
        color
    }

    /// Returns a byte as two's complement.
    pub(crate) fn signed(&self, channel: usize) -> f64 {
        let byte = self.bytes[channel];
        if byte < 128.0 { byte } else { byte - 256.0 }
    }

    /// TSH-1 to TSH-3: returns the vector that the colour is mapped to.
    pub(crate) fn remap(&self, mapping: DotMapping) -> Vector<f64> {
        let each = |of: &dyn Fn(usize) -> f64| [of(0), of(1), of(2)];
        match mapping {
            DotMapping::ZeroToOne => each(&|n| self.bytes[n] / 255.0),
            DotMapping::MinusOneToOneD3d => each(&|n| (self.bytes[n] - 128.0) / 127.0),
            DotMapping::MinusOneToOneGl => each(&|n| (2.0 * self.signed(n) + 1.0) / 255.0),
            DotMapping::MinusOneToOne => each(&|n| self.signed(n) / 127.0),
            DotMapping::Hilo1 => [self.halves[0] / 65535.0, self.halves[1] / 65535.0, 1.0],
            DotMapping::HiloHemisphere => {
                let [x, y] = self.halves.map(|half| (if half < 32768.0 { half } else { half - 65536.0 }) / 32768.0);
                [x, y, (1.0 - x * x - y * y).max(0.0).sqrt()]
            }
        }
    }
}

/// TSH-7: returns the displacement of s and t by blue and green.
pub(crate) fn offset([m0, m1, m2, m3]: [f32; 4], color: &RealColor) -> [f64; 2] {
    let (blue, green) = (color.signed(2), color.signed(1));
    [[m0, m3], [m1, m2]].map(|[b, g]| (f64::from(b) * blue + f64::from(g) * green) / 128.0)
}

/// TSH-8: returns the factor of the colour for a red in steps of a byte. It is not negative.
pub(crate) fn luminance(red: f64, [scale, offset]: [f32; 2]) -> f64 {
    (red / 255.0 * f64::from(scale) + f64::from(offset)).max(0.0)
}

/// Returns the red that stands for the same factor under [`luminance`] where a renderer takes it as a signed byte over 127, halved and moved to
/// 0 to 1.
pub(crate) fn signed_luminance(red: f64) -> f64 {
    255.0 * if red < 128.0 { red / 254.0 } else { (red - 2.0) / 254.0 }
}

/// TSH-9: returns a coordinate as a channel in 255ths.
pub(crate) fn pass_through(coordinate: f64) -> f64 {
    255.0 * coordinate.clamp(0.0, 1.0)
}

/// Where the ideal samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RealTarget {
    /// s and t, where 1.0 spans the whole image, or texels of a rectangle.
    Coordinates([f64; 2]),
    /// A direction of any length.
    Vector([f64; 3]),
}

impl RealTarget {
    /// Returns displaced coordinates.
    pub(crate) fn moved(st: [f64; 2], by: [f64; 2]) -> RealTarget {
        RealTarget::Coordinates([st[0] + by[0], st[1] + by[1]])
    }

    /// Returns the coordinates of two bytes, where `whole` is 1.0.
    pub(crate) fn bytes(st: [f64; 2], whole: f64) -> RealTarget {
        RealTarget::Coordinates(st.map(|byte| byte / whole))
    }

    /// TEX-20: returns the ends of face +X that two dot products choose.
    pub(crate) fn ends([first, second]: [f64; 2]) -> RealTarget {
        RealTarget::Coordinates([first < 0.0, second > 0.0].map(|is_last| f64::from(u8::from(is_last))))
    }

    /// Returns the coordinates on an image of a kind, of a direction on the given face or, without one, on its own. A vector with a
    /// component that is not finite counts as the zero vector.
    pub(crate) fn real(&self, kind: TextureKind, face: Option<Face>) -> Real {
        match *self {
            RealTarget::Coordinates(st) => Real { face: Face::PositiveX, st },
            RealTarget::Vector(v) if v.iter().any(|c| !c.is_finite()) => real_direction(kind, [0.0; 3], face),
            RealTarget::Vector(v) => real_direction(kind, v, face),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Named;
    use crate::texture::dot;

    /// Compares every byte and every half with the definition's fractions.
    #[test]
    fn remaps_are_the_definitions() {
        for half in 0..=65535_u16 {
            let [high, low] = half.to_be_bytes();
            let bytes = [low, 0x12, 0x34, high];
            for mapping in DotMapping::ALL {
                let real = RealColor::from_bytes(bytes.map(f64::from)).remap(*mapping);
                for (n, (fixed, real)) in dot::remap(*mapping, bytes).into_iter().zip(real).enumerate() {
                    let root = *mapping == DotMapping::HiloHemisphere && n == 2;
                    let allowed = if root { 1.3 / f64::from(1 << 14) } else { 1.0 / f64::from(1 << 24) };
                    let error = (f64::from(fixed) - real).abs();
                    assert!(error <= allowed, "{mapping:?} {half}: {error}");
                }
            }
        }
    }

    #[test]
    fn offsets_luminance_and_vectors() {
        let color = RealColor::from_bytes([51.0, 192.0, 64.0, 0.0]);
        assert_eq!(offset([1.0, 0.0, 0.5, -1.0], &color), [1.0, -0.25]);
        assert_eq!((luminance(51.0, [2.0, 0.5]), luminance(51.0, [-9.0, 0.5])), (0.9, 0.0));
        let vector = RealTarget::Vector([f64::NAN, 1.0, 2.0]);
        assert_eq!(vector.real(TextureKind::Cube, None).face, Face::PositiveX);
    }
}
