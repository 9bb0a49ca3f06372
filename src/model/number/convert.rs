//! Conversion of floats: a single-precision number is split into integers once, and no float arithmetic follows.

use super::Integer;

/// Returns (mantissa, exponent) with `f` = mantissa * 2^exponent exactly. `f` must be finite.
#[inline(always)]
pub fn split(f: f32) -> (i64, i32) {
    let bits = f.to_bits();
    let exponent = (bits >> 23 & 255) as i32;
    let mantissa = i64::from(bits & 0x7f_ffff);
    let (mantissa, exponent) = if exponent == 0 { (mantissa, -149) } else { (mantissa | 0x80_0000, exponent - 150) };
    (if bits >> 31 == 1 { -mantissa } else { mantissa }, exponent)
}

/// Returns floor(n * 2^exponent). The result must fit; a shift to the right may have any size.
#[inline]
pub(crate) fn shift(n: i128, exponent: i32) -> i128 {
    if exponent >= 0 { n << exponent.min(126) } else { n >> (-exponent).min(127) }
}

/// Returns floor(n * by * 2^exponent), which must fit. Avoids 128-bit arithmetic where it can.
#[inline(always)]
pub(crate) fn scaled(n: i64, by: i64, exponent: i32) -> i64 {
    match n.checked_mul(by) {
        Some(n) if exponent <= 0 => n >> (-exponent).min(63),
        _ => scaled_in_128_bits(n, by, exponent),
    }
}

/// The rare case of [`scaled`], kept out of line.
#[cold]
fn scaled_in_128_bits(n: i64, by: i64, exponent: i32) -> i64 {
    shift(i128::from(n) * i128::from(by), exponent) as i64
}

/// Like [`align`](super::align), of numbers with exponents in 32 bits.
#[inline(always)]
pub(crate) fn align<const N: usize>(values: [(i64, i32); N], keep: i32) -> ([i64; N], i32) {
    let (aligned, exponent) = super::align(values.map(|(n, exponent)| (n, exponent.into())), keep.into());
    (aligned, exponent as i32)
}

/// NUM-4: converts a channel of a float vertex colour to a byte: clamped to 0..1, truncated to 14 significant bits,
/// floor(255 c + 1/2).
///
/// NaN counts as 0; a valid scene has none.
pub fn vertex_color(c: f32) -> u8 {
    if c.is_nan() || c <= 0.0 {
        return 0;
    }
    if c >= 1.0 {
        return 255;
    }
    let (mantissa, exponent) = split(c);
    // 24 significant bits. Subnormals have fewer, but they are far below half a step anyway.
    let truncated = mantissa & !0x3ff;
    // floor(255 t + 1/2) = floor((510 t + 1) / 2), with t = truncated * 2^exponent.
    let doubled = shift(i128::from(510 * truncated), exponent);
    ((doubled + 1) >> 1) as u8
}

/// NUM-6: converts a factor, given as floor(4096 f) in 0..=4096, to a byte.
#[inline]
pub fn factor_byte(v: i64) -> u8 {
    debug_assert!((0..=4096).contains(&v));
    factor(v as i32) as u8
}

/// Like [`factor_byte`], of any whole number.
#[inline(always)]
pub fn factor<I: Integer>(v: I) -> I {
    (v - v.down(I::new(8))).down(I::new(4)).masked(255)
}

/// NUM-0: converts a float constant to a byte: floor(255 c + 1/2) after clamping to 0..1, computed exactly. NaN counts
/// as 0.
pub fn constant(c: f32) -> u8 {
    if c.is_nan() || c <= 0.0 {
        return 0;
    }
    if c >= 1.0 {
        return 255;
    }
    let (mantissa, exponent) = split(c);
    ((shift(i128::from(510 * mantissa), exponent) + 1) >> 1) as u8
}

