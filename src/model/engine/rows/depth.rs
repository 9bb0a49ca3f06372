//! Depths on rows: the definition's integers as doubles, which hold them exactly; docs/exactness.md says why.
#![allow(
    clippy::float_arithmetic,
    reason = "whole numbers, and cuts at powers of two, of which docs/exactness.md gives account"
)]

use super::fetch::PerLane;
use super::quotient::{IOTA_REAL, Line, Positions, nearest, position, whole};
use super::triangle::PixelBatch;
use crate::engine::pixel::TriangleContext;
use crate::raster::depth::w_ratio;
use crate::raster::interpolate::most_dominant;
use crate::state::{DepthFormat, DepthRange, VertexDepths};

/// Bits of a double below the 24 that count.
const BELOW: u64 = (1 << 29) - 1;

/// Sign and exponent of a double.
const EXPONENT: u64 = 0xfff << 52;

/// 2^-28.
const STEP: f64 = 1.0 / (1_u64 << 28) as f64;

/// The exponent of 1.
const ONE: u64 = 1023 << 52;

/// A depth that no buffer has: the definition computes it.
pub(super) const UNKNOWN: u32 = u32::MAX;

/// A depth that no buffer has: the pixel is outside the draw's range, and dropped (DEP-4).
pub(super) const OUTSIDE: u32 = u32::MAX - 1;

/// Depths at the vertices of a triangle, the largest depth, and what happens to depths that are not just floored.
#[derive(Clone, Copy, Debug)]
struct Depths<'a> {
    z: [f64; 3],
    /// In a w buffer, what edge numbers are multiplied by (DEP-6); `z` holds w there.
    ratios: [f64; 3],
    full: f64,
    offset: f64,
    range: Option<&'a DepthRange>,
    format: DepthFormat,
}

/// Depth of the pixels of a batch.
#[inline(always)]
pub(super) fn depths<const FMA: bool, const ROW: bool>(
    context: &TriangleContext<'_>,
    batch: PixelBatch<'_>,
    out: &mut PerLane<u32>,
) {
    let (triangle, plane, draw) = (&context.triangle, &context.depth, context.draw);
    let Some(test) = &draw.depth_test else { return };
    let e = triangle.edges(batch.first.0, batch.first.1);
    let edge = |k: usize| Line { c: e[k] as f64, x: triangle.a[k] as f64, y: triangle.b[k] as f64 };
    let format = draw.depth_format;
    let offset = plane.offset.mantissa as f64 * power_of_two(plane.offset.exponent);
    let (z, full) = (plane.z.map(f64::from), f64::from(format.largest()));
    let range = test.range.as_ref();
    let depths = Depths { z, ratios: [1.0; 3], full, offset, range, format };
    let out = &mut out[batch.lanes()];
    let edges = [edge(0), edge(1), edge(2)];
    let whole = |z: &f32| *z >= 0.0 && *z < 16_777_216.0 && z.fract() == 0.0;
    // Zero, or far from where binary32 or the steps between are at their ends.
    let moderate = |z: &f32| *z == 0.0 || (1e-18..1e30).contains(&z.abs());
    // Floored, and nothing else.
    let is_plain = range.is_none() && offset == 0.0 && !format.is_float();
    let exact_offset = plane.offset.mantissa.unsigned_abs() >> 53 == 0 && offset.is_finite();
    let unknown = if let Some(w) = plane.w {
        if exact_offset && w.iter().all(|w| *w > 0.0 && moderate(w)) {
            let ratio = |(mantissa, exponent): (i64, i32)| mantissa as f64 * power_of_two(exponent);
            let ratios = w.map(|of| ratio(w_ratio(w[1], of)));
            let depths = Depths { z: w.map(f64::from), ratios, ..depths };
            if is_plain {
                depths.along::<FMA, ROW, false, true>(batch.at, edges, out)
            } else {
                depths.along::<FMA, ROW, true, true>(batch.at, edges, out)
            }
        } else {
            out.fill(UNKNOWN);
            true
        }
    } else if is_plain && (test.vertex_depths == VertexDepths::Fractions || plane.z.iter().all(whole)) {
        depths.along::<FMA, ROW, false, false>(batch.at, edges, out)
    } else if exact_offset && plane.z.iter().all(moderate) {
        depths.along::<FMA, ROW, true, false>(batch.at, edges, out)
    } else {
        out.fill(UNKNOWN);
        true
    };
    if unknown {
        for (n, depth) in out.iter_mut().enumerate().filter(|(_, depth)| **depth == UNKNOWN) {
            *depth = context.depth_word(&batch.sample(n, triangle)).unwrap_or(OUTSIDE);
        }
    }
}

