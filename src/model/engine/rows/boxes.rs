//! RAS-3 for small triangles: all pixels of a box at once, instead of row by row.
#![allow(clippy::float_arithmetic, reason = "quotients whose floors are certain")]

use super::kernels::{PerLane, STEP};
use super::quotient::{Positions, nearest_32};
use super::setup::{Covered, PixelBatch};
use crate::engine::context::TriangleContext;
use crate::engine::walk::Window;
use crate::raster::setup::Triangle;

/// Largest number of columns and of rows of a box, whose pixels are found and interpolated together.
pub(super) const SIDE: i64 = 16;

/// Largest number of columns and of rows of the bounding box of a triangle that is cut into boxes.
const WIDEST: i64 = 8 * SIDE;

/// The same for triangles with a single w. Their quotients are often exact: along rows the DDA handles that, in boxes each one has to be
/// corrected.
const WIDEST_FLAT: i64 = 2 * SIDE;

/// Returns whether a triangle with this bounding box is drawn as boxes instead of row by row. `is_flat` says whether it has a single w.
#[inline(always)]
pub(super) fn is_small((rows, columns): Window, is_flat: bool) -> bool {
    let widest = if is_flat { WIDEST_FLAT } else { WIDEST };
    rows.1 - rows.0 <= widest && columns.1 - columns.0 <= widest
}

/// Cuts rows and columns, of which there are some, into boxes, from left to right, then from top to bottom.
#[inline(always)]
pub(super) fn boxes((rows, columns): Window) -> impl Iterator<Item = Window> {
    let from = move |top: i64, left: i64| ((top, (top + SIDE).min(rows.1)), (left, (left + SIDE).min(columns.1)));
    // Most triangles are one box.
    std::iter::successors(Some(from(rows.0, columns.0)), move |((top, bottom), (_, right))| {
        if *right < columns.1 { Some(from(*top, *right)) } else { (*bottom < rows.1).then(|| from(*bottom, columns.0)) }
    })
}

/// The pixels of a small triangle that lie in a box.
#[derive(Debug, Default)]
pub(super) struct BoxCoverage {
    /// A column and a row at or near the triangle's.
    pub(super) first: (i64, i64),
    /// Columns and rows of the pixels relative to that one. Lanes past the end repeat the last pixel.
    pub(super) x: PerLane<i32>,
    pub(super) y: PerLane<i32>,
    pub(super) count: usize,
    /// For each row: its number, the first column and the number of pixels.
    runs: [(i64, i64, usize); SIDE as usize],
    filled: usize,
    /// Number of pixels that the triangle covers: all but those that [complete](Self::complete) quads.
    pub(super) covered: usize,
    /// If there are others: the covered part of each row, and columns and rows of all pixels, but for those of covered ones in their place.
    parts: [Covered; SIDE as usize],
    inside: [PerLane<i32>; 2],
    /// The largest distance of a pixel from the first, in columns and in rows.
    extent: (i32, i32),
}

impl BoxCoverage {
    /// RAS-3: finds the covered pixels of one of the [boxes] of a [small](is_small) triangle, all rows at once. `e` has the values of its edge
    /// functions at the first pixel, `a` and `b` their slopes, `owed` 1 for those that belong to the other triangle, `inverse` the
    /// [reciprocals](inverse_slope) of `a`.
    #[inline(always)]
    pub(super) fn cover(&mut self, [e, a, b, owed]: [[i32; 3]; 4], inverse: [f32; 3], (rows, columns): Window) {
        let (left, top) = (columns.0, rows.0);
        let (mut low, mut high) = ([0; SIDE as usize], [(columns.1 - left) as i32; SIDE as usize]);
        for k in 0..3 {
            // Not negative inside the triangle.
            limit(e[k] - owed[k], (a[k], inverse[k]), b[k], &mut low, &mut high);
        }
        let (mut used, mut filled) = (0, 0);
        // What a row without pixels writes, the next one overwrites.
        for ((y, low), high) in (0..(rows.1 - top) as i32).zip(low).zip(high) {
            let count = (high - low).max(0) as usize;
            let lanes = used..used + STEP;
            self.y[lanes.clone()].fill(y);
            for (n, to) in (0..).zip(&mut self.x[lanes]) {
                *to = low + n;
            }
            self.runs[filled] = (top + i64::from(y), left + i64::from(low), count);
            filled += usize::from(count > 0);
            used += count;
        }
        (self.first, self.count, self.filled) = ((left, top), used, filled);
        (self.covered, self.extent) = (self.count, (SIDE as i32, SIDE as i32));
        if let Some(last) = self.count.checked_sub(1) {
            let (x, y) = (self.x[last], self.y[last]);
            self.x[self.count..][..STEP].fill(x);
            self.y[self.count..][..STEP].fill(y);
        }
    }

