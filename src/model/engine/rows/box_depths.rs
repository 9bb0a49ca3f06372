//! Depths in boxes of small triangles, set up eight at a time.
#![allow(clippy::float_arithmetic, reason = "whole numbers, and cuts at powers of two, as in `depth.rs`")]

use super::depth::{all_differences, floored_word, uncut_terms, unit_of_weights};
use super::kernels::PerLane;
use super::reciprocal::bits_of_reciprocal;
use super::setup::PixelBatch;
use super::shapes::{Each, GROUP, Lines, Shapes};
use crate::number::convert::depth as fraction;
use crate::plan::PlannedDraw;
use crate::state::{DepthFormat, PolygonOffset, VertexDepths};

/// Returns whether depths of a draw, if it has any, are fractions of whole steps that are floored and nothing else.
pub(super) fn are_floored(draw: &PlannedDraw) -> bool {
    draw.depth_test.as_ref().is_none_or(|test| {
        test.vertex_depths == VertexDepths::Fractions
            && test.offset == PolygonOffset { bias: 0.0, factor: 0.0 }
            && test.range.is_none()
            && !(test.w_buffer || draw.depth_format.is_float())
    })
}

/// Depths in boxes of small triangles, for a draw for which [`are_floored`] holds.
#[derive(Debug, Default)]
pub(super) struct BoxDepths {
    edges: [Lines; 3],
    z: [Each<f64>; 3],
    /// Differences of the depths of vertices 1 and 0, 2 and 0, 2 and 1, times the [unit](unit_of_weights).
    differences: [Each<f64>; 3],
    reciprocal: Each<f64>,
}

impl BoxDepths {
    /// Sets up all boxes, from z at the vertices.
    #[inline(always)]
    pub(super) fn set_up(&mut self, z: &[Each<f32>; 3], format: DepthFormat, shapes: &Shapes) {
        let (bits, mut unit) = (format.bits(), [0.0; GROUP]);
        for n in 0..GROUP {
            // There is no area past the last box.
            let area = i64::from(shapes.doubled_area[n]).max(1);
            for k in 0..3 {
                self.z[k][n] = fraction(z[k][n], bits) as f64;
            }
            (self.reciprocal[n], unit[n]) = (bits_of_reciprocal(area), unit_of_weights(area));
        }
        self.edges = [shapes.lines(0), shapes.lines(1), shapes.lines(2)];
        // Exact in binary32, too, because depths are whole numbers of at most 24 bits.
        for (differences, (a, b)) in self.differences.iter_mut().zip([(1, 0), (2, 0), (2, 1)]) {
            for n in 0..GROUP {
                differences[n] = (self.z[a][n] - self.z[b][n]) * unit[n];
            }
        }
    }

    /// Writes the depths of one box.
    #[inline(always)]
    pub(super) fn write<const FMA: bool>(
        &self,
        n: usize,
        batch: PixelBatch<'_>,
        format: DepthFormat,
        out: &mut PerLane<u32>,
    ) {
        let differences = all_differences(self.differences[0][n], self.differences[1][n], self.differences[2][n]);
        let edges = [self.edges[0].of(n), self.edges[1].of(n), self.edges[2].of(n)];
        let (z, full) = ([self.z[0][n], self.z[1][n], self.z[2][n]], f64::from(format.largest()));
        let reciprocal = (self.reciprocal[n], differences);
        let out = &mut out[batch.lanes()];
        let (xs, ys) = (&batch.at.x[..out.len()], &batch.at.y[..out.len()]);
        for n in 0..out.len() {
            let at = (f64::from(xs[n]), f64::from(ys[n]));
            out[n] = floored_word::<FMA>(uncut_terms::<FMA, false>(at, edges, z, reciprocal), full);
        }
    }
}
