//! TEX-9 to TEX-11: the level of detail (lod), and the levels that are read for it.

use super::planned::PlannedUnit;
use crate::state::{Filter, MipFilter};

/// The lod if it is unknown, or if the texture has no extent on the screen. It always magnifies.
pub(crate) const LEAST: i32 = -32768;

/// u and v at the top-left pixel of a quad and at its right and lower neighbours, in 1/65536 texel of level 0.
pub(crate) type Quad = [[i64; 2]; 3];

/// Limit of coordinates in 1/65536 texel, beyond which all count as equally far.
const FARTHEST: i64 = 1 << 60;

/// TEX-11, TEX-10: returns floor(256 log2) of the larger distance in texels from the coordinates of the top-left pixel
/// to those of its right and lower neighbours. `quad` is `None` if one of its pixels lies behind the viewer.
pub fn log2_ratio(quad: Option<Quad>) -> i32 {
    let Some(quad) = quad else { return LEAST };
    let [origin, right, lower] = quad.map(|p| p.map(|c| i128::from(c.clamp(-FARTHEST, FARTHEST))));
    let squared = |p: [i128; 2]| {
        let (u, v) = (p[0] - origin[0], p[1] - origin[1]);
        (u * u + v * v).unsigned_abs()
    };
    let largest = squared(right).max(squared(lower));
    if largest == 0 {
        return LEAST;
    }
    // Squares are in 2^-32 texel^2, and the log2 of a length is half of that of its square.
    log2_128(largest) - 128 * 32
}

/// Returns floor(128 log2 n) for n > 0: the exponent, then seven bits by squaring the mantissa.
fn log2_128(n: u128) -> i32 {
    let exponent = 127 - n.leading_zeros() as i32;
    // 1.0 to 2.0 with 63 fraction bits. A power of two is exactly 1.0.
    let mut mantissa = if exponent > 63 { n >> (exponent - 63) } else { n << (63 - exponent) };
    let mut log = exponent;
    for _ in 0..7 {
        let square = mantissa * mantissa;
        let bit = (square >> 127) as i32;
        mantissa = square >> if bit == 1 { 64 } else { 63 };
        log = 2 * log + bit;
    }
    log
}

/// Returns the ideal's log2 ratio in 256ths, from s and t at the quad and the texture's sides in texels.
#[allow(clippy::float_arithmetic, reason = "the ideal's lod")]
pub(crate) fn real_log2_ratio(quad: Option<[[f64; 2]; 3]>, sides: [u32; 2]) -> f64 {
    let Some([origin, right, lower]) = quad else { return f64::from(LEAST) };
    let squared = |p: [f64; 2]| {
        let along = |n: usize| (p[n] - origin[n]) * f64::from(sides[n]);
        along(0) * along(0) + along(1) * along(1)
    };
    (128.0 * squared(right).max(squared(lower)).log2()).max(f64::from(LEAST))
}

/// [`biased`] for the ideal.
#[allow(clippy::float_arithmetic, reason = "the ideal's lod")]
pub(crate) fn real_biased(unit: &PlannedUnit, log2_ratio: f64) -> f64 {
    let state = &unit.state;
    (log2_ratio + f64::from(state.lod_bias)).max(f64::from(state.min_lod)).min(f64::from(state.max_lod))
}

/// The filter and the levels that are read for a lod.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Filter within a level.
    pub filter: Filter,
    /// The first level that is read. 0 is the largest.
    pub level: usize,
    /// The second level if levels are interpolated, and its weight, 0..=255.
    pub next: Option<(usize, i32)>,
}

impl Choice {
    /// Returns a number that identifies the filter and the levels.
    pub(crate) fn code(&self) -> i64 {
        let next = self.next.map_or(0, |(next, _)| next as i64 + 1);
        next << 16 | (self.level as i64) << 8 | self.filter as i64
    }
}

/// TEX-9: adds the bias to a lod, then applies the limits.
pub fn biased(unit: &PlannedUnit, log2_ratio: i32) -> i32 {
    Selection::from_unit(unit).biased(log2_ratio)
}

/// TEX-9: returns filter and levels for a lod in 1/256.
pub fn choose(unit: &PlannedUnit, lod: i32) -> Choice {
    let state = &unit.state;
    if lod <= 0 {
        return Choice { filter: state.mag_filter, level: 0, next: None };
    }
    let (level, next, weight) = levels(unit, lod);
    let next = (next != level).then_some((next as usize, weight));
    Choice { filter: state.min_filter, level: level as usize, next }
}

/// TEX-9: returns the level, the second level (which may be the same) and its weight, 0..=255, for a lod that is not
/// negative.
pub(crate) fn levels(unit: &PlannedUnit, lod: i32) -> (i32, i32, i32) {
    Selection::from_unit(unit).levels(lod)
}

/// The state of a unit that selects levels, in numbers, because a loop over lanes with comparisons or branches by
/// filters would not be vectorised.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Selection {
    bias: i32,
    min_lod: i32,
    max_lod: i32,
    /// The index of the last level.
    last: i32,
    /// Number that is added to a lod before its fraction is dropped.
    rounding: i32,
    /// Distance of the second level from the first.
    step: i32,
    /// Mask of the bits of a lod that are the weight.
    fraction: i32,
}

impl Selection {
    pub(crate) fn from_unit(unit: &PlannedUnit) -> Selection {
        let (state, last) = (&unit.state, unit.levels.len() as i32 - 1);
        let (last, rounding, step, fraction) = match state.mip_filter {
            MipFilter::None => (0, 0, 0, 0),
            MipFilter::Nearest => (last, 128, 0, 0),
            MipFilter::Linear => (last, 0, 1, 255),
        };
        let (bias, min_lod, max_lod) = (state.lod_bias, state.min_lod, state.max_lod);
        Selection { bias, min_lod, max_lod, last, rounding, step, fraction }
    }

    /// Like [`biased`], for a unit whose state is set up.
    #[inline(always)]
    pub(crate) fn biased(self, log2_ratio: i32) -> i32 {
        (log2_ratio + self.bias).max(self.min_lod).min(self.max_lod)
    }

    /// Like [`levels`], for a unit whose state is set up.
    #[inline(always)]
    pub(crate) fn levels(self, lod: i32) -> (i32, i32, i32) {
        let level = (lod + self.rounding) >> 8;
        (level.min(self.last), (level + self.step).min(self.last), lod & self.fraction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_are_exact() {
        for k in -10..20 {
            let step = if k < 0 { 65536 >> -k } else { 65536 << k };
            assert_eq!(log2_ratio(Some([[7, 7], [7 + step, 7], [7, 8]])), 256 * k);
            // A slightly smaller step is below.
            assert!(log2_ratio(Some([[7, 7], [7, 7], [7, 7 - step + 1]])) < 256 * k);
        }
    }

    #[test]
    fn others_are_floors() {
        for n in 1..20_000_u128 {
            let log = log2_128(n);
            let exact = 128.0 * (n as f64).log2();
            assert!((exact - f64::from(log)) > -1e-9 && exact - f64::from(log) < 1.0, "{n}: {log} {exact}");
        }
        assert_eq!(log2_128(u128::MAX), 128 * 128 - 1);
    }

    #[test]
    fn no_extent_and_behind() {
        assert_eq!((log2_ratio(None), log2_ratio(Some([[5, 5]; 3]))), (LEAST, LEAST));
        assert_eq!(log2_ratio(Some([[i64::MIN, 0], [i64::MAX, 0], [0, 0]])), 256 * 45);
    }
}
