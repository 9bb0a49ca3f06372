//! Assembly: converts the vertices of a draw to window coordinates, clips its triangles (RAS-6) and checks the limits
//! of RAS-0.

use std::sync::Arc;

use super::setup::{EVERYWHERE, centres};
use super::smooth;
use super::stroke::{self, Figure};
pub(crate) use super::triangles::{IndexedTriangle, Triangles};
use super::{FAR_GUARD, FARTHEST_W, LARGEST_W, NEAREST_W, SMALLEST_W, modes, project};
use crate::number::convert::{snap, vertex_color};
use crate::state::{
    Draw, LineRasterization, Lines, PointRasterization, PolygonModes, Positions, TriangleVertices, Vertex, VertexColor,
    Vertices, Viewport,
};

/// The values of a vertex that triangle set-up reads, converted as on the chip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corner {
    /// x and y in 1/16 pixel (RAS-1). 0 for vertices that no triangle uses.
    pub position: [i32; 2],
    /// w of the clip coordinates, not 0. It is unchanged by the projection.
    pub w: f32,
    /// Primary colour as R, G, B, A bytes (NUM-4).
    pub primary: [u8; 4],
    /// Secondary colour as R, G, B, A bytes (NUM-4).
    pub secondary: [u8; 4],
}

/// The vertices of a draw in window coordinates, and its triangles in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembly {
    /// The vertices with window positions. Positions of vertices that no triangle uses may be left unchanged. Columns
    /// that equal those of the draw's vertices are shared with them.
    pub vertices: Vertices,
    /// One corner for each vertex.
    pub corners: Vec<Corner>,
    /// The triangles in the order in which they are drawn.
    pub triangles: Triangles,
    /// The result of clipping.
    pub clipping: Clipping,
    /// Whether triangles have smooth edges (SMO-1).
    pub smooth_polygons: bool,
    /// State of the lines.
    pub lines: Lines,
    /// Size of the points in 1/8 pixel.
    pub point_size: u16,
    /// Size of the point at each vertex of the draw, in place of that.
    pub point_sizes: Option<Arc<[u16]>>,
    /// How points become pixels.
    pub point_rasterization: PointRasterization,
    /// Whether a vertex lies behind the eye (RAS-8), or outside of the limits for all figures (RAS-0).
    pub is_far: bool,
}

/// What the scalar engine alone draws: the lanes of the fast engine do not, and not every printed text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScalarPart {
    /// Smooth edges (SMO-1).
    SmoothEdges,
    /// Vertices behind the eye (RAS-8) or far away (RAS-0).
    FarVertices,
}

impl ScalarPart {
    /// Returns the words of a message that refuses it, and of its help.
    pub fn words(self) -> [&'static str; 2] {
        match self {
            ScalarPart::SmoothEdges => ["smooth edges", "leave `smooth_polygons` and `RectangularSmooth` out"],
            ScalarPart::FarVertices => ["vertices behind the eye or far away", "cut the triangles at the guard band"],
        }
    }
}

impl Assembly {
    /// Returns the area of a triangle in pixels, rounded down. A line has that of its rectangle, a point that of its box.
    pub(crate) fn area(&self, number: usize) -> u64 {
        let [a, b, c] = self.positions(number);
        match self.triangles.figure(number) {
            // All that it might cover.
            Figure::Triangle if self.reaches_everywhere(number) => ((EVERYWHERE.1 - EVERYWHERE.0) as u64).pow(2),
            // Twice the area in 1/256 square pixel.
            Figure::Triangle => ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).unsigned_abs() / 512,
            Figure::Line => {
                let [x, y] = [0, 1].map(|axis| (c[axis] - a[axis]).unsigned_abs());
                u64::from(self.lines.width) * (2 * x.max(y) + x.min(y)) / 256
            }
            Figure::Point => {
                let count = |axis: usize| self.bounds(number, axis);
                [count(0), count(1)].map(|(first, end)| (end - first).max(0) as u64).iter().product()
            }
        }
    }

    /// Returns the columns or the rows within which a triangle covers pixels, for axis 0 or 1.
    pub(crate) fn bounds(&self, number: usize, axis: usize) -> (i64, i64) {
        let all = self.positions(number);
        match self.triangles.figure(number) {
            Figure::Triangle if self.reaches_everywhere(number) => EVERYWHERE,
            Figure::Triangle => {
                let centres = centres(all.map(|position| position[axis]));
                if self.smooth_polygons { smooth::widened(centres) } else { centres }
            }
            Figure::Line => stroke::line_box([all[1], all[2]], self.lines)[axis],
            Figure::Point => stroke::point_box(all[1], self.size_of(number), self.point_rasterization)[axis],
        }
    }

    /// Returns the size of a point in 1/8 pixel.
    pub fn size_of(&self, number: usize) -> u16 {
        let vertex = self.triangles.vertices(number)[1] as usize;
        self.point_sizes.as_ref().map_or(self.point_size, |sizes| sizes[vertex])
    }

    /// RAS-8: returns whether a vertex of a triangle lies behind the eye.
    #[inline(always)]
    fn reaches_everywhere(&self, number: usize) -> bool {
        self.is_far && self.triangles.vertices(number).iter().any(|v| self.corners[*v as usize].w < 0.0)
    }

    /// Returns x and y of a triangle's vertices, in 1/16 pixel.
    #[inline(always)]
    fn positions(&self, number: usize) -> [[i64; 2]; 3] {
        self.triangles.vertices(number).map(|v| self.corners[v as usize].position.map(i64::from))
    }
}

