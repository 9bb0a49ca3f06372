//! ROP-5, ROP-6: how surface formats store colours, and what blending reads back.

use std::borrow::Cow;

use crate::number::Word;
use crate::state::{SurfaceFormat, TextureFormat};
use crate::texture::format;

/// Returns the number of low bits of R, G and B that the surface drops, both from the source before blending and in the
/// store.
#[inline]
pub(crate) fn dropped_bits(format: SurfaceFormat) -> [u32; 3] {
    match format {
        SurfaceFormat::R5G6B5 => [3, 2, 3],
        SurfaceFormat::X1R5G5B5Z | SurfaceFormat::X1R5G5B5O => [3, 3, 3],
        SurfaceFormat::A8R8G8B8
        | SurfaceFormat::X8R8G8B8Z
        | SurfaceFormat::X8R8G8B8O
        | SurfaceFormat::X1A7R8G8B8Z
        | SurfaceFormat::X1A7R8G8B8O
        | SurfaceFormat::B8
        | SurfaceFormat::G8B8 => [0; 3],
    }
}

/// Returns bytes of which the surface keeps the values that are nearest to R, G and B, as renderers do that do not cut.
pub(crate) fn rounded(format: SurfaceFormat, bytes: [u8; 4]) -> [u8; 4] {
    let mut rounded = bytes;
    for (byte, dropped) in rounded.iter_mut().zip(dropped_bits(format)) {
        let most = 255 >> dropped;
        *byte = (((u32::from(*byte) * most + 127) / 255) << dropped) as u8;
    }
    rounded
}

/// Returns whether the surface stores alpha.
fn stores_alpha(format: SurfaceFormat) -> bool {
    matches!(format, SurfaceFormat::A8R8G8B8 | SurfaceFormat::X1A7R8G8B8Z | SurfaceFormat::X1A7R8G8B8O)
}

/// Returns the channels that the surface keeps, as bits R, G, B, A. Unused bits are not a channel.
pub fn kept_channels(format: SurfaceFormat) -> u8 {
    let bits = channel_bits(format);
    let kept = |n: usize| if n == 3 { stores_alpha(format) } else { bits[n] != 0 };
    (0..4).filter(|n| kept(*n)).map(|n| 1 << n).sum()
}

/// Returns the channels that the texture format of the same bits reads exactly as they are kept, as bits R, G, B, A.
/// Seven bits of alpha beside an unused bit, and values of missing channels, are not included.
pub fn sampled_channels(format: SurfaceFormat) -> u8 {
    kept_channels(format) & if dropped_alpha_bits(format) == 0 { 15 } else { 7 }
}

fn dropped_alpha_bits(format: SurfaceFormat) -> u32 {
    u32::from(matches!(format, SurfaceFormat::X1A7R8G8B8Z | SurfaceFormat::X1A7R8G8B8O))
}

/// Returns the final channels of a pixel: those that a picture shows, except for an alpha of seven bits, which is read
/// as blending does because a picture shows the unused bit with it.
pub fn final_channels(format: SurfaceFormat, word: u32) -> [u8; 4] {
    let (shown, read) = (show(format, word), read(format, word));
    std::array::from_fn(|n| if sampled_channels(format) >> n & 1 != 0 { shown[n] } else { read[n] })
}

/// Returns the number of texels of `texel` bytes in a row of `width` pixels of `pixel` bytes, or `None` if the row does
/// not end at the end of a texel.
pub fn texel_columns(width: u32, pixel: u32, texel: u32) -> Option<u32> {
    let bytes = u64::from(width) * u64::from(pixel);
    let columns = u32::try_from(bytes / u64::from(texel)).ok()?;
    bytes.is_multiple_of(u64::from(texel)).then_some(columns)
}

/// Converts pixels of `pixel` bytes to texels of `texel` bytes: the same memory, lowest byte first. Both sizes are one,
/// two or four bytes.
pub fn texels(words: &[u32], pixel: u32, texel: u32) -> Cow<'_, [u32]> {
    if pixel == texel {
        return Cow::Borrowed(words);
    }
    // Sizes are powers of two.
    if pixel > texel {
        let part = |word: &u32, n: u32| *word >> (8 * texel * n) & (u32::MAX >> (32 - 8 * texel));
        return words.iter().flat_map(|word| (0..pixel / texel).map(move |n| part(word, n))).collect();
    }
    let whole = |words: &[u32]| words.iter().rev().fold(0, |whole, word| whole << (8 * pixel) | word);
    words.chunks((texel / pixel) as usize).map(whole).collect()
}

/// Returns whether the format can be blended.
pub fn blends(format: SurfaceFormat) -> bool {
    !matches!(format, SurfaceFormat::B8 | SurfaceFormat::G8B8)
}

