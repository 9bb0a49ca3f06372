//! The walk: triangles in order, rows from the top, pixels from left to right.

use super::context::TriangleContext;
use super::pixel::{DepthStencil, Fragment};
use crate::plan::{Plan, PlannedDraw};
use crate::texture::planned::Image;
use crate::trace::Observer;

/// Some rows of a surface.
#[derive(Debug)]
pub struct Band<'a> {
    /// Row of the first word, which is even.
    pub first_row: usize,
    /// Number of words of a row.
    pub width: usize,
    /// Words of the rows.
    pub words: &'a mut [u32],
    /// Depths and stencils of the rows, as in [`Surface::depth`](crate::frame::Surface::depth); empty without a depth buffer.
    pub depth: &'a mut [u32],
}

impl Band<'_> {
    /// Returns the first row, and the row after the last.
    pub fn rows(&self) -> (i64, i64) {
        (self.first_row as i64, (self.first_row + self.words.len() / self.width) as i64)
    }

    /// Returns the index of a pixel, modulo 2^32: pixels outside are counted from, too.
    #[inline(always)]
    pub fn index(&self, (i, j): (i64, i64)) -> u32 {
        ((j - self.first_row as i64) * self.width as i64 + i) as u32
    }
}

/// Draws the part of a draw that lies in a band. Returns the number of covered pixels and of stored ones.
pub(super) fn draw<O: Observer>(
    plan: &Plan,
    planned: &PlannedDraw,
    textures: &[Image<'_, i32>],
    band: &mut Band<'_>,
    observer: &mut O,
) -> (u64, u64) {
    let (mut shaded, mut stored) = (0, 0);
    covered(plan, planned, band.rows(), |context, i, j| {
        shaded += 1;
        stored += u64::from(pixel(context, textures, band, i, j, observer));
    });
    (shaded, stored)
}

/// Rows and columns, as half-open ranges.
pub(crate) type Window = ((i64, i64), (i64, i64));

/// Returns the parts of some rows that a draw may touch, in its windows; none if nothing of it can be seen.
pub fn windows(planned: &PlannedDraw, rows: (i64, i64)) -> impl Iterator<Item = Window> {
    let visible = planned.folded.invisible.is_none();
    planned.windows.iter().filter(move |_| visible).filter_map(move |window| {
        let columns = (i64::from(window.x), i64::from(window.x + window.width));
        let rows = (rows.0.max(i64::from(window.y)), rows.1.min(i64::from(window.y + window.height)));
        (rows.0 < rows.1).then_some((rows, columns))
    })
}

/// Returns the numbers of a draw's triangles, in order, in each of the [windows] of some rows.
pub fn triangles(planned: &PlannedDraw, rows: (i64, i64)) -> impl Iterator<Item = (Window, usize)> {
    let count = planned.assembly.triangles.len();
    windows(planned, rows).flat_map(move |window| (0..count).map(move |number| (window, number)))
}

/// Visits every pixel of some rows that a draw covers, once for each triangle that covers it.
#[inline(always)]
pub fn covered(
    plan: &Plan,
    planned: &PlannedDraw,
    rows: (i64, i64),
    mut visit: impl FnMut(&TriangleContext<'_>, i64, i64),
) {
    spans(plan, planned, rows, |context, j, (first, end)| {
        for i in (first..end).filter(|i| !context.is_left_out(*i, j)) {
            visit(context, i, j);
        }
    });
}

/// Visits the columns that a draw covers in some rows, from the first to before the last, once for each triangle that covers them. A stipple
/// may leave pixels of them out.
#[inline(always)]
pub fn spans(
    plan: &Plan,
    planned: &PlannedDraw,
    rows: (i64, i64),
    mut visit: impl FnMut(&TriangleContext<'_>, i64, (i64, i64)),
) {
    for ((rows, columns), number) in triangles(planned, rows) {
        let Some(context) = TriangleContext::new(plan, planned, number, rows) else { continue };
        for j in context.triangle.rows.0.max(rows.0)..context.triangle.rows.1.min(rows.1) {
            let span = context.triangle.span(j, columns);
            if span.0 < span.1 {
                visit(&context, j, span);
            }
        }
    }
}

/// Shades a pixel. Returns whether it was stored.
#[inline]
pub fn pixel<O: Observer>(
    context: &TriangleContext<'_>,
    textures: &[Image<'_, i32>],
    band: &mut Band<'_>,
    i: i64,
    j: i64,
    observer: &mut O,
) -> bool {
    let at = band.index((i, j)) as usize;
    let mut depth = DepthStencil::new(band.depth.get(at).copied().unwrap_or(0));
    let fragment = Fragment { pixel: (i, j), e: context.triangle.edges(i, j), stored: band.words[at], weights: None };
    let result = context.shade::<i32, O>(&fragment, &mut depth, None, textures, observer);
    if let Some(slot) = band.depth.get_mut(at) {
        *slot = depth.word();
    }
    let Some(result) = result else { return false };
    band.words[at] = result.word;
    true
}
