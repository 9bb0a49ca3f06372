//! What `ninebit diff` prints.

use std::fmt::Write;

use ninebit::diff::{Difference, Histogram, Region};
use ninebit::report::{trace_text, trace_value};
use serde_json::{Value, json};

use super::{Findings, SceneFindings};

const CHANNELS: [&str; 4] = ["red", "green", "blue", "alpha"];

/// The channels that were compared, with their names.
fn channels<'a>(findings: &'a Findings<'_>) -> Vec<(&'static str, &'a Histogram)> {
    let count = if findings.arguments.ignore_alpha { 3 } else { 4 };
    CHANNELS.into_iter().zip(&findings.difference.channels).take(count).collect()
}

/// The report for people.
pub(super) fn text(findings: &Findings<'_>) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write_text(&mut out, findings);
    out
}

fn write_text(out: &mut String, findings: &Findings<'_>) -> std::fmt::Result {
    let (arguments, difference) = (findings.arguments, &findings.difference);
    let without = if arguments.ignore_alpha { ", alpha not compared" } else { "" };
    writeln!(out, "A {}", arguments.a.display())?;
    writeln!(out, "B {}", arguments.b.display())?;
    writeln!(out, "{} x {} pixels{without}", difference.width, difference.height)?;
    if let Some(scene) = &findings.scene {
        write_scene(out, scene)?;
    }
    if difference.different == 0 {
        writeln!(out, "\nequal")?;
    } else {
        write_difference(out, findings)?;
    }
    if let Some((path, scale)) = &findings.picture {
        writeln!(out, "\n{path}: |B - A| times {scale} where they differ, a dark grey A elsewhere")?;
    }
    Ok(())
}

fn write_scene(out: &mut String, scene: &SceneFindings<'_>) -> std::fmt::Result {
    writeln!(out, "\nframe of {}, target `{}`:", scene.path.display(), scene.target)?;
    for (name, different) in ["A", "B"].into_iter().zip(scene.different) {
        match different {
            0 => writeln!(out, "  {name} equals it")?,
            different => writeln!(out, "  {name} differs from it in {}", pixels(different))?,
        }
    }
    Ok(())
}

fn write_difference(out: &mut String, findings: &Findings<'_>) -> std::fmt::Result {
    let difference = &findings.difference;
    let (different, all) = (difference.different, difference.pixels());
    writeln!(out, "\n{different} of {} ({}), by {} at most", pixels(all), share(different, all), difference.largest())?;
    write_histogram(out, &channels(findings))?;
    write_regions(out, difference)?;
    for (number, trace) in (1..).zip(findings.scene.iter().flat_map(|scene| &scene.traces)) {
        let Some(scene) = &findings.scene else { break };
        writeln!(out, "\nfirst pixel of region {number}, as the scene draws it")?;
        write!(out, "{}", trace_text(&scene.plan, trace))?;
    }
    Ok(())
}

fn write_histogram(out: &mut String, channels: &[(&str, &Histogram)]) -> std::fmt::Result {
    write!(out, "\n{:>12}", "B - A")?;
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

fn write_regions(out: &mut String, difference: &Difference) -> std::fmt::Result {
    let shown = difference.regions.len() as u64;
    writeln!(
        out,
        "\n{}",
        if difference.region_count == 1 {
            "1 region".to_owned()
        } else {
            format!("{} regions", difference.region_count)
        }
    )?;
    if shown > 0 {
        writeln!(out, "{:>4}{:>10}  {:<24}{:<14}largest difference", "", "pixels", "columns and rows", "first pixel")?;
    }
    for (number, region) in (1..).zip(&difference.regions) {
        let Region { x, y, width, height, .. } = *region;
        let place = format!("{x} to {}, {y} to {}", x + width - 1, y + height - 1);
        let first = format!("{},{}", region.first.0, region.first.1);
        let [r, g, b, a] = region.largest;
        writeln!(out, "{number:>4}{:>10}  {place:<24}{first:<14}R {r} G {g} B {b} A {a}", region.pixels)?;
    }
    match difference.region_count - shown {
        0 => Ok(()),
        more => writeln!(out, "and {more} more; `--regions N` lists more"),
    }
}

fn pixels(count: u64) -> String {
    format!("{count} pixel{}", if count == 1 { "" } else { "s" })
}

/// A share in percent, rounded to two digits; what is not nothing, and not all, is not shown as such.
fn share(part: u64, whole: u64) -> String {
    let hundredths = (u128::from(part) * 20_000 + u128::from(whole)) / (2 * u128::from(whole.max(1)));
    match hundredths {
        0 if part > 0 => "less than 0.01 %".to_owned(),
        10_000 if part < whole => "more than 99.99 %".to_owned(),
        _ => format!("{}.{:02} %", hundredths / 100, hundredths % 100),
    }
}

/// The report for programs.
pub(super) fn json(findings: &Findings<'_>) -> Value {
    let (arguments, difference) = (findings.arguments, &findings.difference);
    let channels: Vec<Value> = channels(findings)
        .into_iter()
        .map(|(name, histogram)| {
            let bucket = |b: &ninebit::diff::Bucket| json!({ "from": b.from, "to": b.to, "pixels": b.pixels });
            json!({
                "channel": name, "pixels": histogram.different(), "largest": histogram.largest(),
                "histogram": histogram.buckets().iter().map(bucket).collect::<Vec<_>>(),
            })
        })
        .collect();
    let regions: Vec<Value> = (0..)
        .zip(&difference.regions)
        .map(|(number, region)| {
            let scene = findings.scene.as_ref();
            let trace = scene.and_then(|scene| Some(trace_value(&scene.plan, scene.traces.get(number as usize)?)));
            json!({
                "x": region.x, "y": region.y, "width": region.width, "height": region.height,
                "pixels": region.pixels, "first": region.first, "largest": region.largest, "trace": trace,
            })
        })
        .collect();
    let scene = findings.scene.as_ref().map(|scene| {
        let [a, b] = scene.different;
        json!({ "path": scene.path.display().to_string(), "target": scene.target, "a_differs": a, "b_differs": b })
    });
    let picture = findings.picture.as_ref().map(|(path, scale)| json!({ "path": path, "scale": scale }));
    json!({
        "format": "ninebit-diff-1",
        "a": arguments.a.display().to_string(),
        "b": arguments.b.display().to_string(),
        "width": difference.width,
        "height": difference.height,
        "ignore_alpha": arguments.ignore_alpha,
        "equal": difference.different == 0,
        "pixels": difference.pixels(),
        "different": difference.different,
        "largest": difference.largest(),
        "channels": channels,
        "region_count": difference.region_count,
        "regions": regions,
        "scene": scene,
        "picture": picture,
    })
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
