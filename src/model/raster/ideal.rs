//! Interpolation of the ideal: the same sample of the same snapped triangle, in float64 and without rounding.
#![allow(clippy::float_arithmetic, reason = "the real-number reference; it never feeds a stored byte")]

use super::fog::not_finite;
use super::setup::{EVERYWHERE, Triangle};
use super::stroke::Figure;
use crate::state::{DepthFormat, DepthTest, FogFunction, FogMode, PolygonOffset, VertexDepths};

/// Returns the barycentric weights of the three vertices at a sample, perspective-corrected by the vertices' w if
/// `perspective` is set.
pub fn barycentrics(triangle: &Triangle, e: [i64; 3], w: [f32; 3], perspective: bool) -> [f64; 3] {
    let weighted: [f64; 3] = std::array::from_fn(|k| {
        let e = e[k] as f64;
        if perspective { e / f64::from(w[k]) } else { e }
    });
    let sum = if perspective { weighted[0] + weighted[1] + weighted[2] } else { triangle.doubled_area as f64 };
    weighted.map(|e| e / sum)
}

/// Returns the weights that are linear on the screen, from those that [`barycentrics`] returned.
pub(crate) fn linear(weights: [f64; 3], w: [f32; 3], perspective: bool) -> [f64; 3] {
    if !perspective {
        return weights;
    }
    let weighted: [f64; 3] = std::array::from_fn(|k| weights[k] * f64::from(w[k]));
    let sum = weighted[0] + weighted[1] + weighted[2];
    weighted.map(|e| e / sum)
}

/// Returns the weighted sum of the vertices' values.
pub fn mix(weights: [f64; 3], values: [f64; 3]) -> f64 {
    weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2]
}

/// Returns the weighted sum of the vertices' values, limited to what they are. Without a sum it is the first.
pub(crate) fn limited_mix(weights: [f64; 3], values: [f64; 3]) -> f64 {
    let sum = mix(weights, values);
    let [least, most] = [f64::min, f64::max].map(|of| values.into_iter().fold(values[0], of));
    if sum.is_nan() { values[0] } else { sum.clamp(least, most) }
}

/// Returns a channel of a vertex colour in 255ths, limited to 0..1 but not rounded.
pub(crate) fn color_channel(color: &crate::state::VertexColor, channel: usize) -> f64 {
    match color {
        crate::state::VertexColor::Bytes(bytes) => f64::from(bytes[channel]),
        crate::state::VertexColor::Floats(floats) => f64::from(floats[channel]).clamp(0.0, 1.0) * 255.0,
    }
}

/// Returns a coordinate divided by q, or 0 for 0/0.
pub(crate) fn quotient(coordinate: f64, q: f64) -> f64 {
    let quotient = coordinate / q;
    if quotient.is_nan() { 0.0 } else { quotient }
}

/// Returns 255 times the fog factor: interpolated from factors of the vertices, or the function of their coordinates
/// without rounding. e is p0 + p1 d + p2 d^2 at the vertices, or the value that they pass if the coordinate is not
/// known.
pub(crate) fn fog(function: &Option<FogFunction>, weights: [f64; 3], passed: [f32; 3], known: [Option<f32>; 3]) -> f64 {
    let Some(function) = function else {
        // Outside of the triangle it may leave 0..1 (SMO-2).
        return 255.0 * mix(weights, passed.map(|f| f64::from(super::fog::limited(f)))).clamp(0.0, 1.0);
    };
    let mode = function.mode;
    let vertices: [f64; 3] = std::array::from_fn(|k| fog_of_vertex(function, passed[k], known[k]));
    let (p0, p1) = if function.per_vertex { (0.0, 1.0) } else { (f64::from(function.p0), f64::from(function.p1)) };
    let finite = passed.iter().all(|n| n.is_finite()) && vertices.iter().all(|n| n.is_finite());
    if !finite || (mode.is_linear() && !(p0.is_finite() && p1.is_finite())) {
        return f64::from(not_finite(mode));
    }
    let x = mix(weights, vertices);
    let above = x - 1.5;
    let factor = match mode {
        FogMode::Linear => p0 + p1 * x - 1.0,
        FogMode::LinearAbs => p0 + p1 * x.abs() - 1.0,
        // Where the table ends, at 2^-8, fog is complete.
        FogMode::Exp if above <= -0.5 => 0.0,
        FogMode::ExpAbs if above.abs() >= 0.5 => 0.0,
        FogMode::Exp => power_of_two(16.0 * above),
        FogMode::ExpAbs => power_of_two(-16.0 * above.abs()),
        FogMode::Exp2 | FogMode::Exp2Abs => power_of_two(-32.0 * above * above),
    };
    255.0 * factor.clamp(0.0, 1.0)
}

