//! Textures made by the tool itself: height fields, normal maps from height fields, and the normal map of a hemisphere.
//!
//! Deterministic: the same arguments give the same bytes on every machine.

pub(crate) mod hash;
pub mod height_field;
pub mod hemisphere;
pub mod normal_map;

/// Sides of the square images that are made from nothing.
pub const SIDES: std::ops::RangeInclusive<u32> = 16..=2048;
