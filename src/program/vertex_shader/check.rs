//! Checks what the language allows, as far as the text alone tells.

use super::print::{letters, name};
use super::{InstructionPlaces, ShaderText, flow};
use crate::Span;
use crate::finding::{finding, warning};
use ninebit::diagnostic::Diagnostic;
use ninebit::vertex::shader::*;

/// Checks each instruction by itself.
pub(super) fn instructions(written: &ShaderText) -> Vec<Diagnostic> {
    let mut findings = Vec::new();
    for (instruction, places) in written.shader.instructions.iter().zip(&written.places) {
        masks(instruction, places, &mut findings);
        rows(instruction, places, &mut findings);
        ports(instruction, places, &mut findings);
        scalar(instruction, places, &mut findings);
    }
    findings
}

/// Checks a program that could be read. Returns errors and warnings in the order of the text.
pub(super) fn check(written: &ShaderText) -> Vec<Diagnostic> {
    let mut findings = instructions(written);
    let (mut slots, mut addressed) = (0, false);
    for (instruction, places) in written.shader.instructions.iter().zip(&written.places) {
        let before = slots;
        slots += instruction.opcode.slots();
        if before <= SLOTS && slots > SLOTS {
            let message = format!("more than {SLOTS} instruction slots: this is number {slots}");
            let help = "m4x4 takes 4 slots, m3x3 and m4x3 take 3, exp and log 10 each, frc 3";
            findings.push(finding("NB0385", places.opcode.clone(), message, "too many from here", help));
        }
        addresses(instruction, places, &mut addressed, &mut findings);
    }
    flow::unwritten(written, &mut findings);
    overlaps(written, &mut findings);
    if written.shader.written(DestinationRegister::Position) == 0 {
        let span = written.places.last().map_or(0..0, |places| places.opcode.clone());
        let help = "write the position in clip space: `m4x4 oPos, v0, c0`";
        findings.push(finding("NB0386", span, "this program does not write oPos", "ends without a position", help));
    }
    findings.sort_by_key(Diagnostic::order);
    findings
}

/// Checks that a0.x is written by `mov` only, and before it is read.
fn addresses(
    instruction: &Instruction,
    places: &InstructionPlaces,
    addressed: &mut bool,
    findings: &mut Vec<Diagnostic>,
) {
    for (source, span) in instruction.sources.iter().zip(&places.sources) {
        if matches!(source.register, SourceRegister::Constant { relative: true, .. }) && !*addressed {
            *addressed = true;
            let message = "a0.x is read before anything writes it";
            let help = "write it first: `mov a0.x, v1.x`";
            findings.push(finding("NB0383", span.clone(), message, "not written yet", help));
        }
    }
    if instruction.destination.register == DestinationRegister::Address {
        *addressed = true;
        if instruction.opcode != Opcode::Mov {
            let message = format!("`{}` cannot write a0.x", instruction.opcode.word());
            let help = "compute into a temporary, then `mov a0.x, r0.x`";
            findings.push(finding("NB0380", places.destination.clone(), message, "only for `mov`", help));
        }
    }
}

/// Checks that an instruction allows its write mask.
fn masks(instruction: &Instruction, places: &InstructionPlaces, findings: &mut Vec<Diagnostic>) {
    let (opcode, mask) = (instruction.opcode, instruction.destination.mask);
    let takes = match opcode {
        Opcode::Frc => (![0b0010, 0b0011].contains(&mask)).then_some(".y or .xy"),
        _ => opcode.matrix().filter(|(rows, _)| mask != natural(*rows)).map(|(rows, _)| match rows {
            2 => ".xy",
            3 => ".xyz",
            _ => ".xyzw",
        }),
    };
    if let Some(takes) = takes {
        let message = format!("`{}` writes {takes}", opcode.word());
        let help = format!("write the mask {takes}, and `mov` from there");
        findings.push(finding("NB0384", places.destination.clone(), message, "another write mask", help));
    }
}

/// Returns the write mask of a matrix macro with this number of rows.
pub(super) fn natural(rows: usize) -> u8 {
    (1 << rows) - 1
}

/// Checks the rows of a matrix macro: that all exist, and that none is overwritten before it is read.
fn rows(instruction: &Instruction, places: &InstructionPlaces, findings: &mut Vec<Diagnostic>) {
    let Some((rows, _)) = instruction.opcode.matrix() else { return };
    let (Some(vector), Some(matrix)) = (instruction.sources.first(), instruction.sources.get(1)) else { return };
    let word = instruction.opcode.word();
    let (first, count, letter) = match matrix.register {
        SourceRegister::Input(index) => (index, INPUTS, 'v'),
        SourceRegister::Temporary(index) => (index, TEMPORARIES, 'r'),
        SourceRegister::Constant { index, .. } => (index, CONSTANTS, 'c'),
    };
    let relative = matches!(matrix.register, SourceRegister::Constant { relative: true, .. });
    if first + rows > count && !relative {
        let message = format!("`{word}` reads {rows} rows, up to {letter}{}", first + rows - 1);
        let help =
            format!("there are {letter}0 to {letter}{}: begin at {letter}{} at the latest", count - 1, count - rows);
        findings.push(finding("NB0206", places.sources[1].clone(), message, "the first of them", help));
    }
    if letter == 'v' && rows > 1 {
        let (span, message) = (places.sources[1].clone(), "rows of a matrix in inputs");
        let help = "move the rows into temporaries first; each of its dot products reads one register v";
        findings.push(finding("NB0382", span, message, "several inputs", help));
    }
    let DestinationRegister::Temporary(to) = instruction.destination.register else { return };
    let overwritten = vector.register == SourceRegister::Temporary(to)
        || matches!(matrix.register, SourceRegister::Temporary(first) if (first..first + rows).contains(&to));
    if overwritten {
        let message = format!("`{word}` overwrites r{to} while it still reads it");
        let help = "it is one dot product after the other: write to another temporary";
        findings.push(finding("NB0384", places.destination.clone(), message, "also a source", help));
    }
}

