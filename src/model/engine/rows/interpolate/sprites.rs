//! PNT-2 on rows: where the pixels of a point sample its picture. Columns and rows are computed once for all points of a size that lie alike in
//! their pixels.
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

/// Places of a point within its pixel, along an axis.
const PHASES: usize = 16;

/// Coordinates of the columns or rows of a point.
#[derive(Clone, Copy, Debug)]
struct Coordinates {
    /// The first column or row after that of the point, their number, the point's size, that of the image, and how the sampler reads them.
    key: [i32; 6],
    /// In 1/65536 texel if quads are taken, otherwise as [`Place::at`] has them.
    values: [f64; SIDE],
}

/// The coordinates that a point gives to a sampler.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sprite {
    /// The first column and row.
    first: [f64; 2],
    phase: [usize; 2],
    /// Those of each axis and place within the pixel; empty before the first point.
    coordinates: Vec<[Coordinates; PHASES]>,
    is_set: bool,
}

impl Sprite {
    /// Sets up the point of a context for the sampler of sprites, if there are both.
    pub(crate) fn set(&mut self, context: &TriangleContext<'_>, samplers: &[Sampler]) {
        let (draw, point) = (context.draw, &context.triangle);
        let sampler = samplers.iter().find(|sampler| sampler.is_sprite && point.figure == Figure::Point);
        self.is_set = sampler.is_some();
        let Some(sampler) = sampler else { return };
        if self.coordinates.is_empty() {
            self.coordinates = vec![[Coordinates { key: [0; 6], values: [0.0; SIDE] }; PHASES]; 2];
        }
        let (at, size) = (context.corners()[1].position, draw.assembly.size_of(context.number));
        let (bits, bias) = if sampler.takes_quads() { (16, 0) } else { (8, sampler.bias()) };
        for (axis, (first, end)) in [point.columns, point.rows].into_iter().enumerate() {
            // Quads have columns and rows beside the point.
            let (first, end) = (first & !1, (end + 1) & !1);
            let (pixel, phase) = (at[axis].div_euclid(PHASES as i32), at[axis].rem_euclid(PHASES as i32));
            (self.first[axis], self.phase[axis]) = (first as f64, phase as usize);
            let (side, start) = (sampler.sides[axis], first as i32 - pixel);
            let key = [start, (end - first) as i32, size.into(), side as i32, bits, bias];
            let coordinates = &mut self.coordinates[axis][phase as usize];
            if coordinates.key == key {
                continue;
            }
            coordinates.key = key;
            for (out, n) in coordinates.values.iter_mut().zip(start..start + key[1]) {
                let d = i64::from(16 * n + 8 - phase);
                *out = (sprite_coordinate(d, size.into(), side.into(), bits.into()) - i64::from(bias)) as f64;
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
            let coordinates = &self.coordinates[axis][self.phase[axis]].values;
            let (first, of) = (self.first[axis], &of[lanes.clone()]);
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
