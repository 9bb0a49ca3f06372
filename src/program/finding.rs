//! What is wrong with a program, as data: the front end that has read it knows the text that the places are of.

use std::ops::Range;

/// One finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Stable code, one of `scene::code::CODES`.
    pub code: &'static str,
    /// Bytes of the program's text that are to blame.
    pub place: Range<usize>,
    /// What is wrong, in one line.
    pub message: String,
    /// Said under the marked text.
    pub label: String,
    /// The rule of `docs/numerics.md` behind it.
    pub rule: Option<&'static str>,
    /// What to do.
    pub help: String,
}

impl Finding {
    /// A finding without a rule.
    pub fn new(
        code: &'static str,
        place: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> Finding {
        Finding { code, place, message: message.into(), label: label.into(), rule: None, help: help.into() }
    }

    /// Names the rule behind it.
    pub fn rule(mut self, rule: &'static str) -> Finding {
        self.rule = Some(rule);
        self
    }
}

/// A value and the bytes of the text that gave it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct At<T> {
    /// The value.
    pub value: T,
    /// Its place; empty if nothing was written.
    pub place: Range<usize>,
}

impl<T> At<T> {
    /// What holds where nothing is written.
    pub fn default_of(value: T) -> At<T> {
        At { value, place: 0..0 }
    }
}
