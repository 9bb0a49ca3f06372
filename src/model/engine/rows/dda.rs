//! Exact quotients along a row on which the denominator does not vary: the triangle has one w, or a w that depends on y only. They advance
//! by steps of quotient and remainder. `docs/exactness.md` has the argument.
#![allow(clippy::float_arithmetic, reason = "an estimate of a quotient, which its remainder corrects")]

use super::BLOCK;
use super::color::narrow;
use super::kernels::PerLane;
use super::kernels::STEP;
use super::planes::Plane;
use super::quotient::{IOTA_REAL, break_ties, nearest};
use super::setup::{PixelBatch, Setup};
use crate::raster::setup::Triangle;
use crate::state::TEXTURE_UNITS;

/// Bound of the magnitudes of quotients.
const MAX_QUOTIENT: f64 = (1_u32 << 29) as f64;

/// Number of bits of the divisor in the remainders that lanes compare.
const BITS: u32 = 29;

/// A type that quotients are written as.
pub(super) trait FromQuotient: Copy {
    /// Converts a quotient that fits.
    fn from_quotient(quotient: i32) -> Self;
}

impl FromQuotient for i32 {
    #[inline(always)]
    fn from_quotient(quotient: i32) -> i32 {
        quotient
    }
}

impl FromQuotient for u16 {
    #[inline(always)]
    fn from_quotient(quotient: i32) -> u16 {
        quotient as u16
    }
}

/// The floor of an integer quotient, with a remainder that is not negative.
#[derive(Clone, Copy, Debug, Default)]
struct Divided {
    quotient: i32,
    remainder: i64,
}

impl Divided {
    /// Divides a numerator modulo 2^64. `real` is about the quotient, whose magnitude is below [`MAX_QUOTIENT`]. The divisor is positive.
    #[inline(always)]
    fn new(numerator: i64, real: f64, divisor: i64) -> Divided {
        // The nearest integer, or one so close to it that the remainder is hardly more than half a divisor.
        let quotient = nearest(real);
        let remainder = numerator.wrapping_sub(i64::from(quotient).wrapping_mul(divisor));
        let negative = remainder >> 63;
        Divided { quotient: quotient + negative as i32, remainder: remainder + (divisor & negative) }
    }

    #[inline(always)]
    fn plus(self, other: Divided, divisor: i64) -> Divided {
        // Without branches, which would be unpredictable.
        let left = self.remainder + other.remainder - divisor;
        let none = left >> 63;
        Divided { quotient: self.quotient + other.quotient + 1 + none as i32, remainder: left + (divisor & none) }
    }
}

/// A quotient along a row: that of a pixel, and its increments.
#[derive(Clone, Debug, Default)]
pub(super) struct Dda {
    /// The quotient of the next batch's first pixel.
    here: Divided,
    divisor: i64,
    slope: i64,
    /// Increment for a whole step of lanes.
    step: Divided,
    /// Number of low bits of the remainders that lanes leave out.
    shift: u32,
    /// Increments for each lane of a step: floors, and the compared bits of the remainders.
    quotients: [i32; STEP],
    remainders: [i32; STEP],
    /// Floor and remainder at the first lane of each step of a batch.
    starts: [[i32; 2]; STEPS],
}

/// Number of steps of a batch.
const STEPS: usize = BLOCK / STEP;

impl Dda {
    /// Sets up the quotients of a plane by D, less a bias, for `columns` pixels from one with the edge functions `e` on. Returns `false` if
    /// the numbers have too many bits.
    #[inline(always)]
    pub(super) fn begin(
        &mut self,
        plane: &Plane,
        triangle: &Triangle,
        e: &[i64; 3],
        denominator: i64,
        columns: i64,
        bias: i32,
    ) -> bool {
        let Some((numerator, slope)) = plane.divided(triangle, e) else { return false };
        self.set(numerator, slope, denominator >> plane.shared, columns, bias)
    }

    /// Sets up the quotients of a numerator, which has a slope, by a divisor.
    #[inline(always)]
    fn set(&mut self, numerator: i64, slope: i64, divisor: i64, columns: i64, bias: i32) -> bool {
        let reciprocal = 1.0 / divisor as f64;
        let all = (columns + 2 * STEP as i64) as f64;
        let real = numerator as f64 * reciprocal;
        // NaN does not fit either.
        let fits = divisor > 0 && real.abs() + (slope as f64 * reciprocal).abs() * all + all < MAX_QUOTIENT;
        if !fits {
            return false;
        }
        self.here = Divided::new(numerator, real, divisor);
        self.here.quotient -= bias;
        if (self.divisor, self.slope) != (divisor, slope) {
            (self.divisor, self.slope) = (divisor, slope);
            self.shift = (64 - divisor.leading_zeros()).saturating_sub(BITS);
            if slope != 0 {
                self.tabulate(slope, reciprocal);
            }
        }
        true
    }

