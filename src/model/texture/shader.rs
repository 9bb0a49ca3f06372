//! TSH-6 to TSH-9, and the use of the dot unit's results: dependent coordinates and colours, in integers.

use super::dot;
use crate::number::convert::{align, factor_byte, shift, split};
use crate::raster::binary::Binary;
use crate::raster::interpolate::COORDINATE_LIMIT;
use crate::state::DependentScale;

/// Number of bits that a sum of products keeps. Each product has at most 32, so that the bits that are floored away
/// cannot reach the next step of any result.
const SUM_BITS: i32 = 100;

/// Returns a f + b g as (n, e) for n 2^e.
fn sum_of_products(terms: [(i64, f32); 2]) -> (i128, i32) {
    let terms = terms.map(|(factor, f)| {
        let (mantissa, exponent) = split(f);
        (i128::from(factor) * i128::from(mantissa), exponent)
    });
    let bits = |n: i128| 128 - n.unsigned_abs().leading_zeros() as i32;
    let top = terms.iter().filter(|t| t.0 != 0).map(|t| bits(t.0) + t.1).max().unwrap_or(0);
    let unit = top - SUM_BITS;
    (terms.map(|(n, e)| shift(n, e - unit)).iter().sum(), unit)
}

/// TSH-7: returns the displacement of one coordinate by blue and green (two's complement) in 128ths of the image: m_b B + m_g G in single precision.
pub fn offset(entries: [f32; 2], blue_green: [u8; 2]) -> f32 {
    dot::moved(entries, blue_green.map(|byte| f32::from(byte as i8)))
}

/// TSH-7: returns a coordinate of an image of `side` texels that is displaced by `offset` 128ths of the image, in 2^-`power` texel, limited to `limit`.
/// The sum is exact before the floor. NaN counts as 0.
pub fn moved(value: Binary, offset: f32, side: u32, power: i32, limit: i64) -> i64 {
    let offset = if offset.is_nan() { 0.0 } else { offset.clamp(f32::MIN, f32::MAX) };
    value.floored_sum(Binary::new(offset).scaled(-7), side.into(), power.into(), limit)
}

/// TSH-8: returns floor(4096 f) of f = c/255 (R/255 scale + offset), limited to 0..=2^20. A negative c counts as 0.
pub fn luminance(c: i32, red: u8, [scale, offset]: [f32; 2]) -> i64 {
    let (n, e) = sum_of_products([(i64::from(red), scale), (255, offset)]);
    let limit = 1 << 20;
    let product = (n * i128::from(c.max(0))) << 12;
    let v = if e > 0 { product.signum() * limit } else { shift(product, e).div_euclid(255 * 255) };
    v.clamp(0, limit) as i64
}

/// TSH-8: converts the result of [`luminance`] to a byte by NUM-6, saturated to 255.
pub fn luminance_byte(v: i64) -> u8 {
    // 4096 and everything above yield 255.
    factor_byte(v.min(4096))
}

/// TSH-6: returns floor(256 side v / 255) in 1/256 texel, or with v / 256 under the alternative.
pub fn dependent(v: u8, side: u32, scale: DependentScale) -> i64 {
    let whole = match scale {
        DependentScale::Over255 => 255,
        DependentScale::Over256 => 256,
    };
    ((i64::from(v) * i64::from(side)) << 8) / whole
}

/// Returns floor(2^bits side f), limited to `limit` in magnitude. NaN counts as 0.
pub(crate) fn scaled(f: f32, side: u32, bits: i32, limit: i128) -> i64 {
    if f.is_nan() {
        return 0;
    }
    let (mantissa, exponent) = split(f);
    let n = i128::from(mantissa) * i128::from(side);
    let exponent = exponent + bits;
    let value = if exponent > 64 { n.signum() * limit } else { shift(n, exponent).clamp(-limit, limit) };
    value as i64
}

/// Returns a coordinate of the dot unit on an image in 1/256 texel, floored and limited as in TEX-15. NaN counts as 0.
pub fn coordinate(f: f32, side: u32) -> i64 {
    scaled(f, side, 8, i128::from(COORDINATE_LIMIT))
}

/// Like [`coordinate`], in 1/65536 texel for the lod (TEX-11).
pub(crate) fn quad_coordinate(f: f32, side: u32) -> i64 {
    scaled(f, side, 16, 1 << 62)
}