/// DEP-1: converts a depth in 0..1 to steps of the buffer's last bit: floor(z (2^bits - 1)), clamped. NaN counts as 0.
#[inline(always)]
pub fn depth(z: f32, bits: u32) -> i64 {
    let full = (1_i64 << bits) - 1;
    if z.is_nan() || z <= 0.0 {
        return 0;
    }
    if z >= 1.0 {
        return full;
    }
    let (mantissa, exponent) = split(z);
    scaled(mantissa, full, exponent)
}

/// RAS-1: converts pixels to 1/16 pixel, truncated toward zero.
pub fn snap(x: f32) -> i64 {
    let (mantissa, exponent) = split(x);
    let n = scaled(mantissa.abs(), 16, exponent);
    if mantissa < 0 { -n } else { n }
}

/// INT-6: cuts w to 16 significant bits, as nv10 does.
pub(crate) fn w_16_bits(w: f32) -> f32 {
    f32::from_bits(w.to_bits() & !0xff)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The narrow path agrees with the computation in 128 bits.
    #[test]
    fn scaled_is_a_shift_of_the_product() {
        let mut random = crate::random::Random::seeded(1);
        for step in 0..2_000 {
            let n = random.bits() as i64;
            let (value, by) = (n >> (12 + step % 50), (n & 0xffff) >> (step % 17));
            for exponent in -130..=2 {
                assert_eq!(scaled(value, by, exponent), shift(i128::from(value) * i128::from(by), exponent) as i64);
            }
        }
    }

    #[test]
    fn block_floating_point_keeps_the_largest() {
        assert_eq!(align([(3, 0), (-1, -2), (0, 500)], 28), ([3 << 26, -(1 << 24), 0], -26));
        assert_eq!(align([((1 << 52) - 1, -300), (-1, -400), (1, -290)], 28).0, [(1 << 28) - 1, -1, 0]);
        assert_eq!(align([(0, 0); 3], 62), ([0; 3], -62));
    }

    #[test]
    fn vertex_colors_as_captured() {
        // Float attributes and the bytes that captured frames show.
        let seen = [
            (0.5, 128),
            (0.1, 25),
            (0.3, 76),
            (0.700_000_05, 178),
            (0.900_000_1, 229),
            (0.65, 166),
            (0.25, 64),
            (0.7, 178),
            (0.6, 153),
            (1.2, 255),
            (-1.0, 0),
        ];
        for (c, byte) in seen {
            assert_eq!(vertex_color(c), byte, "{c}");
        }
    }

    #[test]
    fn constants_round_half_up() {
        for byte in 0..=255_u8 {
            assert_eq!(constant(f32::from(byte) / 255.0), byte);
        }
        assert_eq!((constant(0.5), constant(f32::NAN), constant(7.0)), (128, 0, 255));
    }

    #[test]
    fn factor_bytes_end_at_255() {
        assert_eq!((factor_byte(0), factor_byte(4096), factor_byte(2048)), (0, 255, 127));
        // Captured fog factors of 0.25, 0.5, 0.65, 0.9 and 0.1.
        for (f, byte) in [(0.25_f32, 63), (0.5, 127), (0.65, 165), (0.9, 229), (0.1, 25)] {
            let (m, e) = split(f);
            assert_eq!(factor_byte(shift(i128::from(m), e + 12) as i64), byte, "{f}");
        }
        let mut last = 0;
        for v in 0..=4096 {
            assert!(factor_byte(v) >= last);
            last = factor_byte(v);
        }
    }

    #[test]
    fn snap_truncates_toward_zero() {
        assert_eq!(snap(-162.311_39), -2596);
        assert_eq!(snap(162.311_39), 2596);
        assert_eq!(snap(0.062_4), 0);
        assert_eq!(snap(-0.062_5), -1);
    }

    #[test]
    fn depth_ends() {
        assert_eq!((depth(1.0, 24), depth(0.0, 24), depth(0.5, 16)), (16_777_215, 0, 32_767));
    }

    #[test]
    fn align_keeps_the_bits_of_the_largest() {
        assert_eq!(align([(1, 0), (3, 0), (-5, -1)], 4), ([4, 12, -10], -2));
        assert_eq!(align([(0, 0), (0, 5), (0, 9)], 28).0, [0, 0, 0]);
    }
}
