//! WGT-1 in doubles, which hold all its numbers exactly: the lane of the fast engine.

use super::weights::Number;
use crate::number::Choice;
use std::ops::{BitAnd, BitOr, BitXor, Not};

/// Fraction bits of a double that [`Number::cut`] keeps: the first 24 bits, of which one is not stored.
const CUT: u64 = !0 << 29;
const EXPONENT: u64 = 0x7ff << 52;
const BIAS: u64 = 1023;

/// A truth as 64 bits, all of them 1 or 0: of these compilers make choices in vectors of the same width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mask(u64);

impl Choice for Mask {}

impl From<bool> for Mask {
    #[inline(always)]
    fn from(truth: bool) -> Mask {
        Mask(u64::from(truth).wrapping_neg())
    }
}

impl From<Mask> for bool {
    fn from(mask: Mask) -> bool {
        mask.0 != 0
    }
}

/// Defines operators on masks.
macro_rules! mask_operators {
    ($($operator:ident::$function:ident)*) => {
        $(impl $operator for Mask {
            type Output = Mask;

            #[inline(always)]
            fn $function(self, other: Mask) -> Mask {
                Mask($operator::$function(self.0, other.0))
            }
        })*
    };
}
mask_operators!(BitAnd::bitand BitOr::bitor BitXor::bitxor);

impl Not for Mask {
    type Output = Mask;

    #[inline(always)]
    fn not(self) -> Mask {
        Mask(!self.0)
    }
}

/// Every number of WGT-1 is a double: products have 48 and 53 bits, and exponents stay within 256 of 0.
#[allow(clippy::float_arithmetic, reason = "no operation rounds, but where the text corrects it")]
impl Number for f64 {
    type Exponent = f64;
    type Choice = Mask;

    #[inline(always)]
    fn one() -> f64 {
        1.0
    }

    #[inline(always)]
    fn from_edge(edge: i64) -> f64 {
        edge as f64
    }

    #[inline(always)]
    fn from_f32(number: f32) -> f64 {
        number.into()
    }

    #[inline(always)]
    fn cut(self) -> f64 {
        f64::from_bits(self.to_bits() & CUT)
    }

    #[inline(always)]
    fn product<const BITS: u32>(self, other: f64) -> f64 {
        (self * other).cut()
    }

    #[inline(always)]
    fn linear(number: f64, [first, third]: [[f64; 2]; 2]) -> f64 {
        let terms = [first[0] * first[1], number, third[0] * third[1]];
        let (sum, unit) = aligned::<24>(terms, terms.map(f64::abs));
        sum * unit
    }

    #[inline(always)]
    fn sum_of_products(factors: [[f64; 2]; 3]) -> f64 {
        let terms = factors.map(|[a, b]| a * b);
        let (sum, unit) = aligned::<29>(terms, terms.map(f64::abs));
        sum * unit
    }

    #[inline(always)]
    fn sum_of_edges<const COVERED: bool>(edges: [f64; 3]) -> f64 {
        let (sum, unit) = aligned::<29>(edges, if COVERED { edges } else { edges.map(f64::abs) });
        (if !COVERED && sum == 0.0 { 1.0 } else { sum }) * unit
    }

    /// No product has more than 48 bits.
    #[inline(always)]
    fn reciprocal<const COVERED: bool>(self) -> f64 {
        const ONE: u64 = BIAS << 52;
        /// Half a unit of the 15th fraction bit.
        const HALF: f64 = 1.0 / 65536.0;
        /// 1.5 2^16: beside it binary32 keeps seven bits of fraction.
        const SEVEN_BITS: f32 = 98_304.0;
        /// 2 in units of 2^-30.
        const TWO: f64 = (1_u64 << 31) as f64;
        let bits = self.to_bits();
        let fraction = bits & !(!0 << 52);
        // Quotients in units of 2^-7 are at least 2^-10 from a half: binary32 suffices, and takes less time.
        let middle = f64::from_bits(fraction & !0 << 45 | 1 << 44 | ONE) as f32;
        let first = f64::from((1.0 / middle + SEVEN_BITS) - SEVEN_BITS);
        let near = f64::from_bits(fraction & !0 << 38 | ONE);
        // At least 1/2, so that 14 bits of fraction are left.
        let second = f64::from_bits(((2.0 - first * near) * first + HALF).to_bits() & !0 << 38);
        // m in units of 2^-30, and the third in units of 2^-29.
        let m = f64::from_bits(fraction | (BIAS + 30) << 52);
        let third = ((TWO - second * m).trunc() * (0.5 * second)).trunc();
        let scale = ((2 * BIAS - 29) << 52).wrapping_sub(bits & EXPONENT) | if COVERED { 0 } else { bits & 1 << 63 };
        f64::from_bits(scale) * third
    }

    /// Covered: a dominant weight is at least 1/3. What both differences lose is exact, and together it is less than the last of 53 bits, unless the exact
    /// rest needs more than 24. So rounding up is right where the rest has more than 24 bits, too; if it has 24, the exact one may be larger.
    #[inline(always)]
    fn rest<const COVERED: bool>(a: f64, b: f64) -> f64 {
        if COVERED {
            let most = 1.0 - a;
            let rest = most - b;
            let lost = ((1.0 - most) - a) + ((most - rest) - b);
            return f64::from_bits(rest.to_bits().wrapping_add(!CUT + u64::from(lost > 0.0)) & CUT);
        }
        let sum = a + b;
        let rest = 1.0 - sum;
        // The parts that both roundings lose. They matter where the rest looks like a number of 24 bits and is nearer to 0 than the exact one.
        let lost = ((1.0 - rest) - sum) - lost_by_sum(a, b);
        let up = (rest.to_bits() & !CUT != 0) | (lost * rest > 0.0);
        f64::from_bits((rest.to_bits() & CUT).wrapping_add(if up { 1 << 29 } else { 0 }))
    }

    #[inline(always)]
    fn exponent<const COVERED: bool>(self) -> f64 {
        f64::from_bits(if COVERED || self > 0.0 { self.to_bits() & EXPONENT } else { 0 })
    }

    #[inline(always)]
    fn is_above(a: f64, b: f64) -> Mask {
        Mask::from(a > b)
    }

    #[inline(always)]
    fn or(self, Mask(condition): Mask, other: f64) -> f64 {
        f64::from_bits(self.to_bits() & condition | other.to_bits() & !condition)
    }
}

/// Returns what the sum of two doubles loses by rounding, exactly.
#[allow(clippy::float_arithmetic, reason = "the error of a sum is a double")]
#[inline(always)]
pub(crate) fn lost_by_sum(a: f64, b: f64) -> f64 {
    let sum = a + b;
    let part = sum - a;
    (a - (sum - part)) + (b - part)
}

/// Returns the sum of terms, each toward zero in steps of the `BITS`th bit of the largest magnitude, and such a step.
#[allow(clippy::float_arithmetic, reason = "powers of two, and sums below 2^32")]
#[inline(always)]
fn aligned<const BITS: i32>(terms: [f64; 3], magnitudes: [f64; 3]) -> (f64, f64) {
    let below = BITS as u64 - 1;
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let top = larger(larger(magnitudes[0], magnitudes[1]), magnitudes[2]).to_bits() & EXPONENT;
    // Without any term both are some finite numbers.
    let scale = f64::from_bits(((BIAS + BIAS + below) << 52).wrapping_sub(top));
    let unit = f64::from_bits(top.wrapping_sub(below << 52));
    let sum = (terms[0] * scale).trunc() + (terms[1] * scale).trunc() + (terms[2] * scale).trunc();
    (sum, unit)
}
