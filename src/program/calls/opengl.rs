//! Reads what OpenGL's calls have in common: names, numbers, colours, capabilities.

use super::{Part, PartKind, Reader, Value, known, out_of_range, wrong_kind};
use crate::Span;
use crate::finding::finding;
use ninebit::diagnostic::{Diagnostic, shorten};
use ninebit::number::convert::constant;
use ninebit::shown;
use ninebit::state::Named;

/// Returns a name without its prefix and suffix: `GL_COMBINE_RGB_ARB` becomes `COMBINE_RGB`. Suffixes in `keep` are part of the name.
pub(crate) fn bare<'w>(word: &'w str, keep: &[&str]) -> &'w str {
    let word = word.strip_prefix("GL_").unwrap_or(word);
    let end = ["_NV", "_ARB", "_EXT"].into_iter().filter(|end| !keep.contains(end));
    end.into_iter().find_map(|end| word.strip_suffix(end)).unwrap_or(word)
}

/// Returns the entry of `table` that a value names. Returns `None` after recording that it names none.
pub(crate) fn choose<T: Copy>(
    value: &Value<'_>,
    what: &str,
    table: &[(&str, T)],
    findings: &mut Vec<Diagnostic>,
) -> Option<T> {
    let keep: &[&str] = if table.iter().any(|(name, _)| name.ends_with("_EXT")) { &["_EXT"] } else { &[] };
    match &value.parts[..] {
        [part] if matches!(part.kind, PartKind::Name) => {
            let name = bare(part.text, keep);
            // A suffix that is part of some names is mere decoration of the others.
            let find = |name: &str| table.iter().find(|(known, _)| *known == name);
            match find(name).or_else(|| find(bare(name, &[]))) {
                Some((_, value)) => Some(*value),
                None => known(part, what, bare(name, &[]), table, |name| format!("GL_{name}"), findings),
            }
        }
        _ => wrong_kind(value, &shown::a(what), "write the name that the API has for it", findings),
    }
}

/// Returns the values of an enumeration with the names that the API has for them. `names` has the order of the values.
pub(crate) fn table<T: Named>(names: &'static str) -> Vec<(&'static str, T)> {
    names.split(' ').zip(T::ALL.iter().copied()).collect()
}

/// Returns n of `GL_TEXTURE0 + n` or `GL_TEXTUREn_ARB`, and likewise of other names; n has to be below `count`.
pub(crate) fn numbered(
    value: &Value<'_>,
    name: &str,
    count: usize,
    what: &str,
    findings: &mut Vec<Diagnostic>,
) -> Option<usize> {
    let number = |part: &Part<'_>| match part.kind {
        PartKind::Integer(number) => Some(number as usize),
        PartKind::Name => bare(part.text, &[]).strip_prefix(name)?.parse::<u16>().ok().map(usize::from),
        _ => None,
    };
    let named = value.parts.first().is_some_and(|part| matches!(part.kind, PartKind::Name));
    let numbers: Option<Vec<usize>> = value.parts.iter().map(number).collect();
    let index = numbers
        .filter(|_| named && value.parts.len() <= 2)
        .map(|numbers| numbers.iter().fold(0usize, |sum, n| sum.saturating_add(*n)));
    match index {
        Some(index) if index < count => Some(index),
        Some(index) => {
            let help = format!("write GL_{name}0 to GL_{name}{}", count - 1);
            out_of_range(&value.span, what, index, &help, findings)
        }
        None => wrong_kind(value, &shown::a(what), &format!("write GL_{name}0, or GL_{name}0 + 1"), findings),
    }
}

