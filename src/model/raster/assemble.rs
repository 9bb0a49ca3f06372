//! The vertices of a draw to window coordinates: what is cut off (RAS-6), and the limits of RAS-0.

pub use super::triangles::{Assembled, Triangles};
use super::{LARGEST_W, SMALLEST_W, project};
use crate::number::convert::{snap, vertex_color};
use crate::state::{Draw, Positions, TriangleVertices, Vertex, VertexColor, Vertices, Viewport};

/// What setting up a triangle takes of a vertex: each number as the chip enters it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corner {
    /// x and y, 1/16 pixel (RAS-1); 0 of vertices that no triangle uses.
    pub position: [i32; 2],
    /// w of the clip coordinates, not 0.
    pub w: f32,
    /// Primary colour R, G, B, A (NUM-4).
    pub primary: [u8; 4],
    /// Secondary colour R, G, B, A (NUM-4).
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
    /// What of them has been cut off.
    pub clipping: Clipping,
}

/// What clipping has done to the triangles of a draw (RAS-6).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Clipping {
    /// Planes that something was cut off at: [bits](project::ClipPlane::bit).
    pub planes: u8,
    /// Triangles of which nothing is left.
    pub removed: usize,
    /// Triangles that were cut.
    pub cut: usize,
    /// What they became, in the order of their numbers.
    pub pieces: Vec<Piece>,
}

impl Clipping {
    /// What triangle `number` is a piece of, if it is one.
    pub fn piece(&self, number: usize) -> Option<&Piece> {
        let at = self.pieces.binary_search_by_key(&number, |piece| piece.number).ok()?;
        self.pieces.get(at)
    }
}

/// A triangle that was cut off another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Its number among the triangles that are drawn.
    pub number: usize,
    /// The number of the other, before anything was clipped.
    pub of: usize,
    /// The planes that cut the other: [bits](project::ClipPlane::bit).
    pub planes: u8,
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
const MAX_ERRORS: usize = 8;

/// Forms the triangles of a draw.
///
/// # Errors
/// The vertices (eight at most) that a triangle uses and whose window position or w lies outside RAS-0, whatever was cut off.
pub fn assemble(draw: &Draw) -> Result<Assembly, Vec<PositionError>> {
    let mut vertices = draw.vertices.clone();
    let triangles = Triangles::split(&draw.indices, draw.topology, draw.provoking_vertex);
    let Positions::Clip(viewport) = &draw.positions else {
        return finish(vertices, triangles, Clipping::default(), &[]);
    };
    if (0..vertices.len()).all(|v| project::beyond(vertices.position(v), viewport) == 0) {
        let mut window = vertices.clone();
        window.map_positions(|position| project::window(position, viewport));
        // What leaves the guard band is cut.
        if let Ok(assembly) = finish(window, triangles.clone(), Clipping::default(), &[]) {
            return Ok(assembly);
        }
    }
    let (triangles, clipping, blamed) = clip(&mut vertices, &triangles, viewport);
    let inside = |position: [f32; 4]| position[3] >= SMALLEST_W;
    vertices.map_positions(|position| if inside(position) { project::window(position, viewport) } else { position });
    finish(vertices, triangles, clipping, &blamed)
}

/// Vertices in window coordinates and their triangles, held against RAS-0. The last vertices were made by clipping: `blamed` are those of the
/// draw that had them made.
fn finish(
    vertices: Vertices,
    triangles: Triangles,
    clipping: Clipping,
    blamed: &[usize],
) -> Result<Assembly, Vec<PositionError>> {
    let mut used = vec![false; vertices.len()];
    for triangle in triangles.iter() {
        for v in triangle.vertices {
            used[v as usize] = true;
        }
    }
    let given = vertices.len() - blamed.len();
    let outside = (0..vertices.len()).filter(|v| used[*v] && !in_range(vertices.position(*v)));
    let mut errors: Vec<PositionError> = Vec::new();
    for v in outside {
        let vertex = if v < given { v } else { blamed[v - given] };
        if errors.iter().all(|error| error.vertex != vertex) {
            errors.push(PositionError { vertex, window: vertices.position(v) });
        }
        if errors.len() == MAX_ERRORS {
            break;
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let corners = used.iter().enumerate().map(|(v, used)| corner(&vertices, v, *used)).collect();
    Ok(Assembly { vertices, corners, triangles, clipping })
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
    p.iter().all(|n| n.is_finite()) && project::in_band(p) && (SMALLEST_W..=LARGEST_W).contains(&p[3])
}

/// So many new vertices are taken apart at a time.
const CHUNK: usize = 4096;

/// Cuts triangles at the planes of RAS-6. Their pieces take their place; new vertices are appended, and of each is told which vertex of
/// its triangle lies outside.
fn clip(vertices: &mut Vertices, triangles: &Triangles, viewport: &Viewport) -> (Triangles, Clipping, Vec<usize>) {
    let lies_inside = |v: usize| {
        let position = vertices.position(v);
        project::beyond(position, viewport) == 0 && project::in_band(project::window(position, viewport))
    };
    let inside: Vec<bool> = (0..vertices.len()).map(lies_inside).collect();
    let (mut clipping, mut blamed) = (Clipping::default(), Vec::new());
    let mut new: Vec<Vertex> = Vec::with_capacity(CHUNK);
    let mut kept = Vec::with_capacity(triangles.len());
    for (of, triangle) in triangles.iter().enumerate() {
        let Some(outside) = triangle.vertices.into_iter().find(|v| !inside[*v as usize]) else {
            kept.push(triangle);
            continue;
        };
        let (polygon, planes) = project::clip(&vertices.triangle(triangle.vertices).all(), viewport);
        clipping.planes |= planes;
        if planes == 0 {
            // Not a number: it is refused.
            kept.push(triangle);
        } else if polygon.is_empty() {
            clipping.removed += 1;
        } else {
            clipping.cut += 1;
            let start = (vertices.len() + new.len()) as u32;
            for i in 1..polygon.len() as u32 - 1 {
                clipping.pieces.push(Piece { number: kept.len(), of, planes });
                kept.push(Assembled { vertices: [start, start + i, start + i + 1], provoking: triangle.provoking });
            }
            blamed.resize(blamed.len() + polygon.len(), outside as usize);
            new.extend(polygon);
            if new.len() >= CHUNK {
                vertices.extend(new.drain(..));
            }
        }
    }
    vertices.extend(new);
    (kept.into_iter().collect(), clipping, blamed)
}
