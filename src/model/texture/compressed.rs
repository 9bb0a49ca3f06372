//! TEX-2, TEX-3, TEX-4: decodes texels of compressed 4 x 4 blocks.
//!
//! A block holds two colours of 5, 6 and 5 bits, and two bits for each texel that choose one of the colours or a
//! mixture. In front of these a DXT3 block has four bits of alpha for each texel, and a DXT5 block has two bytes of
//! alpha and three bits for each texel.

use super::format::{replicate5, replicate6};
use crate::state::TextureFormat;

/// Largest red, green and blue of the two colours.
const MAX_CHANNELS: [i32; 3] = [31, 63, 31];

/// TEX-3: dither that is added to red before it is cut to five bits, by row and column of the texel. Blue uses the rows
/// in reverse order.
const DITHER_5: [[i32; 4]; 4] = [[0, 4, 7, 3], [6, 2, 5, 1], [3, 7, 4, 0], [1, 5, 2, 6]];

/// TEX-3: dither of green, which keeps six bits.
const DITHER_6: [[i32; 4]; 4] = [[1, 3, 2, 0], [2, 0, 3, 1], [3, 1, 0, 2], [0, 2, 1, 3]];

/// A decoded texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DecodedTexel {
    /// R, G, B, A bytes.
    pub bytes: [u8; 4],
    /// R, G, B, A as the real numbers in 0..1 that the format defines, each a numerator and a denominator: colours are
    /// v/31 and v/63, mixtures are exact, and there is no dither.
    pub ideal: [(i32, i32); 4],
}

/// Decodes the texel at column `x` and row `y` of a level from the block that contains it.
///
/// `block` has two little-endian words for DXT1 (the two colours with the first in the low half, then the indices), and
/// four for DXT3 and DXT5 (two of alpha before those). If `dithered` is set, DXT1 follows TEX-3 (nv2a), otherwise TEX-4
/// (nv10). Returns zero for formats that have no blocks.
pub fn decode(format: TextureFormat, dithered: bool, block: &[u32], x: u32, y: u32) -> DecodedTexel {
    let texel = 4 * (y & 3) + (x & 3);
    match (format, block) {
        (TextureFormat::Dxt1, &[colors, indices]) => {
            let (index, four_colors) = (indices >> (2 * texel) & 3, has_four_colors(colors));
            if index == 3 && !four_colors {
                return NOTHING;
            }
            let mix = Mix::from_index(colors, index, four_colors);
            mix.opaque(if dithered { dither(mix.at_eight_bits(), x, y) } else { mix.at_own_width() })
        }
        (TextureFormat::Dxt3 | TextureFormat::Dxt5, &[low, high, colors, indices]) => {
            // These formats always have four colours, whichever of the two is larger.
            let mix = Mix::from_index(colors, indices >> (2 * texel) & 3, true);
            let mut decoded = mix.opaque(mix.at_eight_bits());
            let explicit = format == TextureFormat::Dxt3;
            (decoded.bytes[3], decoded.ideal[3]) =
                if explicit { explicit_alpha(low, high, texel) } else { mixed_alpha(low, high, texel) };
            decoded
        }
        _ => NOTHING,
    }
}

/// Returns whether a block of DXT1 with these two colours has four colours in all; otherwise it has three, and a transparent index.
fn has_four_colors(colors: u32) -> bool {
    colors & 0xffff > colors >> 16
}

/// Returns the bytes of [`decode`] with every mixture made at eight bits and without dither, rounded to nearest or `cut`: as renderers do that do
/// not know TEX-3.
pub(crate) fn decode_undithered(format: TextureFormat, block: &[u32], (x, y): (u32, u32), cut: bool) -> [u8; 4] {
    let decoded = decode(format, false, block, x, y);
    let (colors, indices) = match (format, block) {
        (TextureFormat::Dxt1, &[colors, indices]) | (_, &[_, _, colors, indices]) => (colors, indices),
        _ => return decoded.bytes,
    };
    let dxt1 = format == TextureFormat::Dxt1;
    let (index, four_colors) = (indices >> (2 * (4 * (y & 3) + (x & 3))) & 3, !dxt1 || has_four_colors(colors));
    if !four_colors && index == 3 {
        return decoded.bytes;
    }
    let mix = Mix::from_index(colors, index, four_colors);
    let [r, g, b] = if cut { mix.cut_at_eight_bits() } else { mix.at_eight_bits() }.map(|channel| channel as u8);
    [r, g, b, decoded.bytes[3]]
}

