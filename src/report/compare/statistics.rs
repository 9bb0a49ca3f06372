//! Statistics of many errors.
#![allow(clippy::float_arithmetic, reason = "statistics of errors")]

/// Number of bins: one for each whole number of steps, with one shared by all larger errors at each end.
pub(super) const BINS: usize = 17;

/// Count, extremes and moments of errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// Number of errors.
    pub count: u64,
    /// Lowest error; infinity if there are none.
    pub low: f64,
    /// Highest error; minus infinity if there are none.
    pub high: f64,
    /// Sum of the signed errors.
    sum: f64,
    /// Sum of the magnitudes.
    magnitude: f64,
    /// Sum of the squares.
    squares: f64,
}

impl Default for Statistics {
    fn default() -> Self {
        Statistics { count: 0, low: f64::INFINITY, high: -f64::INFINITY, sum: 0.0, magnitude: 0.0, squares: 0.0 }
    }
}

/// Numbers of errors that round to -8 or less, -7, ..., 7, and 8 or more steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Histogram(pub [u64; BINS]);

impl Histogram {
    /// Adds an error.
    pub fn add(&mut self, error: f64) {
        let middle = (BINS / 2) as f64;
        // Halves are rounded up.
        self.0[(error.clamp(-middle, middle) + middle + 0.5) as usize] += 1;
    }

    /// Adds the counts of another histogram.
    pub fn merge(&mut self, other: &Histogram) {
        self.0.iter_mut().zip(other.0).for_each(|(mine, other)| *mine += other);
    }
}

impl Statistics {
    /// Adds an error.
    #[inline]
    pub fn add(&mut self, error: f64) {
        self.low = self.low.min(error);
        self.high = self.high.max(error);
        self.count += 1;
        self.sum += error;
        self.magnitude += error.abs();
        self.squares += error * error;
    }

    /// Adds the errors of other statistics.
    pub fn merge(&mut self, other: &Statistics) {
        self.low = self.low.min(other.low);
        self.high = self.high.max(other.high);
        self.count += other.count;
        self.sum += other.sum;
        self.magnitude += other.magnitude;
        self.squares += other.squares;
    }

    fn over_count(&self, sum: f64) -> f64 {
        if self.count == 0 { 0.0 } else { sum / self.count as f64 }
    }

    /// Returns the largest magnitude; 0 without errors.
    pub fn max(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.high.abs().max(self.low.abs()) }
    }

    /// Returns the mean magnitude; 0 without errors.
    pub fn mean(&self) -> f64 {
        self.over_count(self.magnitude)
    }

    /// Returns the mean: how far the definition lies above the ideal.
    pub fn bias(&self) -> f64 {
        self.over_count(self.sum)
    }

    /// Returns the root mean square.
    pub fn rms(&self) -> f64 {
        self.over_count(self.squares).sqrt()
    }

    /// Returns the peak signal-to-noise ratio in decibels; infinite without errors.
    pub fn psnr(&self) -> f64 {
        20.0 * (255.0 / self.rms()).log10()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_errors(errors: &[f64]) -> Statistics {
        let mut all = Statistics::default();
        errors.iter().for_each(|e| all.add(*e));
        all
    }

    #[test]
    fn moments_by_hand() {
        let all = from_errors(&[-1.0, 0.5, 2.0, -9.0]);
        assert_eq!((all.count, all.low, all.high, all.max()), (4, -9.0, 2.0, 9.0));
        assert_eq!((all.bias(), all.mean(), all.squares), (-1.875, 3.125, 86.25));
        let mut bins = Histogram::default();
        [-1.0, 0.5, 2.0, -9.0].into_iter().for_each(|e| bins.add(e));
        assert_eq!((bins.0[0], bins.0[7], bins.0[9], bins.0[10]), (1, 1, 1, 1));
        assert!((from_errors(&[1.0]).psnr() - 48.130_803_608_679_1).abs() < 1e-9);
        assert_eq!(from_errors(&[0.0]).psnr(), f64::INFINITY);
    }

    #[test]
    fn merging_is_adding() {
        let mut halves = from_errors(&[-1.0, 0.5]);
        halves.merge(&Statistics::default());
        halves.merge(&from_errors(&[2.0, -9.0]));
        assert_eq!(halves, from_errors(&[-1.0, 0.5, 2.0, -9.0]));
        let mut empty = Statistics::default();
        empty.merge(&from_errors(&[3.0]));
        assert_eq!(empty, from_errors(&[3.0]));
    }
}
