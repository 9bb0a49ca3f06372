//! What a render leaves behind: surfaces of stored words.

use crate::rop::surface::show;
use crate::state::{SurfaceFormat, depth_of, stencil_of};

/// A render target's memory after (or during) a render.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Surface {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Format of the words.
    pub format: SurfaceFormat,
    /// `width * height` stored pixels, row by row from the top; unused high bits zero.
    pub words: Vec<u32>,
    /// Stored depths in the same order, each with the stencil above it ([`depth_stencil`](crate::state::depth_stencil)); empty without a depth buffer.
    pub depth: Vec<u32>,
}

impl Surface {
    /// The stored depths, without stencils.
    pub fn depths(&self) -> impl Iterator<Item = u32> {
        self.depth.iter().copied().map(depth_of)
    }

    /// The stored stencils.
    pub fn stencils(&self) -> impl Iterator<Item = u8> {
        self.depth.iter().copied().map(stencil_of)
    }

    /// The words of depth and stencil as the chip has them: the stencil in the low byte. Of Z24S8.
    pub fn chip_depth_words(&self) -> impl Iterator<Item = u32> {
        self.depth.iter().map(|word| word.rotate_left(8))
    }

    /// The surface as R, G, B, A, row by row from the top: the stored bits read by rule TEX-1 as
    /// [`texture_format`](crate::state::SurfaceFormat::texture_format) says.
    ///
    /// Bits that the format does not store come out as TEX-1 says: alpha 255 where there is none, blue in red for B8 and G8B8.
    pub fn rgba8(&self) -> Vec<[u8; 4]> {
        self.words.iter().map(|word| show(self.format, *word)).collect()
    }
}

/// Every surface of a scene, in the order of [`Scene::targets`](crate::state::Scene::targets).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frames {
    /// A surface for each target, in the plan's order.
    pub surfaces: Vec<Surface>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(format: SurfaceFormat, word: u32) -> [u8; 4] {
        Surface { width: 1, height: 1, format, words: vec![word], depth: Vec::new() }.rgba8()[0]
    }

    #[test]
    fn every_format_reads_its_own_bits() {
        use SurfaceFormat::*;
        for (format, word, expected) in [
            (A8R8G8B8, 0x1234_5678, [0x34, 0x56, 0x78, 0x12]),
            (X8R8G8B8Z, 0x0034_5678, [0x34, 0x56, 0x78, 255]),
            (X8R8G8B8O, 0xff34_5678, [0x34, 0x56, 0x78, 255]),
            (X1A7R8G8B8Z, 0x7f00_0001, [0, 0, 1, 0x7f]),
            (R5G6B5, 0xf800, [255, 0, 0, 255]),
            (R5G6B5, (1 << 11) | (1 << 5) | 16, [8, 4, 132, 255]),
            (X1R5G5B5O, 0x8000 | (16 << 10) | (1 << 5) | 31, [132, 8, 255, 255]),
            (B8, 0x42, [0x42, 0x42, 0x42, 255]),
            (G8B8, 0x1242, [0x42, 0x12, 0x42, 0x12]),
        ] {
            assert_eq!(one(format, word), expected, "{format:?} {word:#x}");
        }
    }
}
