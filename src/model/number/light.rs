//! Words of the light unit: single-precision numbers with 14 significant bits, whose products and sums truncate (FOG-1,
//! FOG-3, VTX-6).
//!
//! A word is the bit pattern of a binary32 number whose lowest ten bits are 0. There are no denormals, and the only NaN
//! is `NAN`. The unit has a part for vectors of three numbers, and one for single numbers, which keeps no guard bits in sums.

use super::transform::middle;
pub use super::transform::{INFINITY, ONE, SIGN};

/// The word of a NaN.
pub const NAN: u32 = 0x7fff_fc00;

/// The word of the largest finite number.
const LARGEST_FINITE: u32 = 0x7f7f_fc00;

/// The bits of a pattern that are 0 in a word.
const LOW: u32 = 0x3ff;

/// Number of significant bits after the leading one.
const FRACTION_BITS: u32 = 13;

/// Number of bits that a sum keeps of its terms below the last bit of the largest.
const GUARD_BITS: u32 = 5;

/// FOG-1: converts a binary32 pattern to a word. Rounds to nearest, except that it truncates if bits 10 to 17 are all
/// ones. Denormals become 0.
pub fn word(pattern: u32) -> u32 {
    match pattern >> 23 & 255 {
        0 => 0,
        255 if pattern & 0x7f_ffff != 0 => NAN,
        // The carry stops within bits 10 to 17, which are not all ones.
        _ if pattern >> 10 & 255 != 255 => (pattern + 0x200) & !LOW,
        _ => pattern & !LOW,
    }
}

/// FOG-3: returns the product of two words, truncated. Too small products become 0, too large ones the largest finite
/// number.
pub fn product(a: u32, b: u32) -> u32 {
    if is_nan(a) || is_nan(b) {
        return NAN;
    }
    if is_zero(a) || is_zero(b) {
        return 0;
    }
    if is_infinite(a) || is_infinite(b) {
        return INFINITY;
    }
    let sign = (a ^ b) & 1 << 31;
    finite(sign, mantissa(a) * mantissa(b), exponent(a) + exponent(b) - 127 - FRACTION_BITS as i32)
}

/// FOG-3: returns the sum of up to three words. Each is cut five bits below the last bit of the largest; the sum is exact and
/// then truncated.
pub fn sum<const N: usize>(terms: [u32; N]) -> u32 {
    const { assert!(N <= 3) };
    guarded_sum(terms, GUARD_BITS)
}

/// VTX-6: returns a . b: the products, each truncated, in one sum.
pub fn dot(a: [u32; 3], b: [u32; 3]) -> u32 {
    sum::<3>(std::array::from_fn(|k| product(a[k], b[k])))
}

/// VTX-6: returns the sum of two words in the part for single numbers, where the smaller one is cut at the last bit of the larger.
pub fn single_sum(a: u32, b: u32) -> u32 {
    guarded_sum([a, b], 0)
}

/// VTX-6: returns the product of two words in the part for single numbers, where too large ones and those with infinity are infinity with the sign.
pub fn single_product(a: u32, b: u32) -> u32 {
    let is_large = is_infinite(a) || is_infinite(b) || exponent(a) + exponent(b) - 127 >= 255;
    if is_large && ![a, b].into_iter().any(|x| is_nan(x) || is_zero(x)) {
        return (a ^ b) & SIGN | INFINITY;
    }
    product(a, b)
}

/// VTX-6: returns 1/x by one step of Newton's method from seven bits; of zero it is infinity. It has 12 bits after the leading one.
pub fn reciprocal(x: u32) -> u32 {
    if is_nan(x) {
        return NAN;
    }
    if is_zero(x) {
        return INFINITY;
    }
    if is_infinite(x) {
        return 0;
    }
    let first = (1 << 14) / middle(x);
    let second = (((1 << 21) - first * mantissa(x)) * first) >> 14;
    finite(x & SIGN, second, 253 - exponent(x) + 1)
}

fn guarded_sum<const N: usize>(terms: [u32; N], guard: u32) -> u32 {
    if terms.iter().any(|term| is_nan(*term)) {
        return NAN;
    }
    if terms.iter().any(|term| is_infinite(*term)) {
        return INFINITY;
    }
    let terms = terms.map(|term| if is_zero(term) { 0 } else { term });
    let largest = terms.iter().map(|term| exponent(*term)).fold(0, i32::max);
    let mut sum = 0_i32;
    for term in terms.into_iter().filter(|term| *term != 0) {
        let down = (largest - exponent(term)).min(31);
        let magnitude = (mantissa(term) << guard >> down) as i32;
        sum += if term >> 31 == 1 { -magnitude } else { magnitude };
    }
    let sign = u32::from(sum < 0) << 31;
    finite(sign, sum.unsigned_abs(), largest - guard as i32)
}

/// Truncates a magnitude to a word. `exponent` is the exponent field of a word whose last bit has the same weight as
/// the last bit of `magnitude`.
fn finite(sign: u32, magnitude: u32, exponent: i32) -> u32 {
    if magnitude == 0 {
        return 0;
    }
    let up = FRACTION_BITS as i32 - magnitude.ilog2() as i32;
    let mantissa = if up >= 0 { magnitude << up } else { magnitude >> -up };
    match exponent - up {
        ..=0 => 0,
        255.. => sign | LARGEST_FINITE,
        field => sign | (field as u32) << 23 | (mantissa & ((1 << FRACTION_BITS) - 1)) << 10,
    }
}

