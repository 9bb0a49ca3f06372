//! TEX-9 to TEX-11: the level of detail (lod), and the levels that are read for it.

use super::planned::PlannedUnit;
use crate::number::Integer;
use crate::state::{CompareFunction, Filter, MipFilter};

/// The lod if it is unknown, or if the texture has no extent on the screen. It always magnifies.
pub const LEAST: i32 = -32768;

/// u and v at the top-left pixel of a quad and at its right and lower neighbours, in 1/65536 texel of level 0.
pub(crate) type Quad = [[i64; 2]; 3];

/// Limit of coordinates in 1/65536 texel, beyond which all count as equally far.
const FARTHEST: i64 = 1 << 60;

/// TEX-11, TEX-10: returns floor(256 log2) of the larger distance in texels from the coordinates of the top-left pixel
/// to those of its right and lower neighbours. `quad` is `None` if one of its pixels lies behind the viewer.
pub fn log2_ratio(quad: Option<Quad>) -> i32 {
    quad.map_or(LEAST, |quad| log2_of_steps(quad) as i32)
}

/// [`log2_ratio`] of any whole numbers.
pub fn log2_of_steps<I: Integer>(quad: [[I; 2]; 3]) -> I {
    let [origin, right, lower] = quad.map(|p| p.map(|c| c.limited(-FARTHEST, FARTHEST)));
    let squared = |p: [I; 2]| Wide::sum_of_squares([p[0] - origin[0], p[1] - origin[1]].map(I::magnitude));
    let largest = squared(right).greatest(squared(lower));
    // Squares are in 2^-32 texel^2, and the log2 of a length is half of that of its square.
    let log = largest.log2_128() - I::new(128 * 32);
    log.or(I::new(0).is_below(largest.high + largest.low), I::new(LEAST.into()))
}

/// Number of bits of the lower half of a [`Wide`] number.
const HALF: i64 = 61;

/// Number of fraction bits of a mantissa whose logarithm is taken.
const FRACTION: i64 = 60;

/// The number `high` 2^61 + `low`, where `low` is below 2^61.
#[derive(Clone, Copy)]
struct Wide<I> {
    high: I,
    low: I,
}

impl<I: Integer> Wide<I> {
    /// Returns the sum of the squares of two numbers below 2^62.
    fn sum_of_squares(of: [I; 2]) -> Wide<I> {
        const LOW: i64 = (1 << HALF) - 1;
        let [(u1, u0), (v1, v0)] = of.map(|n| (n.down(I::new(31)), n.masked((1 << 31) - 1)));
        // high 2^62 + middle 2^32 + the squares of the lower parts.
        let high = u1 * u1 + v1 * v1;
        let middle = u1 * u0 + v1 * v0;
        let (u, v) = (u0 * u0, v0 * v0);
        let low = middle.masked((1 << 29) - 1).up(I::new(32)) + u.masked(LOW) + v.masked(LOW);
        let carried = middle.down(I::new(29)) + u.down(I::new(HALF)) + v.down(I::new(HALF)) + low.down(I::new(HALF));
        Wide { high: high + high + carried, low: low.masked(LOW) }
    }

    fn greatest(self, other: Wide<I>) -> Wide<I> {
        let same = self.high.compared(CompareFunction::Equal, other.high);
        let is_below = self.high.is_below(other.high) | (same & self.low.is_below(other.low));
        Wide { high: other.high.or(is_below, self.high), low: other.low.or(is_below, self.low) }
    }

