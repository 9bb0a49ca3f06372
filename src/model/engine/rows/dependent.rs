//! TEX-11 for dependent reads: the level of detail of a quad follows from where its pixels sample, and its pixels are lanes of one block.
#![allow(clippy::float_arithmetic, reason = "integers that doubles hold, and estimates that exact products correct")]

use super::dot::{Facing, Floats, is_finite};
use super::kernels::{Lanes, PerLane};
use super::levels::{MipFetches, choose};
use super::quads::{AtQuads, Measure};
use super::quotient::{floor, larger, whole};
use super::setup::whole_steps;
use super::table::Table;
use super::{BLOCK, Job};
use crate::engine::context::TriangleContext;
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
    pub(super) fn set_up(&mut self, job: &Job<'a>, number: usize) -> Option<&TriangleContext<'a>> {
        if self.0.as_ref().is_none_or(|(other, _)| *other != number) {
            let rows = (0, i64::from(job.plan.targets[job.draw.target].height));
            self.0 = TriangleContext::new(job.plan, job.draw, number, rows).map(|context| (number, context));
        }
        self.0.as_ref().map(|(_, context)| context)
    }
}

/// The quads of a block, and scratch space of a stage that needs their levels of detail.
#[derive(Clone, Debug, Default)]
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
    /// Not 0 for quads that are left open.
    opened: PerLane<i32>,
    /// Not 0 for quads that have no level of detail, because a pixel's direction points away from the face.
    behind: PerLane<i32>,
    /// Directions at the three pixels.
    directions: [[PerLane<f32>; 3]; 3],
    /// s, t and the major component of a pixel's direction on the face.
    meets: [PerLane<f32>; 3],
    of_quads: PerLane<i32>,
    lods: PerLane<i32>,
    levels: [PerLane<i32>; 2],
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

    /// Begins a stage, of whose quads nothing is unknown yet. Returns their number in whole steps.
    fn begin(&mut self) -> usize {
        let rounded = whole_steps(count(&self.all));
        self.unknown[..rounded].fill(0);
        self.opened[..rounded].fill(0);
        self.behind[..rounded].fill(0);
        rounded
    }

    /// TSH-4: sets where pixels sample from results of the dot unit. Lanes whose coordinates are limited are left open, because smaller levels
    /// have limits of their own.
    #[inline(always)]
    pub(super) fn set_floats<const FMA: bool>(
        &mut self,
        (axis, lanes): (usize, Lanes),
        floats: &Floats,
        side: u32,
        open: &mut [i32; BLOCK],
    ) {
        let (scale, limit) = (65536.0 * f64::from(side), (COORDINATE_LIMIT << 8) as f64);
        let fine = self.fine[axis].block_mut();
        for n in 0..lanes.count() {
            let t = f64::from(floats[n]) * scale;
            open[n] |= i32::from(t.abs() >= limit);
            // NaN counts as 0.
            fine[n] = floor::<FMA>(if t.abs() < limit { t } else { 0.0 });
        }
    }

    /// TSH-4, TSH-5: sets where the pixels of quads sample from directions, on the face of the first pixel.
    #[inline(always)]
    pub(super) fn set_directions(&mut self, vector: [&Floats; 3], size: u32) {
        let rounded = self.begin();
        let BlockQuads { all, at, unknown, opened, behind, directions, meets, .. } = self;
        for (pixel, direction) in directions.iter_mut().enumerate() {
            for (from, to) in vector.iter().zip(direction) {
                gather(all, pixel, *from, to);
            }
        }
        let [first, ..] = directions.each_ref().map(|direction| direction.each_ref().map(|of| &of[..rounded]));
        let (opened, behind) = (&mut opened[..rounded], &mut behind[..rounded]);
        for (pixel, (direction, [u, v])) in directions.iter().zip(at).enumerate() {
            let direction = direction.each_ref().map(|of| &of[..rounded]);
            let [s, t, m] = meets.each_mut().map(|of| &mut of[..rounded]);
            meet(first, direction, pixel == 0, s, t, m, opened, behind);
            project(s, t, m, f64::from(32768 * size), &mut u[..rounded], &mut v[..rounded], &mut unknown[..rounded]);
        }
    }

    /// TSH-7: sets where [close](Self::close) lanes sample by whole numbers. `offsets` are in 128ths of the image.
    #[inline(never)]
    pub(super) fn settle(&mut self, job: &Job<'_>, unit: &PlannedUnit, offsets: [&Floats; 2]) {
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
        self.begin();
        let BlockQuads { all, fine, at, .. } = self;
        for (pixel, at) in at.iter_mut().enumerate() {
            for (from, to) in fine.iter().zip(at) {
                gather(all, pixel, from, to);
            }
        }
    }

    /// TEX-9, TEX-11: computes the fetches of a block at the floors `u` and `v` on level 0. Quads with an open lane, or an unknown level of
    /// detail, are left open.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "results apart, so that the compiler sees that none overlaps another")]
    pub(super) fn fetches<const FMA: bool>(
        &mut self,
        (unit, table, used): (&PlannedUnit, &Table, Lanes),
        u: &[i32],
        v: &[i32],
        faces: Option<&PerLane<u32>>,
        open: &mut [i32; BLOCK],
        reads: &mut MipFetches,
    ) {
        let BlockQuads { all, at, unknown, behind, of_quads, lods, levels, opened, .. } = self;
        let count = count(all);
        let rounded = whole_steps(count);
        let (of_quads, unknown) = (&mut of_quads[..rounded], &mut unknown[..rounded]);
        i32::measure::<FMA>(unit, at, count, of_quads, unknown);
        let (behind, opened) = (&behind[..rounded], &mut opened[..rounded]);
        for n in 0..rounded {
            of_quads[n] = if behind[n] != 0 { lod::LEAST } else { of_quads[n] };
            opened[n] = if behind[n] != 0 { 0 } else { opened[n] | (unknown[n] >> 63) as i32 };
        }
        lods.fill(lod::LEAST);
        let mut quad = 0;
        for PixelQuads { upper, lower, count, .. } in all.iter().copied() {
            let (of_quads, opened) = (&of_quads[quad..quad + count], &mut opened[quad..quad + count]);
            let (above, below) = (open[upper..][..2 * count].as_chunks::<2>().0, open[lower..].as_chunks::<2>().0);
            for ((opened, above), below) in opened.iter_mut().zip(above).zip(below) {
                *opened |= above[0] | above[1] | below[0];
            }
            for row in [upper, lower] {
                let (lods, open) = (lods[row..].as_chunks_mut::<2>().0, open[row..].as_chunks_mut::<2>().0);
                for (((lods, open), of_quad), opened) in lods.iter_mut().zip(open).zip(of_quads).zip(&*opened) {
                    *lods = [*of_quad; 2];
                    *open = [open[0] | opened, open[1] | opened];
                }
            }
            quad += count;
        }
        let used = used.count();
        let ranges = choose(unit, lods, levels, &mut reads.weights[..used]);
        reads.place_all((unit, table, 0), 0..used, ranges, lods, levels, &u[..used], &v[..used]);
        if let Some(faces) = faces {
            for entries in &mut reads.entries {
                for (entry, face) in entries[..used].iter_mut().zip(&**faces) {
                    *entry += (face * table.face) as i32;
                }
            }
        }
    }
}

