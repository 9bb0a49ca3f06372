//! Prints a trace as text, one line per step: the integer, its real value, the ideal and the rule.

use ninebit::engine::{DrawTrace, PixelTrace, TraceEnd, Tracer};
use ninebit::plan::Plan;
use ninebit::raster::project::ClipPlane;
use ninebit::shown;
use ninebit::state::{Named, POLICIES, Policies};
use ninebit::texture::cube::Face;
use ninebit::trace::{Operand, SINGLE, Step};
use ninebit_handbook::{GRADES, mark};
use std::fmt::Write;
use std::io;

use crate::written;

/// Returns the trace of a pixel as text.
pub fn trace_text(plan: &Plan, trace: &PixelTrace) -> String {
    let PixelTrace { target, x, y, cleared, left_out, .. } = trace;
    written(|out| {
        write_head(out, plan, target, (*x, *y), *cleared, *left_out)?;
        trace.draws.iter().try_for_each(|draw| write_draw(out, draw))?;
        write_end(out, trace.draws.is_empty(), &TraceEnd { shown: trace.shown, word: trace.word })
    })
}

/// Writes a trace as text while the pixel is traced, fragment by fragment.
///
/// # Errors
/// Those of `out`.
pub fn write_trace_text(out: &mut dyn io::Write, plan: &Plan, tracer: &Tracer<'_>) -> io::Result<()> {
    let (target, cleared, left_out) = (&tracer.target().name, tracer.cleared(), tracer.left_out());
    write!(out, "{}", written(|out| write_head(out, plan, target, tracer.pixel(), cleared, left_out)))?;
    let mut empty = true;
    let end = tracer.run(|draw| {
        empty = false;
        write!(out, "{}", written(|out| write_draw(out, &draw)))
    })?;
    write!(out, "{}", written(|out| write_end(out, empty, &end)))
}

fn write_head(
    out: &mut String,
    plan: &Plan,
    target: &str,
    (x, y): (u32, u32),
    cleared: [u8; 4],
    left_out: u64,
) -> std::fmt::Result {
    let [r, g, b, a] = cleared;
    writeln!(out, "pixel {x},{y} of target `{}`, profile {}", shown::name(target), plan.profile.name())?;
    write!(out, "{}", policies_text(&plan.policies))?;
    let is_given = plan.targets().iter().any(|other| other.name == *target && other.contents.is_some());
    writeln!(out, "{} R {r} G {g} B {b} A {a}", if is_given { "begins as" } else { "cleared to" })?;
    match left_out {
        0 => Ok(()),
        1 => writeln!(out, "\nthe first fragment is left out: `--fragments N` shows the last N"),
        left_out => writeln!(out, "\nthe first {left_out} fragments are left out: `--fragments N` shows the last N"),
    }
}

fn write_end(out: &mut String, empty: bool, end: &TraceEnd) -> std::fmt::Result {
    if empty {
        writeln!(out, "\nno triangle covers this pixel")?;
    }
    let [r, g, b, a] = end.shown;
    writeln!(out, "\nat the end the surface holds {:#010x}, shown as R {r} G {g} B {b} A {a}", end.word)?;
    writeln!(out, "{}", legend())
}

/// Returns a rule's id with the letters of its grades, for a column.
pub(super) fn graded(rule: &str) -> String {
    match mark(rule) {
        "" => rule.to_owned(),
        mark => format!("{rule:6} {mark}"),
    }
}

/// Returns the line that says what letters beside rules mean.
pub(super) fn legend() -> String {
    let letters: Vec<String> = GRADES.iter().map(|grade| format!("{} {grade}", &grade[..1])).collect();
    format!(
        "grades beside rules: {} (further letters are of parts); `ninebit rule ID` prints a rule",
        letters.join(", ")
    )
}

/// Returns the policies that differ from the default, one per line.
pub fn policies_text(policies: &Policies) -> String {
    let mut out = String::new();
    for policy in POLICIES {
        let chosen = policies.chosen(policy.rule);
        if chosen != 0 {
            let (value, meaning) = policy.values[chosen];
            let _ = writeln!(out, "policy {}={value}: {meaning}", policy.rule);
        }
    }
    out
}

/// Returns steps as a table: one line each, under the name of their hardware block.
pub fn steps_text(steps: &[Step]) -> String {
    written(|out| {
        write_steps(out, steps, |_| None)?;
        if steps.iter().any(|step| !step.rule.is_empty()) { writeln!(out, "  {}", legend()) } else { Ok(()) }
    })
}

