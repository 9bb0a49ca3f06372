//! VOL-1, TEX-17, CYL-1: volume textures in all formats, anisotropic filtering, and cylindrical wrapping.

use super::*;
use images::{Image, gradient};

const SIDE: u32 = 256;
const LAYERS: u32 = 4;

/// Returns a volume texture whose words hold one layer after another.
fn volume(format: TextureFormat, words: Vec<u32>) -> Texture {
    let texture = images::of_words(TextureKind::ThreeDimensional, format, [SIDE; 2], 1, words);
    let TextureImage::Texels(texels) = texture.image else { return texture };
    Texture { image: TextureImage::Texels(Texels { layers: LAYERS, ..texels }), ..texture }
}

/// Returns seven pairs of triangles, each with a different r.
fn pairs(unit: TextureUnit) -> Draw {
    let (width, height) = ((2.75_f32 + 2.75) / 3.0 - 0.1 * 2.0, (1.75_f32 + 1.75) / 3.0 - 0.1 * 2.0);
    let (step, fall) = (width + 0.1, height + 0.1);
    let (left, top) = (-2.75_f32, 1.75_f32);
    let second = left + width + 0.1;
    let lower = top - fall;
    let lowest = lower - fall;
    let corners = [
        [left, top],
        [second, top],
        [second + step, top],
        [second, lower],
        [left, lowest],
        [second, lowest],
        [second + step, lowest],
    ];
    let inner = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut r = 0.0_f32;
    let mut vertices = Vec::new();
    for (n, [x, y]) in corners.into_iter().enumerate() {
        let edges = [[x, y], [x + width, y], [x + width, y - height], [x, y], [x + width, y - height], [x, y - height]];
        let layer = if n == 6 { 1.0 } else { r };
        vertices.extend(edges.into_iter().zip(inner).map(|([x, y], [s, t])| Vertex {
            position: space::fixed_function([x, y, 0.0, 1.0]),
            texture_coordinates: [[s, t, layer, 1.0]; TEXTURE_UNITS],
            diffuse: VertexColor::Bytes([255; 4]),
            ..Vertex::default()
        }));
        r += 1.0 / 7.0;
    }
    fetching(draw(Topology::Triangles, vertices), 0, unit)
}

/// Returns a layer of the volume: the gradient with all channels, or with only blue, red or green.
fn layer(z: u32) -> impl Image {
    let masks = [[255; 3], [0, 0, 255], [255, 0, 0], [0, 255, 0]];
    let ([red, green, blue], image) = (masks[z as usize], gradient([SIDE; 2]));
    move |x, y| {
        let [r, g, b, a] = image(x, y);
        [r & red, g & green, b & blue, a]
    }
}

/// Returns the words of a volume. For formats that the programs do not convert to, they store 32 bits per texel (alpha, blue, green, red from the
/// lowest byte on, or alpha, red, green, blue for A8); the chip then reads that memory in its own format.
fn words(format: TextureFormat) -> Vec<u32> {
    use TextureFormat::{A1R5G5B5, A8, A8L8, Dxt1, G8B8, I8, L8, R6G5B5, R8B8, R16B16, Y16};
    let bytes = match format {
        A8 | I8 | L8 => 1,
        A8L8 | G8B8 | R8B8 | Y16 => 2,
        R16B16 => 4,
        Dxt1 => {
            // Blocks are stored row by row. The four layers of a 4 x 4 x 4 block lie one after another.
            let image = layer(0);
            let word = |texel: u32| {
                let [r, g, b, a] = image(texel % SIDE, texel / SIDE);
                u32::from_le_bytes([a, b, g, r])
            };
            let block = |(z, (x, y))| {
                let block = (y * (SIDE / 4) + x) * LAYERS + z;
                [word(2 * block), word(2 * block + 1)]
            };
            let blocks = |z| images::each_texel([SIDE / 4; 2]).map(move |at| (z, at));
            return (0..LAYERS).flat_map(blocks).flat_map(block).collect();
        }
        other => {
            let format = if other == R6G5B5 { A1R5G5B5 } else { other };
            return (0..LAYERS).flat_map(|z| texel_formats::packed(format, [SIDE; 2], layer(z))).collect();
        }
    };
    let place = |x, y, z| images::swizzled([x, y, z], [8, 8, 2]);
    let mut memory = vec![0; (4 * SIDE * SIDE * LAYERS) as usize];
    for z in 0..LAYERS {
        let image = layer(z);
        for (x, y) in images::each_texel([SIDE; 2]) {
            let [r, g, b, a] = image(x, y);
            memory[4 * place(x, y, z)..][..4].copy_from_slice(&if format == A8 { [a, r, g, b] } else { [a, b, g, r] });
        }
    }
    let word = |at: usize| memory[at..at + bytes].iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte));
    (0..LAYERS)
        .flat_map(|z| images::each_texel([SIDE; 2]).map(move |(x, y)| bytes * place(x, y, z)))
        .map(word)
        .collect()
}

