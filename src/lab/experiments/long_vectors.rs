//! Light vectors longer than one.

use super::order::pass;
use super::*;

/// Component of the unit light vector, which points to the middle of an octant.
const THIRD: f64 = 0.577_350_269_189_625_8;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, picture: fn(f64) -> Pixels| {
        Method::new(name, [1.0, 1.9], move |length| {
            largest_error(picture(length), 0, |at| {
                let [x, y, z] = normal(at);
                length * THIRD * (x + y + z)
            })
        })
    };
    Experiment::new("long-vectors", "Light vectors longer than one")
        .moving("length of the light vector", Scale::Real(0.005), steps(1.0, 1.9, 46))
        .measuring("largest error, 8-bit steps", 8.0)
        .by([method("dot product of a general stage", combined), method("passes, additions first", passes)])
}

/// Returns normals that turn from -y to y, through the middle between x and z.
fn normal(at: f64) -> [f64; 3] {
    let tilt = angle(-90.0, 90.0, at);
    let side = cos(tilt) * std::f64::consts::FRAC_1_SQRT_2;
    [side, sin(tilt), side]
}

fn combined(length: f64) -> Pixels {
    let normals = colors((0..WIDTH).map(|x| encode(normal(centre(x, WIDTH)))));
    let program = highlight(Register::Texture0, encode([(length * THIRD).min(1.0); 3]), 0);
    drawn(Profile::Nv2a, WIDTH, vec![normals], vec![whole_row(WIDTH, 0, program)])
}

fn passes(length: f64) -> Pixels {
    let half = |of: fn([f64; 3]) -> f64| bytes((0..WIDTH).map(|x| byte(of(normal(centre(x, WIDTH))).max(0.0))));
    let halves = vec![half(|[x, _, _]| x), half(|[_, y, _]| y), half(|[_, _, z]| z), half(|[_, y, _]| -y)];
    let light = byte((length * THIRD).min(1.0));
    let equations = [BlendEquation::Add, BlendEquation::Add, BlendEquation::Add, BlendEquation::ReverseSubtract];
    let draws = (0..).zip(equations).map(|(n, equation)| pass(n, light, equation)).collect();
    drawn(Profile::Nv2a, WIDTH, halves, draws)
}
