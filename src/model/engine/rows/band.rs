//! The parts of the engine that are compiled for each instruction set: batches of pixels to lanes of a block, and blocks to the surface.

use super::boxes::{HALF_STEP, batch};
use super::depth::depths;
use super::fetch::{self, Workspace};
use super::kernels::{self, PerLane, STEP};
use super::levels::MipFetches;
use super::setup::{Covered, PixelBatch, Run};
use super::small::Boxes;
use super::stages::{self, Workshop};
use super::taps::Footprints;
use super::triangle::{Functions, Interpolators, Varying};
use super::{BLOCK, CompiledDraw, Job, Reason, Reasons, store};
use crate::engine::context::TriangleContext;
use crate::engine::walk::Band;

/// The buffers of a thread. They are kept from draw to draw.
#[derive(Debug, Default)]
pub(crate) struct Block {
    pub(super) rows: Vec<PerLane<i16>>,
    pub(super) varying: Varying,
    pub(super) work: Workspace,
    pub(super) workshop: Workshop,
    pub(super) boxes: Boxes,
    pub(super) planes: Functions,
    pub(super) runs: Vec<Run>,
    /// Number of lanes in use.
    pub(super) used: usize,
    /// A bit for each pixel of the band, set if the block has a lane for the pixel. Maintained only if the draw reads the surface.
    pub(super) taken: Vec<u64>,
    words: PerLane<u32>,
    stored: PerLane<u32>,
    depth: PerLane<u32>,
    pub(super) alive: PerLane<bool>,
    /// Number of pixels, by reason, of which the definition computed something.
    pub(crate) defined: Reasons,
}

/// Prepares a block for a draw. Compiled for the instruction set: draws of few pixels take 7 % less.
#[inline(always)]
pub(super) fn begin<const FMA: bool>(compiled: &CompiledDraw, block: &mut Block, band: &Band<'_>) {
    block.rows.resize(compiled.rows.len(), PerLane::from_value(0));
    for (row, value) in block.rows.iter_mut().zip(&compiled.rows) {
        if let Some(value) = value {
            row.fill(*value);
        }
    }
    // Earlier draws may have dropped fragments.
    block.alive.fill(true);
    block.varying.alive.fill(true);
    // Entries of another draw's table mean nothing in this draw's.
    block.varying.reads.clear();
    if compiled.samplers.iter().any(|sampler| sampler.mixes) {
        block.varying.reads.resize(compiled.samplers.len(), MipFetches::default());
    }
    // Lanes without a pixel are fetched too. Layers that an earlier volume left in them may lie beyond the images of this texture.
    for (faces, sampler) in block.varying.faces.iter_mut().zip(&compiled.samplers) {
        if sampler.has_images() {
            faces.fill(0);
        }
    }
    block.varying.footprints.clear();
    if compiled.estimates {
        block.varying.footprints.resize(compiled.samplers.len(), Footprints::default());
        for (footprints, sampler) in block.varying.footprints.iter_mut().zip(&compiled.samplers) {
            footprints.begin(sampler);
        }
    }
    if let Some(shader) = &compiled.shader {
        block.workshop.begin(shader);
    }
    if compiled.reads_surface {
        block.taken.resize(block.taken.len().max(band.words.len().div_ceil(64)), 0);
    }
}

