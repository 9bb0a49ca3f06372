//! FOG-1 to FOG-5: all fog modes, over coordinates of every source and magnitude, infinities and NaN.

use super::*;
use ninebit::vertex::fog::passed;
use ninebit::vertex::unit;

/// Names of [`FogMode::ALL`] as they appear in the names of frames.
const MODES: &str = "linear exp exp2 linear_abs exp_abs exp2_abs";

/// Returns the parameters p0 and p1 of the programs: full fog at 200, or a density of 0.025.
fn parameters(mode: FogMode, start: f32) -> [f32; 2] {
    let (end, density) = (200.0_f32, 0.025_f32);
    match mode {
        FogMode::Linear | FogMode::LinearAbs => {
            let multiplier = -1.0 / (end - start);
            [1.0 + -end * multiplier, multiplier]
        }
        FogMode::Exp | FogMode::ExpAbs => [1.5, -density / (2.0 * 5.5452)],
        FogMode::Exp2 | FogMode::Exp2Abs => [1.5, -density / (2.0 * 2.3548)],
    }
}

fn function(mode: FogMode, [p0, p1]: [f32; 2]) -> FogFunction {
    FogFunction { mode, p0, p1, p2: 0.0, per_vertex: false }
}

/// Returns combiners that interpolate between two registers by the fog factor.
fn mixed(full: &str, none: &str) -> Combiners {
    program(&format!("out.rgb = lerp(fog.a, {full}, {none}); out.a = col0.a;"))
}

/// Returns a draw in fog, given each vertex with its fog coordinate.
pub(super) fn foggy(
    topology: Topology,
    vertices: impl Iterator<Item = (Vertex, f32)>,
    function: FogFunction,
    color: [u8; 3],
) -> Draw {
    let fog = |d| passed(&function, Profile::Nv2a, d);
    let vertex = |(vertex, d): (Vertex, f32)| Vertex { fog: fog(d), fog_coordinate: Some(d), ..vertex };
    let fog = Fog { enabled: true, color, function: Some(function) };
    let combiners = mixed("col0", "fog");
    Draw { fog, combiners, ..draw(topology, vertices.map(vertex).collect()) }
}

/// Four triangles of the world, from near to far.
const TRIANGLES: [[[f32; 3]; 3]; 4] = [
    [[-1.5, -1.5, 0.0], [-2.5, 0.6, 0.0], [-0.5, 0.6, 0.0]],
    [[0.0, -1.5, 5.0], [-1.0, 0.75, 10.0], [2.0, 0.75, 20.0]],
    [[5.0, -2.0, 30.0], [3.0, 2.0, 40.0], [12.0, 2.0, 70.0]],
    [[20.0, -10.0, 50.0], [12.0, 10.0, 125.0], [80.0, 10.0, 200.0]],
];

/// The depth range, in the steps of [`space::window`]; what lies beyond is culled.
const FARTHEST: DepthRange = DepthRange { lowest: 0.0, highest: 65535.0, clamps: false, drops_triangles: false };

/// Draws the triangles in white, through the fixed function or a vertex program. `coordinate` maps each vertex's w to its fog coordinate. The tip of
/// the last triangle lies beyond the farthest depth.
fn triangles(is_program: bool, coordinate: impl Fn(f32) -> f32, function: FogFunction, color: [u8; 3]) -> Draw {
    let place = if is_program { space::programmed } else { space::fixed_function };
    let vertices = TRIANGLES.as_flattened().iter().map(|[x, y, z]| {
        let position = place([*x, *y, *z, 1.0]);
        (Vertex { position, ..Vertex::default() }, coordinate(position[3]))
    });
    // Through a vertex program, the programs set a farther limit.
    let depth_test = (!is_program).then(|| in_steps(CompareFunction::Always, false, Some(FARTHEST)));
    Draw { depth_test, ..foggy(Topology::Triangles, vertices, function, color) }
}

fn all_modes(frames: &mut Frames, is_program: bool, coordinate: fn(f32) -> f32) {
    for (name, mode) in named(MODES) {
        let function = function(mode, parameters(mode, 1.0));
        let draw = triangles(is_program, coordinate, function, [0x30, 0x20, 0x7f]);
        frames.push(format!("AFF-{name}-planar"), one(0xff30_3030, None, draw));
    }
}

/// Adds the frames of Fog: the coordinate is the depth in eye space.
pub(super) fn planar(frames: &mut Frames) {
    all_modes(frames, false, |w| w);
}

/// Adds the frames of Fog_vsh: a vertex program passes w as the coordinate.
pub(super) fn of_program(frames: &mut Frames) {
    all_modes(frames, true, |w| w);
}

