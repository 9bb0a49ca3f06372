//! Comparison of the model with float64 arithmetic of the vendor's real-number specification, over the same plan.
//!
//! In [`Mode::Follow`] the ideal takes every decision of the definition (coverage, texels, mux, tests). What remains is accumulated quantisation,
//! split by [`Part`]. In [`Mode::PerOp`] each rule starts from the definition's integers, which shows each rule's own error. In [`Mode::Free`] the
//! ideal decides for itself, from vertices that are not snapped; pixels where the two decide differently are counted and excluded from the error.
//!
//! All errors are the definition minus the ideal, in steps of 1/255 (for weights, of 1/256).
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
    /// The decisions that the ideal takes for itself.
    pub enum Mode {
        /// All of them: an end-to-end comparison.
        Free = "free",
        /// None: accumulated quantisation alone.
        Follow = "follow",
        /// None, and each rule starts from the definition's integers.
        PerOp = "per-op",
    }
}

/// Options of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompareOptions {
    /// The decisions of the ideal.
    pub mode: Mode,
    /// Index of the render target that is compared.
    pub target: usize,
    /// Number of threads; 0 for one per core. Counts and extremes do not depend on it; sums may differ in their last bits.
    pub threads: usize,
    /// Mask of the compared channels (bits R, G, B, A), of those that the surface keeps; [`ALL_CHANNELS`] for all.
    pub channels: u8,
}

/// Mask of R, G, B and A.
pub const ALL_CHANNELS: u8 = 15;

/// Errors of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelError {
    /// Channel: 0 to 3 for R, G, B, A.
    pub channel: usize,
    /// Errors of the channel over all pixels.
    pub errors: Statistics,
    /// Histogram of the errors in whole steps.
    pub histogram: Histogram,
}

/// Errors of one rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RuleError {
    /// The rule that causes the errors.
    pub rule: Rule,
    /// Errors of the rule itself, given exact inputs.
    pub errors: Statistics,
    /// Lowest and highest permitted error (`docs/rules`); `None` for projective coordinates.
    pub bound: Option<(f64, f64)>,
}

impl RuleError {
    /// Returns whether an error exceeds the bound.
    pub fn exceeds(&self) -> bool {
        // Products of float64 are not exact either.
        const ROUNDING: f64 = 1e-6;
        self.bound.is_some_and(|(low, high)| {
            self.errors.count > 0 && (self.errors.low < low - ROUNDING || self.errors.high > high + ROUNDING)
        })
    }
}

/// Number of times that a decision was taken, and that the ideal would have decided otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DecisionCount {
    /// The kind of decision.
    pub decision: Decision,
    /// Number of times that it was taken.
    pub taken: u64,
    /// Number of times that the two sides differ.
    pub differing: u64,
}

/// A pixel with a large error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstPixel {
    /// Column, 0 on the left.
    pub x: u32,
    /// Row, 0 at the top.
    pub y: u32,
    /// Channel: 0 to 3 for R, G, B, A.
    pub channel: usize,
    /// Value that the surface shows.
    pub shown: u8,
    /// Value of the ideal, in 255ths.
    pub ideal: f64,
}

/// Result of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Mode of the comparison.
    pub mode: Mode,
    /// Name of the target.
    pub target: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Number of pixels to which a fragment was stored.
    pub drawn: u64,
    /// Number of those that are left out because a decision differs ([`Mode::Free`]).
    pub diverged: u64,
    /// Errors of the channels that the surface keeps. Empty for [`Mode::PerOp`].
    pub channels: Vec<ChannelError>,
    /// Contribution of each part to those errors, in the order of `Part::ALL`. In each pixel they add up to the error. [`Mode::Follow`] only.
    pub parts: Vec<(Part, Statistics)>,
    /// Largest difference between a pixel's error and the sum of its parts, due to float64 rounding. [`Mode::Follow`] only.
    pub unexplained: f64,
    /// Errors of each applied rule. [`Mode::PerOp`] only.
    pub rules: Vec<RuleError>,
    /// Decisions, and how often the two sides differ.
    pub decisions: Vec<DecisionCount>,
    /// Pixels with the largest errors, largest first; each with its worst channel.
    pub worst: Vec<WorstPixel>,
    /// Errors of R, G, B, A, row by row; NaN where nothing was drawn, infinite where a pixel is left out. Empty for [`Mode::PerOp`].
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

/// Evaluates the ideal alone, as [`Mode::Free`] does, in `f64` or `f32`. Returns R, G, B, A of a target in 255ths, row by row; `None` where nothing
/// is drawn. `threads` is that of [`CompareOptions`].
pub fn real_frame<L: Ideal + Send + Sync>(plan: &Plan, target: usize, threads: usize) -> Vec<Option<[L; 4]>> {
    on_threads(threads, || draw::held::<free::Real<L>>(plan, target))
}
