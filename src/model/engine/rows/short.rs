//! INT-4t on rows: quotients of functions that lose something because weights fall short (TEX-15, TSH-7, and planes by policy).
//! `docs/exactness.md` has the argument.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::kernels::PerLane;
use super::planes::{Plane, RealPlane, inverse};
use super::quotient::{
    IOTA_REAL, Line, Positions, Reciprocals, SLACK, any_negative, multiply_add, nearest, position, whole,
};
use super::setup::{BatchSetup, PixelBatch, Setup, whole_steps};
use crate::raster::interpolate::{COORDINATE_LIMIT, SHORT_BITS, Sample, most_dominant};
use crate::raster::setup::Triangle;
use std::ops::Range;

/// The missing part of a weight.
pub(super) const SHORTFALL: f64 = 1.0 / (1_u32 << SHORT_BITS) as f64;

/// Losses of a linear function for each unit of N_0 and of N_2, if those weights fall short.
pub(super) type Losses = [f64; 2];

/// The weights that fall short in a batch, and two quotients of functions with losses.
#[derive(Clone, Debug, Default)]
pub(super) struct Short {
    pub(super) dominance: Dominance,
    /// Sign bits of lanes that are not proved.
    pub(super) close: PerLane<u64>,
    /// Scratch space for two quotients with their fractions.
    pub(super) at: [PerLane<f64>; 2],
    /// Scratch space for the reciprocals of a divisor other than D.
    pub(super) reciprocals: Reciprocals,
}

/// INT-3's dominance in a batch. Weights are classified by whether they are above a half, above a quarter, or neither, because the largest
/// is at least a third.
#[derive(Clone, Debug, Default)]
pub(super) struct Dominance {
    /// N_0 and N_2 as functions.
    functions: [Line; 2],
    /// Parts of a row; none if lanes are classified one by one.
    parts: Parts,
    /// The first column of the row.
    row: i64,
    /// N_0 and N_2 of lanes that are classified one by one, or 0 where the weights do not fall short.
    first: PerLane<f64>,
    third: PerLane<f64>,
    /// Sign bits of lanes that are too close to a border for an estimate.
    close: PerLane<u64>,
}

/// Returns 2^-24 (u_i - u_1) for the weights 0 and 2, with u_k = G_k / P_k. This is what a function with these G_k loses for each unit of
/// N_i.
#[inline(always)]
pub(super) fn losses(triangle: &Triangle, inverse: &[f64; 3], g: &[f64; 3]) -> Losses {
    if triangle.exact_reciprocal {
        return [0.0; 2];
    }
    let [a, b, c] = [g[0] * inverse[0], g[1] * inverse[1], g[2] * inverse[2]];
    [(a - b) * SHORTFALL, (c - b) * SHORTFALL]
}

impl Setup<'_> {
    /// Returns the [`losses`] of s, t and q, where s and t are multiplied by the sides.
    #[inline(always)]
    pub(super) fn losses_by_q(&self, planes: &[Plane; 3], [width, height]: [f64; 2]) -> [Losses; 3] {
        let triangle = &self.context.triangle;
        let inverse = inverse(triangle);
        let of = |plane: &Plane| losses(triangle, &inverse, &plane.g.map(|g| g as f64));
        let [[s0, s2], [t0, t2], q] = [of(&planes[0]), of(&planes[1]), of(&planes[2])];
        [[s0 * width, s2 * width], [t0 * height, t2 * height], q]
    }

    /// Returns the [`losses`] of u and v, and those of D, which are none.
    pub(super) fn losses_on_planes(&self, planes: &[Plane; 2]) -> [Losses; 3] {
        let triangle = &self.context.triangle;
        let of = |plane: &Plane| losses(triangle, &inverse(triangle), &plane.g.map(|g| g as f64));
        [of(&planes[0]), of(&planes[1]), [0.0; 2]]
    }
}

/// Parts of a row in which the same weights fall short.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Parts {
    /// First pixel of each part, and whether the weights 0 and 2 fall short.
    all: [(usize, [bool; 2]); PARTS],
    count: usize,
    /// Number of pixels of the row before the batch.
    before: usize,
}

