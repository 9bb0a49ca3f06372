//! Findings of faults in the notation, and of values that are not what is expected.

use ninebit_program::finding;

use super::{KIND, RANGE, Reader, TWICE, UNKNOWN, quoted};
use crate::diagnostic::{DOCUMENTS, Diagnostic};
use crate::notation::{Fault, FaultKind};
use crate::source::Mismatch;
use crate::wording::{closest, describe, shorten};

impl<'a> Reader<'a> {
    /// Makes the finding that a value is not what is expected, in the terms of the format.
    pub(super) fn mismatch(&self, text: &'a str, mismatch: &Mismatch<'a>, expected: &str) -> Diagnostic {
        let found = || format!("expected {expected}, found {}", describe(text));
        match mismatch {
            Mismatch::Kind => Diagnostic::error(KIND, self.range(text), found()).label("wrong kind of value"),
            Mismatch::Range => Diagnostic::error(RANGE, self.range(text), found()).label("out of range"),
            Mismatch::Unknown(field, known) => {
                let list = quoted(known);
                let help = match closest(field, known.iter().copied()) {
                    Some(name) => format!("did you mean `{name}`? Fields here: {list}"),
                    None => format!("fields here: {list}"),
                };
                let message = format!("there is no field `{}` here", shorten(field));
                finding(UNKNOWN, self.range(field), message, "unknown field", help)
            }
            Mismatch::Twice(field) => {
                let message = format!("`{}` is given twice", shorten(field));
                finding(TWICE, self.range(field), message, "again here", "keep one of them")
            }
        }
    }

    /// Makes the finding of a fault in the notation.
    pub(super) fn syntax(&self, Fault { kind, place }: Fault) -> Diagnostic {
        let at = shorten(&self.notation.text[place.clone()]);
        let examples = format!("see {DOCUMENTS}/scene-format.md for examples");
        let (message, help) = match &kind {
            FaultKind::Nesting => {
                let message = format!("more than {} levels of brackets inside each other", self.limits.nesting);
                let help = "no part of a scene needs more than a dozen levels: look for brackets that were not closed";
                return finding("NB0602", place, message, "one level too many", help);
            }
            FaultKind::Start => (
                "a scene starts with an opening parenthesis".into(),
                "write `(version: 1, profile: Nv2a, draws: [...])`",
            ),
            FaultKind::End(_) => ("the scene ends too early".into(), "close the brackets that are still open"),
            FaultKind::Comma => ("a comma or a closing bracket is missing".into(), "put a comma between the values"),
            FaultKind::Colon => {
                ("a colon is missing".into(), "write `field: value` in parentheses, `\"name\": value` in braces")
            }
            FaultKind::Close(b')') => {
                ("a closing `)` is missing".into(), "close the parenthesis, or put a comma before another value")
            }
            FaultKind::Close(b']') => {
                ("a closing `]` is missing".into(), "close the list, or put a comma before another value")
            }
            FaultKind::Close(_) => {
                ("a closing `}` is missing".into(), "close the table, or put a comma before another entry")
            }
            FaultKind::Quote => ("a closing quote is missing".into(), "end the text with `\"`"),
            FaultKind::Escape => {
                (format!("a text has no `{at}`"), "write `\\\\` for a backslash, or the text as `r\"...\"`")
            }
            FaultKind::Comment => ("a comment is not closed".into(), "end it with `*/`"),
            FaultKind::Trailing => (
                "something follows the end of the scene".into(),
                "a scene is one value in parentheses: look for a bracket that was closed too early",
            ),
            FaultKind::Character(c) => (format!("`{}` is not expected here", c.escape_debug()), examples.as_str()),
            FaultKind::Extension => {
                (format!("there is no RON extension `{at}`"), "leave the `#![enable(...)]` line out")
            }
        };
        let label = if kind == FaultKind::Comma { "a comma before this?" } else { "here" };
        let found = finding("NB0101", place, message, label, help);
        match kind {
            FaultKind::End(Some(open)) => found.related(open..open + 1, "this bracket is still open"),
            _ => found,
        }
    }
}
