//! TEX-1 to TEX-4, TEX-7 to TEX-9, TEX-18: formats of texels, palettes, signed channels, levels, addressing and borders.

use super::draws::{Canvas, FETCHED, WHOLE, abgr, argb, draw, nearest, pasted, sized, unprojected, without_alpha};
use super::images::{self, Color, Image, bulge, checker, gradient, grey};
use super::{Drawn, Frames, assets, space};
use ninebit::state::{
    AddressMode, BORDER_TEXELS, Combiners, Draw, Filter, FinalRegister, GeneralStage, MipFilter, Named, Register,
    ShaderStage, TEXTURE_UNITS, Texels, Texture, TextureFormat, TextureImage, TextureKind, TextureUnit, Topology,
    Vertex, VertexColor,
};

/// A square of two triangles as a vertex program shows it, whose first unit has a texture. `side`: coordinates of its far edges.
fn square(side: f32, unit: TextureUnit) -> Draw {
    let corners = [[-0.75, 0.75], [0.75, 0.75], [0.75, -0.75], [-0.75, -0.75]];
    let texels = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
    let vertex = |n: usize| {
        let [s, t] = texels[n];
        Vertex {
            position: space::vertex_program(corners[n]),
            texture_coordinates: [[s, t, 0.0, 1.0]; TEXTURE_UNITS],
            diffuse: VertexColor::Bytes([255; 4]),
            ..Vertex::default()
        }
    };
    let draw = draw(Topology::Triangles, [0, 1, 2, 0, 2, 3].map(vertex).to_vec());
    let mut draw = Draw { combiners: Combiners::showing(FETCHED[0]), ..draw };
    draw.textures[0] = Some(unit);
    draw.texture_shader[0] = ShaderStage::conventional(0, true);
    draw
}

const SIDE: u32 = 256;
const SIZE: [u32; 2] = [SIDE; 2];

/// What the programs show in a format.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Content {
    Colors,
    Grey,
}

/// Formats of one picture by the names of frames, and whether there is one in coordinates of texels too.
const FORMATS: [(&str, TextureFormat, Content, bool); 17] = [
    ("A8R8G8B8", TextureFormat::A8R8G8B8, Content::Colors, true),
    ("A8B8G8R8", TextureFormat::A8B8G8R8, Content::Colors, true),
    ("B8G8R8A8", TextureFormat::B8G8R8A8, Content::Colors, true),
    ("R8G8B8A8", TextureFormat::R8G8B8A8, Content::Colors, true),
    ("X8R8G8B8", TextureFormat::X8R8G8B8, Content::Colors, true),
    ("R5G6B5", TextureFormat::R5G6B5, Content::Colors, true),
    ("A1R5G5B5", TextureFormat::A1R5G5B5, Content::Colors, true),
    ("X1R5G5B5", TextureFormat::X1R5G5B5, Content::Colors, true),
    ("A4R4G4B4", TextureFormat::A4R4G4B4, Content::Colors, true),
    ("G8B8", TextureFormat::G8B8, Content::Colors, true),
    ("R8B8", TextureFormat::R8B8, Content::Colors, false),
    ("R16B16", TextureFormat::R16B16, Content::Colors, true),
    ("Y8", TextureFormat::L8, Content::Grey, true),
    ("AY8", TextureFormat::I8, Content::Grey, true),
    ("A8Y8", TextureFormat::A8L8, Content::Grey, false),
    ("Y16", TextureFormat::Y16, Content::Grey, true),
    ("R6G5B5", TextureFormat::R6G5B5, Content::Colors, false),
];

/// A format of the frames: its name there, whether its texture is grey, and whether its coordinates are texels.
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

/// All formats, in both kinds of coordinates where there are frames of both.
pub(super) fn variants() -> impl Iterator<Item = Variant> {
    let formats = FORMATS.into_iter().chain([("A8", TextureFormat::A8, Content::Colors, true)]);
    formats.flat_map(|(base, format, content, both)| {
        let variant = |in_texels| Variant { base, format, is_grey: content == Content::Grey, in_texels };
        [Some(variant(false)), both.then(|| variant(true))].into_iter().flatten()
    })
}

