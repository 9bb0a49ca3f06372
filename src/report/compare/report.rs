//! Prints a comparison as text and as JSON.
#![allow(clippy::float_arithmetic, reason = "display of errors")]

use super::statistics::BINS;
use super::{ChannelError, Comparison, DecisionCount, Mode, RuleError, Statistics, WorstPixel};
use crate::{policies_text, policies_value, written};
use ninebit::combiner::registers::channel_name;
use ninebit::plan::Plan;
use ninebit::state::Named;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// Returns the comparison as text.
pub fn comparison_text(plan: &Plan, comparison: &Comparison) -> String {
    written(|out| write(out, plan, comparison))
}

fn write(out: &mut String, plan: &Plan, c: &Comparison) -> std::fmt::Result {
    let Comparison { target, width, height, drawn, .. } = c;
    let target = ninebit::shown::name(target);
    writeln!(out, "target `{target}`, {width} x {height}, profile {}, mode {}", plan.profile.name(), c.mode.name())?;
    write!(out, "{}", policies_text(&plan.policies))?;
    writeln!(out, "errors are the model minus the ideal, in steps of 1/255; drawn: {drawn} pixels")?;
    if c.mode == Mode::Free {
        writeln!(out, "left out, because a decision differs: {} pixels", c.diverged)?;
    }
    if !c.channels.is_empty() {
        writeln!(out, "\nchannel      count      max     mean      rms     bias     psnr")?;
        for ChannelError { channel, errors, .. } in &c.channels {
            let psnr = errors.psnr();
            let psnr = if psnr.is_finite() { format!("{psnr:.2} dB") } else { "exact".to_string() };
            writeln!(out, "{:<7}{:>11}{}{psnr:>11}", channel_name(*channel), errors.count, moments(errors))?;
        }
        write_histogram(out, c)?;
    }
    if c.mode == Mode::Follow {
        writeln!(out, "\npart                  max     mean      rms     bias   what it adds to the error")?;
        for (part, errors) in &c.parts {
            writeln!(out, "{:<16}{}", part.name(), moments(errors))?;
        }
        writeln!(out, "the parts of every pixel add up to its error within {:.1e}", c.unexplained)?;
    }
    if c.mode == Mode::PerOp {
        writeln!(out, "\nrule         count       low      high     mean      rms     bias   bound")?;
        for rule in &c.rules {
            let e = &rule.errors;
            let bound = match rule.bound {
                None => "not stated".to_string(),
                Some((low, high)) => {
                    let exceeded = if rule.exceeds() { "  EXCEEDED" } else { "" };
                    format!("{low:.3} to {high:.3}{exceeded}")
                }
            };
            let (rule, count, low, high) = (rule.rule.name(), e.count, e.low, e.high);
            let (mean, rms, bias) = (e.mean(), e.rms(), e.bias());
            writeln!(out, "{rule:<7}{count:>11}{low:>10.4}{high:>10.4}{mean:>9.4}{rms:>9.4}{bias:>9.4}   {bound}")?;
        }
        writeln!(out, "INT-4, TEX-9, TEX-12, TEX-15, TSH-4, TSH-6 and TSH-7 count in 256ths of a texel or level")?;
    }
    if !c.decisions.is_empty() {
        writeln!(out, "\ndecision               taken   the ideal differs")?;
        for d in &c.decisions {
            writeln!(out, "{:<18}{:>10}{:>20}", d.decision.name(), d.taken, d.differing)?;
        }
    }
    if !c.worst.is_empty() {
        writeln!(out, "\nworst pixels    channel  model      ideal    error")?;
        for w in &c.worst {
            let place = format!("{},{}", w.x, w.y);
            let (channel, shown, ideal) = (channel_name(w.channel), w.shown, w.ideal);
            writeln!(out, "{place:<16}{channel:<7}{shown:>7}{ideal:>11.4}{:>9.4}", w.error())?;
        }
        writeln!(out, "`ninebit trace SCENE --pixel X,Y` shows how such a pixel came to be")?;
    }
    Ok(())
}

