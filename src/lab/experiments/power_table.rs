//! Highlights by a table of powers in a texture.

use super::*;

/// Pixels: more than the largest table has texels.
const PIXELS: usize = 8 * WIDTH;
/// The smallest cosine that is looked up; the steep end of a power is the other one.
const FROM: f64 = 0.75;

pub(super) fn experiment() -> Experiment {
    let method = |texels: usize| {
        Method::new(format!("{texels} texels, filtered"), [1.0, 4096.0], move |exponent| {
            largest_error(&text(texels, exponent), 0, |at| pow(FROM + (1.0 - FROM) * at, exponent))
        })
    };
    Experiment::new("power-table", "Highlight by a table of powers")
        .moving("exponent", Scale::Whole, (0..=24).map(|n| exp2(f64::from(n) / 2.0).round()).collect())
        .measuring("largest error, 8-bit steps", 32.0)
        .by([32, 64, 128, 256, 512, 1024].map(method))
}

/// The cosine along the strip looks its power up.
fn text(texels: usize, exponent: f64) -> String {
    let table: Vec<u8> = (0..texels).map(|n| byte(pow(centre(n, texels), exponent))).collect();
    let draw = format!(
        "({}, textures: [(texture: \"powers\", address: ClampToEdge)], \
         program: Combiners(stages: [()], final_combiner: (d: Texture0)))",
        row(PIXELS, &format!("t0: ({FROM}, 0)"), "t0: (1, 0)")
    );
    scene("Nv2a", PIXELS, "", &bytes("powers", texels, &table), &draw)
}
