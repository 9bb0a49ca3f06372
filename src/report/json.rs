//! Prints a trace as a JSON document; `docs/trace-format.md` describes it.

use super::text::integer;
use ninebit::engine::{DrawTrace, PixelTrace, TraceEnd, Tracer};
use ninebit::plan::Plan;
use ninebit::raster::project::ClipPlane;
use ninebit::raster::stroke::Figure;
use ninebit::shown;
use ninebit::state::{Named, POLICIES, Policies, Policy, StageOrigin, Texture};
use ninebit::trace::{Operand, SINGLE, Step, TexelAddress};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io;

/// Version of the document's format.
const VERSION: u32 = 2;

/// Returns the trace of a pixel as a JSON document that ends in a newline.
pub fn trace_json(plan: &Plan, trace: &PixelTrace) -> String {
    let mut text = serde_json::to_string_pretty(&trace_value(plan, trace)).unwrap_or_default();
    text.push('\n');
    text
}

/// Writes the same document while the pixel is traced, fragment by fragment.
///
/// # Errors
/// Those of `out`.
pub fn write_trace_json(out: &mut dyn io::Write, plan: &Plan, tracer: &Tracer<'_>) -> io::Result<()> {
    let pretty = |value: &Value| shown::json(&serde_json::to_string_pretty(value).unwrap_or_default()).into_owned();
    let cleared = tracer.cleared();
    let head = pretty(&json!({ "cleared": cleared }));
    write!(out, "{},\n  \"draws\": [", head.trim_end_matches("\n}"))?;
    let mut between = "\n    ";
    let end = tracer.run(|fragment| {
        let text = pretty(&draw(plan, &fragment)).replace('\n', "\n    ");
        write!(out, "{}{text}", std::mem::replace(&mut between, ",\n    "))
    })?;
    let closing = if between.starts_with(',') { "\n  ]" } else { "]" };
    let (x, y) = tracer.pixel();
    let (target, left_out, TraceEnd { shown, word }) = (tracer.target().name.clone(), tracer.left_out(), end);
    let mut rest = trace_value(plan, &PixelTrace { target, x, y, cleared, shown, word, left_out, draws: Vec::new() });
    if let Some(fields) = rest.as_object_mut() {
        for written in ["cleared", "draws"] {
            fields.remove(written);
        }
    }
    writeln!(out, "{closing},{}", pretty(&rest).trim_start_matches('{'))
}

/// Writes one document with the traces of all pixels of a rectangle, row by row.
///
/// # Errors
/// Those of `out`.
pub fn write_traces_json(out: &mut dyn io::Write, plan: &Plan, tracers: &[Tracer<'_>]) -> io::Result<()> {
    write!(out, "{{\n\"format\": \"ninebit-traces\",\n\"version\": {VERSION},\n\"pixels\": [\n")?;
    for (n, tracer) in tracers.iter().enumerate() {
        if n > 0 {
            writeln!(out, ",")?;
        }
        write_trace_json(out, plan, tracer)?;
    }
    writeln!(out, "]\n}}")
}

/// Returns the same document as a value, to be embedded in another one.
pub fn trace_value(plan: &Plan, trace: &PixelTrace) -> Value {
    let mut value = json!({
        "format": "ninebit-trace",
        "version": VERSION,
        "profile": plan.profile.name(),
        "policies": policies_value(&plan.policies),
        "target": trace.target,
        "pixel": [trace.x, trace.y],
        "cleared": trace.cleared,
        "shown": trace.shown,
        "word": trace.word,
    });
    // Assigned here because `json!` would copy the value with all its content.
    value["draws"] = trace.draws.iter().map(|fragment| draw(plan, fragment)).collect();
    if trace.left_out > 0 {
        value["left_out"] = json!(trace.left_out);
    }
    if let Some(text) = beyond_31_bits(i64::from(trace.word), SINGLE) {
        value["word_text"] = json!(text);
    }
    value
}

/// Returns an integer as text if it needs more than 31 bits and a sign, which not every reader's integers hold.
fn beyond_31_bits(value: i64, per_one: i64) -> Option<String> {
    i32::try_from(value).is_err().then(|| integer(value, per_one))
}

/// Returns the value of every policy as a JSON object.
pub fn policies_value(policies: &Policies) -> Value {
    let value = |p: &Policy| (p.rule.to_string(), json!(p.values[policies.chosen(p.rule)].0));
    Value::Object(POLICIES.iter().map(value).collect())
}

/// Returns steps as in the document of a trace.
pub fn steps_value(steps: &[Step]) -> Value {
    numbered(steps, &[])
}

/// Returns steps with their ids. `textures` are those of the scene.
fn numbered(steps: &[Step], textures: &[Texture]) -> Value {
    // A later step replaces an earlier one of the same name.
    let mut made = HashMap::new();
    let mut values = Vec::with_capacity(steps.len());
    for (id, each) in steps.iter().enumerate() {
        values.push(step(each, id, &made, textures));
        made.insert(each.name.as_str(), id);
    }
    Value::Array(values)
}

fn draw(plan: &Plan, draw: &DrawTrace) -> Value {
    let mut value = json!({
        "draw": draw.draw,
        "name": draw.name,
        "triangle": draw.triangle,
        "stored": draw.stored,
        "shown": draw.shown,
        "program_origin": origins(&draw.program_origin),
    });
    value["steps"] = numbered(&draw.steps, plan.textures());
    if draw.figure != Figure::Triangle {
        value["figure"] = draw.figure.name().into();
    }
    if let Some(piece) = &draw.piece {
        let planes: Vec<&str> = ClipPlane::in_set(piece.planes).map(|plane| plane.name()).collect();
        value["clipped"] = json!({ "triangle": piece.of, "planes": planes });
    }
    value
}

/// Returns the text that each general stage was made from.
pub fn origins(origins: &[StageOrigin]) -> Value {
    origins.iter().map(|origin| json!({ "rgb": origin.rgb, "alpha": origin.alpha })).collect()
}

fn step(step: &Step, id: usize, made: &HashMap<&str, usize>, textures: &[Texture]) -> Value {
    let mut value = json!({
        "id": id,
        "block": step.block,
        "rule": step.rule,
        "name": step.name,
        "operation": step.operation,
        "value": step.value,
        "per_one": step.per_one,
        "real": step.real(),
        "ideal": step.ideal,
        "note": step.note,
    });
    value["inputs"] = step.inputs.iter().map(|input| operand(input, made.get(input.name.as_str()))).collect();
    if let Some(text) = beyond_31_bits(step.value, step.per_one) {
        value["value_text"] = json!(text);
    }
    if step.exponent != 0 {
        value["exponent"] = json!(step.exponent);
    }
    if let Some(TexelAddress { texture, face, level, at: [x, y] }) = step.texel {
        let name = textures.get(texture).map(|texture| texture.name.as_str());
        let word = format!("{:#010x}", step.value);
        value["texel"] =
            json!({ "texture": texture, "name": name, "face": face, "level": level, "x": x, "y": y, "word": word });
    }
    value
}

fn operand(operand: &Operand, step: Option<&usize>) -> Value {
    let mut value = json!({ "name": operand.name, "value": operand.value, "per_one": operand.per_one });
    if let Some(text) = beyond_31_bits(operand.value, operand.per_one) {
        value["value_text"] = json!(text);
    }
    if operand.exponent != 0 {
        value["exponent"] = json!(operand.exponent);
    }
    if let Some(step) = step {
        value["step"] = json!(step);
    }
    value
}
