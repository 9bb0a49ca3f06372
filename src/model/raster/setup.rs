//! Triangle set-up: RAS-1 to RAS-3, and the perspective weights of INT-1.

use super::GUARD;
use crate::number::convert::{align, scaled, snap, split, w_16_bits};
use crate::state::{PlaneLoss, Profile};
use std::ops::{Add, Mul, Shr, Sub};

/// Bits of the perspective weights. Their sum of products with the edge functions then stays below 2^62.
pub(crate) const PERSPECTIVE_BITS: i32 = 28;

/// A triangle that is set up for drawing.
///
/// Edge function k at pixel (i, j) is `a[k] i + b[k] j + c[k]` in 1/256 square pixel. It is not negative inside, and
/// the three add up to `doubled_area`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triangle {
    /// Slopes of the edge functions along x.
    pub(crate) a: [i64; 3],
    /// Slopes of the edge functions along y.
    pub(crate) b: [i64; 3],
    /// Values of the edge functions at the centre of pixel (0, 0).
    pub(crate) c: [i64; 3],
    /// Whether a sample exactly on edge k belongs to the triangle: left edges and horizontal top edges (RAS-3).
    pub(crate) owns: [bool; 3],
    /// P_k: the product of the other two w in block floating point, the largest in [2^27, 2^28), each at least 1.
    /// Without perspective all are 2^27.
    pub(crate) p: [i64; 3],
    /// Twice the area in 1/256 square pixel, positive, below 2^34.
    pub(crate) doubled_area: i64,
    /// Half-open range of the rows that can be covered.
    pub(crate) rows: (i64, i64),
    /// Half-open range of the columns that can be covered.
    pub(crate) columns: (i64, i64),
    /// Whether it turns counter-clockwise as seen on the screen.
    pub(crate) counter_clockwise: bool,
    /// INT-3's exception: whether the reciprocal of the weights' sum is exact, so that no tie is lowered.
    pub(crate) exact_reciprocal: bool,
    /// INT-4t's policy: whether coordinates on planes lose the finite amount.
    finite_loss: bool,
}

impl Triangle {
    /// Returns P_k: the product of the other two w in block floating point, the largest in [2^27, 2^28), each at least 1.
    pub fn p(&self) -> [i64; 3] {
        self.p
    }

    /// Returns twice the area in 1/256 square pixel, positive, below 2^34.
    pub fn doubled_area(&self) -> i64 {
        self.doubled_area
    }

    /// Returns the half-open range of the rows that can be covered.
    pub fn rows(&self) -> (i64, i64) {
        self.rows
    }

    /// Sets up a triangle from window positions and w. Returns `None` if its area is zero after RAS-1, so that it
    /// covers nothing.
    ///
    /// The positions must be within RAS-0, which the plan has checked.
    pub fn new(positions: [[f32; 4]; 3], perspective: bool, profile: Profile) -> Option<Triangle> {
        let (x, y) = (positions.map(|p| snap(p[0])), positions.map(|p| snap(p[1])));
        let mut triangle = Triangle::default();
        if !triangle.place(x, y) {
            return None;
        }
        triangle.weigh(positions.map(|p| p[3]), perspective, profile);
        Some(triangle)
    }

    /// Sets all fields that do not [depend on w](Self::weigh) from x and y after RAS-1, in 1/16 pixel. Returns `false`
    /// if the area is zero; the triangle is then unusable.
    #[inline(always)]
    pub(crate) fn place(&mut self, x: [i64; 3], y: [i64; 3]) -> bool {
        debug_assert!(x.iter().chain(&y).all(|n| n.abs() < GUARD));
        let edges = EdgeFunctions::new(x, y);
        (self.a, self.b, self.c, self.owns) = (edges.a, edges.b, edges.c, edges.owns);
        self.doubled_area = edges.area.abs();
        (self.rows, self.columns) = (centres(y), centres(x));
        self.counter_clockwise = edges.area < 0;
        edges.area != 0
    }

    /// Sets the fields that depend on the w of the vertices.
    #[inline(always)]
    pub fn weigh(&mut self, w: [f32; 3], perspective: bool, profile: Profile) {
        let taken = significant(w, profile);
        self.p = if perspective { perspective_weights(taken) } else { [1 << (PERSPECTIVE_BITS - 1); 3] };
        self.exact_reciprocal = (self.doubled_area.count_ones() == 1) & is_flat(w, perspective, profile);
    }

    /// INT-4t: sets what coordinates on planes lose.
    #[inline(always)]
    pub fn lose(&mut self, loss: PlaneLoss) {
        self.finite_loss = loss == PlaneLoss::Finite;
    }

    /// INT-4t: returns whether coordinates on planes may lose a finite amount.
    #[inline(always)]
    pub(crate) fn loses_on_planes(&self) -> bool {
        self.finite_loss && !self.exact_reciprocal
    }

