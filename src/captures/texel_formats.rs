//! TEX-1 to TEX-4, TEX-9, TEX-18, TEX-19: texel formats, palettes, signed channels, mip levels and conversion from YUV.

use super::*;
use images::{Color, Image, bulge, gradient, grey, swizzled};

/// Returns a textured square of two triangles, transformed by the vertex program. `side` is the texture coordinate of its far edges.
fn square(side: f32, unit: TextureUnit) -> Draw {
    let (places, texels) = (corners([-0.75, 0.75, 0.75, -0.75]), corners([0.0, 0.0, side, side]));
    let vertex = |n: usize| placed(space::vertex_program(places[n]), texels[n]);
    fetching(draw(Topology::Triangles, [0, 1, 2, 0, 2, 3].map(vertex).to_vec()), 0, unit)
}

const SIDE: u32 = 256;
const SIZE: [u32; 2] = [SIDE; 2];

/// Names of formats in those of frames, the format, and whether there is also a frame with coordinates in texels.
const FORMATS: [(&str, TextureFormat, bool); 19] = [
    ("A8R8G8B8", TextureFormat::A8R8G8B8, true),
    ("A8B8G8R8", TextureFormat::A8B8G8R8, true),
    ("B8G8R8A8", TextureFormat::B8G8R8A8, true),
    ("R8G8B8A8", TextureFormat::R8G8B8A8, true),
    ("X8R8G8B8", TextureFormat::X8R8G8B8, true),
    ("R5G6B5", TextureFormat::R5G6B5, true),
    ("A1R5G5B5", TextureFormat::A1R5G5B5, true),
    ("X1R5G5B5", TextureFormat::X1R5G5B5, true),
    ("A4R4G4B4", TextureFormat::A4R4G4B4, true),
    ("G8B8", TextureFormat::G8B8, true),
    ("R8B8", TextureFormat::R8B8, false),
    ("R16B16", TextureFormat::R16B16, true),
    ("Y8", TextureFormat::L8, true),
    ("AY8", TextureFormat::I8, true),
    ("A8Y8", TextureFormat::A8L8, false),
    ("Y16", TextureFormat::Y16, true),
    ("R6G5B5", TextureFormat::R6G5B5, false),
    ("YUY2", TextureFormat::Yuy2, true),
    ("UYVY", TextureFormat::Uyvy, true),
];

/// A format of the frames: its name there, whether its texture is grey, and whether its coordinates are in texels.
#[derive(Clone, Copy)]
pub(super) struct Variant {
    pub(super) base: &'static str,
    pub(super) format: TextureFormat,
    pub(super) is_grey: bool,
    pub(super) in_texels: bool,
}

impl Variant {
    pub(super) fn name(&self) -> String {
        format!("{}{}", self.base, if self.in_texels { "_L" } else { "" })
    }
}

/// Returns all formats, with both kinds of coordinates where there are frames of both. Those of pairs have coordinates in texels only.
pub(super) fn variants() -> impl Iterator<Item = Variant> {
    let formats = FORMATS.into_iter().chain([("A8", TextureFormat::A8, true)]);
    formats.flat_map(|(base, format, both)| {
        use TextureFormat::{A8L8, I8, L8, Y16};
        let variant = |in_texels| Variant { base, format, is_grey: matches!(format, L8 | I8 | A8L8 | Y16), in_texels };
        [(!format.is_paired()).then(|| variant(false)), both.then(|| variant(true))].into_iter().flatten()
    })
}

/// Returns Y, Cb and Cr of a colour as the programs compute them, in floats that are cut.
fn as_yuv([r, g, b, _]: Color) -> [u32; 3] {
    let [r, g, b] = [r, g, b].map(f32::from);
    let y = 0.257 * r + 0.504 * g + 0.098 * b + 16.0;
    let cb = -(0.148 * r) - 0.291 * g + 0.439 * b + 128.0;
    let cr = 0.439 * r - 0.368 * g - 0.071 * b + 128.0;
    [y, cb, cr].map(|value| value as u32)
}