/// Finds the pixels of boxes on a surface with rows of so many pixels, and sets up what is set up together.
#[inline(always)]
pub(super) fn set_up<const FMA: bool>(
    contexts: &[TriangleContext<'_>],
    compiled: &CompiledDraw,
    width: u32,
    boxes: &mut Boxes,
) {
    boxes.set_up::<FMA>(contexts, compiled, width);
}

/// Sets up what is computed by [`more`].
#[inline(always)]
pub(super) fn set_up_more<const FMA: bool>(context: &TriangleContext<'_>, compiled: &CompiledDraw, boxes: &mut Boxes) {
    if boxes.has_ratios {
        boxes.set_up_ratios::<FMA>(context, compiled);
    }
    if boxes.has_levels {
        boxes.set_up_levels::<FMA>(context, compiled);
    }
}

/// Interpolates all attributes but [`more`] in the block's current box, for a plain draw. Returns `false` if something is not proved; then nothing
/// that was written counts.
#[inline(always)]
pub(super) fn plain<const FMA: bool>(
    context: &TriangleContext<'_>,
    compiled: &CompiledDraw,
    block: &mut Block,
) -> bool {
    let Block { varying, rows, boxes, used, .. } = block;
    boxes.interpolate::<FMA, false>(context, compiled, batch::<HALF_STEP>(boxes.coverage(), *used), varying, rows)
}

/// Does the same for a box whose ties are lowered.
#[inline(always)]
pub(super) fn tied<const FMA: bool>(context: &TriangleContext<'_>, compiled: &CompiledDraw, block: &mut Block) -> bool {
    let Block { varying, rows, boxes, used, .. } = block;
    boxes.interpolate::<FMA, true>(context, compiled, batch::<HALF_STEP>(boxes.coverage(), *used), varying, rows)
}

/// Computes what else a plain draw reads in the block's current box: coordinates that are divided by q, depths to compare with, fog, numbers of the
/// texture shader, and fetches of samplers with levels. Returns `false` if something is not proved; then nothing that was written counts.
#[inline(always)]
pub(super) fn more<const FMA: bool>(context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block) -> bool {
    let compiled = job.compiled;
    let Block { varying, rows, boxes, used, workshop, .. } = block;
    let batch = batch::<HALF_STEP>(boxes.coverage(), *used);
    if boxes.has_ratios && !boxes.interpolate_ratios::<FMA>((context, compiled), batch, varying, rows) {
        return false;
    }
    if let (true, Some(shader)) = (boxes.has_ratios, compiled.of_numbers()) {
        let numbers = (boxes.numbers(), boxes.current);
        workshop.attributes_together::<FMA>(context.number, numbers, batch, &varying.reciprocals, shader);
    }
    !boxes.has_levels || boxes.interpolate_levels((context, compiled), job.interpolators.fetches, batch, varying)
}

/// Interpolates all attributes in one of the boxes of a triangle.
#[inline(always)]
pub(super) fn in_box<const FMA: bool>(interpolators: &Interpolators<'_>, job: &Job<'_>, block: &mut Block) {
    let Block { varying, rows, boxes, used, .. } = block;
    interpolators.interpolate::<FMA, false>(
        batch::<STEP>(boxes.coverage(), *used),
        (job.compiled, &job.interpolators),
        job.textures,
        varying,
        rows,
    );
}

/// Begins a row of so many pixels, or of an unknown number if it is 0.
#[inline(always)]
pub(super) fn begin_row<const FMA: bool>(
    pixel: (i64, i64),
    columns: i64,
    interpolators: &Interpolators<'_>,
    job: &Job<'_>,
    block: &mut Block,
) {
    interpolators.begin_row::<FMA>(pixel, columns, job.compiled, &mut block.varying);
}

/// Interpolates all attributes along a batch of a row. What says where it is comes one by one, in registers: from memory, where it has just
/// been written in parts, vectors of it would have to wait for all that is stored before.
#[inline(always)]
pub(super) fn row<const FMA: bool>(
    pixel: (i64, i64),
    count: usize,
    lane: usize,
    covered: Covered,
    interpolators: &Interpolators<'_>,
    job: &Job<'_>,
    block: &mut Block,
) {
    let Block { varying, rows, .. } = block;
    let batch = PixelBatch { covered, ..PixelBatch::row(pixel, count, lane) };
    interpolators.interpolate::<FMA, true>(batch, (job.compiled, &job.interpolators), job.textures, varying, rows);
}

/// Interpolates the inputs of the texture shader along a batch of a row.
#[inline(always)]
pub(super) fn row_attributes<const FMA: bool>(
    pixel: (i64, i64),
    count: usize,
    lane: usize,
    covered: Covered,
    context: &TriangleContext<'_>,
    job: &Job<'_>,
    block: &mut Block,
) {
    if let Some(shader) = &job.compiled.shader {
        let batch = PixelBatch { covered, ..PixelBatch::row(pixel, count, lane) };
        let Block { workshop, varying, .. } = block;
        workshop.attributes::<FMA, true>(context, batch, shader, &mut varying.short.dominance);
    }
}

/// Interpolates the inputs of the texture shader in the block's box.
#[inline(always)]
pub(super) fn box_attributes<const FMA: bool>(context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block) {
    if let Some(shader) = &job.compiled.shader {
        let Block { workshop, varying, boxes, used, .. } = block;
        let batch = batch::<HALF_STEP>(boxes.coverage(), *used);
        workshop.attributes::<FMA, false>(context, batch, shader, &mut varying.short.dominance);
    }
}

/// Computes the depths along a batch of a row, and tests them if nothing else drops fragments. Returns `false` if the test drops all its
/// pixels.
#[inline(always)]
pub(super) fn row_depths<const FMA: bool>(
    pixel: (i64, i64),
    count: usize,
    lane: usize,
    context: &TriangleContext<'_>,
    job: &Job<'_>,
    block: &mut Block,
    band: &mut Band<'_>,
) -> bool {
    let Block { varying, alive, defined, .. } = block;
    let batch = PixelBatch::row(pixel, count, lane);
    defined[Reason::Depths as usize] += depths::<FMA, true>(context, batch, varying.depths());
    let (lanes, at) = (lane..lane + count, band.index(pixel) as usize);
    let (incoming, memory) = (&varying.depth[lanes.clone()], &mut band.depth[at..][..count]);
    if job.compiled.drops_late {
        store::may_pass(job.draw, incoming, memory)
    } else {
        store::test_early::<false>(job.draw, count, incoming, memory, &mut alive[lanes])
    }
}

/// Computes the depths in the block's box, whose runs are those from the given one on, and tests them if nothing else drops fragments. Returns
/// `false` if the test drops all its pixels.
#[inline(always)]
pub(super) fn box_depths<const FMA: bool>(
    first: usize,
    context: &TriangleContext<'_>,
    job: &Job<'_>,
    block: &mut Block,
    band: &mut Band<'_>,
) -> bool {
    let Block { varying, alive, boxes, used, runs, depth, defined, .. } = block;
    let coverage = boxes.coverage();
    let covered = batch::<HALF_STEP>(coverage, *used).inside::<false>();
    if job.compiled.depths_together {
        boxes.depths.write::<FMA>(boxes.current, covered, job.draw.depth_format, &mut varying.depth);
    } else {
        defined[Reason::Depths as usize] += depths::<FMA, false>(context, covered, varying.depths());
    }
    let (incoming, runs) = (&varying.depth, &runs[first..]);
    if !job.compiled.drops_late {
        let lanes = covered.lanes();
        store::read_runs(band.depth, runs, depth.block_mut());
        let (incoming, memory) = (&incoming[lanes.clone()], &mut depth[lanes.clone()]);
        let is_visible = store::test_early::<true>(job.draw, coverage.count, incoming, memory, &mut alive[lanes]);
        if is_visible {
            store::write_runs(depth.block(), runs, band.depth);
        }
        return is_visible;
    }
    let lanes = |run: &Run| run.lane()..run.lane() + run.count();
    runs.iter().any(|run| store::may_pass(job.draw, &incoming[lanes(run)], &band.depth[run.at()..]))
}

/// Samples the unit of a sampler for a block.
#[inline(always)]
pub(super) fn sample<const FMA: bool>(
    job: &Job<'_>,
    sampler: usize,
    varying: &mut Varying,
    work: &mut Workspace,
    rows: &mut [PerLane<i16>],
) {
    fetch::sample_unit(job, sampler, varying, work, rows);
    fetch::drop_keyed(&job.compiled.samplers[sampler], work, &mut varying.alive);
}

/// Runs the stages of the texture shader for a block.
#[inline(always)]
pub(super) fn shade<const FMA: bool>(job: &Job<'_>, block: &mut Block, band: &mut Band<'_>) {
    let Block { rows, varying, work, workshop, runs, defined, .. } = block;
    let open = stages::run::<FMA>(job, runs, varying, workshop, (work, rows), band);
    defined[Reason::Shader as usize] += open;
}

impl Block {
    /// Appends a run of pixels to the block. `marks` says whether they are marked as taken.
    #[inline(always)]
    pub(super) fn append(&mut self, band: &Band<'_>, pixel: (i64, i64), count: usize, marks: bool) {
        self.runs.push(Run::new(self.used, band.index(pixel), count));
        self.used += count;
        if marks {
            let last = self.runs.len() - 1;
            store::mark(&mut self.taken, &self.runs[last..]);
        }
    }

    /// Returns whether the block has lanes for some of these pixels already.
    #[inline(always)]
    pub(super) fn is_taken(&self, band: &Band<'_>, pixel: (i64, i64), count: usize) -> bool {
        let at = band.index(pixel) as usize;
        store::is_marked(&self.taken, at, count)
    }

    #[inline(always)]
    pub(super) fn is_box_taken(&self, band: &Band<'_>) -> bool {
        let coverage = self.boxes.coverage();
        let first = band.index(coverage.first);
        let is_taken = |run: Run| {
            let run = run.further(0, first);
            store::is_marked(&self.taken, run.at(), run.count())
        };
        coverage.drawn().any(is_taken)
    }
}

/// Computes and stores a block whose units are sampled.
#[inline(always)]
pub(super) fn flush<const WIDE: bool>(job: &Job<'_>, block: &mut Block, band: &mut Band<'_>) {
    let Job { draw, compiled, .. } = *job;
    let Block { rows, varying, work, runs, used, taken, words, stored, depth, alive, .. } = block;
    let lanes = work.lanes;
    let (words, stored) = (words.block_mut(), stored.block_mut());
    let (depth, alive) = (depth.block_mut(), alive.block_mut());
    if compiled.drops_late {
        *alive = std::mem::replace(varying.alive.block_mut(), [true; BLOCK]);
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
        let incoming = varying.depth.block();
        if draw.stencil_test.is_some() || draw.depth_test.is_some() {
            store::read_runs(band.depth, runs, depth);
            if store::test_depth_stencil(draw, incoming, depth, alive) {
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