    /// Fills the tables of a slope.
    #[inline(always)]
    fn tabulate(&mut self, slope: i64, reciprocal: f64) {
        let (real, divisor, shift) = (slope as f64 * reciprocal, self.divisor, self.shift);
        for k in 0..STEP {
            let multiple = Divided::new(slope.wrapping_mul(k as i64), IOTA_REAL[k] * real, divisor);
            self.quotients[k] = multiple.quotient;
            self.remainders[k] = (multiple.remainder >> shift) as i32;
        }
        self.step = Divided::new(slope.wrapping_mul(STEP as i64), STEP as f64 * real, divisor);
    }

    /// Writes the floors of `count` lanes and fills the last step with the last floor. Returns whether a quotient may be exact or, unless
    /// all floors [are right](Self::is_exact), whether one may be one too large. Batches begin at whole steps.
    #[inline(always)]
    pub(super) fn run<T: FromQuotient + Default>(&mut self, count: usize, out: &mut [T]) -> bool {
        if self.slope == 0 {
            let floor = T::from_quotient(self.here.quotient);
            for out in out {
                *out = floor;
            }
            return self.here.remainder == 0;
        }
        let (divisor, slack) = (self.divisor, self.slack());
        let looked = (divisor >> self.shift) as i32;
        let (out, _) = out.as_chunks_mut::<STEP>();
        let (mut at, step, shift) = (self.here, self.step, self.shift);
        for start in &mut self.starts[..out.len().min(STEPS)] {
            // Less the divisor, so that the sign is the carry.
            *start = [at.quotient + 1, (at.remainder >> shift) as i32 - looked + slack];
            at = at.plus(step, divisor);
        }
        self.here = at;
        let least = floors(&self.starts, &self.quotients, &self.remainders, looked, out);
        repeat(count, out);
        let mut found = false;
        for least in least {
            found |= least <= 2 * slack as u32;
        }
        found
    }

    /// Returns 1 for each lane of a step, as [`run`](Self::run) computed it, whose remainder is 0.
    #[inline(always)]
    pub(super) fn whole(&self, step: usize) -> [i32; STEP] {
        let mut whole = [i32::from(self.here.remainder == 0); STEP];
        if self.slope != 0 {
            let ([_, remainder], divisor) = (self.starts[step], self.divisor as i32);
            for k in 0..STEP {
                let sum = remainder + self.remainders[k];
                whole[k] = i32::from((sum == 0) | (sum + divisor == 0));
            }
        }
        whole
    }

    /// Returns the possible error of the compared bits. With bits left out, a sum of two remainders is too small by less than two, and the
    /// divisor by less than one.
    #[inline(always)]
    fn slack(&self) -> i32 {
        i32::from(self.shift > 0)
    }

    /// Returns whether all floors are right.
    pub(super) fn is_exact(&self) -> bool {
        self.shift == 0
    }
}

/// Writes the floors of steps of lanes. Returns the least remainder of each lane of a step.
#[inline(always)]
fn floors<T: FromQuotient + Default>(
    starts: &[[i32; 2]; STEPS],
    quotients: &[i32; STEP],
    remainders: &[i32; STEP],
    divisor: i32,
    out: &mut [[T; STEP]],
) -> [u32; STEP] {
    // Copies, and a step of its own, which cannot overlap the result wherever this function is inlined.
    let (quotients, remainders) = (*quotients, *remainders);
    let mut least = [u32::MAX; STEP];
    for ([quotient, remainder], out) in starts.iter().zip(out) {
        let (mut sums, mut step) = ([0; STEP], [T::default(); STEP]);
        for k in 0..STEP {
            sums[k] = remainder + remainders[k];
        }
        for k in 0..STEP {
            step[k] = T::from_quotient(quotient + quotients[k] + (sums[k] >> 31));
        }
        for k in 0..STEP {
            least[k] = least[k].min(sums[k] as u32).min((sums[k] + divisor) as u32);
        }
        *out = step;
    }
    least
}

/// Fills the lanes past the end of a batch with the last one.
#[inline(always)]
pub(super) fn repeat<T: Copy>(count: usize, steps: &mut [[T; STEP]]) {
    if let (Some(step), left @ 1..) = (steps.last_mut(), count % STEP) {
        let last = step[left - 1];
        for (k, lane) in step.iter_mut().enumerate() {
            *lane = if k < left { *lane } else { last };
        }
    }
}

/// The DDAs of a row.
#[derive(Clone, Debug, Default)]
pub(super) struct DdaRow {
    /// u and v of each sampler, and whether they are in use.
    pub(super) samplers: [([Dda; 2], bool); TEXTURE_UNITS],
    /// Weights 0 and 2, and whether they are in use.
    pub(super) weights: ([Dda; 2], bool),
    /// The fog factor of the row, if it does not vary.
    pub(super) fog: Option<i16>,
    /// Whether nothing else is interpolated.
    pub(super) complete: bool,
    /// Whether nothing else is divided by D.
    pub(super) undivided: bool,
}

