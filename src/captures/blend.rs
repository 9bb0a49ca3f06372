//! ROP-1 to ROP-6: blend equations with all factors, surface formats, the alpha test and the colour mask.

use super::*;
use images::{four_gradients, solid};

/// Names of [`BlendEquation::ALL`] as they appear in the names of frames.
const EQUATIONS: &str = "ADD SUB REVSUB MIN MAX SADD SREVSUB";

/// Names of [`BlendFactor::ALL`] as they appear in the names of frames.
const FACTORS: &str = "0 1 srcRGB 1-srcRGB srcA 1-srcA dstA 1-dstA dstRGB 1-dstRGB srcAsat cRGB 1-cRGB cA 1-cA";

/// Colours (A8B8G8R8) of the nested squares, from the outermost inwards. Their alpha is blended.
const NESTED: [u32; 4] = [0x7f00_cc00, 0xffcc_0000, 0x8000_00ff, 0x00ff_ffff];
/// Colours (A8B8G8R8) of the stacked squares, from the top down.
const STACKED: [u32; 4] = [0xdd00_dd00, 0xdddd_0000, 0xdd00_00dd, 0xddff_ffff];

/// A colour mask that writes red, green and blue, but not alpha.
const COLORS: [bool; 4] = [true, true, true, false];
/// A colour mask that writes alpha only.
const ALPHA: [bool; 4] = [false, false, false, true];
/// A colour mask that writes all channels.
const ALL: [bool; 4] = [true; 4];

/// Returns a rectangle of one A8B8G8R8 colour with the given blend state and colour mask.
fn patch(edges: [f32; 4], color: u32, blend: Option<Blend>, color_mask: [bool; 4]) -> Draw {
    Draw { blend, color_mask, blend_constant: [0x55; 4], ..rectangle(edges, VertexColor::Bytes(abgr(color))) }
}

/// Returns nested squares, each smaller than the last by `inset` on every side. Colours are stored as they are; alpha is blended.
fn nested(blend: Blend, [left, top]: [f32; 2], side: f32, inset: f32) -> Vec<Draw> {
    let square = |(n, color): (u8, u32)| {
        let by = inset * f32::from(n);
        let edges = [left + by, top + by, left + side - by, top + side - by];
        [patch(edges, color, None, COLORS), patch(edges, color, Some(blend), ALPHA)]
    };
    (0..).zip(NESTED).flat_map(square).collect()
}

/// Returns the edges of squares stacked downwards from `corner`, each with its colour.
fn stacked(colors: impl Iterator<Item = u32>, corner: [f32; 2], side: f32) -> impl Iterator<Item = ([f32; 4], u32)> {
    let at = move |n: u8| sized([corner[0], corner[1] + side * f32::from(n)], [side, side]);
    (0..).map(at).zip(colors)
}

/// Returns a stack of squares whose colours are blended and whose alpha is stored as it is.
fn colors_blended(blend: Blend, corner: [f32; 2], side: f32) -> Vec<Draw> {
    let square = |(edges, color)| [patch(edges, color, Some(blend), COLORS), patch(edges, color, None, ALPHA)];
    stacked(STACKED.into_iter(), corner, side).flat_map(square).collect()
}

/// Returns the stack in reverse order, with colours and alpha blended.
fn all_blended(blend: Blend, corner: [f32; 2], side: f32) -> Vec<Draw> {
    let square = |(edges, color)| patch(edges, color, Some(blend), ALL);
    stacked(STACKED.into_iter().rev(), corner, side).map(square).collect()
}

/// Fills the frame buffer with a chequered background.
fn over(canvas: &mut Canvas, background: &Texture) {
    let texture = canvas.texture(background);
    let draw = pasted([0.0, 0.0, 640.0, 480.0], 0, nearest(texture), WHOLE);
    canvas.draw(Draw { blend: None, ..without_alpha(draw, FinalRegister::Texture0) });
}

