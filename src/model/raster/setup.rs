//! Triangle set-up: RAS-1 to RAS-3, and the ratios of w of WGT-1. Lines and points are [strokes](super::stroke).

use super::FAR_GUARD;
use super::binary::Binary;
use super::stroke::{Figure, Side, within};
use super::weights::ratios;
use crate::number::Integer;
use crate::number::convert::{snap, w_16_bits};
use crate::state::{FrontFace, Profile};

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
    pub owns: [bool; 3],
    /// WGT-1: r_k, w_1 over w_k, in perspective with w that differ.
    pub(crate) ratios: Option<[Binary; 3]>,
    /// Twice the area in 1/256 square pixel, positive, below 2^34.
    pub doubled_area: i64,
    /// Half-open range of the rows that can be covered.
    pub rows: (i64, i64),
    /// Half-open range of the columns that can be covered.
    pub(crate) columns: (i64, i64),
    /// Whether it turns counter-clockwise as seen on the screen.
    pub(crate) counter_clockwise: bool,
    /// What it is.
    pub figure: Figure,
    /// The limits of a line, besides its rows and columns.
    pub(crate) sides: [Side; 4],
    /// Whether its edges are smooth (SMO-1).
    pub(crate) is_smooth: bool,
    /// Which vertices lie behind the eye. Their edge functions are not positive inside (RAS-8), where the triangle reaches to infinity.
    pub(crate) behind: [bool; 3],
}

impl Triangle {
    /// Sets up a triangle from window positions and w. Returns `None` if its area is zero after RAS-1, so that it
    /// covers nothing.
    ///
    /// The positions must be within RAS-0, which the plan has checked.
    pub fn new(positions: [[f32; 4]; 3], perspective: bool, profile: Profile) -> Option<Triangle> {
        let (x, y) = (positions.map(|p| snap(p[0])), positions.map(|p| snap(p[1])));
        let mut triangle = Triangle::default();
        if !triangle.place_corners(x, y) {
            return None;
        }
        let w = positions.map(|p| p[3]);
        triangle.turn_behind(w);
        triangle.weigh(w, perspective, profile);
        Some(triangle)
    }

    /// Sets all fields that do not [depend on w](Self::weigh) from x and y after RAS-1, in 1/16 pixel. Returns `false`
    /// if the area is zero; the triangle is then unusable.
    #[inline(always)]
    pub(crate) fn place_corners(&mut self, x: [i64; 3], y: [i64; 3]) -> bool {
        debug_assert!(x.iter().chain(&y).all(|n| n.abs() < FAR_GUARD));
        let edges = EdgeFunctions::new(x, y);
        (self.a, self.b, self.c, self.owns) = (edges.a, edges.b, edges.c, edges.owns);
        self.doubled_area = edges.area.abs();
        (self.rows, self.columns) = (centres(y), centres(x));
        self.counter_clockwise = edges.area < 0;
        (self.figure, self.is_smooth, self.behind) = (Figure::Triangle, false, [false; 3]);
        edges.area != 0
    }

    /// RAS-8: sets the fields that depend on which vertices lie behind the eye, by the w of the vertices.
    pub(crate) fn turn_behind(&mut self, w: [f32; 3]) {
        self.behind = w.map(|w| w < 0.0);
        for k in (0..3).filter(|k| self.behind[*k]) {
            self.owns[k] = owns(-self.a[k], -self.b[k]);
            self.counter_clockwise ^= true;
            (self.rows, self.columns) = (EVERYWHERE, EVERYWHERE);
        }
    }

    /// RAS-8: returns edge functions with the sign that they have inside.
    #[inline(always)]
    fn turned(&self, k: usize, edge: i64) -> i64 {
        if self.behind[k] { -edge } else { edge }
    }

    /// Returns whether a sample with these edge functions lies outside, not on an edge.
    #[inline]
    pub(crate) fn is_outside(&self, e: [i64; 3]) -> bool {
        (self.turned(0, e[0]) | self.turned(1, e[1]) | self.turned(2, e[2])) < 0
    }

    /// Returns whether a sample lies behind the eye, where the sum S of its edge numbers has not the sign of sums inside.
    pub(crate) fn is_behind(&self, sum: i64) -> bool {
        self.turned(1, sum) <= 0
    }

    /// Sets the fields that depend on the w of the vertices.
    #[inline(always)]
    pub fn weigh(&mut self, w: [f32; 3], perspective: bool, profile: Profile) {
        let taken = significant(w, profile);
        let flat = is_flat(w, perspective, profile);
        self.ratios = (!flat).then(|| signed_ratios(taken));
    }

    /// Returns the three edge functions at the centre of pixel (i, j).
    #[inline]
    pub fn edges(&self, i: i64, j: i64) -> [i64; 3] {
        // Not by a function on arrays, which is not always inlined.
        let edge = |k: usize| edge_function([self.a[k], self.b[k], self.c[k]], i, j);
        [edge(0), edge(1), edge(2)]
    }

    /// Returns the three edge functions: slopes along x and y, value at the centre of pixel (0, 0).
    pub fn edge_functions(&self) -> [[i64; 3]; 3] {
        [0, 1, 2].map(|k| [self.a[k], self.b[k], self.c[k]])
    }

