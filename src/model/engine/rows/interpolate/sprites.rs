//! PNT-2 on rows: where the pixels of a point sample its picture. Columns and rows are computed once for all points of a size that lie alike in
//! their pixels.
#![allow(clippy::float_arithmetic, reason = "whole numbers that doubles hold")]

use crate::engine::context::TriangleContext;
use crate::engine::rows::geometry::weights::Pixels;
use crate::engine::rows::lanes::{Run, nearest};
use crate::engine::rows::sampling::place::Place;
use crate::engine::rows::sampling::sampler::Sampler;
use crate::raster::stroke::{Figure, sprite_coordinate};
use std::ops::Range;

/// Columns or rows of the largest point, with those beside it that quads have, fit into so many; a power of two.
const SIDE: usize = 128;

/// Places of a point within its pixel, along an axis.
const PHASES: usize = 16;

/// Columns or rows that are copied at a time.
const WIDTH: usize = 8;

/// What the coordinates of columns or rows follow from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Axis {
    /// The first column or row, after that of the point.
    start: i32,
    count: i32,
    /// The place of the point within its pixel.
    phase: usize,
    /// The point's size.
    size: u16,
    /// Number of texels of the image.
    side: u32,
    /// Fraction bits of coordinates, and what is taken off them.
    bits: u32,
    bias: i32,
}

/// Coordinates of the columns or rows of a point.
#[derive(Clone, Copy, Debug)]
struct Coordinates {
    axis: Option<Axis>,
    /// In 1/65536 texel if quads are taken, otherwise as [`Place::at`] has them.
    values: [i32; SIDE + WIDTH],
}

impl Coordinates {
    /// Sets them for an axis.
    fn set(&mut self, axis: Axis) {
        if self.axis.replace(axis) == Some(axis) {
            return;
        }
        let Axis { start, count, phase, size, side, bits, bias } = axis;
        for (out, n) in self.values.iter_mut().zip(start..start + count) {
            let d = i64::from(16 * n + 8) - phase as i64;
            *out = sprite_coordinate(d, size.into(), side.into(), bits.into()) as i32 - bias;
        }
    }
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
            self.coordinates = vec![[Coordinates { axis: None, values: [0; SIDE + WIDTH] }; PHASES]; 2];
        }
        let (at, size) = (context.corners()[1].position, draw.assembly.size_of(context.number));
        let (bits, bias) = if sampler.takes_quads() { (16, 0) } else { (8, sampler.bias()) };
        for (axis, (first, end)) in [point.columns, point.rows].into_iter().enumerate() {
            // Quads have columns and rows beside the point.
            let (first, end) = (first & !1, (end + 1) & !1);
            let (pixel, phase) = (at[axis].div_euclid(PHASES as i32), at[axis].rem_euclid(PHASES as i32));
            (self.first[axis], self.phase[axis]) = (first as f64, phase as usize);
            let (start, count, phase) = (first as i32 - pixel, (end - first) as i32, phase as usize);
            let of = Axis { start, count, phase, size, side: sampler.sides[axis], bits, bias };
            self.coordinates[axis][phase].set(of);
        }
    }

    /// Returns whether a sampler has the coordinates of the point.
    #[inline(always)]
    pub(crate) fn applies(&self, sampler: &Sampler) -> bool {
        self.is_set && sampler.is_sprite
    }

    /// Computes where lanes sample, whose pixels are those of the runs.
    #[inline(always)]
    pub(crate) fn compute_places(
        &self,
        sampler: &Sampler,
        pixels: &Pixels,
        lanes: Range<usize>,
        runs: &[Run],
        place: &mut Place,
    ) {
        let [columns, rows] = [0, 1].map(|axis| &self.coordinates[axis][self.phase[axis]].values);
        // Lanes without a pixel may lie anywhere.
        let index = |n: f64, axis: usize| nearest(n - self.first[axis]) as usize % SIDE;
        if !sampler.takes_quads() {
            let [u, v] = &mut place.at;
            for run in runs {
                let (lane, count) = (run.lane(), run.count().next_multiple_of(WIDTH));
                let from = columns[index(pixels.x[lane], 0)..].as_chunks::<WIDTH>().0;
                // Whole vectors, of which the next run overwrites what is too much.
                for (out, from) in u[lane..lane + count].as_chunks_mut::<WIDTH>().0.iter_mut().zip(from) {
                    *out = *from;
                }
                let row = rows[index(pixels.y[lane], 1)];
                for out in v[lane..lane + count].as_chunks_mut::<WIDTH>().0 {
                    *out = [row; WIDTH];
                }
            }
            return;
        }
        for (axis, (of, values)) in [(&pixels.x, columns), (&pixels.y, rows)].into_iter().enumerate() {
            let (of, fine) = (&of[lanes.clone()], &mut place.fine[axis][lanes.clone()]);
            for n in 0..of.len() {
                fine[n] = values[index(of[n], axis)].into();
            }
        }
        // Nothing is divided, and nothing lies behind the viewer.
        place.direction[2][lanes.clone()].fill(1.0);
        if sampler.pairs > 0 {
            place.settle(lanes, sampler.bias());
        }
    }
}
