//! Tangent bases where a texture is mirrored.

use super::*;
use ninebit_scene::mesh::{Surface, mesh};

/// Direction of the light: along the binormal and up.
const LIGHT: [f64; 3] = [0.0, 0.6, 0.8];
pub(super) fn experiment() -> Experiment {
    let method = |name: &str, vertices: fn() -> Vec<Vertex>| {
        Method::new(name, [0.05, 45.0], move |degrees: f64| {
            let tilt = degrees.to_radians();
            let ideal = |_| sin(tilt) * LIGHT[1] + cos(tilt) * LIGHT[2];
            compared(picture(tilt, vertices()), 0, ideal, root_mean_square)
        })
    };
    Experiment::new("mirrored-bases", "Tangent bases where a texture is mirrored")
        .moving("tilt of the mapped normal, degrees", Scale::Real(0.05), steps(0.0, 45.0, 46))
        .measuring("rms error, 8-bit steps", 8.0)
        .by([
            method("bases of the mesh, split where it is mirrored", of_the_mesh),
            method("binormal taken as N x T", || {
                // Where s runs to the left, N x T points against the binormal.
                listed([-LIGHT[1], -LIGHT[1]], [LIGHT[1], LIGHT[1]])
            }),
            method("one basis for both sides of the seam", || listed([-LIGHT[1], 0.0], [0.0, LIGHT[1]])),
        ])
}

/// Returns a square whose left half shows the texture mirrored, with light vectors in the tangent bases of its corners.
fn of_the_mesh() -> Vec<Vertex> {
    let half = |[left, right]: [f32; 2], [s, other]: [f32; 2]| {
        [[left, -1.0, s, 1.0], [right, -1.0, other, 1.0], [right, 1.0, other, 0.0], [left, 1.0, s, 0.0]]
    };
    let corners = [half([-1.0, 0.0], [1.0, 0.0]), half([0.0, 1.0], [0.0, 1.0])].concat();
    let mesh = mesh(&Surface {
        positions: corners.iter().map(|[x, y, ..]| [*x, *y, 0.0]).collect(),
        normals: vec![[0.0, 0.0, 1.0]; 8],
        texture_coordinates: corners.iter().map(|[.., s, t]| [*s, *t]).collect(),
        indices: vec![0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7],
    })
    .expect("as many normals as corners");
    let light = |n: usize| mesh.basis(n).map(|axis| (0..3).map(|k| f64::from(axis[k]) * LIGHT[k]).sum::<f64>());
    let places = [[0, WIDTH / 2], [WIDTH / 2, WIDTH]].map(|ends| ends.map(|x| x as f64));
    (0..2).flat_map(|half| quad(places[half], [4 * half, 4 * half + 1].map(|n| pointing(light(n))))).collect()
}

/// Returns vertices with light vectors, given their binormal components at the ends of each half.
fn listed(left: [f64; 2], right: [f64; 2]) -> Vec<Vertex> {
    let lit = |binormal: f64| pointing([0.0, binormal, LIGHT[2]]);
    let middle = (WIDTH / 2) as f64;
    [quad([0.0, middle], left.map(lit)), quad([middle, WIDTH as f64], right.map(lit))].concat()
}

/// Draws a map of one normal that is tilted along the binormal.
fn picture(tilt: f64, vertices: Vec<Vertex>) -> Pixels {
    let normals = colors(std::iter::once(encode([0.0, sin(tilt), cos(tilt)])));
    let dot = dot_product(expanded(Register::Texture0), expanded(Register::PrimaryColor));
    let draw = quads(vertices, &[TextureUnit::new(0)], program([0; 3], vec![dot]));
    drawn(Profile::Nv10, WIDTH, vec![normals], vec![draw])
}
