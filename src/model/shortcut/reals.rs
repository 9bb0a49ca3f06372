//! [`Reals`], the observer that keeps the real numbers of some rules, and [`Told`], which records their steps as well.

use crate::number::Lane;
use crate::trace::{Observer, Recorder, Rule, Step};

/// An observer under which some rules yield the real numbers of a paired lane, and all others the integers of the definition. It makes
/// another renderer of the scalar engine: later rules start from what it returns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reals {
    /// The rules, by their number.
    rules: u64,
    /// Whether depths are rounded to nearest.
    pub(super) depths: bool,
}

impl Reals {
    /// Keeps the real numbers of a rule.
    pub(super) fn keep(&mut self, rule: Rule) {
        self.rules |= 1 << rule as u64;
    }

    #[inline(always)]
    fn has(self, rule: Rule) -> bool {
        self.rules >> rule as u64 & 1 != 0
    }
}

impl Observer for Reals {
    const ON: bool = false;
    const MEASURES: bool = true;
    fn step(&mut self, _step: Step) {}
    #[inline]
    fn observe<L: Lane>(&mut self, rule: Rule, value: L) -> L {
        value.settled(self.has(rule))
    }
    #[inline]
    fn observe_factor<L: Lane>(&mut self, rule: Rule, factor: L::Mapped) -> L::Mapped {
        L::settled_factor(factor, self.has(rule))
    }
    #[inline]
    fn observe_weight<L: Lane>(&mut self, rule: Rule, weight: L::Weight) -> L::Weight {
        L::settled_weight(weight, self.has(rule))
    }
    #[inline]
    #[allow(clippy::float_arithmetic, reason = "another renderer's depths")]
    fn observe_depth(&mut self, word: u32, largest: u32, ideal: impl FnOnce() -> f64) -> u32 {
        if self.depths { ((ideal() + 0.5).floor() as u32).min(largest) } else { word }
    }
}

/// [`Reals`] and a recorder of the steps.
#[derive(Debug, Default)]
pub(super) struct Told {
    pub(super) reals: Reals,
    pub(super) recorder: Recorder,
}

impl Observer for Told {
    const ON: bool = true;
    const MEASURES: bool = true;
    fn step(&mut self, step: Step) {
        self.recorder.step(step);
    }
    fn observe<L: Lane>(&mut self, rule: Rule, value: L) -> L {
        self.reals.observe(rule, value)
    }
    fn observe_factor<L: Lane>(&mut self, rule: Rule, factor: L::Mapped) -> L::Mapped {
        self.reals.observe_factor::<L>(rule, factor)
    }
    fn observe_weight<L: Lane>(&mut self, rule: Rule, weight: L::Weight) -> L::Weight {
        self.reals.observe_weight::<L>(rule, weight)
    }
    fn observe_depth(&mut self, word: u32, largest: u32, ideal: impl FnOnce() -> f64) -> u32 {
        self.reals.observe_depth(word, largest, ideal)
    }
}
