//! Tests traces: the stored word follows from the numbers of the trace alone, and equals the word that the engine stores.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

use crate::bench::Bench;
use ninebit_test_support::random_scene;
use ninebit_test_support::recompute;

use ninebit::engine::{self, RenderOptions, TraceError};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit_report::{trace_json, trace_text};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use serde_json::Value;

/// Number of pixels with at least one fragment that the test recomputes.
const PIXELS: usize = 200;

#[test]
fn stored_words_follow_from_the_trace_alone() {
    let mut runner = TestRunner::deterministic();
    let (mut pixels, mut fragments, mut random) = (0, 0, Random::seeded(1));
    while pixels < PIXELS {
        let scene = random_scene::scene().new_tree(&mut runner).unwrap().current();
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        let frames = engine::render(&plan, &RenderOptions::default());
        // Tests a few random pixels of each target.
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
                        .unwrap_or_else(|e| panic!("{e}: tests/common/recompute.rs\n{}", trace_text(&plan, &trace)));
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
    let outside = (plan.targets()[0].width, 0);
    assert!(matches!(engine::trace(&plan, 0, outside, None), Err(TraceError::Pixel { .. })));
    assert!(matches!(engine::trace(&plan, 0, (0, 0), Some(plan.draws().len())), Err(TraceError::Draw { .. })));
}

/// Returns a scene with this number of triangles over the first pixel. Consecutive ones have different colours.
fn piled(triangles: usize) -> String {
    let vertices: String = (0..triangles)
        .map(|n| {
            let color = format!("diffuse: ({}, {}, 0)", n % 256, n / 256 % 256);
            format!("(position: (0, 0), {color}), (position: (2, 0), {color}), (position: (0, 2), {color}),\n")
        })
        .collect();
    format!("(version: 1, profile: Nv2a, targets: [(width: 4, height: 1)], draws: [(vertices: Window([{vertices}]))])")
}

#[test]
fn a_long_trace_keeps_the_last_fragments_and_says_what_it_leaves_out() {
    let bench = Bench::new();
    bench.write("piled.ron", piled(400));
    let text = bench.run("trace piled.ron --pixel 0,0").text();
    assert_eq!(text.matches("\ndraw 0").count(), 256, "{text:.500}");
    assert!(text.contains("the first 144 fragments are left out: `--fragments N` shows the last N"), "{text:.500}");
    assert!(text.contains(", triangle 144\n") && text.contains(", triangle 399\n"), "{text:.500}");
    let two = bench.run("trace piled.ron --pixel 0,0 --fragments 2").text();
    assert_eq!(two.matches("\ndraw 0").count(), 2, "{two}");
    let last = text.rfind("\ndraw 0").unwrap();
    assert!(two.ends_with(&text[last..]), "what is left out is drawn all the same");
    let document = |fragments: &str| -> Value {
        let json = bench.run(&format!("trace piled.ron --pixel 0,0 --format json{fragments}")).text();
        serde_json::from_str(&json).unwrap()
    };
    let short = document("");
    assert_eq!((&short["left_out"], short["draws"].as_array().unwrap().len()), (&144.into(), 256));
    let all = document(" --fragments 1000");
    assert_eq!((all.get("left_out"), all["draws"].as_array().unwrap().len()), (None, 400));
    assert_eq!(all["draws"].as_array().unwrap()[144..], short["draws"].as_array().unwrap()[..]);
    assert_eq!((&all["word"], &all["shown"]), (&short["word"], &short["shown"]));
}

#[test]
fn what_is_streamed_is_what_is_kept() {
    let bench = Bench::new();
    bench.write("piled.ron", piled(300));
    let loaded = ninebit_scene::load(&bench.path("piled.ron"), &Limits::default()).unwrap();
    {
        let pixel = (0, 0);
        let kept = engine::trace(&loaded.plan, 0, pixel, None).unwrap();
        let command = format!("trace piled.ron --pixel {},{}", pixel.0, pixel.1);
        assert_eq!(bench.run(&command).text(), trace_text(&loaded.plan, &kept));
        assert_eq!(bench.run(&format!("{command} --format json")).text(), trace_json(&loaded.plan, &kept));
    }
    assert_eq!(bench.run("trace piled.ron --pixel 3,0").text().matches("no triangle covers this pixel").count(), 1);
    let empty: Value = serde_json::from_str(&bench.run("trace piled.ron --pixel 3,0 --format json").text()).unwrap();
    assert_eq!(empty["draws"], Value::Array(Vec::new()));
}

#[test]
fn a_rectangle_is_its_pixels_row_by_row() {
    let bench = Bench::new();
    bench.write("piled.ron", piled(2).replace("height: 1", "height: 3"));
    let all: Value =
        serde_json::from_str(&bench.run("trace piled.ron --rectangle 1,0,2,3 --format json").text()).unwrap();
    let places = [(1, 0), (2, 0), (1, 1), (2, 1), (1, 2), (2, 2)];
    let (mut apart, mut text) = (Vec::new(), Vec::new());
    for (x, y) in places {
        let command = format!("trace piled.ron --pixel {x},{y}");
        text.push(bench.run(&command).text());
        apart.push(serde_json::from_str(&bench.run(&format!("{command} --format json")).text()).unwrap());
    }
    assert_eq!((&all["format"], &all["pixels"]), (&"ninebit-traces".into(), &Value::Array(apart)));
    assert_eq!(bench.run("trace piled.ron --rectangle 1,0,2,3").text(), text.join("\n"));
    for refused in ["1,0,2", "1,0,0,3", "0,0,65,64", "3,3,2,2"] {
        assert_eq!(bench.run(&format!("trace piled.ron --rectangle {refused}")).status, 2, "{refused}");
    }
}

#[test]
fn long_names_and_formulas_do_not_move_the_numbers() {
    use ninebit::trace::{Step, plain};
    let long = "a.name.that.is.wider.than.any.column.may.become";
    let operands = (0..30).map(|n| plain(format!("operand{n}"), n)).collect();
    let steps = [
        Step::plain("block", "CMB-1", "short", 12),
        Step::plain("block", "CMB-1", long, 345).by("given", Vec::new()),
        Step::plain("block", "CMB-1", "sum", 6789).by("operation", operands),
    ];
    let text = ninebit_report::steps_text(&steps);
    let ends: Vec<usize> =
        ["12", "345", "6789"].iter().map(|number| line_with(&text, &format!(" {number} ")).1 + number.len()).collect();
    assert!(ends.iter().all(|end| *end == ends[0]), "{text}");
    assert!(text.lines().any(|line| line.trim() == long), "{text}");
}

/// Returns the last line that contains a text, and the column of the text.
fn line_with<'t>(text: &'t str, part: &str) -> (&'t str, usize) {
    text.lines().rev().find_map(|line| Some((line, line.rfind(part)?))).unwrap_or_else(|| panic!("{part}: {text}"))
}
