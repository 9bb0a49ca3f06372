//! An explanation as text and as JSON.

use super::{Cost, DrawExplanation};
use ninebit::engine::DrawCounts;
use ninebit::plan::Plan;
use ninebit::shown;
use ninebit::state::{Named, Profile};
use ninebit::trace::Work;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// The explanation for people. `counted` are the counts of a run, if there was one.
pub fn explanation_text(plan: &Plan, draws: &[DrawExplanation], counted: Option<&[DrawCounts]>) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut out, plan, draws, counted);
    out
}

fn write(out: &mut String, plan: &Plan, draws: &[DrawExplanation], counted: Option<&[DrawCounts]>) -> std::fmt::Result {
    let plural = if draws.len() == 1 { "" } else { "s" };
    writeln!(out, "profile {}, {} draw{plural}", plan.profile.name(), draws.len())?;
    for (number, draw) in draws.iter().enumerate() {
        writeln!(out, "\ndraw {number} `{}` to `{}`", shown::name(&draw.name), shown::name(&draw.target))?;
        if let Some((program, vertices)) = &draw.vertex_program {
            let slots = format!("{} instructions, {} slots", program.instructions, program.slots);
            let who = match plan.profile {
                Profile::Nv10 => ", run by the driver: the chip has no vertex programs",
                Profile::Nv2a => "",
            };
            writeln!(out, "  vertex program: {slots}, for each of {vertices} vertices{who}")?;
            for line in program.text.lines() {
                writeln!(out, "    {}", shown::lines(line))?;
            }
        }
        if let Some(clipping) = &draw.clipping {
            writeln!(out, "  clipping (RAS-6): {clipping}")?;
        }
        writeln!(out, "  program:")?;
        for line in draw.program.lines() {
            writeln!(out, "    {}", shown::lines(line))?;
        }
        if !draw.program_origin.is_empty() {
            writeln!(out, "  written as:")?;
        }
        for (stage, origin) in draw.program_origin.iter().enumerate() {
            writeln!(out, "    general stage {stage} rgb: {}", shown::name(&origin.rgb))?;
            writeln!(out, "    general stage {stage} alpha: {}", shown::name(&origin.alpha))?;
        }
        if !draw.equations.is_empty() {
            writeln!(out, "  computed:")?;
        }
        for line in &draw.equations {
            writeln!(out, "    {}", shown::name(line))?;
        }
        if !draw.dropped.is_empty() {
            writeln!(out, "  left out:")?;
            for line in &draw.dropped {
                writeln!(out, "    {}", shown::name(line))?;
            }
        }
        let cost = &draw.cost;
        let most = if cost.tested { ", at most, because tests decide" } else { "" };
        let lod = if cost.lod_decides { "; texels and filter steps at most, because the lod decides" } else { "" };
        writeln!(out, "  cost: {} fragments{most}{lod}", cost.fragments)?;
        let counted = counted.map(|all| &all[number]);
        let total = cost.total();
        for (n, work) in Work::ALL.iter().enumerate().filter(|(n, _)| total[*n] > 0) {
            let each = cost.fragment.shaded[n] + cost.fragment.stored[n];
            write!(out, "    {:<18}{each:>4} each{:>14}", work.name(), total[n])?;
            match counted {
                Some(counts) => writeln!(out, "   counted {}", counts.work[n])?,
                None => writeln!(out)?,
            }
        }
    }
    writeln!(out, "\nall draws")?;
    for (n, work) in Work::ALL.iter().enumerate() {
        let total: u64 = draws.iter().map(|draw| draw.cost.total()[n]).sum();
        if total > 0 {
            writeln!(out, "    {:<18}{total:>23}", work.name())?;
        }
    }
    Ok(())
}

/// The explanation for programs: one JSON document.
pub fn explanation_json(plan: &Plan, draws: &[DrawExplanation], counted: Option<&[DrawCounts]>) -> String {
    let amounts = |amounts: &[u64]| -> Map<String, Value> {
        Work::ALL.iter().zip(amounts).map(|(work, n)| (work.name().replace(' ', "_"), (*n).into())).collect()
    };
    let cost = |cost: &Cost| {
        json!({
            "fragments": cost.fragments,
            "tested": cost.tested,
            "kills": cost.kills,
            "lod_decides": cost.lod_decides,
            "each_shaded": amounts(&cost.fragment.shaded),
            "each_stored": amounts(&cost.fragment.stored),
            "total": amounts(&cost.total()),
        })
    };
    let draws: Vec<Value> = draws
        .iter()
        .enumerate()
        .map(|(number, draw)| {
            let mut value = json!({
                "name": draw.name, "target": draw.target, "program": draw.program, "equations": draw.equations, "left_out": draw.dropped,
                "cost": cost(&draw.cost),
            });
            if let Some(clipping) = &draw.clipping {
                value["clipping"] = json!(clipping);
            }
            if !draw.program_origin.is_empty() {
                value["program_origin"] = crate::origins(&draw.program_origin);
            }
            if let Some((program, vertices)) = &draw.vertex_program {
                value["vertex_program"] = json!({
                    "text": program.text, "instructions": program.instructions, "slots": program.slots, "vertices": vertices,
                });
            }
            if let Some(counts) = counted.map(|all| &all[number]) {
                value["counted"] = json!({
                    "fragments": counts.fragments, "stored": counts.stored, "work": amounts(&counts.work),
                });
            }
            value
        })
        .collect();
    let value = json!({
        "format": "ninebit-explanation-1",
        "version": env!("CARGO_PKG_VERSION"),
        "profile": plan.profile.name(),
        "draws": draws,
    });
    format!("{value:#}\n")
}
