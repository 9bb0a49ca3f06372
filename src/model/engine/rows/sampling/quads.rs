//! TEX-11 on rows: what units derive from how coordinates change across quads, all of whose pixels are lanes of one block.
//!
//! ```text
//! for each quad:  coordinates of level 0 in 1/65536 texel at the upper left pixel, its right and its lower neighbour
//! for each quad:  a level of detail, or the taps of a footprint
//! for each lane:  what its quad has
//! ```
#![allow(clippy::float_arithmetic, reason = "whole numbers that doubles hold")]

use super::facing::{Facing, floors_on_face};
use super::place::{FARTHEST, Place};
use super::sampler::Sampler;
use crate::engine::rows::geometry::weights::Pixels;
use crate::engine::rows::lanes::{PerLane, STEP, larger};
use crate::raster::binary::Binary;
use crate::raster::interpolate::face_coordinate;
use crate::texture::coordinates::{face_of, on_face, quad_ratio};
use crate::texture::lod::Quad;
use crate::texture::planned::PlannedUnit;
use crate::texture::shader;

/// Coordinates of three pixels of each quad: u and v in 1/65536 texel, whole numbers.
pub(crate) type AtQuads = [[PerLane<f64>; 2]; 3];

/// A result that a unit derives from the coordinates at a quad.
pub(crate) trait Measure: Copy {
    /// Computes the results of quads. Sign bits of `open` are set for those that take whole numbers.
    fn measure(unit: &PlannedUnit, at: &AtQuads, out: &mut [Self], open: &mut [u64]);

    /// Computes the result of one quad in whole numbers. `None` stands for a quad of which a pixel lies behind the viewer.
    fn of_quad(unit: &PlannedUnit, quad: Option<Quad>) -> Self;
}

/// Quads side by side whose pixels are lanes of a block: the first lanes of their two rows, and their number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PixelQuads {
    pub(crate) upper: usize,
    pub(crate) lower: usize,
    pub(crate) count: usize,
}

/// The quads of a block, and scratch space for what is derived from them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Quads {
    all: Vec<PixelQuads>,
    at: AtQuads,
    /// Directions at the three pixels.
    directions: [[PerLane<f64>; 3]; 3],
    /// Not 0 for quads of which a pixel lies behind the viewer, or behind the face.
    behind: PerLane<i32>,
    /// Not 0 for quads whose coordinates take whole numbers.
    far: PerLane<i32>,
    /// Sign bits of quads whose results take whole numbers.
    open: PerLane<u64>,
}

/// Coordinates below this are exact as doubles.
const EXACT: f64 = (1_u64 << 50) as f64;

impl Quads {
    /// Adds quads to the block.
    pub(crate) fn add(&mut self, quads: PixelQuads) {
        self.all.push(quads);
    }