/// Returns an image as words. For 16-bit channels the programs write each byte twice, for luminance they scale it, and a pair takes the chroma of its
/// second texel.
pub(super) fn packed(format: TextureFormat, size: [u32; 2], image: impl Image) -> Vec<u32> {
    let wide = |color: Color| match format {
        TextureFormat::R16B16 => {
            let [r, _, b, _] = color.map(u32::from);
            ((r * 0x101) << 16) | (b * 0x101)
        }
        TextureFormat::Y16 => (f32::from(color[0]) / 255.0 * 65535.0) as u32,
        _ => ninebit_files::texels::word(color, format),
    };
    let paired = |(x, y): (u32, u32)| {
        let [luma, ..] = as_yuv(image(x, y));
        let [_, cb, cr] = as_yuv(image(x | 1, y));
        luma << 16 | cb << 8 | cr
    };
    if format.is_paired() {
        return images::each_texel(size).map(paired).collect();
    }
    images::each_texel(size).map(|(x, y)| wide(image(x, y))).collect()
}

/// Returns the draw, converted from YUV if the texture has pairs (TEX-19).
pub(super) fn converting(format: TextureFormat, draw: Draw) -> Draw {
    Draw { convert_yuv: format.is_paired(), ..draw }
}

/// Returns a texture of the given words, with coordinates in texels or normalised.
pub(super) fn texture(format: TextureFormat, in_texels: bool, size: [u32; 2], words: Vec<u32>) -> Texture {
    let kind = if in_texels { TextureKind::Rectangle } else { TextureKind::TwoDimensional };
    images::of_words(kind, format, size, 1, words)
}

/// A texture, and the entries of its palette if it holds indices.
type Pictured = (Texture, Vec<u32>);

/// Returns a unit that reads the texture, and the texture coordinate of its far edges.
fn unit(canvas: &mut Canvas, (texture, palette): Pictured) -> (TextureUnit, f32) {
    let palette = (!palette.is_empty()).then(|| canvas.palette(palette.into_iter()));
    let side = if texture.kind == TextureKind::Rectangle { SIDE as f32 } else { 1.0 };
    (TextureUnit { palette, ..nearest(canvas.texture(&texture)) }, side)
}

/// Returns the 32-bit gradient, whose memory is read as if every byte were a texel. Its bytes are alpha, red, green, blue from the lowest on.
fn bytes_of_gradient(is_swizzled: bool) -> Vec<u32> {
    let mut memory = vec![0; (4 * SIDE * SIDE) as usize];
    let image = gradient(SIZE);
    let place = |(x, y)| if is_swizzled { swizzled([x, y], [8; 2]) } else { (y * SIDE + x) as usize };
    for (x, y) in images::each_texel(SIZE) {
        let [r, g, b, a] = image(x, y).map(u32::from);
        memory[4 * place((x, y))..][..4].copy_from_slice(&[a, r, g, b]);
    }
    images::each_texel(SIZE).map(|at| memory[place(at)]).collect()
}

/// Returns compressed blocks with two colours, black and the gradient's upper left texel; the block is filled with one of two indices, chosen by that
/// texel's alpha.
fn blocks_of_gradient() -> Vec<u32> {
    let image = gradient(SIZE);
    let block = |(x, y)| {
        let [r, g, b, a] = image(4 * x, 4 * y).map(u32::from);
        let color = (((r & 0xf8) + (g >> 5)) << 8) | (((g & 0x1c) << 3) + (b >> 3));
        [color << 16, if a >= 125 { 0x5555_5555 } else { 0xffff_ffff }]
    };
    images::each_texel([SIDE / 4; 2]).flat_map(block).collect()
}

/// Returns palette entries: blue, green, red and grey, each falling from full in a quarter of the palette.
fn ramps(length: u32) -> impl Iterator<Item = u32> {
    let quarter = length / 4;
    let step = 255_u32.div_ceil(quarter);
    (0..length).map(move |n| {
        let value = 0xff_u32.wrapping_sub(n % quarter * step);
        let shifted = [value, value << 8, value << 16];
        let color = shifted.into_iter().fold(0_u32, u32::wrapping_add);
        0xff00_0000_u32.wrapping_add(if n / quarter < 3 { shifted[(n / quarter) as usize] } else { color })
    })
}

