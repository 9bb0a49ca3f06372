//! From triangles to batches of pixels, and from batches to blocks.

use super::band::Block;
use super::boxes::{Entered, batch, boxes, columns_of_quads, enter, spans_of_quads};
use super::dependent::PixelQuads;
use super::isa::Kernels;
use super::kernels::{Lanes, PerLane, STEP};
use super::levels::MipFetches;
use super::setup::{Covered, PixelBatch, whole_steps};
use super::shapes::GROUP;
use super::taps::Footprints;
use super::triangle::Interpolators;
use super::{BLOCK, Job, store};
use crate::engine::context::TriangleContext;
use crate::engine::walk::{self, Band, Window};
use std::ops::Range;

/// Draws the part of a draw that lies in a band. Returns the number of covered pixels.
#[inline(always)]
pub(super) fn run<T: Kernels>(job: &Job<'_>, band: &mut Band<'_>, block: &mut Block) -> u64 {
    let Job { plan, draw, compiled, .. } = *job;
    let mut shaded = 0;
    if walk::windows(draw, band.rows()).next().is_none() {
        return shaded;
    }
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
    let vacant = |_| TriangleContext::vacant(plan, draw, compiled.shader.is_none());
    // No more than the draw has triangles: most draws of sprites have two.
    let mut contexts: Vec<_> = (0..job.triangles.len().min(GROUP)).map(vacant).collect();
    for window in walk::windows(draw, band.rows()) {
        for numbers in job.triangles.chunks(GROUP) {
            let entered = enter(&mut contexts, numbers, window, compiled.together, &mut block.boxes.corners);
            for (at, entered) in entered[..numbers.len()].iter().enumerate() {
                shaded += draw_triangle::<T>(job, at, *entered, &mut contexts, band, block);
            }
            shaded += draw_boxes::<T>(job, &mut contexts, band, block);
        }
    }
    finish::<T>(job, block, band);
    shaded
}

