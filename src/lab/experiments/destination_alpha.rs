//! Numbers that are gathered in destination alpha, eight bits a pass.

use super::*;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, blend: &'static str, part: fn(f64, f64) -> f64| {
        Method::new(name, [1.0, 128.0], move |passes| largest_error(&text(passes, blend, part), 3, |at| at))
    };
    Experiment::new("destination-alpha", "A number gathered in destination alpha")
        .moving(
            "passes",
            Scale::Whole,
            [1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128].map(f64::from).into(),
        )
        .measuring("largest error, 8-bit steps", 4.0)
        .by([
            method("sum of equal parts", "(source: One, destination: One)", |value, passes| value / passes),
            method("product of equal factors", "(source: Zero, destination: SourceAlpha)", |value, passes| {
                pow(value, 1.0 / passes)
            }),
        ])
}

/// Each pass brings the same part of what is to come out, as a byte.
fn text(passes: f64, blend: &str, part: fn(f64, f64) -> f64) -> String {
    let texels: Vec<u8> = (0..WIDTH).map(|x| byte(part(centre(x, WIDTH), passes))).collect();
    let pass = |blend: &str| {
        format!(
            "({}, textures: [(texture: \"part\", mag_filter: Nearest)], program: Combiners(stages: [()], \
             final_combiner: (g: Texture0)), color_mask: (false, false, false, true), blend: {blend}), ",
            whole_row(WIDTH)
        )
    };
    // The first pass replaces what was there.
    let draws = pass("()") + &pass(blend).repeat(passes as usize - 1);
    scene("Nv10", WIDTH, "", &bytes("part", WIDTH, &texels), &draws)
}
