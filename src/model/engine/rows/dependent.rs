//! TEX-11 for dependent reads: the level of detail of a quad follows from where its pixels sample, and its pixels are lanes of one block.
#![allow(clippy::float_arithmetic, reason = "integers that doubles hold, and estimates that exact products correct")]

use super::depth::floor;
use super::dot::Floats;
use super::kernels::{LANES, PerLane};
use super::levels::{MipFetches, choose};
use super::quads::{AtQuads, Measure};
use super::quotient::whole;
use super::setup::{larger, whole_steps};
use super::table::Table;
use super::{BLOCK, Job};
use crate::engine::pixel::TriangleContext;
use crate::raster::interpolate::{COORDINATE_LIMIT, Sample};
use crate::texture::coordinates::Coordinates;
use crate::texture::planned::PlannedUnit;
use crate::texture::{lod, shader};

/// Quads side by side whose pixels are lanes of a block: the first lanes of their two rows, and their number.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelQuads {
    pub(super) upper: usize,
    pub(super) lower: usize,
    pub(super) count: usize,
    /// Column and row of the first pixel, and the number of the triangle.
    pub(super) pixel: (i64, i64),
    pub(super) triangle: usize,
}

/// The triangle that was set up last by the definition.
#[derive(Debug, Default)]
pub(super) struct DefinedTriangle<'a>(Option<(usize, TriangleContext<'a>)>);

impl<'a> DefinedTriangle<'a> {
    /// Returns a triangle of the draw.
    pub(super) fn set_up(&mut self, job: Job<'a>, number: usize) -> Option<&TriangleContext<'a>> {
        if self.0.as_ref().is_none_or(|(other, _)| *other != number) {
            let rows = (0, i64::from(job.plan.targets[job.draw.target].height));
            self.0 = TriangleContext::new(job.plan, job.draw, number, rows).map(|context| (number, context));
        }
        self.0.as_ref().map(|(_, context)| context)
    }
}

/// The quads of a block, and scratch space of a stage that needs their levels of detail.
#[derive(Clone, Debug)]
pub(super) struct BlockQuads {
    all: Vec<PixelQuads>,
    /// Where pixels sample on level 0, 1/65536 texel, whole numbers.
    pub(super) fine: [PerLane<f64>; 2],
    /// Not 0 for lanes where they are not proved.
    pub(super) close: PerLane<i32>,
    /// The same at the three pixels of each quad that determine its level of detail.
    at: AtQuads,
    /// Sign bits of quads whose level of detail is not known.
    unknown: PerLane<u64>,
    /// Whether no level of detail is defined, because a pixel's direction points away from the face.
    is_behind: PerLane<bool>,
    /// Directions at the three pixels.
    directions: [[PerLane<f32>; 3]; 3],
    of_quads: PerLane<i32>,
    lods: PerLane<i32>,
    levels: [PerLane<i32>; 2],
}

impl Default for BlockQuads {
    fn default() -> Self {
        BlockQuads {
            all: Vec::new(),
            fine: [[0.0; LANES]; 2],
            close: [0; LANES],
            at: [[[0.0; LANES]; 2]; 3],
            unknown: [0; LANES],
            is_behind: [false; LANES],
            directions: [[[0.0; LANES]; 3]; 3],
            of_quads: [0; LANES],
            lods: [0; LANES],
            levels: [[0; LANES]; 2],
        }
    }
}

impl BlockQuads {
    /// Adds quads to the block.
    pub(super) fn add(&mut self, quads: PixelQuads) {
        self.all.push(quads);
    }

    /// Forgets the quads.
    pub(super) fn clear(&mut self) {
        self.all.clear();
    }

