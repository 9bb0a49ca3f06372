//! ROP-1, ROP-5, ROP-6 and DEP-2 on rows.

use super::kernels::Row;
use super::{BLOCK, Compiled};
use crate::plan::PlannedDraw;
use crate::rop::surface;
use crate::state::{CompareFunction, SurfaceFormat};

/// What blending reads of the surface's words, into the rows that want it.
#[inline(always)]
pub(super) fn read(draw: &PlannedDraw, compiled: &Compiled, words: &[u32; BLOCK], rows: &mut [Row]) {
    for channel in 0..4 {
        let Some(row) = compiled.destination[channel] else { continue };
        let out = &mut rows[usize::from(row)].0;
        by_format(draw.surface, |format| {
            for (out, word) in out.iter_mut().zip(words) {
                *out = i16::from(surface::read(format, *word)[channel]);
            }
        });
    }
}

/// Runs a text with a format that is a constant in it, so that loops over pixels hold one format's bits only.
#[inline(always)]
fn by_format(format: SurfaceFormat, mut run: impl FnMut(SurfaceFormat)) {
    match format {
        SurfaceFormat::A8R8G8B8 => run(SurfaceFormat::A8R8G8B8),
        other => run(other),
    }
}

/// The stored rows as words.
#[inline(always)]
pub(super) fn pack(draw: &PlannedDraw, compiled: &Compiled, rows: &[Row], words: &mut [u32; BLOCK]) {
    let [r, g, b, a] = compiled.stored.map(|row| rows[usize::from(row)].block());
    by_format(draw.surface, |format| {
        for n in 0..BLOCK {
            words[n] = surface::pack(format, [r[n] as u8, g[n] as u8, b[n] as u8, a[n] as u8]);
        }
    });
}

/// ROP-6, and what was there where a fragment was dropped.
#[inline(always)]
pub(super) fn merge(mask: u32, alive: &[bool; BLOCK], stored: &[u32; BLOCK], words: &mut [u32; BLOCK]) {
    for ((word, stored), alive) in words.iter_mut().zip(stored).zip(alive) {
        let mask = if *alive { mask } else { 0 };
        *word = (*stored & !mask) | (*word & mask);
    }
}

/// A comparison of rows.
#[inline(always)]
pub(super) fn test<T: Copy + PartialOrd>(
    function: CompareFunction,
    incoming: impl Fn(usize) -> T,
    stored: impl Fn(usize) -> T,
    alive: &mut [bool; BLOCK],
) {
    for (n, alive) in alive.iter_mut().enumerate() {
        *alive &= function.passes(incoming(n), stored(n));
    }
}
