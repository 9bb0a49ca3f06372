//! The engines, which draw the frames of a plan or trace one of its pixels.
//!
//! The scalar engine is the definition: `context.rs` sets up a triangle, `pixel.rs` has the order in which the blocks process one of its pixels, generic
//! over the lane and the observer, and `walk.rs` walks triangles and quads. `rows/` is the fast engine, which computes the same bytes for a block of pixels at a time. `bins.rs` cuts
//! rows into bands and sorts triangles by them. This module runs draws and bands on threads. A pixel's result is a pure function of the plan, whatever
//! the engine, the bands and the threads.

mod bins;
pub mod context;
mod counting;
pub mod pixel;
mod planes;
mod reals;
mod report;
mod rows;
mod texture_words;
mod tracing;
mod unseen;
pub mod walk;

pub use counting::{DrawCounts, ShadedPixels, affordable, count, fragments, shaded};
pub use planes::{FRAGMENT_NAMES, Plane, PlaneOptions, plane_names, planes};
pub use reals::Reals;
pub use rows::Isa;
use rows::Kernels;
pub use texture_words::TextureWords;
pub use tracing::{DrawTrace, FRAGMENTS, PixelTrace, TraceEnd, TraceError, Tracer, trace, trace_last};
pub use unseen::{EmptyDraw, unseen};

use crate::frame::{Frames, Surface};
use crate::plan::{Plan, PlannedDraw};
use crate::rop::surface;
use crate::state::{Target, named};
use crate::threads::Team;
use crate::trace::{Observer, Silent};
use bins::Bins;
use context::TriangleContext;
use rows::Rows;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

named! {
    /// The engine that draws. The result does not depend on it.
    pub enum Engine {
        /// The scalar engine, which is the definition: one pixel at a time.
        Scalar = "scalar",
        /// The fast engine: blocks of pixels.
        Fast = "fast",
    }
}

/// Options of a render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// Number of threads; 0 for one per core. The result does not depend on it.
    pub threads: usize,
    /// The engine that draws.
    pub engine: Engine,
    /// Instruction set of the fast engine; `None` for the widest. The baseline is used if the machine lacks it.
    pub isa: Option<Isa>,
    /// Number of rows of a band, which is the unit of work of a thread; `None` for a suitable number. The result does not depend on it.
    pub band: Option<usize>,
}

impl Default for RenderOptions {
    fn default() -> Self {
        RenderOptions { threads: 1, engine: Engine::Fast, isa: None, band: None }
    }
}

/// Statistics of a render.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Number of covered pixels of each draw, counted once for each triangle that covers them.
    pub shaded_pixels: Vec<u64>,
    /// Number of these that the scalar engine drew for the fast one, because rows do not sample their textures, or edges are smooth.
    pub scalar_pixels: u64,
}

/// Least number of rows of a band, if no number is asked for.
const BAND: usize = 16;

/// Draws with fewer pixels run on one thread.
const SMALL: usize = 16_384;

/// Number of pixels of a band that stays in the cache while several draws pass over it.
const CACHED: usize = 32_768;

/// Number of bands for each thread, if there are several. More would share the work more evenly, but triangles on a border are set up on
/// both sides of it.
const BANDS: usize = 3;

/// Up to so many triangles per draw, it costs hardly anything to set up each triangle for every band.
const MAX_UNSORTED_TRIANGLES: usize = 16;

/// Renders every draw of a plan.
pub fn render(plan: &Plan, options: &RenderOptions) -> Frames {
    render_counted(plan, options, &|_, _| {}).0
}

/// Renders every draw of a plan, and returns statistics. `progress` receives the number of finished bands and of all bands, from any
/// thread.
pub fn render_counted(
    plan: &Plan,
    options: &RenderOptions,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> (Frames, Statistics) {
    let renderer = Renderer::new(plan, options);
    let mut frames = renderer.cleared();
    let total = renderer.groups.iter().map(|group| group.draws.len() * (group.borders.len() - 1)).sum();
    let done = AtomicUsize::new(0);
    let band_done = || progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
    let statistics = renderer.draw_all(&mut frames, &band_done);
    (frames, statistics)
}

/// A plan that is ready to be drawn, any number of times.
#[derive(Debug)]
pub struct Renderer<'a> {
    plan: &'a Plan,
    rows: Option<Rows>,
    kernels: Kernels,
    team: Team,
    /// Buffers of each thread of the team.
    blocks: Box<[Mutex<rows::Block>]>,
    groups: Vec<Group>,
}

