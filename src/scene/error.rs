//! The error that a scene was not accepted.

use std::fmt;

use ninebit::diagnostic::{Diagnostic, ErrorKind, Severity, Source};

use crate::render::render;

/// The error that a scene was not accepted: all its findings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    /// Errors and warnings in the order of the text; at least one is an error.
    pub diagnostics: Vec<Diagnostic>,
    /// Number of findings that were not kept.
    pub suppressed: usize,
    /// The text that the findings point into.
    pub source: Source,
}

impl SceneError {
    /// Returns the findings as text for a terminal.
    pub fn render(&self, color: bool) -> String {
        let mut text = render(&self.diagnostics, &self.source, color);
        if self.suppressed > 0 {
            text.push_str(&format!("\n... and {} more\n", self.suppressed));
        }
        text
    }

    /// Returns the kind that all errors share, or [`ErrorKind::Invalid`] if they differ.
    pub fn kind(&self) -> ErrorKind {
        let mut kinds = self.diagnostics.iter().filter(|d| d.severity == Severity::Error).map(Diagnostic::kind);
        let first = kinds.next().unwrap_or(ErrorKind::Invalid);
        if kinds.all(|kind| kind == first) { first } else { ErrorKind::Invalid }
    }

    /// Returns the exit code of the command line.
    pub fn exit_code(&self) -> u8 {
        self.kind().exit_code()
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for SceneError {}
