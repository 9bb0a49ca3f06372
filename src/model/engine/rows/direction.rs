//! TEX-12 on rows: the face that a direction meets, and the coordinates on it. TEX-15 divides by q instead of by the major component.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::Sampler;
use super::kernels::PerLane;
use super::planes::Plane;
use super::quotient::{
    IOTA_REAL, Line, Positions, QuotientEstimate, Reciprocals, SLACK, any_negative, larger, nearest, position, whole,
};
use super::setup::{BatchSetup, PixelBatch, Planes, Setup};
use super::short::{Losses, Short, floors};
use crate::raster::interpolate::COORDINATE_LIMIT;
use crate::texture::cube::{Face, Signed};

/// Largest error of an estimated coordinate with losses, 1/256 texel.
pub(super) const COARSEST: f64 = 0.125;

/// Returns the face that the directions of all three vertices meet, if none of them lies on an edge of it. Then all directions between them
/// meet it too.
pub(super) fn only_face(g: &[[i64; 3]; 3]) -> Option<Face> {
    let look = |k: usize| {
        let direction = [g[0][k], g[1][k], g[2][k]];
        let magnitudes = direction.map(i64::abs);
        let face = Face::from_direction(direction, magnitudes, 0);
        let axis = face.components()[2].axis;
        (0..3).all(|n| n == axis || magnitudes[n] < magnitudes[axis]).then_some(face)
    };
    let face = look(0)?;
    (look(1)? == face && look(2)? == face).then_some(face)
}

/// TEX-12: returns the coordinate of a component that is the same multiple of the major one at all vertices, and so everywhere. Such ties
/// lose nothing either (INT-4t). Returns `None` if the coordinate varies.
#[inline(always)]
pub(super) fn constant(planes: &[Plane; 3], of: Signed, major: Signed, size: u32) -> Option<f64> {
    let ([s, s1, s2], [m, m1, m2]) = (planes[of.axis].g, planes[major.axis].g);
    // 28 bits each.
    if m == 0 || s * m1 != s1 * m || s * m2 != s2 * m {
        return None;
    }
    let (s, m) = (if of.negative { -s } else { s }, if major.negative { -m } else { m });
    Some((m.signum() * (s + m) * i64::from(128 * size)).div_euclid(m.abs()) as f64)
}

/// Returns s, t and q with such signs that q is positive, and the largest magnitude of s/q and t/q. It is infinite if q has no sign.
pub(super) fn positive(mut g: [[i64; 3]; 3]) -> ([[i64; 3]; 3], f64) {
    if g[2].iter().all(|q| *q < 0) {
        g = [g[0].map(|n| -n), g[1].map(|n| -n), g[2].map(|n| -n)];
    }
    if g[2].iter().any(|q| *q <= 0) {
        return (g, f64::INFINITY);
    }
    let mut reach = 0.0;
    for k in 0..3 {
        let magnitude = g[0][k].unsigned_abs().max(g[1][k].unsigned_abs()) as f64 / g[2][k] as f64;
        if magnitude > reach {
            reach = magnitude;
        }
    }
    (g, reach)
}

/// The error that is accepted of a quotient by a divisor that changes its sign.
const BY_ANY_SIGN: f64 = 1.0 / 1024.0;

/// Returns the magnitude of a divisor d down to which a quotient's error, `first` / d + `second` / d^2, is accepted. It is not 0, even if the divisor
/// is known to be: TEX-15 says what a quotient by 0 is.
fn smallest_divisor(first: f64, second: f64) -> f64 {
    larger(larger(2.0 * first / BY_ANY_SIGN, (2.0 * second / BY_ANY_SIGN).sqrt()), f64::MIN_POSITIVE)
}

/// Returns whether coordinates of that magnitude, in images, may reach their limit (TEX-15).
pub(super) fn reaches_limit(reach: f64, sides: [u32; 2]) -> bool {
    512.0 * f64::from(sides[0].max(sides[1])) * reach >= COORDINATE_LIMIT as f64
}

/// A direction across a batch; also s, t and q.
pub(super) struct CubeDirection {
    /// The components x, y and z as linear functions.
    pub(super) lines: [Line; 3],
    /// Largest error of a component.
    error: f64,
}