/// Checks that an instruction reads at most one register c and one register v.
fn ports(instruction: &Instruction, places: &InstructionPlaces, findings: &mut Vec<Diagnostic>) {
    let mut first: [Option<(SourceRegister, Span)>; 2] = [None, None];
    for (source, span) in instruction.sources.iter().zip(&places.sources) {
        let (port, what) = match source.register {
            SourceRegister::Input(_) => (0, "inputs"),
            SourceRegister::Constant { .. } => (1, "constants"),
            SourceRegister::Temporary(_) => continue,
        };
        match &first[port] {
            None => first[port] = Some((source.register, span.clone())),
            Some((known, at)) if *known != source.register => {
                let message =
                    format!("`{}` reads two {what}; vs.1.1 reads one for each instruction", instruction.opcode.word());
                let help = format!("move one of them into a temporary before: `mov r11, {}`", name(source.register));
                let found = finding("NB0382", span.clone(), message, "the second", help);
                findings.push(found.related(at.clone(), "the first"));
            }
            Some(_) => {}
        }
    }
}

/// Warns of a scalar source without a component, since only one component counts.
fn scalar(instruction: &Instruction, places: &InstructionPlaces, findings: &mut Vec<Diagnostic>) {
    let Some(source) = instruction.sources.first().filter(|_| instruction.opcode.is_scalar()) else { return };
    if source.swizzle.iter().all(|k| *k == source.swizzle[0]) {
        return;
    }
    let word = instruction.opcode.word();
    let taken = letters([source.swizzle[3]]);
    let message = format!("`{word}` reads one component, which is not named");
    let label = format!("taken as .{taken}");
    let help = format!("write `.{taken}` or another component behind the register");
    findings.push(warning("NB0912", places.sources[0].clone(), message, label, help).rule("VTX-1"));
}

/// Warns of a constant that is a row of a matrix in one place and something else in another.
fn overlaps(written: &ShaderText, findings: &mut Vec<Diagnostic>) {
    let shader = &written.shader;
    // For each constant, the first row of the matrix that it belongs to, and the place where that matrix is read.
    let mut row_of: Vec<Option<(usize, Span)>> = vec![None; CONSTANTS];
    let constant = |instruction: &Instruction, n: usize| match instruction.sources.get(n).map(|source| source.register)
    {
        Some(SourceRegister::Constant { index, relative: false }) => Some(index),
        _ => None,
    };
    for (instruction, places) in shader.instructions.iter().zip(&written.places) {
        let Some(((rows, _), base)) = instruction.opcode.matrix().zip(constant(instruction, 1)) else { continue };
        let word = instruction.opcode.word();
        let taken = (base..(base + rows).min(CONSTANTS)).find_map(|row| {
            let (other, span) = row_of[row].clone()?;
            (other != base).then_some((row, other, span))
        });
        if let Some((row, other, span)) = taken {
            let message = format!("`{word}` reads a matrix from c{base}, and c{row} belongs to the matrix at c{other}");
            let help = "matrices of four rows begin four constants apart";
            let finding = warning("NB0911", places.sources[1].clone(), message, "overlaps", help);
            findings.push(finding.related(span, format!("the matrix at c{other}")));
        }
        for row in row_of.iter_mut().skip(base).take(rows).filter(|row| row.is_none()) {
            *row = Some((base, places.sources[1].clone()));
        }
    }
    for (instruction, places) in shader.instructions.iter().zip(&written.places) {
        let rows = instruction.opcode.matrix().is_some();
        for (n, source) in instruction.sources.iter().enumerate() {
            let Some(index) = constant(instruction, n).filter(|_| !(rows && n == 1)) else { continue };
            let product = matches!(instruction.opcode, Opcode::Dp3 | Opcode::Dp4) && !source.negate;
            let Some((base, span)) = row_of[index].clone().filter(|_| !product) else { continue };
            let message = format!("c{index} is a vector here and a row of the matrix at c{base}");
            let help = "give the vector a constant of its own";
            let finding = warning("NB0911", places.sources[n].clone(), message, "a second meaning", help);
            findings.push(finding.related(span, format!("reads c{index} as a row")));
        }
    }
}
