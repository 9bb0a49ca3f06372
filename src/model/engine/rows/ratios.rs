//! TEX-15, SHD-1, INT-4t and TSH-4 for boxes of small triangles, eight at a time: coordinates that are divided by q, depths to compare with, and
//! numbers that a texture shader reads.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::direction::COARSEST;
use super::planes::{KEPT, fraction_bits_by_power};
use super::quotient::{Line, Positions, SLACK, any_negative, floor, larger, nearest};
use super::shapes::{Each, Edges, GROUP, Lines, Shapes, smaller, to_largest_weight};
use super::short::{Dominance, SHORTFALL, Short, floors};
use super::third::{SMALL_ERROR, words};
use crate::state::DepthFormat;

/// A coordinate of the three vertices of each box.
pub(super) type OfVertices = [Each<f32>; 3];

/// The weights 0 and 2 of boxes, which may fall short.
#[derive(Debug, Default)]
pub(super) struct Weights {
    /// N_0 and N_2.
    functions: [Lines; 2],
    /// A bound of the error of four times a numerator less D.
    error: Each<f64>,
}

impl Weights {
    #[inline(always)]
    pub(super) fn set_up<const FMA: bool>(&mut self, edges: &Edges) {
        for (k, line) in [0, 2].into_iter().zip(&mut self.functions) {
            for n in 0..GROUP {
                let p = edges.p[k][n];
                (line.c[n], line.x[n], line.y[n]) = (p * edges.e[k][n], p * edges.a[k][n], p * edges.b[k][n]);
            }
        }
        self.error = edges.function::<FMA>(&edges.p).1.map(|terms| 4.0 * SLACK * terms);
    }

    /// Finds the weights that fall short in a box. Returns whether some are too close to a border.
    #[inline(always)]
    pub(super) fn classify<const FMA: bool>(
        &self,
        (edges, shapes): (&Edges, &Shapes),
        n: usize,
        at: Positions<'_>,
        dominance: &mut Dominance,
    ) -> bool {
        if shapes.exact[n] != 0 {
            dominance.set_none(at);
            return false;
        }
        let [first, third] = &self.functions;
        let functions = [first.of(n), third.of(n), edges.denominator.of(n)];
        dominance.classify::<FMA, false>(at, functions, self.error[n])
    }
}

/// Does what [`Triangle::direction`](crate::raster::setup::Triangle::direction) does, by doubles like the weights.
#[inline(always)]
fn direction<const FMA: bool>(p: [f64; 3], x: [[f32; 3]; 3]) -> [[f64; 3]; 3] {
    let (mut g, mut size) = ([[0.0; 3]; 3], 0.0);
    for (g, x) in g.iter_mut().zip(&x) {
        *g = [f64::from(x[0]) * p[0], f64::from(x[1]) * p[1], f64::from(x[2]) * p[2]];
        size = larger(larger(larger(g[0].abs(), g[1].abs()), g[2].abs()), size);
    }
    let scale = to_largest_weight(size);
    for g in g.as_flattened_mut() {
        *g = floor::<FMA>(g.abs() * scale).copysign(*g);
    }
    g
}

/// Coordinates of a sampler in boxes, where q is not 1.
#[derive(Debug, Default)]
pub(super) struct Ratios {
    /// s and t in 1/256 texel, and q.
    lines: [Lines; 3],
    /// Their [losses](super::short::Losses).
    losses: [[Each<f64>; 2]; 3],
    /// The largest error of a coordinate.
    margin: Each<f64>,
}

