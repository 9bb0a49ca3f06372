//! Errors of scenes that cannot be planned.

use crate::diagnostic::Diagnostic;
use crate::place::Span;
use std::fmt;

/// The reason why a scene cannot be planned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanError {
    /// Index of the draw, if one is to blame.
    pub draw: Option<usize>,
    /// Index of the vertex, if one is to blame.
    pub vertex: Option<usize>,
    /// Index of the texture unit of the draw, if one is to blame.
    pub unit: Option<usize>,
    /// Stable code, like that of a [`Diagnostic`].
    pub code: &'static str,
    /// Rule that is violated, if there is one.
    pub rule: Option<&'static str>,
    /// Description of the error.
    pub message: String,
    /// Advice on what to do.
    pub help: String,
}

impl PlanError {
    /// Creates an error of the scene as a whole.
    pub(crate) fn new(
        code: &'static str,
        rule: impl Into<Option<&'static str>>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        let (rule, message, help) = (rule.into(), message.into(), help.into());
        PlanError { draw: None, vertex: None, unit: None, code, rule, message, help }
    }

    /// Returns the error as a finding about the given part of a text.
    pub fn diagnostic(&self, place: impl Into<Option<Span>>) -> Diagnostic {
        let finding = Diagnostic::error(self.code, place, self.message.as_str()).help(self.help.as_str());
        Diagnostic { rule: self.rule, ..finding }
    }
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.code)?;
        match (self.draw, self.vertex) {
            (Some(draw), Some(vertex)) => write!(f, "draw {draw}, vertex {vertex}: ")?,
            (Some(draw), None) => write!(f, "draw {draw}: ")?,
            (None, _) => {}
        }
        if let Some(unit) = self.unit {
            write!(f, "texture unit {unit}: ")?;
        }
        f.write_str(&self.message)?;
        if let Some(rule) = self.rule {
            write!(f, " ({rule})")?;
        }
        if self.help.is_empty() { Ok(()) } else { write!(f, "; {}", self.help) }
    }
}

impl std::error::Error for PlanError {}
