//! Numbers of the transform unit: products, sums, comparisons, reciprocals and roots (VTX-5).
//!
//! All functions take and return patterns of binary32, since the unit rounds in its own ways.
//!
//! * A number whose exponent field is 0 counts as zero, and results too small become zero of their sign.
//! * Products and sums are cut, not rounded. Too large ones are the largest finite number.
//! * A product with a zero is +0, whatever the other factor is.
//! * The one NaN that comes out is 0x7fffffff.

/// The pattern of 1.
pub const ONE: u32 = 0x3f80_0000;
/// The pattern of infinity.
pub const INFINITY: u32 = 0x7f80_0000;
/// The pattern of the NaN that comes out of operations.
pub const NAN: u32 = 0x7fff_ffff;
/// The bit of the sign.
pub const SIGN: u32 = 1 << 31;
/// The bit of the mantissa that is not stored.
pub const LEADING: u32 = 1 << 23;
/// The exponent field of 1.
pub const BIAS: i32 = 127;

const LARGEST_FINITE: u32 = 0x7f7f_ffff;

/// Returns the exponent field.
pub fn exponent(x: u32) -> i32 {
    (x >> 23 & 255) as i32
}

/// Returns the stored bits of the mantissa.
pub fn fraction(x: u32) -> u32 {
    x & (LEADING - 1)
}

/// Returns whether a pattern counts as zero.
pub fn is_zero(x: u32) -> bool {
    exponent(x) == 0
}

/// Returns whether a pattern is a NaN.
pub fn is_nan(x: u32) -> bool {
    x & !SIGN > INFINITY
}

/// Returns whether a pattern is an infinity.
pub fn is_infinite(x: u32) -> bool {
    x & !SIGN == INFINITY
}

/// Returns whether the sign of a pattern is set.
pub fn is_negative(x: u32) -> bool {
    x & SIGN != 0
}

/// Returns the number with a mantissa of 24 bits and an exponent field that may lie outside of its range.
pub fn finite(sign: u32, exponent: i32, mantissa: u32) -> u32 {
    match exponent {
        _ if mantissa == 0 => sign,
        ..=0 => sign,
        1..=254 => sign | (exponent as u32) << 23 | mantissa & (LEADING - 1),
        _ => sign | LARGEST_FINITE,
    }
}

/// Returns a b, cut.
pub fn product(a: u32, b: u32) -> u32 {
    if is_zero(a) || is_zero(b) {
        return 0;
    }
    if is_nan(a) || is_nan(b) {
        return NAN;
    }
    let sign = (a ^ b) & SIGN;
    if is_infinite(a) || is_infinite(b) {
        return sign | INFINITY;
    }
    let mantissa = u64::from(fraction(a) | LEADING) * u64::from(fraction(b) | LEADING);
    let carry = (mantissa >> 47) as i32;
    finite(sign, exponent(a) + exponent(b) - BIAS + carry, (mantissa >> (23 + carry)) as u32)
}

/// Returns the sum of up to four numbers, cut. Each is first cut five bits below the last bit of the largest.
pub fn sum<const N: usize>(terms: [u32; N]) -> u32 {
    const { assert!(N <= 4) };
    if terms.into_iter().any(is_nan) {
        return NAN;
    }
    let mut infinite = terms.into_iter().filter(|term| is_infinite(*term));
    if let Some(first) = infinite.next() {
        return if infinite.all(|other| other == first) { first } else { NAN };
    }
    let largest = terms.into_iter().map(exponent).fold(0, i32::max) + 2;
    let total: i32 = terms.into_iter().map(|term| aligned(term, largest)).sum();
    if total == 0 {
        return 0;
    }
    let sign = if total < 0 { SIGN } else { 0 };
    let up = total.unsigned_abs().leading_zeros() as i32 - 1;
    finite(sign, largest - up, total.unsigned_abs() << up >> 7)
}

/// Returns a term in units of 2^-7 of the last bit of a number with the exponent field `top`. A denormal keeps its bits
/// here.
fn aligned(term: u32, top: i32) -> i32 {
    let mantissa = fraction(term) | if is_zero(term) { 0 } else { LEADING };
    let down = top - exponent(term);
    // `down` is at least 2, so that the mantissa has room above it.
    let magnitude = if down < 32 + 7 { (u64::from(mantissa) << 7 >> down) as i32 } else { 0 };
    if is_negative(term) { -magnitude } else { magnitude }
}