impl Parts {
    /// Returns the lanes of each part of the batch, up to the given end, and whether the weights 0 and 2 fall short.
    #[inline(always)]
    pub(super) fn ranges(&self, end: usize) -> impl Iterator<Item = (Range<usize>, [bool; 2])> {
        let (all, before) = (&self.all[..self.count], self.before);
        all.iter()
            .enumerate()
            .map(move |(n, (first, short))| {
                let next = all.get(n + 1).map_or(end, |next| next.0.saturating_sub(before).min(end));
                (first.saturating_sub(before)..next, *short)
            })
            .filter(|(lanes, _)| !lanes.is_empty())
    }

    /// Divides a row where four times or twice a weight's numerator passes D: everything is linear, so all pixels between two such places
    /// have the same classes. A pixel that is too close is a part of its own. There are no parts if a numerator passes D so slowly that
    /// several pixels are too close.
    #[inline(always)]
    pub(super) fn set_row<const FMA: bool>(
        &mut self,
        triangle: &Triangle,
        (i, j): (i64, i64),
        last: i32,
        denominator: &RealPlane,
    ) {
        self.count = 0;
        let local = BatchSetup::undivided(triangle, (i, j), (last, 0), denominator);
        let (functions, error) = numerators(triangle, &local);
        let [first, third, denominator] = functions;
        let middle = denominator.less(1.0, first).less(1.0, third);
        // One line comes twice, because vectors are filled.
        let (mut cs, mut slopes) = ([0.0; PLACES], [0.0; PLACES]);
        for (n, line) in [first, middle, third, third].into_iter().enumerate() {
            for (n, times) in [(n, 0.25), (n + PLACES / 2, 0.5)] {
                (cs[n], slopes[n]) = (line.c - times * denominator.c, line.x - times * denominator.x);
            }
        }
        // For each place: the first pixel that may be too close, and the first beyond. One too many does no harm.
        let (end, mut starts, mut longest) = (f64::from(last + 1), [[0; PLACES]; 2], 0);
        for n in 0..PLACES {
            // The slopes of N_k and D are whole numbers, so that this one is 0 or at least a quarter.
            let slope = if slopes[n].abs() > 0.125 { slopes[n].abs() } else { 0.125 };
            let (c, r) = (if slopes[n] < 0.0 { cs[n] } else { -cs[n] }, 1.0 / slope);
            let pixel = |at: f64| {
                let at = if at > 0.0 { at } else { 0.0 };
                nearest(if at < end { at } else { end })
            };
            starts[0][n] = pixel((c - error) * r + (0.5 - GUARD));
            starts[1][n] = pixel((c + error) * r + (0.5 + GUARD));
            longest = (starts[1][n] - starts[0][n]).max(longest);
        }
        if longest > 1 {
            return;
        }
        let mut start = 0;
        while start <= last && self.count < PARTS {
            let ([is_first, is_third], close, _) = classify::<FMA, true>(functions, (f64::from(start), 0.0), error);
            let short = if close >> 63 != 0 {
                Sample::new(triangle, triangle.edges(i + i64::from(start), j)).short()
            } else {
                [!is_first, !is_third]
            };
            // A pixel that is too close belongs to the part before it or after it.
            if self.count == 0 || self.all[self.count - 1].1 != short {
                self.all[self.count] = (start as usize, short);
                self.count += 1;
            }
            start = starts.as_flattened().iter().fold(i32::MAX, |next, n| if *n > start { next.min(*n) } else { next });
        }
    }
}

/// Returns N_0, N_2 and D as functions, and a bound of the error of four times a numerator less D.
#[inline(always)]
fn numerators(triangle: &Triangle, local: &BatchSetup) -> ([Line; 3], f64) {
    let (mut lines, mut terms) = ([Line::default(); 3], 0.0);
    for k in 0..3 {
        let p = triangle.p[k] as f64;
        lines[k] = Line { c: p * local.real[k], x: p * triangle.a[k] as f64, y: p * triangle.b[k] as f64 };
        terms += lines[k].c.abs() + lines[k].x.abs() * local.columns + lines[k].y.abs() * local.rows;
    }
    ([lines[0], lines[2], local.denominator], 4.0 * SLACK * terms)
}

