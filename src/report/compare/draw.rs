//! The walk over draws and bands of rows, independent of the mode.
#![allow(clippy::float_arithmetic, reason = "statistics of errors")]

use super::meter::Counts;
use super::*;
use ninebit::engine::context::TriangleContext;
use ninebit::engine::pixel::{DepthStencil, Fragment, FragmentResult};
use ninebit::engine::{TextureWords, cleared_colors};
use ninebit::number::Lane;
use ninebit::plan::{Plan, PlannedDraw};
use ninebit::rop::surface;
use ninebit::state::{Named, Texture, TextureImage, depth_of};
use ninebit::texture::planned::Image;
use ninebit::threads::on_threads;
use ninebit::trace::{Decision, Observer, Part, Rule};
#[cfg(feature = "threads")]
use rayon::prelude::*;

/// Number of rows in a band. It is even so that quads stay whole.
const BAND: usize = 16;

/// Number of worst pixels that are reported.
const WORST: usize = 8;

/// State of a pixel besides its colour.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct State {
    /// The ideal's depth and stencil.
    pub(super) depth: DepthStencil,
    /// Whether a fragment was stored.
    pub(super) drawn: bool,
    /// Whether a decision has differed.
    pub(super) diverged: bool,
}

/// Some rows of a target, as the definition and the ideal hold them.
pub(super) struct Band<'a, L> {
    /// First row of the band.
    pub(super) first_row: usize,
    /// Width in pixels.
    pub(super) width: usize,
    /// Words of the definition.
    pub(super) words: &'a mut [u32],
    /// Depth words of the definition; empty without a depth buffer.
    pub(super) depth: &'a mut [u32],
    /// Colours of the lane, as R, G, B, A.
    pub(super) held: &'a mut [[L; 4]],
    /// State of each pixel.
    pub(super) states: &'a mut [State],
}

impl<L> Band<'_, L> {
    /// Returns the first row and the row after the last.
    pub(super) fn rows(&self) -> (i64, i64) {
        (self.first_row as i64, (self.first_row + self.words.len() / self.width) as i64)
    }

    /// Returns the index of pixel (i, j).
    pub(super) fn at(&self, i: i64, j: i64) -> usize {
        (j as usize - self.first_row) * self.width + i as usize
    }

    /// Shades pixel (i, j) for the definition, and keeps its word and its depth.
    pub(super) fn shade<S: Lane>(
        &mut self,
        context: &TriangleContext<'_>,
        (i, j): (i64, i64),
        destination: Option<[S; 4]>,
        images: &[Image<'_, S>],
        observer: &mut impl Observer,
    ) -> Option<FragmentResult<S>> {
        let at = self.at(i, j);
        let mut depth = DepthStencil::new(self.depth.get(at).copied().unwrap_or(0));
        let e = context.triangle.edges(i, j);
        let fragment = Fragment { pixel: (i, j), e, stored: self.words[at], weights: None };
        let stored = context.shade(&fragment, &mut depth, destination, images, observer);
        if let Some(slot) = self.depth.get_mut(at) {
            *slot = depth.word();
        }
        let stored = stored?;
        self.words[at] = stored.word;
        self.states[at].drawn = true;
        Some(stored)
    }
}

impl<L: Copy> Band<'_, L> {
    /// Keeps the lane's colours of the channels that a draw writes.
    pub(super) fn hold(&mut self, at: usize, planned: &PlannedDraw, channels: &[L; 4]) {
        for n in (0..4).filter(|n| planned.written >> n & 1 != 0) {
            self.held[at][n] = channels[n];
        }
    }
}

/// Textures at the time of a draw.
pub(super) struct Images<'a, L> {
    /// Images with the lane's colours.
    pub(super) lane: Vec<Image<'a, L>>,
    /// Images with only the definition's words.
    pub(super) words: Vec<Image<'a, i32>>,
    /// For textures that are surfaces, the state of their pixels.
    pub(super) states: Vec<Option<SampledSurface<'a>>>,
}

/// Pixel states of a surface that is read as a texture.
pub(super) struct SampledSurface<'a> {
    /// Width in pixels.
    width: usize,
    states: &'a [State],
    /// Size of a pixel in bytes.
    pixel: u32,
    /// Size of a texel in bytes.
    texel: u32,
}

impl SampledSurface<'_> {
    /// Returns whether one of the pixels behind a texel has diverged.
    pub(super) fn diverged(&self, x: u32, y: u32) -> bool {
        let row = &self.states[y as usize * self.width..][..self.width];
        let [first, last] = [x * self.texel, x * self.texel + self.texel - 1].map(|byte| (byte / self.pixel) as usize);
        row[first..=last].iter().any(|state| state.diverged)
    }
}

