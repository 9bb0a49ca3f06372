//! A list of vertices, stored as one column for each component of an attribute.

mod triangle;

pub use triangle::TriangleVertices;

use std::fmt;

use super::column::Column;
use super::{TEXTURE_UNITS, Vertex, VertexColor};

/// A compact list of vertices. A component that is the same at all vertices is stored once; one that differs has its
/// own column. Coordinate sets that are equal at all vertices share their columns. A clone shares the columns with the
/// original until either changes.
#[derive(Clone)]
pub struct Vertices {
    count: usize,
    position: [Column<f32>; 4],
    diffuse: Colors,
    specular: Colors,
    fog: Column<f32>,
    fog_coordinate: Column<Option<f32>>,
    coordinates: [[Column<f32>; 4]; TEXTURE_UNITS],
    /// For each coordinate set, the first set that equals it, whose columns are used. The columns of other sets are not
    /// kept up to date.
    representative: [usize; TEXTURE_UNITS],
}

/// Number of vertices that are converted to columns at a time.
const CHUNK: usize = 256;

impl Vertices {
    /// Creates an empty list.
    pub fn new() -> Self {
        let Vertex { position, diffuse, specular, fog, fog_coordinate, texture_coordinates } = Vertex::default();
        Vertices {
            count: 0,
            position: position.map(Column::Same),
            diffuse: Colors::from_color(diffuse),
            specular: Colors::from_color(specular),
            fog: Column::Same(fog),
            fog_coordinate: Column::Same(fog_coordinate),
            coordinates: texture_coordinates.map(|set| set.map(Column::Same)),
            representative: [0; TEXTURE_UNITS],
        }
    }

    /// Returns the number of vertices.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Returns whether the list is empty.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Appends a vertex. To append many, [`Extend`] and [`FromIterator`] are faster.
    pub fn push(&mut self, vertex: Vertex) {
        self.append(&[vertex], self.count + 1);
    }

    /// Returns vertex `index`.
    ///
    /// # Panics
    /// Panics if `index` is not below the number of vertices.
    pub fn at(&self, index: usize) -> Vertex {
        assert!(index < self.count, "vertex {index} of {}", self.count);
        Vertex {
            position: self.position(index),
            diffuse: self.diffuse.at(index),
            specular: self.specular.at(index),
            fog: self.fog.at(index),
            fog_coordinate: self.fog_coordinate.at(index),
            texture_coordinates: [0, 1, 2, 3].map(|set| self.coordinates(index, set)),
        }
    }

