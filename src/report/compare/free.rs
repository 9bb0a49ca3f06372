//! The mode in which the ideal decides for itself: two evaluations, each with its own surface.
#![allow(clippy::float_arithmetic, reason = "the real-number reference; it never feeds a stored byte")]

use std::marker::PhantomData;

use super::draw::{Band, Draw, Method};
use super::meter::{Counts, Log};
use ninebit::engine::context::TriangleContext;
use ninebit::engine::pixel::Fragment;
use ninebit::engine::walk;
use ninebit::number::{Ideal, Lane};
use ninebit::plan::PlannedDraw;
use ninebit::raster::ideal::Outline;
use ninebit::raster::setup::Triangle;
use ninebit::raster::stroke::Figure;
use ninebit::state::{Cull, FrontFace, Named};
use ninebit::trace::{Decision, Observer, Part, Silent};

/// The definition and the ideal are evaluated independently and compared in the picture.
pub(super) struct Free;

impl Method for Free {
    type Lane = f64;

    fn draw(draw: &Draw<'_, f64>, band: &mut Band<'_, f64>, counts: &mut Counts) {
        for ((rows, columns), number) in walk::triangles(draw.planned, band.rows()) {
            let fixed = TriangleContext::new(draw.plan, draw.planned, number, rows);
            let shape = Shape::new(draw.planned, number, fixed.as_ref());
            let outer = |f: &Option<TriangleContext<'_>>| f.as_ref().map(|c| c.triangle.rows);
            let spans = outer(&fixed).into_iter().chain(shape.as_ref().map(Shape::rows));
            let Some(reach) = spans.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else { continue };
            for j in rows.0.max(reach.0)..rows.1.min(reach.1) {
                let definition = fixed.as_ref().map_or((0, 0), |c| c.triangle.span(j, columns));
                let ideal = shape.as_ref().map_or((0, 0), |shape| shape.span(j, columns));
                let inside = |span: (i64, i64), i: i64| (span.0..span.1).contains(&i);
                let both = [definition, ideal].into_iter().filter(|s| s.0 < s.1);
                let Some((low, high)) = both.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else { continue };
                for i in low..high {
                    let covered = (inside(definition, i), inside(ideal, i));
                    let is_left_out = fixed.as_ref().is_some_and(|context| context.is_left_out(i, j));
                    if covered != (false, false) && !is_left_out {
                        let triangle = (fixed.as_ref(), shape.as_ref());
                        pixel(draw, triangle, covered, (i, j), band, counts);
                    }
                }
            }
        }
    }

    fn channel(_shown: u8, held: f64, _counts: &mut Counts) -> (f64, Option<[f64; Part::ALL.len()]>) {
        (held, None)
    }
}

/// What the ideal covers.
enum Shape<'t> {
    /// A triangle before its vertices are snapped.
    Outline(Outline),
    /// A line, a point or smooth edges, as the definition has them.
    Stroke(&'t Triangle),
}

impl<'t> Shape<'t> {
    /// Returns the shape of a triangle, or `None` if it is culled.
    fn new(planned: &PlannedDraw, number: usize, fixed: Option<&'t TriangleContext<'_>>) -> Option<Shape<'t>> {
        match planned.assembly.triangles.figure(number) {
            Figure::Triangle if !planned.assembly.smooth_polygons => outline(planned, number).map(Shape::Outline),
            _ => fixed.map(|context| Shape::Stroke(&context.triangle)),
        }
    }

    fn rows(&self) -> (i64, i64) {
        match self {
            Shape::Outline(outline) => outline.rows,
            Shape::Stroke(triangle) => triangle.rows,
        }
    }

    fn span(&self, j: i64, columns: (i64, i64)) -> (i64, i64) {
        match self {
            Shape::Outline(outline) => outline.span(j, columns),
            Shape::Stroke(triangle) => triangle.span(j, columns),
        }
    }
}

