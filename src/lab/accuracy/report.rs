//! A measurement as text and as JSON.

use super::Accuracy;
use ninebit_report::compare::{Statistics, statistics_value};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// The measurement for people.
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
    let c = &a.cost;
    write!(out, "\ncost: {} passes", c.passes)?;
    if c.dropped_passes > 0 {
        write!(out, " ({} more are left out)", c.dropped_passes)?;
    }
    writeln!(
        out,
        " of at most {} general stages and {} texture units, {} vertices",
        c.most_stages, c.most_units, c.vertices
    )?;
    for (name, value) in per_pixel(a) {
        writeln!(out, "  {:<20}{value:>9.3} a final pixel", name.replace('_', " "))?;
    }
    Ok(())
}

/// Amounts for each final pixel.
fn per_pixel(a: &Accuracy) -> [(&'static str, f64); 7] {
    let c = &a.cost;
    [
        ("fragments", c.fragments),
        ("texture_fetches", c.fetches),
        ("texels", c.texels),
        ("general_stages", c.stages),
        ("products", c.products),
        ("blends", c.blends),
        ("frame_buffer_bytes", c.frame_buffer_bytes),
    ]
}

/// The measurement for programs: an object of a JSON document.
pub fn accuracy_value(a: &Accuracy) -> Value {
    let channels: Map<String, Value> =
        ["r", "g", "b"].iter().zip(&a.channels).map(|(name, e)| ((*name).to_owned(), statistics_value(e))).collect();
    let causes: Vec<Value> = a
        .causes
        .iter()
        .map(|cause| {
            let mut value = statistics_value(&cause.errors);
            value["cause"] = cause.name.into();
            value
        })
        .collect();
    let normals = a.normals.as_ref().map(|normals| {
        let (degrees, lengths) = (&normals.degrees, &normals.lengths);
        json!({
            "mean_degrees": degrees.mean(), "max_degrees": degrees.max(),
            "shortest": lengths.low, "longest": lengths.high,
        })
    });
    let per_pixel: Map<String, Value> = per_pixel(a).into_iter().map(|(name, n)| (name.to_owned(), n.into())).collect();
    let (b, c) = (&a.banding, &a.cost);
    json!({
        "width": a.width, "height": a.height, "pixels": a.pixels, "without_truth": a.without,
        "errors": statistics_value(&a.errors),
        "channels": channels,
        "causes": causes,
        "normals": normals,
        "highlight": {
            "pixels": b.pixels, "levels": b.levels, "truth_levels": b.truth_levels,
            "flat_run": b.flat_run, "truth_flat_run": b.truth_flat_run,
        },
        "cost": {
            "passes": c.passes, "dropped_passes": c.dropped_passes, "most_stages": c.most_stages, "most_units": c.most_units,
            "vertices": c.vertices, "per_final_pixel": per_pixel,
        },
    })
}