    /// Forgets the quads from one on.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.all.truncate(count);
    }

    /// Returns the number of entries.
    pub(crate) fn len(&self) -> usize {
        self.all.len()
    }

    /// Computes the results of all quads of a block.
    #[inline(always)]
    pub(crate) fn measure<T: Measure>(
        &mut self,
        (unit, sampler): (&PlannedUnit, &Sampler),
        pixels: &Pixels,
        place: &Place,
        out: &mut Vec<T>,
    ) {
        let count: usize = self.all.iter().map(|quads| quads.count).sum();
        let rounded = count.next_multiple_of(STEP);
        self.far[..rounded].fill(0);
        self.open[..rounded].fill(0);
        if out.len() < rounded {
            out.resize(rounded, T::of_quad(unit, None));
        }
        self.begin(pixels, rounded);
        if sampler.cube || !sampler.depends {
            self.take_directions(place);
        }
        if sampler.cube {
            self.project(f64::from(sampler.sides[0]), sampler.depends, rounded);
        } else {
            self.take(place, !sampler.depends, rounded);
        }
        T::measure(unit, &self.at, &mut out[..rounded], &mut self.open[..rounded]);
        let special = |n: &usize| self.behind[*n] | self.far[*n] | (self.open[*n] >> 63) as i32 != 0;
        for n in (0..count).filter(special) {
            out[n] = T::of_quad(unit, self.quad(n, sampler));
        }
    }

    /// Marks the quads of which a pixel lies behind the viewer.
    #[inline(always)]
    fn begin(&mut self, pixels: &Pixels, rounded: usize) {
        self.behind[..rounded].fill(0);
        for pixel in 0..3 {
            let [[scratch, ..], ..] = &mut self.directions;
            gather(&self.all, pixel, &pixels.reciprocals, scratch);
            let (behind, scratch) = (&mut self.behind[..rounded], &scratch[..rounded]);
            for n in 0..rounded {
                behind[n] |= i32::from(scratch[n] < 0.0);
            }
        }
    }

    /// Calls a function for each lane, with the number of its quad.
    #[inline(always)]
    pub(crate) fn each_lane(&self, mut call: impl FnMut(usize, usize)) {
        let mut quad = 0;
        for PixelQuads { upper, lower, count, .. } in self.all.iter().copied() {
            for first in [upper, lower] {
                for n in 0..count {
                    call(first + 2 * n, quad + n);
                    call(first + 2 * n + 1, quad + n);
                }
            }
            quad += count;
        }
    }

    /// Takes the coordinates of the quads' pixels.
    #[inline(always)]
    fn take(&mut self, place: &Place, divided: bool, rounded: usize) {
        for (pixel, at) in self.at.iter_mut().enumerate() {
            for (from, to) in place.fine.iter().zip(at) {
                gather(&self.all, pixel, from, to);
            }
        }
        if !divided {
            return;
        }
        let (behind, far) = (&mut self.behind[..rounded], &mut self.far[..rounded]);
        for (directions, [u, v]) in self.directions.iter().zip(&self.at) {
            let (q, u, v) = (&directions[2][..rounded], &u[..rounded], &v[..rounded]);
            for n in 0..rounded {
                behind[n] |= i32::from(q[n] <= 0.0);
                far[n] |= i32::from(larger(u[n].abs(), v[n].abs()) >= EXACT);
            }
        }
    }

    /// Takes the directions of the quads' pixels.
    #[inline(always)]
    fn take_directions(&mut self, place: &Place) {
        for (pixel, direction) in self.directions.iter_mut().enumerate() {
            for (from, to) in place.direction.iter().zip(direction) {
                gather(&self.all, pixel, from, to);
            }
        }
    }

    /// TEX-12: computes where the pixels of quads sample on the face that the first pixel's direction meets.
    #[inline(always)]
    fn project(&mut self, side: f64, of_vector: bool, rounded: usize) {
        let Quads { at, directions, behind, far, .. } = self;
        let middle = 32768.0 * side;
        let (behind, far) = (&mut behind[..rounded], &mut far[..rounded]);
        let [a, b, c] = directions[0].each_ref().map(|of| &of[..rounded]);
        for ([x, y, z], [u, v]) in directions.iter().zip(at) {
            let (x, y, z) = (&x[..rounded], &y[..rounded], &z[..rounded]);
            let (u, v) = (&mut u[..rounded], &mut v[..rounded]);
            for n in 0..rounded {
                let [s, t, m] = Facing::new([a[n], b[n], c[n]]).components([x[n], y[n], z[n]]);
                let ahead = m > 0.0;
                behind[n] |= i32::from(!ahead);
                [u[n], v[n]] = floors_on_face([s, t, m], middle);
                let is_far = larger(u[n].abs(), v[n].abs()) >= EXACT;
                // What is not finite times 0 is no number.
                let finite = x[n] * 0.0 + y[n] * 0.0 + z[n] * 0.0 == 0.0;
                far[n] |= i32::from(is_far | of_vector & !finite);
            }
        }
    }

    /// Returns the coordinates at a quad in whole numbers.
    #[cold]
    fn quad(&self, n: usize, sampler: &Sampler) -> Option<Quad> {
        if self.far[n] == 0 {
            let at = |pixel: usize| [0, 1].map(|axis: usize| self.at[pixel][axis][n].clamp(-FARTHEST, FARTHEST) as i64);
            return (self.behind[n] == 0).then(|| [at(0), at(1), at(2)]);
        }
        if self.behind[n] != 0 {
            return None;
        }
        let direction = |pixel: usize| self.directions[pixel].each_ref().map(|of| of[n]);
        let (first, [width, height]) = (direction(0), sampler.sides.map(i64::from));
        let mut quad = [[0; 2]; 3];
        for (pixel, at) in quad.iter_mut().enumerate() {
            *at = match (sampler.depends, sampler.cube) {
                (true, false) => [0, 1].map(|axis: usize| self.at[pixel][axis][n] as i64),
                (false, false) => {
                    let [s, t, q] = direction(pixel).map(whole);
                    [quad_ratio(s, q, width), quad_ratio(t, q, height)]
                }
                (false, true) => {
                    let [s, t, m] = Facing::new(first).components(direction(pixel)).map(whole);
                    [s, t].map(|s| face_coordinate(s, m, width, 16))
                }
                (true, true) => {
                    let bits = |component: f64| i64::from((component as f32).to_bits());
                    let vector = |pixel: usize| shader::direction(direction(pixel).map(bits));
                    let [s, t, m] = on_face(vector(pixel), face_of(vector(0)));
                    if m.mantissa <= 0 {
                        return None;
                    }
                    [s, t].map(|s| face_coordinate(s, m, width, 16))
                }
            };
        }
        Some(quad)
    }
}

/// Returns a number of at most 27 bits.
fn whole(n: f64) -> Binary {
    let Binary { mantissa, exponent } = Binary::from_double(n);
    Binary { mantissa: mantissa >> 26, exponent: exponent + 26 }
}

/// Copies what lanes have at one of the three pixels of quads: the upper left one, the one on its right, or the one below.
#[inline(always)]
fn gather<T: Copy>(all: &[PixelQuads], pixel: usize, from: &[T], to: &mut [T]) {
    let mut quad = 0;
    for PixelQuads { upper, lower, count, .. } in all {
        let pairs = from[if pixel == 2 { *lower } else { *upper }..].as_chunks::<2>().0;
        let to = to[quad..quad + count].iter_mut().zip(pairs);
        // Two loops, because compilers do not take the choice out of one.
        if pixel == 1 {
            to.for_each(|(to, pair)| *to = pair[1]);
        } else {
            to.for_each(|(to, pair)| *to = pair[0]);
        }
        quad += count;
    }
}
