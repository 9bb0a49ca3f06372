//! Linear functions across a triangle, as estimates in double precision and as integers modulo 2^64.
#![allow(clippy::float_arithmetic, reason = "estimates: no result depends on how they are rounded")]

use super::quotient::{Exact, Line, larger};
use crate::raster::setup::Triangle;

/// The function sum G_k E_k.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plane {
    /// The values G_k at the vertices.
    pub(super) g: [i64; 3],
    /// The same in double precision.
    pub(super) real: RealPlane,
    /// Slopes along x and y modulo 2^64.
    whole: [i64; 2],
    /// Number of factors of two that all G_k and P_k share.
    pub(super) shared: u32,
}

impl Plane {
    /// Sets up a plane. `inverse` has the triangle's [`inverse`]s.
    #[inline(always)]
    pub(super) fn new(triangle: &Triangle, inverse: &[f64; 3], g: [i64; 3]) -> Plane {
        let (x, y) = (slope(&g, &triangle.a), slope(&g, &triangle.b));
        let p = &triangle.p;
        let real = [g[0] as f64, g[1] as f64, g[2] as f64];
        // Adds half a denominator, half a texel, and the rounding error of this number.
        let reach = largest_quotient(&real, inverse) + 260.0;
        Plane {
            g,
            real: RealPlane { g: real, slope: [x.0, y.0], sizes: [x.0.abs(), y.0.abs()], reach },
            whole: [x.1, y.1],
            shared: (g[0] | g[1] | g[2] | p[0] | p[1] | p[2]).trailing_zeros(),
        }
    }

    /// Sets up the planes of a direction's components.
    #[inline(always)]
    pub(super) fn three(triangle: &Triangle, inverse: &[f64; 3], g: &[[i64; 3]; 3]) -> [Plane; 3] {
        // Not a closure, because one that is called three times is not inlined.
        [Plane::new(triangle, inverse, g[0]), Plane::new(triangle, inverse, g[1]), Plane::new(triangle, inverse, g[2])]
    }

    /// Sets up the plane of 256 b_k.
    #[inline(always)]
    pub(super) fn weight(triangle: &Triangle, k: usize) -> Plane {
        let p = &triangle.p;
        let mut plane = Plane { shared: (p[0] | p[1] | p[2]).trailing_zeros(), ..Plane::default() };
        // Below 2^36; slopes are below 2^24.
        let g = 256 * p[k];
        plane.g[k] = g;
        plane.whole = [g * triangle.a[k], g * triangle.b[k]];
        let [x, y] = [plane.whole[0] as f64, plane.whole[1] as f64];
        plane.real = RealPlane { slope: [x, y], sizes: [x.abs(), y.abs()], reach: 516.0, ..RealPlane::default() };
        plane.real.g[k] = g as f64;
        plane
    }

    /// Returns whether INT-4t can lower its ties.
    pub(super) fn lowers(&self, triangle: &Triangle) -> bool {
        let (g, p) = (&self.g, &triangle.p);
        let falls = |k: usize| i128::from(g[k]) * i128::from(p[1]) > i128::from(p[k]) * i128::from(g[1]);
        !triangle.exact_reciprocal && (falls(0) || falls(2))
    }

    /// Returns the number of which all quotients by D are multiples, if the P_k are the same power of two, and the power of two that divides the
    /// G_k. Returns 0 if there is no such number.
    pub(super) fn gap(&self, triangle: &Triangle) -> (f64, u32) {
        let p = triangle.p[0] as u64;
        if triangle.p != [triangle.p[0]; 3] || !p.is_power_of_two() {
            return (0.0, 0);
        }
        let shared = (self.g[0] | self.g[1] | self.g[2]).trailing_zeros().min(62);
        ((1_u64 << shared) as f64 / (p as f64 * triangle.doubled_area as f64), shared)
    }

    /// Returns whether floors of the quotients, shifted by so many bits, are the coordinates on a smaller level (INT-4).
    pub(super) fn shifts_by(&self, bits: u32) -> bool {
        (self.g[0] | self.g[1] | self.g[2]).trailing_zeros() >= bits
    }

    /// Returns the slope along x modulo 2^64.
    pub(super) fn x(&self) -> i64 {
        self.whole[0]
    }

    /// Returns the function modulo 2^64.
    #[inline(always)]
    pub(super) fn exact(&self, e: &[i64; 3]) -> Exact {
        let [g0, g1, g2] = self.g;
        let c = g0.wrapping_mul(e[0]).wrapping_add(g1.wrapping_mul(e[1])).wrapping_add(g2.wrapping_mul(e[2]));
        Exact { c, x: self.whole[0], y: self.whole[1] }
    }

