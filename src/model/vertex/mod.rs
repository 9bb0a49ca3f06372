//! The vertex side of the fixed-function pipe: eye space, generated coordinates, texture matrices, fog coordinates and light.
//!
//! [`mod@unit`] has the arithmetic of the chip's transform unit, [`light`] that of its light unit. Everything else is computed in 32-bit floats in the order in
//! which it is written, with + - * / and square root only, so that every machine computes the same vertices. A vector
//! without a length does not become NaN: its direction is zero.
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule; set-up quantises afterwards")]

pub mod fog;
pub mod light;
pub mod point;
pub mod shader;
pub mod texgen;
pub mod unit;
pub mod vector;

use vector::{dot3, dot4, unit};

/// The four rows of a matrix, which multiplies column vectors.
pub type Rows = [[f32; 4]; 4];

/// Returns M p, where each row's products are added from left to right.
pub fn transform(matrix: &Rows, p: [f32; 4]) -> [f32; 4] {
    matrix.map(|row| dot4(row, p))
}

/// A vertex as it was given, before any transform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectVertex {
    /// Position in object space, or the window position of window vertices.
    pub position: [f32; 4],
    /// Normal in object space, of any length. It is zero if none is given (TSH-11).
    pub normal: [f32; 3],
    /// The fog coordinate that was given.
    pub fog_coordinate: f32,
    /// Number of components with which each coordinate set was given, 1 to 4. It is 4 for a set that was not given.
    pub dimensions: [usize; 4],
}

/// The viewer, from which lines of sight start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewer {
    /// A viewer at the origin of eye space. Each vertex has its own line of sight.
    Local,
    /// A viewer far away. All lines of sight have this direction, which need not be of unit length.
    Infinite([f32; 3]),
}

impl Viewer {
    /// A viewer far away that looks along -z, as OpenGL's does.
    pub const FAR: Viewer = Viewer::Infinite([0.0, 0.0, -1.0]);
}

/// The transform from object space to eye space, in which the viewer is at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelView {
    position: Rows,
    normal: [[f32; 3]; 3],
}

impl ModelView {
    /// Creates the transform from the matrix of positions. Normals are transformed by its cofactors. They have the
    /// direction of the inverse transpose, need no division, and are correct for a singular matrix as well.
    pub fn new(matrix: &Rows) -> ModelView {
        let m = |row: usize, column: usize| matrix[row % 3][column % 3];
        let mut cofactors = [[0.0; 3]; 3];
        for (i, row) in cofactors.iter_mut().enumerate() {
            for (j, cofactor) in row.iter_mut().enumerate() {
                *cofactor = m(i + 1, j + 1) * m(i + 2, j + 2) - m(i + 1, j + 2) * m(i + 2, j + 1);
            }
        }
        let determinant = m(0, 0) * cofactors[0][0] + m(0, 1) * cofactors[0][1] + m(0, 2) * cofactors[0][2];
        let normal = if determinant < 0.0 { cofactors.map(|row| row.map(|c| -c)) } else { cofactors };
        ModelView { position: *matrix, normal }
    }

    /// Transforms a direction like a normal. The result is of unit length or zero.
    fn direction(&self, v: [f32; 3]) -> [f32; 3] {
        unit(self.normal.map(|row| dot3(row, v)))
    }
}

/// A vertex in eye space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeVertex<'a> {
    /// The vertex as it was given, in object space.
    pub object: &'a ObjectVertex,
    /// The transform to eye space.
    pub model_view: &'a ModelView,
    /// Position x, y, z, w in eye space.
    pub position: [f32; 4],
    /// Normal in eye space, of unit length or zero.
    pub normal: [f32; 3],
    /// The viewer of the vertex.
    pub viewer: Viewer,
}

impl<'a> EyeVertex<'a> {
    /// Transforms a vertex to eye space.
    pub fn new(object: &'a ObjectVertex, model_view: &'a ModelView, viewer: Viewer) -> Self {
        EyeVertex {
            object,
            model_view,
            viewer,
            position: transform(&model_view.position, object.position),
            normal: model_view.direction(object.normal),
        }
    }

    /// Returns the position as a point, divided by its w unless that is 0.
    pub fn point(&self) -> [f32; 3] {
        let [x, y, z, w] = self.position;
        if w == 0.0 { [x, y, z] } else { [x / w, y / w, z / w] }
    }