/// The effects of clipping on the triangles of a draw (RAS-6).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Clipping {
    /// Set of the planes that cut something off, as [bits](project::ClipPlane::bit).
    pub planes: u8,
    /// Number of triangles of which nothing is left.
    pub removed: usize,
    /// Number of triangles that were cut and of which something is left.
    pub cut: usize,
    /// The pieces of cut triangles, sorted by their numbers.
    pub pieces: Vec<Piece>,
}

impl Clipping {
    /// Returns the piece that is triangle `number`, or `None` if that triangle was not cut.
    pub(crate) fn piece(&self, number: usize) -> Option<&Piece> {
        let at = self.pieces.binary_search_by_key(&number, |piece| piece.number).ok()?;
        self.pieces.get(at)
    }
}

/// A triangle that is a part of a clipped triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Its number among the triangles that are drawn.
    pub number: usize,
    /// The number of the original triangle before clipping.
    pub of: usize,
    /// Set of the planes that cut the original triangle, as [bits](project::ClipPlane::bit).
    pub planes: u8,
}

impl Assembly {
    /// Returns whether a triangle or a line has smooth edges (SMO-1).
    pub fn has_smooth_edges(&self) -> bool {
        let smooth_lines = self.lines.rasterization == LineRasterization::RectangularSmooth;
        (self.smooth_polygons || smooth_lines)
            && (0..self.triangles.len()).any(|number| match self.triangles.figure(number) {
                Figure::Triangle => self.smooth_polygons,
                Figure::Line => smooth_lines,
                Figure::Point => false,
            })
    }

    /// Returns what there is for the scalar engine alone.
    pub fn scalar_part(&self) -> Option<ScalarPart> {
        match self.has_smooth_edges() {
            true => Some(ScalarPart::SmoothEdges),
            false => self.is_far.then_some(ScalarPart::FarVertices),
        }
    }

    /// Returns the vertices of triangle `number`.
    ///
    /// # Panics
    /// Panics if there is no such triangle.
    #[inline(always)]
    pub fn triangle(&self, number: usize) -> TriangleVertices<'_> {
        self.vertices.triangle(self.triangles.vertices(number))
    }
}

/// A vertex that lies outside the limits of RAS-0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionError {
    /// Index of the vertex in the draw.
    pub vertex: usize,
    /// Its window x, y, depth and w.
    pub window: [f32; 4],
}

/// Most errors that are reported for a draw.
const MAX_ERRORS: usize = 8;

/// Assembles the triangles of a draw.
///
/// # Errors
/// Returns up to eight vertices that a triangle uses and whose window position or w is outside RAS-0 even after
/// clipping.
pub fn assemble(draw: &Draw) -> Result<Assembly, Vec<PositionError>> {
    let mut vertices = draw.vertices.clone();
    let triangles = modes::figures(draw, Triangles::split(&draw.indices, draw.topology, draw.provoking_vertex));
    let Positions::Clip(viewport) = &draw.positions else {
        return finish(draw, vertices, triangles, Clipping::default(), &[]);
    };
    if (0..vertices.len()).all(|v| project::beyond(vertices.position(v), viewport) == 0) {
        let mut window = vertices.clone();
        window.map_positions(|position| project::window(position, viewport));
        // Otherwise something leaves the guard band, and has to be cut below.
        if let Ok(assembly) = finish(draw, window, triangles.clone(), Clipping::default(), &[]) {
            return Ok(assembly);
        }
    }
    let (triangles, clipping, blamed) = clip(&mut vertices, &triangles, viewport);
    let inside = |position: [f32; 4]| position[3] >= SMALLEST_W;
    vertices.map_positions(|position| if inside(position) { project::window(position, viewport) } else { position });
    finish(draw, vertices, triangles, clipping, &blamed)
}