    /// Returns floor(128 log2 n) for n > 0: the exponent, then seven bits by squaring the mantissa.
    fn log2_128(self) -> I {
        let one = I::new(1);
        let is_low = self.high.is_zero();
        let upper = self.low.or(is_low, self.high);
        let length = (upper.bits() - one).greatest(I::new(0));
        let exponent = length + I::new(0).or(is_low, I::new(HALF));
        // 1.0 to 2.0 with its fraction bits. A power of two is exactly 1.0.
        let up = I::new(FRACTION) - length;
        let below = self.low.down((I::new(HALF) - up).limited(0, 63)).or(!is_low, I::new(0));
        let shifted =
            upper.down((I::new(0) - up).limited(0, 63)).or(up.is_negative(), upper.up(up.greatest(I::new(0))));
        let mut mantissa = (shifted + below).within(0, (2 << FRACTION) - 1);
        let mut log = exponent;
        for _ in 0..7 {
            let (high, low) = (mantissa.down(I::new(30)), mantissa.masked((1 << 30) - 1));
            let cross = high * low;
            let square = high * high + (cross + cross + (low * low).down(I::new(30))).down(I::new(30));
            let bit = square.down(I::new(FRACTION + 1));
            mantissa = square.down(bit);
            log = log + log + bit;
        }
        log
    }
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
pub struct Selection<I = i32> {
    bias: I,
    min_lod: I,
    max_lod: I,
    /// The index of the last level.
    last: I,
    /// Number that is added to a lod before its fraction is dropped.
    rounding: i64,
    /// Distance of the second level from the first.
    step: i64,
    /// Mask of the bits of a lod that are the weight.
    fraction: i64,
}

impl Selection {
    /// Returns the numbers of a unit.
    pub fn from_unit(unit: &PlannedUnit) -> Selection {
        let state = &unit.state;
        Selection::new(state.mip_filter, unit.levels.len() as i32 - 1, [state.lod_bias, state.min_lod, state.max_lod])
    }
}

impl<I: Integer> Selection<I> {
    /// Returns the numbers of a unit whose last level is `last`, with its bias, least and largest lod.
    pub fn new(filter: MipFilter, last: I, [bias, min_lod, max_lod]: [I; 3]) -> Selection<I> {
        let (last, rounding, step, fraction) = match filter {
            MipFilter::None => (I::new(0), 0, 0, 0),
            MipFilter::Nearest => (last, 128, 0, 0),
            MipFilter::Linear => (last, 0, 1, 255),
        };
        Selection { bias, min_lod, max_lod, last, rounding, step, fraction }
    }

    /// Like [`biased`], for a unit whose state is set up.
    #[inline(always)]
    pub fn biased(self, log2_ratio: I) -> I {
        (log2_ratio + self.bias).greatest(self.min_lod).least(self.max_lod)
    }

    /// Like `levels`, for a unit whose state is set up.
    #[inline(always)]
    pub fn levels(self, lod: I) -> (I, I, I) {
        let level = (lod + I::new(self.rounding)).down(I::new(8));
        (level.least(self.last), (level + I::new(self.step)).least(self.last), lod.masked(self.fraction))
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
        for n in 1..20_000_i64 {
            let log = Wide { high: 0, low: n }.log2_128();
            let exact = 128.0 * (n as f64).log2();
            assert!((exact - log as f64) > -1e-9 && exact - (log as f64) < 1.0, "{n}: {log} {exact}");
            // A power of two above.
            for shift in 1..108 {
                let wide = i128::from(n) << shift;
                let (high, low) = ((wide >> HALF) as i64, (wide & ((1 << HALF) - 1)) as i64);
                assert_eq!(Wide { high, low }.log2_128(), log + 128 * shift, "{n} {shift}");
            }
        }
    }

    #[test]
    fn squares_are_exact() {
        let mut random = crate::random::Random::seeded(3);
        for n in 0..10_000 {
            let of: [i64; 2] = [0, 1].map(|_| (random.bits() >> (3 + n % 60)) as i64);
            let Wide { high, low } = Wide::sum_of_squares(of);
            let [u, v] = of.map(i128::from);
            assert_eq!((i128::from(high) << HALF) + i128::from(low), u * u + v * v);
        }
    }

    #[test]
    fn no_extent_and_behind() {
        assert_eq!((log2_ratio(None), log2_ratio(Some([[5, 5]; 3]))), (LEAST, LEAST));
        assert_eq!(log2_ratio(Some([[i64::MIN, 0], [i64::MAX, 0], [0, 0]])), 256 * 45);
    }
}
