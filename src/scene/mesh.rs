//! Makes meshes with tangent bases, the same on every machine.
//!
//! All arithmetic is addition, subtraction, multiplication, division and rounding of IEEE numbers in a fixed order. Sine and
//! cosine come from `circle`, not from the system's library, whose last bits differ between systems.
//!
//! Conventions: object space is right-handed, with y up. Triangles are counter-clockwise seen from the side that the normal points to. Texture
//! coordinate s grows to the right and t downward, like the rows of an image. The tangent points along s. The binormal points
//! *against* t, which is upward on the image, as the green of a [normal map](crate::generate::normal_map) does; so tangent x
//! binormal = normal.
#![allow(clippy::float_arithmetic, reason = "vertices are floats for the chip, too; the order is fixed")]

mod round;
mod tangent;
mod wavefront;

use std::sync::Arc;

use ninebit::shown;
use thiserror::Error;

pub(crate) use round::{cylinder, torus};
pub use tangent::{Surface, mesh};
pub(crate) use wavefront::read as wavefront;

/// Largest number of vertices of a generated mesh.
pub(crate) const MAXIMUM_VERTICES: u32 = 1 << 20;

/// Vertices and triangles. All lists of vertices have the same length; all vectors but positions are of unit length, to rounding.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions x, y, z in object space.
    pub(crate) positions: Vec<[f32; 3]>,
    /// Normals, which point out of the surface.
    pub(crate) normals: Vec<[f32; 3]>,
    /// Tangents, which point along increasing s.
    pub(crate) tangents: Vec<[f32; 3]>,
    /// Binormals, which point along decreasing t.
    pub(crate) binormals: Vec<[f32; 3]>,
    /// Texture coordinates s and t.
    pub(crate) texture_coordinates: Vec<[f32; 2]>,
    /// Three indices for each triangle. Draws share them.
    pub(crate) indices: Arc<[u32]>,
}

impl Mesh {
    /// Returns tangent, binormal and normal of a vertex.
    pub fn basis(&self, vertex: usize) -> [[f32; 3]; 3] {
        [self.tangents[vertex], self.binormals[vertex], self.normals[vertex]]
    }

    /// Adds a vertex with its position, its tangent, binormal and normal, and its texture coordinates.
    fn push(&mut self, position: [f32; 3], [tangent, binormal, normal]: [[f32; 3]; 3], coordinates: [f32; 2]) {
        self.positions.push(position);
        self.normals.push(normal);
        self.tangents.push(tangent);
        self.binormals.push(binormal);
        self.texture_coordinates.push(coordinates);
    }
}

/// Rounds a vector to the precision of vertices.
fn narrow(v: [f64; 3]) -> [f32; 3] {
    v.map(|c| c as f32)
}

/// Returns s and t at a corner of a lattice of `cells` cells.
fn across(at: [u32; 2], cells: [u32; 2], repeat: [f32; 2]) -> [f32; 2] {
    [0, 1].map(|n| at[n] as f32 / cells[n] as f32 * repeat[n])
}

/// The error that a mesh cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub(crate) enum MeshError {
    /// The shape needs more divisions.
    #[error("{} needs at least {minimum} {what}, not {given}", shown::a(shape))]
    TooCoarse {
        /// Name of the shape in messages.
        shape: &'static str,
        /// What the divisions are called in messages.
        what: &'static str,
        /// Smallest number of divisions of the shape.
        minimum: u32,
        /// Number of divisions that was asked for.
        given: u32,
    },
    /// The mesh would have more than [`MAXIMUM_VERTICES`].
    #[error("{} of {vertices} vertices is too fine; {MAXIMUM_VERTICES} are allowed", shown::a(shape))]
    TooFine {
        /// Name of the shape in messages.
        shape: &'static str,
        /// Number of vertices that it would have.
        vertices: u64,
    },
}

