//! Computes the vertices of the captured programs. Matrices are in double precision, and the results are window positions.

/// A matrix that is multiplied by row vectors from the left.
pub type Matrix = [[f64; 4]; 4];

/// Width and height of the frame in pixels.
pub const FRAME: [f64; 2] = [640.0, 480.0];

/// Scale of x and y in the projection.
const SCALE: [f64; 2] = [1.8106602, 2.4142136];
/// Distance of the viewer from the origin.
const DISTANCE: f64 = 7.0;
/// Offset of Direct3D's viewport, which puts pixel centres at whole numbers.
pub const PIXEL_OFFSET: f64 = 0.53125;

/// Returns x, y and w in the window for a point in front of the viewer at (0, 0, -7). `offset` is added to x and y.
pub fn project([x, y, z]: [f64; 3], offset: f64) -> [f64; 3] {
    let w = z + DISTANCE;
    let [half_width, half_height] = FRAME.map(|side| side / 2.0);
    [half_width + offset + half_width * SCALE[0] * x / w, half_height + offset - half_height * SCALE[1] * y / w, w]
}

/// A cube: its centre, and its rotations about x and y in radians.
pub struct Cube {
    pub center: [f64; 3],
    pub turns: [f64; 2],
}

/// The two cubes of the captures.
pub const CUBES: [Cube; 2] = {
    use std::f64::consts::FRAC_PI_4;
    [
        Cube { center: [-1.5, 0.0, 2.0], turns: [FRAC_PI_4, FRAC_PI_4] },
        Cube { center: [1.5, 0.0, 2.0], turns: [5.0 * FRAC_PI_4, FRAC_PI_4] },
    ]
};

/// Corners of the faces +z, -z, +x, -x, +y, -y, in the order of their vertices.
pub const FACES: [[[i8; 3]; 4]; 6] = [
    [[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]],
    [[1, -1, -1], [-1, -1, -1], [-1, 1, -1], [1, 1, -1]],
    [[1, -1, 1], [1, -1, -1], [1, 1, -1], [1, 1, 1]],
    [[-1, -1, -1], [-1, -1, 1], [-1, 1, 1], [-1, 1, -1]],
    [[-1, 1, 1], [1, 1, 1], [1, 1, -1], [-1, 1, -1]],
    [[-1, -1, -1], [1, -1, -1], [1, -1, 1], [-1, -1, 1]],
];

impl Cube {
    /// Returns the matrix from the cube's space to the world, which rotates about y, then about x, and then translates.
    fn model(&self) -> Matrix {
        let [x, y, z] = self.center;
        let ([sx, sy], [cx, cy]) = (self.turns.map(f64::sin), self.turns.map(f64::cos));
        let about_x = [[1.0, 0.0, 0.0, 0.0], [0.0, cx, sx, 0.0], [0.0, -sx, cx, 0.0], [0.0, 0.0, 0.0, 1.0]];
        let about_y = [[cy, 0.0, -sy, 0.0], [0.0, 1.0, 0.0, 0.0], [sy, 0.0, cy, 0.0], [0.0, 0.0, 0.0, 1.0]];
        product(&product(&about_y, &about_x), &translate(x, y, z))
    }

    /// Returns a corner in world space.
    pub fn corner(&self, corner: [i8; 3]) -> [f64; 3] {
        let [x, y, z] = corner.map(f64::from);
        let model = self.model();
        [0, 1, 2].map(|n| x * model[0][n] + y * model[1][n] + z * model[2][n] + model[3][n])
    }

    /// Returns the matrix from the window, with depths of 16 bits, to the cube's own space.
    pub fn window_to_object(&self) -> Matrix {
        let (near, far) = (1.0, 200.0);
        let q = far / (far - near);
        let projection =
            [[SCALE[0], 0.0, 0.0, 0.0], [0.0, SCALE[1], 0.0, 0.0], [0.0, 0.0, q, 1.0], [0.0, 0.0, -near * q, 0.0]];
        let [half_width, half_height] = FRAME.map(|side| side / 2.0);
        let viewport = [
            [half_width, 0.0, 0.0, 0.0],
            [0.0, -half_height, 0.0, 0.0],
            [0.0, 0.0, 65535.0, 0.0],
            [half_width, half_height, 0.0, 1.0],
        ];
        let view = translate(0.0, 0.0, DISTANCE);
        inverse(&product(&product(&self.model(), &view), &product(&projection, &viewport)))
    }
}

fn translate(x: f64, y: f64, z: f64) -> Matrix {
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [x, y, z, 1.0]]
}

/// Returns the matrix that applies `a`, then `b`.
fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| (0..4).map(|n| a[row][n] * b[n][column]).sum()))
}

/// Returns the inverse of a matrix by elimination with the largest pivot.
fn inverse(matrix: &Matrix) -> Matrix {
    let mut left = *matrix;
    let mut right: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| f64::from(u8::from(row == column))));
    for column in 0..4 {
        let pivot = (column..4).max_by(|a, b| left[*a][column].abs().total_cmp(&left[*b][column].abs())).unwrap();
        left.swap(column, pivot);
        right.swap(column, pivot);
        let scale = left[column][column];
        for n in 0..4 {
            left[column][n] /= scale;
            right[column][n] /= scale;
        }
        for row in (0..4).filter(|row| *row != column) {
            let factor = left[row][column];
            for n in 0..4 {
                left[row][n] -= factor * left[column][n];
                right[row][n] -= factor * right[column][n];
            }
        }
    }
    right
}

/// Returns the unit vector from one point to another, in single precision.
pub fn direction(from: [f32; 3], to: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = std::array::from_fn(|n| to[n] - from[n]);
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length]
}
