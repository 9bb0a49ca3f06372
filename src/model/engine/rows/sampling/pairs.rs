//! TEX-17 on rows: taps in pairs on both sides of a pixel.

use crate::engine::rows::lanes::PerLane;
use crate::texture::anisotropy;

/// Largest number of pairs of taps of a footprint.
pub(crate) const MAX_PAIRS: usize = anisotropy::MAX_TAPS / 2;

/// The taps of a quad's footprint, in pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PairsOfQuad {
    /// Offsets and weights as in [`Pair`].
    pub(crate) offsets: [[i32; 2]; MAX_PAIRS],
    pub(crate) weights: [i32; MAX_PAIRS],
}

impl PairsOfQuad {
    /// Converts the definition's taps, for a level with these sides.
    pub(crate) fn from_taps(taps: &anisotropy::Taps<i64, i32>, sides: [u32; 2]) -> PairsOfQuad {
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
pub(crate) struct Pair {
    /// Offset of one tap from u and v, 1/256 texel. The other one lies on the opposite side.
    pub(crate) offsets: [PerLane<i32>; 2],
    /// Weight of each tap, of 256; 0 for none.
    pub(crate) weights: PerLane<u16>,
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