/// Components that are smaller than the largest by such a factor may lose bits in the definition ([`direction`](crate::texture::shader)).
const TINY: f32 = (1_u64 << 36) as f32;

/// The largest accepted ratio of any component to the major one, which then keeps all of its bits.
const STEEPEST: f32 = (1 << 14) as f32;

/// Largest distance from the middle of a face, 1/65536 texel, whose product with a component doubles hold.
const FARTHEST: f64 = (1 << 28) as f64;

/// TSH-5: writes s, t and the major component of directions on the faces that the `first` ones meet. Marks quads for which directions point away
/// from the face, and those for which doubles do not hold what the definition computes.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "each result apart, so that the compiler sees that none overlaps another")]
fn meet(
    first: [&[f32]; 3],
    direction: [&[f32]; 3],
    is_first: bool,
    s: &mut [f32],
    t: &mut [f32],
    m: &mut [f32],
    opened: &mut [i32],
    behind: &mut [i32],
) {
    let lanes = s.len();
    let (t, m, opened, behind) = (&mut t[..lanes], &mut m[..lanes], &mut opened[..lanes], &mut behind[..lanes]);
    let ([a, b, c], [x, y, z]) = (first.map(|of| &of[..lanes]), direction.map(|of| &of[..lanes]));
    for n in 0..lanes {
        let direction = [x[n], y[n], z[n]];
        let [along, down, major] = Facing::new([a[n], b[n], c[n]]).components(direction);
        // A direction that is not finite counts as 0.
        let ahead = (major > 0.0) & is_finite(direction);
        behind[n] |= i32::from(!ahead);
        let largest = larger(larger(x[n].abs(), y[n].abs()), z[n].abs());
        let tiny = |s: f32| (s != 0.0) & (s.abs() * TINY < largest);
        let coarse = (major * STEEPEST < largest) | !is_first & (tiny(along) | tiny(down));
        opened[n] |= i32::from(coarse);
        (s[n], t[n], m[n]) = (along, down, if ahead { major } else { 1.0 });
    }
}

/// TSH-5: writes the places of [`meet`]'s directions on a face whose half is `scale` wide, 1/65536 texel, as floors. Marks those that are too far
/// away.
#[inline(always)]
fn project(s: &[f32], t: &[f32], m: &[f32], scale: f64, u: &mut [f64], v: &mut [f64], unknown: &mut [u64]) {
    let lanes = u.len();
    let (s, t, m, v, unknown) = (&s[..lanes], &t[..lanes], &m[..lanes], &mut v[..lanes], &mut unknown[..lanes]);
    for n in 0..lanes {
        let (s, t, m) = (f64::from(s[n]) * scale, f64::from(t[n]) * scale, f64::from(m[n]));
        let r = 1.0 / m;
        let (near_u, near_v) = (whole(s * r), whole(t * r));
        unknown[n] |= (FARTHEST - larger(near_u.abs(), near_v.abs())).to_bits() & 1 << 63;
        // Both products are exact.
        let below = |s: f64, near: f64| if s < near * m { 1.0 } else { 0.0 };
        (u[n], v[n]) = (scale + near_u - below(s, near_u), scale + near_v - below(t, near_v));
    }
}

fn count(all: &[PixelQuads]) -> usize {
    all.iter().map(|quads| quads.count).sum()
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