/// Adds the frames of Volume_texture.
pub(super) fn volumes(frames: &mut Frames) {
    let unit = TextureUnit { address_r: AddressMode::ClampToEdge, ..nearest(0) };
    let formats = texel_formats::variants().filter(|variant| !variant.in_texels).map(|v| (v.base, v.format));
    for (name, format) in formats.chain([("DXT1", TextureFormat::Dxt1)]) {
        frames.paint(name, 0xfe20_2020, move |canvas| {
            canvas.texture(&volume(format, words(format)));
            canvas.draw(pairs(unit));
        });
    }
    frames.paint("SZ_Index8", 0xfe20_2020, move |canvas| {
        let block = |n: u32| {
            let value = 255 - 4 * (n % 64);
            let shown = [value, value << 8, value << 16, value | value << 8 | value << 16];
            0xff00_0000 + shown[(n / 64) as usize]
        };
        let palette = Some(canvas.palette((0..256).map(block)));
        let layer = |layer: u32| (0..SIDE * SIDE).map(move |n| (n / SIDE % 64 + layer * 64) & 255);
        canvas.texture(&volume(TextureFormat::P8, (0..LAYERS).flat_map(layer).collect()));
        canvas.draw(pairs(TextureUnit { palette, ..unit }));
    });
}

/// Adds the frames of Texture_anisotropy: a floor to the horizon, with one to eight taps.
pub(super) fn anisotropy(frames: &mut Frames) {
    for anisotropy in [1, 2, 4, 8] {
        let image = checker([0xffff_ff00, 0xff66_3333].map(argb), 4);
        let image = images::texture(TextureFormat::A8R8G8B8, [128; 2], image);
        let (address_s, address_t) = (AddressMode::Wrap, AddressMode::Wrap);
        let unit = TextureUnit { anisotropy, address_s, address_t, ..nearest(0) };
        let floor = corners([-4.0, 200.0, 4.0, 0.0]).into_iter().zip(corners([0.0, 0.0, 1.0, 32.0]));
        let floor = floor.map(|([x, z], texel)| placed(space::fixed_function([x, -1.5, z, 1.0]), texel));
        let floor = without_alpha(fetching(draw(Topology::Quads, floor.collect()), 0, unit), FETCHED[0]);
        frames.push(format!("Anisotropy-{anisotropy}"), one(0xfe20_2020, Some(&image), floor));
    }
}

/// Adds the frame of TextureWrapMode: coordinates that span one repeat and a fifth of it, with and without cylindrical wrapping.
pub(super) fn wrap_modes(frames: &mut Frames) {
    let mut canvas = Canvas::new(0xff00_0000);
    let image = images::radial(SIDE, |distance| distance);
    let image = move |x: u32, y: u32| {
        let [r, g, b] = image(x, y);
        [r, g, b, 255]
    };
    canvas.texture(&images::texture(TextureFormat::A8B8G8R8, [SIDE; 2], image));
    for (row, delta) in [(0.0, 1.0_f32), (1.0, 0.2)] {
        for (column, wraps) in [(0.0, false), (1.0, true)] {
            let from = 1.0 - delta * 0.5;
            let unit = TextureUnit {
                address_s: AddressMode::Wrap,
                address_t: AddressMode::Mirror,
                cylindrical_wrap: [wraps; 2],
                ..nearest(0)
            };
            let corner = [96.0 + column * 320.0, 96.0 + row * 144.0];
            let edges = unprojected(sized(corner, [128.0; 2]));
            let draw = pasted(edges, 0, unit, [from, from, from + delta, from + delta]);
            canvas.draw(without_alpha(draw, FETCHED[0]));
        }
    }
    frames.push("CylinderWrapping", canvas.colors());
}
