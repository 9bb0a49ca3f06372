//! Writes differences as text.

use std::fmt::Write;

use super::Histogram;
use ninebit::shown;

/// Names of the channels, in the order of a pixel's bytes.
pub const CHANNELS: [&str; 4] = ["red", "green", "blue", "alpha"];

/// Returns the histograms of some channels as a table: one line for each bucket that occurs, then how many pixels differ and by how much at
/// most. `title` is the head of the column of differences.
pub fn histogram_text(title: &str, channels: &[(&str, &Histogram)]) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write_histogram(&mut out, title, channels);
    out
}

fn write_histogram(out: &mut String, title: &str, channels: &[(&str, &Histogram)]) -> std::fmt::Result {
    write!(out, "{title:>12}")?;
    for (name, _) in channels {
        write!(out, "{name:>10}")?;
    }
    let mut ranges: Vec<(i16, i16)> =
        channels.iter().flat_map(|(_, h)| h.buckets()).map(|bucket| (bucket.from, bucket.to)).collect();
    ranges.sort_unstable();
    ranges.dedup();
    for (from, to) in ranges {
        let label = if from == to { format!("{from:+}") } else { format!("{from:+} to {to:+}") };
        write!(out, "\n{label:>12}")?;
        for (_, histogram) in channels {
            match histogram.between(from, to) {
                0 => write!(out, "{:>10}", ".")?,
                count => write!(out, "{count:>10}")?,
            }
        }
    }
    let mut line = |label: &str, value: fn(&Histogram) -> u64| {
        write!(out, "\n{label:>12}")?;
        channels.iter().try_for_each(|(_, histogram)| write!(out, "{:>10}", value(histogram)))
    };
    line("pixels", Histogram::different)?;
    line("largest", |histogram| u64::from(histogram.largest()))?;
    writeln!(out)
}

/// Returns a number of pixels in words: `1 pixel`, `2 pixels`.
pub fn pixels(count: u64) -> String {
    shown::count(count, "pixel")
}

/// Returns a share in percent, rounded to two digits. A share that is neither none nor all is never shown as 0 % or 100 %.
pub fn share(part: u64, whole: u64) -> String {
    let hundredths = (u128::from(part) * 20_000 + u128::from(whole)) / (2 * u128::from(whole.max(1)));
    match hundredths {
        0 if part > 0 => "less than 0.01 %".to_owned(),
        10_000 if part < whole => "more than 99.99 %".to_owned(),
        _ => format!("{}.{:02} %", hundredths / 100, hundredths % 100),
    }
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn shares_are_rounded_but_never_to_nothing() {
        assert_eq!(share(1, 3), "33.33 %");
        assert_eq!(share(3, 3), "100.00 %");
        assert_eq!(share(1, 1_000_000), "less than 0.01 %");
        assert_eq!(share(999_999, 1_000_000), "more than 99.99 %");
    }
}
