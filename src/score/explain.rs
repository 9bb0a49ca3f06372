//! One frame: what differs, and which variants yield the same.

use std::collections::HashMap;

use ninebit::shortcut::{Shortcut, Shortcuts};
use ninebit_scene::image::Rgba;
use ninebit_vectors::captures;

use crate::chance::Differences;
use crate::subject::Subject;

/// The result of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Every compared pixel is equal in R, G and B.
    Exact,
    /// No channel differs by more than one.
    OffByOne,
    /// Something differs by more.
    Wrong,
    /// There is no picture.
    Missing,
    /// The picture cannot be read, or has another size.
    Unreadable,
}

/// Counts of pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Pixels that are compared.
    pub compared: u64,
    /// Pixels that differ in R, G or B.
    pub wrong: u64,
    /// Of these, those whose largest difference is one.
    pub by_one: u64,
    /// Of these, those with a difference above eight.
    pub far: u64,
}

/// What variants of the model explain of a frame.
#[derive(Clone, Debug, Default)]
pub struct Explained {
    /// The variants that were drawn.
    pub variants: Vec<Shortcuts>,
    /// Number of wrong pixels by the set of variants (bit n for number n) that yield them. Bit 63 marks pixels where the rules themselves do
    /// not yield the chip's.
    pub signatures: HashMap<u64, u64>,
    /// For each variant, how it changes the pixels that it was drawn for, and right ones.
    pub predicted: Vec<Differences>,
    /// How all compared pixels differ.
    pub actual: Differences,
}

/// Marks pixels that the rules do not yield.
pub(crate) const OPEN: u64 = 1 << 63;

/// One of so many right pixels is drawn with each variant: what a variant changes there speaks against it.
const LATTICE: usize = 16;

/// Most variants of a frame.
const MOST_VARIANTS: usize = 63;

/// Most shortcuts that are tried together.
const MOST_TOGETHER: usize = 4;

/// So many unexplained pixels are worth a search for several shortcuts.
const LEAST_REST: usize = 64;

/// The score of a frame.
#[derive(Clone, Debug)]
pub struct FrameScore {
    /// The suite.
    pub suite: String,
    /// The frame.
    pub name: String,
    /// The result.
    pub class: Class,
    /// The counts.
    pub counts: Counts,
    /// What is explained; `None` if the model does not draw the frame, or nothing is wrong.
    pub explained: Option<Explained>,
}

impl FrameScore {
    /// Returns the score of a frame that cannot be compared.
    pub(crate) fn without(subject: &Subject, class: Class) -> FrameScore {
        let (suite, name) = (subject.suite.clone(), subject.name.clone());
        FrameScore { suite, name, class, counts: Counts::default(), explained: None }
    }
}

/// A frame whose pixels have been compared.
struct Compared<'a> {
    truth: &'a [[u8; 4]],
    other: &'a [[u8; 4]],
    /// The wrong pixels.
    wrong: Vec<bool>,
    /// Some of the right pixels.
    right: Vec<usize>,
    counts: Counts,
}

/// Returns whether two pixels are equal in R, G and B.
pub(crate) fn same(a: [u8; 4], b: [u8; 4]) -> bool {
    a[..3] == b[..3]
}

/// Returns which pixels are compared.
fn outside_of_text(subject: &Subject, pixels: usize) -> Vec<bool> {
    let mut outside = vec![true; pixels];
    for at in subject.text.iter().flat_map(captures::pixels) {
        if let Some(outside) = outside.get_mut(at) {
            *outside = false;
        }
    }
    outside
}

/// Returns which compared pixels of pictures of one size differ.
pub(crate) fn differing(subject: &Subject, truth: &Rgba, other: &Rgba) -> Vec<bool> {
    compare(subject, truth, other).wrong
}

fn compare<'a>(subject: &Subject, truth: &'a Rgba, other: &'a Rgba) -> Compared<'a> {
    let mut outside = outside_of_text(subject, truth.pixels().len());
    let (truth, other) = (truth.pixels(), other.pixels());
    let mut counts =
        Counts { compared: outside.iter().filter(|outside| **outside).count() as u64, ..Counts::default() };
    let mut right = Vec::new();
    for (at, (wrong, (a, b))) in outside.iter_mut().zip(truth.iter().zip(other)).enumerate() {
        if *wrong && same(*a, *b) {
            *wrong = false;
            // Numbers that follow no pattern of pictures.
            if (at.wrapping_mul(0x9e37_79b1) >> 16) % LATTICE == 0 {
                right.push(at);
            }
        }
        if *wrong {
            let largest = (0..3).map(|n| a[n].abs_diff(b[n])).max().unwrap_or(0);
            counts.wrong += 1;
            counts.by_one += u64::from(largest == 1);
            counts.far += u64::from(largest > 8);
        }
    }
    Compared { truth, other, wrong: outside, right, counts }
}

/// Scores the other renderer's picture of a frame against the right one. Without `explain` nothing is drawn.
pub fn score(subject: &Subject, truth: &Rgba, other: &Rgba, explain: bool) -> FrameScore {
    let of = |class, counts, explained| FrameScore {
        suite: subject.suite.clone(),
        name: subject.name.clone(),
        class,
        counts,
        explained,
    };
    if (truth.width(), truth.height()) != (other.width(), other.height()) {
        return of(Class::Unreadable, Counts::default(), None);
    }
    let compared = compare(subject, truth, other);
    let counts = compared.counts;
    let class = match counts {
        Counts { wrong: 0, .. } => Class::Exact,
        Counts { wrong, by_one, .. } if wrong == by_one => Class::OffByOne,
        _ => Class::Wrong,
    };
    let explained = if explain && counts.wrong > 0 { explanation(subject, &compared) } else { None };
    of(class, counts, explained)
}

