//! Texture units: where they sample, which levels and texels, how texels become channels, how they are filtered.

pub mod address;
pub mod compressed;
pub mod cube;
pub mod dot;
pub mod fetch;
pub mod filter;
pub mod format;
pub mod lod;
pub mod place;
pub mod report;
pub mod shader;
pub mod unit;