/// Returns a vector of the dot unit as integers of a common exponent. A vector with a component that is NaN or infinite
/// becomes the zero vector (TEX-13).
///
/// The largest component keeps 62 bits and the others are floored, which changes no texel: only the sign of a component
/// below 2^-38 of the largest matters, and it is kept.
pub(crate) fn direction(vector: [f32; 3]) -> [i64; 3] {
    if vector.iter().any(|c| !c.is_finite()) {
        return [0; 3];
    }
    let (aligned, _) = align(vector.map(split), 62);
    std::array::from_fn(|n| if vector[n] > 0.0 { aligned[n].max(1) } else { aligned[n] })
}

/// TEX-12: returns floor(2^bits size (s + m) / 2m) with the minor component s and the major component m of a
/// [`direction`]. The zero vector yields 0.
pub(crate) fn face_coordinate(s: i64, m: i64, size: u32, bits: u32) -> i64 {
    if m <= 0 {
        return 0;
    }
    let numerator = ((i128::from(s) + i128::from(m)) * i128::from(size)) << (bits - 1);
    numerator.div_euclid(i128::from(m)) as i64
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_arithmetic, reason = "numbers to be taken apart")]
    use super::*;
    use proptest::prelude::*;

    /// Returns a coordinate of 1/2 that is displaced, in 1/256 texel.
    fn from_middle(entries: [f32; 2], blue_green: [u8; 2], side: u32) -> i64 {
        moved(Binary::new(0.5), offset(entries, blue_green), side, 8, COORDINATE_LIMIT)
    }

    #[test]
    fn offsets_by_hand() {
        // B = 64 is one half, and moves by half a texture of 8 texels along u.
        assert_eq!(from_middle([1.0, 0.0], [64, 0], 8), 2048);
        assert_eq!(from_middle([1.0, 0.0], [192, 0], 8), 0);
        assert_eq!(from_middle([0.5, -0.25], [0, 128], 1), 128 + 64);
        // Slightly below a step is one step down, however small.
        assert_eq!(from_middle([-1e-30, 0.0], [1, 0], 1), 127);
        // A sum in single precision: a tiny term is lost beside the other, and 0.3 * 10, which is slightly above 3, is
        // 3.
        assert_eq!(from_middle([-1e-30, 1.0], [1, 1], 1), 128 + 2);
        assert_eq!(from_middle([0.3, 1.0], [10, 125], 1), 128 + 256);
        assert_eq!(from_middle([1e30, 0.0], [1, 0], 1), COORDINATE_LIMIT);
        assert_eq!(from_middle([1e30, 1e30], [1, 255], 1), 128);
        // Infinity, and infinity minus infinity.
        assert_eq!(from_middle([f32::MAX, 0.0], [254, 0], 1), -COORDINATE_LIMIT);
        assert_eq!(from_middle([f32::MAX, f32::MAX], [2, 254], 1), 128);
    }

    #[test]
    fn luminance_by_hand() {
        // R = 255 and scale 1 yield the colour itself.
        for c in 0..=255 {
            let v = luminance(c, 255, [1.0, 0.0]);
            assert_eq!(v, i64::from(4096 * c / 255));
            assert_eq!(v, luminance(c, 0, [7.0, 1.0]));
        }
        assert_eq!(luminance_byte(luminance(200, 255, [4.0, 0.0])), 255);
        assert_eq!((luminance(200, 255, [-1.0, 0.5]), luminance(-20, 255, [1.0, 0.0])), (0, 0));
        assert_eq!((luminance(1, 1, [f32::MAX, 0.0]), luminance(0, 1, [f32::MAX, 1.0])), (1 << 20, 0));
    }

    #[test]
    fn luminance_bytes_end_at_255() {
        let mut last = 0;
        for v in 0..20_000 {
            let want = ((v - (v >> 8)) >> 4).min(255);
            assert_eq!(i64::from(luminance_byte(v)), want);
            assert!(luminance_byte(v) >= last);
            last = luminance_byte(v);
        }
    }

    /// Tests every byte for every side.
    #[test]
    fn dependent_reads() {
        for bits in 0..=12 {
            for v in 0..=255_u8 {
                let side = 1_u32 << bits;
                let [by_255, by_256] =
                    [DependentScale::Over255, DependentScale::Over256].map(|scale| dependent(v, side, scale));
                assert_eq!(by_255, i64::from(256 * side * u32::from(v) / 255));
                assert_eq!(by_256, i64::from(side) * i64::from(v));
            }
        }
    }

    #[test]
    fn float_coordinates() {
        assert_eq!((coordinate(0.5, 64), coordinate(-0.5, 64), coordinate(1.5, 1)), (8192, -8192, 384));
        assert_eq!((coordinate(-1e-40, 64), coordinate(1e-40, 64)), (-1, 0));
        let limit = COORDINATE_LIMIT;
        assert_eq!((coordinate(1e9, 64), coordinate(f32::NEG_INFINITY, 64)), (limit, -limit));
        assert_eq!((coordinate(f32::NAN, 64), quad_coordinate(0.25, 4)), (0, 65536));
    }

    #[test]
    fn directions() {
        let on = |v: [f32; 3]| direction(v);
        assert_eq!(on([0.0, f32::NAN, 1.0]), [0; 3]);
        assert_eq!(on([f32::INFINITY, -1.0, 0.0]), [0; 3]);
        let [x, y, z] = on([f32::MAX, -1.0, 0.0]);
        assert!(x > 0 && y < 0 && z == 0);
        // Faces may use either sign.
        assert_eq!(on([f32::MAX, 1.0, -1.0])[1..], [1, -1]);
        assert_eq!(face_coordinate(y, x, 4, 8), 511);
        assert_eq!(
            (face_coordinate(3, 3, 4, 8), face_coordinate(-3, 3, 4, 8), face_coordinate(0, 0, 4, 8)),
            (1024, 0, 0)
        );
    }

    proptest! {
        /// Compares with integers: the matrix entries and the luminance are multiples of 2^-10, the coordinate one of 2^-20.
        #[test]
        fn sums_are_floors(m in prop::array::uniform2(-40_000..40_000_i32), b: u8, g: u8, at in -9_000_000..9_000_000_i64, side in 0..=12_u32) {
            let entries = m.map(|m| m as f32 / 1024.0);
            let n = i64::from(m[0]) * i64::from(b as i8) + i64::from(m[1]) * i64::from(g as i8);
            let value = Binary { mantissa: at, exponent: -20 };
            let exact = ((n << 3) + at) << (side + 8) >> 20;
            prop_assert_eq!(moved(value, offset(entries, [b, g]), 1 << side, 8, COORDINATE_LIMIT), exact.clamp(-COORDINATE_LIMIT, COORDINATE_LIMIT));
        }

        #[test]
        fn luminances_are_floors(c in 0..=255_i32, r: u8, scale in -9000..9000_i32, offset in -9000..9000_i32) {
            let v = luminance(c, r, [scale as f32 / 1024.0, offset as f32 / 1024.0]);
            let exact = i64::from(c) * 4 * (i64::from(r) * i64::from(scale) + 255 * i64::from(offset));
            prop_assert_eq!(v, exact.div_euclid(255 * 255).clamp(0, 1 << 20));
        }

        /// Terms of any size never panic, and stay within the limits.
        #[test]
        fn any_float_is_safe(m: [f32; 2], b: u8, g: u8, c in -256..=255_i32, vector: [f32; 3], side in 0..=12_u32) {
            prop_assert!(from_middle(m, [b, g], 1 << side).abs() <= COORDINATE_LIMIT);
            prop_assert!((0..=1 << 20).contains(&luminance(c, b, m)));
            for f in vector {
                prop_assert!(coordinate(f, 1 << side).abs() <= COORDINATE_LIMIT);
            }
            let [x, y, z] = direction(vector).map(i64::unsigned_abs);
            let largest = x.max(y).max(z);
            prop_assert!(largest == 0 || (61..=62).contains(&largest.ilog2()));
        }

        /// The 62 bits of a direction yield the texel of the exact quotient.
        #[test]
        fn faces_are_exact(s in -1.0..1.0_f32, small in 0..60_i32, n in 0..=12_u32) {
            let s = s * (0.5_f32).powi(small);
            let m = 1.0_f32;
            let [s_fixed, _, m_fixed] = direction([s, 0.0, m]);
            let (mantissa, exponent) = split(s);
            // floor(128 n (s + 1)) with s = mantissa 2^exponent.
            let side = 1_i128 << n;
            let exact = (side << 7) + shift(i128::from(mantissa) * side, exponent + 7);
            prop_assert_eq!(i128::from(face_coordinate(s_fixed, m_fixed, side as u32, 8)), exact);
        }
    }
}
