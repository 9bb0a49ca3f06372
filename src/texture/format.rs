//! TEX-1: the bits of a texel as channels.

use crate::number::Lane;
use crate::state::TextureFormat;

/// 5 bits to 8 by replication.
#[inline]
pub fn replicate5(v: u32) -> u8 {
    (v << 3 | v >> 2) as u8
}

/// 6 bits to 8 by replication.
#[inline]
pub fn replicate6(v: u32) -> u8 {
    (v << 2 | v >> 4) as u8
}

/// R, G, B, A bytes of a raw texel.
#[inline(always)]
pub fn expand(format: TextureFormat, word: u32) -> [u8; 4] {
    let byte = |shift: u32| (word >> shift) as u8;
    match format {
        TextureFormat::A8R8G8B8 => [byte(16), byte(8), byte(0), byte(24)],
        TextureFormat::X8R8G8B8 => [byte(16), byte(8), byte(0), 255],
        TextureFormat::R5G6B5 => [replicate5(word >> 11 & 31), replicate6(word >> 5 & 63), replicate5(word & 31), 255],
        TextureFormat::X1R5G5B5 => {
            [replicate5(word >> 10 & 31), replicate5(word >> 5 & 31), replicate5(word & 31), 255]
        }
        TextureFormat::A1R5G5B5 => {
            let a = if word >> 15 & 1 == 0 { 0 } else { 255 };
            [replicate5(word >> 10 & 31), replicate5(word >> 5 & 31), replicate5(word & 31), a]
        }
        TextureFormat::A8B8G8R8 => [byte(0), byte(8), byte(16), byte(24)],
        TextureFormat::B8G8R8A8 => [byte(8), byte(16), byte(24), byte(0)],
        TextureFormat::R8G8B8A8 => [byte(24), byte(16), byte(8), byte(0)],
        TextureFormat::R6G5B5 => [replicate6(word >> 10 & 63), replicate5(word >> 5 & 31), replicate5(word & 31), 255],
        TextureFormat::A4R4G4B4 => [8, 4, 0, 12].map(|shift| (word >> shift & 15) as u8 * 17),
        TextureFormat::I8 => [byte(0); 4],
        TextureFormat::A8L8 => [byte(0), byte(0), byte(0), byte(8)],
        TextureFormat::R8B8 => [byte(8), byte(0), byte(0), byte(8)],
        TextureFormat::R16B16 => [byte(16), byte(8), byte(0), byte(24)],
        TextureFormat::Y16 => [255, byte(8), byte(0), 255],
        TextureFormat::P8 | TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5 => [0; 4],
        TextureFormat::L8 => [byte(0), byte(0), byte(0), 255],
        TextureFormat::A8 => [255, 255, 255, byte(0)],
        TextureFormat::G8B8 => [byte(0), byte(8), byte(0), byte(8)],
    }
}

/// Whether channels of the format have less than 8 bits, so that widening them is off.
pub fn is_narrow(format: TextureFormat) -> bool {
    matches!(
        format,
        TextureFormat::R5G6B5
            | TextureFormat::R6G5B5
            | TextureFormat::X1R5G5B5
            | TextureFormat::A1R5G5B5
            | TextureFormat::A4R4G4B4
    )
}

/// [`expand`] in a lane, whose ideal takes 5-bit channels as v/31. Signed channels (TEX-18) come as their two's complement value,
/// s/128 in the ideal.
#[inline(always)]
pub fn lanes<L: Lane>(format: TextureFormat, word: u32, signed: &[bool; 4]) -> [L; 4] {
    let [r, g, b, a] = expand(format, word).map(i32::from);
    let whole = |byte: i32| L::texel(byte, byte, 255);
    let field = |byte: i32, shift: u32, most: u32| L::texel(byte, (word >> shift & most) as i32, most as i32);
    let plain = match format {
        TextureFormat::R5G6B5 => [field(r, 11, 31), field(g, 5, 63), field(b, 0, 31), whole(a)],
        TextureFormat::X1R5G5B5 | TextureFormat::A1R5G5B5 => {
            [field(r, 10, 31), field(g, 5, 31), field(b, 0, 31), whole(a)]
        }
        TextureFormat::R6G5B5 => [field(r, 10, 63), field(g, 5, 31), field(b, 0, 31), whole(a)],
        _ => [whole(r), whole(g), whole(b), whole(a)],
    };
    if *signed == [false; 4] {
        return plain;
    }
    let s = [r, g, b, a].map(|byte| i32::from(byte as u8 as i8));
    std::array::from_fn(|n| if signed[n] { L::texel(s[n], s[n], 128) } else { plain[n] })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every 16-bit texel: replication is the nearest that keeps both ends, and channels agree with bytes.
    #[test]
    fn sixteen_bit_formats() {
        for word in 0..=0xffff_u32 {
            let [r, g, b, a] = expand(TextureFormat::R5G6B5, word);
            assert_eq!(
                (r >> 3, g >> 2, b >> 3, a),
                ((word >> 11) as u8, (word >> 5 & 63) as u8, (word & 31) as u8, 255)
            );
            assert_eq!((r & 7, g & 3, b & 7), (r >> 5, g >> 6, b >> 5));
            let [r, g, b, a] = expand(TextureFormat::X1R5G5B5, word);
            assert_eq!(
                (r >> 3, g >> 3, b >> 3, a),
                ((word >> 10 & 31) as u8, (word >> 5 & 31) as u8, (word & 31) as u8, 255)
            );
            assert_eq!(
                expand(TextureFormat::G8B8, word),
                [word as u8, (word >> 8) as u8, word as u8, (word >> 8) as u8]
            );
            let a = if word & 0x8000 == 0 { 0 } else { 255 };
            assert_eq!(expand(TextureFormat::A1R5G5B5, word), [r, g, b, a]);
            for format in [TextureFormat::R5G6B5, TextureFormat::X1R5G5B5, TextureFormat::A1R5G5B5, TextureFormat::G8B8]
            {
                assert_eq!(lanes::<i32>(format, word, &[false; 4]), expand(format, word).map(i32::from));
            }
        }
    }

    #[test]
    fn bytes_and_fixed_channels() {
        assert_eq!(expand(TextureFormat::A8R8G8B8, 0x1122_3344), [0x22, 0x33, 0x44, 0x11]);
        assert_eq!(expand(TextureFormat::X8R8G8B8, 0x1122_3344), [0x22, 0x33, 0x44, 255]);
        assert_eq!(expand(TextureFormat::L8, 0x7f), [0x7f, 0x7f, 0x7f, 255]);
        assert_eq!(expand(TextureFormat::A8, 0x7f), [255, 255, 255, 0x7f]);
    }
}