    /// Finds all pixels of the quads that a triangle meets in a box, two rows at a time. The box begins at an even row and column, but for what
    /// is not drawn.
    pub(super) fn complete(&mut self, triangle: &Triangle, (rows, columns): Window) {
        (self.count, self.filled, self.covered, self.extent) = (0, 0, 0, (0, 0));
        for top in (rows.0 & !1..rows.1).step_by(2) {
            let spans = spans_of_quads(triangle, top, (rows, columns));
            let (low, high) = columns_of_quads(spans);
            if low >= high {
                continue;
            }
            if self.count == 0 {
                self.first = (low, top);
            }
            let count = (high - low) as usize;
            let (x, y) = ((low - self.first.0) as i32, (top - self.first.1) as i32);
            for (n, (start, end)) in spans.into_iter().enumerate() {
                let other = if start < end { n } else { 1 - n };
                let (least, most) = ((spans[other].0 - low) as i32, (spans[other].1 - 1 - low) as i32);
                let lanes = self.count..self.count + count;
                let [inside_x, inside_y] = &mut self.inside;
                inside_y[lanes.clone()].fill(y + other as i32);
                self.y[lanes.clone()].fill(y + n as i32);
                for (k, (at, inside)) in (0..).zip(self.x[lanes.clone()].iter_mut().zip(&mut inside_x[lanes])) {
                    (*at, *inside) = (x + k, x + k.clamp(least, most));
                }
                let covered = (end - start) as usize;
                self.parts[self.filled] = Covered(if covered > 0 { (start - low) as usize } else { 0 }, covered);
                self.runs[self.filled] = (top + n as i64, low, count);
                self.filled += 1;
                self.count += count;
                self.covered += covered;
                self.extent = (self.extent.0.max(x.abs()).max((x + count as i32 - 1).abs()), y + 1);
            }
        }
        if let Some(last) = self.count.checked_sub(1) {
            let [inside_x, inside_y] = &mut self.inside;
            for all in [&mut self.x, &mut self.y, inside_x, inside_y] {
                let value = all[last];
                all[self.count..][..STEP].fill(value);
            }
        }
    }

    /// Returns for each row that has pixels its number, the first column and the number of pixels.
    #[inline(always)]
    pub(super) fn runs(&self) -> &[(i64, i64, usize)] {
        &self.runs[..self.filled]
    }

    /// Returns the covered pixels: the first lane, column and row of the first pixel, and the number of pixels of each row that has any.
    #[inline(always)]
    pub(super) fn drawn(&self) -> impl Iterator<Item = (usize, (i64, i64), usize)> {
        let mut next = 0;
        self.runs().iter().enumerate().filter_map(move |(n, (j, i, count))| {
            let Covered(first, covered) = if self.covered == self.count { Covered(0, *count) } else { self.parts[n] };
            let lane = next + first;
            next += count;
            (covered > 0).then_some((lane, (i + first as i64, *j), covered))
        })
    }
}

/// Returns the columns that a triangle covers in a row and the next, where they are drawn.
pub(super) fn spans_of_quads(triangle: &Triangle, top: i64, (rows, columns): Window) -> [(i64, i64); 2] {
    [top, top + 1].map(|j| if (rows.0..rows.1).contains(&j) { triangle.span(j, columns) } else { (0, 0) })
}