    /// Returns an iterator over the vertices in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Vertex> + Clone + '_ {
        (0..self.count).map(|index| self.at(index))
    }

    /// Returns the position of vertex `index`, which must exist.
    #[inline(always)]
    pub fn position(&self, index: usize) -> [f32; 4] {
        debug_assert!(index < self.count);
        let [x, y, z, w] = &self.position;
        [x.at(index), y.at(index), z.at(index), w.at(index)]
    }

    /// Returns s, t, r, q of vertex `index`, which must exist, in a coordinate set.
    #[inline(always)]
    pub fn coordinates(&self, index: usize, set: usize) -> [f32; 4] {
        debug_assert!(index < self.count);
        let [s, t, r, q] = &self.coordinates[self.representative[set]];
        [s.at(index), t.at(index), r.at(index), q.at(index)]
    }

    /// Returns whether two coordinate sets are equal at every vertex.
    pub fn same_coordinates(&self, one: usize, other: usize) -> bool {
        self.representative[one] == self.representative[other]
            || (0..self.count).all(|index| self.coordinates(index, one) == self.coordinates(index, other))
    }

    /// Returns a component (s, t, r or q) of a coordinate set if it is the same at every vertex, and `None` otherwise.
    pub fn same_coordinate(&self, set: usize, component: usize) -> Option<f32> {
        let mut all = (0..self.count).map(|index| self.coordinates(index, set)[component]);
        let first = all.next()?;
        all.all(|other| other == first).then_some(first)
    }

    /// Returns the diffuse colour of vertex `index`, which must exist.
    pub fn diffuse(&self, index: usize) -> VertexColor {
        debug_assert!(index < self.count);
        self.diffuse.at(index)
    }

    /// Returns the specular colour of vertex `index`, which must exist.
    pub fn specular(&self, index: usize) -> VertexColor {
        debug_assert!(index < self.count);
        self.specular.at(index)
    }

    /// Returns the fog of vertex `index`, which must exist: a factor, d' or e.
    pub fn fog(&self, index: usize) -> f32 {
        debug_assert!(index < self.count);
        self.fog.at(index)
    }

    /// Returns the triangle of the vertices `indices`, which must exist.
    #[inline(always)]
    pub fn triangle(&self, indices: [u32; 3]) -> TriangleVertices<'_> {
        debug_assert!(indices.iter().all(|index| (*index as usize) < self.count));
        TriangleVertices { vertices: self, indices }
    }

    /// Calls `change` with the index and the contents of each vertex, and stores the changed vertices.
    pub fn update(&mut self, mut change: impl FnMut(usize, &mut Vertex)) {
        let changed = self.iter().enumerate().map(|(index, mut vertex)| {
            change(index, &mut vertex);
            vertex
        });
        *self = changed.collect();
    }

    /// Replaces every position by `map` of it. Components that do not change keep sharing their columns.
    pub fn map_positions(&mut self, mut map: impl FnMut([f32; 4]) -> [f32; 4]) {
        let mut mapped: [Option<Column<f32>>; 4] = [const { None }; 4];
        let mut chunk = Vec::with_capacity(CHUNK.min(self.count));
        for start in (0..self.count).step_by(CHUNK) {
            chunk.clear();
            chunk.extend((start..self.count.min(start + CHUNK)).map(|index| map(self.position(index))));
            for (axis, (given, mapped)) in self.position.iter().zip(&mut mapped).enumerate() {
                let values = chunk.iter().map(|position| position[axis]);
                let stays = |(n, value): (usize, f32)| value.to_bits() == given.at(start + n).to_bits();
                if mapped.is_none() && values.clone().enumerate().all(stays) {
                    continue;
                }
                let mapped = mapped.get_or_insert_with(|| {
                    let mut column = Column::Same(0.0);
                    column.extend(0, self.count, (0..start).map(|index| given.at(index)));
                    column
                });
                mapped.extend(start, self.count, values);
            }
        }
        for (column, mapped) in self.position.iter_mut().zip(mapped) {
            if let Some(mapped) = mapped {
                *column = mapped;
            }
        }
    }

    /// Returns the bytes that the columns take on the heap.
    pub fn bytes(&self) -> usize {
        let sets =
            (0..TEXTURE_UNITS).filter(|set| self.representative[*set] == *set).flat_map(|set| &self.coordinates[set]);
        let floats = self.position.iter().chain([&self.fog]).chain(sets);
        let fog = self.fog_coordinate.bytes();
        floats.map(Column::bytes).sum::<usize>() + fog + self.diffuse.bytes() + self.specular.bytes()
    }

    fn append(&mut self, vertices: &[Vertex], capacity: usize) {
        let count = self.count;
        for (axis, column) in self.position.iter_mut().enumerate() {
            column.extend(count, capacity, vertices.iter().map(|v| v.position[axis]));
        }
        self.diffuse.extend(count, capacity, vertices.iter().map(|v| v.diffuse));
        self.specular.extend(count, capacity, vertices.iter().map(|v| v.specular));
        self.fog.extend(count, capacity, vertices.iter().map(|v| v.fog));
        self.fog_coordinate.extend(count, capacity, vertices.iter().map(|v| v.fog_coordinate));
        self.separate_sets(vertices);
        for (set, columns) in
            self.coordinates.iter_mut().enumerate().filter(|(set, _)| self.representative[*set] == *set)
        {
            for (n, column) in columns.iter_mut().enumerate() {
                column.extend(count, capacity, vertices.iter().map(|v| v.texture_coordinates[set][n]));
            }
        }
        self.count += vertices.len();
    }

    /// Separates coordinate sets that were equal so far and that these vertices distinguish: each gets its own columns.
    fn separate_sets(&mut self, vertices: &[Vertex]) {
        let alike = |one: usize, other: usize| {
            vertices.iter().all(|v| {
                let [one, other] = [one, other].map(|set| v.texture_coordinates[set].map(f32::to_bits));
                one == other
            })
        };
        let before = self.representative;
        for set in 1..TEXTURE_UNITS {
            let first = (before[set]..set).find(|other| before[*other] == before[set] && alike(*other, set));
            self.representative[set] = first.unwrap_or(set);
            if before[set] != set && self.representative[set] == set {
                self.coordinates[set] = self.coordinates[before[set]].clone();
            }
        }
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

/// Compares the vertices themselves, however they are stored.
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

/// A column of colours: all bytes, all floats, or a mixture if the list has both.
#[derive(Clone)]
enum Colors {
    Bytes(Column<[u8; 4]>),
    Floats([Column<f32>; 4]),
    Mixed(Column<VertexColor>),
}

impl Colors {
    /// Returns a column in which all colours are `color`.
    fn from_color(color: VertexColor) -> Self {
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

    /// Appends colours to a column of `count` elements, and reserves room for `capacity` elements if it allocates.
    fn extend(&mut self, count: usize, capacity: usize, colors: impl Iterator<Item = VertexColor> + Clone) {
        if let (0, Some(first)) = (count, colors.clone().next()) {
            *self = Colors::from_color(first);
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Generates vertices whose attributes often stay the same from one vertex to the next, as in scenes.
    fn some(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Vertex>> {
        let number = || prop::sample::select(vec![0.0_f32, -0.0, 1.0, 0.25, -3.5]);
        let color = || {
            prop_oneof![
                prop::sample::select(vec![[0_u8; 4], [255; 4], [1, 2, 3, 4]]).prop_map(VertexColor::Bytes),
                prop::array::uniform4(number()).prop_map(VertexColor::Floats),
            ]
        };
        let parts = (prop::array::uniform4(number()), color(), color(), number(), prop::array::uniform4(number()));
        let change = prop::sample::select(vec![0, 0, 0, 0, 1, 2, 4, 8, 16, 32, 64]);
        prop::collection::vec((parts, change), count).prop_map(|steps| {
            let mut vertex = Vertex::default();
            let step = |((position, diffuse, specular, fog, set), change): (([f32; 4], _, _, _, _), i32)| {
                match change {
                    1 => vertex.position = position,
                    2 => vertex.diffuse = diffuse,
                    4 => vertex.specular = specular,
                    8 => vertex.fog = fog,
                    16 => vertex.texture_coordinates[2] = set,
                    32 => vertex.texture_coordinates = [set; TEXTURE_UNITS],
                    64 => [vertex.texture_coordinates[1], vertex.texture_coordinates[3]] = [set; 2],
                    _ => {}
                }
                vertex
            };
            steps.into_iter().map(step).collect()
        })
    }

    /// Formats a vertex so that every bit of its values shows.
    fn bits(vertex: &Vertex) -> String {
        format!("{vertex:?}")
    }

    proptest! {
        #[test]
        fn a_list_holds_what_it_is_given(all in some(0..700), more in some(0..5)) {
            let mut vertices = Vertices::from(all.clone());
            let shared = vertices.clone();
            for vertex in &more {
                vertices.push(*vertex);
            }
            prop_assert_eq!((shared.len(), vertices.len()), (all.len(), all.len() + more.len()));
            let both: Vec<Vertex> = all.iter().chain(&more).copied().collect();
            prop_assert!(vertices.iter().map(|v| bits(&v)).eq(both.iter().map(bits)));
            prop_assert!(shared.iter().map(|v| bits(&v)).eq(all.iter().map(bits)), "a copy changes with the list");
            for (index, vertex) in both.iter().enumerate() {
                prop_assert_eq!(vertices.position(index), vertex.position);
                prop_assert_eq!(vertices.coordinates(index, 2), vertex.texture_coordinates[2]);
                prop_assert_eq!((vertices.diffuse(index), vertices.specular(index)), (vertex.diffuse, vertex.specular));
            }
        }

        #[test]
        fn triangles_are_of_three_vertices(all in some(1..20), at in prop::array::uniform3(0..1000_u32)) {
            let vertices = Vertices::from(all.clone());
            let at = at.map(|index| index % all.len() as u32);
            let (triangle, expected) = (vertices.triangle(at), at.map(|index| all[index as usize]));
            prop_assert_eq!(triangle.all(), expected);
            prop_assert_eq!(triangle.positions(), expected.map(|v| v.position));
            prop_assert_eq!(triangle.position(3), expected.map(|v| v.position[3]));
            prop_assert_eq!(triangle.coordinates(2), expected.map(|v| v.texture_coordinates[2]));
            prop_assert_eq!(triangle.fog(), expected.map(|v| v.fog));
        }

        #[test]
        fn lists_are_equal_by_value(all in some(0..30), other in some(0..30)) {
            prop_assert_eq!(Vertices::from(all.clone()) == Vertices::from(other.clone()), all == other);
        }
    }

    fn places(count: usize) -> Vertices {
        (0..count).map(|n| Vertex { position: [n as f32, 0.0, 0.0, 1.0], ..Vertex::default() }).collect()
    }

    #[test]
    fn what_is_the_same_takes_nothing() {
        assert_eq!(Vertices::from(vec![Vertex::default(); 1000]).bytes(), 0);
        assert_eq!(places(1000).bytes(), 1000 * 4);
        // One that differs makes a column, whether it comes last or first; 0 and -0 differ.
        let mut late = places(1000);
        late.push(Vertex { fog: -0.0, ..late.at(7) });
        late.push(Vertex { fog: 1.0, ..late.at(7) });
        assert!(late.at(1000).fog.is_sign_negative() && late.at(1001).fog == 1.0 && late.at(999).fog == 1.0);
        assert!(late.bytes() >= 1002 * 8);
    }

    #[test]
    fn columns_that_stay_as_they_are_remain_shared() {
        let given = places(1000);
        let mut moved = given.clone();
        moved.map_positions(|[x, y, z, w]| [x, y + 0.5 * x, z, w]);
        let Column::Each(x) = &given.position[0] else { panic!("a column") };
        assert!(matches!(&moved.position[0], Column::Each(same) if std::sync::Arc::ptr_eq(same, x)));
        assert_eq!((given.position(8), moved.position(8)), ([8.0, 0.0, 0.0, 1.0], [8.0, 4.0, 0.0, 1.0]));
    }

    #[test]
    fn vertices_change_one_by_one() {
        let mut vertices = places(3);
        vertices.update(|index, vertex| vertex.fog = if index == 1 { 0.5 } else { vertex.fog });
        assert_eq!([0, 1, 2].map(|index| vertices.at(index).fog), [1.0, 0.5, 1.0]);
        assert_eq!(vertices.at(2).position[0], 2.0);
    }

    #[test]
    #[should_panic(expected = "vertex 3 of 3")]
    fn there_is_nothing_past_the_end() {
        places(3).at(3);
    }
}