/// Neighbouring draws on one target. They are drawn band by band: all draws of a group on one band, then on the next, so that the band
/// stays in the cache. No draw reads what another one of its group has drawn, except through the surface itself.
#[derive(Debug)]
struct Group {
    draws: Range<usize>,
    /// First row of each band, and the end of the last.
    borders: Vec<usize>,
    /// The sorted triangles of each draw, if the fast engine draws them.
    bins: Vec<Bins>,
}

impl<'a> Renderer<'a> {
    /// Decodes textures and compiles draws, as the engine needs it, and starts the threads.
    pub fn new(plan: &'a Plan, options: &RenderOptions) -> Renderer<'a> {
        // The calling thread draws too.
        let team = Team::new(options.threads);
        let kernels = options.isa.unwrap_or_else(Isa::best).kernels().unwrap_or(Kernels::BASELINE);
        let rows = (options.engine == Engine::Fast).then(|| Rows::compile(plan));
        let group = |draws: Range<usize>| {
            let all = &plan.draws[draws.clone()];
            let borders = borders(plan, all, rows.is_some(), options.band, team.count());
            let bins = |draw: &PlannedDraw| {
                let rows = (0, plan.targets[draw.target].height.into());
                let is_seen = draw.folded.invisible.is_none();
                Bins::new(&draw.assembly, &borders, |n| is_seen && TriangleContext::may_cover(draw, n, rows))
            };
            let bins = if rows.is_some() { all.iter().map(bins).collect() } else { Vec::new() };
            Group { draws, borders, bins }
        };
        let mut first = 0;
        let groups = plan.draws.chunk_by(|one, next| one.target == next.target).map(|draws| {
            first += draws.len();
            group(first - draws.len()..first)
        });
        let groups = groups.collect();
        let blocks = (0..team.count()).map(|_| Mutex::default()).collect();
        Renderer { plan, rows, kernels, blocks, team, groups }
    }

    /// Returns the engine that draws.
    pub fn engine(&self) -> Engine {
        if self.rows.is_some() { Engine::Fast } else { Engine::Scalar }
    }

    /// Returns the instruction set of the fast engine.
    pub fn isa(&self) -> Isa {
        self.kernels.isa
    }

    /// Clears the targets and draws everything. Returns the frames and the statistics.
    pub fn render(&self) -> (Frames, Statistics) {
        let mut frames = self.cleared();
        let statistics = self.draw_all(&mut frames, &|| {});
        (frames, statistics)
    }

    /// Clears frames of [`render`](Self::render) as before the first draw, or sets their initial contents. Others are replaced.
    pub fn clear(&self, frames: &mut Frames) {
        clear(self.plan, &self.team, frames);
    }

    fn cleared(&self) -> Frames {
        let mut frames = Frames { surfaces: Vec::new() };
        self.clear(&mut frames);
        frames
    }

    /// Draws everything once more on frames of [`render`](Self::render), without clearing them. Frames of other sizes are replaced by
    /// cleared ones.
    pub fn redraw(&self, frames: &mut Frames) -> Statistics {
        if !fits(self.plan, frames) {
            *frames = self.cleared();
        }
        self.draw_all(frames, &|| {})
    }

    fn draw_all(&self, frames: &mut Frames, band_done: &(dyn Fn() + Sync)) -> Statistics {
        let shaded = self.groups.iter().flat_map(|group| self.draw_group(group, frames, band_done));
        let shaded_pixels: Vec<u64> = shaded.collect();
        let is_scalar = |draw: usize| self.rows.as_ref().is_some_and(|rows| rows.is_scalar(draw));
        let scalar = shaded_pixels.iter().enumerate().filter(|(draw, _)| is_scalar(*draw));
        Statistics { scalar_pixels: scalar.map(|(_, pixels)| pixels).sum(), shaded_pixels }
    }

    /// Runs a group. Returns the number of covered pixels of each draw.
    fn draw_group(&self, group: &Group, frames: &mut Frames, band_done: &(dyn Fn() + Sync)) -> Vec<u64> {
        let (plan, draws, bins) = (self.plan, &self.plan.draws[group.draws.clone()], &group.bins);
        let windows = draws.iter().flat_map(|draw| &draw.windows);
        let pixels: usize = windows.map(|window| window.width as usize * window.height as usize).sum();
        let alone = Team::new(1);
        let team = if pixels >= SMALL { &self.team } else { &alone };
        let shaded: Vec<AtomicU64> = draws.iter().map(|_| AtomicU64::new(0)).collect();
        with_surface(frames, draws[0].target, |surface, others| {
            let texture_words = TextureWords::new(plan, draws, others);
            let textures = texture_words.images();
            let compiled = self.rows.as_ref().map(|rows| rows.draws(plan, group.draws.clone(), &texture_words));
            let bands = bands(&group.borders, surface.width as usize, &mut surface.words, &mut surface.depth);
            share(team, &bands, |thread, (number, mut band)| {
                // A thread may come twice, but not at the same time.
                let mut block = self.blocks[thread].lock().unwrap_or_else(PoisonError::into_inner);
                for (n, (draw, shaded)) in draws.iter().zip(&shaded).enumerate() {
                    let pixels = match &compiled {
                        Some(_) if bins[n].triangles_in(number).is_empty() => 0,
                        Some(compiled) if !compiled[n].is_scalar => {
                            let of = (plan, draw, compiled[n].as_ref());
                            rows::run(&self.kernels, of, bins[n].triangles_in(number), &mut band, &mut block)
                        }
                        _ => walk::draw(plan, draw, &textures, &mut band, &mut Silent).0,
                    };
                    shaded.fetch_add(pixels, Ordering::Relaxed);
                    band_done();
                }
            });
        });
        shaded.into_iter().map(AtomicU64::into_inner).collect()
    }
}

/// Calls a function with a surface, which leaves the frames meanwhile, so that the other surfaces can be read as textures.
fn with_surface<T>(frames: &mut Frames, target: usize, of: impl FnOnce(&mut Surface, &[Surface]) -> T) -> T {
    let Surface { width, height, format, words, depth } = &mut frames.surfaces[target];
    let (words, depth) = (std::mem::take(words), std::mem::take(depth));
    let mut surface = Surface { width: *width, height: *height, format: *format, words, depth };
    let result = of(&mut surface, &frames.surfaces);
    frames.surfaces[target] = surface;
    result
}

/// Returns the borders of the bands in which some draws, of which there is at least one, are drawn on their target. `rows` is the wanted
/// number of rows of a band.
fn borders(plan: &Plan, draws: &[PlannedDraw], is_fast: bool, rows: Option<usize>, threads: usize) -> Vec<usize> {
    let target = &plan.targets[draws[0].target];
    let (width, height) = (target.width as usize, target.height as usize);
    let triangles: usize = draws.iter().map(|draw| draw.assembly.triangles.len()).sum();
    let rows = match (rows, is_fast, threads) {
        (Some(rows), ..) => rows.max(1),
        (None, false, _) => BAND,
        // A triangle is set up once for each band that it meets.
        (None, true, 1) if draws.len() == 1 || triangles > MAX_UNSORTED_TRIANGLES * draws.len() => height,
        (None, true, 1) => (CACHED / width).max(BAND),
        (None, true, threads) => {
            let visible = draws.iter().filter(|draw| draw.folded.invisible.is_none());
            let assemblies = visible.map(|draw| &draw.assembly);
            return bins::balanced(assemblies, (width, height), BANDS * threads, BAND);
        }
    };
    // Even, so that quads stay whole.
    bins::equal(height, rows.next_multiple_of(2))
}

/// Returns the surfaces after the clears, or with their initial contents.
pub fn cleared(plan: &Plan) -> Frames {
    let mut frames = Frames { surfaces: Vec::new() };
    clear(plan, &Team::new(1), &mut frames);
    frames
}

/// Returns whether frames have the sizes and the formats of the targets.
fn fits(plan: &Plan, frames: &Frames) -> bool {
    let fits = |(surface, target): (&Surface, &Target)| {
        let pixels = target.width as usize * target.height as usize;
        let depths = if target.depth.is_some() { pixels } else { 0 };
        (surface.width, surface.height, surface.format) == (target.width, target.height, target.format)
            && (surface.words.len(), surface.depth.len()) == (pixels, depths)
    };
    frames.surfaces.len() == plan.targets.len() && frames.surfaces.iter().zip(&plan.targets).all(fits)
}

/// Clears frames, or sets their initial contents. Those that do not fit are replaced.
fn clear(plan: &Plan, team: &Team, frames: &mut Frames) {
    if !fits(plan, frames) {
        // What the system has cleared becomes the process's memory where it is first written, by each thread its own.
        frames.surfaces = plan.targets.iter().map(empty).collect();
    }
    for (surface, target) in frames.surfaces.iter_mut().zip(&plan.targets) {
        let alone = Team::new(1);
        let team = if surface.words.len() >= SMALL { team } else { &alone };
        let rows = (surface.height as usize).div_ceil(team.count());
        let borders = bins::equal(surface.height as usize, rows.max(1));
        let bands = bands(&borders, surface.width as usize, &mut surface.words, &mut surface.depth);
        share(team, &bands, |_, (_, band)| clear_band(target, band));
    }
}

/// Returns a surface of zeros.
fn empty(target: &Target) -> Surface {
    let &Target { width, height, format, .. } = target;
    let zeros = || vec![0; width as usize * height as usize];
    Surface { width, height, format, words: zeros(), depth: target.depth.map_or(Vec::new(), |_| zeros()) }
}

/// Clears a band of a target, or sets its initial contents.
fn clear_band(target: &Target, band: walk::Band<'_>) {
    let begin = |words: &mut [u32], contents: &Option<Arc<[u32]>>, cleared: u32| match contents {
        Some(contents) => words.copy_from_slice(&contents[band.first_row * band.width..][..words.len()]),
        None => words.fill(cleared),
    };
    begin(band.words, &target.contents, surface::pack(target.format, target.clear_color));
    begin(band.depth, &target.depth_contents, target.depth.map_or(0, |depth| depth.cleared()));
}

/// The rows of a surface between borders, each with its number, for whoever takes them first.
type Bands<'a> = Vec<Mutex<Option<(usize, walk::Band<'a>)>>>;