fn moments(errors: &Statistics) -> String {
    format!("{:>9.4}{:>9.4}{:>9.4}{:>9.4}", errors.max(), errors.mean(), errors.rms(), errors.bias())
}

/// Returns the name of a bin: the error rounded to whole steps.
fn bin_name(bin: usize) -> String {
    match bin as i64 - (BINS / 2) as i64 {
        -8 => "<= -8".to_string(),
        8 => ">= 8".to_string(),
        n => format!("{n:+}").replace("+0", "0"),
    }
}

fn write_histogram(out: &mut String, c: &Comparison) -> std::fmt::Result {
    write!(out, "\nsteps  ")?;
    for ChannelError { channel, .. } in &c.channels {
        write!(out, "{:>10}", channel_name(*channel))?;
    }
    writeln!(out)?;
    for bin in (0..BINS).filter(|bin| c.channels.iter().any(|c| c.histogram.0[*bin] > 0)) {
        write!(out, "{:>5}  ", bin_name(bin))?;
        for ChannelError { histogram, .. } in &c.channels {
            write!(out, "{:>10}", histogram.0[bin])?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Returns the comparison as a JSON document.
pub fn comparison_json(plan: &Plan, c: &Comparison) -> String {
    let channel = |error: &ChannelError| {
        let bins = (0..BINS).filter(|bin| error.histogram.0[*bin] > 0);
        let bins: Map<String, Value> = bins.map(|bin| (bin_name(bin), error.histogram.0[bin].into())).collect();
        let mut value = statistics_value(&error.errors);
        value["histogram"] = bins.into();
        (channel_name(error.channel).to_string(), value)
    };
    let channels: Map<String, Value> = c.channels.iter().map(channel).collect();
    let parts: Value = c.parts.iter().map(|(part, e)| named(part.name(), "part", e)).collect();
    let rule = |rule: &RuleError| {
        let mut value = named(rule.rule.name(), "rule", &rule.errors);
        value["bound"] = rule.bound.map_or(Value::Null, |(low, high)| json!([low, high]));
        value["exceeds"] = rule.exceeds().into();
        value
    };
    let decision =
        |d: &DecisionCount| json!({ "decision": d.decision.name(), "taken": d.taken, "differing": d.differing });
    let worst = |w: &WorstPixel| {
        let channel = channel_name(w.channel);
        json!({ "x": w.x, "y": w.y, "channel": channel, "model": w.shown, "ideal": w.ideal, "error": w.error() })
    };
    let value = json!({
        "format": "ninebit-comparison-1",
        "version": env!("CARGO_PKG_VERSION"),
        "profile": plan.profile.name(),
        "policies": policies_value(&plan.policies),
        "mode": c.mode.name(),
        "target": c.target,
        "width": c.width,
        "height": c.height,
        "drawn": c.drawn,
        "left_out": c.diverged,
        "channels": channels,
        "parts": parts,
        "unexplained": c.unexplained,
        "rules": c.rules.iter().map(rule).collect::<Value>(),
        "decisions": c.decisions.iter().map(decision).collect::<Value>(),
        "worst": c.worst.iter().map(worst).collect::<Value>(),
    });
    format!("{value:#}\n")
}

fn named(name: &str, kind: &str, errors: &Statistics) -> Value {
    let mut value = statistics_value(errors);
    value[kind] = name.into();
    value
}

/// Returns the moments of errors as a JSON object; `psnr` is null if there is no error.
pub fn statistics_value(e: &Statistics) -> Value {
    let psnr = Some(e.psnr()).filter(|psnr| psnr.is_finite());
    let (low, high) = if e.count == 0 { (0.0, 0.0) } else { (e.low, e.high) };
    json!({
        "count": e.count, "low": low, "high": high, "max": e.max(), "mean": e.mean(), "rms": e.rms(), "bias": e.bias(),
        "psnr": psnr,
    })
}
