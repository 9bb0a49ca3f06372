//! Fog coordinates, the parameters of fog functions, and the value that a vertex passes to the rasteriser (FOG-1 to
//! FOG-3, INT-5n).
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

use super::EyeVertex;
use super::vector::length;
use crate::number::light;
use crate::state::{FogFunction, FogMode, Profile, named};

named! {
    /// The source of a fog function's coordinate.
    pub enum FogSource {
        /// A coordinate that the vertex provides.
        Vertex,
        /// z in eye space with its sign, which is negative in front of an OpenGL viewer.
        EyePlane,
        /// The magnitude of z in eye space.
        EyePlaneAbsolute,
        /// The distance from the viewer.
        EyeRadial,
        /// z as it leaves the vertex side, before any division, or the depth of window vertices. Direct3D's z fog.
        Depth,
        /// w as it leaves the vertex side. Direct3D's w fog.
        W,
    }
}
named! {
    /// Where the coefficients of a fog function are applied.
    pub enum FogEvaluation {
        /// At each vertex, in all modes (INT-5n). Direct3D's vertex fog.
        PerVertex,
        /// At each pixel for linear fog (FOG-2), on nv2a alone. Direct3D's table fog.
        PerPixel,
    }
}

/// Returns the fog coordinate of a vertex that leaves the vertex side at `position`, which is in clip space, or the
/// given position of window vertices.
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

/// 2 ln 256: e^-x is 2^(-16 x / `EXPONENTIAL`).
const EXPONENTIAL: f32 = 11.090_355;

/// 2 sqrt(ln 256): e^(-x^2) is 2^(-32 (x / `SQUARED`)^2).
const SQUARED: f32 = 4.709_64;

/// Returns linear fog that falls from 1 at `start` to 0 at `end`. If they are equal, fog at the pixels is 1 before
/// `end` and 0 from there on, and fog at the vertices is 0 everywhere. Returns `None` if the parameters are not finite.
pub fn linear(mode: FogMode, start: f32, end: f32, evaluation: FogEvaluation) -> Option<FogFunction> {
    // (end - d) 2^40 - 1, whose slope is narrower than 2^-39.
    const STEEP: f32 = 1_099_511_627_776.0;
    let distance = end - start;
    let (p0, p1) = match evaluation {
        _ if start != end => (2.0 + start / distance, -1.0 / distance),
        FogEvaluation::PerVertex => (1.0, 0.0),
        FogEvaluation::PerPixel => (end * STEEP, -STEEP),
    };
    let per_vertex = evaluation == FogEvaluation::PerVertex;
    (distance.is_finite() && p0.is_finite() && p1.is_finite()).then_some(FogFunction {
        mode,
        p0,
        p1,
        p2: 0.0,
        per_vertex,
    })
}

/// Returns fog of a density: e^(-density d), or e^(-(density d)^2) in the squared modes.
pub fn exponential(mode: FogMode, density: f32, evaluation: FogEvaluation) -> FogFunction {
    let scale = if matches!(mode, FogMode::Exp2 | FogMode::Exp2Abs) { SQUARED } else { EXPONENTIAL };
    let per_vertex = evaluation == FogEvaluation::PerVertex;
    FogFunction { mode, p0: 1.5, p1: -density / scale, p2: 0.0, per_vertex }
}

/// The numbers that the light unit computes from a fog coordinate at a vertex (FOG-3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightFog {
    /// The words of p0, p1 and p2 (FOG-1).
    pub parameters: [u32; 3],
    /// The words of d and d^2 (FOG-1).
    pub coordinates: [u32; 2],
    /// The products p1 d and p2 d^2.
    pub products: [u32; 2],
    /// The sum of p0 and the products.
    pub sum: u32,
}

impl LightFog {
    /// Computes p0 + p1 d + p2 d^2 in 14 significant bits.
    pub(crate) fn new(function: &FogFunction, d: f32) -> LightFog {
        LightFog::of(function, [d, square(d)])
    }

    /// Computes p0 + p1 d + p2 x from d and x.
    pub fn of(function: &FogFunction, coordinates: [f32; 2]) -> LightFog {
        let parameters = [function.p0, function.p1, function.p2].map(|p| light::word(p.to_bits()));
        let coordinates = coordinates.map(|d| light::word(d.to_bits()));
        let products = [0, 1].map(|n| light::product(parameters[n + 1], coordinates[n]));
        LightFog { parameters, coordinates, products, sum: light::sum([parameters[0], products[0], products[1]]) }
    }
}

/// Returns d^2 as the light unit uses it, which is the single-precision product.
pub fn square(d: f32) -> f32 {
    d * d
}

/// INT-5n: returns e as the transform unit of nv10 passes it, where bit 10 of a finite word is a copy of bit 11.
fn passed_by_nv10(e: u32) -> u32 {
    if f32::from_bits(e).is_finite() { e & !(1 << 10) | (e >> 11 & 1) << 10 } else { e }
}

