//! RAS-3 for small triangles: all pixels of a box at once, instead of row by row.

use super::kernels::{PerLane, STEP};
use super::quotient::Positions;
use super::setup::{Covered, PixelBatch, Run};
use super::shapes::{Corners, Each, GROUP, ROWS, SIDE, Spans};
use crate::engine::context::TriangleContext;
use crate::engine::walk::Window;
use crate::raster::setup::{Triangle, centres, is_flat};

/// Largest number of columns and of rows of the bounding box of a triangle that is cut into boxes.
const WIDEST: i32 = 8 * SIDE as i32;

/// The same for triangles with a single w. Their quotients are often exact, and along longer rows the DDA handles that faster.
const WIDEST_FLAT: i32 = 2 * SIDE as i32;

/// Returns whether a triangle whose bounding box has so many rows and columns is drawn as boxes instead of row by row. `is_flat` says whether it has
/// a single w.
#[inline(always)]
pub(super) fn is_small((rows, columns): (i32, i32), is_flat: bool) -> bool {
    let widest = if is_flat { WIDEST_FLAT } else { WIDEST };
    (rows <= widest) & (columns <= widest)
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
    pub(super) x: PerLane<i16>,
    pub(super) y: PerLane<i16>,
    pub(super) count: usize,
    /// Its rows, whose lanes and pixels count from the first.
    runs: [Run; ROWS],
    filled: usize,
    /// Number of pixels that the triangle covers: all but those that [complete](Self::complete) quads.
    pub(super) covered: usize,
    beyond: Box<Beyond>,
    /// The largest distance of a pixel from the first, in columns and in rows.
    extent: (i32, i32),
}

/// What only boxes with pixels of quads have. It stands elsewhere, so that those of several triangles are near to each other.
#[derive(Debug, Default)]
struct Beyond {
    /// The covered part of each row.
    parts: [Covered; ROWS],
    /// Columns and rows of all pixels, but for those of covered ones in the place of others.
    inside: [PerLane<i16>; 2],
}

