//! DEP-1 and DEP-3: 992 small quads from the nearest depth to the farthest, and three large ones behind them, in four formats and over 49 clear
//! values.

use super::space::Matrix;
use super::*;

/// The depth formats, their part in the names of frames, and the deepest word that the programs use.
const FORMATS: [(DepthFormat, &str, u32); 4] = [
    (DepthFormat::Z16, "z16", 0xffff),
    (DepthFormat::Z24S8, "z24", 0xff_ffff),
    (DepthFormat::Z16F, "z16", 0xffff),
    (DepthFormat::Z24S8F, "z24", 0xfe_ffff),
];

/// The depth range of 24-bit floats. The programs leave it at 1e30, and the deepest words lie beyond that.
const FLOAT_RANGE: DepthRange = DepthRange { lowest: 0.0, highest: 1e30, clamps: false, drops_triangles: false };

/// Number of steps between the clear values.
const STEPS: u32 = 48;

/// Returns the depth that a word of the format encodes, as the programs pass it to the chip.
fn depth_of_word(format: DepthFormat, word: u32) -> f32 {
    match format {
        DepthFormat::Z16 | DepthFormat::Z24S8 => word as f32,
        _ if word == 0 => 0.0,
        DepthFormat::Z16F => f32::from_bits((word << 11) + 0x3c00_0000),
        DepthFormat::Z24S8F => f32::from_bits(word << 7),
    }
}

/// Adds two triangles that cover a rectangle. Positions and colours belong to its corners, clockwise from the upper left.
fn quad(vertices: &mut Vec<Vertex>, positions: [[f32; 4]; 4], colors: [[f32; 3]; 4]) {
    for n in [0, 1, 2, 0, 2, 3] {
        let (position, [r, g, b]) = (positions[n], colors[n]);
        vertices.push(Vertex { position, diffuse: VertexColor::Floats([r, g, b, 1.0]), ..Vertex::default() });
    }
}

/// Adds a draw over a depth buffer with each of several clears: pictures and depths, with and without compression, which changes no pixel.
fn over_clears(
    frames: &mut Frames,
    prefix: &str,
    (format, bits, deepest): (DepthFormat, &str, u32),
    steps: u32,
    draw: &Draw,
) {
    for step in 0..=steps {
        let clear = deepest - step * (deepest / steps);
        let mut target = frame_buffer(0xff00_0000);
        target.depth = Some(DepthBuffer { format, clear, clear_stencil: 0 });
        let scene = scene(vec![target], vec![], vec![draw.clone()]);
        for compressed in ["n", "y"] {
            let float = if format.is_float() { "y" } else { "n" };
            frames.both(&format!("{prefix}{bits}_C{compressed}_FZ{float}_M{clear:06x}"), scene.clone());
        }
    }
}

fn vertices(format: DepthFormat, deepest: u32) -> Vec<Vertex> {
    let (left, top, right, bottom) = (128.0, 40.0, 512.0, 440.0);
    let full = deepest as f32;
    let mut all = Vec::new();
    let mut add = |edges: [f32; 4], depths: [f32; 4], colors: [[f32; 3]; 4]| {
        let position = |n: usize| [corners(edges)[n][0], corners(edges)[n][1], depths[n], 1.0];
        quad(&mut all, [0, 1, 2, 3].map(position), colors);
    };
    let at = |word: u32| depth_of_word(format, word);
    // 31 by 32 small quads, twelve pixels from one to the next.
    let increment = full / 996.0;
    let (mut z, mut slope) = (0.0_f32, increment * 0.75);
    for row in 0..32_u8 {
        for column in 0..31_u8 {
            let (x, y) = (left + 6.0 + 12.0 * f32::from(column), top + 8.0 + 12.0 * f32::from(row));
            let other = z + slope;
            let grey = |z: f32| [0.25 + z / full * 0.75; 3];
            let (near, far) = (at(z as u32), at(other.max(0.0) as u32));
            let colors = [grey(z), grey(other), grey(other), grey(z)];
            add([x, y, x + 8.0, y + 8.0], [near, far, far, near], colors);
            z += increment;
            slope = -slope;
        }
    }
    let back = deepest - 1;
    let (near, far) = (at(back * 3 / 4), at(0));
    let (first, second) = ([near / full, 0.75, near / full], [0.75, far / full, far / full]);
    let area = [left + 4.0, bottom - 10.0, right - 20.0, bottom - 5.0];
    add(area, [near, far, far, near], [first, second, second, first]);
    let (near, far) = (at(1), at(deepest / 2));
    let (first, second) = ([near / full, 0.5, near / full], [0.5, far / full, far / full]);
    let area = [right - 10.0, top + 5.0, right - 2.0, bottom - 5.0];
    add(area, [near, near, far, far], [first, first, second, second]);
    let (near, far) = (at(back * 2 / 3), at(back));
    let colors = [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.4, 0.3, 0.0], [0.0, 0.0, 1.0]];
    add([left, top, right, bottom], [near, near, far, far], colors);
    all
}

