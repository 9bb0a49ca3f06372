//! DEP-1 on rows: the definition's integers as doubles, which hold them exactly; docs/exactness.md says why.
#![allow(
    clippy::float_arithmetic,
    reason = "whole numbers, and cuts at powers of two, of which docs/exactness.md gives account"
)]

use super::fetch::Numbers;
use super::quotient::{IOTA_REAL, Line, Positions, nearest, position, whole};
use super::triangle::Piece;
use crate::engine::pixel::TriangleContext;

/// Bits of a double below the 24 that count.
const BELOW: u64 = (1 << 29) - 1;

/// Sign and exponent of a double.
const EXPONENT: u64 = 0xfff << 52;

/// 2^-28.
const STEP: f64 = 1.0 / (1_u64 << 28) as f64;

/// The exponent of 1.
const ONE: u64 = 1023 << 52;

/// A depth that no buffer has: the definition computes it.
const UNKNOWN: u32 = u32::MAX;

/// Depths at the vertices of a triangle, and the largest depth.
#[derive(Clone, Copy, Debug)]
struct Depths {
    z: [f64; 3],
    full: f64,
}

/// Depth of the pixels of a piece.
#[inline(always)]
pub(super) fn depths<const FMA: bool, const ROW: bool>(
    context: &TriangleContext<'_>,
    piece: Piece<'_>,
    out: &mut Numbers<u32>,
) {
    let (triangle, z, full) = (&context.triangle, context.z, context.draw.depth_full);
    let e = triangle.edges(piece.first.0, piece.first.1);
    let edge = |k: usize| Line { c: e[k] as f64, x: triangle.a[k] as f64, y: triangle.b[k] as f64 };
    let depths = Depths { z: [z[0] as f64, z[1] as f64, z[2] as f64], full: full as f64 };
    let out = &mut out[piece.lanes()];
    if depths.along::<FMA, ROW>(piece.at, [edge(0), edge(1), edge(2)], out) {
        for (n, depth) in out.iter_mut().enumerate().filter(|(_, depth)| **depth == UNKNOWN) {
            *depth = piece.sample(n, triangle).depth(z, full) as u32;
        }
    }
}

impl Depths {
    /// Whether some are unknown.
    #[inline(always)]
    fn along<const FMA: bool, const ROW: bool>(&self, at: Positions<'_>, edges: [Line; 3], out: &mut [u32]) -> bool {
        let lanes = out.len();
        let (last, [z0, z1, z2]) = (f64::from(at.last), self.z);
        let (xs, ys, iota) = (&at.x[..lanes], &at.y[..lanes], &IOTA_REAL[..lanes]);
        for n in 0..lanes {
            let (x, y) = position::<ROW>(n, last, xs, ys, iota);
            let e0 = edges[0].at::<FMA, ROW>(x, y);
            let e1 = edges[1].at::<FMA, ROW>(x, y);
            let e2 = edges[2].at::<FMA, ROW>(x, y);
            let (x0, x1, x2) = (power(e0), power(e1), power(e2));
            let second = (x1 >= x0) & (x1 >= x2);
            let first = x0 >= x2;
            let z = if first { z0 } else { z2 };
            let z = if second { z1 } else { z };
            let top = if x0 > x2 { x0 } else { x2 };
            let top = if x1 > top { x1 } else { top };
            // The edge numbers as multiples of 2^(X-28), X being the exponent of the largest.
            let scale = f64::from_bits((2 * ONE + (28 << 52)).wrapping_sub(top.to_bits()));
            let (e0, e1, e2) = (cut24(e0) * scale, cut24(e1) * scale, cut24(e2) * scale);
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
            // Of the reference vertex: 0.
            let (t0, t1, t2) = (b0 * (z0 - z), b1 * (z1 - z), b2 * (z2 - z));
            let largest = if t0.abs() > t1.abs() { t0.abs() } else { t1.abs() };
            let largest = if t2.abs() > largest { t2.abs() } else { largest };
            let largest = if z > largest { z } else { largest };
            // Terms that small make no depth.
            let top = power(if largest > 1e-30 { largest } else { 1e-30 });
            let scale = f64::from_bits((2 * ONE + (28 << 52)).wrapping_sub(top.to_bits()));
            let sum = cut(t0 * scale) + cut(t1 * scale) + cut(t2 * scale) + floor(z * scale);
            let depth = floor(sum * (top * STEP));
            let depth = if depth > 0.0 { depth } else { 0.0 };
            let depth = if depth < self.full { depth } else { self.full };
            // -1 is UNKNOWN.
            out[n] = nearest(if close { -1.0 } else { depth }) as u32;
        }
        out.iter().fold(0, |all, depth| all | *depth) == UNKNOWN
    }
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
fn floor(n: f64) -> f64 {
    let near = whole(n);
    if near > n { near - 1.0 } else { near }
}

/// Cut toward zero.
#[inline(always)]
fn cut(n: f64) -> f64 {
    let magnitude = floor(n.abs());
    if n < 0.0 { -magnitude } else { magnitude }
}
