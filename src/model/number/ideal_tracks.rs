//! Several ideals side by side, which attribute errors to the rules that cause them.
#![allow(clippy::float_arithmetic, reason = "real-number references; they never feed a stored byte")]

use super::{Blend, Factor, Ideal, Lane, Part, Register, Sum};
use crate::state::{Named, RegisterFloor};
use std::ops::{Add, Sub};

/// Number of [`IdealTracks`] that attribute all errors: one for the ideal, and one for each part.
pub const IDEAL_TRACKS: usize = 1 + Part::ALL.len();

/// Real-number evaluations side by side, each in steps of 1/255.
///
/// * Track 0 is the ideal.
/// * Track 1 + k receives the errors that the definition makes in the rules of the first k + 1 [`Part`]s and is ideal
///   otherwise. The differences between neighbouring tracks add up to the whole error.
/// * The last track therefore starts from the definition's integers at each rule, so that its error is the error of
///   that rule alone.
///
/// `IdealTracks<1>` consists of the last track alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdealTracks<const N: usize>(pub [f64; N]);

impl<const N: usize> IdealTracks<N> {
    #[inline(always)]
    fn map(mut self, f: impl Fn(f64) -> f64) -> Self {
        for track in &mut self.0 {
            *track = f(*track);
        }
        self
    }

    #[inline(always)]
    fn zip(mut self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        for (track, other) in self.0.iter_mut().zip(other.0) {
            *track = f(*track, other);
        }
        self
    }
}

impl IdealTracks<IDEAL_TRACKS> {
    /// Returns the error that each part adds to the value, in the order of `Part::ALL`.
    pub fn parts(self) -> [f64; Part::ALL.len()] {
        std::array::from_fn(|n| self.0[n + 1] - self.0[n])
    }
}

impl<const N: usize> Ideal for IdealTracks<N> {
    #[inline(always)]
    fn from_real(real: f64) -> Self {
        IdealTracks([real; N])
    }
    #[inline(always)]
    fn real(self) -> f64 {
        self.0[0]
    }
    #[inline(always)]
    fn absorb(mut self, fixed: f64, part: Part) -> (Self, f64) {
        let error = fixed - self.0[N - 1];
        for (n, track) in self.0.iter_mut().enumerate() {
            *track = if n > part as usize { *track + error } else { *track };
        }
        self.0[N - 1] = fixed;
        (self, error)
    }
    #[inline(always)]
    fn remembered(self, fixed: i32, signed: bool) -> Self {
        let remembered = self.map(|memory| memory.remembered(fixed, signed));
        // The error of storing a signed channel appears here, before its unit changes.
        if signed { remembered.absorb(f64::from(fixed) * 255.0 / 128.0, Part::Store).0 } else { remembered }
    }
}

impl<const N: usize> Add for IdealTracks<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<const N: usize> Sub for IdealTracks<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<const N: usize> Blend for IdealTracks<N> {
    type Weight = Self;
    const WHOLE: Self = IdealTracks([f64::WHOLE; N]);
    componentwise! {
        times(weight: Self) -> Self = f64::times;
        round8() -> Self = f64::round8;
    }
}

impl<const N: usize> Register for IdealTracks<N> {
    type Factor = Self;
    type Expanded = Self;
    const ZERO: Self = IdealTracks([0.0; N]);
    const ONE: Self = IdealTracks([f64::ONE; N]);
    const HALF: Self = IdealTracks([f64::HALF; N]);
    #[inline(always)]
    fn max0(self) -> Self {
        self.map(Register::max0)
    }
    #[inline(always)]
    fn factor(self) -> Self {
        self
    }
    componentwise! {
        twice() -> Self = Register::twice;
        halved() -> Self = Register::halved;
    }
    #[inline(always)]
    fn saturated(self, floor: RegisterFloor) -> Self {
        self.map(|x| x.saturated(floor))
    }
}

impl<const N: usize> Factor for IdealTracks<N> {
    type Sum = Self;
    type Register = Self;
    #[inline(always)]
    fn product(self, other: Self) -> Self {
        self.zip(other, Factor::product)
    }
}

impl<const N: usize> Sum for IdealTracks<N> {
    type Register = Self;
    #[inline(always)]
    fn rounded(self) -> Self {
        self.map(Sum::rounded)
    }
}

impl<const N: usize> Lane for IdealTracks<N> {
    type Mapped = Self;
    type Full = Self;
    const STEP: Self = IdealTracks([f64::STEP; N]);
    #[inline(always)]
    fn byte(value: u8) -> Self {
        Self::from_real(f64::from(value))
    }
    #[inline(always)]
    fn texel(value: i32, numerator: i32, denominator: i32) -> Self {
        Self::from_real(f64::texel(value, numerator, denominator))
    }
    #[inline(always)]
    fn signed_texel(self) -> Self {
        self.map(Lane::signed_texel)
    }
    #[inline(always)]
    fn weight(_fixed: i32, ideal: impl FnOnce() -> f64) -> Self {
        Self::from_real(ideal())
    }
    #[inline(always)]
    fn value(_fixed: i32, ideal: impl FnOnce() -> f64) -> Self {
        Self::from_real(ideal())
    }
    #[inline(always)]
    fn multiplied(self, fixed: i32, factor: impl FnOnce() -> f64) -> Self {
        let factor = factor();
        self.map(|track| track.multiplied(fixed, || factor))
    }
    #[inline(always)]
    fn mixed(values: [Self; 3], _fixed: i32, real: impl Fn([f64; 3]) -> f64) -> Self {
        IdealTracks(std::array::from_fn(|track| real(values.map(|value| value.0[track]))))
    }
    #[inline(always)]
    fn halfway(a: Self, b: Self) -> Self {
        a.zip(b, f64::halfway)
    }
    #[inline(always)]
    fn negated(factor: Self) -> Self {
        factor.map(f64::negated)
    }
    #[inline(always)]
    fn widened(self) -> Self {
        self.map(Lane::widened)
    }
    #[inline(always)]
    fn rounded_half(sum: Self) -> Self {
        sum.map(f64::rounded_half)
    }
    componentwise! {
        clamped() -> Self = Lane::clamped;
        least(other: Self) -> Self = f64::min;
        greatest(other: Self) -> Self = f64::max;
    }
    #[inline(always)]
    fn decision(self) -> i32 {
        self.real().decision()
    }
    #[inline(always)]
    fn truncated(self, _shift: u32) -> Self {
        self
    }
    fn observe(self) -> (i64, Option<f64>) {
        self.real().observe()
    }
    fn observe_factor(factor: Self) -> (i64, Option<f64>) {
        f64::observe_factor(factor.real())
    }
    fn observe_sum(sum: Self) -> (i64, Option<f64>) {
        f64::observe_sum(sum.real())
    }
    fn observe_weight(weight: Self) -> (i64, Option<f64>) {
        f64::observe_weight(weight.real())
    }
}
