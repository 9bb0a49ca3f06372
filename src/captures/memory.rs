//! Surfaces as the memory that they are, and as captured pictures show them.

use super::images::{each_texel, swizzled};
use ninebit::frame::Surface;
use ninebit::state::{SurfaceFormat, Texture, TextureImage};

/// Converts an R5G6B5 word as the captured pictures do, by their own factors: 255/31, and 97/24 for G.
pub(super) fn shown_as_565(word: u32) -> [u8; 4] {
    let channel = |n: u32, factor: [u32; 2]| (n * factor[0] / factor[1]) as u8;
    [channel(word >> 11, [255, 31]), channel(word >> 5 & 63, [97, 24]), channel(word & 31, [255, 31]), 255]
}

/// Puts the beginning of a surface's memory, which may be swizzled, into a texture of 32-bit texels.
pub(super) fn put_memory(surface: &Surface, is_swizzled: bool, texture: &mut Texture) {
    let TextureImage::Texels(texels) = &mut texture.image else { return };
    let (bytes, bits) = (surface.format.bytes() as usize, [surface.width, surface.height].map(u32::ilog2));
    let mut words = surface.words.clone();
    if is_swizzled {
        for (at, (x, y)) in each_texel([surface.width, surface.height]).enumerate() {
            words[swizzled([x, y], bits)] = surface.words[at];
        }
    }
    let memory: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes().into_iter().take(bytes)).collect();
    let words = memory.as_chunks().0.iter().map(|four| u32::from_le_bytes(*four));
    let rest = texels.words.iter().skip(words.len()).copied();
    texels.words = words.take(texels.words.len()).chain(rest).collect();
}

/// Reads the beginning of each row of 32-bit words as words of a narrower format, as many in a row.
pub(super) fn seen_as(words: &[u32], width: usize, format: SurfaceFormat) -> Vec<u32> {
    let bytes = format.bytes() as usize;
    let row = |row: &[u32]| {
        let memory: Vec<u8> = row.iter().flat_map(|word| word.to_le_bytes()).collect();
        let word = |bytes: &[u8]| bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte));
        memory.chunks(bytes).take(row.len()).map(word).collect::<Vec<_>>()
    };
    words.chunks(width).flat_map(row).collect()
}

/// Writes a narrower surface back into the beginning of each row of 32-bit words.
pub(super) fn put_back(surface: &Surface, words: &mut [u32]) {
    let (bytes, width) = (surface.format.bytes() as usize, surface.width as usize);
    for (narrow, row) in surface.words.chunks(width).zip(words.chunks_mut(width)) {
        let memory: Vec<u8> = narrow.iter().flat_map(|word| word.to_le_bytes().into_iter().take(bytes)).collect();
        for (word, four) in row.iter_mut().zip(memory.as_chunks::<4>().0) {
            *word = u32::from_le_bytes(*four);
        }
    }
}
