//! TEX-9 to TEX-11: how small a texture appears, and which levels are read for it.

use super::planned::PlannedUnit;
use crate::state::{Filter, MipFilter};

/// The lod where nothing is known, or a texture has no extent on the screen: the magnification side of everything.
pub const LEAST: i32 = -32768;

/// u and v of the top-left pixel of a quad, of its right and of its lower neighbour, in 1/65536 texel of level 0.
pub type Quad = [[i64; 2]; 3];

/// Coordinates beyond this are as far away as any, 1/65536 texel.
const FARTHEST: i64 = 1 << 60;

/// TEX-11, TEX-10: 256 log2 of the larger of the two lengths, in texels, by which the coordinates move from the top-left pixel to its right
/// and its lower neighbour; floored. `None`: a pixel of the quad lies behind the viewer.
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
    // Squares are in 2^-32 texel^2, and log2 of a length is half of that of its square.
    log2_128(largest) - 128 * 32
}

/// floor(128 log2 n), n > 0: the exponent, then seven bits by squaring the mantissa.
fn log2_128(n: u128) -> i32 {
    let exponent = 127 - n.leading_zeros() as i32;
    // 1.0 to 2.0 with 63 fraction bits. A power of two stays exactly 1.0.
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

/// The ideal's log2 of the same ratio, of s and t at the quad, in 256ths; sides in texels.
#[allow(clippy::float_arithmetic, reason = "the ideal's lod")]
pub fn real_log2_ratio(quad: Option<[[f64; 2]; 3]>, sides: [u32; 2]) -> f64 {
    let Some([origin, right, lower]) = quad else { return f64::from(LEAST) };
    let squared = |p: [f64; 2]| {
        let along = |n: usize| (p[n] - origin[n]) * f64::from(sides[n]);
        along(0) * along(0) + along(1) * along(1)
    };
    (128.0 * squared(right).max(squared(lower)).log2()).max(f64::from(LEAST))
}

/// [`biased`] for the ideal.
#[allow(clippy::float_arithmetic, reason = "the ideal's lod")]
pub fn real_biased(unit: &PlannedUnit, log2_ratio: f64) -> f64 {
    let state = &unit.state;
    (log2_ratio + f64::from(state.lod_bias)).max(f64::from(state.min_lod)).min(f64::from(state.max_lod))
}

/// What is read for a lod.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Filter within a level.
    pub filter: Filter,
    /// The level that is read first, 0 the largest.
    pub level: usize,
    /// The level that is mixed in, and its weight, 0..=255.
    pub next: Option<(usize, i32)>,
}

impl Choice {
    /// A number for each choice of filter and levels.
    pub fn code(&self) -> i64 {
        let next = self.next.map_or(0, |(next, _)| next as i64 + 1);
        next << 16 | (self.level as i64) << 8 | self.filter as i64
    }
}

/// TEX-9: bias, then the limits.
pub fn biased(unit: &PlannedUnit, log2_ratio: i32) -> i32 {
    Selection::from_unit(unit).biased(log2_ratio)
}

/// TEX-9: filter and levels for a lod in 1/256.
pub fn choose(unit: &PlannedUnit, lod: i32) -> Choice {
    let state = &unit.state;
    if lod <= 0 {
        return Choice { filter: state.mag_filter, level: 0, next: None };
    }
    let (level, next, weight) = levels(unit, lod);
    let next = (next != level).then_some((next as usize, weight));
    Choice { filter: state.min_filter, level: level as usize, next }
}

/// TEX-9: the level, the one that is mixed in, which may be the same, and its weight, 0..=255, for a lod that is not negative.
pub fn levels(unit: &PlannedUnit, lod: i32) -> (i32, i32, i32) {
    Selection::from_unit(unit).levels(lod)
}

/// What of a unit selects levels, as numbers: a loop over lanes that compares or branches by a filter would not become one over vectors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Selection {
    bias: i32,
    min_lod: i32,
    max_lod: i32,
    /// The last level.
    last: i32,
    /// What is added to a lod before its fraction is cut off.
    rounding: i32,
    /// By how many levels what is mixed in lies further.
    step: i32,
    /// The bits of a lod that make the weight.
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

    /// [`biased`].
    #[inline(always)]
    pub(crate) fn biased(self, log2_ratio: i32) -> i32 {
        (log2_ratio + self.bias).max(self.min_lod).min(self.max_lod)
    }

    /// [`levels`].
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
            // A hair less is below.
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
