//! TSH-7 on rows: coordinates that a stage moves. They are interpolated with their fraction, and floored where the stage runs.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::dot::Floats;
use super::kernels::{LANES, Lanes, PerLane, STEP};
use super::planes::{RealPlane, fraction_bits};
use super::quotient::{floor, larger, multiply_add, nearest, whole};
use super::setup::{BatchSetup, PixelBatch};
use super::shader::Bump;
use super::short::{Dominance, Losses, losses};
use super::{BLOCK, Sampler};
use crate::raster::interpolate::COORDINATE_LIMIT;
use crate::raster::setup::Triangle;
use crate::texture::shader::OFFSET_BITS;

/// The coordinates of a stage that moves them, across a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovedPlanes {
    /// u and v, 1/256 texel.
    planes: [RealPlane; 2],
    /// Their losses where weights fall short.
    losses: [Losses; 2],
    /// Upper bound of their change where the definition floors the numerators of the vertices, on any level.
    floors: f64,
    /// Whether doubles hold all of them exactly, with few bits of a fraction on all levels.
    exact: bool,
}

/// Largest number of fraction bits of coordinates that are moved without an error.
const EXACT_BITS: i32 = 26;

/// Largest error of an estimated coordinate that is accepted.
const COARSEST: f64 = 0.125;

/// Bound of the rounding error of a coordinate within its limits, when it is moved.
const SUM: f64 = 1.0 / (1 << 28) as f64;

/// What the floor of an offset takes off on any level.
const OFFSET_FLOOR: f64 = 1.0 / (1_u64 << OFFSET_BITS) as f64;

/// Half the last bit of an exact coordinate. It is added so that no coordinate that is whole lies on the border of two floors.
const HALF_BIT: f64 = 1.0 / (1_u64 << (EXACT_BITS + 1)) as f64;

/// Coordinates below this have no limit, 1/256 texel.
const FARTHEST: f64 = (COORDINATE_LIMIT - 16) as f64;

impl MovedPlanes {
    /// Sets up a triangle with these coordinates of the vertices.
    #[inline(always)]
    pub(super) fn new(triangle: &Triangle, inverse: &[f64; 3], bump: &Bump, set: [[f32; 4]; 3]) -> MovedPlanes {
        let plane = |axis: usize| {
            let side = f64::from(256 * bump.sides[axis]);
            // Exact, because 28 bits are multiplied by 24.
            let of = |k: usize| f64::from(set[k][axis]) * side * triangle.p[k] as f64;
            RealPlane::new(triangle, inverse, [of(0), of(1), of(2)], 1.0)
        };
        let planes = [plane(0), plane(1)];
        let losses = |plane: &RealPlane| losses(triangle, inverse, plane.g());
        // Offsets are floored to 24 bits on each level, which changes no floor if coordinates have no more.
        let most = if bump.shift > 0 { OFFSET_BITS as i32 - bump.shift as i32 } else { EXACT_BITS };
        let few = |plane: &RealPlane| fraction_bits(triangle, plane.g()).is_some_and(|bits| bits <= most);
        let is_whole = |plane: &RealPlane| plane.g().iter().all(|n| (n / f64::from(1 << bump.shift)).fract() == 0.0);
        let least = triangle.p[0].min(triangle.p[1]).min(triangle.p[2]) as f64;
        MovedPlanes {
            planes,
            losses: [losses(&planes[0]), losses(&planes[1])],
            floors: if is_whole(&planes[0]) && is_whole(&planes[1]) { 0.0 } else { 1.25 / least },
            exact: few(&planes[0]) && few(&planes[1]),
        }
    }

    /// Interpolates the coordinates of a batch. Returns whether their floors can be proved.
    #[inline(always)]
    pub(super) fn interpolate<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        bump: &Bump,
        local: &BatchSetup,
        dominance: &Dominance,
        moved: &mut Moved,
    ) -> bool {
        let MovedPlanes { planes: [along, down], losses, floors, exact } = self;
        let BatchSetup { real, ratio, denominator, .. } = local;
        let (offs, scale) = ([local.margin::<ROW>(along), local.margin::<ROW>(down)], f64::from(1 << bump.shift));
        let off = larger(offs[0], offs[1]) + floors * ratio + SUM + OFFSET_FLOOR;
        // Hardly beyond the triangle no number has more bits.
        let exact = *exact && (!batch.reaches_beyond() || *ratio < 2.0);
        // NaN proves nothing either.
        let proves = exact | (off * scale < COARSEST) & (offs[0] < COARSEST) & (offs[1] < COARSEST);
        let stays = |plane: &RealPlane, most: f64| plane.reach * ratio + most < FARTHEST;
        let (off, plus) = if exact { (HALF_BIT / 2.0 / scale, HALF_BIT - 0.5) } else { (off, -0.5) };
        let off = if proves { off } else { 0.0 };
        moved.has_exact |= exact;
        for largest in &mut moved.off[batch.lane / STEP..batch.lanes().end.div_ceil(STEP)] {
            *largest = larger(off, *largest);
        }
        let lines = [along.line(real), down.line(real), *denominator];
        let [u, v] = moved.at.each_mut().map(|at| &mut at[batch.lane..]);
        dominance.divide::<FMA, ROW>(batch.at, lines, [losses[0], losses[1], [0.0; 2]], plus, [u, v]);
        if bump.mixes {
            let [u, v] = moved.at_quads.each_mut().map(|at| &mut at[batch.lane..]);
            dominance.divide::<FMA, ROW>(batch.at, lines, [[0.0; 2]; 3], plus, [u, v]);
        }
        proves & stays(along, bump.most[0]) & stays(down, bump.most[1])
    }
}

