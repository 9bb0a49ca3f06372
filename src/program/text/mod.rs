//! The combiner language: general stages and final combiner as statements.
//!
//! `docs/languages/combiner-language.md` has the grammar.

mod final_part;
mod parser;
mod portion;
mod print;
mod statements;
pub mod words;

use super::Places;
use ninebit::diagnostic::{Diagnostic, Severity};
use ninebit::legality::check;
use ninebit::state::{Combiners, Profile};
use words::Words;

pub use print::print;

/// A program that has been read and checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// The program as state of the chip.
    pub combiners: Combiners,
    /// Places of its parts in the text.
    pub places: Places,
    /// Findings about what is probably unintended.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a program and checks it against a chip.
///
/// # Errors
/// All findings, with places in `text`.
pub fn parse(text: &str, profile: Profile) -> Result<Program, Vec<Diagnostic>> {
    let mut program = read(text)?;
    program.warnings.extend(check(&program.combiners, profile, &program.places, &Words).findings);
    if program.warnings.iter().any(|finding| finding.severity == Severity::Error) {
        return Err(program.warnings);
    }
    Ok(program)
}

/// Reads a program without checking it against a chip.
///
/// # Errors
/// All findings about the notation, with places in `text`; at most 64.
pub fn read(text: &str) -> Result<Program, Vec<Diagnostic>> {
    parser::Parser::new(text).program()
}
