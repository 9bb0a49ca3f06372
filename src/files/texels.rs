//! Converts texels for the state: packs pixels into a format, turns bytes of memory into words, and makes smaller levels.

use ninebit::state::TextureFormat;
use ninebit::texture::format::expand;

/// Returns the bits of a word that the format uses. The others are zero in the state.
pub fn used_bits(format: TextureFormat) -> u32 {
    if can_pack(format) { word([255; 4], format) } else { u32::MAX >> (32 - format.word_bits()) }
}

/// Places of Y, Cb, Y and Cr among the bytes of a pair.
fn pair_order(format: TextureFormat) -> [usize; 4] {
    if format == TextureFormat::Uyvy { [1, 0, 3, 2] } else { [0, 1, 2, 3] }
}

/// Converts a pair of texels in memory into its words.
fn pair_words(bytes: [u8; 4], format: TextureFormat) -> [u32; 2] {
    let [first, cb, second, cr] = pair_order(format).map(|at| u32::from(bytes[at]));
    [first, second].map(|y| y << 16 | cb << 8 | cr)
}

/// Converts the words of a pair into its bytes. Its chroma is that of the first.
fn pair_bytes([first, second]: [u32; 2], format: TextureFormat) -> [u8; 4] {
    let mut bytes = [0; 4];
    for (at, value) in pair_order(format).into_iter().zip([first >> 16, first >> 8, second >> 16, first]) {
        bytes[at] = value as u8;
    }
    bytes
}

/// Converts texels or blocks in memory, little-endian, into words of the state. Bytes of an incomplete texel or pair are ignored.
pub fn from_bytes(bytes: &[u8], format: TextureFormat) -> Vec<u32> {
    if format.is_paired() {
        return bytes.as_chunks().0.iter().flat_map(|pair| pair_words(*pair, format)).collect();
    }
    let used = used_bits(format);
    let stored = |word: u32| stored(word & used, format);
    match format.bytes() {
        1 => bytes.iter().map(|byte| u32::from(*byte)).collect(),
        2 => bytes.as_chunks().0.iter().map(|pair| stored(u32::from(u16::from_le_bytes(*pair)))).collect(),
        _ => bytes.as_chunks().0.iter().map(|four| stored(u32::from_le_bytes(*four))).collect(),
    }
}

/// Converts words of the state into texels or blocks in memory, as [`from_bytes`] reads them.
pub fn to_bytes(words: &[u32], format: TextureFormat) -> Vec<u8> {
    if format.is_paired() {
        return words.as_chunks().0.iter().flat_map(|pair| pair_bytes(*pair, format)).collect();
    }
    let bytes = format.bytes().min(4) as usize;
    words.iter().flat_map(|word| in_memory(*word, format).to_le_bytes().into_iter().take(bytes)).collect()
}

/// Converts a word of the state into one of memory, as [`stored`] reads it, without the bits that the format ignores.
pub fn in_memory(word: u32, format: TextureFormat) -> u32 {
    let word = match format {
        TextureFormat::Z24S8 | TextureFormat::Z24S8F => word.rotate_left(8),
        _ => word,
    };
    word & used_bits(format)
}

/// Converts a word of memory into one of the state. Depths of 24 bits have the stencil below them in memory, and above them in the state.
pub fn stored(word: u32, format: TextureFormat) -> u32 {
    match format {
        TextureFormat::Z24S8 | TextureFormat::Z24S8F => word.rotate_right(8),
        _ => word,
    }
}

/// Returns whether pixels can be [packed](pack) into the format, which must not hold indices, blocks or depths.
pub fn can_pack(format: TextureFormat) -> bool {
    format != TextureFormat::P8 && !format.is_compressed() && format.depth().is_none()
}

/// Packs pixels with 8 bits a channel into words. Low bits that do not fit are cut off, and channels that the format lacks are dropped. Pairs take
/// the chroma, which is green and blue, of their first pixel; rows then have an even number.
pub fn pack(pixels: &[[u8; 4]], format: TextureFormat) -> Vec<u32> {
    let mut words: Vec<u32> = pixels.iter().map(|pixel| word(*pixel, format)).collect();
    if format.is_paired() {
        for [first, second] in words.as_chunks_mut().0 {
            *second = *second & 0x00ff_0000 | *first & 0xffff;
        }
    }
    words
}

