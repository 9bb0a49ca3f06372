//! TEX-7: addressing, border colours and border texels.

use super::texel_formats::texture;
use super::*;
use images::{Color, Image};

/// Returns fields of `size` texels in eight colours, which repeat diagonally.
fn blocks(colors: [Color; 8], size: u32) -> impl Image {
    move |x, y| colors[((x / size + y / size) % 8) as usize]
}

/// Returns a colour as it is, and with an alpha of 0x66.
fn pale(color: Color) -> [Color; 2] {
    [color, [color[0], color[1], color[2], 0x66]]
}

/// Returns four colours (`first`, green, `third` and white), each as it is and pale.
fn colors(first: Color, third: Color) -> [Color; 8] {
    let [a, b] = pale(first);
    let [c, d] = pale([0, 255, 0, 255]);
    let [e, f] = pale(third);
    let [g, h] = pale([255; 4]);
    [a, b, c, d, e, f, g, h]
}

/// Returns an image with border texels: a chequered grey border around coloured fields. The programs' image has twice the size; only four of its
/// texels on each side are read.
fn bordered([width, height]: [u32; 2]) -> Texture {
    let field = checker([abgr(0xffcc_cccc), abgr(0xff44_4444)], 2);
    let inner = blocks(colors([0, 0, 255, 255], [255, 0x44, 0x44, 255]), 2);
    let image = move |x: u32, y: u32| {
        let (column, row) = (x.wrapping_sub(BORDER_TEXELS), y.wrapping_sub(BORDER_TEXELS));
        if column < width && row < height { inner(column, row) } else { field(x, y) }
    };
    let stored = [width, height].map(|side| side + 2 * BORDER_TEXELS);
    let words = images::words(TextureFormat::A8B8G8R8, stored, image).into();
    let texels = Texels { width, height, levels: 1, layers: 1, border: true, words };
    let (name, format) = (String::from("bordered"), TextureFormat::A8B8G8R8);
    Texture { name, kind: TextureKind::TwoDimensional, format, image: TextureImage::Texels(texels) }
}

fn addressed(mode: AddressMode, border_color: Color, unit: TextureUnit) -> TextureUnit {
    TextureUnit { address_s: mode, address_t: mode, border_color, ..unit }
}

/// Returns the nine squares of a group, each with the texture coordinates of its upper left corner.
fn nine(group: u8) -> Vec<([f32; 4], [f32; 2])> {
    let (unit_width, unit_height) = ((5.5_f32 - 0.2) / 3.0, (3.5_f32 - 0.1) / 2.0);
    let (width, height) = (unit_width / 3.0, unit_height / 3.0);
    let left = -2.75 + f32::from(group % 3) * (unit_width + 0.1);
    let top = if group < 3 { 1.75 + (unit_height * 0.25 + 0.1) } else { -0.2 };
    let cell = |row: u8, column: u8| {
        let (x, y) = (left + f32::from(column) * width, top - f32::from(row) * height);
        let coordinates = [f32::from(column) - 1.0, f32::from(row) - 1.0];
        let right = left + f32::from(column + 1) * width;
        ([x, y, right, top - f32::from(row + 1) * height], coordinates)
    };
    (0..3).flat_map(|row| (0..3).map(move |column| (row, column))).map(|(row, column)| cell(row, column)).collect()
}

/// Returns a rectangle of the world at z = 1, whose vertices have the w of that depth.
fn in_world([left, top, right, bottom]: [f32; 4], unit: TextureUnit, coordinates: [f32; 4]) -> Draw {
    let [x0, y0, _, w] = space::fixed_function([left, top, 1.0, 1.0]);
    let [x1, y1, ..] = space::fixed_function([right, bottom, 1.0, 1.0]);
    far(pasted([x0, y0, x1, y1], 0, unit, coordinates), w)
}

