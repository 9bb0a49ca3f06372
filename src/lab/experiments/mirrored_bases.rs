//! Tangent bases where a texture is mirrored.

use super::*;

/// Toward the light: along the binormal and up.
const LIGHT: [f64; 3] = [0.0, 0.6, 0.8];
/// The left half of a square shows the texture mirrored; corners of the halves as x, y, s, t.
const LEFT: &str = "(position: (-1, -1), normal: (0, 0, 1), t0: (1, 1)), (position: (0, -1), normal: (0, 0, 1), t0: (0, 1)), \
     (position: (0, 1), normal: (0, 0, 1), t0: (0, 0)), (position: (-1, 1), normal: (0, 0, 1), t0: (1, 0)), ";
const RIGHT: &str = "(position: (0, -1), normal: (0, 0, 1), t0: (0, 1)), (position: (1, -1), normal: (0, 0, 1), t0: (1, 1)), \
     (position: (1, 1), normal: (0, 0, 1), t0: (1, 0)), (position: (0, 1), normal: (0, 0, 1), t0: (0, 0)), ";

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, vertices: fn() -> String| {
        Method::new(name, [0.05, 45.0], move |degrees: f64| {
            let tilt = degrees.to_radians();
            let pixels = draw(&text(tilt, &vertices()))?;
            Ok(root_mean_square(&errors(&pixels, 0, |_| sin(tilt) * LIGHT[1] + cos(tilt) * LIGHT[2])))
        })
    };
    Experiment::new("mirrored-bases", "Tangent bases where a texture is mirrored")
        .moving("tilt of the mapped normal, degrees", Scale::Real(0.05), steps(0.0, 45.0, 46))
        .measuring("rms error, 8-bit steps", 8.0)
        .by([
            method("bases of the mesh, split where it is mirrored", || {
                let [x, y, z] = LIGHT;
                format!(
                    "vertices: Matrix(matrix: Identity, mesh: Triangles(vertices: [{LEFT}{RIGHT}], indices: [0, 1, 2, 0, 2, 3, 4, \
                     5, 6, 4, 6, 7]), diffuse: LightVector(direction: ({x}, {y}, {z})))"
                )
            }),
            method("binormal taken as N x T", || {
                // Where s runs to the left, N x T points against the binormal.
                listed([-LIGHT[1], -LIGHT[1]], [LIGHT[1], LIGHT[1]])
            }),
            method("one basis for both sides of the seam", || listed([-LIGHT[1], 0.0], [0.0, LIGHT[1]])),
        ])
}

/// Quads with light vectors whose binormal components are given at the ends of each half.
fn listed(left: [f64; 2], right: [f64; 2]) -> String {
    let vertex = |x: usize, y: usize, binormal: f64| {
        let [g, b] = [binormal, LIGHT[2]].map(|n| 0.5 + 0.5 * n);
        format!("(position: ({x}, {y}), diffuse: Float(0.5, {g}, {b}, 1)), ")
    };
    let quad = |from: usize, to: usize, [a, b]: [f64; 2]| {
        vertex(from, 0, a) + &vertex(to, 0, b) + &vertex(to, 1, b) + &vertex(from, 1, a)
    };
    format!("vertices: Window([{}{}]), topology: Quads", quad(0, WIDTH / 2, left), quad(WIDTH / 2, WIDTH, right))
}

/// A map of one normal that leans along the binormal.
fn text(tilt: f64, vertices: &str) -> String {
    let normals = colors("normals", std::iter::once(encode([0.0, sin(tilt), cos(tilt)])));
    let draw = format!(
        "({vertices}, textures: [\"normals\"], program: Combiners(stages: [(rgb: (a: ExpandNormal(Texture0), \
         b: ExpandNormal(PrimaryColor), ab: Spare0, ab_dot: true))], final_combiner: (d: Spare0)))"
    );
    scene("Nv10", WIDTH, "", &normals, &draw)
}
