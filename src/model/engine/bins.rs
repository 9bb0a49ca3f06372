//! Cuts the rows of a target into bands, and sorts the triangles of a draw by the bands that they meet.

use crate::raster::assemble::Assembly;
use std::ops::Range;

/// Returns the borders of bands of so many rows: the first row of each band, and the end of the last.
pub(super) fn equal(height: usize, rows: usize) -> Vec<usize> {
    (0..height).step_by(rows).chain([height]).collect()
}

/// Setting up a triangle takes about as long as so many pixels.
const SETUP: u64 = 24;

/// Returns the borders of at most `bands` bands, each of at least `least` rows, on which the triangles of some draws take about the same
/// time. Borders are even, so that quads stay whole.
pub(super) fn balanced<'a>(
    draws: impl Iterator<Item = &'a Assembly>,
    (width, height): (usize, usize),
    bands: usize,
    least: usize,
) -> Vec<usize> {
    // By how much the cost of each row exceeds that of the one above, in 256ths of a pixel.
    let mut changes = vec![0_i64; height + 1];
    for assembly in draws {
        for number in 0..assembly.triangles.len() {
            let (rows, cost) = cost(assembly, number, (width, height));
            changes[rows.start] += cost;
            changes[rows.end] -= cost;
        }
    }
    // The cost of all rows up to each one. An empty row has some cost too, so that such rows are shared.
    let (mut cost, mut total) = (1, 0);
    let totals = changes[..height].iter().map(|change| {
        cost += change;
        total += cost;
        total
    });
    let totals: Vec<i64> = totals.collect();
    let mut borders = vec![0];
    let mut last = 0;
    for band in 1..bands as i64 {
        let part = total / bands as i64 * band;
        let border = totals.partition_point(|total| *total < part).next_multiple_of(2);
        if border >= last + least && border + least <= height {
            borders.push(border);
            last = border;
        }
    }
    borders.push(height);
    borders
}

/// Returns the rows of a triangle within a target, and its cost on each of them, in 256ths of a pixel.
fn cost(assembly: &Assembly, number: usize, (width, height): (usize, usize)) -> (Range<usize>, i64) {
    let [(left, right), (top, bottom)] = [0, 1].map(|axis| assembly.bounds(number, axis));
    let (rows, columns) = (within((top, bottom), height), within((left, right), width));
    if rows.is_empty() || columns.is_empty() {
        return (0..0, 0);
    }
    // About as much of the triangle lies within the target as of its bounding box.
    let (inside, all) = (rows.len() * columns.len(), (bottom - top) * (right - left));
    let pixels = u128::from(assembly.area(number)) * inside as u128 / all as u128;
    let cost = (pixels as u64 + SETUP) * 256 / rows.len() as u64;
    (rows, cost as i64)
}

/// The triangles of a draw that can be seen, in order, for each band in which they may cover pixels.
#[derive(Debug)]
pub(super) struct Bins {
    /// Index of each band's first number, and the end of the last band's.
    starts: Vec<usize>,
    numbers: Vec<u32>,
}

impl Bins {
    /// Sorts the visible triangles into the bands between borders.
    pub(super) fn new(assembly: &Assembly, borders: &[usize], is_visible: impl Fn(usize) -> bool) -> Bins {
        // A draw has 32-bit indices, and three make a triangle.
        let visible: Vec<u32> = (0..assembly.triangles.len() as u32).filter(|n| is_visible(*n as usize)).collect();
        let bands = borders.len() - 1;
        let mut starts = vec![0; bands + 1];
        for number in &visible {
            for band in met(assembly, *number as usize, borders) {
                starts[band + 1] += 1;
            }
        }
        for band in 0..bands {
            starts[band + 1] += starts[band];
        }
        let mut numbers = vec![0; starts[bands]];
        let mut ends = starts.clone();
        for number in visible {
            for band in met(assembly, number as usize, borders) {
                numbers[ends[band]] = number;
                ends[band] += 1;
            }
        }
        Bins { starts, numbers }
    }

    /// Returns the numbers of a band's triangles.
    pub(super) fn triangles_in(&self, band: usize) -> &[u32] {
        &self.numbers[self.starts[band]..self.starts[band + 1]]
    }
}

