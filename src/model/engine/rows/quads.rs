//! TEX-11 on rows: the exact coordinates of the quads of a batch, and what units derive from them: a level of detail, or the taps of a
//! footprint.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::Reason;
use super::base_level::{BaseLevel, parted};
use super::kernels::{LANES, PerLane, STEP};
use super::quotient::{any_negative, whole};
use super::setup::{PixelBatch, Run, Setup, whole_steps};
use super::shapes::SIDE;
use crate::texture::coordinates::SampleCoordinates;
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
    fn estimate<const FMA: bool>(
        _: (&PlannedUnit, &BaseLevel<'_>),
        _: [&[f32]; 2],
        _: &mut [Self],
        _: &mut [i32],
    ) -> bool {
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
    /// Sign bits of quads whose estimated result is not proved.
    close: PerLane<i32>,
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
        let (mut quads, mut runs) = (0, batch.runs);
        let pixel = |run: &Run| batch.pixel(run.lane());
        self.filled = 0;
        while let Some(first) = runs.first() {
            let (_, row) = pixel(first);
            let rows = runs.iter().take(2).take_while(|run| pixel(run).1 >> 1 == row >> 1).count();
            let (pair, later) = runs.split_at(rows);
            runs = later;
            let (mut low, mut high) = (i64::MAX, i64::MIN);
            for run in pair {
                let (first, _) = pixel(run);
                (low, high) = (low.min(first >> 1), high.max((first + run.count() as i64 - 1) >> 1));
            }
            for run in pair {
                let (first, _) = pixel(run);
                let quad = quads + ((first >> 1) - low) as usize;
                self.rows[self.filled] = QuadsOfRow { lane: run.lane(), quad, odd: (first & 1) as usize };
                self.filled += 1;
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
}

impl<T> Default for Known<T> {
    fn default() -> Self {
        Known { of: None, columns: 0..0, each: Vec::new() }
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

impl Setup<'_> {
    /// Computes the results of the quads of a batch. Returns how lanes map to them.
    #[inline(always)]
    pub(super) fn of_quads<const FMA: bool, T: Measure>(
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
        if !batch.is_row() {
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
            measured::<FMA, T>((unit, base), exact, count, quads, &mut known.each[first..]);
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
    /// Makes room for so many results.
    #[inline(always)]
    fn make_room(&mut self, unit: &PlannedUnit, count: usize) {
        self.each.resize(self.each.len().max(count), T::behind(unit));
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
    measured::<FMA, T>((unit, base), exact, count, quads, &mut known.each)
}

/// Computes the results of quads at the given [origins](Quads::origins), a step of quads from their coordinates if the estimate of one is not proved.
/// Returns `false` if some are not proved then and nothing decides them.
#[inline(always)]
fn measured<const FMA: bool, T: Measure>(
    (unit, base): (&PlannedUnit, &BaseLevel<'_>),
    exact: Option<Exact<'_>>,
    count: usize,
    quads: &mut Quads,
    out: &mut [T],
) -> bool {
    let rounded = whole_steps(count);
    let Quads { origins: [xs, ys], coordinates, close, .. } = quads;
    let (xs, ys, close, out) = (&xs[..rounded], &ys[..rounded], &mut close[..rounded], &mut out[..rounded]);
    let estimates = T::estimate::<FMA>((unit, base), [xs, ys], out, close);
    for first in (0..count).step_by(STEP) {
        let lanes = first..first + STEP;
        if estimates && close[lanes.clone()].iter().fold(0, |all, close| all | close) >= 0 {
            continue;
        }
        let (origins, count) = ([&xs[lanes.clone()], &ys[lanes.clone()]], STEP.min(count - first));
        if !measured_exactly::<FMA, T>((unit, base), exact, origins, count, coordinates, &mut out[lanes]) {
            return false;
        }
    }
    true
}

/// Computes the results of a step of quads from their coordinates. Returns `false` if some are not proved and nothing decides them.
#[inline(always)]
fn measured_exactly<const FMA: bool, T: Measure>(
    (unit, base): (&PlannedUnit, &BaseLevel<'_>),
    exact: Option<Exact<'_>>,
    [xs, ys]: [&[f32]; 2],
    count: usize,
    coordinates: &mut AtQuads,
    out: &mut [T],
) -> bool {
    const PIXELS: [(i64, i64); 3] = [(0, 0), (1, 0), (0, 1)];
    // Doubles as bits, negative for quads whose coordinates are not known.
    let mut unknown = [0; STEP];
    for ((x, y), [u, v]) in PIXELS.into_iter().zip(&mut *coordinates) {
        corners::<FMA>(base, [xs, ys], [x as f64, y as f64], &mut u[..STEP], &mut v[..STEP], &mut unknown);
    }
    if let (Some(planes), Some(Exact { setup, e, .. })) = (base.planes, exact)
        && any_negative(&unknown)
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
    T::measure::<FMA>(unit, coordinates, count, out, &mut unknown);
    if !any_negative(&unknown) {
        return true;
    }
    let Some(Exact { setup, batch, .. }) = exact else { return false };
    for n in (0..count).filter(|n| unknown[*n] >> 63 != 0) {
        let pixel = (batch.first.0 + xs[n] as i64, batch.first.1 + ys[n] as i64);
        out[n] = setup.defined_quad(*batch, unit, pixel);
    }
    true
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
