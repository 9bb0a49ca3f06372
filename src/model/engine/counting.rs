//! Counts the work of a render while it is done, and the fragments of draws without shading them.

use super::bins::within;
use super::context::TriangleContext;
use super::{cleared, draw_defined, walk};
use crate::plan::{Plan, PlanError, PlannedDraw};
use crate::state::Named;
use crate::trace::{Observer, Step, Work};
use std::ops::Range;

/// The work of one draw.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawCounts {
    /// Number of covered pixels, counted once for each triangle that covers them.
    pub fragments: u64,
    /// Number of fragments that passed the tests.
    pub stored: u64,
    /// Amount of each kind of work, in the order of `Work::ALL`.
    pub work: [u64; Work::ALL.len()],
}

impl Observer for DrawCounts {
    const ON: bool = false;
    const COUNTS: bool = true;
    fn step(&mut self, _step: Step) {}
    fn count(&mut self, work: Work, amount: u64) {
        self.work[work as usize] += amount;
    }
}

/// Renders a plan on one thread, and returns the counts of each draw.
pub fn count(plan: &Plan) -> Vec<DrawCounts> {
    let mut frames = cleared(plan);
    let count = |planned: &PlannedDraw| {
        let mut counts = DrawCounts::default();
        (counts.fragments, counts.stored) = draw_defined(plan, planned, &mut frames, &mut counts);
        counts
    };
    plan.draws.iter().map(count).collect()
}

/// Number of pixels that a draw shades.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadedPixels {
    /// Covered pixels, once for each triangle that covers them.
    pub pixels: u64,
    /// Whether the pixels were counted; otherwise they are an upper bound.
    pub exact: bool,
}

/// Rows of triangles that are looked at before a bound has to do, for all draws of a plan: some tens of milliseconds.
pub(super) const ROWS: u64 = 1 << 22;

/// Returns the number of pixels that each draw of a plan shades. They are counted unless their triangles have more than some millions of rows; the
/// draws that are left then have upper bounds, so that the answer takes little time for any plan.
pub fn shaded(plan: &Plan) -> Vec<ShadedPixels> {
    let mut left = ROWS;
    let draw = |planned: &PlannedDraw| {
        let most = Most::new(plan, planned);
        match left.checked_sub(most.rows) {
            Some(rest) => {
                left = rest;
                ShadedPixels { pixels: fragments(plan, planned), exact: true }
            }
            None => ShadedPixels { pixels: most.pixels, exact: false },
        }
    };
    plan.draws.iter().map(draw).collect()
}

/// Checks that a plan shades at most so many pixels, as [`Limits::shaded_pixels`](crate::limits::Limits) says. It takes little time for any plan.
///
/// # Errors
/// The plan shades more, or so many that they are not counted and may be more. The error names the draw with the most.
#[allow(clippy::result_large_err, reason = "it is made once a scene")]
pub fn affordable(plan: &Plan, most: u64) -> Result<(), PlanError> {
    let total = |draws: &[ShadedPixels]| draws.iter().map(|draw| draw.pixels).fold(0, u64::saturating_add);
    let bounds =
        plan.draws.iter().map(|planned| ShadedPixels { pixels: Most::new(plan, planned).pixels, exact: false });
    if total(&bounds.collect::<Vec<_>>()) <= most {
        return Ok(());
    }
    let draws = shaded(plan);
    let pixels = total(&draws);
    if pixels <= most {
        return Ok(());
    }
    let largest = (0..draws.len()).max_by_key(|index| draws[*index].pixels);
    let bound = if draws.iter().all(|draw| draw.exact) { "" } else { "at most " };
    let message = format!("the draws shade {bound}{pixels} pixels; {most} are allowed");
    let help = "draw fewer or smaller triangles; the option `--work` of the program allows more";
    Err(PlanError { draw: largest, ..PlanError::new("NB0611", None, message, help) })
}

/// Returns the number of covered pixels of a draw, without shading them. It takes as long as there are rows in its triangles.
pub fn fragments(plan: &Plan, planned: &PlannedDraw) -> u64 {
    let mut count = 0;
    spans(plan, planned, |pixels| {
        count += pixels;
        true
    });
    count
}

/// Visits the rows of a draw's triangles with the number of pixels that are covered on each, as long as `visit` wishes.
pub(super) fn spans(plan: &Plan, planned: &PlannedDraw, mut visit: impl FnMut(u64) -> bool) {
    let rows = (0, i64::from(plan.targets[planned.target].height));
    let mut context = TriangleContext::vacant(plan, planned);
    for ((rows, columns), number) in walk::triangles(planned, rows) {
        if !context.set_up(number, rows) {
            continue;
        }
        let triangle = &context.triangle;
        for row in triangle.rows.0.max(rows.0)..triangle.rows.1.min(rows.1) {
            let (first, end) = triangle.span(row, columns);
            let pixels = match planned.polygon_stipple.is_some() || triangle.is_smooth {
                false => (end - first) as u64,
                true => (first..end).filter(|i| !context.is_left_out(*i, row)).count() as u64,
            };
            if !visit(pixels) {
                return;
            }
        }
    }
}

/// Upper bounds of a draw's work.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Most {
    /// Pixels that it shades.
    pub(super) pixels: u64,
    /// Rows of its triangles within its windows.
    pub(super) rows: u64,
}

