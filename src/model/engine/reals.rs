//! [`Reals`], the observer that keeps the real numbers of some rules, and [`FragmentRecorder`], which records their steps as well.

use crate::number::Lane;
use crate::rop::surface;
use crate::state::SurfaceFormat;
use crate::trace::{Observer, Rule, Step};

/// An observer under which some rules yield the real numbers of a paired lane, and all others the integers of the definition. It makes
/// another renderer of the scalar engine: later rules start from what it returns. The default leaves both numbers as they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reals {
    /// Whether the other rules yield the integers.
    settles: bool,
    /// The rules, by their number.
    rules: u64,
    /// Whether depths are computed in single precision.
    pub(crate) depths: bool,
    /// The least depth word above 0; smaller ones become 0.
    pub(crate) least_depth: u32,
    /// Whether the alpha test compares real numbers.
    pub(crate) alpha: bool,
    /// Whether surfaces of 16 bits round to nearest.
    pub(crate) stores: bool,
}

impl Reals {
    /// Returns an observer that keeps the real numbers of no rule yet.
    pub(crate) fn none() -> Reals {
        Reals { settles: true, ..Reals::default() }
    }

    /// Keeps the real numbers of a rule.
    pub(crate) fn keep(&mut self, rule: Rule) {
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
        if self.settles { value.settled(self.has(rule)) } else { value }
    }
    #[inline]
    fn observe_factor<L: Lane>(&mut self, rule: Rule, factor: L::Mapped) -> L::Mapped {
        if self.settles { L::settled_factor(factor, self.has(rule)) } else { factor }
    }
    #[inline]
    fn observe_weight<L: Lane>(&mut self, rule: Rule, weight: L::Weight) -> L::Weight {
        if self.settles { L::settled_weight(weight, self.has(rule)) } else { weight }
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

/// The observer of a fragment: [`Reals`], and the steps of some names, or all. The pipe with its reports is compiled for this observer alone, whoever
/// reads the steps.
#[derive(Debug, Default)]
pub(super) struct FragmentRecorder<'a> {
    pub(super) reals: Reals,
    /// The names that are wanted; `None` for all.
    pub(super) names: Option<&'a [String]>,
    pub(super) steps: Vec<Step>,
}

impl Observer for FragmentRecorder<'_> {
    const ON: bool = true;
    const MEASURES: bool = true;
    fn wants(&self, parts: &[&str]) -> bool {
        self.names.is_none_or(|names| {
            names.iter().any(|name| {
                let mut rest = Some(name.as_str());
                for part in parts {
                    rest = rest.and_then(|rest| rest.strip_prefix(part));
                }
                rest.is_some()
            })
        })
    }
    fn step(&mut self, step: Step) {
        if self.names.is_none_or(|names| names.contains(&step.name)) {
            self.steps.push(step);
        }
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
