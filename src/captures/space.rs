//! Vertex transforms of the programs: matrices in single precision that row vectors are multiplied by.

use ninebit::vertex::unit;
use std::f32::consts::FRAC_1_SQRT_2;

/// A matrix as an array of rows.
pub(super) type Matrix = [[f64; 4]; 4];

pub(super) const IDENTITY: Matrix =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// 1 / tan(22.5 degrees), as the programs have it: half of 45 degrees in single precision.
const COTANGENT: f32 = 2.414_213_4;
/// Distance of the viewer from the origin.
pub(super) const DISTANCE: f64 = 7.0;

/// Returns a row vector times a matrix in single precision, as the programs compute it: products are added from left to right.
pub(super) fn in_single(vector: [f32; 4], matrix: &Matrix) -> [f32; 4] {
    let term = |row: usize, column: usize| vector[row] * matrix[row][column] as f32;
    std::array::from_fn(|column| (1..4).fold(term(0, column), |sum, row| sum + term(row, column)))
}

/// Returns the unit vector of a direction in single precision, as the programs compute it.
pub(super) fn direction([x, y, z]: [f32; 3]) -> [f32; 3] {
    let reciprocal = 1.0 / (x * x + y * y + z * z).sqrt();
    [x * reciprocal, y * reciprocal, z * reciprocal]
}

/// Returns the product of two matrices in single precision.
pub(super) fn product(a: Matrix, b: Matrix) -> Matrix {
    a.map(|row| in_single(row.map(|value| value as f32), &b).map(f64::from))
}

/// Returns the inverse of a matrix as the programs compute it: cofactors in double precision, rounded, times the reciprocal of the determinant.
pub(super) fn inverse(matrix: &Matrix) -> Matrix {
    let cofactor = |row: usize, column: usize| {
        let at = |r: usize, c: usize| matrix[(row + r) % 4][(column + c) % 4];
        let minor = |r: usize, s: usize| at(r, 2) * at(s, 3) - at(r, 3) * at(s, 2);
        let determinant = at(1, 1) * minor(2, 3) - at(2, 1) * minor(1, 3) + at(3, 1) * minor(1, 2);
        if (row + column).is_multiple_of(2) { determinant } else { -determinant }
    };
    let determinant: f64 = (0..4).map(|column| matrix[0][column] * cofactor(0, column)).sum();
    let reciprocal = (1.0 / determinant) as f32;
    std::array::from_fn(|row| std::array::from_fn(|column| f64::from(cofactor(column, row) as f32 * reciprocal)))
}

/// Returns the point of the world with the depth `z` that programs find for a place of the screen: between two points of its line of sight.
/// The matrix leads from window coordinates to the world.
pub(super) fn unproject([x, y]: [f32; 2], z: f32, inverse: &Matrix) -> [f32; 4] {
    let [near, far] = [0.0, 64000.0].map(|depth| {
        let [x, y, z, w] = in_single([x, y, depth, 1.0], inverse);
        [x / w, y / w, z / w]
    });
    let t = (z - near[2]) / (far[2] - near[2]);
    let [x, y] = [0, 1].map(|k| near[k] + (far[k] - near[k]) * t);
    [x, y, z, 1.0]
}

/// Returns the point of the world that programs find for a place in the window.
pub(super) fn unproject_depth(place: [f32; 4], inverse: &Matrix) -> [f32; 4] {
    let [x, y, z, w] = in_single(place, inverse);
    [x / w, y / w, z / w, 1.0]
}

/// Returns the rows of a matrix for column vectors.
pub(super) fn rows(matrix: &Matrix) -> [[f32; 4]; 4] {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[column][row] as f32))
}

/// Returns a translation matrix.
pub(super) fn moved_by([x, y, z]: [f32; 3]) -> Matrix {
    let mut matrix = IDENTITY;
    matrix[3] = [f64::from(x), f64::from(y), f64::from(z), 1.0];
    matrix
}

/// Returns the matrix from eye to window coordinates, with depths of 0 to 65,535 between the distances 1 and 200.
pub(super) fn window() -> Matrix {
    window_to(65535.0)
}

/// Returns the matrix from eye to window coordinates with another deepest depth.
pub(super) fn window_to(deepest: f64) -> Matrix {
    let (near, far) = (1.0_f32, 200.0_f32);
    let depth = far / (far - near);
    let mut projection = [[0.0; 4]; 4];
    projection[0][0] = f64::from(COTANGENT / (640.0_f32 / 480.0));
    projection[1][1] = f64::from(COTANGENT);
    projection[2][2] = f64::from(depth);
    projection[2][3] = 1.0;
    projection[3][2] = f64::from(-near * depth);
    product(projection, viewport(deepest))
}

/// Returns the matrix of a parallel projection to window coordinates, with depths of 0 to 65,535 between two distances.
pub(super) fn parallel_window([near, far]: [f32; 2]) -> Matrix {
    let depth = 1.0 / (near - far);
    let mut projection = IDENTITY;
    (projection[0][0], projection[1][1]) = (f64::from(2.0_f32 / 640.0), f64::from(2.0_f32 / 480.0));
    (projection[2][2], projection[3][2]) = (f64::from(-depth), f64::from(near * depth));
    product(projection, viewport(65535.0))
}

/// Returns the matrix from clip space to window coordinates.
fn viewport(deepest: f64) -> Matrix {
    let mut viewport = IDENTITY;
    (viewport[0][0], viewport[1][1], viewport[2][2]) = (320.0, -240.0, deepest);
    (viewport[3][0], viewport[3][1]) = (320.0, 240.0);
    viewport
}

