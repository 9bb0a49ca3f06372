//! From triangles to batches of pixels, from batches to blocks, and from blocks to the surface.

use super::boxes::{Entered, batch, boxes, columns_of_quads, spans_of_quads};
use super::dependent::PixelQuads;
use super::depth::depths;
use super::fetch::{self, Workspace};
use super::isa::Kernels;
use super::kernels::{self, PerLane};
use super::levels::MipFetches;
use super::setup::{Covered, PixelBatch, Run, whole_steps};
use super::small::{Boxes, GROUP};
use super::stages::{self, Workshop};
use super::taps::Footprints;
use super::triangle::{Functions, Interpolators, Varying};
use super::{BLOCK, CompiledDraw, Job, Reason, Reasons, store};
use crate::engine::pixel::TriangleContext;
use crate::engine::walk::{self, Band, Window};

// Kernels stand here, wherever their text is.
pub(super) use super::boxes::{cover, enter};

/// The buffers of a thread. They are kept from draw to draw.
#[derive(Debug, Default)]
pub(crate) struct Block {
    pub(super) rows: Vec<PerLane<i16>>,
    pub(super) varying: Varying,
    pub(super) work: Workspace,
    pub(super) workshop: Workshop,
    boxes: Boxes,
    planes: Functions,
    pub(super) runs: Vec<Run>,
    /// Number of lanes in use.
    used: usize,
    /// A bit for each pixel of the band, set if the block has a lane for the pixel. Maintained only if the draw reads the surface.
    taken: Vec<u64>,
    words: PerLane<u32>,
    stored: PerLane<u32>,
    depth: PerLane<u32>,
    alive: PerLane<bool>,
    /// Number of pixels, by reason, of which the definition computed something.
    pub(crate) defined: Reasons,
}