/// Adds the frames of Depth_buffer.
pub(super) fn formats(frames: &mut Frames) {
    for (format, bits, deepest) in FORMATS {
        let range = (format == DepthFormat::Z24S8F).then_some(FLOAT_RANGE);
        let depth_test = Some(in_steps(CompareFunction::Less, true, range));
        let draw = Draw { depth_test, ..draw(Topology::Triangles, vertices(format, deepest)) };
        over_clears(frames, "DepthFmt_", (format, bits, deepest), STEPS, &draw);
    }
}

/// Returns the triangles of Depth_buffer_fixed_function: 18 by 18 small quads, two bars, and the quad behind all of them. `matrix` leads from the
/// world to window coordinates.
fn unprojected_vertices(matrix: &Matrix) -> Vec<Vertex> {
    let (left, top, right, bottom) = (128.0_f32, 48.0_f32, 512.0_f32, 432.0_f32);
    let (near, far) = (-6.0_f32, 193.0_f32);
    // The program finds the points before it sets the format of depths.
    let inverse = space::inverse(&space::product(space::eye(), space::window()));
    let mut all = Vec::new();
    let mut add = |edges: [f32; 4], depths: [f32; 4], colors: [[f32; 3]; 4]| {
        let point = |n: usize| space::unproject(corners(edges)[n], depths[n], &inverse);
        quad(&mut all, [0, 1, 2, 3].map(|n| space::fixed_function_to(point(n), matrix)), colors);
    };
    let increment = (far - near) / 328.0;
    let (mut z, mut slope) = (near, increment * 0.75);
    for row in 0..18_u8 {
        for column in 0..18_u8 {
            let (x, y) = (left + 8.0 + 20.0 * f32::from(column), top + 8.0 + 20.0 * f32::from(row));
            let other = z + slope;
            let grey = |z: f32| [0.25 + z / far * 0.75; 3];
            let (first, second) = (grey(z), grey(other));
            // The program gives the colours of the upper right and the lower left corner to each other.
            add([x, y, x + 16.0, y + 16.0], [z, other, other, z], [first, first, second, second]);
            z += increment;
            slope = -slope;
        }
    }
    let bar = far * 0.75;
    let (first, second) = ([bar / far, 0.75, bar / far], [0.75, near / far, near / far]);
    add(
        [left + 4.0, bottom - 10.0, right - 20.0, bottom - 5.0],
        [bar, near, near, bar],
        [first, first, second, second],
    );
    let bar = far * 0.5;
    let (first, second) = ([near / far, 0.5, near / far], [0.5, bar / far, bar / far]);
    add([right - 10.0, top + 5.0, right - 2.0, bottom - 5.0], [near, near, bar, bar], [first, second, second, first]);
    let back = far * 2.0 / 3.0;
    let colors = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.4, 0.3, 0.0], [1.0, 0.0, 0.0]];
    add([left, top, right, bottom], [back, back, far, far], colors);
    all
}

/// Adds the frames of Depth_buffer_fixed_function.
pub(super) fn fixed_function(frames: &mut Frames) {
    for (format, bits, deepest) in FORMATS {
        // The programs take another number for the deepest float of 24 bits.
        let limit = if format == DepthFormat::Z24S8F { FLOAT_RANGE.highest } else { depth_of_word(format, deepest) };
        let matrix = space::product(space::eye(), space::window_to(limit.into()));
        let range = DepthRange { lowest: 0.0, highest: 16_777_216.0, clamps: false, drops_triangles: false };
        let depth_test = Some(in_steps(CompareFunction::Less, true, Some(range)));
        let draw = Draw { depth_test, ..draw(Topology::Triangles, unprojected_vertices(&matrix)) };
        over_clears(frames, "", (format, bits, deepest), 4, &draw);
    }
}