impl Dominance {
    /// Divides a row of so many pixels, of which batches follow. If their number is 0, lanes are classified one by one.
    #[inline(always)]
    pub(super) fn begin_row<const FMA: bool>(
        &mut self,
        triangle: &Triangle,
        first: (i64, i64),
        columns: i64,
        denominator: &RealPlane,
    ) {
        (self.row, self.parts.count) = (first.0, 0);
        if columns > 0 && !triangle.exact_reciprocal {
            self.parts.set_row::<FMA>(triangle, first, columns as i32 - 1, denominator);
        }
    }

    /// Sets the dominance of a batch.
    #[inline(always)]
    pub(super) fn set<const FMA: bool, const ROW: bool>(
        &mut self,
        triangle: &Triangle,
        batch: PixelBatch<'_>,
        local: &BatchSetup,
    ) {
        if triangle.exact_reciprocal {
            if ROW {
                (self.parts.all[0], self.parts.count) = ((0, [false; 2]), 1);
            } else {
                self.set_none(batch.at);
            }
            return;
        }
        let (functions, error) = numerators(triangle, local);
        self.functions = [functions[0], functions[1]];
        if ROW {
            self.parts.before = (batch.first.0 - self.row) as usize;
        } else {
            self.parts.count = 0;
        }
        if self.parts.count == 0 && self.classify::<FMA, ROW>(batch.at, functions, error) {
            self.correct(triangle, batch);
        }
    }

    /// Declares that no weight falls short in a box.
    #[inline(always)]
    pub(super) fn set_none(&mut self, at: Positions<'_>) {
        self.parts.count = 0;
        self.first[..at.x.len()].fill(0.0);
        self.third[..at.x.len()].fill(0.0);
    }

    /// Classifies lanes, one by one. `functions` and `error` are as in [`numerators`]. Returns whether some are too close to a border.
    #[inline(always)]
    pub(super) fn classify<const FMA: bool, const ROW: bool>(
        &mut self,
        at: Positions<'_>,
        functions: [Line; 3],
        error: f64,
    ) -> bool {
        self.parts.count = 0;
        let lanes = at.x.len();
        let last = f64::from(at.last);
        let (xs, ys, iota) = (&at.x[..lanes], &at.y[..lanes], &IOTA_REAL[..lanes]);
        let (to_first, to_third) = (&mut self.first[..lanes], &mut self.third[..lanes]);
        let close = &mut self.close[..lanes];
        for n in 0..lanes {
            let at = position::<ROW>(n, last, xs, ys, iota);
            let ([is_first, is_third], is_close, [a, c]) = classify::<FMA, ROW>(functions, at, error);
            to_first[n] = if is_first { 0.0 } else { a };
            to_third[n] = if is_third { 0.0 } else { c };
            close[n] = is_close;
        }
        any_negative(close)
    }

    /// Decides the lanes that are too close to a border, by integers.
    #[inline(never)]
    fn correct(&mut self, triangle: &Triangle, batch: PixelBatch<'_>) {
        for n in (0..batch.at.x.len()).filter(|n| self.close[*n] >> 63 != 0) {
            let sample = batch.sample(n.min(batch.count - 1), triangle);
            let [first, third] = sample.short();
            self.first[n] = if first { sample.n[0] as f64 } else { 0.0 };
            self.third[n] = if third { sample.n[2] as f64 } else { 0.0 };
        }
    }

    /// Computes two quotients with their fractions, and adds a number. Both numerators and the denominator have losses. Lanes past the end
    /// of the batch may be written.
    #[inline(always)]
    pub(super) fn divide<const FMA: bool, const ROW: bool>(
        &self,
        at: Positions<'_>,
        functions: [Line; 3],
        losses: [Losses; 3],
        plus: f64,
        [u, v]: [&mut [f64]; 2],
    ) {
        let (lanes, last) = (at.x.len(), f64::from(at.last));
        if !ROW || self.parts.count == 0 {
            let positions = (at.x, at.y, &IOTA_REAL[..lanes]);
            let (u, v) = (&mut u[..lanes], &mut v[..lanes]);
            quotients::<FMA, ROW>((last, plus), positions, functions, losses, (&self.first, &self.third), u, v);
            return;
        }
        for (part, short) in self.parts.ranges(lanes) {
            // In whole steps from its first lane: the next part writes over lanes past its end.
            let lanes = part.start..part.start + whole_steps(part.len());
            // The losses are linear as well. No choices, because those of lines go through memory.
            let short = short.map(|short| f64::from(u8::from(short)));
            let less = |n: usize| {
                let [a, b] = losses[n];
                functions[n].less(a * short[0], self.functions[0]).less(b * short[1], self.functions[1])
            };
            let lines = [less(0), less(1), less(2)];
            let iota = &IOTA_REAL[lanes.clone()];
            linear::<FMA>(lines, iota, last, plus, &mut u[lanes.clone()], &mut v[lanes]);
        }
    }
}

