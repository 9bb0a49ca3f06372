//! TEX-17 on rows: the taps of each pixel, in pairs on both sides of it.
#![allow(clippy::float_arithmetic, reason = "whole numbers that doubles hold, and quotients of them that are floored")]

use super::Sampler;
use super::kernels::{PerLane, STEP};
use super::quads::{AtQuads, Known, Measure, Quads};
use super::quotient::{cut, floor, larger, nearest};
use super::setup::{BatchSetup, PixelBatch, Planes, Setup};
use crate::texture::anisotropy;
use crate::texture::lod::Quad;
use crate::texture::planned::PlannedUnit;

/// Largest number of pairs of taps of a footprint.
const MAX_PAIRS: usize = anisotropy::MAX_TAPS / 2;

/// The taps of a quad's footprint, in pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PairsOfQuad {
    /// Offsets and weights as in [`Pair`].
    offsets: [[i32; 2]; MAX_PAIRS],
    weights: [i32; MAX_PAIRS],
}

impl PairsOfQuad {
    /// Converts the definition's taps, for a level with these sides.
    fn from_taps(taps: &anisotropy::Taps<i64, i32>, sides: [u32; 2]) -> PairsOfQuad {
        // A single tap counts as two halves in the same place.
        let weight = |n: usize| match taps.count {
            1 => {
                if n == 0 {
                    128
                } else {
                    0
                }
            }
            _ => taps.weights[2 * n],
        };
        let pairs = [0, 1, 2, 3];
        PairsOfQuad {
            offsets: pairs.map(|n: usize| [0, 1].map(|axis: usize| near(taps.offsets[2 * n][axis], sides[axis]))),
            weights: pairs.map(weight),
        }
    }
}

/// A pair of taps for each lane of a block. Both have the same distance from the pixel.
#[derive(Clone, Debug, Default)]
pub(super) struct Pair {
    /// Offset of one tap from u and v, 1/256 texel. The other one lies on the opposite side.
    pub(super) offsets: [PerLane<i32>; 2],
    /// Weight of each tap, of 256; 0 for none.
    pub(super) weights: PerLane<u16>,
}

/// The taps of the lanes of a block.
#[derive(Clone, Debug, Default)]
pub(super) struct Footprints {
    /// The pairs, as many as the unit can have.
    pub(super) pairs: Vec<Pair>,
    known: Known<PairsOfQuad>,
}

impl Footprints {
    /// Makes room for a sampler.
    pub(super) fn begin(&mut self, sampler: &Sampler) {
        self.pairs.resize(sampler.pairs, Pair::default());
    }

    /// Sets the taps of a lane.
    #[inline(always)]
    pub(super) fn set(pairs: &mut [Pair], lane: usize, quad: &PairsOfQuad) {
        for (n, pair) in pairs.iter_mut().enumerate().take(MAX_PAIRS) {
            pair.weights[lane] = quad.weights[n] as u16;
            (pair.offsets[0][lane], pair.offsets[1][lane]) = (quad.offsets[n][0], quad.offsets[n][1]);
        }
    }
}

/// An upper bound of coordinates, 1/256 texel.
const BEYOND_COORDINATES: u64 = 1 << 27;

/// Returns an equivalent offset in 32 bits. An offset beyond all coordinates lies outside the image, so that only its remainder by the
/// image and its mirror image counts.
#[inline(always)]
fn near(offset: i64, side: u32) -> i32 {
    let magnitude = offset.unsigned_abs();
    if magnitude < BEYOND_COORDINATES {
        return offset as i32;
    }
    offset.signum() as i32 * (BEYOND_COORDINATES + (magnitude - BEYOND_COORDINATES) % (512 * u64::from(side))) as i32
}

/// If pixels of a quad are further apart, in 1/65536 texel, its taps are computed in integers. Below that, quotients in double precision
/// are never rounded up to an integer.
const FARTHEST: f64 = (1 << 24) as f64;

impl Measure for PairsOfQuad {
    fn behind(unit: &PlannedUnit) -> PairsOfQuad {
        PairsOfQuad::defined(unit, None)
    }