/// Adds the frames of Fog_inf_coord: a vertex program passes the reciprocal of 0.
pub(super) fn infinite(frames: &mut Frames) {
    all_modes(frames, true, |_| f32::INFINITY);
}

/// Components of the fog coordinate that a vertex program writes, and the four values. `_` separates its instructions. If an instruction writes
/// several components, the first of them is the coordinate.
const COMPONENTS: [(&str, &[[f32; 4]]); 18] = [
    ("W", &[[0.0, 0.25, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0], [1.0, 0.0, 0.0, 0.5], [0.3, 0.3, 0.3, 1.0]]),
    ("W_X", &[[0.25, 0.0, 0.0, 0.5], [0.65, 0.0, 0.0, 0.0]]),
    ("W_Y", &[[1.0, 0.0, 1.0, 0.75], [0.0, 0.75, 0.75, 0.25]]),
    ("W_Z_Y_X", &[[0.25, 0.5, 0.75, 1.0], [1.0, 0.75, 0.5, 0.25]]),
    ("X", &[[0.0, 0.0, 0.0, 0.0], [0.9, 0.0, 0.0, 0.0]]),
    ("X_Y_Z_W", &[[1.0, 0.25, 0.75, 0.5], [0.0, 0.33, 0.66, 0.9]]),
    ("Y", &[[0.0, 0.0, 0.0, 0.0], [0.0, 0.1, 0.0, 0.0], [0.0, 0.6, 0.0, 0.0]]),
    ("Z", &[[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.2, 0.0], [0.0, 0.0, 0.8, 0.0]]),
    ("XW", &[[0.25, 0.0, 0.0, 0.5], [0.65, 0.0, 0.0, 0.0]]),
    ("XY", &[[0.25, 0.5, 0.0, 0.0], [0.65, 0.75, 0.0, 0.0]]),
    ("XYZ", &[[0.25, 0.5, 0.75, 0.0], [0.65, 0.75, 0.33, 0.0]]),
    ("XYZW", &[[0.25, 0.5, 0.75, 1.0], [0.65, 0.75, 0.33, 0.0]]),
    ("XZ", &[[0.25, 0.0, 0.75, 0.0], [0.65, 0.0, 0.33, 0.0]]),
    ("XZW", &[[0.25, 0.0, 0.75, 1.0], [0.65, 0.0, 0.33, 0.0]]),
    ("YW", &[[0.0, 0.5, 0.0, 1.0], [0.0, 0.75, 0.0, 0.0]]),
    ("YZ", &[[0.0, 0.5, 0.75, 0.0], [0.0, 0.75, 0.33, 0.0]]),
    ("YZW", &[[0.0, 0.5, 0.75, 1.0], [0.0, 0.75, 0.33, 0.0]]),
    ("ZW", &[[0.0, 0.0, 0.75, 1.0], [0.0, 0.0, 0.33, 0.0]]),
];

/// Returns the coordinate that the chip takes: the first component that the last instruction writes.
fn taken(written: &str, values: [f32; 4]) -> f32 {
    let last = written.rsplit('_').next().and_then(|last| last.chars().next());
    let component = last.and_then(|letter| "XYZW".find(letter)).unwrap_or_default();
    values[component]
}

/// Adds the frames of Fog_coord_vec4.
pub(super) fn of_components(frames: &mut Frames) {
    let function = function(FogMode::Linear, [1.0, 1.0]);
    for (written, values) in COMPONENTS {
        for [x, y, z, w] in values {
            let draw = triangles(true, |_| taken(written, [*x, *y, *z, *w]), function, [0, 255, 0]);
            let name = format!("{written}-{x:.2}_{y:.2}_{z:.2}_{w:.2}");
            frames.push(name, one(0xff30_3030, None, Draw { combiners: mixed("fog", "col0"), ..draw }));
        }
    }
    // The program writes no coordinate, so the one that earlier draws have left applies.
    let draw = triangles(true, |_| 0.25, function, [0, 255, 0]);
    let text = "const0 = bytes(127, 0, 191, 255); out.rgb = lerp(fog.a, const0, col0); out.a = col0.a;";
    let combiners = program(text);
    frames.push("CoordNotSet", one(0xff34_1010, None, Draw { combiners, ..draw }));
}

/// Returns the vertices of a rectangle, clockwise from the upper left. Its left and right edges may have a different w.
fn panel(edges: [f32; 4], [left_w, right_w]: [f32; 2], colors: [[f32; 4]; 4], is_program: bool) -> [Vertex; 4] {
    let edges = if is_program { space::programmed_edges(edges) } else { unprojected(edges) };
    std::array::from_fn(|n| {
        let ([x, y], w) = (corners(edges)[n], [left_w, right_w, right_w, left_w][n]);
        Vertex { position: [x, y, 0.0, w], diffuse: VertexColor::Floats(colors[n]), ..Vertex::default() }
    })
}

