//! From triangles to batches of pixels, from batches to blocks, and from blocks to the surface.

use super::boxes::{BoxCoverage, SIDE, boxes, is_box, is_small};
use super::depth::depths;
use super::fetch::{self, Workspace};
use super::isa::Kernels;
use super::kernels::{self, LANES, Lanes256};
use super::levels::MipFetches;
use super::quotient::{IOTA, Positions, SMALL_BATCH};
use super::setup::{PixelBatch, Planes, Run, whole_steps};
use super::stages::{self, Workshop};
use super::taps::Footprints;
use super::triangle::{Interpolators, Varying};
use super::{BLOCK, CompiledDraw, Job, Reason, Reasons, small, store};
use crate::engine::pixel::TriangleContext;
use crate::engine::walk::{self, Band, Window};
use crate::raster::setup::Triangle;
use crate::state::MipFilter;

/// The buffers of a thread. They are kept from draw to draw.
#[derive(Debug)]
pub(crate) struct Block {
    pub(super) rows: Vec<Lanes256>,
    pub(super) varying: Varying,
    pub(super) work: Workspace,
    pub(super) workshop: Workshop,
    coverage: BoxCoverage,
    planes: Vec<Planes>,
    pub(super) runs: Vec<Run>,
    /// Number of lanes in use.
    used: usize,
    /// A bit for each pixel of the band, set if the block has a lane for the pixel. Maintained only if the draw reads the surface.
    taken: Vec<u64>,
    words: [u32; LANES],
    stored: [u32; LANES],
    depth: [u32; BLOCK],
    alive: [bool; BLOCK],
    /// Number of pixels, by reason, of which the definition computed something.
    pub(crate) defined: Reasons,
}

impl Default for Block {
    fn default() -> Self {
        Block {
            rows: Vec::new(),
            varying: Varying::default(),
            work: Workspace::default(),
            workshop: Workshop::default(),
            coverage: BoxCoverage::default(),
            planes: Vec::new(),
            runs: Vec::with_capacity(BLOCK),
            used: 0,
            taken: Vec::new(),
            words: [0; LANES],
            stored: [0; LANES],
            depth: [0; BLOCK],
            alive: [true; BLOCK],
            defined: Reasons::default(),
        }
    }
}

/// Draws the part of a draw that lies in a band. Returns the number of covered pixels.
#[inline(always)]
pub(super) fn run<T: Kernels>(job: Job<'_>, band: &mut Band<'_>, block: &mut Block) -> u64 {
    let Job { plan, draw, compiled, .. } = job;
    let mut shaded = 0;
    if walk::windows(draw, band.rows()).next().is_none() {
        return shaded;
    }
    block.rows.resize(compiled.rows.len(), Lanes256::from_value(0));
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
    let mut context = TriangleContext::vacant(plan, draw);
    for window in walk::windows(draw, band.rows()) {
        shaded += draw_window::<T>(job, window, &mut context, band, block);
    }
    finish::<T>(job, block, band);
    shaded
}

