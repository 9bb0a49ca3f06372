//! LIN-1, PNT-1, POL-1: lines and points of every size.

use super::*;

/// Colours of the vertices in turn, A8B8G8R8.
const COLORS: [u32; 8] =
    [0xffff_3333, 0xff33_ff33, 0xff33_33ff, 0xffff_ff33, 0xff33_ffff, 0xffff_33ff, 0xff80_8080, 0xffff_ffff];

/// The shapes of Line_width, relative to [`ORIGIN`].
const SHAPES: [(Topology, &[[f32; 2]]); 7] = [
    (
        Topology::Points,
        &[
            [19.0, 15.0],
            [56.0, 29.0],
            [74.0, 77.0],
            [45.694405, 101.330154],
            [36.0, 38.369816],
            [14.0, 23.0],
            [85.0, 98.0],
            [31.0, 40.0],
            [98.0, 38.0],
            [17.0, 104.0],
            [78.0, 65.0],
            [31.644773, 49.0],
            [105.0, 11.968842],
            [9.0, 40.0],
            [105.96265, 76.06849],
            [80.0, 87.0],
        ],
    ),
    (
        Topology::LineLoop,
        &[
            [196.0, 47.0],
            [194.0, 19.0],
            [182.0, 97.0],
            [106.18625, 80.0],
            [127.0, 94.58163],
            [133.59744, 13.763389],
            [205.0, 62.0],
            [115.54392, 16.0],
            [122.0, 3.0],
            [117.062706, 87.73556],
            [201.0, 28.664894],
            [146.11409, 10.0],
            [205.3566, 88.0],
            [125.0, 107.0],
            [190.82895, 35.510303],
            [163.0, 105.95682],
        ],
    ),
    (
        Topology::Triangles,
        &[
            [265.1859, 35.0],
            [249.77884, 22.523718],
            [310.0, 19.0],
            [243.97823, 47.650185],
            [304.0, 37.0],
            [232.0, 102.52261],
        ],
    ),
    (Topology::QuadStrip, &[[0.0, 239.0], [0.0, 120.0], [52.5, 225.4], [54.75, 175.5], [105.0, 239.0], [105.0, 120.0]]),
    (
        Topology::TriangleFan,
        &[
            [158.5, 205.0],
            [115.545456, 239.0],
            [120.318184, 120.0],
            [147.04546, 157.4],
            [158.5, 128.5],
            [166.13637, 145.5],
            [204.31818, 159.1],
            [209.75, 239.0],
        ],
    ),
    (Topology::Polygon, &[[218.0, 232.0], [237.77272, 142.1], [258.77274, 120.0], [302.68182, 169.3], [317.0, 230.5]]),
    (Topology::Quads, &[[0.0, 350.0], [60.0, 340.0], [58.5, 425.4], [12.75, 407.5]]),
];

const ORIGIN: [f32; 2] = [160.0, 48.0];

/// Adds the frames of Line_width. Widths that the register does not hold leave it as it was, at one pixel.
pub(super) fn widths(frames: &mut Frames) {
    let whole = |first: u32, end: u32, step: usize| (first * 8..end * 8).step_by(step * 8);
    let fine = (0..16).chain(63 * 8..65 * 8);
    let widths = fine.chain(whole(3, 16, 1)).chain(whole(16, 57, 8)).chain(whole(57, 63, 1)).chain([u32::MAX]);
    for width in widths {
        let name = if width == u32::MAX { "Line_FFFFFFFF".to_owned() } else { named_width("Line", width) };
        let width = if width > u32::from(LARGEST_SIZE) { 8 } else { width as u16 };
        frames.paint(name, 0xff20_2224, move |canvas| shapes(canvas, width, WIREFRAME));
    }
    for width in [0, 8, 256] {
        let name = named_width("Fill", width);
        frames.paint(name, 0xff20_2224, move |canvas| shapes(canvas, width as u16, PolygonModes::FILL));
    }
}

