//! Values with their places, and findings about them.

use std::ops::Range;

use crate::diagnostic::Diagnostic;

/// A value and the bytes of the program's text that gave it.
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

/// An error about a part of a program.
pub(super) fn finding(
    code: &'static str,
    place: Range<usize>,
    message: impl Into<String>,
    label: &str,
    help: impl Into<String>,
) -> Diagnostic {
    Diagnostic::error(code, place, message).label(label).help(help)
}
