//! From triangles to batches of pixels, and from batches to blocks.

use super::band::Block;
use super::boxes::{Entered, batch, boxes, columns_of_quads, enter, spans_of_quads};
use super::dependent::PixelQuads;
use super::isa::Kernels;
use super::kernels::{Lanes, STEP};
use super::setup::{Covered, PixelBatch, whole_steps};
use super::shapes::GROUP;
use super::triangle::Interpolators;
use super::{BLOCK, Job, store};
use crate::engine::context::TriangleContext;
use crate::engine::walk::{self, Band, Window};
use std::ops::Range;

/// Draws the part of a draw that lies in a band. Returns the number of covered pixels.
pub(crate) fn run(kernels: &Kernels, job: &Job<'_>, band: &mut Band<'_>, block: &mut Block) -> u64 {
    let Job { plan, draw, compiled, .. } = *job;
    let rows = band.rows();
    if walk::windows(draw, rows).next().is_none() {
        return 0;
    }
    (kernels.begin)(compiled, block, band);
    let vacant = |_| TriangleContext::vacant(plan, draw, compiled.shader.is_none());
    // No more than the draw has triangles: most draws of sprites have two.
    let mut contexts: Vec<_> = (0..job.triangles.len().min(GROUP)).map(vacant).collect();
    let mut drawing = Drawing { kernels, job, band, block, shaded: 0 };
    for window in walk::windows(draw, rows) {
        for numbers in job.triangles.chunks(GROUP) {
            let corners = &mut drawing.block.boxes.corners;
            let entered = enter(&mut contexts, numbers, window, compiled.together, corners);
            for (at, entered) in entered[..numbers.len()].iter().enumerate() {
                drawing.triangle(at, *entered, &mut contexts);
            }
            drawing.boxes(&mut contexts);
        }
    }
    drawing.finish();
    drawing.shaded
}

/// What draws the triangles of a job on a band.
struct Drawing<'d, 'b> {
    kernels: &'d Kernels,
    job: &'d Job<'d>,
    band: &'d mut Band<'b>,
    block: &'d mut Block,
    /// Number of pixels that were covered.
    shaded: u64,
}

