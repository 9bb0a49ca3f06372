//! Checks that surfaces are legal on a chip: formats, and blending.

use crate::diagnostic::{Diagnostic, needs_nv2a};
use crate::place::Span;
use crate::rop::surface;
use crate::state::{BlendEquation, DepthFormat, Named, Profile, SurfaceFormat};

/// Returns the finding that a chip lacks a surface format, or `None` if it has it.
pub fn format(format: SurfaceFormat, profile: Profile, place: Option<Span>) -> Option<Diagnostic> {
    let what = format!("surface format {}", format.name());
    needs_nv2a(profile, format.is_nv2a_only(), "NB0314", place, &what, "ROP-5")
}

/// Returns the finding that a chip lacks a depth format, or `None` if it has it.
pub fn depth_format(format: DepthFormat, profile: Profile, place: Option<Span>) -> Option<Diagnostic> {
    let what = format!("depth format {}", format.name());
    needs_nv2a(profile, format.is_float(), "NB0314", place, &what, "DEP-3")
}

/// Returns the finding that a chip lacks a blend equation, or `None` if it has it.
pub fn blend_equation(equation: BlendEquation, profile: Profile, place: Option<Span>) -> Option<Diagnostic> {
    let what = format!("blend equation {}", equation.name());
    needs_nv2a(profile, equation.is_nv2a_only(), "NB0315", place, &what, "ROP-3")
}

/// Returns the finding that a surface cannot be blended, or `None` if it can.
pub fn blending(format: SurfaceFormat, place: Option<Span>) -> Option<Diagnostic> {
    (!surface::blends(format)).then(|| {
        Diagnostic::error("NB0316", place, format!("surface format {} cannot be blended", format.name()))
            .label("blending")
            .rule("ROP-5")
            .help("leave `blend` out, or draw into a target with a colour format")
    })
}
