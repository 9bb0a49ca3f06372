//! The shapes of eight small triangles at a time: RAS-1 to RAS-3, INT-1, and what all functions across them share.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::quotient::{EXPONENT, Line, floor, larger, multiply_add, nearest_32};
use crate::engine::context::TriangleContext;
use crate::engine::walk::Window;
use crate::raster::setup::{EdgeFunctions, PERSPECTIVE_BITS, is_flat, significant};
use crate::state::Profile;

/// Largest number of boxes that are set up at a time.
pub(super) const GROUP: usize = 8;

/// Largest number of columns and of rows of a box, whose pixels are found and interpolated together.
pub(super) const SIDE: i64 = 16;

/// The same as a number of rows.
pub(super) const ROWS: usize = SIDE as usize;

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

/// The corners of triangles that boxes are parts of.
#[derive(Debug, Default)]
pub(super) struct Corners {
    /// Indices of the vertices.
    pub(super) vertices: Each<[u32; 3]>,
    /// Positions in 1/16 pixel.
    pub(super) x: [Each<i32>; 3],
    pub(super) y: [Each<i32>; 3],
    pub(super) w: [Each<f32>; 3],
}

impl Corners {
    /// Takes the corners of a triangle.
    #[inline(always)]
    pub(super) fn set(&mut self, n: usize, context: &TriangleContext<'_>) {
        self.vertices[n] = context.draw.assembly.triangles.vertices(context.number);
        for (k, corner) in context.corners().into_iter().enumerate() {
            [self.x[k][n], self.y[k][n]] = corner.position;
            self.w[k][n] = corner.w;
        }
    }
}

/// RAS-1 to RAS-3 and INT-1 for the triangle of each box. All numbers of a small triangle fit into 32 bits.
#[derive(Debug, Default)]
pub(super) struct Shapes {
    /// Edge functions at the first pixel, and their slopes.
    pub(super) e: [Each<i32>; 3],
    pub(super) a: [Each<i32>; 3],
    pub(super) b: [Each<i32>; 3],
    /// 1 for edges that belong to the other triangle (RAS-3).
    owed: [Each<i32>; 3],
    pub(super) doubled_area: Each<i32>,
    pub(super) p: [Each<f64>; 3],
    /// -1 if the reciprocal of the weights' sum is exact (INT-3), otherwise 0.
    pub(super) exact: Each<i32>,
}

/// The columns that triangles cover in boxes.
pub(super) struct Spans {
    /// The first column of each row of each box, counted from the box's first.
    pub(super) first: [Each<i32>; ROWS],
    /// The number of columns, which is 0 if the triangle covers none.
    pub(super) count: [Each<i32>; ROWS],
    /// Number of rows of the highest box.
    pub(super) rows: usize,
}

/// Returns the power of two by which a number other than 0 gets as many bits before the point as the largest weight has.
#[inline(always)]
pub(super) fn to_largest_weight(size: f64) -> f64 {
    const EXPONENTS: u64 = ((2 * 1023 + PERSPECTIVE_BITS - 1) as u64) << 52;
    f64::from_bits(EXPONENTS.wrapping_sub(size.to_bits() & EXPONENT))
}

/// A limit beyond all columns.
const BEYOND: i32 = 1 << 23;

impl Shapes {
    /// RAS-1 to RAS-3: sets the edge functions of boxes, each with the index of its triangle.
    #[inline(always)]
    pub(super) fn place(&mut self, corners: &Corners, boxes: &[(Window, usize)]) {
        let [mut x, mut y] = [[[0; GROUP]; 3]; 2];
        for (n, ((rows, columns), triangle)) in boxes.iter().enumerate() {
            // Measured from the first pixel, edge functions are their values there.
            let (left, top) = (16 * columns.0 as i32, 16 * rows.0 as i32);
            for k in 0..3 {
                (x[k][n], y[k][n]) = (corners.x[k][*triangle] - left, corners.y[k][*triangle] - top);
            }
        }
        let Shapes { e, a, b, owed, doubled_area, .. } = self;
        // One loop, because compilers would make vectors across k of another.
        for n in 0..GROUP {
            let at = |of: &[Each<i32>; 3]| [of[0][n], of[1][n], of[2][n]];
            let edges = EdgeFunctions::new(at(&x), at(&y));
            [e[0][n], e[1][n], e[2][n]] = edges.c;
            [a[0][n], a[1][n], a[2][n]] = edges.a;
            [b[0][n], b[1][n], b[2][n]] = edges.b;
            let owes = |k: usize| i32::from(!edges.owns[k]);
            (owed[0][n], owed[1][n], owed[2][n]) = (owes(0), owes(1), owes(2));
            doubled_area[n] = edges.area.abs();
        }
    }

    /// Returns an edge function of each box.
    #[inline(always)]
    pub(super) fn lines(&self, k: usize) -> Lines {
        Lines { c: self.e[k].map(f64::from), x: self.a[k].map(f64::from), y: self.b[k].map(f64::from) }
    }