/// Draws the part of a draw that lies in some rows and columns of a band. Returns the number of covered pixels.
#[inline(always)]
fn draw_window<T: Kernels>(
    job: Job<'_>,
    (rows, columns): Window,
    context: &mut TriangleContext<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let Job { draw, compiled, .. } = job;
    let mut shaded = 0;
    let count = job.triangles.map_or(draw.assembly.triangles.len(), <[u32]>::len);
    for n in 0..count {
        let number = job.triangles.map_or(n, |numbers| numbers[n] as usize);
        match T::enter(context, number, (rows, columns), &mut block.coverage) {
            Entered::Nothing => {}
            Entered::Box => shaded += draw_box::<T>(job, context, band, block),
            Entered::Boxes => {
                for window in boxes(common(&context.triangle, (rows, columns))) {
                    T::cover(&context.triangle, window, &mut block.coverage);
                    if block.coverage.count > 0 {
                        shaded += draw_box::<T>(job, context, band, block);
                    }
                }
            }
            Entered::Large => {
                context.complete();
                let triangle = &context.triangle;
                let (rows, columns) = common(triangle, (rows, columns));
                let interpolators = Interpolators::new(context, compiled, std::mem::take(&mut block.planes));
                for j in rows.0..rows.1 {
                    let (mut i, end) = triangle.span(j, columns);
                    if i == end {
                        continue;
                    }
                    // Begins at a multiple of a step, so that no step of lanes crosses a cache line.
                    block.used = whole_steps(block.used);
                    interpolators.begin_row((i, j), end - i, compiled, &mut block.varying);
                    while i < end {
                        let wanted = ((end - i) as usize).min(BLOCK);
                        if block.used == BLOCK || (compiled.reads_surface && block.is_taken(band, (i, j), wanted)) {
                            finish::<T>(job, block, band);
                        }
                        let count = wanted.min(BLOCK - block.used);
                        let lanes = whole_steps(count);
                        let last = count as i32 - 1;
                        let at = Positions { x: &IOTA[..lanes], y: &ZEROS[..lanes], last };
                        // By reference, because a copy of what has just been written in parts has to wait for all of them.
                        let batch =
                            &PixelBatch { first: (i, j), at, count, lane: block.used, extent: (last, 0), runs: &[] };
                        T::row(&interpolators, batch, job, block);
                        if compiled.shader.is_some() {
                            T::row_attributes(context, batch, job, block);
                        }
                        if job.draw.depth_test.is_some() {
                            T::row_depths(context, batch, block);
                        }
                        block.append(band, (i, j), count, compiled.reads_surface);
                        shaded += count as u64;
                        i += count as i64;
                    }
                }
                block.planes = interpolators.given_back(&mut block.defined);
            }
        }
    }
    shaded
}

/// Computes a block and stores it.
#[inline(always)]
fn finish<T: Kernels>(job: Job<'_>, block: &mut Block, band: &mut Band<'_>) {
    if job.compiled.shader.is_some() && block.used > 0 {
        T::shade(job, block, band);
    }
    T::flush(job, block, band);
}

/// Draws the pixels of the block's coverage, of which there is at least one. Returns their number.
#[inline(always)]
fn draw_box<T: Kernels>(
    job: Job<'_>,
    context: &mut TriangleContext<'_>,
    band: &mut Band<'_>,
    block: &mut Block,
) -> u64 {
    let compiled = job.compiled;
    let count = block.coverage.count;
    if count > BLOCK - block.used || (compiled.reads_surface && block.is_box_taken(band)) {
        finish::<T>(job, block, band);
    }
    if !(compiled.plain && T::plain(context, compiled, block)) {
        context.complete();
        T::coverage(context, job, block);
    }
    if compiled.shader.is_some() {
        T::box_attributes(context, job, block);
    }
    if job.draw.depth_test.is_some() {
        T::box_depths(context, block);
    }
    for n in 0..block.coverage.filled {
        let (j, i, count) = block.coverage.runs[n];
        block.append(band, (i, j), count, compiled.reads_surface);
    }
    count as u64
}

/// How a triangle is drawn.
#[derive(Clone, Copy, Debug, Default)]
pub(super) enum Entered {
    #[default]
    Nothing,
    /// As one box: the pixels of the coverage.
    Box,
    /// As several boxes.
    Boxes,
    /// Row by row.
    Large,
}

/// Returns the rows and columns that a window shares with the triangle's bounding box.
#[inline(always)]
pub(super) fn common(triangle: &Triangle, (rows, columns): Window) -> Window {
    (
        (triangle.rows.0.max(rows.0), triangle.rows.1.min(rows.1)),
        (triangle.columns.0.max(columns.0), triangle.columns.1.min(columns.1)),
    )
}

/// Sets up a triangle for the given rows and columns, and finds its coverage if it is a single box.
#[inline(always)]
pub(super) fn enter<const WIDE: bool>(
    context: &mut TriangleContext<'_>,
    number: usize,
    window: Window,
    coverage: &mut BoxCoverage,
) -> Entered {
    if !context.set_up(number, window.0) {
        return Entered::Nothing;
    }
    let triangle = &context.triangle;
    if !is_small(triangle) {
        return Entered::Large;
    }
    let window = common(triangle, window);
    let (rows, columns) = window;
    if rows.0 >= rows.1 || columns.0 >= columns.1 {
        return Entered::Nothing;
    }
    if !is_box(window) {
        return Entered::Boxes;
    }
    coverage.cover(triangle, window);
    if coverage.count > 0 { Entered::Box } else { Entered::Nothing }
}

