//! Highlights stored in a cube map: how many texels a face they need.

use super::*;

/// Toward the middle of the highlight.
const AXIS: [f64; 3] = [0.3, 0.1, 1.0];
/// The directions end before the face does: what happens at its edges is another matter.
const REACH: f64 = 0.8;

pub(super) fn experiment() -> Experiment {
    let method = |exponent: i32| {
        Method::new(format!("exponent {exponent}"), [256.0, 4.0], move |side| {
            largest_error(&text(side as usize, exponent), 0, |at| {
                highlight([REACH * (2.0 * at - 1.0), 0.2, 1.0], exponent)
            })
        })
    };
    Experiment::new("cube-resolution", "A highlight in a cube map")
        .moving("texels along a face's side", Scale::Doubling, (2..=8).map(|n| f64::from(1 << n)).collect())
        .measuring("largest error, 8-bit steps", 4.0)
        .by([8, 32, 128].map(method))
}

/// The cosine with the axis, to a power.
fn highlight(direction: [f64; 3], exponent: i32) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cosine = dot(direction, AXIS) / (dot(direction, direction) * dot(AXIS, AXIS)).sqrt();
    pow(cosine.max(0.0), f64::from(exponent))
}

/// Directions along a face; only that face holds anything.
fn text(side: usize, exponent: i32) -> String {
    let mut texels = Vec::with_capacity(side * side);
    for row in 0..side {
        let y = 1.0 - 2.0 * centre(row, side);
        texels.extend((0..side).map(|column| byte(highlight([2.0 * centre(column, side) - 1.0, y, 1.0], exponent))));
    }
    let front = byte_texels(side, &texels);
    let dark = format!("Solid(width: {side}, height: {side}, color: (0, 0, 0))");
    let cube = format!(
        "\"highlight\": (format: I8, source: Faces(positive_x: {dark}, negative_x: {dark}, positive_y: {dark}, \
         negative_y: {dark}, positive_z: {front}, negative_z: {dark})), "
    );
    let draw = format!(
        "({}, textures: [\"highlight\"], program: Combiners(stages: [()], final_combiner: (d: Texture0)))",
        row(WIDTH, &format!("t0: ({}, 0.2, 1)", -REACH), &format!("t0: ({REACH}, 0.2, 1)"))
    );
    scene("Nv2a", WIDTH, "", &cube, &draw)
}
