//! The trace of one pixel: the walk of the scalar engine, with a lane that carries the ideal, and a recorder.

use std::fmt;

use super::context::TriangleContext;
use super::pixel::{DepthStencil, Fragment};
use super::reals::{FragmentRecorder, Reals};
use super::{TextureWords, cleared, cleared_colors, draw_defined};
use crate::number::{Lane, Pair};
use crate::plan::{Plan, PlannedDraw};
use crate::raster::assemble::Piece;
use crate::raster::stroke::Figure;
use crate::rop::surface;
use crate::state::{Rectangle, StageOrigin, Target};
use crate::texture::planned::Image;
use crate::trace::{Observer, Silent, Step};

/// Everything that happens to one pixel of a render target.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelTrace {
    /// Name of the target.
    pub target: String,
    /// Column, 0 on the left.
    pub x: u32,
    /// Row, 0 at the top.
    pub y: u32,
    /// R, G, B and A as a picture shows them, after the clear.
    pub cleared: [u8; 4],
    /// R, G, B and A as a picture shows them, at the end.
    pub shown: [u8; 4],
    /// The stored word at the end.
    pub word: u32,
    /// Number of fragments before those of `draws`.
    pub left_out: u64,
    /// The triangles that cover the pixel, in order, without those left out.
    pub draws: Vec<DrawTrace>,
}

/// The fragment of one triangle at the pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawTrace {
    /// Number of the draw.
    pub draw: usize,
    /// Name of the draw in the scene.
    pub name: String,
    /// Number of the triangle in the draw.
    pub triangle: usize,
    /// What the triangle is.
    pub figure: Figure,
    /// The triangle that it was cut from, if it was clipped (RAS-6).
    pub piece: Option<Piece>,
    /// Whether it was stored, and not dropped by a test.
    pub stored: bool,
    /// R, G, B and A as a picture shows them, after this fragment.
    pub shown: [u8; 4],
    /// Every rule that was applied, in order.
    pub steps: Vec<Step>,
    /// The text of each general stage in the language of an API; empty if the program was written for the combiners.
    pub program_origin: Vec<StageOrigin>,
}

impl DrawTrace {
    /// Returns the line of an API's program that a block of steps comes from, if the block is a portion of a general stage.
    pub fn origin(&self, block: &str) -> Option<&str> {
        let (stage, portion) = block.strip_prefix("general stage ")?.split_once(' ')?;
        let origin = self.program_origin.get(stage.parse::<usize>().ok()?)?;
        Some(if portion == "rgb" { &origin.rgb } else { &origin.alpha })
    }
}

/// The pixel or the draw does not exist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TraceError {
    /// The target does not exist.
    Target {
        /// Number of the requested target.
        target: usize,
        /// Number of targets of the scene.
        count: usize,
    },
    /// The pixel is outside the target.
    Pixel {
        /// The column that was asked for.
        x: u32,
        /// The row that was asked for.
        y: u32,
        /// Name of the target.
        target: String,
        /// Width of the target.
        width: u32,
        /// Height of the target.
        height: u32,
    },
    /// The draw does not exist.
    Draw {
        /// Number of the requested draw.
        draw: usize,
        /// Number of draws of the scene.
        count: usize,
    },
}

impl fmt::Display for TraceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TraceError::Target { target, count } => {
                write!(f, "there is no target {target}; the scene has {count}, numbered from 0")
            }
            TraceError::Pixel { x, y, target, width, height } => {
                write!(f, "pixel {x},{y} lies outside target `{target}`, which is {width} x {height}")
            }
            TraceError::Draw { draw, count } => {
                write!(f, "there is no draw {draw}; the scene has {count}, numbered from 0")
            }
        }
    }
}

impl std::error::Error for TraceError {}

/// Largest number of fragments in a trace, unless more are asked for. They are the last ones.
pub const FRAGMENTS: u64 = 256;

/// Traces pixel (x, y) of target number `target`, with its last [`FRAGMENTS`] fragments. `only` restricts it to a single draw.
///
/// # Errors
/// The target or the draw does not exist, or the pixel lies outside the target.
pub fn trace(plan: &Plan, target: usize, pixel: (u32, u32), only: Option<usize>) -> Result<PixelTrace, TraceError> {
    trace_last(plan, target, pixel, only, FRAGMENTS)
}

/// Does the same as [`trace`], with the last `fragments` fragments. They are all kept in memory, some 60 KB each; [`Tracer`] passes them on
/// one by one.
///
/// # Errors
/// Those of [`trace`].
pub fn trace_last(
    plan: &Plan,
    target: usize,
    pixel: (u32, u32),
    only: Option<usize>,
    fragments: u64,
) -> Result<PixelTrace, TraceError> {
    Ok(Tracer::new(plan, target, pixel, only, fragments)?.collect::<Pair>(Reals::default()))
}

