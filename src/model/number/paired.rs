//! The definition and the ideal side by side: every operation is done in both, every decision is the definition's.

use super::{Blend, Factor, Halves, Ideal, Lane, Part, Quarters, Register, Sum};
use crate::state::RegisterFloor;
use std::ops::{Add, Sub};

/// A value as an integer of the definition and as the real number that it stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paired<I = f64> {
    /// The definition.
    pub fixed: i32,
    /// The ideal, in steps of 1/255.
    pub ideal: I,
}

/// A factor of [`Paired`] registers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairedFactor<I = f64> {
    /// The definition.
    pub fixed: Halves,
    /// The ideal.
    pub ideal: I,
}

/// A sum of products of [`PairedFactor`]s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairedSum<I = f64> {
    /// The definition.
    pub fixed: Quarters,
    /// The ideal.
    pub ideal: I,
}

/// Operators on the two halves; the ideal's arithmetic itself is `f64`'s.
macro_rules! componentwise {
    ($type:ident) => {
        impl<I: Ideal> Add for $type<I> {
            type Output = $type<I>;
            #[inline(always)]
            #[allow(clippy::float_arithmetic, reason = "the ideal half")]
            fn add(self, other: Self) -> Self {
                $type { fixed: self.fixed + other.fixed, ideal: self.ideal + other.ideal }
            }
        }
        impl<I: Ideal> Sub for $type<I> {
            type Output = $type<I>;
            #[inline(always)]
            #[allow(clippy::float_arithmetic, reason = "the ideal half")]
            fn sub(self, other: Self) -> Self {
                $type { fixed: self.fixed - other.fixed, ideal: self.ideal - other.ideal }
            }
        }
    };
}
componentwise!(Paired);
componentwise!(PairedSum);

impl<I: Ideal> Blend for Paired<I> {
    type Weight = Self;
    const WHOLE: Self = Paired { fixed: 256, ideal: I::WHOLE };
    fn times(self, weight: Self) -> Self {
        Paired { fixed: self.fixed.times(weight.fixed), ideal: self.ideal.times(weight.ideal) }
    }
    fn round8(self) -> Self {
        Paired { fixed: self.fixed.round8(), ideal: self.ideal.round8() }
    }
}

impl<I: Ideal> Register for Paired<I> {
    type Factor = PairedFactor<I>;
    type Expanded = PairedFactor<I>;
    const ZERO: Self = Paired { fixed: 0, ideal: I::ZERO };
    const ONE: Self = Paired { fixed: 255, ideal: I::ONE };
    const HALF: Self = Paired { fixed: i32::HALF, ideal: I::HALF };
    fn max0(self) -> Self {
        Paired { fixed: self.fixed.max0(), ideal: self.ideal.max0() }
    }
    fn factor(self) -> PairedFactor<I> {
        PairedFactor { fixed: self.fixed.factor(), ideal: self.ideal.factor() }
    }
    fn twice(self) -> PairedFactor<I> {
        PairedFactor { fixed: self.fixed.twice(), ideal: self.ideal.twice() }
    }
    fn halved(self) -> Self {
        Paired { fixed: self.fixed.halved(), ideal: self.ideal.halved() }
    }
    fn saturated(self, floor: RegisterFloor) -> Self {
        Paired { fixed: self.fixed.saturated(floor), ideal: self.ideal.saturated(floor) }
    }
}

impl<I: Ideal> Factor for PairedFactor<I> {
    type Sum = PairedSum<I>;
    type Register = Paired<I>;
    fn product(self, other: PairedFactor<I>) -> PairedSum<I> {
        PairedSum { fixed: self.fixed.product(other.fixed), ideal: self.ideal.product(other.ideal) }
    }
}

impl<I: Ideal> Sum for PairedSum<I> {
    type Register = Paired<I>;
    fn rounded(self) -> Paired<I> {
        Paired { fixed: self.fixed.rounded(), ideal: self.ideal.rounded() }
    }
}