impl CubeDirection {
    #[inline(always)]
    pub(super) fn new(planes: &[Plane; 3], local: &BatchSetup) -> CubeDirection {
        CubeDirection::around(planes, &local.real, local.columns, local.rows)
    }

    /// Returns the direction across so many columns and rows.
    #[inline(always)]
    pub(super) fn around(planes: &[Plane; 3], e: &[f64; 3], columns: f64, rows: f64) -> CubeDirection {
        let lines = [planes[0].real.line(e), planes[1].real.line(e), planes[2].real.line(e)];
        let terms = [
            planes[0].real.terms(e, columns, rows),
            planes[1].real.terms(e, columns, rows),
            planes[2].real.terms(e, columns, rows),
        ];
        CubeDirection { lines, error: (terms[0] + terms[1] + terms[2]) * SLACK }
    }

    /// Returns bounds of the error and of the magnitude of a quotient of two components times `scale`. `widest` is the reciprocal of the
    /// least divisor.
    #[inline(always)]
    pub(super) fn off(&self, widest: f64, scale: f64) -> (f64, f64) {
        let range = scale * (1.0 + self.error / SLACK * widest);
        (8.0 * self.error * widest * range, range)
    }

    /// Returns four functions that are all positive where directions meet a face.
    #[inline(always)]
    fn inside(&self, face: Face) -> [Line; 4] {
        let [s, t, m] = face.components();
        let (s, t, m) = (self.component(s), self.component(t), self.component(m));
        [m.plus(s), m.less(1.0, s), m.plus(t), m.less(1.0, t)]
    }

    /// Returns whether all directions meet a face. `least` gives a lower bound of a linear function in the batch.
    #[inline(always)]
    pub(super) fn stays(&self, face: Face, least: impl Fn(Line) -> f64) -> bool {
        let [a, b, c, d] = self.inside(face);
        let more = 4.0 * self.error;
        (least(a) > more) & (least(b) > more) & (least(c) > more) & (least(d) > more)
    }

    /// Estimates how many pixels of a row meet the first one's face, and so many rows above, too.
    #[inline(always)]
    pub(super) fn stretch<const FMA: bool>(&self, columns: f64, above: f64) -> usize {
        let Some(face) = self.look::<FMA>(0.0) else { return 1 };
        let mut last = columns;
        for line in self.inside(face).into_iter().filter(|line| line.x < 0.0) {
            let least = line.c - 4.0 * self.error - if line.y > 0.0 { line.y * above } else { 0.0 };
            let end = least / -line.x;
            last = if end < last { end } else { last };
        }
        last as usize + 1
    }

    #[inline(always)]
    pub(super) fn component(&self, of: Signed) -> Line {
        let line = self.lines[of.axis];
        if of.negative { line.times(-1.0) } else { line }
    }

    /// Returns the face that all pixels of a row meet. The directions of a face form a cone, so the ends of the row decide. Returns `None`
    /// if they meet several faces, or are too close to an edge.
    #[inline(always)]
    pub(super) fn face<const FMA: bool>(&self, columns: f64) -> Option<Face> {
        let (first, last) = (self.look::<FMA>(0.0)?, self.look::<FMA>(columns)?);
        (first == last).then_some(first)
    }

    /// Returns the face that a pixel of the row meets, or `None` if it is too close to an edge.
    #[inline(always)]
    pub(super) fn look<const FMA: bool>(&self, x: f64) -> Option<Face> {
        let [a, b, c] = &self.lines;
        let direction = [a.at::<FMA, true>(x, 0.0), b.at::<FMA, true>(x, 0.0), c.at::<FMA, true>(x, 0.0)];
        let magnitudes = [direction[0].abs(), direction[1].abs(), direction[2].abs()];
        let face = Face::from_direction(direction, magnitudes, 0.0);
        let [s, t, m] = face.components();
        let least = magnitudes[m.axis] - 2.0 * self.error;
        (magnitudes[s.axis] < least && magnitudes[t.axis] < least).then_some(face)
    }