    /// RAS-3: returns whether the triangle covers a sample with these edge functions.
    #[inline]
    pub fn covers(&self, e: [i64; 3]) -> bool {
        (0..3).all(|k| is_inside(self.turned(k, e[k]), self.owns[k]))
    }

    /// Returns whether it covers a pixel.
    pub fn contains(&self, i: i64, j: i64) -> bool {
        let (first, end) = self.span(j, (i, i + 1));
        first < end && !(self.is_smooth && self.covered_samples(i, j) == 0)
    }

    /// Returns the columns of row j that [`covers`](Self::covers) accepts, or that a line or a point covers, as a half-open range within `columns`. With
    /// smooth edges not all of them need have [samples](Self::covered_samples).
    pub fn span(&self, j: i64, columns: (i64, i64)) -> (i64, i64) {
        match (self.is_smooth, self.figure) {
            (true, _) => self.smooth_span(j, columns),
            (false, Figure::Triangle) => within(self.limits(), j, columns),
            (false, Figure::Line | Figure::Point) => self.stroke_span(j, columns),
        }
    }

    /// Returns the limits of a triangle's samples.
    #[inline]
    pub(super) fn limits(&self) -> [Side; 3] {
        // Not by a function on arrays, which is not always inlined.
        let limit = |k: usize| {
            let [a, b, c] = [self.a[k], self.b[k], self.c[k]].map(|n| self.turned(k, n));
            [a, b, c - i64::from(!self.owns[k])]
        };
        [limit(0), limit(1), limit(2)]
    }
}

/// RAS-8: the rows and the columns of a triangle that reaches to infinity.
pub(crate) const EVERYWHERE: (i64, i64) = (-FAR_GUARD / 16, FAR_GUARD / 16);

/// RAS-8: returns the [ratios](ratios()) of w of any sign.
#[inline(always)]
pub(crate) fn signed_ratios(w: [f32; 3]) -> [Binary; 3] {
    let of_magnitudes = ratios(w.map(|w| Binary::new(w.abs())));
    [0, 1, 2].map(|k| if (w[k] < 0.0) == (w[1] < 0.0) { of_magnitudes[k] } else { of_magnitudes[k].negated() })
}

/// The edge functions of a triangle, as [`Triangle`] has them, and twice its signed area. Without branches, so that those of many triangles can be
/// computed at a time.
#[derive(Clone, Copy, Debug)]
pub struct EdgeFunctions<T: Integer> {
    /// Slopes along x.
    pub a: [T; 3],
    /// Slopes along y.
    pub b: [T; 3],
    /// Values at the centre of pixel (0, 0).
    pub c: [T; 3],
    /// Whether a sample exactly on the edge belongs to the triangle (RAS-3).
    pub owns: [T::Choice; 3],
    /// In 1/256 square pixel, positive if the triangle turns clockwise.
    pub area: T,
}

impl<T: Integer> EdgeFunctions<T> {
    /// Returns the edge functions between x and y after RAS-1, in 1/16 pixel. They are 0 without an area.
    #[inline(always)]
    pub fn new(x: [T; 3], y: [T; 3]) -> EdgeFunctions<T> {
        let [zero, one, eight, sixteen] = [0, 1, 8, 16].map(T::new);
        let area = clockwise_area(x, y);
        let sign = one.or(zero.is_below(area), zero) - one.or(area.is_below(zero), zero);
        let edge = |s: usize, t: usize| {
            let (a, b) = ((y[s] - y[t]) * sign, (x[t] - x[s]) * sign);
            // RAS-2: from 1/16 pixel to the centre (16 i + 8, 16 j + 8) of pixel (i, j).
            (sixteen * a, sixteen * b, eight * (a + b) - (a * x[s] + b * y[s]), owns(a, b))
        };
        let [(a0, b0, c0, owns0), (a1, b1, c1, owns1), (a2, b2, c2, owns2)] = [edge(1, 2), edge(2, 0), edge(0, 1)];
        EdgeFunctions { a: [a0, a1, a2], b: [b0, b1, b2], c: [c0, c1, c2], owns: [owns0, owns1, owns2], area }
    }

    /// RAS-8: returns edge functions that are not negative inside, where these vertices lie behind the eye.
    pub fn turned(self, behind: [T::Choice; 3]) -> EdgeFunctions<T> {
        let turn = |of: [T; 3]| [0, 1, 2].map(|k: usize| (T::new(0) - of[k]).or(behind[k], of[k]));
        let (a, b, c) = (turn(self.a), turn(self.b), turn(self.c));
        EdgeFunctions { a, b, c, owns: [0, 1, 2].map(|k: usize| owns(a[k], b[k])), area: self.area }
    }
}

/// RAS-3: returns whether a sample exactly on an edge of these slopes belongs to the triangle.
#[inline(always)]
fn owns<T: Integer>(a: T, b: T) -> T::Choice {
    let zero = T::new(0);
    zero.is_below(a) | (a.is_zero() & zero.is_below(b))
}

