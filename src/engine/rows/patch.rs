//! RAS-3 for small triangles: all pixels of one at once, instead of row by row.

use super::kernels::STEP;
use crate::raster::setup::Triangle;

/// Most columns and rows of the box of a small triangle. It covers half of the box and its diagonal: a block holds it.
pub(super) const SIDE: i64 = 16;

/// Most pixels of a small triangle, and what whole steps write past them.
const MOST: usize = (SIDE * SIDE / 2 + SIDE) as usize + 2 * STEP;

/// Whether a triangle is handled as one piece instead of row by row.
#[inline(always)]
pub(super) fn is_small(triangle: &Triangle) -> bool {
    triangle.rows.1 - triangle.rows.0 <= SIDE && triangle.columns.1 - triangle.columns.0 <= SIDE
}

/// The pixels of a small triangle.
#[derive(Debug)]
pub(super) struct Patch {
    /// Column and row of the first pixel.
    pub(super) first: (i64, i64),
    /// Where the others lie from it; past the end the last one again.
    pub(super) x: [i32; MOST],
    pub(super) y: [i32; MOST],
    pub(super) count: usize,
    /// Row, first column and number of the pixels of each row.
    pub(super) runs: [(i64, i64, usize); SIDE as usize],
    pub(super) filled: usize,
}

impl Default for Patch {
    fn default() -> Self {
        Patch { first: (0, 0), x: [0; MOST], y: [0; MOST], count: 0, runs: [(0, 0, 0); SIDE as usize], filled: 0 }
    }
}

impl Patch {
    /// RAS-3 for a box of pixels, a row at a time. Edge functions of small triangles fit in 32 bits.
    #[inline(always)]
    pub(super) fn cover(&mut self, triangle: &Triangle, rows: (i64, i64), columns: (i64, i64)) {
        (self.count, self.filled) = (0, 0);
        let left = triangle.columns.0;
        let (low, high) = ((columns.0 - left).clamp(0, SIDE), (columns.1 - left).clamp(0, SIDE));
        let visible = ((1_u32 << high) - 1) & !((1_u32 << low) - 1);
        let a = [triangle.a[0] as i32, triangle.a[1] as i32, triangle.a[2] as i32];
        let b = [triangle.b[0] as i32, triangle.b[1] as i32, triangle.b[2] as i32];
        let e = triangle.edges(left, rows.0);
        // Not negative inside: one less where a sample on the edge is another triangle's.
        let owed = |k: usize| i32::from(!triangle.owns[k]);
        let mut e = [e[0] as i32 - owed(0), e[1] as i32 - owed(1), e[2] as i32 - owed(2)];
        for j in rows.0..rows.1 {
            let mut inside = 0;
            for n in 0..SIDE as i32 {
                let outside = (e[0] + a[0] * n) | (e[1] + a[1] * n) | (e[2] + a[2] * n);
                inside |= u32::from(outside >= 0) << n;
            }
            e = [e[0] + b[0], e[1] + b[1], e[2] + b[2]];
            inside &= visible;
            if inside == 0 {
                continue;
            }
            let (start, count) = (left + i64::from(inside.trailing_zeros()), inside.count_ones() as usize);
            if self.count == 0 {
                self.first = (start, j);
            }
            let (x, y) = ((start - self.first.0) as i32, (j - self.first.1) as i32);
            let lanes = self.count..self.count + STEP;
            for (n, (to_x, to_y)) in self.x[lanes.clone()].iter_mut().zip(&mut self.y[lanes]).enumerate() {
                (*to_x, *to_y) = (x + n as i32, y);
            }
            self.runs[self.filled] = (j, start, count);
            self.filled += 1;
            self.count += count;
        }
        if let Some(last) = self.count.checked_sub(1) {
            let (x, y) = (self.x[last], self.y[last]);
            self.x[self.count..][..STEP].fill(x);
            self.y[self.count..][..STEP].fill(y);
        }
    }
}
