//! Sixteen numbers of the definition side by side. Every operation is that of the scalar lane on each of them, except
//! that sums are rounded without a division.

use super::{Blend, Factor, Halves, Lane, Quarters, Register, Sum};
use crate::state::RegisterFloor;
use std::ops::{Add, Sub};

/// Number of values in a [`Lanes16`].
pub const LANES: usize = 16;

/// The values of sixteen evaluations that take the same decisions. [`decision`](Lane::decision) and observers use the
/// first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lanes16<T>(pub [T; LANES]);

impl<T: Copy> Lanes16<T> {
    /// Returns sixteen lanes that hold `value`.
    #[inline(always)]
    pub fn all(value: T) -> Lanes16<T> {
        Lanes16([value; LANES])
    }

    // These plain loops compile to vector instructions.
    #[inline(always)]
    fn map<U: Copy>(self, f: impl Fn(T) -> U) -> Lanes16<U> {
        let mut out = [f(self.0[0]); LANES];
        for n in 1..LANES {
            out[n] = f(self.0[n]);
        }
        Lanes16(out)
    }

    #[inline(always)]
    fn zip<V: Copy, U: Copy>(self, other: Lanes16<V>, f: impl Fn(T, V) -> U) -> Lanes16<U> {
        let mut out = [f(self.0[0], other.0[0]); LANES];
        for n in 1..LANES {
            out[n] = f(self.0[n], other.0[n]);
        }
        Lanes16(out)
    }
}

impl<T: Copy + Add<Output = T>> Add for Lanes16<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<T: Copy + Sub<Output = T>> Sub for Lanes16<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Blend for Lanes16<i32> {
    type Weight = Lanes16<i32>;
    const WHOLE: Self = Lanes16([i32::WHOLE; LANES]);
    componentwise! {
        times(weight: Self) -> Self = i32::times;
        round8() -> Self = i32::round8;
    }
}

impl Register for Lanes16<i32> {
    type Factor = Lanes16<Halves>;
    type Expanded = Lanes16<Halves>;
    const ZERO: Self = Lanes16([i32::ZERO; LANES]);
    const ONE: Self = Lanes16([i32::ONE; LANES]);
    const HALF: Self = Lanes16([i32::HALF; LANES]);
    componentwise! {
        max0() -> Self = i32::max0;
        factor() -> Lanes16<Halves> = i32::factor;
        twice() -> Lanes16<Halves> = i32::twice;
        halved() -> Self = i32::halved;
    }
    #[inline(always)]
    fn saturated(self, floor: RegisterFloor) -> Self {
        self.map(|v| v.saturated(floor))
    }
}

impl Factor for Lanes16<Halves> {
    type Sum = Lanes16<Quarters>;
    type Register = Lanes16<i32>;
    #[inline(always)]
    fn product(self, other: Self) -> Lanes16<Quarters> {
        self.zip(other, Halves::product)
    }
}

/// NUM-2 without a division, for quarters of |n| <= 400 000: floor(m / 255) of m = floor((q + 510) / 4).
#[inline(always)]
fn rounded(q: Quarters) -> i32 {
    let m = ((q.0 + 510) >> 2) - 127;
    (m * 257 + (m >> 8) + 32646) >> 16
}

impl Sum for Lanes16<Quarters> {
    type Register = Lanes16<i32>;
    #[inline(always)]
    fn rounded(self) -> Lanes16<i32> {
        self.map(rounded)
    }
}