/// Finds the covered pixels of one box of a triangle that is cut into boxes.
#[inline(always)]
pub(super) fn cover<const WIDE: bool>(triangle: &Triangle, window: Window, coverage: &mut BoxCoverage) {
    coverage.cover(triangle, window);
}

/// Interpolates all attributes of the small triangle in the block's box, for a plain draw. Returns `false` if an attribute could not be
/// estimated; then nothing that was written counts.
#[inline(always)]
pub(super) fn plain<const FMA: bool>(
    context: &mut TriangleContext<'_>,
    compiled: &CompiledDraw,
    block: &mut Block,
) -> bool {
    let Block { varying, rows, coverage, used, planes, .. } = block;
    small::interpolate::<FMA>(context, compiled, few(coverage, *used), varying, rows, planes)
}

/// Interpolates all attributes in the block's box, for any draw.
#[inline(always)]
pub(super) fn coverage<const FMA: bool>(context: &TriangleContext<'_>, job: Job<'_>, block: &mut Block) {
    let Block { varying, rows, coverage, used, planes, defined, .. } = block;
    let interpolators = Interpolators::new(context, job.compiled, std::mem::take(planes));
    interpolators.interpolate::<FMA, false>(batch(coverage, *used), job.compiled, job.textures, varying, rows);
    *planes = interpolators.given_back(defined);
}

/// Returns the pixels of a box as a batch.
#[inline(always)]
pub(super) fn batch(coverage: &BoxCoverage, lane: usize) -> PixelBatch<'_> {
    let lanes = whole_steps(coverage.count);
    let at = Positions { x: &coverage.x[..lanes], y: &coverage.y[..lanes], last: i32::MAX };
    let (first, count, runs) = (coverage.first, coverage.count, &coverage.runs[..coverage.filled]);
    PixelBatch { first, at, count, lane, extent: (SIDE as i32, SIDE as i32), runs }
}

/// Returns the pixels of a box as a batch, with fewer lanes than a step if those suffice.
#[inline(always)]
pub(super) fn few(coverage: &BoxCoverage, lane: usize) -> PixelBatch<'_> {
    let all = batch(coverage, lane);
    let Positions { x, y, last } = all.at;
    if all.count <= SMALL_BATCH {
        PixelBatch { at: Positions { x: &x[..SMALL_BATCH], y: &y[..SMALL_BATCH], last }, ..all }
    } else {
        all
    }
}

/// Interpolates all attributes along a batch of a row.
#[inline(always)]
pub(super) fn row<const FMA: bool>(
    interpolators: &Interpolators<'_>,
    batch: &PixelBatch<'_>,
    job: Job<'_>,
    block: &mut Block,
) {
    let Block { varying, rows, .. } = block;
    interpolators.interpolate::<FMA, true>(*batch, job.compiled, job.textures, varying, rows);
}

/// Interpolates the inputs of the texture shader along a batch of a row.
#[inline(always)]
pub(super) fn row_attributes<const FMA: bool>(
    context: &TriangleContext<'_>,
    batch: &PixelBatch<'_>,
    job: Job<'_>,
    block: &mut Block,
) {
    if let Some(shader) = &job.compiled.shader {
        block.workshop.attributes::<FMA, true>(context, *batch, shader);
    }
}

/// Interpolates the inputs of the texture shader in the block's box.
#[inline(always)]
pub(super) fn box_attributes<const FMA: bool>(context: &TriangleContext<'_>, job: Job<'_>, block: &mut Block) {
    if let Some(shader) = &job.compiled.shader {
        block.workshop.attributes::<FMA, false>(context, few(&block.coverage, block.used), shader);
    }
}

/// Computes the depths along a batch of a row.
#[inline(always)]
pub(super) fn row_depths<const FMA: bool>(context: &TriangleContext<'_>, batch: &PixelBatch<'_>, block: &mut Block) {
    depths::<FMA, true>(context, *batch, block.varying.depths());
}

