//! Fog coordinates, the parameters of fog functions, and the fog of a chip that evaluates it at its vertices.
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

use super::EyeVertex;
use super::vector::length;
use crate::number::convert::split;
use crate::raster::fog::{POWER_BITS, factor};
use crate::state::{FogFunction, FogMode, named};

named! {
    /// Where the coordinate of a fog function comes from.
    pub enum FogSource {
        /// The vertex gives it.
        Vertex,
        /// z in eye space, with its sign: negative in front of an OpenGL viewer.
        EyePlane,
        /// The magnitude of z in eye space.
        EyePlaneAbsolute,
        /// The distance from the viewer.
        EyeRadial,
        /// z as it leaves the vertex side, before any division; of window vertices their depth. Direct3D's z fog.
        Depth,
        /// w as it leaves the vertex side. Direct3D's w fog.
        W,
    }
}
named! {
    /// Where a fog function is evaluated.
    pub enum FogEvaluation {
        /// At each vertex; the factors are interpolated (INT-5n). Direct3D's vertex fog.
        PerVertex,
        /// At each pixel (INT-5), on nv2a alone. Direct3D's table fog.
        PerPixel,
    }
}

/// The fog coordinate of a vertex that leaves the vertex side at `position`: in clip space, or of window vertices as given.
pub fn coordinate(source: FogSource, vertex: &EyeVertex<'_>, position: [f32; 4]) -> f32 {
    match source {
        FogSource::Vertex => vertex.object.fog_coordinate,
        FogSource::EyePlane => vertex.point()[2],
        FogSource::EyePlaneAbsolute => vertex.point()[2].abs(),
        FogSource::EyeRadial => length(vertex.point()),
        FogSource::Depth => position[2],
        FogSource::W => position[3],
    }
}

/// 2 ln 256: e^-x is 2^(-16 x / this).
const EXPONENTIAL: f32 = 11.090_355;

/// 2 sqrt(ln 256): e^(-x^2) is 2^(-32 (x / this)^2).
const SQUARED: f32 = 4.709_64;

/// Fog that falls from 1 at `start` to 0 at `end` in a straight line. Without any distance between them it is, of pixels, 1 before `end`
/// and 0 from there on; of vertices 0 everywhere. `None`: the parameters are not finite.
pub fn linear(mode: FogMode, start: f32, end: f32, evaluation: FogEvaluation) -> Option<FogFunction> {
    // (end - d) 2^40 - 1: the step is less than 2^-39 wide.
    const STEEP: f32 = 1_099_511_627_776.0;
    let distance = end - start;
    let (p0, p1) = match evaluation {
        _ if start != end => (2.0 + start / distance, -1.0 / distance),
        FogEvaluation::PerVertex => (1.0, 0.0),
        FogEvaluation::PerPixel => (end * STEEP, -STEEP),
    };
    (distance.is_finite() && p0.is_finite() && p1.is_finite()).then_some(FogFunction { mode, p0, p1 })
}

/// Fog of a density: e^(-density d), or its square in the exponent.
pub fn exponential(mode: FogMode, density: f32) -> FogFunction {
    let scale = if matches!(mode, FogMode::Exp2 | FogMode::Exp2Abs) { SQUARED } else { EXPONENTIAL };
    FogFunction { mode, p0: 1.5, p1: -density / scale }
}

/// INT-5n: the factor at a vertex, with 12 bits of mantissa below the leading one, truncated.
pub fn vertex_factor(function: &FogFunction, coordinate: f32) -> f32 {
    let (exact, _) = factor(function, split(coordinate));
    let bits = i64::BITS - exact.leading_zeros();
    let cut = exact >> bits.saturating_sub(13) << bits.saturating_sub(13);
    // 13 bits are exact, and so is a division by a power of two.
    cut as f32 / (1_i64 << POWER_BITS) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Named;
    use proptest::prelude::*;

    fn text(mode: FogMode, d: f64, start: f64, end: f64, density: f64) -> f64 {
        let f: f64 = match mode {
            FogMode::Linear | FogMode::LinearAbs => (end - d) / (end - start),
            FogMode::Exp | FogMode::ExpAbs => (-density * d).exp(),
            FogMode::Exp2 | FogMode::Exp2Abs => (-(density * d) * (density * d)).exp(),
        };
        if mode == FogMode::LinearAbs { f.abs().min(1.0) } else { f.clamp(0.0, 1.0) }
    }

    proptest! {
        #[test]
        fn parameters_mean_what_the_text_says(
            mode in 0..FogMode::ALL.len(), d in 0.0_f32..100.0, start in 0.0_f32..50.0, span in 1.0_f32..60.0, density in 0.0_f32..0.2,
        ) {
            let mode = FogMode::ALL[mode];
            let function = if matches!(mode, FogMode::Linear | FogMode::LinearAbs) {
                linear(mode, start, start + span, FogEvaluation::PerVertex).expect("finite")
            } else {
                exponential(mode, density)
            };
            let exact = text(mode, d.into(), start.into(), (start + span).into(), density.into());
            let factor = vertex_factor(&function, d);
            prop_assert!((f64::from(factor) - exact).abs() < 2.0_f64.powi(-12), "{factor} {exact}");
            prop_assert_eq!(factor.to_bits() & 0x7ff, 0);
        }
    }

    #[test]
    fn constants_are_those_of_e() {
        let ln_256 = 8.0 * std::f64::consts::LN_2;
        assert_eq!(EXPONENTIAL, (2.0 * ln_256) as f32);
        assert_eq!(SQUARED, (2.0 * ln_256.sqrt()) as f32);
    }

    #[test]
    fn no_distance_is_a_wall() {
        for end in [0.0, 0.1, 50.0, -3.0, 1e9] {
            let function = |evaluation| linear(FogMode::Linear, end, end, evaluation).expect("finite");
            let around = [end - 0.01 - end.abs() * 1e-6, end, end + 0.01];
            let factors = around.map(|d| vertex_factor(&function(FogEvaluation::PerPixel), d));
            assert_eq!(factors, [1.0, 0.0, 0.0], "{end}");
            let factors = around.map(|d| vertex_factor(&function(FogEvaluation::PerVertex), d));
            assert_eq!(factors, [0.0; 3], "{end}");
        }
        let of_pixels = |start, end| linear(FogMode::Linear, start, end, FogEvaluation::PerPixel);
        assert_eq!(of_pixels(0.0, 1e-45), None);
        assert_eq!(of_pixels(3e38, -3e38), None);
        assert_eq!(of_pixels(1e30, 1e30), None);
        // The other way round is fog that lifts.
        let lifting = of_pixels(24.0, 16.0).expect("finite");
        assert_eq!([0.0, 16.0, 20.0, 24.0, 30.0].map(|d| vertex_factor(&lifting, d)), [0.0, 0.0, 0.5, 1.0, 1.0]);
    }
}
