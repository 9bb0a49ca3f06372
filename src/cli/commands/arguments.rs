//! Arguments that several commands share, and the context of every command.

use clap::{Args, ValueEnum};
use ninebit::shown;
use ninebit::state::Named;
use ninebit_files::output::{write_json, write_text};

use super::exit::Failure;

/// How a command prints its data.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum Format {
    /// For people
    Text,
    /// For programs: one JSON document
    Json,
}

impl Format {
    /// Prints data in this format.
    pub(super) fn print(self, text: impl FnOnce() -> String, json: impl FnOnce() -> String) -> Result<(), Failure> {
        let printed = match self {
            Format::Text => write_text(&text()),
            Format::Json => write_json(&json()),
        };
        Ok(printed?)
    }
}

/// `--format`, where `--json` was once all that there was.
#[derive(Debug, Args)]
pub(super) struct FormatArguments {
    /// How to print the result
    #[arg(long, value_enum, default_value_t = Format::Text, conflicts_with = "json")]
    format: Format,
    #[arg(long, hide = true)]
    json: bool,
}

impl FormatArguments {
    pub(super) fn get(&self) -> Format {
        if self.json { Format::Json } else { self.format }
    }
}

/// Returns the index of a text among names, ignoring case.
pub(super) fn one_of(names: &[&str], text: &str) -> Result<usize, String> {
    let found = names.iter().position(|name| name.eq_ignore_ascii_case(text));
    found.ok_or_else(|| format!("not one of {}", names.join(", ")))
}

/// Parses the name of an enumeration's variant, ignoring case.
pub(super) fn named<T: Named>(text: &str) -> Result<T, String> {
    one_of(T::NAMES, text).map(|index| T::ALL[index])
}

/// Parses a whole number from 0 to `MAX`.
pub(super) fn up_to<const MAX: usize>(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|number| *number <= MAX).ok_or_else(|| shown::not_up_to(MAX))
}

/// Context of every command.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Context {
    /// Whether messages on stderr are coloured.
    pub(super) color: bool,
}
