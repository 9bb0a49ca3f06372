//! Highlights by squaring a dot product again and again.

use super::portable::{cos, log2, pow, sin};
use super::strip::{self, WIDTH, angle, colors, draw, errors, largest, scene, whole_row};
use super::{Experiment, Method, Scale};
use ninebit_scene::generate::normal_map::encode;

/// Pixels: several for each byte of the dot product.
const PIXELS: usize = 4 * WIDTH;
/// Degrees of the normals at the ends.
const TILT: f64 = 50.0;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, of: fn(&[[u8; 4]], f64) -> f64| {
        Method::new(name, [2.0, 128.0], move |exponent| {
            Ok(of(&draw(&text(log2(exponent).round() as usize))?, exponent))
        })
    };
    Experiment {
        name: "squaring",
        title: "Highlight by repeated squaring",
        parameter: "exponent",
        error: "8-bit steps",
        limit: 32.0,
        scale: Scale::Doubling,
        shown: (1..8).map(|n| f64::from(1 << n)).collect(),
        methods: vec![
            method("largest step between neighbouring pixels", |pixels, _| band(pixels)),
            method("largest error", |pixels, exponent| {
                largest(&errors(pixels, 0, |at| pow(cos(angle(-TILT, TILT, at)), exponent)))
            }),
        ],
    }
}

/// N . H, then so many squarings.
fn text(squarings: usize) -> String {
    let normals = (0..PIXELS).map(|x| {
        let tilt = angle(-TILT, TILT, strip::centre(x, PIXELS));
        encode([sin(tilt), 0.0, cos(tilt)])
    });
    let squares = "(rgb: (a: Spare0, b: Spare0, ab: Spare0)), ".repeat(squarings);
    let program = format!(
        "Combiners(constants: ((128, 128, 255)), stages: [(rgb: (a: ExpandNormal(Texture0), b: ExpandNormal(ConstantColor0), \
         ab: Spare0, ab_dot: true)), {squares}], final_combiner: (d: Spare0))"
    );
    let draw =
        format!("({}, textures: [(texture: \"normals\", mag_filter: Nearest)], program: {program})", whole_row(PIXELS));
    scene("Nv2a", PIXELS, "", &colors("normals", normals), &draw)
}

/// The largest difference of two neighbours.
fn band(pixels: &[[u8; 4]]) -> f64 {
    pixels.windows(2).map(|pair| f64::from(pair[0][0].abs_diff(pair[1][0]))).fold(0.0, f64::max)
}