/// The signatures of wrong pixels while variants are drawn.
struct Search<'a> {
    subject: &'a Subject,
    compared: &'a Compared<'a>,
    /// Pixels that are wrong, and that the rules yield.
    open: Vec<bool>,
    signatures: Vec<u64>,
    explained: Explained,
}

fn explanation(subject: &Subject, compared: &Compared<'_>) -> Option<Explained> {
    let drawing = subject.drawing.as_ref()?;
    let ours = drawing.draw(Shortcuts::NONE, None)?;
    if ours.len() != compared.truth.len() {
        return None;
    }
    let mut open = compared.wrong.clone();
    let mut signatures = vec![0; ours.len()];
    for at in 0..ours.len() {
        if open[at] && !same(ours[at], compared.truth[at]) {
            (open[at], signatures[at]) = (false, OPEN);
        }
    }
    let mut search = Search { subject, compared, open, signatures, explained: Explained::default() };
    let concerning = drawing.shortcuts();
    // Every shortcut alone is drawn at all wrong pixels: one that turns out to be chance must hide none.
    let mut moving = Vec::new();
    for shortcut in concerning.iter() {
        let is_part = Shortcut::PARTS_OF_SHADER.contains(&shortcut);
        if search.draw(Shortcuts::NONE.with(shortcut), Wanted::All) && !is_part {
            moving.push(shortcut);
        }
    }
    search.grow(&moving);
    Some(search.finish())
}

/// The pixels that a variant is drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wanted {
    /// All that are wrong.
    All,
    /// Those that nothing has explained yet.
    Unexplained,
}

impl Search<'_> {
    /// Draws a variant. Returns whether it changes a wrong pixel.
    fn draw(&mut self, variant: Shortcuts, wanted: Wanted) -> bool {
        let number = self.explained.variants.len();
        if number >= MOST_VARIANTS {
            return false;
        }
        let is_wanted = |of: u64| wanted == Wanted::All || of == 0;
        let wanted: Vec<bool> =
            self.open.iter().zip(&self.signatures).map(|(open, of)| *open && is_wanted(*of)).collect();
        if !wanted.contains(&true) {
            return false;
        }
        let mut mask = wanted.clone();
        self.compared.right.iter().for_each(|at| mask[*at] = true);
        let Some(drawn) = self.subject.drawing.as_ref().and_then(|drawing| drawing.draw(variant, Some(&mask))) else {
            return false;
        };
        let (truth, other) = (self.compared.truth, self.compared.other);
        let mut predicted = Differences::default();
        let mut moves = false;
        for at in (0..drawn.len()).filter(|at| wanted[*at]) {
            if !same(drawn[at], truth[at]) {
                moves = true;
                predicted.add(truth[at], drawn[at], 1);
                if same(drawn[at], other[at]) {
                    self.signatures[at] |= 1 << number;
                }
            }
        }
        for at in self.compared.right.iter().filter(|at| !same(drawn[**at], truth[**at])) {
            predicted.add(truth[*at], drawn[*at], LATTICE as u64);
        }
        if moves {
            self.explained.variants.push(variant);
            self.explained.predicted.push(predicted);
        }
        moves
    }

    /// Looks for a set of shortcuts that explains what none explains alone: begins with the one that explains the most, and adds the one that
    /// explains the most of the rest, up to [`MOST_TOGETHER`].
    fn grow(&mut self, moving: &[Shortcut]) {
        let rest = |search: &Search<'_>| {
            search.open.iter().zip(&search.signatures).filter(|(open, of)| **open && **of == 0).count()
        };
        let hits = |search: &Search<'_>, variant: Shortcuts| {
            let number = search.explained.variants.iter().position(|drawn| *drawn == variant);
            number.map_or(0, |n| search.signatures.iter().filter(|of| *of >> n & 1 != 0).count())
        };
        let most = moving.iter().copied().max_by_key(|shortcut| hits(self, Shortcuts::NONE.with(*shortcut)));
        let Some(first) = most else { return };
        let mut set = Shortcuts::NONE.with(first);
        for _ in 1..MOST_TOGETHER {
            let rest = rest(self);
            if rest < LEAST_REST {
                return;
            }
            // A hundredth of the rest is not worth the next round.
            let mut best = (rest / 100, set);
            for shortcut in moving.iter().filter(|shortcut| !set.contains(**shortcut)) {
                let variant = set.with(*shortcut);
                self.draw(variant, Wanted::Unexplained);
                let found = hits(self, variant);
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

    fn finish(mut self) -> Explained {
        let wrong = self.compared.wrong.iter().enumerate().filter(|(_, wrong)| **wrong);
        for (at, _) in wrong {
            *self.explained.signatures.entry(self.signatures[at]).or_default() += 1;
            self.explained.actual.add(self.compared.truth[at], self.compared.other[at], 1);
        }
        let Counts { compared, wrong, .. } = self.compared.counts;
        self.explained.actual.add([0; 4], [0; 4], compared - wrong);
        self.explained
    }
}
