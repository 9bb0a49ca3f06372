//! INT-4t on rows: quotients of functions that lose something because weights fall short (TEX-15, TSH-7, and planes by policy).
//! `docs/exactness.md` has the argument.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::BLOCK;
use super::kernels::PerLane;
use super::kernels::{LANES, STEP};
use super::planes::{Plane, inverse};
use super::quotient::{IOTA_REAL, Line, Positions, SLACK, any_negative, nearest, position, whole};
use super::setup::{BatchSetup, PixelBatch, Setup};
use crate::raster::interpolate::{COORDINATE_LIMIT, SHORT_BITS, most_dominant};
use crate::raster::setup::Triangle;
use std::ops::Range;

/// The missing part of a weight.
const SHORTFALL: f64 = 1.0 / (1_u32 << SHORT_BITS) as f64;

/// Losses of a linear function for each unit of N_0 and of N_2, if those weights fall short.
pub(super) type Losses = [f64; 2];

/// The weights that fall short in a batch, and two quotients of functions with losses.
#[derive(Clone, Debug)]
pub(super) struct Short {
    pub(super) dominance: Dominance,
    /// Sign bits of lanes that are not proved.
    pub(super) close: PerLane<u64>,
    /// Scratch space for two quotients with their fractions.
    pub(super) at: [PerLane<f64>; 2],
}

impl Default for Short {
    fn default() -> Self {
        Short { dominance: Dominance::default(), close: [0; LANES], at: [[0.0; LANES]; 2] }
    }
}

/// INT-3's dominance in a batch. Weights are classified by whether they are above a half, above a quarter, or neither, because the largest
/// is at least a third.
#[derive(Clone, Debug)]
pub(super) struct Dominance {
    /// N_0 and N_2 as functions.
    functions: [Line; 2],
    /// For each step of a row: whether weights 0 and 2 fall short in all of its lanes. `None` if lanes differ, or if one is too close to a
    /// border.
    steps: [Option<[bool; 2]>; BLOCK / STEP],
    /// N_0 and N_2 of all other lanes, or 0 where the weights do not fall short.
    first: PerLane<f64>,
    third: PerLane<f64>,
    /// Sign bits of lanes that are too close to a border for an estimate.
    close: PerLane<u64>,
}

impl Default for Dominance {
    fn default() -> Self {
        Dominance {
            functions: [Line::default(); 2],
            steps: [None; BLOCK / STEP],
            first: [0.0; LANES],
            third: [0.0; LANES],
            close: [0; LANES],
        }
    }
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

impl Dominance {
    /// Sets the dominance of a batch.
    #[inline(always)]
    pub(super) fn set<const FMA: bool, const ROW: bool>(
        &mut self,
        triangle: &Triangle,
        batch: PixelBatch<'_>,
        local: &BatchSetup,
    ) {
        let lanes = batch.at.x.len();
        if triangle.exact_reciprocal {
            self.steps = [Some([false; 2]); BLOCK / STEP];
            self.first[..lanes].fill(0.0);
            self.third[..lanes].fill(0.0);
            return;
        }
        let (mut lines, mut terms) = ([Line::default(); 3], 0.0);
        for k in 0..3 {
            let p = triangle.p[k] as f64;
            lines[k] = Line { c: p * local.real[k], x: p * triangle.a[k] as f64, y: p * triangle.b[k] as f64 };
            terms += lines[k].c.abs() + lines[k].x.abs() * local.columns + lines[k].y.abs() * local.rows;
        }
        self.functions = [lines[0], lines[2]];
        let (functions, error) = ([lines[0], lines[2], local.denominator], 4.0 * SLACK * terms);
        if !ROW {
            self.lanes::<FMA, false>(triangle, batch, functions, error, 0..lanes);
            return;
        }
        // Everything is linear along a row, so all pixels between two of the same class have that class.
        let ends = classes_at_ends::<FMA>(functions, f64::from(batch.at.last), error);
        for step in 0..lanes / STEP {
            let (before, after) = (ends[step], ends[step + 1]);
            self.steps[step] = (before == after && before >= 0)
                .then_some([before & FIRST_DOMINATES == 0, before & THIRD_DOMINATES == 0]);
            if self.steps[step].is_none() {
                self.lanes::<FMA, true>(triangle, batch, functions, error, step * STEP..(step + 1) * STEP);
            }
        }
    }

