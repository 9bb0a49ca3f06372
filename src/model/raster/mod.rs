//! Rasteriser: triangles from vertices, coverage, and what is interpolated across them.
//!
//! [`triangles`], [`assemble`] and [`project`] clip and turn a draw's vertices into triangles in window coordinates, once, when the plan is made.
//! [`setup`] takes a triangle's floats apart; from there on everything is integer arithmetic with one answer:
//! [`interpolate`] holds the definition of weights, coordinates and fog, [`mod@depth`] that of depths, [`attribute`] that of numbers which are used as numbers.

pub mod assemble;
pub mod attribute;
pub mod depth;
pub mod fog;
pub mod ideal;
pub mod interpolate;
pub mod project;
pub mod setup;
pub mod triangles;

/// RAS-0: snapped window coordinates stay below this many 1/16 pixels in magnitude (4096 pixels).
pub const GUARD: i64 = 1 << 16;
/// RAS-0: largest texel coordinate, in texels.
pub const TEXEL_LIMIT: i64 = 1 << 16;
/// RAS-6: the guard band reaches so many pixels from the origin: the last place that RAS-1 keeps below [`GUARD`].
pub const BAND: f32 = 4095.9375;
/// RAS-0: smallest w; clip-space triangles are clipped here.
pub const SMALLEST_W: f32 = 1.0 / 1_048_576.0;
/// RAS-0: largest w.
pub const LARGEST_W: f32 = 1_048_576.0;
