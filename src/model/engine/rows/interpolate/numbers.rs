//! TSH-4, TSH-9 and TSH-10 on rows: numbers that a texture shader takes as numbers.
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly")]

use super::LaneWeights;
use crate::engine::rows::lanes::floor_within;
use crate::number::convert::factor;
use crate::raster::weights::Linear;

/// The use of an interpolated number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// Input of the dot unit: the nearest single-precision number.
    Float,
    /// Only its sign counts (TSH-10), which rounding may not change: 0, or -1.
    Sign,
    /// Colour channel (TSH-9): a byte.
    Byte,
}

impl Purpose {
    /// Returns what a number becomes.
    #[inline(always)]
    pub(crate) fn take(self, f: f64) -> f32 {
        match self {
            // Zero is positive.
            Purpose::Float => (f + 0.0) as f32,
            Purpose::Sign => {
                if f < 0.0 {
                    -1.0
                } else {
                    0.0
                }
            }
            Purpose::Byte => factor(floor_within(4096.0 * f, 0.0, 4096.0)) as f32,
        }
    }
}

/// Computes a number in each lane.
#[inline(always)]
pub(crate) fn numbers(purpose: Purpose, number: &Linear<f64>, weights: LaneWeights<'_>, out: &mut [f32]) {
    match purpose {
        Purpose::Float => weights.each(number, out, |f| Purpose::Float.take(f)),
        Purpose::Sign => weights.each(number, out, |f| Purpose::Sign.take(f)),
        Purpose::Byte => weights.each(number, out, |f| Purpose::Byte.take(f)),
    }
}
