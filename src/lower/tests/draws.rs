//! The lines of draws against traces: what a trace says a pixel was given goes in, and what it says was stored has to come out.
//!
//! `NINEBIT_LOWER_SCENES` says of how many random scenes, `NINEBIT_LOWER_SEED` chooses others.
#![allow(
    missing_docs,
    unreachable_pub,
    dead_code,
    clippy::unwrap_used,
    clippy::float_arithmetic,
    reason = "tests fail by panicking, and modules share files of which each uses its part"
)]

#[path = "../../../tests/common/random_scene.rs"]
mod random_scene;

use std::collections::HashMap;

use ninebit::combiner::registers::channel_name;
use ninebit::engine::{DrawTrace, trace};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::state::{Draw, POLICIES, Policies, Scene};
use ninebit_lower::code::{Test, run, value_of};
use ninebit_lower::{Function, Input, Options, Result, Textures, Weight};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |text| text.parse().unwrap())
}

/// What a trace says of an input; 0 where it says nothing: then nothing depends on it.
fn given(steps: &HashMap<&str, (i64, &str)>, draw: &Draw, input: Input) -> i64 {
    let said = |name: String| steps.get(name.as_str()).map_or(0, |(value, _)| *value);
    let texel = |n: usize, at: usize| {
        let next = if at < 4 { "" } else { "next." };
        let of = |suffix: &str| steps.get(format!("unit{n}.{next}texel{suffix}.word").as_str()).copied();
        // A single texel is the first.
        of(["00", "10", "01", "11"][at % 4]).or_else(|| of("").filter(|_| at.is_multiple_of(4))).unwrap_or((0, ""))
    };
    match input {
        Input::Primary(c) => said(format!("primary.{}", channel_name(c))),
        Input::Secondary(c) => said(format!("secondary.{}", channel_name(c))),
        Input::Fog(c) => said(format!("fog.{}", channel_name(c))),
        Input::Texture(n, c) => said(format!("texture{n}.{}", channel_name(c))),
        Input::Texel(n, at) => texel(n, at).0,
        Input::Outside(n) => (0..8).filter(|at| texel(n, *at).1 == "border_color").map(|at| 1 << at).sum(),
        Input::Weight(n, of) => said(match of {
            Weight::U => format!("unit{n}.weight_u"),
            Weight::V => format!("unit{n}.weight_v"),
            Weight::NextU => format!("unit{n}.next.weight_u"),
            Weight::NextV => format!("unit{n}.next.weight_v"),
            Weight::Level => format!("unit{n}.weight_lod"),
        }),
        Input::Destination => said("destination.word".to_string()).max(said("surface.word".to_string())),
        Input::StageConstant(stage, n, c) => draw.combiners.stages[stage].constants[n][c].into(),
        Input::FinalConstant(n, c) => draw.combiners.final_combiner.constants[n][c].into(),
        Input::FogColor(c) => draw.fog.color[c].into(),
        Input::BlendConstant(c) => draw.blend_constant[c].into(),
        Input::AlphaReference => draw.alpha_test.unwrap().reference.into(),
        Input::BorderColor(n, c) => draw.textures[n].unwrap().border_color[c].into(),
        Input::Local(local) => panic!("a draw does not read {local:?}"),
    }
}

/// Holds one fragment against the trace; whether it was one to be held.
fn check(scene: &Scene, fragment: &DrawTrace, function: &Function, what: &str) -> bool {
    let draw = &scene.draws[fragment.draw];
    let steps: HashMap<&str, (i64, &str)> =
        fragment.steps.iter().map(|step| (step.name.as_str(), (step.value, step.operation))).collect();
    let said = |name: &str| steps.get(name).map(|(value, _)| *value);
    // What the registers hold before stages write to them.
    let mut first: HashMap<&str, (i64, &str)> = HashMap::new();
    let mut combines = false;
    for step in &fragment.steps {
        combines |= step.block.starts_with("general stage") || step.block == "final combiner";
        if !combines || !first.contains_key(step.name.as_str()) {
            first.insert(&step.name, (step.value, step.operation));
        }
    }
    let dropped = said("alpha_test.passed") == Some(0);
    if !fragment.stored && !dropped {
        return false;
    }
    let values = run(&function.lines, |input| given(&first, draw, input));
    match function.result {
        Result::Fragment(channels) => {
            for (c, channel) in channels.into_iter().enumerate() {
                let want = said(&format!("fragment.{}", channel_name(c)));
                let got = value_of(&values, channel);
                assert!(want.is_none_or(|want| want == got), "{what}: fragment channel {c} is {got}, traced {want:?}");
            }
        }
        Result::Stored { word, test } => {
            let passed = test.is_none_or(|Test(test, [a, b])| test.passes(value_of(&values, a), value_of(&values, b)));
            assert_eq!(passed, !dropped, "{what}: the alpha test");
            if passed {
                let (got, want) = (value_of(&values, word), said("stored.word").unwrap());
                assert_eq!(got, want, "{what}: stored {got:#010x}, traced {want:#010x}");
            }
        }
    }
    true
}

#[test]
fn stored_words_are_those_of_traces() {
    let seed = setting("NINEBIT_LOWER_SEED", 23);
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[seed as u8; 32]);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    let (mut random, mut held) = (Random::seeded(seed), 0);
    let scenes = random_scene::scene();
    let count = setting("NINEBIT_LOWER_SCENES", 400);
    for number in 0..count {
        let scene = scenes.new_tree(&mut runner).unwrap().current();
        let mut policies = Policies::DEFAULT;
        if number % 2 == 1 {
            for policy in POLICIES {
                let (value, _) = random.pick(policy.values).unwrap();
                policies.set(&format!("{}={value}", policy.rule)).unwrap();
            }
        }
        let plan = Plan::compile(&scene, &PlanOptions { prune: false, policies }).unwrap();
        let textures = [Textures::Registers, Textures::Words];
        let ways = textures.map(|textures| Options {
            policies,
            textures,
            uniform: number % 3 == 0,
            fragment: number % 7 == 0,
        });
        let made: Vec<[Function; 2]> = scene
            .draws
            .iter()
            .zip(&plan.draws)
            .map(|(draw, planned)| ways.map(|options| Function::of_draw(&scene, draw, planned, &options)))
            .collect();
        for target in 0..scene.targets.len() {
            for _ in 0..6 {
                let [width, height] = [scene.targets[target].width, scene.targets[target].height];
                let pixel = (random.below(width.into()) as u32, random.below(height.into()) as u32);
                for fragment in &trace(&plan, target, pixel, None).unwrap().draws {
                    for (function, way) in made[fragment.draw].iter().zip(&ways) {
                        let what =
                            format!("scene {number}, target {target} {pixel:?}, draw {}, {way:?}", fragment.draw);
                        held += u64::from(check(&scene, fragment, function, &what));
                    }
                }
            }
        }
    }
    assert!(held > 4 * count, "of {count} scenes {held} fragments were looked at");
    println!("{held} fragments of {count} scenes");
}
