//! Reads values of texture stage states and render states.

use crate::calls::{self, Part, PartKind, Value, one, out_of_range, without_prefix, wrong_kind};
use crate::texture_stages::{Operation, ResultArgument, StageArgument};
use ninebit::diagnostic::Diagnostic;
use ninebit::number::convert::constant;
use ninebit::state::Named;

/// Finds the entry of `known` that a name means. Findings spell the entries as calls do, or as effect files.
fn known<T: Copy>(
    part: &Part<'_>,
    what: &str,
    prefix: &str,
    call: bool,
    known: &[(&str, T)],
    findings: &mut Vec<Diagnostic>,
) -> Option<T> {
    let spelled = |name: &str| {
        // The API's names of these have an underscore between their two halves.
        let name = if name.starts_with("Modulate") { name.replace("Add", "_Add") } else { name.to_owned() };
        if call { format!("{prefix}{}", name.to_uppercase()) } else { name }
    };
    calls::known(part, what, without_prefix(part.text, &[prefix]).1, known, spelled, findings)
}

/// Reads a plain number.
pub(super) fn number(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<u32> {
    match one(value, "number", findings)?.kind {
        PartKind::Integer(number) => Some(number),
        _ => wrong_kind(value, "a whole number", "variables have no value here: write the number", findings),
    }
}

/// Reads a value of the enumeration D3DTOP.
pub(super) fn operation(value: &Value<'_>, call: bool, findings: &mut Vec<Diagnostic>) -> Option<Operation> {
    let part = one(value, "operation", findings)?;
    if let PartKind::Integer(number) = part.kind {
        let help = "operations are 1 to 26";
        return Operation::from_value(number)
            .or_else(|| out_of_range(&part.span, "texture operation", number, help, findings));
    }
    let names: Vec<(&str, Operation)> = Operation::ALL.iter().map(|operation| (operation.name(), *operation)).collect();
    known(part, "texture operation", "D3DTOP_", call, &names, findings)
}

/// Reads D3DTA with modifiers.
pub(super) fn argument(value: &Value<'_>, call: bool, findings: &mut Vec<Diagnostic>) -> Option<StageArgument> {
    const WORDS: &[(&str, u32)] = &[
        ("Diffuse", 0),
        ("Current", 1),
        ("Texture", 2),
        ("TFactor", 3),
        ("Specular", 4),
        ("Temp", 5),
        ("Constant", 6),
        ("Complement", 16),
        ("AlphaReplicate", 32),
    ];
    let mut bits = 0;
    let mut sources = 0;
    for part in &value.parts {
        let number = match part.kind {
            PartKind::Integer(number) if StageArgument::from_value(number).is_none() => {
                let help = "an argument is 0 to 6, plus 16 for the complement and 32 for alpha in all channels";
                return out_of_range(&part.span, "texture argument", number, help, findings);
            }
            PartKind::Integer(number) => number,
            _ => known(part, "texture argument", "D3DTA_", call, WORDS, findings)?,
        };
        sources += u32::from(number & 48 == 0 || number & 15 != 0);
        bits |= number;
    }
    if sources > 1 {
        return wrong_kind(value, "one source and its modifiers", "keep one of the sources", findings);
    }
    StageArgument::from_value(bits)
}

/// Reads a value of D3DTSS_RESULTARG.
pub(super) fn result(value: &Value<'_>, call: bool, findings: &mut Vec<Diagnostic>) -> Option<ResultArgument> {
    let part = one(value, "result", findings)?;
    if let PartKind::Integer(number) = part.kind {
        return match number {
            1 => Some(ResultArgument::Current),
            5 => Some(ResultArgument::Temp),
            _ => {
                let help = "a result is 1 (D3DTA_CURRENT) or 5 (D3DTA_TEMP)";
                out_of_range(&part.span, "result argument", number, help, findings)
            }
        };
    }
    let names: Vec<_> = ResultArgument::ALL.iter().map(|result| (result.name(), *result)).collect();
    known(part, "result argument", "D3DTA_", call, &names, findings)
}

/// Reads D3DTSS_TEXCOORDINDEX: words D3DTSS_TCI and a number.
pub(super) fn coordinate_index(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<u32> {
    let words = [
        ("PassThru", 0),
        ("CameraSpaceNormal", 1 << 16),
        ("CameraSpacePosition", 2 << 16),
        ("CameraSpaceReflectionVector", 3 << 16),
        ("SphereMap", 4 << 16),
    ];
    flags(value, "source of coordinates", "D3DTSS_TCI_", &words, findings)
}

/// Reads a value of D3DTSS_TEXTURETRANSFORMFLAGS.
pub(super) fn transform_flags(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<u32> {
    let words = [("Disable", 0), ("Count1", 1), ("Count2", 2), ("Count3", 3), ("Count4", 4), ("Projected", 256)];
    flags(value, "transform flag", "D3DTTFF_", &words, findings)
}

fn flags(
    value: &Value<'_>,
    what: &str,
    prefix: &str,
    words: &[(&str, u32)],
    findings: &mut Vec<Diagnostic>,
) -> Option<u32> {
    let mut bits = 0;
    for part in &value.parts {
        bits |= match part.kind {
            PartKind::Integer(number) => number,
            _ => known(part, what, prefix, true, words, findings)?,
        };
    }
    Some(bits)
}

/// Reads TRUE, FALSE or a number.
pub(super) fn flag(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<bool> {
    let part = one(value, "truth value", findings)?;
    match part.kind {
        PartKind::Integer(number) => Some(number != 0),
        _ => known(part, "truth value", "", false, &[("TRUE", true), ("FALSE", false)], findings),
    }
}

/// Reads a D3DCOLOR, 0xAARRGGBB, or one of its macros. Returns bytes R, G, B, A.
pub(super) fn color(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<[u8; 4]> {
    const HELP: &str =
        "write 0xAARRGGBB, D3DCOLOR_ARGB(a, r, g, b) with bytes, or D3DCOLOR_COLORVALUE(r, g, b, a) with 0.0 to 1.0";
    let part = one(value, "colour", findings)?;
    let found = match &part.kind {
        PartKind::Integer(number) => {
            let [a, r, g, b] = number.to_be_bytes();
            return Some([r, g, b, a]);
        }
        PartKind::Call(arguments) => {
            let read: fn(&Value<'_>) -> Option<u8> = match part.text {
                // The macros truncate; the class D3DXCOLOR rounds.
                "D3DCOLOR_COLORVALUE" | "D3DRGBA" | "D3DRGB" => cut,
                "D3DXCOLOR" => |value| real(value).map(constant),
                _ => byte,
            };
            let wanted = if ["D3DCOLOR_XRGB", "RGB_MAKE", "D3DRGB"].contains(&part.text) { 3 } else { 4 };
            let mut bytes = Vec::with_capacity(4);
            for argument in arguments.iter().take(4) {
                let Some(byte) = read(argument) else {
                    let what = match part.text {
                        "D3DCOLOR_COLORVALUE" | "D3DRGBA" | "D3DRGB" | "D3DXCOLOR" => "a number from 0.0 to 1.0",
                        _ => "a byte, 0 to 255",
                    };
                    return wrong_kind(argument, what, HELP, findings);
                };
                bytes.push(byte);
            }
            match (part.text, &bytes[..]) {
                _ if arguments.len() > wanted => None,
                ("D3DCOLOR_ARGB", [a, r, g, b])
                | ("D3DCOLOR_RGBA" | "RGBA_MAKE" | "D3DCOLOR_COLORVALUE" | "D3DRGBA" | "D3DXCOLOR", [r, g, b, a]) => {
                    Some([*r, *g, *b, *a])
                }
                ("D3DCOLOR_XRGB" | "RGB_MAKE" | "D3DRGB", [r, g, b]) => {
                    // RGB_MAKE leaves the top byte 0.
                    Some([*r, *g, *b, if part.text == "RGB_MAKE" { 0 } else { 255 }])
                }
                _ => None,
            }
        }
        PartKind::Name | PartKind::Float(_) | PartKind::List(_) => None,
    };
    found.or_else(|| wrong_kind(value, "a colour", HELP, findings))
}

fn byte(value: &Value<'_>) -> Option<u8> {
    match &value.parts[..] {
        [Part { kind: PartKind::Integer(byte @ 0..=255), .. }] => Some(*byte as u8),
        _ => None,
    }
}

/// Reads a number from 0.0 to 1.0.
fn real(value: &Value<'_>) -> Option<f32> {
    let number = match &value.parts[..] {
        [Part { kind: PartKind::Float(number), .. }] => *number,
        [Part { kind: PartKind::Integer(number @ 0..=1), .. }] => *number as f32,
        _ => return None,
    };
    (0.0..=1.0).contains(&number).then_some(number)
}

/// Reads a number and converts it by (DWORD)(c * 255.f), as the macros of the API do.
fn cut(value: &Value<'_>) -> Option<u8> {
    #[allow(clippy::float_arithmetic, reason = "the API's own macro, in the precision of its text")]
    real(value).map(|number| (number * 255.0) as u8)
}

/// Reads a float: written as one, in a wrapper such as `F2DW(0.5f)`, or as its bits, which is what the API takes.
pub(super) fn float(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<f32> {
    let part = one(value, "number", findings)?;
    let found = match &part.kind {
        PartKind::Float(number) => Some(*number),
        PartKind::Integer(bits) => Some(f32::from_bits(*bits)),
        PartKind::Call(arguments) => match &arguments[..] {
            [Value { parts, .. }] => match &parts[..] {
                [Part { kind: PartKind::Float(number), .. }] => Some(*number),
                // The wrapper takes a float, so whole numbers become floats.
                [Part { kind: PartKind::Integer(number), .. }] => Some(*number as i32 as f32),
                _ => None,
            },
            _ => None,
        },
        PartKind::Name | PartKind::List(_) => None,
    };
    let help = "write a fraction such as `0.5f` or `F2DW(0.5f)`, or the bits of one, 0x3f000000";
    let finite = found.filter(|number| number.is_finite());
    finite.or_else(|| wrong_kind(value, "a finite number", help, findings))
}
