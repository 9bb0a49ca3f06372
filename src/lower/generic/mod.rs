//! The generic text: one C file or shader for every program, which reads the words of the registers while it runs.
//!
//! Its rules are printed like those of a single draw, by reading the order: a function for each step, with a case for each value of the field that chooses
//! ([`pieces`]). What stands here as text ([`text`]) is what brings values from one function to the next: where a field is, which register it names, what is called.

mod modules;
mod pieces;
mod text;

use ninebit::state::{Policies, Profile};

/// Which generic text.
#[derive(Clone, Copy, Debug)]
pub struct Generic {
    /// The chip whose words it reads.
    pub chip: Profile,
    /// Answers to what no capture decides.
    pub policies: Policies,
}

/// The files of the generic C.
#[derive(Clone, Debug)]
pub struct Sources {
    /// `ninebit_combiners.h`, which declares the functions.
    pub header: String,
    /// `ninebit_combiners.c`, which includes it.
    pub source: String,
}

impl Sources {
    /// Both as one text, which needs no other file.
    pub fn whole(&self) -> String {
        format!("{}\n{}", self.header, self.source.replace("#include \"ninebit_combiners.h\"\n\n", ""))
    }
}

impl Generic {
    /// The words of the state, in the order of its members: name, how many, the method of the first. Those that follow are at four bytes each.
    pub fn words(&self) -> Vec<(&'static str, usize, u32)> {
        text::words(self.chip).collect()
    }

    /// C99 without dependencies, allocation or undefined behaviour.
    pub fn c99(&self) -> Sources {
        text::c99(self)
    }

    /// The steps of a pixel as combinational modules of Verilog-2001; what joins them is the reader's.
    pub fn verilog(&self) -> String {
        modules::verilog(self)
    }

    /// GLSL 3.30 and GLSL ES 3.00; the line with the version is the caller's.
    pub fn glsl(&self) -> String {
        text::glsl(self)
    }
}
