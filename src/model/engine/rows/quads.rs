//! TEX-11 on rows: the exact coordinates of the quads of a batch, and what units derive from them: a level of detail, or the taps of a
//! footprint.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::direction::{CubeDirection, constant, reaches_limit};
use super::kernels::{LANES, PerLane, STEP};
use super::lods::Slopes;
use super::planes::Plane;
use super::quotient::{Line, SLACK, any_negative, larger, whole};
use super::setup::{BatchSetup, PixelBatch, Planes, Setup, whole_steps};
use super::shapes::SIDE;
use super::short::Losses;
use super::{Reason, Sampler};
use crate::raster::interpolate::COORDINATE_LIMIT;
use crate::texture::coordinates::{Coordinates, SampleCoordinates};
use crate::texture::cube::{Face, Signed};
use crate::texture::lod::Quad;
use crate::texture::planned::PlannedUnit;
use std::ops::Range;

/// Coordinates of three pixels of each quad: u and v in 1/65536 texel, whole numbers.
pub(super) type AtQuads = [[PerLane<f64>; 2]; 3];

/// A triangle that is set up alone: its exact numbers and the definition decide what estimates of a batch do not prove.
#[derive(Clone, Copy)]
pub(super) struct Exact<'s> {
    pub(super) setup: &'s Setup<'s>,
    pub(super) batch: &'s PixelBatch<'s>,
    /// Edge functions at the batch's first pixel.
    pub(super) e: &'s [i64; 3],
}

/// A result that a unit derives from the coordinates at a quad.
pub(super) trait Measure: Copy {
    /// Returns the result for a quad that is behind the viewer in part.
    fn behind(unit: &PlannedUnit) -> Self;

    /// Estimates the results of quads from how coordinates change around their [origins](Quads::origins). Sign bits of `close` mark those
    /// that are not proved. Returns `false` if nothing was estimated.
    #[inline(always)]
    fn estimate<const FMA: bool>(_: &BaseLevel<'_>, _: [&[f32]; 2], _: &mut [Self], _: &mut [i32]) -> bool {
        false
    }

    /// Computes the results of the first `count` quads. Sign bits of `unknown` mark quads whose coordinates are not known; more of them can
    /// be set.
    fn measure<const WIDE: bool>(unit: &PlannedUnit, at: &AtQuads, count: usize, out: &mut [Self], unknown: &mut [u64]);

    /// Computes the result of one quad by the definition.
    fn defined(unit: &PlannedUnit, quad: Option<Quad>) -> Self;
}

/// Scratch space for the coordinates of quads.
#[derive(Clone, Debug, Default)]
pub(super) struct Quads {
    /// Columns and rows of the upper left pixels of the quads, relative to the batch's first pixel.
    origins: [PerLane<f32>; 2],
    coordinates: AtQuads,
    /// Doubles as bits, negative for quads whose coordinates are not known.
    unknown: PerLane<u64>,
    /// Sign bits of quads whose estimated result is not proved, the indices of these quads, and their origins.
    close: PerLane<i32>,
    open: PerLane<u16>,
    open_origins: [PerLane<f32>; 2],
    /// Number of quads of a box.
    count: usize,
    /// The rows of a batch.
    rows: [QuadsOfRow; SIDE as usize],
    filled: usize,
}

