//! How often a variant would yield another renderer's pixels by chance.
#![allow(clippy::float_arithmetic, reason = "statistics; nothing of this is stored")]

use std::collections::HashMap;

/// The difference between two pixels, R, G and B, on a scale that is coarse beyond [`FINE`]: of two differences that count as equal there, chance
/// is overestimated.
type Key = u32;

/// Largest difference of a channel that is told apart exactly.
const FINE: i16 = 32;

/// Returns the key of the difference between two pixels.
fn key(from: [u8; 4], to: [u8; 4]) -> Key {
    (0..3).fold(0, |key, n| {
        let step = i16::from(to[n]) - i16::from(from[n]);
        let code = if step.abs() <= FINE { step } else { step.signum() * (FINE + (step.abs() - FINE + 7) / 8) };
        key << 8 | (code + 128) as Key
    })
}

/// Counts of differences.
#[derive(Clone, Debug, Default)]
pub struct Differences {
    counts: HashMap<Key, u64>,
    /// The sum of all counts, and that of the squares of the weights that they were counted with.
    total: u64,
    squares: u64,
}

impl Differences {
    /// Counts the difference between two pixels, which stand for `weight` of their kind.
    pub(crate) fn add(&mut self, from: [u8; 4], to: [u8; 4], weight: u64) {
        *self.counts.entry(key(from, to)).or_default() += weight;
        self.total += weight;
        self.squares += weight * weight;
    }

    /// Adds other counts.
    pub fn merge(&mut self, other: &Differences) {
        for (key, count) in &other.counts {
            *self.counts.entry(*key).or_default() += count;
        }
        self.total += other.total;
        self.squares += other.squares;
    }

    /// Returns the number of pixels that one observation stands for on average.
    fn weight(&self) -> f64 {
        self.squares as f64 / self.total.max(1) as f64
    }
}

/// The pixels that a variant explains, and those that it would explain by chance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Chance {
    /// Wrong pixels whose bytes the variant yields.
    pub hits: u64,
    /// Expectation of the same number if the other renderer's errors were dealt out among all compared pixels at random.
    pub expected: f64,
    /// Number of pixels that one of the sample stands for.
    pub weight: f64,
}

impl Chance {
    /// Returns the chance of a variant that changes pixels by `predicted`, where all compared pixels, right ones among them, differ by `actual`.
    pub fn new(hits: u64, predicted: &Differences, actual: &Differences) -> Chance {
        let total = actual.total.max(1) as f64;
        let share = |key: &Key| actual.counts.get(key).map_or(0.0, |count| *count as f64 / total);
        let expected = predicted.counts.iter().map(|(key, count)| *count as f64 * share(key)).sum();
        Chance { hits, expected, weight: predicted.weight() }
    }

    /// Returns whether the variant explains more than chance: twice the expectation, five standard deviations above it, and at least sixteen
    /// pixels of the sample.
    pub fn is_exceeded(self) -> bool {
        let (hits, weight) = (self.hits as f64, self.weight);
        hits >= 16.0 * weight
            && hits >= 2.0 * self.expected
            && hits > self.expected + 5.0 * (self.expected * weight).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_tell_small_differences_apart() {
        let of = |step: i16| key([100; 4], [(100 + step) as u8, 100, 100, 0]);
        let mut keys: Vec<Key> = (-100..=155).map(of).collect();
        keys.dedup();
        assert_eq!(keys.len(), 2 * 32 + 1 + 68_usize.div_ceil(8) + 123_usize.div_ceil(8));
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), 65 + 9 + 16);
    }

    #[test]
    fn where_errors_lie_is_evidence() {
        let (mut predicted, mut actual) = (Differences::default(), Differences::default());
        let add = |to: &mut Differences, from: u8, count: u64, step: u8| {
            (0..count).for_each(|_| to.add([from; 4], [from + step; 4], 1));
        };
        add(&mut predicted, 10, 1000, 1);
        add(&mut actual, 20, 1000, 1);
        // All pixels are one step off, as they are after every change that adds a step.
        let chance = Chance::new(1000, &predicted, &actual);
        assert_eq!(chance, Chance { hits: 1000, expected: 1000.0, weight: 1.0 });
        assert!(!chance.is_exceeded());
        // Only those are off that the variant changes.
        add(&mut actual, 20, 9000, 0);
        assert!(Chance::new(1000, &predicted, &actual).is_exceeded());
        // The variant changes all pixels, and a tenth of them happens to be off by as much.
        add(&mut predicted, 10, 9000, 1);
        assert!(!Chance::new(1000, &predicted, &actual).is_exceeded());
    }
}
