//! Computes the examples of the section "Rasteriser".

use crate::build::{draw, vertex};
use crate::handbook::beside_rows;
use crate::pixel::{covering, scene};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::raster::assemble::assemble;
use ninebit::raster::project::{self, ClipPlane};
use ninebit::raster::setup::Triangle;
use ninebit::state::*;

fn triangle(corners: [[f32; 2]; 3]) -> Triangle {
    Triangle::new(corners.map(|[x, y]| [x, y, 0.0, 1.0]), true, Profile::Nv2a).expect("an area")
}

/// Returns the triangles of a draw.
fn split(topology: Topology, vertices: usize) -> Vec<[u32; 3]> {
    let vertices = (0..vertices).map(|n| vertex(n as f32, 0.0, [0; 4])).collect();
    assemble(&draw(topology, vertices)).unwrap().triangles.iter().map(|t| t.vertices).collect()
}

#[test]
fn examples_of_the_rasteriser() {
    let ras0 = beside_rows("RAS-0");
    let refused_by = |x: f32, topology: Topology| {
        let mut draw = Draw { topology, ..covering(Vertex::default()) };
        draw.vertices.update(|index, vertex| vertex.position[0] = if index == 1 { x } else { vertex.position[0] });
        let scene = scene(Profile::Nv2a, SurfaceFormat::A8R8G8B8, [0; 4], vec![draw]);
        Plan::compile(&scene, &PlanOptions::default()).err().map(|errors| errors[0].rule.unwrap())
    };
    ras0.gives("x = 4095.99", refused_by(4095.99, Topology::LineStrip), None)
        .gives("x = 4096", refused_by(4096.0, Topology::LineStrip), Some("RAS-0"))
        .gives("4096 of a triangle", refused_by(4096.0, Topology::Triangles), None)
        .gives("x = 1048576", refused_by(1_048_576.0, Topology::Triangles), Some("RAS-0"));

    beside_rows("RAS-1").shows("16 x", 16.0 * -162.311_39, 2, "-2596.98");

    let corners = triangle([[0.5, 0.5], [16.5, 0.5], [0.5, 16.5]]);
    // Edge k lies opposite to corner k: 0 is slanted, 1 is the left edge, 2 is the top edge.
    let on_edge = [[0, 1, 1], [1, 0, 1], [1, 1, 0]];
    beside_rows("RAS-3").gives("edges that own their samples", on_edge.map(|e| corners.covers(e)), [false, true, true]);

    let strip = split(Topology::TriangleStrip, 5);
    beside_rows("RAS-4").gives("a strip of five", strip, vec![[0, 1, 2], [2, 1, 3], [2, 3, 4]]);

    let ras6 = beside_rows("RAS-6");
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
    ras6.gives("w + z", positions.map(|[_, _, z, w]| w + z), [1.0, -4.0, 1.0]);
    let corners = positions.map(|position| Vertex { position, ..Vertex::default() }).to_vec();
    let clipped = Draw { positions: Positions::Clip(port), ..draw(Topology::Triangles, corners) };
    ras6.gives("triangles", assemble(&clipped).unwrap().triangles.len(), 2);
}
