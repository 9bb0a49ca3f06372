//! Runs programs.

use super::function::*;
use super::instruction::*;
use super::{CONSTANTS, SLOTS, Slot, TEMPORARIES, decode};
use crate::vertex::{Attributes, DEFAULT, Outputs, attribute};
use ninebit::number::transform::*;

/// The values of all constants.
pub type Constants = [[f32; 4]; CONSTANTS];

/// A program as it runs: the slots from its start to the last one.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    pub(super) instructions: Vec<Instruction>,
}

impl Program {
    /// Reads the program that begins at slot `start`.
    pub fn decode(slots: &[Slot], start: usize) -> Program {
        let mut instructions = Vec::new();
        for slot in slots.iter().take(SLOTS).skip(start) {
            let instruction = decode(slot);
            instructions.push(instruction);
            if instruction.is_last {
                break;
            }
        }
        Program { instructions }
    }

    /// Returns the slots' fields.
    pub fn instructions(&self) -> &[Instruction] {
        &self.instructions
    }

    /// Returns whether the program has an end. Without one, [`run`](Self::run) stops behind the last slot that is known.
    pub fn is_complete(&self) -> bool {
        self.instructions.last().is_some_and(|instruction| instruction.is_last)
    }

    /// Returns which input registers the program reads.
    pub fn inputs(&self) -> [bool; 16] {
        let mut read = [false; 16];
        for instruction in &self.instructions {
            read[usize::from(instruction.input & 15)] |= instruction.reads(Source::Input);
        }
        read
    }

    /// Returns which constants the program reads, and whether it reads others by the address register.
    pub fn constants(&self) -> ([bool; CONSTANTS], bool) {
        let (mut read, mut by_address) = ([false; CONSTANTS], false);
        for instruction in self.instructions.iter().filter(|instruction| instruction.reads(Source::Constant)) {
            match read.get_mut(usize::from(instruction.constant)) {
                _ if instruction.is_relative => by_address = true,
                Some(read) => *read = true,
                None => {}
            }
        }
        (read, by_address)
    }

    /// Returns whether the program writes constants, which later vertices then read.
    pub fn writes_constants(&self) -> bool {
        let mut all = self.instructions.iter().flat_map(|instruction| {
            [Unit::Vector, Unit::Scalar].into_iter().flat_map(|unit| instruction.destinations(unit))
        });
        all.any(|destination| matches!(destination.register, Register::Constant(_)))
    }

    /// Runs the program on a vertex. Temporary registers begin as zero, outputs as (0, 0, 0, 1).
    pub fn run(&self, constants: &mut Constants, inputs: &Attributes) -> Outputs {
        let mut machine = Machine {
            constants,
            inputs,
            temporaries: [[0; 4]; TEMPORARIES],
            outputs: [DEFAULT.map(f32::to_bits); 16],
            address: 0,
        };
        for instruction in &self.instructions {
            machine.step(instruction);
        }
        let output = |number: usize| machine.outputs[number].map(f32::from_bits);
        Outputs {
            position: output(attribute::POSITION),
            diffuse: output(attribute::DIFFUSE),
            specular: output(attribute::SPECULAR),
            back_diffuse: output(attribute::BACK_DIFFUSE),
            back_specular: output(attribute::BACK_SPECULAR),
            fog: output(attribute::FOG)[0],
            point_size: output(attribute::POINT_SIZE)[0],
            coordinates: [0, 1, 2, 3].map(|set| output(attribute::TEXTURE + set)),
        }
    }
}

impl Instruction {
    /// Returns whether a unit reads an operand from this source.
    fn reads(&self, source: Source) -> bool {
        let used = [Unit::Vector, Unit::Scalar].into_iter().flat_map(|unit| self.operands_of(unit));
        used.into_iter().any(|n| self.operands[*n].source == source)
    }
}

struct Machine<'a> {
    constants: &'a mut Constants,
    inputs: &'a Attributes,
    temporaries: [[u32; 4]; TEMPORARIES],
    outputs: [[u32; 4]; 16],
    address: i32,
}

