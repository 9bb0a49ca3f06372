//! Vertices and indices to triangles: RAS-4's splits, RAS-5's provoking vertices, RAS-0's clip and limits.

use super::{GUARD, LARGEST_W, SMALLEST_W, project};
use crate::number::convert::{snap, vertex_color};
use crate::state::{Draw, Positions, ProvokingVertex, Topology, Vertex, VertexColor};

/// A triangle of a draw: the order of its vertices matters (INT-2 gives the second one the remainder).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Assembled {
    /// Indices into [`Assembly::vertices`].
    pub vertices: [u32; 3],
    /// The vertex whose colours a flat triangle takes.
    pub provoking: u32,
}

/// What setting up a triangle takes of a vertex: each number as the chip enters it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corner {
    /// x and y, 1/16 pixel (RAS-1); 0 of vertices that no triangle uses.
    pub position: [i32; 2],
    /// w.
    pub w: f32,
    /// Diffuse (NUM-4).
    pub primary: [u8; 4],
    /// Specular (NUM-4).
    pub secondary: [u8; 4],
}

/// A draw's vertices in window coordinates, and its triangles in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    /// Window positions; those of vertices that no triangle uses are left as they were.
    pub vertices: Vec<Vertex>,
    /// The same vertices as triangles enter them.
    pub corners: Vec<Corner>,
    /// Triangles in order.
    pub triangles: Vec<Assembled>,
}

/// A vertex outside RAS-0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionError {
    /// Index of the draw's vertex.
    pub vertex: usize,
    /// Where it ended up: window x, y, depth and w.
    pub window: [f32; 4],
}

/// At most this many errors are reported for a draw.
const MOST_ERRORS: usize = 8;

/// Forms the triangles of a draw.
///
/// # Errors
/// The vertices (eight at most) that a triangle uses and whose window position or w lies outside RAS-0.
pub fn assemble(draw: &Draw) -> Result<Assembly, Vec<PositionError>> {
    let mut vertices = draw.vertices.clone();
    let mut triangles = split(&draw.indices, draw.topology, draw.provoking_vertex);
    if let Positions::Clip(viewport) = &draw.positions {
        triangles = clip_and_project(&mut vertices, triangles, viewport);
    }
    let mut used = vec![false; vertices.len()];
    for triangle in &triangles {
        for v in triangle.vertices {
            used[v as usize] = true;
        }
    }
    let errors: Vec<PositionError> = (0..vertices.len())
        .filter(|v| used[*v] && !in_range(vertices[*v].position))
        .take(MOST_ERRORS)
        .map(|v| PositionError { vertex: v.min(draw.vertices.len() - 1), window: vertices[v].position })
        .collect();
    if !errors.is_empty() {
        return Err(errors);
    }
    let corners = vertices.iter().zip(used).map(|(vertex, used)| corner(vertex, used)).collect();
    Ok(Assembly { vertices, corners, triangles })
}

fn corner(vertex: &Vertex, used: bool) -> Corner {
    let [x, y, _, w] = vertex.position;
    Corner {
        position: if used { [snap(x) as i32, snap(y) as i32] } else { [0; 2] },
        w,
        primary: color_bytes(&vertex.diffuse),
        secondary: color_bytes(&vertex.specular),
    }
}

/// NUM-4, or the bytes as they are.
fn color_bytes(color: &VertexColor) -> [u8; 4] {
    match color {
        VertexColor::Bytes(bytes) => *bytes,
        VertexColor::Floats(floats) => floats.map(vertex_color),
    }
}

/// RAS-0 for a window position.
fn in_range(p: [f32; 4]) -> bool {
    p.iter().all(|n| n.is_finite())
        && p[..2].iter().all(|n| n.abs() <= 4096.0 && snap(*n).abs() < GUARD)
        && (SMALLEST_W..=LARGEST_W).contains(&p[3])
}

