//! Banding: the number of different levels in a highlight.

use std::collections::HashSet;

use ninebit_scene::generate::byte;
use ninebit_scene::truth::TruthFrame;

/// Banding of the highlight, which consists of the pixels whose truth is at least half of the brightest one. It is counted in the channel that is
/// brightest there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Banding {
    /// Number of pixels in the highlight.
    pub pixels: u64,
    /// Number of different bytes in the picture's highlight.
    pub levels: u64,
    /// Number of different bytes in the highlight of the rounded truth.
    pub truth_levels: u64,
    /// Longest run of pixels in a row that have the same byte.
    pub flat_run: u64,
    /// Longest such run of the rounded truth.
    pub truth_flat_run: u64,
}

impl Banding {
    /// Computes the banding of the measured pixels, whose indices are in ascending order.
    pub(super) fn from_pixels(truth: &TruthFrame, shown: &[[u8; 4]], measured: &[usize]) -> Banding {
        let value = |at: usize, channel: usize| truth.pixels[at].as_ref().map_or(0.0, |pixel| pixel.color[channel]);
        let brightest = |channel: usize| measured.iter().map(|at| value(*at, channel)).fold(0.0, f64::max);
        let channel = (0..3).rev().max_by(|a, b| brightest(*a).total_cmp(&brightest(*b))).unwrap_or(0);
        let half = 0.5 * brightest(channel);
        let highlight: Vec<usize> = measured.iter().copied().filter(|at| value(*at, channel) >= half).collect();
        let width = truth.width as usize;
        let rounded = |at: usize| byte(value(at, channel));
        let (levels, flat_run) = bands(&highlight, width, |at| shown[at][channel]);
        let (truth_levels, truth_flat_run) = bands(&highlight, width, rounded);
        Banding { pixels: highlight.len() as u64, levels, truth_levels, flat_run, truth_flat_run }
    }
}

/// Returns the number of different bytes, and the length of the longest run of one byte.
fn bands(pixels: &[usize], width: usize, byte: impl Fn(usize) -> u8) -> (u64, u64) {
    let (mut levels, mut longest, mut run) = (HashSet::new(), 0, 0);
    let mut before: Option<usize> = None;
    for at in pixels.iter().copied() {
        levels.insert(byte(at));
        let beside = before.is_some_and(|before| before + 1 == at && at % width != 0 && byte(before) == byte(at));
        run = if beside { run + 1 } else { 1 };
        longest = longest.max(run);
        before = Some(at);
    }
    (levels.len() as u64, longest)
}

#[cfg(test)]
mod tests {
    use super::bands;

    #[test]
    fn runs_end_where_the_byte_changes_at_gaps_and_at_the_end_of_a_row() {
        let bytes = [5, 5, 5, 6, 6, 7, 7, 7];
        assert_eq!(bands(&[0, 1, 2, 3, 4, 5, 6, 7], 8, |at| bytes[at]), (3, 3));
        assert_eq!(bands(&[0, 1, 2, 3, 4, 5, 6, 7], 2, |at| bytes[at]), (3, 2));
        assert_eq!(bands(&[0, 2, 5, 7], 8, |at| bytes[at]), (2, 1));
        assert_eq!(bands(&[], 8, |_| 0), (0, 0));
    }
}
