//! Draws scenes by printed functions of whole pixels, and compares every stored word with the engine's.
//!
//! `NINEBIT_WHOLE_SCENES` is the number of random scenes, `NINEBIT_WHOLE_SEED` selects others, `NINEBIT_WHOLE_EVERY` is a step through the scenes
//! of the repository, and `NINEBIT_WHOLE_FRAMES` one through captured frames. `CC` names the C compiler and `NINEBIT_LOWER_CFLAGS` its options.
#![allow(missing_docs, unreachable_pub, dead_code, reason = "modules share files of which each uses its part")]
#![allow(clippy::unwrap_used, clippy::float_arithmetic, reason = "tests fail by panicking")]

#[path = "common/compiled.rs"]
mod compiled;
#[path = "common/drawn.rs"]
mod drawn;
#[path = "common/setting.rs"]
mod setting;
#[path = "common/shaded.rs"]
mod shaded;
#[path = "common/stated.rs"]
mod stated;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use drawn::{Printed, difference};
use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::raster::assemble::ScalarPart;
use ninebit::state::{Policies, Scene};
use ninebit_lower::unprinted;
use ninebit_methods::class::Family;
use ninebit_program::registers::unit;
use ninebit_test_support::random_scene;
use proptest::strategy::{Strategy, ValueTree};
use setting::{GLSL_COMPILER, any_policies, compiler, python, runner, setting, works};
use stated::Programs;

/// Returns the scenes of the repository, sorted.
fn scenes() -> Vec<PathBuf> {
    let mut open = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vectors/scenes")];
    let mut found = Vec::new();
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.to_string_lossy().into_owned();
            if path.is_dir() {
                open.push(path);
            } else if name.ends_with(".ron") && !name.ends_with(".expect.ron") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Loads a scene; `None` if the file is a part of others.
fn load(path: &Path) -> Option<Scene> {
    ninebit_scene::load(path, &Limits::default()).ok().map(|loaded| loaded.scene)
}

/// Comparisons of a pixel with a triangle that a shader does in seconds.
const MAX_COMPARISONS: usize = 20_000_000;

/// How functions run.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    /// By their lines.
    Lines,
    /// Printed in C and compiled.
    C,
    /// Printed in GLSL and compiled, not run.
    Glsl,
    /// Printed in WGSL, for scenes that are small enough.
    Wgsl,
    /// Printed as shaders of GLSL, which OpenGL draws.
    Pair,
    /// By the generic text in C.
    Generic,
    /// By the shaders of the generic text, which OpenGL draws.
    GenericPair,
}

impl Way {
    /// Returns whether one text draws every draw.
    fn is_generic(self) -> bool {
        matches!(self, Way::Generic | Way::GenericPair)
    }
}

/// Draws a scene by its functions and compares it.
///
/// # Errors
/// Why it is left out.
fn hold(scene: &Scene, policies: Policies, (way, programs): (Way, &mut Programs), what: &str) -> Result<(), String> {
    let plan = Plan::compile(scene, &PlanOptions { policies, prune: !way.is_generic() }).unwrap();
    let is_own = !way.is_generic() && way != Way::Pair;
    if let Some(part) = plan.draws().iter().find_map(|draw| unprinted(draw, is_own)) {
        return Err(part.words()[0].to_string());
    }
    let printed = Printed::new(scene, &plan);
    let folder = tempfile::tempdir().unwrap();
    let found = match way {
        Way::Lines => printed.run(),
        Way::C => printed.compiled(folder.path()).unwrap_or_else(|error| panic!("{what}: {error}")),
        Way::Glsl => {
            printed.validated(folder.path()).unwrap_or_else(|error| panic!("{what}: {error}"));
            return Ok(());
        }
        Way::Pair | Way::GenericPair if !printed.is_plain() => return Err("no triangles".to_string()),
        Way::Pair => printed.paired(folder.path()).unwrap_or_else(|error| panic!("{what}: {error}")),
        Way::Generic | Way::GenericPair => {
            let drawn = if way == Way::Generic {
                printed.generic(folder.path(), programs)
            } else {
                printed.paired_generic(folder.path())
            };
            match drawn {
                Ok(frames) => frames,
                Err((true, reason)) => return Err(reason),
                Err((false, error)) => panic!("{what}: {error}"),
            }
        }
        Way::Wgsl if !printed.is_plain() || printed.comparisons() > MAX_COMPARISONS => {
            return Err("too large".to_string());
        }
        Way::Wgsl => printed.shaded(folder.path()).unwrap_or_else(|error| panic!("{what}: {error}")),
    };
    difference(&plan, &render(&plan, &RenderOptions::default()), &found, what);
    Ok(())
}

