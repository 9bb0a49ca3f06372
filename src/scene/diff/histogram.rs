//! Counts how often each difference occurs in a channel.

/// Differences up to this size have a bucket each; the sizes of the buckets beyond double.
const EXACT: i16 = 4;

/// Counts of the signed differences of one channel, without the difference 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Histogram {
    /// Count of each difference, at index difference + 255.
    counts: Vec<u64>,
}

/// A range of neighbouring differences and how many pixels fall into it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bucket {
    /// Lowest difference, inclusive.
    pub from: i16,
    /// Highest difference, inclusive.
    pub to: i16,
    /// Number of pixels with a difference from `from` to `to`.
    pub pixels: u64,
}

impl Default for Histogram {
    fn default() -> Self {
        Histogram { counts: vec![0; 511] }
    }
}

impl Histogram {
    /// Counts one difference from -255 to 255.
    pub(super) fn add(&mut self, step: i16) {
        if step != 0
            && let Some(count) = self.counts.get_mut((step + 255) as usize)
        {
            *count += 1;
        }
    }

    /// Returns the number of pixels that differ in this channel.
    pub fn different(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Returns the largest absolute difference.
    pub fn largest(&self) -> u8 {
        let occurring = self.counts.iter().zip(-255_i16..).filter(|(count, _)| **count > 0);
        occurring.map(|(_, step)| step.unsigned_abs() as u8).max().unwrap_or(0)
    }

    /// Returns the number of pixels whose difference lies between `from` and `to`, inclusive.
    pub fn between(&self, from: i16, to: i16) -> u64 {
        (from..=to).filter_map(|step| self.counts.get(usize::try_from(step + 255).ok()?)).sum()
    }

    /// Returns the buckets that are not empty, the most negative difference first. The differences -4 to 4 have one bucket each.
    pub fn buckets(&self) -> Vec<Bucket> {
        let filled = |(from, to)| Bucket { from, to, pixels: self.between(from, to) };
        ranges().into_iter().map(filled).filter(|bucket| bucket.pixels > 0).collect()
    }
}

/// Returns the lowest and highest difference of every bucket, ascending.
pub fn ranges() -> Vec<(i16, i16)> {
    let mut positive: Vec<(i16, i16)> = (1..=EXACT).map(|step| (step, step)).collect();
    let mut from = EXACT + 1;
    while from <= 255 {
        let to = (2 * (from - 1)).min(255);
        positive.push((from, to));
        from = to + 1;
    }
    let negative = positive.iter().rev().map(|(from, to)| (-to, -from));
    negative.chain(positive.iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_cover_every_difference_once() {
        let covered: Vec<i16> = ranges().into_iter().flat_map(|(from, to)| from..=to).collect();
        assert_eq!(covered, (-255..=-1).chain(1..=255).collect::<Vec<_>>());
        assert!(ranges().contains(&(5, 8)) && ranges().contains(&(-255, -129)));
    }

    #[test]
    fn what_is_added_is_counted() {
        let mut histogram = Histogram::default();
        for step in [-255, -9, -9, 0, 1, 7, 8] {
            histogram.add(step);
        }
        assert_eq!((histogram.different(), histogram.largest()), (6, 255));
        let bucket = |from, to, pixels| Bucket { from, to, pixels };
        let expected = [bucket(-255, -129, 1), bucket(-16, -9, 2), bucket(1, 1, 1), bucket(5, 8, 2)];
        assert_eq!(histogram.buckets(), expected);
        assert_eq!(Histogram::default().largest(), 0);
    }
}