/// A draw and its textures.
pub(super) struct Draw<'a, L> {
    pub(super) plan: &'a Plan,
    pub(super) planned: &'a PlannedDraw,
    pub(super) images: &'a Images<'a, L>,
}

/// Evaluation of the definition and the ideal in one mode.
pub(super) trait Method {
    type Lane: Lane + Send + Sync;

    /// Draws the part of a draw that lies in a band.
    fn draw(draw: &Draw<'_, Self::Lane>, band: &mut Band<'_, Self::Lane>, counts: &mut Counts);

    /// Returns a channel's ideal value at the end, and the contribution of each part to its error.
    fn channel(shown: u8, held: Self::Lane, counts: &mut Counts) -> (f64, Option<[f64; Part::ALL.len()]>);
}

/// A target, or some of its rows, as the definition and the ideal hold it.
struct Surface<L> {
    first_row: usize,
    width: usize,
    words: Vec<u32>,
    depth: Vec<u32>,
    held: Vec<[L; 4]>,
    states: Vec<State>,
}

impl<L: Lane> Surface<L> {
    fn new(plan: &Plan, target: usize, (first, end): (usize, usize)) -> Self {
        let target = &plan.targets()[target];
        let (width, pixels) = (target.width as usize, (end - first) * target.width as usize);
        let depth = match (&target.depth_contents, target.depth) {
            (Some(words), _) => words[first * width..end * width].to_vec(),
            (None, Some(depth)) => vec![depth.cleared(); pixels],
            (None, None) => Vec::new(),
        };
        let memory = |at: usize| {
            let word = depth.get(at).copied().unwrap_or(0);
            let steps = depth_of(word);
            DepthStencil { depth: L::depth(i64::from(steps), || f64::from(steps)), ..DepthStencil::new(word) }
        };
        let states = (0..pixels).map(|at| State { depth: memory(at), ..State::default() }).collect();
        Surface {
            first_row: first,
            width,
            words: match &target.contents {
                Some(words) => words[first * width..end * width].to_vec(),
                None => vec![surface::pack(target.format, target.clear_color); pixels],
            },
            states,
            depth,
            held: match &target.contents {
                Some(_) => (first * width..end * width).map(|at| cleared_colors(target, at).map(L::byte)).collect(),
                None => vec![cleared_colors(target, 0).map(L::byte); pixels],
            },
        }
    }

    fn bands(&mut self) -> Vec<Band<'_, L>> {
        let size = BAND * self.width;
        let mut depths = self.depth.chunks_mut(size);
        let colors = self.words.chunks_mut(size).zip(self.held.chunks_mut(size)).zip(self.states.chunks_mut(size));
        let band = |(number, ((words, held), states))| Band {
            first_row: self.first_row + number * BAND,
            width: self.width,
            words,
            depth: depths.next().unwrap_or_default(),
            held,
            states,
        };
        colors.enumerate().map(band).collect()
    }
}

/// Comparison of some rows.
#[derive(Default)]
struct Outcome {
    counts: Counts,
    drawn: u64,
    diverged: u64,
    channels: [(Statistics, Histogram); 4],
    parts: [Statistics; Part::ALL.len()],
    unexplained: f64,
    worst: Vec<WorstPixel>,
    errors: Vec<[f32; 4]>,
}

impl Outcome {
    /// Appends the rows below.
    fn append(&mut self, mut other: Outcome) {
        self.counts.merge(&other.counts);
        self.drawn += other.drawn;
        self.diverged += other.diverged;
        for (mine, other) in self.channels.iter_mut().zip(&other.channels) {
            mine.0.merge(&other.0);
            mine.1.merge(&other.1);
        }
        self.parts.iter_mut().zip(&other.parts).for_each(|(mine, other)| mine.merge(other));
        self.unexplained = self.unexplained.max(other.unexplained);
        self.worst.append(&mut other.worst);
        self.keep_worst();
        self.errors.append(&mut other.errors);
    }

    fn keep_worst(&mut self) {
        self.worst.sort_by(|a, b| b.error().abs().total_cmp(&a.error().abs()));
        self.worst.truncate(WORST);
    }
}

impl WorstPixel {
    /// Returns the definition minus the ideal, in steps.
    pub fn error(&self) -> f64 {
        f64::from(self.shown) - self.ideal
    }
}

/// Draws everything that affects the target, and sums up the errors.
pub(super) fn run<M: Method>(plan: &Plan, options: &CompareOptions) -> Comparison {
    let reads_targets = plan.draws().iter().any(|planned| plan.reads_target(planned));
    let work = || if reads_targets { on_surfaces::<M>(plan, options) } else { in_bands::<M>(plan, options) };
    summed(plan, options, on_threads(options.threads, work))
}

