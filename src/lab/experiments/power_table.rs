//! Highlights from a table of powers in a texture.

use super::*;

/// Number of pixels: more than the texels of the largest table.
const PIXELS: usize = 8 * WIDTH;
/// Smallest cosine that is looked up; powers are steep at the other end.
const FROM: f64 = 0.75;

pub(super) fn experiment() -> Experiment {
    let method = |texels: usize| {
        Method::new(format!("{texels} texels, filtered"), [1.0, 4096.0], move |exponent| {
            largest_error(picture(texels, exponent), 0, |at| pow(FROM + (1.0 - FROM) * at, exponent))
        })
    };
    Experiment::new("power-table", "Highlight by a table of powers")
        .moving("exponent", Scale::Whole, (0..=24).map(|n| exp2(f64::from(n) / 2.0).round()).collect())
        .measuring("largest error, 8-bit steps", 32.0)
        .by([32, 64, 128, 256, 512, 1024].map(method))
}

/// Draws the powers of cosines along the strip.
fn picture(texels: usize, exponent: f64) -> Pixels {
    let table = bytes((0..texels).map(|n| byte(pow(centre(n, texels), exponent))));
    let clamp = AddressMode::ClampToEdge;
    let unit = TextureUnit { address_s: clamp, address_t: clamp, ..TextureUnit::new(0) };
    let ends = [[FROM, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let row = row(PIXELS, ends, unit, Combiners::showing(FinalRegister::Texture0));
    drawn(Profile::Nv2a, PIXELS, vec![table], vec![row])
}