/// Returns the matrix from world to eye coordinates for an eye that looks at a point, upright, as the programs compute it.
pub(super) fn looking(eye: [f32; 3], at: [f32; 3]) -> Matrix {
    let cross = |a: [f32; 3], b: [f32; 3]| [1, 2, 0].map(|k| a[k] * b[(k + 1) % 3] - a[(k + 1) % 3] * b[k]);
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let z = direction([0, 1, 2].map(|k| at[k] - eye[k]));
    let x = direction(cross([0.0, 1.0, 0.0], z));
    let y = direction(cross(z, x));
    let mut matrix = IDENTITY;
    for (column, axis) in [x, y, z].into_iter().enumerate() {
        for row in 0..3 {
            matrix[row][column] = axis[row].into();
        }
        matrix[3][column] = (-dot(axis, eye)).into();
    }
    matrix
}

/// Returns the matrix from world to eye coordinates.
pub(super) fn eye() -> Matrix {
    moved_by([0.0, 0.0, DISTANCE as f32])
}

/// Transforms a point of the world by the fixed function, which shifts pixels by [`UNPROJECTED`](super::draws::UNPROJECTED).
pub(super) fn fixed_function(point: [f32; 4]) -> [f32; 4] {
    fixed_function_to(point, &product(eye(), window()))
}

/// The same with another matrix from the world to window coordinates.
pub(super) fn fixed_function_to(point: [f32; 4], matrix: &Matrix) -> [f32; 4] {
    let off = super::draws::UNPROJECTED;
    unit::window(unit::transform(&rows(matrix), unit::words(point)), [off, off, 0.0])
}

/// Sets the depth of a position to 0.
pub(super) fn without_depth([x, y, _, w]: [f32; 4]) -> [f32; 4] {
    [x, y, 0.0, w]
}

/// Transforms a point by the fixed function and sets its depth to 0.
pub(super) fn flat(point: [f32; 4]) -> [f32; 4] {
    without_depth(fixed_function(point))
}

/// Truncates a number to single precision.
pub(super) fn toward_zero(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest).abs() > value.abs() { f32::from_bits(nearest.to_bits() - 1) } else { nearest }
}

/// Transforms a point of the world by the programs' vertex program, which multiplies by the reciprocal of w.
pub(super) fn programmed(point: [f32; 4]) -> [f32; 4] {
    programmed_by(&[product(eye(), window())], point)
}

/// The same with other matrices, one after the other.
pub(super) fn programmed_by(matrices: &[Matrix], point: [f32; 4]) -> [f32; 4] {
    let seen = matrices.iter().fold(unit::words(point), |vector, matrix| unit::transform(&rows(matrix), vector));
    unit::window(seen, [0.0; 3])
}

/// Moves edges through the inverse of the programs' vertex program and back. Edges left of and above the centre end up a sixteenth of a pixel before
/// their pixel (RAS-1).
pub(super) fn programmed_edges([left, top, right, bottom]: [f32; 4]) -> [f32; 4] {
    let before = |edge: f32, centre: f32| if edge < centre { edge - 0.0625 } else { edge };
    [before(left, 320.0), before(top, 240.0), before(right, 320.0), before(bottom, 240.0)]
}

/// Transforms a point of the plane z = 0.1 by the programs' vertex program, whose viewer stands 2.25 before the origin.
pub(super) fn vertex_program([x, y]: [f32; 2]) -> [f32; 4] {
    let w = 0.1_f32 + 2.25;
    let across = x * (COTANGENT / (640.0_f32 / 480.0)) * 320.0 + w * 320.0;
    let down = y * COTANGENT * -240.0 + w * 240.0;
    [across / w, down / w, 0.0, w]
}

/// Returns the rotation about z, then y, then x, given sine and cosine of each angle.
pub(super) fn rotated(angles: [[f32; 2]; 3]) -> Matrix {
    let [x, y, z] = angles.map(|angle| angle.map(f64::from));
    let (mut about_x, mut about_y, mut about_z) = (IDENTITY, IDENTITY, IDENTITY);
    (about_z[0][0], about_z[0][1], about_z[1][0], about_z[1][1]) = (z[1], z[0], -z[0], z[1]);
    (about_y[0][0], about_y[0][2], about_y[2][0], about_y[2][2]) = (y[1], -y[0], y[0], y[1]);
    (about_x[1][1], about_x[1][2], about_x[2][1], about_x[2][2]) = (x[1], x[0], -x[0], x[1]);
    product(product(about_z, about_y), about_x)
}

/// Sine and cosine of 0 degrees in single precision, as the programs compute them. The following constants are those of other angles.
pub(super) const STRAIGHT: [f32; 2] = [0.0, 1.0];
pub(super) const DEGREES_45: [f32; 2] = [FRAC_1_SQRT_2; 2];
pub(super) const DEGREES_90: [f32; 2] = [1.0, -4.371_139e-8];
pub(super) const DEGREES_225: [f32; 2] = [f32::from_bits(0xbf35_04f2), f32::from_bits(0xbf35_04f4)];

/// Returns x and y of a point in eye space with depth 1 that the fixed function shows at a place of the screen.
pub(super) fn eye_slope([x, y]: [f32; 2]) -> [f32; 2] {
    [(x - 320.0) / 320.0 * (640.0 / 480.0) / COTANGENT, (240.0 - y) / 240.0 / COTANGENT]
}
