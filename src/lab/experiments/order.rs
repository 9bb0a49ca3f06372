//! A signed dot product as passes that add and passes that subtract.

use super::*;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, additions_first: bool| {
        Method::new(name, [0.0, 45.0], move |tilt: f64| {
            largest_error(picture(tilt.to_radians(), additions_first), 0, |at| {
                cos(angle(-90.0, 90.0, at) - tilt.to_radians())
            })
        })
    };
    Experiment::new("order", "Passes of a signed dot product in two orders")
        .moving("tilt of the light, degrees", Scale::Real(0.125), steps(0.0, 90.0, 46))
        .measuring("largest error, 8-bit steps", 4.0)
        .by([method("additions first", true), method("subtractions first", false)])
}

/// Draws normals over half a circle, lit from `tilt`; each product of positive or negative component parts is a pass.
fn picture(tilt: f64, additions_first: bool) -> Pixels {
    let component =
        |of: fn(f64) -> f64| bytes((0..WIDTH).map(|x| byte(of(angle(-90.0, 90.0, centre(x, WIDTH))).max(0.0))));
    let (across, up) = (byte(sin(tilt)), byte(cos(tilt)));
    let mut passes = vec![
        pass(0, across, BlendEquation::Add),
        pass(1, up, BlendEquation::Add),
        pass(2, across, BlendEquation::ReverseSubtract),
    ];
    if !additions_first {
        passes.reverse();
    }
    drawn(Profile::Nv2a, WIDTH, vec![component(sin), component(cos), component(|angle| -sin(angle))], passes)
}

/// Returns a pass that adds or subtracts a texture times a component of the light.
pub(super) fn pass(texture: usize, light: u8, equation: BlendEquation) -> Draw {
    let lit = product(plain(Register::Texture0), plain(Register::ConstantColor0));
    let blend = Some(Blend { equation, source: BlendFactor::One, destination: BlendFactor::One });
    Draw { blend, ..whole_row(WIDTH, texture, program([light; 3], vec![lit])) }
}