/// Returns a function for each frame that builds its texture, with the frame's name. That of R6G5B5 is written as words of `six_bits`.
fn pictures(six_bits: TextureFormat) -> Vec<(String, Box<dyn Fn() -> Pictured + Send + Sync>)> {
    let mut all: Vec<(String, Box<dyn Fn() -> Pictured + Send + Sync>)> = Vec::new();
    for variant in variants() {
        let name = format!("TexFmt_{}", variant.name());
        let picture = move || {
            let Variant { format, is_grey, in_texels, .. } = variant;
            let words = match format {
                TextureFormat::A8 => bytes_of_gradient(!in_texels),
                TextureFormat::R6G5B5 => packed(six_bits, SIZE, gradient(SIZE)),
                format if is_grey => packed(format, SIZE, grey(gradient(SIZE))),
                format => packed(format, SIZE, gradient(SIZE)),
            };
            (texture(format, in_texels, SIZE, words), vec![])
        };
        all.push((name, Box::new(picture)));
    }
    for length in [256, 128, 64, 32] {
        let picture = move || {
            let index = |n: u32| if n < SIDE * SIDE / 2 { n } else { n & !3 };
            let words = (0..SIDE * SIDE).map(|n| index(n) & (length - 1)).collect();
            (texture(TextureFormat::P8, false, SIZE, words), ramps(length).collect())
        };
        all.push((format!("TexFmt_SZ_Index8_p{length}"), Box::new(picture)));
    }
    let blocks = || (texture(TextureFormat::Dxt1, false, SIZE, blocks_of_gradient()), vec![]);
    all.push(("TexFmt_DXT1".to_owned(), Box::new(blocks)));
    all
}

/// Adds the frames of Texture_format.
pub(super) fn formats(frames: &mut Frames) {
    for (name, picture) in pictures(TextureFormat::R5G6B5) {
        frames.paint(name, 0xfe20_2020, move |canvas| {
            let picture = picture();
            let format = picture.0.format;
            let (unit, side) = unit(canvas, picture);
            canvas.draw(converting(format, square(side, unit)));
        });
    }
}

/// Adds the frames of Texture_render_target, which draw the textures to a render target first.
pub(super) fn render_targets(frames: &mut Frames) {
    for (name, picture) in pictures(TextureFormat::R6G5B5) {
        frames.paint(name, 0xfe21_2021, move |canvas| {
            let picture = picture();
            let format = picture.0.format;
            let (unit, side) = unit(canvas, picture);
            let target = canvas.target(Target::new(SIDE, SIDE, SurfaceFormat::A8R8G8B8));
            let whole = pasted([0.0, 0.0, SIDE as f32, SIDE as f32], 0, unit, [0.0, 0.0, side, side]);
            canvas.draw_into(target, [converting(format, without_alpha(whole, FETCHED[0]))]);
            let shown = canvas.shown(target, TextureKind::TwoDimensional, TextureFormat::A8R8G8B8);
            let [left, top, _, w] = space::fixed_function([-1.75, 1.75, 0.1, 1.0]);
            let [right, bottom, ..] = space::fixed_function([1.75, -1.75, 0.1, 1.0]);
            let draw = pasted([left, top, right, bottom], 0, nearest(shown), WHOLE);
            canvas.draw(without_alpha(far(draw, w), FETCHED[0]));
        });
    }
}

/// Returns a palette whose red grows, green falls and blue repeats. Each entry is masked by `mask`.
fn rainbow(mask: u32) -> Vec<u32> {
    (0..256).map(|n| (0xff << 24 | n << 16 | (255 - n) << 8 | (4 * n) & 255) & mask).collect()
}

/// Draws an image of indices several times in a row, each through another palette.
fn row_of_palettes(canvas: &mut Canvas, top: f32, texture: usize, palettes: &[Vec<u32>]) {
    let mut left = 51.0;
    for palette in palettes {
        let palette = Some(canvas.palette(palette.iter().copied()));
        let edges = unprojected(sized([left, top], [96.0, 96.0]));
        canvas.draw(pasted(edges, 0, TextureUnit { palette, ..nearest(texture) }, WHOLE));
        left += 147.0;
    }
}

/// Returns a texture of indices that are highest in the middle, multiplied by `factor` modulo 256.
fn indices(factor: u32) -> Texture {
    let distance = bulge([128, 128]);
    let words = images::each_texel([128; 2]).map(|(x, y)| (u32::from(distance(x, y)) * factor) & 255).collect();
    texture(TextureFormat::P8, false, [128, 128], words)
}

