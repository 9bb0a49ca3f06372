//! INT-1 to INT-4t for small triangles whose units are sampled on planes. The functions of several boxes are set up at a time, in floating
//! point only, and all quotients of a pixel share one reciprocal. `docs/exactness.md` has the argument.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::CompiledDraw;
use super::boxes::{BoxCoverage, SIDE, inverse_slope};
use super::color::colors;
use super::compiled::Sampler;
use super::kernels::PerLane;
use super::quotient::{Line, QuotientEstimate, SLACK, multiply_add, whole};
use super::setup::PixelBatch;
use super::triangle::Varying;
use crate::engine::pixel::TriangleContext;
use crate::engine::walk::Window;
use crate::raster::setup::{EdgeFunctions, weights};
use crate::state::{PlaneLoss, TEXTURE_UNITS};

/// Largest number of boxes that are set up at a time.
pub(super) const GROUP: usize = 8;

/// A number of each box.
type Each<T> = [T; GROUP];

/// Boxes of small triangles that are set up at a time.
#[derive(Debug, Default)]
pub(super) struct Boxes {
    /// Rows and columns of each, and the index of the triangle among the contexts, in the order in which they are drawn.
    pub(super) all: Each<(Window, usize)>,
    pub(super) count: usize,
    /// Their pixels.
    coverages: Each<BoxCoverage>,
    /// Index of the current box.
    pub(super) current: usize,
    denominator: Lines,
    /// u and v of the samplers.
    coordinates: [[Estimates; 2]; TEXTURE_UNITS],
    /// Weights 0 and 2.
    weights: [Estimates; 2],
    /// Whether all estimates can prove something.
    proves: Each<bool>,
}

impl Boxes {
    /// Adds a box, for which there is room.
    #[inline(always)]
    pub(super) fn add(&mut self, window: Window, context: usize) {
        self.all[self.count] = (window, context);
        self.count += 1;
    }

    /// Returns the index of the first context that no box uses.
    #[inline(always)]
    pub(super) fn vacant(&self) -> usize {
        self.count.checked_sub(1).map_or(0, |last| self.all[last].1 + 1)
    }

    /// Returns the pixels of the current box.
    #[inline(always)]
    pub(super) fn coverage(&self) -> &BoxCoverage {
        &self.coverages[self.current]
    }

    #[inline(always)]
    pub(super) fn coverage_mut(&mut self) -> &mut BoxCoverage {
        &mut self.coverages[self.current]
    }

