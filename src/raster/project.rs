//! Clip space to window, and the clip at the smallest w, in f32 and in this order of operations (RAS-0).
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule; set-up quantises afterwards")]

use super::SMALLEST_W;
use crate::state::{Vertex, VertexColor, Viewport};

/// Window position of a clip-space position whose w is at least [`SMALLEST_W`].
pub fn window(clip: [f32; 4], viewport: &Viewport) -> [f32; 4] {
    let w = clip[3];
    let ndc = [clip[0] / w, clip[1] / w, clip[2] / w];
    [
        viewport.x + (ndc[0] + 1.0) * (viewport.width / 2.0),
        viewport.y + (1.0 - ndc[1]) * (viewport.height / 2.0),
        viewport.near + (ndc[2] + 1.0) * ((viewport.far - viewport.near) / 2.0),
        w,
    ]
}

/// The part of a clip-space triangle with w >= 2^-20, as a polygon of 0, 3 or 4 vertices in the triangle's order.
///
/// A new vertex is always computed from the inside vertex towards the outside one, so that neighbours meet.
pub fn clip(triangle: &[Vertex; 3]) -> Vec<Vertex> {
    let inside = |v: &Vertex| v.position[3] >= SMALLEST_W;
    let mut polygon = Vec::with_capacity(4);
    for k in 0..3 {
        let (from, to) = (&triangle[k], &triangle[(k + 1) % 3]);
        match (inside(from), inside(to)) {
            (true, true) => polygon.push(*from),
            (true, false) => polygon.extend([*from, crossing(from, to)]),
            (false, true) => polygon.push(crossing(to, from)),
            (false, false) => {}
        }
    }
    polygon
}

/// Where the edge from `inside` to `outside` reaches w = 2^-20.
fn crossing(inside: &Vertex, outside: &Vertex) -> Vertex {
    let t = (inside.position[3] - SMALLEST_W) / (inside.position[3] - outside.position[3]);
    let mix = |a: f32, b: f32| a + (b - a) * t;
    let mut position: [f32; 4] = std::array::from_fn(|n| mix(inside.position[n], outside.position[n]));
    position[3] = SMALLEST_W;
    let color = |a: VertexColor, b: VertexColor| {
        if let (VertexColor::Bytes(x), VertexColor::Bytes(y)) = (a, b)
            && x == y
        {
            return a;
        }
        let (a, b) = (floats(a), floats(b));
        VertexColor::Floats(std::array::from_fn(|n| mix(a[n], b[n])))
    };
    Vertex {
        position,
        diffuse: color(inside.diffuse, outside.diffuse),
        specular: color(inside.specular, outside.specular),
        fog: mix(inside.fog, outside.fog),
        fog_coordinate: inside.fog_coordinate.zip(outside.fog_coordinate).map(|(a, b)| mix(a, b)),
        texture_coordinates: std::array::from_fn(|set| {
            std::array::from_fn(|n| mix(inside.texture_coordinates[set][n], outside.texture_coordinates[set][n]))
        }),
    }
}

fn floats(color: VertexColor) -> [f32; 4] {
    match color {
        VertexColor::Bytes(bytes) => bytes.map(|b| f32::from(b) / 255.0),
        VertexColor::Floats(floats) => floats,
    }
}
