//! What varies across a triangle: one file for each kind of number. Every number is WGT-1's linear function of the weights b_0 and b_2.
#![allow(clippy::float_arithmetic, reason = "doubles hold every number exactly")]

pub(super) mod colors;
pub(super) mod coordinates;
pub(super) mod depths;
pub(super) mod fog;
pub(super) mod numbers;

use super::lanes::PerLane;
use crate::raster::weights::Linear;
use std::ops::Range;

/// The weights b_0 and b_2 of some lanes.
#[derive(Clone, Copy)]
pub(super) struct Weighted<'a> {
    first: &'a [f64],
    third: &'a [f64],
}

impl<'a> Weighted<'a> {
    #[inline(always)]
    pub(super) fn new([first, third]: &'a [PerLane<f64>; 2], lanes: Range<usize>) -> Weighted<'a> {
        Weighted { first: &first[lanes.clone()], third: &third[lanes] }
    }

    /// Returns the same lanes, so many that compilers see it.
    #[inline(always)]
    fn lanes(self, count: usize) -> Weighted<'a> {
        Weighted { first: &self.first[..count], third: &self.third[..count] }
    }

    /// Returns a number in a lane.
    #[inline(always)]
    fn at(&self, number: &Linear<f64>, n: usize) -> f64 {
        number.at([self.first[n], 0.0, self.third[n]])
    }

    /// Writes what a function makes of a number in each lane.
    #[inline(always)]
    fn each<T>(self, number: &Linear<f64>, out: &mut [T], of: impl Fn(f64) -> T) {
        let (weights, number) = (self.lanes(out.len()), *number);
        for n in 0..out.len() {
            out[n] = of(weights.at(&number, n));
        }
    }

    /// Writes what a function makes of the quotient of two numbers in each lane: infinite where the second is 0, and 0 where both are.
    #[inline(always)]
    fn each_quotient<T>(self, number: &Linear<f64>, by: &Linear<f64>, out: &mut [T], of: impl Fn(f64, f64) -> T) {
        let (weights, number, by) = (self.lanes(out.len()), *number, *by);
        for n in 0..out.len() {
            // A sum of zeros may be negative.
            out[n] = of(weights.at(&number, n), weights.at(&by, n) + 0.0);
        }
    }
}

/// Returns a quotient, whose divisor is not -0.
#[inline(always)]
fn quotient(n: f64, by: f64) -> f64 {
    if (n == 0.0) & (by == 0.0) { 0.0 } else { n / by }
}
