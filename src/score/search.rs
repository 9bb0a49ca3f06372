//! The search for shortcuts that yield another renderer's pixels of a frame. It looks at a sample of them.

use std::collections::HashMap;

use ninebit::shortcut::{Shortcut, Shortcuts};

use crate::chance::Differences;
use crate::explain::{Comparison, Counts, same};
use crate::subject::{Renderer, Subject};

/// What variants of the model yield of a sample of a frame.
#[derive(Clone, Debug, Default)]
pub struct Explanation {
    /// The variants that were drawn, and that change a pixel.
    pub variants: Vec<Shortcuts>,
    /// Number of wrong pixels by the set of variants (bit n for number n) that yield them. Bit 127 marks pixels where the rules themselves do
    /// not yield the chip's.
    pub signatures: HashMap<u128, u64>,
    /// For each variant, how it changes the pixels that it was drawn for, and right ones.
    pub predicted: Vec<Differences>,
    /// How all compared pixels differ.
    pub actual: Differences,
    /// Whether the rules yield the chip's bytes of every wrong pixel.
    pub(crate) is_closed: bool,
}

impl Explanation {
    /// Returns whether a variant may yield wrong pixels: it does so of the sample, or it was not drawn and has several shortcuts that change
    /// pixels.
    pub(crate) fn admits(&self, variant: Shortcuts) -> bool {
        let moves = |shortcut: Shortcut| {
            IN_COMPANY.contains(&shortcut) || self.variants.contains(&Shortcuts::NONE.with(shortcut))
        };
        match self.variants.iter().position(|drawn| *drawn == variant) {
            Some(n) => self.signatures.keys().any(|of| of & OPEN == 0 && of >> n & 1 != 0),
            None => variant.iter().count() > 1 && variant.iter().all(moves),
        }
    }
}

/// Shortcuts that may show only beside others.
const IN_COMPANY: [Shortcut; 3] = [Shortcut::ExactCoordinates, Shortcut::UnsnappedVertices, Shortcut::CutDepths];

/// Marks pixels that the rules do not yield.
pub(crate) const OPEN: u128 = 1 << 127;

/// Most wrong pixels of a frame that are drawn with each variant.
const MOST_WRONG: u64 = 2048;

/// One of so many right pixels is drawn with each variant: what a variant changes there speaks against it.
const LATTICE: u64 = 128;

/// Most variants of a frame.
const MOST_VARIANTS: usize = 127;

/// Most shortcuts that are tried together.
const MOST_TOGETHER: usize = 4;

/// So many of the best sets are extended.
const STARTS: usize = 3;

/// So many shortcuts of a frame are tried two by two.
const MOST_PAIRED: usize = 12;

/// So many unexplained pixels of the sample are worth a search for several shortcuts.
const LEAST_REST: usize = 64;

/// Returns one of `step` pixels of a set, in a scatter that follows no pattern of pictures.
pub(crate) fn scattered(set: &[bool], step: u64) -> Vec<usize> {
    let is_taken = |at: &usize| ((*at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32).is_multiple_of(step);
    (0..set.len()).filter(|at| set[*at] && is_taken(at)).collect()
}

/// Returns what variants yield, or `None` if the model does not draw the frame.
pub(crate) fn explanation(subject: &Subject, compared: &Comparison<'_>) -> Option<Explanation> {
    let renderer = subject.drawing.as_ref()?.renderer()?;
    let ours = renderer.draw(Shortcuts::NONE, None)?;
    if ours.len() != compared.truth.len() {
        return None;
    }
    let weight = compared.counts.wrong.div_ceil(MOST_WRONG).max(1);
    let wrong = scattered(&compared.wrong, weight);
    let yields = |at: usize| same(ours[at], compared.truth[at]);
    let signatures = wrong.iter().map(|at| if yields(*at) { 0 } else { OPEN }).collect();
    let right = scattered(&compared.right, LATTICE);
    let is_closed = (0..ours.len()).all(|at| !compared.wrong[at] || yields(at));
    let explanation = Explanation { is_closed, ..Explanation::default() };
    let mut search = Search { renderer: &*renderer, compared, weight, wrong, right, signatures, explanation };
    // Every shortcut alone is drawn at all pixels of the sample: one that turns out to be chance must hide none.
    let mut moving = Vec::new();
    for shortcut in renderer.shortcuts().iter() {
        let alone = Shortcuts::NONE.with(shortcut);
        let moves = search.draw(alone, Scope::All);
        // The parts of a shader are tried with others if they explain much, and as a whole in any case.
        let is_part = Shortcut::PARTS_OF_SHADER.contains(&shortcut);
        let is_strong = moves && (!is_part || search.hits(alone) * 20 > search.wrong.len());
        if is_strong || IN_COMPANY.contains(&shortcut) {
            moving.push(shortcut);
        }
    }
    search.pair(&moving);
    search.grow(&moving);
    Some(search.finish())
}

/// The signatures of wrong pixels while variants are drawn.
struct Search<'a> {
    renderer: &'a dyn Renderer,
    compared: &'a Comparison<'a>,
    /// Number of wrong pixels that one of the sample stands for.
    weight: u64,
    /// Wrong pixels, and right ones.
    wrong: Vec<usize>,
    right: Vec<usize>,
    /// The signature of each of the wrong pixels.
    signatures: Vec<u128>,
    explanation: Explanation,
}

