//! RAS-3, LIN-1 and LIN-2: the columns that a triangle or a line covers, several rows at a time.
//!
//! ```text
//! inside where  a x + r >= 0,  r = b y + c, all whole      a triangle owes 1 on edges that are not its own
//! a > 0:  from column -floor((r + 1/2) / a) on      a < 0:  up to column floor((r + 1/2) / -a)
//! ```
//!
//! The half keeps quotients at least 1/2a away from whole numbers. a is below 2^22, and columns that can be drawn are below 2^13, so that
//! doubles yield every floor that counts.
#![allow(clippy::float_arithmetic, reason = "quotients that are further from whole numbers than doubles round")]

use crate::engine::rows::lanes::{larger, nearest, smaller};
use crate::raster::setup::Triangle;
use crate::raster::stroke::Figure;

/// Number of rows whose spans are found at a time.
pub(crate) const ROWS: usize = 16;

/// The first column that a triangle covers in each of some rows, and the column after the last.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spans {
    pub(crate) first: [i32; ROWS],
    pub(crate) end: [i32; ROWS],
}

/// A limit beyond all quotients.
const BEYOND: f64 = (1_u64 << 60) as f64;

/// Finds the columns that a figure covers in the rows from `top` on, between two columns within its box.
#[inline(always)]
pub(crate) fn find_spans<const FMA: bool>(figure: &Triangle, top: i64, columns: (i64, i64)) -> Spans {
    // Written out, because `map` on arrays is not always inlined.
    let limit = |[a, b, c]: [i64; 3]| [a as f64, b as f64, c as f64];
    match figure.figure {
        Figure::Triangle => {
            let edge = |k: usize| limit([figure.a[k], figure.b[k], figure.c[k] - i64::from(!figure.owns[k])]);
            spans([edge(0), edge(1), edge(2)], top, columns)
        }
        Figure::Line => {
            let [first, second, third, last] = figure.sides;
            spans([limit(first), limit(second), limit(third), limit(last)], top, columns)
        }
        Figure::Point => Spans { first: [columns.0 as i32; ROWS], end: [columns.1 as i32; ROWS] },
    }
}

/// Finds the columns of the rows from `top` on where a x + b y + c is not negative, for each of some [a, b, c].
#[inline(always)]
fn spans<const N: usize>(limits: [[f64; 3]; N], top: i64, columns: (i64, i64)) -> Spans {
    let (left, right, top) = (columns.0 as f64, columns.1 as f64, top as f64);
    // Whether an edge is a lower or an upper limit depends on the triangle. Both limits are computed and the other one is moved out of the way.
    let [mut from, mut to, mut inverse] = [[0.0; N]; 3];
    for k in 0..N {
        let [a, ..] = limits[k];
        (from[k], to[k]) = if a >= 0.0 { (0.0, BEYOND) } else { (-BEYOND, 0.0) };
        // A horizontal edge covers all columns of a row or none.
        inverse[k] = if a == 0.0 { (1 << 20) as f64 } else { 1.0 / a.abs() };
    }
    let [mut lows, mut highs] = [[0.0; ROWS]; 2];
    for j in 0..ROWS {
        let (mut low, mut high, y) = (left, right, top + j as f64);
        for k in 0..N {
            let [_, b, c] = limits[k];
            let r = b * y + c + 0.5;
            let floor = (r * inverse[k]).floor();
            low = larger(low, from[k] - floor);
            high = smaller(high, to[k] + (floor + 1.0));
        }
        let low = smaller(low, right);
        (lows[j], highs[j]) = (low, larger(high, low));
    }
    let mut spans = Spans::default();
    for j in 0..ROWS {
        (spans.first[j], spans.end[j]) = (nearest(lows[j]), nearest(highs[j]));
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Triangles of all sizes up to the guard band, slivers, and some with horizontal edges.
    #[test]
    fn spans_are_those_of_the_definition() {
        let (mut random, mut triangle) = (Random::seeded(3), Triangle::default());
        for round in 0..60_000 {
            let size = 2 << (random.bits() % 16);
            let mut at = || (random.below(size) as i64 - (size / 2) as i64).clamp(-65_535, 65_535);
            let (x, mut y) = ([at(), at(), at()], [at(), at(), at()]);
            if round % 4 == 0 {
                y[1] = y[0];
            }
            if round % 7 == 0 {
                y = [0, 1, 2].map(|k| (x[k] / 2 + (random.bits() % 9) as i64).clamp(-65_535, 65_535));
            }
            if !triangle.place_corners(x, y) {
                continue;
            }
            let height = triangle.rows.1 - triangle.rows.0;
            let top = triangle.rows.0 + if height > 0 { random.below(height as u128) as i64 } else { 0 };
            let columns = if round % 3 == 0 { (-50, 300) } else { triangle.columns };
            let found = find_spans::<false>(&triangle, top, columns);
            for j in 0..ROWS {
                let (low, high) = triangle.span(top + j as i64, columns);
                let (first, end) = (i64::from(found.first[j]), i64::from(found.end[j]));
                assert!((first, end) == (low, high) || (first == end && low == high), "{triangle:?} {j}");
            }
        }
    }
}
