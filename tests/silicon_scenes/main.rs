//! Compares captured frames of a real NV2A, whose textures and geometry are known, with the scenes of `vectors/scenes/silicon`.
//!
//! The captures are not part of the repository; the expectation of a scene holds the digest of the pixels that are compared. Some images
//! that the captured programs load are not part of it either, and scenes that need them are ignored. If `NINEBIT_CAPTURES` names a folder
//! with `frames/SUITE/NAME.png` and `assets/NAME`, these scenes are drawn as well, and every scene is compared with the capture itself.
//!
//! `BLESS=1` rewrites generated scenes and textures. With `NINEBIT_CAPTURES` it also rewrites masks and expectations from the captures.
#![allow(
    clippy::float_arithmetic,
    clippy::unwrap_used,
    missing_docs,
    unreachable_pub,
    reason = "a test that computes what the captured programs computed"
)]

mod cases;
mod geometry;
#[path = "../common/repository.rs"]
mod repository;
#[path = "../common/scene_files.rs"]
mod scene_files;
mod scenes;
#[path = "../common/settings.rs"]
mod settings;
mod textures;

use cases::{CASES, Case};
use libtest_mimic::{Arguments, Failed, Trial};
use ninebit::engine::{RenderOptions, render, trace};
use ninebit::expectation::{Expectation, masked_digest};
use ninebit::frame::Surface;
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit_files::output::{Compression, encode_png, write_file};
use ninebit_report::trace_text;
use ninebit_scene as scene;
use ninebit_scene::image::{ImageLimits, load};
use settings::{bless, captures};
use std::path::{Path, PathBuf};
use textures::Picture;

/// Overlaid text is white with alpha 0.
const TEXT: [u8; 4] = [255, 255, 255, 0];

/// Number of differing pixels that are listed in a message.
const LISTED: usize = 20;

fn folder() -> PathBuf {
    repository::at("vectors/scenes/silicon")
}

/// A scene and its frame.
struct SceneDrawing {
    text: String,
    plan: Plan,
    surface: Surface,
}

/// Returns the path of a scene and its text.
fn written(case: &Case) -> (PathBuf, String) {
    let file = folder().join(case.name).with_extension("ron");
    let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    (file, text)
}

/// Renders a scene, with the images that are not part of the repository if it needs them.
fn draw(case: &Case) -> SceneDrawing {
    let (file, text) = written(case);
    let place;
    let file = if !scene_files::captured(&text).is_empty() {
        place = tempfile::tempdir().unwrap();
        let assets = captures().expect("NINEBIT_CAPTURES names the folder of its images").join("assets");
        copy(&folder().join("textures"), &place.path().join("textures"));
        copy(&assets, &place.path().join(scene_files::CAPTURED));
        let copied = place.path().join("scene.ron");
        std::fs::write(&copied, &text).unwrap();
        copied
    } else {
        file
    };
    let loaded = scene::load(&file, &Limits::default()).unwrap_or_else(|error| panic!("{}", error.render(false)));
    assert!(loaded.warnings.is_empty(), "{}: a warning", case.name);
    let surface = render(&loaded.plan, &RenderOptions::default()).surfaces.remove(0);
    SceneDrawing { text, plan: loaded.plan, surface }
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap_or_else(|error| panic!("{}: {error}", from.display())) {
        let path = entry.unwrap().path();
        if path.is_file() {
            std::fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
        }
    }
}

/// Compares a frame with the capture, pixel by pixel. Returns the differences, with the trace of the first one.
fn against_capture(case: &Case, drawn: &SceneDrawing, captured: &[[u8; 4]], compared: &[bool]) -> Option<String> {
    let ours = drawn.surface.rgba8();
    let different: Vec<usize> = (0..ours.len()).filter(|n| compared[*n] && ours[*n] != captured[*n]).collect();
    let total = compared.iter().filter(|compared| **compared).count();
    let width = drawn.surface.width as usize;
    let first = *different.first()?;
    let mut message = format!("{}: {} of {total} pixels differ\n", case.name, different.len());
    for n in different.iter().take(LISTED) {
        message += &format!("  {},{}: captured {:?}, ours {:?}\n", n % width, n / width, captured[*n], ours[*n]);
    }
    let trace = trace(&drawn.plan, 0, ((first % width) as u32, (first / width) as u32), None).unwrap();
    Some(message + &trace_text(&drawn.plan, &trace))
}

