//! TEX-17 on rows: taps in pairs on both sides of a pixel.

use crate::engine::rows::lanes::PerLane;
use crate::texture::anisotropy;
pub(crate) use crate::texture::anisotropy::MAX_PAIRS;
use crate::texture::lod::Quad;

/// The taps of a quad's footprint, in pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PairsOfQuad {
    /// Offsets and weights as in [`Pair`].
    pub(crate) offsets: [[i32; 2]; MAX_PAIRS],
    pub(crate) weights: [i32; MAX_PAIRS],
}

impl PairsOfQuad {
    /// Returns the definition's pairs.
    pub(crate) fn new(quad: Option<Quad>, limit: u32) -> PairsOfQuad {
        let pairs = quad.map_or(anisotropy::Pairs::SINGLE, |quad| anisotropy::pairs(quad, limit.into()));
        let offsets = pairs.offsets.map(|offset| offset.map(|n| n as i32));
        PairsOfQuad { offsets, weights: pairs.weights.map(|weight| weight as i32) }
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
