//! Checks that any text yields a scene or errors, never a panic, and that a small scene renders the same frame with and without pruning, and
//! with both engines, and that the relations between pictures hold.
#![no_main]

#[path = "../../tests/common/frames.rs"]
mod frames;
#[path = "../../tests/common/metamorphic.rs"]
mod metamorphic;

use libfuzzer_sys::fuzz_target;
use ninebit::engine::{Engine, RenderOptions, render};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use std::path::Path;

fuzz_target!(|text: &str| {
    let origin = Path::new("scenes/fuzzed.ron");
    match ninebit_scene::parse(text, origin, &Limits::default()) {
        Err(error) => assert!(!error.render(false).is_empty()),
        Ok(loaded) => {
            let pixels: u64 = loaded.scene.targets.iter().map(|t| u64::from(t.width) * u64::from(t.height)).sum();
            if pixels > 4096 || loaded.scene.draws.len() > 8 {
                return;
            }
            let [pruned, whole] = [true, false].map(|prune| {
                let plan = Plan::compile(&loaded.scene, &PlanOptions { prune, ..PlanOptions::default() });
                plan.expect("a loaded scene can be planned")
            });
            let drawn = |plan, engine| render(plan, &RenderOptions { engine, ..RenderOptions::default() });
            let fast = drawn(&pruned, Engine::Fast);
            for (other, name) in [(drawn(&whole, Engine::Fast), "unpruned"), (drawn(&pruned, Engine::Scalar), "scalar")]
            {
                assert!(fast == other, "{:?}", frames::difference(&fast, &other, name));
            }
            // Any text tells which change is made.
            let seed = crc32fast::hash(text.as_bytes()).into();
            if let Err(reason) = metamorphic::check(&loaded.scene, seed) {
                panic!("{reason}");
            }
        }
    }
});
