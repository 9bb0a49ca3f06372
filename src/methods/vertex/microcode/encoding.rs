//! The fields of a slot's words.

use super::Slot;
use super::instruction::{Instruction, Mac, Operand, Scalar, Source};

/// A field: word, lowest bit, number of bits.
struct Field(usize, u32, u32);

impl Field {
    fn get(&self, slot: &Slot) -> u8 {
        (slot[self.0] >> self.1 & ((1 << self.2) - 1)) as u8
    }

    fn set(&self, slot: &mut Slot, value: u8) {
        slot[self.0] |= (u32::from(value) & ((1 << self.2) - 1)) << self.1;
    }
}

const SCALAR: Field = Field(1, 25, 3);
const MAC: Field = Field(1, 21, 4);
const CONSTANT: Field = Field(1, 13, 8);
const INPUT: Field = Field(1, 9, 4);
const VECTOR_MASK: Field = Field(3, 24, 4);
const TEMPORARY: Field = Field(3, 20, 4);
const SCALAR_MASK: Field = Field(3, 16, 4);
const OUTPUT_MASK: Field = Field(3, 12, 4);
const IS_OUTPUT: Field = Field(3, 11, 1);
const OUTPUT_ADDRESS: Field = Field(3, 3, 8);
const OUTPUT_IS_SCALAR: Field = Field(3, 2, 1);
const IS_RELATIVE: Field = Field(3, 1, 1);
const IS_LAST: Field = Field(3, 0, 1);

/// The fields of an operand.
struct OperandFields {
    negate: Field,
    /// Four components of two bits, x highest.
    swizzle: Field,
    /// The number of the temporary register: the field with its upper bits, and that with its lower ones.
    temporary: [Field; 2],
    source: Field,
}

const OPERANDS: [OperandFields; 3] = [
    OperandFields {
        negate: Field(1, 8, 1),
        swizzle: Field(1, 0, 8),
        temporary: [Field(2, 30, 2), Field(2, 28, 2)],
        source: Field(2, 26, 2),
    },
    OperandFields {
        negate: Field(2, 25, 1),
        swizzle: Field(2, 17, 8),
        temporary: [Field(2, 15, 2), Field(2, 13, 2)],
        source: Field(2, 11, 2),
    },
    // The number of c's register lies across two words.
    OperandFields {
        negate: Field(2, 10, 1),
        swizzle: Field(2, 2, 8),
        temporary: [Field(2, 0, 2), Field(3, 30, 2)],
        source: Field(3, 28, 2),
    },
];

/// Returns a mask with its bits in the other order: the words have x highest.
fn reversed(mask: u8) -> u8 {
    mask.reverse_bits() >> 4
}

impl OperandFields {
    fn get(&self, slot: &Slot) -> Operand {
        let swizzle = self.swizzle.get(slot);
        Operand {
            source: Source::ALL[usize::from(self.source.get(slot))],
            temporary: self.temporary[0].get(slot) << 2 | self.temporary[1].get(slot),
            swizzle: [6, 4, 2, 0].map(|low| swizzle >> low & 3),
            negate: self.negate.get(slot) == 1,
        }
    }

    fn set(&self, slot: &mut Slot, operand: &Operand) {
        self.source.set(slot, operand.source as u8);
        self.temporary[0].set(slot, operand.temporary >> 2);
        self.temporary[1].set(slot, operand.temporary);
        self.swizzle.set(slot, operand.swizzle.iter().fold(0, |all, component| all << 2 | component & 3));
        self.negate.set(slot, operand.negate.into());
    }
}

/// Reads the words of a slot. The first word and the highest four bits of the second mean nothing.
pub fn decode(slot: &Slot) -> Instruction {
    Instruction {
        mac: Mac::ALL[usize::from(MAC.get(slot))],
        scalar: Scalar::ALL[usize::from(SCALAR.get(slot))],
        operands: OPERANDS.map(|fields| fields.get(slot)),
        input: INPUT.get(slot),
        constant: CONSTANT.get(slot),
        is_relative: IS_RELATIVE.get(slot) == 1,
        temporary: TEMPORARY.get(slot),
        vector_mask: reversed(VECTOR_MASK.get(slot)),
        scalar_mask: reversed(SCALAR_MASK.get(slot)),
        output_mask: reversed(OUTPUT_MASK.get(slot)),
        output_address: OUTPUT_ADDRESS.get(slot),
        writes_constant: IS_OUTPUT.get(slot) == 0,
        output_is_scalar: OUTPUT_IS_SCALAR.get(slot) == 1,
        is_last: IS_LAST.get(slot) == 1,
    }
}

/// Returns the words of a slot. Bits of a field beyond its width are left out.
pub fn encode(instruction: &Instruction) -> Slot {
    let mut slot = [0; 4];
    MAC.set(&mut slot, instruction.mac as u8);
    SCALAR.set(&mut slot, instruction.scalar as u8);
    for (fields, operand) in OPERANDS.iter().zip(&instruction.operands) {
        fields.set(&mut slot, operand);
    }
    INPUT.set(&mut slot, instruction.input);
    CONSTANT.set(&mut slot, instruction.constant);
    IS_RELATIVE.set(&mut slot, instruction.is_relative.into());
    TEMPORARY.set(&mut slot, instruction.temporary);
    VECTOR_MASK.set(&mut slot, reversed(instruction.vector_mask));
    SCALAR_MASK.set(&mut slot, reversed(instruction.scalar_mask));
    OUTPUT_MASK.set(&mut slot, reversed(instruction.output_mask));
    OUTPUT_ADDRESS.set(&mut slot, instruction.output_address);
    IS_OUTPUT.set(&mut slot, (!instruction.writes_constant).into());
    OUTPUT_IS_SCALAR.set(&mut slot, instruction.output_is_scalar.into());
    IS_LAST.set(&mut slot, instruction.is_last.into());
    slot
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vertex::random::Random;

    /// All bits but those that mean nothing come back.
    #[test]
    fn words_come_back() {
        let mut random = Random::new(1);
        for _ in 0..100_000 {
            let slot: Slot = random.words();
            let [_, second, third, fourth] = slot;
            assert_eq!(encode(&decode(&slot)), [0, second & 0x0fff_ffff, third, fourth]);
        }
    }

    /// `MAD oPos.xyz, R12, R1.x, c[59]` with the last bit, field by field.
    #[test]
    fn fields_of_one_slot() {
        let instruction = decode(&[0, 0x0087_601b, 0xc400_286c, 0x3070_e801]);
        let swizzled = |source, temporary, swizzle| Operand { source, temporary, swizzle, negate: false };
        assert_eq!(
            instruction,
            Instruction {
                mac: Mac::Mad,
                operands: [
                    swizzled(Source::Temporary, 12, [0, 1, 2, 3]),
                    swizzled(Source::Temporary, 1, [0, 0, 0, 0]),
                    swizzled(Source::Constant, 0, [0, 1, 2, 3]),
                ],
                constant: 59,
                temporary: 7,
                output_mask: 0b0111,
                is_last: true,
                ..Instruction::default()
            }
        );
    }
}
