//! INT-4t on rows: quotients of numbers that lose something because weights fall short (TEX-15, TSH-7). `docs/exactness.md` has the argument.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::fetch::PerLane;
use super::kernels::LANES;
use super::planes::{Plane, inverse};
use super::quads::any_negative;
use super::quotient::{IOTA_REAL, Line, Positions, SLACK, nearest, position, whole};
use super::triangle::{Bounds, PixelBatch, Setup};
use crate::raster::interpolate::{SHORT_BITS, most_dominant};
use crate::raster::setup::Triangle;

/// How much of a weight is missing.
const PART: f64 = 1.0 / (1_u32 << SHORT_BITS) as f64;

/// What a linear function loses of each unit of N_0 and of N_2, where those fall short.
pub(super) type Losses = [f64; 2];

/// N_0 and N_2 of the lanes of a batch, 0 where they do not fall short.
#[derive(Clone, Debug)]
pub(super) struct Short {
    first: PerLane<f64>,
    third: PerLane<f64>,
    /// As sign bits: which weight dominates is too close to call, for an estimate; then, what is not proved of something else.
    pub(super) close: PerLane<u64>,
    /// Two quotients.
    pub(super) at: [PerLane<f64>; 2],
}

impl Default for Short {
    fn default() -> Self {
        Short { first: [0.0; LANES], third: [0.0; LANES], close: [0; LANES], at: [[0.0; LANES]; 2] }
    }
}

/// 2^-24 (u_i - u_1) of weights 0 and 2, with u_k = G_k / P_k: what a function with these G_k loses of each unit of N_i.
#[inline(always)]
pub(super) fn losses(triangle: &Triangle, inverse: &[f64; 3], g: &[f64; 3]) -> Losses {
    if triangle.exact_reciprocal {
        return [0.0; 2];
    }
    let [a, b, c] = [g[0] * inverse[0], g[1] * inverse[1], g[2] * inverse[2]];
    [(a - b) * PART, (c - b) * PART]
}

impl Setup<'_> {
    /// [`losses`] of s, t and q, s and t that many times.
    #[inline(always)]
    pub(super) fn losses_by_q(&self, planes: &[Plane; 3], [width, height]: [f64; 2]) -> [Losses; 3] {
        let triangle = &self.context.triangle;
        let inverse = inverse(triangle);
        let of = |plane: &Plane| losses(triangle, &inverse, &plane.g.map(|g| g as f64));
        let [[s0, s2], [t0, t2], q] = [of(&planes[0]), of(&planes[1]), of(&planes[2])];
        [[s0 * width, s2 * width], [t0 * height, t2 * height], q]
    }
}

impl Short {
    /// INT-3's dominance at the pixels of a batch. Weights are classed by whether they are above a half, a quarter or neither, for the largest is
    /// never below a third.
    #[inline(always)]
    pub(super) fn set<const FMA: bool, const ROW: bool>(
        &mut self,
        triangle: &Triangle,
        batch: PixelBatch<'_>,
        (e, denominator): (&[f64; 3], Line),
        bounds: &Bounds,
    ) {
        let lanes = batch.at.x.len();
        if triangle.exact_reciprocal {
            self.first[..lanes].fill(0.0);
            self.third[..lanes].fill(0.0);
            return;
        }
        let (mut lines, mut terms) = ([Line::default(); 3], 0.0);
        for k in 0..3 {
            let p = triangle.p[k] as f64;
            lines[k] = Line { c: p * e[k], x: p * triangle.a[k] as f64, y: p * triangle.b[k] as f64 };
            terms += lines[k].c.abs() + lines[k].x.abs() * bounds.columns + lines[k].y.abs() * bounds.rows;
        }
        dominance::<FMA, ROW>(batch.at, [lines[0], lines[2], denominator], 4.0 * SLACK * terms, self, lanes);
        if any_negative(&self.close[..lanes]) {
            self.find_dominance(triangle, batch);
        }
    }

    /// Lanes that are too close to call: whole numbers tell.
    #[inline(never)]
    fn find_dominance(&mut self, triangle: &Triangle, batch: PixelBatch<'_>) {
        for n in (0..batch.at.x.len()).filter(|n| self.close[*n] >> 63 != 0) {
            let sample = batch.sample(n.min(batch.count - 1), triangle);
            let [first, third] = sample.short();
            self.first[n] = if first { sample.n[0] as f64 } else { 0.0 };
            self.third[n] = if third { sample.n[2] as f64 } else { 0.0 };
        }
    }
}

