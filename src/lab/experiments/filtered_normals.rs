//! Normals between two texels, shortened by the filter.

use super::*;

const DOT: &str = "(rgb: (a: ExpandNormal(Texture0), b: ExpandNormal(ConstantColor0), ab: Spare0, ab_dot: true)), ";
/// One step of Newton's method first: N + N (1 - N . N) / 2.
const RENORMALISED: &str = "(rgb: (a: ExpandNormal(Texture0), b: ExpandNormal(Texture0), ab: Spare0, ab_dot: true)), \
     (rgb: (a: ExpandNormal(Texture0), b: UnsignedInvert(Spare0), ab: Spare1, scale: Half)), \
     (rgb: (a: ExpandNormal(Texture0), b: UnsignedInvert(Zero), c: SignedIdentity(Spare1), d: UnsignedInvert(Zero), sum: Spare0)), \
     (rgb: (a: SignedIdentity(Spare0), b: ExpandNormal(ConstantColor0), ab: Spare0, ab_dot: true)), ";
const SQUARE: &str = "(rgb: (a: Spare0, b: Spare0, ab: Spare0)), ";

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, dot: &'static str, squarings: usize| {
        Method::new(name, [5.0, 120.0], move |degrees: f64| {
            let half = 0.5 * degrees.to_radians();
            largest_error(&text(half, dot, squarings), 0, |at| {
                // The mix of the exact normals, brought to unit length.
                let (x, z) = (sin(half) * (2.0 * at - 1.0), cos(half));
                pow(z / (x * x + z * z).sqrt(), f64::from(1 << squarings))
            })
        })
    };
    Experiment::new("filtered-normals", "A highlight between two texels of a normal map")
        .moving("angle between neighbouring normals, degrees", Scale::Real(0.125), steps(0.0, 120.0, 61))
        .measuring("largest error, 8-bit steps", 32.0)
        .by([
            method("N . H", DOT, 0),
            method("(N . H)^8", DOT, 3),
            method("(N . H)^8, N renormalised", RENORMALISED, 3),
        ])
}

/// Two normals that lean away from one another by `half` each, mixed along the strip.
fn text(half: f64, dot: &str, squarings: usize) -> String {
    let normals =
        colors("normals", [-1.0, 1.0].into_iter().map(|side: f64| encode([side * sin(half), 0.0, cos(half)])));
    let draw = format!(
        "({}, textures: [(texture: \"normals\", address: ClampToEdge)], program: Combiners(constants: ((128, 128, 255)), \
         stages: [{dot}{}], final_combiner: (d: Spare0)))",
        row(WIDTH, "t0: (0.25, 0)", "t0: (0.75, 0)"),
        SQUARE.repeat(squarings)
    );
    scene("Nv2a", WIDTH, "", &normals, &draw)
}
