//! Raster operations: alpha test, depth test, blend, colour mask, surfaces.

pub mod blend;
pub mod surface;