impl Dominance {
    /// Computes [`divide`](Self::divide) for a row or a box.
    #[inline(always)]
    pub(super) fn divide_batch<const FMA: bool>(
        &self,
        batch: PixelBatch<'_>,
        functions: [Line; 3],
        losses: [Losses; 3],
        plus: f64,
        out: [&mut [f64]; 2],
    ) {
        if batch.is_row() {
            self.divide::<FMA, true>(batch.at, functions, losses, plus, out);
        } else {
            self.divide::<FMA, false>(batch.at, functions, losses, plus, out);
        }
    }
}

impl Short {
    /// Sets its reciprocals to those of a row or a box.
    #[inline(always)]
    pub(super) fn set_reciprocals<const FMA: bool>(&mut self, batch: PixelBatch<'_>, denominator: Line) {
        if batch.is_row() {
            self.reciprocals.set::<FMA, true>(batch.at, denominator);
        } else {
            self.reciprocals.set::<FMA, false>(batch.at, denominator);
        }
    }
}

/// Number of places where a numerator may pass D, rounded up to a whole vector.
const PLACES: usize = 8;

/// Largest number of parts of a row: before and after each of six pixels, and those themselves.
const PARTS: usize = 13;

/// What is added to both sides of a place where a numerator passes D, far above rounding errors.
const GUARD: f64 = 1.0 / 1024.0;

/// Returns whether the weights 0 and 2 dominate at a position, a number whose sign bit tells that it is too close to a border for an
/// estimate, and N_0 and N_2.
#[inline(always)]
fn classify<const FMA: bool, const ROW: bool>(
    [first, third, denominator]: [Line; 3],
    (x, y): (f64, f64),
    error: f64,
) -> ([bool; 2], u64, [f64; 2]) {
    let (a, c, d) = (first.at::<FMA, ROW>(x, y), third.at::<FMA, ROW>(x, y), denominator.at::<FMA, ROW>(x, y));
    let b = d - a - c;
    let close = near(a, d, error) | near(b, d, error) | near(c, d, error);
    // Beyond the triangle, weights may be above 1, where there are more classes.
    let close = close | (d - a - error).to_bits() | (d - b - error).to_bits() | (d - c - error).to_bits();
    (most_dominant([class(a, d), class(b, d), class(c, d)]), close, [a, c])
}

/// INT-4t: lowers those of the coordinates in a box that are whole, where all P_k are equal. `losses` has the differences of the coordinates at the
/// vertices 0 and 2 to that at vertex 1. They are multiples of a texel's 256th, so that nothing is rounded.
#[inline(always)]
pub(super) fn lower_flat<const FMA: bool>(
    edges: [Line; 3],
    at: Positions<'_>,
    losses: [f64; 2],
    whole: &[i32],
    values: &mut [i32],
) {
    let lanes = values.len();
    let (xs, ys, whole) = (&at.x[..lanes], &at.y[..lanes], &whole[..lanes]);
    for n in 0..lanes {
        let (x, y) = (f64::from(xs[n]), f64::from(ys[n]));
        let (a, b) = (edges[0].at::<FMA, false>(x, y), edges[1].at::<FMA, false>(x, y));
        let c = edges[2].at::<FMA, false>(x, y);
        let d = a + b + c;
        let [is_first, is_third] = most_dominant([class(a, d), class(b, d), class(c, d)]);
        let lost = if is_first { 0.0 } else { losses[0] * a } + if is_third { 0.0 } else { losses[1] * c };
        values[n] -= if lost > 0.0 { whole[n] } else { 0 };
    }
}

