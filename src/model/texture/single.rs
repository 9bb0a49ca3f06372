//! Single precision in whole numbers: sums, products and quotients of patterns of binary32, rounded to nearest with ties to even, and aligned sums.
//!
//! All functions but the last give what a machine's binary32 gives, but for the sign of zero and the pattern of a NaN, which nothing depends on. Machines whose
//! floats are not those of the standard run the printed text of these.

use crate::number::Integer;
use crate::raster::binary::Binary;
use crate::raster::weights::cut_sum;
use crate::state::CompareFunction;

/// The pattern of infinity.
const INFINITY: i64 = 0x7f80_0000;
/// The pattern of a NaN.
const NAN: i64 = 0x7fc0_0000;
/// The pattern of the largest finite number.
const LARGEST_FINITE: i64 = INFINITY - 1;
/// The bit of the sign.
const SIGN: i64 = 1 << 31;

/// Number of bits that a quotient has after the point before it is rounded.
const QUOTIENT_BITS: i64 = 44;

fn magnitude<I: Integer>(x: I) -> I {
    x.masked(SIGN - 1)
}

fn is_negative<I: Integer>(x: I) -> I::Choice {
    !x.down(I::new(31)).is_zero()
}

fn is_infinite<I: Integer>(x: I) -> I::Choice {
    magnitude(x).compared(CompareFunction::Equal, I::new(INFINITY))
}

fn is_nan<I: Integer>(x: I) -> I::Choice {
    I::new(INFINITY).is_below(magnitude(x))
}

/// Returns a magnitude with a sign.
fn signed<I: Integer>(magnitude: I, negative: I::Choice) -> I {
    magnitude + I::new(SIGN).or(negative, I::new(0))
}

/// Returns whether a pattern is that of a finite number.
pub fn is_finite<I: Integer>(x: I) -> I::Choice {
    magnitude(x).is_below(I::new(INFINITY))
}

/// Returns a pattern, or the finite number that stands for it: 0 for a NaN, the largest number of its sign for an infinity.
pub fn finite<I: Integer>(x: I) -> I {
    I::new(0).or(is_nan(x), signed(magnitude(x).least(I::new(LARGEST_FINITE)), is_negative(x)))
}

/// Returns the negative of a number.
pub fn negated<I: Integer>(x: I) -> I {
    signed(magnitude(x), !is_negative(x))
}

/// Returns the number nearest to another, whose mantissa has at most 61 bits. Zero is positive, and too large numbers are infinite.
pub fn rounded<I: Integer>(number: Binary<I>) -> I {
    number.mantissa.rounded(number.exponent)
}

/// Returns a b.
pub fn product<I: Integer>(a: I, b: I) -> I {
    let (x, y) = (Binary::from_bits(a), Binary::from_bits(b));
    let finite = rounded(Binary { mantissa: x.mantissa * y.mantissa, exponent: x.exponent + y.exponent });
    let infinite = signed(I::new(INFINITY), is_negative(a) ^ is_negative(b));
    let is_large = is_infinite(a) | is_infinite(b);
    let is_none = is_nan(a) | is_nan(b) | (is_large & (x.mantissa.is_zero() | y.mantissa.is_zero()));
    I::new(NAN).or(is_none, infinite.or(is_large, finite))
}

/// Returns a + b.
pub fn sum<I: Integer>(a: I, b: I) -> I {
    // What lies below 60 bits of the larger number makes the last of them odd, which rounds as the sum does.
    let finite = rounded(Binary::from_bits(a).plus(Binary::from_bits(b), 60));
    let opposite = is_infinite(a) & is_infinite(b) & (is_negative(a) ^ is_negative(b));
    let infinite = a.or(is_infinite(a), b);
    I::new(NAN).or(is_nan(a) | is_nan(b) | opposite, infinite.or(is_infinite(a) | is_infinite(b), finite))
}

/// TSH-4: returns the aligned sum of three numbers, cut to 24 bits.
pub fn aligned_sum<I: Integer>(terms: [I; 3]) -> I {
    // No bit of the sum is below that of the smallest numbers, so that this rounds none.
    let finite = rounded(cut_sum(terms.map(Binary::from_bits)));
    let any = |choices: [I::Choice; 3]| choices[0] | choices[1] | choices[2];
    let above = any(terms.map(|x| is_infinite(x) & !is_negative(x)));
    let below = any(terms.map(|x| is_infinite(x) & is_negative(x)));
    let infinite = signed(I::new(INFINITY), below);
    I::new(NAN).or(any(terms.map(is_nan)) | (above & below), infinite.or(above | below, finite))
}