/// Runs `work` on each band, with the number of a thread. Each thread begins with bands of its own, the same every time, because they may be
/// in its cache, and then takes what others have left.
fn share<'a>(team: &Team, bands: &Bands<'a>, work: impl Fn(usize, (usize, walk::Band<'a>)) + Sync) {
    team.run(|thread| {
        let (before, own) = bands.split_at(thread * bands.len() / team.count());
        for band in own.iter().chain(before) {
            // A panic in another thread ends the render anyway.
            let band = band.lock().unwrap_or_else(PoisonError::into_inner).take();
            if let Some(band) = band {
                work(thread, band);
            }
        }
    });
}

/// Cuts the words and the depths of a surface.
fn bands<'a>(borders: &[usize], width: usize, mut words: &'a mut [u32], mut depth: &'a mut [u32]) -> Bands<'a> {
    let band = |(number, rows): (usize, &[usize])| {
        let count = (rows[1] - rows[0]) * width;
        let words = words.split_off_mut(..count).unwrap_or_default();
        let depth = depth.split_off_mut(..count).unwrap_or_default();
        Mutex::new(Some((number, walk::Band { first_row: rows[0], width, words, depth })))
    };
    borders.windows(2).enumerate().map(band).collect()
}

/// Returns the ideal's colour of pixel `at`, counted row by row, before the first draw: R, G, B and A in 255ths. It is what blending reads
/// of the initial contents. After a clear it is the given colour, or what blending reads of channels that the format does not store.
pub fn cleared_colors(target: &Target, at: usize) -> [u8; 4] {
    if let Some(words) = &target.contents {
        return surface::read(target.format, words[at]);
    }
    let read = surface::read(target.format, surface::pack(target.format, target.clear_color));
    let kept = surface::kept_channels(target.format);
    std::array::from_fn(|n| if kept >> n & 1 != 0 { target.clear_color[n] } else { read[n] })
}

/// Runs one draw by the definition, on one thread. Returns the number of covered pixels and of stored ones.
pub(crate) fn draw_defined<O: Observer>(
    plan: &Plan,
    draw: &PlannedDraw,
    frames: &mut Frames,
    observer: &mut O,
) -> (u64, u64) {
    with_surface(frames, draw.target, |surface, others| {
        let words = TextureWords::new(plan, std::slice::from_ref(draw), others);
        let Surface { width, words: own, depth, .. } = surface;
        let mut band = walk::Band { first_row: 0, width: *width as usize, words: own, depth };
        walk::draw(plan, draw, &words.images(), &mut band, observer)
    })
}