impl Ratios {
    /// Sets up all boxes from s, t and q. Clears `proves` where nothing would be proved.
    #[inline(always)]
    pub(super) fn set_up<const FMA: bool>(
        &mut self,
        (edges, shapes): (&Edges, &Shapes),
        [s, t, q]: [&OfVertices; 3],
        sides: [u32; 2],
        proves: &mut Each<i32>,
    ) {
        let (mut g, mut reach, mut least) = ([[[0.0; GROUP]; 3]; 3], [0.0; GROUP], [0.0; GROUP]);
        let [width, height] = [256.0 * f64::from(sides[0]), 256.0 * f64::from(sides[1])];
        let most = larger(width, height);
        for n in 0..GROUP {
            let at = |of: &OfVertices| [of[0][n], of[1][n], of[2][n]];
            let p = [shapes.p[0][n], shapes.p[1][n], shapes.p[2][n]];
            let [s, t, q] = direction::<FMA>(p, [at(s), at(t), at(q)]);
            let sign = if (q[0] < 0.0) & (q[1] < 0.0) & (q[2] < 0.0) { -1.0 } else { 1.0 };
            let by = |factor: f64, g: [f64; 3]| [g[0] * factor, g[1] * factor, g[2] * factor];
            let (s, t, q) = (by(sign * width, s), by(sign * height, t), by(sign, q));
            (g[0][0][n], g[0][1][n], g[0][2][n]) = (s[0], s[1], s[2]);
            (g[1][0][n], g[1][1][n], g[1][2][n]) = (t[0], t[1], t[2]);
            (g[2][0][n], g[2][1][n], g[2][2][n]) = (q[0], q[1], q[2]);
            let ratio = |k: usize| larger(s[k].abs(), t[k].abs()) / q[k];
            reach[n] = larger(larger(ratio(0), ratio(1)), ratio(2));
            least[n] = smaller(smaller(q[0], q[1]), q[2]);
        }
        let [(s, of_s), (t, of_t), (q, of_q)] =
            [edges.function::<FMA>(&g[0]), edges.function::<FMA>(&g[1]), edges.function::<FMA>(&g[2])];
        self.lines = [s, t, q];
        for n in 0..GROUP {
            // The error of s or t, that of q times the quotient, again for what is subtracted, and twice that.
            let error = 8.0 * SLACK * (of_s[n] + of_t[n] + of_q[n] * (most + reach[n]));
            self.margin[n] = error / (least[n] * edges.area[n]);
            proves[n] &= -i32::from((least[n] > 0.0) & (self.margin[n] < COARSEST));
        }
        for (losses, g) in self.losses.iter_mut().zip(&g) {
            for n in 0..GROUP {
                let falls = if shapes.exact[n] != 0 { 0.0 } else { SHORTFALL };
                let middle = g[1][n] * edges.inverse[1][n];
                losses[0][n] = (g[0][n] * edges.inverse[0][n] - middle) * falls;
                losses[1][n] = (g[2][n] * edges.inverse[2][n] - middle) * falls;
            }
        }
    }

    /// Computes the coordinates of a box, less a bias, whose weights are [classified](Weights::classify). Returns whether some are not proved.
    #[inline(always)]
    pub(super) fn floors<const FMA: bool>(
        &self,
        n: usize,
        at: Positions<'_>,
        bias: i32,
        short: &mut Short,
        [u, v]: [&mut [i32]; 2],
    ) -> bool {
        let lines = [self.lines[0].of(n), self.lines[1].of(n), self.lines[2].of(n)];
        let of = |losses: &[Each<f64>; 2]| [losses[0][n], losses[1][n]];
        let losses = [of(&self.losses[0]), of(&self.losses[1]), of(&self.losses[2])];
        let [at_u, at_v] = &mut short.at;
        short.dominance.divide::<FMA, false>(at, lines, losses, -0.5, [at_u, at_v]);
        let (lanes, Short { at, close, .. }) = (u.len(), short);
        close[..lanes].fill(0);
        floors(&at[0][..lanes], self.margin[n], bias, close, u);
        floors(&at[1][..lanes], self.margin[n], bias, close, v);
        any_negative(&close[..lanes])
    }
}

/// Depths to compare with in boxes: r divided by D or by q.
#[derive(Debug, Default)]
pub(super) struct References {
    lines: [Lines; 2],
    /// The largest error.
    off: Each<f64>,
}

impl References {
    /// Sets up all boxes from r and, if that divides it, q. Clears `proves` where nothing would be proved.
    #[inline(always)]
    pub(super) fn set_up<const FMA: bool>(
        &mut self,
        edges: &Edges,
        (r, q): (&OfVertices, Option<&OfVertices>),
        format: DepthFormat,
        proves: &mut Each<i32>,
    ) {
        let full = f64::from(format.largest());
        let (top, _, of_r) = Bounds::new::<FMA>(edges, r);
        let Some(q) = q else {
            self.lines = [top, edges.denominator];
            for n in 0..GROUP {
                self.off[n] = of_r.off(edges, n);
                proves[n] &= -i32::from(self.off[n] < full);
            }
            return;
        };
        let (bottom, _, of_q) = Bounds::new::<FMA>(edges, q);
        self.lines = [top, bottom];
        for n in 0..GROUP {
            let error = |of: &Bounds| 8.0 * SLACK * of.terms[n] + of.lost[n] * edges.area[n];
            let (of_terms, of_q, least) = (error(&of_r) + error(&of_q), error(&of_q), of_q.least[n] * edges.area[n]);
            let least = least - 4.0 * of_q;
            self.off[n] = (of_terms + of_q * (of_r.terms[n] / least)) / least;
            proves[n] &= -i32::from((least > 0.0) & (self.off[n] < SMALL_ERROR));
        }
    }

    /// Writes the words of a box. Returns whether some are unknown.
    #[inline(always)]
    pub(super) fn words<const FMA: bool>(
        &self,
        n: usize,
        at: Positions<'_>,
        format: DepthFormat,
        out: &mut [u32],
    ) -> bool {
        let lines = (self.lines[0].of(n), self.lines[1].of(n));
        let errors = [self.off[n], 0.0, 0.0];
        if format.is_float() {
            words::<FMA, false, true, false>(at, lines, errors, format, out)
        } else {
            words::<FMA, false, false, false>(at, lines, errors, format, out)
        }
    }
}

