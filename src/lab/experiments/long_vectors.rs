//! Light vectors longer than one.

use super::order::pass;
use super::*;

/// The light stands in the middle of an octant.
const THIRD: f64 = 0.577_350_269_189_625_8;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, text: fn(f64) -> String| {
        Method::new(name, [1.0, 1.9], move |length| {
            largest_error(&text(length), 0, |at| {
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

/// From facing away in y to facing it, between x and z.
fn normal(at: f64) -> [f64; 3] {
    let tilt = angle(-90.0, 90.0, at);
    let side = cos(tilt) * std::f64::consts::FRAC_1_SQRT_2;
    [side, sin(tilt), side]
}

fn combined(length: f64) -> String {
    let normals = colors("normals", (0..WIDTH).map(|x| encode(normal(centre(x, WIDTH)))));
    let program = highlight("Texture0", encode([(length * THIRD).min(1.0); 3]), 0);
    let row = whole_row(WIDTH);
    let draw = format!("({row}, textures: [(texture: \"normals\", mag_filter: Nearest)], program: {program})");
    scene("Nv2a", WIDTH, "", &normals, &draw)
}

fn passes(length: f64) -> String {
    let half = |name: &str, of: fn([f64; 3]) -> f64| {
        let texels: Vec<u8> = (0..WIDTH).map(|x| byte(of(normal(centre(x, WIDTH))).max(0.0))).collect();
        bytes(name, WIDTH, &texels)
    };
    let textures = half("+x", |[x, _, _]| x)
        + &half("+y", |[_, y, _]| y)
        + &half("-y", |[_, y, _]| -y)
        + &half("+z", |[_, _, z]| z);
    let light = byte((length * THIRD).min(1.0));
    let draws = [
        pass("+x", light, "Add"),
        pass("+y", light, "Add"),
        pass("+z", light, "Add"),
        pass("-y", light, "ReverseSubtract"),
    ];
    scene("Nv2a", WIDTH, "", &textures, &draws.concat())
}
