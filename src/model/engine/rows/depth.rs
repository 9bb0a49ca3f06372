//! DEP-1 on rows.
#![allow(
    clippy::float_arithmetic,
    reason = "whole numbers and quotients whose rounding docs/exactness.md accounts for"
)]

use super::fetch::Numbers;
use super::quotient::{IOTA_REAL, Line, Positions, nearest, position, whole};
use super::triangle::Piece;
use crate::engine::pixel::TriangleContext;
use crate::raster::interpolate::most_dominant;

/// Twice the area below which quotients of edge functions by it, rounded to double precision, have the right 24 bits.
const LARGEST: i64 = 1 << 29;

/// Bits of a double below the 24 that count.
const BELOW: u64 = (1 << 29) - 1;

/// Sign and exponent of a double.
const EXPONENT: u64 = 0xfff << 52;

/// Depths at the vertices of a triangle.
#[derive(Clone, Copy, Debug)]
struct Depths {
    z: [f64; 3],
    /// The largest depth.
    full: f64,
}

/// Depth of the pixels of a piece. Twice the area suits [`LARGEST`], or each pixel is the definition's.
#[inline(always)]
pub(super) fn depths<const FMA: bool, const ROW: bool>(
    context: &TriangleContext<'_>,
    piece: Piece<'_>,
    out: &mut Numbers<u32>,
) {
    let (triangle, z, full) = (&context.triangle, context.z, context.draw.depth_full);
    if triangle.doubled_area >= LARGEST {
        for n in 0..piece.count {
            out[piece.lane + n] = piece.sample(n, triangle).depth(z, full) as u32;
        }
        return;
    }
    let e = triangle.edges(piece.first.0, piece.first.1);
    let edge = |k: usize| Line { c: e[k] as f64, x: triangle.a[k] as f64, y: triangle.b[k] as f64 };
    let depths = Depths { z: [z[0] as f64, z[1] as f64, z[2] as f64], full: full as f64 };
    let (edges, area) = ([edge(0), edge(1), edge(2)], triangle.doubled_area as f64);
    depths.along::<FMA, ROW>(piece.at, edges, area, &mut out[piece.lanes()]);
}

impl Depths {
    #[inline(always)]
    fn along<const FMA: bool, const ROW: bool>(&self, at: Positions<'_>, e: [Line; 3], area: f64, out: &mut [u32]) {
        let lanes = out.len();
        let (last, [z0, z1, z2]) = (f64::from(at.last), self.z);
        let (xs, ys, iota) = (&at.x[..lanes], &at.y[..lanes], &IOTA_REAL[..lanes]);
        for n in 0..lanes {
            let (x, y) = position::<ROW>(n, last, xs, ys, iota);
            let a = e[0].at::<FMA, ROW>(x, y) / area;
            let b = e[1].at::<FMA, ROW>(x, y) / area;
            let c = e[2].at::<FMA, ROW>(x, y) / area;
            let [first, third] = most_dominant([class(a), class(b), class(c)]);
            let z = if first { z0 } else { z1 };
            let z = if third { z2 } else { z };
            // Of the dominant vertex: 0.
            let (a, b, c) = (truncated(a) * (z0 - z), truncated(b) * (z1 - z), truncated(c) * (z2 - z));
            let (whole_a, whole_b, whole_c) = (whole(a), whole(b), whole(c));
            // Between -1 and 1, exactly.
            let rest = (a - whole_a) + (b - whole_b) + (c - whole_c);
            let carry = if rest >= 1.0 { 1.0 } else { 0.0 };
            let carry = if rest < 0.0 { -1.0 } else { carry };
            let depth = z + whole_a + whole_b + whole_c + carry;
            let depth = if depth > 0.0 { depth } else { 0.0 };
            out[n] = nearest(if depth < self.full { depth } else { self.full }) as u32;
        }
    }
}

/// The class of a weight (INT-3) as a number that is larger for larger weights: a power of two counts as just below itself, 0 is below all.
#[inline(always)]
fn class(weight: f64) -> f64 {
    f64::from_bits(weight.to_bits().wrapping_sub(1) & EXPONENT)
}

/// The first 24 bits.
#[inline(always)]
fn truncated(weight: f64) -> f64 {
    f64::from_bits(weight.to_bits() & !BELOW)
}
