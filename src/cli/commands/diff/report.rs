//! Report of `ninebit diff`.

use std::fmt::Write;

use ninebit::shown;
use ninebit_report::{trace_text, trace_value};
use ninebit_scene::diff::{CHANNELS, Difference, Histogram, Region, histogram_text, pixels, share};
use serde_json::{Value, json};

use super::{Findings, SceneFindings};
use crate::replay::report::histograms;

/// Returns the compared channels with their names.
fn channels<'a>(findings: &'a Findings<'_>) -> Vec<(&'static str, &'a Histogram)> {
    let count = if findings.arguments.ignore_alpha { 3 } else { 4 };
    CHANNELS.into_iter().zip(&findings.difference.channels).take(count).collect()
}

/// Returns the report as text.
pub(super) fn text(findings: &Findings<'_>) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write_text(&mut out, findings);
    out
}

fn write_text(out: &mut String, findings: &Findings<'_>) -> std::fmt::Result {
    let (arguments, difference) = (findings.arguments, &findings.difference);
    let without = if arguments.ignore_alpha { ", alpha not compared" } else { "" };
    writeln!(out, "A {}", shown::path(&arguments.a))?;
    writeln!(out, "B {}", shown::path(&arguments.b))?;
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
        writeln!(out, "\n{}: |B - A| times {scale} where they differ, a dark grey A elsewhere", shown::name(path))?;
    }
    Ok(())
}

fn write_scene(out: &mut String, scene: &SceneFindings<'_>) -> std::fmt::Result {
    writeln!(out, "\nframe of {}, target `{}`:", shown::path(scene.path), shown::name(&scene.target))?;
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
    write!(out, "\n{}", histogram_text("B - A", &channels(findings)))?;
    write_regions(out, difference)?;
    for (number, trace) in (1..).zip(findings.scene.iter().flat_map(|scene| &scene.traces)) {
        let Some(scene) = &findings.scene else { break };
        writeln!(out, "\nfirst pixel of region {number}, as the scene draws it")?;
        write!(out, "{}", trace_text(&scene.plan, trace))?;
    }
    Ok(())
}

fn write_regions(out: &mut String, difference: &Difference) -> std::fmt::Result {
    let shown = difference.regions.len() as u64;
    writeln!(out, "\n{}", shown::count(difference.region_count, "region"))?;
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

/// Returns the report as JSON.
pub(super) fn json(findings: &Findings<'_>) -> Value {
    let (arguments, difference) = (findings.arguments, &findings.difference);
    let regions = difference.regions.iter().enumerate().map(|(number, region)| {
        let scene = findings.scene.as_ref();
        let trace = scene.and_then(|scene| Some(trace_value(&scene.plan, scene.traces.get(number)?)));
        json!({
            "x": region.x, "y": region.y, "width": region.width, "height": region.height,
            "pixels": region.pixels, "first": region.first, "largest": region.largest, "trace": trace,
        })
    });
    let scene = findings.scene.as_ref().map(|scene| {
        let [a, b] = scene.different;
        json!({ "path": shown::lossless(scene.path), "target": scene.target, "a_differs": a, "b_differs": b })
    });
    let picture = findings.picture.as_ref().map(|(path, scale)| json!({ "path": path, "scale": scale }));
    json!({
        "format": "ninebit-diff-1",
        "a": shown::lossless(&arguments.a),
        "b": shown::lossless(&arguments.b),
        "width": difference.width,
        "height": difference.height,
        "ignore_alpha": arguments.ignore_alpha,
        "equal": difference.different == 0,
        "pixels": difference.pixels(),
        "different": difference.different,
        "largest": difference.largest(),
        "channels": histograms(channels(findings)),
        "region_count": difference.region_count,
        "regions": regions.collect::<Value>(),
        "scene": scene,
        "picture": picture,
    })
}