/// Returns the value that a vertex would pass without rounding: d, or p0 + p1 d + p2 d^2.
pub fn fog_of_vertex(function: &FogFunction, passed: f32, coordinate: Option<f32>) -> f64 {
    match coordinate.map(f64::from) {
        None => f64::from(passed),
        Some(d) if !function.takes_e() => d,
        Some(d) => {
            let square = if function.p2 == 0.0 { 0.0 } else { f64::from(function.p2) * d * d };
            f64::from(function.p0) + f64::from(function.p1) * d + square
        }
    }
}

/// Returns 2^x by a series, so that every machine computes the same bits. x is limited to -64..=16. The relative error
/// is below 2^-51.
pub(crate) fn power_of_two(x: f64) -> f64 {
    let x = x.clamp(-64.0, 16.0);
    let whole = (x + 0.5).floor();
    let t = (x - whole) * std::f64::consts::LN_2;
    // |t| < 0.35, so the first term that is left out is below 2^-60.
    let series = (1..=16).rev().fold(1.0, |sum, n| 1.0 + sum * t / f64::from(n));
    series * f64::from_bits(((1023 + whole as i64) as u64) << 52)
}

/// Returns the depth in words of a buffer. If the buffer holds floats, values between two words are fractions between
/// them.
pub(crate) fn depth(
    weights: [f64; 3],
    (z, w): ([f32; 3], [f32; 3]),
    test: &DepthTest,
    format: DepthFormat,
    triangle: &Triangle,
) -> f64 {
    let full = f64::from(format.largest());
    let fractions = test.vertex_depths == VertexDepths::Fractions && !format.is_float();
    let offset = if triangle.figure == Figure::Triangle { test.offset } else { PolygonOffset::default() };
    let z = z.map(|z| if fractions { f64::from(z).clamp(0.0, 1.0) * full } else { f64::from(z) });
    if test.w_buffer {
        let depth = 1.0 / mix(weights, w.map(|w| 1.0 / f64::from(w))) + f64::from(offset.bias);
        let range = test.range.map_or((f64::NEG_INFINITY, f64::INFINITY), |r| (r.lowest.into(), r.highest.into()));
        return in_words(format, depth.max(range.0).min(range.1));
    }
    let along = |edges: [i64; 3]| mix(edges.map(|edge| edge as f64), z).abs() / triangle.doubled_area as f64;
    let slope = along(triangle.a).max(along(triangle.b));
    let mut depth = mix(weights, z) + f64::from(offset.bias) + f64::from(offset.factor) * slope;
    if let Some(range) = test.range {
        depth = depth.max(f64::from(range.lowest)).min(f64::from(range.highest));
    }
    in_words(format, depth)
}

/// Converts a depth in steps to words of a buffer, including fractions between words.
pub(crate) fn in_words(format: DepthFormat, depth: f64) -> f64 {
    let full = f64::from(format.largest());
    if !format.is_float() {
        return depth.clamp(0.0, full);
    }
    let (kept, bias) = if format == DepthFormat::Z16F { (12, 7) } else { (16, 127) };
    // The pattern of a double counts words of more bits on the same scale. Below the smallest normal number of the
    // format nothing is kept.
    let pattern = depth.max(0.0).to_bits() as f64 / (1_u64 << (52 - kept)) as f64;
    let word = pattern - f64::from((1023 - bias) << kept);
    if word < f64::from(1 << kept) { 0.0 } else { word.min(full) }
}