    /// TSH-4: sets where pixels sample from results of the dot unit, which are finite in number. Lanes whose coordinates are limited are left
    /// open, because smaller levels have limits of their own.
    #[inline(always)]
    pub(super) fn set_floats<const FMA: bool>(
        &mut self,
        axis: usize,
        floats: &Floats,
        side: u32,
        open: &mut [i32; BLOCK],
    ) {
        let (scale, limit) = (65536.0 * f64::from(side), (COORDINATE_LIMIT << 8) as f64);
        let fine = &mut self.fine[axis];
        for n in 0..BLOCK {
            let t = f64::from(floats[n]) * scale;
            open[n] |= i32::from(t.abs() >= limit);
            // NaN counts as 0.
            fine[n] = floor::<FMA>(if t.abs() < limit { t } else { 0.0 });
        }
    }

    /// TSH-4, TSH-5: sets where the pixels of quads sample from directions, on the face of the first pixel.
    #[inline(always)]
    pub(super) fn set_directions(&mut self, vector: [&Floats; 3], size: u32) {
        let BlockQuads { all, at, unknown, is_behind, directions, .. } = self;
        for (pixel, direction) in directions.iter_mut().enumerate() {
            for (from, to) in vector.iter().zip(direction) {
                gather(all, pixel, *from, to);
            }
        }
        let rounded = whole_steps(count(all));
        unknown[..rounded].fill(0);
        is_behind[..rounded].fill(false);
        let [[first_x, first_y, first_z], ..] = &*directions;
        let scale = f64::from(32768 * size);
        for (pixel, ([x, y, z], [u, v])) in directions.iter().zip(at).enumerate() {
            for n in 0..rounded {
                let ([a, b, c], [x, y, z]) = ([first_x[n], first_y[n], first_z[n]], [x[n], y[n], z[n]]);
                // The face as in `dot::on_faces`.
                let on_x = (a.abs() >= b.abs()) & (a.abs() >= c.abs());
                let on_y = !on_x & (b.abs() >= c.abs());
                let major = if on_y { b } else { c };
                let sign = if (if on_x { a } else { major }) < 0.0 { -1.0 } else { 1.0 };
                let [x, y, z] = [f64::from(x), f64::from(y), f64::from(z)];
                let m = if on_y { y } else { z };
                let m = sign * if on_x { x } else { m };
                let other = sign * if on_x { -z } else { x };
                let s = if on_y { x } else { other };
                let t = if on_y { sign * z } else { -y };
                let largest = larger(larger(x.abs(), y.abs()), z.abs());
                // A direction that is not finite counts as 0.
                let ahead = (m > 0.0) & (largest < f64::INFINITY) & !(x + y + z).is_nan();
                is_behind[n] |= !ahead;
                let m = if ahead { m } else { 1.0 };
                let tiny = |s: f64| (pixel > 0) & (s != 0.0) & (s.abs() < largest * TINY);
                let (near_u, near_v) = (whole(s * scale / m), whole(t * scale / m));
                let coarse =
                    (m < largest * LEAST) | tiny(s) | tiny(t) | (larger(near_u.abs(), near_v.abs()) > FARTHEST);
                unknown[n] |= if coarse { 1 << 63 } else { 0 };
                // Both products are exact.
                let below = |s: f64, near: f64| if s * scale < near * m { 1.0 } else { 0.0 };
                (u[n], v[n]) = (scale + near_u - below(s, near_u), scale + near_v - below(t, near_v));
            }
        }
    }

    /// TSH-7: sets where [close](Self::close) lanes sample by whole numbers. `offsets` are in 128ths of the image.
    #[inline(never)]
    pub(super) fn settle(&mut self, job: Job<'_>, unit: &PlannedUnit, offsets: [&Floats; 2]) {
        let mut triangle = DefinedTriangle::default();
        let sides = unit.scale(&unit.levels[0]);
        for PixelQuads { upper, lower, count, pixel: (i, j), triangle: number } in &self.all {
            for (row, first) in [upper, lower].into_iter().enumerate() {
                for n in (0..2 * count).filter(|n| self.close[first + n] != 0) {
                    let Some(context) = triangle.set_up(job, *number) else { continue };
                    let Some(Coordinates::Plane(planes)) = context.coordinates_of(unit.index) else { continue };
                    let e = context.triangle.edges(i + n as i64, j + row as i64);
                    let sample = Sample::new(&context.triangle, e);
                    for axis in 0..2 {
                        let offset = shader::offset_of(offsets[axis][first + n], sides[axis]);
                        let at = if sample.d > 0 { sample.moved_quotient(&planes[axis], offset, 16).0 } else { 0 };
                        self.fine[axis][first + n] = at as f64;
                    }
                }
            }
        }
    }

