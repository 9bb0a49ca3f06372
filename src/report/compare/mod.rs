//! The model against float64 arithmetic of the vendor's real-number text, over the same plan.
//!
//! [`Mode::Follow`] lets the ideal take every decision of the definition (coverage, texels, mux, tests), so that what is left is
//! accumulated quantisation, told apart by [`Part`]. [`Mode::PerOp`] starts again from the definition's integers at each rule, so that
//! each rule's own error shows. [`Mode::Free`] lets the ideal decide for itself, from vertices that are not snapped; pixels where the two
//! decide differently are counted and left out of the error.
//!
//! All errors are the definition minus the ideal, in steps of 1/255 (weights: of 1/256).
#![allow(clippy::float_arithmetic, reason = "statistics of errors; nothing of this is stored")]

pub mod bound;
mod draw;
mod follow;
mod free;
mod heat;
mod meter;
mod report;
mod statistics;

pub use heat::{HeatError, heat_classes, heat_color, heat_map};
pub use report::{comparison_json, comparison_text, statistics_value};
pub use statistics::{Histogram, Statistics};

use ninebit::number::Ideal;
use ninebit::plan::Plan;
use ninebit::state::named;
use ninebit::threads::on_threads;
use ninebit::trace::{Decision, Part, Rule};

named! {
    /// What the ideal is allowed to decide.
    pub enum Mode {
        /// Everything: end to end.
        Free = "free",
        /// Nothing: accumulated quantisation alone.
        Follow = "follow",
        /// Nothing, and it starts from the definition's integers at each rule.
        PerOp = "per-op",
    }
}

/// How to compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompareOptions {
    /// What the ideal decides.
    pub mode: Mode,
    /// Index of the render target that is compared.
    pub target: usize,
    /// Threads; 0 takes one a core. The counts and extremes do not depend on it, sums only in their last bits.
    pub threads: usize,
    /// Channels that count, bits R, G, B, A, as far as the surface keeps them; [`ALL_CHANNELS`] for all.
    pub channels: u8,
}

/// R, G, B and A.
pub const ALL_CHANNELS: u8 = 15;

/// Errors of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelError {
    /// R, G, B or A, as 0 to 3.
    pub channel: usize,
    /// Errors of the channel over all pixels.
    pub errors: Statistics,
    /// The same errors, counted in steps of a byte.
    pub histogram: Histogram,
}

/// What one rule did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RuleError {
    /// The rule that the errors arise in.
    pub rule: Rule,
    /// Its own errors, given exact inputs.
    pub errors: Statistics,
    /// Between which two numbers they must lie (`docs/numerics.md`); none is stated for projective coordinates.
    pub bound: Option<(f64, f64)>,
}

impl RuleError {
    /// Whether an error lies outside the bound.
    pub fn exceeds(&self) -> bool {
        // Products of float64 are not exact either.
        const ROUNDING: f64 = 1e-6;
        self.bound.is_some_and(|(low, high)| {
            self.errors.count > 0 && (self.errors.low < low - ROUNDING || self.errors.high > high + ROUNDING)
        })
    }
}

/// How often something was decided, and how often the ideal would have decided otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decided {
    /// What is decided.
    pub decision: Decision,
    /// How often it was decided.
    pub taken: u64,
    /// How often the two sides differ.
    pub differing: u64,
}

/// A pixel that is far off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstPixel {
    /// Column, 0 on the left.
    pub x: u32,
    /// Row, 0 at the top.
    pub y: u32,
    /// Channel R, G, B or A, as 0 to 3.
    pub channel: usize,
    /// What the surface shows.
    pub shown: u8,
    /// What the ideal holds, in 255ths.
    pub ideal: f64,
}

/// The outcome of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// How it was made.
    pub mode: Mode,
    /// Name of the target.
    pub target: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Pixels that some fragment was stored to.
    pub drawn: u64,
    /// Of those, pixels left out because a decision differs ([`Mode::Free`]).
    pub diverged: u64,
    /// Errors of R, G, B and A; without those that the surface does not keep. Empty for [`Mode::PerOp`].
    pub channels: Vec<ChannelError>,
    /// What each part contributes to those errors, in the order of `Part::ALL`. The parts add up to the error. [`Mode::Follow`] only.
    pub parts: Vec<(Part, Statistics)>,
    /// The largest amount by which the parts of a pixel miss its error: float64 rounding. [`Mode::Follow`] only.
    pub unexplained: f64,
    /// Each rule that was applied. [`Mode::PerOp`] only.
    pub rules: Vec<RuleError>,
    /// Decisions of both, and how often they differ.
    pub decisions: Vec<Decided>,
    /// Pixels with the largest errors, largest first, one for each distance at most.
    pub worst: Vec<WorstPixel>,
    /// Errors of R, G, B, A, row by row; NaN where nothing was drawn, infinite where the pixel is left out. Empty for [`Mode::PerOp`].
    pub errors: Vec<[f32; 4]>,
}

/// Compares a target of a plan with its ideal.
pub fn compare(plan: &Plan, options: &CompareOptions) -> Comparison {
    match options.mode {
        Mode::Free => draw::run::<free::Free>(plan, options),
        Mode::Follow => draw::run::<follow::Follow>(plan, options),
        Mode::PerOp => draw::run::<follow::PerOp>(plan, options),
    }
}

/// Evaluates the ideal alone, as [`Mode::Free`] does, in `f64` or `f32`: R, G, B, A of a target in 255ths, row by row; `None` where it draws
/// nothing. `threads` is that of [`CompareOptions`].
pub fn real_frame<L: Ideal + Send + Sync>(plan: &Plan, target: usize, threads: usize) -> Vec<Option<[L; 4]>> {
    on_threads(threads, || draw::held::<free::Real<L>>(plan, target))
}
