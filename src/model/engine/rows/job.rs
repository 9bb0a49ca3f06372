//! What the parts of the engine are given to draw.

use super::compiled::CompiledDraw;
use super::fetch::SampleUnit;
use super::filter::Filter;
use super::triangle::InterpolatorKernels;
use crate::plan::{Plan, PlannedDraw};
use crate::texture::planned::Image;

/// The parts of a draw that are the same for all of its blocks.
#[derive(Clone, Copy)]
pub(crate) struct Job<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) draw: &'a PlannedDraw,
    pub(crate) compiled: &'a CompiledDraw,
    pub(crate) textures: &'a [Image<'a, i32>],
    /// Numbers of the triangles that may cover pixels, in order.
    pub(crate) triangles: &'a [u32],
    pub(super) filter: Filter,
    pub(super) sample: SampleUnit,
    pub(super) interpolators: InterpolatorKernels,
}