fn write_draw(out: &mut String, draw: &DrawTrace) -> std::fmt::Result {
    let (draw_name, figure) = (shown::name(&draw.name), draw.figure.name());
    write!(out, "\ndraw {} `{draw_name}`, {figure} {}", draw.draw, draw.triangle)?;
    match &draw.piece {
        Some(piece) => writeln!(out, ", cut off {figure} {} (RAS-6: {})", piece.of, ClipPlane::names(piece.planes))?,
        None => writeln!(out)?,
    }
    write_steps(out, &draw.steps, |block| draw.origin(block))?;
    let [r, g, b, a] = draw.shown;
    let outcome = if draw.stored { "stored" } else { "dropped; the surface still shows" };
    writeln!(out, "  {outcome}: R {r} G {g} B {b} A {a}")
}

fn write_steps<'o>(out: &mut String, steps: &[Step], origin: impl Fn(&str) -> Option<&'o str>) -> std::fmt::Result {
    let mut block = "";
    let lines: Vec<(String, String)> = steps.iter().map(|s| (s.name.clone(), expression(s))).collect();
    // A few long names do not widen the columns of all others.
    let width =
        |f: fn(&(String, String)) -> usize, most: usize| lines.iter().map(f).filter(|w| *w <= most).max().unwrap_or(0);
    let (names, expressions) = (width(|l| l.0.chars().count(), 40), width(|l| l.1.chars().count(), 58));
    let integers = steps.iter().map(|s| step_value(s).len()).max().unwrap_or(0).max(7);
    writeln!(
        out,
        "    {:names$}  {:expressions$}  {:>integers$} {:>10} {:>10}  rule",
        "what", "how", "integer", "real", "ideal"
    )?;
    for (step, (name, expression)) in steps.iter().zip(&lines) {
        if step.block != block {
            block = &step.block;
            match origin(block) {
                Some(origin) => writeln!(out, "  {block}: {}", shown::name(origin))?,
                None => writeln!(out, "  {block}")?,
            }
        }
        let counts = step.per_one == 1 && step.exponent == 0;
        let real = if counts { String::new() } else { format!("{:.6}", step.real()) };
        let ideal = step.ideal.filter(|_| !counts).map_or(String::new(), |i| format!("{i:.6}"));
        let (mut name, mut expression) = (name.as_str(), expression.as_str());
        // What is wider than its column gets a line of its own, so that the numbers stay aligned.
        if name.chars().count() > names {
            writeln!(out, "    {name}")?;
            name = "";
        }
        if expression.chars().count() > expressions {
            writeln!(out, "    {name:names$}  {expression}")?;
            (name, expression) = ("", "");
        }
        let line = format!(
            "    {name:names$}  {expression:expressions$}  {:>integers$} {real:>10} {ideal:>10}  {}",
            step_value(step),
            graded(step.rule)
        );
        match &step.note {
            Some(note) => writeln!(out, "{line:<8}  {note}")?,
            None => writeln!(out, "{}", line.trim_end())?,
        }
    }
    Ok(())
}

/// Formats an integer; the bits of a single-precision number are hexadecimal.
pub(super) fn integer(value: i64, per_one: i64) -> String {
    if per_one == SINGLE { format!("{value:#010x}") } else { value.to_string() }
}

/// Formats the integer of a step with its power of two, if it has one.
pub(super) fn step_value(step: &Step) -> String {
    powered(integer(step.value, step.per_one), step.exponent)
}

fn powered(integer: String, exponent: i32) -> String {
    if exponent == 0 { integer } else { format!("{integer} 2^{exponent}") }
}

/// Formats an operand of a formula: its integer, or the single-precision number.
fn operand_text(operand: &Operand) -> String {
    match operand.per_one {
        SINGLE => f32::from_bits(operand.value as u32).to_string(),
        _ => powered(operand.value.to_string(), operand.exponent),
    }
}

