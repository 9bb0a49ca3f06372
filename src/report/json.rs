//! A trace as one JSON document; `docs/trace-format.md` describes it.

use crate::engine::{DrawTrace, PixelTrace};
use crate::plan::Plan;
use crate::raster::project::ClipPlane;
use crate::state::{Named, POLICIES, Policies, Policy, StageOrigin};
use crate::trace::{Operand, Step};
use serde_json::{Value, json};

/// Version of the document.
const VERSION: u32 = 1;

/// The trace of a pixel as one JSON document, ended by a newline.
pub fn trace_json(plan: &Plan, trace: &PixelTrace) -> String {
    let mut text = serde_json::to_string_pretty(&trace_value(plan, trace)).unwrap_or_default();
    text.push('\n');
    text
}

/// The same document as a value, to stand in another one.
pub fn trace_value(plan: &Plan, trace: &PixelTrace) -> Value {
    json!({
        "format": "ninebit-trace",
        "version": VERSION,
        "profile": plan.profile.name(),
        "policies": policies_value(&plan.policies),
        "target": trace.target,
        "pixel": [trace.x, trace.y],
        "cleared": trace.cleared,
        "shown": trace.shown,
        "word": trace.word,
        "draws": trace.draws.iter().map(draw).collect::<Vec<_>>(),
    })
}

/// Every policy's value.
pub fn policies_value(policies: &Policies) -> Value {
    let value = |p: &Policy| (p.rule.to_string(), json!(p.values[policies.chosen(p.rule)].0));
    Value::Object(POLICIES.iter().map(value).collect())
}

/// Steps as they stand in the document of a trace.
pub fn steps_value(steps: &[Step]) -> Value {
    Value::Array(steps.iter().map(step).collect())
}

fn draw(draw: &DrawTrace) -> Value {
    let mut value = json!({
        "draw": draw.draw,
        "name": draw.name,
        "triangle": draw.triangle,
        "stored": draw.stored,
        "shown": draw.shown,
        "program_origin": origins(&draw.program_origin),
        "steps": steps_value(&draw.steps),
    });
    if let Some(piece) = &draw.piece {
        let planes: Vec<&str> = ClipPlane::of(piece.planes).map(|plane| plane.name()).collect();
        value["clipped"] = json!({ "triangle": piece.of, "planes": planes });
    }
    value
}

/// What each general stage was written as.
pub(crate) fn origins(origins: &[StageOrigin]) -> Value {
    origins.iter().map(|origin| json!({ "rgb": origin.rgb, "alpha": origin.alpha })).collect()
}

fn step(step: &Step) -> Value {
    json!({
        "block": step.block,
        "rule": step.rule,
        "name": step.name,
        "operation": step.operation,
        "inputs": step.inputs.iter().map(operand).collect::<Vec<_>>(),
        "value": step.value,
        "per_one": step.per_one,
        "real": step.real(),
        "ideal": step.ideal,
        "note": step.note,
    })
}

fn operand(operand: &Operand) -> Value {
    json!({ "name": operand.name, "value": operand.value, "per_one": operand.per_one })
}
