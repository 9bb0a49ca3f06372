//! TSH-6 to TSH-9, and the use of the dot unit's results: dependent coordinates and colours, in integers.

use super::{dot, single};
use crate::number::convert::factor;
use crate::number::{Integer, align};
use crate::raster::binary::Binary;
use crate::raster::interpolate;
use crate::state::DependentScale;

/// TSH-7: returns the displacement of one coordinate by blue and green (two's complement) in 128ths of the image: m_b B + m_g G in single precision.
pub fn offset(entries: [f32; 2], blue_green: [u8; 2]) -> f32 {
    dot::moved(entries, blue_green.map(|byte| f32::from(byte as i8)))
}

/// TSH-7: returns a coordinate of an image of `side` texels that is displaced by 128ths of the image, in 2^-`power` texel, limited to `limit`. `offset`
/// is a pattern of binary32, of which NaN counts as 0. The sum is exact before the floor.
pub fn moved<I: Integer>(value: Binary<I>, offset: I, side: I, power: I, limit: I) -> I {
    let offset = Binary::from_bits(single::finite(offset)).scaled(I::new(-7));
    value.floored_sum(offset, side, power, limit)
}

/// TSH-8: returns floor(4096 f) of f = c/255 (R/255 scale + offset), limited to 0..=2^20. A negative c counts as 0.
pub fn luminance<I: Integer>(c: I, red: I, [scale, offset]: [Binary<I>; 2]) -> I {
    let c = c.greatest(I::new(0));
    let term = |factor: I, f: Binary<I>| (factor * f.mantissa, f.exponent + I::new(12));
    // Both products have at most 40 bits, so that the larger is exact. The bits that are floored away of the smaller one cannot reach the next step.
    let ([scaled, moved], exponent) = align([term(c * red, scale), term(c * I::new(255), offset)], 60);
    let product = Binary { mantissa: scaled + moved, exponent };
    let steps = product.far_floored(I::new(1), I::new(0), I::new(1 << 40)).greatest(I::new(0));
    steps.quotient(I::new(255 * 255)).least(I::new(LARGEST_LUMINANCE))
}

/// Limit of 4096ths of a luminance.
const LARGEST_LUMINANCE: i64 = 1 << 20;

/// TSH-8: converts the result of [`luminance`] to a byte by NUM-6, saturated to 255.
pub fn luminance_byte<I: Integer>(v: I) -> I {
    // 4096 and everything above yield 255.
    factor(v.least(I::new(4096)))
}

/// TSH-6: returns floor(256 side v / 255) in 1/256 texel, or with v / 256 under the alternative.
pub fn dependent<I: Integer>(v: I, side: I, scale: DependentScale) -> I {
    let whole = match scale {
        DependentScale::Over255 => 255,
        DependentScale::Over256 => 256,
    };
    (v * side).up(I::new(8)).quotient(I::new(whole))
}

/// Returns a coordinate of the dot unit, a pattern of binary32, on an image in 1/256 texel, floored and limited as in TEX-15. NaN counts as 0.
pub fn coordinate<I: Integer>(bits: I, side: I) -> I {
    interpolate::coordinate(Binary::from_bits(single::finite(bits)), side)
}

/// Like [`coordinate`], in 1/65536 texel for the lod (TEX-11).
pub fn quad_coordinate<I: Integer>(bits: I, side: I) -> I {
    super::coordinates::quad_coordinate(Binary::from_bits(single::finite(bits)), side)
}

/// Returns a vector of the dot unit, patterns of binary32. With a component that is NaN or infinite it is the zero vector (TEX-13).
pub fn finite_vector<I: Integer>(vector: [I; 3]) -> [I; 3] {
    let [x, y, z] = vector.map(single::is_finite);
    vector.map(|bits| bits.or(x & y & z, I::new(0)))
}

