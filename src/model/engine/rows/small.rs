//! INT-1 to INT-4t for small triangles whose units are sampled on planes. Four functions are set up at a time, in floating point only, and
//! all quotients of a pixel share one reciprocal. `docs/exactness.md` has the argument.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::CompiledDraw;
use super::boxes::SIDE;
use super::color::{colors, narrow_weights};
use super::kernels::PerLane;
use super::planes::{FOUR, inverse};
use super::quotient::{Line, QuotientEstimate, SLACK, multiply_add, whole};
use super::setup::PixelBatch;
use super::triangle::Varying;
use crate::engine::pixel::TriangleContext;
use crate::raster::setup::Triangle;
use crate::state::TEXTURE_UNITS;

/// Two quotients that belong together.
#[derive(Clone, Copy, Debug)]
enum Pair {
    None,
    /// u and v of a sampler.
    Sampler(usize),
    /// Weights 0 and 2.
    Weights,
}

/// The set-up that all functions of a triangle share.
struct EdgeSetup {
    /// Edge functions at the first pixel, and their slopes.
    e: [f64; 3],
    a: [f64; 3],
    b: [f64; 3],
    /// Upper bound of each |E_k| in the box, with all terms that are added to it.
    terms: [f64; 3],
    p: [f64; 3],
    /// 1 / P_k of the vertices.
    inverse: [f64; 3],
    denominator: Line,
    /// Reciprocal of the first pixel's D.
    reciprocal: f64,
    /// Reciprocal of a lower bound of D.
    widest: f64,
    /// Upper bound of the quotient of any term of D by the least D.
    ratio: f64,
    /// Upper bound of the change of a quotient by the floors of its numerators at the vertices.
    floors: f64,
    /// If the values at the vertices are whole and no tie is lowered (INT-3), quotients are multiples of this number; otherwise 0.
    gap: f64,
}

impl EdgeSetup {
    #[inline(always)]
    fn new<const FMA: bool>(triangle: &Triangle, batch: PixelBatch<'_>) -> EdgeSetup {
        let e = real(&triangle.edges(batch.first.0, batch.first.1));
        let (a, b, p) = (real(&triangle.a), real(&triangle.b), real(&triangle.p));
        let mut terms = [0.0; 3];
        for k in 0..3 {
            terms[k] = e[k] + (a[k].abs() + b[k].abs()) * SIDE as f64;
        }
        let denominator = Line { c: sum::<FMA>(&p, &e), x: sum::<FMA>(&p, &a), y: sum::<FMA>(&p, &b) };
        let least = if p[0] < p[1] { p[0] } else { p[1] };
        let least = if least < p[2] { least } else { p[2] };
        let (least_here, least_of_all) =
            (denominator.least(SIDE as f64, SIDE as f64), least * triangle.doubled_area as f64);
        let widest = 1.0 / if least_here > least_of_all { least_here } else { least_of_all };
        let ratio = sum::<FMA>(&p, &terms) * widest;
        let reciprocal = 1.0 / denominator.c;
        EdgeSetup {
            e,
            a,
            b,
            terms,
            p,
            inverse: inverse(triangle),
            denominator,
            reciprocal,
            widest,
            ratio,
            floors: 1.25 / least,
            gap: if triangle.exact_reciprocal && triangle.p[0].is_positive() && triangle.p[0].count_ones() == 1 {
                1.0 / triangle.doubled_area as f64
            } else {
                0.0
            },
        }
    }

    /// Sets up four quotients. `g` has the numerators at the vertices, before they are floored.
    #[inline(always)]
    fn estimates<const FMA: bool>(&self, g: &[[f64; FOUR]; 3], bias: &[i32; FOUR]) -> Estimates4 {
        let mut all = Estimates4::default();
        let mut gaps = [0.0; FOUR];
        if self.gap > 0.0 {
            for n in 0..FOUR {
                let is_whole = |k: usize| whole(g[k][n] * self.inverse[k]) == g[k][n] * self.inverse[k];
                gaps[n] = if is_whole(0) && is_whole(1) && is_whole(2) { self.gap } else { 0.0 };
            }
        }
        // Not one struct for each quotient, because compilers do not vectorise such a loop.
        for n in 0..FOUR {
            let g = [g[0][n], g[1][n], g[2][n]];
            let line = Line { c: sum::<FMA>(&g, &self.e), x: sum::<FMA>(&g, &self.a), y: sum::<FMA>(&g, &self.b) };
            let size = [g[0].abs(), g[1].abs(), g[2].abs()];
            // Adds half a denominator, half a texel, and the rounding error of this number.
            let most = sum::<FMA>(&size, &self.inverse) + 260.0;
            let margin = (sum::<FMA>(&size, &self.terms) * self.widest + 2.0 * most * self.ratio) * SLACK + self.floors;
            let (extent, reciprocals) = ((SIDE as f64, SIDE as f64), (self.reciprocal, self.widest));
            let off = (margin, gaps[n]);
            let (one, is) =
                QuotientEstimate::with_proof::<false>(line, self.denominator, extent, reciprocals, off, bias[n]);
            (all.c[n], all.x[n], all.y[n]) = (one.line.c, one.line.x, one.line.y);
            (all.base[n], all.shift[n], all.limit[n]) = (one.base, one.shift, one.limit);
            all.proves[n] = i32::from(is);
        }
        all
    }
}

