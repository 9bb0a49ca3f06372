//! Triangles to pieces, pieces to blocks, blocks to the surface.

use super::fetch::{self, Workspace};
use super::kernels::{self, Row};
use super::quotient::{IOTA, Positions};
use super::triangle::{Piece, Setup, Varying, whole_steps};
use super::{BLOCK, Compiled, store};
use crate::engine::pixel::TriangleContext;
use crate::engine::walk::{self, Band};
use crate::plan::{Plan, PlannedDraw};
use crate::raster::setup::Triangle;
use crate::texture::unit::Image;

/// Some lanes of a block that lie side by side on the surface.
#[derive(Clone, Copy, Debug)]
struct Run {
    /// First lane.
    lane: usize,
    /// Index of the first pixel in the band.
    at: usize,
    count: usize,
}

/// What a thread works in.
struct Block {
    rows: Vec<Row>,
    varying: Varying,
    work: Workspace,
    runs: Vec<Run>,
    /// Lanes in use.
    used: usize,
    words: [u32; BLOCK],
    stored: [u32; BLOCK],
    depth: [u32; BLOCK],
    alive: [bool; BLOCK],
}

/// Everything of a draw that is the same for all of its blocks.
#[derive(Clone, Copy)]
pub(crate) struct Job<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) draw: &'a PlannedDraw,
    pub(crate) compiled: &'a Compiled,
    pub(crate) textures: &'a [Image<'a, i32>],
}

/// Draws what of a draw falls into a band; covered pixels.
#[inline(always)]
pub(super) fn run<const FMA: bool>(job: Job<'_>, band: &mut Band<'_>) -> u64 {
    let Job { plan, draw, compiled, textures } = job;
    let mut shaded = 0;
    if draw.folded.invisible.is_some() {
        return shaded;
    }
    let (rows, columns) = walk::window(draw, band.rows());
    if rows.0 >= rows.1 || columns.0 >= columns.1 {
        return shaded;
    }
    let mut block = Block {
        rows: compiled.rows.clone(),
        varying: Varying::default(),
        work: Workspace::default(),
        runs: Vec::with_capacity(BLOCK),
        used: 0,
        words: [0; BLOCK],
        stored: [0; BLOCK],
        depth: [0; BLOCK],
        alive: [true; BLOCK],
    };
    let mut planes = Vec::new();
    for number in 0..draw.assembly.triangles.len() {
        let Some(context) = TriangleContext::new(plan, draw, number, rows) else { continue };
        let setup = Setup::new(context, compiled, planes);
        let triangle = &setup.context.triangle;
        let rows = (triangle.rows.0.max(rows.0), triangle.rows.1.min(rows.1));
        if is_small(triangle) {
            let patch = Patch::of(triangle, rows, columns);
            if patch.count > BLOCK - block.used {
                flush(job, &mut block, band);
            }
            if patch.count > 0 {
                let lanes = whole_steps(patch.count);
                let at = Positions { x: &patch.x[..lanes], y: &patch.y[..lanes], last: i32::MAX };
                let (first, count) = (patch.first, patch.count);
                let piece = Piece { first, at, count, lane: block.used, extent: (SIDE as i32, SIDE as i32) };
                setup.interpolate::<FMA, false>(piece, compiled, textures, &mut block.varying, &mut block.rows);
                for (j, i, count) in &patch.runs[..patch.filled] {
                    block.append(band, (*i, *j), *count);
                }
                shaded += count as u64;
            }
        } else {
            for j in rows.0..rows.1 {
                let (mut i, end) = triangle.span(j, columns);
                // Where rows of lanes begin, so that no step lies across two cache lines.
                block.used = whole_steps(block.used);
                while i < end {
                    if block.used == BLOCK {
                        flush(job, &mut block, band);
                    }
                    let count = ((end - i) as usize).min(BLOCK - block.used);
                    let lanes = whole_steps(count);
                    let last = count as i32 - 1;
                    let at = Positions { x: &IOTA[..lanes], y: &ZEROS[..lanes], last };
                    let piece = Piece { first: (i, j), at, count, lane: block.used, extent: (last, 0) };
                    setup.interpolate::<FMA, true>(piece, compiled, textures, &mut block.varying, &mut block.rows);
                    block.append(band, (i, j), count);
                    shaded += count as u64;
                    i += count as i64;
                }
            }
        }
        // The next triangle may cover the same pixels.
        if compiled.reads_surface {
            flush(job, &mut block, band);
        }
        planes = setup.given_back();
    }
    flush(job, &mut block, band);
    shaded
}

/// Most columns and rows of the box of a small triangle. It covers half of the box and its diagonal: a block holds it.
pub(super) const SIDE: i64 = 12;

/// Whether a triangle is handled as one piece instead of row by row.
#[inline(always)]
pub(super) fn is_small(triangle: &Triangle) -> bool {
    triangle.rows.1 - triangle.rows.0 <= SIDE && triangle.columns.1 - triangle.columns.0 <= SIDE
}

/// The pixels of a small triangle.
pub(super) struct Patch {
    /// Column and row of the first pixel.
    pub(super) first: (i64, i64),
    /// Where the others lie from it; past the end the last one again.
    pub(super) x: [i32; kernels::LANES],
    pub(super) y: [i32; kernels::LANES],
    pub(super) count: usize,
    /// Row, first column and number of the pixels of each row.
    runs: [(i64, i64, usize); SIDE as usize],
    filled: usize,
}

