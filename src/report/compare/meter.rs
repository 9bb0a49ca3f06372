//! What is counted while a band of rows is drawn.

use super::Statistics;
use ninebit::number::Lane;
use ninebit::state::Named;
use ninebit::trace::{Decision, Observer, Rule, Step};

/// Counts of a band.
#[derive(Clone)]
pub(super) struct Counts {
    /// Errors of each rule, by its number.
    pub(super) rules: Vec<Statistics>,
    /// By decision: taken, differing.
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

/// Follows a lane that tells errors apart; `RULES` keeps the error of each rule.
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
        // Depths of the ideal are not kept: it could not decide.
        if decision != Decision::DepthTest {
            self.0.decided(decision, outcome != ideal());
        }
    }
}

/// Notes the decisions of one fragment.
#[derive(Default)]
pub(super) struct Log<'a> {
    /// Decisions of a pixel, in the order in which they were taken.
    pub(super) decisions: Vec<(Decision, i64)>,
    /// Pixels of the textures' surfaces that have diverged, by texture.
    pub(super) diverged: &'a [Option<super::draw::Seen<'a>>],
    /// One of them was read.
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
