//! The words of textures at the time of a draw: texels of their own, or the contents of a target.

use std::borrow::Cow;

use crate::plan::{Plan, PlannedDraw};
use crate::rop::surface;
use crate::state::{TEXTURE_UNITS, Texture, TextureImage};
use crate::texture::planned::Image;

use super::Surface;

/// The words of each texture of a plan at one time, in the order of the scene.
#[derive(Clone, Debug)]
pub struct TextureWords<'a>(Vec<Cow<'a, [u32]>>);

impl<'a> TextureWords<'a> {
    /// Returns the words of textures for some draws. A target that one of them reads in texels of another size is converted. Without
    /// surfaces, no draw may read a target.
    pub fn new(plan: &'a Plan, draws: &[PlannedDraw], surfaces: &'a [Surface]) -> TextureWords<'a> {
        TextureWords::from_surfaces(plan, draws, |target| surfaces.get(target).map(|s| (&s.words[..], &s.depth[..])))
    }

    /// Returns the words of textures. `surface` returns the words of a target and of its depth buffer, if there are any.
    pub fn from_surfaces(
        plan: &'a Plan,
        draws: &[PlannedDraw],
        surface: impl Fn(usize) -> Option<(&'a [u32], &'a [u32])>,
    ) -> TextureWords<'a> {
        let samples = |n: usize| draws.iter().flat_map(|draw| &draw.units).any(|unit| unit.state.texture == n);
        let words = |(n, texture): (usize, &'a Texture)| match &texture.image {
            TextureImage::Texels(texels) => Cow::Borrowed(&texels.words[..]),
            TextureImage::Depth { target } => Cow::Borrowed(surface(*target).map_or(&[][..], |(_, depth)| depth)),
            TextureImage::Target { target } => {
                let (pixel, words) =
                    (plan.targets[*target].format, surface(*target).map_or(&[][..], |(words, _)| words));
                let (pixel, texel) = (pixel.bytes(), texture.format.bytes());
                surface::texels(if pixel == texel || samples(n) { words } else { &[] }, pixel, texel)
            }
        };
        TextureWords(plan.textures.iter().enumerate().map(words).collect())
    }

    /// Returns the words of one texture.
    pub fn words(&self, texture: usize) -> &[u32] {
        &self.0[texture]
    }

    /// Returns the memories of a draw's four units, one word a texel, as printed functions read them. Units without a texture have none.
    pub fn memories<'w>(&'w self, draw: &PlannedDraw) -> [Cow<'w, [u32]>; TEXTURE_UNITS] {
        let mut memories = [0; TEXTURE_UNITS].map(|_| Cow::Borrowed(&[][..]));
        for unit in &draw.units {
            memories[unit.index] = unit.texel_words(self.words(unit.state.texture));
        }
        memories
    }

    /// Returns all words as images without the memory of a lane.
    pub fn images<L>(&self) -> Vec<Image<'_, L>> {
        self.0.iter().map(|words| Image { words, memory: None }).collect()
    }
}
