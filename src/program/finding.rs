//! Values with their places, and findings about them.

use crate::Span;
use ninebit::diagnostic::Diagnostic;

/// A value and the bytes of the program's text that gave it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spanned<T> {
    /// What was read.
    pub value: T,
    /// Its place; empty if nothing was written.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// What holds where nothing is written.
    pub fn default_of(value: T) -> Spanned<T> {
        Spanned { value, span: 0..0 }
    }
}

/// An error about a part of a text: what is wrong, what is said under the part, and what to do.
pub fn finding(
    code: &'static str,
    span: impl Into<Option<Span>>,
    message: impl Into<String>,
    label: impl Into<String>,
    help: impl Into<String>,
) -> Diagnostic {
    Diagnostic::error(code, span, message).label(label).help(help)
}

/// A [`finding`] that is a warning.
pub fn warning(
    code: &'static str,
    span: Span,
    message: impl Into<String>,
    label: impl Into<String>,
    help: impl Into<String>,
) -> Diagnostic {
    Diagnostic::warning(code, span, message).label(label).help(help)
}

/// The header that a text of OpenGL's languages begins with: `!!RC1.0`.
pub(super) fn header(text: &str) -> Option<Span> {
    let rest = text.trim_start();
    let start = text.len() - rest.len();
    let length = rest.find(char::is_whitespace).unwrap_or(rest.len());
    rest.starts_with("!!").then_some(start..start + length)
}

/// The finding that a text begins as one of another language does. `code`: of the language that was expected; `otherwise`: what to do if the
/// other one is not known.
pub(super) fn foreign(text: &str, span: Span, code: &'static str, otherwise: &str) -> Diagnostic {
    let header = text.get(span.clone()).unwrap_or("");
    let known: [(&str, &str, &str); 6] = [
        ("!!TS1.0", "texture shaders", "write the draw's `texture_shader: [Sample, ...]`, a stage for each unit"),
        ("!!RC1.0", "register combiners", "it belongs into the draw's `program: CombinerText(...)`"),
        ("!!VP1.", "NV_vertex_program", "write it in vs.1.1, in the vertices' `Program(text: ...)`"),
        (
            "!!VSP1.0",
            "NV_vertex_program's state programs",
            "give the constants in the vertices' `Program(constants: ...)`",
        ),
        ("!!ARBvp1.0", "ARB_vertex_program", "write it in vs.1.1, in the vertices' `Program(text: ...)`"),
        ("!!ARBfp1.0", "ARB_fragment_program, of later chips", "write general stages: `CombinerText(...)`"),
    ];
    let found = known.iter().find(|(start, ..)| header.starts_with(start));
    let (what, help) = found.map_or(("a language that is not known", otherwise), |(_, what, help)| (*what, *help));
    let header: String = header.chars().take(40).collect();
    finding(code, span, format!("`{header}` begins a program of {what}"), "another language", help)
}