    /// Returns the value at a pixel of the triangle and the slope along x, divided by the power of two that all G_k and P_k share, or
    /// `None` if they have too many bits.
    #[inline(always)]
    pub(super) fn divided(&self, triangle: &Triangle, e: &[i64; 3]) -> Option<(i64, i64)> {
        let [g0, g1, g2] = [self.g[0] >> self.shared, self.g[1] >> self.shared, self.g[2] >> self.shared];
        let [a0, a1, a2] = triangle.a;
        // No edge function is larger than the area.
        let largest = triangle.doubled_area.unsigned_abs() | a0.unsigned_abs() | a1.unsigned_abs() | a2.unsigned_abs();
        let all = g0.unsigned_abs() | g1.unsigned_abs() | g2.unsigned_abs();
        let fits = all.leading_zeros() + largest.leading_zeros() >= 64 + 4;
        if !fits {
            return None;
        }
        Some((g0 * e[0] + g1 * e[1] + g2 * e[2], g0 * a0 + g1 * a1 + g2 * a2))
    }
}

/// Returns what is added to estimates of a coordinate, 1/256 texel, that may be the `same` at all vertices: half a step if it is whole there, so
/// that it lies between two floors and is proved. Nothing lowers it (INT-4t).
pub(super) fn up(same: Option<f32>, side: u32) -> f64 {
    let is_whole = same.is_some_and(|at| (f64::from(at) * f64::from(256 * side)).fract() == 0.0);
    if is_whole { 0.5 } else { 0.0 }
}

/// Returns the edge functions relative to a pixel where they are `e`.
#[inline(always)]
pub(super) fn edge_lines(triangle: &Triangle, e: &[i64; 3]) -> [Line; 3] {
    let (a, b) = (&triangle.a, &triangle.b);
    // Not a closure, because one that is called three times is not inlined.
    [
        Line { c: e[0] as f64, x: a[0] as f64, y: b[0] as f64 },
        Line { c: e[1] as f64, x: a[1] as f64, y: b[1] as f64 },
        Line { c: e[2] as f64, x: a[2] as f64, y: b[2] as f64 },
    ]
}

/// An upper bound of the last bit that an [attribute](crate::raster::attribute) keeps, relative to the largest of a triangle's three numbers.
pub(super) const KEPT: f64 = 1.0 / (1_u64 << 60) as f64;

/// The function sum g_k E_k in double precision.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RealPlane {
    g: [f64; 3],
    /// Slopes along x and y.
    slope: [f64; 2],
    /// Upper bounds of the magnitudes of the slopes, or sums of those of their terms if the slopes are rounded sums.
    sizes: [f64; 2],
    /// Upper bound of the magnitude of its quotient by D.
    pub(super) reach: f64,
}

impl RealPlane {
    /// Sets up a plane. `inverse` has the triangle's [`inverse`]s, and `more` bounds what is added to quotients.
    #[inline(always)]
    pub(super) fn new(triangle: &Triangle, inverse: &[f64; 3], g: [f64; 3], more: f64) -> RealPlane {
        let reach = more + largest_quotient(&g, inverse);
        let mut plane = RealPlane { g, reach, ..RealPlane::default() };
        for k in 0..3 {
            let (x, y) = (g[k] * triangle.a[k] as f64, g[k] * triangle.b[k] as f64);
            plane.slope = [plane.slope[0] + x, plane.slope[1] + y];
            plane.sizes = [plane.sizes[0] + x.abs(), plane.sizes[1] + y.abs()];
        }
        plane
    }

    /// Returns the function relative to a pixel with edge functions `e`.
    #[inline(always)]
    pub(super) fn line(&self, e: &[f64; 3]) -> Line {
        let c = self.g[0] * e[0] + self.g[1] * e[1] + self.g[2] * e[2];
        Line { c, x: self.slope[0], y: self.slope[1] }
    }

    /// Returns a bound of the terms of [`line`](Self::line), so many columns and rows around the pixel.
    #[inline(always)]
    pub(super) fn terms(&self, e: &[f64; 3], columns: f64, rows: f64) -> f64 {
        let at = self.g[0].abs() * e[0].abs() + self.g[1].abs() * e[1].abs() + self.g[2].abs() * e[2].abs();
        at + self.sizes[0] * columns + self.sizes[1] * rows
    }

    /// Returns the values g_k at the vertices.
    #[inline(always)]
    pub(super) fn g(&self) -> &[f64; 3] {
        &self.g
    }
}

/// Four functions like [`RealPlane`] side by side, because compilers then set up all at once.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FourPlanes {
    g: [[f64; FOUR]; 3],
    /// Slopes along x and y.
    slopes: [[f64; FOUR]; 2],
    /// Sums of the magnitudes of the terms of the slopes.
    sizes: [[f64; FOUR]; 2],
    /// Upper bounds of the magnitudes of their quotients by D.
    pub(super) reach: [f64; FOUR],
    /// What each g_k may lose where the definition [keeps](crate::raster::attribute) no more bits of the products.
    pub(super) lost: [f64; FOUR],
}

/// Number of functions that are set up at once.
pub(super) const FOUR: usize = 4;