/// A prepared trace. The number of fragments is known, and each fragment is passed on as soon as it is shaded.
#[derive(Debug)]
pub struct Tracer<'a> {
    plan: &'a Plan,
    target: usize,
    pixel: (u32, u32),
    only: Option<usize>,
    left_out: u64,
}

/// The contents of the surface after the last draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TraceEnd {
    /// R, G, B and A as a picture shows them.
    pub shown: [u8; 4],
    /// The stored word.
    pub word: u32,
}

impl<'a> Tracer<'a> {
    /// Prepares the trace of pixel (x, y) of target number `target`, with its last `fragments` fragments. `only` restricts it to a single
    /// draw. Covered pixels are counted here, but nothing is shaded yet.
    ///
    /// # Errors
    /// The target or the draw does not exist, or the pixel lies outside the target.
    pub fn new(
        plan: &'a Plan,
        target: usize,
        pixel: (u32, u32),
        only: Option<usize>,
        fragments: u64,
    ) -> Result<Self, TraceError> {
        let (count, (x, y)) = (plan.targets.len(), pixel);
        let description = plan.targets.get(target).ok_or(TraceError::Target { target, count })?;
        if x >= description.width || y >= description.height {
            return Err(TraceError::Pixel {
                x,
                y,
                target: description.name.clone(),
                width: description.width,
                height: description.height,
            });
        }
        if let Some(draw) = only.filter(|d| *d >= plan.draws.len()) {
            return Err(TraceError::Draw { draw, count: plan.draws.len() });
        }
        let mut tracer = Tracer { plan, target, pixel, only, left_out: 0 };
        let mut count = 0_u64;
        for (_, planned) in tracer.draws().filter(|(index, _)| tracer.keeps(*index)) {
            let mut context = TriangleContext::vacant(plan, planned);
            count += (0..planned.assembly.triangles.len()).filter(|n| covered(&mut context, *n, pixel)).count() as u64;
        }
        tracer.left_out = count.saturating_sub(fragments);
        Ok(tracer)
    }