/// Reads TRUE, FALSE or a number.
pub(crate) fn flag(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<bool> {
    match &value.parts[..] {
        [Part { kind: PartKind::Integer(number), .. }] => Some(*number != 0),
        [Part { kind: PartKind::Float(number), .. }] => Some(*number != 0.0),
        _ => choose(value, "truth value", &[("TRUE", true), ("FALSE", false)], findings),
    }
}

/// Reads a whole number, which may be written as a float.
pub(crate) fn whole(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<u32> {
    let found = match &value.parts[..] {
        [Part { kind: PartKind::Integer(number), .. }] => Some(*number),
        [Part { kind: PartKind::Float(number), .. }] => (0..=64u8).find(|n| f32::from(*n) == *number).map(u32::from),
        _ => None,
    };
    let help = "variables have no value here: write the number";
    found.or_else(|| wrong_kind(value, "a whole number", help, findings))
}

/// Returns whether a call takes a pointer to its values: its name ends with `v`, which a vendor's suffix may follow.
pub(crate) fn is_vector(function: &str) -> bool {
    bare_call(function).ends_with('v')
}

fn bare_call(function: &str) -> &str {
    ["NV", "ARB", "EXT"].iter().find_map(|end| function.strip_suffix(end)).unwrap_or(function)
}

/// Reads a colour of four values R, G, B, A as bytes. Floats are clamped to 0..1 (NUM-0). Integers of calls with `iv` are converted by the API's
/// table, in which the greatest integer is 1.
pub(crate) fn color(reader: &mut Reader<'_>, value: &Value<'_>, function: &str) -> Option<[u8; 4]> {
    const HELP: &str =
        "define it in the text, `GLfloat color[4] = { 1, 0.5, 0, 1 };`, or write `{ 1, 0.5, 0, 1 }` here";
    let Some(values) = reader.list(value) else {
        let message = format!("the values of `{}` are not in the text", shorten(reader.word(&value.span)));
        reader.findings.push(finding("NB0205", value.span.clone(), message, "four numbers are needed", HELP));
        return None;
    };
    let integral = bare_call(function).ends_with("iv");
    let bytes: Option<Vec<u8>> = values.iter().take(5).map(|value| byte(value, integral)).collect();
    match bytes.as_deref() {
        Some(&[r, g, b, a]) => Some([r, g, b, a]),
        Some(bytes) => {
            let message = format!("a colour has four numbers, not {}", if bytes.len() > 4 { "more" } else { "fewer" });
            reader.findings.push(finding("NB0211", value.span.clone(), message, "R, G, B and A", HELP));
            None
        }
        None => {
            let wanted = if integral { "four whole numbers" } else { "four numbers" };
            wrong_kind(value, wanted, HELP, &mut reader.findings)
        }
    }
}

fn byte(value: &Value<'_>, integral: bool) -> Option<u8> {
    match &value.parts[..] {
        [Part { kind: PartKind::Integer(number), .. }] if integral => {
            // floor(255 c + 1/2) of c = (2n + 1) / (2^32 - 1); negative numbers become 0.
            let n = i64::from((*number as i32).max(0));
            let most = (1i64 << 32) - 1;
            Some(if *number as i32 >= 0 { ((510 * (2 * n + 1) + most) / (2 * most)) as u8 } else { 0 })
        }
        [Part { kind: PartKind::Integer(number), .. }] => Some(if (*number as i32) > 0 { 255 } else { 0 }),
        [Part { kind: PartKind::Float(number), .. }] if !integral => Some(constant(*number)),
        _ => None,
    }
}

/// Capabilities for which a draw has fields: the name, the field, and how it is written.
const CAPABILITIES: &[(&str, &str, &str)] = &[
    ("BLEND", "blend", "`blend: (source: SourceAlpha, destination: OneMinusSourceAlpha)`"),
    ("ALPHA_TEST", "alpha_test", "`alpha_test: (function: Greater, reference: 128)`"),
    ("DEPTH_TEST", "depth_test", "`depth_test: (function: Less)`"),
    ("STENCIL_TEST", "stencil_test", "`stencil_test: (function: Equal, reference: 1, pass: Keep)`"),
    ("FOG", "fog", "`fog: (mode: Linear, start: ..., end: ..., color: ...)`"),
    ("CULL_FACE", "cull", "`cull: Back`"),
    ("SCISSOR_TEST", "scissor", "`scissor: (x: ..., y: ..., width: ..., height: ...)`"),
    ("TEXTURE_SHADER", "texture_shader", "`texture_shader: [Sample, ...]`"),
    ("VERTEX_PROGRAM", "vertices", "`vertices: Program(text: ...)`"),
];

/// Processes `glEnable` and `glDisable` of a capability that does not belong to the program.
pub(crate) fn capability<'t>(reader: &mut Reader<'t>, name: &Span, value: &Value<'t>, enable: bool) {
    let written = reader.word(&value.span);
    let capability = bare(written, &[]);
    if capability.starts_with("TEXTURE_") && capability != "TEXTURE_SHADER" {
        // The draw's `textures` say which units have a texture.
        return;
    }
    match CAPABILITIES.iter().find(|(known, ..)| *known == capability) {
        Some(_) if !enable => {}
        Some((_, field, form)) => {
            let message = format!("`{}` is a state of the draw", shorten(written));
            let help = format!("write it in the draw: {form}");
            reader.aside(value.span.clone(), written, &message, &help, Some(*field));
        }
        None => {
            let message = format!("`{}({})` is passed over", reader.word(name), shorten(written));
            let help = "nothing to do, if the scene says what it is for in fields of its own";
            reader.pass(value.span.clone(), written, &message, "no part of the program", help);
        }
    }
}

/// Calls for which a draw has fields, for [`Vocabulary::instead`](super::Vocabulary).
pub(crate) const INSTEAD: &[(&str, &str)] = &[
    ("BlendFunc", "write `blend: (source: ..., destination: ...)` in the draw"),
    ("AlphaFunc", "write `alpha_test: (function: ..., reference: ...)` in the draw"),
    ("DepthFunc", "write `depth_test: (function: ...)` in the draw"),
    ("StencilFunc", "write `stencil_test: (function: ..., reference: ..., mask: ...)` in the draw"),
    ("StencilOp", "write `stencil_test: (fail: ..., depth_fail: ..., pass: ...)` in the draw"),
    ("StencilMask", "write `stencil_test: (write_mask: ...)` in the draw"),
    ("Fogf", "write `fog: (...)` in the draw"),
    ("Fogi", "write `fog: (...)` in the draw"),
    ("Fogfv", "write `fog: (...)` in the draw"),
    ("CullFace", "write `cull: ...` in the draw"),
    ("FrontFace", "write `front_face: ...` in the draw"),
    ("ShadeModel", "write `shade_model: ...` in the draw"),
    ("ColorMask", "write `color_mask: (...)` in the draw"),
    ("TexParameteri", "write filters and address modes in the draw's `textures`"),
    ("TexParameterf", "write filters and address modes in the draw's `textures`"),
    ("TexGeni", "write `texgen: [...]` in the draw"),
    ("TexGenfv", "write `texgen: [...]` in the draw"),
    ("CombinerInputNV", "a program is either `TextureEnvironment` or `CombinerCalls`: paste these calls there"),
    ("CombinerOutputNV", "a program is either `TextureEnvironment` or `CombinerCalls`: paste these calls there"),
    ("TexEnvi", "a program is either `CombinerCalls` or `TextureEnvironment`: paste these calls there"),
    ("TexEnvf", "a program is either `CombinerCalls` or `TextureEnvironment`: paste these calls there"),
    ("TexEnvfv", "a program is either `CombinerCalls` or `TextureEnvironment`: paste these calls there"),
];
