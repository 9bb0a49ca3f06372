//! Compares the printed form of draws with traces, which record what each pixel was given and what it stored.
//!
//! `NINEBIT_LOWER_SCENES` is the number of random scenes; `NINEBIT_LOWER_SEED` selects others.
#![allow(missing_docs, unreachable_pub, dead_code, reason = "modules share files of which each uses its part")]
#![allow(clippy::unwrap_used, clippy::float_arithmetic, reason = "tests fail by panicking")]

#[path = "common/setting.rs"]
mod setting;
#[path = "common/traced.rs"]
mod traced;

use ninebit::combiner::registers::channel_name;
use ninebit::engine::{DrawTrace, trace};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::state::{Policies, Scene};
use ninebit_lower::code::{Test, run, value_of};
use ninebit_lower::{Function, Options, Result, Textures};
use ninebit_test_support::random_scene;
use proptest::strategy::{Strategy, ValueTree};
use setting::{any_policies, runner, setting};
use traced::Traced;

/// Compares one fragment with its trace. Returns whether it could be compared.
fn check(scene: &Scene, fragment: &DrawTrace, function: &Function, what: &str) -> bool {
    let draw = &scene.draws[fragment.draw];
    let traced = Traced::from_fragment(fragment);
    let said = |name: &str| traced.said(name);
    let dropped = traced.dropped();
    if !fragment.stored && !dropped {
        return false;
    }
    let values = run(&function.lines, |input| traced.given(draw, input));
    match function.result {
        Result::Fragment(channels) => {
            for (c, channel) in channels.into_iter().enumerate() {
                let want = said(&format!("fragment.{}", channel_name(c)));
                let got = value_of(&values, channel);
                assert!(want.is_none_or(|want| want == got), "{what}: fragment channel {c} is {got}, traced {want:?}");
            }
        }
        Result::Pixel { .. } => panic!("no whole pixel was asked for"),
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
    let seed = setting("NINEBIT_LOWER_SEED").unwrap_or(23);
    let count = setting("NINEBIT_LOWER_SCENES").unwrap_or(400);
    let held: u64 = std::thread::scope(|scope| {
        let halves = [0, 1].map(|half| scope.spawn(move || hold(seed + half, count.div_ceil(2))));
        halves.into_iter().map(|half| half.join().unwrap()).sum()
    });
    assert!(held > 4 * count, "of {count} scenes {held} fragments were looked at");
    println!("{held} fragments of {count} scenes");
}

/// Compares random scenes with their traces. Returns the number of fragments.
fn hold(seed: u64, count: u64) -> u64 {
    let mut runner = runner(seed);
    let (mut random, mut held) = (Random::seeded(seed), 0);
    let scenes = random_scene::sharp();
    for number in 0..count {
        let scene = scenes.new_tree(&mut runner).unwrap().current();
        let policies = if number % 2 == 1 { any_policies(&mut random) } else { Policies::DEFAULT };
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
            .zip(plan.draws())
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
    held
}