/// An image as words: of 16 bits a channel the programs write a byte twice, and of luminance they scale its byte.
pub(super) fn packed(format: TextureFormat, size: [u32; 2], image: impl Image) -> Vec<u32> {
    let wide = |color: Color| match format {
        TextureFormat::R16B16 => {
            let [r, _, b, _] = color.map(u32::from);
            ((r * 0x101) << 16) | (b * 0x101)
        }
        TextureFormat::Y16 => (f32::from(color[0]) / 255.0 * 65535.0) as u32,
        _ => ninebit_files::texels::word(color, format),
    };
    let rows = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    rows.map(|(x, y)| wide(image(x, y))).collect()
}

/// Words of a texture whose kind says how its coordinates count.
pub(super) fn texture(format: TextureFormat, in_texels: bool, size: [u32; 2], words: Vec<u32>) -> Texture {
    let kind = if in_texels { TextureKind::Rectangle } else { TextureKind::TwoDimensional };
    images::of_words(kind, format, size, 1, words)
}

fn shown(texture: &Texture, unit: TextureUnit) -> Drawn {
    let mut canvas = Canvas::new(0xfe20_2020);
    canvas.texture(texture);
    canvas.draw(square(if texture.kind == TextureKind::Rectangle { SIDE as f32 } else { 1.0 }, unit));
    canvas.colors()
}

/// Where a texel of a swizzled square lies in memory.
fn swizzled(x: u32, y: u32) -> u32 {
    (0..8).map(|bit| (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1)).sum()
}

/// The gradient of 32 bits, whose memory is read as if every byte were a texel; as alpha, in the lowest byte, red, green and blue.
fn bytes_of_gradient(is_swizzled: bool) -> Vec<u32> {
    let mut memory = vec![0; (4 * SIDE * SIDE) as usize];
    let image = gradient(SIZE);
    for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
        let at = 4 * if is_swizzled { swizzled(x, y) } else { y * SIDE + x } as usize;
        let [r, g, b, a] = image(x, y).map(u32::from);
        memory[at..at + 4].copy_from_slice(&[a, r, g, b]);
    }
    let place = |x, y| if is_swizzled { swizzled(x, y) } else { y * SIDE + x };
    (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))).map(|(x, y)| memory[place(x, y) as usize]).collect()
}

/// Blocks of four colours of which the first is black and the second an upper left texel of the gradient, chosen by its alpha.
fn blocks_of_gradient() -> Vec<u32> {
    let image = gradient(SIZE);
    let corners = (0..SIDE / 4).flat_map(|y| (0..SIDE / 4).map(move |x| (4 * x, 4 * y)));
    let block = |(x, y)| {
        let [r, g, b, a] = image(x, y).map(u32::from);
        let color = (((r & 0xf8) + (g >> 5)) << 8) | (((g & 0x1c) << 3) + (b >> 3));
        [color << 16, if a >= 125 { 0x5555_5555 } else { 0xffff_ffff }]
    };
    corners.flat_map(block).collect()
}

/// Blue, green, red and grey, each falling from full in a quarter of the entries.
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

/// Texture_format.
pub(super) fn formats() -> Frames {
    let mut frames = Frames::default();
    for variant in variants() {
        let name = format!("TexFmt_{}", variant.name());
        frames.make(name, move || {
            let Variant { format, is_grey, in_texels, .. } = variant;
            let words = match format {
                TextureFormat::A8 => bytes_of_gradient(!in_texels),
                // The programs write words R5G6B5.
                TextureFormat::R6G5B5 => packed(TextureFormat::R5G6B5, SIZE, gradient(SIZE)),
                format if is_grey => packed(format, SIZE, grey(gradient(SIZE))),
                format => packed(format, SIZE, gradient(SIZE)),
            };
            shown(&texture(format, in_texels, SIZE, words), nearest(0))
        });
    }
    for length in [256, 128, 64, 32] {
        frames.make(format!("TexFmt_SZ_Index8_p{length}"), move || {
            let index = |n: u32| if n < SIDE * SIDE / 2 { n } else { n & !3 };
            let words = (0..SIDE * SIDE).map(|n| index(n) & (length - 1)).collect();
            let mut canvas = Canvas::new(0xfe20_2020);
            canvas.texture(&texture(TextureFormat::P8, false, SIZE, words));
            let palette = Some(canvas.palette(ramps(length)));
            canvas.draw(square(1.0, TextureUnit { palette, ..nearest(0) }));
            canvas.colors()
        });
    }
    frames.make("TexFmt_DXT1", || shown(&texture(TextureFormat::Dxt1, false, SIZE, blocks_of_gradient()), nearest(0)));
    frames
}

