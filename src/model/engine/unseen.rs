//! Says why a draw stores nothing, as far as that is known before it is drawn.

use super::context::TriangleContext;
use super::counting::{Most, ROWS, spans};
use super::walk;
use crate::plan::{Invisible, Plan, PlannedDraw};
use crate::raster::project::ClipPlane;
use crate::raster::stroke::Figure;
use crate::rop::stencil;
use crate::state::{AlphaTest, CompareFunction, Named};

/// The reason why a draw stores nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EmptyDraw {
    /// The reason, as the end of a sentence.
    pub reason: String,
    /// Advice on what to do.
    pub help: &'static str,
}

/// Returns, for each draw of a plan, why it stores neither colour nor depth nor stencil; `None` if it may store something. A draw whose triangles
/// cover no pixel is not noticed if looking at all of their rows would take long.
pub fn unseen(plan: &Plan) -> Vec<Option<EmptyDraw>> {
    let mut left = ROWS;
    plan.draws
        .iter()
        .map(|planned| folded(planned).or_else(|| tests(planned)).or_else(|| covered(plan, planned, &mut left)))
        .collect()
}

/// Returns what planning has found.
fn folded(planned: &PlannedDraw) -> Option<EmptyDraw> {
    let why = planned.folded.invisible?;
    if why == Invisible::NoTriangles && planned.assembly.clipping.removed > 0 {
        return Some(triangles(planned, &[]));
    }
    let help = match why {
        Invisible::NoTriangles => "give it at least three vertices, or remove it",
        Invisible::NoPixels => "look at `scissor`, `window_clip` and the target's `clip`",
        Invisible::NothingWritten => "look at `color_mask`, and at what the tests write",
        Invisible::AddsZero | Invisible::KeepsDestination => "look at `blend` and at what the program computes",
    };
    Some(EmptyDraw { reason: why.name().to_owned(), help })
}

/// Returns the test that nothing passes, if it has no other effect.
fn tests(planned: &PlannedDraw) -> Option<EmptyDraw> {
    let never = |test: &str, help| Some(EmptyDraw { reason: format!("its {test} never passes"), help });
    if let Some(AlphaTest { function, reference }) = planned.alpha_test {
        let help = "look at `alpha_test`: its function takes the fragment's alpha, then the reference";
        if (0..=255).all(|alpha: u8| !function.passes(alpha, reference)) {
            return never("alpha test", help);
        }
        if planned.folded.zero & 8 != 0 && !function.passes(0, reference) {
            return never("alpha test, whose alpha is 0 in every pixel,", help);
        }
    }
    let writes = planned.stencil_test.is_some_and(|test| stencil::writes(&test));
    if let Some(test) = planned.stencil_test.filter(|_| !writes)
        && (0..=255).all(|stored| !stencil::passes(&test, stored))
    {
        return never("stencil test", "look at `stencil_test`: its function takes the reference, then what is stored");
    }
    if planned.depth_test.is_some_and(|test| test.function == CompareFunction::Never) && !writes {
        return never("depth test", "look at the `function` of `depth_test`");
    }
    None
}

/// Returns why no triangle covers a pixel, if that is so. `left` is the number of rows that may be looked at.
fn covered(plan: &Plan, planned: &PlannedDraw, left: &mut u64) -> Option<EmptyDraw> {
    if Most::new(plan, planned).rows > *left {
        return None;
    }
    let mut covers = false;
    spans(plan, planned, |pixels| {
        *left = left.saturating_sub(1);
        covers = pixels > 0;
        !covers
    });
    if covers {
        return None;
    }
    let rows = (0, i64::from(plan.targets[planned.target].height));
    let windows: Vec<walk::Window> = walk::windows(planned, rows).collect();
    let mut counts = [0; MissReason::ALL.len()];
    for number in 0..planned.assembly.triangles.len() {
        counts[MissReason::new(planned, number, &windows) as usize] += 1;
    }
    Some(triangles(planned, &counts))
}

crate::state::named! {
    /// The reason why a triangle covers no pixel.
    enum MissReason {
        /// Its corners lie on a line.
        Flat = "without area",
        /// It shows the side that is not drawn.
        Culled = "culled",
        /// It lies outside of the windows.
        Outside = "outside the target or the draw's clips",
        /// Its depths drop it, or no centre of a pixel lies within.
        Between = "between the centres of pixels, or dropped by their depths",
    }
}

impl MissReason {
    fn new(planned: &PlannedDraw, number: usize, windows: &[walk::Window]) -> MissReason {
        let [across, down] = [0, 1].map(|axis| planned.assembly.bounds(number, axis));
        let meets = |a: (i64, i64), b: (i64, i64)| a.0.max(b.0) < a.1.min(b.1);
        let is_triangle = planned.assembly.triangles.figure(number) == Figure::Triangle;
        match TriangleContext::clockwise_area(planned, number) {
            0 if is_triangle => MissReason::Flat,
            area if is_triangle && TriangleContext::is_culled(planned, area) => MissReason::Culled,
            // A triangle between two centres has no columns or no rows of its own.
            _ if across.0 >= across.1 || down.0 >= down.1 => MissReason::Between,
            _ if !windows.iter().any(|(rows, columns)| meets(down, *rows) && meets(across, *columns)) => {
                MissReason::Outside
            }
            _ => MissReason::Between,
        }
    }
}

/// Says what became of a draw's triangles: those that clipping removed, and the others by the reason for which they cover nothing.
fn triangles(planned: &PlannedDraw, missed: &[usize]) -> EmptyDraw {
    let clipping = &planned.assembly.clipping;
    let clipped = format!("clipped away ({})", ClipPlane::names(clipping.planes));
    let reasons = MissReason::ALL.iter().zip(missed).map(|(missed, count)| (*count, missed.name()));
    let reasons: Vec<(usize, &str)> =
        [(clipping.removed, clipped.as_str())].into_iter().chain(reasons).filter(|(count, _)| *count > 0).collect();
    let help = match reasons.first() {
        Some((_, first)) if *first == clipped => {
            "look at the matrices: the viewer looks along -z, and sees what lies between near and far"
        }
        Some((_, "culled")) => "turn `front_face` around, or take `cull: None`",
        Some((_, "without area")) => "look at the positions and the matrices: they flatten it",
        _ => "look at the positions, the matrices and the clips",
    };
    let all: usize = reasons.iter().map(|(count, _)| count).sum();
    let reason = match &reasons[..] {
        [(1, why)] => format!("its triangle is {why}"),
        [(count, why)] => format!("all {count} triangles are {why}"),
        several => {
            let parts: Vec<String> = several.iter().map(|(count, why)| format!("{count} are {why}")).collect();
            format!("of {all} triangles {}", parts.join(", "))
        }
    };
    EmptyDraw { reason, help }
}
