//! Subtracting a pass without a subtracting blend: a (1 - b) in place of a - b.

use super::*;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, blend: &'static str| Method::new(name, [255.0, 0.0], move |gap| error(gap as u8, blend));
    Experiment::new("subtraction", "Approximate subtraction of a pass")
        .moving("a - b, 8-bit steps", Scale::Whole, steps(0.0, 255.0, 52))
        .measuring("largest error over a, 8-bit steps", 16.0)
        .by([
            method("(ZERO, ONE_MINUS_SRC_COLOR)", "(source: Zero, destination: OneMinusSourceColor)"),
            method("reverse subtraction", "(equation: ReverseSubtract, source: One, destination: One)"),
        ])
}

/// The largest error of a - b where b is `gap` below a, for all bytes a from `gap` on.
fn error(gap: u8, blend: &str) -> Result<f64, Box<ninebit_scene::SceneError>> {
    let first: Vec<u8> = (0..=255).collect();
    let second: Vec<u8> = first.iter().map(|a| a.saturating_sub(gap)).collect();
    let textures = bytes("a", WIDTH, &first) + &bytes("b", WIDTH, &second);
    let row = whole_row(WIDTH);
    let pass = |texture: &str, blend: &str| {
        format!(
            "({row}, textures: [(texture: \"{texture}\", mag_filter: Nearest)], \
             program: Combiners(stages: [()], final_combiner: (d: Texture0)){blend}), "
        )
    };
    let draws = pass("a", "") + &pass("b", &format!(", blend: {blend}"));
    let pixels = draw(&scene("Nv2a", WIDTH, "", &textures, &draws))?;
    let errors = pixels.iter().zip(first).filter(|(_, a)| *a >= gap).map(|(pixel, _)| pixel[0].abs_diff(gap));
    Ok(errors.map(f64::from).fold(0.0, f64::max))
}