/// Returns a key that orders patterns as the unit compares them: -0 is below +0, and NaN beyond infinity.
fn key(x: u32) -> u32 {
    if is_negative(x) { !x } else { x | SIGN }
}

/// Returns whether a is below b.
pub fn is_below(a: u32, b: u32) -> bool {
    key(a) < key(b)
}

/// Returns the largest whole number that is not above x. A zero of either sign gives +0.
pub fn floor(x: u32) -> u32 {
    let shift = BIAS + 23 - exponent(x);
    match x {
        _ if is_zero(x) => 0,
        _ if is_nan(x) => NAN,
        _ if shift <= 0 => x,
        _ if shift > 23 => {
            if is_negative(x) {
                SIGN | ONE
            } else {
                0
            }
        }
        _ if is_negative(x) => {
            let magnitude = (fraction(x) | LEADING).next_multiple_of(1 << shift);
            // A carry doubles the number and leaves no fraction.
            if magnitude > LEADING * 2 - 1 {
                SIGN | ((exponent(x) + 1) as u32) << 23
            } else {
                x & !(LEADING - 1) | magnitude & (LEADING - 1)
            }
        }
        _ => x & !((1 << shift) - 1),
    }
}

/// VTX-5: returns 1/x by two steps of Newton's method from seven bits. Of zero it is infinity.
pub fn reciprocal(x: u32) -> u32 {
    match x {
        _ if is_nan(x) => NAN,
        _ if is_zero(x) => x & SIGN | INFINITY,
        _ => {
            let (exponent, fraction) = reciprocal_parts(x);
            finite(x & SIGN, exponent, LEADING | fraction)
        }
    }
}

/// VTX-5: returns 1/x, whose magnitude is limited to 2^-64 to 2^64.
pub fn limited_reciprocal(x: u32) -> u32 {
    if is_nan(x) {
        return NAN;
    }
    const SMALLEST: i32 = BIAS - 64;
    const LARGEST: i32 = BIAS + 64;
    let (exponent, fraction) = match reciprocal_parts(x) {
        (..SMALLEST, _) => (SMALLEST, 0),
        (LARGEST.., _) => (LARGEST, 0),
        parts => parts,
    };
    x & SIGN | (exponent as u32) << 23 | fraction
}

/// Returns the exponent field, perhaps outside of its range, and the fraction of 1/x.
fn reciprocal_parts(x: u32) -> (i32, u32) {
    let exponent = 2 * BIAS - exponent(x);
    let fraction = fraction(x);
    if fraction == 0 {
        return (exponent, 0);
    }
    let mantissa = u64::from(fraction | LEADING);
    // 2^7 times the reciprocal of the middle, to nearest.
    let middle = middle(x);
    let first = u64::from((2 * (1 << 14) + middle) / (2 * middle));
    let second = (((1 << 31) - first * mantissa) * first) >> 24;
    let third = (((1 << 37) - second * mantissa) * second) >> 25;
    (exponent - 1, third as u32 & (LEADING - 1))
}

/// VTX-5: returns 1/sqrt |x| by two steps of Newton's method from seven bits. Of zero it is infinity.
pub fn reciprocal_root(x: u32) -> u32 {
    if is_nan(x) {
        return NAN;
    }
    if is_zero(x) {
        return INFINITY;
    }
    if is_infinite(x) {
        return 0;
    }
    // The mantissa is in [1, 2) for even powers of two, in [2, 4) for odd ones.
    let odd = exponent(x) & 1 == 0;
    let half = (exponent(x) - BIAS - i32::from(odd)) / 2;
    let mantissa = u64::from(fraction(x) | LEADING) << u32::from(odd);
    let first = u64::from(twice_root_of_middle(x).div_ceil(2).min(127));
    let second = (((3 << 37) - first * first * mantissa) * first) >> 32;
    let third = (((3 << 49) - second * second * mantissa) * second) >> 39;
    finite(0, BIAS - half - 1, third as u32)
}

