//! DEP-1, DEP-3 and DEP-6 on rows. Offsets and ranges (DEP-4, DEP-5) are the text of the definition, pixel by pixel.
//!
//! ```text
//! d: the vertex of the largest binary exponent among the E_k; of equals 1 before 0 before 2     in a w buffer: vertex 1
//! depth = sum of z_d and b_k (z_k - z_d) for the two others, each cut at the 29th bit of the largest
//! ```
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly")]

use crate::engine::context::TriangleContext;
use crate::engine::rows::geometry::shape::Shape;
use crate::engine::rows::geometry::weights::{CHUNK, Passes, Pixels};
use crate::engine::rows::lanes::{PerLane, floor_within, larger};
use crate::raster::binary::Binary;
use crate::raster::depth;
use crate::raster::doubles::lost_by_sum;
use crate::raster::weights::{Linear, Number, difference, ratios, shares};
use crate::state::DepthFormat;
use std::ops::Range;

/// Marks a pixel outside the draw's depth range, which is dropped (DEP-4). No buffer has it.
pub(crate) const OUTSIDE: u32 = u32::MAX - 1;

/// Depths of the vertices of a triangle.
#[derive(Clone, Copy)]
struct Vertices {
    z: [f64; 3],
    /// The differences z_1 - z_0, z_2 - z_0 and z_2 - z_1.
    differences: [f64; 3],
}

impl Vertices {
    fn new(z: [f32; 3]) -> Vertices {
        let between = |a: usize, b: usize| f64::from(difference(z[a], z[b]));
        Vertices { z: z.map(f64::from), differences: [between(1, 0), between(2, 0), between(2, 1)] }
    }

    /// DEP-1: returns the depth where these are the edge numbers, whose sum has the given reciprocal.
    #[inline(always)]
    fn depth(&self, e: [f64; 3], reciprocal: f64) -> f64 {
        let ([z0, z1, z2], [d10, d20, d21]) = (self.z, self.differences);
        let [x0, x1, x2] = [e[0].exponent::<true>(), e[1].exponent::<true>(), e[2].exponent::<true>()];
        let second = !f64::is_above(x0, x1) & !f64::is_above(x2, x1);
        let first = !second & !f64::is_above(x2, x0);
        // The two others: 0 and 2, 1 and 2, or 0 and 1.
        let (one, other) = (e[1].or(first, e[0]), e[2].or(first | second, e[1]));
        let by_one = (-d10).or(second, d10.or(first, -d20));
        let by_other = d21.or(second, d20.or(first, -d21));
        let z = z1.or(second, z0.or(first, z2));
        let (one, other) = ((one * reciprocal).cut(), (other * reciprocal).cut());
        f64::sum_of_products([[one, by_one], [1.0, z], [other, by_other]])
    }
}

/// DEP-6: returns 1 less two weights of which 60 fraction bits count, toward zero to 24 bits.
#[inline(always)]
fn rest(a: f64, b: f64) -> f64 {
    const UNIT: f64 = (1_u64 << 60) as f64;
    let (a, b) = ((a * UNIT).floor() * (1.0 / UNIT), (b * UNIT).floor() * (1.0 / UNIT));
    let sum = a + b;
    let rest = 1.0 - sum;
    // What both roundings lost. It matters where the rest looks like a number of 24 bits.
    let lost = ((1.0 - rest) - sum) - lost_by_sum(a, b);
    let cut = rest.cut();
    f64::from_bits(cut.to_bits() - if (cut == rest) & (lost < 0.0) { 1 << 29 } else { 0 })
}

/// Computes the depths of lanes.
#[inline(always)]
pub(crate) fn depths<const FMA: bool>(
    context: &TriangleContext<'_>,
    shape: &Shape,
    lanes: Range<usize>,
    pixels: &mut Pixels,
    out: &mut PerLane<u32>,
) {
    let plane = &context.depth;
    let (vertices, w) = (Vertices::new(plane.z), Linear::new(plane.w.unwrap_or_default()));
    let ratios = plane.w.map(|w| ratios([w[0].into(), w[1].into(), w[2].into()]));
    let mut found = [0.0; CHUNK];
    for first in lanes.clone().step_by(CHUNK) {
        let part = first..(first + CHUNK).min(lanes.end);
        let found = &mut found[..part.len()];
        let Passes { edges: [e0, e1, e2], reciprocals, .. } = pixels.part::<FMA>(shape, ratios, part.clone());
        if ratios.is_some() {
            for n in 0..found.len() {
                found[n] = depth::w_of_shares::<_, true>(shares([e0[n], e1[n], e2[n]], reciprocals[n]), w, rest);
            }
        } else {
            for n in 0..found.len() {
                found[n] = vertices.depth([e0[n], e1[n], e2[n]], reciprocals[n]);
            }
        }
        words(context, found, &mut out[part]);
    }
}

/// DEP-3 to DEP-5: writes the words of depths.
#[inline(always)]
fn words(context: &TriangleContext<'_>, depths: &[f64], out: &mut [u32]) {
    let (plane, format) = (&context.depth, context.draw.depth_format);
    let range = context.draw.depth_test.as_ref().and_then(|test| test.range.as_ref());
    if plane.offset.mantissa != 0 || range.is_some() {
        for n in 0..out.len() {
            let depth = plane.with_offset(Binary::from_double(depths[n]));
            out[n] = depth::ranged(range, depth).map_or(OUTSIDE, |depth| depth::word(format, depth));
        }
    } else if format.is_float() {
        for n in 0..out.len() {
            out[n] = word(format, depths[n]);
        }
    } else {
        let full = f64::from(format.largest());
        for n in 0..out.len() {
            out[n] = floor_within(depths[n], 0.0, full) as u32;
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::weights::edge_numbers;

    /// Differences of the largest depths lie beyond single precision.
    #[test]
    fn extreme_depths_are_those_of_the_definition() {
        let ends = [f32::MIN, -1.329_228e36, 0.0, f32::MIN_POSITIVE, 1.0, 16_777_215.0, 1.329_228e36, f32::MAX];
        let edges = [[5, 7, 1000], [900, 31, 0], [3, 70_000_001, 12], [1, 1, 1], [1, 1, 1 << 36]];
        for z in ends.iter().flat_map(|a| ends.iter().flat_map(move |b| ends.map(|c| [*a, *b, c]))) {
            for e in edges {
                let numbers = edge_numbers(e.map(f64::from_edge), None);
                let found = Vertices::new(z).depth(numbers, f64::sum_of_edges::<true>(numbers).reciprocal::<true>());
                let exact = depth::interpolate(e, z);
                assert_eq!(found, exact.mantissa as f64 * 2_f64.powi(exact.exponent as i32), "{z:?} {e:?}");
            }
        }
    }
}
