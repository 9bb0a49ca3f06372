//! The parts of the engine that are compiled for each instruction set: lanes of a triangle, and blocks to the surface.

use super::Job;
use super::triangle::Functions;
use crate::engine::context::TriangleContext;
use crate::engine::rows::geometry::shape::Shape;
use crate::engine::rows::geometry::weights::Pixels;
use crate::engine::rows::interpolate::colors::ColorWeights;
use crate::engine::rows::interpolate::depths;
use crate::engine::rows::lanes::{BLOCK, PerLane, Run};
use crate::engine::rows::sampling::fetch::Workspace;
use crate::engine::rows::sampling::place::Place;
use crate::engine::rows::sampling::quads::Quads;
use crate::engine::rows::shading::compiled::CompiledDraw;
use crate::engine::rows::shading::kernels;
use crate::engine::rows::shading::stages::{Stages, Workshop};
use crate::engine::rows::store;
use crate::engine::walk::Band;

/// The buffers of a thread. They are kept from draw to draw.
#[derive(Debug, Default)]
pub(crate) struct Block {
    pub(crate) rows: Vec<PerLane<i16>>,
    pub(crate) pixels: Pixels,
    pub(crate) functions: Functions,
    /// W0 and W2.
    pub(crate) colors: ColorWeights,
    /// Where each sampler samples.
    pub(crate) places: Vec<Place>,
    pub(crate) quads: Quads,
    pub(crate) work: Workspace,
    pub(crate) workshop: Workshop,
    pub(crate) runs: Vec<Run>,
    /// Number of lanes in use.
    pub(crate) used: usize,
    /// A bit for each pixel of the band, set if the block has a lane for the pixel. Maintained only if the draw reads the surface.
    pub(crate) taken: Vec<u64>,
    /// Depths, if they are tested.
    incoming: PerLane<u32>,
    words: PerLane<u32>,
    stored: PerLane<u32>,
    depth: PerLane<u32>,
    /// Whether the depth test keeps the pixel, if it comes first. It keeps all between two blocks.
    alive: PerLane<bool>,
    /// Whether the texture units keep the pixel. They keep all between two blocks.
    pub(crate) sampled: PerLane<bool>,
}

/// Prepares a block for a draw.
#[inline(always)]
pub(crate) fn begin<const FMA: bool>(compiled: &CompiledDraw, block: &mut Block, band: &Band<'_>) {
    block.rows.resize(compiled.rows.len(), PerLane::from_value(0));
    for (row, value) in block.rows.iter_mut().zip(&compiled.rows) {
        if let Some(value) = value {
            row.fill(*value);
        }
    }
    // Earlier draws may have dropped fragments.
    block.alive.fill(true);
    block.sampled.fill(true);
    if block.places.len() < compiled.samplers.len() {
        block.places.resize(compiled.samplers.len(), Place::default());
    }
    for (place, sampler) in block.places.iter_mut().zip(&compiled.samplers) {
        place.begin(sampler);
    }
    if let Some(shader) = &compiled.shader {
        block.workshop.begin(shader);
    }
    if compiled.reads_surface {
        block.taken.resize(block.taken.len().max(band.words.len().div_ceil(64)), 0);
    }
}

/// Computes the depths of the lanes from the first one on, whose pixels are those of the runs from the first one on, and tests them if nothing
/// else drops fragments. If the test drops all, they are taken out of the block.
#[inline(always)]
pub(crate) fn test_depths<const FMA: bool>(
    context: &TriangleContext<'_>,
    shape: &Shape,
    job: &Job<'_>,
    block: &mut Block,
    (lane, first): (usize, usize),
    band: &mut Band<'_>,
) {
    let Block { pixels, incoming, alive, runs, depth, used, taken, .. } = block;
    let lanes = lane..lane + (*used - lane).next_multiple_of(8);
    depths::depths::<FMA>(context, shape, lanes.clone(), pixels, incoming);
    if job.compiled.drops_late {
        return;
    }
    let own = &runs[first..];
    store::read_runs(band.depth, own, depth.block_mut());
    store::test_early(job.draw, &incoming[lanes.clone()], &mut depth[lanes.clone()], &mut alive[lanes]);
    store::write_runs(depth.block(), own, band.depth);
    if !own.iter().any(|run| alive[run.lanes()].contains(&true)) {
        if job.compiled.reads_surface {
            store::mark(taken, own);
        }
        (*used, _) = (lane, runs.truncate(first));
    }
    // Lanes past the end are those of the next triangle.
    alive[*used..].fill(true);
}

