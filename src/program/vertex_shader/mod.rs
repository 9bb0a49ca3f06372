//! Vertex programs in the assembler language vs.1.1 of Direct3D 8, read and printed (`docs/vertex-shader.md`).
//!
//! A program becomes [`VertexShader`]; what that computes stands in [`ninebit::vertex::shader`].

mod check;
mod flow;
mod operand;
mod parser;
mod print;

use crate::Span;
use ninebit::diagnostic::{Diagnostic, Severity};
use ninebit::vertex::shader::VertexShader;
pub use parser::parse;
pub use print::print;

/// A program and where its parts stand in the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// The program that was read.
    pub shader: VertexShader,
    /// Where each instruction stands.
    pub places: Vec<InstructionPlaces>,
    /// Where the number of each definition stands.
    pub definitions: Vec<Span>,
    /// What is allowed but probably not meant.
    pub warnings: Vec<Diagnostic>,
}

/// Where an instruction stands: bytes of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InstructionPlaces {
    /// The word of the instruction.
    pub opcode: Span,
    /// What it writes.
    pub destination: Span,
    /// Each source, in order.
    pub sources: Vec<Span>,
}

/// Reads a program and checks everything that the text alone can tell.
///
/// # Errors
/// Everything that is wrong with it, warnings left out.
pub fn read(text: &str) -> Result<Written, Vec<Diagnostic>> {
    let (mut written, mut errors) = parser::lines(text);
    let findings = if errors.is_empty() { check::check(&written) } else { check::instructions(&written) };
    let (found, warnings): (Vec<_>, Vec<_>) =
        findings.into_iter().partition(|finding| finding.severity == Severity::Error);
    errors.extend(found);
    errors.sort_by_key(Diagnostic::order);
    written.warnings.extend(warnings);
    written.warnings.sort_by_key(Diagnostic::order);
    if errors.is_empty() { Ok(written) } else { Err(errors) }
}