/// The loop of [`Short::set`], with what four times a weight's numerator less D can be off by.
#[inline(always)]
fn dominance<const FMA: bool, const ROW: bool>(
    at: Positions<'_>,
    [first, third, denominator]: [Line; 3],
    error: f64,
    short: &mut Short,
    lanes: usize,
) {
    let last = f64::from(at.last);
    let (xs, ys, iota) = (&at.x[..lanes], &at.y[..lanes], &IOTA_REAL[..lanes]);
    let (to_first, to_third, close) = (&mut short.first[..lanes], &mut short.third[..lanes], &mut short.close[..lanes]);
    for n in 0..lanes {
        let (x, y) = position::<ROW>(n, last, xs, ys, iota);
        let (a, c, d) = (first.at::<FMA, ROW>(x, y), third.at::<FMA, ROW>(x, y), denominator.at::<FMA, ROW>(x, y));
        let b = d - a - c;
        let [is_first, is_third] = most_dominant([class(a, d), class(b, d), class(c, d)]);
        to_first[n] = if is_first { 0.0 } else { a };
        to_third[n] = if is_third { 0.0 } else { c };
        close[n] = near(a, d, error) | near(b, d, error) | near(c, d, error);
    }
}

/// 2 above half of d, 1 above a quarter.
#[inline(always)]
fn class(n: f64, d: f64) -> f64 {
    let quarter = if 4.0 * n > d { 1.0 } else { 0.0 };
    if 2.0 * n > d { 2.0 } else { quarter }
}

/// As its sign bit: whether a half or a quarter of d is closer.
#[inline(always)]
fn near(n: f64, d: f64, error: f64) -> u64 {
    ((4.0 * n - d).abs() - error).to_bits() | ((2.0 * n - d).abs() - error).to_bits()
}

/// Two quotients with their fractions, of functions with weights that fall short.
#[inline(always)]
pub(super) fn quotients<const FMA: bool, const ROW: bool>(
    at: Positions<'_>,
    [along, down, denominator]: [Line; 3],
    [loss_along, loss_down, loss_denominator]: [Losses; 3],
    (first, third): (&[f64], &[f64]),
    u: &mut [f64],
    v: &mut [f64],
) {
    let lanes = u.len();
    let last = f64::from(at.last);
    let (v, xs, ys, iota) = (&mut v[..lanes], &at.x[..lanes], &at.y[..lanes], &IOTA_REAL[..lanes]);
    let (first, third) = (&first[..lanes], &third[..lanes]);
    for n in 0..lanes {
        let (x, y) = position::<ROW>(n, last, xs, ys, iota);
        let weights = [first[n], third[n]];
        let r = 1.0 / (denominator.at::<FMA, ROW>(x, y) - lost(loss_denominator, weights));
        u[n] = (along.at::<FMA, ROW>(x, y) - lost(loss_along, weights)) * r;
        v[n] = (down.at::<FMA, ROW>(x, y) - lost(loss_down, weights)) * r;
    }
}

#[inline(always)]
fn lost(losses: Losses, weights: [f64; 2]) -> f64 {
    losses[0] * weights[0] + losses[1] * weights[1]
}

impl Short {
    /// [`quotients`] of the lanes of a batch.
    #[inline(always)]
    pub(super) fn divide<const FMA: bool, const ROW: bool>(
        &self,
        at: Positions<'_>,
        lines: [Line; 3],
        losses: [Losses; 3],
        [u, v]: [&mut [f64]; 2],
    ) {
        quotients::<FMA, ROW>(at, lines, losses, (&self.first, &self.third), u, v);
    }

    /// The same, kept [here](Self::at).
    #[inline(always)]
    pub(super) fn keep<const FMA: bool, const ROW: bool>(
        &mut self,
        at: Positions<'_>,
        lines: [Line; 3],
        losses: [Losses; 3],
    ) {
        let (lanes, [u, v]) = (at.x.len(), &mut self.at);
        let weights = (&self.first[..], &self.third[..]);
        quotients::<FMA, ROW>(at, lines, losses, weights, &mut u[..lanes], &mut v[..lanes]);
    }
}

/// Floors, less a bias, of numbers that are off by less than `off`, and as sign bits which are not proved, besides those that were not.
#[inline(always)]
pub(super) fn floors(at: &[f64], off: f64, bias: i32, close: &mut [u64], out: &mut [i32]) {
    let lanes = at.len();
    let (close, out) = (&mut close[..lanes], &mut out[..lanes]);
    for n in 0..lanes {
        let t = at[n] - 0.5;
        out[n] = nearest(t).wrapping_sub(bias);
        close[n] |= (0.5 - off - (t - whole(t)).abs()).to_bits();
    }
}