/// Returns the formula of a step with the integers of its operands.
pub(super) fn expression(step: &Step) -> String {
    let value = |n: usize| step.inputs.get(n).map_or(String::new(), operand_text);
    let pairs = |inputs: &[Operand]| {
        let products: Vec<String> =
            inputs.chunks(2).map(|p| format!("{} * {}", p[0].value, p[p.len() - 1].value)).collect();
        products.join(" + ")
    };
    // The last parts of the operands' names.
    let name = |n: usize| step.inputs.get(n).map_or("", |input| input.name.rsplit('.').next().unwrap_or_default());
    match step.operation {
        "given" => String::new(),
        "product" | "dot_product" => pairs(&step.inputs),
        "edge_function" => format!("{} * {} + {} * {} + {}", value(0), value(3), value(1), value(4), value(2)),
        "stipple_bit" => {
            let x = step.inputs.get(1).map_or(0, |x| x.value);
            format!("bit {} of {}", x / 8 % 4 * 8 + 7 - x % 8, step.inputs.first().map_or("", |row| &row.name))
        }
        "cut_24" => format!("cut({})", name(0)),
        "cut_24_product" => format!("cut({} {})", name(0), name(1)),
        "edge_sum" => format!("{} + {} + {}, to 29 bits of the largest", name(0), name(1), name(2)),
        "reciprocal" => format!("1 / {} by Newton's method, 29 bits", name(0)),
        "rest_24" => format!("1 - {} - {}, up to 24 bits", name(0), name(1)),
        "float_difference" => format!("{} - {}", value(0), value(1)),
        "number" => name(0).to_owned(),
        "number_product" => format!("{} {}", name(0), name(1)),
        "align_24" => format!("{}, to 24 bits of the largest", name(0)),
        "number_sum" => format!("{} + {} + {}", name(0), name(1), name(2)),
        "floor_weight" => format!("floor(256 {})", name(0)),
        "signed_weight" => format!("256 {}, toward zero", name(0)),
        "cover" => format!("floor({} * {} / 8)", value(0), value(1)),
        "remainder_weight" => format!("256 - {} - {}", value(0), value(1)),
        "interpolate" | "interpolate_within" => {
            let products = [0, 1, 2].map(|n| format!("{} * {}", value(n), value(n + 3)));
            let limits = if step.operation == "interpolate" { "" } else { ", within the three colours" };
            format!("({} + 128) >> 8{limits}", products.join(" + "))
        }
        "floor_coordinate" => format!("floor(256 * {} * {})", value(1), name(0)),
        "quad_coordinate" => format!("floor(65536 * {} * {})", value(1), name(0)),
        "floor_ratio" => format!("floor(256 * {} * {} / {})", value(2), name(0), name(1)),
        "quad_ratio" => format!("floor(65536 * {} * {} / {})", value(2), name(0), name(1)),
        "floor_on_plane_u" | "floor_on_plane_v" | "quad_on_plane_u" | "quad_on_plane_v" => {
            let ((s, m), steps) = (on_face(step), if step.operation.starts_with("quad") { 65536 } else { 256 });
            let sign = if step.operation.ends_with('v') { "-" } else { "" };
            format!("floor({sign}{steps} * {} * {} / {})", value(4), decimal(s), decimal(m))
        }
        "floor_on_face_u" | "floor_on_face_v" | "quad_on_face_u" | "quad_on_face_v" => {
            let steps = if step.operation.starts_with("quad") { 32768 } else { 128 };
            let sign = if step.operation.ends_with('v') { '-' } else { '+' };
            let (size, by) =
                if step.inputs.len() == 2 { (value(1), String::new()) } else { (value(2), format!(" / {}", name(1))) };
            format!("floor({steps} * {size} * (1 {sign} {}{by}))", name(0))
        }
        "cube_face" => {
            let [x, y, z] = [0, 1, 2].map(|n| step.inputs.get(n).map_or(0.0, real));
            format!("largest of ({}, {}, {})", decimal(x), decimal(y), decimal(z))
        }
        "floor_face_u" | "floor_face_v" | "quad_face_u" | "quad_face_v" => {
            let ((s, m), steps) = (on_face(step), if step.operation.starts_with("quad") { 32768 } else { 128 });
            format!("floor({steps} * {} * (1 + {} / {}))", value(4), decimal(s), decimal(m))
        }
        "log2_ratio" => {
            let moved = |pixel: usize, n: usize| {
                let at = |k: usize| step.inputs.get(k).map_or(0, |o| o.value);
                at(2 * pixel + n).saturating_sub(at(n))
            };
            format!("256 log2 |({}, {}) or ({}, {})|", moved(1, 0), moved(1, 1), moved(2, 0), moved(2, 1))
        }
        "biased_lod" => format!("{} + {}, limited to {}..{}", value(0), value(1), value(2), value(3)),
        "nearest_level" => format!("({} + 128) >> 8, at most {} - 1", value(0), value(1)),
        "lower_level" => format!("{} >> 8, at most {} - 1", value(0), value(1)),
        "upper_level" => format!("({} >> 8) + 1, at most {} - 1", value(0), value(1)),
        "lod_weight" => format!("{} & 255", value(0)),
        "high_byte" => format!("{} >> 8", value(0)),
        "high_byte_doubled" => format!("2 * ({} >> 8)", value(0)),
        "low_byte" => format!("{} & 255", value(0)),
        "nearest_float" => format!("nearest float to {}", name(0)),
        "floor_number" | "floor_factor" => format!("floor(4096 {})", name(0)),
        "fog_steps" => format!("floor(4096 {}) - 6144", name(0)),
        "is_negative" => format!("{} < 0", name(0)),
        "is_not_negative" => format!("{} >= 0", name(0)),
        "floor_moved" => format!("floor(256 * {} * ({} + {} / 128))", value(2), name(0), value(1)),
        "float_product" => format!("{} * {}", value(0), value(1)),
        "float_sum" => format!("{} + {} + {}, to 24 bits of the largest", value(0), value(1), value(2)),
        "float_double" => format!("2 * {}", value(0)),
        "float_reflection" => {
            format!("{} * {} - {} * {}, to 24 bits of the larger", value(0), value(1), value(2), value(3))
        }
        "luminance" => format!("4096 * {} / 255 * ({} / 255 * {} + {})", value(0), value(1), value(2), value(3)),
        "convert_yuv_red" => {
            format!("(149 * {} >> 7) + 2 * (409 * {} >> 9) - 223, limited to 0..255", value(0), value(2))
        }
        "convert_yuv_green" => format!(
            "(149 * {} >> 7) - 2 * (100 * {} >> 9) - 2 * (208 * {} >> 9) + 136, limited to 0..255",
            value(0),
            value(1),
            value(2)
        ),
        "convert_yuv_blue" => format!("(149 * {} >> 7) + (129 * {} >> 6) - 277, limited to 0..255", value(0), value(1)),
        "bump_offset" => format!("{} * s8({}) + {} * s8({})", value(0), value(2), value(1), value(3)),
        "nearest_texel" => format!("{} >> 8", value(0)),
        "linear_texel" => format!("({} - 128) >> 8", value(0)),
        "linear_texel_next" => format!("(({} - 128) >> 8) + 1", value(0)),
        "linear_weight" => format!("({} - 128) & 255", value(0)),
        "mix" => format!("({} * (256 - {}) + {} * {} + 128) >> 8", value(0), value(2), value(1), value(2)),
        "expand_texel" | "expand_texel_signed" | "read_surface" => {
            let (format, channel) = (&step.inputs[1].name, &step.inputs[2].name);
            format!("{channel} of {} as {format}", step.inputs[0].name)
        }
        "fetch" => format!("texel ({}, {})", value(0), value(1)),
        "round_255" => format!("nearest 255th of {}", value(0)),
        "bias" => format!("{} - 128", value(0)),
        "scale_2" => format!("{} * 2", value(0)),
        "scale_4" => format!("{} * 4", value(0)),
        "scale_half" => format!("({} + 1) >> 1", value(0)),
        "lerp_add" => {
            // FIN-1: A counts as 255 at most.
            let a = step.inputs.first().map_or(0, |a| a.value.min(255));
            format!("({a} * {} + (255 - {a}) * {}) / 255 + {}", value(1), value(2), value(3))
        }
        "blend_add" => format!("({} * {} + {} * {}) / 255", value(0), value(2), value(1), value(3)),
        "blend_subtract" => format!("({} * {} - {} * {}) / 255", value(0), value(2), value(1), value(3)),
        "blend_reverse_subtract" => format!("({} * {} - {} * {}) / 255", value(1), value(3), value(0), value(2)),
        "store" => {
            let channels: Vec<String> = step.inputs[3..].iter().map(|o| format!("{} {}", o.name, o.value)).collect();
            format!("{}({})", step.inputs[0].name, channels.join(", "))
        }
        operation => {
            let operands: Vec<String> = step.inputs.iter().map(|o| format!("{} {}", o.name, operand_text(o))).collect();
            format!("{operation}({})", operands.join(", "))
        }
    }
}

/// Returns the number of an operand that has a power of two.
#[allow(clippy::float_arithmetic, reason = "display of a number")]
fn real(operand: &Operand) -> f64 {
    operand.value as f64 * 2.0_f64.powi(operand.exponent)
}

/// Formats a number with at most six decimals.
fn decimal(number: f64) -> String {
    let text = format!("{number:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Returns the minor component for u or v, and the magnitude of the major one, for a step on a face.
#[allow(clippy::float_arithmetic, reason = "display of a number")]
fn on_face(step: &Step) -> (f64, f64) {
    let face = step.inputs.get(3).and_then(|face| Face::ALL.get(usize::try_from(face.value).ok()?));
    let [s, t, m] = face.copied().unwrap_or(Face::PositiveX).components().map(|c| {
        let component = step.inputs.get(c.axis).map_or(0.0, real);
        if c.negative { -component } else { component }
    });
    (if step.operation.ends_with('u') { s } else { t }, m)
}
