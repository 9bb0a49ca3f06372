//! Findings: what is wrong with a scene or a program, where, and what to do about it.

use crate::place::Span;
use std::sync::Arc;

use crate::state::Profile;

/// Where the documents stand that messages name: at the repository's address, once it has one.
pub const DOCUMENTS: &str = match is_placeholder(env!("CARGO_PKG_REPOSITORY")) {
    true => "docs",
    false => concat!(env!("CARGO_PKG_REPOSITORY"), "/blob/main/docs"),
};

/// Returns whether an address leads nowhere.
const fn is_placeholder(address: &str) -> bool {
    let (address, placeholder) = (address.as_bytes(), b"https://example.org/");
    let mut n = 0;
    while n < placeholder.len() && n < address.len() && address[n] == placeholder[n] {
        n += 1;
    }
    n == placeholder.len()
}

/// Severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The scene is refused.
    Error,
    /// The scene is accepted, but something in it is probably not intended.
    Warning,
}

/// Kind of an error, which decides the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// The scene, or a file that it names, is not valid.
    Invalid = 3,
    /// The scene, or a file that it names, does not exist.
    Missing = 4,
    /// The scene is valid as far as it was checked, but exceeds a limit.
    Limit = 5,
}

impl ErrorKind {
    /// Returns the exit code of the command line.
    pub fn exit_code(self) -> u8 {
        self as u8
    }
}

/// An error or a warning about an input, with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Stable code, such as "NB0201". `docs/errors.md` lists them.
    pub code: &'static str,
    /// Whether it is an error or a warning.
    pub severity: Severity,
    /// Description of the error, in one line.
    pub message: String,
    /// The bytes of [`Source::text`] that are marked. `None` if no text is to blame.
    pub span: Option<Span>,
    /// Text shown under the marked bytes.
    pub label: String,
    /// Other places that matter, and why.
    pub related: Vec<(Span, String)>,
    /// The rule of `docs/rules` that is violated.
    pub rule: Option<&'static str>,
    /// Explanations, one line each.
    pub notes: Vec<String>,
    /// Advice on what to do.
    pub help: Option<String>,
    /// The file that the places refer to, if it is not the input itself.
    pub file: Option<Arc<File>>,
}

/// A text in its own file that a scene names, such as a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// The text and its name.
    pub source: Source,
    /// The place where the scene names the file.
    pub named: Span,
}

impl Diagnostic {
    /// Creates an error about `span`.
    pub fn error(code: &'static str, span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Diagnostic {
            code,
            severity: Severity::Error,
            message: message.into(),
            span: span.into(),
            label: String::new(),
            related: Vec::new(),
            rule: None,
            notes: Vec::new(),
            help: None,
            file: None,
        }
    }

    /// Creates a warning about `span`.
    pub fn warning(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, span, message) }
    }

    /// Sets the text under the marked bytes.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Sets the advice on what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Sets the rule of `docs/rules` that is violated.
    pub fn rule(mut self, rule: &'static str) -> Self {
        self.rule = Some(rule);
        self
    }

    /// Adds a line of explanation.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Adds another place that matters, and says why.
    pub fn related(mut self, span: Span, label: impl Into<String>) -> Self {
        self.related.push((span, label.into()));
        self
    }

    /// Makes the places refer to another file.
    pub fn inside(mut self, file: &Arc<File>) -> Self {
        self.file = Some(Arc::clone(file));
        self
    }

    /// Returns the sort key of a finding: where it is mentioned in the input, then the place in the named file.
    pub fn order(&self) -> (usize, usize) {
        let start = self.span.as_ref().map_or(0, |span| span.start);
        match &self.file {
            Some(file) => (file.named.start, start),
            None => (start, 0),
        }
    }

    /// Returns the kind of the error, by its code.
    pub fn kind(&self) -> ErrorKind {
        match self.code {
            "NB0111" | "NB0502" | "NB0510" | "NB0530" | "NB0536" => ErrorKind::Missing,
            "NB0514" | "NB0515" | "NB0516" | "NB0534" | "NB0538" => ErrorKind::Limit,
            code if code.starts_with("NB06") => ErrorKind::Limit,
            _ => ErrorKind::Invalid,
        }
    }
}

/// Returns the finding that `what` requires nv2a.
pub(crate) fn only_nv2a(code: &'static str, place: Option<Span>, what: &str, rule: &'static str) -> Diagnostic {
    Diagnostic::error(code, place, format!("{what} does not exist on Nv10"))
        .label("not on this chip")
        .rule(rule)
        .help("profile Nv2a has it: write `profile: Nv2a`, or use what Nv10 has")
}

/// Returns `only_nv2a` if `needs` is set and the profile is nv10.
pub fn needs_nv2a(
    profile: Profile,
    needs: bool,
    code: &'static str,
    place: impl Into<Option<Span>>,
    what: &str,
    rule: &'static str,
) -> Option<Diagnostic> {
    (needs && profile == Profile::Nv10).then(|| only_nv2a(code, place.into(), what, rule))
}

/// A text and its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// Name that is shown before line and column.
    pub name: String,
    /// The text without a byte order mark.
    pub text: String,
}

impl Source {
    /// Returns line and column of a byte offset, both counted from 1. Columns count characters.
    pub fn position(&self, offset: usize) -> (usize, usize) {
        let offset = floor_boundary(&self.text, offset);
        let before = &self.text[..offset];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        (1 + before.bytes().filter(|byte| *byte == b'\n').count(), 1 + before[line_start..].chars().count())
    }
}

/// Returns the largest character boundary that is not above `offset`.
pub fn floor_boundary(text: &str, offset: usize) -> usize {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

/// Shortens a text to at most forty characters of its first line.
pub fn shorten(text: &str) -> String {
    let line = text.lines().next().unwrap_or("");
    if line.chars().count() <= 40 { line.to_owned() } else { line.chars().take(37).chain("...".chars()).collect() }
}
