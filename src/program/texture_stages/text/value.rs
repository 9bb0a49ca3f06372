//! Values of pasted text: numbers and names of the API.

use std::ops::Range;

use super::Parser;
use super::token::TokenKind;
use crate::diagnostic::Diagnostic;
use crate::program::finding::finding;
use crate::program::texture_stages::{ArgumentSource, Operation, ResultArgument, StageArgument};
use crate::spelling::closest;
use crate::state::Named;

/// Brackets and casts around one value.
const MOST_BRACKETS: usize = 8;

/// One part of a value.
#[derive(Clone, Debug)]
pub(super) struct Part<'t> {
    text: &'t str,
    place: Range<usize>,
    kind: PartKind<'t>,
}

#[derive(Clone, Debug)]
enum PartKind<'t> {
    Name,
    Integer(u32),
    Float(f32),
    /// `D3DCOLOR_ARGB(...)`.
    Call(Vec<Value<'t>>),
}

/// Parts joined by `|`.
#[derive(Clone, Debug)]
pub(super) struct Value<'t> {
    parts: Vec<Part<'t>>,
    pub(super) place: Range<usize>,
}

impl<'t> Parser<'t> {
    /// Reads a value; `None` once the reason that it is none has been recorded.
    pub(super) fn value(&mut self) -> Option<Value<'t>> {
        self.nested_value(0)
    }

    fn nested_value(&mut self, depth: usize) -> Option<Value<'t>> {
        let start = self.place().start;
        let mut parts = Vec::new();
        loop {
            self.part(&mut parts, depth)?;
            if !matches!(self.peek(), Some(TokenKind::Symbol('|' | '+'))) {
                break;
            }
            self.at += 1;
        }
        let end = self.tokens[..self.at].last().map_or(start, |token| token.place.end);
        Some(Value { parts, place: start..end })
    }

    fn part(&mut self, parts: &mut Vec<Part<'t>>, depth: usize) -> Option<()> {
        if depth > MOST_BRACKETS {
            self.expected("a value in fewer brackets");
            return None;
        }
        let place = self.place();
        let text = self.word(&place);
        match self.peek() {
            Some(TokenKind::Number) => {
                self.at += 1;
                parts.push(Part { text, place: place.clone(), kind: self.number_kind(text, place, false)? });
            }
            Some(TokenKind::Symbol('-')) => {
                self.at += 1;
                let number = self.place();
                let text = self.word(&number);
                if self.peek() != Some(TokenKind::Number) {
                    self.expected("a number");
                    return None;
                }
                self.at += 1;
                let place = place.start..number.end;
                parts.push(Part { text, place: place.clone(), kind: self.number_kind(text, place, true)? });
            }
            Some(TokenKind::Symbol('(')) => {
                self.at += 1;
                let inner = self.nested_value(depth + 1)?;
                self.symbol(')')?;
                let cast = matches!(&inner.parts[..], [Part { kind: PartKind::Name, text, .. }] if is_type(text));
                if cast {
                    return self.part(parts, depth + 1);
                }
                parts.extend(inner.parts);
            }
            Some(TokenKind::Word) => {
                self.at += 1;
                if self.peek() != Some(TokenKind::Symbol('(')) {
                    parts.push(Part { text, place, kind: PartKind::Name });
                    return Some(());
                }
                self.at += 1;
                let mut arguments = Vec::new();
                loop {
                    arguments.push(self.nested_value(depth + 1)?);
                    if self.peek() != Some(TokenKind::Symbol(',')) {
                        break;
                    }
                    self.at += 1;
                }
                self.symbol(')')?;
                let end = self.tokens[..self.at].last().map_or(place.end, |token| token.place.end);
                parts.push(Part { text, place: place.start..end, kind: PartKind::Call(arguments) });
            }
            _ => {
                self.expected("a number or a name of the API");
                return None;
            }
        }
        Some(())
    }

    fn number_kind(&mut self, text: &str, place: Range<usize>, negative: bool) -> Option<PartKind<'t>> {
        if let Some(value) = integer(text) {
            return Some(PartKind::Integer(if negative { value.wrapping_neg() } else { value }));
        }
        let digits = text.trim_end_matches(['f', 'F']);
        let plain = digits.bytes().all(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b'e' | b'E'));
        match digits.parse::<f32>() {
            Ok(value) if plain && value.is_finite() => {
                // The sign bit: no arithmetic here.
                Some(PartKind::Float(f32::from_bits(value.to_bits() ^ u32::from(negative) << 31)))
            }
            _ => {
                let help = "write a whole number, a hexadecimal one such as 0xff8040, or a fraction such as 0.5f";
                self.findings.push(finding("NB0205", place, format!("`{text}` is not a number"), "not a number", help));
                None
            }
        }
    }
}

fn is_type(word: &str) -> bool {
    ["DWORD", "UINT", "ULONG", "LONG", "int", "long", "unsigned", "D3DCOLOR", "D3DTEXTUREOP"].contains(&word)
}