/// Draws into a target that starts out as the image `first`, then pastes the result into the frame buffer.
fn through(canvas: &mut Canvas, first: &Texture, draws: Vec<Draw>, edges: [f32; 4]) {
    let target = canvas.painted(first, SurfaceFormat::A8R8G8B8, draws);
    let texture = canvas.shown(target, TextureKind::TwoDimensional, TextureFormat::A8B8G8R8);
    canvas.draw(pasted(edges, 1, nearest(texture), WHOLE));
}

/// Adds the frames of Blend_tests: a large frame for each pair of factors, and a frame with every destination factor for each source factor.
pub(super) fn tests(frames: &mut Frames) {
    let grey = |dark: u32, size| checker([abgr(dark), abgr(0xff00_0000)], size);
    let background = |size| images::texture(TextureFormat::A8B8G8R8, [256, 256], grey(0xff20_2020, size));
    let first = |size, field| Arc::new(images::texture(TextureFormat::A8B8G8R8, size, grey(0x3333_3333, field)));
    let (large, small) = (Arc::new(background(24)), Arc::new(background(16)));
    let (square, strip, sheet) = (first([256, 256], 16), first([64, 256], 16), first([512, 512], 8));
    for (equation_name, equation) in named(EQUATIONS) {
        for (source_name, source) in named(FACTORS) {
            for (name, destination) in named(FACTORS) {
                if (source, destination) == (BlendFactor::Zero, BlendFactor::Zero) {
                    continue;
                }
                let blend = Blend { equation, source, destination };
                let [large, square, strip] = [&large, &square, &strip].map(Arc::clone);
                frames.paint(format!("{source_name}_{equation_name}_{name}"), 0xff31_2f31, move |canvas| {
                    over(canvas, &large);
                    let origin = [0.0, 0.0];
                    let tall = |left| sized([left, 112.0], [64.0, 256.0]);
                    through(canvas, &square, nested(blend, origin, 256.0, 24.0), [192.0, 112.0, 448.0, 368.0]);
                    through(canvas, &strip, colors_blended(blend, origin, 64.0), tall(16.0));
                    through(canvas, &strip, all_blended(blend, origin, 64.0), tall(560.0));
                });
            }
            let [small, sheet] = [&small, &sheet].map(Arc::clone);
            frames.paint(format!("#spot_{source_name}_{equation_name}"), 0xff31_2f31, move |canvas| {
                over(canvas, &small);
                let mut draws = Vec::new();
                for (&destination, corner) in BlendFactor::ALL.iter().zip(places([0.0; 2], [103.0, 136.0], 5)) {
                    let blend = Blend { equation, source, destination };
                    let [left, top] = corner;
                    draws.extend(colors_blended(blend, corner, 24.0));
                    draws.extend(all_blended(blend, [left + 24.0, top], 24.0));
                    draws.extend(nested(blend, [left + 48.0, top], 51.0, 4.0));
                }
                through(canvas, &sheet, draws, [64.0, 64.0, 576.0, 576.0]);
            });
        }
    }
}

/// The surface formats of Blend_surface: name in the frames, format, and the texture format that reads their words.
const SURFACES: [(&str, SurfaceFormat, TextureFormat); 8] = [
    ("X_Z1RGB5", SurfaceFormat::X1R5G5B5Z, TextureFormat::A1R5G5B5),
    ("X_O1RGB5", SurfaceFormat::X1R5G5B5O, TextureFormat::A1R5G5B5),
    ("R5G6B5", SurfaceFormat::R5G6B5, TextureFormat::R5G6B5),
    ("X_ZRGB8", SurfaceFormat::X8R8G8B8Z, TextureFormat::A8R8G8B8),
    ("X_ORGB8", SurfaceFormat::X8R8G8B8O, TextureFormat::A8R8G8B8),
    ("XA_Z1A7RGB8", SurfaceFormat::X1A7R8G8B8Z, TextureFormat::A8R8G8B8),
    ("XA_O1A7RGB8", SurfaceFormat::X1A7R8G8B8O, TextureFormat::A8R8G8B8),
    ("ARGB8", SurfaceFormat::A8R8G8B8, TextureFormat::A8R8G8B8),
];

