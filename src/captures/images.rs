//! Images that the programs generate for their textures.

use ninebit::state::{Texels, Texture, TextureFormat, TextureImage, TextureKind};
use ninebit_files::texels;

/// A colour as R, G, B, A.
pub(super) type Color = [u8; 4];

/// A function from column and row to the texel's colour.
pub(super) trait Image: Fn(u32, u32) -> Color {}

impl<F: Fn(u32, u32) -> Color> Image for F {}

/// Returns a texture of the given words: faces one after another, and the levels within each.
pub(super) fn of_words(
    kind: TextureKind,
    format: TextureFormat,
    [width, height]: [u32; 2],
    levels: u32,
    words: Vec<u32>,
) -> Texture {
    let texels = Texels { width, height, levels, layers: 1, border: false, words: words.into() };
    Texture { name: String::from("image"), kind, format, image: TextureImage::Texels(texels) }
}

/// Returns the column and row of every texel, row by row from the top.
pub(super) fn each_texel([width, height]: [u32; 2]) -> impl Iterator<Item = (u32, u32)> {
    (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

/// Returns the index of a texel in a swizzled texture, which interleaves the bits of its coordinates. `bits` is the number of bits of each.
pub(super) fn swizzled<const N: usize>(at: [u32; N], bits: [u32; N]) -> usize {
    let in_turn = (0..8).flat_map(|bit| (0..N).filter(move |n| bit < bits[*n]).map(move |n| at[n] >> bit & 1));
    in_turn.enumerate().map(|(place, bit)| (bit as usize) << place).sum()
}

/// Returns the texel words of an image, row by row from the top.
pub(super) fn words(format: TextureFormat, size: [u32; 2], image: impl Image) -> Vec<u32> {
    each_texel(size).map(|(x, y)| texels::word(image(x, y), format)).collect()
}

/// Returns an image as a 2D texture with normalised coordinates.
pub(super) fn texture(format: TextureFormat, size: [u32; 2], image: impl Image) -> Texture {
    of_words(TextureKind::TwoDimensional, format, size, 1, words(format, size, image))
}

/// Returns the texture with coordinates in texels.
pub(super) fn in_texels(texture: Texture) -> Texture {
    Texture { kind: TextureKind::Rectangle, ..texture }
}

/// Returns a texture in texels that is all zeros, for memory that takes its place.
pub(super) fn blank(format: TextureFormat, size: [u32; 2]) -> Texture {
    of_words(TextureKind::Rectangle, format, size, 1, vec![0; (size[0] * size[1]) as usize])
}

/// Returns the texture with its words read in another format of as many bytes.
pub(super) fn read_as(texture: Texture, format: TextureFormat) -> Texture {
    let TextureImage::Texels(image) = texture.image else { return Texture { format, ..texture } };
    let words = image.words.iter().map(|word| word & texels::used_bits(format)).collect();
    Texture { format, image: TextureImage::Texels(Texels { words, ..image }), ..texture }
}

/// Returns a cube map of six images.
pub(super) fn cube<I: Image>(format: TextureFormat, side: u32, faces: [I; 6]) -> Texture {
    let words = faces.into_iter().flat_map(|face| words(format, [side, side], face)).collect();
    of_words(TextureKind::Cube, format, [side, side], 1, words)
}

/// Returns an image of one colour.
pub(super) fn solid(color: Color) -> impl Image {
    move |_, _| color
}

/// Returns a chequered image with fields of `size` texels; the upper left field has the first colour.
pub(super) fn checker(colors: [Color; 2], size: u32) -> impl Image {
    move |x, y| colors[((x / size + y / size) % 2) as usize]
}

/// Maps 0..`of` to 0..255, truncated.
fn ramp(at: u32, of: u32) -> u8 {
    (f32::from(at as u16) * 255.0 / f32::from(of as u16)) as u8
}

/// Returns an image whose red grows and blue falls downwards, and whose green grows to the right. Alpha is the sum of red and green modulo 256.
pub(super) fn gradient([width, height]: [u32; 2]) -> impl Image {
    move |x, y| {
        let (down, right) = (ramp(y, height), ramp(x, width));
        [down, right, 255 - down, down.wrapping_add(right)]
    }
}

/// Returns an image whose red grows to the right and green downwards, with blue at three quarters. All are multiplied by a brightness, a function of
/// the distance from the centre (0 to 1).
pub(super) fn radial(side: u32, brightness: impl Fn(f32) -> f32) -> impl Fn(u32, u32) -> [u8; 3] {
    let middle = f32::from((side - 1) as u16) / 2.0;
    let farthest = (middle * middle + middle * middle).sqrt();
    move |x, y| {
        let [x, y] = [x, y].map(|at| f32::from(at as u16));
        let distance = ((x - middle) * (x - middle) + (y - middle) * (y - middle)).sqrt() / farthest;
        let brightness = brightness(distance);
        let side = f32::from(side as u16);
        [x / side, y / side, 0.75].map(|value| (value * brightness * 255.0) as u8)
    }
}

/// Returns the luminance of a colour, truncated.
pub(super) fn luminance([r, g, b, _]: Color) -> u8 {
    (0.299 * f32::from(r) + 0.587 * f32::from(g) + 0.114 * f32::from(b)) as u8
}

/// Returns the image in grey, with its alpha.
pub(super) fn grey(image: impl Image) -> impl Image {
    move |x, y| {
        let color = image(x, y);
        let l = luminance(color);
        [l, l, l, color[3]]
    }
}

/// Returns a function that is 255 in the middle and falls with the square of the distance to 0 in the corners, truncated.
pub(super) fn bulge([width, height]: [u32; 2]) -> impl Fn(u32, u32) -> u8 {
    let [right, down] = [width, height].map(|side| f32::from((side / 2) as u16));
    let farthest = right * right + down * down;
    move |x, y| {
        let (dx, dy) = (f32::from(x as u16) - right, f32::from(y as u16) - down);
        (255.0 * (1.0 - (dx * dx + dy * dy) / farthest)) as u8
    }
}

/// Returns an image of four gradients; the alpha of all is the bulge.
pub(super) fn four_gradients([width, height]: [u32; 2]) -> impl Image {
    let (quarter, alpha) = ([width / 2, height / 2], bulge([width, height]));
    let gradient = gradient(quarter);
    move |x, y| {
        let [r, g, b, _] = gradient(x % quarter[0], y % quarter[1]);
        [r, g, b, alpha(x, y)]
    }
}
