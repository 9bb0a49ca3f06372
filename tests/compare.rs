//! Tests the comparison with the ideal: it agrees with the trace, its parts add up, and it stays within the stated bounds.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

use crate::repository::at;
use ninebit_test_support::random_scene;

use ninebit::engine::{RenderOptions, render, trace};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;
use ninebit::trace::{Decision, Rule};
use ninebit_report::compare::{ALL_CHANNELS, CompareOptions, Comparison, Mode, Statistics, compare};
use ninebit_scene as scene;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use std::path::{Path, PathBuf};

fn options(mode: Mode) -> CompareOptions {
    CompareOptions { mode, target: 0, threads: 1, channels: ALL_CHANNELS }
}

/// Returns the DOT3 scenes of the repository by path.
fn repository() -> Vec<(PathBuf, Plan)> {
    let folder = at("vectors/scenes/dot3");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| {
        let name = path.to_string_lossy();
        name.ends_with(".ron") && !name.ends_with(".expect.ron")
    });
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), scene::load(&path, &Limits::default()).unwrap().plan)).collect()
}

/// Calls `visit` with random plans under varying policies, the same ones on every machine.
fn random(count: usize, mut visit: impl FnMut(&Plan, &Scene)) {
    let mut runner = TestRunner::deterministic();
    for n in 0..count {
        let scene = random_scene::scene().new_tree(&mut runner).unwrap().current();
        let mut plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        for (k, policy) in POLICIES.iter().enumerate() {
            plan.policies.choose(policy.rule, (n / (k + 1)) % policy.values.len());
        }
        visit(&plan, &scene);
    }
}

fn check_bounds(what: &str, comparison: &Comparison) {
    for rule in &comparison.rules {
        assert!(!rule.exceeds(), "{:?} {:?} outside {:?}: {what}", rule.rule, rule.errors, rule.bound);
    }
}

#[test]
fn single_rules_stay_within_their_bounds_on_every_scene() {
    for (path, plan) in repository() {
        let comparison = compare(&plan, &options(Mode::PerOp));
        check_bounds(&path.display().to_string(), &comparison);
        assert!(comparison.rules.iter().any(|rule| rule.rule == Rule::Cmb8), "{}: no dot product", path.display());
    }
}

#[test]
fn single_rules_stay_within_their_bounds_on_random_scenes() {
    let mut seen = std::collections::BTreeSet::new();
    random(1500, |plan, scene| {
        let comparison = compare(plan, &options(Mode::PerOp));
        check_bounds(&format!("{:?} {scene:?}", plan.policies), &comparison);
        seen.extend(comparison.rules.iter().map(|rule| rule.rule.name()));
    });
    // Anisotropy occurs only in scenes that are made for it.
    let floor = at("vectors/scenes/sampling/anisotropy.ron");
    let floor = compare(&scene::load(&floor, &Limits::default()).unwrap().plan, &options(Mode::PerOp));
    check_bounds("anisotropy.ron", &floor);
    seen.extend(floor.rules.iter().map(|rule| rule.rule.name()));
    // Every rule that can cause an error has occurred.
    assert_eq!(seen.len(), Rule::ALL.len(), "{seen:?}");
}

#[test]
fn parts_add_up_to_the_error() {
    random(600, |plan, scene| {
        let comparison = compare(plan, &options(Mode::Follow));
        assert!(comparison.unexplained < 1e-6, "{} {:?} {scene:?}", comparison.unexplained, plan.policies);
        let sum = |errors: &Statistics| errors.bias() * errors.count as f64;
        let total: f64 = comparison.channels.iter().map(|channel| sum(&channel.errors)).sum();
        let parts: f64 = comparison.parts.iter().map(|part| sum(&part.1)).sum();
        assert!((total - parts).abs() < 1e-5 * (1.0 + comparison.drawn as f64), "{total} {parts}");
    });
}

