//! Pictures of a frame: what differs, and which cause yields it.

use std::collections::BTreeMap;

use ninebit::shortcut::{PixelSelection, Shortcuts};
use ninebit_scene::image::Rgba;

use crate::explain::{differing, same};
use crate::search::{Explanation, scattered};
use crate::subject::Subject;

/// Colours of causes, which are told apart on light and dark ground.
pub const COLORS: [[u8; 3]; 12] = [
    [230, 159, 0],
    [86, 180, 233],
    [0, 158, 115],
    [240, 228, 66],
    [0, 114, 178],
    [213, 94, 0],
    [204, 121, 167],
    [153, 102, 51],
    [136, 204, 0],
    [170, 102, 255],
    [102, 204, 204],
    [255, 153, 153],
];

/// Colour of pixels that nothing explains.
const UNEXPLAINED: [u8; 3] = [255, 255, 255];

/// Colour of pixels that are right.
const RIGHT: [u8; 3] = [24, 26, 30];

/// A wrong pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// Column and row.
    pub at: (u32, u32),
    /// The chip's pixel.
    pub truth: [u8; 4],
    /// The other renderer's.
    pub other: [u8; 4],
}

impl Sample {
    /// Returns the largest difference of a channel.
    pub(crate) fn size(&self) -> u8 {
        (0..3).map(|n| self.truth[n].abs_diff(self.other[n])).max().unwrap_or(0)
    }
}

/// The causes of a frame's wrong pixels.
#[derive(Clone, Debug)]
pub(crate) struct CauseMap {
    size: (u32, u32),
    /// For each pixel, `None` if it is right, otherwise the number of its cause, or `None` if it has none.
    of: Vec<Option<Option<usize>>>,
    /// Of each cause that yields pixels, how many, and the first of those that differ the most.
    pub(crate) found: BTreeMap<usize, (u64, Sample)>,
    /// Number of wrong pixels where the rules do not yield the chip's bytes.
    pub(crate) open: u64,
}

/// So many pixels tell whether a variant yields any of a frame, before it is drawn for all.
const PROBE: usize = 256;

impl CauseMap {
    /// Attributes each wrong pixel to the first of `variants`, which have the numbers of causes, that yields it.
    pub(crate) fn new(
        subject: &Subject,
        (truth, other): (&Rgba, &Rgba),
        explanation: Option<&Explanation>,
        variants: &[(usize, Shortcuts)],
    ) -> CauseMap {
        let (wrong, size) = (differing(subject, truth, other), (truth.width(), truth.height()));
        let of = wrong.iter().map(|wrong| wrong.then_some(None)).collect();
        let mut map = CauseMap { size, of, found: BTreeMap::new(), open: 0 };
        let renderer = subject.drawing.as_ref().and_then(|drawing| drawing.renderer());
        let (Some(explanation), Some(renderer)) = (explanation, renderer) else { return map };
        let mut left: Vec<usize> = (0..wrong.len()).filter(|at| wrong[*at]).collect();
        if !explanation.is_closed {
            let ours = renderer.draw(Shortcuts::NONE, None).unwrap_or_default();
            let before = left.len();
            left.retain(|at| ours.get(*at).is_some_and(|pixel| same(*pixel, truth.pixels()[*at])));
            map.open = (before - left.len()) as u64;
        }
        for (number, variant) in variants.iter().filter(|(_, variant)| explanation.admits(*variant)) {
            map.attribute(*number, (truth.pixels(), other.pixels()), &mut left, |mask| {
                renderer.draw(*variant, Some(mask))
            });
        }
        map
    }

    /// Attributes those of the pixels that are left to a cause that `draw` yields.
    fn attribute(
        &mut self,
        number: usize,
        (truth, other): (&[[u8; 4]], &[[u8; 4]]),
        left: &mut Vec<usize>,
        draw: impl Fn(&PixelSelection) -> Option<Vec<[u8; 4]>>,
    ) {
        let drawn =
            |places: &[usize]| draw(&PixelSelection::new(self.size, places.iter().copied())).unwrap_or_default();
        if left.len() > 8 * PROBE {
            let probe: Vec<usize> = scattered(left.iter().copied(), (left.len() / PROBE) as u64);
            if !probe.iter().zip(drawn(&probe)).any(|(at, drawn)| same(drawn, other[*at])) {
                return;
            }
        }
        if left.is_empty() {
            return;
        }
        let mut found: Option<(u64, Sample)> = None;
        let mut rest = Vec::new();
        let pixels = drawn(left);
        for (at, drawn) in std::mem::take(left).into_iter().zip(pixels) {
            if !same(drawn, other[at]) {
                rest.push(at);
                continue;
            }
            self.of[at] = Some(Some(number));
            let place = (at as u32 % self.size.0, at as u32 / self.size.0);
            let sample = Sample { at: place, truth: truth[at], other: other[at] };
            let (pixels, shown) = found.get_or_insert((0, sample));
            *pixels += 1;
            if sample.size() > shown.size() {
                *shown = sample;
            }
        }
        *left = rest;
        self.found.extend(found.map(|found| (number, found)));
    }

    /// Returns the picture: a colour for each cause, white where nothing explains.
    pub(crate) fn picture(&self, color: impl Fn(usize) -> [u8; 3]) -> Rgba {
        let shown = |of: &Option<Option<usize>>| match of {
            None => RIGHT,
            Some(None) => UNEXPLAINED,
            Some(Some(number)) => color(*number),
        };
        let opaque = |[r, g, b]: [u8; 3]| [r, g, b, 255];
        Rgba::new(self.size.0, self.of.iter().map(|of| opaque(shown(of))).collect())
    }
}

/// What a difference of one step looks like, to be seen at all.
const FAINTEST: u8 = 64;

/// Returns the difference between two pictures: each channel's, eight times, on black; areas that are not compared are black.
pub(crate) fn difference(subject: &Subject, truth: &Rgba, other: &Rgba) -> Rgba {
    let wrong = differing(subject, truth, other);
    let shown = |((a, b), wrong): ((&[u8; 4], &[u8; 4]), &bool)| {
        let channel = |n: usize| match a[n].abs_diff(b[n]) {
            step if *wrong && step > 0 => step.saturating_mul(8).max(FAINTEST),
            _ => 0,
        };
        [channel(0), channel(1), channel(2), 255]
    };
    Rgba::new(truth.width(), truth.pixels().iter().zip(other.pixels()).zip(&wrong).map(shown).collect())
}
