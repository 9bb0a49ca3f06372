//! The walk: triangles in order, rows in pairs, 2x2 quads from left to right.

use super::pixel::{Fragment, TriangleContext};
use crate::plan::{Plan, PlannedDraw};
use crate::texture::unit::Image;
use crate::trace::Observer;

/// Some rows of a surface.
#[derive(Debug)]
pub struct Band<'a> {
    /// Row of the first word; even.
    pub first_row: usize,
    /// Words a row.
    pub width: usize,
    /// The rows' words.
    pub words: &'a mut [u32],
    /// The rows' depths; empty without a depth buffer.
    pub depth: &'a mut [u32],
}

impl Band<'_> {
    /// First row and the row after the last.
    pub fn rows(&self) -> (i64, i64) {
        (self.first_row as i64, (self.first_row + self.words.len() / self.width) as i64)
    }
}

/// Draws what of a draw falls into a band; covered pixels, and those that were stored.
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

/// Some rows and columns, as half-open ranges.
pub type Window = ((i64, i64), (i64, i64));

/// The part of some rows that lies in a draw's window, and its columns.
pub fn window(planned: &PlannedDraw, rows: (i64, i64)) -> Window {
    let window = &planned.window;
    let columns = (i64::from(window.x), i64::from(window.x + window.width));
    ((rows.0.max(i64::from(window.y)), rows.1.min(i64::from(window.y + window.height))), columns)
}

/// Visits every pixel of some rows that a draw covers, once for each triangle that covers it.
#[inline(always)]
pub fn covered(
    plan: &Plan,
    planned: &PlannedDraw,
    rows: (i64, i64),
    mut visit: impl FnMut(&TriangleContext<'_>, i64, i64),
) {
    if planned.folded.invisible.is_some() {
        return;
    }
    let (rows, columns) = window(planned, rows);
    if rows.0 >= rows.1 || columns.0 >= columns.1 {
        return;
    }
    for number in 0..planned.assembly.triangles.len() {
        let Some(context) = TriangleContext::new(plan, planned, number, rows) else { continue };
        let triangle = &context.triangle;
        let rows = (triangle.rows.0.max(rows.0), triangle.rows.1.min(rows.1));
        let mut top = rows.0 & !1;
        while top < rows.1 {
            let span = |j: i64| if (rows.0..rows.1).contains(&j) { triangle.span(j, columns) } else { (0, 0) };
            let spans = [span(top), span(top + 1)];
            let filled = spans.into_iter().filter(|s| s.0 < s.1);
            let left = filled.clone().map(|s| s.0).min().unwrap_or(0) & !1;
            let right = filled.map(|s| s.1).max().unwrap_or(0);
            let mut i = left;
            while i < right {
                for (j, span) in [(top, spans[0]), (top + 1, spans[1])] {
                    for i in [i, i + 1] {
                        if span.0 <= i && i < span.1 {
                            visit(&context, i, j);
                        }
                    }
                }
                i += 2;
            }
            top += 2;
        }
    }
}

/// Shades a pixel; whether it was stored.
#[inline]
pub fn pixel<O: Observer>(
    context: &TriangleContext<'_>,
    textures: &[Image<'_, i32>],
    band: &mut Band<'_>,
    i: i64,
    j: i64,
    observer: &mut O,
) -> bool {
    let at = (j as usize - band.first_row) * band.width + i as usize;
    let depth = band.depth.get(at).copied();
    let fragment = Fragment {
        pixel: (i, j),
        e: context.triangle.edges(i, j),
        stored: band.words[at],
        stored_depth: i64::from(depth.unwrap_or(0)),
        weights: None,
    };
    let Some(result) = context.shade::<i32, O>(&fragment, None, textures, observer) else { return false };
    band.words[at] = result.word;
    if let (Some(depth), Some(slot)) = (result.depth, band.depth.get_mut(at)) {
        *slot = depth as u32;
    }
    true
}
