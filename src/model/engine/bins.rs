//! Sorts the triangles of a draw by the bands of rows that they meet.

use crate::raster::assemble::Assembly;
use crate::raster::setup::centres;
use std::ops::Range;

/// The triangles of a draw, in order, for each band in which they may cover pixels.
#[derive(Debug)]
pub(super) struct Bins {
    /// Index of each band's first number, and the end of the last band's.
    starts: Vec<usize>,
    numbers: Vec<u32>,
}

impl Bins {
    /// Sorts triangles into `bands` bands of `height` rows.
    pub(super) fn new(assembly: &Assembly, height: usize, bands: usize) -> Bins {
        let count = assembly.triangles.len();
        let mut starts = vec![0; bands + 1];
        for number in 0..count {
            for band in met(assembly, number, height, bands) {
                starts[band + 1] += 1;
            }
        }
        for band in 0..bands {
            starts[band + 1] += starts[band];
        }
        let mut numbers = vec![0; starts[bands]];
        let mut ends = starts.clone();
        for number in 0..count {
            for band in met(assembly, number, height, bands) {
                // A draw has 32-bit indices, and three make a triangle.
                numbers[ends[band]] = number as u32;
                ends[band] += 1;
            }
        }
        Bins { starts, numbers }
    }

    /// Returns the numbers of a band's triangles.
    pub(super) fn of(&self, band: usize) -> &[u32] {
        &self.numbers[self.starts[band]..self.starts[band + 1]]
    }
}

/// Returns the bands that a triangle's rows lie in.
fn met(assembly: &Assembly, number: usize, height: usize, bands: usize) -> Range<usize> {
    let y = assembly.triangles.vertices(number).map(|v| i64::from(assembly.corners[v as usize].position[1]));
    let (top, bottom) = centres(y);
    let end = (height * bands) as i64;
    let (top, bottom) = (top.clamp(0, end) as usize, bottom.clamp(0, end) as usize);
    if top < bottom { top / height..bottom.div_ceil(height) } else { 0..0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::raster::assemble::{Clipping, Corner};
    use crate::raster::triangles::Triangles;
    use crate::state::{ProvokingVertex, Topology, Vertices};
    use std::sync::Arc;

    /// Every triangle is in the bins of exactly those bands that one of its rows lies in.
    #[test]
    fn bins_hold_what_meets_their_rows() {
        let mut sequence = Random::seeded(7);
        let mut random = || sequence.below(4000) as i32 - 1000;
        let corners: Vec<Corner> = (0..600)
            .map(|_| Corner { position: [random(), random() >> (random() & 3)], ..Corner::default() })
            .collect();
        let indices: Arc<[u32]> = (0..600).collect();
        let triangles = Triangles::split(&indices, Topology::Triangles, ProvokingVertex::First);
        let assembly = Assembly { vertices: Vertices::default(), corners, triangles, clipping: Clipping::default() };
        for (height, bands) in [(16, 8), (6, 21), (200, 1)] {
            let bins = Bins::new(&assembly, height, bands);
            for band in 0..bands {
                let rows = ((band * height) as i64, ((band + 1) * height) as i64);
                let wanted: Vec<u32> = (0..200)
                    .filter(|n| {
                        let y = [0, 1, 2].map(|k| i64::from(assembly.corners[3 * *n as usize + k].position[1]));
                        let (top, bottom) = centres(y);
                        top.max(rows.0) < bottom.min(rows.1)
                    })
                    .collect();
                assert_eq!(bins.of(band), wanted, "{height} {band}");
            }
        }
    }
}