    /// INT-1: sets the weights of the vertices of [placed](Self::place) boxes. Doubles hold the product of two w exactly, and no vector of 64-bit
    /// integers is as fast.
    #[inline(always)]
    pub(super) fn weigh<const FMA: bool>(
        &mut self,
        corners: &Corners,
        boxes: &[(Window, usize)],
        (perspective, profile): (bool, Profile),
    ) {
        let mut w = [[1.0; GROUP]; 3];
        for (n, (_, triangle)) in boxes.iter().enumerate() {
            for k in 0..3 {
                w[k][n] = corners.w[k][*triangle];
            }
        }
        let Shapes { doubled_area, p, exact, .. } = self;
        for n in 0..GROUP {
            let of = [w[0][n], w[1][n], w[2][n]];
            exact[n] = -i32::from((doubled_area[n].count_ones() == 1) & is_flat(of, perspective, profile));
            let [a, b, c] = if perspective { significant(of, profile) } else { [1.0; 3] };
            let (a, b, c) = (f64::from(a), f64::from(b), f64::from(c));
            let products = [b * c, c * a, a * b];
            let size = larger(larger(products[0].abs(), products[1].abs()), products[2].abs());
            let scale = to_largest_weight(size);
            let floored = |product: f64| larger(floor::<FMA>(product * scale), 1.0);
            (p[0][n], p[1][n], p[2][n]) = (floored(products[0]), floored(products[1]), floored(products[2]));
        }
    }

    /// RAS-3: finds the columns in which no edge function is negative inside the triangle, in all rows of [placed](Self::place) boxes.
    ///
    /// Where i a + r is not negative are the columns from -floor(r / a) on, or up to floor(r / -a), with r = j b + e below 2^22. The distance of
    /// (r + 1/2) / a from an integer is at least half of 1/a. For quotients below 32 single precision is more exact than that, because a is
    /// below 2^15; larger quotients put the whole box on one side.
    #[inline(always)]
    pub(super) fn spans(&self, boxes: &[(Window, usize)]) -> Spans {
        let [mut height, mut width] = [[0; GROUP]; 2];
        for (n, ((rows, columns), _)) in boxes.iter().enumerate() {
            (height[n], width[n]) = ((rows.1 - rows.0) as i32, (columns.1 - columns.0) as i32);
        }
        let highest = height.iter().fold(0, |highest, height| highest.max(*height)) as usize;
        // Whether an edge is a lower or an upper limit depends on the triangle. Both limits are computed and the other one is moved out of the
        // way, which avoids a branch.
        let [mut from, mut to] = [[[0; GROUP]; 3]; 2];
        let [mut r, mut step, mut inverse] = [[[0.0; GROUP]; 3]; 3];
        for n in 0..GROUP {
            for k in 0..3 {
                let a = self.a[k][n];
                (from[k][n], to[k][n]) = if a > 0 { (0, BEYOND) } else { (-BEYOND, 0) };
                // A horizontal edge covers all columns of a row or none. The chosen factor moves the limit out of the box.
                inverse[k][n] = if a == 0 { 40.0 } else { 1.0 / a.abs() as f32 };
                (r[k][n], step[k][n]) = ((self.e[k][n] - self.owed[k][n]) as f32 + 0.5, self.b[k][n] as f32);
            }
        }
        let [mut first, mut count] = [[[0; GROUP]; ROWS]; 2];
        for j in 0..highest.min(ROWS) {
            for n in 0..GROUP {
                let (mut low, mut high) = (0, width[n]);
                for k in 0..3 {
                    let floor = nearest_32(r[k][n] * inverse[k][n] - 0.5);
                    r[k][n] += step[k][n];
                    // Rows below a box, which have no columns, may wrap.
                    low = low.max(from[k][n].wrapping_sub(floor));
                    high = high.min(to[k][n].wrapping_add(floor.wrapping_add(1)));
                }
                let is_inside = (j as i32) < height[n];
                (first[j][n], count[j][n]) = (low, if is_inside { high.wrapping_sub(low).max(0) } else { 0 });
            }
        }
        Spans { first, count, rows: highest }
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
    /// The same if ties are lowered.
    pub(super) tied: Each<f64>,
    /// The doubled area.
    pub(super) area: Each<f64>,
}

impl Edges {
    /// Sets up all boxes. In place, because some compilers copy a result.
    #[inline(always)]
    pub(super) fn set<const FMA: bool>(&mut self, shapes: &Shapes) {
        let [e, a, b] = [shapes.e, shapes.a, shapes.b].map(|of| of.map(|of| of.map(f64::from)));
        let (p, area) = (shapes.p, shapes.doubled_area.map(f64::from));
        (self.e, self.a, self.b, self.p, self.area) = (e, a, b, p, area);
        let Edges { terms, inverse, denominator, reciprocal, widest, ratio, floors, gap, tied, .. } = self;
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
            // Equal P cancel. A power of two divides all edge functions.
            let bits = |of: &[Each<i32>; 3]| of[0][n] | of[1][n] | of[2][n];
            let bits = bits(&shapes.e) | bits(&shapes.a) | bits(&shapes.b);
            let unit = f64::from(bits & bits.wrapping_neg()) / area[n];
            let unit = if (p[0] == p[1]) & (p[1] == p[2]) { unit } else { 0.0 };
            let (is_exact, is_power) = (shapes.exact[n] != 0, p[0].to_bits() << 12 == 0);
            gap[n] = if is_exact & is_power { unit } else { 0.0 };
            tied[n] = if is_exact { 0.0 } else { unit };
            (denominator.c[n], denominator.x[n], denominator.y[n]) = (line.c, line.x, line.y);
        }
    }

