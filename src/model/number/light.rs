//! Words of the light unit: single-precision numbers with 14 significant bits, whose products and sums truncate (FOG-1,
//! FOG-3, VTX-6).
//!
//! A word is the bit pattern of a binary32 number whose lowest ten bits are 0. There are no denormals, and the only NaN
//! is `NAN`. The unit has a part for vectors of three numbers, and one for single numbers, which keeps no guard bits in sums. Both
//! multiply and add in one step.

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

/// VTX-6: returns total + a b in the part for vectors: the sum of a word and of a product that is not cut before.
pub fn add_product(total: u32, a: u32, b: u32) -> u32 {
    if is_zero(a) || is_zero(b) || [total, a, b].into_iter().any(|x| exponent(x) == 255) {
        return sum([total, product(a, b)]);
    }
    let product = mantissa(a) * mantissa(b);
    let last = exponent(a) + exponent(b) - 127 - FRACTION_BITS as i32;
    // The product of the mantissas has one or two bits before the point.
    let leading = last + product.ilog2() as i32 - FRACTION_BITS as i32;
    let terms = [(total, mantissa(total), exponent(total)), (a ^ b, product, last)];
    aligned_sum(terms, exponent(total).max(leading) - GUARD_BITS as i32)
}

/// VTX-6: returns x b + c in the part for single numbers. The first factor, not the product, is cut at the last bit of c where c is larger.
pub fn multiply_add(x: u32, b: u32, c: u32) -> u32 {
    let field = exponent(x) + exponent(b) - 127;
    if is_zero(x) || is_zero(b) || [exponent(x), exponent(b), exponent(c), field].into_iter().any(|field| field >= 255)
    {
        return single_sum(single_product(x, b), c);
    }
    let largest = field.max(exponent(c));
    let [first, third] = [(x, field), (c, exponent(c))].map(|(x, field)| mantissa(x) >> (largest - field).min(31));
    let last = largest - FRACTION_BITS as i32;
    aligned_sum([(x ^ b, first * mantissa(b), last), (c, third, largest)], last)
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
    let largest = terms.iter().map(|term| exponent(*term)).fold(0, i32::max);
    aligned_sum(terms.map(|term| (term, mantissa(term), exponent(term))), largest - guard as i32)
}

/// Returns the sum of numbers, each cut to a multiple of the last bit, which is added exactly and then truncated. A number
/// has the sign of a word, a magnitude, and the exponent field of a word whose last bit has the weight of the magnitude's.
fn aligned_sum<const N: usize>(terms: [(u32, u32, i32); N], last: i32) -> u32 {
    let sum: i32 = terms
        .into_iter()
        .map(|(sign, magnitude, exponent)| {
            let down = last - exponent;
            let cut = if down > 0 { magnitude >> down.min(31) } else { magnitude << -down };
            if sign & SIGN == 0 { cut as i32 } else { -(cut as i32) }
        })
        .sum();
    finite(u32::from(sum < 0) << 31, sum.unsigned_abs(), last)
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

/// Returns the 14 bits of the mantissa, including the leading one; 0 of zero.
fn mantissa(word: u32) -> u32 {
    if is_zero(word) { 0 } else { word >> 10 & ((1 << FRACTION_BITS) - 1) | 1 << FRACTION_BITS }
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
    fn products_in_sums() {
        let two = ONE + (1 << 23);
        // As captured frames have them; cut products give 3d9e0000 and 3ec07400.
        assert_eq!(multiply_add(0x3f7f_3c00, 0xc046_4000, 0x404a_9800), 0x3d9e_5c00);
        let (x, b, c) = (0x3f77_9c00, 0xc020_7400, 0x4033_3c00);
        assert_eq!(multiply_add(b, x, c), 0x3ec0_7000);
        // 2 (1 - 2^-14) - 3: beside 3 the first factor loses its last bit, the second does not.
        let (below, three) = (0x3f7f_fc00, 0xc040_0000);
        assert_eq!([multiply_add(below, two, three), multiply_add(two, below, three)], [0xbf80_0800, 0xbf80_0400]);
        for x in [below, two, three, 0x3f8a_8800, 0] {
            assert_eq!(
                [multiply_add(x, ONE, three), multiply_add(three, x, 0)],
                [single_sum(x, three), product(three, x)]
            );
            assert_eq!(
                [multiply_add(x, 0, three), add_product(three, 0, x), add_product(0, x, three)],
                [three, three, product(x, three)]
            );
        }
        // (1 - 2^-7) (1 - 2^-8) keeps its 2^-15 beside 1, which the product as a word lacks; (1 - 2^-9) (1 - 2^-10) loses its 2^-19.
        let (minus, a, b) = (ONE | SIGN, 0x3f7e_0000, 0x3f7f_0000);
        assert_eq!([add_product(minus, a, b), sum([minus, product(a, b)])], [0xbc3f_8000, 0xbc40_0000]);
        assert_eq!(add_product(minus, 0x3f7f_8000, 0x3f7f_c000), 0xbb40_0000);
        assert_eq!([multiply_add(INFINITY, ONE, ONE), add_product(ONE, NAN, ONE)], [INFINITY, NAN]);
        let large = LARGEST_FINITE;
        assert_eq!([multiply_add(large, two, ONE), multiply_add(large, ONE, large)], [INFINITY, large]);
        assert_eq!([multiply_add(0x0080_0000, 0x3f00_0000, 0), add_product(0, 0x0080_0000, 0x3f00_0000)], [0; 2]);
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
