//! POL-1: the edges or corners that are drawn of triangles in place of their pixels.

use super::project;
use super::setup::{clockwise_area, is_front};
use super::stroke::Figure;
use super::triangles::{IndexedTriangle, Triangles};
use crate::number::convert::snap;
use crate::state::{Cull, Draw, PolygonMode, PolygonModes, Positions, Topology};

/// Returns what a draw's polygon modes make of its triangles, before these are clipped. Faces that are culled, and filled ones without area,
/// are left out where any is not filled.
pub(super) fn figures(draw: &Draw, triangles: Triangles) -> Triangles {
    if draw.polygon_modes == PolygonModes::FILL || !draw.topology.has_faces() {
        return triangles;
    }
    let mut figures = Vec::new();
    for (number, triangle) in triangles.iter().enumerate() {
        let outer = outer_edges(draw.topology, number, triangles.len());
        match mode(draw, &triangle) {
            None => {}
            Some(PolygonMode::Fill) => figures.push(triangle),
            Some(mode) => {
                // Edge k lies opposite to vertex k.
                for k in (0..3).filter(|k| outer[*k]) {
                    let [from, to] = [1, 2].map(|n| triangle.vertices[(k + n) % 3]);
                    if !is_flagged(draw, from) {
                        continue;
                    }
                    figures.push(match mode {
                        PolygonMode::Line => IndexedTriangle::line([from, to], triangle.provoking),
                        _ => IndexedTriangle::point(from, triangle.provoking),
                    });
                }
            }
        }
    }
    figures.into_iter().collect()
}

/// Returns the mode of the side that a triangle shows, or `None` if nothing of it is drawn.
fn mode(draw: &Draw, triangle: &IndexedTriangle) -> Option<PolygonMode> {
    debug_assert_eq!(triangle.figure, Figure::Triangle);
    let Some(area) = area(draw, triangle.vertices) else {
        // It is refused, whatever is drawn of it.
        return Some(PolygonMode::Fill);
    };
    let front = is_front(area, draw.front_face);
    if draw.cull == if front { Cull::Front } else { Cull::Back } {
        return None;
    }
    let mode = if front { draw.polygon_modes.front } else { draw.polygon_modes.back };
    (area != 0 || mode != PolygonMode::Fill).then_some(mode)
}

/// Returns twice the area that is left of a triangle on the screen, positive if it turns clockwise, or `None` if it lies outside of RAS-0.
fn area(draw: &Draw, vertices: [u32; 3]) -> Option<i64> {
    let corners = draw.vertices.triangle(vertices);
    let polygon: Vec<[f32; 4]> = match &draw.positions {
        Positions::Window => corners.positions().to_vec(),
        Positions::Clip(viewport) => {
            let (polygon, _) = project::clip(&corners.all(), viewport);
            polygon.iter().map(|vertex| project::window(vertex.position, viewport)).collect()
        }
    };
    if !polygon.iter().all(|position| project::in_band(*position) && position[3] > 0.0) {
        return None;
    }
    let at = |n: usize, axis: usize| snap(polygon[n][axis]);
    let part = |n: usize| clockwise_area([0, n, n + 1].map(|n| at(n, 0)), [0, n, n + 1].map(|n| at(n, 1)));
    Some((1..polygon.len().max(1) - 1).map(part).sum())
}

/// Returns whether a draw has the edges that begin at a vertex. Strips and fans have all.
fn is_flagged(draw: &Draw, vertex: u32) -> bool {
    let has_flags = matches!(draw.topology, Topology::Triangles | Topology::Quads | Topology::Polygon);
    draw.edge_flags.as_ref().filter(|_| has_flags).is_none_or(|flags| flags[vertex as usize])
}

