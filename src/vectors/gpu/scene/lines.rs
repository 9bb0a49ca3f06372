//! What the lines of scenes are made of.

use ninebit::state::CompareFunction;

use crate::gpu::fixed::FUNCTIONS;

/// The deepest depth of the program's buffer, which has 24 bits.
pub(super) const DEEPEST: f64 = 16_777_215.0;

/// What computes a draw's colours where no combiners are needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Environment {
    /// No texture: the colours of the vertices, their sum and fog.
    Colors,
    /// The texel of unit 0.
    Texel,
}

/// Lines in the making, with the extensions that they need.
#[derive(Debug, Default)]
pub(super) struct Lines {
    pub(super) needs: Vec<&'static str>,
    pub(super) lines: Vec<String>,
}

impl Lines {
    pub(super) fn needs(&mut self, extension: &'static str) {
        if !self.needs.contains(&extension) {
            self.needs.push(extension);
        }
    }

    pub(super) fn add(&mut self, line: String) {
        self.lines.push(line);
    }
}

/// Returns OpenGL's name of a function.
pub(super) fn function(function: CompareFunction) -> &'static str {
    // The names are in the order of the values.
    FUNCTIONS.split(' ').nth(function as usize).unwrap_or("ALWAYS")
}
