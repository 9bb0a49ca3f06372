//! Draws a plan with shortcuts.

use std::borrow::Cow;

use super::{Shortcut, Shortcuts};
use crate::engine::context::TriangleContext;
use crate::engine::pixel::{DepthStencil, Fragment};
use crate::engine::{self, PixelTrace, RenderOptions, TextureWords, TraceError, Tracer, walk};
use crate::frame::{Frames, Surface};
use crate::number::{Lane, Pair};
use crate::plan::{Plan, PlannedDraw};
use crate::raster::ideal::Outline;
use crate::raster::stroke::Figure;
use crate::trace::{Observer, Silent};

/// One of so many pixels is few: the scalar engine draws them sooner than the fast one draws all.
const FEW: usize = 32;

/// Pixels of the first target that are wanted.
#[derive(Clone, Debug)]
pub struct PixelSelection {
    /// Their columns, row after row, in order.
    columns: Vec<u32>,
    /// Of each row, and of that behind the last, the number of pixels before it.
    starts: Vec<u32>,
    width: u32,
}

impl PixelSelection {
    /// Returns those of a target, row by row from the top, whose places are given in order.
    pub fn new((width, height): (u32, u32), places: impl IntoIterator<Item = usize>) -> PixelSelection {
        let mut wanted = PixelSelection { columns: Vec::new(), starts: vec![0], width };
        for place in places {
            while wanted.starts.len() * width as usize <= place {
                wanted.starts.push(wanted.columns.len() as u32);
            }
            wanted.columns.push((place % width as usize) as u32);
        }
        wanted.starts.resize(height as usize + 1, wanted.columns.len() as u32);
        wanted
    }

    /// Returns the number of pixels.
    pub fn count(&self) -> usize {
        self.columns.len()
    }

    /// Returns their places in order.
    pub fn places(&self) -> impl Iterator<Item = usize> {
        (0..self.starts.len().saturating_sub(1))
            .flat_map(move |row| self.row(row).iter().map(move |column| row * self.width as usize + *column as usize))
    }

    /// Returns what a picture has in their places.
    pub fn of<T: Copy>(&self, picture: &[T]) -> Vec<T> {
        self.places().filter_map(|place| picture.get(place).copied()).collect()
    }

    fn row(&self, row: usize) -> &[u32] {
        let at = |row: usize| self.starts.get(row).map_or(self.columns.len(), |start| *start as usize);
        &self.columns[at(row)..at(row + 1)]
    }

    /// Returns their columns in a part of a row.
    fn within(&self, row: i64, (first, end): (i64, i64)) -> &[u32] {
        let row = self.row(row as usize);
        let before = |limit: i64| row.partition_point(|column| i64::from(*column) < limit);
        &row[before(first)..before(end)]
    }
}

/// The pixels that are wanted; others are not drawn. `None` draws all.
pub type Mask<'a> = Option<&'a PixelSelection>;

/// Returns the frames of a plan of the chip's rules as a renderer with shortcuts draws it.
pub fn drawn(plan: &Plan, shortcuts: Shortcuts, options: &RenderOptions, mask: Mask<'_>) -> Frames {
    let plan = changed(plan, shortcuts);
    let mut frames = engine::cleared(&plan);
    render(&plan, shortcuts, options, &mut frames, mask);
    frames
}

/// Returns a plan of the chip's rules as a renderer with shortcuts would have it.
fn changed(plan: &Plan, shortcuts: Shortcuts) -> Cow<'_, Plan> {
    if shortcuts.is_empty() { Cow::Borrowed(plan) } else { Cow::Owned(plan.clone().with_shortcuts(shortcuts)) }
}

/// Draws a plan, which has these shortcuts already, on frames that are cleared or hold what was there before.
///
/// Where no shortcut needs the scalar engine, and many pixels are wanted, the engine of `options` draws all. Otherwise the scalar one draws those
/// that are wanted.
pub fn render(plan: &Plan, shortcuts: Shortcuts, options: &RenderOptions, frames: &mut Frames, mask: Mask<'_>) {
    // A draw that reads the first target may read any of its pixels.
    let is_read = plan.textures.iter().any(|texture| texture.image.target() == Some(0));
    let mask = mask.filter(|_| !is_read);
    let pixels = plan.targets.first().map_or(0, |target| target.width as usize * target.height as usize);
    let are_few = |mask: &PixelSelection| mask.count() * FEW < pixels;
    if !shortcuts.need_scalar() {
        match mask.filter(|mask| are_few(mask)) {
            Some(mask) => draw_all::<i32, _>(plan, shortcuts, frames, Some(mask), &mut Silent),
            None => {
                engine::Renderer::new(plan, options).redraw(frames);
            }
        }
    } else if shortcuts.lead() {
        draw_all::<Pair<f32>, _>(plan, shortcuts, frames, mask, &mut shortcuts.reals());
    } else {
        draw_all::<Pair, _>(plan, shortcuts, frames, mask, &mut shortcuts.reals());
    }
}

