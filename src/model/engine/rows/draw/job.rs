//! The parts of the engine that are compiled for each instruction set are told what to draw by a job.

use crate::engine::rows::sampling::fetch::SampleUnit;
use crate::engine::rows::sampling::filter::Filter;
use crate::engine::rows::shading::compiled::CompiledDraw;
use crate::plan::{Plan, PlannedDraw};

/// The parts of a draw that are the same for all of its blocks.
#[derive(Clone, Copy)]
pub(crate) struct Job<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) draw: &'a PlannedDraw,
    pub(crate) compiled: &'a CompiledDraw,
    /// Numbers of the triangles that may cover pixels, in order.
    pub(crate) triangles: &'a [u32],
    pub(crate) filter: Filter,
    pub(crate) sample: SampleUnit,
}
