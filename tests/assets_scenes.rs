//! Checks that the generated textures of the scenes under `vectors/scenes` are what the generators make. The pictures of the scenes are
//! checked by `tests/cases`.
#![allow(clippy::unwrap_used, unreachable_pub, reason = "a test fails by panicking, and shares a file with others")]

use crate::repository::at;
use std::path::PathBuf;

use ninebit_scene::generate::{height_field, hemisphere, normal_map};
use ninebit_scene::image::{ImageLimits, load};

fn scenes_folder() -> PathBuf {
    at("vectors/scenes")
}

#[test]
fn stored_textures_are_what_the_generators_make() {
    let folder = scenes_folder().join("dot3");
    let stored = |name: &str| load(&folder.join(name), &ImageLimits::default()).unwrap();
    let height = height_field::rocks(256, 3);
    assert!(stored("rocks-height.png") == height, "ninebit generate height-rocks --size 256 --seed 3");
    let options = normal_map::Options { scale: 16.0, ..normal_map::Options::default() };
    let normal = normal_map::from_height(&height, &options);
    assert!(stored("rocks-normal.png") == normal, "ninebit generate normal-map rocks-height.png --scale 16");
    let clean = hemisphere::normals(&hemisphere::Options::default());
    assert!(stored("hemisphere-normal.png") == clean, "ninebit generate hemisphere-normals");
    let noisy = hemisphere::normals(&hemisphere::Options { noise: 0.02, ..hemisphere::Options::default() });
    assert!(stored("hemisphere-noisy-normal.png") == noisy, "ninebit generate hemisphere-normals --noise 0.02");
    let small = hemisphere::normals(&hemisphere::Options { size: 128, ..hemisphere::Options::default() });
    let stored = load(&scenes_folder().join("texture-shader/hemisphere-normal.png"), &ImageLimits::default()).unwrap();
    assert!(stored == small, "ninebit generate hemisphere-normals --size 128");
    let normal = normal_map::from_height(&height_field::rocks(64, 3), &normal_map::Options::default());
    let stored = load(&scenes_folder().join("programs/rocks-normal.png"), &ImageLimits::default()).unwrap();
    assert!(stored == normal, "ninebit generate normal-map of height-rocks --size 64 --seed 3");
}
