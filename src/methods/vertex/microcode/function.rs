//! The functions of the scalar unit that have tables of their own: powers of two, logarithms, lighting.
//!
//! INFERRED, and from the source that [`transform`](ninebit::number::transform) names. The numbers in the tables are the chip's.

use super::tables::*;
use ninebit::number::transform::*;

/// Number of bits after the point of a power's exponent.
const POINT: u32 = 13;

/// Returns floor(2^13 x), limited to 32 bits. Numbers below 2^-23 give 0.
fn fixed(x: u32) -> i32 {
    let exponent = exponent(x) - BIAS;
    if is_nan(x) {
        return i32::MAX;
    }
    if exponent >= 18 {
        return if is_negative(x) { i32::MIN } else { i32::MAX };
    }
    if exponent < -23 {
        return 0;
    }
    let magnitude = i64::from(fraction(x) | LEADING);
    let number = if is_negative(x) { -magnitude } else { magnitude };
    (number << 8 >> (23 + 8 - POINT as i32 - exponent)) as i32
}

/// Returns 2^(x / 2^13), by 32 straight lines for the fraction.
fn power_of_two(x: i32) -> u32 {
    let whole = x >> POINT;
    if whole <= -BIAS {
        return 0;
    }
    if whole > BIAS {
        return INFINITY;
    }
    let (line, along) = ((x >> 8 & 31) as usize, (x & 255) as u32);
    let (start, slope) = POWERS[line];
    let fraction = (u32::from(start) << 8) + u32::from(slope) * along;
    ((whole + BIAS) as u32) << 23 | fraction << 1
}

/// EXP: returns (2^floor(x), x - floor(x), 2^x, 1).
pub(super) fn exponential(x: u32) -> [u32; 4] {
    let number = fixed(x);
    let power = if is_nan(x) { NAN } else { power_of_two(number) };
    [power_of_two(number & !((1 << POINT) - 1)), fractional_part(x), power, ONE]
}

/// Returns x - floor(x). A negative number above -2^-23 gives 1.
fn fractional_part(x: u32) -> u32 {
    let power = exponent(x) - BIAS;
    match power {
        _ if is_nan(x) => x,
        _ if is_zero(x) => 0,
        23.. => 0,
        ..0 if !is_negative(x) => x,
        ..-23 => ONE,
        _ => {
            // In units of the last bit of a number in [1, 2), or of the number itself if that is larger.
            let top = power.max(0);
            let mantissa = fraction(x) | LEADING;
            let magnitude = if power < 0 { mantissa.div_ceil(1 << -power) } else { mantissa };
            let number = if is_negative(x) { magnitude.wrapping_neg() } else { magnitude };
            let fraction = number & ((1 << (23 - top)) - 1);
            let up = fraction.leading_zeros() as i32 - 8;
            finite(0, BIAS + top - up, fraction << up)
        }
    }
}

/// Returns log2 |x| with 26 bits after the point, by 32 straight lines. The exponent field of x is not 0 or 255.
fn logarithm_of_two(x: u32) -> i64 {
    let fraction = fraction(x);
    let (start, slope) = LOGARITHMS[(fraction >> 18) as usize];
    let along = i64::from(fraction >> 10 & 255);
    i64::from(exponent(x) - BIAS) * (1 << 26) + i64::from(start) * 256 + i64::from(slope) * along
}

/// Returns a number with `point` bits after the point, cut.
fn float(number: i64, point: u32) -> u32 {
    if number == 0 {
        return 0;
    }
    let top = number.unsigned_abs().ilog2();
    let mantissa = if top > 23 { number.unsigned_abs() >> (top - 23) } else { number.unsigned_abs() << (23 - top) };
    finite(if number < 0 { SIGN } else { 0 }, BIAS + top as i32 - point as i32, mantissa as u32)
}

/// LOG: returns (the exponent, the mantissa, log2, 1) of |x|.
pub(super) fn logarithm(x: u32) -> [u32; 4] {
    match x & !SIGN {
        nan if is_nan(nan) => [nan, nan, nan, ONE],
        zero if is_zero(zero) => [SIGN | INFINITY, ONE, SIGN | INFINITY, ONE],
        INFINITY => [INFINITY, ONE, INFINITY, ONE],
        x => [float(i64::from(exponent(x) - BIAS), 0), ONE | fraction(x), float(logarithm_of_two(x), 26), ONE],
    }
}

/// LIT: returns (1, max(x, 0), y^w, 1), where the power is 0 if x is not positive and w is limited to 127.9999.
pub(super) fn lighting([x, y, _, w]: [u32; 4]) -> [u32; 4] {
    if is_negative(x) {
        return [ONE, 0, 0, ONE];
    }
    let power = match (y, w) {
        _ if is_zero(x) => 0,
        _ if is_zero(w) => ONE,
        _ if is_nan(y) || is_nan(w) => NAN,
        _ if is_negative(y) || is_zero(y) => {
            if is_negative(w) {
                INFINITY
            } else {
                0
            }
        }
        _ if is_infinite(y) => {
            if is_negative(w) {
                0
            } else {
                INFINITY
            }
        }
        _ => {
            let limit = 128 << POINT;
            let product = logarithm_of_two(y) * i64::from(fixed(w).clamp(-limit, limit - 1));
            match i32::try_from(product >> 26) {
                Ok(exponent) => power_of_two(exponent),
                Err(_) => {
                    if product < 0 {
                        0
                    } else {
                        INFINITY
                    }
                }
            }
        }
    };
    [ONE, x, power, ONE]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_arithmetic, reason = "compares with floats")]

    use super::*;
    use crate::vertex::random::Random;

    fn real(x: u32) -> f64 {
        f64::from(f32::from_bits(x))
    }

    /// Lines have eleven bits.
    #[test]
    fn powers_and_logarithms() {
        let mut random = Random::new(1);
        for _ in 0..100_000 {
            let x = random.number(115, 133);
            let [whole, fraction, power, one] = exponential(x);
            let number = real(x);
            assert_eq!((real(whole), one), (number.floor().exp2(), ONE));
            assert!((real(fraction) - (number - number.floor())).abs() < 2.0_f64.powi(-23), "{number}");
            assert!((real(power) / number.exp2() - 1.0).abs() < 2.0_f64.powi(-11), "{number}");
            let y = random.number(1, 255);
            let [exponent, mantissa, logarithm, _] = logarithm(y);
            assert_eq!(real(mantissa) * real(exponent).exp2(), real(y).abs());
            assert!((real(logarithm) - real(y).abs().log2()).abs() < 2.0_f64.powi(-11), "{y:08x}");
        }
        let infinite = |x: f32| exponential(x.to_bits())[2];
        assert_eq!(
            [infinite(128.0), infinite(-127.0), infinite(f32::NAN), infinite(f32::NEG_INFINITY)],
            [INFINITY, 0, NAN, 0]
        );
    }

    /// Nothing that is computed is a denormal, or a NaN that is not the one.
    #[test]
    fn any_pattern() {
        let mut random = Random::new(2);
        for _ in 0..100_000 {
            let x: [u32; 4] = random.words();
            let ([floor, _, power, _], lit) = (exponential(x[0]), lighting(x)[2]);
            for result in [floor, power, lit] {
                assert!(result & !SIGN == 0 || !is_zero(result) && (result == NAN || !is_nan(result)), "{result:08x}");
            }
            if !is_nan(x[0]) {
                assert!(logarithm(x[0]).into_iter().all(|result| result == 0 || !is_zero(result) && !is_nan(result)));
            }
        }
    }
}