/// A whole number, decimal or hexadecimal, with C's suffixes.
pub(super) fn integer(text: &str) -> Option<u32> {
    let text = text.trim_end_matches(['u', 'U', 'l', 'L']);
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok())?,
    }
}

/// A word without the first of the prefixes that it has, whatever the case: the prefix and the rest.
pub(super) fn without_prefix<'w>(word: &'w str, prefixes: &[&str]) -> (&'w str, &'w str) {
    for prefix in prefixes {
        if let (Some(head), Some(rest)) = (word.get(..prefix.len()), word.get(prefix.len()..))
            && head.eq_ignore_ascii_case(prefix)
        {
            return (head, rest);
        }
    }
    ("", word)
}

/// Letters and digits only, in lower case: `MODULATEALPHA_ADDCOLOR` and `ModulateAlphaAddColor` are one.
fn folded(word: &str) -> String {
    word.chars().filter(|c| *c != '_').map(|c| c.to_ascii_lowercase()).collect()
}

/// The entry of `known` that a name means; says what was probably meant otherwise. Spelled as calls do, or as effect files.
fn known<T: Copy>(
    part: &Part<'_>,
    what: &str,
    prefix: &str,
    call: bool,
    known: &[(&str, T)],
    findings: &mut Vec<Diagnostic>,
) -> Option<T> {
    let (_, bare) = without_prefix(part.text, &[prefix]);
    let word = folded(bare);
    if let Some((_, value)) = known.iter().find(|(name, _)| folded(name) == word)
        && matches!(part.kind, PartKind::Name)
    {
        return Some(*value);
    }
    let spelled = |name: &str| {
        // The API's names have an underscore between the two halves of these.
        let name = if name.starts_with("Modulate") { name.replace("Add", "_Add") } else { name.to_owned() };
        if call { format!("{prefix}{}", name.to_uppercase()) } else { name }
    };
    let help = match closest(bare, known.iter().map(|(name, _)| *name)) {
        Some(name) => format!("did you mean `{}`?", spelled(name)),
        None => format!("known: {}", known.iter().map(|(name, _)| spelled(name)).collect::<Vec<_>>().join(", ")),
    };
    let message = format!("there is no {what} `{}`", part.text.chars().take(40).collect::<String>());
    findings.push(finding("NB0204", part.place.clone(), message, "not known", help));
    None
}

fn one<'v, 't>(value: &'v Value<'t>, what: &str, findings: &mut Vec<Diagnostic>) -> Option<&'v Part<'t>> {
    if let [part] = &value.parts[..] {
        return Some(part);
    }
    let message = format!("expected one {what}, found several joined by `|`");
    findings.push(finding("NB0205", value.place.clone(), message, "not one value", "write one of them"));
    None
}

fn out_of_range(place: &Range<usize>, what: &str, value: u32, help: &str, findings: &mut Vec<Diagnostic>) {
    let message = format!("there is no {what} {value}");
    findings.push(finding("NB0206", place.clone(), message, "out of range", help));
}

fn wrong_kind(place: &Range<usize>, what: &str, help: &str, findings: &mut Vec<Diagnostic>) {
    findings.push(finding("NB0205", place.clone(), format!("expected {what}"), "wrong kind of value", help));
}

