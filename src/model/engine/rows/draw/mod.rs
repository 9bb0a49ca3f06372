//! From triangles to lanes, and from lanes to blocks.
//!
//! ```text
//! for each triangle that may cover pixels of the band:
//!     for each row, or each pair of rows where quads are taken:
//!         the covered columns become lanes of the block, after those of the row above
//!         if the block is full:  interpolate the triangle's lanes, finish the block
//!     interpolate the triangle's lanes
//! finish the block:  sample or shade, combine, store
//! ```

mod block;
mod compile;
mod isa;
mod triangle;

pub(crate) use block::Block;
pub(crate) use compile::Rows;
pub use isa::Isa;
pub(crate) use isa::Kernels;

use crate::engine::context::TriangleContext;
use crate::engine::rows::geometry::shape::Shape;
use crate::engine::rows::geometry::spans::ROWS;
use crate::engine::rows::lanes::{BLOCK, Lanes, Run};
use crate::engine::rows::sampling::fetch::Reader;
use crate::engine::rows::sampling::quads::PixelQuads;
use crate::engine::rows::shading::compiled::CompiledDraw;
use crate::engine::rows::store;
use crate::engine::walk::{self, Band, Window};
use crate::plan::{Plan, PlannedDraw};
use crate::raster::stroke::{self, Figure};
use crate::state::PolygonStipple;

/// The parts of a draw that are the same for all of its blocks, for the parts of the engine that are compiled for each instruction set.
#[derive(Clone, Copy)]
pub(crate) struct Job<'a> {
    plan: &'a Plan,
    draw: &'a PlannedDraw,
    compiled: &'a CompiledDraw,
    kernels: &'a Kernels,
}

/// Draws the part of a draw that lies in a band, of which triangles are given that may cover pixels, in order. Returns the number of covered pixels.
pub(crate) fn run(
    kernels: &Kernels,
    (plan, draw, compiled): (&Plan, &PlannedDraw, &CompiledDraw),
    triangles: &[u32],
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let (rows, job) = (band.rows(), &Job { plan, draw, compiled, kernels });
    (kernels.begin)(compiled, block, band);
    let mut context = TriangleContext::vacant(plan, draw);
    let mut drawing =
        Drawing { job, band, block, shaded: 0, stipple: None, shape: None, is_set_up: false, own: [0; 3] };
    for window in walk::windows(draw, rows) {
        for number in triangles {
            if context.place(*number as usize) {
                drawing.triangle(window, &context);
            }
        }
    }
    drawing.finish();
    drawing.shaded
}

/// What draws the triangles of a job on a band, one after the other.
struct Drawing<'d, 'b> {
    job: &'d Job<'d>,
    band: &'d mut Band<'b>,
    block: &'d mut Block,
    /// Number of pixels that were covered.
    shaded: u64,
    /// The pattern of the triangle, if it has one.
    stipple: Option<&'d PolygonStipple>,
    /// Its geometry, once that is needed, and whether its functions are set up.
    shape: Option<Shape>,
    is_set_up: bool,
    /// The first lane, run and entry of quads that belong to it.
    own: [usize; 3],
}

impl Drawing<'_, '_> {
    /// Draws a triangle.
    fn triangle(&mut self, window: Window, context: &TriangleContext<'_>) {
        let (triangle, draw) = (&context.triangle, self.job.draw);
        let takes_quads = self.job.compiled.takes_quads;
        self.stipple = draw.polygon_stipple.as_ref().filter(|_| triangle.figure == Figure::Triangle);
        let within = |of: (i64, i64), limits: (i64, i64)| (of.0.max(limits.0), of.1.min(limits.1));
        let (rows, columns) = (within(triangle.rows, window.0), within(triangle.columns, window.1));
        if rows.0 >= rows.1 || columns.0 >= columns.1 {
            return;
        }
        (self.shape, self.is_set_up) = (None, false);
        self.own = [self.block.used, self.block.runs.len(), self.block.quads.len()];
        // Even, so that no quad is divided.
        for top in (rows.0 & !1..rows.1).step_by(ROWS) {
            let spans = (self.job.kernels.find_spans)(triangle, top, columns);
            let count = (rows.1 - top).min(ROWS as i64) as usize;
            let span = |n: usize| {
                let is_drawn = n < count && top + n as i64 >= rows.0;
                if is_drawn { (i64::from(spans.first[n]), i64::from(spans.end[n])) } else { (0, 0) }
            };
            if takes_quads {
                for n in (0..count).step_by(2) {
                    self.pair(top + n as i64, [span(n), span(n + 1)], context);
                }
            } else {
                for n in 0..count {
                    self.row(top + n as i64, span(n), context);
                }
            }
        }
        self.close(context);
    }

    /// Adds the covered pixels of a row.
    #[inline(always)]
    fn row(&mut self, j: i64, (mut i, end): (i64, i64), context: &TriangleContext<'_>) {
        while i < end {
            let count = ((end - i) as usize).min(BLOCK);
            if self.block.used == BLOCK || self.is_taken((i, j), count) {
                self.finish_within(context);
            }
            let count = count.min(BLOCK - self.block.used);
            let lane = self.block.used;
            self.block.add(self.job.compiled, (i, j), count);
            self.cover((i, j), lane, count);
            i += count as i64;
        }
    }