    /// Takes where the pixels of quads sample from what was set for each lane.
    pub(super) fn take_lanes(&mut self) {
        let BlockQuads { all, fine, at, unknown, is_behind, .. } = self;
        for (pixel, at) in at.iter_mut().enumerate() {
            for (from, to) in fine.iter().zip(at) {
                gather(all, pixel, from, to);
            }
        }
        let rounded = whole_steps(count(all));
        unknown[..rounded].fill(0);
        is_behind[..rounded].fill(false);
    }

    /// TEX-9, TEX-11: computes the fetches of a block at the floors `u` and `v` on level 0. Quads with an open lane, or an unknown level of
    /// detail, are left open.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "results apart, so that the compiler sees that none overlaps another")]
    pub(super) fn fetches<const FMA: bool>(
        &mut self,
        (unit, table): (&PlannedUnit, &Table),
        u: &[i32],
        v: &[i32],
        faces: Option<&PerLane<u32>>,
        open: &mut [i32; BLOCK],
        reads: &mut MipFetches,
    ) {
        let BlockQuads { all, at, unknown, is_behind, of_quads, lods, levels, .. } = self;
        let count = count(all);
        let rounded = whole_steps(count);
        i32::measure::<FMA>(unit, at, count, &mut of_quads[..rounded], &mut unknown[..rounded]);
        lods.fill(lod::LEAST);
        let mut quad = 0;
        for PixelQuads { upper, lower, count, .. } in all.iter() {
            for first in 0..*count {
                let (upper, lower) = (upper + 2 * first, lower + 2 * first);
                let lod = if is_behind[quad] { lod::LEAST } else { of_quads[quad] };
                let is_unknown = !is_behind[quad] && unknown[quad] >> 63 != 0;
                let is_open = i32::from(is_unknown) | open[upper] | open[upper + 1] | open[lower];
                for lane in [upper, upper + 1, lower, lower + 1] {
                    lods[lane] = lod;
                    open[lane] |= is_open;
                }
                quad += 1;
            }
        }
        let ranges = choose(unit, lods, levels, &mut reads.weights[..BLOCK]);
        reads.place_all((unit, table, 0), 0..BLOCK, ranges, lods, levels, &u[..BLOCK], &v[..BLOCK]);
        if let Some(faces) = faces {
            for entries in &mut reads.entries {
                for (entry, face) in entries[..BLOCK].iter_mut().zip(faces) {
                    *entry += (face * table.face) as i32;
                }
            }
        }
    }
}

/// Components that are smaller, relative to the largest, may lose bits in the definition ([`direction`](crate::texture::shader)).
const TINY: f64 = 1.0 / (1_u64 << 36) as f64;

/// The least accepted major component relative to the largest one. It keeps all of its bits.
const LEAST: f64 = 1.0 / (1 << 14) as f64;

/// Largest distance from the middle of a face, 1/65536 texel, whose product with a component doubles hold.
const FARTHEST: f64 = (1 << 28) as f64;

fn count(all: &[PixelQuads]) -> usize {
    all.iter().map(|quads| quads.count).sum()
}

/// Copies what lanes have at one of the three pixels of quads: the upper left one, the one on its right, or the one below.
#[inline(always)]
fn gather<T: Copy>(all: &[PixelQuads], pixel: usize, from: &[T], to: &mut [T]) {
    let mut quad = 0;
    for PixelQuads { upper, lower, count, .. } in all {
        let lanes = &from[if pixel == 2 { *lower } else { upper + pixel }..];
        for (to, from) in to[quad..quad + count].iter_mut().zip(lanes.iter().step_by(2)) {
            *to = *from;
        }
        quad += count;
    }
}