/// A triangle before its vertices are snapped, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// Coefficients of the edge functions: x, y and constant. They are positive inside.
    edges: [[f64; 3]; 3],
    /// Whether samples on each edge belong to the triangle: left edges and horizontal top edges.
    owns: [bool; 3],
    /// Reciprocals of the vertices' w, or 1 without perspective.
    reciprocals: [f64; 3],
    /// Half-open range of the rows whose centres it may cover.
    pub rows: (i64, i64),
    /// Whether it turns counter-clockwise on the screen.
    pub counter_clockwise: bool,
}

impl Outline {
    /// Sets up the outline from window positions. Returns `None` if it has no area.
    pub fn new(positions: [[f32; 4]; 3], perspective: bool) -> Option<Outline> {
        let [x, y] = [0, 1].map(|n| positions.map(|p| f64::from(p[n])));
        let mut edges = [[0.0; 3]; 3];
        let mut area = 0.0;
        for k in 0..3 {
            let (s, t) = ((k + 1) % 3, (k + 2) % 3);
            let (a, b) = (y[s] - y[t], x[t] - x[s]);
            edges[k] = [a, b, -(a * x[s] + b * y[s])];
            area = a * x[k] + b * y[k] + edges[k][2];
        }
        if area == 0.0 || !area.is_finite() {
            return None;
        }
        let edges = edges.map(|edge| edge.map(|n| n * area.signum()));
        let (low, high) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
        let rows = ((low - 0.5).floor() as i64, (high - 0.5).ceil() as i64 + 1);
        // RAS-8, as the triangle has it.
        let behind = positions.map(|p| p[3] < 0.0);
        let inside = [0, 1, 2].map(|k| if behind[k] { edges[k].map(|n| -n) } else { edges[k] });
        Some(Outline {
            edges: inside,
            owns: inside.map(|[a, b, _]| a > 0.0 || (a == 0.0 && b > 0.0)),
            reciprocals: positions.map(|p| if perspective { 1.0 / f64::from(p[3]).abs() } else { 1.0 }),
            rows: if behind == [false; 3] { rows } else { EVERYWHERE },
            counter_clockwise: (area < 0.0) ^ behind[0] ^ behind[1] ^ behind[2],
        })
    }

    fn at(&self, i: i64, j: i64) -> [f64; 3] {
        self.edges.map(|[a, b, c]| a * (i as f64 + 0.5) + b * (j as f64 + 0.5) + c)
    }

    fn covers(&self, i: i64, j: i64) -> bool {
        let e = self.at(i, j);
        (0..3).all(|k| e[k] > 0.0 || (e[k] == 0.0 && self.owns[k]))
    }

    /// Returns the columns of row j that it covers, as a half-open range within `columns`.
    pub fn span(&self, j: i64, columns: (i64, i64)) -> (i64, i64) {
        let (mut low, mut high) = (columns.0 as f64, columns.1 as f64);
        for [a, b, c] in self.edges {
            let zero = -(b * (j as f64 + 0.5) + c) / a - 0.5;
            if a > 0.0 {
                low = low.max(zero);
            } else if a < 0.0 {
                high = high.min(zero);
            }
        }
        // The estimate may be off by one column on either side; the edge functions decide.
        let mut low = (low.floor() as i64 - 1).max(columns.0);
        let mut high = (high.ceil() as i64 + 2).min(columns.1);
        while low < high && !self.covers(low, j) {
            low += 1;
        }
        while low < high && !self.covers(high - 1, j) {
            high -= 1;
        }
        (low, high.max(low))
    }

    /// Returns the weights of the vertices at the centre of a covered pixel, perspective-corrected if the outline was
    /// set up with perspective.
    pub fn weights(&self, i: i64, j: i64) -> [f64; 3] {
        let e = self.at(i, j);
        let weighted: [f64; 3] = std::array::from_fn(|k| e[k] * self.reciprocals[k]);
        let sum = weighted[0] + weighted[1] + weighted[2];
        weighted.map(|e| e / sum)
    }
}

#[cfg(test)]
mod tests {
    use super::power_of_two;

    #[test]
    fn powers_are_those_of_the_library() {
        for n in -64 * 1000..=16 * 1000 {
            let x = f64::from(n) / 1000.0;
            assert!((power_of_two(x) / x.exp2() - 1.0).abs() < 5e-16, "{x}");
        }
        assert_eq!((power_of_two(-1e300), power_of_two(1e300)), (0.5_f64.powi(64), 65536.0));
    }
}
