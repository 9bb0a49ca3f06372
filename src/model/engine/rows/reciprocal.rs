//! DEP-1's reciprocals across a triangle.
#![allow(clippy::float_arithmetic, reason = "each value is compared with the definition's before it is used")]

use super::quotient::{multiply_add, whole};
use crate::raster::depth::reciprocal;

/// DEP-1's reciprocals of a triangle as a linear function. The three edge numbers add up to the doubled area, less the few last bits that
/// each loses when it is cut to 24 bits. So the reciprocal is a function of a sum that hardly varies.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ReciprocalLine {
    pub(super) area: i64,
    /// Whether the function yields every reciprocal of the triangle.
    pub(super) tells: bool,
    /// The value of a sum of 0, less by 3/16 and one half, so that the nearest integer is the reciprocal; if nothing is lost, it is the
    /// reciprocal itself.
    start: f64,
    slope: f64,
    /// Factor that turns edge numbers times reciprocals into weights.
    pub(super) unit: f64,
}

impl ReciprocalLine {
    pub(super) fn new<const FMA: bool>(area: i64) -> ReciprocalLine {
        let bits = 64 - area.leading_zeros();
        let mut line = ReciprocalLine { area, ..ReciprocalLine::default() };
        // Edge numbers with more bits would be cut again when they are aligned.
        if bits > 29 {
            return line;
        }
        line.unit = power_of_two(-28 - bits as i32);
        let (largest_loss, real) = (3 * ((1_i64 << bits.saturating_sub(24)) - 1), area as f64);
        let first = (1_u64 << (28 + bits)) as f64 / real;
        (line.start, line.slope) =
            if largest_loss == 0 { (bits_of_reciprocal(area), 0.0) } else { (2.0 * first - 0.6875, -first / real) };
        // Compares each value with the definition's.
        let tells =
            |sum: i64| 64 - sum.leading_zeros() == bits && line.at::<FMA>(sum as f64) == bits_of_reciprocal(sum);
        line.tells = (area - largest_loss..=area).all(tells);
        line
    }

    /// Returns the reciprocal of a sum.
    #[inline(always)]
    pub(super) fn at<const FMA: bool>(&self, sum: f64) -> f64 {
        whole(multiply_add::<FMA>(sum, self.slope, self.start))
    }
}

/// Returns the mantissa of DEP-1's reciprocal of a sum, with as many bits if the reciprocal is exact.
#[inline(always)]
pub(super) fn bits_of_reciprocal(sum: i64) -> f64 {
    if sum & (sum - 1) == 0 { (1_u64 << 29) as f64 } else { reciprocal(sum).0 as f64 }
}

/// Returns 2^exponent, or 0 or infinity if no double has that value.
pub(super) fn power_of_two(exponent: i32) -> f64 {
    match exponent {
        -1022..=1023 => f64::from_bits(((exponent + 1023) as u64) << 52),
        1024.. => f64::INFINITY,
        _ => 0.0,
    }
}
