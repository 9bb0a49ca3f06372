//! Compares two pictures: which pixels differ, where, and by how much.
//!
//! The comparison is exact. A pixel differs if one of its bytes does. Differences are signed, second picture minus first, in steps of
//! 1/255. Differing pixels that touch, even at corners, form a [`Region`].

mod histogram;
mod picture;
mod region;
mod words;

pub use histogram::ranges;
pub use histogram::{Bucket, Histogram};
pub use picture::{DifferencePicture, highlight};
pub use region::Region;
pub use words::{CHANNELS, histogram_text, pixels, share};

use crate::image::Rgba;
use region::Regions;

/// Options of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Whether differences of alpha are ignored: screenshots often have no alpha.
    pub ignore_alpha: bool,
    /// Number of regions to keep; the largest ones are kept.
    pub regions: usize,
}

impl Default for Options {
    fn default() -> Self {
        Options { ignore_alpha: false, regions: 8 }
    }
}

/// Result of a comparison.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Number of columns of both pictures.
    pub width: u32,
    /// Number of rows of both pictures.
    pub height: u32,
    /// Number of pixels that differ.
    pub different: u64,
    /// Signed differences of R, G, B and A. Alpha's histogram is empty if alpha is ignored.
    pub channels: [Histogram; 4],
    /// The largest regions, the largest first; regions of equal size are in reading order.
    pub regions: Vec<Region>,
    /// Number of all regions, including those that were not kept.
    pub region_count: u64,
}

impl Difference {
    /// Returns the number of pixels of each picture.
    pub fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Returns the largest absolute difference of any channel.
    pub fn largest(&self) -> u8 {
        self.channels.iter().map(Histogram::largest).max().unwrap_or(0)
    }
}

/// The error that two pictures differ in size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("pictures of {} x {} and {} x {} cannot be compared", first.0, first.1, second.0, second.1)]
pub struct SizeError {
    /// Columns and rows of the first picture.
    pub(crate) first: (u32, u32),
    /// Columns and rows of the second picture.
    pub(crate) second: (u32, u32),
}

/// Compares two pictures of the same size.
///
/// Takes time linear in the number of pixels, and memory that depends only on the width of the pictures.
///
/// # Errors
/// The sizes differ.
pub fn compare(a: &Rgba, b: &Rgba, options: &Options) -> Result<Difference, SizeError> {
    same_size(a, b)?;
    let mut channels: [Histogram; 4] = Default::default();
    let mut regions = Regions::new(options.regions);
    let width = (a.width as usize).max(1);
    for (y, (row_a, row_b)) in (0_u32..).zip(a.pixels.chunks(width).zip(b.pixels.chunks(width))) {
        if row_a != row_b {
            for (x, (pixel_a, pixel_b)) in (0_u32..).zip(row_a.iter().zip(row_b)) {
                let steps = steps(*pixel_a, *pixel_b, options.ignore_alpha);
                if steps != [0; 4] {
                    for (histogram, step) in channels.iter_mut().zip(steps) {
                        histogram.add(step);
                    }
                    regions.pixel(x, y, steps.map(largest));
                }
            }
        }
        regions.end_row();
    }
    let found = regions.finish();
    Ok(Difference {
        width: a.width,
        height: a.height,
        different: found.pixels,
        channels,
        regions: found.kept,
        region_count: found.count,
    })
}

/// Returns the number of pixels that differ.
///
/// # Errors
/// The sizes differ.
pub fn count(a: &Rgba, b: &Rgba, ignore_alpha: bool) -> Result<u64, SizeError> {
    same_size(a, b)?;
    let differs = |(a, b): &(&[u8; 4], &[u8; 4])| steps(**a, **b, ignore_alpha) != [0; 4];
    Ok(a.pixels.iter().zip(&b.pixels).filter(differs).count() as u64)
}

fn same_size(a: &Rgba, b: &Rgba) -> Result<(), SizeError> {
    let (first, second) = ((a.width, a.height), (b.width, b.height));
    if first == second { Ok(()) } else { Err(SizeError { first, second }) }
}

/// Returns the differences of R, G, B and A, second pixel minus first.
fn steps(a: [u8; 4], b: [u8; 4], ignore_alpha: bool) -> [i16; 4] {
    let mut steps = [0, 1, 2, 3].map(|n| i16::from(b[n]) - i16::from(a[n]));
    if ignore_alpha {
        steps[3] = 0;
    }
    steps
}

/// Returns the absolute value of a difference.
fn largest(step: i16) -> u8 {
    step.unsigned_abs().min(255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(rows: &[&str]) -> Rgba {
        let level = |c: char| c.to_digit(10).unwrap_or(0) as u8;
        let pixels: Vec<[u8; 4]> = rows.concat().chars().map(|c| [level(c), 0, 0, 255]).collect();
        Rgba { width: rows[0].len() as u32, height: rows.len() as u32, pixels }
    }

    fn black(of: &Rgba) -> Rgba {
        Rgba { pixels: vec![[0, 0, 0, 255]; of.pixels.len()], ..of.clone() }
    }

    #[test]
    fn corners_connect() {
        let b = picture(&["1...2", ".1.2.", "..1.."]);
        let found = compare(&black(&b), &b, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((found.different, found.region_count), (5, 1));
        let region = Region { x: 0, y: 0, width: 5, height: 3, pixels: 5, first: (0, 0), largest: [2, 0, 0, 0] };
        assert_eq!(found.regions, [region]);
    }

    #[test]
    fn regions_are_sorted_by_size_then_by_place() {
        let b = picture(&["1..1..9", "......9", "1.....9"]);
        let options = Options { regions: 2, ..Options::default() };
        let found = compare(&black(&b), &b, &options).unwrap_or_else(|e| panic!("{e}"));
        let firsts: Vec<_> = found.regions.iter().map(|region| (region.first, region.pixels)).collect();
        assert_eq!((found.region_count, firsts), (4, vec![((6, 0), 3), ((0, 0), 1)]));
    }

    /// A spiral and a comb: shapes whose arms meet late.
    #[test]
    fn winding_shapes_are_one_region() {
        let spiral = picture(&["11111.", ".....1", ".11..1", "1..1.1", "1....1", ".1111."]);
        let comb = picture(&["1.1.1.1", "1.1.1.1", "1111111"]);
        for (b, regions) in [(spiral, 1), (comb, 1)] {
            let found = compare(&black(&b), &b, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!((found.region_count, found.regions[0].pixels), (regions, found.different));
        }
    }

    #[test]
    fn alpha_counts_unless_it_does_not() {
        let a = Rgba { width: 2, height: 1, pixels: vec![[1, 2, 3, 4], [5, 6, 7, 8]] };
        let b = Rgba { pixels: vec![[1, 2, 3, 255], [5, 6, 9, 8]], ..a.clone() };
        let found = |ignore_alpha| {
            let options = Options { ignore_alpha, ..Options::default() };
            compare(&a, &b, &options).unwrap_or_else(|e| panic!("{e}"))
        };
        assert_eq!((found(false).different, found(false).largest()), (2, 251));
        assert_eq!((found(true).different, found(true).largest(), count(&a, &b, true)), (1, 2, Ok(1)));
    }

    #[test]
    fn sizes_must_agree() {
        let a = Rgba { width: 2, height: 1, pixels: vec![[0; 4]; 2] };
        let b = Rgba { width: 1, height: 2, pixels: vec![[0; 4]; 2] };
        assert_eq!(compare(&a, &b, &Options::default()), Err(SizeError { first: (2, 1), second: (1, 2) }));
    }
}