/// Makes a rectangle in the xy plane, centred on the origin, facing +z, of `columns` x `rows` cells with two triangles each.
///
/// `size` is its width and height. The texture is repeated `repeat` times along s and t; its first row lies at the top.
///
/// # Errors
/// No columns or rows, or too many vertices.
pub(crate) fn grid(columns: u32, rows: u32, size: [f32; 2], repeat: [f32; 2]) -> Result<Mesh, MeshError> {
    at_least("grid", "columns", 1, columns)?;
    at_least("grid", "rows", 1, rows)?;
    let mut mesh = with_room("grid", columns, rows)?;
    for row in 0..=rows {
        for column in 0..=columns {
            // (2i - n) / 2n is exactly symmetric about the centre.
            let x = (2.0 * column as f32 - columns as f32) / (2.0 * columns as f32) * size[0];
            let y = (rows as f32 - 2.0 * row as f32) / (2.0 * rows as f32) * size[1];
            let basis = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            mesh.push([x, y, 0.0], basis, across([column, row], [columns, rows], repeat));
        }
    }
    mesh.indices = cells(columns, rows).collect();
    Ok(mesh)
}

/// Makes a box about the origin, whose edges run along the axes. Each of its six faces has four vertices of its own.
///
/// The texture is repeated on each face. Its first row lies at the top of the sides, and at the back of the top face and the front of the bottom
/// face.
pub(crate) fn cuboid(size: [f32; 3], repeat: [f32; 2]) -> Mesh {
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0_f32, 0.0, 1.0]];
    let minus = |v: [f32; 3]| v.map(|c| 0.0 - c);
    // Tangent and normal of each face.
    let faces = [(x, z), (minus(z), x), (minus(x), minus(z)), (z, minus(x)), (x, y), (x, minus(y))];
    let mut mesh = Mesh::default();
    for (tangent, normal) in faces {
        let [n, t] = [normal, tangent];
        let binormal =
            [n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]].map(|c| c + 0.0);
        for (right, up) in [(0.0, 1.0), (1.0, 1.0), (0.0, 0.0), (1.0, 0.0)] {
            let at = |k: usize| normal[k] + (2.0 * right - 1.0) * tangent[k] + (2.0 * up - 1.0) * binormal[k];
            let position = [0, 1, 2].map(|k| at(k) * (size[k] / 2.0));
            mesh.push(position, [tangent, binormal, normal], [right * repeat[0], (1.0 - up) * repeat[1]]);
        }
    }
    let face = |first: u32| [0, 2, 3, 0, 3, 1].map(|corner| first + corner);
    mesh.indices = (0..6).flat_map(|number| face(4 * number)).collect();
    mesh
}

/// Returns the tangent of half an angle in degrees, which is above 0 and below 180.
pub(crate) fn half_tangent(degrees: f64) -> f64 {
    let half = degrees / 2.0;
    // Rounded, the sine and the cosine of 45 degrees are not equal.
    if half == 45.0 {
        return 1.0;
    }
    let eighth = if half < 45.0 { half } else { 90.0 - half } / 45.0 * std::f64::consts::FRAC_PI_4;
    let tangent = sin_eighth(eighth) / cos_eighth(eighth);
    if half < 45.0 { tangent } else { 1.0 / tangent }
}

/// Makes a sphere about the origin with its poles on the y axis. It has `slices` around the axis and `stacks` from pole to pole.
///
/// s is 0 at +z and grows eastward (to the right seen
/// from outside), up to `repeat[0]` back at +z; t is 0 at the north pole and `repeat[1]` at the south pole.
///
/// # Errors
/// Fewer than 3 slices or 2 stacks, or too many vertices.
pub(crate) fn sphere(slices: u32, stacks: u32, radius: f32, repeat: [f32; 2]) -> Result<Mesh, MeshError> {
    at_least("sphere", "slices", 3, slices)?;
    at_least("sphere", "stacks", 2, stacks)?;
    let mut mesh = with_room("sphere", slices, stacks)?;
    for stack in 0..=stacks {
        // From pole to pole is half a turn.
        let [sin_polar, cos_polar] = circle(stack, 2 * stacks);
        for slice in 0..=slices {
            let [sin_azimuth, cos_azimuth] = circle(slice, slices);
            let normal = [sin_polar * sin_azimuth, cos_polar, sin_polar * cos_azimuth];
            let tangent = [cos_azimuth, 0.0, -sin_azimuth];
            let binormal = [-cos_polar * sin_azimuth, sin_polar, -cos_polar * cos_azimuth];
            let basis = [tangent, binormal, normal].map(narrow);
            mesh.push(narrow(normal).map(|n| n * radius), basis, across([slice, stack], [slices, stacks], repeat));
        }
    }
    let mut indices = Vec::with_capacity(mesh.positions.len() * 6);
    for stack in 0..stacks {
        for slice in 0..slices {
            let [a, b, c, d] = cell(slices, stack, slice);
            // At the poles one of a cell's two triangles has no area.
            if stack + 1 < stacks {
                indices.extend([a, c, d]);
            }
            if stack > 0 {
                indices.extend([a, d, b]);
            }
        }
    }
    mesh.indices = indices.into();
    Ok(mesh)
}

