//! Reads values in pasted text: numbers, names of an API, macros, lists.

use crate::Span;
use std::fmt::Display;

use super::{Kind, Reader};
use crate::finding::finding;
use crate::spelling::closest;
use ninebit::diagnostic::{Diagnostic, shorten};

/// Deepest nesting of brackets and casts around a value.
const MAX_BRACKET_DEPTH: usize = 8;

/// One part of a value, which may be joined from several.
#[derive(Clone, Debug)]
pub(crate) struct Part<'t> {
    pub(crate) text: &'t str,
    pub(crate) span: Span,
    pub(crate) kind: PartKind<'t>,
}

#[derive(Clone, Debug)]
pub(crate) enum PartKind<'t> {
    /// A name of the API or of a variable.
    Name,
    Integer(u32),
    Float(f32),
    /// A macro with arguments: `D3DCOLOR_ARGB(...)`.
    Call(Vec<Value<'t>>),
    /// A list: `{ 1, 0, 0, 1 }`.
    List(Vec<Value<'t>>),
}

/// A value: parts joined by `|` or `+`.
#[derive(Clone, Debug)]
pub(crate) struct Value<'t> {
    pub(crate) parts: Vec<Part<'t>>,
    pub(crate) span: Span,
}

impl<'t> Reader<'t> {
    /// Reads a value. Returns `None` after recording what is wrong.
    pub(super) fn value(&mut self) -> Option<Value<'t>> {
        self.nested_value(0)
    }

    fn nested_value(&mut self, depth: usize) -> Option<Value<'t>> {
        let start = self.cursor.span().start;
        let mut parts = Vec::new();
        self.part(&mut parts, depth)?;
        while self.cursor.take('|') || self.cursor.take('+') {
            self.part(&mut parts, depth)?;
        }
        Some(Value { parts, span: start..self.cursor.end() })
    }

    fn part(&mut self, parts: &mut Vec<Part<'t>>, depth: usize) -> Option<()> {
        if depth > MAX_BRACKET_DEPTH {
            return self.expected("a value in fewer brackets");
        }
        let span = self.cursor.span();
        let text = self.word(&span);
        match self.cursor.kind() {
            Some(Kind::Number) => {
                self.cursor.advance();
                parts.push(Part { text, span: span.clone(), kind: self.number_kind(text, span, false)? });
            }
            Some(Kind::Sign('-')) => {
                self.cursor.advance();
                let number = self.cursor.span();
                let text = self.word(&number);
                if self.cursor.kind() != Some(Kind::Number) {
                    return self.expected("a number");
                }
                self.cursor.advance();
                let span = span.start..number.end;
                parts.push(Part { text, span: span.clone(), kind: self.number_kind(text, span, true)? });
            }
            // The address of an array's first element is the array.
            Some(Kind::Sign('&' | '+')) => {
                self.cursor.advance();
                return self.part(parts, depth + 1);
            }
            Some(Kind::Sign('(')) => {
                if let Some(behind) = self.cast() {
                    self.cursor.at = behind;
                    return self.part(parts, depth + 1);
                }
                self.cursor.advance();
                let inner = self.nested_value(depth + 1)?;
                self.sign(')')?;
                parts.extend(inner.parts);
            }
            Some(Kind::Sign('{')) => {
                self.cursor.advance();
                let values = self.values('}', depth)?;
                let span = span.start..self.cursor.end();
                parts.push(Part { text: self.word(&span), span, kind: PartKind::List(values) });
            }
            Some(Kind::Sign('<')) if self.cursor.kind_at(self.cursor.at + 2) == Some(Kind::Sign('>')) => {
                self.cursor.at += 3;
                let span = span.start..self.cursor.end();
                parts.push(Part { text: self.word(&span), span, kind: PartKind::Name });
            }
            Some(Kind::Word) => {
                self.cursor.advance();
                if self.cursor.take('(') {
                    let arguments = self.values(')', depth)?;
                    let span = span.start..self.cursor.end();
                    parts.push(Part { text, span, kind: PartKind::Call(arguments) });
                    return Some(());
                }
                self.members();
                let span = span.start..self.cursor.end();
                let text = self.word(&span).trim_end_matches("[0]");
                parts.push(Part { text, span, kind: PartKind::Name });
            }
            _ => return self.expected("a number or a name of the API"),
        }
        Some(())
    }

    /// Reads values separated by commas, up to a closing bracket.
    fn values(&mut self, closing: char, depth: usize) -> Option<Vec<Value<'t>>> {
        let mut values = Vec::new();
        while !self.cursor.is(closing) {
            values.push(self.nested_value(depth + 1)?);
            if !self.cursor.take(',') {
                break;
            }
        }
        self.sign(closing)?;
        Some(values)
    }

    /// Skips `[0]`, `.v` and `->v` behind a name.
    fn members(&mut self) {
        loop {
            let inside = [1, 2].map(|n| self.cursor.kind_at(self.cursor.at + n));
            match (self.cursor.kind(), inside) {
                (Some(Kind::Sign('[')), [Some(Kind::Number | Kind::Word), Some(Kind::Sign(']'))]) => {
                    self.cursor.at += 3
                }
                (Some(Kind::Arrow | Kind::Sign('.')), [Some(Kind::Word), _]) => self.cursor.at += 2,
                _ => return,
            }
        }
    }

    /// Returns the token after a cast like `(DWORD)`, `(const GLfloat *)` or `(GLfloat[4])`, if one stands here.
    fn cast(&self) -> Option<usize> {
        if !is_type(self.cursor.text_at(self.cursor.at + 1)) {
            return None;
        }
        let parts = |kind| matches!(kind, Some(Kind::Word | Kind::Number | Kind::Sign('*' | '[' | ']' | '&')));
        let close = (self.cursor.at + 2..self.cursor.at + 10).find(|at| !parts(self.cursor.kind_at(*at)))?;
        (self.cursor.kind_at(close) == Some(Kind::Sign(')'))).then_some(close + 1)
    }

    fn number_kind(&mut self, text: &str, span: Span, negative: bool) -> Option<PartKind<'t>> {
        if let Some(value) = integer(text) {
            return Some(PartKind::Integer(if negative { value.wrapping_neg() } else { value }));
        }
        let digits = text.trim_end_matches(['f', 'F']);
        let plain =
            digits.bytes().all(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b'e' | b'E' | b'+' | b'-'));
        match digits.parse::<f32>() {
            Ok(value) if plain && value.is_finite() => {
                // Only the sign bit is changed: there is no arithmetic here.
                Some(PartKind::Float(f32::from_bits(value.to_bits() ^ u32::from(negative) << 31)))
            }
            _ => {
                let help = "write a whole number, a hexadecimal one such as 0xff8040, or a fraction such as 0.5f";
                let message = format!("`{}` is not a number", shorten(text));
                self.findings.push(finding("NB0205", span, message, "not a number", help));
                None
            }
        }
    }
}