/// A palette whose red grows, green falls and blue repeats, under a mask.
fn rainbow(mask: u32) -> Vec<u32> {
    (0..256).map(|n| (0xff << 24 | n << 16 | (255 - n) << 8 | (4 * n) & 255) & mask).collect()
}

/// Squares of an image of indices in a row, each through another palette.
fn row_of_palettes(canvas: &mut Canvas, top: f32, texture: usize, palettes: &[Vec<u32>]) {
    let mut left = 51.0;
    for palette in palettes {
        let palette = Some(canvas.palette(palette.iter().copied()));
        let edges = unprojected(sized([left, top], [96.0, 96.0]));
        canvas.draw(pasted(edges, 0, TextureUnit { palette, ..nearest(texture) }, WHOLE));
        left += 147.0;
    }
}

/// Indices that are highest in the middle, times a factor.
fn indices(factor: u32) -> Texture {
    let distance = bulge([128, 128]);
    let words = (0..128).flat_map(|y| (0..128).map(move |x| (x, y)));
    let words = words.map(|(x, y)| (u32::from(distance(x, y)) * factor) & 255).collect();
    texture(TextureFormat::P8, false, [128, 128], words)
}

/// Four palettes, each but the first without one channel, also in the other order; below them the palettes themselves.
fn swapped_palettes() -> Drawn {
    let mut canvas = Canvas::new(0xff33_3333);
    let number = canvas.texture(&indices(1));
    let mut palettes = [0xffff_ffff, 0xff00_ffff, 0xffff_00ff, 0xffff_ff00].map(rainbow);
    let image = texture(TextureFormat::A8R8G8B8, true, [1024, 1], palettes.concat());
    row_of_palettes(&mut canvas, 80.0, number, &palettes);
    palettes.reverse();
    row_of_palettes(&mut canvas, 184.0, number, &palettes);
    let shown = canvas.texture(&image);
    for (first, top) in [(0.0, 340.0), (256.0, 376.0), (512.0, 412.0), (768.0, 448.0)] {
        let edges = unprojected(sized([192.0, top], [256.0, 32.0]));
        canvas.draw(pasted(edges, 1, nearest(shown), [first, 0.0, first + 256.0, 1.0]));
    }
    canvas.colors()
}

/// One palette, of which all but the first quarter is moved by 31 entries, and has its channels changed about, twice.
fn moved_palettes() -> Drawn {
    let mut canvas = Canvas::new(0xff33_3333);
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
    row_of_palettes(&mut canvas, 192.0, number, &[first, moved, once, twice]);
    canvas.colors()
}

/// Texture_palette.
pub(super) fn palettes() -> Frames {
    let mut frames = Frames::default();
    frames.make("PaletteSwapping", swapped_palettes);
    frames.make("XemuHighPaletteBug", moved_palettes);
    frames
}

/// Texture_signed_component_tests: every set of signed channels. Fields of largest and smallest bytes stand in a larger one.
pub(super) fn signed() -> Frames {
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
    let mut stage = GeneralStage::initial([[0; 4]; 2]);
    for portion in [&mut stage.rgb, &mut stage.alpha] {
        (portion.inputs[0].register, portion.ab_output) = (Register::Texture0, Register::Spare0);
        portion.sum_output = Register::Zero;
    }
    let combiners = Combiners { stages: vec![stage], ..Combiners::showing(FinalRegister::Spare0) };
    let mut frames = Frames::default();
    for flags in 0..16_u8 {
        let signed = [2, 4, 8, 1].map(|bit| flags & bit != 0);
        let mut canvas = Canvas::new(0xfe20_2020);
        canvas.texture(&texture);
        let draw = square(1.0, TextureUnit { signed, ..nearest(0) });
        canvas.draw(Draw { combiners: combiners.clone(), ..draw });
        frames.push(format!("A8R8G8B8_0x{flags:04X}"), canvas.colors());
    }
    frames
}

/// A unit that mixes two levels where the texture is minified.
fn levels(texture: usize) -> TextureUnit {
    TextureUnit { min_filter: Filter::Linear, mip_filter: MipFilter::Linear, ..nearest(texture) }
}