/// Returns 2 above a half of d, 1 above a quarter, and otherwise 0.
#[inline(always)]
fn class(n: f64, d: f64) -> f64 {
    let quarter = if 4.0 * n > d { 1.0 } else { 0.0 };
    if 2.0 * n > d { 2.0 } else { quarter }
}

/// Returns a number whose sign bit is set if n is too close to a half or a quarter of d.
#[inline(always)]
fn near(n: f64, d: f64, error: f64) -> u64 {
    ((4.0 * n - d).abs() - error).to_bits() | ((2.0 * n - d).abs() - error).to_bits()
}

/// Computes two quotients with their fractions, of functions with losses.
#[inline(always)]
fn quotients<const FMA: bool, const ROW: bool>(
    (last, plus): (f64, f64),
    (xs, ys, iota): (&[i16], &[i16], &[f64]),
    [along, down, denominator]: [Line; 3],
    [loss_along, loss_down, loss_denominator]: [Losses; 3],
    (first, third): (&[f64], &[f64]),
    u: &mut [f64],
    v: &mut [f64],
) {
    let lanes = u.len();
    let (v, xs, ys, iota) = (&mut v[..lanes], &xs[..lanes], &ys[..lanes], &iota[..lanes]);
    let (first, third) = (&first[..lanes], &third[..lanes]);
    for n in 0..lanes {
        let (x, y) = position::<ROW>(n, last, xs, ys, iota);
        let weights = [first[n], third[n]];
        let r = 1.0 / (denominator.at::<FMA, ROW>(x, y) - lost(loss_denominator, weights));
        u[n] = multiply_add::<FMA>(along.at::<FMA, ROW>(x, y) - lost(loss_along, weights), r, plus);
        v[n] = multiply_add::<FMA>(down.at::<FMA, ROW>(x, y) - lost(loss_down, weights), r, plus);
    }
}

/// Computes two quotients of lines by a third one along a row, and adds a number. Lanes past the last pixel repeat it.
#[inline(always)]
fn linear<const FMA: bool>(
    [along, down, denominator]: [Line; 3],
    iota: &[f64],
    last: f64,
    plus: f64,
    u: &mut [f64],
    v: &mut [f64],
) {
    let lanes = u.len();
    let (v, iota) = (&mut v[..lanes], &iota[..lanes]);
    if denominator.x == 0.0 {
        let r = 1.0 / denominator.c;
        let divided = |line: Line| Line { c: multiply_add::<FMA>(line.c, r, plus), ..line.times(r) };
        let (along, down) = (divided(along), divided(down));
        for n in 0..lanes {
            let x = if iota[n] < last { iota[n] } else { last };
            (u[n], v[n]) = (along.at::<FMA, true>(x, 0.0), down.at::<FMA, true>(x, 0.0));
        }
        return;
    }
    for n in 0..lanes {
        let x = if iota[n] < last { iota[n] } else { last };
        let r = 1.0 / denominator.at::<FMA, true>(x, 0.0);
        u[n] = multiply_add::<FMA>(along.at::<FMA, true>(x, 0.0), r, plus);
        v[n] = multiply_add::<FMA>(down.at::<FMA, true>(x, 0.0), r, plus);
    }
}

#[inline(always)]
fn lost(losses: Losses, weights: [f64; 2]) -> f64 {
    losses[0] * weights[0] + losses[1] * weights[1]
}

/// Writes the floors, less a bias, of numbers that are given less a half. Their error is less than `off`. Floors are limited as TEX-15 says.
/// Sets the sign bits of lanes that are not proved.
#[inline(always)]
pub(super) fn floors(at: &[f64], off: f64, bias: i32, close: &mut [u64], out: &mut [i32]) {
    let lanes = at.len();
    let (close, out) = (&mut close[..lanes], &mut out[..lanes]);
    for n in 0..lanes {
        // In the middle of a step, far from where the floor changes.
        let (low, high) = (-COORDINATE_LIMIT as f64, COORDINATE_LIMIT as f64);
        let limited = if at[n] > low { at[n] } else { low };
        let t = if limited < high { limited } else { high };
        out[n] = nearest(t).wrapping_sub(bias);
        close[n] |= (0.5 - off - (t - whole(t)).abs()).to_bits();
    }
}
