//! Errors of an operation's options, shown at their place on the command line.

use std::ffi::OsString;
use std::ops::Range;

use ninebit::diagnostic::{Diagnostic, Severity, Source};
use ninebit::shown;
use ninebit_scene::SceneError;

use super::{Context, Failure};
use crate::commands::scene::refused_beside;

/// The command line as one text, for messages that point into it.
pub(super) struct CommandLine {
    text: String,
    /// Positions of its words.
    words: Vec<Range<usize>>,
}

impl CommandLine {
    /// Returns the command line of this process.
    pub(super) fn of_this_process() -> Self {
        CommandLine::new(std::env::args_os().skip(1))
    }

    fn new(arguments: impl Iterator<Item = OsString>) -> Self {
        let (mut text, mut words) = ("ninebit".to_owned(), Vec::new());
        for word in arguments {
            text.push(' ');
            let start = text.len();
            text.push_str(&shown::name(&word.to_string_lossy()));
            words.push(start..text.len());
        }
        CommandLine { text, words }
    }

    /// Returns the place of an option's value, or of the option itself if it has no value, or `None` if it is not given. `names` are
    /// without dashes.
    pub(super) fn value_range(&self, names: &[&str]) -> Option<Range<usize>> {
        let word = |index: usize| self.words.get(index).map(|place| (place, &self.text[place.clone()]));
        (0..self.words.len()).rev().find_map(|index| {
            let (place, option) = word(index)?;
            let (name, value) = match option.strip_prefix("--")?.split_once('=') {
                Some((name, value)) => (name, Some(place.end - value.len()..place.end)),
                None => (option.strip_prefix("--")?, None),
            };
            let is_value = |text: &str| text.strip_prefix('-').is_none_or(|rest| rest.starts_with(char::is_numeric));
            let next = word(index + 1).filter(|(_, text)| is_value(text)).map(|(place, _)| place.clone());
            names.contains(&name).then(|| value.or(next).unwrap_or_else(|| place.clone()))
        })
    }

    /// Reports findings, and returns an error if one of them is an error.
    pub(super) fn accept(
        self,
        findings: impl IntoIterator<Item = Diagnostic>,
        context: Context,
    ) -> Result<(), Failure> {
        let errors = findings.into_iter().filter(|finding| finding.severity == Severity::Error);
        let source = Source { name: "the command line".to_owned(), text: self.text };
        let error = SceneError { diagnostics: errors.collect(), suppressed: 0, source };
        if error.diagnostics.is_empty() {
            return Ok(());
        }
        Err(refused_beside(error, "`--profile nv10` or `nv2a` chooses the chip", context))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_flags_are_found() {
        let words = "op combiner --a tex0 --b=tex1.a --bias --scale 4 --index -3 --dot -o out --a tex2".split(' ');
        let line = CommandLine::new(words.map(OsString::from));
        let found = |name: &str| line.value_range(&["other", name]).map(|place| &line.text[place]);
        assert_eq!(found("a"), Some("tex2"));
        assert_eq!((found("b"), found("bias"), found("scale")), (Some("tex1.a"), Some("--bias"), Some("4")));
        assert_eq!((found("index"), found("dot"), found("c")), (Some("-3"), Some("--dot"), None));
    }
}