/// Texture_LOD_Bias: levels of other colours through fifteen biases.
pub(super) fn lod_bias() -> Frames {
    let mut frames = Frames::default();
    frames.make("LODBias", || {
        let colors = [
            [0, 0, 255],
            [0, 255, 0],
            [255, 0, 0],
            [255, 255, 255],
            [0, 255, 255],
            [255, 0, 255],
            [255, 255, 0],
            [128, 128, 128],
        ];
        let level = |(n, [r, g, b]): (u32, [u8; 3])| {
            let fields = checker([[r, g, b, 255], [5, 5, 5, 255]], 4);
            images::words(TextureFormat::A8B8G8R8, [512 >> n; 2], fields)
        };
        let words: Vec<u32> = (0..).zip(colors).flat_map(level).collect();
        let mut canvas = Canvas::new(0xfe20_2020);
        let of = images::of_words(TextureKind::TwoDimensional, TextureFormat::A8B8G8R8, [512; 2], 8, words);
        let texture = canvas.texture(&of);
        // All levels as they are, centred on the left.
        for side in [512.0, 256.0, 128.0, 64.0, 32.0, 16.0, 8.0, 4.0] {
            let edges = sized([160.0 - side, 272.0 - side / 2.0], [side; 2]);
            canvas.draw(without_alpha(pasted(edges, 0, levels(texture), WHOLE), FETCHED[0]));
        }
        let mut corner = [192.0, 200.0];
        // 1/256 steps, cut.
        for lod_bias in [-3840, -1024, -512, -256, 0, 256, 512, 768, 1024, 3840, -204, 307, 460, 640, 896] {
            let unit = TextureUnit { lod_bias, ..levels(texture) };
            canvas.draw(without_alpha(pasted(sized(corner, [64.0; 2]), 0, unit, WHOLE), FETCHED[0]));
            corner[0] += 96.0;
            if corner[0] + 64.0 > 640.0 {
                corner = [192.0, corner[1] + 96.0];
            }
        }
        canvas.colors()
    });
    frames
}

/// Texture_DXT: the programs' images, large and through their levels.
pub(super) fn compressed() -> Frames {
    let mut frames = Frames::default();
    for (name, format, size, count, file) in assets::COMPRESSED {
        let words = assets::blocks(format, file);
        let code = format.name();
        let of = |levels, words| images::of_words(TextureKind::TwoDimensional, format, size, levels, words);
        if size[0] == size[1] {
            let mut canvas = Canvas::new(0xfe10_1010);
            let first = format.words(size[0], size[1]);
            let texture = canvas.texture(&of(1, words[..first].to_vec()));
            canvas.draw(pasted([192.0, 112.0, 448.0, 368.0], 0, nearest(texture), WHOLE));
            frames.push(format!("{code}_{name}"), canvas.colors());
        }
        let mut canvas = Canvas::new(0xfe10_1010);
        let texture = canvas.texture(&of(count, words));
        for ([left, top], side) in [
            ([5.0, 80.0], 256.0),
            ([270.0, 80.0], 128.0),
            ([410.0, 80.0], 64.0),
            ([480.0, 80.0], 32.0),
            ([520.0, 80.0], 16.0),
            ([270.0, 220.0], 8.0),
            ([280.0, 220.0], 4.0),
            ([290.0, 220.0], 2.0),
            ([300.0, 220.0], 1.0),
        ] {
            canvas.draw(pasted(sized([left, top], [side; 2]), 0, levels(texture), WHOLE));
        }
        frames.push(format!("MIP{code}_{name}"), canvas.colors());
    }
    frames
}

/// Eight colours that go on from row to row, in fields of so many texels.
fn blocks(colors: [Color; 8], size: u32) -> impl Image {
    move |x, y| colors[((x / size + y / size) % 8) as usize]
}

fn pale(color: Color) -> [Color; 2] {
    [color, [color[0], color[1], color[2], 0x66]]
}

/// Red, green, blue and white, each once opaque and once not.
fn colors(first: Color, third: Color) -> [Color; 8] {
    let [a, b] = pale(first);
    let [c, d] = pale([0, 255, 0, 255]);
    let [e, f] = pale(third);
    let [g, h] = pale([255; 4]);
    [a, b, c, d, e, f, g, h]
}

/// An image with border texels: a chequered field of grey around coloured ones. Of the programs' image of twice the size only four texels on each side are read.
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

/// Nine squares of a group, with the coordinates of their upper left corners.
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

