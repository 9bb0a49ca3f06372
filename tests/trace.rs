//! Traces: a stored word follows from the numbers of its trace alone, and equals what the engine stores.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

use crate::random_scene;
use crate::recompute;

use ninebit::engine::{self, RenderOptions, TraceError};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::report::{trace_json, trace_text};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use serde_json::Value;

/// Pixels with at least one fragment that the test recomputes.
const PIXELS: usize = 200;

#[test]
fn stored_words_follow_from_the_trace_alone() {
    let mut runner = TestRunner::deterministic();
    let (mut pixels, mut fragments, mut random) = (0, 0, Random::seeded(1));
    while pixels < PIXELS {
        let scene = random_scene::scene().new_tree(&mut runner).unwrap().current();
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        let frames = engine::render(&plan, &RenderOptions::default());
        // A few pixels of each target, wherever the generator points.
        for (target, surface) in frames.surfaces.iter().enumerate() {
            for _ in 0..4 {
                let [x, y] = [surface.width, surface.height].map(|side| random.below(side.into()) as u32);
                let trace = engine::trace(&plan, target, (x, y), None).unwrap();
                let stored = surface.words[(y * surface.width + x) as usize];
                assert_eq!(trace.word, stored, "{}", trace_text(&plan, &trace));
                let document: Value = serde_json::from_str(&trace_json(&plan, &trace)).unwrap();
                let mut word = None;
                for draw in document["draws"].as_array().unwrap() {
                    let known = recompute::fragment(draw, &document["policies"])
                        .unwrap_or_else(|e| panic!("{e}\n{}", trace_text(&plan, &trace)));
                    if draw["stored"].as_bool().unwrap() {
                        word = Some(known["stored.word"].value);
                    }
                    fragments += 1;
                }
                if let Some(word) = word {
                    assert_eq!(word, i128::from(stored), "{}", trace_text(&plan, &trace));
                    pixels += 1;
                }
            }
        }
    }
    println!("{pixels} pixels, {fragments} fragments recomputed");
    assert!(fragments >= PIXELS);
}

#[test]
fn pixels_and_draws_that_do_not_exist_are_refused() {
    let mut runner = TestRunner::deterministic();
    let scene = random_scene::scene().new_tree(&mut runner).unwrap().current();
    let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    let outside = (plan.targets[0].width, 0);
    assert!(matches!(engine::trace(&plan, 0, outside, None), Err(TraceError::Pixel { .. })));
    assert!(matches!(engine::trace(&plan, 0, (0, 0), Some(plan.draws.len())), Err(TraceError::Draw { .. })));
}
