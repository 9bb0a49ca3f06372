//! Rasteriser: assembly of triangles, coverage, and interpolation.
//!
//! [`triangles`], [`assemble`] and [`project`] convert the vertices of a draw to clipped triangles in window
//! coordinates, once, when the plan is made. [`setup`] splits the floats of a triangle; everything after it is integer
//! arithmetic. [`stroke`] covers lines and points, which [`modes`] makes of triangles, [`smooth`] the edges of smooth ones. [`weights`] defines the weights
//! of the vertices and the numbers that are interpolated by them, [`interpolate`] the colours and texel coordinates, [`fog`] the fog, and [`mod@depth`] the depths.

pub mod assemble;
pub mod binary;
pub mod depth;
pub(crate) mod doubles;
pub mod fog;
pub mod ideal;
pub mod interpolate;
pub mod modes;
pub mod project;
pub(crate) mod report;
pub mod setup;
pub mod smooth;
pub mod stroke;
pub mod triangles;
pub mod weights;
#[cfg(test)]
mod weights_tests;

/// RAS-0: limit of snapped window coordinates, which stay below it in magnitude: 4096 pixels in units of 1/16 pixel.
pub(crate) const GUARD: i64 = 1 << 16;
/// RAS-0: largest texel coordinate, in texels.
pub(crate) const TEXEL_LIMIT: i64 = 1 << 16;
/// RAS-6: distance of the guard band's edges from the origin in pixels. It is the last position that RAS-1 keeps below
/// [`GUARD`].
pub(crate) const BAND: f32 = 4095.9375;
/// RAS-0: smallest w, where clip-space triangles are clipped.
pub(crate) const SMALLEST_W: f32 = 1.0 / 1_048_576.0;
/// RAS-0: largest w.
pub(crate) const LARGEST_W: f32 = 1_048_576.0;
/// RAS-0: limit of snapped coordinates of filled triangles in window coordinates: 2^20 pixels in units of 1/16 pixel.
pub(crate) const FAR_GUARD: i64 = 1 << 24;
/// RAS-8: largest magnitude of w, 2^64.
pub(crate) const FARTHEST_W: f32 = 18_446_744_073_709_551_616.0;
/// RAS-8: smallest magnitude of w, 2^-64.
pub(crate) const NEAREST_W: f32 = 1.0 / FARTHEST_W;
