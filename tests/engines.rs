//! The fast engine against the definition: the same words and depths in every scene of the repository and in random ones, whatever the
//! instruction set and the threads.
//!
//! `NINEBIT_ENGINE_SCENES` says how many random scenes, `NINEBIT_ENGINE_SEED` which.
use crate::{random_scene, scene_files};

use ninebit::engine::{Engine, Isa, RenderOptions, render};
use ninebit::frame::Frames;
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::scene;
use ninebit::state::{Named, Scene};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestError, TestRng, TestRunner};
use std::path::Path;

/// The first pixel where two renders differ.
fn difference(got: &Frames, expected: &Frames) -> Option<String> {
    for (target, (got, expected)) in got.surfaces.iter().zip(&expected.surfaces).enumerate() {
        for (what, got, expected, width) in
            [("word", &got.words, &expected.words, got.width), ("depth", &got.depth, &expected.depth, got.width)]
        {
            let differing = (0..got.len()).filter(|at| got[*at] != expected[*at]);
            if let Some(at) = differing.clone().next() {
                let (x, y) = (at as u32 % width, at as u32 / width);
                let (got, expected, count) = (got[at], expected[at], differing.count());
                return Some(format!(
                    "target {target} ({x}, {y}): {what} {got:#010x}, scalar {expected:#010x}; {count} differ"
                ));
            }
        }
    }
    None
}

/// Renders by the definition and by the fast engine in some ways, and says where they differ.
fn compare(plan: &Plan, ways: &[(Isa, usize)]) -> Result<(), String> {
    let scalar = render(plan, &RenderOptions { engine: Engine::Scalar, ..RenderOptions::default() });
    for (isa, threads) in ways {
        let options = RenderOptions { threads: *threads, engine: Engine::Fast, isa: Some(*isa) };
        if let Some(difference) = difference(&render(plan, &options), &scalar) {
            return Err(format!("{}, {threads} threads: {difference}", isa.name()));
        }
    }
    Ok(())
}

#[test]
fn engines_agree_on_every_scene_of_the_repository() {
    let mut complaints = Vec::new();
    for path in scene_files::below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("vectors/scenes")) {
        let loaded = scene::load(&path, &Limits::default()).unwrap();
        if let Err(difference) = compare(&loaded.plan, &[(Isa::best(), 1), (Isa::Baseline, 3)]) {
            complaints.push(format!("{}: {difference}", path.display()));
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

/// A number from the environment.
fn setting(name: &str, otherwise: u32) -> u32 {
    std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(otherwise)
}

#[test]
fn engines_agree_on_random_scenes() {
    let cases = setting("NINEBIT_ENGINE_SCENES", 400);
    let config = Config {
        cases,
        max_shrink_iters: 20_000,
        max_global_rejects: cases,
        failure_persistence: None,
        ..Config::default()
    };
    let seed = setting("NINEBIT_ENGINE_SEED", 5) as u8;
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 32]));
    let ways: Vec<(Isa, usize)> =
        Isa::ALL.iter().filter(|isa| isa.is_available()).map(|isa| (*isa, 1 + *isa as usize % 2)).collect();
    let result = runner.run(&random_scene::scene(), |scene: Scene| {
        for prune in [true, false] {
            let plan = Plan::compile(&scene, &PlanOptions { prune, ..PlanOptions::default() }).unwrap();
            compare(&plan, &ways).map_err(|difference| TestCaseError::fail(format!("prune {prune}: {difference}")))?;
        }
        Ok(())
    });
    if let Err(TestError::Fail(reason, scene)) = result {
        panic!("{reason}\n{scene:#?}");
    }
}
