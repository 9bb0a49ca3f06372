//! INT-1 to INT-4t, TEX-12 and everything else that varies across a triangle, for the pixels of a piece.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::fetch::Numbers;
use super::kernels::{LANES, Row, STEP};
use super::planes::Plane;
use super::quotient::{
    COARSEST, Line, Positions, SLACK, SLACK_32, break_ties, estimate_two, estimate_weights, nearest, settle,
};
use super::{Compiled, Sampler};
use crate::combiner::registers::Registers;
use crate::engine::pixel::TriangleContext;
use crate::raster::interpolate::{self, Sample};
use crate::state::{Register, TEXTURE_UNITS};
use crate::texture::place::{Coordinates, Place};
use crate::texture::unit::Image;
use crate::trace::Silent;

/// A unit's linear functions.
pub(super) enum Planes {
    /// u and v over D.
    Plane([Plane; 2]),
    /// A direction.
    Direction([Plane; 3]),
    /// Anything else: the definition, pixel by pixel.
    Other,
    /// The same coordinates as those of an earlier sampler.
    Same(usize),
}

/// A triangle with what its pieces need.
pub(super) struct Setup<'a> {
    pub(super) context: TriangleContext<'a>,
    denominator: Plane,
    /// 256 b0 and 256 b2, where some colour varies.
    weights: Option<[Plane; 2]>,
    samplers: Vec<Planes>,
    /// Bits of the largest D.
    bits: u32,
}

/// What the pieces of a block leave in their lanes.
#[derive(Clone, Debug)]
pub(super) struct Varying {
    /// u and v of each sampler, 1/256 texel, less half a texel where it filters.
    pub(super) coordinates: [[Numbers<i32>; 2]; TEXTURE_UNITS],
    /// Faces of cube maps.
    pub(super) faces: [Numbers<u32>; TEXTURE_UNITS],
    /// Depth, where it is tested.
    pub(super) depth: Numbers<u32>,
    /// The texture shader lets the pixel live.
    pub(super) alive: Numbers<bool>,
    /// W0 and W2.
    pub(super) weights: [Numbers<i32>; 2],
    narrow: [Numbers<u16>; 2],
    whole: [Numbers<i32>; 2],
}

impl Default for Varying {
    fn default() -> Self {
        Varying {
            coordinates: [[[0; LANES]; 2]; TEXTURE_UNITS],
            faces: [[0; LANES]; TEXTURE_UNITS],
            depth: [0; LANES],
            alive: [true; LANES],
            weights: [[0; LANES]; 2],
            narrow: [[0; LANES]; 2],
            whole: [[0; LANES]; 2],
        }
    }
}

/// Some pixels of a triangle that become lanes of a block.
#[derive(Clone, Copy)]
pub(super) struct Piece<'a> {
    /// Column and row of its first pixel.
    pub(super) first: (i64, i64),
    /// Where the others lie; whole steps of lanes.
    pub(super) at: Positions<'a>,
    /// How many there are.
    pub(super) count: usize,
    /// The lane of the first.
    pub(super) lane: usize,
    /// Columns and rows that none of them is further away from it.
    pub(super) extent: (i32, i32),
}

impl Piece<'_> {
    /// Column and row of one of its pixels.
    fn pixel(&self, n: usize) -> (i64, i64) {
        (self.first.0 + i64::from(self.at.x[n]), self.first.1 + i64::from(self.at.y[n]))
    }

    /// The lanes that whole steps take.
    fn lanes(&self) -> std::ops::Range<usize> {
        self.lane..self.lane + self.at.x.len()
    }
}

/// Rounded up to whole steps.
pub(super) fn whole_steps(count: usize) -> usize {
    count.next_multiple_of(STEP)
}

