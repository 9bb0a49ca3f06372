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

    /// No product has more than 48 bits.
    #[inline(always)]
    fn reciprocal(self) -> f64 {
        const ONE: u64 = BIAS << 52;
        /// Half a unit of the 15th fraction bit.
        const HALF: f64 = 1.0 / 65536.0;
        let bits = self.to_bits();
        let fraction = bits & !(!0 << 52);
        let m = f64::from_bits(fraction | ONE);
        // Quotients of 7 bits and a half, at least 2^-10 from a whole number: binary32 suffices, and takes less time.
        let middle = f64::from_bits(fraction & !0 << 45 | 1 << 44 | ONE) as f32;
        let first = f64::from((128.0 / middle + 0.5).trunc() * (1.0 / 128.0));
        let near = f64::from_bits(fraction & !0 << 38 | ONE);
        // At least 1/2, so that 14 bits of fraction are left.
        let second = f64::from_bits(((2.0 - first * near) * first + HALF).to_bits() & !0 << 38);
        let third = cut_at::<29>(cut_at::<30>(2.0 - second * m) * second);
        let scale = (BIAS << 53).wrapping_sub(bits & EXPONENT) | (bits & 1 << 63);
        f64::from_bits(scale) * third
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

/// Returns a number that is not negative, less what lies below 2^-`BITS`.
#[allow(clippy::float_arithmetic, reason = "powers of two")]
#[inline(always)]
fn cut_at<const BITS: u64>(n: f64) -> f64 {
    let [up, down] = [BIAS + BITS, BIAS - BITS].map(|power| f64::from_bits(power << 52));
    (n * up).trunc() * down
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