/// Returns the columns of all quads that spans meet.
pub(super) fn columns_of_quads(spans: [(i64, i64); 2]) -> (i64, i64) {
    let (mut low, mut high) = (i64::MAX, i64::MIN);
    for (first, end) in spans.into_iter().filter(|(first, end)| first < end) {
        (low, high) = (low.min(first & !1), high.max((end + 1) & !1));
    }
    (low, high)
}

/// How a triangle is drawn.
#[derive(Clone, Copy, Debug, Default)]
pub(super) enum Entered {
    #[default]
    Nothing,
    /// As boxes, in these rows and columns, of which there are some.
    Small(Window),
    /// Row by row, likewise.
    Large(Window),
}

/// Returns the rows and columns that a window shares with a bounding box.
#[inline(always)]
pub(super) fn common((of_rows, of_columns): Window, (rows, columns): Window) -> Window {
    ((of_rows.0.max(rows.0), of_rows.1.min(rows.1)), (of_columns.0.max(columns.0), of_columns.1.min(columns.1)))
}

/// Takes a triangle that may cover pixels in the given rows and columns, and sets it up, unless it is small and small ones are set up
/// [together](super::small::Boxes).
#[inline(always)]
pub(super) fn enter<const WIDE: bool>(
    context: &mut TriangleContext<'_>,
    number: usize,
    window: Window,
    together: bool,
) -> Entered {
    context.begin(number);
    let bounds = context.bounds();
    let (rows, columns) = common(bounds, window);
    if rows.0 >= rows.1 || columns.0 >= columns.1 {
        return Entered::Nothing;
    }
    let is_small = is_small(bounds, context.is_flat());
    let waits = is_small && together;
    if !waits && !context.place() {
        return Entered::Nothing;
    }
    if is_small { Entered::Small((rows, columns)) } else { Entered::Large((rows, columns)) }
}

/// Finds the covered pixels of one box of a triangle.
#[inline(always)]
pub(super) fn cover<const WIDE: bool>(triangle: &Triangle, window: Window, coverage: &mut BoxCoverage) {
    let edges = [triangle.edges(window.1.0, window.0.0), triangle.a, triangle.b];
    let [e, a, b] = edges.map(|of| of.map(|n| n as i32));
    let owed = triangle.owns.map(|owns| i32::from(!owns));
    coverage.cover([e, a, b, owed], a.map(inverse_slope), window);
}

/// Steps of lanes for what is computed in double precision: small triangles have few pixels.
pub(super) const HALF_STEP: usize = STEP / 2;

/// Returns the pixels of a box as a batch, in whole steps of so many lanes.
#[inline(always)]
pub(super) fn batch<const LANES: usize>(coverage: &BoxCoverage, lane: usize) -> PixelBatch<'_> {
    let lanes = coverage.count.next_multiple_of(LANES);
    let at = Positions { x: &coverage.x[..lanes], y: &coverage.y[..lanes], last: i32::MAX };
    let [x, y] = &coverage.inside;
    let inside = [&x[..lanes], &y[..lanes]];
    let BoxCoverage { first, count, extent, covered, .. } = *coverage;
    PixelBatch { first, at, count, lane, extent, runs: coverage.runs(), covered: Covered(0, covered), inside }
}

/// Returns the reciprocal of the magnitude of an edge's slope along x.
#[inline(always)]
pub(super) fn inverse_slope(a: i32) -> f32 {
    // A horizontal edge covers all columns of a row or none. The chosen factor moves the limit out of the box.
    if a == 0 { 40.0 } else { 1.0 / a.abs() as f32 }
}

/// A limit beyond all columns.
const BEYOND: i32 = 1 << 23;

