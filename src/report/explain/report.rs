//! Prints an explanation as text and as JSON.

use super::{Cost, DrawExplanation};
use crate::work::ShadingWork;
use ninebit::engine::{self, DrawCounts};
use ninebit::plan::Plan;
use ninebit::shown;
use ninebit::state::{Named, Profile};
use ninebit::trace::Work;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// Returns the explanation as text. `counted` are the counts of a run, if there was one.
pub fn explanation_text(plan: &Plan, draws: &[DrawExplanation], counted: Option<&[DrawCounts]>) -> String {
    crate::written(|out| write(out, plan, draws, counted))
}

fn write(out: &mut String, plan: &Plan, draws: &[DrawExplanation], counted: Option<&[DrawCounts]>) -> std::fmt::Result {
    writeln!(out, "profile {}, {}", plan.profile.name(), shown::count(draws.len() as u64, "draw"))?;
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
        let sections = [("computed", &draw.equations), ("left out", &draw.dropped)];
        for (heading, lines) in sections.into_iter().filter(|(_, lines)| !lines.is_empty()) {
            writeln!(out, "  {heading}:")?;
            for line in lines {
                writeln!(out, "    {}", shown::name(line))?;
            }
        }
        write_cost(out, draw, counted.map(|all| &all[number]))?;
    }
    let shaded = ShadingWork::from_draws(
        draws.iter().map(|draw| engine::ShadedPixels { pixels: draw.cost.fragments, exact: draw.cost.exact }),
    );
    writeln!(out, "\nshaded pixels: {}", shaded.text())?;
    writeln!(out, "\nall draws{:>32}{:>16}", "after pruning", "as asked")?;
    let (kept, asked) = (total(draws, |draw| &draw.cost), total(draws, |draw| &draw.asked));
    for ((name, kept), (_, asked)) in kept.iter().zip(&asked).filter(|((_, kept), (_, asked))| kept + asked > 0) {
        writeln!(out, "    {name:<18}{kept:>19}{asked:>16}")?;
    }
    Ok(())
}

/// Writes the cost of a draw after pruning and as asked.
fn write_cost(out: &mut String, draw: &DrawExplanation, counted: Option<&DrawCounts>) -> std::fmt::Result {
    let (cost, asked) = (&draw.cost, &draw.asked);
    let most = if cost.tested { ", at most, because tests decide" } else { "" };
    let lod = if cost.lod_decides { "; texels and filter steps at most, because the lod decides" } else { "" };
    let bound = if cost.exact { "" } else { "at most " };
    writeln!(out, "  cost: {bound}{} fragments{most}{lod}", cost.fragments)?;
    writeln!(out, "{:>41}{:>16}", "after pruning", "as asked")?;
    for ((name, kept), (_, asked)) in cost.counts().iter().zip(asked.counts()).filter(|((_, n), (_, m))| n + m > 0) {
        writeln!(out, "    {name:<18}{kept:>19}{asked:>16}")?;
    }
    let (total, whole) = (cost.total(), asked.total());
    for (n, work) in Work::ALL.iter().enumerate().filter(|(n, _)| total[*n] + whole[*n] > 0) {
        let each = cost.fragment.shaded[n] + cost.fragment.stored[n];
        write!(out, "    {:<18}{each:>4} each{:>10}{:>16}", work.name(), total[n], whole[n])?;
        match counted {
            Some(counts) => writeln!(out, "   counted {}", counts.work[n])?,
            None => writeln!(out)?,
        }
    }
    Ok(())
}

/// Returns the total counts and work of all draws, by name.
fn total(draws: &[DrawExplanation], of: fn(&DrawExplanation) -> &Cost) -> Vec<(&'static str, u64)> {
    let mut all: Vec<(&'static str, u64)> = Vec::new();
    for draw in draws {
        let cost = of(draw);
        let work = Work::ALL.iter().map(|work| work.name()).zip(cost.total());
        for (n, (name, amount)) in cost.counts().into_iter().chain(work).enumerate() {
            match all.get_mut(n) {
                Some((_, sum)) => *sum = sum.saturating_add(amount),
                None => all.push((name, amount)),
            }
        }
    }
    all
}

/// Returns the explanation as a JSON document.
pub fn explanation_json(plan: &Plan, draws: &[DrawExplanation], counted: Option<&[DrawCounts]>) -> String {
    let amounts = |amounts: &[u64]| -> Map<String, Value> {
        Work::ALL.iter().zip(amounts).map(|(work, n)| (work.name().replace(' ', "_"), (*n).into())).collect()
    };
    let cost = |cost: &Cost| {
        let counts: Map<String, Value> =
            cost.counts().iter().map(|(name, n)| (name.replace(' ', "_"), (*n).into())).collect();
        json!({
            "counts": counts,
            "fragments": cost.fragments,
            "exact": cost.exact,
            "tested": cost.tested,
            "kills": cost.kills,
            "lod_decides": cost.lod_decides,
            "each_shaded": amounts(&cost.fragment.shaded),
            "each_stored": amounts(&cost.fragment.stored),
            "total": amounts(&cost.total()),
        })
    };
    let draw = |(number, draw): (usize, &DrawExplanation)| {
        let mut value = json!({
            "name": draw.name, "target": draw.target, "program": draw.program, "equations": draw.equations, "left_out": draw.dropped,
            "cost": cost(&draw.cost), "cost_as_asked": cost(&draw.asked),
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
    };
    let value = json!({
        "format": "ninebit-explanation-1",
        "version": env!("CARGO_PKG_VERSION"),
        "profile": plan.profile.name(),
        "draws": draws.iter().enumerate().map(draw).collect::<Value>(),
    });
    format!("{value:#}\n")
}