/// Returns a [`finite_vector`] as numbers.
pub fn direction(vector: [i64; 3]) -> [Binary; 3] {
    finite_vector(vector).map(Binary::from_bits)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_arithmetic, reason = "numbers to be taken apart")]
    use super::*;
    use crate::number::convert::{shift, split};
    use crate::raster::interpolate::{COORDINATE_LIMIT, FARTHEST, face_coordinate};
    use proptest::prelude::*;

    /// Returns a coordinate that is displaced, in 1/256 texel.
    fn displaced(value: Binary, entries: [f32; 2], blue_green: [u8; 2], side: i64) -> i64 {
        moved(value, offset(entries, blue_green).to_bits().into(), side, 8, COORDINATE_LIMIT)
    }

    /// Returns a coordinate of 1/2 that is displaced, in 1/256 texel.
    fn from_middle(entries: [f32; 2], blue_green: [u8; 2], side: i64) -> i64 {
        displaced(Binary::new(0.5), entries, blue_green, side)
    }

    fn luminance(c: i64, red: i64, state: [f32; 2]) -> i64 {
        super::luminance(c, red, state.map(Binary::new))
    }

    fn bits(f: f32) -> i64 {
        f.to_bits().into()
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
            assert_eq!(v, 4096 * c / 255);
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
            assert_eq!(luminance_byte(v), want);
            assert!(luminance_byte(v) >= last);
            last = luminance_byte(v);
        }
    }

    /// Tests every byte for every side.
    #[test]
    fn dependent_reads() {
        for bits in 0..=12 {
            for v in 0..=255_i64 {
                let side = 1_i64 << bits;
                let [by_255, by_256] =
                    [DependentScale::Over255, DependentScale::Over256].map(|scale| dependent(v, side, scale));
                assert_eq!(by_255, 256 * side * v / 255);
                assert_eq!(by_256, side * v);
            }
        }
    }

    #[test]
    fn float_coordinates() {
        let on = |f: f32, side: i64| coordinate(bits(f), side);
        assert_eq!((on(0.5, 64), on(-0.5, 64), on(1.5, 1)), (8192, -8192, 384));
        assert_eq!((on(-1e-40, 64), on(1e-40, 64)), (-1, 0));
        let limit = COORDINATE_LIMIT;
        assert_eq!((on(1e9, 64), on(f32::NEG_INFINITY, 64)), (limit, -limit));
        assert_eq!((on(f32::NAN, 64), quad_coordinate(bits(0.25), 4)), (0, 65536));
        assert_eq!(quad_coordinate(bits(f32::MIN), 1), -FARTHEST);
    }

    #[test]
    fn directions() {
        let on = |v: [f32; 3]| direction(v.map(bits)).map(|of| of.mantissa);
        assert_eq!(on([0.0, f32::NAN, 1.0]), [0; 3]);
        assert_eq!(on([f32::INFINITY, -1.0, 0.0]), [0; 3]);
        let [x, y, z] = direction([f32::MAX, -1.0, 0.0].map(bits));
        assert_eq!(z.mantissa, 0);
        // However small, a component below 0 lies left of the middle.
        assert_eq!([face_coordinate(y, x, 4, 8), face_coordinate(y.negated(), x, 4, 8)], [511, 512]);
    }

    proptest! {
        /// Compares with integers: the matrix entries and the luminance are multiples of 2^-10, the coordinate one of 2^-20.
        #[test]
        fn sums_are_floors(m in prop::array::uniform2(-40_000..40_000_i32), b: u8, g: u8, at in -9_000_000..9_000_000_i64, side in 0..=12_u32) {
            let entries = m.map(|m| m as f32 / 1024.0);
            let n = i64::from(m[0]) * i64::from(b as i8) + i64::from(m[1]) * i64::from(g as i8);
            let value = Binary { mantissa: at, exponent: -20 };
            let exact = ((n << 3) + at) << (side + 8) >> 20;
            prop_assert_eq!(displaced(value, entries, [b, g], 1 << side), exact.clamp(-COORDINATE_LIMIT, COORDINATE_LIMIT));
        }

        #[test]
        fn luminances_are_floors(c in 0..=255_i64, r in 0..=255_i64, scale in -9000..9000_i32, offset in -9000..9000_i32) {
            let v = luminance(c, r, [scale as f32 / 1024.0, offset as f32 / 1024.0]);
            let exact = c * 4 * (r * i64::from(scale) + 255 * i64::from(offset));
            prop_assert_eq!(v, exact.div_euclid(255 * 255).clamp(0, 1 << 20));
        }

        /// Terms of any size never panic, and stay within the limits.
        #[test]
        fn any_float_is_safe(m: [f32; 2], b: u8, g: u8, c in -256..=255_i64, f: f32, side in 0..=12_u32) {
            prop_assert!(from_middle(m, [b, g], 1 << side).abs() <= COORDINATE_LIMIT);
            let state = m.map(|m| if m.is_finite() { m } else { 0.0 });
            prop_assert!((0..=1 << 20).contains(&luminance(c, b.into(), state)));
            prop_assert!(coordinate(bits(f), 1 << side).abs() <= COORDINATE_LIMIT);
        }

        /// Terms of any exponents, against wider integers.
        #[test]
        fn luminances_of_any_size(c in 0..=255_i64, r in 0..=255_i64, scale in 0..=u32::MAX, offset in 0..=u32::MAX, apart in -30..30_i32) {
            let scale = f32::from_bits(scale & 0x807f_ffff | 120 << 23);
            let offset = f32::from_bits(offset & 0x807f_ffff | ((120 + apart) as u32) << 23);
            let term = |factor: i64, f: f32| {
                let (mantissa, exponent) = split(f);
                shift(i128::from(factor * mantissa), exponent + 60)
            };
            let exact = (term(c * r, scale) + term(c * 255, offset)).div_euclid(65025 << 48);
            prop_assert_eq!(i128::from(luminance(c, r, [scale, offset])), exact.clamp(0, 1 << 20));
        }

        #[test]
        fn faces_are_exact(s in -1.0..1.0_f32, small in 0..60_i32, n in 0..=12_u32) {
            let s = s * (0.5_f32).powi(small);
            let [across, _, along] = direction([s, 0.0, 1.0].map(bits));
            let (mantissa, exponent) = split(s);
            // floor(128 n (s + 1)) with s = mantissa 2^exponent.
            let side = 1_i128 << n;
            let exact = (side << 7) + shift(i128::from(mantissa) * side, exponent + 7);
            prop_assert_eq!(i128::from(face_coordinate(across, along, 1 << n, 8)), exact);
        }
    }
}
