//! Declares the fields of what the vertex side computes: fog, generated coordinates, and sizes of points.

use super::*;
use ninebit::vertex::fog::{FogEvaluation, FogSource};

source! {
    /// How the size of a point depends on its distance.
    struct PointParameters {
        /// `(A, B, C)`: the factor is 1 / sqrt(A + B D + C D^2), D the distance from the viewer in eye space (`model_view`)
        attenuation: Numbers [numbers 3..=3, "an attenuation"] = [1.0, 0.0, 0.0, 0.0],
        /// added to the factor, which is then limited to 0..1
        bias: f32 = 0.0,
        /// in pixels: the size is the factor times `range`, and `smallest`
        range: f32 = 1.0, smallest: f32 = 0.0,
    }
    struct Fog {
        /// `false`: the factor is 1
        enabled: bool = true,
        /// red, green and blue of the fog register
        color: Color [color] = [0; 4],
        /// the function: those with Abs of the coordinate's or the exponent's magnitude; `LinearAbs` on Nv2a
        mode: Name<state::FogMode> [or "none: factors of the vertices"],
        /// of the exponential modes: e^(-density d), or e^(-(density d)^2)
        density: f32 = 1.0,
        /// of the linear modes: coordinates without fog and of nothing but fog. The same for both: none before, all from there on; evaluated at vertices,
        /// nothing but fog
        start: f32 = 0.0, end: f32 = 1.0,
        /// instead of these: `(p0, p1)` or `(p0, p1, p2)`, c0, c1 and c2 of FOG-3, as the chip has them; linear fog with `PerPixel` has no p2
        parameters: Numbers [numbers 2..=3, "the parameters of fog"],
        /// `fog_coordinate` of listed vertices; z in eye space, negative before an OpenGL viewer, or its magnitude; distance from the viewer; z and w as
        /// `matrix` leaves them, of `Window` vertices as written
        coordinate_source: Name<FogSource> = FogSource::Vertex,
        /// where linear fog applies its parameters; the exponential modes always apply them to the vertices and look up the curve at the pixel
        evaluation: Name<FogEvaluation> [or "`PerPixel` on Nv2a, `PerVertex`, the only one, on Nv10"],
    }
    struct CoordinateSet {
        /// the given set from which components without a generator come
        input: u32 [or "the same set" in 0..=3, "a given coordinate set"],
        /// a generator for the component
        s: Generator [or "as given"], t: Generator [or "as given"], r: Generator [or "as given"], q: Generator [or "as given"],
    }
    struct Emboss "emboss" {
        /// its direction, in eye space
        light: Numbers [required numbers 3..=3, "the direction of a light"],
        /// `(ks, kt)`
        scale: Numbers [required numbers 2..=2, "a scale"],
    }
}