/// Checks vertices in window coordinates against RAS-0 and completes the assembly. The last vertices were made by
/// clipping; `blamed` holds, for each of these, the vertex of the draw that is reported in its place.
fn finish(
    draw: &Draw,
    mut vertices: Vertices,
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
    let may_be_far = may_be_far(draw);
    let mut is_far = false;
    let mut errors: Vec<PositionError> = Vec::new();
    for v in (0..vertices.len()).filter(|v| used[*v] && !in_range(vertices.position(*v))) {
        if may_be_far && in_far_range(vertices.position(v), draw.perspective) {
            is_far = true;
            continue;
        }
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
    if is_far {
        vertices.map_positions(limit_w);
    }
    let corners = used.iter().enumerate().map(|(v, used)| corner(&vertices, v, *used)).collect();
    let Draw { smooth_polygons, lines, point_size, point_rasterization, .. } = *draw;
    let point_sizes = draw.point_sizes.clone();
    Ok(Assembly {
        vertices,
        corners,
        triangles,
        clipping,
        smooth_polygons,
        lines,
        point_size,
        point_sizes,
        point_rasterization,
        is_far,
    })
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

/// Returns the colour as bytes, converting floats by NUM-4.
fn color_bytes(color: VertexColor) -> [u8; 4] {
    match color {
        VertexColor::Bytes(bytes) => bytes,
        VertexColor::Floats(floats) => floats.map(vertex_color),
    }
}

/// Returns whether a window position is within RAS-0.
fn in_range(p: [f32; 4]) -> bool {
    p.iter().all(|n| n.is_finite()) && project::in_band(p) && (SMALLEST_W..=LARGEST_W).contains(&p[3])
}

/// Returns whether vertices may lie [far away](in_far_range): the figures are filled triangles that are given in window coordinates.
fn may_be_far(draw: &Draw) -> bool {
    let are_filled = draw.polygon_modes == PolygonModes::FILL && !draw.smooth_polygons;
    matches!(draw.positions, Positions::Window) && draw.topology.has_faces() && are_filled
}

/// RAS-0: returns whether a draw takes a window position.
pub fn takes_position(draw: &Draw, position: [f32; 4]) -> bool {
    in_range(position) || may_be_far(draw) && in_far_range(position, draw.perspective)
}

/// Returns whether a window position is within RAS-0 for filled triangles. Those behind the eye need perspective (RAS-8).
fn in_far_range([x, y, z, w]: [f32; 4], perspective: bool) -> bool {
    let in_guard = |n: f32| n.abs() < (FAR_GUARD / 16) as f32;
    z.is_finite() && in_guard(x) && in_guard(y) && !w.is_nan() && (perspective || w.is_sign_positive())
}

/// RAS-8: limits the magnitude of the w of a position.
pub fn limit_w([x, y, z, w]: [f32; 4]) -> [f32; 4] {
    [x, y, z, w.abs().clamp(NEAREST_W, FARTHEST_W).copysign(w)]
}

/// Number of new vertices that are converted to columns at a time.
const CHUNK: usize = 4096;

/// Clips triangles at the planes of RAS-6. Pieces replace the triangles that are cut, and new vertices are appended.
/// The last part of the result holds, for each new vertex, the vertex of its triangle that lies outside.
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
        let all = vertices.triangle(triangle.vertices).all();
        let (corners, count) = match triangle.figure {
            Figure::Triangle => (&all[..], usize::MAX),
            Figure::Line => (&all[1..], 2),
            Figure::Point => (&all[1..2], 1),
        };
        let (mut polygon, planes) = project::clip(corners, viewport);
        polygon.truncate(count);
        clipping.planes |= planes;
        if planes == 0 {
            // A position is not a number, which is refused later.
            kept.push(triangle);
        } else if polygon.is_empty() {
            clipping.removed += 1;
        } else {
            clipping.cut += 1;
            let start = (vertices.len() + new.len()) as u32;
            let pieces = if triangle.figure == Figure::Line { 1..2 } else { 1..polygon.len() as u32 - 1 };
            for i in pieces {
                clipping.pieces.push(Piece { number: kept.len(), of, planes });
                kept.push(match triangle.figure {
                    Figure::Line => IndexedTriangle::line([start, start + 1], triangle.provoking),
                    _ => IndexedTriangle { vertices: [start, start + i, start + i + 1], ..triangle },
                });
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
