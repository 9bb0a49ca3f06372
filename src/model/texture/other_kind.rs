//! TEX-20: coordinates of a stage for one kind of image on an image of another.

use super::planned::PlannedUnit;
use super::single;
use crate::number::Integer;
use crate::raster::binary::Binary;
use crate::raster::interpolate::{COORDINATE_LIMIT, face_coordinate};
use crate::state::TextureKind;

/// Where the zero vector reads a two-dimensional image: u and v in 1/256 texel.
pub const ZERO_VECTOR: [i64; 2] = [-COORDINATE_LIMIT, COORDINATE_LIMIT];

/// Returns 128 n (1 + s), floored, of floor(256 n s), and likewise for other powers: a coordinate on a face of n texels.
#[inline]
pub fn on_face<I: Integer>(coordinate: I, side: I, power: i64) -> I {
    coordinate.down(I::new(1)) + side.up(I::new(power - 1))
}

/// Returns floor(2^`power` n s / m) of the coordinate of a [face](face_coordinate) of 2 n texels: one on a two-dimensional image of n texels.
#[inline]
pub fn on_plane<I: Integer>(of_face: I, side: I, power: i64) -> I {
    of_face - side.up(I::new(power))
}

/// Returns u and v of a direction, of which sc, tc and |ma| are given, in 2^-`power` texel.
pub(crate) fn of_direction(
    unit: &PlannedUnit,
    [s, t, m]: [Binary; 3],
    [width, height]: [i64; 2],
    power: i64,
) -> [i64; 2] {
    if unit.kind == TextureKind::Cube {
        return [face_coordinate(s, m, width, power), face_coordinate(t, m, height, power)];
    }
    if m.mantissa <= 0 {
        return ZERO_VECTOR;
    }
    let of = |s: Binary, side: i64| on_plane(face_coordinate(s, m, 2 * side, power), side, power);
    [of(s, width), of(t.negated(), height)]
}

/// Returns the end of face +X, 0 or its side in 2^-`power` texel, that a dot product chooses along an axis. It is a pattern of binary32.
#[inline]
pub fn end_of_face<I: Integer>(axis: usize, dot: I, side: I, power: i64) -> I {
    let (zero, dot) = (I::new(0), Binary::from_bits(single::finite(dot)).mantissa);
    let is_last = if axis == 0 { dot.is_below(zero) } else { zero.is_below(dot) };
    side.up(I::new(power)).or(is_last, zero)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_arithmetic, reason = "compares with floats")]
    use super::*;
    use crate::raster::interpolate::ratio;

    /// Of numbers that sums and quotients of doubles are exact for.
    #[test]
    fn coordinates_by_their_formulas() {
        let unit = |kind| crate::texture::planned::PlannedUnit { kind, ..crate::texture::planned::tests::unit() };
        let (plane, cube) = (unit(TextureKind::TwoDimensional), unit(TextureKind::Cube));
        for n in 0..4096 {
            let [s, t, m] = [n % 16 - 8, n / 16 % 16 - 8, 1 << (n / 256 % 5)].map(|n: i32| f64::from(n) / 8.0);
            let numbers = [s, t, m].map(|n| Binary::new(n as f32));
            let floor = |n: f64| n.floor() as i64;
            let wanted = [floor(256.0 * 8.0 * s / m), floor(-256.0 * 32.0 * t / m)];
            assert_eq!(of_direction(&plane, numbers, [8, 32], 8), wanted, "{s} {t} {m}");
            let wanted = [floor(1024.0 * (1.0 + s / m)), floor(1024.0 * (1.0 + t / m))];
            assert_eq!(of_direction(&cube, numbers, [8, 8], 8), wanted, "{s} {t} {m}");
            let [s, t, q] = numbers;
            assert_eq!([s, t].map(|s| on_face(ratio(s, q, 8), 8, 8)), wanted);
        }
        assert_eq!(of_direction(&plane, [Binary::new(0.0); 3], [8, 8], 8), [-1 << 24, 1 << 24]);
    }

    #[test]
    fn ends_by_signs() {
        let of = |axis: usize, dot: f32| end_of_face(axis, i64::from(dot.to_bits()), 4, 8);
        assert_eq!(
            [-1e-30, -0.0, 0.0, 7.0, f32::NAN, f32::NEG_INFINITY].map(|dot| of(0, dot)),
            [1024, 0, 0, 0, 0, 1024]
        );
        assert_eq!([-1e-30, -0.0, 0.0, 7.0, f32::NAN, f32::INFINITY].map(|dot| of(1, dot)), [0, 0, 0, 1024, 0, 1024]);
    }
}