impl FourPlanes {
    /// Sets up planes of numbers at the vertices.
    #[inline(always)]
    pub(super) fn set(&mut self, triangle: &Triangle, inverse: &[f64; 3], values: &[[f32; FOUR]; 3]) {
        let FourPlanes { g, slopes, sizes, reach, lost } = self;
        let [p, a, b] = [triangle.p, triangle.a, triangle.b].map(|of| of.map(|n| n as f64));
        for k in 0..3 {
            for n in 0..FOUR {
                // Exact, because 28 bits are multiplied by 24.
                g[k][n] = f64::from(values[k][n]) * p[k];
            }
        }
        // One result after the other, because compilers do not make vectors of all at once.
        for ((slopes, sizes), along) in slopes.iter_mut().zip(sizes).zip([a, b]) {
            for n in 0..FOUR {
                slopes[n] = g[0][n] * along[0] + g[1][n] * along[1] + g[2][n] * along[2];
            }
            for n in 0..FOUR {
                sizes[n] = (g[0][n] * along[0]).abs() + (g[1][n] * along[1]).abs() + (g[2][n] * along[2]).abs();
            }
        }
        for n in 0..FOUR {
            let [first, second, third] = [0, 1, 2].map(|k| g[k][n].abs() * inverse[k]);
            reach[n] = larger(larger(first, second), third);
        }
        for n in 0..FOUR {
            lost[n] = larger(larger(g[0][n].abs(), g[1][n].abs()), g[2][n].abs()) * KEPT;
        }
    }

    /// Returns the functions relative to a pixel with edge functions `e`, and bounds of their terms so many columns and rows around it.
    #[inline(always)]
    pub(super) fn around(&self, e: &[f64; 3], columns: f64, rows: f64) -> ([Line; FOUR], [f64; FOUR]) {
        let (FourPlanes { g, slopes: [x, y], sizes, .. }, mut lines, mut terms) =
            (self, [Line::default(); 4], [0.0; 4]);
        for n in 0..FOUR {
            let c = g[0][n] * e[0] + g[1][n] * e[1] + g[2][n] * e[2];
            lines[n] = Line { c, x: x[n], y: y[n] };
            let at = g[0][n].abs() * e[0].abs() + g[1][n].abs() * e[1].abs() + g[2][n].abs() * e[2].abs();
            terms[n] = at + sizes[0][n] * columns + sizes[1][n] * rows;
        }
        (lines, terms)
    }

    /// Returns the values g_k of a function at the vertices.
    #[inline(always)]
    pub(super) fn g(&self, n: usize) -> [f64; 3] {
        [self.g[0][n], self.g[1][n], self.g[2][n]]
    }
}

/// Returns the number of fraction bits of the quotients by D of sum g_k E_k if doubles hold all of them and all intermediate results exactly. D
/// is then a power of two, as it is on squares that face the viewer.
#[inline(always)]
pub(super) fn fraction_bits(triangle: &Triangle, g: &[f64; 3]) -> Option<i32> {
    // All P are equal if the reciprocal is exact.
    let [p, ..] = triangle.p;
    let divides_by_power = triangle.exact_reciprocal && p.count_ones() == 1;
    if divides_by_power { fraction_bits_by_power(p, triangle.doubled_area, g) } else { None }
}

/// Does the same where all P_k are one power of two and the doubled area is another.
#[inline(always)]
pub(super) fn fraction_bits_by_power(p: i64, area: i64, g: &[f64; 3]) -> Option<i32> {
    let exponent = |n: f64| (n.to_bits() >> 52 & 0x7ff) as i32 - 1023;
    let lowest = |n: &f64| exponent(*n) - 52 + (n.to_bits() | 1 << 52).trailing_zeros() as i32;
    let largest = g[0].abs().max(g[1].abs()).max(g[2].abs());
    let last = g.iter().filter(|n| **n != 0.0).map(lowest).min().unwrap_or(0);
    // Sums of three terms, along two axes.
    let bits = exponent(largest) + area.ilog2() as i32 + 4 - last;
    (bits <= 53).then(|| (p.ilog2() + area.ilog2()) as i32 - last)
}

/// Returns the largest magnitude of the quotients g_k / P_k.
#[inline(always)]
fn largest_quotient(g: &[f64; 3], inverse: &[f64; 3]) -> f64 {
    let mut largest = 0.0;
    for k in 0..3 {
        let quotient = g[k].abs() * inverse[k];
        largest = if quotient > largest { quotient } else { largest };
    }
    largest
}

/// Returns 1 / P_k, rounded.
#[inline(always)]
pub(super) fn inverse(triangle: &Triangle) -> [f64; 3] {
    let p = &triangle.p;
    [1.0 / p[0] as f64, 1.0 / p[1] as f64, 1.0 / p[2] as f64]
}

/// Returns the slope of a sum of G_k E_k along an axis, as an estimate and modulo 2^64.
#[inline(always)]
fn slope(g: &[i64; 3], edge: &[i64; 3]) -> (f64, i64) {
    let bits = |n: &[i64; 3]| 64 - (n[0].unsigned_abs() | n[1].unsigned_abs() | n[2].unsigned_abs()).leading_zeros();
    if bits(g) + bits(edge) <= 60 {
        let sum = g[0] * edge[0] + g[1] * edge[1] + g[2] * edge[2];
        (sum as f64, sum)
    } else {
        let sum: i128 = (0..3).map(|k| i128::from(g[k]) * i128::from(edge[k])).sum();
        (sum as f64, sum as i64)
    }
}
