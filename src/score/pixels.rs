//! Pictures of a frame: what differs, and which cause yields it.

use ninebit::shortcut::Shortcuts;
use ninebit_scene::image::Rgba;

use crate::explain::{differing, same};
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

/// The causes of a frame's wrong pixels.
#[derive(Clone, Debug)]
pub(crate) struct CauseMap {
    width: u32,
    /// For each pixel, `None` if it is right, otherwise the number of its cause, or `None` if it has none.
    of: Vec<Option<Option<usize>>>,
    /// For each cause, the first pixel that it explains and that differs the most.
    pub(crate) samples: Vec<Option<Sample>>,
}

impl CauseMap {
    /// Attributes each wrong pixel to the first of `variants` that yields it.
    pub(crate) fn new(subject: &Subject, truth: &Rgba, other: &Rgba, variants: &[Shortcuts]) -> CauseMap {
        let (wrong, width) = (differing(subject, truth, other), truth.width());
        let mut of: Vec<Option<Option<usize>>> = wrong.iter().map(|wrong| wrong.then_some(None)).collect();
        let mut samples = vec![None; variants.len()];
        let drawing = subject.drawing.as_ref();
        let concerning = drawing.map_or(Shortcuts::NONE, |drawing| drawing.shortcuts());
        let ours = drawing.and_then(|drawing| drawing.draw(Shortcuts::NONE, None)).unwrap_or_default();
        let (truth, other) = (truth.pixels(), other.pixels());
        for (number, variant) in variants.iter().enumerate() {
            if !variant.iter().all(|shortcut| concerning.contains(shortcut)) {
                continue;
            }
            let open = |at: usize| of[at] == Some(None) && ours.get(at).is_some_and(|pixel| same(*pixel, truth[at]));
            let mask: Vec<bool> = (0..of.len()).map(open).collect();
            if !mask.contains(&true) {
                continue;
            }
            let drawn = drawing.and_then(|drawing| drawing.draw(*variant, Some(&mask))).unwrap_or_default();
            let mut largest = 0;
            for at in (0..drawn.len()).filter(|at| mask[*at] && same(drawn[*at], other[*at])) {
                of[at] = Some(Some(number));
                let size = (0..3).map(|n| truth[at][n].abs_diff(other[at][n])).max().unwrap_or(0);
                if size > largest {
                    largest = size;
                    let place = (at as u32 % width, at as u32 / width);
                    samples[number] = Some(Sample { at: place, truth: truth[at], other: other[at] });
                }
            }
        }
        CauseMap { width, of, samples }
    }

    /// Returns the picture: a colour for each cause, white where nothing explains.
    pub(crate) fn picture(&self, color: impl Fn(usize) -> [u8; 3]) -> Rgba {
        let shown = |of: &Option<Option<usize>>| match of {
            None => RIGHT,
            Some(None) => UNEXPLAINED,
            Some(Some(number)) => color(*number),
        };
        let opaque = |[r, g, b]: [u8; 3]| [r, g, b, 255];
        Rgba::new(self.width, self.of.iter().map(|of| opaque(shown(of))).collect())
    }
}

/// Returns the difference between two pictures: each channel's, eight times, on black; areas that are not compared are black.
pub(crate) fn difference(subject: &Subject, truth: &Rgba, other: &Rgba) -> Rgba {
    let wrong = differing(subject, truth, other);
    let shown = |((a, b), wrong): ((&[u8; 4], &[u8; 4]), &bool)| {
        let channel = |n: usize| if *wrong { a[n].abs_diff(b[n]).saturating_mul(8) } else { 0 };
        [channel(0), channel(1), channel(2), 255]
    };
    Rgba::new(truth.width(), truth.pixels().iter().zip(other.pixels()).zip(&wrong).map(shown).collect())
}
