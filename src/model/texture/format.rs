//! TEX-1: converts the bits of a texel to channels.

use crate::number::{Lane, Word};
use crate::state::TextureFormat;

/// Widens 5 bits to 8 by replication.
#[inline]
pub(crate) fn replicate5(v: u32) -> u8 {
    five_to_eight(v) as u8
}

/// Widens 6 bits to 8 by replication.
#[inline]
pub(crate) fn replicate6(v: u32) -> u8 {
    six_to_eight(v) as u8
}

#[inline(always)]
fn five_to_eight<W: Word>(v: W) -> W {
    v << 3 | v >> 2
}

#[inline(always)]
fn six_to_eight<W: Word>(v: W) -> W {
    v << 2 | v >> 4
}

/// Returns R, G, B, A of a raw texel, each 0 to 255. A depth returns its highest byte. Texels of P8 have to be looked
/// up first, and those of compressed formats [decoded](super::compressed::decode); here they are zero.
#[inline(always)]
pub fn channels<W: Word>(format: TextureFormat, word: W) -> [W; 4] {
    let [none, all] = [0, 255].map(W::from);
    let bits = |shift: u32, mask: u32| word >> shift & W::from(mask);
    let byte = |shift: u32| bits(shift, 255);
    let five = |shift: u32| five_to_eight(bits(shift, 31));
    let six = |shift: u32| six_to_eight(bits(shift, 63));
    let four = |shift: u32| bits(shift, 15) << 4 | bits(shift, 15);
    match format {
        TextureFormat::A8R8G8B8 | TextureFormat::R16B16 => [byte(16), byte(8), byte(0), byte(24)],
        TextureFormat::X8R8G8B8 | TextureFormat::Yuy2 | TextureFormat::Uyvy => [byte(16), byte(8), byte(0), all],
        TextureFormat::A8B8G8R8 => [byte(0), byte(8), byte(16), byte(24)],
        TextureFormat::B8G8R8A8 => [byte(8), byte(16), byte(24), byte(0)],
        TextureFormat::R8G8B8A8 => [byte(24), byte(16), byte(8), byte(0)],
        TextureFormat::R5G6B5 => [five(11), six(5), five(0), all],
        TextureFormat::R6G5B5 => [six(10), five(5), five(0), all],
        TextureFormat::X1R5G5B5 => [five(10), five(5), five(0), all],
        TextureFormat::A1R5G5B5 => [five(10), five(5), five(0), bits(15, 1) * all],
        TextureFormat::A4R4G4B4 => [four(8), four(4), four(0), four(12)],
        TextureFormat::L8 => [byte(0), byte(0), byte(0), all],
        TextureFormat::I8 => [byte(0); 4],
        TextureFormat::A8 => [all, all, all, byte(0)],
        TextureFormat::A8L8 => [byte(0), byte(0), byte(0), byte(8)],
        TextureFormat::G8B8 => [byte(0), byte(8), byte(0), byte(8)],
        TextureFormat::R8B8 => [byte(8), byte(0), byte(0), byte(8)],
        TextureFormat::Y16 => [all, byte(8), byte(0), all],
        // Depths as pictures show them. Units compare them instead.
        TextureFormat::Z16 | TextureFormat::Z16F => [byte(8), byte(8), byte(8), all],
        TextureFormat::Z24S8 | TextureFormat::Z24S8F => [byte(16), byte(16), byte(16), all],
        TextureFormat::P8 | TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5 => [none; 4],
    }
}

/// Returns [`channels`] as bytes.
#[inline(always)]
pub fn expand(format: TextureFormat, word: u32) -> [u8; 4] {
    channels(format, word).map(|channel| channel as u8)
}

/// Appends what `of` makes of each word's [`expand`]. The format is the same for all, so that a loop for each can be vectorised.
pub(crate) fn expand_all<T>(format: TextureFormat, words: &[u32], of: impl Fn([u8; 4]) -> T, out: &mut Vec<T>) {
    macro_rules! each {
        ($($name:ident)*) => {
            match format {
                $(TextureFormat::$name => out.extend(words.iter().map(|word| of(expand(TextureFormat::$name, *word)))),)*
            }
        };
    }
    each!(A8R8G8B8 X8R8G8B8 A8B8G8R8 B8G8R8A8 R8G8B8A8 R5G6B5 R6G5B5 X1R5G5B5 A1R5G5B5 A4R4G4B4 L8 I8 A8 A8L8 G8B8 R8B8 R16B16 Y16
        Yuy2 Uyvy Z16 Z16F Z24S8 Z24S8F P8 Dxt1 Dxt3 Dxt5);
}

