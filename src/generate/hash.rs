//! The randomness of the generators, in integers.

/// 2^64 over the golden ratio: the step of SplitMix64.
pub(crate) const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// 64 bits that depend on all of `z`: a step of SplitMix64.
pub(crate) fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(GOLDEN);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// 64 well mixed bits of two coordinates and a seed.
pub(super) fn hash(x: i64, y: i64, seed: u64) -> u64 {
    mix(mix(seed ^ (x as u64)) ^ ((y as u64) << 32))
}
