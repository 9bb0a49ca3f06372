//! Random numbers for the generators, computed in integers.

use ninebit::random::mix;

/// Returns 64 well mixed bits of two coordinates and a seed.
pub(super) fn hash(x: i64, y: i64, seed: u64) -> u64 {
    mix(mix(seed ^ (x as u64)) ^ ((y as u64) << 32))
}
