//! The vertices of a draw to window coordinates: RAS-0's clip and limits.

pub use super::triangles::{Assembled, Triangles};
use super::{GUARD, LARGEST_W, SMALLEST_W, project};
use crate::number::convert::{snap, vertex_color};
use crate::state::{Draw, Positions, TriangleVertices, Vertex, VertexColor, Vertices, Viewport};

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
    /// Window positions; those of vertices that no triangle uses are left as they were. What they have in common with the
    /// draw's vertices they share.
    pub vertices: Vertices,
    /// The same vertices as triangles enter them.
    pub corners: Vec<Corner>,
    /// Triangles in order.
    pub triangles: Triangles,
}

impl Assembly {
    /// The vertices of triangle `number`.
    ///
    /// # Panics
    /// There is no such triangle.
    #[inline(always)]
    pub fn triangle(&self, number: usize) -> TriangleVertices<'_> {
        self.vertices.triangle(self.triangles.vertices(number))
    }
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
    let mut triangles = Triangles::split(&draw.indices, draw.topology, draw.provoking_vertex);
    if let Positions::Clip(viewport) = &draw.positions {
        clip_and_project(&mut vertices, &mut triangles, viewport);
    }
    let mut used = vec![false; vertices.len()];
    for triangle in triangles.iter() {
        for v in triangle.vertices {
            used[v as usize] = true;
        }
    }
    let errors: Vec<PositionError> = (0..vertices.len())
        .filter(|v| used[*v] && !in_range(vertices.position(*v)))
        .take(MOST_ERRORS)
        .map(|v| PositionError { vertex: v.min(draw.vertices.len() - 1), window: vertices.position(v) })
        .collect();
    if !errors.is_empty() {
        return Err(errors);
    }
    let corners = used.iter().enumerate().map(|(v, used)| corner(&vertices, v, *used)).collect();
    Ok(Assembly { vertices, corners, triangles })
}

fn corner(vertices: &Vertices, index: usize, used: bool) -> Corner {
    let [x, y, _, w] = vertices.position(index);
    Corner {
        position: if used { [snap(x) as i32, snap(y) as i32] } else { [0; 2] },
        w,
        primary: color_bytes(vertices.diffuse(index)),
        secondary: color_bytes(vertices.specular(index)),
    }
}

/// NUM-4, or the bytes as they are.
fn color_bytes(color: VertexColor) -> [u8; 4] {
    match color {
        VertexColor::Bytes(bytes) => bytes,
        VertexColor::Floats(floats) => floats.map(vertex_color),
    }
}

/// RAS-0 for a window position.
fn in_range(p: [f32; 4]) -> bool {
    p.iter().all(|n| n.is_finite())
        && p[..2].iter().all(|n| n.abs() <= 4096.0 && snap(*n).abs() < GUARD)
        && (SMALLEST_W..=LARGEST_W).contains(&p[3])
}

/// Projects what lies in front of w = 2^-20 and replaces triangles that cross it by their pieces, split as a polygon.
fn clip_and_project(vertices: &mut Vertices, triangles: &mut Triangles, viewport: &Viewport) {
    let inside = |position: [f32; 4]| position[3] >= SMALLEST_W;
    if !(0..vertices.len()).all(|v| inside(vertices.position(v))) {
        clip(vertices, triangles);
    }
    vertices.map_positions(|position| if inside(position) { project::window(position, viewport) } else { position });
}

/// Drops triangles behind w = 2^-20; their pieces take the place of those that cross it.
fn clip(vertices: &mut Vertices, triangles: &mut Triangles) {
    let mut pieces: Vec<Vertex> = Vec::new();
    let mut kept = Vec::with_capacity(triangles.len());
    for triangle in triangles.iter() {
        let given = vertices.triangle(triangle.vertices);
        let inside = given.position(3).map(|w| w >= SMALLEST_W);
        if inside == [true; 3] {
            kept.push(triangle);
        } else if inside != [false; 3] {
            let polygon = project::clip(&given.all());
            let start = (vertices.len() + pieces.len()) as u32;
            kept.extend(
                (1..polygon.len() as u32 - 1)
                    .map(|i| Assembled { vertices: [start, start + i, start + i + 1], provoking: triangle.provoking }),
            );
            pieces.extend(polygon);
        }
    }
    *triangles = kept.into_iter().collect();
    vertices.extend(pieces);
}