impl Setup<'_> {
    /// INT-4, INT-4t: corrects the coordinates of a row where some may be exact.
    #[inline(never)]
    #[allow(
        clippy::too_many_arguments,
        reason = "each result apart, so that the compiler sees that none overlaps another"
    )]
    pub(super) fn correct_dda(
        &self,
        batch: PixelBatch<'_>,
        planes: &[Plane; 2],
        bias: i32,
        found: [bool; 2],
        ddas: [&Dda; 2],
        u: &mut [i32],
        v: &mut [i32],
        whole: &mut PerLane<i32>,
    ) {
        let triangle = &self.context.triangle;
        let e = triangle.edges(batch.first.0, batch.first.1);
        for (n, values) in [(0, u), (1, v)] {
            let (plane, dda) = (&planes[n], ddas[n]);
            if found[n] && !dda.is_exact() {
                self.correct_coordinate::<true>(batch, bias, plane, &e, values, whole);
            } else if found[n] && plane.lowers(triangle) {
                let whole = &mut whole[..values.len()];
                for (step, whole) in whole.as_chunks_mut::<STEP>().0.iter_mut().enumerate() {
                    *whole = dda.whole(step);
                }
                self.lower_ties::<true>(batch, plane, whole, values);
            }
        }
    }
}

/// INT-3: corrects the weights of a row where some are exact.
#[inline(always)]
pub(super) fn break_dda_ties([first, third]: [&Dda; 2], count: usize, w0: &mut [u16], w2: &mut [u16]) {
    let ((w0, _), (w2, _)) = (w0.as_chunks_mut::<STEP>(), w2.as_chunks_mut::<STEP>());
    for (step, (w0, w2)) in w0.iter_mut().zip(w2.iter_mut()).enumerate() {
        let (whole0, whole2) = (first.whole(step), third.whole(step));
        let mut tied = 0;
        for k in 0..STEP {
            tied |= whole0[k] | whole2[k];
        }
        if tied != 0 {
            let (mut floors0, mut floors2) = ([0; STEP], [0; STEP]);
            widen(w0, &mut floors0);
            widen(w2, &mut floors2);
            break_ties(&mut floors0, &mut floors2, &whole0, &whole2);
            narrow(&floors0, w0);
            narrow(&floors2, w2);
        }
    }
    repeat(count, w0);
    repeat(count, w2);
}

/// Widens numbers to 32 bits.
#[inline(always)]
pub(super) fn widen(narrow: &[u16], out: &mut [i32]) {
    for (out, narrow) in out.iter_mut().zip(narrow) {
        *out = i32::from(*narrow);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sequences of quotients against divisions, one by one: divisors of few and of many bits, ties in all of them.
    #[test]
    fn steps_are_floors() {
        let mut sequence = crate::random::Random::seeded(0x2545_f491_4f6c_dd1d);
        let mut random = |bits: u32| (sequence.bits() >> (64 - bits)) as i64;
        let (mut exact, mut close) = (0, 0);
        for round in 0..60_000 {
            let bits = 2 + round % 52;
            let divisor = random(bits).max(1);
            let bits = (bits + 18).min(60);
            let (mut numerator, mut slope) = (random(bits) - (1 << (bits - 1)), random(bits - 8) - (1 << (bits - 9)));
            if round % 3 == 0 {
                // Exact quotients every few lanes.
                let every = 1 + random(4);
                slope = slope / divisor * divisor / every;
                numerator = numerator / divisor * divisor - slope * random(5);
            }
            let mut dda = Dda::default();
            if !dda.set(numerator, slope, divisor, 600, 0) {
                continue;
            }
            let mut first = 0;
            for count in [256, 16, 17 + random(7) as usize] {
                let mut out = vec![0_i32; count.next_multiple_of(STEP)];
                let found = dda.run(count, &mut out);
                for (k, got) in out.iter().enumerate() {
                    let at = i128::from(numerator) + i128::from(slope) * (first + k.min(count - 1)) as i128;
                    let (floor, rest) = (at.div_euclid(i128::from(divisor)), at.rem_euclid(i128::from(divisor)));
                    if dda.is_exact() || !found {
                        assert_eq!(i128::from(*got), floor, "{numerator} + {k} {slope} over {divisor}");
                    } else {
                        assert!((0..=1).contains(&(i128::from(*got) - floor)));
                    }
                    assert!(found || rest != 0);
                    if dda.is_exact() && k < count {
                        assert_eq!(dda.whole(k / STEP)[k % STEP], i32::from(rest == 0));
                    }
                    (exact, close) = (exact + u64::from(rest == 0), close + u64::from(found && !dda.is_exact()));
                }
                first += count;
            }
        }
        assert!(exact > 100_000 && close > 100_000, "{exact} {close}");
    }
}
