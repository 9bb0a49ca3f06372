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
fn shapes() -> [Shape; 7] {
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
    let (large, larger) = ([LARGE; 2], [LARGE + 1.0; 2]);
    let screen = [[0.0, 0.0], [640.0, 0.0], [640.0, 480.0], [0.0, 480.0]];
    let strip = vec![
        [321.0, 0.5, 16_777_210.0, NEAR[1]],
        [159.5, 0.5, 16_777_210.0, FAR[1]],
        [159.5, 448.5, 16_572_698.0, NEAR[1]],
        [321.0, 448.5, 16_572_698.0, FAR[1]],
    ];
    [
        ("FloorQuad", quads, quad(floor, far_first), DOWN),
        ("LineStrip", Topology::LineStrip, strip, DOWN),
        ("LargeZ", quads, quad(screen, [large, large, larger, larger]), DOWN),
        ("RoofQuad", quads, quad(roof, near_first), UP),
        ("TriH", Topology::Triangles, horizontal, DOWN),
        ("TriV", Topology::Triangles, vertical, DOWN),
        ("WallQuad", quads, quad(wall, far_first), DOWN),
    ]
}

/// Almost the deepest depth.
const LARGE: f32 = 16_777_046.0;

/// Returns the floor of the world that the fixed function transforms. Its near corners lie half a million pixels from the screen.
fn world(format: DepthFormat) -> Shape {
    let deepest = if format.bits() == 16 { 65535.0 } else { 16_777_215.0 };
    let eye = space::looking([0.0, 50.0, -7.0], [0.0, 47.0, 0.0]);
    let matrix = space::product(eye, space::window_to(deepest));
    let corners = [[-15000.0, 30000.0], [15000.0, 30000.0], [15000.0, -10.0], [-15000.0, -10.0]];
    let place = |[x, z]: [f32; 2]| space::fixed_function_to([x, 0.0, z, 1.0], &matrix);
    let coordinates = DOWN.map(|at| at.map(|n| 100.0 * n));
    ("FloorQuad", Topology::Quads, corners.map(place).to_vec(), coordinates)
}

/// What a frame shows of a shape.
#[derive(Clone)]
struct Setup {
    format: DepthFormat,
    shape: Shape,
    offset: PolygonOffset,
    w_buffer: bool,
    /// Column and row from which on the shape is drawn: to the right of the programs' text, unless a frame is about them.
    clip: [u32; 2],
}

/// Column and row from which on most frames are drawn.
const CLIP: [u32; 2] = [150, 0];

fn frame(setup: &Setup, shown: Buffer) -> FrameDrawing {
    let (_, topology, positions, coordinates) = &setup.shape;
    let coordinates = &coordinates[..if *topology == Topology::Triangles { 3 } else { 4 }];
    let vertex = |(position, at): (&[f32; 4], &[f32; 2])| placed(*position, *at);
    let vertices = positions.iter().zip(coordinates.iter().cycle()).map(vertex).collect();
    let mut target = frame_buffer(0xff25_1135);
    target.depth = Some(DepthBuffer { format: setup.format, clear: setup.format.largest(), clear_stencil: 0 });
    let range = DepthRange { lowest: 0.0, highest: 16_777_215.0 * 16.0, clamps: true, drops_triangles: false };
    let depth_test = in_steps(CompareFunction::LessOrEqual, true, Some(range));
    let depth_test = DepthTest { offset: setup.offset, w_buffer: setup.w_buffer, ..depth_test };
    let unit = TextureUnit { address_s: AddressMode::Wrap, address_t: AddressMode::Wrap, ..nearest(0) };
    let draw = fetching(draw(*topology, vertices), 0, unit);
    let [x, y] = setup.clip;
    let scissor = Some(Rectangle { x, y, width: SIZE.0 - x, height: SIZE.1 - y });
    let mut draws = vec![Draw { scissor, depth_test: Some(depth_test), blend: None, ..draw }];
    draws.push(pointers(setup));
    draws.extend(marks(setup.clip));
    let fields = checker([argb(0xff00_ffff), argb(0xff00_0000)], 8);
    let texture = images::texture(TextureFormat::A8R8G8B8, [256; 2], fields);
    FrameDrawing { shown, ..FrameDrawing::colors(scene(vec![target], vec![texture], draws)) }
}

/// Returns the pixels whose depths the programs print.
fn printed(shape: &Shape) -> Vec<[u16; 2]> {
    let (name, _, positions, _) = shape;
    let pixel = |[x, y, ..]: &[f32; 4]| [x.floor() as u16, y.floor() as u16];
    match *name {
        "LineStrip" => {
            let (columns, rows) = ([320, 267, 214], [56, 112, 168, 224, 280, 336, 392]);
            let top = columns.map(|x| [x, 0]).into_iter().chain([[159, 0]]);
            let down = rows.map(|y| [159, y]).into_iter().chain([[159, 448]]);
            top.chain(down).chain([[214, 448], [267, 448], [320, 448]]).collect()
        }
        "Riddick" => vec![[316, 262], [270, 266], [184, 479], [150, 463]],
        "TriH" | "TriV" => positions.iter().step_by(3).map(pixel).collect(),
        "WallQuad" => (0..15).map(|n| [159 + 34 * n, 5]).collect(),
        _ => (0..15).map(|n| [159, 32 * n]).collect(),
    }
}

