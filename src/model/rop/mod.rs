//! Raster operations: alpha test, stencil test, depth test, blend, colour mask, surfaces.

pub mod blend;
pub mod stencil;
pub mod surface;
