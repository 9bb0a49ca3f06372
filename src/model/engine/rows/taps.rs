//! TEX-17 on rows: the taps of each pixel, two and two to both sides of it.

use super::Sampler;
use super::kernels::LANES;
use super::kernels::PerLane;
use super::quads::{AtQuads, Known, Measure, Quads};
use super::setup::{BatchSetup, PixelBatch, Planes, Setup};
use crate::texture::anisotropy;
use crate::texture::lod::Quad;
use crate::texture::planned::PlannedUnit;

/// The taps of a quad's footprint.
pub(super) type Taps = anisotropy::Taps<i64, i32>;

/// Two taps of the lanes of a block, at equal distances from them.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    /// Where one lies from u and v, 1/256 texel; the other lies as far to the other side.
    pub(super) offsets: [PerLane<i32>; 2],
    /// What either weighs, of 256; 0: nothing.
    pub(super) weights: PerLane<u16>,
}

/// The taps of the lanes of a block.
#[derive(Clone, Debug, Default)]
pub(super) struct Footprints {
    /// As many as the unit can have.
    pub(super) pairs: Vec<Pair>,
    known: Known<Taps>,
}

impl Footprints {
    /// Becomes that of a sampler.
    pub(super) fn begin(&mut self, sampler: &Sampler) {
        self.pairs.resize(sampler.pairs, Pair { offsets: [[0; LANES]; 2], weights: [0; LANES] });
    }

    /// The taps of a lane, on a level of so many texels.
    #[inline(always)]
    pub(super) fn set(pairs: &mut [Pair], lane: usize, taps: &Taps, sides: [u32; 2]) {
        for (n, pair) in pairs.iter_mut().enumerate() {
            // A single tap is two halves in the same place.
            let weight = if taps.count == 1 { if n == 0 { 128 } else { 0 } } else { taps.weights[2 * n] };
            pair.weights[lane] = weight as u16;
            for axis in 0..2 {
                pair.offsets[axis][lane] = near(taps.offsets[2 * n][axis], sides[axis]);
            }
        }
    }
}

/// More than a coordinate, 1/256 texel.
const BEYOND_COORDINATES: u64 = 1 << 27;

/// An offset that has the same effect, in 32 bits: what is further away than all coordinates lies beyond the image, and counts but for repeats of it and
/// of its mirror image.
#[inline(always)]
fn near(offset: i64, side: u32) -> i32 {
    let magnitude = offset.unsigned_abs();
    if magnitude < BEYOND_COORDINATES {
        return offset as i32;
    }
    offset.signum() as i32 * (BEYOND_COORDINATES + (magnitude - BEYOND_COORDINATES) % (512 * u64::from(side))) as i32
}

impl Measure for Taps {
    fn behind() -> Taps {
        anisotropy::taps(None, 1)
    }

    #[inline(always)]
    fn measure(unit: &PlannedUnit, at: &AtQuads, count: usize, out: &mut [Taps], unknown: &mut [u64]) {
        for n in (0..count).filter(|n| unknown[*n] >> 63 == 0) {
            // Whole numbers below 2^53.
            let quad = [0, 1, 2].map(|pixel: usize| [0, 1].map(|axis: usize| at[pixel][axis][n] as i64));
            out[n] = anisotropy::taps(Some(quad), unit.state.anisotropy);
        }
    }

    fn defined(unit: &PlannedUnit, quad: Option<Quad>) -> Taps {
        anisotropy::taps(quad, unit.state.anisotropy)
    }
}

impl Setup<'_> {
    /// The taps of a batch.
    #[inline(always)]
    pub(super) fn taps<const FMA: bool, const ROW: bool>(
        &self,
        batch: PixelBatch<'_>,
        (sampler, planes): (&Sampler, &Planes),
        local: &BatchSetup,
        quads: &mut Quads,
        footprints: &mut Footprints,
    ) {
        let unit = &self.context.draw.units[sampler.index];
        let sides = [unit.levels[0].width, unit.levels[0].height];
        let Footprints { pairs, known } = footprints;
        let Some(base) = self.base_level::<FMA, ROW>(sampler, planes, local) else {
            for n in 0..batch.count {
                let taps = self.defined_quad::<Taps>(batch, unit, batch.pixel(n));
                Footprints::set(pairs, batch.lane + n, &taps, sides);
            }
            return;
        };
        let spread = self.of_quads::<FMA, ROW, Taps>(batch, (unit, &base), &local.e, quads, known);
        for n in 0..batch.count {
            Footprints::set(pairs, batch.lane + n, &known.each[spread.quad(n)], sides);
        }
    }
}