/// Draws four palettes, three of which lack one channel, in both orders, and the palettes themselves below.
fn swapped_palettes(canvas: &mut Canvas) {
    let number = canvas.texture(&indices(1));
    let mut palettes = [0xffff_ffff, 0xff00_ffff, 0xffff_00ff, 0xffff_ff00].map(rainbow);
    let image = texture(TextureFormat::A8R8G8B8, true, [1024, 1], palettes.concat());
    row_of_palettes(canvas, 80.0, number, &palettes);
    palettes.reverse();
    row_of_palettes(canvas, 184.0, number, &palettes);
    let shown = canvas.texture(&image);
    for (first, top) in [(0.0, 340.0), (256.0, 376.0), (512.0, 412.0), (768.0, 448.0)] {
        let edges = unprojected(sized([192.0, top], [256.0, 32.0]));
        canvas.draw(pasted(edges, 1, nearest(shown), [first, 0.0, first + 256.0, 1.0]));
    }
}

/// Draws a palette, the same with all but its first quarter rotated by 31 entries, and that with its channels rotated once and twice.
fn moved_palettes(canvas: &mut Canvas) {
    let number = canvas.texture(&indices(5));
    let first = rainbow(0xffff_ffff);
    let mut moved = first.clone();
    moved[64..].rotate_left(31);
    let turned = |palette: &[u32]| {
        let turn = |word: u32| 0xff00_0000 | (word << 8 | (word & 0xff_ffff) >> 16) & 0xff_ffff;
        palette.iter().enumerate().map(|(n, word)| if n < 64 { *word } else { turn(*word) }).collect::<Vec<u32>>()
    };
    let once = turned(&moved);
    let twice = turned(&once);
    row_of_palettes(canvas, 192.0, number, &[first, moved, once, twice]);
}

/// Adds the frames of Texture_palette.
pub(super) fn palettes(frames: &mut Frames) {
    frames.paint("PaletteSwapping", 0xff33_3333, swapped_palettes);
    frames.paint("XemuHighPaletteBug", 0xff33_3333, moved_palettes);
}

/// Adds the frames of Texture_signed_component_tests: every set of signed channels, over fields of the largest and smallest bytes.
pub(super) fn signed(frames: &mut Frames) {
    let image = |x: u32, y: u32| {
        let (column, row) = (x.wrapping_sub(5), y.wrapping_sub(10));
        let inside = column / 38 < 6 && column % 38 < 36 && row / 53 < 3 && row % 53 < 51;
        if !inside {
            return checker([abgr(0xfffe_fdfc), abgr(0x7f20_2122)], 8)(x, y);
        }
        let channel = 8 * (row / 53);
        let (alpha, lower) = ([0xff, 0x7f, 0][(column / 76) as usize] << 24, column / 38 % 2 == 1);
        let pair = if lower { [0x80, 0] } else { [0xff, 0x7f] };
        checker(pair.map(|value: u32| abgr(alpha | value << channel)), 4)(column % 38, row % 53)
    };
    let texture = images::texture(TextureFormat::A8R8G8B8, SIZE, image);
    // The programs multiply by 1 in a general stage.
    let combiners = program(SPARE);
    blended_ramps(frames);
    for flags in 0..16_u8 {
        let signed = [2, 4, 8, 1].map(|bit| flags & bit != 0);
        let draw = square(1.0, TextureUnit { signed, ..nearest(0) });
        let draw = Draw { combiners: combiners.clone(), ..draw };
        frames.push(format!("A8R8G8B8_0x{flags:04X}"), one(0xfe20_2020, Some(&texture), draw));
    }
}

/// Adds the frames of Texture_signed_component_tests that blend ramps.
fn blended_ramps(frames: &mut Frames) {
    for (name, equation) in [
        ("ADD", BlendEquation::Add),
        ("SADD", BlendEquation::SignedAdd),
        ("SREVSUB", BlendEquation::SignedReverseSubtract),
    ] {
        frames.paint(format!("txt_A8R8G8B8_{name}"), 0, move |canvas| blend_ramps(canvas, equation));
    }
}

/// Blends ramps of each channel, unsigned and signed, with a chequered frame buffer.
pub(super) fn blend_ramps(canvas: &mut Canvas, equation: BlendEquation) {
    let fields = checker([abgr(0xffff_ffff), abgr(0xff7f_7f7f)], 12);
    canvas.frame_buffer().contents = Some(images::words(TextureFormat::A8B8G8R8, super::SIZE.into(), fields).into());
    let sections = places([64.0, 0.0], [256.0, 240.0], 2);
    for (channel, [left, top]) in (0..TEXTURE_UNITS).zip(sections) {
        let bands = [(0xff, false), (0xff, true), (0x7f, false), (0x7f, true)];
        for ((alpha, signed), n) in bands.into_iter().zip(0_u8..) {
            let ramp = move |x: u32, _| {
                let mut color = if channel == 3 { [255; 4] } else { [0, 0, 0, alpha] };
                color[channel] = x as u8;
                color
            };
            let texture = canvas.texture(&images::texture(TextureFormat::A8R8G8B8, [256; 2], ramp));
            let signed = std::array::from_fn(|n| signed && (n == channel));
            let unit = TextureUnit { signed, ..nearest(texture) };
            let band = sized([left, top + 60.0 * f32::from(n)], [256.0, 60.0]);
            let blend = OVER.map(|blend| Blend { equation, ..blend });
            let combiners = program(SPARE);
            canvas.draw(Draw { blend, combiners, ..pasted(band, 0, unit, WHOLE) });
        }
    }
}