/// Draws the part of a draw that lies in a band. Returns the number of covered pixels.
#[inline(always)]
pub(super) fn run<T: Kernels>(job: &Job<'_>, band: &mut Band<'_>, block: &mut Block) -> u64 {
    let Job { plan, draw, compiled, .. } = *job;
    let mut shaded = 0;
    if walk::windows(draw, band.rows()).next().is_none() {
        return shaded;
    }
    block.rows.resize(compiled.rows.len(), PerLane::from_value(0));
    for (row, constant) in block.rows.iter_mut().zip(&compiled.rows) {
        row.fill(*constant);
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
    let vacant = |_| TriangleContext::vacant(plan, draw, compiled.shader.is_none());
    let mut contexts: [_; GROUP] = std::array::from_fn(vacant);
    for window in walk::windows(draw, band.rows()) {
        for number in job.triangles {
            shaded += draw_triangle::<T>(job, *number as usize, window, &mut contexts, band, block);
        }
    }
    shaded += draw_boxes::<T>(job, &mut contexts, band, block);
    finish::<T>(job, block, band);
    shaded
}

/// Draws the part of a triangle that lies in some rows and columns of a band, or adds its boxes to those that are drawn later. Returns the number
/// of covered pixels that are drawn.
#[inline(always)]
fn draw_triangle<T: Kernels>(
    job: &Job<'_>,
    number: usize,
    window: Window,
    contexts: &mut [TriangleContext<'_>; GROUP],
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let (compiled, mut shaded, mut at) = (job.compiled, 0, block.boxes.vacant());
    let entered = T::enter(&mut contexts[at], number, window);
    match entered {
        Entered::Nothing => return 0,
        Entered::Small(window) if compiled.plain && !compiled.completes_quads => {
            for window in boxes(window) {
                block.boxes.add(window, at);
                if block.boxes.count == GROUP {
                    shaded += draw_boxes::<T>(job, contexts, band, block);
                    contexts.swap(0, at);
                    at = 0;
                }
            }
            return shaded;
        }
        Entered::Small(_) | Entered::Large(_) => shaded += draw_boxes::<T>(job, contexts, band, block),
    }
    let context = &mut contexts[at];
    if let (Entered::Small(window), false) = (entered, compiled.completes_quads) {
        return shaded + draw_in_boxes::<T>(job, window, context, band, block);
    }
    T::complete(context);
    let interpolators = Interpolators::new(context, compiled, std::mem::take(&mut block.planes));
    shaded += match entered {
        Entered::Nothing => 0,
        Entered::Small(window) => draw_boxes_of_quads::<T>(job, window, context, &interpolators, band, block),
        Entered::Large(window) if compiled.completes_quads => {
            draw_quads::<T>(job, window, context, &interpolators, band, block)
        }
        Entered::Large(window) => draw_rows::<T>(job, window, context, &interpolators, band, block),
    };
    block.planes = interpolators.given_back(&mut block.defined);
    shaded
}

/// Draws a triangle row by row. Returns the number of covered pixels.
#[inline(always)]
fn draw_rows<T: Kernels>(
    job: &Job<'_>,
    (rows, columns): Window,
    context: &TriangleContext<'_>,
    interpolators: &Interpolators<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let (compiled, mut shaded) = (job.compiled, 0);
    for j in rows.0..rows.1 {
        let (mut i, end) = context.triangle.span(j, columns);
        if i == end {
            continue;
        }
        // Begins at a multiple of a step, so that no step of lanes crosses a cache line.
        block.used = whole_steps(block.used);
        let mut has_begun = false;
        while i < end {
            let wanted = ((end - i) as usize).min(BLOCK);
            if block.used == BLOCK || (compiled.reads_surface && block.is_taken(band, (i, j), wanted)) {
                finish::<T>(job, block, band);
            }
            let count = wanted.min(BLOCK - block.used);
            let (pixel, lane, all) = ((i, j), block.used, Covered(0, count));
            let is_visible =
                job.draw.depth_test.is_none() || T::row_depths(pixel, count, lane, context, job, block, band);
            if is_visible {
                // Quotients by steps go on from the batch before, if there is one.
                if !has_begun {
                    interpolators.begin_row((i, j), end - i, compiled, &mut block.varying);
                }
                T::row(pixel, count, lane, all, interpolators, job, block);
                if compiled.shader.is_some() {
                    T::row_attributes(pixel, count, lane, all, context, job, block);
                }
                block.append(band, (i, j), count, compiled.reads_surface);
            }
            has_begun = is_visible;
            shaded += count as u64;
            i += count as i64;
        }
    }
    shaded
}

/// Draws a triangle by two rows at a time, with all pixels of the quads that it meets. Returns the number of covered pixels.
#[inline(always)]
fn draw_quads<T: Kernels>(
    job: &Job<'_>,
    window: Window,
    context: &TriangleContext<'_>,
    interpolators: &Interpolators<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let (compiled, mut shaded) = (job.compiled, 0);
    interpolators.begin_row((window.1.0, window.0.0), 0, compiled, &mut block.varying);
    for top in (window.0.0 & !1..window.0.1).step_by(2) {
        let spans = spans_of_quads(&context.triangle, top, window);
        let (mut low, high) = columns_of_quads(spans);
        while low < high {
            // Two rows fill a block at most.
            let columns = (high - low).min(BLOCK as i64 / 2);
            let covered = spans.map(|(first, end)| {
                let (first, end) = (first.max(low), end.min(low + columns));
                if first < end { Covered((first - low) as usize, (end - first) as usize) } else { Covered(0, 0) }
            });
            let at = |n: usize| (low + covered[n].0 as i64, top + n as i64);
            let lanes = whole_steps(columns as usize);
            let is_taken = |n: usize| covered[n].1 > 0 && block.is_taken(band, at(n), covered[n].1);
            if 2 * lanes > BLOCK - block.used || (compiled.reads_surface && (is_taken(0) || is_taken(1))) {
                finish::<T>(job, block, band);
            }
            let quads = PixelQuads {
                upper: block.used,
                lower: block.used + lanes,
                count: columns as usize / 2,
                pixel: (low, top),
                triangle: context.number,
            };
            for n in 0..2 {
                let whole = PixelBatch {
                    covered: covered[n],
                    ..PixelBatch::row((low, top + n as i64), columns as usize, block.used)
                };
                // Where D is not positive, the definition knows no level of detail, and quotients mean nothing.
                let is_known = interpolators.setup.is_positive(&whole);
                let batch = &if is_known { whole } else { whole.inside::<true>() };
                if batch.count > 0 {
                    let PixelBatch { first, count, lane, covered, .. } = *batch;
                    T::row(first, count, lane, covered, interpolators, job, block);
                    T::row_attributes(first, count, lane, covered, context, job, block);
                }
                if !is_known {
                    block.workshop.leave_open(whole.lanes());
                }
                let Covered(first, count) = covered[n];
                let (tests, lane) = (job.draw.depth_test.is_some(), whole.lane + first);
                if count > 0 && (!tests || T::row_depths(at(n), count, lane, context, job, block, band)) {
                    block.used += first;
                    block.append(band, at(n), count, compiled.reads_surface);
                }
                block.used = whole.lanes().end;
                shaded += count as u64;
            }
            block.workshop.quads.add(quads);
            low += columns;
        }
    }
    shaded
}

/// Draws a small triangle with all pixels of the quads that it meets. Returns the number of covered pixels.
#[inline(always)]
fn draw_boxes_of_quads<T: Kernels>(
    job: &Job<'_>,
    (rows, columns): Window,
    context: &TriangleContext<'_>,
    interpolators: &Interpolators<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let all = ((rows.0 & !1, rows.1), (columns.0 & !1, columns.1));
    let parts = boxes(all).map(|((top, end), (left, right))| ((top.max(rows.0), end), (left.max(columns.0), right)));
    parts.map(|part| draw_box_of_quads::<T>(job, part, context, interpolators, band, block)).sum()
}

/// Draws the part of a small triangle in a box that begins at an even row and column, with all pixels of the quads that it meets. Returns the
/// number of covered pixels.
#[inline(always)]
fn draw_box_of_quads<T: Kernels>(
    job: &Job<'_>,
    window: Window,
    context: &TriangleContext<'_>,
    interpolators: &Interpolators<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    block.boxes.coverage_mut().complete(&context.triangle, window);
    if block.boxes.coverage().count == 0 {
        return 0;
    }
    if !interpolators.setup.is_positive_around(&batch(block.boxes.coverage(), 0)) {
        return draw_quads::<T>(job, window, context, interpolators, band, block);
    }
    if begin_box::<T>(job, context, band, block) {
        T::in_box(interpolators, job, block);
        let mut upper = block.used;
        for [(top, low, columns), _] in block.boxes.coverage().runs[..block.boxes.coverage().filled].as_chunks::<2>().0
        {
            let (pixel, count) = ((*low, *top), columns / 2);
            let quads = PixelQuads { upper, lower: upper + columns, count, pixel, triangle: context.number };
            block.workshop.quads.add(quads);
            upper += 2 * columns;
        }
        append_box::<T>(job, context, block);
    }
    block.boxes.coverage().covered as u64
}

/// Computes a block and stores it.
#[inline(always)]
fn finish<T: Kernels>(job: &Job<'_>, block: &mut Block, band: &mut Band<'_>) {
    if job.compiled.shader.is_some() && block.used > 0 {
        T::shade(job, block, band);
    }
    T::flush(job, block, band);
}

/// Draws the block's boxes, for a plain draw. Returns the number of covered pixels.
#[inline(always)]
fn draw_boxes<T: Kernels>(
    job: &Job<'_>,
    contexts: &mut [TriangleContext<'_>; GROUP],
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let (count, mut shaded) = (std::mem::take(&mut block.boxes.count), 0);
    if count > 0 {
        T::set_up(contexts, job.compiled, count, &mut block.boxes);
    }
    for n in 0..count {
        block.boxes.current = n;
        let context = &mut contexts[block.boxes.all[n].1];
        shaded += block.boxes.coverage().count as u64;
        if block.boxes.coverage().count == 0 || !begin_box::<T>(job, context, band, block) {
            continue;
        }
        if !T::plain(context, job.compiled, block) {
            T::complete(context);
            let interpolators = Interpolators::new(context, job.compiled, std::mem::take(&mut block.planes));
            T::in_box(&interpolators, job, block);
            block.planes = interpolators.given_back(&mut block.defined);
        }
        append_box::<T>(job, context, block);
    }
    block.boxes.current = 0;
    shaded
}

/// Draws the part of a small triangle in some rows and columns, for any draw. Returns the number of covered pixels.
#[inline(always)]
fn draw_in_boxes<T: Kernels>(
    job: &Job<'_>,
    window: Window,
    context: &mut TriangleContext<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let (mut windows, mut shaded) = (boxes(window), 0);
    let mut next = |context: &TriangleContext<'_>, block: &mut Block| {
        windows.any(|window| {
            T::cover(&context.triangle, window, block.boxes.coverage_mut());
            let count = block.boxes.coverage().count;
            shaded += count as u64;
            count > 0 && begin_box::<T>(job, context, band, block)
        })
    };
    // Nothing else is computed of triangles that the depth test drops.
    if next(context, block) {
        T::complete(context);
        let interpolators = Interpolators::new(context, job.compiled, std::mem::take(&mut block.planes));
        loop {
            T::in_box(&interpolators, job, block);
            append_box::<T>(job, context, block);
            if !next(context, block) {
                break;
            }
        }
        block.planes = interpolators.given_back(&mut block.defined);
    }
    shaded
}

/// Computes the block if it has no room for the pixels of its coverage, adds and marks their runs, and computes their depths. Returns `false` if the
/// depth test drops all of them, so that nothing else has to be computed; then there are no runs of them.
#[inline(always)]
fn begin_box<T: Kernels>(job: &Job<'_>, context: &TriangleContext<'_>, band: &mut Band<'_>, block: &mut Block) -> bool {
    if block.boxes.coverage().count > BLOCK - block.used || (job.compiled.reads_surface && block.is_box_taken(band)) {
        finish::<T>(job, block, band);
    }
    let (first, mut lane) = (block.runs.len(), block.used);
    let coverage = block.boxes.coverage();
    // Most boxes have covered pixels only, and choices in each row would cost a small triangle some per cent.
    if coverage.covered == coverage.count {
        block.runs.extend(coverage.runs[..coverage.filled].iter().map(|(j, i, count)| {
            let run = Run { lane, at: index(band, (*i, *j)), count: *count };
            lane += count;
            run
        }));
    } else {
        let run = |(from, pixel, count)| Run { lane: lane + from, at: index(band, pixel), count };
        block.runs.extend(coverage.drawn().map(run));
    }
    let is_visible = job.draw.depth_test.is_none() || T::box_depths(first, context, job, block, band);
    if !is_visible {
        block.runs.truncate(first);
    } else if job.compiled.reads_surface {
        store::mark(&mut block.taken, &block.runs[first..]);
    }
    is_visible
}

/// Adds the pixels of the block's coverage, whose runs it has.
#[inline(always)]
fn append_box<T: Kernels>(job: &Job<'_>, context: &TriangleContext<'_>, block: &mut Block) {
    if job.compiled.shader.is_some() {
        T::box_attributes(context, job, block);
    }
    block.used += block.boxes.coverage().count;
}

/// Sets up coordinates and fog of a triangle.
#[inline(always)]
pub(super) fn complete<const WIDE: bool>(context: &mut TriangleContext<'_>) {
    context.complete();
}

/// Finds the pixels of the first boxes, and sets up all functions.
#[inline(always)]
pub(super) fn set_up<const FMA: bool>(
    contexts: &[TriangleContext<'_>],
    compiled: &CompiledDraw,
    count: usize,
    boxes: &mut Boxes,
) {
    boxes.set_up::<FMA>(contexts, compiled, count);
}

/// Interpolates all attributes in the block's current box, for a plain draw. Returns `false` if something is not proved; then nothing that was
/// written counts.
#[inline(always)]
pub(super) fn plain<const FMA: bool>(
    context: &TriangleContext<'_>,
    compiled: &CompiledDraw,
    block: &mut Block,
) -> bool {
    let Block { varying, rows, boxes, used, .. } = block;
    boxes.interpolate::<FMA>(context, compiled, batch(boxes.coverage(), *used), varying, rows)
}

/// Interpolates all attributes in one of the boxes of a triangle.
#[inline(always)]
pub(super) fn in_box<const FMA: bool>(interpolators: &Interpolators<'_>, job: &Job<'_>, block: &mut Block) {
    let Block { varying, rows, boxes, used, .. } = block;
    interpolators.interpolate::<FMA, false>(batch(boxes.coverage(), *used), job.compiled, job.textures, varying, rows);
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
    interpolators.interpolate::<FMA, true>(batch, job.compiled, job.textures, varying, rows);
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
        block.workshop.attributes::<FMA, true>(context, batch, shader);
    }
}

/// Interpolates the inputs of the texture shader in the block's box.
#[inline(always)]
pub(super) fn box_attributes<const FMA: bool>(context: &TriangleContext<'_>, job: &Job<'_>, block: &mut Block) {
    if let Some(shader) = &job.compiled.shader {
        block.workshop.attributes::<FMA, false>(context, batch(block.boxes.coverage(), block.used), shader);
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
    let (lanes, at) = (lane..lane + count, index(band, pixel));
    let (incoming, memory) = (&varying.depth[lanes.clone()], &mut band.depth[at..][..count]);
    if job.compiled.drops_late {
        store::may_pass(job.draw, incoming, memory)
    } else {
        store::test_early(job.draw, incoming, memory, &mut alive[lanes])
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
    let covered = batch(coverage, *used).inside::<false>();
    defined[Reason::Depths as usize] += depths::<FMA, false>(context, covered, varying.depths());
    let (incoming, runs, depth) = (&varying.depth, &runs[first..], depth.block_mut());
    if !job.compiled.drops_late {
        let lanes = *used..*used + coverage.count;
        store::read_runs(band.depth, runs, depth);
        let (incoming, memory) = (&incoming[lanes.clone()], &mut depth[lanes.clone()]);
        let is_visible = store::test_early(job.draw, incoming, memory, &mut alive[lanes]);
        if is_visible {
            store::write_runs(depth, runs, band.depth);
        }
        return is_visible;
    }
    let lanes = |run: &Run| run.lane..run.lane + run.count;
    runs.iter().any(|run| store::may_pass(job.draw, &incoming[lanes(run)], &band.depth[run.at..]))
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
    fn append(&mut self, band: &Band<'_>, pixel: (i64, i64), count: usize, marks: bool) {
        let at = index(band, pixel);
        self.runs.push(Run { lane: self.used, at, count });
        self.used += count;
        if marks {
            let last = self.runs.len() - 1;
            store::mark(&mut self.taken, &self.runs[last..]);
        }
    }

    /// Returns whether the block has lanes for some of these pixels already.
    #[inline(always)]
    fn is_taken(&self, band: &Band<'_>, pixel: (i64, i64), count: usize) -> bool {
        let at = index(band, pixel);
        store::is_marked(&self.taken, at, count)
    }

    #[inline(always)]
    fn is_box_taken(&self, band: &Band<'_>) -> bool {
        self.boxes.coverage().drawn().any(|(_, pixel, count)| self.is_taken(band, pixel, count))
    }
}

/// Returns the index of a pixel in a band.
#[inline(always)]
fn index(band: &Band<'_>, (i, j): (i64, i64)) -> usize {
    (j as usize - band.first_row) * band.width + i as usize
}

/// From this average length of runs on, words of the surface are worked on in place instead of being copied.
const LONG_RUN: usize = 48;

/// Computes and stores a block whose texture shader stages have run.
#[inline(always)]
pub(super) fn flush<const WIDE: bool>(job: &Job<'_>, block: &mut Block, band: &mut Band<'_>) {
    let Job { draw, compiled, .. } = *job;
    let Block { rows, varying, work, runs, used, taken, words, stored, depth, alive, .. } = block;
    if *used == 0 {
        return;
    }
    let (words, stored) = (words.block_mut(), stored.block_mut());
    let (depth, alive) = (depth.block_mut(), alive.block_mut());
    if compiled.drops_late {
        *alive = *varying.alive.block();
    }
    let mut found = None;
    let samplers = if compiled.shader.is_some() { &[] } else { &compiled.samplers[..] };
    for (n, sampler) in samplers.iter().enumerate() {
        found = fetch::sample_unit(job, n, found, varying, work, rows);
        fetch::drop_keyed(sampler, work, alive);
    }
    if compiled.destination.iter().any(Option::is_some) {
        store::read_runs(band.words, runs, stored);
        store::read(draw, compiled, stored, rows);
    }
    if compiled.reads_surface {
        store::mark(taken, runs);
    }
    for (node, at) in &compiled.operations {
        kernels::run(node, *at, rows);
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
    if !merges && runs.len() * LONG_RUN <= *used {
        for run in runs.iter() {
            store::pack(draw, compiled, rows, run.lane, &mut band.words[run.at..][..run.count]);
        }
    } else {
        store::pack(draw, compiled, rows, 0, words);
        if merges {
            store::merge_runs(draw.write_mask, alive, words, stored, runs, band.words);
        } else {
            store::write_runs(words, runs, band.words);
        }
    }
    if draw.depth_test.is_some() {
        alive.fill(true);
    }
    runs.clear();
    *used = 0;
}