/// Returns the edges of square panels row by row, as far as they fit the screen. `corner` is the upper left corner of the first.
fn grid(corner: [f32; 2], side: f32, gaps: [f32; 2]) -> impl Iterator<Item = [f32; 4]> {
    let (right, bottom) = (640.0 - (corner[0] + side), 480.0 - side);
    let [mut left, mut top] = corner;
    std::iter::from_fn(move || {
        let edges = (top < bottom).then(|| sized([left, top], [side, side]))?;
        left += side + gaps[0];
        if left >= right {
            (left, top) = (corner[0], top + side + gaps[1]);
        }
        Some(edges)
    })
}

/// Returns numbers that grow by a step; each sum is rounded to single precision.
fn steps(first: f32, step: f32) -> impl Iterator<Item = f32> {
    std::iter::successors(Some(first), move |value| Some(value + step))
}

const RED: [u8; 3] = [255, 0, 0];

/// Adds the frames of Fog_param: 320 coordinates through eight multipliers, and 340 biases.
pub(super) fn parameters_varied(frames: &mut Frames) {
    for (name, mode) in named(MODES) {
        let name = name.replace("linear", "lin");
        let bias = match mode {
            FogMode::Linear | FogMode::LinearAbs => 2.0,
            FogMode::Exp => 1.51,
            FogMode::ExpAbs => 1.5075,
            FogMode::Exp2 | FogMode::Exp2Abs => 1.5,
        };
        for multiplier in [1.0, 2.0, -1.0, -2.0, 0.5, -0.5, -0.25, 0.25] {
            frames.make(format!("FogParam{multiplier:.2}-{name}"), move || {
                let places = grid([60.0, 70.0], 24.0, [1.0, 1.0]).zip(steps(-1.4, 0.01));
                let panels = places.flat_map(|(edges, d)| {
                    panel(edges, [7.0, 8.0], [[0.0, 0.0, 1.0, 1.0]; 4], false).map(|vertex| (vertex, d))
                });
                one(0xff23_1f23, None, foggy(Topology::Quads, panels, function(mode, [bias, multiplier]), RED))
            });
        }
        frames.paint(format!("FogZeroBias-{name}"), 0xff23_1f23, move |canvas| {
            for (edges, bias) in grid([48.0, 46.0], 24.0, [2.0, 1.0]).zip(steps(1.0, 0.005)) {
                let panel = panel(edges, [8.0, 8.0], [[0.0, 0.5, 0.5, 1.0]; 4], false);
                let panel = panel.into_iter().map(|vertex| (vertex, -1.0));
                canvas.draw(foggy(Topology::Quads, panel, function(mode, [bias, 0.0]), RED));
            }
        });
    }
}

/// Sources of the fog coordinate, as the names of frames have them.
const SOURCES: [&str; 5] = ["spec_alpha", "radial", "planar", "abs_planar", "fog_x"];

/// The alphas of the secondary colours at a panel's corners.
const SECONDARY_ALPHAS: [f32; 4] = [0.0, 1.0, 0.75, 0.25];

/// Returns the distance from the eye of a point that programs find for a panel's corner, by the transform unit.
fn distance(edges: [f32; 4], corner: usize, z: f32, inverse: &space::Matrix) -> f32 {
    let point = space::unproject(corners(edges)[corner], z, inverse);
    let [x, y, z, _] = unit::transform(&space::rows(&space::eye()), unit::words(point));
    f32::from_bits(unit::direction([x, y, z]).1)
}

