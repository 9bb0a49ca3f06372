//! DEP-1, DEP-3 on rows. Depths with an offset, a range or w are computed pixel by pixel, by the text of the definition.
//!
//! ```text
//! d: the vertex of the largest binary exponent among the E_k; of equals 1 before 0 before 2
//! depth = sum of z_d and b_k (z_k - z_d) for the two others, each cut at the 29th bit of the largest
//! ```
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly")]

use crate::engine::context::TriangleContext;
use crate::engine::rows::geometry::shape::Shape;
use crate::engine::rows::geometry::weights::Pixels;
use crate::engine::rows::lanes::{PerLane, floor_within, larger};
use crate::raster::depth::{self, difference};
use crate::raster::weights::Number;
use crate::state::DepthFormat;
use std::ops::Range;

/// Marks a pixel outside the draw's depth range, which is dropped (DEP-4). No buffer has it.
pub(crate) const OUTSIDE: u32 = u32::MAX - 1;

/// Computes the depths of lanes.
#[inline(always)]
pub(crate) fn depths(
    context: &TriangleContext<'_>,
    shape: &Shape,
    lanes: Range<usize>,
    pixels: &mut Pixels,
    out: &mut PerLane<u32>,
) {
    let (plane, draw) = (&context.depth, context.draw);
    let Some(test) = &draw.depth_test else { return };
    let format = draw.depth_format;
    let between = |a: usize, b: usize| f64::from(difference(plane.z[a], plane.z[b]));
    let differences = [between(1, 0), between(2, 0), between(2, 1)];
    let is_plain = plane.w.is_none() && plane.offset.mantissa == 0 && test.range.is_none();
    if !(is_plain && differences.iter().all(|difference| difference.is_finite())) {
        for n in lanes {
            let e = context.triangle.edges(pixels.x[n] as i64, pixels.y[n] as i64);
            let depth = depth::ranged(test.range.as_ref(), plane.at(e));
            out[n] = depth.map_or(OUTSIDE, |depth| depth::word(format, depth));
        }
        return;
    }
    let [z0, z1, z2] = [f64::from(plane.z[0]), f64::from(plane.z[1]), f64::from(plane.z[2])];
    let [d10, d20, d21] = differences;
    let full = f64::from(format.largest());
    pixels.each_part(shape, lanes, |passes, lanes| {
        let out = &mut out[lanes];
        let ([e0, e1, e2], reciprocals) = (&passes.edges, &passes.reciprocals);
        let (e0, e1, e2) = (&e0[..out.len()], &e1[..out.len()], &e2[..out.len()]);
        let reciprocals = &reciprocals[..out.len()];
        let depth = |n: usize| {
            let e = [e0[n], e1[n], e2[n]];
            let [x0, x1, x2] = [e[0].exponent(), e[1].exponent(), e[2].exponent()];
            let second = (x1 >= x0) & (x1 >= x2);
            let first = !second & (x0 >= x2);
            // The two others: 0 and 2, 1 and 2, or 0 and 1. One choice at a time, because compilers turn nested ones into branches.
            let (one, other) = (if first { e[1] } else { e[0] }, if first | second { e[2] } else { e[1] });
            let by_one = if first { d10 } else { -d20 };
            let by_one = if second { -d10 } else { by_one };
            let by_other = if first { d20 } else { -d21 };
            let by_other = if second { d21 } else { by_other };
            let z = if first { z0 } else { z2 };
            let z = if second { z1 } else { z };
            let weight = |e: f64| e.times(reciprocals[n]).cut();
            f64::aligned_sum::<29>([weight(one) * by_one, z, weight(other) * by_other])
        };
        if format.is_float() {
            for n in 0..out.len() {
                out[n] = word(format, depth(n));
            }
        } else {
            for n in 0..out.len() {
                out[n] = floor_within(depth(n), 0.0, full) as u32;
            }
        }
    });
}

/// DEP-3: returns the word of a depth in steps.
#[inline(always)]
pub(crate) fn word(format: DepthFormat, depth: f64) -> u32 {
    let depth = larger(depth, 0.0);
    if !format.is_float() {
        return floor_within(depth, 0.0, f64::from(format.largest())) as u32;
    }
    let (kept, bias, end) = if format == DepthFormat::Z16F { (12, 7, 1 << 16) } else { (16, 127, 255 << 16) };
    let word = (depth.to_bits() >> (52 - kept)) as i64 - ((1023 - bias) << kept);
    match word {
        ..0 => 0,
        tiny if tiny >> kept == 0 => 0,
        huge if huge >= end => format.largest(),
        word => word as u32,
    }
}