/// PNT-3, VTX-5: returns floor(2^8 / sqrt m) for the middle m in [1, 4) of all mantissas that share six bits of fraction with x and
/// an exponent that is even or odd with x's.
pub(crate) fn twice_root_of_middle(x: u32) -> u32 {
    let odd = (exponent(x) & 1) ^ 1;
    ((1_u32 << 23 >> odd) / middle(x)).isqrt()
}

/// Returns 2^7 times the middle of all mantissas in [1, 2) that share six bits of fraction with x.
pub(crate) fn middle(x: u32) -> u32 {
    129 + 2 * (fraction(x) >> 17)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_arithmetic, reason = "compares with floats")]

    use super::*;
    use crate::random::Random;

    /// The pattern of a number with an exponent field from `low` to below `high`.
    fn number(random: &mut Random, low: u32, high: u32) -> u32 {
        let word = random.bits();
        let exponent = low + ((word >> 32) as u32) % (high - low);
        word as u32 & 0x807f_ffff | exponent << 23
    }

    fn real(x: u32) -> f64 {
        f64::from(f32::from_bits(if is_zero(x) { 0 } else { x }))
    }

    /// Returns a number cut to 24 significant bits.
    fn cut(x: f64) -> f64 {
        f64::from_bits(x.to_bits() & !((1 << 29) - 1))
    }

    fn bits(x: f32) -> u32 {
        x.to_bits()
    }

    #[test]
    fn products_are_cut() {
        let mut random = Random::seeded(1);
        for _ in 0..100_000 {
            // Normal numbers whose product is normal too.
            let [a, b] = [number(&mut random, 80, 160), number(&mut random, 80, 160)];
            assert_eq!(real(product(a, b)), cut(real(a) * real(b)), "{a:08x} {b:08x}");
        }
    }

    /// Terms of near exponents lose nothing before the sum is cut.
    #[test]
    fn near_sums_are_cut() {
        let mut random = Random::seeded(2);
        for _ in 0..100_000 {
            let a = number(&mut random, 80, 160);
            let b = number(&mut random, exponent(a) as u32 - 4, exponent(a) as u32 + 1);
            assert_eq!(real(sum([a, b])), cut(real(a) + real(b)), "{a:08x} {b:08x}");
            assert_eq!(sum([a, b]), sum([b, a]));
        }
    }

    /// A distant term loses what lies five bits below the last bit of the largest.
    #[test]
    fn sums_are_near() {
        let mut random = Random::seeded(3);
        for _ in 0..100_000 {
            let terms = [(); 4].map(|()| number(&mut random, 110, 140));
            let exact: f64 = terms.iter().map(|term| real(*term)).sum();
            let largest = terms.iter().map(|term| real(*term).abs()).fold(0.0, f64::max);
            let allowed = largest * 2.0_f64.powi(-26) + exact.abs() * 2.0_f64.powi(-22);
            assert!((real(sum(terms)) - exact).abs() <= allowed, "{terms:08x?}");
        }
    }

    /// All mantissas: the last step is never out of range, and is off by at most two units of the last place.
    #[test]
    fn reciprocals_of_all_mantissas() {
        for fraction in 0..LEADING {
            let x = ONE | fraction;
            let error = real(reciprocal(x)) * real(x) - 1.0;
            assert!(error.abs() < 2.0_f64.powi(-22), "{x:08x}");
            assert_eq!(limited_reciprocal(x), reciprocal(x));
        }
    }

    /// All mantissas of even and odd powers of two.
    #[test]
    fn roots_of_all_mantissas() {
        for fraction in 0..2 * LEADING {
            let x = ONE + fraction;
            let error = real(reciprocal_root(x)).powi(2) * real(x) - 1.0;
            assert!(error.abs() < 2.0_f64.powi(-20), "{x:08x}");
        }
        assert_eq!(reciprocal_root(SIGN | 0x4080_0000), 0x3f00_0000 - 1);
    }

    #[test]
    fn reciprocals_keep_within_their_range() {
        let powers = [-126, -100, -64, 0, 63, 64, 65, 127].map(|power| 2.0_f32.powi(power));
        let limited = powers.map(|x| f32::from_bits(limited_reciprocal(x.to_bits())));
        let [small, large] = [2.0_f32.powi(-64), 2.0_f32.powi(64)];
        assert_eq!(limited, [large, large, large, 1.0, 2.0 * small, small, small, small]);
        let free = powers.map(|x| f32::from_bits(reciprocal(x.to_bits())));
        // 2^-127 would be a denormal.
        assert_eq!(free[..7], powers.map(|x| 1.0 / x)[..7]);
        assert_eq!((free[7], reciprocal(INFINITY), reciprocal(SIGN | INFINITY)), (0.0, 0, SIGN));
        assert_eq!([reciprocal(0x7fc0_0000), limited_reciprocal(NAN), reciprocal_root(NAN)], [NAN; 3]);
    }

    #[test]
    fn order_and_floor_are_those_of_numbers() {
        let mut random = Random::seeded(4);
        for _ in 0..100_000 {
            let [a, b] = [number(&mut random, 1, 256), number(&mut random, 1, 256)];
            let [x, y] = [a, b].map(f32::from_bits);
            if !x.is_nan() && !y.is_nan() && x != y {
                assert_eq!(is_below(a, b), x < y, "{x} {y}");
            }
            let z = f32::from_bits(number(&mut random, 100, 160));
            assert_eq!(f32::from_bits(floor(bits(z))), z.floor());
        }
    }

    /// No operation gives a denormal, or a NaN that is not the one.
    #[test]
    fn any_pattern() {
        let mut random = Random::seeded(5);
        for _ in 0..100_000 {
            let terms = [(); 4].map(|()| random.bits() as u32);
            let [a, b, c, _] = terms;
            let functions = [reciprocal(a), limited_reciprocal(a), reciprocal_root(a)];
            for result in
                [product(a, b), sum([a, b]), sum([a, b, c]), sum(terms), floor(a)].into_iter().chain(functions)
            {
                assert!(result & !SIGN == 0 || !is_zero(result) && (result == NAN || !is_nan(result)), "{result:08x}");
            }
        }
    }

    #[test]
    fn special_numbers() {
        let [zero, minus_zero, one, infinity, nan] = [0, SIGN, ONE, INFINITY, 0x7fc0_0000];
        for other in [zero, minus_zero, one, infinity, nan, 1, SIGN | INFINITY] {
            assert_eq!([product(zero, other), product(other, minus_zero), product(other, 5)], [0; 3]);
        }
        assert_eq!(product(SIGN | ONE, infinity), SIGN | INFINITY);
        assert_eq!([product(nan, one), sum([nan, one]), sum([infinity, SIGN | INFINITY])], [NAN; 3]);
        assert_eq!(sum([infinity, one, infinity]), infinity);
        assert_eq!(sum([one, SIGN | ONE]), 0);
        assert_eq!(sum([minus_zero, minus_zero]), 0);
        // Too large is the largest, too small is zero with its sign.
        assert_eq!(product(bits(-1e30), bits(1e30)), SIGN | LARGEST_FINITE);
        assert_eq!(sum([bits(3e38), bits(3e38)]), LARGEST_FINITE);
        assert_eq!(product(bits(-1e-30), bits(1e-30)), SIGN);
        // 1 + 2^-24 - 2^-24 is 1: nothing is rounded up on the way.
        assert_eq!(sum([ONE, bits(2.0_f32.powi(-24)), bits(-(2.0_f32.powi(-24)))]), ONE);
        // 1 - 2^-30: the small term lies below the room of the sum.
        assert_eq!(sum([ONE, bits(-(2.0_f32.powi(-30)))]), ONE);
        assert_eq!(sum([ONE, bits(-(2.0_f32.powi(-28)))]), ONE - 1);
        assert!(is_below(minus_zero, zero) && !is_below(zero, minus_zero) && is_below(infinity, nan));
        assert_eq!([floor(minus_zero), floor(bits(-0.5)), floor(bits(-1e-40)), floor(nan)], [0, SIGN | ONE, 0, NAN]);
        assert_eq!([floor(bits(-1.5)), floor(bits(-7.25)), floor(bits(7.75))], [bits(-2.0), bits(-8.0), bits(7.0)]);
        assert_eq!([floor(infinity), floor(SIGN | INFINITY)], [infinity, SIGN | INFINITY]);
    }
}