impl Quads {
    /// Finds the quads of a box and the quad of each lane.
    #[inline(always)]
    pub(super) fn begin_box(&mut self, batch: PixelBatch<'_>) {
        let ((i, j), [xs, ys]) = (batch.first, &mut self.origins);
        let (mut quads, mut lane) = (0, 0);
        let mut runs = batch.runs;
        self.filled = 0;
        while let Some((row, ..)) = runs.first() {
            let rows = runs.iter().take(2).take_while(|(other, ..)| other >> 1 == row >> 1).count();
            let (pair, later) = runs.split_at(rows);
            runs = later;
            let (mut low, mut high) = (i64::MAX, i64::MIN);
            for (_, first, count) in pair {
                (low, high) = (low.min(first >> 1), high.max((first + *count as i64 - 1) >> 1));
            }
            for (_, first, count) in pair {
                let quad = quads + ((first >> 1) - low) as usize;
                self.rows[self.filled] = QuadsOfRow { lane, quad, odd: (first & 1) as usize };
                self.filled += 1;
                lane += count;
            }
            // A whole step, of which the next rows overwrite what is too much.
            let (x, y) = ((2 * low - i) as i32, ((row & !1) - j) as f32);
            for (n, (to_x, to_y)) in xs[quads..quads + STEP].iter_mut().zip(&mut ys[quads..quads + STEP]).enumerate() {
                (*to_x, *to_y) = ((x + 2 * n as i32) as f32, y);
            }
            quads += (high + 1 - low) as usize;
        }
        if let Some(last) = quads.checked_sub(1) {
            let (x, y, beyond) = (xs[last], ys[last], whole_steps(quads));
            xs[quads..beyond].fill(x);
            ys[quads..beyond].fill(y);
        }
        self.count = quads;
    }
}

/// Results of quads side by side, for the two rows that share them.
#[derive(Clone, Debug)]
pub(super) struct Known<T> {
    /// Number of the triangle, and of the pair of rows.
    of: Option<(usize, i64)>,
    /// Columns of the quads.
    columns: Range<i64>,
    /// Result of each quad, from the first column on.
    pub(super) each: Vec<T>,
    /// Results of quads whose estimates are not proved.
    open: Vec<T>,
}

impl<T> Default for Known<T> {
    fn default() -> Self {
        Known { of: None, columns: 0..0, each: Vec::new(), open: Vec::new() }
    }
}

/// Pixels of a row side by side: two of them belong to a quad. If `odd` is 1, the first pixel is the right one of its quad.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct QuadsOfRow {
    lane: usize,
    quad: usize,
    odd: usize,
}

/// How the lanes of a batch map to the [known](Known) quads.
#[derive(Clone, Copy, Debug)]
pub(super) enum Spread {
    /// All lanes belong to the first quad.
    First,
    /// As the [rows](Quads::rows) say.
    Rows,
}

impl Spread {
    /// Copies the results of quads to their lanes. Only the first `count` lanes have pixels; others up to the next whole step repeat the last
    /// one.
    #[inline(always)]
    pub(super) fn hand_out<T: Copy>(&self, quads: &Quads, known: &[T], count: usize, out: &mut PerLane<T>) {
        match *self {
            Spread::First => out[..count].fill(known[0]),
            Spread::Rows if quads.filled == 1 => {
                let QuadsOfRow { quad, odd, .. } = quads.rows[0];
                let known = &known[quad..];
                let (head, pairs) = out[..count].split_at_mut(odd.min(count));
                head.fill(known[0]);
                let (pairs, rest) = pairs.as_chunks_mut::<2>();
                for (pair, known) in pairs.iter_mut().zip(&known[odd..]) {
                    *pair = [*known; 2];
                }
                rest.fill(known[(count - 1 + odd) >> 1]);
            }
            Spread::Rows => {
                // Whole steps, of which the next row overwrites what is too much.
                for QuadsOfRow { lane, quad, odd } in quads.rows[..quads.filled].iter().copied() {
                    let known = &known[quad..][..=STEP / 2];
                    let step = &mut out[lane..][..STEP];
                    for n in 0..STEP {
                        step[n] = if odd == 1 { known[n.div_ceil(2)] } else { known[n / 2] };
                    }
                }
            }
        }
        let (last, beyond) = (out[count - 1], count..whole_steps(count));
        out[beyond].fill(last);
    }

    /// Calls a function for each of `count` lanes with its quad.
    #[inline(always)]
    pub(super) fn each(&self, quads: &Quads, count: usize, mut call: impl FnMut(usize, usize)) {
        let Spread::Rows = self else { return (0..count).for_each(|lane| call(lane, 0)) };
        let rows = &quads.rows[..quads.filled];
        for (n, row) in rows.iter().enumerate() {
            let end = rows.get(n + 1).map_or(count, |next| next.lane);
            for lane in row.lane..end {
                call(lane, row.quad + ((lane - row.lane + row.odd) >> 1));
            }
        }
    }
}

