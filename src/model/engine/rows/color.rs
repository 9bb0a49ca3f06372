//! INT-2 on rows: 16-bit weights, and the colours that they yield.

use super::CompiledDraw;
use super::kernels::PerLane;
use super::setup::PixelBatch;
use crate::engine::context::TriangleContext;
use crate::raster::interpolate;

/// Narrows weights to 16 bits.
#[inline(always)]
pub(super) fn narrow(wide: &[i32], out: &mut [u16]) {
    for (out, wide) in out.iter_mut().zip(wide) {
        *out = *wide as u16;
    }
}

/// Narrows the exact weights of a batch, 0..=256, to 16 bits.
#[inline(always)]
pub(super) fn narrow_weights(
    batch: PixelBatch<'_>,
    [w0, w2]: &[PerLane<i32>; 2],
    [narrow0, narrow2]: &mut [PerLane<u16>; 2],
) {
    // Not a loop over both, because compilers do not always unroll it.
    narrow(&w0[batch.lanes()], &mut narrow0[batch.lanes()]);
    narrow(&w2[batch.lanes()], &mut narrow2[batch.lanes()]);
}

/// INT-2: interpolates all channels that are read.
#[inline(always)]
pub(super) fn colors(
    context: &TriangleContext<'_>,
    compiled: &CompiledDraw,
    batch: PixelBatch<'_>,
    [w0, w2]: &[PerLane<u16>; 2],
    rows: &mut [PerLane<i16>],
) {
    for (slots, colors) in [(&compiled.primary, &context.primary), (&compiled.secondary, &context.secondary)] {
        for channel in 0..4 {
            let Some(slot) = slots[channel] else { continue };
            let out = &mut rows[usize::from(slot)].0[batch.lanes()];
            let corners = [u16::from(colors[0][channel]), u16::from(colors[1][channel]), u16::from(colors[2][channel])];
            if corners[0] == corners[1] && corners[1] == corners[2] {
                out.fill(corners[0] as i16);
            } else {
                color(corners, &w0[batch.lanes()], &w2[batch.lanes()], out);
            }
        }
    }
}

/// INT-2 of one channel.
#[inline(always)]
fn color(corners: [u16; 3], w0: &[u16], w2: &[u16], out: &mut [i16]) {
    for ((out, w0), w2) in out.iter_mut().zip(w0).zip(w2) {
        *out = interpolate::color(corners, *w0, *w2) as i16;
    }
}
