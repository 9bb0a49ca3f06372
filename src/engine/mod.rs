//! The engines: a plan in, frames or the trace of one pixel out.
//!
//! `pixel.rs` owns the order in which the blocks run for one pixel, generic over the lane and the observer; `walk.rs` walks triangles and
//! quads: the scalar engine, which is the definition. `rows/` is the fast engine: the same bytes, a block of pixels at a time. This module
//! runs draws and bands of rows on threads. A pixel's result is a pure function of the plan, whatever the engine, bands and threads.

mod counting;
pub(crate) mod pixel;
mod report;
mod rows;
mod tracing;
pub(crate) mod walk;

pub use counting::{DrawCounts, count, fragments};
pub use rows::Isa;
pub use tracing::{DrawTrace, PixelTrace, TraceError, trace};

use crate::frame::{Frames, Surface};
use crate::plan::{Plan, PlannedDraw};
use crate::rop::surface;
use crate::state::{Target, Texture, TextureImage, named};
use crate::texture::unit::Image;
use crate::trace::Silent;
use rayon::prelude::*;
use rows::Rows;
use std::sync::atomic::{AtomicUsize, Ordering};

named! {
    /// Which engine draws. The bytes do not depend on it.
    pub enum Engine {
        /// The definition: one pixel at a time.
        Scalar = "scalar",
        /// Blocks of pixels; draws under policies that are not the default ones are the definition's all the same.
        Fast = "fast",
    }
}

/// How to render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// Threads; 0 takes one a core. The result does not depend on it.
    pub threads: usize,
    /// The engine. The result does not depend on it.
    pub engine: Engine,
    /// The instruction set of the fast engine; `None` takes the widest. One that the machine lacks is taken as the baseline.
    pub isa: Option<Isa>,
}

impl Default for RenderOptions {
    fn default() -> Self {
        RenderOptions { threads: 1, engine: Engine::Fast, isa: None }
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
    let renderer = Renderer::new(plan, options);
    let total = plan.draws.iter().map(|draw| renderer.bands(draw)).sum();
    let done = AtomicUsize::new(0);
    let band_done = || progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
    let statistics = renderer.draw_all(&mut frames, &band_done);
    (frames, statistics)
}

/// A plan ready to be drawn, any number of times.
#[derive(Debug)]
pub struct Renderer<'a> {
    plan: &'a Plan,
    rows: Option<Rows>,
    isa: Isa,
    threads: usize,
    pool: Option<rayon::ThreadPool>,
}