/// Draws a triangle of a context, or adds its boxes to those that are drawn later. Returns the number of covered pixels that are drawn.
#[inline(always)]
fn draw_triangle<T: Kernels>(
    job: &Job<'_>,
    at: usize,
    entered: Entered,
    contexts: &mut [TriangleContext<'_>],
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let (compiled, mut shaded) = (job.compiled, 0);
    match entered {
        Entered::Nothing => return 0,
        Entered::Small(window) if !compiled.completes_quads => {
            for window in boxes(window) {
                block.boxes.add(window, at);
                if block.boxes.count == GROUP {
                    shaded += draw_boxes::<T>(job, contexts, band, block);
                }
            }
            return shaded;
        }
        Entered::Small(_) | Entered::Large(_) => shaded += draw_boxes::<T>(job, contexts, band, block),
    }
    let context = &mut contexts[at];
    // Written out where it is needed: a function that draws by a closure is not inlined, so that rows are not compiled for the instruction set.
    context.complete();
    let interpolators = Interpolators::new(context, compiled, std::mem::take(&mut block.planes));
    shaded += match entered {
        Entered::Nothing => 0,
        Entered::Small(window) => draw_boxes_of_quads::<T>(job, window, &interpolators, band, block),
        Entered::Large(window) if compiled.completes_quads => draw_quads::<T>(job, window, &interpolators, band, block),
        Entered::Large(window) => draw_rows::<T>(job, window, &interpolators, band, block),
    };
    block.planes = interpolators.given_back(&mut block.defined);
    shaded
}

/// Draws a triangle row by row. Returns the number of covered pixels.
#[inline(always)]
fn draw_rows<T: Kernels>(
    job: &Job<'_>,
    (rows, columns): Window,
    interpolators: &Interpolators<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let (compiled, context, mut shaded) = (job.compiled, interpolators.setup.context, 0);
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
    interpolators: &Interpolators<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let (compiled, context, mut shaded) = (job.compiled, interpolators.setup.context, 0);
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
    interpolators: &Interpolators<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let all = ((rows.0 & !1, rows.1), (columns.0 & !1, columns.1));
    let parts = boxes(all).map(|((top, end), (left, right))| ((top.max(rows.0), end), (left.max(columns.0), right)));
    parts.map(|part| draw_box_of_quads::<T>(job, part, interpolators, band, block)).sum()
}

/// Draws the part of a small triangle in a box that begins at an even row and column, with all pixels of the quads that it meets. Returns the
/// number of covered pixels.
#[inline(always)]
fn draw_box_of_quads<T: Kernels>(
    job: &Job<'_>,
    window: Window,
    interpolators: &Interpolators<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let context = interpolators.setup.context;
    block.boxes.coverage_mut().complete(&context.triangle, window, band.width as u32);
    if block.boxes.coverage().count == 0 {
        return 0;
    }
    if !interpolators.setup.is_positive_around(&batch::<STEP>(block.boxes.coverage(), 0)) {
        return draw_quads::<T>(job, window, interpolators, band, block);
    }
    if begin_box::<T>(job, context, band, block) {
        T::in_box(interpolators, job, block);
        let batch = batch::<STEP>(block.boxes.coverage(), block.used);
        for [one, other] in batch.runs.as_chunks::<2>().0 {
            let [upper, lower] = [one, other].map(|run| block.used + run.lane());
            let (pixel, count) = (batch.pixel(one.lane()), one.count() / 2);
            block.workshop.quads.add(PixelQuads { upper, lower, count, pixel, triangle: context.number });
        }
        append_box::<T>(job, context, block, false);
    }
    block.boxes.coverage().covered as u64
}

/// Computes a block and stores it.
#[inline(always)]
fn finish<T: Kernels>(job: &Job<'_>, block: &mut Block, band: &mut Band<'_>) {
    block.work.lanes = Lanes::first(block.used);
    if job.compiled.shader.is_some() && block.used > 0 {
        T::shade(job, block, band);
    }
    T::flush(job, block, band);
}

/// Draws the block's boxes. Returns the number of covered pixels.
#[inline(always)]
fn draw_boxes<T: Kernels>(
    job: &Job<'_>,
    contexts: &mut [TriangleContext<'_>],
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let (mut next, mut shaded) = (0, 0);
    if block.boxes.count > 0 {
        T::set_up(contexts, job.compiled, band.width as u32, &mut block.boxes);
        if block.boxes.has_more() {
            T::set_up_more(&contexts[0], job.compiled, &mut block.boxes);
        }
    }
    let count = std::mem::take(&mut block.boxes.count);
    while next < count {
        let at = block.boxes.all[next].1;
        let parts = block.boxes.all[next..count].iter().take_while(|(_, other)| *other == at).count();
        shaded += draw_parts::<T>(job, next..next + parts, &mut contexts[at], band, block);
        next += parts;
    }
    shaded
}

/// Draws some of the block's boxes, which are parts of one triangle. Returns the number of covered pixels.
#[inline(always)]
fn draw_parts<T: Kernels>(
    job: &Job<'_>,
    mut parts: Range<usize>,
    context: &mut TriangleContext<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let mut shaded = 0;
    // Nothing else is computed of triangles that the depth test drops.
    if begin_part::<T>(job, &mut parts, &mut shaded, context, band, block) {
        context.complete();
        let interpolators = Interpolators::new(context, job.compiled, std::mem::take(&mut block.planes));
        loop {
            T::in_box(&interpolators, job, block);
            append_box::<T>(job, context, block, false);
            if !begin_part::<T>(job, &mut parts, &mut shaded, context, band, block) {
                break;
            }
        }
        block.planes = interpolators.given_back(&mut block.defined);
    }
    shaded
}

/// Draws parts of a triangle up to the first one of which something is visible and not interpolated yet, which is begun. Returns whether there is one.
#[inline(always)]
fn begin_part<T: Kernels>(
    job: &Job<'_>,
    parts: &mut Range<usize>,
    shaded: &mut u64,
    context: &TriangleContext<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> bool {
    for n in parts {
        block.boxes.current = n;
        let count = block.boxes.coverage().count;
        *shaded += count as u64;
        if count == 0 || !begin_box::<T>(job, context, band, block) {
            continue;
        }
        let interpolate = if block.boxes.is_tied() { T::tied } else { T::plain };
        let proves = job.compiled.plain
            && interpolate(context, job.compiled, block)
            && (!block.boxes.has_more() || T::more(context, job.compiled, block));
        if !proves {
            return true;
        }
        append_box::<T>(job, context, block, true);
    }
    false
}

/// Computes the block if it has no room for the pixels of its coverage, adds and marks their runs, and computes their depths. Returns `false` if the
/// depth test drops all of them, so that nothing else has to be computed; then there are no runs of them.
#[inline(always)]
fn begin_box<T: Kernels>(job: &Job<'_>, context: &TriangleContext<'_>, band: &mut Band<'_>, block: &mut Block) -> bool {
    if block.boxes.coverage().count > BLOCK - block.used || (job.compiled.reads_surface && block.is_box_taken(band)) {
        finish::<T>(job, block, band);
    }
    let first = block.runs.len();
    let coverage = block.boxes.coverage();
    coverage.append((block.used, band.index(coverage.first)), &mut block.runs);
    let is_visible = job.draw.depth_test.is_none() || T::box_depths(first, context, job, block, band);
    if !is_visible {
        block.runs.truncate(first);
    } else if job.compiled.reads_surface {
        store::mark(&mut block.taken, &block.runs[first..]);
    }
    is_visible
}

/// Adds the pixels of the block's coverage, whose runs it has. `has_numbers` says whether it has the numbers of the texture shader, if it has one.
#[inline(always)]
fn append_box<T: Kernels>(job: &Job<'_>, context: &TriangleContext<'_>, block: &mut Block, has_numbers: bool) {
    let reads_numbers_only = job.compiled.of_numbers().is_some();
    if job.compiled.shader.is_some() && !(has_numbers && reads_numbers_only) {
        T::box_attributes(context, job, block);
    }
    block.used += block.boxes.coverage().count;
}