/// The [`QuotientEstimate`]s of four quotients.
#[derive(Default)]
struct Estimates4 {
    c: [f64; FOUR],
    x: [f64; FOUR],
    y: [f64; FOUR],
    base: [i32; FOUR],
    shift: [u32; FOUR],
    limit: [i32; FOUR],
    /// 1 if the estimate can prove something.
    proves: [i32; FOUR],
}

impl Estimates4 {
    #[inline(always)]
    fn of(&self, n: usize) -> QuotientEstimate {
        let line = Line { c: self.c[n], x: self.x[n], y: self.y[n] };
        QuotientEstimate { line, base: self.base[n], shift: self.shift[n], limit: self.limit[n], least: i32::MIN }
    }
}

/// Interpolates all attributes of the pixels of a small triangle, of which there is at least one. Returns `false` if something is not proved;
/// then nothing counts.
#[inline(always)]
pub(super) fn interpolate<const FMA: bool>(
    context: &TriangleContext<'_>,
    compiled: &CompiledDraw,
    batch: PixelBatch<'_>,
    varying: &mut Varying,
    rows: &mut [PerLane<i16>],
) -> bool {
    let mut pairs = [Pair::None; 2 * TEXTURE_UNITS];
    let mut count = 0;
    for (n, sampler) in compiled.samplers.iter().enumerate() {
        if sampler.shares.is_none() && !sampler.depends {
            let [a, b, c] = context.sampled_coordinates(sampler.index);
            if [a[3], b[3], c[3]] != [1.0; 3] || context.triangle.loses_on_planes() {
                return false;
            }
            pairs[count] = Pair::Sampler(n);
            count += 1;
        }
    }
    let weighted = compiled.varies(context);
    if weighted {
        pairs[count] = Pair::Weights;
        count += 1;
    }
    if count > 0 && !divide::<FMA>(context, compiled, batch, (&pairs, count), varying) {
        return false;
    }
    if weighted {
        narrow_weights(batch, &varying.weights, &mut varying.narrow);
    }
    colors(context, compiled, batch, &varying.narrow, rows);
    true
}

/// Computes everything that is divided by D. Returns whether all of it is proved.
#[inline(always)]
fn divide<const FMA: bool>(
    context: &TriangleContext<'_>,
    compiled: &CompiledDraw,
    batch: PixelBatch<'_>,
    (pairs, count): (&[Pair; 2 * TEXTURE_UNITS], usize),
    varying: &mut Varying,
) -> bool {
    let edges = EdgeSetup::new::<FMA>(&context.triangle, batch);
    let mut is_open = false;
    for (n, pairs) in pairs[..count.next_multiple_of(2)].as_chunks::<2>().0.iter().enumerate() {
        let (mut g, mut bias) = ([[0.0; FOUR]; 3], [0; FOUR]);
        for (half, pair) in pairs.iter().enumerate() {
            let (u, v) = (2 * half, 2 * half + 1);
            match *pair {
                Pair::None => {}
                Pair::Sampler(n) => {
                    let sampler = &compiled.samplers[n];
                    let (sets, [width, height]) = (context.sampled_coordinates(sampler.index), sampler.sides);
                    let (width, height) = (f64::from(256 * width), f64::from(256 * height));
                    for k in 0..3 {
                        g[k][u] = (f64::from(sets[k][0]) * width + sampler.up[0]) * edges.p[k];
                        g[k][v] = (f64::from(sets[k][1]) * height + sampler.up[1]) * edges.p[k];
                    }
                    (bias[u], bias[v]) = (sampler.bias(), sampler.bias());
                }
                Pair::Weights => (g[0][u], g[2][v]) = (256.0 * edges.p[0], 256.0 * edges.p[2]),
            }
        }
        let estimates = edges.estimates::<FMA>(&g, &bias);
        if estimates.proves != [1; FOUR] {
            return false;
        }
        // Not earlier: the positions have just been stored in parts, and loading them waits for that.
        if n == 0 {
            varying.reciprocals.set::<FMA, false>(batch.at, edges.denominator);
        }
        let Varying { coordinates, weights: [w0, w2], reciprocals, .. } = &mut *varying;
        for (half, pair) in pairs.iter().enumerate() {
            let (along, down) = (estimates.of(2 * half), estimates.of(2 * half + 1));
            let at = batch.lanes();
            let close = match *pair {
                Pair::None => [false; 2],
                Pair::Sampler(n) => {
                    let [u, v] = &mut coordinates[n];
                    reciprocals.estimate::<FMA, false>([along, down], &mut u[at.clone()], &mut v[at])
                }
                Pair::Weights => {
                    let estimates = [along.not_negative(), down.not_negative()];
                    reciprocals.estimate::<FMA, false>(estimates, &mut w0[at.clone()], &mut w2[at])
                }
            };
            is_open |= close[0] | close[1];
        }
    }
    !is_open
}

#[inline(always)]
fn sum<const FMA: bool>(g: &[f64; 3], of: &[f64; 3]) -> f64 {
    multiply_add::<FMA>(g[2], of[2], multiply_add::<FMA>(g[1], of[1], g[0] * of[0]))
}

#[inline(always)]
fn real(n: &[i64; 3]) -> [f64; 3] {
    [n[0] as f64, n[1] as f64, n[2] as f64]
}
