//! The vertices of a triangle, read out of columns.

use std::fmt;

use super::Vertices;
use crate::state::Vertex;

/// The three vertices of a triangle.
#[derive(Clone, Copy)]
pub struct TriangleVertices<'a> {
    pub(super) vertices: &'a Vertices,
    pub(super) indices: [u32; 3],
}

impl TriangleVertices<'_> {
    /// Returns the three vertices.
    pub fn all(&self) -> [Vertex; 3] {
        self.indices.map(|index| self.vertices.at(index as usize))
    }

    /// Returns x, y, z, w of each vertex.
    #[inline(always)]
    pub fn positions(&self) -> [[f32; 4]; 3] {
        transposed([self.position(0), self.position(1), self.position(2), self.position(3)])
    }

    /// Returns a component of the positions: 0 to 3 for x, y, z, w.
    #[inline(always)]
    pub fn position(&self, component: usize) -> [f32; 3] {
        self.vertices.position[component].three(self.indices)
    }

    /// Returns s, t, r, q of each vertex in a coordinate set.
    #[inline(always)]
    pub fn coordinates(&self, set: usize) -> [[f32; 4]; 3] {
        let ([s, t, r, q], indices) = (&self.vertices.coordinates[self.vertices.representative[set]], self.indices);
        transposed([s.three(indices), t.three(indices), r.three(indices), q.three(indices)])
    }

    /// Returns a component of a coordinate set of each vertex: 0 to 3 for s, t, r, q.
    #[inline(always)]
    pub fn coordinate(&self, set: usize, component: usize) -> [f32; 3] {
        self.vertices.coordinates[self.vertices.representative[set]][component].three(self.indices)
    }

    /// Returns the fog of each vertex: factors, d' or e.
    #[inline(always)]
    pub fn fog(&self) -> [f32; 3] {
        self.vertices.fog.three(self.indices)
    }

    /// Returns the fog coordinates that the fog was computed from.
    pub fn fog_coordinates(&self) -> [Option<f32>; 3] {
        self.vertices.fog_coordinate.three(self.indices)
    }
}

impl fmt::Debug for TriangleVertices<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.all().fmt(f)
    }
}

/// Converts components of three vertices to vertices of four components.
#[inline(always)]
fn transposed([x, y, z, w]: [[f32; 3]; 4]) -> [[f32; 4]; 3] {
    [[x[0], y[0], z[0], w[0]], [x[1], y[1], z[1], w[1]], [x[2], y[2], z[2], w[2]]]
}