/// Returns n / d of whole numbers: n with at most 16 bits, d from 1 to 2^30.
pub fn quotient<I: Integer>(n: I, d: I) -> I {
    let above = n.magnitude().up(I::new(QUOTIENT_BITS));
    let floor = above.quotient(d);
    let is_exact = (above - floor * d).is_zero();
    let odd = floor + (I::new(1) - floor.masked(1)).or(!is_exact, I::new(0));
    rounded(Binary { mantissa: odd.negated(n.is_negative()), exponent: I::new(-QUOTIENT_BITS) })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_arithmetic, reason = "compares with floats")]

    use super::*;
    use crate::random::Random;
    use crate::texture::dot::Number as Dot;

    /// Numbers at which rounding, exponents or special values change, and any.
    fn pattern(random: &mut Random) -> u32 {
        let word = random.bits();
        let (sign, any) = ((word as u32) & 1 << 31, (word >> 32) as u32);
        let fraction = match word & 7 {
            0 => 0,
            1 => 0x7f_ffff,
            2 => 1,
            3 => 0x40_0000,
            _ => any & 0x7f_ffff,
        };
        let exponent = match word >> 3 & 7 {
            0 => [0, 1, 2, 23, 24, 103, 104, 126, 127, 128, 149, 150, 230, 253, 254, 255][(any >> 24) as usize & 15],
            1 => any >> 23 & 255,
            _ => 100 + (any >> 25) % 50,
        };
        sign | exponent << 23 | fraction
    }

    /// Zeros of both signs are one number, and all NaN are one.
    fn same(pattern: i64, wanted: f32) -> bool {
        let found = f32::from_bits(pattern as u32);
        (found.is_nan() && wanted.is_nan()) || found == wanted
    }

    #[test]
    fn operations_are_the_machines() {
        let mut random = Random::seeded(1);
        for _ in 0..400_000 {
            let [a, b] = [pattern(&mut random), pattern(&mut random)];
            let ([x, y], [m, n]) = ([a, b].map(f32::from_bits), [a, b].map(i64::from));
            assert!(same(product(m, n), x * y), "{a:08x} * {b:08x}: {:08x}", product(m, n));
            assert!(same(sum(m, n), x + y), "{a:08x} + {b:08x}: {:08x}", sum(m, n));
            assert!(same(sum(m, negated(n)), x - y), "{a:08x} - {b:08x}");
            assert_eq!(is_finite(m), x.is_finite());
            let limited = if x.is_nan() { 0.0 } else { x.clamp(f32::MIN, f32::MAX) };
            assert!(same(finite(m), limited), "{a:08x}");
        }
    }

    /// Sums of numbers that lie near to one another, and products around the smallest and the largest number.
    #[test]
    fn near_sums_and_far_products() {
        let mut random = Random::seeded(2);
        for _ in 0..200_000 {
            let a = pattern(&mut random);
            let shift = random.below(30) as u32;
            let b = (a ^ (random.bits() as u32 & 0x8000_0003)).wrapping_sub(shift << 23);
            let ([x, y], [m, n]) = ([a, b].map(f32::from_bits), [a, b].map(i64::from));
            assert!(same(sum(m, n), x + y), "{a:08x} + {b:08x}: {:08x}", sum(m, n));
            let c = f32::from_bits((127 + random.below(60) as u32) << 23 | a & 0x7f_ffff);
            for (x, y) in [(x, c), (x, 1.0 / c)] {
                let found = product(x.to_bits().into(), y.to_bits().into());
                assert!(same(found, x * y), "{x:e} * {y:e}: {found:08x}");
            }
        }
    }

    /// Sums of three numbers of any sizes, and of such as nearly cancel, are those of doubles.
    #[test]
    fn aligned_sums_are_those_of_doubles() {
        let mut random = Random::seeded(4);
        for round in 0..400_000 {
            let [a, b] = [pattern(&mut random), pattern(&mut random)];
            let near = (a ^ (random.bits() as u32 & 0x8000_0003)).wrapping_sub((random.below(30) as u32) << 23);
            let third = if round % 2 == 0 { near } else { pattern(&mut random) };
            let wanted = <f32 as Dot>::sum([a, b, third].map(f32::from_bits));
            let found = aligned_sum([a, b, third].map(i64::from));
            assert!(same(found, wanted), "{a:08x} + {b:08x} + {third:08x}: {found:08x}, not {wanted:e}");
        }
    }

    /// All bytes and halves over what maps them, and powers of two.
    #[test]
    fn quotients_are_the_machines() {
        let divisors = [1, 127, 255, 32768, 65535, 1 << 29, 1 << 30];
        for n in -65535_i64..=65535 {
            for d in divisors {
                assert!(same(quotient(n, d), n as f32 / d as f32), "{n} / {d}");
            }
        }
    }

    #[test]
    fn interpolated_numbers_round_as_doubles_do() {
        let mut random = Random::seeded(3);
        for _ in 0..200_000 {
            let mantissa = random.bits() as i64 >> (11 + random.below(50));
            let exponent = random.below(300) as i64 - 220;
            let number = Binary { mantissa, exponent };
            assert!(same(rounded(number), number.nearest_f32()), "{number:?}");
        }
    }
}
