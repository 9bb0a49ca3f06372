//! TEX-15 and INT-4: texture coordinates that the fixed function generates, and texture matrices.

use super::space::{DEGREES_90, IDENTITY, Matrix, STRAIGHT};
use super::*;
use images::gradient;
use ninebit::number::transform::{product, reciprocal_root, sum};
use ninebit::vertex::unit;

/// Texture coordinate generation modes, as the names of frames have them.
const MODES: [&str; 6] = ["Disabled", "EyeLinear", "ObjectLinear", "SphereMap", "NormalMap", "ReflectionMap"];

/// Returns the texture matrices by name.
fn matrices() -> [(&'static str, Matrix); 11] {
    let scaled = |by: f64| {
        let mut matrix = IDENTITY;
        for n in 0..3 {
            matrix[n][n] = by;
        }
        matrix
    };
    let shifted = |x, y| space::moved_by([x, y, 0.0]);
    let about = |axis: usize| {
        let mut angles = [STRAIGHT; 3];
        angles[axis] = DEGREES_90;
        space::rotated(angles)
    };
    let arbitrary =
        [[0.708_939_2, 0.0, 0.515, 0.0], [0.0, 1.260_336_4, 0.49, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    [
        ("Identity", IDENTITY),
        ("Double", scaled(2.0)),
        ("Half", scaled(0.5)),
        ("ShiftHPlus", shifted(0.5, 0.0)),
        ("ShiftHMinus", shifted(-0.5, 0.0)),
        ("ShiftVPlus", shifted(0.0, 0.5)),
        ("ShiftVMinus", shifted(0.0, -0.5)),
        ("RotateX", about(0)),
        ("RotateY", about(1)),
        ("RotateZ", about(2)),
        ("Arbitrary", arbitrary),
    ]
}

/// Returns the generated coordinates of a corner at x, y of the world as the transform unit has them, before the texture matrix. The draws give
/// no normals, so these are zero.
fn generated(mode: &str, [x, y]: [f32; 2], [s, t]: [f32; 2]) -> [u32; 4] {
    let seen = unit::transform(&space::rows(&space::eye()), unit::words([x, y, 0.0, 1.0]));
    let [one, half] = [1.0_f32, 0.5].map(f32::to_bits);
    // A zero normal reflects nothing: the reflection is the direction to the vertex.
    let ([x_seen, y_seen, z_seen], _) = unit::direction([seen[0], seen[1], seen[2]]);
    let raised = sum([z_seen, one]);
    match mode {
        "Disabled" => unit::words([s, t, 0.0, 1.0]),
        "EyeLinear" => seen,
        "ObjectLinear" => unit::words([x, y, 0.0, 1.0]),
        "NormalMap" => [0, 0, 0, one],
        "ReflectionMap" => [x_seen, y_seen, sum([raised, (-1.0_f32).to_bits()]), one],
        _ => {
            let r = [x_seen, y_seen, raised];
            let root = reciprocal_root(unit::dot(r, r));
            let at = |value| sum([product(product(value, half), root), half]);
            [at(x_seen), at(y_seen), z_seen, one]
        }
    }
}

fn image() -> Texture {
    images::texture(TextureFormat::R8G8B8A8, [256, 128], gradient([256, 128]))
}

/// Draws two triangles over a rectangle of the world. The matrix is multiplied by column vectors.
fn drawing(texture: &Texture, [top, bottom]: [f32; 2], mode: &str, matrix: &Matrix) -> FrameDrawing {
    let vertex = |n: usize| {
        let [x, y] = corners([-2.75, top, 2.75, bottom])[n];
        let made = unit::transform(
            &matrix.map(|row| row.map(|value| value as f32)),
            generated(mode, [x, y], corners(WHOLE)[n]),
        );
        let made = made.map(f32::from_bits);
        let [x, y, _, w] = space::fixed_function([x, y, 0.0, 1.0]);
        let diffuse = VertexColor::Bytes([255; 4]);
        Vertex { position: [x, y, 0.0, w], diffuse, texture_coordinates: [made; TEXTURE_UNITS], ..Vertex::default() }
    };
    let draw = draw(Topology::Triangles, [0, 1, 2, 0, 2, 3].map(vertex).to_vec());
    one(0xfe20_2020, Some(texture), without_alpha(fetching(draw, 0, nearest(0)), FETCHED[0]))
}

/// Adds the frames of Texgen, except that of SphereMap: no rule covers normals of length zero there.
pub(super) fn generation(frames: &mut Frames) {
    let texture = image();
    for mode in MODES.into_iter().filter(|mode| *mode != "SphereMap") {
        frames.push(mode, drawing(&texture, [1.75, -1.75], mode, &IDENTITY));
    }
}

/// Adds the frames of Texgen_with_texture_matrix.
pub(super) fn generation_and_matrices(frames: &mut Frames) {
    let texture = image();
    for mode in MODES {
        for (name, matrix) in matrices() {
            frames.push(format!("{mode}_{name}"), drawing(&texture, [1.0, -2.5], mode, &matrix));
        }
    }
}

/// Adds the frames of Texture_Matrix: matrices over given coordinates.
pub(super) fn texture_matrices(frames: &mut Frames) {
    let texture = image();
    for (name, matrix) in matrices() {
        frames.push(name, drawing(&texture, [1.0, -2.5], "Disabled", &matrix));
    }
}