impl Most {
    pub(super) fn new(plan: &Plan, planned: &PlannedDraw) -> Most {
        let target = &plan.targets[planned.target];
        let all = (0, i64::from(target.height));
        let windows: Vec<walk::Window> = walk::windows(planned, all).collect();
        let whole = |range: fn(&walk::Window) -> (i64, i64)| {
            let ends = windows.iter().map(range);
            ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default()
        };
        let (rows, columns) = (whole(|window| window.0), whole(|window| window.1));
        let mut most = Most::default();
        for number in 0..planned.assembly.triangles.len() {
            if TriangleContext::may_cover(planned, number, rows) {
                let [across, down] =
                    [(0, columns), (1, rows)].map(|(axis, limits)| part(planned, number, axis, limits));
                most.rows = most.rows.saturating_add(down * windows.len() as u64);
                most.pixels = most.pixels.saturating_add(pixels(planned.assembly.area(number), across, down));
            }
        }
        most
    }
}

/// Returns the length of the part of a triangle's columns or rows that lies within limits.
fn part(planned: &PlannedDraw, number: usize, axis: usize, limits: (i64, i64)) -> u64 {
    let (first, end) = planned.assembly.bounds(number, axis);
    let Range { start, end } = within((first - limits.0, end - limits.0), (limits.1 - limits.0) as usize);
    (end - start) as u64
}

/// Returns the most centres of pixels that the part of a triangle within a rectangle holds, if it holds centres in so many columns and rows. `area` is
/// the triangle's, rounded down.
///
/// A convex figure of area A and perimeter P holds at most A + P / 2 + 1 points of a lattice (Nosarzewska). Half of its perimeter is at most that of
/// the box around it, whose sides are at most one longer than the number of centres along them.
fn pixels(area: u64, columns: u64, rows: u64) -> u64 {
    (columns * rows).min(area + 1 + (columns + 1) + (rows + 1) + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{RenderOptions, render_counted};
    use crate::plan::PlanOptions;
    use crate::random::Random;
    use crate::state::*;

    /// Returns a plan of one draw of triangles whose corners lie anywhere up to `reach` pixels around the target.
    #[allow(clippy::float_arithmetic, reason = "corners in sixteenths of a pixel")]
    fn plan(count: u32, side: u32, reach: u32, change: impl FnOnce(&mut Draw)) -> Plan {
        let mut random = Random::seeded(u64::from(count + side + reach));
        let mut place = || random.below(u128::from(16 * (side + 2 * reach))) as f32 / 16.0 - reach as f32;
        let corner = |position| Vertex { position, ..Vertex::default() };
        let vertices: Vec<Vertex> = (0..3 * count).map(|_| corner([place(), place(), 0.0, 1.0])).collect();
        let mut draw = Draw { vertices: vertices.into(), indices: (0..3 * count).collect(), ..Draw::default() };
        change(&mut draw);
        let targets = vec![Target::new(side, side, SurfaceFormat::A8R8G8B8)];
        let scene = Scene { profile: Profile::Nv2a, targets, draws: vec![draw], ..Scene::default() };
        Plan::compile(&scene, &PlanOptions::default()).expect("a legal scene")
    }

    fn window(x: u32, y: u32, width: u32, height: u32) -> Rectangle {
        Rectangle { x, y, width, height }
    }

    #[test]
    fn pixels_are_those_that_a_render_shades_and_no_more_than_the_bound() {
        let clips = [
            None,
            Some(WindowClip { rectangles: vec![window(3, 5, 7, 9), window(20, 1, 3, 40)], exclusive: false }),
            Some(WindowClip { rectangles: vec![window(3, 5, 7, 9)], exclusive: true }),
        ];
        for (reach, count) in [(0, 1), (0, 200), (40, 200), (4000, 200), (200, 1)] {
            for (clip, cull) in clips.iter().zip([Cull::None, Cull::Back, Cull::Front]) {
                let plan = plan(count, 48, reach, |draw| (draw.window_clip, draw.cull) = (clip.clone(), cull));
                let rendered = render_counted(&plan, &RenderOptions::default(), &|_, _| {}).1.shaded_pixels;
                assert_eq!(shaded(&plan), [ShadedPixels { pixels: rendered[0], exact: true }]);
                let most = Most::new(&plan, &plan.draws[0]);
                assert!(most.pixels >= rendered[0], "{most:?} {rendered:?}");
                assert_eq!(affordable(&plan, rendered[0]), Ok(()));
                if let Some(less) = rendered[0].checked_sub(1) {
                    let error = affordable(&plan, less).expect_err("one too many");
                    assert_eq!((error.code, error.draw), ("NB0611", Some(0)));
                }
            }
        }
    }

    #[test]
    fn bounds_follow_the_area() {
        let half = |draw: &mut Draw| {
            let corner = |x: f32, y: f32| Vertex { position: [x, y, 0.0, 1.0], ..Vertex::default() };
            draw.vertices = vec![corner(0.0, 0.0), corner(1000.0, 0.0), corner(0.0, 1000.0)].into();
        };
        let most = Most::new(&plan(1, 1000, 0, half), &plan(1, 1000, 0, half).draws[0]);
        assert!((499_500..510_000).contains(&most.pixels) && most.rows == 1000, "{most:?}");
    }

    /// Many rows are not looked at.
    #[test]
    fn large_plans_have_bounds() {
        let large = plan(3000, 4096, 0, |_| {});
        let [ShadedPixels { pixels, exact }] = shaded(&large)[..] else { panic!("one draw") };
        assert!(!exact && pixels >= fragments(&large, &large.draws[0]), "{pixels}");
        assert_eq!(affordable(&large, pixels), Ok(()));
        let error = affordable(&large, pixels - 1).expect_err("too many").message;
        assert_eq!(error, format!("the draws shade at most {pixels} pixels; {} are allowed", pixels - 1));
    }
}