/// Runs `work` on each band. Returns its results in the order of the bands.
fn each<B: Send, T: Send>(bands: Vec<B>, work: impl Fn(B) -> T + Send + Sync) -> Vec<T> {
    #[cfg(feature = "threads")]
    return bands.into_par_iter().map(work).collect();
    #[cfg(not(feature = "threads"))]
    bands.into_iter().map(work).collect()
}

/// Compares a target if no draw reads a surface: each band goes through all draws independently, and other targets do not matter.
fn in_bands<M: Method>(plan: &Plan, options: &CompareOptions) -> Outcome {
    let height = plan.targets()[options.target].height as usize;
    let surfaces: Vec<Surface<M::Lane>> = Vec::new();
    let words = texture_words(plan, plan.draws(), &surfaces);
    let images = images(plan, &words, &surfaces);
    let bands = each((0..height.div_ceil(BAND)).collect(), |number| {
        let rows = (number * BAND, (number * BAND + BAND).min(height));
        let mut surface = Surface::new(plan, options.target, rows);
        let mut counts = Counts::default();
        for planned in plan.draws().iter().filter(|planned| planned.target == options.target) {
            for mut band in surface.bands() {
                M::draw(&Draw { plan, planned, images: &images }, &mut band, &mut counts);
            }
        }
        let mut outcome = outcome::<M>(plan, options, &surface);
        outcome.counts.merge(&counts);
        outcome
    });
    bands.into_iter().fold(Outcome::default(), |mut all, band| {
        all.append(band);
        all
    })
}

/// Compares a target by drawing on whole surfaces, one draw after the other.
fn on_surfaces<M: Method>(plan: &Plan, options: &CompareOptions) -> Outcome {
    let (surfaces, counts) = surfaces::<M>(plan);
    let mut outcome = outcome::<M>(plan, options, &surfaces[options.target]);
    outcome.counts.merge(&counts);
    outcome
}

/// Returns the lane's final colours of a target, R, G, B, A row by row; `None` where nothing was drawn.
pub(super) fn held<M: Method>(plan: &Plan, target: usize) -> Vec<Option<[M::Lane; 4]>> {
    let (surfaces, _) = surfaces::<M>(plan);
    let surface = &surfaces[target];
    surface.held.iter().zip(&surface.states).map(|(held, state)| state.drawn.then_some(*held)).collect()
}

/// Returns all targets after all draws.
fn surfaces<M: Method>(plan: &Plan) -> (Vec<Surface<M::Lane>>, Counts) {
    let rows = |target: usize| (0, plan.targets()[target].height as usize);
    let mut surfaces: Vec<Surface<M::Lane>> =
        (0..plan.targets().len()).map(|target| Surface::new(plan, target, rows(target))).collect();
    let mut counts = Counts::default();
    for planned in plan.draws() {
        let empty = Surface { first_row: 0, width: 0, words: vec![], depth: vec![], held: vec![], states: vec![] };
        // The surface is taken out during the draw, so that the others can be read as textures.
        let mut surface = std::mem::replace(&mut surfaces[planned.target], empty);
        let words = texture_words(plan, std::slice::from_ref(planned), &surfaces);
        let images = images(plan, &words, &surfaces);
        let drawn = each(surface.bands(), |mut band| {
            let mut counts = Counts::default();
            M::draw(&Draw { plan, planned, images: &images }, &mut band, &mut counts);
            counts
        });
        drawn.iter().for_each(|band| counts.merge(band));
        surfaces[planned.target] = surface;
    }
    (surfaces, counts)
}

/// Returns the words of the textures that these draws read. `surfaces` may be empty if no draw reads a target.
fn texture_words<'a, L>(plan: &'a Plan, draws: &[PlannedDraw], surfaces: &'a [Surface<L>]) -> TextureWords<'a> {
    TextureWords::from_surfaces(plan, draws, |target| surfaces.get(target).map(|s| (&s.words[..], &s.depth[..])))
}

