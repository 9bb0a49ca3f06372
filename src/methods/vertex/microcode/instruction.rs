//! What a slot of microcode says, and what its two units write.

use super::{CONSTANTS, POSITION_READ, TEMPORARIES};

macro_rules! opcodes {
    ($(#[$of:meta])* $type:ident: $($(#[$meta:meta])* $name:ident $code:literal $word:literal,)+) => {
        $(#[$of])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub enum $type { #[default] $($(#[$meta])* $name = $code),+ }
        impl $type {
            /// All operations, in the order of their codes.
            pub const ALL: &'static [$type] = &[$($type::$name),+];
            /// Returns the name, as nv2a_vsh_asm writes it.
            pub fn word(self) -> &'static str { match self { $($type::$name => $word),+ } }
        }
    };
}
opcodes! {
    /// An operation of the vector unit (MAC) on the operands a, b and c.
    Mac:
    /// Nothing.
    Nop 0 "NOP",
    /// a.
    Mov 1 "MOV",
    /// a b.
    Mul 2 "MUL",
    /// a + c.
    Add 3 "ADD",
    /// a b + c.
    Mad 4 "MAD",
    /// a . b over x, y, z.
    Dp3 5 "DP3",
    /// a . b over x, y, z, plus b.w.
    Dph 6 "DPH",
    /// a . b over all four.
    Dp4 7 "DP4",
    /// (1, a.y b.y, a.z, b.w).
    Dst 8 "DST",
    /// The smaller of a and b.
    Min 9 "MIN",
    /// The larger of a and b.
    Max 10 "MAX",
    /// 1 where a is below b, else 0.
    Slt 11 "SLT",
    /// 1 where a is not below b, else 0.
    Sge 12 "SGE",
    /// The floor of a.x, into the address register.
    Arl 13 "ARL",
    /// A code without an operation.
    Reserved14 14 "NOP",
    /// A code without an operation.
    Reserved15 15 "NOP",
}
opcodes! {
    /// An operation of the scalar unit (ILU) on the operand c.
    Scalar:
    /// Nothing.
    Nop 0 "NOP",
    /// c.
    Mov 1 "MOV",
    /// 1 / c.x.
    Rcp 2 "RCP",
    /// 1 / c.x, limited to a magnitude of 2^-64 to 2^64.
    Rcc 3 "RCC",
    /// 1 / sqrt |c.x|.
    Rsq 4 "RSQ",
    /// (2^floor(c.x), c.x - floor(c.x), 2^c.x, 1).
    Exp 5 "EXP",
    /// (exponent, mantissa, log2, 1) of |c.x|.
    Log 6 "LOG",
    /// (1, max(c.x, 0), c.y^c.w, 1).
    Lit 7 "LIT",
}

impl Mac {
    /// Returns which of the operands a, b and c the operation reads.
    pub fn operands(self) -> &'static [usize] {
        match self {
            Mac::Nop | Mac::Reserved14 | Mac::Reserved15 => &[],
            Mac::Mov | Mac::Arl => &[0],
            Mac::Add => &[0, 2],
            Mac::Mad => &[0, 1, 2],
            _ => &[0, 1],
        }
    }
}

impl Scalar {
    /// Returns whether the operation uses only the first component of its operand.
    pub fn is_scalar(self) -> bool {
        matches!(self, Scalar::Rcp | Scalar::Rcc | Scalar::Rsq | Scalar::Exp | Scalar::Log)
    }
}

/// Where an operand comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Source {
    /// A code without a source, which reads as zero.
    #[default]
    None = 0,
    /// A temporary register. R12 is the position that was written so far, R13 to R15 read as zero.
    Temporary = 1,
    /// The input register that the slot names.
    Input = 2,
    /// The constant that the slot names.
    Constant = 3,
}

impl Source {
    /// All sources, in the order of their codes.
    pub const ALL: [Source; 4] = [Source::None, Source::Temporary, Source::Input, Source::Constant];
}

/// An operand of a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operand {
    /// Where it comes from.
    pub source: Source,
    /// Number of the temporary register, 0 to 15.
    pub temporary: u8,
    /// The component, 0 to 3, that each of x, y, z, w is taken from.
    pub swizzle: [u8; 4],
    /// Whether the sign is changed.
    pub negate: bool,
}

impl Operand {
    /// Returns an operand without a swizzle.
    pub fn new(source: Source) -> Operand {
        Operand { source, ..Operand::default() }
    }