    /// Returns the edge functions of a box.
    #[inline(always)]
    pub(super) fn lines(&self, n: usize) -> [Line; 3] {
        // Not a closure, because one that is called three times is not inlined.
        [self.line(0, n), self.line(1, n), self.line(2, n)]
    }

    /// Returns an edge function of a box.
    #[inline(always)]
    pub(super) fn line(&self, k: usize, n: usize) -> Line {
        Line { c: self.e[k][n], x: self.a[k][n], y: self.b[k][n] }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::raster::setup::Triangle;

    /// Weights of any w: alike, far apart, subnormal, and 0.
    #[test]
    fn weights_are_those_of_triangles() {
        let (mut random, mut shapes, mut corners) = (Random::seeded(41), Shapes::default(), Corners::default());
        let all = std::array::from_fn::<_, GROUP, _>(|n| (((0, SIDE), (0, SIDE)), n));
        for round in 0..20_000 {
            let profile = [Profile::Nv2a, Profile::Nv10][round % 2];
            for n in 0..GROUP {
                shapes.doubled_area[n] = 1 << (random.bits() % 24);
                let mut finite =
                    || Some(f32::from_bits(random.bits() as u32)).filter(|w| w.is_finite()).unwrap_or(0.0).abs();
                let first = finite();
                for (k, w) in corners.w.iter_mut().enumerate() {
                    let near = first * (1.0 + (k * n) as f32 / 64.0);
                    w[n] = if n >= 4 && near.is_finite() { near } else { finite() };
                }
            }
            for perspective in [true, false] {
                let mut triangles: [Triangle; GROUP] = Default::default();
                for (n, triangle) in triangles.iter_mut().enumerate() {
                    triangle.doubled_area = shapes.doubled_area[n].into();
                    triangle.weigh([0, 1, 2].map(|k| corners.w[k][n]), perspective, profile);
                }
                for fused in [false, true] {
                    let weigh = if fused { Shapes::weigh::<true> } else { Shapes::weigh::<false> };
                    weigh(&mut shapes, &corners, &all, (perspective, profile));
                    for (n, triangle) in triangles.iter().enumerate() {
                        let found = [0, 1, 2].map(|k| shapes.p[k][n] as i64);
                        let w = corners.w.map(|w| w[n]);
                        assert_eq!((found, shapes.exact[n] != 0), (triangle.p, triangle.exact_reciprocal), "{w:?}");
                    }
                }
            }
        }
    }

    /// Every slope and many values, those around a whole number of columns above all.
    #[test]
    fn spans_are_floors() {
        let (mut shapes, all) = (Shapes::default(), [(((0, SIDE), (0, SIDE)), 0); GROUP]);
        let slopes: Vec<i32> = (-4352..=4352_i32).step_by(16).collect();
        for slopes in slopes.chunks(GROUP) {
            for n in -40..=40_i32 {
                for value in 0..4 {
                    let edge = |a: i32| {
                        let size = n * a.abs();
                        let e = [size - 1, size, size + 1, n * 6007][value].clamp(-150_000, 150_000);
                        (e, a, (e & 255) * 16 - 2048)
                    };
                    // The edge stands at each of the three in turn; the others limit nothing.
                    let k = (n + 40) as usize % 3;
                    (shapes.a, shapes.b, shapes.e) = Default::default();
                    for (n, a) in slopes.iter().enumerate() {
                        (shapes.e[k][n], shapes.a[k][n], shapes.b[k][n]) = edge(*a);
                    }
                    let Spans { first, count, .. } = shapes.spans(&all);
                    for (n, a) in slopes.iter().enumerate() {
                        let (e, _, b) = edge(*a);
                        for j in 0..ROWS {
                            let inside = |i: &i32| a * i + b * j as i32 + e >= 0;
                            let wanted = (0..SIDE as i32).filter(inside).count() as i32;
                            let (low, count) = (first[j][n], count[j][n]);
                            assert_eq!(count, wanted, "{a} {b} {e} {j}");
                            assert!((low..low + count).all(|i| inside(&i)), "{a} {b} {e} {j}");
                        }
                    }
                }
            }
        }
    }
}
