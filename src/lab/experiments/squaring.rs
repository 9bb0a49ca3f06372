//! Highlights by repeated squaring of a dot product.

use super::*;

/// Number of pixels: several for each byte of the dot product.
const PIXELS: usize = 4 * WIDTH;
/// Tilt of the normals at the ends in degrees.
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

/// Draws N . H, squared `count` times.
fn picture(count: usize) -> Pixels {
    let normals = leaning(PIXELS, |x| angle(-TILT, TILT, strip::centre(x, PIXELS)));
    let row = whole_row(PIXELS, 0, highlight(Register::Texture0, [128, 128, 255], count));
    drawn(Profile::Nv2a, PIXELS, vec![normals], vec![row])
}

/// Returns the largest difference of two neighbouring pixels.
fn band(pixels: &[[u8; 4]]) -> f64 {
    pixels.windows(2).map(|pair| f64::from(pair[0][0].abs_diff(pair[1][0]))).fold(0.0, f64::max)
}