/// Side of a tile in pixels.
const TILE: f32 = 128.0;
const WHOLE_TILE: [f32; 4] = [0.0, 0.0, TILE, TILE];

/// Returns the corners of tiles, four in a row, with `down` pixels from one row to the next.
fn tiles(down: f32) -> impl Iterator<Item = [f32; 2]> {
    places([32.0, 92.0], [144.0, down], 4)
}

/// Draws into a new target of one tile. Returns the texture that reads it in the format `read`.
fn tile(canvas: &mut Canvas, format: SurfaceFormat, draws: Vec<Draw>, read: TextureFormat) -> usize {
    let target = canvas.target(Target::new(128, 128, format));
    canvas.draw_into(target, draws);
    canvas.shown(target, TextureKind::Rectangle, read)
}

/// Draws eight tiles in which the destination's alpha is a blend factor. Shows the upper half of each blended into the frame buffer, and the lower
/// half opaque.
fn destination_alpha(canvas: &mut Canvas, format: SurfaceFormat, read: TextureFormat, factor: BlendFactor) {
    let colors = [0, 0x4000_0000, 0x8000_0000, 0xff00_0000, 0x00ff_0000, 0x40ff_0000, 0x80ff_0000, 0xffff_0000];
    for (color, [x, y]) in colors.into_iter().zip(tiles(160.0)) {
        let whole = unprojected(WHOLE_TILE);
        let blend = Blend { equation: BlendEquation::Add, source: factor, destination: BlendFactor::Zero };
        let draws = vec![patch(whole, color, None, ALL), patch(whole, 0x22ff_ffff, Some(blend), ALL)];
        let texture = tile(canvas, format, draws, read);
        let half = |y| pasted(unprojected(sized([x, y], [TILE, TILE / 2.0])), 0, nearest(texture), WHOLE_TILE);
        canvas.draw(half(y));
        canvas.draw(without_alpha(half(y + TILE / 2.0), FinalRegister::Texture0));
    }
}

/// Returns an image of 4-bit channels, held in the high half of a byte: red grows downwards, blue falls to the right, green runs across, and alpha is
/// highest in the middle.
fn four_bits(side: u32) -> impl images::Image {
    let last = f32::from((side - 1) as u16);
    let middle = last / 2.0;
    move |x, y| {
        let [x, y] = [x, y].map(|at| f32::from(at as u16));
        let [dx, dy] = [x - middle, y - middle];
        let alpha = 15.0 * (1.0 - (dx * dx + dy * dy) / (middle * middle + middle * middle));
        let (right, down) = (x / last, y / last);
        let green = (15.0 * right) * (1.0 - down) + (15.0 * (1.0 - right)) * down;
        [15.0 * down, green, 15.0 * (1.0 - right), alpha].map(|value| (value as u8) << 4)
    }
}

/// Texture formats that are blended into each surface format.
const BLENDED: [TextureFormat; 7] = [
    TextureFormat::A8B8G8R8,
    TextureFormat::X8R8G8B8,
    TextureFormat::R5G6B5,
    TextureFormat::R6G5B5,
    TextureFormat::X1R5G5B5,
    TextureFormat::A1R5G5B5,
    TextureFormat::A4R4G4B4,
];

