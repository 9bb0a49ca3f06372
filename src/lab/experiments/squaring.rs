//! Highlights by repeated squaring of a dot product.

use super::*;

/// Number of pixels: several for each byte of the dot product.
const PIXELS: usize = 4 * WIDTH;
/// Tilt of the normals at the ends in degrees.
const TILT: f64 = 50.0;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, rings: bool| {
        Method::new(name, [2.0, 128.0], move |exponent| {
            let pixels = picture(log2(exponent).round() as usize);
            let found = largest_error(pixels, 0, |at| pow(cos(angle(-TILT, TILT, at)), exponent))?;
            Ok(Outcome { error: if rings { ring(&found.drawn) } else { found.error }, ..found })
        })
    };
    Experiment::new("squaring", "Highlight by repeated squaring")
        .moving("exponent", Scale::Doubling, (1..8).map(|n| f64::from(1 << n)).collect())
        .measuring("8-bit steps", 32.0)
        .by([method("largest step between neighbouring pixels", true), method("largest error", false)])
}

/// Draws N . H, squared `count` times.
fn picture(count: usize) -> Pixels {
    let normals = leaning(PIXELS, |x| angle(-TILT, TILT, strip::centre(x, PIXELS)));
    let row = whole_row(PIXELS, 0, highlight(Register::Texture0, [128, 128, 255], count));
    drawn(Profile::Nv2a, PIXELS, vec![normals], vec![row])
}

/// Returns the largest difference of two neighbouring pixels.
fn ring(pixels: &[u8]) -> f64 {
    pixels.windows(2).map(|pair| f64::from(pair[0].abs_diff(pair[1]))).fold(0.0, f64::max)
}