/// Returns sine and cosine of `numerator / denominator` of a full turn.
///
/// The angle is reduced to the first eighth of a turn in integers, so symmetries are exact: quarter turns give exactly 0 and
/// 1, and sin(-a) = -sin(a). In that eighth, Taylor polynomials of degree 15 and 14 in f64 are off by less than 3e-16.
///
/// `denominator` must be from 1 to 2^28.
pub(crate) fn circle(numerator: u32, denominator: u32) -> [f64; 2] {
    debug_assert!(denominator > 0 && denominator <= 1 << 28);
    let (n, d) = (u64::from(numerator % denominator), u64::from(denominator));
    // The angle is `octant` eighths of a turn, plus `rest / d` of the next.
    let octant = 8 * n / d;
    let rest = 8 * n % d;
    // In odd octants the angle is measured back from their end.
    let eighths = if octant % 2 == 0 { rest } else { d - rest };
    let angle = eighths as f64 / d as f64 * std::f64::consts::FRAC_PI_4;
    let (sin, cos) = if eighths == d {
        // On the border of two octants the polynomials may differ in the last bit, but the symmetries have to be exact.
        [std::f64::consts::FRAC_1_SQRT_2; 2].into()
    } else {
        (sin_eighth(angle), cos_eighth(angle))
    };
    match octant {
        0 => [sin, cos],
        1 => [cos, sin],
        2 => [cos, -sin],
        3 => [sin, -cos],
        4 => [-sin, -cos],
        5 => [-cos, -sin],
        6 => [-cos, sin],
        _ => [-sin, cos],
    }
}

/// Returns the sine of x, for 0 <= x <= pi / 4.
fn sin_eighth(x: f64) -> f64 {
    x * series(x * x, 7, 1.0)
}

/// Returns the cosine of x, for 0 <= x <= pi / 4.
fn cos_eighth(x: f64) -> f64 {
    series(x * x, 8, 0.0)
}

/// Returns 1 - y/((1 + odd) (2 + odd)) (1 - y/((3 + odd) (4 + odd)) (1 - ...)) with `terms` terms, innermost first.
fn series(y: f64, terms: u32, odd: f64) -> f64 {
    let double = |k| 2.0 * f64::from(k) + odd;
    (1..=terms).rev().map(double).fold(1.0, |sum, double| 1.0 - y / ((double - 1.0) * double) * sum)
}

/// Returns the corners of a cell in a lattice whose rows have `columns + 1` vertices: upper left, upper right, lower left, lower right.
fn cell(columns: u32, row: u32, column: u32) -> [u32; 4] {
    let upper = row * (columns + 1) + column;
    let lower = upper + columns + 1;
    [upper, upper + 1, lower, lower + 1]
}

/// Returns the indices of two triangles for each cell of a lattice.
fn cells(columns: u32, rows: u32) -> impl Iterator<Item = u32> {
    // Mapping a range keeps its length known, so that collecting the indices allocates once.
    (0..6 * columns * rows).map(move |n| {
        let [a, b, c, d] = cell(columns, n / 6 / columns, n / 6 % columns);
        [a, c, d, a, d, b][n as usize % 6]
    })
}

