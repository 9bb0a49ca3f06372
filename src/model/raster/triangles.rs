//! The triangles of a draw: how primitives are split (RAS-4), and their provoking vertices (RAS-5). Lines and points are [triangles](super::stroke), too.

use std::sync::Arc;

use super::stroke::Figure;
use crate::state::{ProvokingVertex, Topology};

/// A triangle of a draw. The order of its vertices matters, because INT-2 gives the second one the remainder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IndexedTriangle {
    /// What it is. The vertices of a line from A to B are A, A and B; those of a point are all the same.
    pub figure: Figure,
    /// Indices into [`Assembly::vertices`](super::assemble::Assembly::vertices).
    pub vertices: [u32; 3],
    /// Index of the vertex whose colours the triangle has if it is flat.
    pub provoking: u32,
}

/// A list of triangles. If a draw lists its triangles, its indices are shared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Triangles {
    /// Three indices for each triangle. A remainder of less than three is ignored.
    indices: Arc<[u32]>,
    provoking: Provoking,
    figures: Figures,
}

/// What a list consists of.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Figures {
    All(Figure),
    Each(Arc<[Figure]>),
}

/// The provoking vertices of a list of triangles.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Provoking {
    /// The same one of each triangle's vertices, 0 to 2.
    Corner(usize),
    /// The index of any vertex, for each triangle.
    Each(Arc<[u32]>),
}

impl IndexedTriangle {
    /// Returns the line between two vertices.
    pub(super) fn line([from, to]: [u32; 2], provoking: u32) -> IndexedTriangle {
        IndexedTriangle { figure: Figure::Line, vertices: [from, from, to], provoking }
    }

    /// Returns the point at a vertex.
    pub(super) fn point(vertex: u32, provoking: u32) -> IndexedTriangle {
        IndexedTriangle { figure: Figure::Point, vertices: [vertex; 3], provoking }
    }
}

impl Triangles {
    /// Splits primitives into triangles. Indices that do not complete a primitive are ignored.
    pub fn split(indices: &Arc<[u32]>, topology: Topology, provoking: ProvokingVertex) -> Triangles {
        let first = provoking == ProvokingVertex::First;
        let triangle = |a: usize, b: usize, c: usize, provoking: usize| IndexedTriangle {
            figure: Figure::Triangle,
            vertices: [indices[a], indices[b], indices[c]],
            provoking: indices[provoking],
        };
        let line =
            |a: usize, b: usize| IndexedTriangle::line([indices[a], indices[b]], indices[if first { a } else { b }]);
        let count = indices.len();
        match topology {
            Topology::Triangles => Triangles {
                indices: Arc::clone(indices),
                provoking: Provoking::Corner(if first { 0 } else { 2 }),
                figures: Figures::All(Figure::Triangle),
            },
            Topology::TriangleStrip => (0..count.saturating_sub(2))
                .map(|i| {
                    let (a, b) = if i % 2 == 0 { (i, i + 1) } else { (i + 1, i) };
                    triangle(a, b, i + 2, if first { i } else { i + 2 })
                })
                .collect(),
            Topology::TriangleFan => {
                (1..count.saturating_sub(1)).map(|i| triangle(0, i, i + 1, if first { i } else { i + 1 })).collect()
            }
            Topology::Quads => (0..count / 4)
                .flat_map(|q| {
                    let v = 4 * q;
                    [triangle(v, v + 1, v + 2, v + 3), triangle(v, v + 2, v + 3, v + 3)]
                })
                .collect(),
            Topology::QuadStrip => (0..(count / 2).saturating_sub(1))
                .flat_map(|q| {
                    let v = 2 * q;
                    [triangle(v, v + 1, v + 2, v + 3), triangle(v + 2, v + 1, v + 3, v + 3)]
                })
                .collect(),
            Topology::Polygon => (1..count.saturating_sub(1)).map(|i| triangle(0, i, i + 1, 0)).collect(),
            Topology::Points => indices.iter().map(|vertex| IndexedTriangle::point(*vertex, *vertex)).collect(),
            Topology::Lines => (0..count / 2).map(|i| line(2 * i, 2 * i + 1)).collect(),
            Topology::LineStrip => (1..count).map(|i| line(i - 1, i)).collect(),
            Topology::LineLoop => (1..count + usize::from(count > 1)).map(|i| line(i - 1, i % count)).collect(),
        }
    }

