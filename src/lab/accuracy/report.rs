//! Prints an accuracy measurement as text and as JSON.

use super::{Accuracy, Cause, FrameCost, HardwareCost};
use ninebit_report::compare::{Statistics, statistics_value};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// Returns the measurement as text.
pub fn accuracy_text(accuracy: &Accuracy) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut out, accuracy);
    out
}

fn write(out: &mut String, a: &Accuracy) -> std::fmt::Result {
    let row = |out: &mut String, name: &str, e: &Statistics| {
        writeln!(out, "{name:<20}{:>9.4}{:>9.4}{:>9.4}{:>9.4}", e.rms(), e.max(), e.mean(), e.bias())
    };
    write!(out, "{} x {}, measured: {} pixels", a.width, a.height, a.pixels)?;
    match a.without {
        0 => writeln!(out)?,
        n => writeln!(out, ", drawn without a truth: {n}")?,
    }
    writeln!(out, "errors are the picture minus the truth, in steps of 1/255\n")?;
    writeln!(out, "channel                   rms      max     mean     bias")?;
    row(out, "all", &a.errors)?;
    for (name, errors) in ["r", "g", "b"].iter().zip(&a.channels) {
        row(out, name, errors)?;
    }
    let psnr = a.errors.psnr();
    writeln!(
        out,
        "psnr                {}",
        if psnr.is_finite() { format!("{psnr:9.2} dB") } else { "    exact".to_owned() }
    )?;
    writeln!(out, "\ncause                     rms      max     mean     bias   what it adds to the error")?;
    for cause in &a.causes {
        row(out, cause.name, &cause.errors)?;
    }
    if let Some(normals) = &a.normals {
        writeln!(out, "\nnormals               mean      max")?;
        writeln!(out, "turned by, degrees{:>8.3} {:>8.3}", normals.degrees.mean(), normals.degrees.max())?;
        writeln!(out, "length, from {:.3} to {:.3}", normals.lengths.low, normals.lengths.high)?;
    }
    let b = &a.banding;
    writeln!(out, "\nhighlight: {} pixels     picture    truth", b.pixels)?;
    writeln!(out, "levels{:>28}{:>9}", b.levels, b.truth_levels)?;
    writeln!(out, "longest flat run, pixels{:>10}{:>9}", b.flat_run, b.truth_flat_run)?;
    write_cost(out, &a.cost)
}

/// Writes the cost as asked beside the cost after pruning.
fn write_cost(out: &mut String, cost: &HardwareCost) -> std::fmt::Result {
    writeln!(out, "\ncost                     as asked  after pruning")?;
    for ((name, asked), (_, pruned)) in cost.asked.counts().iter().zip(cost.pruned.counts()) {
        writeln!(out, "{name:<24}{asked:>9}{pruned:>15}")?;
    }
    writeln!(out, "for each final pixel")?;
    for ((name, asked), (_, pruned)) in cost.asked.per_pixel().iter().zip(cost.pruned.per_pixel()) {
        writeln!(out, "  {name:<22}{asked:>9.3}{pruned:>15.3}")?;
    }
    Ok(())
}

/// Returns the measurement as a JSON object.
pub fn accuracy_value(a: &Accuracy) -> Value {
    let channels: Map<String, Value> =
        ["r", "g", "b"].iter().zip(&a.channels).map(|(name, e)| ((*name).to_owned(), statistics_value(e))).collect();
    let cause = |cause: &Cause| {
        let mut value = statistics_value(&cause.errors);
        value["cause"] = cause.name.into();
        value
    };
    let normals = a.normals.as_ref().map(|normals| {
        let (degrees, lengths) = (&normals.degrees, &normals.lengths);
        json!({
            "mean_degrees": degrees.mean(), "max_degrees": degrees.max(),
            "shortest": lengths.low, "longest": lengths.high,
        })
    });
    let b = &a.banding;
    json!({
        "width": a.width, "height": a.height, "pixels": a.pixels, "without_truth": a.without,
        "errors": statistics_value(&a.errors),
        "channels": channels,
        "causes": a.causes.iter().map(cause).collect::<Value>(),
        "normals": normals,
        "highlight": {
            "pixels": b.pixels, "levels": b.levels, "truth_levels": b.truth_levels,
            "flat_run": b.flat_run, "truth_flat_run": b.truth_flat_run,
        },
        "cost": { "as_asked": cost_value(&a.cost.asked), "after_pruning": cost_value(&a.cost.pruned) },
    })
}

fn cost_value(cost: &FrameCost) -> Value {
    let key = |name: &str| name.replace(' ', "_");
    let mut value: Map<String, Value> = cost.counts().iter().map(|(name, n)| (key(name), (*n).into())).collect();
    let per_pixel: Map<String, Value> = cost.per_pixel().iter().map(|(name, n)| (key(name), (*n).into())).collect();
    value.insert("per_final_pixel".to_owned(), per_pixel.into());
    value.into()
}
