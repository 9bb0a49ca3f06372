//! A triangle as loops over lanes take it.
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly")]

use crate::raster::setup::{Triangle, significant};
use crate::raster::weights::Number;
use crate::state::Profile;

/// RAS-2 and WGT-1: the numbers of a triangle from which the weights at its pixels follow. Edge functions have at most 39 bits.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Shape {
    /// Changes of the edge functions from column to column, and from row to row, and their values at pixel (0, 0).
    pub(super) a: [f64; 3],
    pub(super) b: [f64; 3],
    pub(super) c: [f64; 3],
    /// What is taken off the edge functions where they are compared with 0 (RAS-3): 1 for edges that belong to the other triangle.
    pub(super) owed: [f64; 3],
    /// Ratios of the w of the vertices, if these differ.
    pub(super) ratios: Option<[f64; 3]>,
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
        let [w0, w1, w2] = [f64::from(w[0]), f64::from(w[1]), f64::from(w[2])];
        let real = |n: [i64; 3]| [n[0] as f64, n[1] as f64, n[2] as f64];
        let owed = |k: usize| if triangle.owns[k] { 0.0 } else { 1.0 };
        // The last bit that any of them has.
        let all = (0..3).fold(0, |all, k| all | triangle.a[k] | triangle.b[k] | triangle.c[k]);
        let largest = (0..3).fold(0, |largest: i64, k| largest.max(triangle.a[k].abs() + triangle.b[k].abs()));
        let reach = triangle.doubled_area + if around { 2 * largest } else { 0 };
        let is_whole = reach < 1 << (24 + all.trailing_zeros().min(30));
        Shape {
            a: real(triangle.a),
            b: real(triangle.b),
            c: real(triangle.c),
            owed: [owed(0), owed(1), owed(2)],
            // The quotient of numbers of 24 bits is no nearer to one of 24 bits than a double can tell.
            ratios: (!is_flat).then(|| [(w1 / w0).cut(), 1.0, (w1 / w2).cut()]),
            reciprocal: is_whole.then(|| (triangle.doubled_area as f64).reciprocal()),
        }
    }

    /// RAS-2: returns the edge functions of a pixel.
    #[inline(always)]
    pub(crate) fn edges(&self, x: f64, y: f64) -> [f64; 3] {
        let edge = |k: usize| self.a[k] * x + (self.b[k] * y + self.c[k]);
        [edge(0), edge(1), edge(2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::raster::weights::ratio;

    #[test]
    fn ratios_are_those_of_the_definition() {
        let mut random = Random::seeded(16);
        let mut triangle = Triangle::default();
        assert!(triangle.place([0, 160, 0], [0, 0, 160]));
        for round in 0..100_000 {
            let mut w = || f32::from_bits((107 + (random.bits() % 40) as u32) << 23 | (random.bits() >> 41) as u32);
            let w = [w(), w(), w()];
            let shape = Shape::new(&triangle, w, (true, Profile::Nv2a), round % 2 == 0);
            let wanted = [0, 2].map(|k| {
                let ratio = ratio(w[1], w[k]);
                ratio.mantissa as f64 * 2_f64.powi(ratio.exponent)
            });
            assert_eq!(shape.ratios.map(|r| [r[0], r[2]]), Some(wanted), "{w:?}");
        }
    }
}
