//! TEX-17 on rows: the taps of each pixel, in pairs on both sides of it.
#![allow(clippy::float_arithmetic, reason = "whole numbers that doubles hold, and quotients of them that are floored")]

use super::pairs::{MAX_PAIRS, Pair, PairsOfQuad};
use super::quads::{AtQuads, Measure, Quads};
use crate::engine::rows::lanes::{STEP, larger, nearest};
use crate::texture::anisotropy;
use crate::texture::lod::Quad;
use crate::texture::planned::PlannedUnit;

/// Sets the taps of the lanes of a block to those of their quads.
#[inline(always)]
pub(crate) fn spread(quads: &Quads, known: &[PairsOfQuad], pairs: &mut [Pair]) {
    quads.each_lane(|lane, quad| {
        let quad = &known[quad];
        for (n, pair) in pairs.iter_mut().enumerate().take(MAX_PAIRS) {
            pair.weights[lane] = quad.weights[n] as u16;
            (pair.offsets[0][lane], pair.offsets[1][lane]) = (quad.offsets[n][0], quad.offsets[n][1]);
        }
    });
}

/// If pixels of a quad are further apart, in 1/65536 texel, its taps are computed in integers. Below that, quotients in double precision
/// are never rounded up to an integer.
const FARTHEST: f64 = (1 << 24) as f64;

impl Measure for PairsOfQuad {
    #[inline(always)]
    fn measure(unit: &PlannedUnit, at: &AtQuads, out: &mut [PairsOfQuad], open: &mut [u64]) {
        let limit = f64::from(unit.state.anisotropy);
        for (step, (out, open)) in out.as_chunks_mut::<STEP>().0.iter_mut().zip(open.chunks_mut(STEP)).enumerate() {
            let lanes = step * STEP..(step + 1) * STEP;
            let mut deltas = [[0.0; STEP]; 4];
            for n in 0..4 {
                let (from, to) = (&at[0][n % 2][lanes.clone()], &at[1 + n / 2][n % 2][lanes.clone()]);
                for k in 0..STEP {
                    deltas[n][k] = to[k] - from[k];
                    open[k] |= (FARTHEST - deltas[n][k].abs()).to_bits();
                }
            }
            pairs_of_near(&deltas, limit, out);
        }
    }

    fn of_quad(unit: &PlannedUnit, quad: Option<Quad>) -> PairsOfQuad {
        PairsOfQuad::new(quad, unit.state.anisotropy)
    }
}

/// Computes [`anisotropy::taps`] for quads whose pixels are that close. `deltas` has u and v to the right pixel, then u and v to the lower
/// one.
#[inline(always)]
fn pairs_of_near(deltas: &[[f64; STEP]; 4], limit: f64, out: &mut [PairsOfQuad; STEP]) {
    let least = f64::from(anisotropy::TEXEL);
    // Not functions, which closures would call for each lane.
    let (floor, ceiling) = (|n: f64| n.floor(), |n: f64| n.ceil());
    let [mut u, mut v, mut long, mut step, mut pairs, mut inner] = [[0.0; STEP]; 6];
    for n in 0..STEP {
        let [a, b, c, d] = [deltas[0][n], deltas[1][n], deltas[2][n], deltas[3][n]];
        let (right, lower) = (floor((a * a + b * b).sqrt()), floor((c * c + d * d).sqrt()));
        let is_right = right >= lower;
        (u[n], v[n]) = if is_right { (a, b) } else { (c, d) };
        let short = if is_right { lower } else { right };
        long[n] = if is_right { right } else { lower };
        let width = larger(larger(short, ceiling(long[n] / limit)), least);
        pairs[n] = if long[n] <= width { 0.0 } else { ceiling(long[n] / (2.0 * width)) };
        step[n] = if pairs[n] == 1.0 { long[n] - width } else { width };
        inner[n] = floor((floor(512.0 * width / long[n]) + 1.0) * 0.5);
    }
    for pair in 0..MAX_PAIRS.min(limit as usize / 2) {
        let (mut offsets, mut weights) = ([[0; STEP]; 2], [0; STEP]);
        for n in 0..STEP {
            let (reach, divisor) = ((2 * pair + 1) as f64 * step[n], 512.0 * long[n]);
            let (is_tap, is_last) = ((pair as f64) < pairs[n], (pair + 1) as f64 == pairs[n]);
            let most = floor(128.0 / larger(pairs[n] - 1.0, 1.0));
            let inner = if inner[n] < most { inner[n] } else { most };
            let weight = if is_last { 128.0 - (pairs[n] - 1.0) * inner } else { inner };
            let single = if (pair == 0) & (pairs[n] == 0.0) { 128.0 } else { 0.0 };
            weights[n] = nearest(if is_tap { weight } else { single });
            let offset = |n: f64| nearest(if is_tap { (n * reach / divisor).trunc() } else { 0.0 });
            (offsets[0][n], offsets[1][n]) = (offset(u[n]), offset(v[n]));
        }
        for n in 0..STEP {
            out[n].offsets[pair] = [offsets[0][n], offsets[1][n]];
            out[n].weights[pair] = weights[n];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Taps in double precision against whole numbers: lengths of all magnitudes, squares and what is hardly less, whole quotients.
    #[test]
    fn doubles_hold_what_whole_numbers_say() {
        let mut random = crate::random::Random::seeded(0x6a09_e667_f3bc_c908);
        let mut several = 0;
        for round in 0..40_000 {
            let limit = 2 << (round % 3);
            let mut deltas = [[0_i64; STEP]; 4];
            for n in 0..STEP {
                let bits = 14 + random.bits() % 11;
                for delta in &mut deltas {
                    delta[n] = (random.bits() % (2 << bits)) as i64 - (1 << bits);
                }
                // A length that is whole, and which a multiple of a texel or of the other one divides.
                match n % 4 {
                    0 => (deltas[0][n], deltas[2][n]) = (0, (random.bits() % (1 << (bits - 4))) as i64),
                    1 => (deltas[0][n], deltas[1][n], deltas[2][n]) = (0, deltas[3][n] / 8 * 3, deltas[3][n] / 8),
                    2 => (deltas[0][n], deltas[1][n]) = (65_536 * (random.bits() % 256) as i64, 0),
                    _ => {}
                }
            }
            let mut got = [PairsOfQuad::default(); STEP];
            let reals = deltas.map(|delta| delta.map(|n| n as f64));
            pairs_of_near(&reals, f64::from(limit), &mut got);
            for n in 0..STEP {
                let quad = [[0, 0], [deltas[0][n], deltas[1][n]], [deltas[2][n], deltas[3][n]]];
                assert_eq!(got[n], PairsOfQuad::new(Some(quad), limit), "{quad:?}, {limit}");
                several += usize::from(got[n].offsets[0] != [0, 0]);
            }
        }
        assert!(several > 300_000, "{several}");
    }
}