/// Returns whether the format has channels of 5 or 6 bits, which widening does not convert exactly. 1 and 4 bits are
/// exact.
pub(crate) fn is_narrow(format: TextureFormat) -> bool {
    fields(format).is_some()
}

/// Returns the shift and the largest value of red, green and blue if the format gives them 5 or 6 bits.
#[inline(always)]
fn fields(format: TextureFormat) -> Option<[(u32, u32); 3]> {
    match format {
        TextureFormat::R5G6B5 => Some([(11, 31), (5, 63), (0, 31)]),
        TextureFormat::R6G5B5 => Some([(10, 63), (5, 31), (0, 31)]),
        TextureFormat::X1R5G5B5 | TextureFormat::A1R5G5B5 => Some([(10, 31), (5, 31), (0, 31)]),
        _ => None,
    }
}

/// Returns [`expand`] with channels of 5 and 6 bits widened by zeros, as renderers do that shift in place of replicating.
pub(crate) fn shifted(format: TextureFormat, word: u32) -> [u8; 4] {
    let mut bytes = expand(format, word);
    if let Some(fields) = fields(format) {
        for (byte, (shift, most)) in bytes.iter_mut().zip(fields) {
            *byte = ((word >> shift & most) * 256 / (most + 1)) as u8;
        }
    }
    bytes
}

