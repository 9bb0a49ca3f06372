//! Says programs in vs.1.1, where that language can say them.

use super::instruction::{Destination, Instruction, Mac, Register, Scalar, Source, Unit};
use super::{CONSTANTS, Program, TEMPORARIES};
use crate::vertex::attribute;
use ninebit::vertex::shader::{self, DestinationRegister, Opcode, SourceRegister, VertexShader};
use ninebit_program::vertex_shader;

/// The constant that Direct3D calls c0.
const FIRST: usize = CONSTANTS - shader::CONSTANTS;

/// An operation of one unit with one destination.
struct Step {
    unit: Unit,
    destination: Destination,
}

impl Program {
    /// Returns the program in vs.1.1, with the same operations on the same registers: c0 is constant 96, as Direct3D has
    /// it. Only the rounding of the unit is not that of the language (VTX-1).
    ///
    /// Returns `None` if the language cannot say it: DPH and RCC, constants below 96, constants and colours of the back
    /// that are written, the position that is read back, units in company whose work cannot be put in a row, and programs
    /// that its checks refuse, such as those that read registers before they write them.
    pub fn vertex_shader(&self) -> Option<String> {
        if !self.is_complete() {
            return None;
        }
        let mut translated = VertexShader::default();
        for instruction in &self.instructions {
            for step in row(instruction)? {
                translated.instructions.push(translate(instruction, &step)?);
            }
        }
        let text = vertex_shader::print(&translated);
        let read = vertex_shader::read(&text).ok()?;
        (read.shader == translated).then_some(text)
    }
}

/// Returns the operations of a slot in an order in which none writes what a later one reads.
fn row(instruction: &Instruction) -> Option<Vec<Step>> {
    let of = |unit: Unit| instruction.destinations(unit).map(move |destination| Step { unit, destination });
    let mut left: Vec<Step> = of(Unit::Vector).chain(of(Unit::Scalar)).collect();
    let mut row = Vec::new();
    while !left.is_empty() {
        let free = (0..left.len()).find(|at| {
            let others = left.iter().enumerate().filter(|(other, _)| other != at);
            others.into_iter().all(|(_, other)| !reads(instruction, other.unit, left[*at].destination))
        })?;
        row.push(left.remove(free));
    }
    Some(row)
}

/// Returns whether a unit reads a component of what is written.
fn reads(instruction: &Instruction, unit: Unit, written: Destination) -> bool {
    let used = |components: [u8; 4]| components.into_iter().fold(0, |mask, component| mask | 1 << component);
    instruction.operands_of(unit).iter().map(|n| &instruction.operands[*n]).any(|operand| match written.register {
        Register::Temporary(number) => {
            operand.source == Source::Temporary
                && operand.temporary == number
                && used(operand.swizzle) & written.mask != 0
        }
        Register::Address => operand.source == Source::Constant && instruction.is_relative,
        Register::Output(_) | Register::Constant(_) => false,
    })
}

fn translate(instruction: &Instruction, step: &Step) -> Option<shader::Instruction> {
    let opcode = match step.unit {
        Unit::Vector => vector_opcode(instruction.mac)?,
        Unit::Scalar => scalar_opcode(instruction.scalar)?,
    };
    let one_component = step.unit == Unit::Scalar && instruction.scalar.is_scalar();
    let sources = instruction.operands_of(step.unit).iter().map(|n| {
        let operand = &instruction.operands[*n];
        let register = match operand.source {
            Source::Input => SourceRegister::Input(instruction.input.into()),
            Source::Temporary if !operand.is_position() => Some(usize::from(operand.temporary))
                .filter(|number| *number < TEMPORARIES)
                .map(SourceRegister::Temporary)?,
            Source::Constant => SourceRegister::Constant {
                index: usize::from(instruction.constant)
                    .checked_sub(FIRST)
                    .filter(|index| *index < shader::CONSTANTS)?,
                relative: instruction.is_relative,
            },
            Source::Temporary | Source::None => return None,
        };
        let swizzle = operand.swizzle.map(usize::from);
        let swizzle = if one_component { [swizzle[0]; 4] } else { swizzle };
        Some(shader::Source { register, swizzle, negate: operand.negate })
    });
    let sources: Option<Vec<_>> = sources.collect();
    Some(shader::Instruction { opcode, destination: destination(step.destination)?, sources: sources? })
}

fn vector_opcode(mac: Mac) -> Option<Opcode> {
    Some(match mac {
        Mac::Mov | Mac::Arl => Opcode::Mov,
        Mac::Mul => Opcode::Mul,
        Mac::Add => Opcode::Add,
        Mac::Mad => Opcode::Mad,
        Mac::Dp3 => Opcode::Dp3,
        Mac::Dp4 => Opcode::Dp4,
        Mac::Dst => Opcode::Dst,
        Mac::Min => Opcode::Min,
        Mac::Max => Opcode::Max,
        Mac::Slt => Opcode::Slt,
        Mac::Sge => Opcode::Sge,
        Mac::Dph | Mac::Nop | Mac::Reserved14 | Mac::Reserved15 => return None,
    })
}

