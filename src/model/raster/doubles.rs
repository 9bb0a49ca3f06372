//! WGT-1 in doubles, which hold all its numbers exactly: the lane of the fast engine.

use super::weights::Number;

/// Fraction bits of a double that [`Number::cut`] keeps: the first 24 bits, of which one is not stored.
const CUT: u64 = !0 << 29;
const EXPONENT: u64 = 0x7ff << 52;
const BIAS: u64 = 1023;

/// Every number of WGT-1 is a double: products have 48 and 53 bits, and exponents stay within 256 of 0.
#[allow(clippy::float_arithmetic, reason = "no operation rounds, but where the text corrects it")]
impl Number for f64 {
    type Exponent = f64;
    type Choice = bool;

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
        let (sum, unit) = aligned::<24>([first[0] * first[1], number, third[0] * third[1]]);
        sum * unit
    }

    #[inline(always)]
    fn sum_of_products(factors: [[f64; 2]; 3]) -> f64 {
        let (sum, unit) = aligned::<29>(factors.map(|[a, b]| a * b));
        sum * unit
    }

    #[inline(always)]
    fn sum_of_edges(edges: [f64; 3]) -> f64 {
        let (sum, unit) = aligned::<29>(edges);
        (if sum == 0.0 { 1.0 } else { sum }) * unit
    }

    /// The quotient is correct to half of its 53rd bit. That can reach the floor at the 29th only from below, and whether it did is decided by
    /// the exact product: with m the 31 bits of the sum and k the floor, k is too large if (16 k + 3) m > 2^63.
    #[inline(always)]
    fn reciprocal(self) -> f64 {
        const KEPT: u64 = !0 << 24;
        let quotient = (1.0 / self).to_bits();
        let floor = quotient.wrapping_sub(3 << 20) & KEPT;
        let k = (floor >> 24 & 0x0fff_ffff) | 1 << 28;
        let m = (self.to_bits() >> 22 & 0x3fff_ffff) | 1 << 30;
        let above = ((k * m) << 4).wrapping_add(3 * m) >> 63;
        let is_power = quotient << 12 == 0;
        f64::from_bits(if is_power { quotient } else { floor.wrapping_sub(above << 24) })
    }

    #[inline(always)]
    fn rest(a: f64, b: f64) -> f64 {
        let sum = a + b;
        let rest = 1.0 - sum;
        // The parts that both roundings lose. They matter where the rest looks like a number of 24 bits and is nearer to 0 than the exact one.
        let lost = ((1.0 - rest) - sum) - lost_by_sum(a, b);
        let up = (rest.to_bits() & !CUT != 0) | (lost * rest > 0.0);
        f64::from_bits((rest.to_bits() & CUT).wrapping_add(if up { 1 << 29 } else { 0 }))
    }

    /// 1 less the larger weight is exact, or both are so small that the rest rounds up to 1. What the other subtraction loses is exact, too: if the exact
    /// rest is larger, it is no number of 24 bits, which the last bit then says.
    #[inline(always)]
    fn rest_of_weights(a: f64, b: f64) -> f64 {
        let (larger, smaller) = if a > b { (a, b) } else { (b, a) };
        let most = 1.0 - larger;
        let rest = most - smaller;
        let lost = (most - rest) - smaller;
        f64::from_bits((rest.to_bits() | u64::from(lost > 0.0)).wrapping_add(!CUT) & CUT)
    }

    #[inline(always)]
    fn exponent(self) -> f64 {
        f64::from_bits(if self > 0.0 { self.to_bits() & EXPONENT } else { 0 })
    }

    #[inline(always)]
    fn is_above(a: f64, b: f64) -> bool {
        a > b
    }

    #[inline(always)]
    fn or(self, condition: bool, other: f64) -> f64 {
        if condition { self } else { other }
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

/// Returns the [reciprocal](Number::reciprocal) of a number above 0, and whether it may be a last bit too large, which is one in 2^24.
#[allow(clippy::float_arithmetic, reason = "a quotient whose rounding is looked at")]
#[inline(always)]
pub(crate) fn likely_reciprocal(sum: f64) -> (f64, bool) {
    let quotient = (1.0 / sum).to_bits();
    let lowered = quotient.wrapping_sub(3 << 20);
    let is_power = quotient << 12 == 0;
    (f64::from_bits(if is_power { quotient } else { lowered & !0 << 24 }), lowered << 40 == 0)
}

/// Returns the sum of terms, each toward zero in steps of the `BITS`th bit of the largest, and such a step.
#[allow(clippy::float_arithmetic, reason = "powers of two, and sums below 2^32")]
#[inline(always)]
fn aligned<const BITS: i32>(terms: [f64; 3]) -> (f64, f64) {
    let below = BITS as u64 - 1;
    let power = |term: f64| f64::from_bits(term.to_bits() & EXPONENT);
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let top = larger(larger(power(terms[0]), power(terms[1])), power(terms[2])).to_bits();
    // Without any term both are some finite numbers.
    let scale = f64::from_bits(((BIAS + BIAS + below) << 52).wrapping_sub(top));
    let unit = f64::from_bits(top.wrapping_sub(below << 52));
    let sum = (terms[0] * scale).trunc() + (terms[1] * scale).trunc() + (terms[2] * scale).trunc();
    (sum, unit)
}
