//! A directional light that sinks to the horizon of a bumpy surface and below.

use super::*;

pub(super) fn behind() -> Experiment {
    let method = |name: &str, shadowed: bool, works: f64, fails: f64| {
        Method::new(name, [works, fails], move |elevation| {
            light(elevation, 30.0, shadowed, |errors, _| largest(errors))
        })
    };
    Experiment::new("light-behind", "A light that sinks below the surface")
        .moving("height of the light, degrees", Scale::Real(0.05), steps(-40.0, 40.0, 81))
        .measuring("largest error, 8-bit steps", 16.0)
        .by([method("N . L", false, 20.0, -15.0), method("N . L times 4 L.z", true, 30.0, 1.0)])
}

pub(super) fn grazing() -> Experiment {
    let method = |name: &str, bumps: f64| {
        Method::new(name, [60.0, 0.25], move |elevation| {
            light(elevation, bumps, false, |errors, wanted| {
                100.0 * root_mean_square(errors) / root_mean_square(wanted).max(1e-9)
            })
        })
    };
    Experiment::new("light-grazing", "A light that grazes the surface")
        .moving("height of the light, degrees", Scale::Real(0.05), (1..=60).map(f64::from).collect())
        .measuring("rms error, per cent of the rms light", 5.0)
        .by([method("bumps of up to 2 degrees", 2.0), method("bumps of up to 10 degrees", 10.0)])
}

/// Measures the light. `error` makes one number of the errors and the expected values, in steps. With `shadowed`, light that comes from below the surface is multiplied by its height above
/// the surface, times four; otherwise it lights bumps.
fn light(
    elevation: f64,
    bumps: f64,
    shadowed: bool,
    error: impl FnOnce(&[f64], &[f64]) -> f64,
) -> Result<Outcome, Box<SceneError>> {
    let elevation = elevation.to_radians();
    let tilt = |at: f64| angle(-bumps, bumps, at);
    let normals = leaning(WIDTH, |x| tilt(centre(x, WIDTH)));
    let [r, g, b] = encode([cos(elevation), 0.0, sin(elevation)]);
    let direction = expanded(Register::ConstantColor0);
    let mut stages = vec![dot_product(expanded(Register::Texture0), direction)];
    if shadowed {
        let term = &mut stages[0].alpha;
        term.inputs[0] = CombinerInput { component: Component::Blue, ..direction };
        term.inputs[1].mapping = InputMapping::UnsignedInvert;
        (term.ab_output, term.scale) = (Register::Spare0, ninebit::state::Scale::Four);
        let lit = plain(Register::Spare0);
        stages.push(product(lit, CombinerInput { component: Component::Alpha, ..lit }));
    }
    let row = whole_row(WIDTH, 0, program([r, g, b], stages));
    let pixels = drawn(Profile::Nv2a, WIDTH, vec![normals], vec![row]);
    let ideal =
        |at: f64| if elevation <= 0.0 { 0.0 } else { cos(tilt(at) - (std::f64::consts::FRAC_PI_2 - elevation)) };
    let wanted: Vec<f64> = (0..WIDTH).map(|x| 255.0 * ideal(centre(x, WIDTH)).max(0.0)).collect();
    compared(pixels, 0, ideal, |errors| error(errors, &wanted))
}
