//! Decodes texels of compressed blocks by TEX-2, TEX-3 and TEX-4 of `docs/rules`, to recompute traces.

/// Returns a texel as A8R8G8B8. `words` are those of the block, then the texel's x and y.
pub fn decode(operation: &str, words: &[i128]) -> i128 {
    let (block, [x, y]) = (&words[..words.len() - 2], [words[words.len() - 2], words[words.len() - 1]]);
    let [colors, indices] = [block[block.len() - 2], block[block.len() - 1]];
    let texel = (y & 3) * 4 + (x & 3);
    let dxt1 = block.len() == 2;
    let four = !dxt1 || colors & 0xffff > colors >> 16;
    let index = indices >> (2 * texel) & 3;
    if index == 3 && !four {
        return 0;
    }
    let alpha = match operation {
        "decode_dxt3" => (block[(texel / 8) as usize] >> (4 * (texel % 8)) & 15) * 17,
        "decode_dxt5" => {
            let bits = block[0] | block[1] << 32;
            let (a0, a1, k) = (bits & 255, bits >> 8 & 255, bits >> (16 + 3 * texel) & 7);
            match (k, a0 > a1) {
                (0, _) => a0,
                (1, _) => a1,
                (k, true) => (2 * ((8 - k) * a0 + (k - 1) * a1) + 7) / 14,
                (6, false) => 0,
                (7, false) => 255,
                (k, false) => (2 * ((6 - k) * a0 + (k - 1) * a1) + 5) / 10,
            }
        }
        _ => 255,
    };
    let fields = |word: i128| [word >> 11 & 31, word >> 5 & 63, word & 31];
    let (a, b) = (fields(colors & 0xffff), fields(colors >> 16));
    let widened = |c: usize, v: i128| if c == 1 { v << 2 | v >> 4 } else { v << 3 | v >> 2 };
    let mixed = |a: i128, b: i128| match index {
        0 => a,
        1 => b,
        2 if four => (2 * a + b + 1) / 3,
        2 => (a + b + 1) >> 1,
        _ => (a + 2 * b + 1) / 3,
    };
    let rgb = [0, 1, 2].map(|c| match operation {
        "decode_dxt1" => widened(c, mixed(a[c], b[c])),
        "decode_dxt1_dithered" => dithered(c, mixed(widened(c, a[c]), widened(c, b[c])), x & 3, y & 3),
        _ => mixed(widened(c, a[c]), widened(c, b[c])),
    });
    alpha << 24 | rgb[0] << 16 | rgb[1] << 8 | rgb[2]
}

fn dithered(channel: usize, value: i128, x: i128, y: i128) -> i128 {
    let red = ["0473", "6251", "3740", "1526"];
    let green = ["1320", "2031", "3102", "0213"];
    let row = |rows: [&str; 4], y: i128| i128::from(rows[y as usize].as_bytes()[x as usize] - b'0');
    let (add, bits) = match channel {
        0 => (row(red, y), 3),
        1 => (row(green, y), 2),
        _ => (row(red, 3 - y), 3),
    };
    let n = (value + add) & ((1 << bits) - 1);
    let level = (value - n) >> bits;
    let most = (256 >> bits) - 1;
    match level {
        _ if level <= 0 => 0,
        _ if level >= most => 255,
        _ => value + (1 << (bits - 1)) - 1 - n,
    }
}