/// Returns the destination's R, G, B, A, each 0 to 255, as blending reads them: low bits are zero, and alpha is 255 if
/// none is stored.
#[inline(always)]
pub fn channels<W: Word>(format: SurfaceFormat, word: W) -> [W; 4] {
    let [none, all] = [0, 255].map(W::from);
    let bits = |shift: u32, mask: u32| word >> shift & W::from(mask);
    let byte = |shift: u32| bits(shift, 255);
    let five = |shift: u32| bits(shift, 31) << 3;
    match format {
        SurfaceFormat::A8R8G8B8 => [byte(16), byte(8), byte(0), byte(24)],
        SurfaceFormat::X8R8G8B8Z | SurfaceFormat::X8R8G8B8O => [byte(16), byte(8), byte(0), all],
        SurfaceFormat::X1A7R8G8B8Z | SurfaceFormat::X1A7R8G8B8O => {
            let a = bits(24, 127);
            [byte(16), byte(8), byte(0), a << 1 | a >> 6]
        }
        SurfaceFormat::R5G6B5 => [five(11), bits(5, 63) << 2, five(0), all],
        SurfaceFormat::X1R5G5B5Z | SurfaceFormat::X1R5G5B5O => [five(10), five(5), five(0), all],
        SurfaceFormat::B8 => [none, none, byte(0), all],
        SurfaceFormat::G8B8 => [none, byte(8), byte(0), all],
    }
}

/// Returns [`channels`] as bytes.
#[inline]
pub fn read(format: SurfaceFormat, word: u32) -> [u8; 4] {
    channels(format, word).map(|channel| channel as u8)
}

/// Returns the bits of a stored word that belong to R, G, B and A. Unused bits belong to alpha, with which they are
/// written.
#[inline]
pub fn channel_bits(format: SurfaceFormat) -> [u32; 4] {
    match format {
        SurfaceFormat::A8R8G8B8
        | SurfaceFormat::X8R8G8B8Z
        | SurfaceFormat::X8R8G8B8O
        | SurfaceFormat::X1A7R8G8B8Z
        | SurfaceFormat::X1A7R8G8B8O => [0x00ff_0000, 0x0000_ff00, 0x0000_00ff, 0xff00_0000],
        SurfaceFormat::R5G6B5 => [0xf800, 0x07e0, 0x001f, 0],
        SurfaceFormat::X1R5G5B5Z | SurfaceFormat::X1R5G5B5O => [0x7c00, 0x03e0, 0x001f, 0x8000],
        SurfaceFormat::B8 => [0, 0, 0xff, 0],
        SurfaceFormat::G8B8 => [0, 0xff00, 0xff, 0],
    }
}

/// Packs R, G, B, A bytes into a stored word.
#[inline]
pub fn pack(format: SurfaceFormat, rgba: [u8; 4]) -> u32 {
    packed(format, rgba.map(u32::from))
}

/// CLR-1: returns the word that a surface holds after a clear to a word: its unused bits are the format's.
pub fn cleared(format: SurfaceFormat, word: u32) -> u32 {
    pack(format, read(format, word))
}

/// Packs R, G, B, A, each 0 to 255, into a stored word.
#[inline(always)]
pub fn packed<W: Word>(format: SurfaceFormat, [r, g, b, a]: [W; 4]) -> W {
    let rgb = r << 16 | g << 8 | b;
    match format {
        SurfaceFormat::A8R8G8B8 => a << 24 | rgb,
        SurfaceFormat::X8R8G8B8Z => rgb,
        SurfaceFormat::X8R8G8B8O => W::from(0xff00_0000) | rgb,
        SurfaceFormat::X1A7R8G8B8Z => (a >> 1) << 24 | rgb,
        SurfaceFormat::X1A7R8G8B8O => (W::from(0x80) | a >> 1) << 24 | rgb,
        SurfaceFormat::R5G6B5 => (r >> 3) << 11 | (g >> 2) << 5 | b >> 3,
        SurfaceFormat::X1R5G5B5Z => (r >> 3) << 10 | (g >> 3) << 5 | b >> 3,
        SurfaceFormat::X1R5G5B5O => W::from(0x8000) | (r >> 3) << 10 | (g >> 3) << 5 | b >> 3,
        SurfaceFormat::B8 => b,
        SurfaceFormat::G8B8 => g << 8 | b,
    }
}

/// ROP-6: returns the stored word after a masked store, which replaces the bits of `write_mask`.
#[inline(always)]
pub fn masked<W: Word>(stored: W, word: W, write_mask: u32) -> W {
    stored & W::from(!write_mask) | word & W::from(write_mask)
}