/// Computes the depths in the block's box.
#[inline(always)]
pub(super) fn box_depths<const FMA: bool>(context: &TriangleContext<'_>, block: &mut Block) {
    depths::<FMA, false>(context, few(&block.coverage, block.used), block.varying.depths());
}

/// Runs the stages of the texture shader for a block.
#[inline(always)]
pub(super) fn shade<const FMA: bool>(job: Job<'_>, block: &mut Block, band: &mut Band<'_>) {
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
            mark(&mut self.taken, at, count);
        }
    }

    /// Returns whether the block has lanes for some of these pixels already.
    #[inline(always)]
    fn is_taken(&self, band: &Band<'_>, pixel: (i64, i64), count: usize) -> bool {
        let at = index(band, pixel);
        (at / 64..=(at + count - 1) / 64).any(|word| self.taken[word] & bits(word, at, count) != 0)
    }

    #[inline(always)]
    fn is_box_taken(&self, band: &Band<'_>) -> bool {
        let runs = &self.coverage.runs[..self.coverage.filled];
        runs.iter().any(|(j, i, count)| self.is_taken(band, (*i, *j), *count))
    }
}

/// Returns the index of a pixel in a band.
#[inline(always)]
fn index(band: &Band<'_>, (i, j): (i64, i64)) -> usize {
    (j as usize - band.first_row) * band.width + i as usize
}

/// Returns the bits of a 64-bit word that belong to the given pixels, at least one of which lies in the word.
#[inline(always)]
fn bits(word: usize, at: usize, count: usize) -> u64 {
    let (first, last) = (word * 64, word * 64 + 63);
    let low = if at > first { u64::MAX << (at - first) } else { u64::MAX };
    let end = at + count - 1;
    if end < last { low & (u64::MAX >> (last - end)) } else { low }
}

/// Flips the bits of the given pixels.
#[inline(always)]
fn mark(taken: &mut [u64], at: usize, count: usize) {
    for word in at / 64..=(at + count - 1) / 64 {
        taken[word] ^= bits(word, at, count);
    }
}

/// Number of pixels that are copied at once if a run is shorter and the slices have room.
const SHORT_RUN: usize = 16;

/// From this average length of runs on, words of the surface and its depth buffer are worked on in place instead of being copied.
const LONG_RUN: usize = 48;

/// Copies a run from one slice to another. Most runs are short and are copied without a call. With `MASKS`, lanes can be stored one by one,
/// so that pixels around the run need not be read; reading them would have to wait for earlier stores.
#[inline(always)]
fn copy<const MASKS: bool>(from: &[u32], to: &mut [u32], count: usize) {
    if count <= SHORT_RUN
        && let (Some(from), Some(to)) = (from.first_chunk::<SHORT_RUN>(), to.first_chunk_mut::<SHORT_RUN>())
    {
        for n in 0..SHORT_RUN {
            if MASKS {
                if n < count {
                    to[n] = from[n];
                }
            } else {
                to[n] = if n < count { from[n] } else { to[n] };
            }
        }
    } else {
        to[..count].copy_from_slice(&from[..count]);
    }
}

