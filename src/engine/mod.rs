//! The scalar engine: a plan in, frames or the trace of one pixel out.
//!
//! `pixel.rs` owns the order in which the blocks run for one pixel, generic over the lane and the observer; this module walks
//! draws, bands of rows, triangles and quads. A pixel's result is a pure function of the plan, whatever the bands and threads.

mod counting;
pub(crate) mod pixel;
mod report;
mod tracing;
pub(crate) mod walk;

pub use counting::{DrawCounts, count, fragments};
pub use tracing::{DrawTrace, PixelTrace, TraceError, trace};

use crate::frame::{Frames, Surface};
use crate::plan::{Plan, PlannedDraw};
use crate::rop::surface;
use crate::state::{Target, Texture, TextureImage};
use crate::texture::unit::Image;
use crate::trace::Silent;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How to render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// Threads; 0 takes one a core. The result does not depend on it.
    pub threads: usize,
}

impl Default for RenderOptions {
    fn default() -> Self {
        RenderOptions { threads: 1 }
    }
}

/// What a render did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Covered pixels of each draw, counted once for each triangle that covers them.
    pub shaded_pixels: Vec<u64>,
}

/// Rows of a band: the unit of work that threads share. Even, so that quads stay whole.
const BAND: usize = 16;

/// Below this many pixels a draw stays on one thread.
const SMALL: usize = 16_384;

/// Renders every draw.
pub fn render(plan: &Plan, options: &RenderOptions) -> Frames {
    render_counted(plan, options, &|_, _| {}).0
}

/// Renders every draw, counting; `progress` is told how many of how many bands of rows are done, from any thread.
pub fn render_counted(
    plan: &Plan,
    options: &RenderOptions,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> (Frames, Statistics) {
    let mut frames = cleared(plan);
    let mut statistics = Statistics::default();
    let pool = (options.threads != 1)
        .then(|| rayon::ThreadPoolBuilder::new().num_threads(options.threads).build().ok())
        .flatten();
    let bands = |draw: &PlannedDraw| (plan.targets[draw.target].height as usize).div_ceil(BAND);
    let total = plan.draws.iter().map(bands).sum();
    let done = AtomicUsize::new(0);
    let band_done = || progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
    for index in 0..plan.draws.len() {
        let shaded = draw(plan, index, &mut frames, pool.as_ref(), &band_done);
        statistics.shaded_pixels.push(shaded);
    }
    (frames, statistics)
}

/// The surfaces as the clears leave them.
pub(crate) fn cleared(plan: &Plan) -> Frames {
    let clear = |target: &Target| {
        let pixels = target.width as usize * target.height as usize;
        Surface {
            width: target.width,
            height: target.height,
            format: target.format,
            words: vec![surface::pack(target.format, target.clear_color); pixels],
            depth: target.depth.map_or(Vec::new(), |d| vec![d.clear; pixels]),
        }
    };
    Frames { surfaces: plan.targets.iter().map(clear).collect() }
}

/// What the ideal's surface holds after the clear, R, G, B, A in 255ths: the colour as it was given, and what blending reads of
/// channels that the format does not keep.
pub(crate) fn cleared_colors(target: &Target) -> [u8; 4] {
    let read = surface::read(target.format, surface::pack(target.format, target.clear_color));
    let kept = surface::kept_channels(target.format);
    std::array::from_fn(|n| if kept >> n & 1 != 0 { target.clear_color[n] } else { read[n] })
}

/// Each texture as it stands at this moment.
pub(crate) fn images<'a, L>(plan: &'a Plan, surfaces: &'a [Surface]) -> Vec<Image<'a, L>> {
    let words = |texture: &'a Texture| match &texture.image {
        TextureImage::Texels(texels) => &texels.words[..],
        TextureImage::Target { target } => &surfaces[*target].words,
    };
    plan.textures.iter().map(|texture| Image { words: words(texture), memory: None }).collect()
}

/// Runs one draw on its target; covered pixels.
pub(crate) fn draw(
    plan: &Plan,
    index: usize,
    frames: &mut Frames,
    pool: Option<&rayon::ThreadPool>,
    band_done: &(dyn Fn() + Sync),
) -> u64 {
    let planned = &plan.draws[index];
    let target = &mut frames.surfaces[planned.target];
    let width = target.width as usize;
    // The surface leaves the frames for the draw, so that the other surfaces can be read as textures.
    let (mut words, mut depth) = (std::mem::take(&mut target.words), std::mem::take(&mut target.depth));
    let textures = images(plan, &frames.surfaces);
    let band_of = |number: usize, words, depth| walk::Band { first_row: number * BAND, width, words, depth };
    let shaded = {
        let bands: Vec<walk::Band<'_>> = if depth.is_empty() {
            words.chunks_mut(BAND * width).enumerate().map(|(n, w)| band_of(n, w, &mut [][..])).collect()
        } else {
            let pairs = words.chunks_mut(BAND * width).zip(depth.chunks_mut(BAND * width));
            pairs.enumerate().map(|(n, (w, d))| band_of(n, w, d)).collect()
        };
        let pixels = planned.window.width as usize * planned.window.height as usize;
        let run = |mut band: walk::Band<'_>| {
            let (shaded, _) = walk::draw(plan, planned, &textures, &mut band, &mut Silent);
            band_done();
            shaded
        };
        match pool {
            Some(pool) if pixels >= SMALL => pool.install(|| bands.into_par_iter().map(run).sum()),
            _ => bands.into_iter().map(run).sum(),
        }
    };
    let target = &mut frames.surfaces[planned.target];
    (target.words, target.depth) = (words, depth);
    shaded
}
