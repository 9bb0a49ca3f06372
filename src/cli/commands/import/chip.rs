//! What the chip's surfaces held after a draw, as a hardware tracer dumped it, beside what is drawn here.

use std::fmt;

use ninebit::engine::{RenderOptions, render};
use ninebit::frame::Surface;
use ninebit::plan::{Plan, PlanOptions};
use ninebit_files::output::{Compression, OutputError, encode_png};
use ninebit_methods::frame::{Frame, Held};

use crate::expectation::{Expectation, depth_digest};

/// A surface of the chip beside the same surface as it is drawn here.
pub(super) struct Comparison {
    /// `frame 2` or `draw 12`.
    name: String,
    target: String,
    /// Number of the last draw into it.
    draw: u64,
    /// The surface as the chip had it; what was not dumped is as it is drawn here.
    chip: Surface,
    has_depth: bool,
    colors: Difference,
    depths: Difference,
}

/// The pixels in which two surfaces differ.
#[derive(Default)]
struct Difference {
    count: usize,
    /// Column, row, the chip's word and the word that is drawn here.
    first: Option<(usize, usize, u32, u32)>,
}

impl Difference {
    fn new(chip: &[u32], drawn: &[u32], width: u32) -> Difference {
        let mut found = chip.iter().zip(drawn).enumerate().filter(|(_, (chip, drawn))| chip != drawn);
        let first = found.next();
        let width = width as usize;
        Difference {
            count: usize::from(first.is_some()) + found.count(),
            first: first.map(|(at, (chip, drawn))| (at % width, at / width, *chip, *drawn)),
        }
    }
}

/// Draws a frame and compares it with what the chip held. Without dumps, or if the frame cannot be drawn, there is nothing to compare.
pub(super) fn compare(frame: &Frame, name: &str) -> Vec<Comparison> {
    if frame.held.is_empty() {
        return Vec::new();
    }
    let Ok(plan) = Plan::compile(&frame.scene, &PlanOptions::default()) else { return Vec::new() };
    let frames = render(&plan, &RenderOptions::default());
    let comparison = |held: &Held| {
        let drawn = &frames.surfaces[held.target];
        let mut chip = drawn.clone();
        held.words.iter().for_each(|words| chip.words.clone_from(words));
        held.depth.iter().for_each(|words| chip.depth.clone_from(words));
        let colors = Difference::new(&chip.words, &drawn.words, drawn.width);
        let depths = Difference::new(&chip.depth, &drawn.depth, drawn.width);
        let target = frame.scene.targets[held.target].name.clone();
        let has_depth = held.depth.is_some();
        Comparison { name: name.to_owned(), target, draw: held.draw, chip, has_depth, colors, depths }
    };
    frame.held.iter().map(comparison).collect()
}

impl Comparison {
    /// Returns whether every word is the chip's.
    pub(super) fn is_exact(&self) -> bool {
        self.colors.count + self.depths.count == 0
    }

    /// Returns what the scene is expected to draw, whose picture is the file of that name.
    pub(super) fn expectation(&self, picture: String) -> Expectation {
        Expectation {
            depth: self.has_depth.then(|| depth_digest(&self.chip)),
            picture: Some(picture),
            capture: Some(format!("the chip's surface after draw {}", self.draw)),
            ..Expectation::from_surface(&self.target, &self.chip)
        }
    }

    /// Returns the chip's surface as a PNG.
    pub(super) fn picture(&self) -> Result<Vec<u8>, OutputError> {
        encode_png(self.chip.width, self.chip.height, &self.chip.rgba8(), Compression::Small)
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Comparison { name, target, chip, .. } = self;
        let pixels = chip.words.len();
        if self.is_exact() {
            return write!(f, "{name}: {target} is the chip's in all of {pixels} pixels");
        }
        write!(f, "{name}: {target} differs from the chip's")?;
        for (what, difference) in [("colours", &self.colors), ("depths", &self.depths)] {
            if let Some((x, y, chip, drawn)) = difference.first {
                let count = difference.count;
                write!(
                    f,
                    "; {what} in {count} of {pixels} pixels, first {x},{y}: 0x{chip:08x} by the chip, 0x{drawn:08x} here"
                )?;
            }
        }
        Ok(())
    }
}