/// Computes and stores a block whose texture shader stages have run.
#[inline(always)]
pub(super) fn flush<const MASKS: bool>(job: Job<'_>, block: &mut Block, band: &mut Band<'_>) {
    let Job { draw, compiled, .. } = job;
    let Block { rows, varying, work, runs, used, taken, words, stored, depth, alive, .. } = block;
    if *used == 0 {
        return;
    }
    let (Some(words), Some(stored)) = (words.first_chunk_mut::<BLOCK>(), stored.first_chunk_mut::<BLOCK>()) else {
        return;
    };
    if compiled.drops {
        *alive = *varying.alive.first_chunk().unwrap_or(&[true; BLOCK]);
    }
    // The sampler whose entries are in `work`, and the pitch of its table. Samplers that share coordinates also have the same axes.
    let mut found = None;
    let samplers = if compiled.shader.is_some() { &[] } else { &compiled.samplers[..] };
    for (n, sampler) in samplers.iter().enumerate() {
        let Some(table) = &sampler.table else { continue };
        let faces = sampler.has_images().then_some(&varying.faces[n]);
        let wanted = compiled.textures[sampler.unit];
        let at = sampler.shares.unwrap_or(n);
        if let (true, Some(reads)) = (sampler.mixes, varying.reads.get(at)) {
            let both = draw.units[sampler.index].state.mip_filter == MipFilter::Linear;
            fetch::sample_levels(job.vectors, table, reads, both, sampler.signed, wanted, work, rows);
            // The entries in `work` have been overwritten.
            found = None;
            continue;
        }
        if let (1.., Some(footprints)) = (sampler.pairs, varying.footprints.get(n)) {
            let at = &varying.coordinates[n];
            fetch::sample_taps(job.vectors, table, at, &footprints.pairs, sampler.signed, wanted, work, rows);
            found = None;
            continue;
        }
        if found != Some((at, table.pitch)) {
            fetch::locate(table, &mut varying.coordinates[at], faces, work);
        }
        found = Some((at, table.pitch));
        let references = &varying.references[n];
        fetch::sample(job.vectors, table, &varying.coordinates[at], references, sampler.signed, wanted, work, rows);
        if let Some(key) = sampler.key {
            fetch::drop_keyed(key, work, alive);
        }
    }
    let blends = compiled.destination.iter().any(Option::is_some);
    if blends {
        read::<MASKS>(band.words, runs, stored);
        store::read(draw, compiled, stored, rows);
    }
    if compiled.reads_surface {
        for run in runs.iter() {
            mark(taken, run.at, run.count);
        }
    }
    for (node, at) in &compiled.operations {
        kernels::run(node, *at, rows);
    }
    let is_long = runs.len() * LONG_RUN <= *used;
    if compiled.drops {
        if let Some(test) = &draw.alpha_test {
            let (alpha, reference) = (rows[usize::from(compiled.alpha)].block(), i16::from(test.reference));
            store::test(test.function, |n| alpha[n].clamp(0, 255), |_| reference, alive);
        }
        let incoming = varying.depth.first_chunk().unwrap_or(&[0; BLOCK]);
        if draw.stencil_test.is_none() && draw.depth_test.is_some() && is_long {
            for Run { lane, at, count } in runs.iter().copied() {
                let (memory, alive) = (&mut band.depth[at..][..count], &mut alive[lane..][..count]);
                store::test_depths(draw, &incoming[lane..][..count], memory, alive);
            }
        } else if draw.stencil_test.is_some() || draw.depth_test.is_some() {
            if let Some(depth) = depth.first_chunk_mut() {
                read::<MASKS>(band.depth, runs, depth);
            }
            if store::test_depth_stencil(draw, incoming, depth, alive) {
                for run in runs.iter() {
                    copy::<MASKS>(&depth[run.lane..], &mut band.depth[run.at..], run.count);
                }
            }
        }
    }
    // Most blocks lose no fragment.
    let merges = compiled.merges && !(compiled.writes_whole && all(&alive[..*used]));
    if !merges && is_long {
        for run in runs.iter() {
            store::pack(draw, compiled, rows, run.lane, &mut band.words[run.at..][..run.count]);
        }
    } else {
        store::pack(draw, compiled, rows, 0, words);
        if merges {
            if !blends {
                read::<MASKS>(band.words, runs, stored);
            }
            store::merge(draw.write_mask, alive, stored, words);
        }
        for run in runs.iter() {
            copy::<MASKS>(&words[run.lane..], &mut band.words[run.at..], run.count);
        }
    }
    runs.clear();
    *used = 0;
}

/// Reads the words of some runs from the surface or its depth buffer.
#[inline(always)]
fn read<const MASKS: bool>(words: &[u32], runs: &[Run], out: &mut [u32; BLOCK]) {
    for run in runs {
        copy::<MASKS>(&words[run.at..], &mut out[run.lane..], run.count);
    }
}

/// Returns whether all lanes are true. It has no branches, because they usually are.
#[inline(always)]
fn all(alive: &[bool]) -> bool {
    alive.iter().fold(true, |all, alive| all & alive)
}

static ZEROS: [i32; kernels::LANES] = [0; kernels::LANES];