    /// Returns whether this is the position that was written so far.
    pub fn is_position(&self) -> bool {
        self.source == Source::Temporary && self.temporary == POSITION_READ
    }
}

impl Default for Operand {
    fn default() -> Self {
        Operand { source: Source::None, temporary: 0, swizzle: [0, 1, 2, 3], negate: false }
    }
}

/// One of the two units of a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// The vector unit, MAC.
    Vector,
    /// The scalar unit, ILU.
    Scalar,
}

/// A register that a unit writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Register {
    /// A temporary register, R0 to R11.
    Temporary(u8),
    /// An output register, by the number of its attribute.
    Output(u8),
    /// A constant.
    Constant(u8),
    /// The address register A0.
    Address,
}

/// A register, and which of its components are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Destination {
    /// The register.
    pub register: Register,
    /// The components. Bits 0 to 3 are x to w.
    pub mask: u8,
}

/// The fields of a slot. Bits 0 to 3 of a mask are x to w.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Instruction {
    /// The operation of the vector unit.
    pub mac: Mac,
    /// The operation of the scalar unit.
    pub scalar: Scalar,
    /// The operands a, b and c.
    pub operands: [Operand; 3],
    /// Number of the input register that operands may read.
    pub input: u8,
    /// Number of the constant that operands may read.
    pub constant: u8,
    /// Whether the address register is added to the number of the constant.
    pub is_relative: bool,
    /// Number of the temporary register that is written.
    pub temporary: u8,
    /// Components of the temporary register that the vector unit writes.
    pub vector_mask: u8,
    /// Components of the temporary register that the scalar unit writes.
    pub scalar_mask: u8,
    /// Components of the output register or constant that are written.
    pub output_mask: u8,
    /// Number of the output register or constant.
    pub output_address: u8,
    /// Whether a constant is written in place of an output register.
    pub writes_constant: bool,
    /// Whether the scalar unit writes the output register or constant, in place of the vector unit.
    pub output_is_scalar: bool,
    /// Whether the program ends here.
    pub is_last: bool,
}

impl Instruction {
    /// Returns whether a unit does something.
    pub fn is_active(&self, unit: Unit) -> bool {
        match unit {
            Unit::Vector => !self.mac.operands().is_empty(),
            Unit::Scalar => self.scalar != Scalar::Nop,
        }
    }

    /// Returns which operands a unit reads.
    pub fn operands_of(&self, unit: Unit) -> &'static [usize] {
        match unit {
            Unit::Vector => self.mac.operands(),
            Unit::Scalar if self.scalar == Scalar::Nop => &[],
            Unit::Scalar => &[2],
        }
    }

    /// Returns what a unit writes, the output register before the temporary one. Registers that do not exist are left out.
    pub fn destinations(&self, unit: Unit) -> impl Iterator<Item = Destination> + use<> {
        let active = self.is_active(unit);
        let address = unit == Unit::Vector && self.mac == Mac::Arl;
        let output = Destination { register: self.output_register(), mask: self.output_mask };
        let outputs = self.output_is_scalar == (unit == Unit::Scalar) && self.output_exists();
        let [number, mask] = self.written_temporary(unit);
        let temporary = Destination { register: Register::Temporary(number), mask };
        let found = [
            address.then_some(Destination { register: Register::Address, mask: 1 }),
            (active && !address && outputs && output.mask != 0).then_some(output),
            (active && !address && usize::from(number) < TEMPORARIES && mask != 0).then_some(temporary),
        ];
        found.into_iter().flatten()
    }

    /// Returns the number of the temporary register that a unit writes, and the mask. In company the scalar unit writes R1,
    /// and the vector unit does not.
    fn written_temporary(&self, unit: Unit) -> [u8; 2] {
        let company = self.is_active(Unit::Vector) && self.is_active(Unit::Scalar);
        match unit {
            Unit::Vector if company && self.temporary == 1 => [1, 0],
            Unit::Vector => [self.temporary, self.vector_mask],
            Unit::Scalar => [if company { 1 } else { self.temporary }, self.scalar_mask],
        }
    }

    fn output_register(&self) -> Register {
        if self.writes_constant {
            Register::Constant(self.output_address)
        } else {
            Register::Output(self.output_address & 15)
        }
    }

    fn output_exists(&self) -> bool {
        match self.output_register() {
            Register::Constant(number) => usize::from(number) < CONSTANTS,
            Register::Output(number) => matches!(number, 0 | 3..=12),
            _ => true,
        }
    }
}