/// Transparent black, for formats without blocks and for the transparent index of DXT1.
const NOTHING: DecodedTexel = DecodedTexel { bytes: [0; 4], ideal: [(0, 1); 4] };

/// How the colour of a texel is mixed from the two colours of the block: (a first + b second) / (a + b).
#[derive(Clone, Copy)]
struct Mix {
    first: [i32; 3],
    second: [i32; 3],
    a: i32,
    b: i32,
}

impl Mix {
    /// Returns the mixture that an index stands for: 0..=3 of four colours, or 0..=2 of three.
    #[inline]
    fn from_index(colors: u32, index: u32, four_colors: bool) -> Mix {
        let channels = |c: u32| [c >> 11 & 31, c >> 5 & 63, c & 31].map(|v| v as i32);
        let (a, b) = match (index, four_colors) {
            (0, _) => (1, 0),
            (1, _) => (0, 1),
            (2, true) => (2, 1),
            (2, false) => (1, 1),
            _ => (1, 2),
        };
        Mix { first: channels(colors), second: channels(colors >> 16), a, b }
    }

    /// Mixes a channel and rounds to nearest: (2a + b + 1) div 3 for thirds, (a + b + 1) >> 1 for halves.
    #[inline]
    fn round(&self, first: i32, second: i32) -> i32 {
        let whole = self.a + self.b;
        (self.a * first + self.b * second + whole / 2) / whole
    }

    /// TEX-2: widens the two colours to bytes, then mixes.
    #[inline]
    fn at_eight_bits(&self) -> [i32; 3] {
        let widened = |v: [i32; 3]| widen(v).map(i32::from);
        let (first, second) = (widened(self.first), widened(self.second));
        [0, 1, 2].map(|n| self.round(first[n], second[n]))
    }

    /// Widens the two colours to bytes by a division, then mixes them, and cuts each result.
    fn cut_at_eight_bits(&self) -> [i32; 3] {
        let byte = |v: [i32; 3], n: usize| 255 * v[n] / MAX_CHANNELS[n];
        [0, 1, 2].map(|n| (self.a * byte(self.first, n) + self.b * byte(self.second, n)) / (self.a + self.b))
    }

    /// TEX-4: mixes at five, six and five bits, then widens (TEX-1).
    #[inline]
    fn at_own_width(&self) -> [i32; 3] {
        widen([0, 1, 2].map(|n| self.round(self.first[n], self.second[n]))).map(i32::from)
    }

    /// Returns a texel of these bytes with alpha 255, and the mixture as real numbers.
    #[inline]
    fn opaque(&self, [r, g, b]: [i32; 3]) -> DecodedTexel {
        let ideal = |n: usize| (self.a * self.first[n] + self.b * self.second[n], (self.a + self.b) * MAX_CHANNELS[n]);
        DecodedTexel { bytes: [r as u8, g as u8, b as u8, 255], ideal: [ideal(0), ideal(1), ideal(2), (1, 1)] }
    }
}

/// TEX-1: widens five, six and five bits to bytes.
#[inline]
fn widen([r, g, b]: [i32; 3]) -> [u8; 3] {
    [replicate5(r as u32), replicate6(g as u32), replicate5(b as u32)]
}