/// Draws some scenes of the repository.
fn hold_committed(way: Way, step: usize) {
    let (mut left_out, mut drawn) = (BTreeMap::<String, Vec<String>>::new(), 0);
    let mut programs = Programs::default();
    for path in scenes().into_iter().step_by(step) {
        let Some(scene) = load(&path) else { continue };
        match hold(&scene, Policies::DEFAULT, (way, &mut programs), &path.to_string_lossy()) {
            Ok(()) => drawn += 1,
            Err(reason) => {
                let name = path.file_stem().unwrap().to_string_lossy().into_owned();
                left_out.entry(reason).or_default().push(name);
            }
        }
    }
    println!("{drawn} scenes; left out: {left_out:?}");
    assert!(drawn > 0, "left out: {left_out:?}");
}

#[test]
fn lines_of_committed_scenes_draw_them() {
    hold_committed(Way::Lines, setting("NINEBIT_WHOLE_EVERY").unwrap_or(13) as usize);
}

#[test]
fn printed_c_draws_committed_scenes() {
    if works(&compiler(), &["--version"]) {
        hold_committed(Way::C, setting("NINEBIT_WHOLE_EVERY").unwrap_or(16) as usize);
    }
}

/// Draws scenes of captured frames.
fn hold_captured(way: Way) {
    if !works(&compiler(), &["--version"]) {
        return;
    }
    let mut programs = Programs::default();
    let step = setting("NINEBIT_WHOLE_FRAMES").unwrap_or(1501) as usize;
    let mut drawn = 0;
    for frame in ninebit_captures::frames(&[]).unwrap().into_iter().step_by(step) {
        let scene = frame.scene(&RenderOptions::default()).unwrap();
        // Some programs only clear.
        let Some(scene) = scene.filter(|scene| !scene.draws.is_empty()) else { continue };
        let name = format!("{}/{}", frame.suite, frame.name);
        match hold(&scene, Policies::DEFAULT, (way, &mut programs), &name) {
            Ok(()) => drawn += 1,
            Err(reason) => {
                let parts = [ScalarPart::SmoothEdges, ScalarPart::FarVertices];
                assert!(parts.iter().any(|part| part.words()[0] == reason), "{name}: {reason}");
            }
        }
    }
    println!("{drawn} frames");
    assert!(drawn > 0);
}

/// The words of state have the names and the methods of the class.
#[test]
fn words_of_state_are_those_of_the_class() {
    for words in unit::WORDS {
        let (elements, step) = words.elements;
        for at in 0..elements as u32 {
            let place = Family::Kelvin.find(words.method + step * at).unwrap();
            assert_eq!(place.method.name, format!("SET_{}", words.name.to_uppercase()));
            assert_eq!(place.word + words.words as u32, place.method.words);
            assert!(place.element == at || elements == 1, "{words:?}");
        }
    }
}

#[test]
fn generic_c_draws_committed_scenes() {
    if works(&compiler(), &["--version"]) {
        hold_committed(Way::Generic, setting("NINEBIT_WHOLE_EVERY").unwrap_or(5) as usize);
    }
}