/// Packs a pixel R, G, B, A into a word of the format.
pub fn word(pixel: [u8; 4], format: TextureFormat) -> u32 {
    // Called for each texel by crates that are not optimised in a build for tests.
    let [r, g, b, a] = pixel;
    let [r, g, b, a] = [u32::from(r), u32::from(g), u32::from(b), u32::from(a)];
    match format {
        TextureFormat::A8R8G8B8 | TextureFormat::R16B16 => a << 24 | r << 16 | g << 8 | b,
        TextureFormat::X8R8G8B8 | TextureFormat::Yuy2 | TextureFormat::Uyvy => r << 16 | g << 8 | b,
        TextureFormat::A8B8G8R8 => a << 24 | b << 16 | g << 8 | r,
        TextureFormat::B8G8R8A8 => b << 24 | g << 16 | r << 8 | a,
        TextureFormat::R8G8B8A8 => r << 24 | g << 16 | b << 8 | a,
        TextureFormat::R5G6B5 => (r >> 3) << 11 | (g >> 2) << 5 | b >> 3,
        TextureFormat::R6G5B5 => (r >> 2) << 10 | (g >> 3) << 5 | b >> 3,
        TextureFormat::X1R5G5B5 => (r >> 3) << 10 | (g >> 3) << 5 | b >> 3,
        TextureFormat::A1R5G5B5 => (a >> 7) << 15 | (r >> 3) << 10 | (g >> 3) << 5 | b >> 3,
        TextureFormat::A4R4G4B4 => (a >> 4) << 12 | (r >> 4) << 8 | (g >> 4) << 4 | b >> 4,
        TextureFormat::L8 | TextureFormat::I8 => r,
        TextureFormat::A8 => a,
        TextureFormat::A8L8 => a << 8 | r,
        TextureFormat::G8B8 | TextureFormat::Y16 => g << 8 | b,
        TextureFormat::R8B8 => r << 8 | b,
        // Callers have asked `can_pack`.
        TextureFormat::P8 | TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5 => 0,
        TextureFormat::Z16 | TextureFormat::Z24S8 | TextureFormat::Z16F | TextureFormat::Z24S8F => 0,
    }
}

/// Makes the next smaller level of one whose sides are powers of two, by a box filter. Each channel as it is read (TEX-1) becomes the mean of
/// 2 x 2 texels, or of two if one side is 1 already, with halves rounded up, and is [packed](pack) again. Formats of 16 bits a channel keep
/// 16 bits. This prepares textures: no chip makes levels.
pub fn halve(words: &[u32], width: u32, height: u32, format: TextureFormat) -> Vec<u32> {
    // A loop for each way of a mean, because most textures are large.
    match format {
        TextureFormat::Y16 => smaller(words, width, height, mean),
        TextureFormat::R16B16 => {
            let halves = |texels: [u32; 4]| mean(texels.map(|t| t >> 16)) << 16 | mean(texels.map(|t| t & 0xffff));
            smaller(words, width, height, halves)
        }
        // Channels are whole bytes, wherever they lie.
        TextureFormat::A8R8G8B8
        | TextureFormat::A8B8G8R8
        | TextureFormat::B8G8R8A8
        | TextureFormat::R8G8B8A8
        | TextureFormat::L8
        | TextureFormat::I8
        | TextureFormat::A8
        | TextureFormat::A8L8
        | TextureFormat::G8B8
        | TextureFormat::R8B8 => smaller(words, width, height, mean_of_bytes),
        TextureFormat::X8R8G8B8 | TextureFormat::Yuy2 | TextureFormat::Uyvy => {
            smaller(words, width, height, |texels| mean_of_bytes(texels) & 0x00ff_ffff)
        }
        format => smaller(words, width, height, |texels| mean_as_read(texels, format)),
    }
}

/// Applies `of` to the 2 x 2 texels below each of the next level.
fn smaller(words: &[u32], width: u32, height: u32, of: impl Fn([u32; 4]) -> u32) -> Vec<u32> {
    let (width, has_rows) = (width as usize, height > 1);
    let mut smaller = Vec::with_capacity(words.len().div_ceil(4));
    for rows in words.chunks_exact(width * (1 + usize::from(has_rows))) {
        // If a side is 1, texels count twice, which does not change the mean.
        let (upper, lower) = if has_rows { rows.split_at(width) } else { (rows, rows) };
        if let ([upper], [lower]) = (upper, lower) {
            smaller.push(of([*upper, *upper, *lower, *lower]));
            continue;
        }
        let pairs = upper.as_chunks::<2>().0.iter().zip(lower.as_chunks::<2>().0);
        smaller.extend(pairs.map(|([a, b], [c, d])| of([*a, *b, *c, *d])));
    }
    smaller
}

/// Returns the mean of numbers of at most 16 bits, with halves rounded up.
#[inline(always)]
fn mean([a, b, c, d]: [u32; 4]) -> u32 {
    (a + b + c + d + 2) >> 2
}

/// Returns the mean of each byte.
#[inline(always)]
fn mean_of_bytes(texels: [u32; 4]) -> u32 {
    // Two bytes at a time, in 16 bits each.
    const EVEN: u32 = 0x00ff_00ff;
    let sum = |[a, b, c, d]: [u32; 4]| ((a + b + c + d + 0x0002_0002) >> 2) & EVEN;
    sum(texels.map(|texel| texel & EVEN)) | sum(texels.map(|texel| texel >> 8 & EVEN)) << 8
}