/// Returns [`expand`] in a lane. The ideal takes 5-bit channels as v/31 and 6-bit ones as v/63. Signed channels
/// (TEX-18) are their two's complement value, s/128 in the ideal.
#[inline(always)]
pub(crate) fn lanes<L: Lane>(format: TextureFormat, word: u32, signed: &[bool; 4]) -> [L; 4] {
    let bytes = expand(format, word).map(i32::from);
    let mut plain = bytes.map(|byte| L::texel(byte, byte, 255));
    if let Some(fields) = fields(format) {
        for (n, (shift, most)) in fields.into_iter().enumerate() {
            plain[n] = L::texel(bytes[n], (word >> shift & most) as i32, most as i32);
        }
    }
    if *signed == [false; 4] {
        return plain;
    }
    let s = bytes.map(|byte| i32::from(byte as u8 as i8));
    std::array::from_fn(|n| if signed[n] { L::texel(s[n], s[n], 128) } else { plain[n] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Named;

    /// The source of a channel of a format.
    #[derive(Clone, Copy)]
    enum Channel {
        /// Bits of the word: the lowest one, and their number.
        Bits(u32, u32),
        /// A constant, which is in no bit of the word.
        Fixed(u8),
    }
    use Channel::{Bits, Fixed};

    /// Returns the sources of R, G, B, A for every format whose texels are expanded.
    fn channels(format: TextureFormat) -> Option<[Channel; 4]> {
        let byte = |shift| Bits(shift, 8);
        Some(match format {
            TextureFormat::A8R8G8B8 | TextureFormat::R16B16 => [byte(16), byte(8), byte(0), byte(24)],
            TextureFormat::X8R8G8B8 | TextureFormat::Yuy2 | TextureFormat::Uyvy => {
                [byte(16), byte(8), byte(0), Fixed(255)]
            }
            TextureFormat::A8B8G8R8 => [byte(0), byte(8), byte(16), byte(24)],
            TextureFormat::B8G8R8A8 => [byte(8), byte(16), byte(24), byte(0)],
            TextureFormat::R8G8B8A8 => [byte(24), byte(16), byte(8), byte(0)],
            TextureFormat::R5G6B5 => [Bits(11, 5), Bits(5, 6), Bits(0, 5), Fixed(255)],
            TextureFormat::R6G5B5 => [Bits(10, 6), Bits(5, 5), Bits(0, 5), Fixed(255)],
            TextureFormat::X1R5G5B5 => [Bits(10, 5), Bits(5, 5), Bits(0, 5), Fixed(255)],
            TextureFormat::A1R5G5B5 => [Bits(10, 5), Bits(5, 5), Bits(0, 5), Bits(15, 1)],
            TextureFormat::A4R4G4B4 => [Bits(8, 4), Bits(4, 4), Bits(0, 4), Bits(12, 4)],
            TextureFormat::L8 => [byte(0), byte(0), byte(0), Fixed(255)],
            TextureFormat::I8 => [byte(0); 4],
            TextureFormat::A8 => [Fixed(255), Fixed(255), Fixed(255), byte(0)],
            TextureFormat::A8L8 => [byte(0), byte(0), byte(0), byte(8)],
            TextureFormat::G8B8 => [byte(0), byte(8), byte(0), byte(8)],
            TextureFormat::R8B8 => [byte(8), byte(0), byte(0), byte(8)],
            TextureFormat::Y16 => [Fixed(255), byte(8), byte(0), Fixed(255)],
            TextureFormat::Z16 | TextureFormat::Z16F => [byte(8), byte(8), byte(8), Fixed(255)],
            TextureFormat::Z24S8 | TextureFormat::Z24S8F => [byte(16), byte(16), byte(16), Fixed(255)],
            TextureFormat::P8 | TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5 => return None,
        })
    }

    /// Repeats bits one by one until they fill a byte.
    fn repeated(value: u32, bits: u32) -> u8 {
        (0..8).fold(0, |byte, n| byte << 1 | (value >> (bits - 1 - n % bits) & 1) as u8)
    }

    /// Checks bytes, the i32 lane and the ideal of one word.
    #[allow(clippy::float_arithmetic, reason = "the ideal against its formula")]
    fn check(format: TextureFormat, word: u32) {
        let Some(channels) = channels(format) else { return };
        let bytes = expand(format, word);
        let (fixed, ideal) = (lanes::<i32>(format, word, &[false; 4]), lanes::<f64>(format, word, &[false; 4]));
        for (n, from) in channels.into_iter().enumerate() {
            let (byte, real) = match from {
                Fixed(byte) => (byte, f64::from(byte)),
                Bits(shift, bits) => {
                    let (value, most) = (word >> shift & ((1 << bits) - 1), (1 << bits) - 1);
                    (repeated(value, bits), 255.0 * f64::from(value) / f64::from(most))
                }
            };
            assert_eq!(bytes[n], byte, "{format:?} {word:#x} channel {n}");
            assert_eq!(fixed[n], i32::from(byte));
            let off = (ideal[n] - real).abs();
            assert!(off < 1e-9, "{format:?} {word:#x} channel {n}: {} is not {real}", ideal[n]);
            let exact = f64::from(byte) == ideal[n];
            assert!(exact || is_narrow(format), "{format:?} {word:#x} channel {n}");
        }
    }

    /// Tests every texel of at most 16 bits in every format.
    #[test]
    fn every_small_texel() {
        for format in TextureFormat::ALL.iter().filter(|format| format.bytes() <= 2 && !format.is_paired()) {
            for word in 0..1 << (8 * format.bytes()) {
                check(*format, word);
            }
        }
    }

    /// Tests every value of each byte in the 32-bit formats, while the other bytes hold something else.
    #[test]
    fn every_byte_of_large_texels() {
        for format in TextureFormat::ALL.iter().filter(|format| format.bytes() == 4 || format.is_paired()) {
            for byte in 0..=255_u32 {
                for shift in [0, 8, 16, 24] {
                    let others = 0x1234_5678 & !(255 << shift);
                    check(*format, byte << shift | others);
                }
            }
        }
        assert_eq!(expand(TextureFormat::A8R8G8B8, 0x1122_3344), [0x22, 0x33, 0x44, 0x11]);
    }

    /// What `state` says of a format beside its channels.
    #[test]
    fn alpha_is_known_to_the_state() {
        for format in TextureFormat::ALL.iter().copied() {
            let Some(channels) = channels(format) else { continue };
            assert_eq!(format.has_alpha(), matches!(channels[3], Bits(..)), "correct `has_alpha` for {format:?}");
        }
    }

    #[test]
    fn signed_channels() {
        for byte in 0..=255_u32 {
            let s = i32::from(byte as u8 as i8);
            let word = byte << 24 | byte << 16 | byte << 8 | byte;
            let [r, g, b, a] = lanes::<i32>(TextureFormat::A8R8G8B8, word, &[true, false, true, false]);
            assert_eq!([r, g, b, a], [s, byte as i32, s, byte as i32]);
        }
    }
}
