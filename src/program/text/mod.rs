//! The combiner language: general stages and final combiner as statements.
//!
//! The grammar is in `docs/combiner-language.md`.

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

/// A program that was read and checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// What it says.
    pub combiners: Combiners,
    /// Where its parts stand.
    pub places: Places,
    /// What is probably not meant.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a program and holds it against a chip.
///
/// # Errors
/// Everything that is wrong with it, with places in `text`.
pub fn parse(text: &str, profile: Profile) -> Result<Program, Vec<Diagnostic>> {
    let mut program = read(text)?;
    program.warnings.extend(check(&program.combiners, profile, &program.places, &Words).findings);
    if program.warnings.iter().any(|finding| finding.severity == Severity::Error) {
        return Err(program.warnings);
    }
    Ok(program)
}

/// Reads a program without asking whether a chip allows it.
///
/// # Errors
/// Everything that is wrong with its notation, with places in `text`; at most 64 findings.
pub fn read(text: &str) -> Result<Program, Vec<Diagnostic>> {
    parser::Parser::new(text).program()
}
