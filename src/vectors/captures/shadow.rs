//! SHD-1: a picture of depths, as large as the frame, compared by eight functions with one r; in three dimensions and in two.

use super::draws::{corners, nearest, quads, rectangle, textured, with_primary_alpha};
use super::{Frames, SIZE, images, named};
use ninebit::state::*;

/// Names of [`CompareFunction::ALL`] in those of frames.
const FUNCTIONS: &str = "N LT EQ LE GT NE GE A";

/// Formats, the bits of names, and least, greatest and reference word.
const RANGES: [(TextureFormat, u32, [u32; 3]); 6] = [
    (TextureFormat::Z16, 16, [0, 0xffff, 0x7fff]),
    (TextureFormat::Z16, 16, [0, 256, 128]),
    (TextureFormat::Z16, 16, [256, 512, 384]),
    (TextureFormat::Z24S8, 24, [0, 0xff_ffff, 0x7f_ffff]),
    (TextureFormat::Z24S8, 24, [0, 256, 128]),
    (TextureFormat::Z24S8, 24, [256, 512, 384]),
];

/// Boxes along both axes.
const BOXES: u32 = 15;
/// Columns of the special boxes, how far one is from the next, the first column, the first row.
const WIDTH: u32 = SIZE.0 / BOXES / 2;
const STEP: u32 = WIDTH + (SIZE.0 / BOXES - WIDTH) * 2;
const LEFT: u32 = SIZE.0 / 2 - STEP * 3 + WIDTH / 2;
const TOP: u32 = SIZE.1 / 2 - WIDTH / 2;
const HEIGHT: u32 = SIZE.1 / BOXES * 2;

/// The colours of the markers on the special boxes.
const MARKERS: [u32; 7] = [0xffff_aa00, 0xffff_7700, 0xffcc_5500, 0xff00_ff00, 0xff00_aacc, 0xff00_5577, 0xff00_2266];

/// The words of the picture in memory: boxes that grow from the least to the greatest value, and seven special ones in the middle.
///
/// The programs shift words of 24 bits up only in the special boxes and at the sides.
fn words(format: TextureFormat, [least, greatest, reference]: [u32; 3]) -> Vec<u32> {
    let (width, height) = SIZE;
    let shift = if format == TextureFormat::Z24S8 { 8 } else { 0 };
    let (across, down) = (width / BOXES, height / BOXES);
    let indent = (width - across * BOXES) / 2;
    let mut words = vec![reference << shift; (width * height) as usize];
    let mut value = least as f32;
    let increment = greatest as f32 / (BOXES * BOXES) as f32;
    for row in 0..BOXES {
        for column in 0..BOXES {
            for y in row * down..(row + 1) * down {
                let first = (y * width + indent + column * across) as usize;
                words[first..first + across as usize].fill(value as u32);
            }
            value += increment;
        }
    }
    let special = [0, 1, reference - 1, reference, reference + 1, greatest - 1, greatest];
    for (n, value) in (0..).zip(special) {
        for y in TOP..TOP + HEIGHT {
            let first = (y * width + LEFT + n * STEP) as usize;
            words[first..first + WIDTH as usize].fill(value << shift);
        }
    }
    words
}

/// A colour as the programs hand it to the chip: red in the low byte.
fn color(word: u32) -> VertexColor {
    VertexColor::Bytes(word.to_le_bytes())
}

/// A small triangle in each special box.
fn markers() -> Vec<Draw> {
    let (across, down) = (WIDTH as f32 / 4.0, HEIGHT as f32 / 4.0);
    let marker = |(n, word): (u32, u32)| {
        let left = (LEFT + n * STEP) as f32;
        let (top, bottom) = (TOP as f32 + down, TOP as f32 + 2.0 * down);
        let corners = [[left + across, bottom], [left + 2.0 * across, top], [left + 3.0 * across, bottom]];
        Draw { topology: Topology::Triangles, ..quads(&corners, color(word), FinalRegister::PrimaryColor) }
    };
    (0..).zip(MARKERS).map(marker).collect()
}

/// Texture_shadow_comparator, the frames whose depths are given as they are.
pub(super) fn given(frames: &mut Frames) {
    for (format, bits, values) in RANGES {
        let memory = words(format, values);
        let texels = memory.iter().map(|word| if bits == 24 { word.rotate_right(8) } else { *word });
        let texture = images::of_words(TextureKind::Rectangle, format, [SIZE.0, SIZE.1], 1, texels.collect());
        for (name, function) in named(FUNCTIONS) {
            for (reference, stage) in [(ShadowReference::R, 3), (ShadowReference::Zero, 2)] {
                let unit = TextureUnit { shadow: Some(ShadowComparison { function, reference }), ..nearest(0) };
                let [least, greatest, r] = values;
                let (width, height) = (SIZE.0 as f32, SIZE.1 as f32);
                let draw = rectangle([0.0, 100.0, width, height - 100.0], color(0xff22_77ff));
                let mut draw = textured(draw, 0, unit, corners([0.0, 0.0, width, height]));
                draw.vertices.update(|_, vertex| vertex.texture_coordinates.iter_mut().for_each(|at| at[2] = r as f32));
                draw.combiners = with_primary_alpha(FinalRegister::Texture0);
                let (texture, name) = (texture.clone(), format!("{stage}R{bits}_{least:X}-{greatest:X}_{r:X}_{name}"));
                frames.paint(name, 0xfe11_2233, move |canvas| {
                    canvas.texture(&texture);
                    canvas.draw(draw.clone());
                    markers().into_iter().for_each(|marker| canvas.draw(marker));
                });
            }
        }
    }
}
