//! What varies across a triangle: one file for each kind of number. Every number is WGT-1's linear function of the weights b_0 and b_2.
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly")]

pub(super) mod colors;
pub(super) mod coordinates;
pub(super) mod depths;
pub(super) mod estimates;
pub(super) mod fog;
pub(super) mod numbers;
pub(super) mod sprites;

use super::geometry::weights::CHUNK;
use super::lanes::{PerLane, larger};
use crate::raster::weights::{self, Linear, Number};
use std::ops::Range;

/// The weights b_0 and b_2 of some lanes.
#[derive(Clone, Copy)]
pub(crate) struct LaneWeights<'a> {
    first: &'a [f64],
    third: &'a [f64],
    /// Whether lanes whose pixel the triangle does not cover do not count.
    are_covered: bool,
}

impl<'a> LaneWeights<'a> {
    #[inline(always)]
    pub(super) fn new(
        [first, third]: &'a [PerLane<f64>; 2],
        lanes: Range<usize>,
        are_covered: bool,
    ) -> LaneWeights<'a> {
        LaneWeights { first: &first[lanes.clone()], third: &third[lanes], are_covered }
    }

    /// Returns some of the lanes.
    #[inline(always)]
    fn part(self, lanes: Range<usize>) -> LaneWeights<'a> {
        LaneWeights { first: &self.first[lanes.clone()], third: &self.third[lanes], ..self }
    }

    /// Returns the same lanes, so many that compilers see it.
    #[inline(always)]
    fn lanes(self, count: usize) -> LaneWeights<'a> {
        LaneWeights { first: &self.first[..count], third: &self.third[..count], ..self }
    }

    /// Returns a number in a lane.
    #[inline(always)]
    fn at(&self, number: &Linear<f64>, n: usize) -> f64 {
        number.at([self.first[n], self.third[n]])
    }

    /// Writes a number in each lane.
    ///
    /// Where no weight counts that is above 1, and f_1 has the exponent of both differences or a larger one, the terms of all lanes are cut at the
    /// same bit.
    #[inline(always)]
    fn number(self, number: &Linear<f64>, out: &mut [f64]) {
        let (weights, number) = (self.lanes(out.len()), *number);
        let Linear { second, first, third } = number;
        let [power, a, b] = [second, first, third].map(|n| n.abs().exponent::<true>());
        if weights.are_covered && second != 0.0 && power >= larger(a, b) {
            // Steps of the last of 24 bits.
            let unit = power * (1.0 / f64::from(1 << 23));
            let (steps, first, third) = (second / unit, first / unit, third / unit);
            for n in 0..out.len() {
                let (a, b) = (weights.first[n] * first, weights.third[n] * third);
                out[n] = (steps + a.trunc() + b.trunc()) * unit;
            }
        } else if second == 0.0 && first == 0.0 {
            for n in 0..out.len() {
                out[n] = (weights.third[n] * third).cut();
            }
        } else {
            for n in 0..out.len() {
                out[n] = weights.at(&number, n);
            }
        }
    }

    /// Writes what a function makes of a number in each lane.
    #[inline(always)]
    fn each<T>(self, number: &Linear<f64>, out: &mut [T], of: impl Fn(f64) -> T) {
        let mut numbers = [0.0; CHUNK];
        for first in (0..out.len()).step_by(CHUNK) {
            let part = first..(first + CHUNK).min(out.len());
            let (out, numbers) = (&mut out[part.clone()], &mut numbers[..part.len()]);
            self.part(part).number(number, numbers);
            for n in 0..out.len() {
                out[n] = of(numbers[n]);
            }
        }
    }

    /// Writes what a function makes of the quotient of two numbers in each lane: infinite where the second is 0, and 0 where both are.
    #[inline(always)]
    fn each_quotient<T>(self, number: &Linear<f64>, by: &Linear<f64>, out: &mut [T], of: impl Fn(f64, f64) -> T) {
        let mut numbers = [[0.0; CHUNK]; 2];
        for first in (0..out.len()).step_by(CHUNK) {
            let part = first..(first + CHUNK).min(out.len());
            let (out, [above, below]) = (&mut out[part.clone()], &mut numbers);
            let (above, below) = (&mut above[..part.len()], &mut below[..part.len()]);
            self.part(part.clone()).number(number, above);
            self.part(part).number(by, below);
            for n in 0..out.len() {
                // A sum of zeros may be negative.
                out[n] = of(above[n], below[n] + 0.0);
            }
        }
    }

    /// TEX-15: writes what a function makes of the ratios of numbers to another in each lane, given the number's place among them.
    #[inline(always)]
    fn each_ratio<T, const N: usize>(
        self,
        numbers: [&Linear<f64>; N],
        by: &Linear<f64>,
        outs: [&mut [T]; N],
        of: impl Fn(usize, f64) -> T,
    ) {
        let mut chunks = [[0.0; CHUNK]; 3];
        for first in (0..self.first.len()).step_by(CHUNK) {
            let part = first..(first + CHUNK).min(self.first.len());
            let [above, below, reciprocals] = chunks.each_mut().map(|chunk| &mut chunk[..part.len()]);
            self.part(part.clone()).number(by, below);
            for n in 0..below.len() {
                below[n] += 0.0;
                reciprocals[n] = reciprocal(below[n]);
            }
            for k in 0..N {
                self.part(part.clone()).number(numbers[k], above);
                let out = &mut outs[k][part.clone()];
                for n in 0..out.len() {
                    out[n] = of(k, ratio(above[n], below[n], reciprocals[n]));
                }
            }
        }
    }
}

/// Returns a quotient, whose divisor is not -0.
#[inline(always)]
fn quotient(n: f64, by: f64) -> f64 {
    if (n == 0.0) & (by == 0.0) { 0.0 } else { n / by }
}

/// Returns the reciprocal of a q, for [`ratio`].
#[inline(always)]
fn reciprocal(q: f64) -> f64 {
    (if q == 0.0 { 1.0 } else { q }).reciprocal::<false>()
}

/// TEX-15: returns s/q of a q that is not -0, and of its [`reciprocal`].
#[inline(always)]
fn ratio(s: f64, q: f64, reciprocal: f64) -> f64 {
    let ratio = weights::quotient(s, reciprocal);
    if q == 0.0 { quotient(s, q) } else { ratio }
}
