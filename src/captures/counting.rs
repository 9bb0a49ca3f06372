//! LIN-1, PNT-1 behind depth tests: ZPass_pixel_count.

use super::clears::{FAR_DEPTHS_16, at_depth, depth};
use super::*;

const LESS: CompareFunction = CompareFunction::Less;

/// The square that is drawn first.
const SQUARE: [f32; 4] = [32.0, 240.0, 160.0, 368.0];

fn canvas() -> Canvas {
    let mut canvas = Canvas::new(0xff33_3333);
    canvas.frame_buffer().depth = Some(FAR_DEPTHS_16);
    canvas
}

/// Returns white lines or points from a place of the screen and a depth of the world.
fn white(topology: Topology, places: &[([f32; 2], f32)]) -> Draw {
    let end = |([x, y], z): &([f32; 2], f32)| Vertex {
        position: [x + UNPROJECTED, y + UNPROJECTED, depth(*z), 1.0],
        ..Vertex::default()
    };
    let depth_test = Some(DepthTest::new(LESS, true));
    let draw = draw(topology, places.iter().map(end).collect());
    without_alpha(Draw { depth_test, ..draw }, FinalRegister::PrimaryColor)
}

/// Adds the frames of ZPass_pixel_count.
pub(super) fn frames(frames: &mut Frames) {
    let mut all = canvas();
    let half = [576.0, 240.0, 704.0, 368.0];
    for (edges, z, color) in [
        (SQUARE, 0.0, 0xff77_3377),
        (SQUARE, 1.0, 0xffff_0000),
        ([224.0, 240.0, 352.0, 368.0], 0.0, 0xff77_7733),
        (half, 0.0, 0xffe0_e0e0),
        ([576.0, 176.0, 704.0, 304.0], -0.1, 0xff33_cc33),
    ] {
        all.draw(at_depth(edges, z, color, LESS));
    }
    frames.both("ZPass", all.colors().scene);
    for width in [0, 1, 4, 8, 0xf, 0x10, 0x40, 0xff, 0x1f8] {
        let mut canvas = canvas();
        canvas.draw(at_depth(SQUARE, 0.0, 0xff77_3377, LESS));
        let lines = white(
            Topology::Lines,
            &[([32.0, 304.0], 1.5), ([96.0, 304.0], 1.5), ([288.0, 304.0], 1.5), ([352.0, 304.0], 1.5)],
        );
        canvas.draw(Draw { lines: Lines { width, ..Lines::default() }, ..lines });
        frames.both(&format!("ZPassLineWidth-0x{width:04X}"), canvas.colors().scene);
    }
    let known = [0, 1, 4, 7, 8, 9, 0xf, 0x10, 0x40, 0xff, 0x100, 0x1f8, 0x1ff];
    for size in known {
        let mut canvas = canvas();
        canvas.draw(at_depth(SQUARE, 0.0, 0xff77_3377, LESS));
        let points = white(Topology::Points, &[([96.0, 304.0], 1.5), ([288.0, 304.0], 0.0)]);
        canvas.draw(Draw { point_size: size, ..points });
        frames.both(&format!("ZPassPointSize-0x{size:04X}"), canvas.colors().scene);
    }
    for size in known.into_iter().chain([0x1f9, 0x200, 0x201]) {
        let mut canvas = canvas();
        let depth_test = Some(in_steps(LESS, true, None));
        let through = |draw: Draw| Draw { depth_test, ..without_alpha(draw, FinalRegister::PrimaryColor) };
        canvas.draw(through(rectangle(SQUARE, VertexColor::Bytes(abgr(0xff77_3377)))));
        // A size that the register does not hold leaves the one before it, a pixel.
        let point_size = if size > LARGEST_SIZE { 8 } else { size };
        for (x, z) in [(96.0, 1.5), (288.0, 0.0)] {
            let point = Vertex { position: [x, 304.0, z, 1.0], ..Vertex::default() };
            canvas.draw(Draw { point_size, ..through(draw(Topology::Points, vec![point])) });
        }
        frames.both(&format!("ZPassPointSizeVS-0x{size:04X}"), canvas.colors().scene);
    }
}
