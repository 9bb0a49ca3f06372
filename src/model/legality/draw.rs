//! Checks that a draw goes with its target.

use crate::diagnostic::Diagnostic;
use crate::place::Span;
use crate::state::{DepthTest, Positions, Target, VertexDepths, WINDOW_CLIP_RECTANGLES};

/// Returns the finding that a target has no depths to test, or `None` if it has them.
pub fn depth_test(target: &Target, place: Option<Span>) -> Option<Diagnostic> {
    target.depth.is_none().then(|| {
        Diagnostic::error("NB0216", place, format!("target \"{}\" has no depth buffer", target.name))
            .label("tests depth")
            .rule("DEP-2")
            .help("add `depth: Z24S8` (or `Z16`) to the target")
    })
}

/// Returns the finding that a target has no stencil to test, or `None` if it has one.
pub fn stencil_test(target: &Target, place: Option<Span>) -> Option<Diagnostic> {
    (!target.depth.is_some_and(|depth| depth.format.has_stencil())).then(|| {
        Diagnostic::error("NB0216", place, format!("target \"{}\" has no stencil", target.name))
            .label("tests the stencil")
            .rule("STN-1")
            .help("give the target `depth: Z24S8`")
    })
}

/// Returns the finding that depths are steps of the buffer where positions are projected, or `None` if they go together.
pub fn vertex_depths(test: &DepthTest, positions: &Positions, place: Option<Span>) -> Option<Diagnostic> {
    (test.vertex_depths == VertexDepths::Steps && !matches!(positions, Positions::Window)).then(|| {
        Diagnostic::error("NB0206", place, "vertex depths are steps of the buffer, and positions are projected")
            .label("`vertex_depths: Steps`")
            .rule("DEP-1")
            .help("give the vertices as `Window([...])`, or leave `vertex_depths` out")
    })
}

/// Returns the finding that a window clip has no rectangles or too many, or `None` if the chip has as many.
pub fn window_clip(rectangles: usize, place: Option<Span>) -> Option<Diagnostic> {
    (!(1..=WINDOW_CLIP_RECTANGLES).contains(&rectangles)).then(|| {
        let message = format!("a window clip has 1 to {WINDOW_CLIP_RECTANGLES} rectangles, not {rectangles}");
        Diagnostic::error("NB0211", place, message)
            .label(format!("{rectangles} here"))
            .rule("CLP-1")
            .help("leave `window_clip` out to draw everywhere, or draw in several draws")
    })
}