/// Draws tiles in which each texture is blended four times with an offset, and small squares in the corners once or four times.
fn textures_blended(canvas: &mut Canvas, format: SurfaceFormat, read: TextureFormat, destination: BlendFactor) {
    let blend = Some(Blend { equation: BlendEquation::Add, source: BlendFactor::SourceAlpha, destination });
    for (number, (blended, place)) in BLENDED.into_iter().zip(tiles(144.0)).enumerate() {
        let side = [64, 64];
        let (written, picture, grey, hole) = if number < 2 {
            let picture = images::texture(TextureFormat::A8B8G8R8, side, four_gradients(side));
            (TextureFormat::A8B8G8R8, picture, [0x44; 4], abgr(0x00ff_ff55))
        } else {
            let picture = images::texture(TextureFormat::A4R4G4B4, side, four_bits(64));
            (TextureFormat::A4R4G4B4, picture, [0x40; 4], [0xf0, 0xf0, 0x50, 0])
        };
        let [grey, hole] = [grey, hole].map(|color| images::texture(written, [8, 8], solid(color)));
        let [picture, grey, hole] = [picture, grey, hole].map(|image| canvas.texture(&images::read_as(image, blended)));
        let first = rectangle(unprojected(WHOLE_TILE), VertexColor::Floats([0.1, 0.1, 0.1, 0.7]));
        let mut draws = vec![Draw { blend: None, ..first }];
        let mut put = |texture, unit, corner, side, times| {
            let edges = unprojected(sized(corner, [side, side]));
            let draw = Draw { blend, ..pasted(edges, unit, nearest(texture), WHOLE) };
            draws.extend(std::iter::repeat_n(draw, times));
        };
        for n in [12.0, 24.0, 36.0, 48.0] {
            put(picture, 1, [n, n], 64.0, 1);
        }
        put(grey, 2, [0.0, 0.0], 8.0, 1);
        put(grey, 2, [120.0, 0.0], 8.0, 4);
        put(hole, 3, [0.0, 120.0], 8.0, 1);
        put(hole, 3, [120.0, 120.0], 8.0, 4);
        let texture = tile(canvas, format, draws, read);
        let draw = pasted(unprojected(sized(place, [TILE, TILE])), 0, nearest(texture), WHOLE_TILE);
        canvas.draw(Draw { blend: None, ..without_alpha(draw, FinalRegister::Texture0) });
    }
}

/// Adds the frames of Blend_surface.
pub(super) fn surfaces(frames: &mut Frames) {
    for (name, format, read) in SURFACES {
        for (prefix, factor) in
            [("DstAlpha", BlendFactor::DestinationAlpha), ("1-DstAlpha", BlendFactor::OneMinusDestinationAlpha)]
        {
            frames.paint(format!("{prefix}_{name}"), 0xff55_5555, move |canvas| {
                destination_alpha(canvas, format, read, factor)
            });
        }
        for (suffix, factor) in [("1-SrcA", BlendFactor::OneMinusSourceAlpha), ("DstA", BlendFactor::DestinationAlpha)]
        {
            frames.paint(format!("{name}_Add_SrcA_{suffix}"), 0xff55_5555, move |canvas| {
                textures_blended(canvas, format, read, factor)
            });
        }
    }
}

/// Draws a picture, blended and opaque, into zeroed memory of a surface format. The frame then reads that memory as 32 bits per pixel, whatever the
/// format.
fn surface_format(format: SurfaceFormat) -> FrameDrawing {
    let blend = if surface::blends(format) && format != SurfaceFormat::R5G6B5 { OVER } else { None };
    let mut before = Canvas::new(0);
    let size = [128, 128];
    let picture = images::texture(TextureFormat::A8B8G8R8, size, four_gradients(size));
    let picture = images::in_texels(images::read_as(picture, TextureFormat::A8R8G8B8));
    let unit = nearest(before.texture(&picture));
    // The memory is as large as 480 rows of 32 bits, also where the format is narrower.
    let (width, height) = (640, 480 * 4 / format.bytes());
    let contents = Some(vec![0; (width * height) as usize].into());
    *before.frame_buffer() = Target { contents, ..Target::new(width, height, format) };
    let draw = |left: f32| pasted(sized([left, 96.0], [TILE, TILE]), 3, unit, WHOLE_TILE);
    before.draw(Draw { blend, ..without_alpha(draw(184.0), FinalRegister::Texture3) });
    before.draw(Draw { blend, ..draw(328.0) });
    let mut canvas = Canvas::new(0);
    let shown = nearest(canvas.texture(&images::blank(TextureFormat::A8R8G8B8, SIZE.into())));
    let fields = checker([abgr(0xff20_2020), abgr(0xff00_0000)], 8);
    let words = images::words(TextureFormat::A8B8G8R8, [640, 480], fields);
    canvas.frame_buffer().contents = Some(words.into());
    let half = |top: f32| pasted(sized([0.0, top], [640.0, 240.0]), 0, shown, [0.0, 0.0, 640.0, 240.0]);
    canvas.draw(half(0.0));
    canvas.draw(without_alpha(half(240.0), FinalRegister::Texture0));
    let before = vec![before.colors().scene];
    FrameDrawing { before, ..canvas.colors() }
}

