//! WGT-1 on lanes: the weights of a triangle's vertices at its pixels.
//!
//! ```text
//! for each lane:  e_k = cut_24(E_k), with unequal w cut_24(e_k r_k)
//! for each lane:  S = sum of e_k at 29 bits;  R = reciprocal of S      once a triangle where nothing is cut and w are equal
//! for each lane:  b_k = cut_24(e_k R);  the dominant one is the rest of the others
//! ```
//!
//! Each pass is a loop of its own: one long chain of dependent operations would fill the processor's queues.
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly")]

use super::shape::Shape;
use crate::engine::rows::lanes::PerLane;
use crate::raster::weights::{Number, edge_numbers, outer_weights, shares};
use std::ops::Range;

/// Number of lanes of which a pass is done before the next pass begins, so that what it hands on stays in the nearest cache.
pub(crate) const CHUNK: usize = 128;

/// What the passes hand on. Aligned, because vectors are stored and loaded.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Passes {
    /// The edge numbers e_k.
    pub(crate) edges: [[f64; CHUNK]; 3],
    /// Their sums S.
    sums: [f64; CHUNK],
    /// The reciprocals R.
    pub(crate) reciprocals: [f64; CHUNK],
}

impl Default for Passes {
    fn default() -> Self {
        Passes { edges: [[0.0; CHUNK]; 3], sums: [0.0; CHUNK], reciprocals: [0.0; CHUNK] }
    }
}

/// Columns of a block: the positions of its pixels, and their weights.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pixels {
    /// Column and row of each pixel.
    pub(crate) x: PerLane<f64>,
    pub(crate) y: PerLane<f64>,
    /// b_0 and b_2.
    pub(crate) b: [PerLane<f64>; 2],
    /// The reciprocals R. They are negative behind the viewer.
    pub(crate) reciprocals: PerLane<f64>,
    passes: Box<Passes>,
}

impl Pixels {
    /// Computes the weights of lanes, and keeps the reciprocals. `around` says that pixels beside the triangle count.
    #[inline(always)]
    pub(crate) fn weigh<const FMA: bool>(&mut self, shape: &Shape, lanes: Range<usize>, around: bool) {
        for first in lanes.clone().step_by(CHUNK) {
            let part = first..(first + CHUNK).min(lanes.end);
            let Pixels { x, y, b: [first, third], reciprocals, passes } = &mut *self;
            let (x, y) = (&x[part.clone()], &y[part.clone()]);
            let (first, third) = (&mut first[part.clone()], &mut third[part.clone()]);
            if around {
                passes.run::<FMA, false>(shape, shape.ratios, x, y);
                passes.weights::<false>(first, third);
            } else {
                passes.run::<FMA, true>(shape, shape.ratios, x, y);
                passes.weights::<true>(first, third);
            }
            let count = part.len();
            reciprocals[part].copy_from_slice(&passes.reciprocals[..count]);
        }
    }

    /// Writes the weights of a point's vertex: its edge functions are (0, 1, 0) everywhere.
    #[inline(always)]
    pub(crate) fn weigh_point(&mut self, lanes: Range<usize>) {
        for b in &mut self.b {
            b[lanes.clone()].fill(0.0);
        }
        self.reciprocals[lanes].fill(1.0);
    }

    /// Returns edge numbers and reciprocals of at most [`CHUNK`] lanes; those beside the triangle do not count. Not by calls of a function: compilers do not inline long closures, and what
    /// is not inlined lacks the caller's instruction set.
    #[inline(always)]
    pub(crate) fn part<const FMA: bool>(
        &mut self,
        shape: &Shape,
        ratios: Option<[f64; 3]>,
        lanes: Range<usize>,
    ) -> &Passes {
        self.passes.run::<FMA, true>(shape, ratios, &self.x[lanes.clone()], &self.y[lanes]);
        &self.passes
    }
}