    /// TEX-12 of a batch whose pixels meet several faces. It needs no denominator, because the perspective division cancels. Returns
    /// `false` if a pixel is too close to an edge; then no result counts.
    #[inline(always)]
    pub(super) fn directions<const FMA: bool>(
        &self,
        batch: PixelBatch<'_>,
        sampler: &Sampler,
        numbers: &mut [PerLane<i32>; 2],
        faces: &mut PerLane<u32>,
    ) -> bool {
        let size = f64::from(sampler.sides[0]) * 128.0;
        let offset = f64::from(sampler.bias()) + 0.5;
        let lanes = batch.lanes();
        let [u, v] = numbers;
        let (u, v, faces) = (&mut u[lanes.clone()], &mut v[lanes.clone()], &mut faces[lanes]);
        let about = (self.error, size, offset);
        if batch.is_row() {
            directions::<FMA, true>(batch.at, self.lines, about, u, v, faces)
        } else {
            directions::<FMA, false>(batch.at, self.lines, about, u, v, faces)
        }
    }
}

/// [`coordinates`], compiled for an instruction set.
pub(super) type FindCoordinates = fn(
    &Setup<'_>,
    PixelBatch<'_>,
    (&Sampler, &Planes),
    (&BatchSetup, &Reciprocals),
    (&mut [PerLane<i32>; 2], &mut PerLane<u32>),
    (&mut Short, &mut PerLane<i32>),
);

/// Computes the coordinates of a batch by the functions of its sampler. The definition computes those that estimates do not prove.
#[inline(always)]
pub(super) fn coordinates<const FMA: bool>(
    setup: &Setup<'_>,
    batch: PixelBatch<'_>,
    (sampler, planes): (&Sampler, &Planes),
    (local, reciprocals): (&BatchSetup, &Reciprocals),
    (numbers, faces): (&mut [PerLane<i32>; 2], &mut PerLane<u32>),
    (short, whole): (&mut Short, &mut PerLane<i32>),
) {
    let done = match planes {
        Planes::Plane(planes) if setup.context.triangle.loses_on_planes() => {
            // The sum bounds both, and is NaN if one of them is.
            let margin = local.margin::<false>(&planes[0].real) + local.margin::<false>(&planes[1].real);
            let lines = [planes[0].real.line(&local.real), planes[1].real.line(&local.real), local.denominator];
            let functions = (lines, setup.losses_on_planes(planes), (margin, 0.0));
            setup.short_quotients::<FMA>(batch, sampler, functions, short, numbers, faces)
        }
        Planes::Plane(planes) => {
            let [u, v] = &mut *numbers;
            let (u, v) = (&mut u[batch.lanes()], &mut v[batch.lanes()]);
            setup.on_planes::<FMA, false>(batch, (sampler, planes), (local, reciprocals), u, v, whole);
            true
        }
        Planes::Direction(planes, face) => {
            let direction = CubeDirection::new(planes, local);
            // Pixels beyond the triangle may meet another face than its vertices.
            let face = match *face {
                Some(face) if !batch.reaches_beyond() => Some(face),
                _ if batch.is_row() => direction.face::<FMA>(local.columns),
                face => face.filter(|face| direction.stays(*face, |line| line.least(local.columns, local.rows))),
            };
            match face {
                Some(face) => {
                    setup.on_face::<FMA>(batch, sampler, planes, face, &direction, local, short, numbers, faces)
                }
                None => direction.directions::<FMA>(batch, sampler, numbers, faces),
            }
        }
        Planes::Ratio(planes, reach) => {
            setup.projected::<FMA>(batch, sampler, planes, *reach, local, short, numbers, faces)
        }
        Planes::Other | Planes::Shared => false,
    };
    if !done {
        setup.defined(batch, sampler, numbers, faces);
    }
}