    /// Finds the pixels of the first boxes, and sets up all functions. Contexts need not be [placed](TriangleContext::place).
    #[inline(always)]
    pub(super) fn set_up<const FMA: bool>(
        &mut self,
        contexts: &[TriangleContext<'_>],
        compiled: &CompiledDraw,
        count: usize,
    ) {
        let all = &self.all[..count];
        let shapes = Shapes::new(contexts, all);
        for (n, ((window, _), coverage)) in all.iter().zip(&mut self.coverages).enumerate() {
            let of = |edges: &[Each<i32>; 3]| [edges[0][n], edges[1][n], edges[2][n]];
            let inverse = [shapes.inverse[0][n], shapes.inverse[1][n], shapes.inverse[2][n]];
            coverage.cover([of(&shapes.e), of(&shapes.a), of(&shapes.b), of(&shapes.owed)], inverse, *window);
        }
        let edges = Edges::new::<FMA>(&shapes);
        let loses = contexts[0].plan.policies.plane_loss == PlaneLoss::Finite;
        let mut proves = [-1; GROUP];
        for (n, sampler) in own(compiled) {
            let (mut s, mut t) = ([[0.0_f32; GROUP]; 3], [[0.0_f32; GROUP]; 3]);
            for (n, (_, context)) in all.iter().enumerate() {
                let context = &contexts[*context];
                let sets = context.sampled_coordinates(sampler.index);
                for k in 0..3 {
                    (s[k][n], t[k][n]) = (sets[k][0], sets[k][1]);
                }
                let is_plane = [sets[0][3], sets[1][3], sets[2][3]] == [1.0; 3] && !(loses && shapes.exact[n] == 0);
                proves[n] &= -i32::from(is_plane);
            }
            let (bias, [width, height], [up, down]) = (sampler.bias(), sampler.sides, sampler.up);
            let [u, v] = &mut self.coordinates[n];
            for (estimates, at, side, up) in [(u, s, width, up), (v, t, height, down)] {
                let (side, mut g) = (f64::from(256 * side), [[0.0; GROUP]; 3]);
                for k in 0..3 {
                    for n in 0..GROUP {
                        g[k][n] = (f64::from(at[k][n]) * side + up) * edges.p[k][n];
                    }
                }
                *estimates = Estimates::new::<FMA>(&edges, &g, bias, &mut proves);
            }
        }
        if all.iter().any(|(_, context)| compiled.varies(&contexts[*context])) {
            for (k, estimates) in [0, 2].into_iter().zip(&mut self.weights) {
                let mut g = [[0.0; GROUP]; 3];
                g[k] = edges.p[k].map(|p| 256.0 * p);
                *estimates = Estimates::new::<FMA>(&edges, &g, 0, &mut proves);
            }
        }
        self.proves = proves.map(|proves| proves != 0);
        self.denominator = edges.denominator;
    }

    /// Interpolates all attributes of the pixels of the current box, of which there is at least one. Returns `false` if something is not proved; then
    /// nothing counts.
    #[inline(always)]
    pub(super) fn interpolate<const FMA: bool>(
        &self,
        context: &TriangleContext<'_>,
        compiled: &CompiledDraw,
        batch: PixelBatch<'_>,
        varying: &mut Varying,
        rows: &mut [PerLane<i16>],
    ) -> bool {
        let n = self.current;
        if !self.proves[n] {
            return false;
        }
        let weighted = compiled.varies(context);
        let Varying { coordinates, narrow: [w0, w2], reciprocals, .. } = &mut *varying;
        if weighted || !compiled.samplers.is_empty() {
            reciprocals.set::<FMA, false>(batch.at, self.denominator.of(n));
        }
        let (at, mut open) = (|| batch.lanes(), 0);
        for (sampler, _) in own(compiled) {
            let ([along, down], [u, v]) = (&self.coordinates[sampler], &mut coordinates[sampler]);
            let close =
                reciprocals.floors::<FMA, false, _>([along.of(n), down.of(n)], &mut u[at()], &mut v[at()], |u| u);
            open |= close[0] | close[1];
        }
        if weighted {
            let [first, third] = [self.weights[0].of(n).not_negative(), self.weights[1].of(n).not_negative()];
            let close = reciprocals.floors::<FMA, false, _>([first, third], &mut w0[at()], &mut w2[at()], |w| w as u16);
            open |= close[0] | close[1];
        }
        if open < 0 {
            return false;
        }
        colors(context, compiled, batch, &varying.narrow, rows);
        true
    }
}

/// Returns the samplers that have coordinates of their own, with their indices.
#[inline(always)]
fn own(compiled: &CompiledDraw) -> impl Iterator<Item = (usize, &Sampler)> {
    compiled.samplers.iter().enumerate().filter(|(_, sampler)| sampler.shares.is_none() && !sampler.depends)
}

/// A linear function of each box.
#[derive(Debug, Default)]
struct Lines {
    c: Each<f64>,
    x: Each<f64>,
    y: Each<f64>,
}

impl Lines {
    #[inline(always)]
    fn of(&self, n: usize) -> Line {
        Line { c: self.c[n], x: self.x[n], y: self.y[n] }
    }
}

/// RAS-1 to RAS-3 and INT-1 for the triangle of each box. All numbers of a small triangle fit into 32 bits.
struct Shapes {
    /// Edge functions at the first pixel, and their slopes.
    e: [Each<i32>; 3],
    a: [Each<i32>; 3],
    b: [Each<i32>; 3],
    /// Reciprocals of the magnitudes of the slopes along x.
    inverse: [Each<f32>; 3],
    /// 1 for edges that belong to the other triangle (RAS-3).
    owed: [Each<i32>; 3],
    p: [Each<i32>; 3],
    doubled_area: Each<i32>,
    /// -1 if the reciprocal of the weights' sum is exact (INT-3), otherwise 0.
    exact: Each<i32>,
}

impl Shapes {
    #[inline(always)]
    fn new(contexts: &[TriangleContext<'_>], boxes: &[(Window, usize)]) -> Shapes {
        let (draw, profile) = (contexts[0].draw, contexts[0].plan.profile);
        let [mut x, mut y] = [[[0; GROUP]; 3]; 2];
        let mut w = [[1.0; GROUP]; 3];
        for (n, ((rows, columns), context)) in boxes.iter().enumerate() {
            // Measured from the first pixel, edge functions are their values there.
            let (left, top) = (16 * columns.0 as i32, 16 * rows.0 as i32);
            for (k, corner) in contexts[*context].corners().into_iter().enumerate() {
                let [of_x, of_y] = corner.position;
                (x[k][n], y[k][n], w[k][n]) = (of_x - left, of_y - top, corner.w);
            }
        }
        let [mut e, mut a, mut b, mut owed, mut p] = [[[0; GROUP]; 3]; 5];
        let ([mut doubled_area, mut exact], mut inverse) = ([[0; GROUP]; 2], [[0.0; GROUP]; 3]);
        // One loop, because compilers would make vectors across k of another.
        for n in 0..GROUP {
            let at = |of: &[Each<i32>; 3]| [of[0][n], of[1][n], of[2][n]];
            let edges = EdgeFunctions::new(at(&x), at(&y));
            let area = edges.area.abs();
            let (weights, is_exact) = weights([w[0][n], w[1][n], w[2][n]], area.into(), draw.perspective, profile);
            [e[0][n], e[1][n], e[2][n]] = edges.c;
            [a[0][n], a[1][n], a[2][n]] = edges.a;
            [b[0][n], b[1][n], b[2][n]] = edges.b;
            let [a0, a1, a2] = edges.a;
            (inverse[0][n], inverse[1][n], inverse[2][n]) = (inverse_slope(a0), inverse_slope(a1), inverse_slope(a2));
            let owes = |k: usize| i32::from(!edges.owns[k]);
            (owed[0][n], owed[1][n], owed[2][n]) = (owes(0), owes(1), owes(2));
            (p[0][n], p[1][n], p[2][n]) = (weights[0] as i32, weights[1] as i32, weights[2] as i32);
            (doubled_area[n], exact[n]) = (area, -i32::from(is_exact));
        }
        Shapes { e, a, b, inverse, owed, p, doubled_area, exact }
    }
}

/// The set-up that all functions of a box share.
struct Edges {
    /// Edge functions at the first pixel, and their slopes.
    e: [Each<f64>; 3],
    a: [Each<f64>; 3],
    b: [Each<f64>; 3],
    /// Upper bound of each |E_k| in the box, with all terms that are added to it.
    terms: [Each<f64>; 3],
    p: [Each<f64>; 3],
    /// 1 / P_k of the vertices.
    inverse: [Each<f64>; 3],
    denominator: Lines,
    /// Reciprocal of the first pixel's D.
    reciprocal: Each<f64>,
    /// Reciprocal of a lower bound of D.
    widest: Each<f64>,
    /// Upper bound of the quotient of any term of D by the least D.
    ratio: Each<f64>,
    /// Upper bound of the change of a quotient by the floors of its numerators at the vertices.
    floors: Each<f64>,
    /// If the values at the vertices are whole and no tie is lowered (INT-3), quotients are multiples of this number; otherwise 0.
    gap: Each<f64>,
}

impl Edges {
    #[inline(always)]
    fn new<const FMA: bool>(shapes: &Shapes) -> Edges {
        let [e, a, b, p] = [shapes.e, shapes.a, shapes.b, shapes.p].map(|of| of.map(|of| of.map(f64::from)));
        let area = shapes.doubled_area.map(f64::from);
        let (mut terms, mut inverse, mut denominator) = ([[0.0; GROUP]; 3], [[0.0; GROUP]; 3], Lines::default());
        let [mut reciprocal, mut widest, mut ratio, mut floors, mut gap] = [[0.0; GROUP]; 5];
        // One loop, because compilers would make vectors across k of another.
        for n in 0..GROUP {
            let at = |of: &[Each<f64>; 3]| [of[0][n], of[1][n], of[2][n]];
            let (e, a, b, p) = (at(&e), at(&a), at(&b), at(&p));
            let line = Line { c: sum::<FMA>(&p, &e), x: sum::<FMA>(&p, &a), y: sum::<FMA>(&p, &b) };
            let bound = |k: usize| e[k].abs() + (a[k].abs() + b[k].abs()) * SIDE as f64;
            let bounds = [bound(0), bound(1), bound(2)];
            (terms[0][n], terms[1][n], terms[2][n]) = (bounds[0], bounds[1], bounds[2]);
            (inverse[0][n], inverse[1][n], inverse[2][n]) = (1.0 / p[0], 1.0 / p[1], 1.0 / p[2]);
            let least = smaller(smaller(p[0], p[1]), p[2]);
            let (least_here, least_of_all) = (line.least(SIDE as f64, SIDE as f64), least * area[n]);
            widest[n] = 1.0 / if least_here > least_of_all { least_here } else { least_of_all };
            ratio[n] = sum::<FMA>(&p, &bounds) * widest[n];
            reciprocal[n] = 1.0 / line.c;
            floors[n] = 1.25 / least;
            // All P are equal if the reciprocal is exact.
            let is_power = shapes.p[0][n].count_ones() == 1;
            gap[n] = if is_power & (shapes.exact[n] != 0) { 1.0 / area[n] } else { 0.0 };
            (denominator.c[n], denominator.x[n], denominator.y[n]) = (line.c, line.x, line.y);
        }
        Edges { e, a, b, terms, p, inverse, denominator, reciprocal, widest, ratio, floors, gap }
    }
}

/// The [`QuotientEstimate`]s of a quotient in each box.
#[derive(Debug, Default)]
struct Estimates {
    line: Lines,
    base: Each<i32>,
    shift: Each<u32>,
    limit: Each<i32>,
}

impl Estimates {
    /// Sets up a quotient in all boxes. `g` has the numerators at the vertices, before they are floored. Clears `proves` where the estimate can
    /// prove nothing.
    #[inline(always)]
    fn new<const FMA: bool>(edges: &Edges, g: &[Each<f64>; 3], bias: i32, proves: &mut Each<i32>) -> Estimates {
        let mut all = Estimates::default();
        // Not one struct for each quotient, because compilers do not vectorise such a loop.
        for n in 0..GROUP {
            let at = |of: &[Each<f64>; 3]| [of[0][n], of[1][n], of[2][n]];
            let (g, inverse) = (at(g), at(&edges.inverse));
            let line = Line {
                c: sum::<FMA>(&g, &at(&edges.e)),
                x: sum::<FMA>(&g, &at(&edges.a)),
                y: sum::<FMA>(&g, &at(&edges.b)),
            };
            let size = [g[0].abs(), g[1].abs(), g[2].abs()];
            let is_whole = |k: usize| whole(g[k] * inverse[k]) == g[k] * inverse[k];
            let gap = if is_whole(0) & is_whole(1) & is_whole(2) { edges.gap[n] } else { 0.0 };
            // Adds half a denominator, half a texel, and the rounding error of this number.
            let most = sum::<FMA>(&size, &inverse) + 260.0;
            let terms = sum::<FMA>(&size, &at(&edges.terms));
            let margin = (terms * edges.widest[n] + 2.0 * most * edges.ratio[n]) * SLACK + edges.floors[n];
            let (extent, reciprocals) = ((SIDE as f64, SIDE as f64), (edges.reciprocal[n], edges.widest[n]));
            let denominator = edges.denominator.of(n);
            let (one, is) =
                QuotientEstimate::with_proof::<false>(line, denominator, extent, reciprocals, (margin, gap), bias);
            (all.line.c[n], all.line.x[n], all.line.y[n]) = (one.line.c, one.line.x, one.line.y);
            (all.base[n], all.shift[n], all.limit[n]) = (one.base, one.shift, one.limit);
            proves[n] &= -i32::from(is);
        }
        all
    }

    #[inline(always)]
    fn of(&self, n: usize) -> QuotientEstimate {
        let (base, shift, limit) = (self.base[n], self.shift[n], self.limit[n]);
        QuotientEstimate { line: self.line.of(n), base, shift, limit, least: i32::MIN }
    }
}

#[inline(always)]
fn sum<const FMA: bool>(g: &[f64; 3], of: &[f64; 3]) -> f64 {
    multiply_add::<FMA>(g[2], of[2], multiply_add::<FMA>(g[1], of[1], g[0] * of[0]))
}

#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
