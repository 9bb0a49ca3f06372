//! Raster operations: alpha test, stencil test, depth test, blending, colour mask and surfaces.

pub mod blend;
pub mod stencil;
pub mod surface;
