//! DEP-1, DEP-5 and DEP-6 on triangles of up to 3,000 pixels and depths beyond the buffer: W_buffering.

use super::*;

const FORMATS: [(DepthFormat, &str); 4] = [
    (DepthFormat::Z16, "ZBuf16D"),
    (DepthFormat::Z16F, "ZBuf16F"),
    (DepthFormat::Z24S8, "ZBuf24D"),
    (DepthFormat::Z24S8F, "ZBuf24F"),
];

/// The offset that the programs add in the frames with an offset.
const BIAS: f32 = 16.0;
const FACTOR: f32 = 16.0;

/// The scissor: the programs draw to the right of their text.
const DRAWN: Rectangle = Rectangle { x: 150, y: 0, width: SIZE.0 - 150, height: SIZE.1 };

/// The far depth of the long quads, and its w.
const FAR: [f32; 2] = [16_809_768.0, 325.805_8];
/// The near depth of the long quads, and its w.
const NEAR: [f32; 2] = [16_572_698.0, 58.379_993];

/// Texture coordinates of a quad's corners, clockwise from the upper left.
const DOWN: [[f32; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// Texture coordinates of a quad that starts at its lower left corner.
const UP: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];

/// A shape: name, topology, positions, and the texture coordinates that its vertices repeat.
type Shape = (&'static str, Topology, Vec<[f32; 4]>, [[f32; 2]; 4]);

/// Returns the shapes of W_buffering. The w of triangles equals their z.
fn shapes() -> [Shape; 6] {
    let quads = Topology::Quads;
    let (mut horizontal, mut vertical) = (Vec::new(), Vec::new());
    for n in 0..24_u8 {
        let (along, shift) = (20.0 * f32::from(n), f32::from(n));
        let x = 160.0 + along;
        horizontal.extend([
            [x + 0.5, shift + 0.5, 325.0, 325.0],
            [x + 10.5, shift + 0.5, 325.0, 325.0],
            [x + 0.5, shift + 200.0, 58.0, 58.0],
        ]);
        let x = 160.0 + shift;
        vertical.extend([
            [x + 0.5, along + 0.5, 325.0, 325.0],
            [x + 200.0, along + 0.5, 58.0, 58.0],
            [x + 0.5, along + 10.5, 325.0, 325.0],
        ]);
    }
    let quad = |corners: [[f32; 2]; 4], depths: [[f32; 2]; 4]| {
        corners.into_iter().zip(depths).map(|([x, y], [z, w])| [x, y, z, w]).collect::<Vec<_>>()
    };
    let (far_first, near_first) = ([FAR, FAR, NEAR, NEAR], [NEAR, NEAR, FAR, FAR]);
    let floor = [[53.1875, -34.3125], [586.75, -34.3125], [1808.6875, 453.0], [-1168.6875, 453.0]];
    let roof = [[-1168.6875, 0.0], [1808.6875, 0.0], [586.75, 487.3125], [53.1875, 487.3125]];
    let wall = [[637.3125, -26.8125], [637.3125, 506.75], [150.0, 1728.6875], [150.0, -1248.6875]];
    let (large, larger) = ([LARGE, LARGE / 32.0], [LARGE + 1.0, (LARGE + 1.0) / 32.0]);
    let screen = [[0.0, 0.0], [640.0, 0.0], [640.0, 480.0], [0.0, 480.0]];
    [
        ("FloorQuad", quads, quad(floor, far_first), DOWN),
        ("LargeZ", quads, quad(screen, [large, large, larger, larger]), DOWN),
        ("RoofQuad", quads, quad(roof, near_first), UP),
        ("TriH", Topology::Triangles, horizontal, DOWN),
        ("TriV", Topology::Triangles, vertical, DOWN),
        ("WallQuad", quads, quad(wall, far_first), DOWN),
    ]
}

/// Almost the deepest depth. The programs give it the same w, which is beyond the limit of a scene; a 32nd of that draws the same pixels.
const LARGE: f32 = 16_777_046.0;

fn frame(format: DepthFormat, shape: &Shape, offset: PolygonOffset, w_buffer: bool, shown: Shown) -> Drawn {
    let (_, topology, positions, coordinates) = shape;
    let vertex = |(position, at): (&[f32; 4], &[f32; 2])| placed(*position, *at);
    let vertices = positions.iter().zip(coordinates.iter().cycle()).map(vertex).collect();
    let mut target = frame_buffer(0xff25_1135);
    target.depth = Some(DepthBuffer { format, clear: format.largest(), clear_stencil: 0 });
    let range = DepthRange { lowest: 0.0, highest: 16_777_215.0 * 16.0, clamps: true, drops_triangles: false };
    let depth_test = DepthTest { offset, w_buffer, ..in_steps(CompareFunction::LessOrEqual, true, Some(range)) };
    let unit = TextureUnit { address_s: AddressMode::Wrap, address_t: AddressMode::Wrap, ..nearest(0) };
    let draw = fetching(draw(*topology, vertices), 0, unit);
    let draw = Draw { scissor: Some(DRAWN), depth_test: Some(depth_test), blend: None, ..draw };
    let fields = checker([argb(0xff00_ffff), argb(0xff00_0000)], 8);
    let texture = images::texture(TextureFormat::A8R8G8B8, [256; 2], fields);
    Drawn { scene: scene(vec![target], vec![texture], vec![draw]), before: None, view: None, shown }
}

/// Adds the frames of W_buffering: the words of depth, and the colours where no line of the programs lies over them. A slope of w has no effect on
/// colours, because every depth passes.
pub(super) fn buffers(frames: &mut Frames) {
    let named =
        |prefix: &str, name: &str, [biased, sloped]: [u8; 2]| format!("{prefix}_{name}_V1_ZB{biased}_ZS{sloped}");
    for (format, prefix) in FORMATS {
        for shape in shapes() {
            let name = shape.0;
            let has_colors = !name.starts_with("Tri") && name != "WallQuad";
            for [biased, sloped] in [[0_u8, 0_u8], [0, 1], [1, 0], [1, 1]] {
                let offset = PolygonOffset { bias: BIAS * f32::from(biased), factor: FACTOR * f32::from(sloped) };
                let of_w = PolygonOffset { factor: 0.0, ..offset };
                let (z, w) = (
                    named(prefix, name, [biased, sloped]),
                    named(&format!("W{}", &prefix[1..]), name, [biased, sloped]),
                );
                if has_colors {
                    frames.push(z.clone(), frame(format, &shape, offset, false, Shown::Colors));
                    frames.push(w.clone(), frame(format, &shape, of_w, true, Shown::Colors));
                }
                frames.push(format!("{z}_ZB"), frame(format, &shape, offset, false, Shown::DepthStencil));
                if sloped == 0 && name != "LargeZ" {
                    frames.push(format!("{w}_ZB"), frame(format, &shape, of_w, true, Shown::DepthStencil));
                }
            }
        }
    }
    for (name, top) in [("Trunc0", -1.0 / 16.0 + 0.001), ("TruncNeg", -1.0 / 16.0)] {
        let [near, far] = [NEAR[1], FAR[1]];
        let positions = vec![
            [-1168.6875, top, 0.0, near],
            [1808.6875, top, 0.0, near],
            [586.75, 487.3125, 500_000.0, far],
            [53.1875, 487.3125, 500_000.0, far],
        ];
        let shape = (name, Topology::Quads, positions, UP);
        for (suffix, shown) in [("", Shown::Colors), ("_ZB", Shown::DepthStencil)] {
            let drawn = frame(DepthFormat::Z24S8, &shape, PolygonOffset::default(), false, shown);
            frames.push(format!("{}{suffix}", named("ZBuf24D", name, [0, 0])), drawn);
        }
    }
}