/// TEX-3: cuts bytes to five, six and five bits with the dither of column `x` and row `y`, and removes the dither again
/// as reading does.
#[inline]
fn dither([r, g, b]: [i32; 3], x: u32, y: u32) -> [i32; 3] {
    let (column, row) = ((x & 3) as usize, (y & 3) as usize);
    [
        through(r, DITHER_5[row][column], 3),
        through(g, DITHER_6[row][column], 2),
        through(b, DITHER_5[3 - row][column], 3),
    ]
}

/// Cuts `cut` bits of one channel. The lowest and the highest stored level stand for 0 and 255.
#[inline]
fn through(value: i32, dither: i32, cut: u32) -> i32 {
    let lost = (1 << cut) - 1;
    let n = (value + dither) & lost;
    let level = (value - n) >> cut;
    if level <= 0 {
        0
    } else if level >= 255 >> cut {
        255
    } else {
        value + (lost >> 1) - n
    }
}

/// TEX-2: multiplies four bits of alpha by 17.
#[inline]
fn explicit_alpha(low: u32, high: u32, texel: u32) -> (u8, (i32, i32)) {
    let word = if texel < 8 { low } else { high };
    let n = word >> (4 * (texel & 7)) & 15;
    ((n * 17) as u8, (n as i32, 15))
}

