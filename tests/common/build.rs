//! Builds scenes in few words, with the state that the captured programs leave at its default.

use ninebit::state::*;

/// Returns a colour target without a depth buffer.
pub fn target(width: u32, height: u32, format: SurfaceFormat, clear_color: [u8; 4]) -> Target {
    Target { clear_color, ..Target::new(width, height, format) }
}

/// Returns a vertex in window coordinates, with z = 0 and w = 1.
pub fn vertex(x: f32, y: f32, diffuse: [u8; 4]) -> Vertex {
    Vertex { position: [x, y, 0.0, 1.0], diffuse: VertexColor::Bytes(diffuse), ..Vertex::default() }
}

/// Returns a draw of `vertices` in order that stores the primary colour.
pub fn draw(topology: Topology, vertices: Vec<Vertex>) -> Draw {
    Draw {
        indices: (0..vertices.len() as u32).collect(),
        vertices: vertices.into(),
        topology,
        provoking_vertex: ProvokingVertex::First,
        combiners: Combiners::showing(FinalRegister::PrimaryColor),
        ..Draw::default()
    }
}