impl Drawing<'_, '_> {
    /// Draws a triangle of a context, or adds its boxes to those that are drawn later.
    fn triangle(&mut self, at: usize, entered: Entered, contexts: &mut [TriangleContext<'_>]) {
        let completes_quads = self.job.compiled.completes_quads;
        match entered {
            Entered::Nothing => return,
            Entered::Small(window) if !completes_quads => {
                for window in boxes(window) {
                    self.block.boxes.add(window, at);
                    if self.block.boxes.count == GROUP {
                        self.boxes(contexts);
                    }
                }
                return;
            }
            Entered::Small(_) | Entered::Large(_) => self.boxes(contexts),
        }
        let interpolators = self.interpolators(&mut contexts[at]);
        match entered {
            Entered::Nothing => {}
            Entered::Small(window) => self.boxes_of_quads(window, &interpolators),
            Entered::Large(window) if completes_quads => self.quads(window, &interpolators),
            Entered::Large(window) => self.rows(window, &interpolators),
        }
        self.give_back(interpolators);
    }

    /// Sets up a triangle completely.
    fn interpolators<'t>(&mut self, context: &'t mut TriangleContext<'_>) -> Interpolators<'t> {
        context.complete();
        Interpolators::new(context, self.job.compiled, std::mem::take(&mut self.block.planes))
    }

    fn give_back(&mut self, interpolators: Interpolators<'_>) {
        self.block.planes = interpolators.given_back(&mut self.block.defined);
    }

    /// Draws a triangle row by row.
    fn rows(&mut self, (rows, columns): Window, interpolators: &Interpolators<'_>) {
        let (kernels, job, context) = (self.kernels, self.job, interpolators.setup.context);
        for j in rows.0..rows.1 {
            let (mut i, end) = context.triangle.span(j, columns);
            if i == end {
                continue;
            }
            // Begins at a multiple of a step, so that no step of lanes crosses a cache line.
            self.block.used = whole_steps(self.block.used);
            let mut has_begun = false;
            while i < end {
                let wanted = ((end - i) as usize).min(BLOCK);
                if self.block.used == BLOCK || self.is_taken((i, j), wanted) {
                    self.finish();
                }
                let (band, block) = (&mut *self.band, &mut *self.block);
                let count = wanted.min(BLOCK - block.used);
                let (pixel, lane, all) = ((i, j), block.used, Covered(0, count));
                let is_visible = job.draw.depth_test.is_none()
                    || (kernels.row_depths)(pixel, count, lane, context, job, block, band);
                if is_visible {
                    // Quotients by steps go on from the batch before, if there is one.
                    if !has_begun {
                        (kernels.begin_row)(pixel, end - i, interpolators, job, block);
                    }
                    (kernels.row)(pixel, count, lane, all, interpolators, job, block);
                    if job.compiled.shader.is_some() {
                        (kernels.row_attributes)(pixel, count, lane, all, context, job, block);
                    }
                    block.append(band, pixel, count, job.compiled.reads_surface);
                }
                has_begun = is_visible;
                self.shaded += count as u64;
                i += count as i64;
            }
        }
    }

    /// Draws a triangle by two rows at a time, with all pixels of the quads that it meets.
    fn quads(&mut self, window: Window, interpolators: &Interpolators<'_>) {
        let (kernels, job, context) = (self.kernels, self.job, interpolators.setup.context);
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
                let is_taken = |n: usize| covered[n].1 > 0 && self.is_taken(at(n), covered[n].1);
                if 2 * lanes > BLOCK - self.block.used || is_taken(0) || is_taken(1) {
                    self.finish();
                }
                let (band, block) = (&mut *self.band, &mut *self.block);
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
                        let columns = if batch.reaches_beyond() { 0 } else { count as i64 };
                        (kernels.begin_row)(first, columns, interpolators, job, block);
                        (kernels.row)(first, count, lane, covered, interpolators, job, block);
                        (kernels.row_attributes)(first, count, lane, covered, context, job, block);
                    }
                    if !is_known {
                        block.workshop.leave_open(whole.lanes());
                    }
                    let Covered(first, count) = covered[n];
                    let (tests, lane) = (job.draw.depth_test.is_some(), whole.lane + first);
                    if count > 0 && (!tests || (kernels.row_depths)(at(n), count, lane, context, job, block, band)) {
                        block.used += first;
                        block.append(band, at(n), count, job.compiled.reads_surface);
                    }
                    block.used = whole.lanes().end;
                    self.shaded += count as u64;
                }
                block.workshop.quads.add(quads);
                low += columns;
            }
        }
    }

    /// Draws a small triangle with all pixels of the quads that it meets.
    fn boxes_of_quads(&mut self, (rows, columns): Window, interpolators: &Interpolators<'_>) {
        let all = ((rows.0 & !1, rows.1), (columns.0 & !1, columns.1));
        for ((top, end), (left, right)) in boxes(all) {
            self.box_of_quads(((top.max(rows.0), end), (left.max(columns.0), right)), interpolators);
        }
    }

    /// Draws the part of a small triangle in a box that begins at an even row and column, with all pixels of the quads that it meets.
    fn box_of_quads(&mut self, window: Window, interpolators: &Interpolators<'_>) {
        let context = interpolators.setup.context;
        self.block.boxes.coverage_mut().complete(&context.triangle, window, self.band.width as u32);
        let coverage = self.block.boxes.coverage();
        if coverage.count == 0 {
            return;
        }
        if !interpolators.setup.is_positive_around(&batch::<STEP>(coverage, 0)) {
            return self.quads(window, interpolators);
        }
        self.shaded += coverage.covered as u64;
        if self.begin_box(context) {
            (self.kernels.in_box)(interpolators, self.job, self.block);
            let block = &mut *self.block;
            let batch = batch::<STEP>(block.boxes.coverage(), block.used);
            for [one, other] in batch.runs.as_chunks::<2>().0 {
                let [upper, lower] = [one, other].map(|run| block.used + run.lane());
                let (pixel, count) = (batch.pixel(one.lane()), one.count() / 2);
                block.workshop.quads.add(PixelQuads { upper, lower, count, pixel, triangle: context.number });
            }
            self.append_box(context, false);
        }
    }

    /// Draws the block's boxes.
    fn boxes(&mut self, contexts: &mut [TriangleContext<'_>]) {
        let (kernels, compiled, boxes) = (self.kernels, self.job.compiled, &mut self.block.boxes);
        if boxes.count > 0 {
            (kernels.set_up)(contexts, compiled, self.band.width as u32, boxes);
            if boxes.has_more() {
                (kernels.set_up_more)(&contexts[0], compiled, boxes);
            }
        }
        let (mut next, count) = (0, std::mem::take(&mut boxes.count));
        while next < count {
            let all = &self.block.boxes.all[next..count];
            let at = all[0].1;
            let parts = all.iter().take_while(|(_, other)| *other == at).count();
            self.parts(next..next + parts, &mut contexts[at]);
            next += parts;
        }
    }

    /// Draws some of the block's boxes, which are parts of one triangle. Inlined as what it calls: boxes have few pixels.
    #[inline(always)]
    fn parts(&mut self, mut parts: Range<usize>, context: &mut TriangleContext<'_>) {
        // Nothing else is computed of triangles that the depth test drops.
        if !self.begin_part(&mut parts, context) {
            return;
        }
        let interpolators = self.interpolators(context);
        loop {
            (self.kernels.in_box)(&interpolators, self.job, self.block);
            self.append_box(interpolators.setup.context, false);
            if !self.begin_part(&mut parts, interpolators.setup.context) {
                break;
            }
        }
        self.give_back(interpolators);
    }

    /// Draws parts of a triangle up to the first one of which something is visible and not interpolated yet, which is begun. Returns whether there
    /// is one.
    #[inline(always)]
    fn begin_part(&mut self, parts: &mut Range<usize>, context: &TriangleContext<'_>) -> bool {
        let (kernels, job, compiled) = (self.kernels, self.job, self.job.compiled);
        for n in parts {
            self.block.boxes.current = n;
            let count = self.block.boxes.coverage().count;
            self.shaded += count as u64;
            if count == 0 || !self.begin_box(context) {
                continue;
            }
            let interpolate = if self.block.boxes.is_tied() { kernels.tied } else { kernels.plain };
            let proves = compiled.plain
                && interpolate(context, compiled, self.block)
                && (!self.block.boxes.has_more() || (kernels.more)(context, job, self.block));
            if !proves {
                return true;
            }
            self.append_box(context, true);
        }
        false
    }

    /// Computes the block if it has no room for the pixels of its coverage, adds and marks their runs, and computes their depths. Returns `false` if
    /// the depth test drops all of them, so that nothing else has to be computed; then there are no runs of them.
    #[inline(always)]
    fn begin_box(&mut self, context: &TriangleContext<'_>) -> bool {
        let (job, reads_surface) = (self.job, self.job.compiled.reads_surface);
        let has_room = self.block.boxes.coverage().count <= BLOCK - self.block.used;
        if !has_room || (reads_surface && self.block.is_box_taken(self.band)) {
            self.finish();
        }
        let (band, block) = (&mut *self.band, &mut *self.block);
        let (first, coverage) = (block.runs.len(), block.boxes.coverage());
        coverage.append((block.used, band.index(coverage.first)), &mut block.runs);
        let is_visible = job.draw.depth_test.is_none() || (self.kernels.box_depths)(first, context, job, block, band);
        if !is_visible {
            block.runs.truncate(first);
        } else if reads_surface {
            store::mark(&mut block.taken, &block.runs[first..]);
        }
        is_visible
    }

    /// Adds the pixels of the block's coverage, whose runs it has. `has_numbers` says whether it has the numbers of the texture shader, if it has one.
    #[inline(always)]
    fn append_box(&mut self, context: &TriangleContext<'_>, has_numbers: bool) {
        let reads_numbers_only = self.job.compiled.of_numbers().is_some();
        if self.job.compiled.shader.is_some() && !(has_numbers && reads_numbers_only) {
            (self.kernels.box_attributes)(context, self.job, self.block);
        }
        self.block.used += self.block.boxes.coverage().count;
    }

    /// Returns whether the draw reads the surface and the block has lanes for some of these pixels already.
    fn is_taken(&self, pixel: (i64, i64), count: usize) -> bool {
        self.job.compiled.reads_surface && self.block.is_taken(self.band, pixel, count)
    }

    /// Computes a block and stores it.
    fn finish(&mut self) {
        let (kernels, job, block) = (self.kernels, self.job, &mut *self.block);
        if block.used == 0 {
            return;
        }
        block.work.lanes = Lanes::first(block.used);
        if job.compiled.shader.is_some() {
            (kernels.shade)(job, block, self.band);
        } else {
            for n in 0..job.compiled.samplers.len() {
                (kernels.sample)(job, n, &mut block.varying, &mut block.work, &mut block.rows);
            }
        }
        (kernels.flush)(job, block, self.band);
    }
}
