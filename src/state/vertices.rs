//! Many vertices, an attribute after the other.

use std::fmt;

use super::column::Column;
use super::{TEXTURE_UNITS, Vertex, VertexColor};

/// A list of vertices that takes little memory: a component of an attribute that is the same at all vertices is held once, one that
/// differs as a column of its own. A copy shares the columns with the list it was made of, until either changes.
#[derive(Clone)]
pub struct Vertices {
    count: usize,
    position: [Column<f32>; 4],
    diffuse: Colors,
    specular: Colors,
    fog: Column<f32>,
    coordinates: [[Column<f32>; 4]; TEXTURE_UNITS],
}

/// How many vertices are taken apart at a time.
const CHUNK: usize = 256;

impl Vertices {
    /// No vertices.
    pub fn new() -> Self {
        let Vertex { position, diffuse, specular, fog, texture_coordinates } = Vertex::default();
        Vertices {
            count: 0,
            position: position.map(Column::Same),
            diffuse: Colors::of(diffuse),
            specular: Colors::of(specular),
            fog: Column::Same(fog),
            coordinates: texture_coordinates.map(|set| set.map(Column::Same)),
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Appends a vertex. Many are faster appended together, by [`Extend`] or [`FromIterator`].
    pub fn push(&mut self, vertex: Vertex) {
        self.append(&[vertex], self.count + 1);
    }

    /// Vertex `index`.
    ///
    /// # Panics
    /// There is none.
    pub fn at(&self, index: usize) -> Vertex {
        assert!(index < self.count, "vertex {index} of {}", self.count);
        Vertex {
            position: self.position(index),
            diffuse: self.diffuse.at(index),
            specular: self.specular.at(index),
            fog: self.fog.at(index),
            texture_coordinates: self.coordinates.each_ref().map(|set| set.each_ref().map(|c| c.at(index))),
        }
    }

    /// The vertices in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Vertex> + Clone + '_ {
        (0..self.count).map(|index| self.at(index))
    }

    /// The position of vertex `index`, which must be one of these.
    #[inline(always)]
    pub fn position(&self, index: usize) -> [f32; 4] {
        debug_assert!(index < self.count);
        self.position.each_ref().map(|component| component.at(index))
    }

    /// s, t, r, q of vertex `index`, which must be one of these, in a coordinate set.
    #[inline(always)]
    pub fn coordinates(&self, index: usize, set: usize) -> [f32; 4] {
        debug_assert!(index < self.count);
        self.coordinates[set].each_ref().map(|component| component.at(index))
    }

    /// Whether two coordinate sets are equal at every vertex.
    pub fn same_coordinates(&self, one: usize, other: usize) -> bool {
        one == other || (0..self.count).all(|index| self.coordinates(index, one) == self.coordinates(index, other))
    }

    /// Diffuse of vertex `index`, which must be one of these.
    pub fn diffuse(&self, index: usize) -> VertexColor {
        debug_assert!(index < self.count);
        self.diffuse.at(index)
    }

    /// Specular of vertex `index`, which must be one of these.
    pub fn specular(&self, index: usize) -> VertexColor {
        debug_assert!(index < self.count);
        self.specular.at(index)
    }

    /// The vertices `indices`, which must be of these, as the vertices of a triangle.
    #[inline(always)]
    pub fn triangle(&self, indices: [u32; 3]) -> TriangleVertices<'_> {
        debug_assert!(indices.iter().all(|index| (*index as usize) < self.count));
        TriangleVertices { vertices: self, indices }
    }

    /// Changes vertices: `change` is given each with its index.
    pub fn update(&mut self, mut change: impl FnMut(usize, &mut Vertex)) {
        let changed = self.iter().enumerate().map(|(index, mut vertex)| {
            change(index, &mut vertex);
            vertex
        });
        *self = changed.collect();
    }

    /// Puts every vertex where `map` takes its position. Components that stay as they are remain shared.
    pub fn map_positions(&mut self, mut map: impl FnMut([f32; 4]) -> [f32; 4]) {
        let mut mapped = [0.0; 4].map(Column::Same);
        let mut chunk = Vec::with_capacity(CHUNK.min(self.count));
        for start in (0..self.count).step_by(CHUNK) {
            chunk.clear();
            chunk.extend((start..self.count.min(start + CHUNK)).map(|index| map(self.position(index))));
            for (axis, column) in mapped.iter_mut().enumerate() {
                column.extend(start, self.count, chunk.iter().map(|position| position[axis]));
            }
        }
        for (column, mapped) in self.position.iter_mut().zip(mapped) {
            if !column.same(&mapped, self.count) {
                *column = mapped;
            }
        }
    }

    /// Bytes that the columns take, beside the list itself.
    pub fn bytes(&self) -> usize {
        let floats = self.position.iter().chain([&self.fog]).chain(self.coordinates.iter().flatten());
        floats.map(Column::bytes).sum::<usize>() + self.diffuse.bytes() + self.specular.bytes()
    }

    fn append(&mut self, vertices: &[Vertex], capacity: usize) {
        let count = self.count;
        for (axis, column) in self.position.iter_mut().enumerate() {
            column.extend(count, capacity, vertices.iter().map(|v| v.position[axis]));
        }
        self.diffuse.extend(count, capacity, vertices.iter().map(|v| v.diffuse));
        self.specular.extend(count, capacity, vertices.iter().map(|v| v.specular));
        self.fog.extend(count, capacity, vertices.iter().map(|v| v.fog));
        for (set, columns) in self.coordinates.iter_mut().enumerate() {
            for (n, column) in columns.iter_mut().enumerate() {
                column.extend(count, capacity, vertices.iter().map(|v| v.texture_coordinates[set][n]));
            }
        }
        self.count += vertices.len();
    }
}

