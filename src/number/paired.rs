//! The definition and the ideal side by side: every operation is done in both, every decision is the definition's.

use super::{Blend, Factor, Halves, Lane, Quarters, Register, Sum};
use crate::state::RegisterFloor;
use std::ops::{Add, Sub};

/// A value as an integer of the definition and as the real number that it stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paired {
    /// The definition.
    pub fixed: i32,
    /// The ideal, in steps of 1/255.
    pub ideal: f64,
}

/// A factor of [`Paired`] registers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairedFactor {
    /// The definition.
    pub fixed: Halves,
    /// The ideal.
    pub ideal: f64,
}

/// A sum of products of [`PairedFactor`]s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairedSum {
    /// The definition.
    pub fixed: Quarters,
    /// The ideal.
    pub ideal: f64,
}

/// Operators on the two halves; the ideal's arithmetic itself is `f64`'s.
macro_rules! componentwise {
    ($type:ident) => {
        impl Add for $type {
            type Output = $type;
            #[inline(always)]
            #[allow(clippy::float_arithmetic, reason = "the ideal half")]
            fn add(self, other: $type) -> $type {
                $type { fixed: self.fixed + other.fixed, ideal: self.ideal + other.ideal }
            }
        }
        impl Sub for $type {
            type Output = $type;
            #[inline(always)]
            #[allow(clippy::float_arithmetic, reason = "the ideal half")]
            fn sub(self, other: $type) -> $type {
                $type { fixed: self.fixed - other.fixed, ideal: self.ideal - other.ideal }
            }
        }
    };
}
componentwise!(Paired);
componentwise!(PairedSum);

impl Blend for Paired {
    type Weight = Paired;
    const WHOLE: Paired = Paired { fixed: 256, ideal: 256.0 };
    fn times(self, weight: Paired) -> Paired {
        Paired { fixed: self.fixed.times(weight.fixed), ideal: self.ideal.times(weight.ideal) }
    }
    fn round8(self) -> Paired {
        Paired { fixed: self.fixed.round8(), ideal: self.ideal.round8() }
    }
}

impl Register for Paired {
    type Factor = PairedFactor;
    type Expanded = PairedFactor;
    const ZERO: Paired = Paired { fixed: 0, ideal: 0.0 };
    const ONE: Paired = Paired { fixed: 255, ideal: 255.0 };
    const HALF: Paired = Paired { fixed: i32::HALF, ideal: f64::HALF };
    fn max0(self) -> Paired {
        Paired { fixed: self.fixed.max0(), ideal: self.ideal.max0() }
    }
    fn factor(self) -> PairedFactor {
        PairedFactor { fixed: self.fixed.factor(), ideal: self.ideal.factor() }
    }
    fn twice(self) -> PairedFactor {
        PairedFactor { fixed: self.fixed.twice(), ideal: self.ideal.twice() }
    }
    fn halved(self) -> Paired {
        Paired { fixed: self.fixed.halved(), ideal: self.ideal.halved() }
    }
    fn saturated(self, floor: RegisterFloor) -> Paired {
        Paired { fixed: self.fixed.saturated(floor), ideal: self.ideal.saturated(floor) }
    }
}

impl Factor for PairedFactor {
    type Sum = PairedSum;
    type Register = Paired;
    fn product(self, other: PairedFactor) -> PairedSum {
        PairedSum { fixed: self.fixed.product(other.fixed), ideal: self.ideal.product(other.ideal) }
    }
}

impl Sum for PairedSum {
    type Register = Paired;
    fn rounded(self) -> Paired {
        Paired { fixed: self.fixed.rounded(), ideal: self.ideal.rounded() }
    }
}

impl Lane for Paired {
    type Mapped = PairedFactor;
    type Full = PairedSum;
    const STEP: Paired = Paired { fixed: i32::STEP, ideal: f64::STEP };
    fn byte(value: u8) -> Paired {
        Paired { fixed: i32::byte(value), ideal: f64::byte(value) }
    }
    fn texel(value: i32, numerator: i32, denominator: i32) -> Paired {
        Paired { fixed: i32::texel(value, numerator, denominator), ideal: f64::texel(value, numerator, denominator) }
    }
    fn signed_texel(self) -> Paired {
        Paired { fixed: self.fixed.signed_texel(), ideal: self.ideal.signed_texel() }
    }
    fn weight(fixed: i32, ideal: impl FnOnce() -> f64) -> Paired {
        Paired { fixed, ideal: ideal() }
    }
    fn value(fixed: i32, ideal: impl FnOnce() -> f64) -> Paired {
        Paired { fixed, ideal: ideal() }
    }
    fn halfway(a: Paired, b: Paired) -> PairedFactor {
        PairedFactor { fixed: i32::halfway(a.fixed, b.fixed), ideal: f64::halfway(a.ideal, b.ideal) }
    }
    fn negated(factor: PairedFactor) -> PairedFactor {
        PairedFactor { fixed: i32::negated(factor.fixed), ideal: f64::negated(factor.ideal) }
    }
    fn widened(self) -> PairedSum {
        PairedSum { fixed: self.fixed.widened(), ideal: self.ideal.widened() }
    }
    fn rounded_half(sum: PairedSum) -> Paired {
        Paired { fixed: i32::rounded_half(sum.fixed), ideal: f64::rounded_half(sum.ideal) }
    }
    fn clamped(self) -> Paired {
        Paired { fixed: self.fixed.clamped(), ideal: self.ideal.clamped() }
    }
    fn least(self, other: Paired) -> Paired {
        Paired { fixed: self.fixed.least(other.fixed), ideal: self.ideal.least(other.ideal) }
    }
    fn greatest(self, other: Paired) -> Paired {
        Paired { fixed: self.fixed.greatest(other.fixed), ideal: self.ideal.greatest(other.ideal) }
    }
    fn decision(self) -> i32 {
        self.fixed
    }
    fn truncated(self, shift: u32) -> Paired {
        Paired { fixed: self.fixed.truncated(shift), ideal: self.ideal.truncated(shift) }
    }
    fn observe(self) -> (i64, Option<f64>) {
        (i64::from(self.fixed), Some(self.ideal))
    }
    fn observe_factor(factor: PairedFactor) -> (i64, Option<f64>) {
        (i64::from(factor.fixed.0), Some(factor.ideal))
    }
    fn observe_sum(sum: PairedSum) -> (i64, Option<f64>) {
        (i64::from(sum.fixed.0), Some(sum.ideal))
    }
    fn observe_weight(weight: Paired) -> (i64, Option<f64>) {
        (i64::from(weight.fixed), Some(weight.ideal))
    }
}
