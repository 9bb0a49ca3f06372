//! INT-2 on rows: 16-bit weights, and the colours that they yield.
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly")]

use crate::engine::rows::geometry::weights::Pixels;
use crate::engine::rows::lanes::{PerLane, floor_within, smaller};
use crate::raster::interpolate;
use std::ops::Range;

/// W0 and W2 of a block.
pub(crate) type ColorWeights = [PerLane<u16>; 2];

/// Computes W0 and W2 of lanes. Beside a triangle they are limited, so that W1 is not negative; such colours are not stored.
#[inline(always)]
pub(crate) fn weigh(pixels: &Pixels, lanes: Range<usize>, [w0, w2]: &mut ColorWeights) {
    let (b0, b2) = (&pixels.b[0][lanes.clone()], &pixels.b[1][lanes.clone()]);
    let (w0, w2) = (&mut w0[lanes.clone()], &mut w2[lanes]);
    for n in 0..w0.len() {
        (w0[n], w2[n]) = (fixed(b0[n]), fixed(b2[n]));
    }
    limit(w0, w2);
}

/// Returns the floor of 256 b, limited. Beside 1 a double has 52 bits of fraction: all that a weight of at least 2^-28 has, and others are rounded to less than
/// 1/256.
#[inline(always)]
fn fixed(b: f64) -> u16 {
    const ONE: u64 = 0x3ff00;
    (((1.0 + b).to_bits() >> 44) as u16).wrapping_sub(ONE as u16).cast_signed().clamp(0, 256) as u16
}

/// Returns the 16-bit weight of the floor of 256 b.
#[inline(always)]
pub(super) fn weight(b: f64) -> u16 {
    floor_within(b, 0.0, 256.0) as u16
}

/// Limits W2, so that W1 is not negative.
#[inline(always)]
pub(super) fn limit(w0: &[u16], w2: &mut [u16]) {
    let w0 = &w0[..w2.len()];
    for n in 0..w2.len() {
        w2[n] = smaller(w2[n], 256 - w0[n]);
    }
}

/// INT-2: interpolates the channels of a colour that are read into their rows.
#[inline(always)]
pub(crate) fn color(
    slots: &[Option<u16>; 4],
    colors: &[[u8; 4]; 3],
    lanes: Range<usize>,
    [w0, w2]: &ColorWeights,
    rows: &mut [PerLane<i16>],
) {
    for channel in 0..4 {
        let Some(slot) = slots[channel] else { continue };
        let out = &mut rows[usize::from(slot)].0[lanes.clone()];
        let corners = [u16::from(colors[0][channel]), u16::from(colors[1][channel]), u16::from(colors[2][channel])];
        let (w0, w2) = (&w0[lanes.clone()], &w2[lanes.clone()]);
        for n in 0..out.len() {
            out[n] = interpolate::color(corners, w0[n], w2[n]) as i16;
        }
    }
}