    /// Sets the dominance of some lanes, one by one. `error` bounds the error of four times a weight's numerator less D.
    #[inline(always)]
    fn lanes<const FMA: bool, const ROW: bool>(
        &mut self,
        triangle: &Triangle,
        batch: PixelBatch<'_>,
        [first, third, denominator]: [Line; 3],
        error: f64,
        lanes: Range<usize>,
    ) {
        let last = f64::from(batch.at.last);
        let (xs, ys, iota) = (&batch.at.x[lanes.clone()], &batch.at.y[lanes.clone()], &IOTA_REAL[lanes.clone()]);
        let (to_first, to_third) = (&mut self.first[lanes.clone()], &mut self.third[lanes.clone()]);
        let close = &mut self.close[lanes.clone()];
        for n in 0..close.len() {
            let (x, y) = position::<ROW>(n, last, xs, ys, iota);
            let (a, c, d) = (first.at::<FMA, ROW>(x, y), third.at::<FMA, ROW>(x, y), denominator.at::<FMA, ROW>(x, y));
            let b = d - a - c;
            let [is_first, is_third] = most_dominant([class(a, d), class(b, d), class(c, d)]);
            to_first[n] = if is_first { 0.0 } else { a };
            to_third[n] = if is_third { 0.0 } else { c };
            close[n] = near(a, d, error) | near(b, d, error) | near(c, d, error);
        }
        if any_negative(close) {
            self.correct(triangle, batch, lanes);
        }
    }

    /// Decides the lanes that are too close to a border, by integers.
    #[inline(never)]
    fn correct(&mut self, triangle: &Triangle, batch: PixelBatch<'_>, lanes: Range<usize>) {
        for n in lanes.filter(|n| self.close[*n] >> 63 != 0) {
            let sample = batch.sample(n.min(batch.count - 1), triangle);
            let [first, third] = sample.short();
            self.first[n] = if first { sample.n[0] as f64 } else { 0.0 };
            self.third[n] = if third { sample.n[2] as f64 } else { 0.0 };
        }
    }

