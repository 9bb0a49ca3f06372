//! Interpolation of the ideal: the same sample of the same snapped triangle, in float64 with nothing rounded.
#![allow(clippy::float_arithmetic, reason = "the real-number reference; it never feeds a stored byte")]

use super::interpolate::COORDINATE_LIMIT;
use super::setup::Triangle;

/// Barycentric weights of the three vertices at a sample, perspective-corrected by the vertices' w if asked for.
pub fn barycentrics(triangle: &Triangle, e: [i64; 3], w: [f32; 3], perspective: bool) -> [f64; 3] {
    let weighted: [f64; 3] = std::array::from_fn(|k| {
        let e = e[k] as f64;
        if perspective { e / f64::from(w[k]) } else { e }
    });
    let sum = if perspective { weighted[0] + weighted[1] + weighted[2] } else { triangle.doubled_area as f64 };
    weighted.map(|e| e / sum)
}

/// Weights linear on the screen, of those that [`barycentrics`] would give.
pub fn linear(weights: [f64; 3], w: [f32; 3], perspective: bool) -> [f64; 3] {
    if !perspective {
        return weights;
    }
    let weighted: [f64; 3] = std::array::from_fn(|k| weights[k] * f64::from(w[k]));
    let sum = weighted[0] + weighted[1] + weighted[2];
    weighted.map(|e| e / sum)
}

/// A quantity of the vertices at those weights.
pub fn mix(weights: [f64; 3], values: [f64; 3]) -> f64 {
    weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2]
}

/// A vertex colour channel in 255ths, limited to 0..1, not rounded.
pub fn color_channel(color: &crate::state::VertexColor, channel: usize) -> f64 {
    match color {
        crate::state::VertexColor::Bytes(bytes) => f64::from(bytes[channel]),
        crate::state::VertexColor::Floats(floats) => f64::from(floats[channel]).clamp(0.0, 1.0) * 255.0,
    }
}

/// u and v in 1/256 texel: the coordinates divided by q, times the image's sides; limited as in TEX-15, 0/0 is 0.
pub fn texel_coordinates(weights: [f64; 3], vertices: [[f32; 4]; 3], sizes: [u32; 2]) -> [f64; 2] {
    let component = |n: usize| mix(weights, vertices.map(|v| f64::from(v[n])));
    let q = component(3);
    std::array::from_fn(|axis| {
        let coordinate = component(axis) / q * 256.0 * f64::from(sizes[axis]);
        let limit = COORDINATE_LIMIT as f64;
        if coordinate.is_nan() { 0.0 } else { coordinate.clamp(-limit, limit) }
    })
}

/// 255 times a factor 0..1.
pub fn factor(weights: [f64; 3], factors: [f32; 3]) -> f64 {
    255.0 * mix(weights, factors.map(|f| f64::from(f).clamp(0.0, 1.0)))
}

/// Depth in units of the buffer's last bit.
pub fn depth(weights: [f64; 3], z: [f32; 3], full: i64) -> f64 {
    mix(weights, z.map(|z| f64::from(z).clamp(0.0, 1.0))) * full as f64
}