/// RAS-2: returns an edge function, of which slopes and the value at the centre of pixel (0, 0) are given, at pixel (i, j).
#[inline(always)]
pub fn edge_function<I: Integer>([a, b, c]: [I; 3], i: I, j: I) -> I {
    a * i + b * j + c
}

/// RAS-3: returns whether an edge has a sample inside, where its edge function is `e`.
#[inline(always)]
pub fn is_inside<I: Integer>(e: I, owns: I::Choice) -> I::Choice {
    I::new(0).is_below(e) | (e.is_zero() & owns)
}

/// Returns whether a triangle has a single w, so that it needs no ratios.
#[inline(always)]
pub(crate) fn is_flat(w: [f32; 3], perspective: bool, profile: Profile) -> bool {
    let w = significant(w, profile);
    let equal = (w[0] == w[1]) & (w[1] == w[2]);
    !perspective | equal
}

/// Returns twice the area of a triangle in 1/256 square pixel. It is positive if the triangle turns clockwise for the viewer, because y points
/// down.
#[inline(always)]
pub(crate) fn clockwise_area<T: Integer>(x: [T; 3], y: [T; 3]) -> T {
    (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
}

/// Returns whether a triangle of that [area](clockwise_area) shows its front. One without area counts as counterclockwise (POL-1).
#[inline(always)]
pub(crate) fn is_front(clockwise_area: i64, front_face: FrontFace) -> bool {
    (clockwise_area <= 0) == (front_face == FrontFace::CounterClockwise)
}

/// RAS-8: returns twice the area of a triangle as the eye sees it: each vertex behind the eye turns the triangle over.
#[inline(always)]
pub(crate) fn area_seen(clockwise_area: i64, w: [f32; 3]) -> i64 {
    let is_turned = (w[0] < 0.0) ^ (w[1] < 0.0) ^ (w[2] < 0.0);
    if is_turned { -clockwise_area } else { clockwise_area }
}

/// INT-6: returns the three w as a chip takes them.
#[inline(always)]
pub fn significant(w: [f32; 3], profile: Profile) -> [f32; 3] {
    if profile == Profile::Nv10 { [w_16_bits(w[0]), w_16_bits(w[1]), w_16_bits(w[2])] } else { w }
}

/// Returns the half-open range of pixels whose centres lie between three positions in 1/16 pixel. Centres are at 16 n +
/// 8.
#[inline(always)]
pub(crate) fn centres<T: Integer>(n: [T; 3]) -> (T, T) {
    let (low, high) = (n[0].least(n[1]).least(n[2]), n[0].greatest(n[1]).greatest(n[2]));
    ((low + T::new(7)).down(T::new(4)), (high - T::new(8)).down(T::new(4)) + T::new(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(x: [[f32; 2]; 3]) -> Option<Triangle> {
        Triangle::new(x.map(|p| [p[0], p[1], 0.0, 1.0]), true, Profile::Nv2a)
    }

    #[test]
    fn triangles_behind_the_eye() {
        let corners = [[4.5, 4.5], [8.5, 4.5], [4.5, 8.5]];
        let covers = |corners: [[f32; 2]; 3], behind: [bool; 3], (i, j): (i64, i64)| {
            let w = behind.map(|behind| if behind { -2.0 } else { 1.0 });
            let position = |k: usize| [corners[k][0], corners[k][1], 0.0, w[k]];
            let triangle = Triangle::new([0, 1, 2].map(position), true, Profile::Nv2a).expect("area");
            let covered = triangle.covers(triangle.edges(i, j));
            assert_eq!(triangle.contains(i, j), covered, "{behind:?} {i} {j}");
            let at = |axis: usize| corners.map(|corner| snap(corner[axis]));
            let edges = EdgeFunctions::new(at(0), at(1)).turned(behind);
            let turned = |k: usize| is_inside(edge_function([edges.a[k], edges.b[k], edges.c[k]], i, j), edges.owns[k]);
            assert_eq!((0..3).all(turned), covered, "{behind:?} {i} {j}");
            covered
        };
        let sets = [0, 1, 2, 3, 4, 5, 6, 7].map(|n| [n & 1 != 0, n & 2 != 0, n & 4 != 0]);
        let turned = [corners[0], corners[2], corners[1]];
        for (i, j) in (-4..20).flat_map(|i| (-4..20).map(move |j| (i, j))) {
            let counts = sets.map(|set| usize::from(covers(corners, set, (i, j))));
            // Each pixel belongs to one set of signs, or its edges have owners that contradict each other; nobody sees a triangle that lies behind
            // the eye as a whole.
            assert!(counts.iter().sum::<usize>() <= 1 && counts[7] == 0, "{i} {j}: {counts:?}");
            // The order of the corners does not matter.
            for [a, b, c] in sets {
                assert_eq!(covers(corners, [a, b, c], (i, j)), covers(turned, [a, c, b], (i, j)));
            }
        }
        assert!(covers(corners, [true, false, false], (9, 9)) && !covers(corners, [false; 3], (9, 9)));
        assert!(covers(corners, [true, false, false], (6, 6)) && !covers(corners, [false; 3], (6, 6)));
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
}
