//! PNT-3: the sizes of points that the vertex side computes.
#![allow(clippy::float_arithmetic, reason = "the vertex side computes with floats")]

use crate::state::LARGEST_SIZE;

/// How the size of a point depends on its distance from the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointParameters {
    /// A, B and C.
    pub attenuation: [f32; 3],
    /// What is added to the factor.
    pub bias: f32,
    /// How much larger than `smallest` a point becomes, in pixels.
    pub range: f32,
    /// The smallest size, in pixels.
    pub smallest: f32,
}

impl PointParameters {
    /// Returns the size in 1/8 pixel of a point at a distance. The factor is the number below 1 / sqrt(A + B D + C D^2).
    pub fn size(&self, distance: f32) -> u16 {
        let [a, b, c] = self.attenuation;
        let factor = (1.0 / (a + b * distance + c * distance * distance).sqrt()).next_down();
        // In doubles, which keep what the factor lacks.
        let [factor, bias, range, smallest] = [factor, self.bias, self.range, self.smallest].map(f64::from);
        eighths((factor + bias).clamp(0.0, 1.0) * range + smallest)
    }
}

/// Returns a size in pixels as eighths, cut and limited to those of the register. What is no number is 0.
pub fn eighths(size: f64) -> u16 {
    (8.0 * size).clamp(0.0, f64::from(LARGEST_SIZE)) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_fall_with_distance() {
        let near = PointParameters { attenuation: [1.0, 0.0, 0.0], bias: 0.0, range: 4.0, smallest: 1.0 };
        assert_eq!(near.size(5.0), 39);
        let far = PointParameters { attenuation: [0.0, 0.0, 1.0], ..near };
        assert_eq!([far.size(0.0), far.size(0.5), far.size(4.0), far.size(1e9)], [40, 40, 15, 8]);
        assert_eq!(
            [eighths(f64::NAN), eighths(-1.0), eighths(3.99), eighths(64.0), eighths(f64::INFINITY)],
            [0, 0, 31, 511, 511]
        );
    }
}
