//! Highlights by squaring a dot product again and again.

use super::*;

/// Pixels: several for each byte of the dot product.
const PIXELS: usize = 4 * WIDTH;
/// Degrees of the normals at the ends.
const TILT: f64 = 50.0;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, of: fn(&[[u8; 4]], f64) -> f64| {
        Method::new(name, [2.0, 128.0], move |exponent| Ok(of(&picture(log2(exponent).round() as usize)?, exponent)))
    };
    Experiment::new("squaring", "Highlight by repeated squaring")
        .moving("exponent", Scale::Doubling, (1..8).map(|n| f64::from(1 << n)).collect())
        .measuring("8-bit steps", 32.0)
        .by([
            method("largest step between neighbouring pixels", |pixels, _| band(pixels)),
            method("largest error", |pixels, exponent| {
                largest(&errors(pixels, 0, |at| pow(cos(angle(-TILT, TILT, at)), exponent)))
            }),
        ])
}

/// N . H, then so many squarings.
fn picture(count: usize) -> Pixels {
    let normals = leaning(PIXELS, |x| angle(-TILT, TILT, strip::centre(x, PIXELS)));
    let row = whole_row(PIXELS, 0, highlight(Register::Texture0, [128, 128, 255], count));
    drawn(Profile::Nv2a, PIXELS, vec![normals], vec![row])
}

/// The largest difference of two neighbours.
fn band(pixels: &[[u8; 4]]) -> f64 {
    pixels.windows(2).map(|pair| f64::from(pair[0][0].abs_diff(pair[1][0]))).fold(0.0, f64::max)
}
