//! Textures made by the tool itself: height fields, normal maps and occlusion from them, the normal map of a hemisphere, cube maps of
//! vectors and of the light of a sky, tables of powers.
//!
//! Deterministic: the same arguments give the same bytes on every machine.

use crate::image::Rgba;
use crate::vector::Vector;
pub mod cube;
pub mod dds;
pub mod half_components;
pub(crate) mod hash;
pub mod height_field;
pub mod hemisphere;
pub mod normal_map;
pub mod occlusion;
pub mod power_table;
pub mod sky;

/// The byte nearest to a share of 0..1; halves count upwards, what is outside is limited.
#[allow(clippy::float_arithmetic, reason = "real numbers become bytes of a texture, or of a picture of the truth")]
pub fn byte(share: f64) -> u8 {
    (255.0 * share + 0.5) as u8
}

/// Sides of the square images that are made from nothing.
pub const SIDES: std::ops::RangeInclusive<u32> = 16..=2048;