/// Bound of coordinates in 1/256 texel, so that their multiples are exact in double precision.
const MAX_COORDINATE: f64 = (1_u64 << 36) as f64;

/// Largest error of an estimated coordinate that is accepted, in its own steps.
const COARSEST: f64 = 0.125;

/// Half a step of the coordinates of quads.
const HALF_STEP: f64 = 0.5;

/// Coordinates of level 0 around a batch, as two quotients.
pub(super) struct BaseLevel<'p> {
    pub(super) along: Line,
    pub(super) down: Line,
    pub(super) denominator: Line,
    /// The least denominator of a quad's pixel, and how many columns and rows lie between a quad and the first pixel at most.
    pub(super) lowest: f64,
    pub(super) reach: [f64; 2],
    /// What was added to u and v because they are [constant](super::planes::up), 1/65536 texel.
    pub(super) up: [f64; 2],
    /// Upper bound of the error of an estimate, 1/256 texel.
    pub(super) off: f64,
    /// Upper bound of the change of a smaller level's coordinates by the floors of its numerators (INT-4).
    pub(super) floors: f64,
    pub(super) face: Face,
    /// Whether all of the batch lies behind the viewer, where no level of detail is known.
    pub(super) behind: bool,
    /// Whether the denominator is D.
    pub(super) by_d: bool,
    /// Planes whose exact remainders decide what estimates do not prove.
    pub(super) planes: Option<&'p [Plane; 2]>,
    /// Losses of the three functions where weights fall short (TEX-15, INT-4t).
    pub(super) losses: Option<[Losses; 3]>,
    /// For planes: the numbers of which all values of u and of v are multiples, and the powers of two that divide the G_k.
    pub(super) gaps: [(f64, u32); 2],
    /// How fast the coordinates change, if that is set up.
    pub(super) slopes: Option<Slopes>,
}

impl Default for BaseLevel<'_> {
    fn default() -> Self {
        BaseLevel {
            along: Line::default(),
            down: Line::default(),
            denominator: Line::default(),
            lowest: 0.0,
            reach: [0.0; 2],
            up: [0.0; 2],
            off: 0.0,
            floors: 0.0,
            face: Face::PositiveX,
            behind: false,
            by_d: false,
            planes: None,
            losses: None,
            gaps: [(0.0, 0); 2],
            slopes: None,
        }
    }
}

impl BaseLevel<'_> {
    /// Returns whether anything is proved, with coordinates in such a `range` and the least D. Without branches, so that compilers set up several
    /// batches at once.
    #[inline(always)]
    pub(super) fn proves(&self, range: f64, least: f64) -> bool {
        // NaN proves nothing either.
        (least > 0.0)
            & (self.lowest > 0.0)
            & (range < MAX_COORDINATE)
            & (self.off < COARSEST / 256.0)
            & (self.floors < COARSEST)
    }
}

/// Returns the least value of a function at the pixels of quads, none of which lies further to the left of the first pixel, or more than one row above
/// it.
#[inline(always)]
pub(super) fn least_around(line: Line, left: f64, [columns, rows]: [f64; 2]) -> f64 {
    line.c - falls(line.x, left, columns) - falls(line.y, 1.0, rows)
}

/// Returns how far a function falls at most, so many steps back and ahead.
#[inline(always)]
fn falls(slope: f64, back: f64, ahead: f64) -> f64 {
    if slope > 0.0 { slope * back } else { -slope * ahead }
}

/// Returns what is added to a coordinate on planes for what is added to [others](super::planes::up), 1/65536 texel.
#[inline(always)]
pub(super) fn up_of_quads(up: f64) -> f64 {
    // Also between two steps of the coordinates of quads.
    if up > 0.0 { 256.0 * up + HALF_STEP } else { 0.0 }
}