#[test]
fn generic_c_draws_random_scenes() {
    if works(&compiler(), &["--version"]) {
        let count = setting("NINEBIT_WHOLE_SCENES").unwrap_or(200);
        hold_random(Way::Generic, setting("NINEBIT_WHOLE_SEED").unwrap_or(45), count);
    }
}

#[test]
fn printed_c_draws_captured_scenes() {
    hold_captured(Way::C);
}

#[test]
fn generic_c_draws_captured_scenes() {
    hold_captured(Way::Generic);
}

#[test]
fn printed_glsl_compiles() {
    if works(GLSL_COMPILER, &["--version"]) {
        hold_committed(Way::Glsl, setting("NINEBIT_WHOLE_EVERY").unwrap_or(7) as usize);
    }
}

/// Returns whether a module of Python opens a driver.
fn has_driver(module: &str) -> bool {
    works(&python(), &["-c", &format!("import {module}, numpy")])
}

/// Draws every `step`th committed scene and a share of the random ones by a driver that a module of Python opens, where there is one.
fn hold_by_driver(way: Way, module: &str, step: u64, share: u64, seed: u64) {
    if has_driver(module) {
        hold_committed(way, setting("NINEBIT_WHOLE_EVERY").unwrap_or(step) as usize);
        let count = setting("NINEBIT_WHOLE_SCENES").unwrap_or(200) / share;
        hold_random(way, setting("NINEBIT_WHOLE_SEED").unwrap_or(seed), count);
    }
}

#[test]
fn printed_wgsl_draws_scenes() {
    hold_by_driver(Way::Wgsl, "wgpu", 40, 40, 43);
}

/// The sample has no cube map that is small enough.
#[test]
fn printed_wgsl_draws_cube_maps() {
    if has_driver("wgpu") {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vectors/scenes/silicon/t08-cube-map.ron");
        hold(&load(&path).unwrap(), Policies::DEFAULT, (Way::Wgsl, &mut Programs::default()), "cube map").unwrap();
    }
}

#[test]
fn printed_shaders_draw_scenes() {
    hold_by_driver(Way::Pair, "moderngl", 24, 40, 44);
}

#[test]
fn generic_shaders_draw_scenes() {
    hold_by_driver(Way::GenericPair, "moderngl", 110, 100, 46);
}

/// Draws random scenes. Returns how many were drawn.
fn hold_random(way: Way, seed: u64, count: u64) -> u64 {
    let (mut runner, mut random, mut drawn) = (runner(seed), Random::seeded(seed), 0);
    let (scenes, mut left_out) = (random_scene::sharp(), BTreeMap::<String, u64>::new());
    let mut programs = Programs::default();
    for number in 0..count {
        let scene = scenes.new_tree(&mut runner).unwrap().current();
        // The generic text is compiled for each set of policies.
        let alternatives = if way.is_generic() { number % 100 == 99 } else { number % 2 == 1 };
        let policies = if alternatives { any_policies(&mut random) } else { Policies::DEFAULT };
        match hold(&scene, policies, (way, &mut programs), &format!("scene {number} of seed {seed}")) {
            Ok(()) => drawn += 1,
            Err(reason) => *left_out.entry(reason).or_default() += 1,
        }
    }
    println!("{drawn} of {count} scenes; left out: {left_out:?}");
    drawn
}

#[test]
fn lines_of_random_scenes_draw_them() {
    let (seed, count) = (setting("NINEBIT_WHOLE_SEED").unwrap_or(41), setting("NINEBIT_WHOLE_SCENES").unwrap_or(200));
    assert_eq!(hold_random(Way::Lines, seed, count), count);
}

#[test]
fn printed_c_draws_random_scenes() {
    if works(&compiler(), &["--version"]) {
        let count = setting("NINEBIT_WHOLE_SCENES").unwrap_or(200) / 20;
        hold_random(Way::C, setting("NINEBIT_WHOLE_SEED").unwrap_or(42), count);
    }
}
