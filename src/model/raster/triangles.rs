//! The triangles of a draw: how primitives are split (RAS-4), and their provoking vertices (RAS-5).

use std::sync::Arc;

use crate::state::{ProvokingVertex, Topology};

/// A triangle of a draw. The order of its vertices matters, because INT-2 gives the second one the remainder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Assembled {
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
}

/// The provoking vertices of a list of triangles.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Provoking {
    /// The same one of each triangle's vertices, 0 to 2.
    Corner(usize),
    /// The index of any vertex, for each triangle.
    Each(Arc<[u32]>),
}

impl Triangles {
    /// Splits primitives into triangles. Indices that do not complete a primitive are ignored.
    pub fn split(indices: &Arc<[u32]>, topology: Topology, provoking: ProvokingVertex) -> Triangles {
        let first = provoking == ProvokingVertex::First;
        let triangle = |a: usize, b: usize, c: usize, provoking: usize| Assembled {
            vertices: [indices[a], indices[b], indices[c]],
            provoking: indices[provoking],
        };
        let count = indices.len();
        match topology {
            Topology::Triangles => {
                Triangles { indices: Arc::clone(indices), provoking: Provoking::Corner(if first { 0 } else { 2 }) }
            }
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

    /// Returns triangle `number`.
    ///
    /// # Panics
    /// Panics if there is no such triangle.
    pub fn at(&self, number: usize) -> Assembled {
        Assembled { vertices: self.vertices(number), provoking: self.provoking(number) }
    }

    /// Returns an iterator over the triangles in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Assembled> + '_ {
        (0..self.len()).map(|number| self.at(number))
    }
}

impl FromIterator<Assembled> for Triangles {
    fn from_iter<I: IntoIterator<Item = Assembled>>(triangles: I) -> Self {
        let triangles = triangles.into_iter();
        let count = triangles.size_hint().0;
        let (mut indices, mut provoking) = (Vec::with_capacity(3 * count), Vec::with_capacity(count));
        for triangle in triangles {
            indices.extend(triangle.vertices);
            provoking.push(triangle.provoking);
        }
        Triangles { indices: indices.into(), provoking: Provoking::Each(provoking.into()) }
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
    fn listed_triangles_share_the_indices_of_the_draw() {
        let indices: Arc<[u32]> = (0..9).collect();
        let triangles = Triangles::split(&indices, Topology::Triangles, ProvokingVertex::Last);
        assert!(Arc::ptr_eq(&triangles.indices, &indices));
    }
}
