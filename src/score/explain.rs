//! One frame: what differs.

use ninebit_scene::image::Rgba;

use crate::search::{self, Explanation};
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
    /// What variants of the model yield; `None` if the model does not draw the frame, or nothing is wrong.
    pub explanation: Option<Explanation>,
    /// The pixels of each cause, once causes are chosen: its number, and how many.
    pub attributed: Vec<(usize, u64)>,
}

impl FrameScore {
    /// Returns the score of a frame that cannot be compared.
    pub(crate) fn without(subject: &Subject, class: Class) -> FrameScore {
        let (suite, name) = (subject.suite.clone(), subject.name.clone());
        FrameScore { suite, name, class, counts: Counts::default(), explanation: None, attributed: Vec::new() }
    }

    /// Returns the number of explained pixels.
    pub fn explained(&self) -> u64 {
        self.attributed.iter().map(|(_, pixels)| pixels).sum()
    }
}

/// A frame whose pixels have been compared.
pub(crate) struct Comparison<'a> {
    /// Width and height.
    pub(crate) size: (u32, u32),
    pub(crate) truth: &'a [[u8; 4]],
    pub(crate) other: &'a [[u8; 4]],
    /// The wrong pixels.
    pub(crate) wrong: Vec<bool>,
    /// The right pixels that are compared.
    pub(crate) right: Vec<bool>,
    pub(crate) counts: Counts,
}

/// Returns whether two pixels are equal in R, G and B.
pub(crate) fn same(a: [u8; 4], b: [u8; 4]) -> bool {
    a[..3] == b[..3]
}

/// Returns which pixels are compared.
fn outside_of_text(subject: &Subject, pixels: usize) -> Vec<bool> {
    let mut outside = vec![true; pixels];
    for at in subject.text.iter().flat_map(ninebit_captures::pixels) {
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

fn compare<'a>(subject: &Subject, truth: &'a Rgba, other: &'a Rgba) -> Comparison<'a> {
    let mut wrong = outside_of_text(subject, truth.pixels().len());
    let mut right = wrong.clone();
    let size = (truth.width(), truth.height());
    let (truth, other) = (truth.pixels(), other.pixels());
    let mut counts = Counts { compared: wrong.iter().filter(|outside| **outside).count() as u64, ..Counts::default() };
    for (at, (a, b)) in truth.iter().zip(other).enumerate() {
        wrong[at] &= !same(*a, *b);
        right[at] &= !wrong[at];
        if wrong[at] {
            let largest = (0..3).map(|n| a[n].abs_diff(b[n])).max().unwrap_or(0);
            counts.wrong += 1;
            counts.by_one += u64::from(largest == 1);
            counts.far += u64::from(largest > 8);
        }
    }
    Comparison { size, truth, other, wrong, right, counts }
}

/// Scores the other renderer's picture of a frame against the right one. Without `explain` nothing is drawn.
pub fn score(subject: &Subject, truth: &Rgba, other: &Rgba, explain: bool) -> FrameScore {
    let of = |class, counts, explanation| FrameScore { counts, explanation, ..FrameScore::without(subject, class) };
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
    let explanation = if explain && counts.wrong > 0 { search::explanation(subject, &compared) } else { None };
    of(class, counts, explanation)
}