fn scalar_opcode(scalar: Scalar) -> Option<Opcode> {
    Some(match scalar {
        Scalar::Mov => Opcode::Mov,
        Scalar::Rcp => Opcode::Rcp,
        Scalar::Rsq => Opcode::Rsq,
        Scalar::Exp => Opcode::Expp,
        Scalar::Log => Opcode::Logp,
        Scalar::Lit => Opcode::Lit,
        Scalar::Rcc | Scalar::Nop => return None,
    })
}

fn destination(written: Destination) -> Option<shader::Destination> {
    let mut mask = written.mask;
    let register = match written.register {
        Register::Temporary(number) => DestinationRegister::Temporary(number.into()),
        Register::Address => DestinationRegister::Address,
        Register::Constant(_) => return None,
        Register::Output(number) => match usize::from(number) {
            attribute::POSITION => DestinationRegister::Position,
            attribute::DIFFUSE => DestinationRegister::Color(0),
            attribute::SPECULAR => DestinationRegister::Color(1),
            // Both have one component. A slot that writes another than x has no name for it.
            attribute::FOG | attribute::POINT_SIZE if mask & 1 == 0 => return None,
            attribute::FOG => {
                mask = 1;
                DestinationRegister::Fog
            }
            attribute::POINT_SIZE => {
                mask = 1;
                DestinationRegister::PointSize
            }
            set @ attribute::TEXTURE..=12 => DestinationRegister::Coordinates(set - attribute::TEXTURE),
            _ => return None,
        },
    };
    Some(shader::Destination { register, mask })
}

#[cfg(test)]
mod tests {
    use super::super::{Operand, encode, passthrough};
    use super::*;

    fn text(slots: &[super::super::Slot]) -> Option<String> {
        Program::decode(slots, 0).vertex_shader()
    }

    #[test]
    fn a_simple_program() {
        let expected = "vs.1.1\nmov oPos, v0\nmov oD0, v3\nmov oD1, v4\nmov oFog.x, v5\nmov oPts.x, v6\n\
                        mov oT0, v9\nmov oT1, v10\nmov oT2, v11\nmov oT3, v12\n";
        assert_eq!(text(&passthrough()).as_deref(), Some(expected));
        // Without its end it is not the program that runs.
        assert_eq!(text(&passthrough()[..3]), None);
    }

    /// Operations in company become two, the one that reads before the one that writes.
    #[test]
    fn company_is_put_in_a_row() {
        let temporary = |number| Operand { temporary: number, ..Operand::new(Source::Temporary) };
        let first = Instruction {
            mac: Mac::Mov,
            operands: [Operand::new(Source::Input), Operand::default(), Operand::default()],
            vector_mask: 15,
            temporary: 1,
            ..Instruction::default()
        };
        // MOV oPos, R1 + RCP R1.x, R1.w: the first reads what the second writes.
        let second = Instruction {
            mac: Mac::Mov,
            scalar: Scalar::Rcp,
            operands: [temporary(1), Operand::default(), Operand { swizzle: [3; 4], ..temporary(1) }],
            scalar_mask: 1,
            output_mask: 15,
            is_last: true,
            ..Instruction::default()
        };
        let slots = [encode(&first), encode(&second)];
        assert_eq!(text(&slots).unwrap(), "vs.1.1\nmov r1, v0\nmov oPos, r1\nrcp r1.x, r1.w\n");
        // MUL R2, R1, c96 + RSQ R1.x, R2.x: both read what the other writes.
        let crossed = Instruction {
            mac: Mac::Mul,
            scalar: Scalar::Rsq,
            operands: [temporary(1), Operand::new(Source::Constant), temporary(2)],
            constant: 96,
            temporary: 2,
            vector_mask: 15,
            scalar_mask: 1,
            ..Instruction::default()
        };
        assert_eq!(text(&[encode(&first), encode(&crossed), encode(&second)]), None);
    }

    #[test]
    fn words_that_the_language_lacks() {
        let slot = |change: fn(&mut Instruction)| {
            let mut instruction = Instruction {
                mac: Mac::Dp4,
                operands: [Operand::new(Source::Input), Operand::new(Source::Constant), Operand::default()],
                constant: 191,
                output_mask: 15,
                is_last: true,
                ..Instruction::default()
            };
            change(&mut instruction);
            text(&[encode(&instruction)])
        };
        assert_eq!(slot(|_| {}).unwrap(), "vs.1.1\ndp4 oPos, v0, c95\n");
        let refused: [fn(&mut Instruction); 6] = [
            |instruction| instruction.mac = Mac::Dph,
            |instruction| instruction.constant = 95,
            |instruction| instruction.writes_constant = true,
            |instruction| instruction.operands[0] = Operand { temporary: 12, ..Operand::new(Source::Temporary) },
            |instruction| instruction.operands[0] = Operand::new(Source::Temporary),
            |instruction| instruction.output_address = 7,
        ];
        for (n, change) in refused.into_iter().enumerate() {
            assert_eq!(slot(change), None, "{n}");
        }
    }
}
