//! Draws a plan with shortcuts.

use super::reals::RealsRecorder;
use super::{Shortcut, Shortcuts};
use crate::engine::pixel::{DepthStencil, Fragment};
use crate::engine::{self, PixelTrace, RenderOptions, TextureWords, TraceError, Tracer, walk};
use crate::frame::{Frames, Surface};
use crate::number::{Lane, Paired};
use crate::plan::{Plan, PlannedDraw};
use crate::raster::ideal::Outline;
use crate::raster::stroke::Figure;

/// One of so many pixels is few: the scalar engine draws them sooner than the fast one draws all.
const FEW: usize = 32;

/// The pixels of the first target that are wanted, row by row; others are not drawn. `None` draws all.
pub type Mask<'a> = Option<&'a [bool]>;

/// Draws a plan, which has these shortcuts already, on frames that are cleared or hold what was there before.
///
/// Where no shortcut needs the scalar engine, and many pixels are wanted, the engine of `options` draws all. Otherwise the scalar one draws those
/// that are wanted.
pub fn render(plan: &Plan, shortcuts: Shortcuts, options: &RenderOptions, frames: &mut Frames, mask: Mask<'_>) {
    // A draw that reads the first target may read any of its pixels.
    let is_read = plan.textures.iter().any(|texture| texture.image.target() == Some(0));
    let mask = mask.filter(|_| !is_read);
    let are_few = |mask: &[bool]| mask.iter().filter(|wanted| **wanted).count() * FEW < mask.len();
    if !shortcuts.need_scalar() {
        match mask.filter(|mask| are_few(mask)) {
            Some(mask) => draw_all::<i32>(plan, shortcuts, frames, Some(mask)),
            None => {
                engine::Renderer::new(plan, options).redraw(frames);
            }
        }
    } else if shortcuts.lead() {
        draw_all::<Paired<f32>>(plan, shortcuts, frames, mask);
    } else {
        draw_all::<Paired>(plan, shortcuts, frames, mask);
    }
}

/// Traces a pixel of the first target of a plan, which has these shortcuts already, with its last `fragments` fragments.
///
/// # Errors
/// The pixel lies outside of the target.
pub fn trace(plan: &Plan, shortcuts: Shortcuts, pixel: (u32, u32), fragments: u64) -> Result<PixelTrace, TraceError> {
    let tracer = Tracer::new(plan, 0, pixel, None, fragments)?;
    let mut draws = Vec::new();
    let keep = |draw| {
        draws.push(draw);
        Ok::<(), std::convert::Infallible>(())
    };
    let observer = || RealsRecorder { reals: shortcuts.reals(), ..RealsRecorder::default() };
    let Ok(end) = if shortcuts.lead() {
        tracer.run_with::<Paired<f32>, _, _>(observer, |observer| observer.recorder.steps, keep)
    } else {
        tracer.run_with::<Paired, _, _>(observer, |observer| observer.recorder.steps, keep)
    };
    let (cleared, left_out) = (tracer.cleared(), tracer.left_out());
    let (target, (x, y)) = (tracer.target().name.clone(), pixel);
    Ok(PixelTrace { target, x, y, cleared, shown: end.shown, word: end.word, left_out, draws })
}

fn draw_all<L: Lane>(plan: &Plan, shortcuts: Shortcuts, frames: &mut Frames, mask: Mask<'_>) {
    for planned in &plan.draws {
        // The surface leaves the frames during the draw, so that the other surfaces can be read as textures.
        let surface = &mut frames.surfaces[planned.target];
        let (mut words, mut depth) = (std::mem::take(&mut surface.words), std::mem::take(&mut surface.depth));
        let mask = mask.filter(|_| planned.target == 0);
        draw::<L>(plan, planned, shortcuts, &frames.surfaces, (&mut words, &mut depth), mask);
        let surface = &mut frames.surfaces[planned.target];
        (surface.words, surface.depth) = (words, depth);
    }
}

fn draw<L: Lane>(
    plan: &Plan,
    planned: &PlannedDraw,
    shortcuts: Shortcuts,
    surfaces: &[Surface],
    (words, depth): (&mut [u32], &mut [u32]),
    mask: Mask<'_>,
) {
    let textures = TextureWords::new(plan, std::slice::from_ref(planned), surfaces);
    let images = textures.images::<L>();
    let target = &plan.targets[planned.target];
    let mut reals = shortcuts.reals();
    let is_unsnapped = shortcuts.contains(Shortcut::UnsnappedVertices);
    let mut outline: Option<(usize, Option<Outline>)> = None;
    walk::covered(plan, planned, (0, i64::from(target.height)), |context, i, j| {
        let at = j as usize * target.width as usize + i as usize;
        if mask.is_some_and(|mask| !mask[at]) {
            return;
        }
        let mut memory = DepthStencil::new(depth.get(at).copied().unwrap_or(0));
        let e = context.triangle.edges(i, j);
        let mut fragment = Fragment { pixel: (i, j), e, stored: words[at], weights: None };
        if is_unsnapped && context.triangle.figure == Figure::Triangle {
            let number = context.number;
            if outline.as_ref().is_none_or(|(of, _)| *of != number) {
                let positions = planned.assembly.triangle(number).positions();
                outline = Some((number, Outline::new(positions, planned.perspective)));
            }
            fragment.weights = outline.as_ref().and_then(|(_, outline)| Some(outline.as_ref()?.weights(i, j)));
        }
        let stored = context.shade::<L, _>(&fragment, &mut memory, None, &images, &mut reals);
        if let Some(slot) = depth.get_mut(at) {
            *slot = memory.word();
        }
        if let Some(stored) = stored {
            words[at] = stored.word;
        }
    });
}
