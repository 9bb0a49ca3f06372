//! A small encoder for DXT1, DXT3 and DXT5, which prepares content and is no part of the chip.
//!
//! The end points of a block are its two texels that are farthest apart. Each texel gets the nearest of the four colours.

use ninebit_scene::image::Rgba;

/// Returns the blocks of an image whose sides are multiples of four. `code` is `DXT1`, `DXT3` or `DXT5`.
pub fn encode(image: &Rgba, code: &[u8; 4]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for top in (0..image.height()).step_by(4) {
        for left in (0..image.width()).step_by(4) {
            let texels: [[u8; 4]; 16] = std::array::from_fn(|n| {
                let (x, y) = (left + n as u32 % 4, top + n as u32 / 4);
                image.pixels()[(y * image.width() + x) as usize]
            });
            match code {
                b"DXT3" => bytes.extend(explicit_alpha(&texels).to_le_bytes()),
                b"DXT5" => bytes.extend(interpolated_alpha(&texels).to_le_bytes()),
                _ => {}
            }
            bytes.extend(colors(&texels));
        }
    }
    bytes
}

fn colors(texels: &[[u8; 4]; 16]) -> [u8; 8] {
    let (mut ends, mut farthest) = ([texels[0]; 2], -1);
    for (n, a) in texels.iter().enumerate() {
        for b in &texels[n + 1..] {
            if distance(a, b) > farthest {
                (ends, farthest) = ([*a, *b], distance(a, b));
            }
        }
    }
    let [mut c0, mut c1] = ends.map(|end| to_565(&end));
    if c0 < c1 {
        (c0, c1) = (c1, c0);
    }
    // With equal end points the block has three colours, and all indices below 3 stand for the same one.
    let (a, b) = (from_565(c0), from_565(c1));
    let third =
        |a: [u8; 4], b: [u8; 4]| std::array::from_fn(|n| ((2 * u32::from(a[n]) + u32::from(b[n]) + 1) / 3) as u8);
    let palette = [a, b, third(a, b), third(b, a)];
    let known = if c0 == c1 { 1 } else { 4 };
    let mut indices = 0_u32;
    for (n, texel) in texels.iter().enumerate() {
        let nearest = (0..known).min_by_key(|index| distance(texel, &palette[*index])).unwrap();
        indices |= (nearest as u32) << (2 * n);
    }
    let words = [u32::from(c1) << 16 | u32::from(c0), indices].map(u32::to_le_bytes);
    words.concat().try_into().unwrap()
}

fn distance(a: &[u8; 4], b: &[u8; 4]) -> i32 {
    (0..3).map(|n| (i32::from(a[n]) - i32::from(b[n])).pow(2)).sum()
}

/// Returns the nearest colour with 5, 6 and 5 bits.
fn to_565(color: &[u8; 4]) -> u16 {
    let field = |n: usize, most: u16| (u16::from(color[n]) * most + 127) / 255;
    field(0, 31) << 11 | field(1, 63) << 5 | field(2, 31)
}

fn from_565(color: u16) -> [u8; 4] {
    let five = |v: u16| (v << 3 | v >> 2) as u8;
    let six = color >> 5 & 63;
    [five(color >> 11), (six << 2 | six >> 4) as u8, five(color & 31), 255]
}

fn explicit_alpha(texels: &[[u8; 4]; 16]) -> u64 {
    (0..16).map(|n| ((u64::from(texels[n][3]) + 8) / 17) << (4 * n)).sum()
}

fn interpolated_alpha(texels: &[[u8; 4]; 16]) -> u64 {
    let alphas = texels.map(|texel| u64::from(texel[3]));
    let (high, low) = (*alphas.iter().max().unwrap(), *alphas.iter().min().unwrap());
    let mut bits = high | low << 8;
    // There are eight steps from high to low. Indices 0 and 1 are the ends, and 2 to 7 the values between them in descending order.
    for (n, alpha) in alphas.into_iter().enumerate().filter(|_| high > low) {
        let down = (7 * (high - alpha) + (high - low) / 2) / (high - low);
        let index = [0, 2, 3, 4, 5, 6, 7, 1][down as usize];
        bits |= index << (16 + 3 * n);
    }
    bits
}
