//! Checks that any bytes, read as PNG and as TGA, yield an image or an error, never a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit_scene::image::{ImageLimits, decode};
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    for name in ["texture.png", "texture.tga"] {
        if let Ok(image) = decode(bytes, Path::new(name), &ImageLimits::default()) {
            assert_eq!(image.pixels().len(), image.width() as usize * image.height() as usize);
        }
    }
});
