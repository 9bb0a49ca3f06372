//! Generates textures: height fields, normal maps and occlusion from them, the normal map of a hemisphere, cube maps of
//! vectors and of the light of a sky, tables of powers.
//!
//! The same arguments give the same bytes on every machine.

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

/// Returns the byte nearest to 255 times a share. Halves round up; shares outside 0..1 are clamped.
#[allow(clippy::float_arithmetic, reason = "real numbers become bytes of a texture, or of a picture of the truth")]
pub fn byte(share: f64) -> u8 {
    (255.0 * share + 0.5) as u8
}

/// Permitted sides of the square images that are generated without an input image.
pub const SIDES: std::ops::RangeInclusive<u32> = 16..=2048;
