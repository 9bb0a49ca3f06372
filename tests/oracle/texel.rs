//! Decodes stored texels, TEX-1, and applies TEX-18 before and after the filter.

use ninebit::state::TextureFormat;

/// Returns whether a format is filtered as two halves of 16 bits.
pub fn has_halves(format: TextureFormat) -> bool {
    matches!(format, TextureFormat::R16B16 | TextureFormat::Y16)
}

/// TEX-1: returns the bytes R, G, B, A of a word in an uncompressed format.
pub fn bytes(format: TextureFormat, word: u32) -> [i128; 4] {
    // Returns the `count` bits from bit `at` on, widened to 8 bits by repetition.
    let field = |at: u32, count: u32| {
        let v = i128::from(word >> at & ((1 << count) - 1));
        let mut wide = 0;
        let mut have = 0;
        while have < 8 {
            wide = wide << count | v;
            have += count;
        }
        wide >> (have - 8)
    };
    let byte = |n: u32| i128::from(word >> (8 * n) & 255);
    match format {
        TextureFormat::A8R8G8B8 => [byte(2), byte(1), byte(0), byte(3)],
        TextureFormat::X8R8G8B8 => [byte(2), byte(1), byte(0), 255],
        // Y, Cb, Cr
        TextureFormat::Yuy2 | TextureFormat::Uyvy => [byte(2), byte(1), byte(0), 255],
        TextureFormat::A8B8G8R8 => [byte(0), byte(1), byte(2), byte(3)],
        TextureFormat::B8G8R8A8 => [byte(1), byte(2), byte(3), byte(0)],
        TextureFormat::R8G8B8A8 => [byte(3), byte(2), byte(1), byte(0)],
        TextureFormat::R5G6B5 => [field(11, 5), field(5, 6), field(0, 5), 255],
        TextureFormat::R6G5B5 => [field(10, 6), field(5, 5), field(0, 5), 255],
        TextureFormat::X1R5G5B5 => [field(10, 5), field(5, 5), field(0, 5), 255],
        TextureFormat::A1R5G5B5 => [field(10, 5), field(5, 5), field(0, 5), field(15, 1)],
        TextureFormat::A4R4G4B4 => [field(8, 4), field(4, 4), field(0, 4), field(12, 4)],
        TextureFormat::L8 => [byte(0), byte(0), byte(0), 255],
        TextureFormat::I8 => [byte(0); 4],
        TextureFormat::A8 => [255, 255, 255, byte(0)],
        TextureFormat::A8L8 => [byte(0), byte(0), byte(0), byte(1)],
        TextureFormat::G8B8 => [byte(0), byte(1), byte(0), byte(1)],
        TextureFormat::R8B8 => [byte(1), byte(0), byte(0), byte(1)],
        TextureFormat::P8 | TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5 => {
            unreachable!("{format:?} is looked up or decoded")
        }
        TextureFormat::R16B16 | TextureFormat::Y16 => unreachable!("{format:?} is read in halves"),
        TextureFormat::Z16 | TextureFormat::Z24S8 | TextureFormat::Z16F | TextureFormat::Z24S8F => {
            unreachable!("{format:?} is compared")
        }
    }
}

/// KEY-1: returns whether texels have their own alpha. Without it alpha is 255, whatever the word.
pub fn has_alpha(format: TextureFormat) -> bool {
    let other = matches!(format, TextureFormat::P8 | TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5);
    other || bytes(format, 0)[3] != 255
}

/// TEX-1: returns the two halves of a word that is filtered at 16 bits. Y16 has 255 in both bytes of the upper half.
pub fn halves(format: TextureFormat, word: u32) -> [i128; 2] {
    let low = i128::from(word & 0xffff);
    if format == TextureFormat::Y16 { [0xffff, low] } else { [i128::from(word >> 16), low] }
}

/// Reads `bits` bits as two's complement if the flag is set.
pub fn signed(flag: bool, v: i128, bits: u32) -> i128 {
    if flag && v >> (bits - 1) & 1 == 1 { v - (1 << bits) } else { v }
}

/// A sampled colour, as later units read it and as the register holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color {
    /// R, G, B, A as later units read them, 0 to 255.
    pub bytes: [i128; 4],
    /// R, G, B, A of the register, in 1/255.
    pub register: [i128; 4],
}

impl Color {
    pub fn plain(bytes: [i128; 4]) -> Color {
        Color { bytes, register: bytes }
    }

    /// TEX-18: returns the colour of filtered channels.
    pub fn of_channels(v: [i128; 4], flags: [bool; 4]) -> Color {
        let register = std::array::from_fn(|c| if flags[c] { 2 * v[c] } else { v[c] });
        Color { bytes: v.map(|v| v & 255), register }
    }

    /// TEX-18: returns the colour of filtered halves. Only the upper byte of a signed half is signed.
    pub fn of_halves([high, low]: [i128; 2], [high_signed, low_signed]: [bool; 2]) -> Color {
        let bytes = [high & 255, low >> 8 & 255, low & 255, high >> 8 & 255];
        let mut register = bytes;
        if high_signed {
            register[3] = 2 * signed(true, bytes[3], 8);
        }
        if low_signed {
            register[1] = 2 * signed(true, bytes[1], 8);
        }
        Color { bytes, register }
    }
}
