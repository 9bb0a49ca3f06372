//! Lines of a vertex program without their comments, taken apart from left to right.

use std::ops::Range;

use crate::finding::finding;
use ninebit::diagnostic::Diagnostic;

/// Comments and line ends of a text.
pub(super) struct Uncommented {
    /// The text with spaces in place of its comments, byte for byte.
    pub(super) text: String,
    /// Places of the comments that a semicolon began, without it.
    pub(super) behind_semicolons: Vec<Range<usize>>,
}

/// Blanks the comments: `//` and `;` up to the end of the line, `/* */`.
pub(super) fn uncomment(text: &str, findings: &mut Vec<Diagnostic>) -> Uncommented {
    let mut result = Uncommented { text: String::with_capacity(text.len()), behind_semicolons: Vec::new() };
    let mut at = 0;
    while let Some(sign) = text[at..].chars().next() {
        let rest = &text[at..];
        let line = rest.find('\n').unwrap_or(rest.len());
        let comment = if rest.starts_with("//") {
            line
        } else if sign == ';' {
            result.behind_semicolons.push(at + 1..at + line);
            line
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or_else(
                || {
                    let message = "this comment does not end";
                    findings.push(finding("NB0108", at..at + 2, message, "opened here", "close it with `*/`"));
                    rest.len()
                },
                |end| end + 2,
            )
        } else {
            result.text.push(sign);
            at += sign.len_utf8();
            continue;
        };
        for byte in rest.as_bytes()[..comment].iter() {
            result.text.push(if *byte == b'\n' { '\n' } else { ' ' });
        }
        at += comment;
    }
    result
}

/// A part of a line that is being read.
#[derive(Clone)]
pub(super) struct Scanner<'t> {
    text: &'t str,
    /// The next byte.
    at: usize,
    end: usize,
}

impl<'t> Scanner<'t> {
    /// A part of a text.
    pub(super) fn new(text: &'t str, part: Range<usize>) -> Self {
        Scanner { text, at: part.start, end: part.end }
    }

    fn rest(&self) -> &'t str {
        self.text.get(self.at..self.end).unwrap_or("")
    }

    /// The text of a place.
    pub(super) fn text(&self, place: &Range<usize>) -> &'t str {
        self.text.get(place.clone()).unwrap_or("")
    }

    /// The next byte.
    pub(super) fn position(&self) -> usize {
        self.at
    }

    /// Passes over spaces; the place that comes then.
    pub(super) fn here(&mut self) -> usize {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start().len();
        self.at
    }

    /// Whether nothing but spaces is left.
    pub(super) fn is_done(&mut self) -> bool {
        self.here() >= self.end
    }

    /// What is left, without spaces at its ends.
    pub(super) fn remaining(&mut self) -> Range<usize> {
        let start = self.here();
        start..start + self.rest().trim_end().len()
    }

    /// Takes a sign if it comes next, and says where it stands.
    pub(super) fn sign(&mut self, sign: char) -> Option<Range<usize>> {
        let at = self.here();
        let found = self.rest().starts_with(sign);
        found.then(|| {
            self.at += sign.len_utf8();
            at..self.at
        })
    }

    /// Takes a word of letters, digits and `_`; its place, empty if none comes next.
    pub(super) fn word(&mut self) -> Range<usize> {
        let at = self.here();
        let inside = |c: char| c.is_ascii_alphanumeric() || c == '_';
        self.at += self.rest().find(|c| !inside(c)).unwrap_or(self.rest().len());
        at..self.at
    }

    /// Takes everything up to a comma, or to the end.
    pub(super) fn until_comma(&mut self) -> Range<usize> {
        let at = self.here();
        let part = self.rest().split(',').next().unwrap_or("");
        self.at += part.len();
        at..at + part.trim_end().len()
    }

    /// The next sign or word, for "found `...`"; empty at the end.
    pub(super) fn next(&mut self) -> Range<usize> {
        let word = self.clone().word();
        if !word.is_empty() {
            return word;
        }
        let at = self.here();
        at..at + self.rest().chars().next().map_or(0, char::len_utf8)
    }
}
