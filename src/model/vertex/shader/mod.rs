//! Vertex programs of the language vs.1.1 in executable form: the instructions, and how they run on a vertex.
//!
//! `ninebit_program::vertex_shader` parses the text, and [`evaluate()`] runs a program on one vertex. Rules VTX-1 to
//! VTX-4.

mod evaluate;
mod function;

pub use evaluate::{Outputs, evaluate};
pub use function::{exponential, logarithm};

/// Number of constant registers, c0 to c95.
pub const CONSTANTS: usize = 96;
/// Number of input registers, v0 to v15.
pub const INPUTS: usize = 16;
/// Number of temporary registers, r0 to r11.
pub const TEMPORARIES: usize = 12;
/// Most instruction slots that a program may take.
pub const SLOTS: usize = 128;
/// Number of output registers for texture coordinates, oT0 to oT3.
pub const COORDINATES: usize = 4;

/// The values of all constant registers.
pub type Constants = [[f32; 4]; CONSTANTS];
/// The values of all input registers.
pub type Inputs = [[f32; 4]; INPUTS];

macro_rules! opcodes {
    ($($(#[$meta:meta])* $name:ident $word:literal $sources:literal $slots:literal,)+) => {
        /// The operation of an instruction. s, t and u are its sources.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Opcode { $($(#[$meta])* $name),+ }
        impl Opcode {
            /// All opcodes in the order of their declaration.
            pub const ALL: &'static [Opcode] = &[$(Opcode::$name),+];
            /// The words of the language, in lower case and in the order of [`ALL`](Self::ALL).
            pub const WORDS: &'static [&'static str] = &[$($word),+];
            /// Returns the word of the language.
            pub fn word(self) -> &'static str { Self::WORDS[self as usize] }
            /// Returns the number of sources, 1 to 3.
            pub fn sources(self) -> usize { match self { $(Opcode::$name => $sources),+ } }
            /// Returns the number of [`SLOTS`] that an instruction takes.
            pub fn slots(self) -> usize { match self { $(Opcode::$name => $slots),+ } }
        }
    };
}
opcodes! {
    /// s + t.
    Add "add" 2 1,
    /// s . t over x, y, z, in every component.
    Dp3 "dp3" 2 1,
    /// s . t over all four, in every component.
    Dp4 "dp4" 2 1,
    /// (1, s.y t.y, s.z, t.w).
    Dst "dst" 2 1,
    /// 2^s.w in every component.
    Exp "exp" 1 10,
    /// (2^floor(s.w), fraction of s.w, 2^s.w, 1).
    Expp "expp" 1 1,
    /// s - floor(s); writes y, or x and y.
    Frc "frc" 1 3,
    /// (1, max(s.x, 0), s.y^s.w where lit, 1).
    Lit "lit" 1 1,
    /// log2 |s.w| in every component.
    Log "log" 1 10,
    /// (exponent, mantissa, log2 of |s.w|, 1).
    Logp "logp" 1 1,
    /// Two rows of three.
    M3x2 "m3x2" 2 2,
    /// Three rows of three.
    M3x3 "m3x3" 2 3,
    /// Four rows of three.
    M3x4 "m3x4" 2 4,
    /// Three rows of four.
    M4x3 "m4x3" 2 3,
    /// Four rows of four.
    M4x4 "m4x4" 2 4,
    /// s t + u.
    Mad "mad" 3 1,
    /// The larger of s and t.
    Max "max" 2 1,
    /// The smaller of s and t.
    Min "min" 2 1,
    /// s.
    Mov "mov" 1 1,
    /// s t.
    Mul "mul" 2 1,
    /// 1 / s.w in every component.
    Rcp "rcp" 1 1,
    /// 1 / sqrt |s.w| in every component.
    Rsq "rsq" 1 1,
    /// 1 where s >= t, else 0.
    Sge "sge" 2 1,
    /// 1 where s < t, else 0.
    Slt "slt" 2 1,
    /// s - t.
    Sub "sub" 2 1,
}

impl Opcode {
    /// Returns the rows and columns of a matrix macro, or `None` for other instructions.
    pub fn matrix(self) -> Option<(usize, usize)> {
        match self {
            Opcode::M3x2 => Some((2, 3)),
            Opcode::M3x3 => Some((3, 3)),
            Opcode::M3x4 => Some((4, 3)),
            Opcode::M4x3 => Some((3, 4)),
            Opcode::M4x4 => Some((4, 4)),
            _ => None,
        }
    }

    /// Returns whether the instruction uses only the last component of its swizzled source.
    pub fn is_scalar(self) -> bool {
        matches!(self, Opcode::Rcp | Opcode::Rsq | Opcode::Exp | Opcode::Expp | Opcode::Log | Opcode::Logp)
    }

    /// Returns the components of source `source`, after its swizzle, on which the components `written` of the result
    /// depend. Bits 0 to 3 are x to w.
    pub fn reads(self, source: usize, written: u8) -> u8 {
        const W: u8 = 8;
        if written == 0 {
            return 0;
        }
        match self {
            Opcode::Dp3 | Opcode::M3x2 | Opcode::M3x3 | Opcode::M3x4 => 0b0111,
            Opcode::Dp4 | Opcode::M4x3 | Opcode::M4x4 => 0b1111,
            Opcode::Dst if source == 0 => written & 0b0110,
            Opcode::Dst => written & 0b1010,
            Opcode::Expp | Opcode::Logp if written == W => 0,
            _ if self.is_scalar() => W,
            Opcode::Lit => (written >> 1 & 1) | if written & 4 != 0 { 0b1011 } else { 0 },
            _ => written,
        }
    }
}

/// A register that an instruction reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SourceRegister {
    /// An input register, v0 to v15.
    Input(usize),
    /// A temporary register, r0 to r11.
    Temporary(usize),
    /// A constant register, c0 to c95.
    Constant {
        /// Number of the register, or the offset that is added to a0.x.
        index: usize,
        /// Whether the register is `c[a0.x + index]`. Outside c0 to c95 that reads as zero.
        relative: bool,
    },
}