impl<'a> Setup<'a> {
    /// `samplers` is a place to put things; [`given_back`](Self::given_back) returns it.
    pub(super) fn new(context: TriangleContext<'a>, compiled: &Compiled, mut samplers: Vec<Planes>) -> Setup<'a> {
        let triangle = &context.triangle;
        let p = triangle.p;
        let varies = |slots: &[Option<u16>; 4], colors: &[[u8; 4]; 3]| {
            (0..4).any(|n| slots[n].is_some() && (colors[0][n] != colors[1][n] || colors[1][n] != colors[2][n]))
        };
        let weighted = varies(&compiled.primary, &context.primary) || varies(&compiled.secondary, &context.secondary);
        let plane = |g: [i64; 3]| Plane::new(triangle, g);
        samplers.clear();
        for (n, sampler) in compiled.samplers.iter().enumerate() {
            let coordinates = &context.coordinates[sampler.unit];
            let earlier = compiled.samplers[..n].iter().position(|other| {
                other.filters == sampler.filters
                    && !other.cube
                    && context.coordinates[other.unit] == *coordinates
                    && context.draw.units[other.index].levels[0] == context.draw.units[sampler.index].levels[0]
            });
            samplers.push(match coordinates {
                _ if earlier.is_some() => Planes::Same(earlier.unwrap_or(0)),
                Some(Coordinates::Plane(g)) => Planes::Plane([plane(g[0]), plane(g[1])]),
                Some(Coordinates::Direction(g)) => Planes::Direction([plane(g[0]), plane(g[1]), plane(g[2])]),
                _ => Planes::Other,
            });
        }
        let bits = |n: i64| 64 - n.leading_zeros();
        Setup {
            denominator: plane(p),
            weights: weighted.then(|| [plane([256 * p[0], 0, 0]), plane([0, 0, 256 * p[2]])]),
            samplers,
            bits: bits(triangle.doubled_area) + bits(p[0].max(p[1]).max(p[2])),
            context,
        }
    }

    /// What [`new`](Self::new) was given.
    pub(super) fn given_back(self) -> Vec<Planes> {
        self.samplers
    }

    /// Everything that varies, for a piece. `ROW`: its pixels are on one row, one beside the other.
    #[inline(always)]
    pub(super) fn interpolate<const FMA: bool, const ROW: bool>(
        &self,
        piece: Piece<'_>,
        compiled: &Compiled,
        textures: &[Image<'_, i32>],
        varying: &mut Varying,
        rows: &mut [Row],
    ) {
        let triangle = &self.context.triangle;
        let e = triangle.edges(piece.first.0, piece.first.1);
        let real = e.map(|e| e as f64);
        let denominator = self.denominator.line(&real);
        let bounds = self.bounds::<FMA, ROW>(piece, &real, denominator);
        for (n, (sampler, planes)) in compiled.samplers.iter().zip(&self.samplers).enumerate() {
            match planes {
                Planes::Plane(planes) => {
                    let numbers = &mut varying.coordinates[n];
                    self.coordinates::<FMA, ROW>(
                        piece,
                        sampler,
                        planes,
                        (&e, &real),
                        denominator,
                        &bounds,
                        numbers,
                        &mut varying.whole,
                    );
                }
                Planes::Direction(planes) => {
                    let (numbers, faces) = (&mut varying.coordinates[n], &mut varying.faces[n]);
                    if !direction::<FMA, ROW>(piece, sampler, planes, &real, &bounds, numbers, faces) {
                        self.defined(piece, sampler, numbers, faces);
                    }
                }
                Planes::Other => {
                    self.defined(piece, sampler, &mut varying.coordinates[n], &mut varying.faces[n]);
                }
                Planes::Same(other) => {
                    let lanes = piece.lanes();
                    let [earlier, numbers] = match varying.coordinates.split_at_mut(n) {
                        (before, [numbers, ..]) => [&mut before[*other], numbers],
                        (_, []) => return,
                    };
                    for axis in 0..2 {
                        numbers[axis][lanes.clone()].copy_from_slice(&earlier[axis][lanes.clone()]);
                    }
                }
            }
        }
        if let Some(planes) = &self.weights {
            self.weights::<FMA, ROW>(piece, planes, (&e, &real), denominator, &bounds, varying);
            for n in 0..2 {
                narrow(&varying.weights[n][piece.lanes()], &mut varying.narrow[n][piece.lanes()]);
            }
        }
        let [w0, w2] = &varying.narrow;
        let sets = [(&compiled.primary, &self.context.primary), (&compiled.secondary, &self.context.secondary)];
        for (slots, colors) in sets {
            for channel in 0..4 {
                let Some(slot) = slots[channel] else { continue };
                let out = &mut rows[usize::from(slot)].0[piece.lanes()];
                let corners = [0, 1, 2].map(|k: usize| u16::from(colors[k][channel]));
                if corners[0] == corners[1] && corners[1] == corners[2] {
                    out.fill(corners[0] as i16);
                } else {
                    color(corners, &w0[piece.lanes()], &w2[piece.lanes()], out);
                }
            }
        }
        if compiled.pixel_by_pixel {
            self.pixel_by_pixel(piece, compiled, textures, varying, rows);
        }
    }

    /// The largest and the smallest denominator of a piece, as far as is known, and how far its pixels are apart.
    #[inline(always)]
    fn bounds<const FMA: bool, const ROW: bool>(&self, piece: Piece<'_>, e: &[f64; 3], denominator: Line) -> Bounds {
        if ROW {
            let end = denominator.at::<FMA, true>(f64::from(piece.at.last), 0.0);
            let (low, high) = if denominator.c < end { (denominator.c, end) } else { (end, denominator.c) };
            return Bounds { ratio: high / low, columns: f64::from(piece.at.last), rows: 0.0 };
        }
        let (columns, rows) = (f64::from(piece.extent.0), f64::from(piece.extent.1));
        let p = self.context.triangle.p;
        let least = p[0].min(p[1]).min(p[2]) as f64 * self.context.triangle.doubled_area as f64;
        Bounds { ratio: self.denominator.terms(e, columns, rows) / least, columns, rows }
    }

    /// How far the estimate of a plane's quotient can be off.
    #[inline(always)]
    fn margin<const ROW: bool>(&self, plane: &Plane, e: &[f64; 3], bounds: &Bounds) -> f64 {
        if ROW {
            // Every term that is added is at most `reach` times one of D, and none of those is negative.
            return plane.reach * bounds.ratio * SLACK;
        }
        let terms = self.denominator.terms(e, bounds.columns, bounds.rows);
        (plane.terms(e, bounds.columns, bounds.rows) / terms + 2.0 * plane.reach) * bounds.ratio * SLACK
    }

    /// INT-4, INT-4t.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "what the caller has computed once for all planes")]
    fn coordinates<const FMA: bool, const ROW: bool>(
        &self,
        piece: Piece<'_>,
        sampler: &Sampler,
        planes: &[Plane; 2],
        (e, real): (&[i64; 3], &[f64; 3]),
        denominator: Line,
        bounds: &Bounds,
        numbers: &mut [Numbers<i32>; 2],
        whole: &mut [Numbers<i32>; 2],
    ) {
        let bias = if sampler.filters { 128 } else { 0 };
        let margins = [0, 1].map(|n: usize| self.margin::<ROW>(&planes[n], real, bounds));
        let lanes = piece.lanes();
        let [u, v] = numbers;
        let (u, v) = (&mut u[lanes.clone()], &mut v[lanes.clone()]);
        if !(margins[0] < COARSEST && margins[1] < COARSEST) {
            for n in 0..piece.count {
                let sample = self.sample(piece, n);
                (u[n], v[n]) =
                    (defined_coordinate(&sample, &planes[0], bias), defined_coordinate(&sample, &planes[1], bias));
            }
            return;
        }
        let offset = f64::from(bias) + 0.5;
        let lines = [0, 1].map(|n: usize| planes[n].line(real).less(offset, denominator));
        let close = estimate_two::<FMA, ROW>(piece.at, denominator, lines, margins, u, v);
        for (n, values) in [(0, u), (1, v)] {
            if !close[n] {
                continue;
            }
            let plane = &planes[n];
            let bottom = self.denominator.exact(e);
            let top = plane.exact(e).less(i64::from(bias), bottom);
            let whole = &mut whole[0][..values.len()];
            settle::<ROW>(piece.at, top, bottom, plane.small(self.bits), values, whole);
            if plane.lowers {
                for k in (0..piece.count).filter(|k| whole[*k] != 0) {
                    values[k] -= i32::from(self.sample(piece, k).truncation(&plane.g) > 0);
                }
            }
        }
    }

    /// INT-2, INT-3.
    #[inline(always)]
    fn weights<const FMA: bool, const ROW: bool>(
        &self,
        piece: Piece<'_>,
        planes: &[Plane; 2],
        (e, real): (&[i64; 3], &[f64; 3]),
        denominator: Line,
        bounds: &Bounds,
        varying: &mut Varying,
    ) {
        let lanes = piece.lanes();
        let [w0, w2] = &mut varying.weights;
        let (w0, w2) = (&mut w0[lanes.clone()], &mut w2[lanes.clone()]);
        let lines = [0, 1].map(|n: usize| planes[n].line(real).less(0.5, denominator));
        // Nothing but the row's own terms is added, so single precision has a margin too.
        let single = 257.0 * bounds.ratio * SLACK_32;
        let margins = [0, 1].map(|n: usize| self.margin::<ROW>(&planes[n], real, bounds));
        let close = if ROW && single < COARSEST {
            estimate_weights::<FMA>(piece.at, denominator, lines, single, w0, w2)
        } else if margins[0] < COARSEST && margins[1] < COARSEST {
            let close = estimate_two::<FMA, ROW>(piece.at, denominator, lines, margins, w0, w2);
            close[0] || close[1]
        } else {
            for n in 0..piece.count {
                let [first, third] = self.sample(piece, n).weights();
                (w0[n], w2[n]) = (first.value as i32, third.value as i32);
            }
            false
        };
        if !close {
            return;
        }
        let [whole0, whole2] = &mut varying.whole;
        let (whole0, whole2) = (&mut whole0[..w0.len()], &mut whole2[..w2.len()]);
        let bottom = self.denominator.exact(e);
        settle::<ROW>(piece.at, planes[0].exact(e), bottom, planes[0].small(self.bits), w0, whole0);
        settle::<ROW>(piece.at, planes[1].exact(e), bottom, planes[1].small(self.bits), w2, whole2);
        if !self.context.triangle.exact_reciprocal {
            break_ties(w0, w2, whole0, whole2);
        }
    }

    fn sample(&self, piece: Piece<'_>, n: usize) -> Sample<'_> {
        let (i, j) = piece.pixel(n);
        Sample::new(&self.context.triangle, self.context.triangle.edges(i, j))
    }

    /// Coordinates by the definition, pixel by pixel.
    fn defined(&self, piece: Piece<'_>, sampler: &Sampler, numbers: &mut [Numbers<i32>; 2], faces: &mut Numbers<u32>) {
        let unit = &self.context.draw.units[sampler.index];
        let bias = if sampler.filters { 128 } else { 0 };
        for n in 0..piece.count {
            let sample = self.sample(piece, n);
            let Some(place) = self.context.place(unit, &sample, piece.pixel(n)) else { return };
            let [u, v] = place.on(&unit.levels[0]);
            let lane = piece.lane + n;
            (numbers[0][lane], numbers[1][lane]) = (u.value as i32 - bias, v.value as i32 - bias);
            faces[lane] = place.face() as u32;
        }
    }

    /// What is not computed by rows: texture units beyond the plain ones, fog, depth.
    fn pixel_by_pixel(
        &self,
        piece: Piece<'_>,
        compiled: &Compiled,
        textures: &[Image<'_, i32>],
        varying: &mut Varying,
        rows: &mut [Row],
    ) {
        const UNITS: [Register; TEXTURE_UNITS] =
            [Register::Texture0, Register::Texture1, Register::Texture2, Register::Texture3];
        let context = &self.context;
        for n in 0..piece.count {
            let (sample, lane) = (self.sample(piece, n), piece.lane + n);
            let mut registers = Registers::<i32>::new();
            let mut put = |slot: Option<u16>, value: i32| {
                if let Some(slot) = slot {
                    rows[usize::from(slot)].0[lane] = value as i16;
                }
            };
            if compiled.samples_pixels {
                let lives = context.sample_textures(&sample, piece.pixel(n), &mut registers, textures, &mut Silent);
                varying.alive[lane] = lives.is_some();
                for (unit, register) in UNITS.into_iter().enumerate() {
                    for channel in 0..4 {
                        put(compiled.textures[unit][channel], registers.read(register, channel));
                    }
                }
            }
            if compiled.fog.is_some() {
                context.load_fog(&sample, &mut registers, &mut Silent);
                put(compiled.fog, registers.read(Register::Fog, 3));
            }
            if context.draw.depth_test.is_some() {
                varying.depth[lane] = sample.depth(context.z, context.draw.depth_full) as u32;
            }
        }
    }
}

/// How the denominators of a piece vary.
struct Bounds {
    /// The largest term that goes into one over the smallest one.
    ratio: f64,
    columns: f64,
    rows: f64,
}

fn defined_coordinate(sample: &Sample<'_>, plane: &Plane, bias: i32) -> i32 {
    sample.coordinate(&plane.g).value as i32 - bias
}

/// Weights in 16 bits.
#[inline(always)]
fn narrow(wide: &[i32], out: &mut [u16]) {
    for (out, wide) in out.iter_mut().zip(wide) {
        *out = *wide as u16;
    }
}

/// INT-2 of a channel.
#[inline(always)]
fn color(corners: [u16; 3], w0: &[u16], w2: &[u16], out: &mut [i16]) {
    for ((out, w0), w2) in out.iter_mut().zip(w0).zip(w2) {
        *out = interpolate::color(corners, *w0, *w2) as i16;
    }
}

/// TEX-12 of a piece. No denominator: the perspective divide cancels. `false`: some pixel is too close to call, and nothing is known.
#[inline(always)]
fn direction<const FMA: bool, const ROW: bool>(
    piece: Piece<'_>,
    sampler: &Sampler,
    planes: &[Plane; 3],
    e: &[f64; 3],
    bounds: &Bounds,
    numbers: &mut [Numbers<i32>; 2],
    faces: &mut Numbers<u32>,
) -> bool {
    let lines = [0, 1, 2].map(|n: usize| planes[n].line(e));
    let terms = [0, 1, 2].map(|n: usize| planes[n].terms(e, bounds.columns, bounds.rows));
    let error = (terms[0] + terms[1] + terms[2]) * SLACK;
    let size = f64::from(sampler.side) * 128.0;
    let offset = if sampler.filters { 128.5 } else { 0.5 };
    let lanes = piece.lanes();
    let [u, v] = numbers;
    let (u, v, faces) = (&mut u[lanes.clone()], &mut v[lanes.clone()], &mut faces[lanes]);
    directions::<FMA, ROW>(piece.at, lines, (error, size, offset), u, v, faces)
}

/// The loop of [`direction`], with the error of a component, half of the size in 1/256 texel, and what is taken off a coordinate.
#[inline(always)]
fn directions<const FMA: bool, const ROW: bool>(
    at: Positions<'_>,
    lines: [Line; 3],
    (error, size, offset): (f64, f64, f64),
    u: &mut [i32],
    v: &mut [i32],
    faces: &mut [u32],
) -> bool {
    let mut close = 0_u64;
    let lanes = u.len();
    let (v, faces, columns, rows) = (&mut v[..lanes], &mut faces[..lanes], &at.x[..lanes], &at.y[..lanes]);
    for n in 0..lanes {
        let (column, row) = (f64::from(columns[n].min(at.last)), f64::from(rows[n]));
        let x = lines[0].at::<FMA, ROW>(column, row);
        let y = lines[1].at::<FMA, ROW>(column, row);
        let z = lines[2].at::<FMA, ROW>(column, row);
        let (ax, ay, az) = (x.abs(), y.abs(), z.abs());
        let on_x = (ax >= ay) & (ax >= az);
        let on_y = !on_x & (ay >= az);
        // One choice at a time: nested ones would become branches.
        let (magnitude, major) = (if on_y { ay } else { az }, if on_y { y } else { z });
        let (magnitude, major) = (if on_x { ax } else { magnitude }, if on_x { x } else { major });
        let negative = major < 0.0;
        let other = if on_x { -z } else { x };
        let turned = if negative { -other } else { other };
        let s = if on_y { other } else { turned };
        let upright = if negative { -z } else { z };
        let t = if on_y { upright } else { -y };
        // The face's number, as a float among floats.
        let axis = if on_y { 2.0 } else { 4.0 };
        let axis = if on_x { 0.0 } else { axis };
        let face = if negative { axis + 1.0 } else { axis };
        let r = size / magnitude;
        let slack = 0.5 - 4.0 * error * r;
        let (p, p_close) = nearest((s + magnitude) * r - offset, slack);
        let (q, q_close) = nearest((t + magnitude) * r - offset, slack);
        (u[n], v[n]) = (p, q);
        faces[n] = nearest(face, 0.5).0 as u32;
        close |= p_close | q_close;
        close |= ((ax - ay).abs() - error).to_bits();
        close |= ((ax - az).abs() - error).to_bits();
        close |= ((ay - az).abs() - error).to_bits();
    }
    close >> 63 == 0
}