/// A rectangle of the world at z = 1, whose w its corners have.
fn in_world([left, top, right, bottom]: [f32; 4], unit: TextureUnit, coordinates: [f32; 4]) -> Draw {
    let [x0, y0, _, w] = space::fixed_function([left, top, 1.0, 1.0]);
    let [x1, y1, ..] = space::fixed_function([right, bottom, 1.0, 1.0]);
    let draw = pasted([x0, y0, x1, y1], 0, unit, coordinates);
    let vertices = draw.vertices.iter().map(|vertex| {
        let [x, y, z, _] = vertex.position;
        Vertex { position: [x, y, z, w], ..vertex }
    });
    Draw { vertices: vertices.collect(), ..draw }
}

/// One texture through every address mode; in `with_border` one of border texels too.
fn modes(border_color: Color, other_color: Option<Color>) -> Drawn {
    let mut canvas = Canvas::new(0xfe20_2020);
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
                    // As far as the border texels go.
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
    canvas.colors()
}

/// Textures with border texels in nine sizes, without the border and with it.
fn border_sizes() -> Drawn {
    let sizes = [[1, 1], [2, 2], [4, 4], [8, 8], [16, 16], [32, 32], [16, 1], [8, 2], [4, 8]];
    let mut canvas = Canvas::new(0xfe18_1818);
    let textures = sizes.map(|size| canvas.texture(&bordered(size)));
    for (top, shows_border) in [(80.0, false), (272.0, true)] {
        let mut corner = [32.0, top];
        for ([width, height], texture) in sizes.into_iter().zip(textures) {
            let [s, t] = [width, height].map(|side| if shows_border { 4.0 / side as f32 } else { 0.0 });
            let unit = addressed(AddressMode::ClampToBorder, [0; 4], nearest(texture));
            canvas.draw(pasted(sized(corner, [64.0; 2]), 0, unit, [-s, -t, 1.0 + s, 1.0 + t]));
            corner[0] += 96.0;
            if corner[0] >= 32.0 + 96.0 * 6.0 {
                corner = [32.0, corner[1] + 96.0];
            }
        }
    }
    canvas.colors()
}

/// Texture_border, without its cube maps.
pub(super) fn borders() -> Frames {
    let mut frames = Frames::default();
    frames.make("2D", || modes([255, 0, 255, 0xf0], None));
    frames.make("xemu#1034", || modes([0x55, 0x9f, 0xff, 0xf0], Some([0xff, 0x55, 0x33, 0xf0])));
    frames.make("2D_BorderTex_SZ", border_sizes);
    frames
}

/// Texture_border_color: the border colour beside texels of every format.
pub(super) fn border_color() -> Frames {
    use TextureFormat::*;
    let formats = [A8, R5G6B5, R8B8, G8B8, R6G5B5, A8R8G8B8, X8R8G8B8, A8B8G8R8, B8G8R8A8, R8G8B8A8];
    let in_texels = [A8, R5G6B5, G8B8, X1R5G5B5, A8R8G8B8, X8R8G8B8, A8B8G8R8, B8G8R8A8, R8G8B8A8];
    let mut frames = Frames::default();
    frames.make("TextureBorderColor", move || {
        let mut canvas = Canvas::new(0xff10_1010);
        let fields = checker([abgr(0xff00_0000), abgr(0xff44_4444)], 8);
        let background = canvas.texture(&images::texture(A8B8G8R8, SIZE, fields));
        let behind = pasted(unprojected([0.0, 0.0, 640.0, 480.0]), 0, nearest(background), WHOLE);
        canvas.draw(without_alpha(behind, FETCHED[0]));
        let mut corner = [64.0, 96.0];
        let all = formats.map(|format| (format, false)).into_iter().chain(in_texels.map(|format| (format, true)));
        for (format, in_texels) in all {
            // Every byte is 0x80.
            let word = 0x8080_8080 & ninebit_files::texels::used_bits(format);
            let number = canvas.texture(&texture(format, in_texels, [8, 8], vec![word; 64]));
            let unit = addressed(AddressMode::ClampToBorder, argb(0x33ff_22cc), nearest(number));
            let (low, high) = if in_texels { (-4.0, 12.0) } else { (-0.5, 1.5) };
            canvas.draw(pasted(unprojected(sized(corner, [64.0; 2])), 0, unit, [low, low, high, high]));
            corner[0] += 99.0;
            if corner[0] > 640.0 - 99.0 {
                corner = [64.0, corner[1] + 99.0];
            }
        }
        canvas.colors()
    });
    frames
}