/// The ideal of a trace follows the decisions of the definition as well. Its last value for a pixel is that of the comparison.
#[test]
fn followed_ideals_are_those_of_the_trace() {
    let mut compared = 0;
    random(250, |plan, scene| {
        // A trace cannot follow the ideal through a surface that a draw reads, so such scenes are skipped.
        let mut read = scene.draws.iter().flat_map(|draw| draw.textures.iter().flatten());
        if read.any(|unit| matches!(scene.textures[unit.texture].image, TextureImage::Target { .. })) {
            return;
        }
        let comparison = compare(plan, &options(Mode::Follow));
        for w in comparison.worst.iter().take(3) {
            let pixel = trace(plan, 0, (w.x, w.y), None).unwrap();
            let name = format!("stored.{}", ["r", "g", "b", "a"][w.channel]);
            let steps = pixel.draws.iter().filter(|d| d.stored).flat_map(|d| &d.steps);
            let Some(ideal) = steps.filter(|s| s.name == name).filter_map(|s| s.ideal).next_back() else { continue };
            assert!((255.0 * ideal - w.ideal).abs() < 1e-9, "{w:?}: {ideal}");
            compared += 1;
        }
    });
    assert!(compared >= 50, "{compared}");
}

#[test]
fn decisions_and_pixels_are_counted() {
    for (path, plan) in repository() {
        let drawn = compare(&plan, &options(Mode::Follow));
        let frames = render(&plan, &RenderOptions::default());
        let touched = frames.surfaces[0].words.len() as u64;
        assert!(0 < drawn.drawn && drawn.drawn <= touched);
        assert_eq!(drawn.errors.len(), frames.surfaces[0].words.len());
        for channel in &drawn.channels {
            assert_eq!(channel.errors.count, drawn.drawn, "{}", path.display());
            assert_eq!(channel.histogram.0.iter().sum::<u64>(), drawn.drawn);
        }
        let free = compare(&plan, &options(Mode::Free));
        assert!(free.drawn >= drawn.drawn && free.diverged < free.drawn / 4, "{}", path.display());
        for channel in &free.channels {
            assert_eq!(channel.errors.count, free.drawn - free.diverged);
        }
        let differing: u64 = free.decisions.iter().map(|d| d.differing).sum();
        assert!((free.diverged > 0) == (differing > 0));
        assert!(free.decisions.iter().any(|d| d.decision == Decision::Coverage && d.taken >= free.drawn));
    }
}

#[test]
fn threads_change_nothing_that_is_counted() {
    random(40, |plan, _| {
        for mode in Mode::ALL {
            let one = compare(plan, &options(*mode));
            let three = compare(plan, &CompareOptions { threads: 3, ..options(*mode) });
            assert_eq!((one.drawn, one.diverged, &one.decisions), (three.drawn, three.diverged, &three.decisions));
            let bits = |c: &Comparison| c.errors.iter().map(|e| e.map(f32::to_bits)).collect::<Vec<_>>();
            assert_eq!(bits(&one), bits(&three));
        }
    });
}

/// Returns the plan of a scene in which one draw stores the same colour in every pixel. D is the primary colour unless `change` alters it.
fn flat(change: impl FnOnce(&mut Scene)) -> Plan {
    let text = "(version: 1, profile: Nv2a, targets: [(name: \"frame\", width: 4, height: 4)], draws: [(vertices: Window([\
                (position: (0, 0), diffuse: (100, 200, 37, 255)), (position: (4, 0), diffuse: (100, 200, 37, 255)), \
                (position: (4, 4), diffuse: (100, 200, 37, 255)), (position: (0, 4), diffuse: (100, 200, 37, 255))]), \
                topology: Quads)])";
    let mut scene = scene::parse(text, Path::new("flat.ron"), &Limits::default()).unwrap().scene;
    change(&mut scene);
    Plan::compile(&scene, &PlanOptions::default()).unwrap()
}

