//! Several ideals at once, which tell the errors of the rules apart.
#![allow(clippy::float_arithmetic, reason = "real-number references; they never feed a stored byte")]

use super::{Blend, Factor, Ideal, Lane, Register, Sum};
use crate::state::{Named, RegisterFloor};
use crate::trace::Part;
use std::ops::{Add, Sub};

/// Number of [`Strands`]: one of single rules, one without any error, one for each part up to which errors are let in.
pub const STRANDS: usize = 2 + Part::ALL.len();

/// Real-number evaluations side by side, each in steps of 1/255.
///
/// * Strand 0 starts from the definition's integers at each rule: what it is off by is the error of that rule alone.
/// * Strand 1 is the ideal.
/// * Strand 2 + k receives the errors of all rules of the first k + 1 [`Part`]s, as the definition makes them, and is ideal otherwise.
///   The last one therefore equals the definition, and the differences of neighbours add up to the whole error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strands(pub [f64; STRANDS]);

impl Strands {
    #[inline(always)]
    fn each(self, f: impl Fn(f64) -> f64) -> Strands {
        Strands(std::array::from_fn(|n| f(self.0[n])))
    }

    #[inline(always)]
    fn both(self, other: Strands, f: impl Fn(f64, f64) -> f64) -> Strands {
        Strands(std::array::from_fn(|n| f(self.0[n], other.0[n])))
    }

    /// What each part adds to the error of a value, in the order of [`Part::ALL`].
    pub fn parts(self) -> [f64; Part::ALL.len()] {
        std::array::from_fn(|n| self.0[n + 2] - self.0[n + 1])
    }
}

impl Ideal for Strands {
    #[inline(always)]
    fn of(real: f64) -> Strands {
        Strands([real; STRANDS])
    }
    #[inline(always)]
    fn real(self) -> f64 {
        self.0[1]
    }
    #[inline(always)]
    fn absorb(mut self, fixed: f64, part: Part) -> (Strands, f64) {
        let error = fixed - self.0[0];
        self.0[0] = fixed;
        for strand in &mut self.0[2 + part as usize..] {
            *strand += error;
        }
        (self, error)
    }
    #[inline(always)]
    fn remembered(self, fixed: i32, signed: bool) -> Strands {
        let remembered = self.each(|memory| memory.remembered(fixed, signed));
        // What the store lost of a signed channel shows here, before its unit changes.
        if signed { remembered.absorb(f64::from(fixed) * 255.0 / 128.0, Part::Store).0 } else { remembered }
    }
}

impl Add for Strands {
    type Output = Strands;
    #[inline(always)]
    fn add(self, other: Strands) -> Strands {
        self.both(other, |a, b| a + b)
    }
}

impl Sub for Strands {
    type Output = Strands;
    #[inline(always)]
    fn sub(self, other: Strands) -> Strands {
        self.both(other, |a, b| a - b)
    }
}

impl Blend for Strands {
    type Weight = Strands;
    const WHOLE: Strands = Strands([f64::WHOLE; STRANDS]);
    #[inline(always)]
    fn times(self, weight: Strands) -> Strands {
        self.both(weight, f64::times)
    }
    #[inline(always)]
    fn round8(self) -> Strands {
        self.each(f64::round8)
    }
}

impl Register for Strands {
    type Factor = Strands;
    type Expanded = Strands;
    const ZERO: Strands = Strands([0.0; STRANDS]);
    const ONE: Strands = Strands([f64::ONE; STRANDS]);
    const HALF: Strands = Strands([f64::HALF; STRANDS]);
    #[inline(always)]
    fn max0(self) -> Strands {
        self.each(Register::max0)
    }
    #[inline(always)]
    fn factor(self) -> Strands {
        self
    }
    #[inline(always)]
    fn twice(self) -> Strands {
        self.each(Register::twice)
    }
    #[inline(always)]
    fn halved(self) -> Strands {
        self.each(Register::halved)
    }
    #[inline(always)]
    fn saturated(self, floor: RegisterFloor) -> Strands {
        self.each(|x| x.saturated(floor))
    }
}

impl Factor for Strands {
    type Sum = Strands;
    type Register = Strands;
    #[inline(always)]
    fn product(self, other: Strands) -> Strands {
        self.both(other, Factor::product)
    }
}

impl Sum for Strands {
    type Register = Strands;
    #[inline(always)]
    fn rounded(self) -> Strands {
        self.each(Sum::rounded)
    }
}

impl Lane for Strands {
    type Mapped = Strands;
    type Full = Strands;
    const STEP: Strands = Strands([f64::STEP; STRANDS]);
    #[inline(always)]
    fn byte(value: u8) -> Strands {
        Strands::of(f64::from(value))
    }
    #[inline(always)]
    fn texel(value: i32, numerator: i32, denominator: i32) -> Strands {
        Strands::of(f64::texel(value, numerator, denominator))
    }
    #[inline(always)]
    fn signed_texel(self) -> Strands {
        self.each(Lane::signed_texel)
    }
    #[inline(always)]
    fn weight(_fixed: i32, ideal: impl FnOnce() -> f64) -> Strands {
        Strands::of(ideal())
    }
    #[inline(always)]
    fn value(_fixed: i32, ideal: impl FnOnce() -> f64) -> Strands {
        Strands::of(ideal())
    }
    #[inline(always)]
    fn halfway(a: Strands, b: Strands) -> Strands {
        a.both(b, f64::halfway)
    }
    #[inline(always)]
    fn negated(factor: Strands) -> Strands {
        factor.each(f64::negated)
    }
    #[inline(always)]
    fn widened(self) -> Strands {
        self.each(Lane::widened)
    }
    #[inline(always)]
    fn rounded_half(sum: Strands) -> Strands {
        sum.each(f64::rounded_half)
    }
    #[inline(always)]
    fn clamped(self) -> Strands {
        self.each(Lane::clamped)
    }
    #[inline(always)]
    fn least(self, other: Strands) -> Strands {
        self.both(other, f64::min)
    }
    #[inline(always)]
    fn greatest(self, other: Strands) -> Strands {
        self.both(other, f64::max)
    }
    #[inline(always)]
    fn decision(self) -> i32 {
        self.real().decision()
    }
    #[inline(always)]
    fn truncated(self, _shift: u32) -> Strands {
        self
    }
    fn observe(self) -> (i64, Option<f64>) {
        self.real().observe()
    }
    fn observe_factor(factor: Strands) -> (i64, Option<f64>) {
        f64::observe_factor(factor.real())
    }
    fn observe_sum(sum: Strands) -> (i64, Option<f64>) {
        f64::observe_sum(sum.real())
    }
    fn observe_weight(weight: Strands) -> (i64, Option<f64>) {
        f64::observe_weight(weight.real())
    }
}