    /// Computes two quotients with their fractions. Both numerators and the denominator have losses.
    #[inline(always)]
    pub(super) fn divide<const FMA: bool, const ROW: bool>(
        &self,
        at: Positions<'_>,
        functions: [Line; 3],
        losses: [Losses; 3],
        [u, v]: [&mut [f64]; 2],
    ) {
        let last = f64::from(at.last);
        if !ROW {
            let positions = (at.x, at.y, &IOTA_REAL[..at.x.len()]);
            quotients::<FMA, false>(last, positions, functions, losses, (&self.first, &self.third), u, v);
            return;
        }
        let (steps, mut first) = (&self.steps[..u.len() / STEP], 0);
        while first < steps.len() {
            let short = steps[first];
            let count = steps[first..].iter().take_while(|other| **other == short).count();
            let lanes = first * STEP..(first + count) * STEP;
            first += count;
            let (u, v, iota) = (&mut u[lanes.clone()], &mut v[lanes.clone()], &IOTA_REAL[lanes.clone()]);
            let Some(short) = short else {
                let positions = (&at.x[lanes.clone()], &at.y[lanes.clone()], iota);
                let weights = (&self.first[lanes.clone()], &self.third[lanes]);
                quotients::<FMA, true>(last, positions, functions, losses, weights, u, v);
                continue;
            };
            // The losses are linear as well.
            let mut lines = functions;
            for (line, losses) in lines.iter_mut().zip(losses) {
                for i in 0..2 {
                    *line = if short[i] { line.less(losses[i], self.functions[i]) } else { *line };
                }
            }
            linear::<FMA>(lines, iota, last, u, v);
        }
    }
}

impl Short {
    /// Computes [`Dominance::divide`] and keeps the results in [`at`](Self::at).
    #[inline(always)]
    pub(super) fn keep<const FMA: bool, const ROW: bool>(
        &mut self,
        at: Positions<'_>,
        functions: [Line; 3],
        losses: [Losses; 3],
    ) {
        let (lanes, [u, v]) = (at.x.len(), &mut self.at);
        self.dominance.divide::<FMA, ROW>(at, functions, losses, [&mut u[..lanes], &mut v[..lanes]]);
    }
}

/// Number of ends of a batch's steps, rounded up to whole vectors.
const ENDS: usize = BLOCK / STEP + 8;

/// Bits in the results of [`classes_at_ends`].
const FIRST_DOMINATES: i64 = 1 << 6;
const THIRD_DOMINATES: i64 = 1 << 7;

/// Computes the classes of the three weights at the first pixel of each step of a row, packed into a number with the bits that tell which
/// weight dominates. The number is negative if a weight is too close to a border.
#[inline(always)]
fn classes_at_ends<const FMA: bool>([first, third, denominator]: [Line; 3], last: f64, error: f64) -> [i64; ENDS] {
    let mut out = [0; ENDS];
    for n in 0..ENDS {
        let x = IOTA_REAL[n] * STEP as f64;
        let x = if x < last { x } else { last };
        let at = |line: Line| line.at::<FMA, true>(x, 0.0);
        let (a, c, d) = (at(first), at(third), at(denominator));
        let b = d - a - c;
        let close = (near(a, d, error) | near(b, d, error) | near(c, d, error)) & 1 << 63;
        let class = |n: f64| i64::from(4.0 * n > d) + i64::from(2.0 * n > d);
        let (a, b, c) = (class(a), class(b), class(c));
        let [is_first, is_third] = most_dominant([a, b, c]);
        let dominance = (i64::from(is_first) << 6) | (i64::from(is_third) << 7);
        out[n] = a << 4 | b << 2 | c | dominance | close as i64;
    }
    out
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
    last: f64,
    (xs, ys, iota): (&[i32], &[i32], &[f64]),
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
        u[n] = (along.at::<FMA, ROW>(x, y) - lost(loss_along, weights)) * r;
        v[n] = (down.at::<FMA, ROW>(x, y) - lost(loss_down, weights)) * r;
    }
}

/// Computes two quotients of lines by a third one along a row. Lanes past the last pixel repeat it.
#[inline(always)]
fn linear<const FMA: bool>(
    [along, down, denominator]: [Line; 3],
    iota: &[f64],
    last: f64,
    u: &mut [f64],
    v: &mut [f64],
) {
    let lanes = u.len();
    let (v, iota) = (&mut v[..lanes], &iota[..lanes]);
    for n in 0..lanes {
        let x = if iota[n] < last { iota[n] } else { last };
        let r = 1.0 / denominator.at::<FMA, true>(x, 0.0);
        u[n] = along.at::<FMA, true>(x, 0.0) * r;
        v[n] = down.at::<FMA, true>(x, 0.0) * r;
    }
}

#[inline(always)]
fn lost(losses: Losses, weights: [f64; 2]) -> f64 {
    losses[0] * weights[0] + losses[1] * weights[1]
}

/// Writes the floors, less a bias, of numbers whose error is less than `off`, limited as TEX-15 says. Sets the sign bits of lanes that are
/// not proved.
#[inline(always)]
pub(super) fn floors(at: &[f64], off: f64, bias: i32, close: &mut [u64], out: &mut [i32]) {
    let lanes = at.len();
    let (close, out) = (&mut close[..lanes], &mut out[..lanes]);
    for n in 0..lanes {
        // In the middle of a step, far from where the floor changes.
        let (low, high) = (0.5 - COORDINATE_LIMIT as f64, COORDINATE_LIMIT as f64 + 0.5);
        let limited = if at[n] > low { at[n] } else { low };
        let t = if limited < high { limited } else { high } - 0.5;
        out[n] = nearest(t).wrapping_sub(bias);
        close[n] |= (0.5 - off - (t - whole(t)).abs()).to_bits();
    }
}
