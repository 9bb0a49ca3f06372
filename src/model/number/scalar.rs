//! The definition: plain `i32` arithmetic.

use super::{Blend, Factor, Lane, Register, Sum};
use crate::state::RegisterFloor;
use std::ops::{Add, Sub};

/// A mapped input in halves of a register step. It is even, except under CMB-4=127.5, which keeps the half bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Halves(pub i32);

/// A sum of products of [`Halves`], in quarters of 1/65025. The sum of two dot products stays below 2^23 in magnitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quarters(pub i32);

impl Blend for i32 {
    type Weight = i32;
    const WHOLE: i32 = 256;
    #[inline(always)]
    fn times(self, weight: i32) -> i32 {
        self * weight
    }
    #[inline(always)]
    fn round8(self) -> i32 {
        (self + 128) >> 8
    }
}

impl Register for i32 {
    type Factor = Halves;
    type Expanded = Halves;
    const ZERO: i32 = 0;
    const ONE: i32 = 255;
    const HALF: i32 = 128;
    #[inline(always)]
    fn max0(self) -> i32 {
        self.max(0)
    }
    #[inline(always)]
    fn factor(self) -> Halves {
        Halves(2 * self)
    }
    #[inline(always)]
    fn twice(self) -> Halves {
        Halves(4 * self)
    }
    #[inline(always)]
    fn halved(self) -> i32 {
        (self + 1) >> 1
    }
    #[inline(always)]
    fn saturated(self, floor: RegisterFloor) -> i32 {
        let lowest = match floor {
            RegisterFloor::Full => -256,
            RegisterFloor::Symmetric => -255,
        };
        self.clamp(lowest, 255)
    }
}

impl Factor for Halves {
    type Sum = Quarters;
    type Register = i32;
    #[inline(always)]
    fn product(self, other: Halves) -> Quarters {
        Quarters(self.0 * other.0)
    }
}

wrapped! {
    Quarters: Add, add, |a, b| a + b;
    Quarters: Sub, sub, |a, b| a - b;
}

impl Sum for Quarters {
    type Register = i32;
    /// Returns floor(n/1020 + 1/2), which is floor((2m + 255)/510) for whole products m = n/4.
    #[inline(always)]
    fn rounded(self) -> i32 {
        (self.0 + 510).div_euclid(1020)
    }
}

impl Lane for i32 {
    type Mapped = Halves;
    type Full = Quarters;
    const STEP: i32 = 1;
    #[inline(always)]
    fn byte(value: u8) -> i32 {
        i32::from(value)
    }
    #[inline(always)]
    fn texel(value: i32, _numerator: i32, _denominator: i32) -> i32 {
        value
    }
    #[inline(always)]
    fn signed_texel(self) -> i32 {
        2 * self
    }
    #[inline(always)]
    fn weight(fixed: i32, _ideal: impl FnOnce() -> f64) -> i32 {
        fixed
    }
    #[inline(always)]
    fn value(fixed: i32, _ideal: impl FnOnce() -> f64) -> i32 {
        fixed
    }
    #[inline(always)]
    fn multiplied(self, fixed: i32, _factor: impl FnOnce() -> f64) -> i32 {
        fixed
    }
    #[inline(always)]
    fn mixed(_values: [i32; 3], fixed: i32, _real: impl Fn([f64; 3]) -> f64) -> i32 {
        fixed
    }
    #[inline(always)]
    fn halfway(a: i32, b: i32) -> Halves {
        Halves(a + b)
    }
    #[inline(always)]
    fn negated(factor: Halves) -> Halves {
        Halves((-factor.0).min(2 * 255))
    }
    #[inline(always)]
    fn widened(self) -> Quarters {
        Quarters(self * 1020)
    }
    #[inline(always)]
    fn rounded_half(sum: Quarters) -> i32 {
        (sum.0 + 1020).div_euclid(2040)
    }
    #[inline(always)]
    fn clamped(self) -> i32 {
        self.clamp(0, 255)
    }
    #[inline(always)]
    fn least(self, other: i32) -> i32 {
        self.min(other)
    }
    #[inline(always)]
    fn greatest(self, other: i32) -> i32 {
        self.max(other)
    }
    #[inline(always)]
    fn decision(self) -> i32 {
        self
    }
    #[inline(always)]
    fn truncated(self, shift: u32) -> i32 {
        self >> shift << shift
    }
    fn observe(self) -> (i64, Option<f64>) {
        (i64::from(self), None)
    }
    fn observe_factor(factor: Halves) -> (i64, Option<f64>) {
        (i64::from(factor.0), None)
    }
    fn observe_sum(sum: Quarters) -> (i64, Option<f64>) {
        (i64::from(sum.0), None)
    }
    fn observe_weight(weight: i32) -> (i64, Option<f64>) {
        (i64::from(weight), None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares NUM-2 with its statement for every sum that two dot products can form.
    #[test]
    fn rounding_is_floor_of_2n_plus_255_over_510() {
        for n in -400_000..=400_000_i32 {
            assert_eq!(Quarters(4 * n).rounded(), (2 * n + 255).div_euclid(510), "{n}");
        }
    }

    #[test]
    fn half_of_a_sum_rounds_halves_up() {
        for n in -400_000..=400_000_i32 {
            assert_eq!(i32::rounded_half(Quarters(4 * n)), (n + 255).div_euclid(510), "{n}");
        }
    }

    /// CMB-9: 25, 63 and 255 become 13, 32 and 128, as captured.
    #[test]
    fn halving_rounds_up() {
        assert_eq!([25, 63, 255, -1, -256].map(Register::halved), [13, 32, 128, 0, -128]);
    }

    #[test]
    fn saturation_holds_both_floors() {
        for v in -2000..=2000_i32 {
            assert_eq!(v.saturated(RegisterFloor::Full), v.clamp(-256, 255));
            assert_eq!(v.saturated(RegisterFloor::Symmetric), v.clamp(-255, 255));
        }
    }
}
