//! Vectors of three float64 numbers, for meshes, generated textures and the truth.
#![allow(clippy::float_arithmetic, reason = "of vertices, generators and the truth; no pixel's integers")]

/// A vector x, y, z.
pub type Vector = [f64; 3];

/// Converts a vector of f32 to f64.
pub(crate) fn wide(v: [f32; 3]) -> Vector {
    v.map(f64::from)
}

/// Returns a + b.
pub(crate) fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Returns a - b.
pub(crate) fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Returns the dot product.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the cross product a x b.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns v with every component multiplied by a factor.
pub(crate) fn scaled(v: Vector, by: f64) -> Vector {
    v.map(|c| c * by)
}

/// Returns the vector of unit length; `None` if it is so short that it is zero compared with `scale`.
pub(crate) fn unit(v: Vector, scale: f64) -> Option<Vector> {
    let length = dot(v, v).sqrt();
    (length > scale * 1e-12).then(|| v.map(|c| c / length))
}

/// Returns the vector of unit length; the zero vector stays zero.
pub fn unit_or_zero(v: Vector) -> Vector {
    unit(v, 1.0).unwrap_or([0.0; 3])
}
