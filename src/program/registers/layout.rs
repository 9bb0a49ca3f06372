//! Where the parts of the words are.

use super::Word;
use ninebit::state::Profile;

/// Bits of a word that belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Number of the lowest bit.
    pub shift: u32,
    /// How many bits there are.
    pub bits: u32,
}

impl Field {
    const fn new(shift: u32, bits: u32) -> Field {
        Field { shift, bits }
    }

    /// The largest number that it holds.
    pub const fn most(self) -> u32 {
        (1 << self.bits) - 1
    }

    /// What a word has there.
    pub const fn of(self, word: u32) -> u32 {
        word >> self.shift & self.most()
    }

    /// Whether a word has more than 0 there.
    pub const fn is_set(self, word: u32) -> bool {
        self.of(word) != 0
    }

    /// A word that has only this.
    pub const fn put(self, value: u32) -> u32 {
        (value & self.most()) << self.shift
    }
}

/// A, B, C and D of an input word; of the second final word E, F, G and its flags.
pub const BYTES: [Field; 4] = [Field::new(24, 8), Field::new(16, 8), Field::new(8, 8), Field::new(0, 8)];
/// The register of such a byte.
pub const REGISTER: Field = Field::new(0, 4);
/// Whether it is the register's alpha.
pub const ALPHA: Field = Field::new(4, 1);
/// The mapping of a general input: its place among [`InputMapping::ALL`](ninebit::state::InputMapping).
pub const MAPPING: Field = Field::new(5, 3);
/// Whether a final input is inverted.
pub const INVERT: Field = Field::new(5, 1);
/// Registers of an output word: of AB, of CD, of the sum or mux.
pub const OUTPUTS: [Field; 3] = [Field::new(4, 4), Field::new(0, 4), Field::new(8, 4)];
/// Whether AB, CD is a dot product.
pub const DOT_PRODUCTS: [Field; 2] = [Field::new(13, 1), Field::new(12, 1)];
/// The mux instead of the sum.
pub const MUX: Field = Field::new(14, 1);
/// Bias and scale: one of [`OPERATIONS`](super::OPERATIONS).
pub const OPERATION: Field = Field::new(15, 3);
/// Blue of AB, of CD to alpha.
pub const BLUE_TO_ALPHA: [Field; 2] = [Field::new(19, 1), Field::new(18, 1)];
/// Flags of the second final word: the colour sum is limited to one.
pub const COLOR_SUM_CLAMP: Field = Field::new(7, 1);
/// Secondary colour is inverted in the colour sum.
pub const INVERT_SECONDARY: Field = Field::new(6, 1);
/// SPARE0 is inverted in the colour sum.
pub const INVERT_SPARE0: Field = Field::new(5, 1);
/// Whether each stage has its own constant 0, 1 (nv20).
pub const OWN_CONSTANTS: [Field; 2] = [Field::new(12, 1), Field::new(16, 1)];

/// The word that has the number of stages and the mux bit.
pub const fn config(chip: Profile) -> (Word, usize) {
    match chip {
        Profile::Nv10 => (Word::RcOutRgb, 1),
        Profile::Nv2a => (Word::RcConfig, 0),
    }
}

/// The number of stages.
pub const fn stages(chip: Profile) -> Field {
    match chip {
        Profile::Nv10 => Field::new(28, 2),
        Profile::Nv2a => Field::new(0, 4),
    }
}

/// Whether muxes go by the most significant bit.
pub const fn mux_by_msb(chip: Profile) -> Field {
    match chip {
        Profile::Nv10 => Field::new(27, 1),
        Profile::Nv2a => Field::new(8, 1),
    }
}
