//! The result of a render: surfaces of stored words.

use crate::rop::surface::show_all;
use crate::state::{SurfaceFormat, depth_of, stencil_of};

/// The memory of a render target after a render.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Surface {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Format of the words.
    pub format: SurfaceFormat,
    /// `width * height` stored pixels, row by row from the top. Unused high bits are zero.
    pub words: Vec<u32>,
    /// Stored depths in the same order, each with the stencil above it
    /// ([`depth_stencil`](crate::state::depth_stencil)). Empty without a depth buffer.
    pub depth: Vec<u32>,
}

impl Surface {
    /// Returns the stored depths without stencils.
    pub fn depths(&self) -> impl Iterator<Item = u32> {
        self.depth.iter().copied().map(depth_of)
    }

    /// Returns the stored stencils.
    pub fn stencils(&self) -> impl Iterator<Item = u8> {
        self.depth.iter().copied().map(stencil_of)
    }

    /// Returns the words of depth and stencil as the chip stores them for Z24S8, with the stencil in the low byte.
    pub fn chip_depth_words(&self) -> impl Iterator<Item = u32> {
        self.depth.iter().map(|word| word.rotate_left(8))
    }

    /// Returns the surface as R, G, B, A, row by row from the top. The stored bits are read by rule TEX-1 in the format
    /// [`texture_format`](crate::state::SurfaceFormat::texture_format).
    ///
    /// Channels that the format does not store follow TEX-1: alpha is 255 if there is none, and red equals blue for B8
    /// and G8B8.
    pub fn rgba8(&self) -> Vec<[u8; 4]> {
        self.rgba8_of(&self.words)
    }

    /// Returns words of the surface as [`rgba8`](Self::rgba8) does.
    pub fn rgba8_of(&self, words: &[u32]) -> Vec<[u8; 4]> {
        show_all(self.format, words)
    }
}

/// The surfaces of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frames {
    /// One surface for each of [`Scene::targets`](crate::state::Scene::targets), in the same order.
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