/// Returns the mean of each channel as it is read, packed again.
fn mean_as_read(texels: [u32; 4], format: TextureFormat) -> u32 {
    let channels = texels.map(|texel| expand(format, texel));
    word([0, 1, 2, 3].map(|n| mean(channels.map(|channel| u32::from(channel[n]))) as u8), format)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ninebit::state::Named;

    /// A packed pixel that is read packs into the same word again.
    #[test]
    fn packing_undoes_expanding() {
        for format in TextureFormat::ALL.iter().copied().filter(|format| can_pack(*format)) {
            for n in 0..=0xffff_u32 {
                let word = n.wrapping_mul(0x9e37_0001) & used_bits(format);
                // Y16 shows the two bytes of its value in two channels; all other formats show each value in one channel.
                assert_eq!(
                    super::word(expand(format, word), format),
                    word,
                    "`word` has to undo `expand` of {format:?}"
                );
            }
        }
    }

    #[test]
    fn bytes_of_memory() {
        let bytes = [1, 2, 3, 0x84];
        assert_eq!(from_bytes(&bytes, TextureFormat::L8), [1, 2, 3, 0x84]);
        assert_eq!(from_bytes(&bytes, TextureFormat::R5G6B5), [0x0201, 0x8403]);
        assert_eq!(from_bytes(&bytes, TextureFormat::X1R5G5B5), [0x0201, 0x0403]);
        assert_eq!(from_bytes(&bytes, TextureFormat::A8R8G8B8), [0x8403_0201]);
        assert_eq!(from_bytes(&bytes, TextureFormat::X8R8G8B8), [0x0003_0201]);
        assert_eq!(from_bytes(&bytes, TextureFormat::Yuy2), [0x0001_0284, 0x0003_0284]);
        assert_eq!(from_bytes(&bytes, TextureFormat::Uyvy), [0x0002_0103, 0x0084_0103]);
        assert_eq!(from_bytes(&[1, 2, 3, 4, 5, 6, 7, 8], TextureFormat::Dxt1), [0x0403_0201, 0x0807_0605]);
    }

    #[test]
    fn memory_is_read_as_it_was_written() {
        for format in TextureFormat::ALL.iter().copied() {
            let mut words: Vec<u32> =
                (0..998_u32).map(|n| stored(n.wrapping_mul(0x9e37_79b1) & used_bits(format), format)).collect();
            if format.is_paired() {
                words = pack(&words.iter().map(|word| expand(format, *word)).collect::<Vec<_>>(), format);
            }
            let bytes = to_bytes(&words, format);
            assert_eq!(bytes.len(), words.len() * format.bytes().min(4) as usize, "{format:?}");
            assert_eq!(from_bytes(&bytes, format), words, "{format:?}");
        }
    }

    /// Levels of all formats by the definition: channels as they are read, of all shapes.
    #[test]
    fn levels_are_means_of_channels() {
        let mut random = ninebit::random::Random::seeded(11);
        for format in TextureFormat::ALL.iter().copied().filter(|format| can_pack(*format)) {
            for (width, height) in [(8, 8), (16, 1), (1, 16), (2, 64), (1, 1)] {
                // Many bytes are 0 or 255.
                let mut word = || {
                    let [bits, ends, which] = [0; 3].map(|_| random.bits() as u32);
                    let ends = (ends & 0x0101_0101) * 255;
                    (bits & !ends | ends & ((which & 0x0101_0101) * 255)) & used_bits(format)
                };
                let words: Vec<u32> = (0..width * height).map(|_| word()).collect();
                let at = |x: u32, y: u32| words[(y.min(height - 1) * width + x.min(width - 1)) as usize];
                let wanted =
                    (0..(height / 2).max(1)).flat_map(|y| (0..(width / 2).max(1)).map(move |x| (2 * x, 2 * y)));
                let wanted = wanted.map(|(x, y)| {
                    let texels = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
                    match format {
                        TextureFormat::Y16 => mean(texels),
                        TextureFormat::R16B16 => mean(texels.map(|t| t >> 16)) << 16 | mean(texels.map(|t| t & 0xffff)),
                        _ => mean_as_read(texels, format),
                    }
                });
                assert_eq!(
                    halve(&words, width, height, format),
                    wanted.collect::<Vec<_>>(),
                    "{format:?} {width} x {height}"
                );
            }
        }
    }

    #[test]
    fn halving() {
        let l8 = |words: &[u32], width, height| halve(words, width, height, TextureFormat::L8);
        assert_eq!(l8(&[0, 1, 10, 20, 0, 0, 30, 41], 4, 2), [0, 25]);
        // The means are 1/2 and 2/4.
        assert_eq!(l8(&[0, 1], 2, 1), [1]);
        assert_eq!(l8(&[0, 1, 4, 4], 1, 4), [1, 4]);
        assert_eq!(l8(&[1, 1, 0, 0], 2, 2), [1]);
        assert_eq!(halve(&[0x00ff_0000, 0x0100_ffff], 2, 1, TextureFormat::R16B16), [0x0100_8000]);
        assert_eq!(halve(&[0x00ff, 0x0100], 2, 1, TextureFormat::Y16), [0x0100]);
        // Red 31 and 30 are read as 255 and 247; their mean 251 becomes 31.
        assert_eq!(halve(&[31 << 11, 30 << 11], 2, 1, TextureFormat::R5G6B5), [31 << 11]);
    }
}