impl Setup<'_> {
    /// TEX-12 of a batch that meets one face: two ordinary quotients. Returns `false` if nothing would be proved.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "what the caller has computed")]
    fn on_face<const FMA: bool>(
        &self,
        batch: PixelBatch<'_>,
        sampler: &Sampler,
        planes: &[Plane; 3],
        face: Face,
        direction: &CubeDirection,
        local: &BatchSetup,
        short: &mut Short,
        numbers: &mut [PerLane<i32>; 2],
        faces: &mut PerLane<u32>,
    ) -> bool {
        let [s, t, major] = face.components();
        let m = direction.component(major);
        let least = self.least::<FMA>(batch, m, &planes[major.axis], local);
        let widest = 1.0 / least;
        let size = f64::from(sampler.sides[0]) * 128.0;
        // The error of both components, again for what is subtracted, and twice that.
        let margin = 8.0 * direction.error * size * widest;
        let line = |of: Signed| match constant(planes, of, major, sampler.sides[0]) {
            // The middle of the step, far from where the floor changes.
            Some(floor) => m.times(floor + 0.5),
            None => direction.component(of).plus(m).times(size),
        };
        let (along, down) = (line(s), line(t));
        faces[batch.lanes()].fill(face as u32);
        self.quotients::<FMA>(batch, sampler, [along, down, m], widest, margin, local, short, numbers, faces)
    }

    /// TEX-15 of a batch for s, t and q: two quotients of numbers that lose something where weights fall short. `reach` bounds
    /// their magnitudes, in images, if q is positive. Returns `false` if nothing would be proved.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "what the caller has computed")]
    fn projected<const FMA: bool>(
        &self,
        batch: PixelBatch<'_>,
        sampler: &Sampler,
        planes: &[Plane; 3],
        reach: f64,
        local: &BatchSetup,
        short: &mut Short,
        numbers: &mut [PerLane<i32>; 2],
        faces: &mut PerLane<u32>,
    ) -> bool {
        let direction = CubeDirection::new(planes, local);
        let [s, t, q] = direction.lines;
        let [width, height] = [256.0 * f64::from(sampler.sides[0]), 256.0 * f64::from(sampler.sides[1])];
        let most = if width > height { width } else { height };
        let lines = [s.times(width), t.times(height), q];
        // The error of s or t, that of q times the quotient, again for what is subtracted, and twice that.
        let error = 8.0 * direction.error * most;
        let proved = if reach.is_infinite() {
            // The largest s or t in place of those at the vertices. Losses take less than 2^-20 of the divisor.
            (BY_ANY_SIGN, smallest_divisor(2.0 * error, 2.0 * error * direction.error / SLACK))
        } else {
            let widest = 1.0 / self.least::<FMA>(batch, q, &planes[2], local);
            let mut reach = reach;
            if batch.reaches_beyond() {
                if widest <= 0.0 {
                    return false;
                }
                reach *= planes[2].real.terms(&local.real, local.columns, local.rows) * widest;
            }
            (error * (1.0 + reach) * widest, 0.0)
        };
        let functions = (lines, self.losses_by_q(planes, [width, height]), proved);
        self.short_quotients::<FMA>(batch, sampler, functions, short, numbers, faces)
    }

    /// INT-4t: computes two quotients of lines with losses by a third one. `margin` is the largest error unless the divisor's magnitude is
    /// below `smallest`. The definition computes lanes that are not proved. Returns `false` if nothing would be proved.
    #[inline(always)]
    fn short_quotients<const FMA: bool>(
        &self,
        batch: PixelBatch<'_>,
        sampler: &Sampler,
        (lines, losses, (margin, smallest)): ([Line; 3], [Losses; 3], (f64, f64)),
        short: &mut Short,
        numbers: &mut [PerLane<i32>; 2],
        faces: &mut PerLane<u32>,
    ) -> bool {
        // NaN proves nothing either.
        let proves = margin < COARSEST;
        if !proves {
            return false;
        }
        let [at_u, at_v] = &mut short.at;
        short.dominance.divide_batch::<FMA>(batch, lines, losses, -0.5, [at_u, at_v]);
        let (lanes, [u, v], Short { at, close, .. }) = (batch.at.x.len(), &mut *numbers, short);
        close[..lanes].fill(0);
        if smallest > 0.0 {
            let (last, xs, ys) = (f64::from(batch.at.last), &batch.at.x[..lanes], &batch.at.y[..lanes]);
            for n in 0..lanes {
                let (x, y) = position::<false>(n, last, xs, ys, &IOTA_REAL[..lanes]);
                close[n] = (lines[2].at::<FMA, false>(x, y).abs() - smallest).to_bits();
            }
        }
        floors(&at[0][..lanes], margin, sampler.bias(), close, &mut u[batch.lanes()]);
        floors(&at[1][..lanes], margin, sampler.bias(), close, &mut v[batch.lanes()]);
        let count = if any_negative(&close[..lanes]) { batch.count } else { 0 };
        for n in (0..count).filter(|n| close[*n] >> 63 != 0) {
            self.defined_lane(batch, n, sampler, numbers, faces);
        }
        true
    }

    /// Returns a lower bound in the batch of a linear function that is positive at all vertices.
    #[inline(always)]
    pub(super) fn least<const FMA: bool>(
        &self,
        batch: PixelBatch<'_>,
        line: Line,
        plane: &Plane,
        local: &BatchSetup,
    ) -> f64 {
        if batch.is_row() {
            let end = line.at::<FMA, true>(local.columns, 0.0);
            return if line.c < end { line.c } else { end };
        }
        if batch.reaches_beyond() {
            return line.least(local.columns, local.rows);
        }
        let g = &plane.g;
        let least = g[0].unsigned_abs().min(g[1].unsigned_abs()).min(g[2].unsigned_abs());
        least as f64 * self.context.triangle.doubled_area as f64
    }

    /// Estimates two quotients by a line that is at least 1 / `widest`. `margin` is the largest error. The definition computes lanes that
    /// are not proved. Returns `false` if nothing would be proved.
    #[inline(always)]
    #[allow(clippy::too_many_arguments, reason = "what the caller has computed")]
    fn quotients<const FMA: bool>(
        &self,
        batch: PixelBatch<'_>,
        sampler: &Sampler,
        [along, down, m]: [Line; 3],
        widest: f64,
        margin: f64,
        local: &BatchSetup,
        short: &mut Short,
        numbers: &mut [PerLane<i32>; 2],
        faces: &mut PerLane<u32>,
    ) -> bool {
        let (extent, reciprocals) = ((local.columns, local.rows), (1.0 / m.c, widest));
        let (Some(along), Some(down)) = (
            QuotientEstimate::new::<false>(along, m, extent, reciprocals, margin, sampler.bias()),
            QuotientEstimate::new::<false>(down, m, extent, reciprocals, margin, sampler.bias()),
        ) else {
            return false;
        };
        let [u, v] = numbers;
        short.set_reciprocals::<FMA>(batch, m);
        let divided = &short.reciprocals;
        let close = divided.estimate::<FMA, false>([along, down], &mut u[batch.lanes()], &mut v[batch.lanes()]);
        if close[0] | close[1] {
            for n in 0..batch.count {
                match divided.prove::<false>(n, &[along, down]) {
                    Some([u, v]) => (numbers[0][batch.lane + n], numbers[1][batch.lane + n]) = (u, v),
                    None => self.defined_lane(batch, n, sampler, numbers, faces),
                }
            }
        }
        true
    }
}