    /// Returns the render target.
    pub fn target(&self) -> &'a Target {
        &self.plan.targets[self.target]
    }

    /// Returns column and row.
    pub fn pixel(&self) -> (u32, u32) {
        self.pixel
    }

    /// Returns R, G, B and A as a picture shows them, before the first draw.
    pub fn cleared(&self) -> [u8; 4] {
        let target = self.target();
        let word = match &target.contents {
            Some(words) => words[self.at()],
            None => surface::pack(target.format, target.clear_color),
        };
        surface::show(target.format, word)
    }

    /// Returns the pixel's index, row by row from the top.
    fn at(&self) -> usize {
        self.pixel.1 as usize * self.target().width as usize + self.pixel.0 as usize
    }

    /// Returns the number of fragments before the first that is passed on.
    pub fn left_out(&self) -> u64 {
        self.left_out
    }

    fn keeps(&self, index: usize) -> bool {
        self.only.is_none_or(|only| only == index)
    }

    /// Returns the draws that may touch the pixel, with their numbers.
    fn draws(&self) -> impl Iterator<Item = (usize, &'a PlannedDraw)> {
        let (target, (x, y)) = (self.target, self.pixel);
        self.plan.draws.iter().enumerate().filter(move |(_, planned)| {
            let inside = |window: &Rectangle| {
                (window.x..window.x + window.width).contains(&x) && (window.y..window.y + window.height).contains(&y)
            };
            planned.target == target && planned.windows.iter().any(inside)
        })
    }

    /// Draws the pixel, and passes each kept fragment to `each`, in order.
    ///
    /// # Errors
    /// An error of `each`, which ends the trace.
    pub fn run<E>(&self, mut each: impl FnMut(DrawTrace) -> Result<(), E>) -> Result<TraceEnd, E> {
        let mut error = None;
        let end = self.run_each(&mut |fragment| {
            error = each(fragment).err();
            error.is_none()
        });
        error.map_or(Ok(end), Err)
    }

    /// Returns the whole trace, drawn as by [`run_with`](Self::run_with).
    pub(crate) fn collect<L: Lane>(&self, reals: Reals) -> PixelTrace {
        let mut draws = Vec::new();
        let TraceEnd { shown, word } = self.run_with::<L>(reals, &mut |draw| {
            draws.push(draw);
            true
        });
        let (target, (x, y), cleared) = (self.target().name.clone(), self.pixel, self.cleared());
        PixelTrace { target, x, y, cleared, shown, word, left_out: self.left_out, draws }
    }

    fn run_each(&self, each: &mut dyn FnMut(DrawTrace) -> bool) -> TraceEnd {
        self.run_with::<Pair>(Reals::default(), each)
    }

    /// Does the same as [`run`](Self::run) in a lane and with the real numbers of some rules, as long as `each` wants more. `each` is no
    /// type parameter, so that the pipe is compiled in this crate alone.
    fn run_with<L: Lane>(&self, reals: Reals, each: &mut dyn FnMut(DrawTrace) -> bool) -> TraceEnd {
        let (plan, description) = (self.plan, self.target());
        let mut frames = cleared(plan);
        // Whole frames are needed only if a later draw reads one.
        let rendered = plan.textures.iter().any(|t| t.image.target().is_some());
        let at = self.at();
        let word = frames.surfaces[self.target].words[at];
        let depth = frames.surfaces[self.target].depth.get(at).copied().unwrap_or(0);
        let mut pixel = Pixel::new(word, depth, cleared_colors(description, at));
        let place = (i64::from(self.pixel.0), i64::from(self.pixel.1));
        let mut passed_over = self.left_out;
        let mut finished = 0;
        'draws: for (index, planned) in self.draws() {
            if rendered {
                for before in &plan.draws[finished..index] {
                    draw_defined(plan, before, &mut frames, &mut Silent);
                }
                finished = index;
            }
            let texture_words = TextureWords::new(plan, std::slice::from_ref(planned), &frames.surfaces);
            let textures = texture_words.images::<L>();
            let mut context = TriangleContext::vacant(plan, planned);
            for number in 0..planned.assembly.triangles.len() {
                if !covered(&mut context, number, self.pixel) {
                    continue;
                }
                context.complete();
                if !self.keeps(index) || passed_over > 0 {
                    passed_over -= u64::from(self.keeps(index));
                    pixel.shade(planned, &context, place, &textures, &mut reals.clone());
                    continue;
                }
                let mut recorder = FragmentRecorder { reals, ..FragmentRecorder::default() };
                let stored = pixel.shade(planned, &context, place, &textures, &mut recorder);
                let is_wanted = each(DrawTrace {
                    draw: index,
                    name: planned.name.clone(),
                    triangle: context.number,
                    figure: context.triangle.figure,
                    piece: planned.assembly.clipping.piece(context.number).copied(),
                    stored,
                    shown: surface::show(planned.surface, pixel.word),
                    steps: recorder.steps,
                    program_origin: planned.program_origin.clone(),
                });
                if !is_wanted {
                    break 'draws;
                }
            }
        }
        TraceEnd { shown: surface::show(description.format, pixel.word), word: pixel.word }
    }
}

/// Returns whether triangle `number` covers a pixel. Texture coordinates and fog are not set up.
fn covered(context: &mut TriangleContext<'_>, number: usize, (x, y): (u32, u32)) -> bool {
    let (i, j) = (i64::from(x), i64::from(y));
    context.set_up(number, (j, j + 1)) && context.triangle.contains(i, j) && !context.is_left_out(i, j)
}

/// The contents of a traced pixel.
pub(super) struct Pixel {
    word: u32,
    depth: DepthStencil,
    /// Contents of a surface of real numbers: R, G, B and A in 255ths.
    ideal: [f64; 4],
}

impl Pixel {
    /// Creates a pixel of a surface that nothing is drawn into yet.
    pub(super) fn new(word: u32, depth: u32, colors: [u8; 4]) -> Pixel {
        Pixel { word, depth: DepthStencil::new(depth), ideal: colors.map(f64::from) }
    }

    /// Shades one fragment. Returns whether it was stored.
    pub(super) fn shade<L: Lane, O: Observer>(
        &mut self,
        planned: &PlannedDraw,
        context: &TriangleContext<'_>,
        pixel: (i64, i64),
        textures: &[Image<'_, L>],
        observer: &mut O,
    ) -> bool {
        let e = context.triangle.edges(pixel.0, pixel.1);
        let fragment = Fragment { pixel, e, stored: self.word, weights: None };
        let fixed = surface::read(planned.surface, self.word);
        let destination = std::array::from_fn(|n| L::value(i32::from(fixed[n]), || self.ideal[n]));
        let stored = context.shade(&fragment, &mut self.depth, Some(destination), textures, observer);
        let Some(stored) = stored else { return false };
        self.word = stored.word;
        for n in (0..4).filter(|n| planned.written >> n & 1 != 0) {
            if let (_, Some(ideal)) = stored.channels[n].observe() {
                self.ideal[n] = ideal.clamp(0.0, 255.0);
            }
        }
        true
    }
}
