//! Pseudorandom numbers that are the same on every machine: SplitMix64. Rows of vectors, the noise of generated images
//! and tests use it, and no other generator.

/// 2^64 divided by the golden ratio, the increment of SplitMix64.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Mixes the bits of `z`: a step of SplitMix64, in which every bit depends on all of `z`.
pub fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(GOLDEN);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A sequence of pseudorandom numbers.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// Creates the sequence of a seed.
    pub fn seeded(seed: u64) -> Random {
        Random { state: seed }
    }

    /// Creates the sequence of a seed and a name.
    pub fn new(seed: u64, name: &str) -> Random {
        let mut random = Random::seeded(seed);
        for byte in name.bytes() {
            random.state = random.state.wrapping_add(u64::from(byte));
            random.state = random.bits();
        }
        random
    }

    /// Returns the next 64 bits.
    pub fn bits(&mut self) -> u64 {
        let value = mix(self.state);
        self.state = self.state.wrapping_add(GOLDEN);
        value
    }

    /// Returns a number below `end`, which must not be 0.
    pub fn below(&mut self, end: u128) -> u128 {
        let wide = u128::from(self.bits()) << 64 | u128::from(self.bits());
        wide % end.max(1)
    }

    /// Returns an element of a list, or `None` if the list is empty.
    pub fn pick<T: Copy>(&mut self, values: &[T]) -> Option<T> {
        values.get(self.below(values.len() as u128) as usize).copied()
    }

    /// Returns `true` once in `times` calls on average.
    pub fn once_in(&mut self, times: u128) -> bool {
        self.below(times) == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first numbers that the authors of the generator publish for the seed 1234567.
    #[test]
    fn the_sequence_is_that_of_splitmix64() {
        let mut random = Random::seeded(1_234_567);
        let drawn = [0; 3].map(|_| random.bits());
        assert_eq!(drawn, [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]);
    }

    #[test]
    fn nothing_is_picked_of_nothing() {
        assert_eq!(Random::seeded(1).pick::<u8>(&[]), None);
        assert_eq!(Random::seeded(1).pick(&[7]), Some(7));
    }
}