/// Coordinates that a stage moves.
#[derive(Clone, Debug, Default)]
pub(super) struct Moved {
    /// Estimates less a half, 1/256 texel.
    at: [PerLane<f64>; 2],
    /// The same without losses, if levels of detail follow from them (TEX-11).
    at_quads: [PerLane<f64>; 2],
    /// The largest error of a coordinate in each step of lanes, on the level where it is.
    off: [f64; LANES / STEP],
    /// Whether coordinates of some batch are exact.
    has_exact: bool,
}

impl Moved {
    /// Begins a block.
    #[inline(always)]
    pub(super) fn begin(&mut self) {
        self.off.fill(0.0);
        self.has_exact = false;
    }
}

/// TSH-7: writes the floors of coordinates, less the sampler's bias, that are moved by so many 128ths of the image. Lanes are left open whose
/// floors are not proved, or not those on smaller levels, which are the same shifted by up to `shift` bits. Returns whether there may be any.
#[inline(always)]
pub(super) fn place<const FMA: bool>(
    of: (&Sampler, Lanes),
    (moved, shift): (&Moved, u32),
    by: [&Floats; 2],
    at: &mut [PerLane<i32>; 2],
    open: &mut [i32],
) -> bool {
    if moved.has_exact {
        place_by::<FMA, true>(of, (moved, shift), by, at, open)
    } else {
        place_by::<FMA, false>(of, (moved, shift), by, at, open)
    }
}

/// Does the same. `EXACT` says that offsets are floored, as those of exact coordinates have to be.
#[inline(always)]
fn place_by<const FMA: bool, const EXACT: bool>(
    (sampler, lanes): (&Sampler, Lanes),
    (moved, shift): (&Moved, u32),
    [along, down]: [&Floats; 2],
    [u, v]: &mut [PerLane<i32>; 2],
    open: &mut [i32],
) -> bool {
    let mut any = false;
    let (open, bias) = (&mut open[..BLOCK], sampler.bias());
    let place = |n: usize| {
        let [at_u, at_v] = by::<FMA, EXACT>(&moved.at, sampler.sides, [along[n], down[n]], n);
        let (near_u, near_v) = ((at_u - whole(at_u)).abs(), (at_v - whole(at_v)).abs());
        (at_u, at_v, larger(near_u, near_v))
    };
    for (step, off) in moved.off[..lanes.count() / STEP].iter().enumerate() {
        let (lanes, mut close) = (step * STEP..(step + 1) * STEP, 0);
        let room = 0.5 - off * f64::from(1 << shift);
        for n in lanes.clone() {
            let (at_u, at_v, near) = place(n);
            close |= (room - near).to_bits();
            u[n] = nearest(at_u).wrapping_sub(bias);
            v[n] = nearest(at_v).wrapping_sub(bias);
        }
        if close >> 63 != 0 {
            any = true;
            // An integer is a border on the levels whose steps it is a multiple of.
            let is_proved = |at: f64| {
                let near = nearest(at + 0.5);
                let shift = shift.min(near.trailing_zeros());
                (at + 0.5 - f64::from(near)).abs() > off * f64::from(1 << shift)
            };
            for n in lanes {
                let (at_u, at_v, _) = place(n);
                open[n] |= i32::from(!(is_proved(at_u) & is_proved(at_v)));
            }
        }
    }
    any
}

/// TSH-7: returns u and v of a lane, moved by so many 128ths of the image. `FLOORS` says whether offsets are floored.
#[inline(always)]
fn by<const FMA: bool, const FLOORS: bool>(
    [u, v]: &[PerLane<f64>; 2],
    sides: [u32; 2],
    offsets: [f32; 2],
    n: usize,
) -> [f64; 2] {
    const PARTS: f64 = (1 << OFFSET_BITS) as f64;
    let by = |offset: f32, side: u32, at: f64| {
        // A side of the image has 256 steps for each of its texels.
        let (offset, side) = (f64::from(offset), 2.0 * f64::from(side));
        if FLOORS {
            multiply_add::<FMA>(floor::<FMA>(offset * (side * PARTS)), 1.0 / PARTS, at)
        } else {
            multiply_add::<FMA>(offset, side, at)
        }
    };
    [by(offsets[0], sides[0], u[n]), by(offsets[1], sides[1], v[n])]
}

/// TEX-11 of what [`place`] does: writes floors on level 0 in 1/65536 texel, and a number other than 0 for lanes where one is not proved.
/// Returns whether there are such lanes.
#[inline(always)]
pub(super) fn place_finely<const FMA: bool>(
    (sampler, lanes): (&Sampler, Lanes),
    moved: &Moved,
    [along, down]: [&Floats; 2],
    [u, v]: &mut [PerLane<f64>; 2],
    unproved: &mut PerLane<i32>,
) -> bool {
    let mut any = 0;
    for n in 0..lanes.count() {
        let [at_u, at_v] = by::<FMA, true>(&moved.at_quads, sampler.sides, [along[n], down[n]], n);
        let (at_u, at_v, off) = (256.0 * (at_u + 0.5), 256.0 * (at_v + 0.5), 256.0 * moved.off[n / STEP]);
        let close = ((at_u - whole(at_u)).abs() - off).to_bits() | ((at_v - whole(at_v)).abs() - off).to_bits();
        unproved[n] = (close >> 63) as i32;
        any |= unproved[n];
        (u[n], v[n]) = (floor::<FMA>(at_u), floor::<FMA>(at_v));
    }
    any != 0
}
