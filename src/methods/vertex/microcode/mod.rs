//! Vertex programs as microcode: 136 slots of four words, 192 constants, and two units that work at once.
//!
//! The vector unit (MAC) and the scalar unit (ILU) of a slot read their operands before either writes. The fields of the
//! words are those of nxdk's and envytools' documents and of abaire's nv2a_vsh_asm, which agree. INFERRED: what the units
//! compute (`ninebit::number::transform`, `function.rs`), and from xemu that a scalar unit in company writes only R1, and a vector unit in
//! company never R1.

mod encoding;
mod function;
mod instruction;
mod print;
mod program;
mod tables;
mod translate;

pub use encoding::{decode, encode};
pub use instruction::{Destination, Instruction, Mac, Operand, Register, Scalar, Source, Unit};
pub use program::{Constants, Program};

use super::attribute;

/// Number of slots of a program.
pub const SLOTS: usize = 136;
/// Number of constants. Direct3D calls the 97th c0, and its c-96 is the first.
pub const CONSTANTS: usize = 192;
/// Number of temporary registers, R0 to R11.
pub const TEMPORARIES: usize = 12;
/// The temporary register that gives the position as it was written so far.
pub const POSITION_READ: u8 = 12;

/// The words of a slot.
pub type Slot = [u32; 4];

/// Returns a program that hands a vertex through: position, colours, fog, point size and texture coordinates.
pub fn passthrough() -> Vec<Slot> {
    let copied = [
        attribute::POSITION,
        attribute::DIFFUSE,
        attribute::SPECULAR,
        attribute::FOG,
        attribute::POINT_SIZE,
        attribute::TEXTURE,
        attribute::TEXTURE + 1,
        attribute::TEXTURE + 2,
        attribute::TEXTURE + 3,
    ];
    let slot = |attribute: usize| {
        let number = attribute as u8;
        let operands = [Operand::new(Source::Input), Operand::default(), Operand::default()];
        encode(&Instruction {
            mac: Mac::Mov,
            input: number,
            operands,
            output_mask: 15,
            output_address: number,
            is_last: attribute == attribute::TEXTURE + 3,
            ..Instruction::default()
        })
    };
    copied.map(slot).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passthrough_hands_all_through() {
        let program = Program::decode(&passthrough(), 0);
        assert!(program.is_complete());
        let inputs = std::array::from_fn(|n| {
            std::array::from_fn(|k| f32::from_bits(0x8000_0001 + (n * 4 + k) as u32 * 0x0123_4567))
        });
        let bits = |v: [f32; 4]| v.map(f32::to_bits);
        let outputs = program.run(&mut [[0.0; 4]; CONSTANTS], &inputs);
        assert_eq!(bits(outputs.position), bits(inputs[0]));
        assert_eq!([bits(outputs.diffuse), bits(outputs.specular)], [bits(inputs[3]), bits(inputs[4])]);
        assert_eq!(outputs.fog.to_bits(), inputs[5][0].to_bits());
        assert_eq!(outputs.point_size.to_bits(), inputs[6][0].to_bits());
        assert_eq!(outputs.coordinates.map(bits), [9, 10, 11, 12].map(|n| bits(inputs[n])));
        // The back has no colours of its own.
        assert_eq!(outputs.back_diffuse, [0.0, 0.0, 0.0, 1.0]);
        let text = "MOV oPos.xyzw, v0\nMOV oD0.xyzw, v3\nMOV oD1.xyzw, v4\nMOV oFog.xyzw, v5\nMOV oPts.xyzw, v6\n\
                    MOV oT0.xyzw, v9\nMOV oT1.xyzw, v10\nMOV oT2.xyzw, v11\nMOV oT3.xyzw, v12\n";
        assert_eq!(program.print(), text);
    }
}
