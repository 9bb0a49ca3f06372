//! How often each difference occurs in a channel.

/// Differences up to this size have a bucket each; beyond, buckets double.
const EXACT: i16 = 4;

/// Counts of the signed differences of one channel; 0 is not counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Histogram {
    /// Index: difference + 255.
    counts: Vec<u64>,
}

/// Some neighbouring differences.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bucket {
    /// The lowest difference.
    pub from: i16,
    /// The highest difference.
    pub to: i16,
    /// Pixels with a difference from `from` to `to`.
    pub pixels: u64,
}

impl Default for Histogram {
    fn default() -> Self {
        Histogram { counts: vec![0; 511] }
    }
}

impl Histogram {
    /// Counts a difference of -255 to 255.
    pub(super) fn add(&mut self, step: i16) {
        if step != 0
            && let Some(count) = self.counts.get_mut((step + 255) as usize)
        {
            *count += 1;
        }
    }

    /// Pixels that differ in this channel.
    pub fn different(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// The largest difference, without its sign.
    pub fn largest(&self) -> u8 {
        let occurring = self.counts.iter().zip(-255_i16..).filter(|(count, _)| **count > 0);
        occurring.map(|(_, step)| step.unsigned_abs() as u8).max().unwrap_or(0)
    }

    /// Pixels whose difference is `from` to `to`.
    pub fn between(&self, from: i16, to: i16) -> u64 {
        (from..=to).filter_map(|step| self.counts.get(usize::try_from(step + 255).ok()?)).sum()
    }

    /// The buckets that are not empty, from the most negative difference up: one each for -4 to 4, wider ones beyond.
    pub fn buckets(&self) -> Vec<Bucket> {
        let filled = |(from, to)| Bucket { from, to, pixels: self.between(from, to) };
        ranges().into_iter().map(filled).filter(|bucket| bucket.pixels > 0).collect()
    }
}

/// Every bucket's lowest and highest difference, ascending.
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