/// A plain number.
pub(super) fn number(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<u32> {
    match one(value, "number", findings)?.kind {
        PartKind::Integer(number) => Some(number),
        _ => {
            wrong_kind(&value.place, "a whole number", "variables have no value here: write the number", findings);
            None
        }
    }
}

/// D3DTOP.
pub(super) fn operation(value: &Value<'_>, call: bool, findings: &mut Vec<Diagnostic>) -> Option<Operation> {
    let part = one(value, "operation", findings)?;
    if let PartKind::Integer(number) = part.kind {
        let operation = Operation::from_value(number);
        if operation.is_none() {
            out_of_range(&part.place, "texture operation", number, "operations are 1 to 26", findings);
        }
        return operation;
    }
    let names: Vec<(&str, Operation)> = Operation::ALL.iter().map(|operation| (operation.name(), *operation)).collect();
    known(part, "texture operation", "D3DTOP_", call, &names, findings)
}

#[derive(Clone, Copy)]
enum ArgumentWord {
    Source(ArgumentSource),
    Complement,
    AlphaReplicate,
}

/// D3DTA, with modifiers.
pub(super) fn argument(value: &Value<'_>, call: bool, findings: &mut Vec<Diagnostic>) -> Option<StageArgument> {
    const WORDS: &[(&str, ArgumentWord)] = &[
        ("Diffuse", ArgumentWord::Source(ArgumentSource::Diffuse)),
        ("Current", ArgumentWord::Source(ArgumentSource::Current)),
        ("Texture", ArgumentWord::Source(ArgumentSource::Texture)),
        ("TFactor", ArgumentWord::Source(ArgumentSource::TextureFactor)),
        ("Specular", ArgumentWord::Source(ArgumentSource::Specular)),
        ("Temp", ArgumentWord::Source(ArgumentSource::Temp)),
        ("Constant", ArgumentWord::Source(ArgumentSource::Constant)),
        ("Complement", ArgumentWord::Complement),
        ("AlphaReplicate", ArgumentWord::AlphaReplicate),
    ];
    let mut bits = 0;
    let mut sources = 0;
    for part in &value.parts {
        if let PartKind::Integer(number) = part.kind {
            if StageArgument::from_value(number).is_none() {
                let help = "an argument is 0 to 6, plus 16 for the complement and 32 for alpha in all channels";
                out_of_range(&part.place, "texture argument", number, help, findings);
                return None;
            }
            sources += u32::from(number & 48 == 0 || number & 15 != 0);
            bits |= number;
            continue;
        }
        match known(part, "texture argument", "D3DTA_", call, WORDS, findings)? {
            ArgumentWord::Complement => bits |= 16,
            ArgumentWord::AlphaReplicate => bits |= 32,
            ArgumentWord::Source(source) => {
                sources += 1;
                bits |= ArgumentSource::ALL.iter().position(|known| *known == source).unwrap_or(0) as u32;
            }
        }
    }
    if sources > 1 {
        wrong_kind(&value.place, "one source and its modifiers", "keep one of the sources", findings);
        return None;
    }
    StageArgument::from_value(bits)
}

/// D3DTSS_RESULTARG.
pub(super) fn result(value: &Value<'_>, call: bool, findings: &mut Vec<Diagnostic>) -> Option<ResultArgument> {
    let part = one(value, "result", findings)?;
    if let PartKind::Integer(number) = part.kind {
        return match number {
            1 => Some(ResultArgument::Current),
            5 => Some(ResultArgument::Temp),
            _ => {
                let help = "a result is 1 (D3DTA_CURRENT) or 5 (D3DTA_TEMP)";
                out_of_range(&part.place, "result argument", number, help, findings);
                None
            }
        };
    }
    let names: Vec<_> = ResultArgument::ALL.iter().map(|result| (result.name(), *result)).collect();
    known(part, "result argument", "D3DTA_", call, &names, findings)
}

/// D3DTSS_TEXCOORDINDEX: the words D3DTSS_TCI and a number.
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

/// D3DTSS_TEXTURETRANSFORMFLAGS.
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

/// TRUE, FALSE or a number.
pub(super) fn flag(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<bool> {
    let part = one(value, "truth value", findings)?;
    match part.kind {
        PartKind::Integer(number) => Some(number != 0),
        _ => known(part, "truth value", "", false, &[("TRUE", true), ("FALSE", false)], findings),
    }
}

/// A D3DCOLOR, 0xAARRGGBB, as R, G, B, A bytes; or one of its macros.
pub(super) fn color(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<[u8; 4]> {
    const HELP: &str = "write 0xAARRGGBB, or D3DCOLOR_ARGB(a, r, g, b) with bytes";
    let part = one(value, "colour", findings)?;
    match &part.kind {
        PartKind::Integer(number) => {
            let [a, r, g, b] = number.to_be_bytes();
            return Some([r, g, b, a]);
        }
        PartKind::Call(arguments) => {
            let mut bytes = Vec::with_capacity(4);
            for argument in arguments {
                match &argument.parts[..] {
                    [Part { kind: PartKind::Integer(byte @ 0..=255), .. }] => bytes.push(*byte as u8),
                    _ => {
                        wrong_kind(&argument.place, "a byte, 0 to 255", HELP, findings);
                        return None;
                    }
                }
            }
            match (part.text, &bytes[..]) {
                ("D3DCOLOR_ARGB", [a, r, g, b]) | ("D3DCOLOR_RGBA", [r, g, b, a]) => return Some([*r, *g, *b, *a]),
                ("D3DCOLOR_XRGB", [r, g, b]) => return Some([*r, *g, *b, 255]),
                _ => {}
            }
        }
        PartKind::Name | PartKind::Float(_) => {}
    }
    wrong_kind(&value.place, "a colour", HELP, findings);
    None
}

/// A float: written as one, in a wrapper such as `F2DW(0.5f)`, or as the bits of one, as the API takes it.
pub(super) fn float(value: &Value<'_>, findings: &mut Vec<Diagnostic>) -> Option<f32> {
    let part = one(value, "number", findings)?;
    let found = match &part.kind {
        PartKind::Float(number) => Some(*number),
        PartKind::Integer(bits) => Some(f32::from_bits(*bits)),
        PartKind::Call(arguments) => match &arguments[..] {
            [Value { parts, .. }] => match &parts[..] {
                [Part { kind: PartKind::Float(number), .. }] => Some(*number),
                // Such a wrapper takes a float: whole numbers become one.
                [Part { kind: PartKind::Integer(number), .. }] => Some(*number as i32 as f32),
                _ => None,
            },
            _ => None,
        },
        PartKind::Name => None,
    };
    let found = found.filter(|number| number.is_finite());
    if found.is_none() {
        let help = "write a fraction such as `0.5f` or `F2DW(0.5f)`, or the bits of one, 0x3f000000";
        wrong_kind(&value.place, "a finite number", help, findings);
    }
    found
}
