//! Vertex programs of the language vs.1.1, ready to run: what an instruction is, and what it does to a vertex.
//!
//! The text is read in `ninebit_program::vertex_shader`. [`evaluate()`] runs a program on one vertex. Rules VTX-1 to VTX-4.

mod evaluate;
mod function;

pub use evaluate::{Outputs, evaluate};
pub use function::{exponential, logarithm, power};

/// Constant registers c0 to c95.
pub const CONSTANTS: usize = 96;
/// Input registers v0 to v15.
pub const INPUTS: usize = 16;
/// Temporary registers r0 to r11.
pub const TEMPORARIES: usize = 12;
/// Most instruction slots that a program may take.
pub const SLOTS: usize = 128;
/// Output registers of texture coordinates, oT0 to oT3.
pub const COORDINATES: usize = 4;

/// Values of all constant registers.
pub type Constants = [[f32; 4]; CONSTANTS];
/// Values of all input registers.
pub type Inputs = [[f32; 4]; INPUTS];

macro_rules! opcodes {
    ($($(#[$meta:meta])* $name:ident $word:literal $sources:literal $slots:literal,)+) => {
        /// What an instruction computes; s, t and u are its sources.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Opcode { $($(#[$meta])* $name),+ }
        impl Opcode {
            /// All of them.
            pub const ALL: &'static [Opcode] = &[$(Opcode::$name),+];
            /// The word of the language, in lower case.
            pub fn word(self) -> &'static str { match self { $(Opcode::$name => $word),+ } }
            /// How many sources it takes, 1 to 3.
            pub fn sources(self) -> usize { match self { $(Opcode::$name => $sources),+ } }
            /// How many of the [`SLOTS`] it takes.
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
    /// Rows and columns of a matrix macro; `None` of other instructions.
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

    /// Takes only the last component of its (swizzled) source.
    pub fn is_scalar(self) -> bool {
        matches!(self, Opcode::Rcp | Opcode::Rsq | Opcode::Exp | Opcode::Expp | Opcode::Log | Opcode::Logp)
    }

    /// Which components of source `source`, after its swizzle, the components `written` of the result depend on. Bits 0 to 3 are x
    /// to w.
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

/// A register that instructions read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SourceRegister {
    /// v0 to v15.
    Input(usize),
    /// r0 to r11.
    Temporary(usize),
    /// c0 to c95.
    Constant {
        /// Its number, or what is added to a0.x.
        index: usize,
        /// `c[a0.x + index]`: outside c0 to c95 it reads as zero.
        relative: bool,
    },
}

/// A source of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Source {
    /// The register; of a matrix macro's second source the first of the rows.
    pub register: SourceRegister,
    /// Which component (0 to 3) each of x, y, z, w is taken from.
    pub swizzle: [usize; 4],
    /// The sign is changed.
    pub negate: bool,
}

impl Source {
    /// Bits of the register's components that the swizzled components `components` come from.
    pub fn components(&self, components: u8) -> u8 {
        (0..4).filter(|k| components >> k & 1 != 0).fold(0, |mask, k| mask | 1 << self.swizzle[k])
    }
}

/// A register that instructions write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DestinationRegister {
    /// r0 to r11.
    Temporary(usize),
    /// a0, of which only x exists.
    Address,
    /// oPos: position in clip space.
    Position,
    /// oFog: fog factor, in x.
    Fog,
    /// oPts: size of points, in x.
    PointSize,
    /// oD0, oD1: primary and secondary colour.
    Color(usize),
    /// oT0 to oT3.
    Coordinates(usize),
}

/// What an instruction writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Destination {
    /// The register that is written.
    pub register: DestinationRegister,
    /// Which components are written: bits 0 to 3 for x to w.
    pub mask: u8,
}

/// An operation with its destination and sources.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Instruction {
    /// What it computes.
    pub opcode: Opcode,
    /// The register and the components that are written.
    pub destination: Destination,
    /// From what: as many as the opcode takes.
    pub sources: Vec<Source>,
}

/// A vertex program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexShader {
    /// Constants that the program brings: number and value.
    pub definitions: Vec<(usize, [f32; 4])>,
    /// The instructions, in the order in which they run.
    pub instructions: Vec<Instruction>,
}

impl VertexShader {
    /// Instruction slots, macros at what they expand to.
    pub fn slots(&self) -> usize {
        self.instructions.iter().map(|instruction| instruction.opcode.slots()).sum()
    }

    /// Components of an output register that the program writes.
    pub fn written(&self, register: DestinationRegister) -> u8 {
        let to = self.instructions.iter().filter(|instruction| instruction.destination.register == register);
        to.fold(0, |mask, instruction| mask | instruction.destination.mask)
    }

    /// Input registers that it reads.
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