fn named_width(kind: &str, width: u32) -> String {
    format!("{kind}_{:04}.{}", width / 8, width % 8)
}

fn shapes(canvas: &mut Canvas, width: u16, polygon_modes: PolygonModes) {
    let lines = Lines { width, ..Lines::default() };
    for (topology, places) in SHAPES {
        canvas.draw(Draw { lines, polygon_modes, ..shape(topology, places, ORIGIN) });
    }
}

/// Returns a shape of many colours.
fn shape(topology: Topology, places: &[[f32; 2]], [x, y]: [f32; 2]) -> Draw {
    let colored =
        |(place, color): (&[f32; 2], u32)| vertex([x + place[0], y + place[1]], VertexColor::Bytes(abgr(color)));
    draw(topology, places.iter().zip(COLORS.into_iter().cycle()).map(colored).collect())
}

/// Adds the frames of Smoothing_control: four times the same shapes, with smooth lines in the right half and smooth polygons in the lower one, which a
/// register's first bit forbids.
pub(super) fn smoothing(frames: &mut Frames) {
    for (name, allowed) in [("0xFFFF0000", true), ("0xFFFF0001", false)] {
        frames.paint(name, 0xff32_343a, move |canvas| {
            for origin in places([0.0; 2], [320.0, 240.0], 2).take(4) {
                // Line_width's last shape does not occur.
                for (topology, places) in &SHAPES[..6] {
                    let shape = shape(*topology, places, origin);
                    let [right, low] = origin.map(|n| n > 0.0);
                    let is_smooth = if topology.has_faces() { low } else { right && *topology != Topology::Points };
                    canvas.draw(match allowed {
                        true if is_smooth => smooth::smooth(shape),
                        true => thin(shape),
                        false => shape,
                    });
                }
            }
        });
    }
}

/// Returns the draw with thin lines and points.
pub(super) fn thin(draw: Draw) -> Draw {
    let lines = Lines { rasterization: LineRasterization::Bresenham, ..draw.lines };
    Draw { lines, point_rasterization: PointRasterization::Thin, ..draw }
}

/// The shapes that Edge_flag draws a second time, with flags that change from vertex to vertex: whether the first vertex has one.
const FLAGGED: [(Topology, &[[f32; 2]], bool); 3] = [
    (
        Topology::Triangles,
        &[[365.185_94, 35.0], [349.778_84, 22.523_718], [410.0, 19.0], [344.0, 48.0], [404.0, 37.0], [332.0, 103.0]],
        false,
    ),
    (Topology::Polygon, &[[320.0, 232.0], [340.0, 142.1], [361.0, 120.0], [405.0, 169.3], [419.0, 230.5]], true),
    (Topology::Quads, &[[100.0, 350.0], [160.0, 340.0], [158.5, 425.4], [112.75, 407.5]], true),
];

/// Adds the frames of Edge_flag.
pub(super) fn edge_flags(frames: &mut Frames) {
    for (name, enabled) in [("Enabled", true), ("Disabled", false)] {
        frames.paint(name, 0xff30_3234, move |canvas| {
            let plain = SHAPES.map(|(topology, places)| (shape(topology, places, ORIGIN), vec![enabled; places.len()]));
            let flagged = FLAGGED.map(|(topology, places, first)| {
                let flags = (0..places.len()).map(|n| enabled || (n % 2 == 0) == first);
                (shape(topology, places, ORIGIN), flags.collect())
            });
            for (shape, flags) in plain.into_iter().chain(flagged) {
                canvas.draw(Draw { polygon_modes: WIREFRAME, edge_flags: Some(flags.into()), ..shape });
            }
        });
    }
}