/// Returns upper bounds for coordinates on planes around a batch, which are divided by D: of their magnitudes, with those of all terms, and of their
/// changes by the floors of numerators (INT-4). Takes the least D and its terms, the terms of u and v, bounds of their magnitudes at the vertices, and
/// the least P_k.
#[inline(always)]
pub(super) fn bounds_on_planes((lowest, of_d): (f64, f64), terms: [f64; 2], reach: [f64; 2], least: f64) -> (f64, f64) {
    let widest = 1.0 / lowest;
    let ratio = of_d * widest;
    // Outside of the triangle, numbers can be larger than at the vertices.
    let most = [terms[0] * widest + 2.0 * reach[0] * ratio, terms[1] * widest + 2.0 * reach[1] * ratio];
    // The magnitudes of weights add up to `ratio` at most.
    (larger(most[0], most[1]) * (1.0 + ratio), 1.25 * ratio / least)
}

impl Setup<'_> {
    /// Returns the coordinates of level 0 around a batch, or `None` if nothing would be proved.
    #[inline(always)]
    pub(super) fn base_level<'p, const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        (sampler, planes): (&Sampler, &'p Planes),
        local: &BatchSetup,
    ) -> Option<BaseLevel<'p>> {
        // Pixels of a quad lie at most one pixel outside of the batch.
        let (columns, rows) = (local.columns + 1.0, local.rows + 1.0);
        // No pixel lies further to the left of a row's first pixel, or above that of a box.
        let left = if ROW { 1.0 } else { columns };
        let least = |line: Line| least_around(line, left, [columns, rows]);
        let (lowest, reach) = (least(local.denominator), [columns, rows]);
        // Quotients by another line than D.
        let divided = |[along, down]: [Line; 2], denominator: Line, off: f64, face: Face| BaseLevel {
            along,
            down,
            denominator,
            lowest: least(denominator),
            reach,
            off,
            face,
            ..BaseLevel::default()
        };
        let (base, range) = match planes {
            Planes::Plane(planes) if !self.stays_near(&batch, planes, local) => return None,
            Planes::Plane(planes) => {
                let [u, v] = [&planes[0].real, &planes[1].real];
                let of_d = self.denominator.real.terms(&local.real, columns, rows);
                let terms = [u.terms(&local.real, columns, rows), v.terms(&local.real, columns, rows)];
                let p = &self.context.triangle.p;
                let losses = self.context.triangle.loses_on_planes().then(|| self.losses_on_planes(planes));
                let up = if losses.is_none() { sampler.up.map(up_of_quads) } else { [0.0; 2] };
                let least = p[0].min(p[1]).min(p[2]) as f64;
                let reaches = [u.reach, v.reach];
                let (range, floors) = bounds_on_planes((lowest, of_d), terms, reaches, least);
                let line = |n: usize| planes[n].real.line(&local.real).plus(local.denominator.times(up[n] / 256.0));
                let base = BaseLevel {
                    along: line(0),
                    down: line(1),
                    denominator: local.denominator,
                    lowest,
                    reach,
                    up,
                    off: range * SLACK,
                    floors,
                    by_d: true,
                    planes: Some(planes),
                    losses,
                    gaps: [planes[0].gap(&self.context.triangle), planes[1].gap(&self.context.triangle)],
                    ..BaseLevel::default()
                };
                (base, range)
            }
            Planes::Ratio(_, reach) if reach.is_finite() && reaches_limit(*reach, sampler.sides) => return None,
            Planes::Ratio(planes, reach) => {
                let direction = CubeDirection::around(planes, &local.real, columns, rows);
                // Where q changes its sign, it has one in most batches.
                let sign = if reach.is_infinite() && direction.lines[2].c < 0.0 { -1.0 } else { 1.0 };
                let [s, t, q] = direction.lines.map(|line| line.times(sign));
                let sides = sampler.sides.map(|side| 256.0 * f64::from(side));
                let most = if sides[0] > sides[1] { sides[0] } else { sides[1] };
                let (off, range) = direction.off(1.0 / least(q), most);
                if reach.is_infinite() && range >= COORDINATE_LIMIT as f64 {
                    return None;
                }
                let lines = [s.times(sides[0]), t.times(sides[1])];
                // The signs of all three were changed if q was negative.
                let behind = match self.context.coordinates_of(sampler.unit) {
                    Some(Coordinates::Ratio(g)) if reach.is_finite() => g[2][0] < 0,
                    _ => sign < 0.0,
                };
                let losses = (!self.context.triangle.exact_reciprocal)
                    .then(|| self.losses_by_q(planes, sides).map(|of| of.map(|loss| loss * sign)));
                (BaseLevel { behind, losses, ..divided(lines, q, off, Face::PositiveX) }, range)
            }
            Planes::Direction(planes, face) => {
                let direction = CubeDirection::around(planes, &local.real, columns, rows);
                let face = match face {
                    Some(face) => *face,
                    None => direction.look::<FMA>(0.0)?,
                };
                let [s, t, major] = face.components();
                let m = direction.component(major);
                // The first pixel of a quad could meet another face.
                let (odd_column, odd_row) = ((batch.first.0 & 1) as f64, (batch.first.1 & 1) as f64);
                let meets =
                    |line: Line| line.c - falls(line.x, odd_column, local.columns) - falls(line.y, odd_row, 0.0);
                if !(if ROW { direction.stays(face, meets) } else { direction.stays(face, least) }) {
                    return None;
                }
                let size = 128.0 * f64::from(sampler.sides[0]);
                let (off, range) = direction.off(1.0 / least(m), size);
                let line = |of: Signed| match constant(planes, of, major, sampler.sides[0]) {
                    Some(floor) => m.times(floor + (128.0 + HALF_STEP) / 256.0),
                    None => direction.component(of).plus(m).times(size),
                };
                let lines = [line(s), line(t)];
                (divided(lines, m, off, face), range)
            }
            Planes::Other | Planes::Shared => return None,
        };
        base.proves(range, lowest).then_some(base)
    }

    /// Computes the results of the quads of a batch. Returns how lanes map to them.
    #[inline(always)]
    pub(super) fn of_quads<const FMA: bool, const ROW: bool, T: Measure>(
        &self,
        batch: PixelBatch<'_>,
        (unit, base): (&PlannedUnit, &BaseLevel<'_>),
        e: &[i64; 3],
        quads: &mut Quads,
        known: &mut Known<T>,
    ) -> Spread {
        let (i, j) = batch.first;
        let above = ((j & !1) - j) as f32;
        let exact = Some(Exact { setup: self, batch: &batch, e });
        if base.behind {
            known.make_room(unit, 1);
            (known.of, known.each[0]) = (None, T::behind(unit));
            return Spread::First;
        }
        if !ROW {
            of_box::<FMA, T>((unit, base), exact, quads, known);
            return Spread::Rows;
        }
        let wanted = (i >> 1)..((i + batch.count as i64 - 1) >> 1) + 1;
        let row = Some((self.context.number, j >> 1));
        let follows = wanted.start >= known.columns.start && wanted.start <= known.columns.end;
        if known.of != row || !follows {
            (known.of, known.columns) = (row, wanted.start..wanted.start);
        }
        // Not a loop, before which compilers would compute all that does not change in it.
        let next = known.columns.end;
        if next < wanted.end {
            // A block has no more, and one more where it begins with half a quad.
            let count = (wanted.end - next) as usize;
            let [xs, ys] = &mut quads.origins;
            let lanes = whole_steps(count);
            let (first, last) = ((2 * next - i) as i32, count as i32 - 1);
            for (k, x) in xs[..lanes].iter_mut().enumerate() {
                *x = (first + 2 * (k as i32).min(last)) as f32;
            }
            ys[..lanes].fill(above);
            let first = (next - known.columns.start) as usize;
            known.make_room(unit, first + LANES + STEP);
            let out = (&mut known.each[first..], &mut known.open[..]);
            measured::<FMA, T>((unit, base), exact, count, quads, out);
            known.columns.end = wanted.end;
        }
        let quad = (wanted.start - known.columns.start) as usize;
        (quads.rows[0], quads.filled) = (QuadsOfRow { lane: 0, quad, odd: (i & 1) as usize }, 1);
        Spread::Rows
    }

    /// Computes the result of a quad by the definition.
    #[inline(never)]
    pub(super) fn defined_quad<T: Measure>(&self, batch: PixelBatch<'_>, unit: &PlannedUnit, pixel: (i64, i64)) -> T {
        self.count_defined(Reason::Levels, 1);
        let sample = self.sample(batch, 0);
        T::defined(unit, self.context.sample_coordinates(unit, &sample, pixel).and_then(|place| place.quad()))
    }
}

