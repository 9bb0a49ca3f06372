//! The definition and the ideal side by side. Every operation is done in both; every decision is the definition's.

use super::{Blend, Factor, Halves, Ideal, Lane, Part, Quarters, Register, Sum};
use crate::state::RegisterFloor;
use std::ops::{Add, Sub};

/// An integer of the definition, and the real number that it approximates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair<I = f64, F = i32> {
    /// The integer of the definition.
    pub fixed: F,
    /// The real number of the ideal, in steps of 1/255.
    pub ideal: I,
}

/// A factor of [`Pair`] registers.
pub(crate) type PairFactor<I = f64> = Pair<I, Halves>;

/// A sum of products of [`PairFactor`]s.
pub(crate) type PairSum<I = f64> = Pair<I, Quarters>;

impl<I: Add<Output = I>, F: Add<Output = F>> Add for Pair<I, F> {
    type Output = Self;
    #[inline(always)]
    #[allow(clippy::float_arithmetic, reason = "the ideal half")]
    fn add(self, other: Self) -> Self {
        Pair { fixed: self.fixed + other.fixed, ideal: self.ideal + other.ideal }
    }
}

impl<I: Sub<Output = I>, F: Sub<Output = F>> Sub for Pair<I, F> {
    type Output = Self;
    #[inline(always)]
    #[allow(clippy::float_arithmetic, reason = "the ideal half")]
    fn sub(self, other: Self) -> Self {
        Pair { fixed: self.fixed - other.fixed, ideal: self.ideal - other.ideal }
    }
}

/// Defines methods that act on each half alone.
macro_rules! on_both {
    ($($method:ident($($other:ident: $type:ty)?) -> $result:ty;)+) => { $(
        fn $method(self $(, $other: $type)?) -> $result {
            Pair { fixed: self.fixed.$method($($other.fixed)?), ideal: self.ideal.$method($($other.ideal)?) }
        }
    )+ };
}

impl<I: Ideal> Blend for Pair<I> {
    type Weight = Self;
    const WHOLE: Self = Pair { fixed: 256, ideal: I::WHOLE };
    on_both! {
        times(weight: Self) -> Self;
        round8() -> Self;
    }
}

impl<I: Ideal> Register for Pair<I> {
    type Factor = PairFactor<I>;
    type Expanded = PairFactor<I>;
    const ZERO: Self = Pair { fixed: 0, ideal: I::ZERO };
    const ONE: Self = Pair { fixed: 255, ideal: I::ONE };
    const HALF: Self = Pair { fixed: i32::HALF, ideal: I::HALF };
    on_both! {
        max0() -> Self;
        factor() -> PairFactor<I>;
        twice() -> PairFactor<I>;
        halved() -> Self;
    }
    fn saturated(self, floor: RegisterFloor) -> Self {
        Pair { fixed: self.fixed.saturated(floor), ideal: self.ideal.saturated(floor) }
    }
}

impl<I: Ideal> Factor for PairFactor<I> {
    type Sum = PairSum<I>;
    type Register = Pair<I>;
    on_both! { product(other: Self) -> PairSum<I>; }
}

impl<I: Ideal> Sum for PairSum<I> {
    type Register = Pair<I>;
    on_both! { rounded() -> Pair<I>; }
}

