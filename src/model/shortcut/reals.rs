//! [`Reals`], the observer that keeps the real numbers of some rules, and [`RealsRecorder`], which records their steps as well.

use crate::number::Lane;
use crate::rop::surface;
use crate::state::SurfaceFormat;
use crate::trace::{Observer, Recorder, Rule, Step};

/// An observer under which some rules yield the real numbers of a paired lane, and all others the integers of the definition. It makes
/// another renderer of the scalar engine: later rules start from what it returns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reals {
    /// The rules, by their number.
    rules: u64,
    /// Whether depths are computed in single precision.
    pub(super) depths: bool,
    /// The least depth word above 0; smaller ones become 0.
    pub(super) least_depth: u32,
    /// Whether the alpha test compares real numbers.
    pub(super) alpha: bool,
    /// Whether surfaces of 16 bits round to nearest.
    pub(super) stores: bool,
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
    fn observe_depth(&mut self, word: u32, largest: u32, ideal: impl FnOnce() -> f64) -> u32 {
        let word = if self.depths { (ideal() as f32 as u32).min(largest) } else { word };
        if word < self.least_depth { 0 } else { word }
    }
    #[inline]
    #[allow(clippy::float_arithmetic, reason = "another renderer's alpha test")]
    fn observe_alpha<L: Lane>(&mut self, alpha: L) -> Option<i64> {
        self.alpha.then(|| (alpha.observe().1.unwrap_or_default() * 65536.0) as i64)
    }
    #[inline]
    fn observe_store(&mut self, format: SurfaceFormat, bytes: [u8; 4]) -> [u8; 4] {
        if self.stores { surface::rounded(format, bytes) } else { bytes }
    }
}

/// [`Reals`] and a recorder of the steps.
#[derive(Debug, Default)]
pub(super) struct RealsRecorder {
    pub(super) reals: Reals,
    pub(super) recorder: Recorder,
}

impl Observer for RealsRecorder {
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
    fn observe_alpha<L: Lane>(&mut self, alpha: L) -> Option<i64> {
        self.reals.observe_alpha(alpha)
    }
    fn observe_store(&mut self, format: SurfaceFormat, bytes: [u8; 4]) -> [u8; 4] {
        self.reals.observe_store(format, bytes)
    }
}
