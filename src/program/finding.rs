//! Values with their places, and findings about them.

use crate::Span;
use ninebit::diagnostic::Diagnostic;

/// A value with its place in the text of the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spanned<T> {
    /// The value that was read.
    pub value: T,
    /// Its range of bytes; empty if it was not written.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// Wraps the default of a value that is not written.
    pub fn default_of(value: T) -> Spanned<T> {
        Spanned { value, span: 0..0 }
    }
}

/// Makes an error about a part of a text: what is wrong, the label under the part, and what to do.
pub fn finding(
    code: &'static str,
    span: impl Into<Option<Span>>,
    message: impl Into<String>,
    label: impl Into<String>,
    help: impl Into<String>,
) -> Diagnostic {
    Diagnostic::error(code, span, message).label(label).help(help)
}

/// Makes a warning about a part of a text, like [`finding`].
pub fn warning(
    code: &'static str,
    span: Span,
    message: impl Into<String>,
    label: impl Into<String>,
    help: impl Into<String>,
) -> Diagnostic {
    Diagnostic::warning(code, span, message).label(label).help(help)
}

/// Returns the place of the header `!!...` that texts of OpenGL's languages begin with, if there is one.
pub(super) fn header(text: &str) -> Option<Span> {
    let rest = text.trim_start();
    let start = text.len() - rest.len();
    let length = rest.find(char::is_whitespace).unwrap_or(rest.len());
    rest.starts_with("!!").then_some(start..start + length)
}

/// Makes the finding that a text begins like one of another language. `code` is that of the expected language; `otherwise` is the help if the
/// other language is unknown.
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