/// Runs the stages of the texture shader for a block.
#[inline(always)]
pub(crate) fn shade<const FMA: bool>(job: &Job<'_>, block: &mut Block) {
    let Block { rows, pixels, places, quads, work, workshop, sampled, .. } = block;
    let Job { draw, compiled, .. } = *job;
    let (filter, sample) = (job.kernels.filter, job.kernels.sample);
    Stages { draw, compiled, filter, sample, pixels, places, quads, workshop, work, alive: sampled, rows }.run::<FMA>();
}

/// Computes and stores a block whose units are sampled.
#[inline(always)]
pub(crate) fn flush<const WIDE: bool>(job: &Job<'_>, block: &mut Block, band: &mut Band<'_>) {
    let Job { draw, compiled, .. } = *job;
    let Block { rows, incoming, sampled, work, runs, used, taken, words, stored, depth, alive, .. } = block;
    let lanes = work.lanes;
    let (words, stored) = (words.block_mut(), stored.block_mut());
    let (depth, alive) = (depth.block_mut(), alive.block_mut());
    if compiled.drops_late {
        *alive = std::mem::replace(sampled.block_mut(), [true; BLOCK]);
    }
    if compiled.destination.iter().any(Option::is_some) {
        store::read_runs(band.words, runs, stored);
        store::read((draw, compiled), lanes, stored, rows);
    }
    if compiled.reads_surface {
        store::mark(taken, runs);
    }
    for (node, at) in &compiled.operations {
        kernels::run(node, *at, lanes, rows);
    }
    if compiled.drops_late {
        if let Some(test) = &draw.alpha_test {
            let (alpha, reference) = (rows[usize::from(compiled.alpha)].block(), i16::from(test.reference));
            store::test(test.function, |n| alpha[n].clamp(0, 255), |_| reference, alive);
        }
        if draw.stencil_test.is_some() || draw.depth_test.is_some() {
            store::read_runs(band.depth, runs, depth);
            if store::test_depth_stencil(draw, incoming.block(), depth, alive) {
                store::write_runs(depth, runs, band.depth);
            }
        }
    }
    // Most blocks lose no fragment.
    let merges = compiled.merges && !(compiled.writes_whole && store::all(&alive[..*used]));
    store::pack((draw, compiled), lanes, rows, words);
    if merges {
        store::merge_runs((draw.write_mask, lanes), alive, words, stored, runs, band.words);
    } else {
        store::write_runs(words, runs, band.words);
    }
    if draw.depth_test.is_some() {
        alive.fill(true);
    }
    runs.clear();
    *used = 0;
}

impl Block {
    /// Adds pixels of a row as lanes.
    #[inline(always)]
    pub(crate) fn add(&mut self, compiled: &CompiledDraw, (i, j): (i64, i64), count: usize) {
        let lanes = self.used..self.used + count;
        self.used = lanes.end;
        if !compiled.interpolates {
            return;
        }
        // Whole vectors, of which the next row overwrites what is too much.
        let beyond = lanes.start..lanes.start + count.next_multiple_of(8);
        for (first, x) in (i as i32..).step_by(8).zip(self.pixels.x[beyond.clone()].as_chunks_mut::<8>().0) {
            *x = std::array::from_fn(|n| f64::from(first + n as i32));
        }
        for y in self.pixels.y[beyond].as_chunks_mut::<8>().0 {
            *y = [j as f64; 8];
        }
    }
}