/// Clips each row of a box to the columns i in which a i + b j + e is not negative.
///
/// These are the columns from -floor(r / a) on, or up to floor(r / -a), with r = b j + e below 2^22. The distance of (r + 1/2) / a from an
/// integer is at least half of 1/a. For quotients below 32 single precision is more exact than that, because a is below 2^15; larger
/// quotients put the whole box on one side.
#[inline(always)]
fn limit(e: i32, (a, inverse): (i32, f32), b: i32, low: &mut [i32; SIDE as usize], high: &mut [i32; SIDE as usize]) {
    // Whether an edge is a lower or an upper limit depends on the triangle. Both limits are computed and the other one is moved out of the
    // way, which avoids a branch.
    let (from, to) = if a > 0 { (0, BEYOND) } else { (-BEYOND, 0) };
    for ((j, low), high) in low.iter_mut().enumerate().zip(high) {
        let r = (b * j as i32 + e) as f32 + 0.5;
        let floor = nearest_32(r * inverse - 0.5);
        // Rows below the box, which nobody reads, may wrap.
        *low = (*low).max(from.wrapping_sub(floor));
        *high = (*high).min(to.wrapping_add(floor.wrapping_add(1)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::state::Profile;

    /// The rows of all boxes of triangles of all sizes and shapes are what spans say.
    #[test]
    fn boxes_hold_the_spans() {
        let mut sequence = Random::seeded(0x1234_5678);
        let mut random = |n: i64| sequence.below(n as u128) as i64;
        let (mut coverage, mut triangle, mut drawn) = (BoxCoverage::default(), Triangle::default(), 0);
        for round in 0..40_000 {
            // 1/16 pixel; every third is a sliver.
            let (size, thin) = (1 + random(16 * WIDEST), if round % 3 == 0 { 1 + random(40) } else { 16 * WIDEST });
            let (x0, y0) = (random(4000), random(4000));
            let x = [x0, x0 + random(size), x0 + random(size)];
            let mut y = [y0, y0 + random(size), y0 + random(size)];
            if thin < size {
                y = [0, 1, 2].map(|k| y0 + (x[k] - x0) / 2 + random(thin) / 2);
            }
            if !triangle.place(x, y) {
                continue;
            }
            triangle.weigh([1.0, 1.5, 2.0], true, Profile::Nv2a);
            if !is_small((triangle.rows, triangle.columns), false) {
                continue;
            }
            drawn += 1;
            for (rows, columns) in boxes((triangle.rows, triangle.columns)) {
                assert!(rows.1 - rows.0 <= SIDE && columns.1 - columns.0 <= SIDE);
                cover::<false>(&triangle, (rows, columns), &mut coverage);
                let spans = (rows.0..rows.1).map(|j| (j, triangle.span(j, columns)));
                let wanted: Vec<_> =
                    spans.filter(|(_, s)| s.0 < s.1).map(|(j, s)| (j, s.0, (s.1 - s.0) as usize)).collect();
                assert_eq!(coverage.runs(), wanted, "{triangle:?} {rows:?} {columns:?}");
                let mut pixels =
                    wanted.iter().flat_map(|(j, first, count)| (0..*count).map(move |n| (first + n as i64, *j)));
                for n in 0..coverage.count {
                    let at = (coverage.first.0 + i64::from(coverage.x[n]), coverage.first.1 + i64::from(coverage.y[n]));
                    assert_eq!(Some(at), pixels.next());
                }
                assert_eq!(pixels.next(), None);
            }
        }
        assert!(drawn > 30_000);
    }

    /// Every slope and many values, those around a whole number of columns above all.
    #[test]
    fn limits_are_floors() {
        let whole = |n: i32| -> [i32; SIDE as usize] { [n; SIDE as usize] };
        for a in (-4352..=4352_i32).step_by(16) {
            for n in -40..=40_i32 {
                for e in [n * a.abs() - 1, n * a.abs(), n * a.abs() + 1, n * 6007] {
                    let e = e.clamp(-150_000, 150_000);
                    let b = (e & 255) * 16 - 2048;
                    let (mut low, mut high) = (whole(0), whole(SIDE as i32));
                    limit(e, (a, inverse_slope(a)), b, &mut low, &mut high);
                    for j in 0..SIDE as i32 {
                        let inside = |i: &i32| a * i + b * j + e >= 0;
                        let wanted = (0..SIDE as i32).filter(inside).count() as i32;
                        let (low, high) = (low[j as usize], high[j as usize]);
                        assert_eq!((high - low).max(0), wanted, "{a} {b} {e} {j}");
                        assert!((low..high).all(|i| inside(&i)), "{a} {b} {e} {j}");
                    }
                }
            }
        }
    }
}
