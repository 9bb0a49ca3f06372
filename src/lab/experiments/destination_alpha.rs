//! Numbers that are accumulated in destination alpha, with eight bits per pass.

use super::*;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, blend: [BlendFactor; 2], part: fn(f64, f64) -> f64| {
        Method::new(name, [1.0, 128.0], move |passes| largest_error(picture(passes, blend, part), 3, |at| at))
    };
    Experiment::new("destination-alpha", "A number gathered in destination alpha")
        .moving(
            "passes",
            Scale::Whole,
            [1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128].map(f64::from).into(),
        )
        .measuring("largest error, 8-bit steps", 4.0)
        .by([
            method("sum of equal parts", [BlendFactor::One, BlendFactor::One], |value, passes| value / passes),
            method("product of equal factors", [BlendFactor::Zero, BlendFactor::SourceAlpha], |value, passes| {
                pow(value, 1.0 / passes)
            }),
        ])
}

/// Draws the passes. Each contributes the same part of the result, as a byte.
fn picture(passes: f64, [source, destination]: [BlendFactor; 2], part: fn(f64, f64) -> f64) -> Pixels {
    let texels = bytes((0..WIDTH).map(|x| byte(part(centre(x, WIDTH), passes))));
    let pass = whole_row(WIDTH, 0, Combiners::showing(FinalRegister::Texture0));
    let pass = Draw { color_mask: [false, false, false, true], ..pass };
    let blend = Some(Blend { equation: BlendEquation::Add, source, destination });
    let mut draws = vec![Draw { blend, ..pass.clone() }; passes as usize];
    // The first pass overwrites the target.
    draws[0] = pass;
    drawn(Profile::Nv10, WIDTH, vec![texels], draws)
}