/// Adds the frames of Surface_format.
pub(super) fn surface_formats(frames: &mut Frames) {
    let names = "A8R8G8B8 X8R8G8B8_Z8R8G8B8 X8R8G8B8_O8R8G8B8 R5G6B5 X1R5G5B5_Z1R5G5B5 X1R5G5B5_O1R5G5B5 \
                 X1A7R8G8B8_Z1A7R8G8B8 X1A7R8G8B8_O1A7R8G8B8 B8 G8B8";
    for (name, format) in named(names) {
        frames.make(format!("Fmt_{name}"), move || surface_format(format));
    }
}

/// Adds the frames of Alpha_func: wide and steep ramps of alpha, and a rectangle of one alpha.
pub(super) fn alpha_function(frames: &mut Frames) {
    let names = "Never LessThan Equal LessThanOrEqual GreaterThan NotEqual GreaterThanOrEqual Always";
    for (name, function) in named(names) {
        for (state, enabled) in [("Enabled", true), ("Disabled", false)] {
            let mut canvas = Canvas::new(0xff22_2322);
            let mut top = (480.0 - 256.0) / 3.0 * 2.0;
            for ([r, g, b], left, right) in
                [([1.0, 0.0, 0.0], 0.0, 1.0), ([0.0, 0.0, 1.0], 1.0, 0.0), ([0.0, 1.0, 0.0], 0.495, 0.505)]
            {
                let corners =
                    [(64.0, top, left), (576.0, top, right), (576.0, top + 64.0, right), (64.0, top + 64.0, left)];
                let corner = |(x, y, a)| vertex([x, y], VertexColor::Floats([r, g, b, a]));
                canvas.draw(draw(Topology::Quads, corners.map(corner).to_vec()));
                top += 64.0;
            }
            canvas.draw(rectangle([0.0, top, 640.0, top + 32.0], VertexColor::Bytes(abgr(0x7fff_ffff))));
            let FrameDrawing { mut scene, .. } = canvas.colors();
            for draw in &mut scene.draws {
                draw.alpha_test = enabled.then_some(AlphaTest { function, reference: 127 });
            }
            frames.push(format!("AlphaFunc{name}_{state}"), FrameDrawing::colors(scene));
        }
    }
}

/// Adds the frame of Color_mask_blend: the destination's alpha is a blend factor while alpha itself is not written.
pub(super) fn color_mask(frames: &mut Frames) {
    let mut canvas = Canvas::new(0x3022_2222);
    for (edges, color) in [
        ([20.0, 120.0, 320.0, 360.0], 0xccff_ffff),
        ([180.0, 130.0, 310.0, 350.0], 0xff00_0000),
        ([330.0, 130.0, 470.0, 350.0], 0x2277_99ff),
    ] {
        canvas.draw(rectangle(edges, VertexColor::Bytes(abgr(color))));
    }
    let mut alphas = [0.5_f32, 1.0, 0.9, 0.75];
    for left in [71.0, 213.0, 355.0, 497.0] {
        let corners = corners(sized([left, 180.0], [71.0, 120.0]));
        let colors = [[1.0, 0.0, 0.0], [0.5; 3], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]];
        let corner = |n: usize| {
            let [r, g, b] = colors[n];
            vertex(corners[n], VertexColor::Floats([r, g, b, alphas[n]]))
        };
        let source = BlendFactor::DestinationAlpha;
        let blend = Some(Blend { equation: BlendEquation::Add, source, destination: BlendFactor::Zero });
        let triangles = draw(Topology::Triangles, [0, 1, 2, 0, 2, 3].map(corner).to_vec());
        canvas.draw(Draw { blend, color_mask: COLORS, ..triangles });
        alphas = alphas.map(|alpha| alpha * 0.75);
    }
    frames.push("C00010101_O32774_S772_D0", canvas.colors());
}