impl Lane for Lanes16<i32> {
    type Mapped = Lanes16<Halves>;
    type Full = Lanes16<Quarters>;
    const STEP: Self = Lanes16([i32::STEP; LANES]);
    #[inline(always)]
    fn byte(value: u8) -> Self {
        Lanes16::all(i32::byte(value))
    }
    #[inline(always)]
    fn texel(value: i32, numerator: i32, denominator: i32) -> Self {
        Lanes16::all(i32::texel(value, numerator, denominator))
    }
    #[inline(always)]
    fn signed_texel(self) -> Self {
        self.map(i32::signed_texel)
    }
    #[inline(always)]
    fn weight(fixed: i32, ideal: impl FnOnce() -> f64) -> Self {
        Lanes16::all(i32::weight(fixed, ideal))
    }
    #[inline(always)]
    fn value(fixed: i32, ideal: impl FnOnce() -> f64) -> Self {
        Lanes16::all(i32::value(fixed, ideal))
    }
    #[inline(always)]
    fn multiplied(self, fixed: i32, _factor: impl FnOnce() -> f64) -> Self {
        Lanes16::all(fixed)
    }
    #[inline(always)]
    fn mixed(_values: [Self; 3], fixed: i32, _real: impl Fn([f64; 3]) -> f64) -> Self {
        Lanes16::all(fixed)
    }
    #[inline(always)]
    fn halfway(a: Self, b: Self) -> Lanes16<Halves> {
        a.zip(b, i32::halfway)
    }
    #[inline(always)]
    fn negated(factor: Lanes16<Halves>) -> Lanes16<Halves> {
        factor.map(i32::negated)
    }
    #[inline(always)]
    fn widened(self) -> Lanes16<Quarters> {
        self.map(i32::widened)
    }
    #[inline(always)]
    fn rounded_half(sum: Lanes16<Quarters>) -> Self {
        sum.map(i32::rounded_half)
    }
    componentwise! {
        clamped() -> Self = i32::clamped;
        least(other: Self) -> Self = i32::least;
        greatest(other: Self) -> Self = i32::greatest;
    }
    #[inline(always)]
    fn decision(self) -> i32 {
        self.0[0]
    }
    #[inline(always)]
    fn truncated(self, shift: u32) -> Self {
        self.map(|v| v.truncated(shift))
    }
    #[inline(always)]
    fn signed_byte(self) -> Self {
        self.map(i32::signed_byte)
    }
    fn observe(self) -> (i64, Option<f64>) {
        self.0[0].observe()
    }
    fn observe_factor(factor: Lanes16<Halves>) -> (i64, Option<f64>) {
        i32::observe_factor(factor.0[0])
    }
    fn observe_sum(sum: Lanes16<Quarters>) -> (i64, Option<f64>) {
        i32::observe_sum(sum.0[0])
    }
    fn observe_weight(weight: Self) -> (i64, Option<f64>) {
        i32::observe_weight(weight.0[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests whole products and those with half a step, up to the largest that two dot products reach.
    #[test]
    fn rounding_without_a_division_is_exact() {
        for q in -1_600_000..=1_600_000_i32 {
            assert_eq!(rounded(Quarters(q)), Quarters(q).rounded(), "{q}");
        }
    }

    /// Applies every operation that a rule of combiners or blending uses to some numbers, and compares with the scalar
    /// lane.
    #[test]
    fn each_is_the_definition() {
        let numbers: Lanes16<i32> = Lanes16(std::array::from_fn(|n| n as i32 * 37 - 256));
        let others = numbers.map(|v| 99 - v / 2);
        for (n, (a, b)) in numbers.0.into_iter().zip(others.0).enumerate() {
            let product = numbers.factor().product(others.twice());
            let one = a.factor().product(b.twice());
            assert_eq!((product.0[n], product.rounded().0[n]), (one, one.rounded()));
            assert_eq!((product + product - numbers.widened()).0[n], one + one - a.widened());
            assert_eq!(<Lanes16<i32> as Lane>::rounded_half(product).0[n], i32::rounded_half(one));
            assert_eq!((numbers - others).saturated(RegisterFloor::Full).0[n], (a - b).saturated(RegisterFloor::Full));
            assert_eq!(numbers.max0().halved().clamped().0[n], a.max0().halved().clamped());
            assert_eq!((numbers.least(others).0[n], numbers.greatest(others).0[n]), (a.min(b), a.max(b)));
            assert_eq!(<Lanes16<i32> as Lane>::negated(numbers.factor()).0[n], i32::negated(a.factor()));
            assert_eq!(Lane::halfway(numbers, others).0[n], <i32 as Lane>::halfway(a, b));
            assert_eq!(numbers.truncated(3).0[n], a.truncated(3));
            assert_eq!(numbers.signed_byte().0[n], a.signed_byte());
            assert_eq!(numbers.times(others).round8().0[n], a.times(b).round8());
        }
    }
}
