//! Two pictures held against each other: which pixels differ, where, and by how much.
//!
//! The comparison is exact. A pixel differs when one of its bytes does; differences are signed, second picture less first, in steps of
//! 1/255. Differing pixels that touch, corners included, form a [`Region`].

mod histogram;
mod picture;
mod region;
mod words;

pub use histogram::ranges;
pub use histogram::{Bucket, Histogram};
pub use picture::{Highlighted, highlight};
pub use region::Region;
pub use words::{CHANNELS, histogram_text, pixels, share};

use crate::image::Rgba;
use region::Regions;

/// How to compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Alpha does not count: screenshots often have none.
    pub ignore_alpha: bool,
    /// The most regions that are kept, the largest ones.
    pub regions: usize,
}

impl Default for Options {
    fn default() -> Self {
        Options { ignore_alpha: false, regions: 8 }
    }
}

/// What two pictures differ in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Columns of both.
    pub width: u32,
    /// Rows of both.
    pub height: u32,
    /// Pixels that differ.
    pub different: u64,
    /// The signed differences of R, G, B, A. Alpha's is empty if it does not count.
    pub channels: [Histogram; 4],
    /// The largest regions, largest first; of equal ones, the first in reading order.
    pub regions: Vec<Region>,
    /// All regions, kept or not.
    pub region_count: u64,
}

impl Difference {
    /// Pixels of each picture.
    pub fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// The largest difference of any channel, without its sign.
    pub fn largest(&self) -> u8 {
        self.channels.iter().map(Histogram::largest).max().unwrap_or(0)
    }
}

/// Pictures that cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("pictures of {} x {} and {} x {} cannot be compared", first.0, first.1, second.0, second.1)]
pub struct SizeError {
    /// Columns and rows of the first.
    pub first: (u32, u32),
    /// Columns and rows of the second.
    pub second: (u32, u32),
}

/// Compares two pictures of the same size.
///
/// The time is linear in the pixels; the memory besides the pictures depends on their width only.
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

/// Counts the pixels that differ, and nothing else.
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

/// Second less first, R, G, B, A.
fn steps(a: [u8; 4], b: [u8; 4], ignore_alpha: bool) -> [i16; 4] {
    let mut steps = [0, 1, 2, 3].map(|n| i16::from(b[n]) - i16::from(a[n]));
    if ignore_alpha {
        steps[3] = 0;
    }
    steps
}

/// A difference without its sign.
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
