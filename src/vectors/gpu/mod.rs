//! GPU batches: rows of tables as draws for a real card or a driver.
//!
//! A card cannot evaluate a row directly: its operands become texels of nearest-filtered textures, constants and vertex colours, and its result is a
//! byte of an RGBA frame buffer. A [`Placement`] describes that for one row. Rows that share their state form one batch of up to 65,536 pixels. The
//! program under `vectors/harness/gl` draws batches and writes what it reads back.
//!
//! [`recipes`] returns the recipes of a unit: `stages.rs` has those for register combiners, `environment.rs` those for whole texture environments,
//! `buffers.rs` those for stencil, fog, depths and volumes, and `fixed.rs` the others that need no combiners.

mod buffers;
mod combiners;
mod environment;
mod fixed;
pub mod scene;
mod stages;
pub mod write;

use ninebit::state::{Combiners, FinalRegister, Named, Profile, Scale, named};

use super::column::Column;
use super::table::Row;

/// Everything that is needed to draw a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// The part of OpenGL that it uses.
    pub path: Path,
    /// Required extensions. Each entry is one name, or several with `|` between them of which any will do.
    pub needs: Vec<&'static str>,
    /// State lines that all draws share (`vectors/harness/gl/README.md`).
    pub state: Vec<String>,
    /// The draws. Their pixels together yield the results.
    pub draws: Vec<Draw>,
    /// The row's own bytes, by the name of their source.
    pub sources: Vec<(&'static str, Vec<u8>)>,
}

impl Placement {
    /// Returns whether OpenGL refuses it: as A, NVIDIA's driver takes no sum of SPARE0 and the secondary colour (`GL_INVALID_OPERATION`).
    fn is_refused(&self) -> bool {
        let mut combiners = self.draws.iter().filter_map(|draw| draw.combiners.as_ref());
        combiners.any(|all| all.final_combiner.inputs[0].register == FinalRegister::Spare0PlusSecondary)
    }
}

/// One draw of a batch and its state.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// State lines of this draw only.
    pub state: Vec<String>,
    /// The contributions of its pixels to the results.
    pub reads: Vec<Contribution>,
    /// The combiners that the state sets; `None` on paths without combiners.
    pub combiners: Option<Combiners>,
}

/// Adds a byte of the pixel, times a weight, to a column that starts at 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contribution {
    /// Name of the unit's column; `out.u>>8` is that column without its eight lowest bits.
    pub column: String,
    /// Channel: 0 to 3 for R, G, B, A, and 4 for the stencil.
    pub channel: usize,
    /// Factor of the byte.
    pub weight: i64,
}

impl Contribution {
    /// Returns a read of a byte with weight 1.
    fn byte(column: &str, channel: usize) -> Contribution {
        Contribution { column: column.to_owned(), channel, weight: 1 }
    }
}

named! {
    /// The part of OpenGL that a batch uses.
    #[derive(PartialOrd, Ord)]
    pub enum Path =>
    /// Returns the word in a batch file.
    word: &'static str {
        /// General stages and a final combiner: `NV_register_combiners`.
        Combiners => "combiners",
        /// The texture environment, for cards without combiners.
        Environment => "environment",
        /// Functions that every card has: texels, coordinates, colours, blending.
        Common => "common",
    }
}

/// A row whose numbers are looked up by column name.
#[derive(Clone, Copy, Debug)]
pub struct Case<'r> {
    /// Configuration and inputs.
    pub inputs: &'r [Column],
    /// Intermediates and results.
    pub results: &'r [Column],
    /// The row to be drawn.
    pub row: &'r Row,
    /// The chip whose rules it follows.
    pub profile: Profile,
}

impl Case<'_> {
    /// Returns the number in a column. It is 0 for an unknown name, which the tests of this module rule out.
    fn number(&self, name: &str) -> i64 {
        let numbers = self.row.inputs.iter().chain(&self.row.results);
        self.inputs.iter().chain(self.results).zip(numbers).find(|(c, _)| c.name == name).map_or(0, |(_, n)| *n)
    }

    /// Returns the numbers in several columns.
    fn numbers<const N: usize>(&self, names: [&str; N]) -> [i64; N] {
        names.map(|name| self.number(name))
    }

    /// Returns the variant in a column of names.
    fn choice<T: Named>(&self, name: &str) -> T {
        super::units::named(self.number(name))
    }

    /// Returns OpenGL's word for a choice. `words` are in the order of the column's names.
    fn word(&self, name: &str, words: &'static str) -> &'static str {
        words.split(' ').nth(self.number(name) as usize).unwrap_or_default()
    }

    /// Returns the factor of a scale, or `None` for one half, which OpenGL does not have.
    fn scale(&self) -> Option<u8> {
        match self.choice("cfg.scale") {
            Scale::One => Some(1),
            Scale::Two => Some(2),
            Scale::Four => Some(4),
            Scale::Half => None,
        }
    }
}

/// Converts a row to a placement, or returns `None` if the row cannot be drawn.
pub type Recipe = fn(&Case) -> Option<Placement>;

/// Returns the recipes of a unit; none if no frame buffer can show its results.
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
        "filtered-shadow" => &[buffers::filtered_shadow],
        "volume-layer" => &[buffers::volume_layer],
        "blend" => &[fixed::blend],
        _ => &[],
    }
}

/// Converts a number to a byte, or returns `None` if it is out of range.
fn byte(value: i64) -> Option<u8> {
    u8::try_from(value).ok()
}

#[cfg(test)]
mod tests;