/// A source operand of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Source {
    /// The register, or for the second source of a matrix macro the first row.
    pub register: SourceRegister,
    /// The component (0 to 3) that each of x, y, z, w is taken from.
    pub swizzle: [usize; 4],
    /// Whether the sign is changed.
    pub negate: bool,
}

impl Source {
    /// Returns the components of the register that the swizzled components `components` are taken from, as bits.
    pub fn components(&self, components: u8) -> u8 {
        (0..4).filter(|k| components >> k & 1 != 0).fold(0, |mask, k| mask | 1 << self.swizzle[k])
    }
}

/// A register that an instruction writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DestinationRegister {
    /// A temporary register, r0 to r11.
    Temporary(usize),
    /// The address register a0, of which only x exists.
    Address,
    /// oPos, the position in clip space.
    Position,
    /// oFog, the fog factor in x.
    Fog,
    /// oPts, the point size in x.
    PointSize,
    /// oD0 and oD1, the primary and the secondary colour.
    Color(usize),
    /// Texture coordinates, oT0 to oT3.
    Coordinates(usize),
}

/// The destination of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Destination {
    /// The register that is written.
    pub register: DestinationRegister,
    /// Mask of the components that are written. Bits 0 to 3 are x to w.
    pub mask: u8,
}

/// An instruction of a program.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Instruction {
    /// The operation of the instruction.
    pub opcode: Opcode,
    /// The register and the components that are written.
    pub destination: Destination,
    /// The sources, as many as the opcode takes.
    pub sources: Vec<Source>,
}

/// A vertex program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexShader {
    /// Constants that the program defines: number and value of each.
    pub definitions: Vec<(usize, [f32; 4])>,
    /// The instructions, in the order in which they run.
    pub instructions: Vec<Instruction>,
}

impl VertexShader {
    /// Returns the number of instruction slots, counting macros as they expand.
    pub fn slots(&self) -> usize {
        self.instructions.iter().map(|instruction| instruction.opcode.slots()).sum()
    }

    /// Returns the components of an output register that the program writes, as a mask.
    pub fn written(&self, register: DestinationRegister) -> u8 {
        let to = self.instructions.iter().filter(|instruction| instruction.destination.register == register);
        to.fold(0, |mask, instruction| mask | instruction.destination.mask)
    }

    /// Returns which input registers the program reads.
    pub fn inputs(&self) -> [bool; INPUTS] {
        let mut read = [false; INPUTS];
        for source in self.instructions.iter().flat_map(|instruction| &instruction.sources) {
            if let SourceRegister::Input(index) = source.register {
                read[index] = true;
            }
        }
        read
    }
}