/// 2^exponent; 0 or infinite where a double has no such power.
fn power_of_two(exponent: i32) -> f64 {
    match exponent {
        -1022..=1023 => f64::from_bits(((exponent + 1023) as u64) << 52),
        1024.. => f64::INFINITY,
        _ => 0.0,
    }
}

impl Depths<'_> {
    /// Whether some are unknown. `GENERAL`: depths are not just floored. `W`: in a w buffer.
    #[inline(always)]
    fn along<const FMA: bool, const ROW: bool, const GENERAL: bool, const W: bool>(
        &self,
        at: Positions<'_>,
        edges: [Line; 3],
        out: &mut [u32],
    ) -> bool {
        let lanes = out.len();
        let (last, [z0, z1, z2], [r0, r1, r2]) = (f64::from(at.last), self.z, self.ratios);
        let (xs, ys, iota) = (&at.x[..lanes], &at.y[..lanes], &IOTA_REAL[..lanes]);
        for n in 0..lanes {
            let (x, y) = position::<ROW>(n, last, xs, ys, iota);
            let e0 = edges[0].at::<FMA, ROW>(x, y);
            let e1 = edges[1].at::<FMA, ROW>(x, y);
            let e2 = edges[2].at::<FMA, ROW>(x, y);
            let (e0, e1, e2) =
                if W { (cut24(cut24(e0) * r0), cut24(cut24(e1) * r1), cut24(cut24(e2) * r2)) } else { (e0, e1, e2) };
            let (x0, x1, x2) = (power(e0), power(e1), power(e2));
            let second = (x1 >= x0) & (x1 >= x2);
            let first = x0 >= x2;
            let z = if first { z0 } else { z2 };
            let z = if W | second { z1 } else { z };
            let top = if x0 > x2 { x0 } else { x2 };
            let top = if x1 > top { x1 } else { top };
            // The edge numbers as multiples of 2^(X-28), X being the exponent of the largest.
            let scale = f64::from_bits((2 * ONE + (28 << 52)).wrapping_sub(top.to_bits()));
            let (e0, e1, e2) = (cut24(e0) * scale, cut24(e1) * scale, cut24(e2) * scale);
            // The definition has 61 bits of the largest.
            let (e0, e1, e2) = if W { (kept(e0, 32), kept(e1, 32), kept(e2, 32)) } else { (e0, e1, e2) };
            let sum = floor(e0) + floor(e1) + floor(e2);
            let length = power(sum);
            let quotient = length * (1_i64 << 29) as f64 / sum;
            let low = quotient - 0.1875;
            let reciprocal = floor(low);
            let exact = length == sum;
            // A quotient that was rounded to the border of two reciprocals.
            let close = (reciprocal == low) & !exact;
            let reciprocal = if exact { (1_i64 << 29) as f64 } else { reciprocal };
            // What makes weights of them.
            let unit = f64::from_bits((2 * ONE - (29 << 52)).wrapping_sub(length.to_bits()));
            let b0 = cut24(e0 * reciprocal) * unit;
            let b1 = cut24(e1 * reciprocal) * unit;
            let b2 = cut24(e2 * reciprocal) * unit;
            let (b0, b2, close) = if W { with_rest([b0, b1, b2], close) } else { (b0, b2, close) };
            // Of the reference vertex: 0.
            let (d0, d1, d2) = (z0 - z, z1 - z, z2 - z);
            // Differences of whole numbers need no rounding.
            let rounded = |d: f64| if GENERAL | W { f64::from(d as f32) } else { d };
            let (t0, t1, t2) = (b0 * rounded(d0), b1 * rounded(d1), b2 * rounded(d2));
            let largest = if t0.abs() > t1.abs() { t0.abs() } else { t1.abs() };
            let largest = if t2.abs() > largest { t2.abs() } else { largest };
            let largest = if z.abs() > largest { z.abs() } else { largest };
            // Terms that small make no depth.
            let top = power(if largest > 1e-200 { largest } else { 1e-200 });
            let scale = f64::from_bits((2 * ONE + (28 << 52)).wrapping_sub(top.to_bits()));
            let sum = cut(t0 * scale) + cut(t1 * scale) + cut(t2 * scale) + cut(z * scale);
            let depth = sum * (top * STEP);
            if GENERAL {
                out[n] = if close { UNKNOWN } else { self.word(depth) };
                continue;
            }
            let depth = floor(depth);
            let depth = if depth > 0.0 { depth } else { 0.0 };
            let depth = if depth < self.full { depth } else { self.full };
            // -1 is UNKNOWN.
            out[n] = nearest(if close { -1.0 } else { depth }) as u32;
        }
        out.contains(&UNKNOWN)
    }

    /// DEP-3 to DEP-5 of an interpolated depth.
    #[inline(always)]
    fn word(&self, depth: f64) -> u32 {
        let sum = depth + self.offset;
        // What the sum lost, exactly; the definition has more bits than a double.
        let other = sum - depth;
        if (depth - (sum - other)) + (self.offset - other) != 0.0 {
            return UNKNOWN;
        }
        let mut depth = sum;
        if let Some(range) = self.range {
            let (lowest, highest) = (f64::from(range.lowest), f64::from(range.highest));
            if !range.clamps && (depth < lowest || depth > highest) {
                return OUTSIDE;
            }
            depth = depth.max(lowest).min(highest);
        }
        word(self.format, depth)
    }
}

