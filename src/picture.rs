//! Surfaces as pictures: decoded to R, G, B, A bytes, and their digest.

use sha2::{Digest, Sha256};

use crate::frame::Surface;
use crate::rop::surface::show;

impl Surface {
    /// The surface as R, G, B, A, row by row from the top: the stored bits read by rule TEX-1 as
    /// [`texture_format`](crate::state::SurfaceFormat::texture_format) says.
    ///
    /// Bits that the format does not store come out as TEX-1 says: alpha 255 where there is none, blue in red for B8 and G8B8.
    pub fn rgba8(&self) -> Vec<[u8; 4]> {
        self.words.iter().map(|word| show(self.format, *word)).collect()
    }

    /// SHA-256, in lower-case hexadecimal, of width and height (four bytes each, little-endian) and the bytes of
    /// [`rgba8`](Self::rgba8).
    ///
    /// It names what the picture shows: not how it is stored, nor how a PNG of it is compressed.
    pub fn digest(&self) -> String {
        digest(self.width, self.height, &self.rgba8())
    }
}

/// The digest of a picture; see [`Surface::digest`].
pub fn digest(width: u32, height: u32, pixels: &[[u8; 4]]) -> String {
    let mut hash = Sha256::new();
    hash.update(width.to_le_bytes());
    hash.update(height.to_le_bytes());
    hash.update(pixels.as_flattened());
    hexadecimal(&hash.finalize())
}

/// Bytes as two digits each.
pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::SurfaceFormat;

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

    #[test]
    fn the_digest_tells_shapes_apart() {
        let pixels = vec![[1, 2, 3, 4]; 6];
        assert_ne!(digest(2, 3, &pixels), digest(3, 2, &pixels));
        // What sha256sum says of the twelve bytes 01 00 00 00, 01 00 00 00, 00 00 00 00.
        assert_eq!(digest(1, 1, &[[0; 4]]), "7d450465ceb49083708a6970827f0e0b116ed285072a95b451e55f583f56da8d");
    }
}