    /// Adds all pixels of the quads that a triangle meets in two rows.
    fn pair(&mut self, top: i64, spans: [(i64, i64); 2], context: &TriangleContext<'_>) {
        let (mut low, mut high) = (i64::MAX, i64::MIN);
        for (first, end) in spans.into_iter().filter(|(first, end)| first < end) {
            (low, high) = (low.min(first & !1), high.max((end + 1) & !1));
        }
        while low < high {
            // Two rows fill a block at most.
            let columns = (high - low).min(BLOCK as i64 / 2);
            let covered = spans.map(|(first, end)| (first.max(low), end.min(low + columns)));
            let count = |n: usize| (covered[n].1 - covered[n].0).max(0) as usize;
            let at = |n: usize| (covered[n].0, top + n as i64);
            // The spans of a sliver lie far apart.
            if count(0) + count(1) == 0 {
                low += columns;
                continue;
            }
            let is_taken = |n: usize| count(n) > 0 && self.is_taken(at(n), count(n));
            if 2 * columns as usize > BLOCK - self.block.used || is_taken(0) || is_taken(1) {
                self.finish_within(context);
            }
            let (upper, lower) = (self.block.used, self.block.used + columns as usize);
            self.block.quads.add(PixelQuads { upper, lower, count: columns as usize / 2 });
            for (n, first) in [upper, lower].into_iter().enumerate() {
                self.block.add(self.job.compiled, (low, top + n as i64), columns as usize);
                if count(n) > 0 {
                    self.cover(at(n), first + (covered[n].0 - low) as usize, count(n));
                }
            }
            low += columns;
        }
    }

    /// Notes that lanes have pixels that the triangle covers. Those that a pattern leaves out (STP-1) stay without a pixel.
    #[inline(always)]
    fn cover(&mut self, (i, j): (i64, i64), lane: usize, count: usize) {
        let Some(stipple) = self.stipple else { return self.run((i, j), lane, count) };
        let is_drawn = |n: &usize| stroke::stipples(stipple, i + *n as i64, j);
        let mut first = 0;
        while let Some(start) = (first..count).find(is_drawn) {
            let end = (start..count).find(|n| !is_drawn(n)).unwrap_or(count);
            self.run((i + start as i64, j), lane + start, end - start);
            first = end;
        }
    }

    #[inline(always)]
    fn run(&mut self, pixel: (i64, i64), lane: usize, count: usize) {
        let run = Run::new(lane, self.band.index(pixel), count);
        self.block.runs.push(run);
        if self.job.compiled.reads_surface {
            store::mark(&mut self.block.taken, &[run]);
        }
        self.shaded += count as u64;
    }

    /// Computes what a triangle's lanes in the block read, unless the pattern or the depth test takes all of them out.
    fn close(&mut self, context: &TriangleContext<'_>) {
        let (job, block, [lane, run, quads]) = (self.job, &mut *self.block, self.own);
        if block.used > lane && block.runs.len() > run && job.compiled.interpolates {
            let shape = self.shape.get_or_insert_with(|| {
                let w = context.corners().map(|corner| corner.w);
                Shape::new(&context.triangle, w, (job.draw.perspective, job.plan.profile), job.compiled.takes_quads)
            });
            if job.draw.depth_test.is_some() {
                (job.kernels.test_depths)(context, shape, job, block, (lane, run), self.band);
            }
            if block.runs.len() > run {
                if !std::mem::replace(&mut self.is_set_up, true) {
                    (job.kernels.set_up)(context, shape, job, block);
                }
                (job.kernels.interpolate)(context, shape, job, block, (lane, run));
            }
        }
        if block.runs.len() == run {
            (block.used, _) = (lane, block.quads.truncate(quads));
        }
    }

    /// Finishes the block although more pixels of a triangle follow.
    fn finish_within(&mut self, context: &TriangleContext<'_>) {
        self.close(context);
        self.finish();
        self.own = [0; 3];
    }

    /// Returns whether the draw reads the surface and the block has lanes for some of these pixels already.
    #[inline(always)]
    fn is_taken(&self, pixel: (i64, i64), count: usize) -> bool {
        self.job.compiled.reads_surface && store::is_marked(&self.block.taken, self.band.index(pixel) as usize, count)
    }

    /// Computes a block and stores it.
    fn finish(&mut self) {
        let (job, block) = (self.job, &mut *self.block);
        if block.used == 0 {
            return;
        }
        block.work.lanes = Lanes::first(block.used);
        if job.compiled.shader.is_some() {
            (job.kernels.shade)(job, block);
        } else {
            for (n, sampler) in job.compiled.samplers.iter().enumerate() {
                let unit = &job.draw.units[sampler.index];
                let wanted = job.compiled.textures[sampler.unit];
                let reader = Reader { filter: job.kernels.filter, unit, sampler, wanted };
                let Block { pixels, places, quads, work, sampled, rows, .. } = block;
                (job.kernels.sample)(
                    reader,
                    pixels,
                    &mut places[sampler.shares.unwrap_or(n)],
                    quads,
                    work,
                    sampled,
                    rows,
                );
            }
        }
        (job.kernels.flush)(job, block, self.band);
        block.quads.truncate(0);
    }
}
