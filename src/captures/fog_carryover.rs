//! FOG-1: vertices whose program writes no fog coordinate have that of the vertex before.

use super::fog::foggy;
use super::*;

const RED: [u8; 3] = [255, 0, 0];

fn function(mode: FogMode) -> FogFunction {
    let p0 = match mode {
        FogMode::Linear | FogMode::LinearAbs => 2.0,
        FogMode::Exp | FogMode::ExpAbs => 1.51,
        FogMode::Exp2 | FogMode::Exp2Abs => 1.5,
    };
    FogFunction { mode, p0, p1: -1.0, p2: 0.0, per_vertex: false }
}

fn fogged(topology: Topology, corners: &[([f32; 2], [f32; 3])], coordinate: f32, mode: FogMode) -> Draw {
    let colored = |(at, [r, g, b]): &([f32; 2], [f32; 3])| vertex(*at, VertexColor::Floats([*r, *g, *b, 1.0]));
    foggy(topology, corners.iter().map(|corner| (colored(corner), coordinate)), function(mode), RED)
}

const BLUE: [f32; 3] = [0.0, 0.0, 1.0];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];

/// A shape in one colour.
const fn green<const N: usize>(places: [[f32; 2]; N]) -> [([f32; 2], [f32; 3]); N] {
    let mut all = [([0.0; 2], GREEN); N];
    let mut n = 0;
    while n < N {
        all[n].0 = places[n];
        n += 1;
    }
    all
}

const LINES: &[([f32; 2], [f32; 3])] = &green([
    [8.0, 64.0],
    [160.0, 80.0],
    [236.0, 64.0],
    [312.0, 96.0],
    [312.0, 128.0],
    [160.0, 124.0],
    [160.0, 96.0],
    [8.0, 128.0],
]);
const TRIANGLES: &[([f32; 2], [f32; 3])] = &green([
    [8.0, 64.0],
    [84.0, 64.0],
    [8.0, 128.0],
    [84.0, 128.0],
    [160.0, 64.0],
    [236.0, 128.0],
    [312.0, 64.0],
    [312.0, 128.0],
    [236.0, 64.0],
]);
const STRIP: &[([f32; 2], [f32; 3])] =
    &green([[8.0, 128.0], [8.0, 64.0], [160.0, 96.0], [160.0, 64.0], [236.0, 80.0], [236.0, 64.0], [312.0, 112.0]]);
const FAN: &[([f32; 2], [f32; 3])] = &green([[160.0, 96.0], [8.0, 112.0], [84.0, 64.0], [236.0, 80.0], [312.0, 128.0]]);
const QUADS: &[([f32; 2], [f32; 3])] = &[
    ([8.0, 64.0], [1.0, 1.0, 1.0]),
    ([84.0, 64.0], [0.5, 0.5, 0.6]),
    ([84.0, 96.0], [0.7, 0.7, 0.7]),
    ([8.0, 96.0], [0.33, 0.33, 0.33]),
    ([160.0, 64.0], [1.0, 0.0, 1.0]),
    ([312.0, 64.0], [0.1, 0.3, 0.6]),
    ([312.0, 96.0], [1.0, 1.0, 0.0]),
    ([160.0, 96.0], [0.0, 1.0, 1.0]),
    ([8.0, 112.0], [0.25, 0.25, 0.25]),
    ([312.0, 112.0], [0.1, 0.3, 0.1]),
    ([312.0, 128.0], [0.65, 0.65, 0.65]),
    ([8.0, 128.0], [0.45, 0.45, 0.45]),
];
const QUAD_STRIP: &[([f32; 2], [f32; 3])] =
    &green([[8.0, 128.0], [8.0, 64.0], [160.0, 112.0], [160.0, 80.0], [312.0, 128.0], [312.0, 64.0]]);
const POLYGON: &[([f32; 2], [f32; 3])] = &[
    ([84.0, 128.0], [0.33, 0.7, 0.33]),
    ([8.0, 96.0], [0.7, 0.1, 0.0]),
    ([8.0, 64.0], [0.1, 0.7, 0.5]),
    ([312.0, 80.0], [0.0, 0.9, 0.6]),
    ([236.0, 112.0], [0.4, 0.25, 0.9]),
];

/// Adds the frames of Fog_carryover: shapes with a coordinate, and after each one without.
pub(super) fn frames(frames: &mut Frames) {
    frames.paint("FogCarryover", 0xff20_1f20, |canvas| {
        let start = (640.0 - 192.0) / 3.0;
        for (n, (mode, coordinate)) in (0_u8..).zip([
            (FogMode::Linear, 0.6),
            (FogMode::Exp, 0.1),
            (FogMode::Exp2, 0.2),
            (FogMode::ExpAbs, 0.1),
            (FogMode::Exp2Abs, 0.2),
            (FogMode::LinearAbs, 0.6),
        ]) {
            let top = 62.0 + 50.0 * f32::from(n);
            for left in [start, start * 2.0] {
                let corners = [[left, top], [left + 96.0, top], [left + 48.0, top + 42.0]].map(|at| (at, BLUE));
                canvas.draw(fogged(Topology::Triangles, &corners, coordinate, mode));
            }
        }
    });
    for (name, topology, corners) in [
        ("Points", Topology::Points, LINES),
        ("Lines", Topology::Lines, LINES),
        ("LineLoop", Topology::LineLoop, LINES),
        ("LineStrip", Topology::LineStrip, LINES),
        ("Tris", Topology::Triangles, TRIANGLES),
        ("TriStrip", Topology::TriangleStrip, STRIP),
        ("TriFan", Topology::TriangleFan, FAN),
        ("Quads", Topology::Quads, QUADS),
        ("QuadStrip", Topology::QuadStrip, QUAD_STRIP),
        ("Poly", Topology::Polygon, POLYGON),
    ] {
        frames.paint(format!("Carryover{name}"), 0xffaa_aaaa, move |canvas| {
            for down in [0.0, 104.0, 208.0, 312.0] {
                let moved: Vec<_> = corners.iter().map(|([x, y], color)| ([*x, y + down], *color)).collect();
                canvas.draw(fogged(topology, &moved, 0.6, FogMode::Exp));
                let square = corners_of_square(down).map(|at| (at, BLUE));
                canvas.draw(fogged(Topology::Quads, &square, 0.6, FogMode::Exp));
            }
        });
    }
}

fn corners_of_square(down: f32) -> [[f32; 2]; 4] {
    corners(sized([448.0, 64.0 + down], [64.0; 2]))
}