/// TEX-2: mixes two bytes of alpha in sevenths, or in fifths with the additional values 0 and 255 if the first byte is
/// not larger.
#[inline]
fn mixed_alpha(low: u32, high: u32, texel: u32) -> (u8, (i32, i32)) {
    let bits = u64::from(high) << 32 | u64::from(low);
    let (first, second) = ((low & 255) as i32, (low >> 8 & 255) as i32);
    let code = (bits >> (16 + 3 * texel) & 7) as i32;
    let steps = if first > second { 7 } else { 5 };
    let place = match code {
        0 => 0,
        1 => steps,
        6 if steps == 5 => return (0, (0, 1)),
        7 if steps == 5 => return (255, (1, 1)),
        code => code - 1,
    };
    let sum = (steps - place) * first + place * second;
    (((2 * sum + steps) / (2 * steps)) as u8, (sum, 255 * steps))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Decodes one texel of a DXT5 block with the given alpha.
    fn dxt5_alpha(first: u32, second: u32, code: u64, texel: u32) -> DecodedTexel {
        let bits = code << (16 + 3 * texel) | u64::from(second) << 8 | u64::from(first);
        decode(TextureFormat::Dxt5, true, &[bits as u32, (bits >> 32) as u32, 0, 0], texel & 3, texel >> 2)
    }

    /// Tests every pair of bytes with every code, at varying places in the block.
    #[test]
    fn alpha_between_two_bytes() {
        for first in 0..=255_u32 {
            for second in 0..=255_u32 {
                for code in 0..8_u64 {
                    // The byte that is nearest to the real number. No seventh or fifth lies half way between two bytes.
                    let (a, b) = (first as i32, second as i32);
                    let real = match (code as i32, first > second) {
                        (0, _) => (a, 1),
                        (1, _) => (b, 1),
                        (c, true) => ((8 - c) * a + (c - 1) * b, 7),
                        (6, false) => (0, 1),
                        (7, false) => (255, 1),
                        (c, false) => ((6 - c) * a + (c - 1) * b, 5),
                    };
                    let nearest = real.0 / real.1 + i32::from(2 * (real.0 % real.1) > real.1);
                    let texel = (first + second + code as u32) & 15;
                    let decoded = dxt5_alpha(first, second, code, texel);
                    assert_eq!(i32::from(decoded.bytes[3]), nearest, "{first} {second} {code}");
                    let (numerator, denominator) = decoded.ideal[3];
                    assert_eq!(numerator * 255 * real.1, real.0 * denominator, "{first} {second} {code}");
                }
            }
        }
    }

    #[test]
    fn alpha_of_four_bits() {
        for texel in 0..16_u32 {
            for n in 0..16_u64 {
                let bits = n << (4 * texel);
                let block = [bits as u32, (bits >> 32) as u32, 0, 0];
                for other in 0..16 {
                    let decoded = decode(TextureFormat::Dxt3, true, &block, other & 3, other >> 2);
                    let alpha = if other == texel { n as i32 } else { 0 };
                    assert_eq!((decoded.bytes[3], decoded.ideal[3]), (17 * alpha as u8, (alpha, 15)));
                }
            }
        }
    }

    /// Tests every pair of ends of every channel with every index. Thirds are rounded to the nearest byte, whichever
    /// end is larger.
    #[test]
    fn colors_beside_alpha() {
        for (shift, most, wide) in [(11, 31, replicate5 as fn(u32) -> u8), (5, 63, replicate6), (0, 31, replicate5)] {
            for first in 0..=most {
                for second in 0..=most {
                    let block = [0, 0, first << shift | second << (16 + shift), 0b11_10_01_00];
                    let (a, b) = (i32::from(wide(first)), i32::from(wide(second)));
                    let want = [a, b, (2 * a + b + 1) / 3, (a + 2 * b + 1) / 3];
                    let (f, s) = (first as i32, second as i32);
                    let real = [(3 * f, 3), (3 * s, 3), (2 * f + s, 3), (f + 2 * s, 3)];
                    let channel = match shift {
                        11 => 0,
                        5 => 1,
                        _ => 2,
                    };
                    for format in [TextureFormat::Dxt3, TextureFormat::Dxt5] {
                        for x in 0..4 {
                            let decoded = decode(format, true, &block, x as u32, 0);
                            assert_eq!(i32::from(decoded.bytes[channel]), want[x]);
                            let (numerator, denominator) = decoded.ideal[channel];
                            assert_eq!(numerator * real[x].1 * most as i32, real[x].0 * denominator);
                        }
                    }
                }
            }
        }
    }

    /// TEX-3 at every position: compares every level of five and six bits with the formula as it is stated.
    #[test]
    fn dither_at_every_position() {
        let red = [[0, 4, 7, 3], [6, 2, 5, 1], [3, 7, 4, 0], [1, 5, 2, 6]];
        let blue = [[1, 5, 2, 6], [3, 7, 4, 0], [6, 2, 5, 1], [0, 4, 7, 3]];
        let green = [[1, 3, 2, 0], [2, 0, 3, 1], [3, 1, 0, 2], [0, 2, 1, 3]];
        let five = |p: i32, d: i32| {
            let n = (p + d) & 7;
            match (p - n) >> 3 {
                ..=0 => 0,
                31.. => 255,
                _ => p + 3 - n,
            }
        };
        let six = |p: i32, d: i32| {
            let n = (p + d) & 3;
            match (p - n) >> 2 {
                ..=0 => 0,
                63.. => 255,
                _ => p + 1 - n,
            }
        };
        for (x, y) in (0..8_u32).flat_map(|y| (0..8_u32).map(move |x| (x, y))) {
            let (column, row) = ((x % 4) as usize, (y % 4) as usize);
            for first in 0..=63_u32 {
                for second in 0..=63_u32 {
                    let (f, s) =
                        ((first & 31) << 11 | first << 5 | first & 31, (second & 31) << 11 | second << 5 | second & 31);
                    for index in 0..4_u32 {
                        // Four colours, then three colours.
                        let four = [f.max(s) | f.min(s) << 16, index * 0x5555_5555];
                        let three = [f.min(s) | f.max(s) << 16, index * 0x5555_5555];
                        for (block, halves) in [(four, f == s), (three, true)] {
                            let decoded = decode(TextureFormat::Dxt1, true, &block, x, y);
                            if halves && index == 3 {
                                assert_eq!(decoded.bytes, [0; 4]);
                                continue;
                            }
                            let ends = [block[0] & 0xffff, block[0] >> 16];
                            let mixed = |wide: &dyn Fn(u32) -> u8| {
                                let [a, b] = ends.map(|c| i32::from(wide(c)));
                                match (index, halves) {
                                    (0, _) => a,
                                    (1, _) => b,
                                    (2, true) => (a + b + 1) >> 1,
                                    (2, false) => (2 * a + b + 1) / 3,
                                    _ => (a + 2 * b + 1) / 3,
                                }
                            };
                            let want = [
                                five(mixed(&|c| replicate5(c >> 11)), red[row][column]),
                                six(mixed(&|c| replicate6(c >> 5 & 63)), green[row][column]),
                                five(mixed(&|c| replicate5(c & 31)), blue[row][column]),
                                255,
                            ];
                            assert_eq!(decoded.bytes.map(i32::from), want, "{x} {y} {block:x?} {index}");
                        }
                    }
                }
            }
        }
    }

    /// TEX-4 mixes before widening, and the position does not matter.
    #[test]
    fn at_own_width_without_dither() {
        for first in 0..=31_u32 {
            for second in 0..first {
                let block = [first << 11 | second << 27, 0b11_10_01_00];
                let want = [first, second, (2 * first + second + 1) / 3, (first + 2 * second + 1) / 3].map(replicate5);
                for (x, y) in (0..4_usize).map(|x| (x, 4)) {
                    let decoded = decode(TextureFormat::Dxt1, false, &block, x as u32, y);
                    assert_eq!(decoded.bytes, [want[x], 0, 0, 255]);
                }
                let halves = [second << 11 | first << 27, 0xaaaa_aaaa];
                let decoded = decode(TextureFormat::Dxt1, false, &halves, 3, 3);
                assert_eq!(decoded.bytes, [replicate5((first + second + 1) >> 1), 0, 0, 255]);
                assert_eq!(decoded.ideal[0], ((first + second) as i32, 62));
            }
        }
        let clear = decode(TextureFormat::Dxt1, false, &[0, !0], 2, 1);
        assert_eq!((clear.bytes, clear.ideal), ([0; 4], [(0, 1); 4]));
    }
    /// Tests every pair of colours with every index at every position. The handbook states these extremes; the
    /// fractions are exact.
    #[test]
    fn errors_are_as_stated() {
        // Lowest and highest byte - ideal of red and green, as numerators over a common multiple of all denominators.
        const WHOLE: i64 = 31 * 63 * 6;
        let mut extremes = [[[0_i64; 2]; 2]; 3];
        let mut note = |rule: usize, channel: usize, decoded: &DecodedTexel| {
            let (numerator, denominator) = decoded.ideal[channel];
            let ideal = 255 * i64::from(numerator) * (WHOLE / i64::from(denominator));
            let error = i64::from(decoded.bytes[channel]) * WHOLE - ideal;
            let [low, high] = &mut extremes[rule][channel];
            (*low, *high) = (error.min(*low), error.max(*high));
        };
        for first in 0..=63_u32 {
            for second in 0..=63_u32 {
                let ends = [first, second].map(|v| (v & 31) << 11 | v << 5);
                let colors = ends[0] | ends[1] << 16;
                for index in 0..4_u32 {
                    let indices = index * 0x5555_5555;
                    let transparent = index == 3 && ends[0] <= ends[1];
                    for (channel, n) in [0, 1].into_iter().flat_map(|channel| (0..16).map(move |n| (channel, n))) {
                        let block = [0, 0, colors, indices];
                        note(0, channel, &decode(TextureFormat::Dxt3, true, &block, n & 3, n >> 2));
                        if !transparent {
                            note(1, channel, &decode(TextureFormat::Dxt1, true, &block[2..], n & 3, n >> 2));
                            note(2, channel, &decode(TextureFormat::Dxt1, false, &block[2..], n & 3, n >> 2));
                        }
                    }
                }
            }
        }
        // In thousandths, rounded away from zero.
        let rounded = |error: i64| (1000 * error.abs() + WHOLE - 1) / WHOLE * error.signum();
        let stated = [[[-936, 936], [-1016, 1016]], [[-13_710, 5484], [-6072, 2699]], [[-3420, 4791], [-2064, 2739]]];
        assert_eq!(extremes.map(|rule| rule.map(|channel| channel.map(rounded))), stated);
    }
}