impl<I: Ideal> Lane for Pair<I> {
    type Mapped = PairFactor<I>;
    type Full = PairSum<I>;
    const STEP: Self = Pair { fixed: i32::STEP, ideal: I::STEP };
    const DECIDES: bool = I::LEADS;
    fn byte(value: u8) -> Self {
        Pair { fixed: i32::byte(value), ideal: I::byte(value) }
    }
    fn texel(value: i32, numerator: i32, denominator: i32) -> Self {
        Pair { fixed: i32::texel(value, numerator, denominator), ideal: I::texel(value, numerator, denominator) }
    }
    fn weight(fixed: i32, ideal: impl FnOnce() -> f64) -> Self {
        Pair { fixed, ideal: I::from_real(ideal()) }
    }
    fn value(fixed: i32, ideal: impl FnOnce() -> f64) -> Self {
        Pair { fixed, ideal: I::from_real(ideal()) }
    }
    fn multiplied(self, fixed: i32, factor: impl FnOnce() -> f64) -> Self {
        Pair { fixed, ideal: self.ideal.multiplied(fixed, factor) }
    }
    fn mixed(values: [Self; 3], fixed: i32, real: impl Fn([f64; 3]) -> f64) -> Self {
        Pair { fixed, ideal: I::mixed(values.map(|value| value.ideal), fixed, real) }
    }
    fn halfway(a: Self, b: Self) -> PairFactor<I> {
        Pair { fixed: i32::halfway(a.fixed, b.fixed), ideal: I::halfway(a.ideal, b.ideal) }
    }
    fn negated(factor: PairFactor<I>) -> PairFactor<I> {
        Pair { fixed: i32::negated(factor.fixed), ideal: I::negated(factor.ideal) }
    }
    fn rounded_half(sum: PairSum<I>) -> Self {
        Pair { fixed: i32::rounded_half(sum.fixed), ideal: I::rounded_half(sum.ideal) }
    }
    on_both! {
        signed_texel() -> Self;
        widened() -> PairSum<I>;
        clamped() -> Self;
        least(other: Self) -> Self;
        greatest(other: Self) -> Self;
    }
    fn decision(self) -> i32 {
        self.fixed
    }
    fn ideal_decision(self) -> i32 {
        self.ideal.decision()
    }
    fn remember(self, memory: Self, signed: bool) -> Self {
        Pair { fixed: self.fixed, ideal: memory.ideal.remembered(self.fixed, signed) }
    }
    fn attributed(self, part: Part) -> (Self, f64) {
        let (ideal, error) = self.ideal.absorb(f64::from(self.fixed), part);
        (Pair { ideal, ..self }, error)
    }
    #[allow(clippy::float_arithmetic, reason = "the ideal half")]
    fn attributed_factor(factor: PairFactor<I>, part: Part) -> (PairFactor<I>, f64) {
        let (ideal, error) = factor.ideal.absorb(f64::from(factor.fixed.0) / 2.0, part);
        (Pair { ideal, ..factor }, error)
    }
    fn attributed_weight(weight: Self, part: Part) -> (Self, f64) {
        weight.attributed(part)
    }
    fn settled(self, real: bool) -> Self {
        if real {
            Pair { fixed: self.ideal.decision(), ..self }
        } else {
            Pair { ideal: I::from_real(self.fixed.into()), ..self }
        }
    }
    #[allow(clippy::float_arithmetic, reason = "the ideal half")]
    fn settled_factor(factor: PairFactor<I>, real: bool) -> PairFactor<I> {
        if real {
            Pair { fixed: Halves((2.0 * factor.ideal.real() + 0.5).floor() as i32), ..factor }
        } else {
            Pair { ideal: I::from_real(f64::from(factor.fixed.0) / 2.0), ..factor }
        }
    }
    fn settled_weight(weight: Self, real: bool) -> Self {
        weight.settled(real)
    }
    fn truncated(self, shift: u32) -> Self {
        Pair { fixed: self.fixed.truncated(shift), ideal: self.ideal.truncated(shift) }
    }
    fn observe(self) -> (i64, Option<f64>) {
        (i64::from(self.fixed), Some(self.ideal.real()))
    }
    fn observe_factor(factor: PairFactor<I>) -> (i64, Option<f64>) {
        (i64::from(factor.fixed.0), Some(factor.ideal.real()))
    }
    fn observe_sum(sum: PairSum<I>) -> (i64, Option<f64>) {
        (i64::from(sum.fixed.0), Some(sum.ideal.real()))
    }
    fn observe_weight(weight: Self) -> (i64, Option<f64>) {
        (i64::from(weight.fixed), Some(weight.ideal.real()))
    }
}