impl Machine<'_> {
    fn step(&mut self, instruction: &Instruction) {
        let operands = [0, 1, 2].map(|n| self.operand(instruction, &instruction.operands[n]));
        let results = [vector(instruction.mac, operands), scalar(instruction.scalar, operands[2])];
        for (unit, result) in [Unit::Vector, Unit::Scalar].into_iter().zip(results) {
            for destination in instruction.destinations(unit) {
                self.write(destination, result);
            }
        }
    }

    fn operand(&self, instruction: &Instruction, operand: &Operand) -> [u32; 4] {
        let value = match operand.source {
            Source::None => [0; 4],
            Source::Temporary if operand.is_position() => self.outputs[attribute::POSITION],
            Source::Temporary => self.temporaries.get(usize::from(operand.temporary)).copied().unwrap_or_default(),
            Source::Input => self.inputs[usize::from(instruction.input & 15)].map(f32::to_bits),
            Source::Constant => self.constant(instruction),
        };
        let sign = if operand.negate { SIGN } else { 0 };
        operand.swizzle.map(|component| value[usize::from(component & 3)] ^ sign)
    }

    /// Returns the constant that an instruction reads. Beyond the constants there are zeros, as `NV_vertex_program` has it.
    fn constant(&self, instruction: &Instruction) -> [u32; 4] {
        let base = if instruction.is_relative { self.address } else { 0 };
        let number = usize::try_from(base.saturating_add(i32::from(instruction.constant)));
        let value = number.ok().and_then(|number| self.constants.get(number));
        value.map_or([0; 4], |value| value.map(f32::to_bits))
    }

    fn write(&mut self, destination: Destination, result: [u32; 4]) {
        let mask = destination.mask;
        let merge = |old: [u32; 4]| -> [u32; 4] {
            std::array::from_fn(|k| if mask >> k & 1 == 1 { result[k] } else { old[k] })
        };
        match destination.register {
            // INFERRED: plainly the floor. xemu adds 0.001 for hosts whose products differ from the chip's.
            Register::Address => self.address = f32::from_bits(floor(result[0])) as i32,
            Register::Temporary(number) => {
                if let Some(register) = self.temporaries.get_mut(usize::from(number)) {
                    *register = merge(*register);
                }
            }
            // INFERRED, from xemu: fog has one component, which gets the first one that is written.
            Register::Output(number) if usize::from(number) == attribute::FOG => {
                self.outputs[attribute::FOG][0] = result[mask.trailing_zeros() as usize & 3];
            }
            Register::Output(number) => {
                let register = &mut self.outputs[usize::from(number & 15)];
                *register = merge(*register);
            }
            Register::Constant(number) => {
                if let Some(register) = self.constants.get_mut(usize::from(number)) {
                    *register = merge(register.map(f32::to_bits)).map(f32::from_bits);
                }
            }
        }
    }
}

/// Returns what the vector unit computes.
fn vector(mac: Mac, [a, b, c]: [[u32; 4]; 3]) -> [u32; 4] {
    let each = |f: &dyn Fn(usize) -> u32| [0, 1, 2, 3].map(f);
    let times = |k: usize| product(a[k], b[k]);
    let truth = |below: bool| if below { ONE } else { 0 };
    match mac {
        Mac::Nop | Mac::Reserved14 | Mac::Reserved15 => [0; 4],
        Mac::Mov | Mac::Arl => a,
        Mac::Mul => each(&times),
        Mac::Add => each(&|k| sum([a[k], c[k]])),
        Mac::Mad => each(&|k| sum([times(k), c[k]])),
        Mac::Dp3 => [sum([times(0), times(1), times(2)]); 4],
        Mac::Dph => [sum([times(0), times(1), times(2), product(ONE, b[3])]); 4],
        Mac::Dp4 => [sum([times(0), times(1), times(2), times(3)]); 4],
        Mac::Dst => [ONE, times(1), a[2], b[3]],
        Mac::Min => each(&|k| if is_below(a[k], b[k]) { a[k] } else { b[k] }),
        Mac::Max => each(&|k| if is_below(a[k], b[k]) { b[k] } else { a[k] }),
        Mac::Slt => each(&|k| truth(is_below(a[k], b[k]))),
        Mac::Sge => each(&|k| truth(!is_below(a[k], b[k]))),
    }
}

/// Returns what the scalar unit computes.
fn scalar(operation: Scalar, c: [u32; 4]) -> [u32; 4] {
    match operation {
        Scalar::Nop => [0; 4],
        Scalar::Mov => c,
        Scalar::Rcp => [reciprocal(c[0]); 4],
        Scalar::Rcc => [limited_reciprocal(c[0]); 4],
        Scalar::Rsq => [reciprocal_root(c[0]); 4],
        Scalar::Exp => exponential(c[0]),
        Scalar::Log => logarithm(c[0]),
        Scalar::Lit => lighting(c),
    }
}

#[cfg(test)]
#[path = "program_tests.rs"]
mod tests;
