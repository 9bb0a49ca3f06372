//! PNT-3: the sizes of points that the vertex side computes.
#![allow(clippy::float_arithmetic, reason = "the vertex side computes with floats")]

use crate::number::transform::twice_root_of_middle;
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
    /// Returns the size in 1/8 pixel of a point at a distance.
    pub fn size(&self, distance: f32) -> u16 {
        let [a, b, c] = self.attenuation;
        let factor = reciprocal_root(a + b * distance + c * distance * distance);
        // In doubles, which keep what the factor lacks.
        let [factor, bias, range, smallest] = [factor, self.bias, self.range, self.smallest].map(f64::from);
        eighths((factor + bias).clamp(0.0, 1.0) * range + smallest)
    }
}

/// PNT-3: returns 1 / sqrt(x) as the light unit has it: seven bits, from the first six of x's fraction and whether its exponent is odd. It is that of
/// the middle of all x with these, cut. What is no positive normal number yields infinity.
fn reciprocal_root(x: f32) -> f32 {
    if x < f32::MIN_POSITIVE || x.is_nan() {
        return f32::INFINITY;
    }
    if x == f32::INFINITY {
        return 0.0;
    }
    let exponent = (x.to_bits() >> 23) as i32 - 127;
    let root = twice_root_of_middle(x.to_bits()) / 2;
    let unit = f32::from_bits(((127 - 7 - exponent.div_euclid(2)) as u32) << 23);
    root as f32 * unit
}

/// Returns a size in pixels as eighths, cut and limited to those of the register. What is no number is 0.
pub fn eighths(size: f64) -> u16 {
    (8.0 * size).clamp(0.0, f64::from(LARGEST_SIZE)) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Within seven bits of the root, and never above it by more than half a step of x.
    #[test]
    fn roots_have_seven_bits() {
        assert_eq!(
            [1.0, 4.0, 16.0, 2.0, 0.25].map(reciprocal_root),
            [127.0 / 128.0, 127.0 / 256.0, 127.0 / 512.0, 90.0 / 128.0, 127.0 / 64.0]
        );
        for bits in (0x0080_0000..0x7f80_0000).step_by(0x1_2345) {
            let x = f32::from_bits(bits);
            let (root, exact) = (f64::from(reciprocal_root(x)), 1.0 / f64::from(x).sqrt());
            assert!((root / exact - 1.0).abs() < 1.0 / 42.0, "{x:e}: {root}");
            assert_eq!(root.to_bits() << 18, 0, "{x:e}");
        }
        assert_eq!([0.0, -1.0, 1e-40, f32::NAN].map(reciprocal_root), [f32::INFINITY; 4]);
        assert_eq!(reciprocal_root(f32::INFINITY), 0.0);
    }

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
