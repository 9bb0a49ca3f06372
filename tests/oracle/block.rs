//! Decodes compressed formats: TEX-2 to TEX-4.

use ninebit::state::TextureFormat;

/// TEX-3: dither that is added to red before it is cut to five bits, by row and column of the texel.
const DITHER_RED: [[i128; 4]; 4] = [[0, 4, 7, 3], [6, 2, 5, 1], [3, 7, 4, 0], [1, 5, 2, 6]];
const DITHER_GREEN: [[i128; 4]; 4] = [[1, 3, 2, 0], [2, 0, 3, 1], [3, 1, 0, 2], [0, 2, 1, 3]];
const DITHER_BLUE: [[i128; 4]; 4] = [[1, 5, 2, 6], [3, 7, 4, 0], [6, 2, 5, 1], [0, 4, 7, 3]];

/// Widens a channel of `bits` bits to 8 by repeating them.
fn widen(v: i128, bits: u32) -> i128 {
    v << (8 - bits) | v >> (2 * bits - 8)
}

/// Returns the fields of a colour, which have 5, 6 and 5 bits.
fn fields(word: u32) -> [i128; 3] {
    [word >> 11 & 31, word >> 5 & 63, word & 31].map(i128::from)
}

const WIDTHS: [u32; 3] = [5, 6, 5];

/// TEX-3: stores a channel in `bits` bits with dither, and removes the dither again.
fn dithered(p: i128, bits: u32, d: i128) -> i128 {
    let step = 1 << (8 - bits);
    let n = (p + d) & (step - 1);
    let level = (p - n) >> (8 - bits);
    if level <= 0 {
        0
    } else if level >= (1 << bits) - 1 {
        255
    } else {
        p + step / 2 - 1 - n
    }
}

/// Returns R, G, B, A of texel (x, y) of the block that begins with these words.
pub fn texel(format: TextureFormat, nv2a: bool, block: &[u32], x: usize, y: usize) -> [i128; 4] {
    let one = format == TextureFormat::Dxt1;
    let (colors, indices) = if one { (block[0], block[1]) } else { (block[2], block[3]) };
    let (low, high) = (colors & 0xffff, colors >> 16);
    let at = (x & 3) + 4 * (y & 3);
    let index = indices >> (2 * at) & 3;
    let three = one && low <= high;
    if three && index == 3 {
        return [0; 4];
    }
    let (a, b) = (fields(low), fields(high));
    // TEX-4: nv10 mixes DXT1 at the width of each channel.
    let narrow = one && !nv2a;
    let [r, g, b] = [0, 1, 2].map(|c| {
        let (a, b) = if narrow { (a[c], b[c]) } else { (widen(a[c], WIDTHS[c]), widen(b[c], WIDTHS[c])) };
        let p = match (index, three) {
            (0, _) => a,
            (1, _) => b,
            (2, true) => (a + b + 1) >> 1,
            (2, false) => (2 * a + b + 1) / 3,
            _ => (a + 2 * b + 1) / 3,
        };
        if narrow {
            widen(p, WIDTHS[c])
        } else if one {
            dithered(p, WIDTHS[c], [DITHER_RED, DITHER_GREEN, DITHER_BLUE][c][y & 3][x & 3])
        } else {
            p
        }
    });
    let bits = u128::from(block[0]) | u128::from(block[1]) << 32;
    let alpha = match format {
        TextureFormat::Dxt3 => (bits >> (4 * at) & 15) as i128 * 17,
        TextureFormat::Dxt5 => {
            let (a, b) = ((bits & 255) as i128, (bits >> 8 & 255) as i128);
            let index = (bits >> (16 + 3 * at) & 7) as i128;
            match index {
                0 => a,
                1 => b,
                // Rounds to the nearest seventh.
                i if a > b => (2 * ((8 - i) * a + (i - 1) * b) + 7) / 14,
                6 => 0,
                7 => 255,
                i => (2 * ((6 - i) * a + (i - 1) * b) + 5) / 10,
            }
        }
        _ => 255,
    };
    [r, g, b, alpha]
}