impl Patch {
    /// RAS-3 for a box of pixels, a row at a time. Edge functions of small triangles fit in 32 bits.
    #[inline(always)]
    pub(super) fn of(triangle: &Triangle, rows: (i64, i64), columns: (i64, i64)) -> Patch {
        let mut patch = Patch {
            first: (0, 0),
            x: [0; kernels::LANES],
            y: [0; kernels::LANES],
            count: 0,
            runs: [(0, 0, 0); SIDE as usize],
            filled: 0,
        };
        let left = triangle.columns.0;
        let a = [triangle.a[0] as i32, triangle.a[1] as i32, triangle.a[2] as i32];
        let window = |bit: i64| columns.0 <= left + bit && left + bit < columns.1;
        let visible = (0..SIDE).filter(|bit| window(*bit)).fold(0_u32, |mask, bit| mask | 1 << bit);
        for j in rows.0..rows.1 {
            let e = triangle.edges(left, j);
            // Not negative inside: one less where a sample on the edge is another triangle's.
            let e = [0, 1, 2].map(|k: usize| e[k] as i32 - i32::from(!triangle.owns[k]));
            let mut inside = 0;
            for n in 0..SIDE as i32 {
                let outside = (e[0] + a[0] * n) | (e[1] + a[1] * n) | (e[2] + a[2] * n);
                inside |= u32::from(outside >= 0) << n;
            }
            inside &= visible;
            if inside == 0 {
                continue;
            }
            let (start, count) = (left + i64::from(inside.trailing_zeros()), inside.count_ones() as usize);
            if patch.count == 0 {
                patch.first = (start, j);
            }
            let (x, y) = ((start - patch.first.0) as i32, (j - patch.first.1) as i32);
            let lanes = patch.count..patch.count + kernels::STEP;
            for (n, (to_x, to_y)) in patch.x[lanes.clone()].iter_mut().zip(&mut patch.y[lanes]).enumerate() {
                (*to_x, *to_y) = (x + n as i32, y);
            }
            patch.runs[patch.filled] = (j, start, count);
            patch.filled += 1;
            patch.count += count;
        }
        if let Some(last) = patch.count.checked_sub(1) {
            let (x, y) = (patch.x[last], patch.y[last]);
            patch.x[patch.count..][..kernels::STEP].fill(x);
            patch.y[patch.count..][..kernels::STEP].fill(y);
        }
        patch
    }
}

impl Block {
    /// Lanes for pixels that lie side by side.
    #[inline(always)]
    fn append(&mut self, band: &Band<'_>, (i, j): (i64, i64), count: usize) {
        let at = (j as usize - band.first_row) * band.width + i as usize;
        self.runs.push(Run { lane: self.used, at, count });
        self.used += count;
    }
}

static ZEROS: [i32; kernels::LANES] = [0; kernels::LANES];

/// Computes and stores a block.
#[inline(always)]
fn flush(job: Job<'_>, block: &mut Block, band: &mut Band<'_>) {
    let Job { draw, compiled, .. } = job;
    let Block { rows, varying, work, runs, used, words, stored, depth, alive } = block;
    if *used == 0 {
        return;
    }
    for (n, sampler) in compiled.samplers.iter().enumerate() {
        let Some(table) = &sampler.table else { continue };
        let faces = sampler.cube.then_some(&varying.faces[n]);
        let wanted = compiled.textures[sampler.unit];
        fetch::sample(table, &varying.coordinates[n], faces, sampler.signed, wanted, work, rows);
    }
    if compiled.reads_surface {
        for run in runs.iter() {
            stored[run.lane..][..run.count].copy_from_slice(&band.words[run.at..][..run.count]);
        }
        store::read(draw, compiled, stored, rows);
    }
    for (node, at) in &compiled.operations {
        kernels::run(node, *at, rows);
    }
    store::pack(draw, compiled, rows, words);
    if compiled.drops {
        *alive = *varying.alive.first_chunk().unwrap_or(&[true; BLOCK]);
        if let Some(test) = &draw.alpha_test {
            let (alpha, reference) = (rows[usize::from(compiled.alpha)].block(), i16::from(test.reference));
            store::test(test.function, |n| alpha[n].clamp(0, 255), |_| reference, alive);
        }
        if let Some(test) = &draw.depth_test {
            for run in runs.iter() {
                depth[run.lane..][..run.count].copy_from_slice(&band.depth[run.at..][..run.count]);
            }
            store::test(test.function, |n| varying.depth[n], |n| depth[n], alive);
            if test.write {
                for n in (0..*used).filter(|n| alive[*n]) {
                    depth[n] = varying.depth[n];
                }
                for run in runs.iter() {
                    band.depth[run.at..][..run.count].copy_from_slice(&depth[run.lane..][..run.count]);
                }
            }
        }
    }
    if compiled.merges {
        store::merge(draw.write_mask, alive, stored, words);
    }
    for run in runs.iter() {
        band.words[run.at..][..run.count].copy_from_slice(&words[run.lane..][..run.count]);
    }
    runs.clear();
    *used = 0;
}