    /// Returns the three edge functions at the centre of pixel (i, j).
    #[inline]
    pub fn edges(&self, i: i64, j: i64) -> [i64; 3] {
        // Not by a function on arrays, which is not always inlined.
        let edge = |k: usize| self.a[k] * i + self.b[k] * j + self.c[k];
        [edge(0), edge(1), edge(2)]
    }

    /// RAS-3: returns whether the triangle covers a sample with these edge functions.
    #[inline]
    pub fn covers(&self, e: [i64; 3]) -> bool {
        (0..3).all(|k| e[k] > 0 || (e[k] == 0 && self.owns[k]))
    }

    /// Returns the columns of row j that [`covers`](Self::covers) accepts, as a half-open range within `columns`.
    pub fn span(&self, j: i64, columns: (i64, i64)) -> (i64, i64) {
        let (mut low, mut high) = columns;
        for k in 0..3 {
            // The condition is a i + r >= 0.
            let r = self.b[k] * j + self.c[k] - i64::from(!self.owns[k]);
            match self.a[k] {
                0 if r < 0 => return (0, 0),
                0 => {}
                a if a > 0 => low = low.max(-r.div_euclid(a)),
                a => high = high.min(r.div_euclid(-a) + 1),
            }
        }
        (low, high.max(low))
    }

    /// Returns G_k of a coordinate: floor(P_k 256 size s_k), so that u = floor(sum G E / sum P E) in 1/256 texel
    /// (INT-4).
    #[inline(always)]
    pub fn coordinate(&self, s: [f32; 3], size: u32) -> [i64; 3] {
        let mut g = [0; 3];
        for k in 0..3 {
            let (m, e) = split(s[k]);
            g[k] = scaled(m * self.p[k], i64::from(size), e + 8);
        }
        g
    }

    /// Returns G_k of a factor 0..1 in 4096ths: floor(P_k 4096 f_k) (NUM-6, INT-5n).
    pub fn factor(&self, f: [f32; 3]) -> [i64; 3] {
        std::array::from_fn(|k| {
            let (m, e) = split(f[k]);
            scaled(m, self.p[k], e + 12)
        })
    }

    /// Returns the linear functions of three coordinates of which only ratios are used: nine numbers P_k x_k with one common exponent and 28 bits.
    /// They are truncated toward zero, so that opposite directions stay opposite (TEX-15).
    #[inline(always)]
    pub fn direction(&self, x: [[f32; 3]; 3]) -> [[i64; 3]; 3] {
        let mut magnitudes = [(0, 0); 9];
        for (n, magnitude) in magnitudes.iter_mut().enumerate() {
            let (m, e) = split(x[n / 3][n % 3]);
            *magnitude = (m.abs() * self.p[n % 3], e);
        }
        let (mut g, _) = align(magnitudes, PERSPECTIVE_BITS);
        for (n, g) in g.iter_mut().enumerate() {
            *g = if x[n / 3][n % 3] < 0.0 { -*g } else { *g };
        }
        [[g[0], g[1], g[2]], [g[3], g[4], g[5]], [g[6], g[7], g[8]]]
    }
}

/// Whole numbers that hold the products of coordinates: 64 bits anywhere, 32 near a small triangle.
pub(crate) trait Whole:
    Copy + Ord + From<i32> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Shr<u32, Output = Self>
{
}

impl Whole for i32 {}
impl Whole for i64 {}

/// The edge functions of a triangle, as [`Triangle`] has them, and twice its signed area. Without branches, so that those of many triangles can be
/// computed at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeFunctions<T> {
    pub(crate) a: [T; 3],
    pub(crate) b: [T; 3],
    pub(crate) c: [T; 3],
    pub(crate) owns: [bool; 3],
    /// In 1/256 square pixel, positive if the triangle turns clockwise.
    pub(crate) area: T,
}

impl<T: Whole> EdgeFunctions<T> {
    /// Returns the edge functions between x and y after RAS-1, in 1/16 pixel.
    #[inline(always)]
    pub(crate) fn new(x: [T; 3], y: [T; 3]) -> EdgeFunctions<T> {
        let [zero, eight, sixteen] = [T::from(0), T::from(8), T::from(16)];
        let area = clockwise_area(x, y);
        let sign = T::from(i32::from(area > zero) - i32::from(area < zero));
        let edge = |s: usize, t: usize| {
            let (a, b) = ((y[s] - y[t]) * sign, (x[t] - x[s]) * sign);
            let owns = (a > zero) | ((a == zero) & (b > zero));
            // RAS-2: from 1/16 pixel to the centre (16 i + 8, 16 j + 8) of pixel (i, j).
            (sixteen * a, sixteen * b, eight * (a + b) - (a * x[s] + b * y[s]), owns)
        };
        let [(a0, b0, c0, owns0), (a1, b1, c1, owns1), (a2, b2, c2, owns2)] = [edge(1, 2), edge(2, 0), edge(0, 1)];
        EdgeFunctions { a: [a0, a1, a2], b: [b0, b1, b2], c: [c0, c1, c2], owns: [owns0, owns1, owns2], area }
    }
}