impl BoxCoverage {
    /// Takes the covered pixels of box `n` of those that have `spans`, on a surface with rows of so many pixels.
    #[inline(always)]
    pub(super) fn cover(&mut self, spans: &Spans, n: usize, ((top, _), (left, _)): Window, width: u32) {
        let (mut used, mut filled) = (0, 0);
        // What a row without pixels writes, the next one overwrites.
        for y in 0..spans.rows.min(ROWS) {
            let (low, count) = (spans.first[y][n], spans.count[y][n] as usize);
            let lanes = used..used + STEP;
            self.y[lanes.clone()].fill(y as i16);
            for (n, to) in (0..).zip(&mut self.x[lanes]) {
                *to = low as i16 + n;
            }
            self.runs[filled] = Run::new(used, (y as u32 * width).wrapping_add(low as u32), count);
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
    pub(super) fn complete(&mut self, triangle: &Triangle, (rows, columns): Window, width: u32) {
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
            let (x, y) = ((low - self.first.0) as i16, (top - self.first.1) as i16);
            for (n, (start, end)) in spans.into_iter().enumerate() {
                let other = if start < end { n } else { 1 - n };
                let (least, most) = ((spans[other].0 - low) as i16, (spans[other].1 - 1 - low) as i16);
                let lanes = self.count..self.count + count;
                let [inside_x, inside_y] = &mut self.beyond.inside;
                inside_y[lanes.clone()].fill(y + other as i16);
                self.y[lanes.clone()].fill(y + n as i16);
                for (k, (at, inside)) in (0..).zip(self.x[lanes.clone()].iter_mut().zip(&mut inside_x[lanes])) {
                    (*at, *inside) = (x + k, x + k.clamp(least, most));
                }
                let covered = (end - start) as usize;
                self.beyond.parts[self.filled] = Covered(if covered > 0 { (start - low) as usize } else { 0 }, covered);
                let at = ((top + n as i64 - self.first.1) as u32).wrapping_mul(width).wrapping_add(x as u32);
                self.runs[self.filled] = Run::new(self.count, at, count);
                self.filled += 1;
                self.count += count;
                self.covered += covered;
                let reach = x.abs().max((x + count as i16 - 1).abs());
                self.extent = (self.extent.0.max(reach.into()), i32::from(y) + 1);
            }
        }
        if let Some(last) = self.count.checked_sub(1) {
            let [inside_x, inside_y] = &mut self.beyond.inside;
            for all in [&mut self.x, &mut self.y, inside_x, inside_y] {
                let value = all[last];
                all[self.count..][..STEP].fill(value);
            }
        }
    }

    /// Returns the rows that have pixels.
    #[inline(always)]
    pub(super) fn runs(&self) -> &[Run] {
        &self.runs[..self.filled]
    }

    /// Returns the covered pixels of each row that has any.
    #[inline(always)]
    pub(super) fn drawn(&self) -> impl Iterator<Item = Run> {
        let is_whole = self.covered == self.count;
        self.runs().iter().enumerate().filter_map(move |(n, run)| {
            let Covered(first, count) = if is_whole { Covered(0, run.count()) } else { self.beyond.parts[n] };
            (count > 0).then(|| run.part(first, count))
        })
    }

    /// Appends [these](Self::drawn), so many lanes and pixels further.
    #[inline(always)]
    pub(super) fn append(&self, (lanes, pixels): (usize, u32), runs: &mut Vec<Run>) {
        if self.covered != self.count {
            runs.extend(self.drawn().map(|run| run.further(lanes, pixels)));
            return;
        }
        // Of most boxes all pixels are covered. All runs, because a loop over the used ones would end unpredictably.
        let filled = runs.len() + self.filled;
        runs.extend_from_slice(&self.runs.map(|run| run.further(lanes, pixels)));
        runs.truncate(filled);
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

/// Takes triangles that may cover pixels in the given rows and columns, and sets them up, unless they are small and small ones are set up
/// [together](super::small::Boxes). Returns how each is drawn.
#[inline(never)]
pub(super) fn enter(
    contexts: &mut [TriangleContext<'_>],
    numbers: &[u32],
    window: Window,
    together: bool,
    corners: &mut Corners,
) -> Each<Entered> {
    for (n, (context, number)) in contexts.iter_mut().zip(numbers).enumerate() {
        context.begin(*number as usize);
        corners.set(n, context);
    }
    let (perspective, profile) = (contexts[0].draw.perspective, contexts[0].plan.profile);
    let narrow = |(first, end): (i64, i64)| (first as i32, end as i32);
    let ((top, bottom), (left, right)) = (narrow(window.0), narrow(window.1));
    let ([mut tops, mut bottoms, mut lefts, mut rights], mut small) = ([[0; GROUP]; 4], [0; GROUP]);
    for n in 0..GROUP {
        let Corners { x, y, w, .. } = &*corners;
        let (rows, columns) = (centres([y[0][n], y[1][n], y[2][n]]), centres([x[0][n], x[1][n], x[2][n]]));
        let is_flat = is_flat([w[0][n], w[1][n], w[2][n]], perspective, profile);
        small[n] = i32::from(is_small((rows.1 - rows.0, columns.1 - columns.0), is_flat));
        (tops[n], bottoms[n]) = (rows.0.max(top), rows.1.min(bottom));
        (lefts[n], rights[n]) = (columns.0.max(left), columns.1.min(right));
    }
    let mut entered = [Entered::Nothing; GROUP];
    for (n, context) in contexts.iter_mut().enumerate().take(numbers.len()) {
        if tops[n] >= bottoms[n] || lefts[n] >= rights[n] {
            continue;
        }
        let is_small = small[n] != 0;
        let waits = is_small && together;
        if !waits && !context.place() {
            continue;
        }
        let common = ((tops[n].into(), bottoms[n].into()), (lefts[n].into(), rights[n].into()));
        entered[n] = if is_small { Entered::Small(common) } else { Entered::Large(common) };
    }
    entered
}

/// Steps of lanes for what is computed in double precision: small triangles have few pixels.
pub(super) const HALF_STEP: usize = STEP / 2;

/// Returns the pixels of a box as a batch, in whole steps of so many lanes.
#[inline(always)]
pub(super) fn batch<const LANES: usize>(coverage: &BoxCoverage, lane: usize) -> PixelBatch<'_> {
    let lanes = coverage.count.next_multiple_of(LANES);
    let at = Positions { x: &coverage.x[..lanes], y: &coverage.y[..lanes], last: i32::MAX };
    let [x, y] = &coverage.beyond.inside;
    let inside = [&x[..lanes], &y[..lanes]];
    let BoxCoverage { first, count, extent, covered, .. } = *coverage;
    PixelBatch { first, at, count, lane, extent, runs: coverage.runs(), covered: Covered(0, covered), inside }
}

#[cfg(test)]
mod tests {
    use super::super::shapes::Shapes;
    use super::*;
    use crate::random::Random;
    use crate::state::Profile;

    /// Pixels of a row.
    const WIDTH: u32 = 4096;

    /// The rows of all boxes of triangles of all sizes and shapes are what spans say.
    #[test]
    fn boxes_hold_the_spans() {
        let mut sequence = Random::seeded(0x1234_5678);
        let mut random = |n: i64| sequence.below(n as u128) as i64;
        let (mut coverage, mut triangle, mut drawn) = (BoxCoverage::default(), Triangle::default(), 0);
        let (mut corners, mut shapes) = (Corners::default(), Shapes::default());
        for round in 0..40_000 {
            // 1/16 pixel; every third is a sliver, every fifth has a horizontal edge.
            let widest = 16 * i64::from(WIDEST);
            let (size, thin) = (1 + random(widest), if round % 3 == 0 { 1 + random(40) } else { widest });
            let (x0, y0) = (random(4000), widest + random(4000));
            let x = [x0, x0 + random(size), x0 + random(size)];
            let mut y = [y0, y0 + random(size), y0 + random(size)];
            if thin < size {
                y = [0, 1, 2].map(|k| y0 + (x[k] - x0) / 2 + random(thin) / 2);
            }
            if round % 5 == 0 {
                y[1] = y[0];
                // Below the others, too.
                y[2] = if round % 2 == 0 { 2 * y[0] - y[2] } else { y[2] };
            }
            if !triangle.place(x, y) {
                continue;
            }
            triangle.weigh([1.0, 1.5, 2.0], true, Profile::Nv2a);
            let [rows, columns] = [triangle.rows, triangle.columns].map(|(first, end)| (end - first) as i32);
            if !is_small((rows, columns), false) {
                continue;
            }
            drawn += 1;
            let at = round % GROUP;
            for k in 0..3 {
                (corners.x[k][at], corners.y[k][at]) = (x[k] as i32, y[k] as i32);
            }
            let all: Vec<_> = boxes((triangle.rows, triangle.columns)).map(|window| (window, at)).collect();
            for all in all.chunks(GROUP) {
                shapes.place(&corners, all);
                let found = shapes.spans(all);
                for (n, ((rows, columns), _)) in all.iter().enumerate() {
                    assert!(rows.1 - rows.0 <= SIDE && columns.1 - columns.0 <= SIDE);
                    coverage.cover(&found, n, (*rows, *columns), WIDTH);
                    let (width, (left, top)) = (i64::from(WIDTH), coverage.first);
                    let pixel = |at: i64| (top + at / width, left + at % width);
                    let runs: Vec<_> = coverage.drawn().map(|run| (pixel(run.at() as i64), run.count())).collect();
                    let spans = (rows.0..rows.1).map(|j| (j, triangle.span(j, *columns)));
                    let wanted: Vec<_> =
                        spans.filter(|(_, s)| s.0 < s.1).map(|(j, s)| ((j, s.0), (s.1 - s.0) as usize)).collect();
                    assert_eq!(runs, wanted, "{triangle:?} {rows:?} {columns:?}");
                    let mut pixels =
                        wanted.iter().flat_map(|((j, first), count)| (0..*count).map(move |n| (first + n as i64, *j)));
                    for n in 0..coverage.count {
                        let (x, y) = (i64::from(coverage.x[n]), i64::from(coverage.y[n]));
                        assert_eq!(Some((coverage.first.0 + x, coverage.first.1 + y)), pixels.next());
                    }
                    assert_eq!(pixels.next(), None);
                }
            }
        }
        assert!(drawn > 30_000);
    }
}