impl Default for Vertices {
    fn default() -> Self {
        Vertices::new()
    }
}

impl Extend<Vertex> for Vertices {
    fn extend<I: IntoIterator<Item = Vertex>>(&mut self, vertices: I) {
        let mut vertices = vertices.into_iter();
        let coming = vertices.size_hint().0;
        let capacity = self.count + coming;
        let mut chunk = Vec::with_capacity(coming.min(CHUNK));
        loop {
            chunk.clear();
            chunk.extend(vertices.by_ref().take(CHUNK));
            if chunk.is_empty() {
                break;
            }
            self.append(&chunk, capacity);
        }
    }
}

impl FromIterator<Vertex> for Vertices {
    fn from_iter<I: IntoIterator<Item = Vertex>>(vertices: I) -> Self {
        let mut all = Vertices::new();
        all.extend(vertices);
        all
    }
}

impl From<Vec<Vertex>> for Vertices {
    fn from(vertices: Vec<Vertex>) -> Self {
        vertices.into_iter().collect()
    }
}

/// By value: what is held once and what is not plays no part.
impl PartialEq for Vertices {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl fmt::Debug for Vertices {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

/// The three vertices of a triangle.
#[derive(Clone, Copy)]
pub struct TriangleVertices<'a> {
    vertices: &'a Vertices,
    indices: [u32; 3],
}

impl TriangleVertices<'_> {
    /// All of them.
    pub fn all(&self) -> [Vertex; 3] {
        self.indices.map(|index| self.vertices.at(index as usize))
    }

    /// Their positions.
    #[inline(always)]
    pub fn positions(&self) -> [[f32; 4]; 3] {
        turned([0, 1, 2, 3].map(|axis| self.position(axis)))
    }

    /// A component of their positions: 0 to 3 for x, y, z, w.
    #[inline(always)]
    pub fn position(&self, component: usize) -> [f32; 3] {
        self.vertices.position[component].three(self.indices)
    }

    /// Their s, t, r, q in a coordinate set.
    #[inline(always)]
    pub fn coordinates(&self, set: usize) -> [[f32; 4]; 3] {
        turned(self.vertices.coordinates[set].each_ref().map(|component| component.three(self.indices)))
    }

    /// Their fog factors, or coordinates.
    #[inline(always)]
    pub fn fog(&self) -> [f32; 3] {
        self.vertices.fog.three(self.indices)
    }
}

impl fmt::Debug for TriangleVertices<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.all().fmt(f)
    }
}

/// Components of three vertices to three vertices' components.
#[inline(always)]
fn turned(components: [[f32; 3]; 4]) -> [[f32; 4]; 3] {
    [0, 1, 2].map(|vertex| components.map(|component| component[vertex]))
}

/// Colours: bytes or floats, and only if need be some of both.
#[derive(Clone)]
enum Colors {
    Bytes(Column<[u8; 4]>),
    Floats([Column<f32>; 4]),
    Mixed(Column<VertexColor>),
}

impl Colors {
    /// All of them this one.
    fn of(color: VertexColor) -> Self {
        match color {
            VertexColor::Bytes(bytes) => Colors::Bytes(Column::Same(bytes)),
            VertexColor::Floats(floats) => Colors::Floats(floats.map(Column::Same)),
        }
    }

    fn at(&self, index: usize) -> VertexColor {
        match self {
            Colors::Bytes(column) => VertexColor::Bytes(column.at(index)),
            Colors::Floats(columns) => VertexColor::Floats(columns.each_ref().map(|column| column.at(index))),
            Colors::Mixed(column) => column.at(index),
        }
    }

    /// Appends colours to `count`.
    fn extend(&mut self, count: usize, capacity: usize, colors: impl Iterator<Item = VertexColor> + Clone) {
        if let (0, Some(first)) = (count, colors.clone().next()) {
            *self = Colors::of(first);
        }
        let fits = |color: VertexColor| match self {
            Colors::Bytes(_) => matches!(color, VertexColor::Bytes(_)),
            Colors::Floats(_) => matches!(color, VertexColor::Floats(_)),
            Colors::Mixed(_) => true,
        };
        if !colors.clone().all(fits) {
            let mut mixed = Column::Same(VertexColor::Bytes([0; 4]));
            mixed.extend(0, capacity, (0..count).map(|index| self.at(index)));
            *self = Colors::Mixed(mixed);
        }
        match self {
            Colors::Bytes(column) => column.extend(
                count,
                capacity,
                colors.map(|color| if let VertexColor::Bytes(bytes) = color { bytes } else { [0; 4] }),
            ),
            Colors::Floats(columns) => {
                for (channel, column) in columns.iter_mut().enumerate() {
                    let values = colors.clone();
                    column.extend(
                        count,
                        capacity,
                        values.map(|color| if let VertexColor::Floats(all) = color { all[channel] } else { 0.0 }),
                    );
                }
            }
            Colors::Mixed(column) => column.extend(count, capacity, colors),
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Colors::Bytes(column) => column.bytes(),
            Colors::Floats(columns) => columns.iter().map(Column::bytes).sum(),
            Colors::Mixed(column) => column.bytes(),
        }
    }
}
