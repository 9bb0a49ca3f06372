//! CLR-1, DEP-2: clears, which no mask stops; depth functions, of which values that the chip does not know leave the last one.

use super::*;

/// A 16-bit depth buffer that is cleared to the farthest depth.
pub(super) const FAR_DEPTHS_16: DepthBuffer = DepthBuffer { format: DepthFormat::Z16, clear: 0xffff, clear_stencil: 0 };

/// Adds the frames of Clear.
pub(super) fn frames(frames: &mut Frames) {
    for mask in ["00000000", "00000001", "00000100", "00010000", "01000000", "01010101"] {
        for depth in ["n", "y"] {
            let target = Target { depth: Some(FAR_DEPTHS_16), ..frame_buffer(0x7f7f_7f7f) };
            frames.both(&format!("C{mask}_Depth_{depth}"), scene(vec![target], vec![], vec![]));
        }
    }
    for (name, format) in [
        ("SFC_A8R8G8B8", SurfaceFormat::A8R8G8B8),
        ("SFC_X1R5G5B5_Z1R5G5B5", SurfaceFormat::X1R5G5B5Z),
        ("SCF_X1R5G5B5_O1R5G5B5", SurfaceFormat::X1R5G5B5O),
        ("SCF_R5G6B5", SurfaceFormat::R5G6B5),
        ("SCF_X8R8G8B8_Z8R8G8B8", SurfaceFormat::X8R8G8B8Z),
        ("SCF_X8R8G8B8_O8R8G8B8", SurfaceFormat::X8R8G8B8O),
        ("SCF_X1A7R8G8B8_Z1A7R8G8B8", SurfaceFormat::X1A7R8G8B8Z),
        ("SCF_X1A7R8G8B8_O1A7R8G8B8", SurfaceFormat::X1A7R8G8B8O),
    ] {
        frames.make(name, move || words(format));
    }
}

/// The words that the surfaces are cleared to.
const WORDS: [u32; 6] = [0x00da_caba, 0x011b_2b3b, 0x7f3c_2c1c, 0x804d_5d6d, 0xfe0e_ce3e, 0xff8f_9faf];

/// Width and height of the surfaces.
const SIDE: u32 = 128;

/// Returns a frame of surfaces that are cleared to a word and have a black square in the middle. Their memory is read as A8B8G8R8.
fn words(format: SurfaceFormat) -> FrameDrawing {
    let bytes = format.bytes();
    let mut canvas = Canvas::new(0xff22_0022);
    let mut before = Vec::new();
    for (word, at) in WORDS.into_iter().zip(places([48.0, 128.0], [144.0; 2], 4)) {
        let contents = Some(vec![surface::cleared(format, word); (SIDE * SIDE) as usize].into());
        let target = Target { contents, ..Target::new(SIDE, SIDE, format) };
        let square = rectangle([62.0, 62.0, 66.0, 66.0], VertexColor::Bytes([0; 4]));
        let square = without_alpha(square, FinalRegister::PrimaryColor);
        before.push(scene(vec![target], vec![], vec![square]));
        let rows = SIDE * bytes / 4;
        let texture = canvas.texture(&images::blank(TextureFormat::A8B8G8R8, [SIDE, rows]));
        let size = [SIDE, rows].map(|side| f32::from(side as u16));
        let shown = pasted(sized(at, size), 0, nearest(texture), sized([0.0; 2], size));
        canvas.draw(Draw { blend: None, ..shown });
    }
    FrameDrawing { before, ..canvas.colors() }
}

/// Returns the depth in the buffer's range of a point of the world at z.
pub(super) fn depth(z: f32) -> f32 {
    let [_, _, depth, _] = space::fixed_function([0.0, 0.0, z, 1.0]);
    depth / 65535.0
}

/// Returns a rectangle of the screen at a depth of the world.
pub(super) fn at_depth(edges: [f32; 4], z: f32, color: u32, function: CompareFunction) -> Draw {
    let depth_test = Some(DepthTest::new(function, true));
    let draw =
        without_alpha(rectangle(unprojected(edges), VertexColor::Bytes(abgr(color))), FinalRegister::PrimaryColor);
    let mut draw = Draw { depth_test, ..draw };
    draw.vertices.update(|_, vertex| vertex.position[2] = depth(z));
    draw
}

/// Adds the frames of Depth_function: of each function a strip with patches behind, on and before it.
pub(super) fn functions(frames: &mut Frames) {
    // The programs begin with the last function.
    let known = CompareFunction::ALL.iter().cycle().skip(CompareFunction::ALL.len() - 1).zip(0_u8..8);
    let mut canvas = Canvas::new(0xff00_0000);
    canvas.frame_buffer().depth = Some(FAR_DEPTHS_16);
    let mut strip = |x: f32, top: f32, function: CompareFunction| {
        canvas.draw(at_depth([x + 4.0, top, x + 32.0, top + 96.0], 0.0, 0xffaa_aaaa, CompareFunction::Always));
        let patches = [
            ([top + 4.0, top + 24.0], 1.0, 0xff33_33ff),
            ([top + 36.0, top + 60.0], 0.0, 0xffff_3333),
            ([top + 68.0, top + 92.0], -1.0, 0xff33_ff33),
        ];
        for ([upper, lower], z, color) in patches {
            canvas.draw(at_depth([x, upper, x + 24.0, lower], z, color, function));
        }
    };
    for (function, n) in known.clone() {
        strip(32.0 + 40.0 * f32::from(n), 64.0, *function);
    }
    for (function, n) in known {
        // Values that are no function: the one before them stays.
        strip(32.0 + 40.0 * f32::from(n), 200.0, *function);
        strip(32.0 + 40.0 * f32::from(n), 320.0, CompareFunction::Always);
    }
    frames.both("DepthFunc", canvas.colors().scene);
}