/// Returns the patterns of Stipple_tests.
fn patterns() -> [(&'static str, Option<[u32; 32]>); 6] {
    let rows = |word: fn(usize) -> u32| Some(std::array::from_fn(word));
    let checkered = rows(|row| if row % 8 < 4 { 0x0f0f_0f0f } else { 0xf0f0_f0f0 });
    [
        ("Checkered_Off", None),
        ("Checkered_On", checkered),
        ("Zero_On", Some([0; 32])),
        ("Border_On", rows(|row| if row % 31 == 0 { 0 } else { 0x7fff_fffe })),
        ("Alternating_On", Some([0xaaaa_aaaa; 32])),
        ("Asymmetric_On", rows(|row| [0xc0c0_ffff, 0x3030_ffff, 0x0000_8cef, 0x0f00_0f0f][row / 8])),
    ]
}

/// Adds the frames of Stipple_tests.
pub(super) fn stipples(frames: &mut Frames) {
    for (name, pattern) in patterns() {
        frames.paint(name, 0xff20_2224, move |canvas| {
            let polygon_stipple = pattern.map(PolygonStipple);
            let square = rectangle([288.0, 384.0, 352.0, 448.0], VertexColor::Bytes([255; 4]));
            let shapes = SHAPES.map(|(topology, places)| shape(topology, places, ORIGIN));
            for shape in shapes.into_iter().chain([square]) {
                canvas.draw(Draw { polygon_stipple, ..shape });
            }
        });
    }
}

/// Adds the frames of Point_size whose program is known: not the smallest, and not those of a program's size.
pub(super) fn sizes(frames: &mut Frames) {
    for (kind, moved) in [("FF", UNPROJECTED), ("VS", 0.0)] {
        for step in [1, 4, 8, 16] {
            for smooth in ["On", "Off"] {
                let name = format!("PointSmooth{smooth}_{step:02}_{kind}");
                frames.paint(name, 0xff22_2322, move |canvas| grid(canvas, step, moved));
            }
        }
        frames.paint(format!("LargestPointSize_{kind}"), 0xff44_4444, move |canvas| largest(canvas, moved));
    }
}

fn point(at: [f32; 2], point_size: u16, color: VertexColor) -> Draw {
    Draw { point_size, ..draw(Topology::Points, vec![vertex(at, color)]) }
}

/// Draws points whose sizes grow by `step`, as long as the register holds them.
fn grid(canvas: &mut Canvas, step: u16, moved: f32) {
    let [across, down] = if step == 1 { [40, 30] } else { [64, 64] };
    let (mut size, mut red) = (0, 0.1_f32);
    for y in (100_u16..480).step_by(down) {
        let mut blue = 0.1_f32;
        for x in (20_u16..640).step_by(across) {
            let at = [f32::from(x) + moved, f32::from(y) + moved];
            let held = size.min(LARGEST_SIZE - LARGEST_SIZE % step);
            canvas.draw(point(at, held, VertexColor::Floats([red, 0.65, blue, 1.0])));
            (size, blue) = (size + step, blue + 0.1);
        }
        red += 0.1;
    }
}

/// Draws points beside rulers, the second of a size that the register does not hold.
fn largest(canvas: &mut Canvas, moved: f32) {
    for (y, size) in [(138.0_f32, 8), (276.0, 511)] {
        let at = |x: f32| [x + moved, y + moved];
        canvas.draw(point(at(192.0), size, VertexColor::Bytes([0xbb, 0xbb, 0xbb, 255])));
        let (left, top) = (384.0 - 32.0, y - 32.0);
        for edges in [
            [left, top, left + 64.0, top + 64.0],
            [left - 4.0, top, left - 2.0, top + 64.0],
            [left, top - 4.0, left + 64.0, top - 2.0],
        ] {
            let edges = edges.map(|edge| edge + moved);
            canvas.draw(rectangle(edges, VertexColor::Bytes([0, 0xbb, 0, 255])));
        }
        canvas.draw(point(at(384.0), size, VertexColor::Bytes([255; 4])));
    }
}
