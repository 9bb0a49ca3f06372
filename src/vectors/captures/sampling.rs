//! VOL-1, TEX-17, CYL-1: volumes in all formats, anisotropy, and a coordinate that goes around a cylinder.

use super::draws::{
    Canvas, FETCHED, argb, corners, draw, fetching, nearest, pasted, placed, sized, unprojected, without_alpha,
};
use super::images::{checker, gradient};
use super::{Frames, images, space, texel_formats};
use ninebit::state::*;

const SIDE: u32 = 256;
const LAYERS: u32 = 4;

/// Layers one after the other as a volume.
fn volume(format: TextureFormat, layers: impl Iterator<Item = Vec<u32>>) -> Texture {
    let texture = images::of_words(TextureKind::ThreeDimensional, format, [SIDE; 2], 1, layers.flatten().collect());
    let TextureImage::Texels(texels) = texture.image else { return texture };
    Texture { image: TextureImage::Texels(Texels { layers: LAYERS, ..texels }), ..texture }
}

/// Seven pairs of triangles, each at another r.
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

/// Formats whose layers the programs store as they convert them, in another order than the chip reads them: they are left out, as is DXT1.
const CONVERTED: [&str; 9] = ["A8", "A8Y8", "AY8", "G8B8", "R16B16", "R6G5B5", "R8B8", "Y16", "Y8"];

/// Volume_texture, ten formats.
pub(super) fn volumes(frames: &mut Frames) {
    let unit = TextureUnit { address_r: AddressMode::ClampToEdge, ..nearest(0) };
    for variant in texel_formats::variants().filter(|v| !v.in_texels && !CONVERTED.contains(&v.base)) {
        frames.paint(variant.base, 0xfe20_2020, move |canvas| {
            let masks = [[255; 3], [0, 0, 255], [255, 0, 0], [0, 255, 0]];
            let layer = |[red, green, blue]: [u8; 3]| {
                let image = move |x: u32, y: u32| {
                    let [r, g, b, a] = gradient([SIDE; 2])(x, y);
                    [r & red, g & green, b & blue, a]
                };
                texel_formats::packed(variant.format, [SIDE; 2], image)
            };
            canvas.texture(&volume(variant.format, masks.into_iter().map(layer)));
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
        let layer = |layer: u32| (0..SIDE * SIDE).map(|n| (n / SIDE % 64 + layer * 64) & 255).collect();
        canvas.texture(&volume(TextureFormat::P8, (0..LAYERS).map(layer)));
        canvas.draw(pairs(TextureUnit { palette, ..unit }));
    });
}

/// Texture_anisotropy: a floor to the horizon, with one to eight taps.
pub(super) fn anisotropy(frames: &mut Frames) {
    for anisotropy in [1, 2, 4, 8] {
        let mut canvas = Canvas::new(0xfe20_2020);
        let image = checker([0xffff_ff00, 0xff66_3333].map(argb), 4);
        canvas.texture(&images::texture(TextureFormat::A8R8G8B8, [128; 2], image));
        let (address_s, address_t) = (AddressMode::Wrap, AddressMode::Wrap);
        let unit = TextureUnit { anisotropy, address_s, address_t, ..nearest(0) };
        let floor = corners([-4.0, 200.0, 4.0, 0.0]).into_iter().zip(corners([0.0, 0.0, 1.0, 32.0]));
        let floor = floor.map(|([x, z], texel)| placed(space::fixed_function([x, -1.5, z, 1.0]), texel));
        canvas.draw(without_alpha(fetching(draw(Topology::Quads, floor.collect()), 0, unit), FETCHED[0]));
        frames.push(format!("Anisotropy-{anisotropy}"), canvas.colors());
    }
}

/// TextureWrapMode: coordinates that jump by one repeat and by a fifth, as they are and around a cylinder.
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
