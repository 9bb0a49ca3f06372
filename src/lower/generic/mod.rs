//! Generic text: one C file or shader for all programs, which reads the words of the registers while it runs.
//!
//! Its rules are printed like those of a single draw, by reading the order of a pixel: [`pieces`] has a function for each step, with a case for
//! each value of the field that selects. [`text`] is written by hand and passes values from one function to the next: where a field is, which
//! register it selects, and which function is called.

mod modules;
mod pieces;
mod print;
mod text;
mod translation;
mod wgsl;
mod whole;

use ninebit::plan::{Plan, PlannedDraw};
use ninebit::state::{Level, Policies, Profile, Texels, TextureImage};
use ninebit_program::registers::unit::{WORDS, Words};

use crate::language::{Language, Shaders};

/// Options of a generic text.
#[derive(Clone, Copy, Debug)]
pub struct Generic {
    /// The chip whose words it reads.
    pub chip: Profile,
    /// Decisions about behaviour that no capture shows.
    pub policies: Policies,
}

/// Returns a draw whose units have all levels of their images, as memories have them for texts of every draw: plans leave out those that no pixel can
/// reach.
pub fn with_all_levels(plan: &Plan, draw: &PlannedDraw) -> PlannedDraw {
    let mut draw = draw.clone();
    for unit in &mut draw.units {
        let image = &plan.textures()[unit.state.texture].image;
        if let TextureImage::Texels(Texels { width, height, levels, border, .. }) = *image {
            unit.levels = Level::chain(unit.format, width, height, levels, border).0;
        }
    }
    draw
}

/// The C files of a generic text.
#[derive(Clone, Debug)]
pub struct Sources {
    /// Contents of the header, which declares the functions.
    pub header: String,
    /// Contents of the source, which includes the header.
    pub source: String,
    /// Name of both files, without `.h` and `.c`.
    pub name: &'static str,
}

impl Sources {
    /// Returns both files as one text, which needs no other file.
    pub fn whole(&self) -> String {
        format!("{}\n{}", self.header, self.source.replace(&format!("#include \"{}.h\"\n\n", self.name), ""))
    }
}

impl Generic {
    /// Returns the words of the state in the order of its members: name, number of words, and method of the first. The methods of the others
    /// follow in steps of four bytes.
    pub fn words(&self) -> Vec<(&'static str, usize, u32)> {
        text::words(self.chip).map(|words| (words.name, words.elements.0, words.method)).collect()
    }

    /// Prints C99 without dependencies, allocation or undefined behaviour.
    pub fn c99(&self) -> Sources {
        text::c99(self)
    }

    /// Prints C99 for whole pixels of every draw: from words of state, constants of a triangle and memories of textures to the stored words.
    pub fn whole_c99(&self) -> Sources {
        whole::c99(self)
    }

    /// Prints GLSL 4.30 and GLSL ES 3.10 for whole pixels of every draw, without the line that gives the version. `ninebit_texel` is the host's; storage
    /// buffers 0 and 2 have triangles and the [state](Generic::state).
    pub fn whole_glsl(&self) -> String {
        whole::shader(self, Language::Glsl)
    }

    /// Prints WGSL for whole pixels of every draw. `ninebit_texel`, `ninebit_triangles` and `ninebit_state`, which is a `NinebitState`, are the host's.
    pub fn whole_wgsl(&self) -> String {
        whole::shader(self, Language::Wgsl)
    }

    /// Prints shaders for every draw, for hosts that rasterise. Storage buffer 2 has the [state](Generic::state).
    pub fn whole_shaders(&self) -> Shaders {
        Shaders::of_every_draw(&self.whole_glsl(), "nb_draw_pixel(ninebit_number")
    }

    /// Returns the words of the state of whole pixels in the order of its members. `word` returns the word of a method.
    pub fn state(&self, word: impl Fn(u32) -> u32) -> Vec<u32> {
        let words =
            text::words(self.chip).chain(WORDS).flat_map(|Words { method, elements: (count, step), words, .. }| {
                (0..count as u32 * words as u32).map(move |n| method + n / words as u32 * step + n % words as u32 * 4)
            });
        words.map(word).collect()
    }

    /// Prints the steps of a pixel as combinational modules of Verilog-2001; connecting them is left to the user.
    pub fn verilog(&self) -> String {
        modules::verilog(self)
    }

    /// Prints GLSL 3.30 and GLSL ES 3.00, without the line that gives the version.
    pub fn glsl(&self) -> String {
        text::glsl(self)
    }
}
