//! Textures with one word for each texel: palettes looked up, and blocks decoded to A8R8G8B8.

use std::borrow::Cow;

use super::compressed::decode;
use super::fetch::palette_entry;
use super::planned::PlannedUnit;
use crate::state::TextureFormat;

impl PlannedUnit {
    /// Returns whether texels have to be looked up or decoded.
    fn is_coded(&self) -> bool {
        self.format.is_compressed() || self.format == TextureFormat::P8
    }

    /// Returns the index of the first word of each level of a face or layer with one word for each texel, and the number of words of a face or layer.
    pub fn texel_layout(&self) -> (Vec<usize>, usize) {
        if !self.format.is_compressed() {
            return (self.levels.iter().map(|level| level.offset).collect(), self.face_words);
        }
        let mut end = 0;
        let mut first = |size: usize| {
            end += size;
            end - size
        };
        let offsets = self.levels.iter().map(|level| first(level.width as usize * level.height as usize)).collect();
        (offsets, end)
    }

    /// Returns the words of an image with one word for each texel.
    pub fn texel_words<'w>(&self, words: &'w [u32]) -> Cow<'w, [u32]> {
        if !self.is_coded() {
            return Cow::Borrowed(words);
        }
        if self.format == TextureFormat::P8 {
            return words.iter().map(|index| palette_entry(self, *index)).collect();
        }
        let mut texels = Vec::new();
        let block = self.format.bytes() as usize / 4;
        for face in words.chunks_exact(self.face_words) {
            for level in &self.levels {
                let across = level.width.div_ceil(4);
                for (y, x) in (0..level.height).flat_map(|y| (0..level.width).map(move |x| (y, x))) {
                    let at = level.offset + block * (across * (y / 4) + x / 4) as usize;
                    let [r, g, b, a] = decode(self.format, self.dithered, &face[at..at + block], x, y).bytes;
                    texels.push(u32::from_be_bytes([a, r, g, b]));
                }
            }
        }
        texels.into()
    }
}
