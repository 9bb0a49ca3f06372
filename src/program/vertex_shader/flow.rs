//! Finds registers that are read before they are written, and those that are read at all.

use super::ShaderText;
use super::print::letters;
use crate::Span;
use crate::finding::finding;
use ninebit::diagnostic::Diagnostic;
use ninebit::vertex::shader::{CONSTANTS, DestinationRegister, INPUTS, Instruction, SourceRegister, TEMPORARIES};

/// Returns, for each instruction, the components of its result on which something later depends.
fn needed(instructions: &[Instruction]) -> Vec<u8> {
    let mut live = [0_u8; TEMPORARIES];
    let mut needed = vec![0; instructions.len()];
    for (instruction, needed) in instructions.iter().zip(&mut needed).rev() {
        let mask = instruction.destination.mask;
        *needed = mask;
        if let DestinationRegister::Temporary(index) = instruction.destination.register {
            *needed &= live[index];
            live[index] &= !mask;
        }
        for (register, components, _) in temporaries(instruction, *needed) {
            live[register] |= components;
        }
    }
    needed
}

/// Returns the temporaries from which the components `needed` of the result are computed: register, components, number of the source.
fn temporaries(instruction: &Instruction, needed: u8) -> Vec<(usize, u8, usize)> {
    let mut read = Vec::new();
    for (n, source) in instruction.sources.iter().enumerate() {
        let SourceRegister::Temporary(index) = source.register else { continue };
        let components = source.components(instruction.opcode.reads(n, needed));
        match instruction.opcode.matrix() {
            Some((rows, _)) if n == 1 => {
                let rows = (0..rows).filter(|row| needed >> row & 1 != 0 && index + row < TEMPORARIES);
                read.extend(rows.map(|row| (index + row, components, n)));
            }
            _ => read.push((index, components, n)),
        }
    }
    read
}

/// Finds temporaries that are read before they are written, where the result matters.
pub(super) fn unwritten(written: &ShaderText, findings: &mut Vec<Diagnostic>) {
    let mut known = [0_u8; TEMPORARIES];
    let needed = needed(&written.shader.instructions);
    for ((instruction, places), needed) in written.shader.instructions.iter().zip(&written.places).zip(needed) {
        for (register, components, source) in temporaries(instruction, needed) {
            let missing = components & !known[register];
            if missing == 0 {
                continue;
            }
            // Each component is reported once.
            known[register] |= missing;
            let letters = letters((0..4).filter(|k| missing >> k & 1 != 0));
            let message = format!("r{register}.{letters} is read before anything writes it");
            let help =
                format!("write r{register} first, or leave the component out of the swizzle or of the write mask");
            findings.push(finding("NB0383", places.sources[source].clone(), message, "not written yet", help));
        }
        if let DestinationRegister::Temporary(index) = instruction.destination.register {
            known[index] |= instruction.destination.mask;
        }
    }
}

impl ShaderText {
    /// Returns the first place where each constant is read, if it is, and whether some are read by an address.
    pub fn constants_read(&self) -> ([Option<Span>; CONSTANTS], bool) {
        let mut read: [Option<Span>; CONSTANTS] = std::array::from_fn(|_| None);
        let mut any = false;
        for (instruction, places) in self.shader.instructions.iter().zip(&self.places) {
            for (n, (source, span)) in instruction.sources.iter().zip(&places.sources).enumerate() {
                let SourceRegister::Constant { index, relative } = source.register else { continue };
                any |= relative;
                let rows = instruction.opcode.matrix().filter(|_| n == 1).map_or(1, |(rows, _)| rows);
                for slot in read.iter_mut().skip(index).take(rows).filter(|slot| slot.is_none() && !relative) {
                    *slot = Some(span.clone());
                }
            }
        }
        (read, any)
    }

    /// Returns the first place where each input is read, if it is.
    pub fn inputs_read(&self) -> [Option<Span>; INPUTS] {
        let mut read: [Option<Span>; INPUTS] = std::array::from_fn(|_| None);
        for (instruction, places) in self.shader.instructions.iter().zip(&self.places) {
            for (source, span) in instruction.sources.iter().zip(&places.sources) {
                let SourceRegister::Input(index) = source.register else { continue };
                read[index].get_or_insert_with(|| span.clone());
            }
        }
        read
    }
}
