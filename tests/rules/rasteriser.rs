//! Examples of the section "Rasteriser".

use crate::build::{draw, vertex};
use crate::handbook::{beside_rows, example};
use crate::pixel::{covering, scene};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::raster::assemble::assemble;
use ninebit::raster::project::{self, ClipPlane};
use ninebit::raster::setup::Triangle;
use ninebit::state::*;

fn triangle(corners: [[f32; 2]; 3]) -> Triangle {
    Triangle::new(corners.map(|[x, y]| [x, y, 0.0, 1.0]), true, Profile::Nv2a).expect("an area")
}

/// The triangles of a draw and the vertex whose colours each takes when it is flat.
fn split(topology: Topology, vertices: usize, provoking_vertex: ProvokingVertex) -> Vec<([u32; 3], u32)> {
    let vertices = (0..vertices).map(|n| vertex(n as f32, 0.0, [0; 4])).collect();
    let draw = Draw { provoking_vertex, ..draw(topology, vertices) };
    assemble(&draw).unwrap().triangles.iter().map(|t| (t.vertices, t.provoking)).collect()
}

#[test]
fn examples_of_the_rasteriser() {
    let ras0 = beside_rows("RAS-0");
    let refused_by = |x: f32| {
        let mut draw = covering(Vertex::default());
        draw.vertices.update(|index, vertex| vertex.position[0] = if index == 1 { x } else { vertex.position[0] });
        let scene = scene(Profile::Nv2a, SurfaceFormat::A8R8G8B8, [0; 4], vec![draw]);
        Plan::compile(&scene, &PlanOptions::default()).err().map(|errors| errors[0].rule.unwrap())
    };
    ras0.gives("x = 4095.99", refused_by(4095.99), None).gives("x = 4096", refused_by(4096.0), Some("RAS-0"));

    beside_rows("RAS-1").shows("16 x", 16.0 * -162.311_39, 2, "-2596.98");

    let corners = triangle([[0.5, 0.5], [16.5, 0.5], [0.5, 16.5]]);
    // Edge k lies opposite of corner k: 0 is slanted, 1 the left edge, 2 the top edge.
    beside_rows("RAS-3").gives("edges that own their samples", corners.owns, [false, true, true]);

    let ras4 = beside_rows("RAS-4");
    let strip: Vec<[u32; 3]> =
        split(Topology::TriangleStrip, 5, ProvokingVertex::First).into_iter().map(|t| t.0).collect();
    ras4.gives("a strip of five", strip, vec![[0, 1, 2], [2, 1, 3], [2, 3, 4]]);

    let ras5 = beside_rows("RAS-5");
    let fan = split(Topology::TriangleFan, 4, ProvokingVertex::Last);
    ras5.gives("a fan of four", fan, vec![([0, 1, 2], 2), ([0, 2, 3], 3)]);

    let ras6 = example(
        "RAS-6",
        "positions (0, 0, 0, 1), (4, 0, -3, -1), (0, 4, 0, 1): w + z is 1, -4 and 1, so near cuts the second off; four vertices are \
         left, two triangles.",
    );
    let positions = [[0.0, 0.0, 0.0, 1.0], [4.0, 0.0, -3.0, -1.0], [0.0, 4.0, 0.0, 1.0]];
    let port = Viewport {
        x: 0.0,
        y: 0.0,
        width: 64.0,
        height: 64.0,
        near: 0.0,
        far: 1.0,
        clip_depth: ClipDepth::MinusOneToOne,
        depth_clamp: false,
    };
    let beyond = positions.map(|position| project::beyond(position, &port) & ClipPlane::Near.bit());
    ras6.gives("who lies beyond near", beyond, [0, ClipPlane::Near.bit(), 0]);
    let corners = positions.map(|position| Vertex { position, ..Vertex::default() });
    let (polygon, planes) = project::clip(&corners, &port);
    ras6.gives("vertices and planes", (polygon.len(), planes), (4, ClipPlane::Near.bit()));
    let clipped = Draw { positions: Positions::Clip(port), ..draw(Topology::Triangles, corners.to_vec()) };
    ras6.gives("triangles", assemble(&clipped).unwrap().triangles.len(), 2);

    let ras7 =
        example("RAS-7", "from (0, 0, 0, 1) to (4, 0, -3, -1): t = 1/5, and the new vertex is (0.8, 0, -0.6, 0.6).");
    ras7.gives("the new vertex", polygon[1].position, [0.8, 0.0, -0.6, 0.6]);
}
