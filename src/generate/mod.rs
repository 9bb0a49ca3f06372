//! Textures made by the tool itself: height fields, and normal maps from height fields.
//!
//! Deterministic: the same arguments give the same bytes on every machine.

pub mod height_field;
pub mod normal_map;