/// DEP-3 of a depth.
#[inline(always)]
pub(super) fn word(format: DepthFormat, depth: f64) -> u32 {
    if depth <= 0.0 {
        return 0;
    }
    if !format.is_float() {
        return depth.min(f64::from(format.largest())) as u32;
    }
    let (kept, bias) = if format == DepthFormat::Z16F { (12, 7) } else { (16, 127) };
    let word = (depth.to_bits() >> (52 - kept)) as i64 - ((1023 - bias) << kept);
    match word {
        ..0 => 0,
        tiny if tiny >> kept == 0 => 0,
        huge if huge >= if kept == 12 { 1 << 16 } else { 255 << 16 } => format.largest(),
        word => word as u32,
    }
}

/// DEP-6: the first weight and the third, of which the dominant one is what the others leave of 1; and whether that is too close to call, or was.
#[inline(always)]
fn with_rest([b0, b1, b2]: [f64; 3], close: bool) -> (f64, f64, bool) {
    let [first, third] = most_dominant([power(b0), power(b1), power(b2)]);
    // Where the second dominates, nobody reads it.
    // One choice at a time: nested ones would become branches.
    let other = if first { b2 } else { b0 };
    let (one, other) = (kept(b1, 60), kept(other, 60));
    let large = if one > other { one } else { other };
    let small = if one > other { other } else { one };
    let most = 1.0 - large;
    let rest = most - small;
    // What the differences lost, exactly.
    let lost = ((1.0 - most) - large != 0.0) | ((most - rest) - small != 0.0);
    let same = cut24(rest * (1.0 - ROUNDINGS)) == cut24(rest * (1.0 + ROUNDINGS));
    let rest = cut24(rest);
    let b0 = if first { rest } else { b0 };
    let b2 = if third { rest } else { b2 };
    (b0, b2, close | (lost & !same & (first | third)))
}

/// More than two roundings.
const ROUNDINGS: f64 = 1.0 / (1_u64 << 50) as f64;

/// A number of at most 24 bits that is not negative, floored at 2^-`bits`.
#[inline(always)]
fn kept(n: f64, bits: u32) -> f64 {
    let steps = n * (1_u64 << bits) as f64;
    // All others are whole; not all of them could be floored.
    let floored = floor(steps) * (1.0 / (1_u64 << bits) as f64);
    if steps < (1_u64 << 40) as f64 { floored } else { n }
}

/// The largest power of two that is not above a positive number.
#[inline(always)]
fn power(n: f64) -> f64 {
    f64::from_bits(n.to_bits() & EXPONENT)
}

/// The first 24 bits.
#[inline(always)]
fn cut24(n: f64) -> f64 {
    f64::from_bits(n.to_bits() & !BELOW)
}

/// The largest whole number that is not above another number of less than 51 bits.
#[inline(always)]
pub(super) fn floor(n: f64) -> f64 {
    let near = whole(n);
    if near > n { near - 1.0 } else { near }
}

/// Cut toward zero.
#[inline(always)]
fn cut(n: f64) -> f64 {
    let magnitude = floor(n.abs());
    if n < 0.0 { -magnitude } else { magnitude }
}
