//! Where the lanes of a block sample a texture.
#![allow(clippy::float_arithmetic, reason = "whole numbers that doubles hold")]

use super::levels::MipFetches;
use super::pairs::Pair;
use super::sampler::Sampler;
use crate::engine::rows::lanes::{PerLane, limited};
use crate::texture::other_kind::{ZERO_VECTOR, on_face, on_plane};
use std::ops::Range;

/// Largest magnitude of a coordinate in 1/65536 texel from which levels of detail follow. Beyond it nothing is told apart (TEX-11).
pub(crate) const FARTHEST: f64 = (1_u64 << 60) as f64;

/// Where the lanes of a block sample a texture.
#[derive(Clone, Debug, Default)]
pub(crate) struct Place {
    /// u and v in 1/256 texel, less half a texel if the unit filters a single level.
    pub(crate) at: [PerLane<i32>; 2],
    /// Faces of a cube map, or layers of a volume.
    pub(crate) images: PerLane<u32>,
    /// Words that depths are compared with.
    pub(crate) references: PerLane<u32>,
    /// u and v on level 0 in 1/65536 texel, whole numbers, if levels or taps follow from them.
    pub(crate) fine: [PerLane<f64>; 2],
    /// q, or the components of a direction, if levels or taps follow from coordinates that are divided.
    pub(crate) direction: [PerLane<f64>; 3],
    /// What is read of a texture with levels.
    pub(crate) reads: MipFetches,
    /// The taps of the pixels, as many pairs as the unit can have.
    pub(crate) pairs: Vec<Pair>,
}

impl Place {
    /// Begins a draw.
    pub(crate) fn begin(&mut self, sampler: &Sampler) {
        self.pairs.resize(sampler.pairs, Pair::default());
        // Lanes without a pixel are fetched too. Layers that an earlier volume left in them may lie beyond the images of this texture.
        if sampler.has_images() {
            self.images.fill(0);
        }
    }

    /// Sets u and v in 1/256 texel from those in 1/65536.
    #[inline(always)]
    pub(crate) fn settle(&mut self, lanes: Range<usize>, bias: i32) {
        for (fine, at) in self.fine.iter().zip(&mut self.at) {
            let (fine, at) = (&fine[lanes.clone()], &mut at[lanes.clone()]);
            for n in 0..at.len() {
                at[n] = limited(fine[n] * (1.0 / 256.0)) - bias;
            }
        }
    }
}

/// TEX-20: takes u and v of a sampler, without a bias, from a two-dimensional image to a face, or from a face to a two-dimensional image.
/// `is_zero` says whether a lane's direction is the zero vector.
#[inline(always)]
pub(crate) fn change_kind(
    at: &mut [PerLane<i32>; 2],
    sampler: &Sampler,
    lanes: Range<usize>,
    is_zero: impl Fn(usize) -> bool,
) {
    let (bias, longest) = (sampler.bias(), sampler.side_of_face() / 2);
    for (axis, at) in at.iter_mut().enumerate() {
        let side = sampler.sides[axis];
        for n in lanes.clone() {
            let u = if !sampler.direction {
                on_face(at[n], side as i32, 8)
            } else if is_zero(n) {
                ZERO_VECTOR[axis] as i32
            } else {
                on_plane(at[n], longest as i32, 8) >> (longest.ilog2() - side.ilog2())
            };
            at[n] = u - bias;
        }
    }
}