/// Returns which edges of a triangle are edges of its primitive: those opposite to its vertices, in order.
pub fn outer_edges(topology: Topology, number: usize, count: usize) -> [bool; 3] {
    match (topology, number % 2) {
        (Topology::Quads, 0) => [true, false, true],
        (Topology::QuadStrip, 0) => [false, true, true],
        (Topology::Quads | Topology::QuadStrip, _) => [true, true, false],
        (Topology::Polygon, _) => [true, number + 1 == count, number == 0],
        _ => [true; 3],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::assemble::assemble;
    use crate::state::{FrontFace, Vertex};

    /// Returns the figures of a draw of a square, or of the first of its corners.
    fn shapes(draw: Draw) -> Vec<(Figure, [u32; 2])> {
        let corners = [(0.0, 0.0), (0.0, 9.0), (9.0, 9.0), (9.0, 0.0)].map(|(x, y)| Vertex::at(x, y));
        let draw = Draw { vertices: corners.to_vec().into(), indices: (0..4).collect(), ..draw };
        let figures = assemble(&draw).expect("legal").triangles;
        figures.iter().map(|figure| (figure.figure, [figure.vertices[1], figure.vertices[2]])).collect()
    }

    fn draw(topology: Topology, front: PolygonMode) -> Draw {
        Draw { topology, polygon_modes: PolygonModes { front, back: PolygonMode::Fill }, ..Draw::default() }
    }

    #[test]
    fn inner_edges_are_not_drawn() {
        let line = |ends: [u32; 2]| (Figure::Line, ends);
        let sides = [[1, 2], [0, 1], [2, 3], [3, 0]].map(line);
        assert_eq!(shapes(draw(Topology::Quads, PolygonMode::Line)), sides);
        assert_eq!(shapes(draw(Topology::Polygon, PolygonMode::Line)), sides);
        let fan = [[1, 2], [2, 0], [0, 1], [2, 3], [3, 0], [0, 2]].map(line);
        assert_eq!(shapes(draw(Topology::TriangleFan, PolygonMode::Line)), fan);
        let corners = [1, 0, 2, 3].map(|corner| (Figure::Point, [corner; 2]));
        assert_eq!(shapes(draw(Topology::Quads, PolygonMode::Point)), corners);
    }

    #[test]
    fn flags_belong_to_first_ends() {
        let flagged = |topology| Draw {
            edge_flags: Some([true, false, true, false].into()),
            ..draw(topology, PolygonMode::Line)
        };
        let sides = [[0, 1], [2, 3]].map(|ends| (Figure::Line, ends));
        assert_eq!(shapes(flagged(Topology::Quads)), sides);
        assert_eq!(shapes(flagged(Topology::Polygon)), sides);
        assert_eq!(shapes(flagged(Topology::TriangleFan)).len(), 6);
        let corners = Draw {
            polygon_modes: PolygonModes { front: PolygonMode::Point, back: PolygonMode::Fill },
            ..flagged(Topology::Quads)
        };
        assert_eq!(shapes(corners), [0, 2].map(|corner| (Figure::Point, [corner; 2])));
    }

    #[test]
    fn each_side_has_its_mode() {
        let clockwise = Draw { front_face: FrontFace::Clockwise, ..draw(Topology::Quads, PolygonMode::Line) };
        assert!(shapes(clockwise.clone()).iter().all(|(figure, _)| *figure == Figure::Triangle));
        assert!(shapes(Draw { cull: Cull::Back, ..clockwise }).is_empty());
        assert!(shapes(Draw { cull: Cull::Front, ..draw(Topology::Quads, PolygonMode::Line) }).is_empty());
        assert_eq!(shapes(Draw { cull: Cull::Back, ..draw(Topology::Quads, PolygonMode::Line) }).len(), 4);
    }

    /// POL-1: three corners in one place, and front faces of either winding.
    #[test]
    fn no_area_is_counterclockwise() {
        let flat = |front_face, cull| {
            let vertices = vec![Vertex::at(4.0, 4.0); 3].into();
            let draw = Draw {
                vertices,
                indices: (0..3).collect(),
                cull,
                front_face,
                ..draw(Topology::Triangles, PolygonMode::Line)
            };
            assemble(&draw).expect("legal").triangles.len()
        };
        assert_eq!(flat(FrontFace::CounterClockwise, Cull::Back), 3);
        assert_eq!(flat(FrontFace::CounterClockwise, Cull::Front), 0);
        assert_eq!(flat(FrontFace::Clockwise, Cull::None), 0, "the back is filled");
    }
}
