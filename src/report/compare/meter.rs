//! Counters for the drawing of a band of rows.

use super::Statistics;
use ninebit::number::Lane;
use ninebit::state::Named;
use ninebit::trace::{Decision, Observer, Rule, Step};

/// Counts of a band.
#[derive(Clone)]
pub(super) struct Counts {
    /// Errors of each rule, indexed by the rule's number.
    pub(super) rules: Vec<Statistics>,
    /// For each decision, how often it was taken, and how often the two sides differ.
    pub(super) decisions: Vec<[u64; 2]>,
}

impl Default for Counts {
    fn default() -> Self {
        Counts { rules: vec![Statistics::default(); Rule::ALL.len()], decisions: vec![[0; 2]; Decision::ALL.len()] }
    }
}

impl Counts {
    pub(super) fn merge(&mut self, other: &Counts) {
        self.rules.iter_mut().zip(&other.rules).for_each(|(mine, other)| mine.merge(other));
        for (mine, other) in self.decisions.iter_mut().zip(&other.decisions) {
            *mine = [mine[0] + other[0], mine[1] + other[1]];
        }
    }

    pub(super) fn decided(&mut self, decision: Decision, differs: bool) {
        let counts = &mut self.decisions[decision as usize];
        *counts = [counts[0] + 1, counts[1] + u64::from(differs)];
    }
}

/// Observer that attributes errors to rules. With `RULES` it also records the error of each rule.
pub(super) struct Meter<'a, const RULES: bool>(pub(super) &'a mut Counts);

impl<const RULES: bool> Meter<'_, RULES> {
    #[inline(always)]
    fn note(&mut self, rule: Rule, error: f64) {
        if RULES {
            self.0.rules[rule as usize].add(error);
        }
    }
}

impl<const RULES: bool> Observer for Meter<'_, RULES> {
    const ON: bool = false;
    const MEASURES: bool = true;
    fn step(&mut self, _step: Step) {}
    #[inline]
    fn observe<L: Lane>(&mut self, rule: Rule, value: L) -> L {
        let (value, error) = value.attributed(rule.part());
        self.note(rule, error);
        value
    }
    #[inline]
    fn observe_factor<L: Lane>(&mut self, rule: Rule, factor: L::Mapped) -> L::Mapped {
        let (factor, error) = L::attributed_factor(factor, rule.part());
        self.note(rule, error);
        factor
    }
    #[inline]
    fn observe_weight<L: Lane>(&mut self, rule: Rule, weight: L::Weight) -> L::Weight {
        let (weight, error) = L::attributed_weight(weight, rule.part());
        self.note(rule, error);
        weight
    }
    fn decided(&mut self, decision: Decision, outcome: i64, ideal: impl FnOnce() -> i64) {
        // The ideal keeps no depths, so it could not decide.
        if decision != Decision::DepthTest {
            self.0.decided(decision, outcome != ideal());
        }
    }
}

/// Observer that records the decisions of one fragment.
#[derive(Default)]
pub(super) struct Log<'a> {
    /// Decisions and their outcomes, in order.
    pub(super) decisions: Vec<(Decision, i64)>,
    /// For each texture that is a surface, the state of its pixels.
    pub(super) diverged: &'a [Option<super::draw::SampledSurface<'a>>],
    /// Whether a diverged pixel was read.
    pub(super) tainted: bool,
}

impl Observer for Log<'_> {
    const ON: bool = false;
    const MEASURES: bool = true;
    fn step(&mut self, _step: Step) {}
    fn decided(&mut self, decision: Decision, outcome: i64, _ideal: impl FnOnce() -> i64) {
        self.decisions.push((decision, outcome));
    }
    fn fetched(&mut self, texture: usize, (x, y): (u32, u32)) {
        if let Some(Some(seen)) = self.diverged.get(texture) {
            self.tainted |= seen.diverged(x, y);
        }
    }
}
