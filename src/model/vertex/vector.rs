//! Vector operations with sums in a fixed order, and directions.
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

/// Returns a . b, adding from left to right.
pub fn dot3(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns a . b, adding from left to right.
pub fn dot4(a: [f32; 4], b: [f32; 4]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// Returns a x b.
pub fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the largest magnitude of the components, and the vector divided by it, whose length is between 1 and the
/// square root of 3. Returns `None` if the vector is zero or not finite.
fn scaled(v: [f32; 3]) -> Option<(f32, [f32; 3])> {
    let largest = v[0].abs().max(v[1].abs()).max(v[2].abs());
    let usable = largest > 0.0 && v.iter().all(|c| c.is_finite());
    usable.then(|| (largest, v.map(|c| c / largest)))
}

/// Returns the direction of a vector, of unit length, or zero if it has none. No square overflows or underflows to
/// zero.
pub fn unit(v: [f32; 3]) -> [f32; 3] {
    let Some((_, v)) = scaled(v) else { return [0.0; 3] };
    let length = dot3(v, v).sqrt();
    v.map(|c| c / length)
}

/// Returns the length of a vector, or 0 if it is not finite.
pub fn length(v: [f32; 3]) -> f32 {
    scaled(v).map_or(0.0, |(largest, v)| largest * dot3(v, v).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_of_all_sizes() {
        for size in [1e-44_f32, 1e-30, 1.0, 1e30, 3e38] {
            let v = unit([size, 0.0, -size]);
            assert!((v[0] - 0.5_f32.sqrt()).abs() < 1e-6 && v[1] == 0.0 && v[2] == -v[0], "{size} {v:?}");
            assert!((length([0.0, size, 0.0]) - size).abs() <= size * 1e-7);
        }
        assert_eq!(unit([0.0; 3]), [0.0; 3]);
        assert_eq!(unit([f32::NAN, 1.0, 0.0]), [0.0; 3]);
        assert_eq!(unit([f32::INFINITY, 1.0, 0.0]), [0.0; 3]);
        assert_eq!(length([0.0; 3]), 0.0);
    }
}
