//! DEP-1, DEP-5 and DEP-6 on triangles of up to 3,000 pixels and depths beyond the buffer: the buffers of W_buffering.

use super::draws::{draw, frame_buffer, in_steps, scene};
use super::{Drawn, Frames, SIZE, Shown};
use ninebit::state::*;

const FORMATS: [(DepthFormat, &str); 4] = [
    (DepthFormat::Z16, "ZBuf16D"),
    (DepthFormat::Z16F, "ZBuf16F"),
    (DepthFormat::Z24S8, "ZBuf24D"),
    (DepthFormat::Z24S8F, "ZBuf24F"),
];

/// What the programs add where they add something.
const BIAS: f32 = 16.0;
const FACTOR: f32 = 16.0;

/// The programs draw to the right of their text.
const DRAWN: Rectangle = Rectangle { x: 150, y: 0, width: SIZE.0 - 150, height: SIZE.1 };

/// The two depths of the long quads.
const FAR: f32 = 16_809_768.0;
const NEAR: f32 = 16_572_698.0;

/// Shapes by name: quads, or triangles.
fn shapes() -> [(&'static str, Topology, Vec<[f32; 3]>); 6] {
    let quads = Topology::Quads;
    let (mut horizontal, mut vertical) = (Vec::new(), Vec::new());
    for n in 0..24_u8 {
        let (along, shift) = (20.0 * f32::from(n), f32::from(n));
        let x = 160.0 + along;
        horizontal.extend([
            [x + 0.5, shift + 0.5, 325.0],
            [x + 10.5, shift + 0.5, 325.0],
            [x + 0.5, shift + 200.0, 58.0],
        ]);
        let x = 160.0 + shift;
        vertical.extend([
            [x + 0.5, along + 0.5, 325.0],
            [x + 200.0, along + 0.5, 58.0],
            [x + 0.5, along + 10.5, 325.0],
        ]);
    }
    let floor =
        [[53.1875, -34.3125, FAR], [586.75, -34.3125, FAR], [1808.6875, 453.0, NEAR], [-1168.6875, 453.0, NEAR]];
    let roof = [[-1168.6875, 0.0, NEAR], [1808.6875, 0.0, NEAR], [586.75, 487.3125, FAR], [53.1875, 487.3125, FAR]];
    let wall =
        [[637.3125, -26.8125, FAR], [637.3125, 506.75, FAR], [150.0, 1728.6875, NEAR], [150.0, -1248.6875, NEAR]];
    let large = 16_777_046.0;
    let large = [[0.0, 0.0, large], [640.0, 0.0, large], [640.0, 480.0, large + 1.0], [0.0, 480.0, large + 1.0]];
    [
        ("FloorQuad", quads, floor.to_vec()),
        ("LargeZ", quads, large.to_vec()),
        ("RoofQuad", quads, roof.to_vec()),
        ("TriH", Topology::Triangles, horizontal),
        ("TriV", Topology::Triangles, vertical),
        ("WallQuad", quads, wall.to_vec()),
    ]
}

fn frame(
    format: DepthFormat,
    topology: Topology,
    positions: &[[f32; 3]],
    offset: PolygonOffset,
    w_buffer: bool,
) -> Drawn {
    // w is z. It plays no part in z buffers, and some of the programs' are beyond what draws may have.
    let vertex =
        |[x, y, z]: &[f32; 3]| Vertex { position: [*x, *y, *z, if w_buffer { *z } else { 1.0 }], ..Vertex::default() };
    let mut target = frame_buffer(0xff25_1135);
    target.depth = Some(DepthBuffer { format, clear: format.largest(), clear_stencil: 0 });
    let range = DepthRange { lowest: 0.0, highest: 16_777_215.0 * 16.0, clamps: true, drops_triangles: false };
    let depth_test = DepthTest { offset, w_buffer, ..in_steps(CompareFunction::LessOrEqual, true, Some(range)) };
    let draw = draw(topology, positions.iter().map(vertex).collect());
    let draw = Draw { scissor: Some(DRAWN), depth_test: Some(depth_test), blend: None, ..draw };
    Drawn { scene: scene(vec![target], vec![], vec![draw]), before: None, view: None, shown: Shown::DepthStencil }
}

/// W_buffering: words of the z buffers, and of w buffers where no w is beyond what draws may have.
pub(super) fn buffers(frames: &mut Frames) {
    for (format, prefix) in FORMATS {
        for (shape, topology, positions) in shapes() {
            for (biased, sloped) in [(0_u8, 0_u8), (0, 1), (1, 0), (1, 1)] {
                let offset = PolygonOffset { bias: BIAS * f32::from(biased), factor: FACTOR * f32::from(sloped) };
                let name = format!("{prefix}_{shape}_V1_ZB{biased}_ZS{sloped}_ZB");
                frames.push(name, frame(format, topology, &positions, offset, false));
                if sloped == 0 && shape.starts_with("Tri") {
                    let name = format!("W{}_{shape}_V1_ZB{biased}_ZS0_ZB", &prefix[1..]);
                    frames.push(name, frame(format, topology, &positions, offset, true));
                }
            }
        }
    }
    for (name, top) in [("Trunc0", -1.0 / 16.0 + 0.001), ("TruncNeg", -1.0 / 16.0)] {
        let positions = [
            [-1168.6875, top, 0.0],
            [1808.6875, top, 0.0],
            [586.75, 487.3125, 500_000.0],
            [53.1875, 487.3125, 500_000.0],
        ];
        let drawn = frame(DepthFormat::Z24S8, Topology::Quads, &positions, PolygonOffset::default(), false);
        frames.push(format!("ZBuf24D_{name}_V1_ZB0_ZS0_ZB"), drawn);
    }
}
