//! Triangles to pieces, pieces to blocks, blocks to the surface.

use super::fetch::{self, Workspace};
use super::kernels::{self, Row};
use super::quotient::{IOTA, Positions};
use super::triangle::{Piece, Setup, Varying, whole_steps};
use super::{BLOCK, Compiled, store};
use crate::engine::pixel::TriangleContext;
use crate::engine::walk::{self, Band};
use crate::plan::{Plan, PlannedDraw};
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
    for number in 0..draw.assembly.triangles.len() {
        let Some(context) = TriangleContext::new(plan, draw, number, rows) else { continue };
        let setup = Setup::new(context, compiled);
        let triangle = &setup.context.triangle;
        for j in triangle.rows.0.max(rows.0)..triangle.rows.1.min(rows.1) {
            let (mut i, end) = triangle.span(j, columns);
            while i < end {
                let count = ((end - i) as usize).min(BLOCK - block.used);
                let lanes = whole_steps(count);
                let at = Positions { x: &IOTA[..lanes], y: &ZEROS[..lanes], last: count as i32 - 1 };
                let piece = Piece { first: (i, j), at, count, lane: block.used };
                setup.interpolate::<FMA, true>(piece, compiled, textures, &mut block.varying, &mut block.rows);
                let at = (j as usize - band.first_row) * band.width + i as usize;
                block.runs.push(Run { lane: block.used, at, count });
                block.used += count;
                shaded += count as u64;
                i += count as i64;
                if block.used == BLOCK {
                    flush(job, &mut block, band);
                }
            }
        }
        if compiled.reads_surface {
            // The next triangle may cover the same pixels.
            flush(job, &mut block, band);
        }
    }
    flush(job, &mut block, band);
    shaded
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
    if compiled.reads_surface {
        store::merge(draw.write_mask, alive, stored, words);
    }
    for run in runs.iter() {
        band.words[run.at..][..run.count].copy_from_slice(&words[run.lane..][..run.count]);
    }
    runs.clear();
    *used = 0;
}