    /// Returns the direction in which the viewer sees the vertex, of unit length or zero.
    fn line_of_sight(&self) -> [f32; 3] {
        match self.viewer {
            Viewer::Local => unit(self.point()),
            Viewer::Infinite(direction) => unit(direction),
        }
    }

    /// Returns the line of sight mirrored at the normal: u - 2 n (n u), of unit length. It is zero if the vertex is at
    /// the viewer's place, and the line of sight itself if the normal is zero.
    pub fn reflection(&self) -> [f32; 3] {
        let (u, n) = (self.line_of_sight(), self.normal);
        let along = 2.0 * dot3(n, u);
        std::array::from_fn(|k| u[k] - n[k] * along)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn matrix() -> impl Strategy<Value = Rows> {
        proptest::array::uniform4(proptest::array::uniform4(-3.0_f32..3.0)).prop_map(|mut rows| {
            rows[3] = [0.0, 0.0, 0.0, 1.0];
            rows
        })
    }

    fn vector() -> impl Strategy<Value = [f32; 3]> {
        proptest::array::uniform3(-3.0_f32..3.0)
    }

    fn wide(v: [f32; 3]) -> [f64; 3] {
        v.map(f64::from)
    }

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    proptest! {
        /// A transformed normal stays perpendicular to the surface, on the same side of it.
        #[test]
        fn normals_stay_perpendicular(matrix in matrix(), n in vector(), v in vector()) {
            let view = ModelView::new(&matrix);
            let determinant = {
                let m = matrix.map(|row| wide([row[0], row[1], row[2]]));
                let cross = |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                dot(m[0], cross(m[1], m[2]))
            };
            prop_assume!(determinant.abs() > 0.1 && dot(wide(n), wide(n)) > 0.1 && dot(wide(v), wide(v)) > 0.1);
            let moved = transform(&matrix, [v[0], v[1], v[2], 0.0]);
            let normal = wide(view.direction(n));
            let product = dot(normal, wide([moved[0], moved[1], moved[2]]));
            // n v keeps its sign. Because normals are made of unit length, its magnitude changes.
            prop_assert!((dot(normal, normal) - 1.0).abs() < 1e-6);
            let given = dot(wide(n), wide(v));
            prop_assert!(product * given > -1e-4, "{product} {given}");
        }

        #[test]
        fn reflection_is_a_mirror(p in vector(), n in vector()) {
            let position = [p[0], p[1], p[2], 1.0];
            let object = ObjectVertex { position, normal: n, fog_coordinate: 0.0, dimensions: [4; 4] };
            let identity = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
            let view = ModelView::new(&identity);
            let vertex = EyeVertex::new(&object, &view, Viewer::Local);
            let r = vertex.reflection();
            prop_assume!(dot(wide(p), wide(p)) > 1e-3 && dot(wide(n), wide(n)) > 1e-3);
            // The reflection is as long as the line of sight, in its plane with the normal, and leaves the surface at
            // the same angle.
            let (r, n, u) = (wide(r), wide(vertex.normal), wide(p).map(|c| c / dot(wide(p), wide(p)).sqrt()));
            prop_assert!((dot(r, r) - 1.0).abs() < 1e-5);
            prop_assert!((dot(r, n) + dot(u, n)).abs() < 1e-5);
            let sideways = |v: [f64; 3]| [0, 1, 2].map(|k| v[k] - n[k] * dot(v, n));
            prop_assert!((0..3).all(|k| (sideways(r)[k] - sideways(u)[k]).abs() < 1e-5));
            // Mirroring it again yields the line of sight.
            let back = [0, 1, 2].map(|k| r[k] - 2.0 * n[k] * dot(r, n));
            prop_assert!((0..3).all(|k| (back[k] - u[k]).abs() < 1e-5));
        }

        /// A viewer far away sees every vertex as a local viewer sees what is straight ahead.
        #[test]
        fn from_far_away_all_lines_of_sight_are_one(p in vector(), ahead in vector(), n in vector()) {
            prop_assume!(dot(wide(ahead), wide(ahead)) > 1e-3);
            let identity = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
            let view = ModelView::new(&identity);
            let at = |p: [f32; 3]| ObjectVertex { position: [p[0], p[1], p[2], 1.0], normal: n, fog_coordinate: 0.0, dimensions: [4; 4] };
            let (there, straight_ahead) = (at(p), at(ahead));
            let far = EyeVertex::new(&there, &view, Viewer::Infinite(ahead)).reflection();
            prop_assert_eq!(far, EyeVertex::new(&straight_ahead, &view, Viewer::Local).reflection());
        }
    }
}