/// Compares a scene with its expectation and, if there is one, with its capture.
fn check(case: &Case) -> Result<(), Failed> {
    let drawn = draw(case);
    let path = folder().join(case.name).with_extension("expect.ron");
    let mut wrong = None;
    if let Some(captures) = captures() {
        let file = captures.join("frames").join(case.capture);
        let mut captured = load(&file, &ImageLimits::default()).unwrap_or_else(|error| panic!("{error}"));
        let (width, height) = (captured.width(), captured.height());
        assert_eq!([width, height], [drawn.surface.width, drawn.surface.height], "{}", case.name);
        let inside = |n: u32| (case.region)(n % width, n / width, &drawn.surface);
        let compared: Vec<bool> =
            (0..width * height).map(|n| inside(n) && captured.pixels()[n as usize] != TEXT).collect();
        let pixels = compared.iter().filter(|compared| **compared).count() as u64;
        wrong = against_capture(case, &drawn, captured.pixels(), &compared);
        assert_eq!(pixels, case.pixels, "{}: pixels compared", case.name);
        let expectation = Expectation {
            sha256: masked_digest(width, height, captured.pixels_mut(), &compared),
            capture: Some(case.capture.to_string()),
            pixels: Some(pixels),
            mask: Some(format!("masks/{}.png", case.name)),
            needs: scene_files::captured(&drawn.text),
            ..Expectation::from_surface("frame", &drawn.surface)
        };
        if bless() {
            let mask: Vec<[u8; 4]> =
                compared.iter().map(|compared| if *compared { [255; 4] } else { [0, 0, 0, 255] }).collect();
            let png = encode_png(width, height, &mask, Compression::Small).unwrap();
            write_file(&folder().join(format!("masks/{}.png", case.name)), &png).unwrap();
            write_file(&path, expectation.to_text().as_bytes()).unwrap();
        }
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(text == expectation.to_text(), "{} is not what the capture gives", path.display());
    }
    if let Some(message) = wrong {
        return Err(message.into());
    }
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let expectation = Expectation::parse(&text)?;
    assert_eq!(expectation.capture.as_deref(), Some(case.capture), "{}", case.name);
    assert_eq!(expectation.pixels, Some(case.pixels), "{}", case.name);
    match expectation.compare(&drawn.surface, &folder()).map_err(|error| format!("{}: {error}", case.name))? {
        None => Ok(()),
        Some(mismatch) => Err(format!("{}: {mismatch}; set NINEBIT_CAPTURES to see where", case.name).into()),
    }
}

fn main() {
    repository::enter();
    let arguments = Arguments::from_args();
    if bless() && !arguments.list {
        write_generated();
    }
    let mut trials: Vec<Trial> = CASES.iter().map(trial).collect();
    for (name, test) in [
        ("generated_scenes_are_what_their_formulas_give", generated_scenes_are_what_their_formulas_give as fn()),
        ("stored_textures_are_what_their_formulas_give", stored_textures_are_what_their_formulas_give),
    ] {
        trials.push(Trial::test(name, move || {
            test();
            Ok(())
        }));
    }
    libtest_mimic::run(&arguments, trials).exit();
}

/// Returns the test of a scene, which is ignored if its images are missing.
fn trial(case: &'static Case) -> Trial {
    let trial = Trial::test(format!("shows_what_was_captured::{}", case.name), move || check(case));
    let complete = scene_files::captured(&written(case).1).is_empty() || captures().is_some();
    if complete { trial } else { trial.with_ignored_flag(true).with_kind("its images are not here") }
}

/// Writes all scenes and textures that formulas determine.
fn write_generated() {
    for case in &CASES {
        if let Some(scene) = case.scene {
            write_file(&folder().join(case.name).with_extension("ron"), scene().as_bytes()).unwrap();
        }
    }
    for (path, picture) in pictures() {
        let png = encode_png(picture.width, picture.height, &picture.pixels, Compression::Small).unwrap();
        write_file(&path, &png).unwrap();
    }
    write_file(&folder().join(INDICES), &textures::indices()).unwrap();
}

/// The file with the texels of T3.
const INDICES: &str = "textures/indices-64.bin";

fn pictures() -> impl Iterator<Item = (PathBuf, Picture)> {
    let path = |name: String| folder().join("textures").join(name).with_extension("png");
    textures::pictures().into_iter().map(move |(name, picture)| (path(name), picture))
}

fn generated_scenes_are_what_their_formulas_give() {
    for case in &CASES {
        let Some(scene) = case.scene else { continue };
        let path = folder().join(case.name).with_extension("ron");
        assert!(std::fs::read_to_string(&path).unwrap() == scene(), "{}: BLESS=1 writes it", path.display());
    }
}

fn stored_textures_are_what_their_formulas_give() {
    for (path, picture) in pictures() {
        let stored = load(&path, &ImageLimits::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!([stored.width(), stored.height()], [picture.width, picture.height], "{}", path.display());
        assert!(stored.pixels() == picture.pixels, "{}: BLESS=1 writes it", path.display());
    }
    assert!(std::fs::read(folder().join(INDICES)).unwrap() == textures::indices(), "{INDICES}: BLESS=1 writes it");
}