/// Adds the frames of Fog_gen: panels farther and farther away, with coordinates of five sources. With a vertex program, every source yields the
/// coordinate that the program passes.
pub(super) fn generated(frames: &mut Frames) {
    for (name, mode) in named(MODES) {
        for source in SOURCES {
            for is_program in [false, true] {
                if is_program && source == "radial" {
                    // The chip's result differs from run to run.
                    continue;
                }
                let path = if is_program { "VS" } else { "FF" };
                frames.make(format!("FogGen_{path}-{name}-{source}"), move || {
                    let [p0, p1] = match (source, mode) {
                        ("spec_alpha", FogMode::Linear | FogMode::LinearAbs) if !is_program => [0.0, 2.0],
                        ("spec_alpha", FogMode::Exp | FogMode::ExpAbs) if !is_program => [0.5, 1.0 / 16.0],
                        ("spec_alpha", _) if !is_program => [0.5, (1.0_f64 / 32.0).sqrt() as f32],
                        _ => parameters(mode, 0.0),
                    };
                    let inverse = space::inverse(&space::product(space::eye(), space::window()));
                    let places = grid([48.0, 70.0], 22.0, [2.0, 2.0]).zip(steps(-6.0, 0.5)).zip(steps(50.0, -0.2));
                    let panels = places.flat_map(|((edges, z), fog_x)| {
                        let w = [z + 7.0, z + 8.0];
                        let panel = panel(edges, w, [[0.0, 0.0, 1.0, 1.0]; 4], is_program);
                        panel.into_iter().enumerate().map(move |(corner, vertex)| {
                            let [.., w] = vertex.position;
                            let d = match source {
                                _ if is_program => fog_x,
                                "spec_alpha" => SECONDARY_ALPHAS[corner],
                                "radial" => distance(edges, corner, w - 7.0, &inverse),
                                "fog_x" => fog_x,
                                // The programs' plane yields twice the depth.
                                _ => 2.0 * w,
                            };
                            (vertex, d)
                        })
                    });
                    one(0xff23_2623, None, foggy(Topology::Quads, panels, function(mode, [p0, p1]), RED))
                });
            }
        }
    }
}

/// Exceptional and ordinary coordinates, as binary32 words.
const EXCEPTIONAL: [[u32; 7]; 3] = [
    [0, 0x3f80_0000, 0x4120_0000, 0x42c8_0000, 0x447a_0000, 0xbf9e_b852, 0xc12c_0000],
    [0x7f80_0000, 0xff80_0000, 0x7fc0_0000, 0xffc0_0000, 0x7f80_0001, 0xff80_0001, 0x7f7f_ffff],
    [0xff7f_ffff, 0x0080_0000, 0x8080_0000, 0x007f_ffff, 0x807f_ffff, 0x0000_0001, 0x8000_0001],
];

/// Returns the reciprocal as the vertex unit computes it, which flushes subnormal numbers to 0.
fn reciprocal(value: f32) -> f32 {
    let flushed = |value: f32| if value.is_subnormal() { 0.0_f32.copysign(value) } else { value };
    flushed(1.0 / flushed(value))
}

fn exceptional_panel(edges: [f32; 4], d: f32) -> impl Iterator<Item = (Vertex, f32)> {
    let colors = [[0.25, 0.5, 0.5, 1.0], [0.25, 0.25, 0.75, 1.0], [0.25, 0.0, 1.0, 1.0], [0.25, 0.75, 0.25, 1.0]];
    panel(edges, [7.0, 9.0], colors, true).into_iter().map(move |vertex| (vertex, d))
}

/// Adds the frames of Fog_exceptional_value: a vertex program passes exceptional coordinates or their reciprocals; infinity and NaN are also drawn
/// under 24 pairs of parameters.
pub(super) fn exceptional(frames: &mut Frames) {
    let places = || grid([48.0, 70.0], 64.0, [24.0, 38.0]);
    for (name, mode) in named(MODES) {
        for source in SOURCES.into_iter().filter(|source| *source != "radial") {
            for (prefix, is_reciprocal) in [("", false), ("RCP-", true)] {
                frames.make(format!("{prefix}FogExc-{name}-{source}"), move || {
                    let coordinates = EXCEPTIONAL.as_flattened().iter().map(|word| f32::from_bits(*word));
                    let coordinates = coordinates.map(|d| if is_reciprocal { reciprocal(d) } else { d });
                    let panels = places().zip(coordinates).flat_map(|(edges, d)| exceptional_panel(edges, d));
                    one(0xff23_2623, None, foggy(Topology::Quads, panels, function(mode, parameters(mode, 1.0)), RED))
                });
            }
            for (prefix, d) in [("INF", f32::INFINITY), ("NaN", f32::NAN)] {
                frames.paint(format!("{prefix}-FogExc-{name}-{source}"), 0xff23_2623, move |canvas| {
                    let modes = [FogMode::Linear, FogMode::Exp, FogMode::Exp2];
                    let [linear, exp, exp2] = modes.map(|mode| parameters(mode, 1.0)[1]);
                    let biases = [-1.0, 1.0, 1.5, 1000.0].into_iter();
                    let pairs = biases.flat_map(|p0| [linear, exp, exp2, 1.0, 0.0, -1000.0].map(|p1| [p0, p1]));
                    for (edges, pair) in places().zip(pairs) {
                        canvas.draw(foggy(Topology::Quads, exceptional_panel(edges, d), function(mode, pair), RED));
                    }
                });
            }
        }
    }
}