/// ROP-6: returns the bits of the stored word that a colour mask (R, G, B, A) lets through.
#[inline]
pub fn write_mask(format: SurfaceFormat, color_mask: [bool; 4]) -> u32 {
    let bits = channel_bits(format);
    (0..4).filter(|n| color_mask[*n]).map(|n| bits[n]).sum()
}

/// Returns the R, G, B, A that a picture shows, read by the texture format of the same bits (TEX-1).
pub fn show(format: SurfaceFormat, word: u32) -> [u8; 4] {
    let texture: TextureFormat = format.texture_format();
    format::expand(texture, word)
}

/// Returns [`show`] of all words.
pub fn show_all(format: SurfaceFormat, words: &[u32]) -> Vec<[u8; 4]> {
    let mut shown = Vec::with_capacity(words.len());
    format::expand_all(format.texture_format(), words, |channels| channels, &mut shown);
    shown
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Named;

    /// CLR-1
    #[test]
    fn clears_keep_all_bits_but_unused_ones() {
        for format in SurfaceFormat::ALL {
            let (bits, unused, ones) = match format {
                SurfaceFormat::A8R8G8B8 => (u32::MAX, 0, false),
                SurfaceFormat::X8R8G8B8Z => (u32::MAX, 0xff00_0000, false),
                SurfaceFormat::X8R8G8B8O => (u32::MAX, 0xff00_0000, true),
                SurfaceFormat::X1A7R8G8B8Z => (u32::MAX, 0x8000_0000, false),
                SurfaceFormat::X1A7R8G8B8O => (u32::MAX, 0x8000_0000, true),
                SurfaceFormat::R5G6B5 | SurfaceFormat::G8B8 => (0xffff, 0, false),
                SurfaceFormat::X1R5G5B5Z => (0xffff, 0x8000, false),
                SurfaceFormat::X1R5G5B5O => (0xffff, 0x8000, true),
                SurfaceFormat::B8 => (0xff, 0, false),
            };
            for n in 0..=0xffff_u32 {
                for word in [n, n << 16, n.wrapping_mul(0x9e37_79b1)] {
                    let kept = word & bits & !unused;
                    assert_eq!(cleared(*format, word), if ones { kept | unused } else { kept }, "{format:?} {word:x}");
                }
            }
        }
    }

    /// Stored colours come back with the bits that the format keeps.
    #[test]
    fn round_trips() {
        for format in SurfaceFormat::ALL {
            for v in 0..=255_u8 {
                let rgba = [v, v ^ 0x5a, v.wrapping_mul(7), 255 - v];
                let word = pack(*format, rgba);
                assert!(format.bytes() == 4 || word < 1 << (8 * format.bytes()));
                let back = read(*format, word);
                let dropped = dropped_bits(*format);
                for n in 0..3 {
                    if channel_bits(*format)[n] != 0 {
                        assert_eq!(back[n], rgba[n] >> dropped[n] << dropped[n], "{format:?}");
                    }
                }
                assert_eq!(pack(*format, back) & !channel_bits(*format)[3], word & !channel_bits(*format)[3]);
            }
        }
    }

    #[test]
    fn seven_bit_alpha_is_replicated() {
        assert_eq!(pack(SurfaceFormat::X1A7R8G8B8O, [0, 0, 0, 0]), 0x8000_0000);
        assert_eq!(pack(SurfaceFormat::X1A7R8G8B8Z, [0, 0, 0, 255]), 0x7f00_0000);
        assert_eq!(read(SurfaceFormat::X1A7R8G8B8Z, 0x7f00_0000)[3], 255);
        assert_eq!(read(SurfaceFormat::X1A7R8G8B8O, 0xc000_0000)[3], 129);
    }

    #[test]
    fn texels_of_other_sizes_are_the_same_bytes() {
        let words = [0x4433_2211, 0x8877_6655];
        let bytes = [0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88];
        assert_eq!(*texels(&words, 4, 1), bytes);
        assert_eq!(*texels(&words, 4, 2), [0x2211, 0x4433, 0x6655, 0x8877]);
        assert_eq!(*texels(&bytes, 1, 4), words);
        for (pixel, texel) in [(1, 2), (2, 1), (4, 2), (2, 4), (1, 4), (4, 1), (2, 2)] {
            let pixels = texels(&bytes, 1, pixel);
            assert_eq!(*texels(&texels(&pixels, pixel, texel), texel, pixel), *pixels);
        }
        assert_eq!(texel_columns(3, 4, 2), Some(6));
        assert_eq!(texel_columns(3, 2, 4), None);
        assert_eq!(texel_columns(6, 1, 2), Some(3));
        assert_eq!(texel_columns(u32::MAX, 4, 1), None);
    }
}
