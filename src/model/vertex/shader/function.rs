//! VTX-2: powers and logarithms to base two, which are the same on every machine.
//!
//! They are computed in f64 with + - * / in a fixed order, from series whose relative error is below 2^-50, and are
//! rounded to f32 once. They are at most 0.500001 of a unit in the last place from the exact value.
#![allow(clippy::float_arithmetic, reason = "vertex programs are single precision by rule")]

use std::f64::consts::{LN_2, SQRT_2};

/// Returns 2^x, rounded to single precision.
pub fn exponential(x: f32) -> f32 {
    power_of_two(f64::from(x)) as f32
}

/// Returns log2 |x|, which is minus infinity for zero.
pub fn logarithm(x: f32) -> f32 {
    let (exponent, mantissa) = parts(x);
    (f64::from(exponent) + of_mantissa(mantissa)) as f32
}

/// Returns y^p of a positive y.
pub(crate) fn power(y: f32, p: f32) -> f32 {
    if p == 0.0 {
        return 1.0;
    }
    let (exponent, mantissa) = parts(y);
    power_of_two((f64::from(exponent) + of_mantissa(mantissa)) * f64::from(p)) as f32
}

/// Returns exponent and mantissa of |x|, with 1 <= mantissa < 2. The exponent of infinity is infinity, that of zero is
/// minus infinity; their mantissa is 1.
pub(super) fn parts(x: f32) -> (f32, f32) {
    let x = x.abs();
    if x == 0.0 {
        return (f32::NEG_INFINITY, 1.0);
    }
    if !x.is_finite() {
        return (x, 1.0);
    }
    // Denormal numbers of f32 are normal in f64.
    let bits = f64::from(x).to_bits();
    let exponent = (bits >> 52) as i32 - 1023;
    let mantissa = f64::from_bits(bits & ((1 << 52) - 1) | 1023 << 52);
    (exponent as f32, mantissa as f32)
}

/// Returns 2^x. Values beyond the range of f32 become infinite or 0 when they are rounded.
fn power_of_two(x: f64) -> f64 {
    if x.is_nan() {
        return x;
    }
    let x = x.clamp(-1000.0, 1000.0);
    let whole = (x + 0.5).floor();
    // |y| <= ln 2 / 2, so the terms that are left out are below 2^-56.
    let y = (x - whole) * LN_2;
    let mut sum = 1.0;
    for k in (1..=14).rev() {
        sum = 1.0 + y / f64::from(k) * sum;
    }
    let scale = f64::from_bits(((whole as i64 + 1023) as u64) << 52);
    sum * scale
}

/// Returns log2 of a mantissa from 1 to 2.
fn of_mantissa(mantissa: f32) -> f64 {
    let m = f64::from(mantissa);
    let (m, whole) = if m > SQRT_2 { (m / 2.0, 1.0) } else { (m, 0.0) };
    // ln m = 2 (z + z^3 / 3 + z^5 / 5 ...) with |z| < 0.172, so the terms that are left out are below 2^-55.
    let z = (m - 1.0) / (m + 1.0);
    let square = z * z;
    let mut sum = 0.0;
    for k in (0..=10).rev() {
        sum = 1.0 / f64::from(2 * k + 1) + square * sum;
    }
    whole + 2.0 * z * sum / LN_2
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns the distance from an exact value, in units of the last place of `found`.
    fn off(found: f32, exact: f64) -> f64 {
        let step = f64::from(f32::from_bits(found.abs().to_bits() + 1)) - f64::from(found.abs());
        ((f64::from(found) - exact) / step).abs()
    }

    proptest! {
        #[test]
        fn powers_are_rounded_once(x in -120.0_f32..127.0) {
            prop_assert!(off(exponential(x), f64::from(x).exp2()) < 0.5001, "{x}");
        }

        #[test]
        fn logarithms_are_rounded_once(bits in 1_u32..0x7f80_0000) {
            let x = f32::from_bits(bits);
            prop_assert!(off(logarithm(x), f64::from(x).log2()) < 0.5001, "{x}");
            prop_assert_eq!(logarithm(-x), logarithm(x));
            let (exponent, mantissa) = parts(x);
            prop_assert!((1.0..2.0).contains(&mantissa));
            prop_assert_eq!(f64::from(mantissa) * f64::from(exponent).exp2(), f64::from(x));
        }

        #[test]
        fn powers_of_anything(y in 1e-3_f32..4.0, p in -20.0_f32..20.0) {
            let exact = f64::from(y).powf(f64::from(p));
            prop_assume!((1e-30..1e30).contains(&exact));
            prop_assert!(off(power(y, p), exact) < 0.5001, "{y}^{p}");
        }
    }

    #[test]
    fn whole_powers_are_exact() {
        for k in -149..128 {
            let exact = f64::from(k).exp2() as f32;
            assert_eq!(exponential(k as f32), exact, "{k}");
            assert_eq!(logarithm(exact), k as f32);
        }
        assert_eq!(
            [exponential(128.0), exponential(f32::INFINITY), exponential(-151.0)],
            [f32::INFINITY, f32::INFINITY, 0.0]
        );
        assert_eq!([logarithm(0.0), logarithm(f32::INFINITY)], [f32::NEG_INFINITY, f32::INFINITY]);
        assert!(exponential(f32::NAN).is_nan() && logarithm(f32::NAN).is_nan());
        assert_eq!([power(0.5, 2.0), power(3.0, 0.0), power(1.0, 127.0)], [0.25, 1.0, 1.0]);
    }
}
