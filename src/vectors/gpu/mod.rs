//! GPU batches: rows of tables as draws that a real card, or a driver, can be asked with.
//!
//! A row is not fed to a card by itself: operands become texels of nearest-filtered textures, constants and vertex colours, and what comes out is a byte of
//! an RGBA frame buffer. [`Placement`] says all that for one row; rows that share their state are one batch of up to 65,536 pixels. The
//! program under `vectors/harness/gl` draws batches and writes what it read back.
//!
//! [`recipes`] names what there is for a unit: `stages.rs` asks the register combiners, `environment.rs` whole texture environments, `fixed.rs` what
//! else OpenGL has without them, `buffers.rs` stencil, fog, depths and volumes.

mod buffers;
pub mod combiners;
mod environment;
mod fixed;
mod stages;
pub mod write;

use ninebit::state::{Combiners, Named, Profile, Scale, named};

use super::column::Column;
use super::table::Row;

/// What a row is drawn with.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// Which part of OpenGL it asks.
    pub path: Path,
    /// Extensions; each is one name or several with `|` between, of which any will do.
    pub needs: Vec<&'static str>,
    /// State that all draws share, a line each (`vectors/harness/gl/README.md`).
    pub state: Vec<String>,
    /// Draws, whose bytes make the results together.
    pub draws: Vec<Draw>,
    /// What this row brings, by the name of the source.
    pub sources: Vec<(&'static str, Vec<u8>)>,
}

/// One draw of a batch, with what is set before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// State of its own.
    pub state: Vec<String>,
    /// What its pixels add to the results.
    pub reads: Vec<Read>,
    /// The combiners that the state sets; none on the fixed path.
    pub combiners: Option<Combiners>,
}

/// A byte of the pixel times a weight is added to a column, which starts at 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Read {
    /// The column of the unit; `out.u>>8` is that column without its eight lowest bits.
    pub column: String,
    /// R, G, B, A: 0 to 3; 4 is the stencil.
    pub channel: usize,
    /// The factor by which the byte is multiplied.
    pub weight: i64,
}

impl Read {
    /// A byte as it is.
    fn byte(column: &str, channel: usize) -> Read {
        Read { column: column.to_owned(), channel, weight: 1 }
    }
}

named! {
    /// Which part of OpenGL a batch asks.
    #[derive(PartialOrd, Ord)]
    pub enum Path =>
    /// The word in a batch.
    word: &'static str {
        /// General stages and a final combiner: `NV_register_combiners`.
        Combiners => "combiners",
        /// The texture environment, asked where there are no combiners.
        Environment => "environment",
        /// What every path has: texels, coordinates, colours, blending.
        Common => "common",
    }
}

/// A row by the names of its columns.
#[derive(Clone, Copy, Debug)]
pub struct Case<'r> {
    /// Configuration and inputs.
    pub inputs: &'r [Column],
    /// Intermediates and results.
    pub results: &'r [Column],
    /// The row that is to be drawn.
    pub row: &'r Row,
    /// The chip whose rules it follows.
    pub profile: Profile,
}

impl Case<'_> {
    /// The number in a column; 0 if there is none of that name, which the tests of this module rule out.
    fn number(&self, name: &str) -> i64 {
        let numbers = self.row.inputs.iter().chain(&self.row.results);
        self.inputs.iter().chain(self.results).zip(numbers).find(|(c, _)| c.name == name).map_or(0, |(_, n)| *n)
    }

    /// The numbers in several columns.
    fn numbers<const N: usize>(&self, names: [&str; N]) -> [i64; N] {
        names.map(|name| self.number(name))
    }

    /// The variant in a column of names.
    fn choice<T: Named>(&self, name: &str) -> T {
        super::units::named(self.number(name))
    }

    /// OpenGL's word for a choice; `words` are in the order of the names that it is among.
    fn word(&self, name: &str, words: &'static str) -> &'static str {
        words.split(' ').nth(self.number(name) as usize).unwrap_or_default()
    }

    /// What a scale multiplies by; OpenGL has no half.
    fn scale(&self) -> Option<u8> {
        match self.choice("cfg.scale") {
            Scale::One => Some(1),
            Scale::Two => Some(2),
            Scale::Four => Some(4),
            Scale::Half => None,
        }
    }
}

/// Places a row, or says that it cannot be asked.
pub type Recipe = fn(&Case) -> Option<Placement>;

/// The recipes of a unit, empty if no frame buffer shows it.
pub fn recipes(unit: &str) -> &'static [Recipe] {
    match unit {
        "vertex-color" => &[fixed::vertex_color],
        "constant-color" => &[fixed::constant_color],
        "nearest-address" => &[fixed::nearest_address],
        "linear-step" => &[fixed::linear_step],
        "bilinear" => &[fixed::bilinear],
        "cube-face" => &[fixed::cube_face],
        "texel-expansion" => &[fixed::texel_expansion],
        "compressed-block" => &[fixed::compressed_block],
        "input-mapping" => &[stages::input_mapping],
        "product" => &[stages::product, fixed::product],
        "sum" => &[stages::sum],
        "dot-product" => &[stages::dot_product, fixed::dot_product],
        "mux" => &[stages::mux],
        "scale-bias" => &[stages::scale_bias, fixed::scale_bias],
        "general-stage" => &[stages::general_stage],
        "alpha-portion" => &[stages::alpha_portion],
        "two-stages" => &[stages::two_stages],
        "final-combiner" => &[stages::final_combiner],
        "texture-environment" => &[environment::texture_environment],
        "texture-combine" => &[environment::texture_combine],
        "alpha-test" => &[fixed::alpha_test],
        "stencil-test" => &[buffers::stencil_test],
        "fog-table" => &[buffers::fog_table],
        "shadow-comparison" => &[buffers::shadow_comparison],
        "volume-layer" => &[buffers::volume_layer],
        "blend" => &[fixed::blend],
        _ => &[],
    }
}

/// A byte, if the number is one.
fn byte(value: i64) -> Option<u8> {
    u8::try_from(value).ok()
}

#[cfg(test)]
mod tests;
