//! The fast engine against the definition: the same words and depths in every scene of the repository and in random ones, whatever the
//! instruction set and the threads.
//!
//! The normal run draws the first 2,000 of a sequence of random scenes. `NINEBIT_ENGINE_SCENES` says how many instead, `NINEBIT_ENGINE_SHARD=k/n`
//! draws every n-th of them, beginning with the k-th (from 0), `NINEBIT_ENGINE_MATRIX` says how many of the first are drawn by every
//! instruction set with 1, 2, 3 and 8 threads and bands of all sizes, and `NINEBIT_ENGINE_SEED` chooses another sequence.
use crate::{random_scene, scene_files};

use ninebit::engine::{Engine, Isa, RenderOptions, render};
use ninebit::frame::Frames;
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::scene;
use ninebit::state::{Named, Scene};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use sha2::{Digest, Sha256};
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

/// Renders by the definition and by the fast engine in some ways, and says where they differ; the definition's frames.
fn compare(plan: &Plan, ways: &[RenderOptions]) -> Result<Frames, String> {
    let scalar = render(plan, &RenderOptions { engine: Engine::Scalar, ..RenderOptions::default() });
    for options in ways {
        if let Some(difference) = difference(&render(plan, options), &scalar) {
            return Err(format!("{options:?}: {difference}"));
        }
    }
    Ok(scalar)
}

/// The fast engine with an instruction set and some threads.
fn fast(isa: Isa, threads: usize) -> RenderOptions {
    RenderOptions { threads, isa: Some(isa), ..RenderOptions::default() }
}

#[test]
fn engines_agree_on_every_scene_of_the_repository() {
    let mut complaints = Vec::new();
    for path in scene_files::below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("vectors/scenes")) {
        let loaded = scene::load(&path, &Limits::default()).unwrap();
        if let Err(difference) = compare(&loaded.plan, &[fast(Isa::best(), 1), fast(Isa::Baseline, 3)]) {
            complaints.push(format!("{}: {difference}", path.display()));
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

/// A number from the environment.
fn setting(name: &str, otherwise: u32) -> u32 {
    std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(otherwise)
}

/// Everything that the engine can be told: instruction sets, threads, rows of a band.
fn every_way() -> Vec<RenderOptions> {
    let mut ways = Vec::new();
    for isa in Isa::ALL.iter().filter(|isa| isa.is_available()) {
        for threads in [1, 2, 3, 8] {
            for band in [None, Some(2), Some(6), Some(16), Some(4096)] {
                ways.push(RenderOptions { band, ..fast(*isa, threads) });
            }
        }
    }
    ways
}

/// A scene of the sequence, as something that can be made simpler.
fn tree(seed: u32, number: u32) -> impl ValueTree<Value = Scene> {
    let mut bytes = [0; 32];
    bytes[..4].copy_from_slice(&seed.to_le_bytes());
    bytes[4..8].copy_from_slice(&number.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut runner = TestRunner::new_with_rng(Config { failure_persistence: None, ..Config::default() }, rng);
    random_scene::scene().new_tree(&mut runner).unwrap()
}

/// What a frame adds to the digest: the first 64 bits of the SHA-256 of its words and depths.
fn digest(frames: &Frames) -> u64 {
    let mut hash = Sha256::new();
    for surface in &frames.surfaces {
        for word in surface.words.iter().chain(&surface.depth) {
            hash.update(word.to_le_bytes());
        }
    }
    u64::from_be_bytes(hash.finalize()[..8].try_into().unwrap())
}

/// Sums of digests do not depend on how the scenes are shared out among shards.
#[test]
fn engines_agree_on_random_scenes() {
    let (scenes, matrix) = (setting("NINEBIT_ENGINE_SCENES", 2_000), setting("NINEBIT_ENGINE_MATRIX", 12));
    let seed = setting("NINEBIT_ENGINE_SEED", 5);
    let shard = std::env::var("NINEBIT_ENGINE_SHARD").unwrap_or_else(|_| "0/1".to_owned());
    let (first, step) = shard.split_once('/').expect("NINEBIT_ENGINE_SHARD is k/n");
    let (first, step) = (first.parse::<u32>().unwrap(), step.parse::<usize>().unwrap());
    let every_way = every_way();
    let best = [fast(Isa::best(), 1)];
    let check = |number: u32, scene: &Scene| {
        let ways = if number < matrix { &every_way[..] } else { &best };
        let plan = |prune| Plan::compile(scene, &PlanOptions { prune, ..PlanOptions::default() }).unwrap();
        if number < matrix {
            compare(&plan(false), &best)?;
        }
        compare(&plan(true), ways)
    };
    let (mut count, mut sum) = (0_u32, 0_u64);
    for number in (first..scenes).step_by(step) {
        let mut tree = tree(seed, number);
        match check(number, &tree.current()) {
            Ok(frames) => (count, sum) = (count + 1, sum.wrapping_add(digest(&frames))),
            Err(reason) => {
                simplify(&mut tree, |scene| check(number, scene).is_err());
                panic!("scene {number}: {reason}\nat its simplest: {:#?}", tree.current());
            }
        }
    }
    println!("{count} scenes, digest {sum:016x}");
}

/// Leaves the simplest value that still fails.
fn simplify<T: ValueTree>(tree: &mut T, fails: impl Fn(&T::Value) -> bool) {
    for _ in 0..20_000 {
        if !tree.simplify() {
            return;
        }
        while !fails(&tree.current()) {
            if !tree.complicate() {
                return;
            }
        }
    }
}