/// Draws a texture through every address mode. The fifth group shows `other_color` as the border colour; where that is `None`, it shows a texture
/// with border texels.
fn modes(canvas: &mut Canvas, border_color: Color, other_color: Option<Color>) {
    let image = blocks(colors([255, 0, 0, 255], [0x44, 0x44, 255, 255]), 2);
    let plain = canvas.texture(&images::texture(TextureFormat::A8R8G8B8, [32, 32], image));
    let border = canvas.texture(&bordered([32, 32]));
    for group in 0..6 {
        for (edges, [s, t]) in nine(group) {
            let mode = match group {
                0 => AddressMode::Wrap,
                1 => AddressMode::Mirror,
                3 | 4 => AddressMode::ClampToBorder,
                _ => AddressMode::ClampToEdge,
            };
            let draw = match (group, other_color) {
                (4, None) => {
                    // Coordinates are limited to the border texels.
                    let coordinates = [s, t, s + 1.0, t + 1.0].map(|at| at.clamp(-0.125, 1.125));
                    in_world(edges, addressed(mode, [0; 4], nearest(border)), coordinates)
                }
                _ => {
                    let color = if group == 4 { other_color.unwrap_or_default() } else { border_color };
                    in_world(edges, addressed(mode, color, nearest(plain)), [s, t, s + 1.0, t + 1.0])
                }
            };
            canvas.draw(draw);
        }
    }
}

/// Draws textures with border texels in nine sizes, without and with their borders.
fn border_sizes(canvas: &mut Canvas) {
    let sizes = [[1, 1], [2, 2], [4, 4], [8, 8], [16, 16], [32, 32], [16, 1], [8, 2], [4, 8]];
    let textures = sizes.map(|size| canvas.texture(&bordered(size)));
    for (top, shows_border) in [(80.0, false), (272.0, true)] {
        let corners = places([32.0, top], [96.0; 2], 6);
        for (([width, height], texture), corner) in sizes.into_iter().zip(textures).zip(corners) {
            let [s, t] = [width, height].map(|side| if shows_border { 4.0 / side as f32 } else { 0.0 });
            let unit = addressed(AddressMode::ClampToBorder, [0; 4], nearest(texture));
            canvas.draw(pasted(sized(corner, [64.0; 2]), 0, unit, [-s, -t, 1.0 + s, 1.0 + t]));
        }
    }
}

/// Adds the frames of Texture_border, except those of cube maps.
pub(super) fn borders(frames: &mut Frames) {
    frames.paint("2D", 0xfe20_2020, move |canvas| modes(canvas, [255, 0, 255, 0xf0], None));
    frames.paint("xemu#1034", 0xfe20_2020, move |canvas| {
        modes(canvas, [0x55, 0x9f, 0xff, 0xf0], Some([0xff, 0x55, 0x33, 0xf0]))
    });
    frames.paint("2D_BorderTex_SZ", 0xfe18_1818, border_sizes);
}

/// Adds the frame of Texture_border_color: the border colour beside texels of every format.
pub(super) fn border_color(frames: &mut Frames) {
    use TextureFormat::*;
    let formats = [A8, R5G6B5, R8B8, G8B8, R6G5B5, A8R8G8B8, X8R8G8B8, A8B8G8R8, B8G8R8A8, R8G8B8A8];
    let in_texels = [A8, R5G6B5, G8B8, X1R5G5B5, A8R8G8B8, X8R8G8B8, A8B8G8R8, B8G8R8A8, R8G8B8A8];
    frames.paint("TextureBorderColor", 0xff10_1010, move |canvas| {
        let fields = checker([abgr(0xff00_0000), abgr(0xff44_4444)], 8);
        let background = canvas.texture(&images::texture(A8B8G8R8, [256, 256], fields));
        let behind = pasted(unprojected([0.0, 0.0, 640.0, 480.0]), 0, nearest(background), WHOLE);
        canvas.draw(without_alpha(behind, FETCHED[0]));
        let all = formats.map(|format| (format, false)).into_iter().chain(in_texels.map(|format| (format, true)));
        for ((format, in_texels), corner) in all.zip(places([64.0, 96.0], [99.0; 2], 5)) {
            // Every byte is 0x80.
            let word = 0x8080_8080 & ninebit_files::texels::used_bits(format);
            let number = canvas.texture(&texture(format, in_texels, [8, 8], vec![word; 64]));
            let unit = addressed(AddressMode::ClampToBorder, argb(0x33ff_22cc), nearest(number));
            let (low, high) = if in_texels { (-4.0, 12.0) } else { (-0.5, 1.5) };
            canvas.draw(pasted(unprojected(sized(corner, [64.0; 2])), 0, unit, [low, low, high, high]));
        }
    });
}