/// RAS-4 and RAS-5. Indices that do not fill a primitive are ignored.
fn split(indices: &[u32], topology: Topology, provoking: ProvokingVertex) -> Vec<Assembled> {
    let first = provoking == ProvokingVertex::First;
    let triangle = |a: usize, b: usize, c: usize, provoking: usize| Assembled {
        vertices: [indices[a], indices[b], indices[c]],
        provoking: indices[provoking],
    };
    let count = indices.len();
    let mut out = Vec::new();
    match topology {
        Topology::Triangles => {
            out.extend(
                (0..count / 3).map(|t| triangle(3 * t, 3 * t + 1, 3 * t + 2, 3 * t + if first { 0 } else { 2 })),
            );
        }
        Topology::TriangleStrip => out.extend((0..count.saturating_sub(2)).map(|i| {
            let (a, b) = if i % 2 == 0 { (i, i + 1) } else { (i + 1, i) };
            triangle(a, b, i + 2, if first { i } else { i + 2 })
        })),
        Topology::TriangleFan => {
            out.extend((1..count.saturating_sub(1)).map(|i| triangle(0, i, i + 1, if first { i } else { i + 1 })));
        }
        Topology::Quads => out.extend((0..count / 4).flat_map(|q| {
            let v = 4 * q;
            [triangle(v, v + 1, v + 2, v + 3), triangle(v, v + 2, v + 3, v + 3)]
        })),
        Topology::QuadStrip => out.extend((0..(count / 2).saturating_sub(1)).flat_map(|q| {
            let v = 2 * q;
            [triangle(v, v + 1, v + 2, v + 3), triangle(v + 2, v + 1, v + 3, v + 3)]
        })),
        Topology::Polygon => out.extend((1..count.saturating_sub(1)).map(|i| triangle(0, i, i + 1, 0))),
    }
    out
}

/// Projects what lies in front of w = 2^-20 and replaces triangles that cross it by their pieces, split as a polygon.
fn clip_and_project(
    vertices: &mut Vec<Vertex>,
    triangles: Vec<Assembled>,
    viewport: &crate::state::Viewport,
) -> Vec<Assembled> {
    let inside: Vec<bool> = vertices.iter().map(|v| v.position[3] >= SMALLEST_W).collect();
    let mut out = Vec::with_capacity(triangles.len());
    for triangle in triangles {
        let corners = triangle.vertices.map(|v| v as usize);
        if corners.iter().all(|v| inside[*v]) {
            out.push(triangle);
        } else if corners.iter().any(|v| inside[*v]) {
            let polygon = project::clip([&vertices[corners[0]], &vertices[corners[1]], &vertices[corners[2]]]);
            let start = vertices.len() as u32;
            out.extend(
                (1..polygon.len() as u32 - 1)
                    .map(|i| Assembled { vertices: [start, start + i, start + i + 1], provoking: triangle.provoking }),
            );
            vertices.extend(polygon);
        }
    }
    for vertex in vertices.iter_mut().filter(|v| v.position[3] >= SMALLEST_W) {
        vertex.position = project::window(vertex.position, viewport);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shapes(topology: Topology, count: u32, provoking: ProvokingVertex) -> Vec<([u32; 3], u32)> {
        let indices: Vec<u32> = (0..count).collect();
        split(&indices, topology, provoking).into_iter().map(|t| (t.vertices, t.provoking)).collect()
    }

    #[test]
    fn splits_and_provoking_vertices() {
        use ProvokingVertex::{First, Last};
        assert_eq!(shapes(Topology::Triangles, 7, First), [([0, 1, 2], 0), ([3, 4, 5], 3)]);
        assert_eq!(shapes(Topology::Triangles, 3, Last), [([0, 1, 2], 2)]);
        assert_eq!(shapes(Topology::TriangleStrip, 5, First), [([0, 1, 2], 0), ([2, 1, 3], 1), ([2, 3, 4], 2)]);
        assert_eq!(shapes(Topology::TriangleStrip, 4, Last), [([0, 1, 2], 2), ([2, 1, 3], 3)]);
        assert_eq!(shapes(Topology::TriangleFan, 4, First), [([0, 1, 2], 1), ([0, 2, 3], 2)]);
        assert_eq!(shapes(Topology::TriangleFan, 4, Last), [([0, 1, 2], 2), ([0, 2, 3], 3)]);
        assert_eq!(shapes(Topology::Quads, 5, First), [([0, 1, 2], 3), ([0, 2, 3], 3)]);
        assert_eq!(
            shapes(Topology::QuadStrip, 6, Last),
            [([0, 1, 2], 3), ([2, 1, 3], 3), ([2, 3, 4], 5), ([4, 3, 5], 5)]
        );
        assert_eq!(shapes(Topology::Polygon, 5, Last), [([0, 1, 2], 0), ([0, 2, 3], 0), ([0, 3, 4], 0)]);
        assert!(shapes(Topology::TriangleStrip, 2, First).is_empty());
    }
}