/// Returns whether a triangle has a single w, so that all P_k are equal.
#[inline(always)]
pub(crate) fn is_flat(w: [f32; 3], perspective: bool, profile: Profile) -> bool {
    let w = significant(w, profile);
    let equal = (w[0] == w[1]) & (w[1] == w[2]);
    !perspective | equal
}

/// Returns twice the area of a triangle in 1/256 square pixel. It is positive if the triangle turns clockwise for the viewer, because y points
/// down.
#[inline(always)]
pub(crate) fn clockwise_area<T: Whole>(x: [T; 3], y: [T; 3]) -> T {
    (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
}

/// INT-6: returns the three w as a chip takes them.
#[inline(always)]
pub fn significant(w: [f32; 3], profile: Profile) -> [f32; 3] {
    if profile == Profile::Nv10 { [w_16_bits(w[0]), w_16_bits(w[1]), w_16_bits(w[2])] } else { w }
}

/// Returns the half-open range of pixels whose centres lie between three positions in 1/16 pixel. Centres are at 16 n +
/// 8.
#[inline(always)]
pub(crate) fn centres<T: Whole>(n: [T; 3]) -> (T, T) {
    let (low, high) = (n[0].min(n[1]).min(n[2]), n[0].max(n[1]).max(n[2]));
    ((low + T::from(7)) >> 4, ((high - T::from(8)) >> 4) + T::from(1))
}

/// Returns P_k: the exact products of the other two w, floored to one common exponent, each at least 1.
#[inline(always)]
fn perspective_weights(w: [f32; 3]) -> [i64; 3] {
    let ((m0, e0), (m1, e1), (m2, e2)) = (split(w[0]), split(w[1]), split(w[2]));
    let ([p0, p1, p2], _) = align([(m1 * m2, e1 + e2), (m2 * m0, e2 + e0), (m0 * m1, e0 + e1)], PERSPECTIVE_BITS);
    [p0.max(1), p1.max(1), p2.max(1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(x: [[f32; 2]; 3]) -> Option<Triangle> {
        Triangle::new(x.map(|p| [p[0], p[1], 0.0, 1.0]), true, Profile::Nv2a)
    }

    #[test]
    fn spans_are_the_covered_columns() {
        let shapes = [
            [[1.3, 1.1], [18.7, 3.9], [5.2, 17.4]],
            [[0.5, 0.5], [16.5, 0.5], [0.5, 16.5]],
            [[-30.0, 5.0], [40.0, 4.0], [12.0, 9.5]],
            [[3.0, 19.0], [3.0, 1.0], [3.4, 10.0]],
        ];
        for shape in shapes {
            let t = triangle(shape).expect("area");
            for j in -2..22 {
                let (low, high) = t.span(j, (0, 20));
                for i in 0..20 {
                    assert_eq!((low..high).contains(&i), t.covers(t.edges(i, j)), "{shape:?} {i} {j}");
                }
            }
        }
    }

    #[test]
    fn shared_edges_cover_once() {
        let corners = [[2.0, 2.0], [14.5, 3.5], [13.0, 15.0], [1.5, 12.25]];
        let a = triangle([corners[0], corners[1], corners[2]]).expect("area");
        let b = triangle([corners[0], corners[2], corners[3]]).expect("area");
        for j in 0..20 {
            for i in 0..20 {
                assert!(!(a.covers(a.edges(i, j)) && b.covers(b.edges(i, j))), "{i} {j}");
            }
        }
    }

    #[test]
    fn zero_area_after_snapping_is_nothing() {
        assert!(triangle([[1.0, 1.0], [1.01, 1.0], [1.0, 1.03]]).is_none());
    }

    #[test]
    fn winding_is_the_viewers() {
        // Right, then down, which is clockwise on a screen whose y points down.
        assert!(!triangle([[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]]).expect("area").counter_clockwise);
        assert!(triangle([[0.0, 0.0], [9.0, 9.0], [9.0, 0.0]]).expect("area").counter_clockwise);
    }

    #[test]
    fn opposite_directions_are_opposite() {
        let t = Triangle::new([[0.0, 0.0, 0.0, 1.3], [9.0, 0.0, 0.0, 3.7], [0.0, 9.0, 0.0, 2.1]], true, Profile::Nv2a);
        let x = [[0.1_f32, -0.003, 7.7], [-1.9, 0.0, 0.37], [1.0, 1.7, -0.3]];
        let (there, back) = (t.expect("area").direction(x), t.expect("area").direction(x.map(|row| row.map(|c| -c))));
        assert_eq!(there, back.map(|row| row.map(|g| -g)));
    }

    #[test]
    fn equal_w_keeps_weights_equal() {
        let t = Triangle::new([[0.0, 0.0, 0.0, 3.7], [9.0, 0.0, 0.0, 3.7], [0.0, 9.0, 0.0, 3.7]], true, Profile::Nv2a);
        let p = t.expect("area").p;
        assert!(p[0] == p[1] && p[1] == p[2]);
    }
}
