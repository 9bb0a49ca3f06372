//! Every scene under `vectors/scenes` shows what is expected, and its generated textures are what the generators make.
//!
//! `BLESS=1 cargo test --test suite assets_scenes` rewrites the expectations, but for those that come from a capture; look at the pictures
//! and at the difference before committing.
#![allow(clippy::unwrap_used, unreachable_pub, reason = "a test fails by panicking, and shares a file with others")]

use crate::scene_files;

use std::path::{Path, PathBuf};

use ninebit::engine::{RenderOptions, render};
use ninebit::expectation::Expectation;
use ninebit::generate::{height_field, hemisphere, normal_map};
use ninebit::limits::Limits;
use ninebit::output::write_file;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::scene;
use ninebit::scene::image::{ImageLimits, load};

fn scenes_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("vectors/scenes")
}

/// Renders a scene and compares its first target with the expectation; says what is wrong.
fn check(file: &Path, bless: bool) -> Result<(), String> {
    let loaded = scene::load(file, &Limits::default()).map_err(|error| error.render(false))?;
    let plan = Plan::compile(&loaded.scene, &PlanOptions::default()).map_err(|errors| format!("{errors:?}"))?;
    let frames = render(&plan, &RenderOptions::default());
    if render(&plan, &RenderOptions { threads: 3, ..RenderOptions::default() }) != frames {
        return Err("the picture depends on the number of threads".to_owned());
    }
    let surface = &frames.surfaces[0];
    let path = file.with_extension("expect.ron");
    let text = std::fs::read_to_string(&path).map_err(|error| format!("no expectation ({error})"));
    let expectation = text.and_then(|text| Expectation::parse(&text).map_err(|error| error.to_string()));
    let captured = expectation.as_ref().is_ok_and(|expectation| expectation.capture.is_some());
    if bless && !captured {
        let text = Expectation::of(&loaded.scene.targets[0].name, surface).to_text();
        return write_file(&path, text.as_bytes()).map_err(|error| error.to_string());
    }
    let expectation = expectation?;
    match expectation.compare(surface, file.parent().unwrap()).map_err(|error| error.to_string())? {
        None => Ok(()),
        Some(mismatch) => Err(mismatch.to_string()),
    }
}

#[test]
fn every_scene_shows_what_is_expected() {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty() && value != "0");
    let bless = set("BLESS");
    assert!(!(bless && set("CI")), "expectations are not rewritten in continuous integration");
    let files = scene_files::below(&scenes_folder());
    let complaints: Vec<String> = files
        .iter()
        .filter_map(|file| check(file, bless).err().map(|error| format!("{}: {error}", file.display())))
        .collect();
    assert!(complaints.is_empty(), "{}\nBLESS=1 rewrites the expectations", complaints.join("\n"));
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