impl<T: Measure> Known<T> {
    /// Makes room for so many results. Not where some are open: code that grows a list would slow down the loops beside it.
    #[inline(always)]
    fn make_room(&mut self, unit: &PlannedUnit, count: usize) {
        self.each.resize(self.each.len().max(count), T::behind(unit));
        self.open.resize(LANES, T::behind(unit));
    }
}

/// Computes the results of the [quads of a box](Quads::begin_box). Returns `false` if some are not proved and nothing decides them.
#[inline(always)]
pub(super) fn of_box<const FMA: bool, T: Measure>(
    (unit, base): (&PlannedUnit, &BaseLevel<'_>),
    exact: Option<Exact<'_>>,
    quads: &mut Quads,
    known: &mut Known<T>,
) -> bool {
    known.make_room(unit, LANES + STEP);
    known.of = None;
    let count = quads.count;
    measured::<FMA, T>((unit, base), exact, count, quads, (&mut known.each, &mut known.open))
}

/// Computes the results of quads at the given [origins](Quads::origins): those whose estimates are not proved from their coordinates, side by side
/// in `spare`. Returns `false` if some are not proved then and nothing decides them.
#[inline(always)]
fn measured<const FMA: bool, T: Measure>(
    (unit, base): (&PlannedUnit, &BaseLevel<'_>),
    exact: Option<Exact<'_>>,
    count: usize,
    quads: &mut Quads,
    (out, spare): (&mut [T], &mut [T]),
) -> bool {
    let rounded = whole_steps(count);
    let Quads { origins: [xs, ys], coordinates, unknown, close, open, open_origins, .. } = quads;
    let (xs, ys, close, out) = (&xs[..rounded], &ys[..rounded], &mut close[..rounded], &mut out[..rounded]);
    let mut left = count;
    if T::estimate::<FMA>(base, [xs, ys], out, close) {
        // Without an early exit, which is slower.
        left = close[..count].iter().fold(0, |left, close| left + usize::from(*close < 0));
    }
    if left == 0 {
        return true;
    }
    // A few are computed side by side, many with those between them.
    let few = 2 * left <= count;
    let (mut origins, mut to) = ([xs, ys], &mut *out);
    if few {
        left = 0;
        for n in 0..count {
            open[left] = n as u16;
            left += usize::from(close[n] < 0);
        }
        let (rounded, last) = (whole_steps(left), open[left - 1]);
        open[left..rounded].fill(last);
        let [xs, ys] = open_origins;
        for (n, quad) in open[..rounded].iter().enumerate() {
            (xs[n], ys[n]) = (origins[0][usize::from(*quad)], origins[1][usize::from(*quad)]);
        }
        (origins, to) = ([&xs[..rounded], &ys[..rounded]], &mut spare[..rounded]);
    }
    let measured = if few { left } else { count };
    if !measured_exactly::<FMA, T>((unit, base), exact, origins, measured, (coordinates, unknown), to) {
        return false;
    }
    if few {
        for (quad, result) in open[..left].iter().zip(spare) {
            out[usize::from(*quad)] = *result;
        }
    }
    true
}

/// Computes the results of quads from their coordinates. Returns `false` if some are not proved and nothing decides them.
#[inline(always)]
fn measured_exactly<const FMA: bool, T: Measure>(
    (unit, base): (&PlannedUnit, &BaseLevel<'_>),
    exact: Option<Exact<'_>>,
    [xs, ys]: [&[f32]; 2],
    count: usize,
    (coordinates, unknown): (&mut AtQuads, &mut PerLane<u64>),
    out: &mut [T],
) -> bool {
    const PIXELS: [(i64, i64); 3] = [(0, 0), (1, 0), (0, 1)];
    let rounded = xs.len();
    let unknown = &mut unknown[..rounded];
    unknown.fill(0);
    for ((x, y), [u, v]) in PIXELS.into_iter().zip(&mut *coordinates) {
        corners::<FMA>(base, [xs, ys], [x as f64, y as f64], &mut u[..rounded], &mut v[..rounded], unknown);
    }
    if let (Some(planes), Some(Exact { setup, e, .. })) = (base.planes, exact)
        && any_negative(unknown)
    {
        for n in (0..count).filter(|n| unknown[*n] >> 63 != 0) {
            for ((x, y), at) in PIXELS.into_iter().zip(&mut *coordinates) {
                let (x, y) = (xs[n] as i64 + x, ys[n] as i64 + y);
                let bottom = setup.denominator.exact(e).at(x, y);
                for ((plane, up), at) in planes.iter().zip(base.up).zip(at) {
                    let value = at[n] as i64 - up as i64;
                    at[n] = floor(plane.exact(e).times(256).at(x, y), bottom, value).0 as f64;
                }
            }
        }
        unknown.fill(0);
    }
    T::measure::<FMA>(unit, coordinates, count, &mut out[..rounded], unknown);
    if !any_negative(unknown) {
        return true;
    }
    let Some(Exact { setup, batch, .. }) = exact else { return false };
    for n in (0..count).filter(|n| unknown[*n] >> 63 != 0) {
        let pixel = (batch.first.0 + xs[n] as i64, batch.first.1 + ys[n] as i64);
        out[n] = setup.defined_quad(*batch, unit, pixel);
    }
    true
}

/// Returns what is added to estimates whose error is less than `off`, and the distance from an integer below which they prove nothing. If
/// all values are multiples of a sufficiently wide `gap`, the addition separates integers from the values below them, and everything is
/// proved.
#[inline(always)]
pub(super) fn parted(gap: f64, off: f64) -> (f64, f64) {
    if gap >= 4.0 * off { (off, -1.0) } else { (0.0, off) }
}

/// Computes u and v of one of the three pixels of quads, as floors in 1/65536 texel. Sets the sign bits of those that are not proved.
#[inline(always)]
fn corners<const FMA: bool>(
    base: &BaseLevel<'_>,
    [xs, ys]: [&[f32]; 2],
    [right, below]: [f64; 2],
    u: &mut [f64],
    v: &mut [f64],
    unknown: &mut [u64],
) {
    let lanes = u.len();
    let (v, unknown, xs, ys) = (&mut v[..lanes], &mut unknown[..lanes], &xs[..lanes], &ys[..lanes]);
    let (along, down, denominator) = (base.along.times(256.0), base.down.times(256.0), base.denominator);
    let off = 256.0 * base.off;
    let [(up_p, off_p), (up_q, off_q)] = base.gaps.map(|(gap, _)| parted(256.0 * gap, off));
    for n in 0..lanes {
        let (x, y) = (f64::from(xs[n]) + right, f64::from(ys[n]) + below);
        let r = 1.0 / denominator.at::<FMA, false>(x, y);
        let (p, q) = (along.at::<FMA, false>(x, y) * r + up_p, down.at::<FMA, false>(x, y) * r + up_q);
        let (near_p, near_q) = (whole(p), whole(q));
        unknown[n] |= ((p - near_p).abs() - off_p).to_bits() | ((q - near_q).abs() - off_q).to_bits();
        u[n] = if near_p > p { near_p - 1.0 } else { near_p };
        v[n] = if near_q > q { near_q - 1.0 } else { near_q };
    }
}

/// Returns the floor of a quotient of numbers modulo 2^64, from one that is at most one off, and whether the remainder is 0.
#[inline(always)]
pub(super) fn floor(top: i64, bottom: i64, value: i64) -> (i64, bool) {
    let rest = top.wrapping_sub(value.wrapping_mul(bottom));
    let by = i64::from(rest >= bottom) - i64::from(rest < 0);
    (value + by, rest == by * bottom)
}
