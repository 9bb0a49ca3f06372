//! A triangle as loops over lanes take it.
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly")]

use crate::raster::setup::{Triangle, significant};
use crate::raster::weights::{Number, ratios};
use crate::state::Profile;

/// RAS-2 and WGT-1: the numbers of a triangle from which the weights at its pixels follow. Edge functions have at most 39 bits.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Shape {
    /// Changes of the edge functions from column to column, and from row to row, and their values at pixel (0, 0).
    pub(crate) a: [f64; 3],
    pub(crate) b: [f64; 3],
    pub(crate) c: [f64; 3],
    /// Ratios of the w of the vertices, if these differ.
    pub(crate) ratios: Option<[f64; 3]>,
    /// The reciprocal R of the edge numbers' sum, if it is the same at all pixels that are computed, and nothing is cut off edge functions.
    pub(super) reciprocal: Option<f64>,
}

impl Shape {
    /// Returns a triangle with these w. `around` says that pixels beside it are computed, too.
    #[inline(always)]
    pub(crate) fn new(
        triangle: &Triangle,
        w: [f32; 3],
        (perspective, profile): (bool, Profile),
        around: bool,
    ) -> Shape {
        let w = significant(w, profile);
        let is_flat = !perspective | ((w[0] == w[1]) & (w[1] == w[2]));
        let real = |n: [i64; 3]| [n[0] as f64, n[1] as f64, n[2] as f64];
        // The last bit that any of them has.
        let all = (0..3).fold(0, |all, k| all | triangle.a[k] | triangle.b[k] | triangle.c[k]);
        let largest = (0..3).fold(0, |largest: i64, k| largest.max(triangle.a[k].abs() + triangle.b[k].abs()));
        let reach = triangle.doubled_area + if around { 2 * largest } else { 0 };
        let is_whole = reach < 1 << (24 + all.trailing_zeros().min(30));
        Shape {
            a: real(triangle.a),
            b: real(triangle.b),
            c: real(triangle.c),
            ratios: (!is_flat).then(|| ratios(w.map(f64::from))),
            reciprocal: is_whole.then(|| (triangle.doubled_area as f64).reciprocal::<true>()),
        }
    }

    /// Returns the doubled area in 1/256 pixel, the sum of the edge functions at every pixel.
    #[inline(always)]
    pub(crate) fn area(&self) -> f64 {
        self.c[0] + self.c[1] + self.c[2]
    }

    /// RAS-2: returns the edge functions of a pixel. They are exact in both ways.
    #[inline(always)]
    pub(crate) fn edges<const FMA: bool>(&self, x: f64, y: f64) -> [f64; 3] {
        let sum = |a: f64, b: f64, c: f64| if FMA { a.mul_add(b, c) } else { a * b + c };
        let edge = |k: usize| sum(self.a[k], x, sum(self.b[k], y, self.c[k]));
        [edge(0), edge(1), edge(2)]
    }
}
