//! A signed dot product as passes that add and passes that subtract.

use super::*;

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, additions_first: bool| {
        Method::new(name, [0.0, 45.0], move |tilt: f64| {
            largest_error(&text(tilt.to_radians(), additions_first), 0, |at| {
                cos(angle(-90.0, 90.0, at) - tilt.to_radians())
            })
        })
    };
    Experiment::new("order", "Passes of a signed dot product in two orders")
        .moving("tilt of the light, degrees", Scale::Real(0.125), steps(0.0, 90.0, 46))
        .measuring("largest error, 8-bit steps", 4.0)
        .by([method("additions first", true), method("subtractions first", false)])
}

/// Normals over half a circle, lit from `tilt`: each product of half components is a pass.
fn text(tilt: f64, additions_first: bool) -> String {
    let component = |name: &str, of: fn(f64) -> f64| {
        let texels: Vec<u8> = (0..WIDTH).map(|x| byte(of(angle(-90.0, 90.0, centre(x, WIDTH))).max(0.0))).collect();
        bytes(name, WIDTH, &texels)
    };
    let textures = component("+x", sin) + &component("-x", |angle| -sin(angle)) + &component("+z", cos);
    let (across, up) = (byte(sin(tilt)), byte(cos(tilt)));
    let mut passes = [pass("+x", across, "Add"), pass("+z", up, "Add"), pass("-x", across, "ReverseSubtract")];
    if !additions_first {
        passes.reverse();
    }
    scene("Nv2a", WIDTH, "", &textures, &passes.concat())
}

/// A pass that adds or subtracts a texture times the byte of a half component of the light.
pub(super) fn pass(texture: &str, light: u8, equation: &str) -> String {
    format!(
        "({}, textures: [(texture: \"{texture}\", mag_filter: Nearest)], program: Combiners(constants: (({light}, {light}, \
         {light})), stages: [(rgb: (a: Texture0, b: ConstantColor0, ab: Spare0))], final_combiner: (d: Spare0)), \
         blend: (equation: {equation}, source: One, destination: One)), ",
        whole_row(WIDTH)
    )
}
