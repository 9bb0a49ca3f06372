//! Subtraction of a pass without a subtracting blend: a (1 - b) in place of a - b.

use super::*;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, blend: Blend| Method::new(name, [255.0, 0.0], move |gap| error(gap as u8, blend));
    let subtracting =
        Blend { equation: BlendEquation::ReverseSubtract, source: BlendFactor::One, destination: BlendFactor::One };
    let approximate = Blend {
        equation: BlendEquation::Add,
        source: BlendFactor::Zero,
        destination: BlendFactor::OneMinusSourceColor,
    };
    Experiment::new("subtraction", "Approximate subtraction of a pass")
        .moving("a - b, 8-bit steps", Scale::Whole, steps(0.0, 255.0, 52))
        .measuring("largest error over a, 8-bit steps", 16.0)
        .by([method("(ZERO, ONE_MINUS_SRC_COLOR)", approximate), method("reverse subtraction", subtracting)])
}

/// Measures the largest error of a - b, where b is `gap` below a, over all bytes a from `gap` on.
fn error(gap: u8, blend: Blend) -> Result<Outcome, Box<SceneError>> {
    let textures = vec![bytes(0..=255), bytes((0..=255_u8).map(|a| a.saturating_sub(gap)))];
    let [first, second] = [0, 1].map(|n| whole_row(WIDTH, n, Combiners::showing(FinalRegister::Texture0)));
    let pixels = drawn(Profile::Nv2a, WIDTH, textures, vec![first, Draw { blend: Some(blend), ..second }])?;
    // Where a is less than the gap, b stops at zero.
    let drawn: Vec<u8> = pixels.iter().map(|pixel| pixel[0]).collect();
    let errors = drawn.iter().zip(0..=255_u8).filter(|(_, a)| *a >= gap).map(|(drawn, _)| drawn.abs_diff(gap));
    let error = errors.map(f64::from).fold(0.0, f64::max);
    Ok(Outcome { error, drawn, exact: (0..=255_u8).map(|a| a.min(gap)).collect() })
}
