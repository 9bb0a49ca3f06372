//! Why a scene was not accepted.

use std::fmt;

use ninebit::diagnostic::{Diagnostic, ErrorKind, Severity, Source};

use crate::render::render;

/// Why a scene was not accepted: everything that is wrong with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    /// Errors and warnings, in the order of the text. At least one error.
    pub diagnostics: Vec<Diagnostic>,
    /// Findings beyond the ones kept.
    pub suppressed: usize,
    /// The text they point into.
    pub source: Source,
}

impl SceneError {
    /// The findings as text for a terminal.
    pub fn render(&self, color: bool) -> String {
        let mut text = render(&self.diagnostics, &self.source, color);
        if self.suppressed > 0 {
            text.push_str(&format!("\n... and {} more\n", self.suppressed));
        }
        text
    }

    /// The kind that all errors share; [`ErrorKind::Invalid`] if they differ.
    pub fn kind(&self) -> ErrorKind {
        let mut kinds = self.diagnostics.iter().filter(|d| d.severity == Severity::Error).map(Diagnostic::kind);
        let first = kinds.next().unwrap_or(ErrorKind::Invalid);
        if kinds.all(|kind| kind == first) { first } else { ErrorKind::Invalid }
    }

    /// Exit code of the command line.
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