impl<I: Ideal> Lane for Paired<I> {
    type Mapped = PairedFactor<I>;
    type Full = PairedSum<I>;
    const STEP: Self = Paired { fixed: i32::STEP, ideal: I::STEP };
    fn byte(value: u8) -> Self {
        Paired { fixed: i32::byte(value), ideal: I::byte(value) }
    }
    fn texel(value: i32, numerator: i32, denominator: i32) -> Self {
        Paired { fixed: i32::texel(value, numerator, denominator), ideal: I::texel(value, numerator, denominator) }
    }
    fn signed_texel(self) -> Self {
        Paired { fixed: self.fixed.signed_texel(), ideal: self.ideal.signed_texel() }
    }
    fn weight(fixed: i32, ideal: impl FnOnce() -> f64) -> Self {
        Paired { fixed, ideal: I::of(ideal()) }
    }
    fn value(fixed: i32, ideal: impl FnOnce() -> f64) -> Self {
        Paired { fixed, ideal: I::of(ideal()) }
    }
    fn multiplied(self, fixed: i32, factor: impl FnOnce() -> f64) -> Self {
        Paired { fixed, ideal: self.ideal.multiplied(fixed, factor) }
    }
    fn halfway(a: Self, b: Self) -> PairedFactor<I> {
        PairedFactor { fixed: i32::halfway(a.fixed, b.fixed), ideal: I::halfway(a.ideal, b.ideal) }
    }
    fn negated(factor: PairedFactor<I>) -> PairedFactor<I> {
        PairedFactor { fixed: i32::negated(factor.fixed), ideal: I::negated(factor.ideal) }
    }
    fn widened(self) -> PairedSum<I> {
        PairedSum { fixed: self.fixed.widened(), ideal: self.ideal.widened() }
    }
    fn rounded_half(sum: PairedSum<I>) -> Self {
        Paired { fixed: i32::rounded_half(sum.fixed), ideal: I::rounded_half(sum.ideal) }
    }
    fn clamped(self) -> Self {
        Paired { fixed: self.fixed.clamped(), ideal: self.ideal.clamped() }
    }
    fn least(self, other: Self) -> Self {
        Paired { fixed: self.fixed.least(other.fixed), ideal: self.ideal.least(other.ideal) }
    }
    fn greatest(self, other: Self) -> Self {
        Paired { fixed: self.fixed.greatest(other.fixed), ideal: self.ideal.greatest(other.ideal) }
    }
    fn decision(self) -> i32 {
        self.fixed
    }
    fn ideal_decision(self) -> i32 {
        self.ideal.decision()
    }
    fn remember(self, memory: Self, signed: bool) -> Self {
        Paired { fixed: self.fixed, ideal: memory.ideal.remembered(self.fixed, signed) }
    }
    fn attributed(self, part: Part) -> (Self, f64) {
        let (ideal, error) = self.ideal.absorb(f64::from(self.fixed), part);
        (Paired { ideal, ..self }, error)
    }
    #[allow(clippy::float_arithmetic, reason = "the ideal half")]
    fn attributed_factor(factor: PairedFactor<I>, part: Part) -> (PairedFactor<I>, f64) {
        let (ideal, error) = factor.ideal.absorb(f64::from(factor.fixed.0) / 2.0, part);
        (PairedFactor { ideal, ..factor }, error)
    }
    fn attributed_weight(weight: Self, part: Part) -> (Self, f64) {
        weight.attributed(part)
    }
    fn truncated(self, shift: u32) -> Self {
        Paired { fixed: self.fixed.truncated(shift), ideal: self.ideal.truncated(shift) }
    }
    fn observe(self) -> (i64, Option<f64>) {
        (i64::from(self.fixed), Some(self.ideal.real()))
    }
    fn observe_factor(factor: PairedFactor<I>) -> (i64, Option<f64>) {
        (i64::from(factor.fixed.0), Some(factor.ideal.real()))
    }
    fn observe_sum(sum: PairedSum<I>) -> (i64, Option<f64>) {
        (i64::from(sum.fixed.0), Some(sum.ideal.real()))
    }
    fn observe_weight(weight: Self) -> (i64, Option<f64>) {
        (i64::from(weight.fixed), Some(weight.ideal.real()))
    }
}
