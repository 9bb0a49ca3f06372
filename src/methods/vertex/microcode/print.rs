//! Prints programs as nv2a_vsh_asm writes them.

use std::fmt::Write;

use super::Program;
use super::instruction::{Destination, Instruction, Operand, Register, Source, Unit};

impl Program {
    /// Prints the program. A slot is one operation for each register that it writes; those after the first begin with `+`.
    pub fn print(&self) -> String {
        let mut out = String::new();
        for instruction in &self.instructions {
            out.push_str(&instruction.print());
            out.push('\n');
        }
        if !self.is_complete() {
            out.push_str("// The program has no end.\n");
        }
        out
    }
}

impl Instruction {
    /// Prints the slot, which may take several lines.
    pub fn print(&self) -> String {
        let mut lines = Vec::new();
        for unit in [Unit::Vector, Unit::Scalar] {
            let word = if unit == Unit::Vector { self.mac.word() } else { self.scalar.word() };
            for destination in self.destinations(unit) {
                let mut line = format!("{word} {}", written(destination));
                for operand in self.operands_of(unit) {
                    // Writing to a string cannot fail.
                    let _ = write!(line, ", {}", self.operand(&self.operands[*operand]));
                }
                lines.push(line);
            }
        }
        if lines.is_empty() { "NOP".to_owned() } else { lines.join("\n+ ") }
    }

    fn operand(&self, operand: &Operand) -> String {
        let name = match operand.source {
            Source::None => "0".to_owned(),
            Source::Temporary => format!("R{}", operand.temporary),
            Source::Input => format!("v{}", self.input),
            Source::Constant if self.is_relative => format!("c[A0+{}]", self.constant),
            Source::Constant => format!("c[{}]", self.constant),
        };
        let sign = if operand.negate { "-" } else { "" };
        format!("{sign}{name}{}", swizzle(operand.swizzle))
    }
}

/// Returns the letters of a swizzle. The last one is repeated when it is read.
fn swizzle(components: [u8; 4]) -> String {
    if components == [0, 1, 2, 3] {
        return String::new();
    }
    let last = components[3];
    let kept = components.iter().rposition(|component| *component != last).map_or(1, |at| at + 2);
    format!(".{}", letters(components.into_iter().take(kept)))
}

fn letters(components: impl IntoIterator<Item = u8>) -> String {
    components.into_iter().filter_map(|component| "xyzw".chars().nth(component.into())).collect()
}

fn written(destination: Destination) -> String {
    let name = match destination.register {
        Register::Address => return "A0".to_owned(),
        Register::Temporary(number) => format!("R{number}"),
        Register::Constant(number) => format!("c[{number}]"),
        Register::Output(number @ 9..) => format!("oT{}", number - 9),
        Register::Output(number) => {
            const NAMES: [&str; 9] = ["oPos", "o1", "o2", "oD0", "oD1", "oFog", "oPts", "oB0", "oB1"];
            NAMES[usize::from(number)].to_owned()
        }
    };
    format!("{name}.{}", letters((0..4).filter(|component| destination.mask >> component & 1 == 1)))
}

#[cfg(test)]
mod tests {
    use super::super::{Slot, decode};

    /// Slots of programs that consoles ran, and what they say.
    #[test]
    fn slots_of_real_programs() {
        let expected: [(Slot, &str); 20] = [
            // The first five slots of a racing game's program.
            ([0, 0x00ec_001b, 0x0836_186c, 0x2070_8800], "DP4 oPos.x, v0, c[96]"),
            ([0, 0x00ec_201b, 0x0836_186c, 0x2070_4800], "DP4 oPos.y, v0, c[97]"),
            ([0, 0x00ec_401b, 0x0836_186c, 0x2070_2800], "DP4 oPos.z, v0, c[98]"),
            ([0, 0x00ec_601b, 0x0836_186c, 0x2070_1800], "DP4 oPos.w, v0, c[99]"),
            ([0, 0x0074_641b, 0x0836_106c, 0x3070_f848], "ADD oT0.xyzw, v2, c[163]"),
            // The first four of Direct3D's program for vertices in the window.
            ([0, 0x0020_001b, 0x0836_106c, 0x2f10_0ff8], "MOV R1.xyzw, v0"),
            ([0, 0x0420_061b, 0x0836_13fc, 0x5011_f818], "MOV oD0.xyzw, v3\n+ RCP R1.w, R1.w"),
            ([0, 0x0400_001b, 0x0836_13fc, 0x2070_f82c], "RCP oFog.xyzw, v0.w"),
            ([0, 0x0240_081b, 0x1436_186c, 0x2f20_f824], "MUL R2.xyzw, R1, c[0]\n+ MOV oD1.xyzw, v4"),
            // One of each kind of field.
            ([0, 0x0062_201b, 0x0c36_146e, 0x9e60_0ff8], "ADD R6.xyz, c[17], -R10"),
            ([0, 0x0080_0163, 0x150e_e86e, 0x9db0_0ff8], "MAD R11.xyw, -R1.yzxw, R7.zxyw, R10"),
            ([0, 0x00a2_e01b, 0x0636_186c, 0x2270_0ff8], "DP3 R7.z, R0, -c[23]"),
            ([0, 0x0047_8c00, 0x0836_186c, 0x2f30_0ffa], "MUL R3.xyzw, v6.x, c[A0+60]"),
            ([0, 0x00c1_481b, 0x0836_186c, 0x2070_c078], "DPH c[15].xy, v4, c[10]"),
            ([0, 0x01a0_0000, 0x0436_106c, 0x2070_0ff8], "ARL A0, R0.x"),
            ([0, 0x0047_401a, 0xc434_186c, 0x2070_e800], "MUL oPos.xyz, R12.xyz, c[58].xyz"),
            // Both registers of one unit.
            ([0, 0x00ec_401b, 0x6436_186c, 0x2800_2800], "DP4 oPos.z, R6, c[98]\n+ DP4 R0.x, R6, c[98]"),
            // The scalar unit in company writes R1, whatever register is named.
            ([0, 0x08ec_001b, 0x6436_1800, 0x90a8_8800], "DP4 oPos.x, R6, c[96]\n+ RSQ R1.x, R2.x"),
            // The vector unit in company does not.
            ([0, 0x0820_001b, 0x0836_1000, 0x5f18_0ff8], "RSQ R1.x, R1.x"),
            ([0, 0, 0, 1], "NOP"),
        ];
        for (slot, text) in expected {
            assert_eq!(decode(&slot).print(), text, "{slot:08x?}");
        }
    }
}