/// The pixels of the sample that a variant is drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scope {
    /// All that are wrong.
    All,
    /// Those that nothing has explained yet.
    Unexplained,
}

impl Search<'_> {
    /// Draws a variant. Returns whether it changes a wrong pixel.
    fn draw(&mut self, variant: Shortcuts, scope: Scope) -> bool {
        let number = self.explanation.variants.len();
        if number >= MOST_VARIANTS {
            return false;
        }
        let is_wanted = |of: u128| of == 0 || scope == Scope::All && of & OPEN == 0;
        let wanted: Vec<usize> = (0..self.wrong.len()).filter(|n| is_wanted(self.signatures[*n])).collect();
        if wanted.is_empty() {
            return false;
        }
        let mut mask = vec![false; self.compared.truth.len()];
        wanted.iter().for_each(|n| mask[self.wrong[*n]] = true);
        self.right.iter().for_each(|at| mask[*at] = true);
        let Some(drawn) = self.renderer.draw(variant, Some(&mask)) else { return false };
        let (truth, other) = (self.compared.truth, self.compared.other);
        let mut predicted = Differences::default();
        let mut moves = false;
        for n in wanted {
            let at = self.wrong[n];
            if !same(drawn[at], truth[at]) {
                moves = true;
                predicted.add(truth[at], drawn[at], self.weight);
                if same(drawn[at], other[at]) {
                    self.signatures[n] |= 1 << number;
                }
            }
        }
        for at in self.right.iter().filter(|at| !same(drawn[**at], truth[**at])) {
            predicted.add(truth[*at], drawn[*at], LATTICE);
        }
        if moves {
            self.explanation.variants.push(variant);
            self.explanation.predicted.push(predicted);
        }
        moves
    }

    /// Returns how many pixels of the sample nothing has explained yet.
    fn rest(&self) -> usize {
        self.signatures.iter().filter(|of| **of == 0).count()
    }

    /// Returns how many pixels of the sample a variant yields.
    fn hits(&self, variant: Shortcuts) -> usize {
        let number = self.explanation.variants.iter().position(|drawn| *drawn == variant);
        number.map_or(0, |n| self.signatures.iter().filter(|of| *of & OPEN == 0 && *of >> n & 1 != 0).count())
    }

    /// Tries few shortcuts two by two.
    fn pair(&mut self, moving: &[Shortcut]) {
        let few = moving.len().min(if moving.len() > MOST_PAIRED { 0 } else { MOST_PAIRED });
        for (first, second) in (0..few).flat_map(|first| (first + 1..few).map(move |second| (first, second))) {
            if self.rest() < LEAST_REST {
                return;
            }
            self.draw([moving[first], moving[second]].into_iter().collect(), Scope::Unexplained);
        }
    }

    /// Looks for sets of shortcuts that explain what one or two do not. Each begins with one of those that explain the most.
    fn grow(&mut self, moving: &[Shortcut]) {
        let is_known = |variant: &Shortcuts| variant.iter().all(|shortcut| moving.contains(&shortcut));
        let mut starts = self.explanation.variants.clone();
        starts.retain(is_known);
        starts.sort_by_key(|variant| std::cmp::Reverse(self.hits(*variant)));
        for start in starts.into_iter().take(STARTS) {
            self.extend(start, moving);
        }
    }

    /// Adds to a set the shortcut that explains the most of the rest, up to [`MOST_TOGETHER`].
    fn extend(&mut self, mut set: Shortcuts, moving: &[Shortcut]) {
        while set.iter().count() < MOST_TOGETHER {
            let rest = self.rest();
            if rest < LEAST_REST {
                return;
            }
            // A hundredth of the rest is not worth the next round.
            let mut best = (rest / 100, set);
            for shortcut in moving.iter().filter(|shortcut| !set.contains(**shortcut)) {
                let variant = set.with(*shortcut);
                if self.explanation.variants.contains(&variant) {
                    continue;
                }
                self.draw(variant, Scope::Unexplained);
                let found = self.hits(variant);
                if found > best.0 {
                    best = (found, variant);
                }
            }
            if best.1 == set {
                return;
            }
            set = best.1;
        }
    }

    fn finish(mut self) -> Explanation {
        for signature in &self.signatures {
            *self.explanation.signatures.entry(*signature).or_default() += self.weight;
        }
        for at in (0..self.compared.truth.len()).filter(|at| self.compared.wrong[*at]) {
            self.explanation.actual.add(self.compared.truth[at], self.compared.other[at], 1);
        }
        let Counts { compared, wrong, .. } = self.compared.counts;
        self.explanation.actual.add([0; 4], [0; 4], compared - wrong);
        self.explanation
    }
}