impl Passes {
    /// Computes edge numbers and reciprocals of lanes at these columns and rows. `COVERED` as in [`weights`](Self::weights).
    #[inline(always)]
    fn run<const FMA: bool, const COVERED: bool>(
        &mut self,
        shape: &Shape,
        ratios: Option<[f64; 3]>,
        x: &[f64],
        y: &[f64],
    ) {
        let lanes = x.len();
        let Passes { edges: [e0, e1, e2], sums, reciprocals } = self;
        let (e0, e1, e2, y) = (&mut e0[..lanes], &mut e1[..lanes], &mut e2[..lanes], &y[..lanes]);
        let (sums, reciprocals, shape) = (&mut sums[..lanes], &mut reciprocals[..lanes], *shape);
        match (ratios, shape.reciprocal) {
            (None, Some(reciprocal)) => {
                for n in 0..lanes {
                    [e0[n], e1[n], e2[n]] = shape.edges::<FMA>(x[n], y[n]);
                }
                reciprocals.fill(reciprocal);
                return;
            }
            (None, None) => {
                for n in 0..lanes {
                    [e0[n], e1[n], e2[n]] = edge_numbers(shape.edges::<FMA>(x[n], y[n]), None);
                }
            }
            (Some(ratios), _) => {
                for n in 0..lanes {
                    [e0[n], e1[n], e2[n]] = edge_numbers(shape.edges::<FMA>(x[n], y[n]), Some(ratios));
                }
            }
        }
        for n in 0..lanes {
            sums[n] = f64::sum_of_edges::<COVERED>([e0[n], e1[n], e2[n]]);
        }
        for n in 0..lanes {
            reciprocals[n] = sums[n].reciprocal::<COVERED>();
        }
    }

    /// Completes b_0 and b_2. `COVERED` says that lanes without a pixel of the triangle do not count.
    #[inline(always)]
    fn weights<const COVERED: bool>(&self, first: &mut [f64], third: &mut [f64]) {
        let lanes = first.len();
        let Passes { edges: [e0, e1, e2], reciprocals, .. } = self;
        let (e0, e1, e2) = (&e0[..lanes], &e1[..lanes], &e2[..lanes]);
        let (reciprocals, third) = (&reciprocals[..lanes], &mut third[..lanes]);
        for n in 0..lanes {
            [first[n], third[n]] = outer_weights::<f64, COVERED>(shares([e0[n], e1[n], e2[n]], reciprocals[n]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::raster::binary::Binary;
    use crate::raster::setup::Triangle;
    use crate::raster::weights::{self, Weights};
    use crate::state::Profile;

    fn double(n: Binary) -> f64 {
        n.mantissa as f64 * 2_f64.powi(n.exponent as i32)
    }

    /// Triangles of all sizes, with one w and with several, inside and hardly outside.
    #[test]
    fn lanes_have_the_weights_of_the_definition() {
        let (mut random, mut pixels, mut triangle) = (Random::seeded(29), Pixels::default(), Triangle::default());
        for round in 0..3_000 {
            let size = 32 << (random.bits() % 12);
            let mut at = || random.below(size) as i64;
            if !triangle.place_corners([at(), at(), at()], [at(), at(), at()]) {
                continue;
            }
            let mut w = || 0.25 + (random.bits() >> 40) as f32 / (1 << 20) as f32;
            let w = if round % 3 == 0 { [w(); 3] } else { [w(), w(), w()] };
            let around = round % 2 == 0;
            let shape = Shape::new(&triangle, w, (true, Profile::Nv2a), around);
            let mut count = 0;
            for _ in 0..600 {
                let middle = |of: (i64, i64), bits: u64| of.0 + (bits % (of.1 - of.0 + 1).max(1) as u64) as i64;
                let (i, j) = (middle(triangle.columns, random.bits()), middle(triangle.rows, random.bits()));
                let near = |i: i64, j: i64| triangle.covers(triangle.edges(i, j));
                if count < 384 && (near(i, j) || around && (near(i - 1, j) || near(i, j - 1))) {
                    (pixels.x[count], pixels.y[count]) = (i as f64, j as f64);
                    count += 1;
                }
            }
            pixels.weigh::<false>(&shape, 0..count, around);
            let ratios = shape.ratios.is_some().then(|| weights::ratios(w.map(Binary::new)));
            for n in 0..count {
                let e = triangle.edges(pixels.x[n] as i64, pixels.y[n] as i64);
                let wanted = Weights::<Binary>::new(e.map(Binary::from_edge), ratios);
                let found = [pixels.b[0][n], pixels.b[1][n]];
                assert_eq!(found, [double(wanted.b[0]), double(wanted.b[2])], "{e:?} {w:?}");
            }
        }
    }
}