/// Returns the textures with these words.
fn images<'a, L>(plan: &'a Plan, words: &'a TextureWords<'a>, surfaces: &'a [Surface<L>]) -> Images<'a, L> {
    let surface = |texture: &Texture| match &texture.image {
        TextureImage::Target { target } => {
            let surface = plan.targets()[*target].format;
            // The lane has no colours for bits that are read as another format.
            let channels =
                if surface.texture_format() == texture.format { surface::sampled_channels(surface) } else { 0 };
            surfaces.get(*target).map(|s| (s, channels))
        }
        TextureImage::Depth { target } => surfaces.get(*target).map(|s| (s, 0)),
        TextureImage::Texels(_) => None,
    };
    // Size of a pixel and of a texel in bytes.
    let sizes = |texture: &Texture| match &texture.image {
        TextureImage::Target { target } => (plan.targets()[*target].format.bytes(), texture.format.bytes()),
        TextureImage::Texels(_) | TextureImage::Depth { .. } => (1, 1),
    };
    let seen = |texture: &Texture| {
        let ((surface, _), (pixel, texel)) = (surface(texture)?, sizes(texture));
        Some(SampledSurface { width: surface.width, states: &surface.states, pixel, texel })
    };
    let lane = plan.textures().iter().zip(words.images()).map(|(texture, image)| {
        // The lane has no colours for texels of another size.
        let (pixel, texel) = sizes(texture);
        let memory = surface(texture).filter(|_| pixel == texel);
        Image { memory: memory.map(|(s, channels)| (&s.held[..], channels)), ..image }
    });
    Images { lane: lane.collect(), words: words.images(), states: plan.textures().iter().map(seen).collect() }
}

/// Compares the final colours of the definition and the ideal.
fn outcome<M: Method>(plan: &Plan, options: &CompareOptions, surface: &Surface<M::Lane>) -> Outcome {
    let format = plan.targets()[options.target].format;
    let kept = surface::kept_channels(format) & options.channels;
    let mut out = Outcome { errors: Vec::with_capacity(surface.words.len()), ..Outcome::default() };
    let mut least = 0.0;
    for (at, (word, state)) in surface.words.iter().zip(&surface.states).enumerate() {
        let mut errors = if state.drawn && state.diverged { [f32::INFINITY; 4] } else { [f32::NAN; 4] };
        out.drawn += u64::from(state.drawn);
        out.diverged += u64::from(state.drawn && state.diverged);
        if state.drawn && !state.diverged {
            let shown = surface::final_channels(format, *word);
            let mut worst: Option<WorstPixel> = None;
            for channel in (0..4).filter(|n| kept >> n & 1 != 0) {
                let (ideal, parts) = M::channel(shown[channel], surface.held[at][channel], &mut out.counts);
                let (x, y) = ((at % surface.width) as u32, (surface.first_row + at / surface.width) as u32);
                let pixel = WorstPixel { x, y, channel, shown: shown[channel], ideal };
                let error = pixel.error();
                errors[channel] = error as f32;
                out.channels[channel].0.add(error);
                out.channels[channel].1.add(error);
                if let Some(parts) = parts {
                    out.parts.iter_mut().zip(parts).for_each(|(all, part)| all.add(part));
                    out.unexplained = out.unexplained.max((error - parts.iter().sum::<f64>()).abs());
                }
                if worst.is_none_or(|w| w.error().abs() < error.abs()) {
                    worst = Some(pixel);
                }
            }
            // Skips most pixels, which are no candidates.
            if let Some(worst) = worst.filter(|w| w.error().abs() > least) {
                out.worst.push(worst);
                if out.worst.len() >= 2 * WORST {
                    out.keep_worst();
                    least = out.worst.last().map_or(0.0, |w| w.error().abs());
                }
            }
        }
        out.errors.push(errors);
    }
    out.keep_worst();
    out
}

fn summed(plan: &Plan, options: &CompareOptions, outcome: Outcome) -> Comparison {
    let target = &plan.targets()[options.target];
    let mode = options.mode;
    let rules = outcome.counts.rules.iter().zip(Rule::ALL).filter(|(errors, _)| errors.count > 0);
    let decisions = outcome.counts.decisions.iter().zip(Decision::ALL).filter(|(counts, _)| counts[0] > 0);
    let kept = surface::kept_channels(target.format) & options.channels;
    let frames = mode != Mode::PerOp;
    let channels = (0..4).filter(|n| frames && kept >> n & 1 != 0).map(|channel| {
        let (errors, histogram) = outcome.channels[channel];
        ChannelError { channel, errors, histogram }
    });
    let parts = Part::ALL.iter().copied().zip(outcome.parts).filter(|_| mode == Mode::Follow).collect();
    Comparison {
        mode,
        target: target.name.clone(),
        width: target.width,
        height: target.height,
        drawn: outcome.drawn,
        diverged: outcome.diverged,
        channels: channels.collect(),
        parts,
        unexplained: if mode == Mode::Follow { outcome.unexplained } else { 0.0 },
        rules: rules
            .map(|(errors, rule)| RuleError { rule: *rule, errors: *errors, bound: bound::error_range(*rule, plan) })
            .collect(),
        decisions: decisions
            .map(|([taken, differing], decision)| DecisionCount {
                decision: *decision,
                taken: *taken,
                differing: *differing,
            })
            .collect(),
        worst: if frames { outcome.worst } else { Vec::new() },
        errors: if frames { outcome.errors } else { Vec::new() },
    }
}