/// Returns the outline of a triangle before its vertices are snapped, or `None` if it is culled.
fn outline(planned: &PlannedDraw, number: usize) -> Option<Outline> {
    let outline = Outline::new(planned.assembly.triangle(number).positions(), planned.perspective)?;
    let front = outline.counter_clockwise == (planned.front_face == FrontFace::CounterClockwise);
    match planned.cull {
        Cull::Front if front => None,
        Cull::Back if !front => None,
        Cull::None | Cull::Front | Cull::Back => Some(outline),
    }
}

/// Evaluates one pixel that either side covers.
fn pixel(
    draw: &Draw<'_, f64>,
    (fixed, shape): (Option<&TriangleContext<'_>>, Option<&Shape<'_>>),
    covered: (bool, bool),
    (i, j): (i64, i64),
    band: &mut Band<'_, f64>,
    counts: &mut Counts,
) {
    let at = band.at(i, j);
    counts.decided(Decision::Coverage, covered.0 != covered.1);
    let mut diverged = covered.0 != covered.1;
    let mut logs = [(); 2].map(|()| Log { diverged: &draw.images.states, ..Log::default() });
    let [definition, ideal] = &mut logs;
    if let (true, Some(context)) = (covered.0, fixed) {
        band.shade::<i32>(context, (i, j), None, &draw.images.words, definition);
    }
    // If the definition has no such triangle, the pixel is left out whatever the ideal holds.
    if let (true, Some(shape), Some(context)) = (covered.1, shape, fixed) {
        real_side(draw, context, shape, (i, j), band, ideal);
    }
    if covered == (true, true) {
        for (definition, ideal) in definition.decisions.iter().zip(&ideal.decisions) {
            // The list of the side that fails a test ends there; the other goes on.
            debug_assert_eq!(definition.0, ideal.0);
            counts.decided(definition.0, definition.1 != ideal.1);
            diverged |= definition.1 != ideal.1;
        }
    }
    band.states[at].diverged |= diverged || definition.tainted || ideal.tainted;
    band.states[at].drawn |= band.states[at].diverged;
}

/// Evaluates the ideal for a pixel that it covers.
fn real_side<L: Lane>(
    draw: &Draw<'_, L>,
    context: &TriangleContext<'_>,
    shape: &Shape<'_>,
    (i, j): (i64, i64),
    band: &mut Band<'_, L>,
    observer: &mut impl Observer,
) {
    let at = band.at(i, j);
    let (e, weights) = match shape {
        // Any sample will do, because the ideal uses its own weights.
        Shape::Outline(outline) => ([context.triangle.doubled_area, 0, 0], Some(outline.weights(i, j))),
        Shape::Stroke(triangle) => (triangle.edges(i, j), None),
    };
    let fragment = Fragment { pixel: (i, j), e, stored: band.words[at], weights };
    let (memory, held) = (&mut band.states[at].depth, band.held[at]);
    if let Some(stored) = context.shade::<L, _>(&fragment, memory, Some(held), &draw.images.lane, observer) {
        band.states[at].drawn = true;
        band.hold(at, draw.planned, &stored.channels);
    }
}

/// The ideal alone, in a lane of real numbers.
pub(super) struct Real<L>(PhantomData<L>);

impl<L: Ideal + Send + Sync> Method for Real<L> {
    type Lane = L;

    fn draw(draw: &Draw<'_, L>, band: &mut Band<'_, L>, _: &mut Counts) {
        for ((rows, columns), number) in walk::triangles(draw.planned, band.rows()) {
            let Some(context) = TriangleContext::new(draw.plan, draw.planned, number, rows) else { continue };
            let Some(shape) = Shape::new(draw.planned, number, Some(&context)) else { continue };
            for j in rows.0.max(shape.rows().0)..rows.1.min(shape.rows().1) {
                let (low, high) = shape.span(j, columns);
                for i in (low..high).filter(|i| !context.is_left_out(*i, j)) {
                    real_side(draw, &context, &shape, (i, j), band, &mut Silent);
                }
            }
        }
    }

    fn channel(_shown: u8, held: L, _counts: &mut Counts) -> (f64, Option<[f64; Part::ALL.len()]>) {
        (held.real(), None)
    }
}