/// Returns the value that a vertex passes for the coordinate d: d' (FOG-2) or e (FOG-3, INT-5n).
pub fn passed(function: &FogFunction, profile: Profile, d: f32) -> f32 {
    if !function.takes_e() {
        return f32::from_bits(light::word(d.to_bits()));
    }
    let e = LightFog::new(function, d).sum;
    f32::from_bits(if profile == Profile::Nv10 { passed_by_nv10(e) } else { e })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::fog::FogPlane;
    use crate::raster::interpolate::Sample;
    use crate::raster::setup::Triangle;
    use crate::state::Named;
    use proptest::prelude::*;

    fn text(mode: FogMode, d: f64, start: f64, end: f64, density: f64) -> f64 {
        let f: f64 = match mode {
            FogMode::Linear => (end - d) / (end - start),
            FogMode::LinearAbs => (end - d.abs()) / (end - start),
            FogMode::Exp | FogMode::ExpAbs => (-density * d).exp(),
            FogMode::Exp2 | FogMode::Exp2Abs => (-(density * d) * (density * d)).exp(),
        };
        f.clamp(0.0, 1.0)
    }

    /// Returns the factor, 0 to 1, if all three vertices have the coordinate.
    fn factor(function: &FogFunction, d: f32) -> f64 {
        let triangle =
            Triangle::new([[0.0, 0.0, 0.0, 1.0], [64.0, 0.0, 0.0, 1.0], [0.0, 64.0, 0.0, 1.0]], true, Profile::Nv2a);
        let triangle = triangle.expect("area");
        let plane = FogPlane::new(Some(*function), [passed(function, Profile::Nv2a, d); 3]);
        f64::from(plane.at(&Sample::new(&triangle, triangle.edges(3, 3))).byte) / 255.0
    }

    proptest! {
        #[test]
        fn parameters_mean_what_the_text_says(
            mode in 0..FogMode::ALL.len(), d in 0.0_f32..100.0, below in any::<bool>(), start in 0.0_f32..50.0, span in 1.0_f32..60.0, density in 0.0_f32..0.2,
        ) {
            let mode = FogMode::ALL[mode];
            let d = if below && mode == FogMode::LinearAbs { -d } else { d };
            for evaluation in [FogEvaluation::PerVertex, FogEvaluation::PerPixel] {
                let function = if mode.is_linear() {
                    linear(mode, start, start + span, evaluation).expect("finite")
                } else {
                    exponential(mode, density, evaluation)
                };
                if mode == FogMode::LinearAbs && evaluation == FogEvaluation::PerVertex {
                    continue;
                }
                let exact = text(mode, d.into(), start.into(), (start + span).into(), density.into());
                let factor = factor(&function, d);
                // 14 bits of each of the three terms, which may be 2 + 50 - 50.
                let off = if mode.is_linear() { 2.0_f64.powi(-12) * (2.0 + f64::from(start + d.abs()) / f64::from(span)) } else { 0.0 };
                prop_assert!((factor - exact).abs() < 2.0 / 255.0 + off, "{factor} {exact}");
            }
        }

        /// Bit 10 is a copy of bit 11, and everything below it is 0.
        #[test]
        fn nv10_passes_twelve_bits_and_a_copy(p0 in any::<f32>(), p1 in any::<f32>(), p2 in any::<f32>(), d in any::<f32>()) {
            let function = FogFunction { mode: FogMode::Exp, p0, p1, p2, per_vertex: true };
            let (e, old) = (passed(&function, Profile::Nv2a, d), passed(&function, Profile::Nv10, d));
            prop_assert_eq!(e.is_finite(), old.is_finite());
            if e.is_finite() {
                prop_assert_eq!((old.to_bits() & 0x3ff, old.to_bits() >> 10 & 1), (0, old.to_bits() >> 11 & 1));
                prop_assert_eq!(old.to_bits() >> 11, e.to_bits() >> 11);
            }
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
            // Values that differ by more than 14 bits of d resolve.
            let around = [end - 0.01 - end.abs() * 1e-3, end, end + 0.01 + end.abs() * 1e-3];
            let near = f64::from(f32::from_bits(light::word(end.to_bits()))) < f64::from(end);
            let factors = around.map(|d| factor(&function(FogEvaluation::PerPixel), d));
            assert_eq!(factors, [1.0, if near { 1.0 } else { 0.0 }, 0.0], "{end}");
            let factors = around.map(|d| factor(&function(FogEvaluation::PerVertex), d));
            assert_eq!(factors, [0.0; 3], "{end}");
        }
        let of_pixels = |start, end| linear(FogMode::Linear, start, end, FogEvaluation::PerPixel);
        assert_eq!(of_pixels(0.0, 1e-45), None);
        assert_eq!(of_pixels(3e38, -3e38), None);
        assert_eq!(of_pixels(1e30, 1e30), None);
        // With the ends swapped the fog lifts.
        let lifting = of_pixels(24.0, 16.0).expect("finite");
        assert_eq!([0.0, 16.0, 20.0, 24.0, 30.0].map(|d| factor(&lifting, d)), [0.0, 0.0, 127.0 / 255.0, 1.0, 1.0]);
    }
}