fn exponent(word: u32) -> i32 {
    (word >> 23 & 255) as i32
}

/// Returns the 14 bits of the mantissa, including the leading one.
fn mantissa(word: u32) -> u32 {
    word >> 10 & ((1 << FRACTION_BITS) - 1) | 1 << FRACTION_BITS
}

fn is_zero(word: u32) -> bool {
    exponent(word) == 0
}

fn is_infinite(word: u32) -> bool {
    exponent(word) == 255 && word & 0x7f_ffff == 0
}

fn is_nan(word: u32) -> bool {
    exponent(word) == 255 && word & 0x7f_ffff != 0
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_arithmetic, reason = "compares with floats")]

    use super::*;

    #[test]
    fn conversions_as_captured() {
        assert_eq!(word(0x3fb5_1eb5), 0x3fb5_2000);
        assert_eq!(word(0x3fbf_fffc), 0x3fbf_fc00);
        assert_eq!(word(0xbb13_bb3c), 0xbb13_bc00);
        assert_eq!([word(1), word(0x807f_ffff), word(0x7f80_0000), word(0xff80_0000)], [0, 0, INFINITY, 0xff80_0000]);
        assert_eq!([word(0x7f80_0001), word(0xffff_ffff)], [NAN; 2]);
        assert_eq!(word(0x7f7f_ffff), LARGEST_FINITE);
    }

    /// No word differs from its number by more than one unit of its last place, and words convert to themselves.
    #[test]
    fn words_are_near() {
        for low in 0..1 << 18 {
            let pattern = 0x3f80_0000 | low;
            let near = word(pattern);
            assert_eq!((near & LOW, word(near)), (0, near));
            let off = i64::from(near) - i64::from(pattern);
            let cut = low >> 10 & 255 == 255;
            assert!(if cut { (-0x3ff..=0).contains(&off) } else { (-0x1ff..=0x200).contains(&off) }, "{pattern:#x}");
        }
    }

    #[test]
    fn vertices_as_captured() {
        // c0 = 1.5 and c1 = -0.0022542 at d = 56 and 3.
        let (c0, c1) = (word(0x3fc0_0000), word(0xbb13_bb3c));
        let first = product(c1, word(56.0_f32.to_bits()));
        assert_eq!((first, sum([c0, first, 0])), (0xbe01_4400, 0x3faf_d400));
        let second = product(c1, word(3.0_f32.to_bits()));
        assert_eq!((second, f32::from_bits(sum([c0, second, 0]))), (0xbbdd_9800, 12232.0 / 8192.0));
    }

    /// The seeds are floors: those to nearest would give 1/1.0859375 another bit.
    #[test]
    fn reciprocals_and_single_numbers() {
        let one = ONE;
        assert_eq!([reciprocal(one), reciprocal(one | SIGN)], [0x3f7f_f800, 0xbf7f_f800]);
        assert_eq!([reciprocal(0), reciprocal(NAN), reciprocal(INFINITY)], [INFINITY, NAN, 0]);
        assert_eq!(reciprocal(0x3f8a_8800), 0x3f6c_8000);
        for fraction in 0..1 << FRACTION_BITS {
            let x = one | fraction << 10;
            let error = f64::from(f32::from_bits(reciprocal(x))) * f64::from(f32::from_bits(x)) - 1.0;
            assert!((-1.0 / 1024.0..=0.0).contains(&error), "{x:08x} {error}");
        }
        // 2^-14 lies below the last bit of 1; a vector's sum keeps it, until it is cut.
        let tiny = (127 - 14) << 23;
        assert_eq!([single_sum(one, tiny), single_sum(one, tiny | SIGN)], [one, one]);
        assert_eq!(sum([one, tiny | SIGN]), 0x3f7f_fc00);
        assert_eq!(single_product(LARGEST_FINITE, LARGEST_FINITE | SIGN), INFINITY | SIGN);
        assert_eq!([single_product(0, INFINITY), single_product(one | SIGN, INFINITY)], [0, INFINITY | SIGN]);
        assert_eq!([single_product(NAN, 0), single_sum(NAN, one)], [NAN; 2]);
        assert_eq!(dot([one; 3], [one, one, one | SIGN]), one);
    }

    #[test]
    fn ends_of_the_range() {
        let one = 0x3f80_0000;
        assert_eq!(product(LARGEST_FINITE, LARGEST_FINITE | 1 << 31), LARGEST_FINITE | 1 << 31);
        assert_eq!(product(0x0080_0000, 0x3f00_0000), 0);
        assert_eq!(product(0x0080_0000, one), 0x0080_0000);
        assert_eq!((product(0, INFINITY), product(0, NAN), product(one | 1 << 31, INFINITY)), (0, NAN, INFINITY));
        assert_eq!(sum([LARGEST_FINITE, LARGEST_FINITE, 0]), LARGEST_FINITE);
        assert_eq!(sum([0xff80_0000, one, 0]), INFINITY);
        assert_eq!((sum([INFINITY, NAN, 0]), sum([0, 0x8000_0000, 0])), (NAN, 0));
        assert_eq!(sum([0x0080_0400, 0x8080_0000, 0]), 0);
        assert_eq!(sum([one, one | 1 << 31, 0]), 0);
    }
}
