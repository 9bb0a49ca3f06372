//! Vertex programs in the assembler language vs.1.1 of Direct3D 8 (`docs/languages/vertex-shader.md`).
//!
//! A program is read as a [`VertexShader`]; [`ninebit::vertex::shader`] runs it.

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

/// A program with the places of its parts in the text.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaderText {
    /// The program that was read.
    pub shader: VertexShader,
    /// Places of each instruction.
    pub places: Vec<InstructionPlaces>,
    /// Place of the register of each definition.
    pub definitions: Vec<Span>,
    /// Findings about what is legal but probably unintended.
    pub warnings: Vec<Diagnostic>,
}

/// Places of an instruction in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InstructionPlaces {
    /// Place of the instruction's name.
    pub(crate) opcode: Span,
    /// Place of the destination.
    pub(crate) destination: Span,
    /// Places of the sources, in order.
    pub sources: Vec<Span>,
}

/// Reads a program and checks everything that the text alone tells.
///
/// # Errors
/// All errors, without warnings.
pub fn read(text: &str) -> Result<ShaderText, Vec<Diagnostic>> {
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
