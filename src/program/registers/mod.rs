//! Combiners as words of the chips' registers: NV10 (Celsius) and NV20 (Kelvin, to which the NV2A belongs).
//!
//! `docs/languages/registers.md` has layouts and codes. A word is checked as the chip checks it when it is written: [`refusal`]. Whether a
//! program is legal is decided afterwards ([`legality`](ninebit::legality)).

mod code;
mod describe;
pub mod layout;
mod program;
pub mod raster;
mod text;
pub mod unit;

use ninebit::state::{Named, Profile, named};

pub use code::{OPERATIONS, component, refusal, register_code, stored};
pub use describe::{Description, describe};
pub(crate) use program::word_of;
pub use program::{color_of, color_word, decode, encode};
pub use text::{WordText, read};

named! {
    /// A register of the combiners, or an array of registers.
    pub enum Word =>
    /// Returns, for NV10 and NV20, the number of registers on the chip (0 if it has none), and the method of the chip's 3D class that sets the
    /// first. The methods of the others follow in steps of four bytes.
    layout: [(usize, u32); 2] {
        /// Inputs of the alpha portions.
        RcInAlpha = "rc_in_alpha" => [(2, 0x260), (8, 0x260)],
        /// Inputs of the RGB portions.
        RcInRgb = "rc_in_rgb" => [(2, 0x268), (8, 0xac0)],
        /// Constant colours 0 and 1: of the whole program (nv10), of the final combiner (nv20).
        RcColor = "rc_color" => [(2, 0x270), (2, 0x1e20)],
        /// Constant colour 0 of each stage (nv20).
        RcConstantColor0 = "rc_constant_color0" => [(0, 0xa60), (8, 0xa60)],
        /// Constant colour 1 of each stage (nv20).
        RcConstantColor1 = "rc_constant_color1" => [(0, 0xa80), (8, 0xa80)],
        /// Outputs of the alpha portions.
        RcOutAlpha = "rc_out_alpha" => [(2, 0x278), (8, 0xaa0)],
        /// Outputs of the RGB portions; on nv10 the second also has the number of stages and the mux bit.
        RcOutRgb = "rc_out_rgb" => [(2, 0x280), (8, 0x1e40)],
        /// Inputs A to D of the final combiner.
        RcFinal0 = "rc_final0" => [(1, 0x288), (1, 0x288)],
        /// Inputs E to G of the final combiner, and its flags.
        RcFinal1 = "rc_final1" => [(1, 0x28c), (1, 0x28c)],
        /// Number of stages, mux bit, and whether stages have own constants (nv20).
        RcConfig = "rc_config" => [(0, 0x1e60), (1, 0x1e60)],
    }
}

impl Word {
    /// Returns the number of registers on a chip; 0 if it has none.
    pub fn count(self, chip: Profile) -> usize {
        self.layout()[chip as usize].0
    }

    /// Returns the method of the chip's 3D class that sets the first register. The methods of the others follow in steps of four bytes.
    pub fn method(self, chip: Profile) -> u32 {
        self.layout()[chip as usize].1
    }

    /// Returns the word and the index that a method sets; `None` if it sets no register of the combiners.
    pub fn of_method(method: u32, chip: Profile) -> Option<(Word, usize)> {
        Word::ALL.iter().find_map(|word| {
            let at = method.checked_sub(word.method(chip))?;
            (at % 4 == 0 && ((at / 4) as usize) < word.count(chip)).then_some((*word, at as usize / 4))
        })
    }

    /// Returns the word's name in text: `RC_IN_RGB[1]`, or `RC_FINAL0` if there is only one.
    pub(crate) fn label(self, chip: Profile, index: usize) -> String {
        let name = self.name().to_uppercase();
        if self.count(chip) > 1 { format!("{name}[{index}]") } else { name }
    }
}

/// The values of all words of a chip's combiners. Words that have not been set are 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegisterWords {
    /// The chip whose layout is used.
    pub chip: Profile,
    values: [[u32; 8]; Word::ALL.len()],
}

impl RegisterWords {
    /// Makes words that are all 0.
    pub fn new(chip: Profile) -> Self {
        RegisterWords { chip, values: [[0; 8]; Word::ALL.len()] }
    }

    /// Returns a word; 0 if the chip does not have it.
    pub fn get(&self, word: Word, index: usize) -> u32 {
        self.values[word as usize].get(index).copied().unwrap_or(0)
    }

    /// Sets a word, if the chip has it.
    pub fn set(&mut self, word: Word, index: usize, value: u32) {
        if index < word.count(self.chip) {
            self.values[word as usize][index] = value;
        }
    }

    /// Returns the words that the chip has, with their indices and values.
    pub fn all(&self) -> impl Iterator<Item = (Word, usize, u32)> + '_ {
        Word::ALL.iter().flat_map(|word| (0..word.count(self.chip)).map(|n| (*word, n, self.get(*word, n))))
    }
}

/// The reason that a chip refuses a word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The kind of word.
    pub word: Word,
    /// Index of the word among those of its kind.
    pub index: usize,
    /// The code, which `docs/errors.md` lists.
    pub code: &'static str,
    /// Message in one line.
    pub message: String,
    /// What to do about it.
    pub help: String,
}