/// Traces a pixel of a target of a plan of the chip's rules as a renderer with shortcuts draws it, with its last `fragments` fragments.
///
/// # Errors
/// There is no such target, or the pixel lies outside of it.
pub fn trace(
    plan: &Plan,
    shortcuts: Shortcuts,
    target: usize,
    pixel: (u32, u32),
    fragments: u64,
) -> Result<PixelTrace, TraceError> {
    let plan = &*changed(plan, shortcuts);
    let tracer = Tracer::new(plan, target, pixel, None, fragments)?;
    Ok(match shortcuts.lead() {
        true => tracer.collect::<Pair<f32>>(shortcuts.reals()),
        false => tracer.collect::<Pair>(shortcuts.reals()),
    })
}

fn draw_all<L: Lane, O: Observer>(
    plan: &Plan,
    shortcuts: Shortcuts,
    frames: &mut Frames,
    mask: Mask<'_>,
    observer: &mut O,
) {
    for planned in &plan.draws {
        // The surface leaves the frames during the draw, so that the other surfaces can be read as textures.
        let surface = &mut frames.surfaces[planned.target];
        let (mut words, mut depth) = (std::mem::take(&mut surface.words), std::mem::take(&mut surface.depth));
        let mask = mask.filter(|_| planned.target == 0);
        draw::<L, O>(plan, planned, shortcuts, &frames.surfaces, (&mut words, &mut depth), mask, observer);
        let surface = &mut frames.surfaces[planned.target];
        (surface.words, surface.depth) = (words, depth);
    }
}

fn draw<L: Lane, O: Observer>(
    plan: &Plan,
    planned: &PlannedDraw,
    shortcuts: Shortcuts,
    surfaces: &[Surface],
    (words, depth): (&mut [u32], &mut [u32]),
    mask: Mask<'_>,
    observer: &mut O,
) {
    let textures = TextureWords::new(plan, std::slice::from_ref(planned), surfaces);
    let images = textures.images::<L>();
    let target = &plan.targets[planned.target];
    let is_unsnapped = shortcuts.contains(Shortcut::UnsnappedVertices);
    let mut outline: Option<(usize, Option<Outline>)> = None;
    let mut shade = |context: &TriangleContext<'_>, i: i64, j: i64| {
        if context.is_left_out(i, j) {
            return;
        }
        let at = j as usize * target.width as usize + i as usize;
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
        let stored = context.shade::<L, _>(&fragment, &mut memory, None, &images, observer);
        if let Some(slot) = depth.get_mut(at) {
            *slot = memory.word();
        }
        if let Some(stored) = stored {
            words[at] = stored.word;
        }
    };
    walk::spans(plan, planned, (0, i64::from(target.height)), |context, j, span| match mask {
        Some(mask) => mask.within(j, span).iter().for_each(|i| shade(context, i64::from(*i), j)),
        None => (span.0..span.1).for_each(|i| shade(context, i, j)),
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wanted_pixels_by_rows() {
        let places = [3, 4, 9, 21];
        let wanted = PixelSelection::new((5, 6), places);
        assert_eq!((wanted.count(), wanted.places().collect::<Vec<_>>()), (4, places.to_vec()));
        assert_eq!(wanted.of(&(0..30).collect::<Vec<_>>()), places);
        let within = |row, first, end| wanted.within(row, (first, end));
        assert_eq!((within(0, 0, 4), within(0, 0, 5), within(1, 4, 5)), (&[3][..], &[3, 4][..], &[4][..]));
        assert_eq!(
            (within(2, 0, 5), within(4, 0, 1), within(4, 1, 5), within(5, 0, 5)),
            (&[][..], &[][..], &[1][..], &[][..])
        );
    }
}
