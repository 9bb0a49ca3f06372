//! The shapes of eight small triangles at a time: RAS-1 to RAS-3, INT-1, and what all functions across them share.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::boxes::{SIDE, inverse_slope};
use super::quotient::{Line, multiply_add};
use crate::engine::context::TriangleContext;
use crate::engine::walk::Window;
use crate::raster::setup::{EdgeFunctions, weights};

/// Largest number of boxes that are set up at a time.
pub(super) const GROUP: usize = 8;

/// A number of each box.
pub(super) type Each<T> = [T; GROUP];

/// A linear function of each box.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Lines {
    pub(super) c: Each<f64>,
    pub(super) x: Each<f64>,
    pub(super) y: Each<f64>,
}

impl Lines {
    #[inline(always)]
    pub(super) fn of(&self, n: usize) -> Line {
        Line { c: self.c[n], x: self.x[n], y: self.y[n] }
    }
}

/// RAS-1 to RAS-3 and INT-1 for the triangle of each box. All numbers of a small triangle fit into 32 bits.
#[derive(Debug, Default)]
pub(super) struct Shapes {
    /// Edge functions at the first pixel, and their slopes.
    pub(super) e: [Each<i32>; 3],
    pub(super) a: [Each<i32>; 3],
    pub(super) b: [Each<i32>; 3],
    /// Reciprocals of the magnitudes of the slopes along x.
    pub(super) inverse: [Each<f32>; 3],
    /// 1 for edges that belong to the other triangle (RAS-3).
    pub(super) owed: [Each<i32>; 3],
    pub(super) p: [Each<i32>; 3],
    pub(super) doubled_area: Each<i32>,
    /// -1 if the reciprocal of the weights' sum is exact (INT-3), otherwise 0.
    pub(super) exact: Each<i32>,
}

impl Shapes {
    #[inline(always)]
    pub(super) fn new(contexts: &[TriangleContext<'_>], boxes: &[(Window, usize)]) -> Shapes {
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
#[derive(Debug, Default)]
pub(super) struct Edges {
    /// Edge functions at the first pixel, and their slopes.
    pub(super) e: [Each<f64>; 3],
    pub(super) a: [Each<f64>; 3],
    pub(super) b: [Each<f64>; 3],
    /// Upper bound of each |E_k| in the box, with all terms that are added to it.
    pub(super) terms: [Each<f64>; 3],
    pub(super) p: [Each<f64>; 3],
    /// 1 / P_k of the vertices.
    pub(super) inverse: [Each<f64>; 3],
    pub(super) denominator: Lines,
    /// Reciprocal of the first pixel's D.
    pub(super) reciprocal: Each<f64>,
    /// Reciprocal of a lower bound of D.
    pub(super) widest: Each<f64>,
    /// Upper bound of the quotient of any term of D by the least D.
    pub(super) ratio: Each<f64>,
    /// Upper bound of the change of a quotient by the floors of its numerators at the vertices.
    pub(super) floors: Each<f64>,
    /// If the values at the vertices are whole and no tie is lowered (INT-3), quotients are multiples of this number; otherwise 0.
    pub(super) gap: Each<f64>,
    /// The doubled area.
    pub(super) area: Each<f64>,
}

impl Edges {
    #[inline(always)]
    pub(super) fn new<const FMA: bool>(shapes: &Shapes) -> Edges {
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
        Edges { e, a, b, terms, p, inverse, denominator, reciprocal, widest, ratio, floors, gap, area }
    }

    /// Returns the function with these values at the vertices in each box, and an upper bound of its terms.
    #[inline(always)]
    pub(super) fn function<const FMA: bool>(&self, g: &[Each<f64>; 3]) -> (Lines, Each<f64>) {
        let (mut line, mut terms) = (Lines::default(), [0.0; GROUP]);
        for n in 0..GROUP {
            let at = |of: &[Each<f64>; 3]| [of[0][n], of[1][n], of[2][n]];
            let g = at(g);
            line.c[n] = sum::<FMA>(&g, &at(&self.e));
            line.x[n] = sum::<FMA>(&g, &at(&self.a));
            line.y[n] = sum::<FMA>(&g, &at(&self.b));
            terms[n] = sum::<FMA>(&[g[0].abs(), g[1].abs(), g[2].abs()], &at(&self.terms));
        }
        (line, terms)
    }
}

#[inline(always)]
pub(super) fn sum<const FMA: bool>(g: &[f64; 3], of: &[f64; 3]) -> f64 {
    multiply_add::<FMA>(g[2], of[2], multiply_add::<FMA>(g[1], of[1], g[0] * of[0]))
}

#[inline(always)]
pub(super) fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
