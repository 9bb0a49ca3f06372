//! Half vectors that are computed at the vertices and interpolated.

use super::*;

/// Position of the light over a floor: x and height.
const LIGHT: [f64; 2] = [0.6, 1.0];
/// Position of the viewer over the floor: x and height.
const EYE: [f64; 2] = [-0.6, 1.0];
/// Binary logarithm of the exponent.
const SQUARINGS: usize = 3;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, parts: usize| {
        Method::new(name, [0.1, 8.0], move |extent| {
            largest_error(picture(extent, parts), 0, |at| {
                pow(half_vector(floor_x(at, extent))[1], f64::from(1 << SQUARINGS))
            })
        })
    };
    Experiment::new("half-vectors", "Half vectors of the vertices across triangles")
        .moving(
            "length of the floor, heights of the lamp",
            Scale::Real(0.01),
            (0..=36).map(|n| 0.1 * exp2(f64::from(n) / 5.7)).collect(),
        )
        .measuring("largest error of (N . H)^8, 8-bit steps", 32.0)
        .by([method("one quad", 1), method("2 quads", 2), method("4 quads", 4), method("16 quads", 16)])
}

/// Converts a position on the strip (0 to 1) to x on the floor.
fn floor_x(at: f64, extent: f64) -> f64 {
    extent * (at - 0.5)
}

/// Returns the unit half vector between the directions to light and viewer, as components along the floor and up.
fn half_vector(x: f64) -> [f64; 2] {
    let unit = |[x, z]: [f64; 2]| {
        let length = (x * x + z * z).sqrt();
        [x / length, z / length]
    };
    let [light, eye] = [LIGHT, EYE].map(|place| unit([place[0] - x, place[1]]));
    unit([light[0] + eye[0], light[1] + eye[1]])
}

fn picture(extent: f64, parts: usize) -> Pixels {
    let vertices = (0..parts).flat_map(|part| {
        let ends = [part, part + 1].map(|n| n as f64 / parts as f64);
        let vectors = ends.map(|at| {
            let [x, z] = half_vector(floor_x(at, extent));
            pointing([x, 0.0, z])
        });
        quad(ends.map(|at| at * WIDTH as f64), vectors)
    });
    let program = highlight(Register::PrimaryColor, [128, 128, 255], SQUARINGS);
    drawn(Profile::Nv2a, WIDTH, vec![], vec![quads(vertices.collect(), &[], program)])
}
