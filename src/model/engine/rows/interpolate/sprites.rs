//! PNT-2 on rows: where the pixels of a point sample its picture. Columns and rows are computed once for each point.
#![allow(clippy::float_arithmetic, reason = "whole numbers that doubles hold")]

use crate::engine::context::TriangleContext;
use crate::engine::rows::geometry::weights::Pixels;
use crate::engine::rows::lanes::nearest;
use crate::engine::rows::sampling::place::Place;
use crate::engine::rows::sampling::sampler::Sampler;
use crate::raster::stroke::{Figure, sprite_coordinate};
use std::ops::Range;

/// Columns or rows of the largest point, with those beside it that quads have, fit into so many; a power of two.
const SIDE: usize = 128;

/// The coordinates that a point gives to a sampler.
#[derive(Clone, Debug)]
pub(crate) struct Sprite {
    /// The first column and row.
    first: [f64; 2],
    /// The coordinates in each column and row, in 1/65536 texel if quads are taken, otherwise as [`Place::at`] has them.
    coordinates: [[f64; SIDE]; 2],
    is_set: bool,
}

impl Default for Sprite {
    fn default() -> Self {
        Sprite { first: [0.0; 2], coordinates: [[0.0; SIDE]; 2], is_set: false }
    }
}

impl Sprite {
    /// Sets up the point of a context for the sampler of sprites, if there are both.
    pub(crate) fn set(&mut self, context: &TriangleContext<'_>, samplers: &[Sampler]) {
        let (draw, point) = (context.draw, &context.triangle);
        let sampler = samplers.iter().find(|sampler| sampler.is_sprite && point.figure == Figure::Point);
        self.is_set = sampler.is_some();
        let Some(sampler) = sampler else { return };
        let (at, size) = (context.corners()[1].position, draw.assembly.size_of(context.number));
        let (bits, bias) = if sampler.takes_quads() { (16, 0) } else { (8, sampler.bias()) };
        for (axis, (first, end)) in [point.columns, point.rows].into_iter().enumerate() {
            // Quads have columns and rows beside the point.
            let (first, end) = (first & !1, (end + 1) & !1);
            let of = |n: i64| {
                sprite_coordinate(16 * n + 8 - i64::from(at[axis]), size.into(), sampler.sides[axis].into(), bits)
            };
            self.first[axis] = first as f64;
            for (out, n) in self.coordinates[axis].iter_mut().zip(first..end) {
                *out = (of(n) - i64::from(bias)) as f64;
            }
        }
    }

    /// Computes where lanes sample. Returns whether the sampler has coordinates of a point.
    #[inline(always)]
    pub(crate) fn compute_places(
        &self,
        sampler: &Sampler,
        pixels: &Pixels,
        lanes: Range<usize>,
        place: &mut Place,
    ) -> bool {
        if !(self.is_set && sampler.is_sprite) {
            return false;
        }
        let takes_quads = sampler.takes_quads();
        for (axis, of) in [&pixels.x, &pixels.y].into_iter().enumerate() {
            let (coordinates, first, of) = (&self.coordinates[axis], self.first[axis], &of[lanes.clone()]);
            // Lanes without a pixel may lie anywhere.
            let coordinate = |n: f64| coordinates[nearest(n - first) as usize % SIDE];
            let (at, fine) = (&mut place.at[axis][lanes.clone()], &mut place.fine[axis][lanes.clone()]);
            if takes_quads {
                for n in 0..of.len() {
                    fine[n] = coordinate(of[n]);
                }
            } else {
                for n in 0..of.len() {
                    at[n] = nearest(coordinate(of[n]));
                }
            }
        }
        if takes_quads {
            // Nothing is divided, and nothing lies behind the viewer.
            place.direction[2][lanes.clone()].fill(1.0);
        }
        if sampler.pairs > 0 {
            place.settle(lanes, sampler.bias());
        }
        true
    }
}
