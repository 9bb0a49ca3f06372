//! The layout of the words: where their fields are.

use super::Word;
use ninebit::state::Profile;

/// A field: consecutive bits of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Number of the lowest bit.
    pub shift: u32,
    /// Number of bits.
    pub bits: u32,
}

impl Field {
    pub(super) const fn new(shift: u32, bits: u32) -> Field {
        Field { shift, bits }
    }

    /// Returns the largest value of the field.
    pub const fn most(self) -> u32 {
        (1 << self.bits) - 1
    }

    /// Returns the value of the field in a word.
    pub const fn value_in(self, word: u32) -> u32 {
        word >> self.shift & self.most()
    }

    /// Returns whether the field is not 0 in a word.
    pub const fn is_set(self, word: u32) -> bool {
        self.value_in(word) != 0
    }

    /// Returns a word with the given value in the field and 0 elsewhere.
    pub const fn put(self, value: u32) -> u32 {
        (value & self.most()) << self.shift
    }
}

/// Bytes A, B, C and D of an input word. In the second final word they are E, F, G and the flags.
pub const BYTES: [Field; 4] = [Field::new(24, 8), Field::new(16, 8), Field::new(8, 8), Field::new(0, 8)];
/// Register code of an input byte.
pub const REGISTER: Field = Field::new(0, 4);
/// Flag of an input byte: whether it reads the register's alpha.
pub const ALPHA: Field = Field::new(4, 1);
/// Mapping of a general input byte: index in [`InputMapping::ALL`](ninebit::state::InputMapping).
pub const MAPPING: Field = Field::new(5, 3);
/// Flag of a final input byte: whether the input is inverted.
pub const INVERT: Field = Field::new(5, 1);
/// Register codes of an output word: of AB, of CD, and of the sum or mux.
pub const OUTPUTS: [Field; 3] = [Field::new(4, 4), Field::new(0, 4), Field::new(8, 4)];
/// Flags of an output word: whether AB, and whether CD, is a dot product.
pub const DOT_PRODUCTS: [Field; 2] = [Field::new(13, 1), Field::new(12, 1)];
/// Flag of an output word: whether the mux replaces the sum.
pub const MUX: Field = Field::new(14, 1);
/// Code of bias and scale in an output word: one of [`OPERATIONS`](super::OPERATIONS).
pub const OPERATION: Field = Field::new(15, 3);
/// Flags of an output word: whether the blue of AB, and of CD, is also written to alpha.
pub const BLUE_TO_ALPHA: [Field; 2] = [Field::new(19, 1), Field::new(18, 1)];
/// Flag of the second final word: whether the colour sum is clamped to 1.
pub const COLOR_SUM_CLAMP: Field = Field::new(7, 1);
/// Flag of the second final word: whether the secondary colour is inverted in the colour sum.
pub const INVERT_SECONDARY: Field = Field::new(6, 1);
/// Flag of the second final word: whether SPARE0 is inverted in the colour sum.
pub const INVERT_SPARE0: Field = Field::new(5, 1);
/// Flags of the configuration word: whether each stage has its own constant 0, and constant 1 (NV20).
pub const OWN_CONSTANTS: [Field; 2] = [Field::new(12, 1), Field::new(16, 1)];

/// Returns the word with the number of stages and the mux bit, and its index.
pub const fn config(chip: Profile) -> (Word, usize) {
    match chip {
        Profile::Nv10 => (Word::RcOutRgb, 1),
        Profile::Nv2a => (Word::RcConfig, 0),
    }
}

/// Returns the field of the configuration word with the number of stages.
pub const fn stages(chip: Profile) -> Field {
    match chip {
        Profile::Nv10 => Field::new(28, 2),
        Profile::Nv2a => Field::new(0, 4),
    }
}

/// Returns the flag of the configuration word that muxes select by the most significant bit.
pub const fn mux_by_msb(chip: Profile) -> Field {
    match chip {
        Profile::Nv10 => Field::new(27, 1),
        Profile::Nv2a => Field::new(8, 1),
    }
}
