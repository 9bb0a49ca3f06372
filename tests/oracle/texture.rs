//! Texture units: TEX-1, TEX-5 to TEX-8, TEX-16, TEX-18.

use ninebit::frame::Surface;
use ninebit::state::{AddressMode, Filter, Texture, TextureFormat, TextureImage, TextureUnit};

/// A texture's words as they stand when a draw begins.
pub struct Image {
    pub size: [u32; 2],
    format: TextureFormat,
    words: Vec<u32>,
}

impl Image {
    pub fn new(texture: &Texture, surfaces: &[Surface]) -> Image {
        match &texture.image {
            TextureImage::Texels(texels) => {
                Image { size: [texels.width, texels.height], format: texture.format, words: texels.words.to_vec() }
            }
            TextureImage::Target { target } => {
                let s = &surfaces[*target];
                Image { size: [s.width, s.height], format: texture.format, words: s.words.clone() }
            }
        }
    }
}

/// TEX-1: R, G, B, A bytes.
pub fn texel_bytes(format: TextureFormat, word: u32) -> [i128; 4] {
    let byte = |n: u32| i128::from(word >> (8 * n) & 255);
    let five = |at: u32| {
        let v = i128::from(word >> at & 31);
        v << 3 | v >> 2
    };
    match format {
        TextureFormat::A8R8G8B8 => [byte(2), byte(1), byte(0), byte(3)],
        TextureFormat::X8R8G8B8 => [byte(2), byte(1), byte(0), 255],
        TextureFormat::R5G6B5 => {
            let six = i128::from(word >> 5 & 63);
            [five(11), six << 2 | six >> 4, five(0), 255]
        }
        TextureFormat::X1R5G5B5 => [five(10), five(5), five(0), 255],
        TextureFormat::A1R5G5B5 => [five(10), five(5), five(0), if word >> 15 & 1 == 1 { 255 } else { 0 }],
        TextureFormat::L8 => [byte(0), byte(0), byte(0), 255],
        TextureFormat::A8 => [255, 255, 255, byte(0)],
        TextureFormat::G8B8 => [byte(0), byte(1), byte(0), byte(1)],
        other => unimplemented!("{other:?}"),
    }
}

/// TEX-7, TEX-8: a texel index along one axis; none is the border.
fn address(mode: AddressMode, index: i128, size: u32) -> Option<usize> {
    let n = i128::from(size);
    let i = match mode {
        AddressMode::Wrap => index.rem_euclid(n),
        AddressMode::Mirror => {
            let i = index.rem_euclid(2 * n);
            if i < n { i } else { 2 * n - 1 - i }
        }
        AddressMode::ClampToEdge | AddressMode::Clamp => index.clamp(0, n - 1),
        AddressMode::ClampToBorder => {
            if index < 0 || index >= n {
                return None;
            }
            index
        }
    };
    Some(i as usize)
}

/// What the unit's register holds, for coordinates in 1/256 texel.
pub fn sample(unit: &TextureUnit, image: &Image, [u, v]: [i128; 2]) -> [i128; 4] {
    // TEX-18: the byte as the filter sees it.
    let fetch = |x: i128, y: i128| -> [i128; 4] {
        let bytes = match (address(unit.address_s, x, image.size[0]), address(unit.address_t, y, image.size[1])) {
            (Some(x), Some(y)) => texel_bytes(image.format, image.words[y * image.size[0] as usize + x]),
            _ => unit.border_color.map(i128::from),
        };
        std::array::from_fn(|c| if unit.signed[c] && bytes[c] >= 128 { bytes[c] - 256 } else { bytes[c] })
    };
    let filtered: [i128; 4] = match unit.mag_filter {
        Filter::Nearest => fetch(u >> 8, v >> 8),
        Filter::Linear => {
            let (u, v) = (u - 128, v - 128);
            let (x, y) = (u >> 8, v >> 8);
            let (fx, fy) = (u & 255, v & 255);
            let l = |a: i128, b: i128, w: i128| (a * (256 - w) + b * w + 128) >> 8;
            let [a, b, c, d] = [fetch(x, y), fetch(x + 1, y), fetch(x, y + 1), fetch(x + 1, y + 1)];
            std::array::from_fn(|k| l(l(a[k], b[k], fx), l(c[k], d[k], fx), fy))
        }
    };
    std::array::from_fn(|c| if unit.signed[c] { 2 * filtered[c] } else { filtered[c] })
}
