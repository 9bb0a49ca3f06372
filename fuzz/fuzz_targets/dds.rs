//! Checks that any bytes after a DDS signature yield a texture or an error, never a panic, and that every texel of a texture can be
//! decoded.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit::state::{CUBE_FACES, Level, Texels};
use ninebit::texture::show;
use ninebit_scene::dds::{SIGNATURE, decode};
use ninebit_scene::image::ImageLimits;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    // A small limit keeps runs short.
    let limits = ImageLimits { maximum_decoded_bytes: 1 << 20, ..ImageLimits::default() };
    let file = [&SIGNATURE, bytes].concat();
    let Ok(image) = decode(&file, Path::new("texture.dds"), &limits) else { return };
    let (_, face) = Level::chain(image.format, image.width, image.height, image.levels, false);
    let faces = if image.cube { CUBE_FACES } else { 1 };
    assert_eq!(image.words.len(), face * faces as usize);
    let (width, height, levels) = (image.width, image.height, image.levels);
    let texels = Texels { width, height, levels, layers: 1, border: false, words: image.words.into() };
    let palette = image.palette.unwrap_or_default();
    for (face, level) in (0..faces).flat_map(|face| (0..levels).map(move |level| (face, level))) {
        let shown = show::level(&texels, image.format, &palette, bytes.len().is_multiple_of(2), face, level);
        let shown = shown.expect("every level of every face is there");
        assert_eq!(shown.pixels.len(), shown.width as usize * shown.height as usize);
    }
});
