//! Randomness that is the same everywhere: SplitMix64.

use crate::generate::hash::{GOLDEN, mix};

/// A seeded sequence.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// The sequence of a seed and a name.
    pub fn new(seed: u64, name: &str) -> Random {
        let mut random = Random { state: seed };
        for byte in name.bytes() {
            random.state = random.state.wrapping_add(u64::from(byte));
            random.state = random.bits();
        }
        random
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        let value = mix(self.state);
        self.state = self.state.wrapping_add(GOLDEN);
        value
    }

    /// A number below `end`, which is not 0.
    pub fn below(&mut self, end: u128) -> u128 {
        let wide = u128::from(self.bits()) << 64 | u128::from(self.bits());
        wide % end.max(1)
    }

    /// One of a list that is not empty.
    pub fn pick(&mut self, values: &[i64]) -> i64 {
        values.get(self.below(values.len() as u128) as usize).copied().unwrap_or_default()
    }

    /// True once in so many times.
    pub fn once_in(&mut self, times: u128) -> bool {
        self.below(times) == 0
    }
}