    /// Returns the number of triangles.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.indices.len() / 3
    }

    /// Returns whether there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the vertices of triangle `number`.
    ///
    /// # Panics
    /// Panics if there is no such triangle.
    #[inline(always)]
    pub fn vertices(&self, number: usize) -> [u32; 3] {
        self.indices.as_chunks().0[number]
    }

    /// Returns the vertex whose colours triangle `number` has if it is flat.
    ///
    /// # Panics
    /// Panics if there is no such triangle.
    pub(crate) fn provoking(&self, number: usize) -> u32 {
        match &self.provoking {
            Provoking::Corner(corner) => self.vertices(number)[*corner],
            Provoking::Each(vertices) => vertices[number],
        }
    }

    /// Returns what `number` is.
    ///
    /// # Panics
    /// Panics if there is no such triangle.
    #[inline(always)]
    pub fn figure(&self, number: usize) -> Figure {
        match &self.figures {
            Figures::All(figure) => *figure,
            Figures::Each(figures) => figures[number],
        }
    }

    /// Returns triangle `number`.
    ///
    /// # Panics
    /// Panics if there is no such triangle.
    pub fn at(&self, number: usize) -> IndexedTriangle {
        IndexedTriangle {
            figure: self.figure(number),
            vertices: self.vertices(number),
            provoking: self.provoking(number),
        }
    }

    /// Returns an iterator over the triangles in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = IndexedTriangle> + '_ {
        (0..self.len()).map(|number| self.at(number))
    }
}

impl FromIterator<IndexedTriangle> for Triangles {
    fn from_iter<I: IntoIterator<Item = IndexedTriangle>>(triangles: I) -> Self {
        let triangles = triangles.into_iter();
        let count = triangles.size_hint().0;
        let (mut indices, mut provoking) = (Vec::with_capacity(3 * count), Vec::with_capacity(count));
        let mut figures = Vec::with_capacity(count);
        for triangle in triangles {
            indices.extend(triangle.vertices);
            provoking.push(triangle.provoking);
            figures.push(triangle.figure);
        }
        let first = figures.first().copied().unwrap_or_default();
        let same = figures.iter().all(|figure| *figure == first);
        let figures = if same { Figures::All(first) } else { Figures::Each(figures.into()) };
        Triangles { indices: indices.into(), provoking: Provoking::Each(provoking.into()), figures }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shapes(topology: Topology, count: u32, provoking: ProvokingVertex) -> Vec<([u32; 3], u32)> {
        let indices: Arc<[u32]> = (0..count).collect();
        Triangles::split(&indices, topology, provoking).iter().map(|t| (t.vertices, t.provoking)).collect()
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

    #[test]
    fn lines_and_points_are_triangles() {
        use ProvokingVertex::{First, Last};
        assert_eq!(shapes(Topology::Points, 2, First), [([0, 0, 0], 0), ([1, 1, 1], 1)]);
        assert_eq!(shapes(Topology::Lines, 5, First), [([0, 0, 1], 0), ([2, 2, 3], 2)]);
        assert_eq!(shapes(Topology::LineStrip, 3, Last), [([0, 0, 1], 1), ([1, 1, 2], 2)]);
        assert_eq!(shapes(Topology::LineLoop, 3, Last), [([0, 0, 1], 1), ([1, 1, 2], 2), ([2, 2, 0], 0)]);
        assert!(
            [Topology::Lines, Topology::LineStrip, Topology::LineLoop].iter().all(|t| shapes(*t, 1, First).is_empty())
        );
        assert!(shapes(Topology::Points, 0, First).is_empty() && shapes(Topology::LineLoop, 0, First).is_empty());
    }

    #[test]
    fn listed_triangles_share_the_indices_of_the_draw() {
        let indices: Arc<[u32]> = (0..9).collect();
        let triangles = Triangles::split(&indices, Topology::Triangles, ProvokingVertex::Last);
        assert!(Arc::ptr_eq(&triangles.indices, &indices));
    }
}