impl<'a> Renderer<'a> {
    /// Decodes textures and compiles draws, as far as the engine wants that, and starts the threads.
    pub fn new(plan: &'a Plan, options: &RenderOptions) -> Renderer<'a> {
        let pool = (options.threads != 1)
            .then(|| rayon::ThreadPoolBuilder::new().num_threads(options.threads).build().ok())
            .flatten();
        let isa = options
            .isa
            .filter(|isa| isa.is_available())
            .unwrap_or_else(|| if options.isa.is_some() { Isa::Baseline } else { Isa::best() });
        let rows = (options.engine == Engine::Fast).then(|| Rows::compile(plan)).flatten();
        let threads = pool.as_ref().map_or(1, rayon::ThreadPool::current_num_threads);
        Renderer { plan, rows, isa, threads, pool }
    }

    /// The instruction set that the fast engine uses.
    pub fn isa(&self) -> Isa {
        self.isa
    }

    /// Clears the targets and draws everything.
    pub fn render(&self) -> (Frames, Statistics) {
        let mut frames = cleared(self.plan);
        let statistics = self.draw_all(&mut frames, &|| {});
        (frames, statistics)
    }

    /// Draws everything once more on frames that [`render`](Self::render) made; nothing is cleared.
    pub fn redraw(&self, frames: &mut Frames) -> Statistics {
        self.draw_all(frames, &|| {})
    }

    fn draw_all(&self, frames: &mut Frames, band_done: &(dyn Fn() + Sync)) -> Statistics {
        let draws = 0..self.plan.draws.len();
        Statistics { shaded_pixels: draws.map(|index| self.draw(index, frames, band_done)).collect() }
    }

    /// Rows of a band of a draw.
    fn band(&self, draw: &PlannedDraw) -> usize {
        let height = self.plan.targets[draw.target].height as usize;
        match (&self.rows, self.threads) {
            (None, _) => BAND,
            // What is set up for a triangle is set up for each band that it meets.
            (Some(_), 1) => height.next_multiple_of(2).max(2),
            (Some(_), threads) => height.div_ceil(4 * threads).next_multiple_of(2).max(BAND),
        }
    }

    fn bands(&self, draw: &PlannedDraw) -> usize {
        (self.plan.targets[draw.target].height as usize).div_ceil(self.band(draw))
    }

    /// Runs one draw on its target; covered pixels.
    fn draw(&self, index: usize, frames: &mut Frames, band_done: &(dyn Fn() + Sync)) -> u64 {
        let planned = &self.plan.draws[index];
        let compiled = self.rows.as_ref().map(|rows| rows.draw(self.plan, index, &frames.surfaces));
        let run = |textures: &[Image<'_, i32>], band: &mut walk::Band<'_>| {
            let shaded = match &compiled {
                Some(compiled) => {
                    let job = rows::Job { plan: self.plan, draw: planned, compiled, textures };
                    rows::isa::run(self.isa, job, band)
                }
                None => walk::draw(self.plan, planned, textures, band, &mut Silent).0,
            };
            band_done();
            shaded
        };
        draw(self.plan, index, self.band(planned), frames, self.pool.as_ref(), &run)
    }
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

/// What runs a draw in one band.
type RunBand<'r> = dyn Fn(&[Image<'_, i32>], &mut walk::Band<'_>) -> u64 + Sync + 'r;

/// Runs one draw on its target, in bands of so many rows; covered pixels.
fn draw(
    plan: &Plan,
    index: usize,
    height: usize,
    frames: &mut Frames,
    pool: Option<&rayon::ThreadPool>,
    run_band: &RunBand<'_>,
) -> u64 {
    let planned = &plan.draws[index];
    let target = &mut frames.surfaces[planned.target];
    let width = target.width as usize;
    // The surface leaves the frames for the draw, so that the other surfaces can be read as textures.
    let (mut words, mut depth) = (std::mem::take(&mut target.words), std::mem::take(&mut target.depth));
    let textures = images(plan, &frames.surfaces);
    let band_of = |number: usize, words, depth| walk::Band { first_row: number * height, width, words, depth };
    let shaded = {
        let bands: Vec<walk::Band<'_>> = if depth.is_empty() {
            words.chunks_mut(height * width).enumerate().map(|(n, w)| band_of(n, w, &mut [][..])).collect()
        } else {
            let pairs = words.chunks_mut(height * width).zip(depth.chunks_mut(height * width));
            pairs.enumerate().map(|(n, (w, d))| band_of(n, w, d)).collect()
        };
        let pixels = planned.window.width as usize * planned.window.height as usize;
        let run = |mut band: walk::Band<'_>| run_band(&textures, &mut band);
        match pool {
            Some(pool) if pixels >= SMALL => pool.install(|| bands.into_par_iter().map(run).sum()),
            _ => bands.into_iter().map(run).sum(),
        }
    };
    let target = &mut frames.surfaces[planned.target];
    (target.words, target.depth) = (words, depth);
    shaded
}

/// Runs one draw by the definition, on one thread.
pub(crate) fn draw_defined(plan: &Plan, index: usize, frames: &mut Frames) {
    let planned = &plan.draws[index];
    draw(plan, index, BAND, frames, None, &|textures, band| walk::draw(plan, planned, textures, band, &mut Silent).0);
}
