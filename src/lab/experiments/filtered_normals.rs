//! Normals between two texels, which filtering shortens.

use super::*;

/// Returns the stages of the dot product of normals and constant. `renormalised` adds one step of Newton's method before: N + N (1 - N . N) / 2.
fn dot(renormalised: bool) -> Vec<GeneralStage> {
    let (normals, direction) = (expanded(Register::Texture0), expanded(Register::ConstantColor0));
    if !renormalised {
        return vec![dot_product(normals, direction)];
    }
    let signed = |register| mapped(InputMapping::SignedIdentity, register);
    let mut correction = product(normals, mapped(InputMapping::UnsignedInvert, Register::Spare0));
    (correction.rgb.ab_output, correction.rgb.scale) = (Register::Spare1, ninebit::state::Scale::Half);
    let corrected = sum(normals, signed(Register::Spare1));
    vec![dot_product(normals, normals), correction, corrected, dot_product(signed(Register::Spare0), direction)]
}

pub(super) fn experiment() -> Experiment {
    let method = |name: &str, renormalised: bool, squares: usize| {
        Method::new(name, [5.0, 120.0], move |degrees: f64| {
            let half = 0.5 * degrees.to_radians();
            largest_error(picture(half, renormalised, squares), 0, |at| {
                // The interpolated exact normals, normalised.
                let (x, z) = (sin(half) * (2.0 * at - 1.0), cos(half));
                pow(z / (x * x + z * z).sqrt(), f64::from(1 << squares))
            })
        })
    };
    Experiment::new("filtered-normals", "A highlight between two texels of a normal map")
        .moving("angle between neighbouring normals, degrees", Scale::Real(0.125), steps(0.0, 120.0, 61))
        .measuring("largest error, 8-bit steps", 32.0)
        .by([method("N . H", false, 0), method("(N . H)^8", false, 3), method("(N . H)^8, N renormalised", true, 3)])
}

/// Draws a strip between two normals that lean away from one another by `half` each.
fn picture(half: f64, renormalised: bool, squares: usize) -> Pixels {
    let normals = colors([-1.0, 1.0].into_iter().map(|side: f64| encode([side * sin(half), 0.0, cos(half)])));
    let clamp = AddressMode::ClampToEdge;
    let unit = TextureUnit { address_s: clamp, address_t: clamp, ..TextureUnit::new(0) };
    let stages = dot(renormalised).into_iter().chain(squarings(squares)).collect();
    let row = row(WIDTH, [[0.25, 0.0, 0.0], [0.75, 0.0, 0.0]], unit, program([128, 128, 255], stages));
    drawn(Profile::Nv2a, WIDTH, vec![normals], vec![row])
}
