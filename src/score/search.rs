//! The search for shortcuts that yield another renderer's pixels of a frame. It looks at a sample of them.

use std::collections::HashMap;

use ninebit::shortcut::{PixelSelection, Shortcut, Shortcuts};

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

/// So many unexplained pixels of the sample have to be moved by each of two shortcuts before they are tried together.
const LEAST_SHARED: usize = 16;

/// Where one in so many pixels of the sample is left, shortcuts are tried beside others that move no pixel alone.
const MUCH: usize = 4;

/// Returns one of `step` places, in a scatter that follows no pattern of pictures.
pub(crate) fn scattered(places: impl Iterator<Item = usize>, step: u64) -> Vec<usize> {
    let is_taken = |at: &usize| ((*at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32).is_multiple_of(step);
    places.filter(is_taken).collect()
}

/// Returns the places of a set.
fn places(set: &[bool]) -> impl Iterator<Item = usize> {
    (0..set.len()).filter(|at| set[*at])
}

/// Returns what variants yield, or `None` if the model does not draw the frame.
pub(crate) fn explanation(subject: &Subject, compared: &Comparison<'_>) -> Option<Explanation> {
    let renderer = subject.drawing.as_ref()?.renderer()?;
    let ours = renderer.draw(Shortcuts::NONE, None)?;
    if ours.len() != compared.truth.len() {
        return None;
    }
    let weight = compared.counts.wrong.div_ceil(MOST_WRONG).max(1);
    let wrong = scattered(places(&compared.wrong), weight);
    let yields = |at: usize| same(ours[at], compared.truth[at]);
    let signatures = wrong.iter().map(|at| if yields(*at) { 0 } else { OPEN }).collect();
    let right = scattered(places(&compared.right), LATTICE);
    let is_closed = (0..ours.len()).all(|at| !compared.wrong[at] || yields(at));
    let explanation = Explanation { is_closed, ..Explanation::default() };
    let (moved, nearer) = (HashMap::new(), Vec::new());
    let mut search =
        Search { renderer: &*renderer, compared, weight, wrong, right, signatures, moved, nearer, explanation };
    let concerning: Vec<Shortcut> = renderer.shortcuts().iter().collect();
    // Every shortcut alone is drawn at all pixels of the sample: one that turns out to be chance must hide none.
    let mut moving = Vec::new();
    for shortcut in concerning.iter().copied() {
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
    search.grow(&moving, &concerning);
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
    /// For each shortcut alone, which of the wrong pixels it changes.
    moved: HashMap<Shortcut, Vec<bool>>,
    /// For each variant, of how many more pixels that it was drawn for it comes nearer to the other's than it goes away from them.
    nearer: Vec<i64>,
    explanation: Explanation,
}

/// Returns the sum of the differences of R, G and B.
fn distance(a: [u8; 4], b: [u8; 4]) -> u16 {
    (0..3).map(|n| u16::from(a[n].abs_diff(b[n]))).sum()
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
        let mut places: Vec<usize> = wanted.iter().map(|n| self.wrong[*n]).chain(self.right.iter().copied()).collect();
        places.sort_unstable();
        let mask = PixelSelection::new(self.compared.size, places.iter().copied());
        let Some(drawn) = self.renderer.draw(variant, Some(&mask)) else { return false };
        let (truth, other) = (self.compared.truth, self.compared.other);
        let mut predicted = Differences::default();
        let (mut moved, mut nearer) = (vec![false; self.wrong.len()], 0);
        let mut wanted = wanted.into_iter().peekable();
        for (at, drawn) in places.into_iter().zip(drawn) {
            let of_wrong = wanted.next_if(|n| self.wrong[*n] == at);
            if same(drawn, truth[at]) {
                continue;
            }
            predicted.add(truth[at], drawn, if of_wrong.is_some() { self.weight } else { LATTICE });
            let Some(n) = of_wrong else { continue };
            moved[n] = true;
            nearer += (distance(other[at], truth[at]).cmp(&distance(other[at], drawn))) as i64;
            if same(drawn, other[at]) {
                self.signatures[n] |= 1 << number;
            }
        }
        let moves = moved.contains(&true);
        if let (1, Some(shortcut)) = (variant.iter().count(), variant.iter().next()) {
            self.moved.insert(shortcut, moved);
        }
        if moves {
            self.nearer.push(nearer);
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
            let both = [moving[first], moving[second]];
            if self.can_gain(&both) {
                self.draw(both.into_iter().collect(), Scope::Unexplained);
            }
        }
    }

    /// Returns whether there are unexplained pixels that each of the shortcuts changes alone. Beside those that show only in company others may
    /// change more.
    fn can_gain(&self, shortcuts: &[Shortcut]) -> bool {
        if shortcuts.iter().any(|shortcut| IN_COMPANY.contains(shortcut)) {
            return true;
        }
        let moves = |shortcut: &Shortcut, n: usize| self.moved.get(shortcut).is_some_and(|moved| moved[n]);
        let is_open = |n: &usize| self.signatures[*n] == 0 && shortcuts.iter().all(|shortcut| moves(shortcut, *n));
        (0..self.wrong.len()).filter(is_open).nth(LEAST_SHARED - 1).is_some()
    }

    /// Looks for sets of shortcuts that explain what one or two do not. Each begins with one of those that explain the most, and if much is
    /// left with that which brings the most pixels nearer.
    fn grow(&mut self, moving: &[Shortcut], concerning: &[Shortcut]) {
        let is_known = |variant: &Shortcuts| variant.iter().all(|shortcut| moving.contains(&shortcut));
        let all = self.explanation.variants.clone();
        let mut starts: Vec<Shortcuts> = all.iter().copied().filter(is_known).collect();
        starts.sort_by_key(|variant| std::cmp::Reverse(self.hits(*variant)));
        starts.truncate(STARTS);
        for start in starts {
            let is_in_company = start.iter().any(|shortcut| IN_COMPANY.contains(&shortcut));
            let can_gain = |shortcut: &Shortcut| is_in_company || self.can_gain(&[*shortcut]);
            let candidates: Vec<Shortcut> = moving.iter().copied().filter(can_gain).collect();
            self.extend(start, &candidates);
        }
        if self.rest() * MUCH > self.wrong.len()
            && let Some(nearest) = (0..all.len()).max_by_key(|n| self.nearer[*n]).filter(|n| self.nearer[*n] > 0)
        {
            self.extend(all[nearest], concerning);
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