/// Returns those that lie between 0 and `end`.
pub(super) fn within((first, last): (i64, i64), end: usize) -> Range<usize> {
    first.clamp(0, end as i64) as usize..last.clamp(0, end as i64) as usize
}

/// Returns the bands that a triangle's rows lie in.
fn met(assembly: &Assembly, number: usize, borders: &[usize]) -> Range<usize> {
    let rows = within(assembly.bounds(number, 1), borders.last().copied().unwrap_or(0));
    if rows.is_empty() {
        return 0..0;
    }
    borders.partition_point(|border| *border <= rows.start) - 1..borders.partition_point(|border| *border < rows.end)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::raster::assemble::{Clipping, Corner};
    use crate::raster::setup::centres;
    use crate::raster::triangles::Triangles;
    use crate::state::{Lines, PointRasterization, ProvokingVertex, Topology, Vertices};
    use std::sync::Arc;

    fn triangles(count: u32) -> Assembly {
        let mut sequence = Random::seeded(7);
        let mut random = || sequence.below(4000) as i32 - 1000;
        let corners: Vec<Corner> = (0..3 * count)
            .map(|_| Corner { position: [random(), random() >> (random() & 3)], ..Corner::default() })
            .collect();
        let indices: Arc<[u32]> = (0..3 * count).collect();
        let triangles = Triangles::split(&indices, Topology::Triangles, ProvokingVertex::First);
        let (vertices, clipping, lines) = (Vertices::default(), Clipping::default(), Lines::default());
        Assembly {
            vertices,
            corners,
            triangles,
            clipping,
            smooth_polygons: false,
            lines,
            point_size: 8,
            point_sizes: None,
            point_rasterization: PointRasterization::Rectangular,
            is_far: false,
        }
    }

    /// No band costs more than its part, one row and what makes a border even.
    #[test]
    fn bands_cost_the_same() {
        let assembly = triangles(2_000);
        let size = (150, 188);
        let of_row = |row: usize| {
            let all = (0..2_000).map(|number| cost(&assembly, number, size));
            all.filter(|(rows, _)| rows.contains(&row)).map(|(_, cost)| cost).sum::<i64>()
        };
        let costs: Vec<i64> = (0..188).map(of_row).collect();
        let (total, largest) = (costs.iter().sum::<i64>(), costs.iter().copied().max().unwrap_or(0));
        for bands in [1, 2, 3, 8] {
            let borders = balanced([&assembly].into_iter(), size, bands, 2);
            assert_eq!((borders.len(), borders[0], borders[bands]), (bands + 1, 0, 188));
            for rows in borders.windows(2) {
                assert!(rows[0] < rows[1] && rows[0] % 2 == 0, "{borders:?}");
                let cost = costs[rows[0]..rows[1]].iter().sum::<i64>();
                assert!(cost < total / bands as i64 + 3 * largest, "{borders:?}");
            }
        }
        let lowest = balanced([&assembly].into_iter(), size, 8, 40);
        assert!(lowest.windows(2).all(|rows| rows[1] - rows[0] >= 40), "{lowest:?}");
        assert_eq!(balanced(std::iter::empty(), (64, 48), 3, 2), [0, 16, 32, 48]);
    }

    /// Every visible triangle is in the bins of exactly those bands that one of its rows lies in.
    #[test]
    fn bins_hold_what_meets_their_rows() {
        let assembly = triangles(200);
        for borders in [equal(128, 16), equal(126, 6), equal(200, 200), vec![0, 2, 40, 150]] {
            let bins = Bins::new(&assembly, &borders, |number| number % 5 != 0);
            for band in 0..borders.len() - 1 {
                let rows = (borders[band] as i64, borders[band + 1] as i64);
                let wanted: Vec<u32> = (0..200)
                    .filter(|n| n % 5 != 0)
                    .filter(|n| {
                        let y = [0, 1, 2].map(|k| i64::from(assembly.corners[3 * *n as usize + k].position[1]));
                        let (top, bottom) = centres(y);
                        top.max(rows.0) < bottom.min(rows.1)
                    })
                    .collect();
                assert_eq!(bins.triangles_in(band), wanted, "{borders:?} {band}");
            }
        }
    }
}
