//! Division of work among several runs.

use std::str::FromStr;

/// The run number `index`, from 1, of `count` runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: u64,
    count: u64,
}

impl Shard {
    /// The only run, which has all the work.
    pub(crate) const ALL: Shard = Shard { index: 1, count: 1 };

    /// Returns the shard `index` of `count`, or `None` unless `1 <= index <= count`.
    pub fn new(index: u64, count: u64) -> Option<Self> {
        (1..=count).contains(&index).then_some(Shard { index, count })
    }

    /// Returns whether the piece of work with the given number belongs to this shard. Every number belongs to exactly one of the shards.
    pub(crate) fn takes(self, number: u64) -> bool {
        number % self.count == self.index - 1
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.split_once('/')
            .and_then(|(index, count)| Shard::new(index.parse().ok()?, count.parse().ok()?))
            .ok_or_else(|| "not of the form I/N with I from 1 to N, for example 1/4".to_owned())
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::Shard;

    #[test]
    fn text_and_back() {
        assert_eq!("3/4".parse(), Ok(Shard { index: 3, count: 4 }));
        assert_eq!(Shard::ALL.to_string().parse(), Ok(Shard::ALL));
        for text in ["", "1", "/", "0/2", "3/2", "1/0", "-1/2", "a/b", "1/2/3"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