fn at_least(shape: &'static str, what: &'static str, minimum: u32, given: u32) -> Result<(), MeshError> {
    if given < minimum { Err(MeshError::TooCoarse { shape, what, minimum, given }) } else { Ok(()) }
}

/// Returns an empty mesh with room for the vertices of a lattice of `columns` x `rows` cells.
fn with_room(shape: &'static str, columns: u32, rows: u32) -> Result<Mesh, MeshError> {
    let vertices = (u64::from(columns) + 1).saturating_mul(u64::from(rows) + 1);
    if vertices > u64::from(MAXIMUM_VERTICES) {
        return Err(MeshError::TooFine { shape, vertices });
    }
    let vertices = vertices as usize;
    Ok(Mesh {
        positions: Vec::with_capacity(vertices),
        normals: Vec::with_capacity(vertices),
        tangents: Vec::with_capacity(vertices),
        binormals: Vec::with_capacity(vertices),
        texture_coordinates: Vec::with_capacity(vertices),
        indices: Arc::default(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }
    fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    /// Checks that bases are orthonormal and right-handed, that triangles face outward, and that indices are in range.
    pub(super) fn check(mesh: &Mesh) {
        assert_eq!(
            [mesh.normals.len(), mesh.tangents.len(), mesh.binormals.len(), mesh.texture_coordinates.len()],
            [mesh.positions.len(); 4]
        );
        for i in 0..mesh.positions.len() {
            let (t, b, n) = (mesh.tangents[i], mesh.binormals[i], mesh.normals[i]);
            for (v, expected) in
                [(dot(t, t), 1.0), (dot(b, b), 1.0), (dot(n, n), 1.0), (dot(t, b), 0.0), (dot(t, n), 0.0)]
            {
                assert!((v - expected).abs() < 1e-6, "vertex {i}: {t:?} {b:?} {n:?}");
            }
            let third = cross(t, b);
            assert!((0..3).all(|k| (third[k] - n[k]).abs() < 1e-6), "vertex {i} is left-handed");
        }
        assert!(mesh.indices.len().is_multiple_of(3));
        for triangle in mesh.indices.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[triangle[k] as usize]);
            let edge = |p: [f32; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
            let facing = cross(edge(b), edge(c));
            let outward: [f32; 3] =
                std::array::from_fn(|k| (0..3).map(|v| mesh.normals[triangle[v] as usize][k]).sum());
            assert!(dot(facing, outward) > 0.0, "triangle {triangle:?} is inside out or has no area");
        }
    }

    #[test]
    fn sine_and_cosine_are_within_their_stated_error() {
        for n in 0..=4096 {
            let [sin, cos] = circle(n, 4096);
            let angle = f64::from(n) / 4096.0 * std::f64::consts::TAU;
            // The reference multiplies a rounded angle, which contributes 1e-15 of the difference.
            assert!((sin - angle.sin()).abs() < 2e-15 && (cos - angle.cos()).abs() < 2e-15, "{n}: {sin} {cos}");
            assert!((sin * sin + cos * cos - 1.0).abs() < 6e-16, "{n}");
        }
        // In the first eighth the reference is exact to its last bit.
        for n in 0..=512 {
            let angle = f64::from(n) / 512.0 * std::f64::consts::FRAC_PI_4;
            assert!((sin_eighth(angle) - angle.sin()).abs() < 3e-16 && (cos_eighth(angle) - angle.cos()).abs() < 3e-16);
        }
    }

    #[test]
    fn the_circle_is_exactly_symmetric() {
        assert_eq!(
            [0, 1, 2, 3, 4].map(|q| circle(q, 4)),
            [[0.0, 1.0], [1.0, 0.0], [0.0, -1.0], [-1.0, 0.0], [0.0, 1.0]]
        );
        for d in [3, 5, 7, 360, 1000] {
            for n in 1..d {
                let ([sin, cos], [back_sin, back_cos]) = (circle(n, d), circle(d - n, d));
                assert_eq!((sin, cos), (-back_sin, back_cos), "{n}/{d}");
            }
        }
    }

    #[test]
    fn a_grid_of_one_cell_is_two_triangles() {
        let mesh = grid(1, 1, [4.0, 2.0], [3.0, 1.0]).expect("mesh");
        check(&mesh);
        assert_eq!(mesh.positions, [[-2.0, 1.0, 0.0], [2.0, 1.0, 0.0], [-2.0, -1.0, 0.0], [2.0, -1.0, 0.0]]);
        assert_eq!(mesh.texture_coordinates, [[0.0, 0.0], [3.0, 0.0], [0.0, 1.0], [3.0, 1.0]]);
        assert_eq!(mesh.indices[..], [0, 2, 3, 0, 3, 1]);
    }

    #[test]
    fn a_box_has_six_faces() {
        let mesh = cuboid([2.0, 4.0, 6.0], [3.0, 1.0]);
        check(&mesh);
        assert_eq!((mesh.positions.len(), mesh.indices.len()), (24, 36));
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            assert_eq!(position.map(f32::abs), [1.0, 2.0, 3.0]);
            assert_eq!(dot(position.map(|c| c.signum()), *normal), 1.0);
        }
        // The front face, seen from +z: its first row is the upper one.
        assert_eq!(mesh.positions[..4], [[-1.0, 2.0, 3.0], [1.0, 2.0, 3.0], [-1.0, -2.0, 3.0], [1.0, -2.0, 3.0]]);
        assert_eq!(mesh.texture_coordinates[..4], [[0.0, 0.0], [3.0, 0.0], [0.0, 1.0], [3.0, 1.0]]);
        // What a textured mesh says of itself is what VTX-4 computes.
        let found = tangent::tests::again(&mesh);
        assert_eq!((&found.tangents, &found.binormals), (&mesh.tangents, &mesh.binormals));
    }

    #[test]
    fn tangents_of_half_angles_are_near_the_real_ones() {
        for n in 1..360 {
            let degrees = f64::from(n) / 2.0;
            // Near 180 degrees a rounded angle counts 200 times; what is left to 180 is exact.
            let tangent = |degrees: f64| (degrees.to_radians() / 2.0).tan();
            let tangent = if degrees <= 90.0 { tangent(degrees) } else { 1.0 / tangent(180.0 - degrees) };
            assert!((half_tangent(degrees) / tangent - 1.0).abs() < 1e-14, "{degrees}");
        }
        assert_eq!(half_tangent(90.0), 1.0);
    }

    #[test]
    fn finer_grids_hold_together() {
        let mesh = grid(7, 5, [1.0, 1.0], [1.0, 1.0]).expect("mesh");
        check(&mesh);
        assert_eq!((mesh.positions.len(), mesh.indices.len()), (8 * 6, 7 * 5 * 6));
    }

    #[test]
    fn spheres_are_round_and_closed() {
        for (slices, stacks) in [(3, 2), (8, 4), (31, 17), (64, 32)] {
            let mesh = sphere(slices, stacks, 2.0, [2.0, 1.0]).expect("mesh");
            check(&mesh);
            assert_eq!(mesh.indices.len() as u32, slices * (stacks - 1) * 6);
            assert!(mesh.positions.iter().all(|p| (dot(*p, *p) - 4.0).abs() < 2e-6));
            // The first and the last column, at the seam, are the same points.
            for stack in 0..=stacks {
                let first = (stack * (slices + 1)) as usize;
                assert_eq!(mesh.positions[first], mesh.positions[first + slices as usize]);
            }
        }
    }

    #[test]
    fn divisions_are_checked() {
        assert!(matches!(grid(0, 1, [1.0; 2], [1.0; 2]), Err(MeshError::TooCoarse { .. })));
        assert!(matches!(sphere(2, 2, 1.0, [1.0; 2]), Err(MeshError::TooCoarse { .. })));
        assert!(matches!(grid(1 << 20, 1, [1.0; 2], [1.0; 2]), Err(MeshError::TooFine { .. })));
        let huge = sphere(u32::MAX, u32::MAX, 1.0, [1.0; 2]).expect_err("too fine");
        assert!(huge.to_string().contains("1048576"));
    }
}