/// The loop of [`CubeDirection::directions`]. It takes the largest error of a component, half the face's size in 1/256 texel, and what is
/// subtracted from coordinates.
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
        let (column, row) = (f64::from(i32::from(columns[n]).min(at.last)), f64::from(rows[n]));
        let x = lines[0].at::<FMA, ROW>(column, row);
        let y = lines[1].at::<FMA, ROW>(column, row);
        let z = lines[2].at::<FMA, ROW>(column, row);
        let (ax, ay, az) = (x.abs(), y.abs(), z.abs());
        let (more, less) = (if ax > ay { ax } else { ay }, if ax > ay { ay } else { ax });
        let (magnitude, rest) = (if more > az { more } else { az }, if more > az { az } else { more });
        let second = if rest > less { rest } else { less };
        // A tie between two components proves nothing.
        let (on_x, on_y) = (ax >= magnitude, ay >= magnitude);
        // One choice at a time, because compilers turn nested ones into branches.
        let major = if on_y { y } else { z };
        let major = if on_x { x } else { major };
        let negative = major < 0.0;
        let other = if on_x { -z } else { x };
        let turned = if negative { -other } else { other };
        let s = if on_y { other } else { turned };
        let upright = if negative { -z } else { z };
        let t = if on_y { upright } else { -y };
        // Number of the face, as a float.
        let axis = if on_y { 2.0 } else { 4.0 };
        let axis = if on_x { 0.0 } else { axis };
        let face = if negative { axis + 1.0 } else { axis };
        let r = size / magnitude;
        let slack = 0.5 - 4.0 * error * r;
        let (p, q) = ((s + magnitude) * r - offset, (t + magnitude) * r - offset);
        (u[n], v[n]) = (nearest(p), nearest(q));
        faces[n] = nearest(face) as u32;
        close |= (slack - (p - whole(p)).abs()).to_bits();
        close |= (slack - (q - whole(q)).abs()).to_bits();
        close |= (magnitude - second - error).to_bits();
    }
    close >> 63 == 0
}
