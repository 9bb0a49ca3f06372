//! Findings: what is wrong with a scene or a program, where, and what to do about it.

use crate::place::Span;
use std::sync::Arc;

use crate::state::Profile;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The scene is not accepted.
    Error,
    /// The scene is accepted; something in it is probably not meant.
    Warning,
}

/// What a caller does about a refused scene: each kind has its exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// The scene, or a file that it names, makes no sense.
    Invalid = 3,
    /// The scene, or a file that it names, does not exist.
    Missing = 4,
    /// Sound as far as looked at, but more than is allowed.
    Limit = 5,
}

impl ErrorKind {
    /// Exit code of the command line.
    pub fn exit_code(self) -> u8 {
        self as u8
    }
}

/// An error or a warning about an input, with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Stable code, for example "NB0201"; `docs/errors.md` lists them.
    pub code: &'static str,
    /// Error or warning.
    pub severity: Severity,
    /// What is wrong, in one line.
    pub message: String,
    /// Bytes of [`Source::text`] that are to blame; `None` if no text is.
    pub span: Option<Span>,
    /// Said under the marked text.
    pub label: String,
    /// Other places that matter, and why.
    pub related: Vec<(Span, String)>,
    /// The rule of `docs/numerics.md` behind it.
    pub rule: Option<&'static str>,
    /// What helps to understand it, a line each.
    pub notes: Vec<String>,
    /// What to do.
    pub help: Option<String>,
    /// The other text that the places point into; `None`: the one that was given.
    pub file: Option<Arc<File>>,
}

/// A text that a scene names: a program in a file of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// The text and its name.
    pub source: Source,
    /// Where the scene names it.
    pub named: Span,
}

impl Diagnostic {
    /// An error about `span`.
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

    /// A warning about `span`.
    pub fn warning(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, span, message) }
    }

    /// Says something under the marked text.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Says what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Names the rule of `docs/numerics.md` behind it.
    pub fn rule(mut self, rule: &'static str) -> Self {
        self.rule = Some(rule);
        self
    }

    /// Adds a line that helps to understand the finding.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Marks another place that matters, and says why.
    pub fn related(mut self, span: Span, label: impl Into<String>) -> Self {
        self.related.push((span, label.into()));
        self
    }

    /// The same about places of another text.
    pub fn inside(mut self, file: &Arc<File>) -> Self {
        self.file = Some(Arc::clone(file));
        self
    }

    /// Where it is mentioned in the text that was given: findings are sorted by this.
    pub fn order(&self) -> (usize, usize) {
        let start = self.span.as_ref().map_or(0, |span| span.start);
        match &self.file {
            Some(file) => (file.named.start, start),
            None => (start, 0),
        }
    }

    /// What a caller does about it.
    pub fn kind(&self) -> ErrorKind {
        match self.code {
            "NB0111" | "NB0502" | "NB0510" | "NB0530" | "NB0536" => ErrorKind::Missing,
            "NB0514" | "NB0515" | "NB0516" | "NB0534" | "NB0538" => ErrorKind::Limit,
            code if code.starts_with("NB06") => ErrorKind::Limit,
            _ => ErrorKind::Invalid,
        }
    }
}

/// The finding that something needs the larger chip.
pub fn only_nv2a(code: &'static str, place: impl Into<Option<Span>>, what: &str, rule: &'static str) -> Diagnostic {
    Diagnostic::error(code, place, format!("{what} does not exist on Nv10"))
        .label("not on this chip")
        .rule(rule)
        .help("profile Nv2a has it: write `profile: Nv2a`, or use what Nv10 has")
}

/// [`only_nv2a`], where something needs the larger chip and `profile` is the smaller one.
pub fn needs_nv2a(
    profile: Profile,
    needs: bool,
    code: &'static str,
    place: impl Into<Option<Span>>,
    what: &str,
    rule: &'static str,
) -> Option<Diagnostic> {
    (needs && profile == Profile::Nv10).then(|| only_nv2a(code, place, what, rule))
}

/// A text and its name in messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// Shown before line and column.
    pub name: String,
    /// The text, without a byte order mark.
    pub text: String,
}

impl Source {
    /// Line and column of a byte offset, both from 1; columns count characters.
    pub fn position(&self, offset: usize) -> (usize, usize) {
        let offset = floor_boundary(&self.text, offset);
        let before = &self.text[..offset];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        (1 + before.bytes().filter(|byte| *byte == b'\n').count(), 1 + before[line_start..].chars().count())
    }
}

/// The largest character boundary at or below `offset`.
pub fn floor_boundary(text: &str, offset: usize) -> usize {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

/// At most forty characters of one line.
pub fn shorten(text: &str) -> String {
    let line = text.lines().next().unwrap_or("");
    if line.chars().count() <= 40 { line.to_owned() } else { line.chars().take(37).chain("...".chars()).collect() }
}