/// A number that a texture shader reads.
#[derive(Clone, Debug, Default)]
pub(super) struct BoxNumber {
    values: OfVertices,
    line: Lines,
    /// The largest error of a quotient by D.
    off: Each<f64>,
}

impl BoxNumber {
    /// Sets up all boxes from the values at the vertices.
    #[inline(always)]
    pub(super) fn set_up<const FMA: bool>(&mut self, (edges, shapes): (&Edges, &Shapes), values: &OfVertices) {
        let (line, g, bounds) = Bounds::new::<FMA>(edges, values);
        (self.values, self.line) = (*values, line);
        for n in 0..GROUP {
            self.off[n] = bounds.off(edges, n);
        }
        // D is a power of two in few boxes.
        for n in (0..GROUP).filter(|n| edges.gap[*n] > 0.0) {
            let (p, area) = (nearest(shapes.p[0][n]).into(), shapes.doubled_area[n].into());
            if fraction_bits_by_power(p, area, &[g[0][n], g[1][n], g[2][n]]).is_some() {
                self.off[n] = 0.0;
            }
        }
    }

    /// Returns the number in a box if it is the same at all vertices.
    #[inline(always)]
    pub(super) fn same(&self, n: usize) -> Option<f32> {
        let [a, b, c] = [self.values[0][n], self.values[1][n], self.values[2][n]];
        (a == b && a == c).then_some(a)
    }

    /// Returns its function in a box, and the largest error of its quotient by D.
    #[inline(always)]
    pub(super) fn of(&self, n: usize) -> (Line, f64) {
        (self.line.of(n), self.off[n])
    }
}

/// Bounds of a number's function in boxes.
pub(super) struct Bounds {
    terms: Each<f64>,
    /// The largest magnitude of a quotient by D.
    reach: Each<f64>,
    /// What each g_k may lose where the definition [keeps](crate::raster::attribute) no more bits of the products.
    lost: Each<f64>,
    /// The least magnitude of a g_k.
    least: Each<f64>,
}

impl Bounds {
    /// Returns the function of values at the vertices, its numbers at the vertices, and bounds.
    #[inline(always)]
    pub(super) fn new<const FMA: bool>(edges: &Edges, values: &OfVertices) -> (Lines, [Each<f64>; 3], Bounds) {
        let (mut g, [mut reach, mut lost, mut least]) = ([[0.0; GROUP]; 3], [[0.0; GROUP]; 3]);
        for n in 0..GROUP {
            // Exact, because 28 bits are multiplied by 24.
            let of = |k: usize| f64::from(values[k][n]) * edges.p[k][n];
            let [a, b, c] = [of(0), of(1), of(2)];
            (g[0][n], g[1][n], g[2][n]) = (a, b, c);
            let [a, b, c] = [a.abs(), b.abs(), c.abs()];
            (lost[n], least[n]) = (larger(larger(a, b), c) * KEPT, smaller(smaller(a, b), c));
            let [a, b, c] = [a * edges.inverse[0][n], b * edges.inverse[1][n], c * edges.inverse[2][n]];
            reach[n] = larger(larger(a, b), c);
        }
        let (line, terms) = edges.function::<FMA>(&g);
        (line, g, Bounds { terms, reach, lost, least })
    }

    /// Returns the largest error of a quotient by D.
    #[inline(always)]
    pub(super) fn off(&self, edges: &Edges, n: usize) -> f64 {
        (self.terms[n] * edges.widest[n] + 2.0 * self.reach[n] * edges.ratio[n]) * SLACK
            + self.lost[n] * edges.floors[n]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::raster::setup::Triangle;

    /// Coordinates of any size and sign, alike and far apart.
    #[test]
    fn directions_are_those_of_triangles() {
        let (mut random, mut triangle) = (Random::seeded(42), Triangle::default());
        for round in 0..40_000 {
            let p = [0; 3].map(|_| 1 + (random.bits() >> (36 + random.bits() % 20)) as i64);
            triangle.p = p;
            let finite = |bits: u64| Some(f32::from_bits(bits as u32)).filter(|x| x.is_finite()).unwrap_or(0.0);
            let size = finite(random.bits());
            let x = [[0.0; 3]; 3].map(|of| {
                of.map(|zero| match random.bits() % 8 {
                    0 => zero,
                    1..4 if round % 2 == 0 => size,
                    4..6 if round % 2 == 0 => -size / 3.0,
                    _ => finite(random.bits()),
                })
            });
            let wanted = triangle.direction(x);
            for found in [direction::<true>(p.map(|p| p as f64), x), direction::<false>(p.map(|p| p as f64), x)] {
                assert_eq!(found.map(|of| of.map(|g| g as i64)), wanted, "{p:?} {x:?}");
            }
        }
    }
}