    #[inline(always)]
    fn measure<const WIDE: bool>(
        unit: &PlannedUnit,
        at: &AtQuads,
        count: usize,
        out: &mut [PairsOfQuad],
        unknown: &mut [u64],
    ) {
        let limit = f64::from(unit.state.anisotropy);
        for (step, out) in out.as_chunks_mut::<STEP>().0.iter_mut().enumerate() {
            let lanes = step * STEP..(step + 1) * STEP;
            let mut deltas = [[0.0; STEP]; 4];
            let mut far = 0;
            for n in 0..4 {
                let (from, to) = (&at[0][n % 2][lanes.clone()], &at[1 + n / 2][n % 2][lanes.clone()]);
                for k in 0..STEP {
                    deltas[n][k] = to[k] - from[k];
                    far |= (FARTHEST - deltas[n][k].abs()).to_bits();
                }
            }
            pairs_of_near::<WIDE>(&deltas, limit, out);
            if far >> 63 == 0 {
                continue;
            }
            let is_far =
                |n: usize| !(0..4).all(|delta: usize| deltas[delta][n] <= FARTHEST && deltas[delta][n] >= -FARTHEST);
            for n in (0..STEP).filter(|n| lanes.start + n < count && unknown[lanes.start + n] >> 63 == 0 && is_far(*n))
            {
                // Integers below 2^53.
                let quad =
                    [0, 1, 2].map(|pixel: usize| [0, 1].map(|axis: usize| at[pixel][axis][lanes.start + n] as i64));
                out[n] = PairsOfQuad::defined(unit, Some(quad));
            }
        }
    }

    fn defined(unit: &PlannedUnit, quad: Option<Quad>) -> PairsOfQuad {
        let taps = anisotropy::taps(quad, unit.state.anisotropy);
        PairsOfQuad::from_taps(&taps, [unit.levels[0].width, unit.levels[0].height])
    }
}

/// Computes [`anisotropy::taps`] for quads whose pixels are that close. `deltas` has u and v to the right pixel, then u and v to the lower
/// one.
#[inline(always)]
fn pairs_of_near<const WIDE: bool>(deltas: &[[f64; STEP]; 4], limit: f64, out: &mut [PairsOfQuad; STEP]) {
    let least = f64::from(anisotropy::TEXEL);
    let floor = floor::<WIDE>;
    let ceiling = |n: f64| -floor(-n);
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
            let offset = |n: f64| nearest(if is_tap { cut::<WIDE>(n * reach / divisor) } else { 0.0 });
            (offsets[0][n], offsets[1][n]) = (offset(u[n]), offset(v[n]));
        }
        for n in 0..STEP {
            out[n].offsets[pair] = [offsets[0][n], offsets[1][n]];
            out[n].weights[pair] = weights[n];
        }
    }
}

/// [`taps`], compiled for an instruction set.
pub(super) type FindTaps =
    fn(&Setup<'_>, PixelBatch<'_>, (&Sampler, &Planes), &BatchSetup, &mut Quads, &mut Footprints);

/// Computes the taps of a batch.
#[inline(always)]
pub(super) fn taps<const FMA: bool>(
    setup: &Setup<'_>,
    batch: PixelBatch<'_>,
    (sampler, planes): (&Sampler, &Planes),
    local: &BatchSetup,
    quads: &mut Quads,
    footprints: &mut Footprints,
) {
    let unit = &setup.context.draw.units[sampler.index];
    let Footprints { pairs, known } = footprints;
    let Some(base) = setup.base_level::<FMA>(batch, (sampler, planes), local) else {
        for n in 0..batch.count {
            let quad = setup.defined_quad::<PairsOfQuad>(batch, unit, batch.pixel(n));
            Footprints::set(pairs, batch.lane + n, &quad);
        }
        return;
    };
    let spread = setup.of_quads::<FMA, PairsOfQuad>(batch, (unit, &base), &local.e, quads, known);
    spread.each(quads, batch.count, |n, quad| Footprints::set(pairs, batch.lane + n, &known.each[quad]));
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
            if round % 2 == 0 {
                pairs_of_near::<true>(&reals, f64::from(limit), &mut got);
            } else {
                pairs_of_near::<false>(&reals, f64::from(limit), &mut got);
            }
            for n in 0..STEP {
                let quad = [[0, 0], [deltas[0][n], deltas[1][n]], [deltas[2][n], deltas[3][n]]];
                let taps = anisotropy::taps(Some(quad), limit);
                assert_eq!(got[n], PairsOfQuad::from_taps(&taps, [256; 2]), "{quad:?}, {limit}");
                several += usize::from(taps.count > 1);
            }
        }
        assert!(several > 300_000, "{several}");
    }
}