/// Passes texture 0 through a general stage.
const SPARE: &str =
    "{ rgb { spare0 = unsigned(tex0); } alpha { spare0 = unsigned(tex0.a); } } out.rgb = spare0; out.a = spare0.a;";

/// Returns a unit with trilinear minification.
fn levels(texture: usize) -> TextureUnit {
    TextureUnit { min_filter: Filter::Linear, mip_filter: MipFilter::Linear, ..nearest(texture) }
}

/// Adds the frame of Texture_LOD_Bias: mip levels of different colours through fifteen biases.
pub(super) fn lod_bias(frames: &mut Frames) {
    frames.paint("LODBias", 0xfe20_2020, move |canvas| {
        // A8B8G8R8.
        let colors = [0xff_0000, 0xff00, 0xff, 0xff_ffff, 0xff_ff00, 0xff_00ff, 0xffff, 0x80_8080];
        let level = |(n, color): (u32, u32)| {
            let fields = checker([color, 0x05_0505].map(|color| abgr(0xff00_0000 | color)), 4);
            images::words(TextureFormat::A8B8G8R8, [512 >> n; 2], fields)
        };
        let words: Vec<u32> = (0..).zip(colors).flat_map(level).collect();
        let of = images::of_words(TextureKind::TwoDimensional, TextureFormat::A8B8G8R8, [512; 2], 8, words);
        let texture = canvas.texture(&of);
        // All levels without a bias, centred on the left.
        for side in [512.0, 256.0, 128.0, 64.0, 32.0, 16.0, 8.0, 4.0] {
            let edges = sized([160.0 - side, 272.0 - side / 2.0], [side; 2]);
            canvas.draw(without_alpha(pasted(edges, 0, levels(texture), WHOLE), FETCHED[0]));
        }
        // In steps of 1/256, truncated.
        let biases = [-3840, -1024, -512, -256, 0, 256, 512, 768, 1024, 3840, -204, 307, 460, 640, 896];
        for (lod_bias, corner) in biases.into_iter().zip(places([192.0, 200.0], [96.0; 2], 5)) {
            let unit = TextureUnit { lod_bias, ..levels(texture) };
            canvas.draw(without_alpha(pasted(sized(corner, [64.0; 2]), 0, unit, WHOLE), FETCHED[0]));
        }
    });
}

/// Adds the frames of Texture_DXT: the programs' images, large and through their mip levels.
pub(super) fn compressed(frames: &mut Frames) {
    for (name, format, size, count, file) in assets::COMPRESSED {
        let words = assets::blocks(format, file);
        let code = format.name();
        let of = |levels, words| images::of_words(TextureKind::TwoDimensional, format, size, levels, words);
        if size[0] == size[1] {
            let first = format.words(size[0], size[1]);
            let texture = of(1, words[..first].to_vec());
            let draw = pasted([192.0, 112.0, 448.0, 368.0], 0, nearest(0), WHOLE);
            frames.push(format!("{code}_{name}"), one(0xfe10_1010, Some(&texture), draw));
        }
        let mut canvas = Canvas::new(0xfe10_1010);
        let texture = canvas.texture(&of(count, words));
        let upper = [(5.0, 256.0), (270.0, 128.0), (410.0, 64.0), (480.0, 32.0), (520.0, 16.0)];
        let lower = [(270.0, 8.0), (280.0, 4.0), (290.0, 2.0), (300.0, 1.0)];
        for (top, row) in [(80.0, &upper[..]), (220.0, &lower)] {
            for (left, side) in row {
                canvas.draw(pasted(sized([*left, top], [*side; 2]), 0, levels(texture), WHOLE));
            }
        }
        frames.push(format!("MIP{code}_{name}"), canvas.colors());
    }
}
