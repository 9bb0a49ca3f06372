//! What the chips take of surfaces: formats, and blending on them.

use crate::diagnostic::{Diagnostic, needs_nv2a};
use crate::place::Span;
use crate::rop::surface;
use crate::state::{BlendEquation, DepthFormat, Named, Profile, SurfaceFormat};

/// The bytes of a text that are to blame, if it has them.
/// The finding that a chip lacks a format of surfaces.
pub fn format(format: SurfaceFormat, profile: Profile, place: Option<Span>) -> Option<Diagnostic> {
    let what = format!("surface format {}", format.name());
    needs_nv2a(profile, format.is_nv2a_only(), "NB0314", place, &what, "ROP-5")
}

/// The finding that a chip lacks a format of depth buffers.
pub fn depth_format(format: DepthFormat, profile: Profile, place: Option<Span>) -> Option<Diagnostic> {
    let what = format!("depth format {}", format.name());
    needs_nv2a(profile, format.is_float(), "NB0314", place, &what, "DEP-3")
}

/// The finding that a chip lacks a blend equation.
pub fn blend_equation(equation: BlendEquation, profile: Profile, place: Option<Span>) -> Option<Diagnostic> {
    let what = format!("blend equation {}", equation.name());
    needs_nv2a(profile, equation.is_nv2a_only(), "NB0315", place, &what, "ROP-3")
}

/// The finding that a surface cannot be blended.
pub fn blending(format: SurfaceFormat, place: Option<Span>) -> Option<Diagnostic> {
    (!surface::blends(format)).then(|| {
        Diagnostic::error("NB0316", place, format!("surface format {} cannot be blended", format.name()))
            .label("blending")
            .rule("ROP-5")
            .help("leave `blend` out, or draw into a target with a colour format")
    })
}