fn is_type(word: &str) -> bool {
    const C: &str = "int long unsigned float double const void";
    const APIS: &str = "DWORD UINT ULONG LONG D3DCOLOR D3DTEXTUREOP GLfloat GLint GLenum GLuint GLdouble GLclampf";
    C.split(' ').chain(APIS.split(' ')).any(|known| known == word)
}

/// Parses a whole number, decimal or hexadecimal, with C's suffixes.
pub(crate) fn integer(text: &str) -> Option<u32> {
    let text = text.trim_end_matches(['u', 'U', 'l', 'L']);
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok())?,
    }
}

/// Splits a word into the first of `prefixes` that it has, in any case, and the rest. The prefix is empty if it has none.
pub(crate) fn without_prefix<'w>(word: &'w str, prefixes: &[&str]) -> (&'w str, &'w str) {
    for prefix in prefixes {
        if let (Some(head), Some(rest)) = (word.get(..prefix.len()), word.get(prefix.len()..))
            && head.eq_ignore_ascii_case(prefix)
        {
            return (head, rest);
        }
    }
    ("", word)
}

/// Returns a word in lower case without underscores: `MODULATEALPHA_ADDCOLOR` and `ModulateAlphaAddColor` are the same.
fn folded(word: &str) -> String {
    word.chars().filter(|c| *c != '_').map(|c| c.to_ascii_lowercase()).collect()
}

/// Returns the entry of `known` that a name means. `bare` is the name in the form of the entries; `spelled` writes an entry in the form of the text.
/// Returns `None` after recording what was probably meant.
pub(crate) fn known<T: Copy>(
    part: &Part<'_>,
    what: &str,
    bare: &str,
    known: &[(&str, T)],
    spelled: impl Fn(&str) -> String,
    findings: &mut Vec<Diagnostic>,
) -> Option<T> {
    let word = folded(bare);
    if let Some((_, value)) = known.iter().find(|(name, _)| folded(name) == word)
        && matches!(part.kind, PartKind::Name)
    {
        return Some(*value);
    }
    let message = format!("there is no {what} `{:.40}`", part.text);
    let help = meant(bare, known, spelled);
    findings.push(finding("NB0204", part.span.clone(), message, "not known", help));
    None
}

/// Returns the help for an unknown word: what was probably meant, or else all known words.
pub(crate) fn meant<T>(word: &str, known: &[(&str, T)], spelled: impl Fn(&str) -> String) -> String {
    match closest(word, known.iter().map(|(name, _)| *name)) {
        Some(name) => format!("did you mean `{}`?", spelled(name)),
        None => format!("known: {}", known.iter().map(|(name, _)| spelled(name)).collect::<Vec<_>>().join(", ")),
    }
}

/// Returns the only part of a value. Returns `None` after recording that there are several.
pub(crate) fn one<'v, 't>(value: &'v Value<'t>, what: &str, findings: &mut Vec<Diagnostic>) -> Option<&'v Part<'t>> {
    if let [part] = &value.parts[..] {
        return Some(part);
    }
    let message = format!("expected one {what}, found several joined by `|`");
    findings.push(finding("NB0205", value.span.clone(), message, "not one value", "write one of them"));
    None
}

/// Records that there is no `what` with this number, and returns `None`.
pub(crate) fn out_of_range<T>(
    span: &Span,
    what: &str,
    value: impl Display,
    help: &str,
    findings: &mut Vec<Diagnostic>,
) -> Option<T> {
    let message = format!("there is no {what} {value}");
    findings.push(finding("NB0206", span.clone(), message, "out of range", help));
    None
}

/// Records that another kind of value was expected, and returns `None`.
pub(crate) fn wrong_kind<T>(value: &Value<'_>, what: &str, help: &str, findings: &mut Vec<Diagnostic>) -> Option<T> {
    findings.push(finding("NB0205", value.span.clone(), format!("expected {what}"), "wrong kind of value", help));
    None
}