/// Returns the yellow lines from the printed depths to their pixels.
fn pointers(setup: &Setup) -> Draw {
    let left = if setup.format.bits() == 16 { 102.0 } else { 122.0 };
    let yellow = VertexColor::Floats([1.0, 1.0, 0.0, 1.0]);
    let rows = (0..15).map(|n: u8| 32.0 + 25.0 * f32::from(n));
    let line = |([x, y], row): ([u16; 2], f32)| {
        let [x, y] = [x, y].map(f32::from);
        let (across, down) = (x - left, y - row);
        let half = 0.5 / across.abs().max(down.abs());
        [[left + 0.5, row + 0.5], [x + 0.5 + half * across, y + 0.5 + half * down]]
    };
    let ends = printed(&setup.shape).into_iter().zip(rows).flat_map(line);
    draw(Topology::Lines, ends.map(|at| vertex(at, yellow)).collect())
}

/// Returns red lines, drawn as rectangles, along a clip that differs from that of most frames.
fn marks([x, y]: [u32; 2]) -> Vec<Draw> {
    let [left, top] = [x, y].map(|at| f32::from(at as u16));
    let [right, bottom] = [SIZE.0, SIZE.1].map(|at| f32::from(at as u16));
    let red = |edges| rectangle(edges, VertexColor::Bytes([255, 0, 0, 255]));
    let across = (y != CLIP[1]).then(|| red([left, top, right, top + 1.0]));
    let down = (x != CLIP[0]).then(|| red([left, top, left + 1.0, bottom]));
    across.into_iter().chain(down).collect()
}

/// Adds the frames of W_buffering: colours, and the words of depth. A slope of w has no effect on colours, because every depth passes.
pub(super) fn buffers(frames: &mut Frames) {
    let named = |prefix: &str, name: &str, is_program: bool, [biased, sloped]: [u8; 2]| {
        format!("{prefix}_{name}_V{}_ZB{biased}_ZS{sloped}", u8::from(is_program))
    };
    for (format, prefix) in FORMATS {
        let all = shapes().into_iter().map(|shape| (shape, true)).chain([(world(format), false)]);
        for (shape, is_program) in all {
            let name = shape.0;
            for [biased, sloped] in [[0_u8, 0_u8], [0, 1], [1, 0], [1, 1]] {
                for w_buffer in [false, true] {
                    let prefix = if w_buffer { format!("W{}", &prefix[1..]) } else { prefix.to_owned() };
                    let factor = if w_buffer { 0.0 } else { FACTOR * f32::from(sloped) };
                    let offset = PolygonOffset { bias: BIAS * f32::from(biased), factor };
                    let setup = Setup { format, shape: shape.clone(), offset, w_buffer, clip: CLIP };
                    let name_of_frame = named(&prefix, name, is_program, [biased, sloped]);
                    frames.push(name_of_frame.clone(), frame(&setup, Buffer::Color));
                    if !w_buffer || sloped == 0 {
                        frames.push(format!("{name_of_frame}_ZB"), frame(&setup, Buffer::Depth));
                    }
                }
            }
        }
    }
    let plain = |shape: Shape, w_buffer: bool, clip: [u32; 2]| Setup {
        format: DepthFormat::Z24S8,
        shape,
        offset: PolygonOffset::default(),
        w_buffer,
        clip,
    };
    for (name, top) in [("Trunc0", -1.0 / 16.0 + 0.001), ("TruncNeg", -1.0 / 16.0)] {
        let [near, far] = [NEAR[1], FAR[1]];
        let positions = vec![
            [-1168.6875, top, 0.0, near],
            [1808.6875, top, 0.0, near],
            [586.75, 487.3125, 500_000.0, far],
            [53.1875, 487.3125, 500_000.0, far],
        ];
        let setup = plain((name, Topology::Quads, positions, UP), false, CLIP);
        for (suffix, shown) in [("", Buffer::Color), ("_ZB", Buffer::Depth)] {
            frames.push(format!("{}{suffix}", named("ZBuf24D", name, true, [0, 0])), frame(&setup, shown));
        }
    }
    let far = [
        [-12_630.813, 21_456.188, 2_889_041.5, 2_026.681_5],
        [270.4375, 266.5, 16_736_755.0, 668_074.8],
        [317.25, 262.375, 16_739_467.0, 714_052.2],
    ];
    let setup = plain(("Riddick", Topology::Triangles, far.to_vec(), DOWN), true, CLIP);
    for (suffix, shown) in [("", Buffer::Color), ("_ZB", Buffer::Depth)] {
        frames.push(format!("{}{suffix}", named("WBuf24D", "Riddick", true, [0, 0])), frame(&setup, shown));
    }
    for shape in shapes() {
        let clips: [[u32; 2]; 3] = match shape.0 {
            "FloorQuad" => [[150, 32], [150, 128], [150, 224]],
            "WallQuad" => [[159, 0], [261, 0], [363, 0]],
            _ => continue,
        };
        for clip @ [x, y] in clips {
            let name = named("WBuf24D", &format!("Clip{}-{x:03}-{y:03}", &shape.0[..1]), true, [0, 1]);
            frames.push(name, frame(&plain(shape.clone(), true, clip), Buffer::Color));
        }
    }
}