#[test]
fn what_is_exact_has_no_error() {
    let plan = flat(|_| {});
    for mode in [Mode::Free, Mode::Follow] {
        let comparison = compare(&plan, &options(mode));
        assert_eq!((comparison.drawn, comparison.diverged), (16, 0));
        assert!(comparison.channels.iter().all(|c| c.errors.max() == 0.0 && c.errors.psnr().is_infinite()));
        assert!(comparison.worst.is_empty());
        assert_eq!(
            ninebit_report::compare::heat_map(&comparison),
            Err(ninebit_report::compare::HeatError::NoDifference)
        );
    }
}

/// Expanded, 100 is 2 (100 - 128) = -56 and ideally 2 * 100 - 255 = -55, which differ by one step of CMB-3. Times 200/255, the results are
/// -43.9 and -43.1. Negated and rounded they are 44 and ideally 43.1.
#[test]
fn one_product_by_hand() {
    let plan = flat(|scene| {
        let combiners = &mut scene.draws[0].combiners;
        let rgb = &mut combiners.stages[0].rgb;
        *rgb = Portion::idle(Component::Rgb);
        rgb.inputs[0] = CombinerInput {
            register: Register::PrimaryColor,
            component: Component::Rgb,
            mapping: InputMapping::ExpandNegate,
        };
        rgb.inputs[1] = CombinerInput {
            register: Register::ConstantColor0,
            component: Component::Rgb,
            mapping: InputMapping::UnsignedIdentity,
        };
        rgb.ab_output = Register::Spare0;
        combiners.stages[0].constants[0] = [200; 4];
        combiners.final_combiner.inputs = [FinalInput::zero(Component::Rgb); 6];
        combiners.final_combiner.inputs[3].register = FinalRegister::Spare0;
    });
    let follow = compare(&plan, &options(Mode::Follow));
    let red = follow.channels[0].errors;
    let ideal = 55.0 * 200.0 / 255.0;
    assert!((red.low - (44.0 - ideal)).abs() < 1e-12 && red.low == red.high, "{red:?}");
    let part = |name: &str| follow.parts.iter().find(|p| p.0.name() == name).unwrap().1;
    assert!((part("expansion").high - 200.0 / 255.0).abs() < 1e-12);
    assert_eq!(part("interpolation").max() + part("filtering").max() + part("store").max(), 0.0);
    let per_op = compare(&plan, &options(Mode::PerOp));
    let rule = |rule: Rule| per_op.rules.iter().find(|r| r.rule == rule).unwrap().errors;
    assert_eq!((rule(Rule::Cmb3).low, rule(Rule::Cmb3).high), (1.0, 1.0));
    assert!((rule(Rule::Cmb6).high - (44.0 - 56.0 * 200.0 / 255.0)).abs() < 0.5);
    let free = compare(&plan, &options(Mode::Free));
    assert_eq!(free.channels[0].errors.low, red.low);
}

/// An alpha test near its limit, where the ideal alpha rounds to the other side of the reference.
#[test]
fn decisions_that_differ_are_left_out() {
    let plan = flat(|scene| {
        let draw = &mut scene.draws[0];
        draw.vertices
            .update(|index, vertex| vertex.diffuse = VertexColor::Bytes([100, 200, 37, [0, 255, 255, 0][index]]));
        scene.targets[0].width = 250;
        scene.draws[0].vertices.update(|_, vertex| vertex.position[0] *= 250.0 / 4.0);
        scene.draws[0].alpha_test = Some(AlphaTest { function: CompareFunction::Greater, reference: 127 });
    });
    let free = compare(&plan, &options(Mode::Free));
    let test = free.decisions.iter().find(|d| d.decision == Decision::AlphaTest).unwrap();
    assert_eq!(test.taken, 1000);
    assert!(test.differing > 0 && free.diverged == test.differing, "{test:?} {}", free.diverged);
    // The remaining pixels do not differ by a whole colour.
    assert!(free.channels.iter().all(|c| c.errors.max() < 3.0), "{:?}", free.channels);
    let follow = compare(&plan, &options(Mode::Follow));
    let followed = follow.decisions.iter().find(|d| d.decision == Decision::AlphaTest).unwrap();
    assert_eq!((follow.diverged, followed.differing), (0, test.differing));
}
