//! ROP-5: surfaces that are swizzled in memory, whatever their pitch.

use super::*;
use images::swizzled;

/// Side of the surfaces, and of what is drawn into them.
const SIDES: [u32; 2] = [128, 64];
const GREEN: u32 = 0xff00_aa00;

/// Returns the words of a chequered image that is swizzled in memory, row by row of as many words as it has columns.
fn chequered(first: u32) -> Vec<u32> {
    let (side, bits) = (SIDES[1], SIDES[1].ilog2());
    let mut memory = vec![0; (side * side) as usize];
    for (x, y) in images::each_texel([side; 2]) {
        memory[swizzled([x, y], [bits; 2])] = if (x / 4 + y / 4) % 2 == 0 { first } else { 0 };
    }
    memory
}

/// Returns a scene that draws words, read as rows, into the upper left corner of a green surface.
fn surface(side: u32, words: Vec<u32>) -> Scene {
    let target = Target { clear_color: argb(GREEN), ..Target::new(side, side, SurfaceFormat::A8R8G8B8) };
    let image = images::of_words(TextureKind::Rectangle, TextureFormat::A8R8G8B8, [SIDES[1]; 2], 1, words);
    let edges = [0.0, 0.0, SIDES[1] as f32, SIDES[1] as f32];
    let draw = without_alpha(pasted(edges, 0, nearest(0), edges), FETCHED[0]);
    scene(vec![target], vec![image], vec![draw])
}

/// Adds the frame of Surface_pitch.
pub(super) fn frames(frames: &mut Frames) {
    frames.make("Swizzle", || {
        let mut canvas = Canvas::new(0xfc21_2111);
        let size = [SIDES[0]; 2];
        let green = vec![GREEN; (SIDES[0] * SIDES[0]) as usize];
        let before = [(64, 0xffff_2222), (64, 0xffff_2277), (128, 0xff22_22ff), (128, 0xff77_22ff)]
            .map(|(side, color)| surface(side, chequered(color)));
        let (side, top) = (SIDES[0] as f32, 224.0 / 3.0);
        let texels = [0.0, 0.0, side, side];
        for corner in [[128.0, top], [384.0, top], [128.0, top * 2.0 + side], [384.0, top * 2.0 + side]] {
            let of = images::of_words(TextureKind::Rectangle, TextureFormat::A8R8G8B8, size, 1, green.clone());
            let result = canvas.texture(&of);
            let draw = pasted(sized(corner, [side; 2]), 0, nearest(result), texels);
            canvas.draw(without_alpha(draw, FETCHED[0]));
        }
        let image = images::checker([[255; 4], [0, 0, 0, 255]], 4);
        let image = canvas.texture(&images::texture(TextureFormat::A8B8G8R8, [SIDES[1]; 2], image));
        let draw = pasted([288.0, 208.0, 352.0, 272.0], 0, nearest(image), WHOLE);
        canvas.draw(without_alpha(draw, FETCHED[0]));
        FrameDrawing { before: before.into(), is_swizzled: true, ..canvas.colors() }
    });
}
