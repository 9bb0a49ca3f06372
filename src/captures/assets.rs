//! Image files that the test programs load (MIT).

use super::images::Color;
use ninebit::state::TextureFormat;
use ninebit_data::images;
pub(super) use ninebit_data::images::{NORMALS, SEEN, WATER};
use ninebit_files::texels;

/// A compressed image: name, format, size in texels, number of mip levels, and the bytes of its DDS file.
pub(super) type Compressed = (&'static str, TextureFormat, [u32; 2], u32, &'static [u8]);

/// The compressed images of Texture_DXT.
pub(super) const COMPRESSED: [Compressed; 9] = [
    ("plasma_dxt1", TextureFormat::Dxt1, [32, 32], 6, images::PLASMA_DXT1),
    ("plasma_alpha_dxt1", TextureFormat::Dxt1, [32, 32], 6, images::PLASMA_ALPHA_DXT1),
    ("plasma_dxt3", TextureFormat::Dxt3, [32, 32], 6, images::PLASMA_DXT3),
    ("plasma_alpha_dxt3", TextureFormat::Dxt3, [32, 32], 6, images::PLASMA_ALPHA_DXT3),
    ("plasma_dxt5", TextureFormat::Dxt5, [32, 32], 6, images::PLASMA_DXT5),
    ("plasma_alpha_dxt5", TextureFormat::Dxt5, [32, 32], 6, images::PLASMA_ALPHA_DXT5),
    ("64x256_bands_dxt1", TextureFormat::Dxt1, [64, 256], 9, images::BANDS_DXT1),
    ("64x256_bands_dxt3", TextureFormat::Dxt3, [64, 256], 9, images::BANDS_DXT3),
    ("64x256_bands_dxt5", TextureFormat::Dxt5, [64, 256], 9, images::BANDS_DXT5),
];

/// Size of a DDS file's header in bytes; the blocks follow it.
const DDS_HEADER: usize = 128;

/// Returns the compressed blocks of all levels as words.
pub(super) fn blocks(format: TextureFormat, file: &[u8]) -> Vec<u32> {
    texels::from_bytes(file.get(DDS_HEADER..).unwrap_or_default(), format)
}

/// Decodes a PNG file. Returns a function from column and row to the pixel's colour.
pub(super) fn pixels(file: &[u8]) -> impl Fn(u32, u32) -> Color + use<> {
    // The file is one of the constants above, so it decodes.
    let picture = image::load_from_memory(file).map(|picture| picture.into_rgba8()).unwrap_or_default();
    move |x, y| picture.get_pixel_checked(x, y).map_or([0; 4], |pixel| pixel.0)
}
