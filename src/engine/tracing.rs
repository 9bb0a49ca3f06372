//! The trace of one pixel: the same walk, the lane that carries the ideal beside the definition, and a recorder.

use super::pixel::{Fragment, TriangleContext};
use super::{cleared, cleared_colors, draw_defined, images};
use crate::number::Paired;
use crate::plan::{Plan, PlannedDraw};
use crate::raster::assemble::Piece;
use crate::rop::surface;
use crate::state::{StageOrigin, TextureImage};
use crate::texture::unit::Image;
use crate::trace::{Recorder, Step};

/// Everything that happened to one pixel of a render target.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelTrace {
    /// Name of the target.
    pub target: String,
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// R, G, B, A as a picture shows them, after the clear.
    pub cleared: [u8; 4],
    /// R, G, B, A as a picture shows them, at the end.
    pub shown: [u8; 4],
    /// The stored word at the end.
    pub word: u32,
    /// Each triangle that covers the pixel, in order.
    pub draws: Vec<DrawTrace>,
}

/// One triangle's fragment at the pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawTrace {
    /// Number of the draw.
    pub draw: usize,
    /// Its name.
    pub name: String,
    /// Number of the triangle in the draw.
    pub triangle: usize,
    /// What it is a piece of, if it was cut off another (RAS-6).
    pub piece: Option<Piece>,
    /// Whether it was stored, or dropped by a test.
    pub stored: bool,
    /// R, G, B, A as a picture shows them, after this fragment.
    pub shown: [u8; 4],
    /// Every rule that was applied, in order.
    pub steps: Vec<Step>,
    /// What each general stage was written as in the language of an API; empty if the program was written for the combiners.
    pub program_origin: Vec<StageOrigin>,
}

impl DrawTrace {
    /// What a block of the steps was written as: a portion of a general stage, of a program in the language of an API.
    pub fn origin(&self, block: &str) -> Option<&str> {
        let (stage, portion) = block.strip_prefix("general stage ")?.split_once(' ')?;
        let origin = self.program_origin.get(stage.parse::<usize>().ok()?)?;
        Some(if portion == "rgb" { &origin.rgb } else { &origin.alpha })
    }
}

/// A pixel or draw that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TraceError {
    /// Outside the target.
    #[error("pixel {x},{y} lies outside target `{target}`, which is {width} x {height}")]
    Pixel {
        /// Column asked for.
        x: u32,
        /// Row asked for.
        y: u32,
        /// Target.
        target: String,
        /// Its columns.
        width: u32,
        /// Its rows.
        height: u32,
    },
    /// No such draw.
    #[error("there is no draw {draw}; the scene has {count}, numbered from 0")]
    Draw {
        /// Draw asked for.
        draw: usize,
        /// Draws of the scene.
        count: usize,
    },
}

/// Traces pixel (x, y) of target number `target`; `only` keeps a single draw in the result.
///
/// # Errors
/// The pixel lies outside the target, or the draw does not exist.
pub fn trace(plan: &Plan, target: usize, (x, y): (u32, u32), only: Option<usize>) -> Result<PixelTrace, TraceError> {
    let description = &plan.targets[target];
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
    let mut frames = cleared(plan);
    // Whole frames are needed only where a later draw reads one.
    let rendered = plan.textures.iter().any(|t| matches!(t.image, TextureImage::Target { .. }));
    let at = y as usize * description.width as usize + x as usize;
    let word = frames.surfaces[target].words[at];
    let depth = frames.surfaces[target].depth.get(at).copied().unwrap_or(0);
    let clear = cleared_colors(description).map(f64::from);
    let mut pixel = Pixel { word, depth, ideal: clear };
    let cleared = surface::show(description.format, word);
    let mut draws = Vec::new();
    for (index, planned) in plan.draws.iter().enumerate() {
        if planned.target == target {
            let textures = images(plan, &frames.surfaces);
            let traced = pixel.draw(plan, planned, index, (x, y), &textures);
            draws.extend(traced.into_iter().filter(|_| only.is_none_or(|d| d == index)));
        }
        if rendered {
            draw_defined(plan, index, &mut frames);
        }
    }
    let shown = surface::show(description.format, pixel.word);
    Ok(PixelTrace { target: description.name.clone(), x, y, cleared, shown, word: pixel.word, draws })
}

/// The traced pixel's memory.
struct Pixel {
    word: u32,
    depth: u32,
    /// What a surface of real numbers would hold, R, G, B, A in 255ths.
    ideal: [f64; 4],
}

impl Pixel {
    fn draw(
        &mut self,
        plan: &Plan,
        planned: &PlannedDraw,
        index: usize,
        (x, y): (u32, u32),
        textures: &[Image<'_, Paired>],
    ) -> Vec<DrawTrace> {
        let window = &planned.window;
        let inside =
            (window.x..window.x + window.width).contains(&x) && (window.y..window.y + window.height).contains(&y);
        if !inside {
            return Vec::new();
        }
        let (i, j) = (i64::from(x), i64::from(y));
        let mut traces = Vec::new();
        for number in 0..planned.assembly.triangles.len() {
            let Some(context) = TriangleContext::new(plan, planned, number, (j, j + 1)) else { continue };
            let e = context.triangle.edges(i, j);
            if !context.triangle.covers(e) {
                continue;
            }
            let mut recorder = Recorder::default();
            let fragment =
                Fragment { pixel: (i, j), e, stored: self.word, stored_depth: i64::from(self.depth), weights: None };
            let fixed = surface::read(planned.surface, self.word);
            let destination = std::array::from_fn(|n| Paired { fixed: i32::from(fixed[n]), ideal: self.ideal[n] });
            let stored = context.shade(&fragment, Some(destination), textures, &mut recorder);
            if let Some(stored) = &stored {
                self.word = stored.word;
                self.depth = stored.depth.map_or(self.depth, |depth| depth as u32);
                for n in (0..4).filter(|n| planned.written >> n & 1 != 0) {
                    self.ideal[n] = stored.channels[n].ideal.clamp(0.0, 255.0);
                }
            }
            traces.push(DrawTrace {
                draw: index,
                name: planned.name.clone(),
                triangle: context.number,
                piece: planned.assembly.clipping.piece(context.number).copied(),
                stored: stored.is_some(),
                shown: surface::show(planned.surface, self.word),
                steps: recorder.steps,
                program_origin: planned.program_origin.clone(),
            });
        }
        traces
    }
}
