//! Draws scenes by a GPU and compares every stored word with the engine's. Without an adapter the tests are ignored.
//!
//! `NINEBIT_GPU_ADAPTER` names the adapter, `NINEBIT_GPU_SCENES` is the number of random scenes, `NINEBIT_WHOLE_SEED` selects others, and
//! `NINEBIT_WHOLE_EVERY` is a step through the scenes of the repository.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]
#![allow(missing_docs, unreachable_pub, dead_code, reason = "a shared file of which a part is used")]

#[path = "../../lower/tests/common/setting.rs"]
mod setting;

use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::{Arguments, Failed, Trial};
use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::state::{Policies, Scene, TextureImage};
use ninebit_gpu::{Failure, Gpu, Renderer, Text, adapters, difference};
use ninebit_lower::unprinted;
use ninebit_test_support::random_scene;
use proptest::strategy::{Strategy, ValueTree};
use setting::{any_policies, runner, setting};
use walkdir::WalkDir;

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../vectors/scenes");

fn main() {
    let arguments = Arguments::from_args();
    let none = adapters().is_empty();
    let trial = |name: &str, run: fn() -> Result<(), Failed>| Trial::test(name, run).with_ignored_flag(none);
    let trials = vec![
        trial("committed_scenes_have_the_words_of_the_engine", committed),
        trial("random_scenes_have_the_words_of_the_engine", random),
        trial("one_text_draws_committed_scenes", committed_by_one_text),
        trial("one_text_draws_random_scenes", random_by_one_text),
        trial("targets_of_another_texel_size_are_converted", converted),
        trial("a_difference_is_found", found),
        trial("adapters_are_chosen_by_number_and_name", chosen),
        trial("limits_refuse_by_name", limits),
        trial("captured_frames_have_the_words_of_the_engine", captured),
        trial("both_engines_write_one_picture", pictures),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}

fn open() -> Gpu {
    let wanted = std::env::var("NINEBIT_GPU_ADAPTER").ok();
    Gpu::open(wanted.as_deref()).unwrap()
}

/// Draws a scene by its own texts, and says how it differs from the engine's.
fn hold(gpu: &Gpu, scene: &Scene, policies: Policies, what: &str) -> Result<(), Failed> {
    hold_by(gpu, (scene, what), policies, Text::OfDraw)
}

/// Draws a scene by texts, and says how it differs from the engine's.
fn hold_by(gpu: &Gpu, (scene, what): (&Scene, &str), policies: Policies, text: Text) -> Result<(), Failed> {
    let plan = Plan::compile(scene, &PlanOptions { policies, ..PlanOptions::default() }).unwrap();
    let plan = text.plan(scene, &plan).unwrap();
    if plan.draws().iter().any(|draw| unprinted(draw, text == Text::OfDraw).is_some()) {
        let failure = Renderer::new(gpu, scene, &plan, text).map(|_| ()).unwrap_err();
        return if failure.is_unprinted() { Ok(()) } else { Err(failure.text().into()) };
    }
    let renderer = Renderer::new(gpu, scene, &plan, text).map_err(|failure| format!("{what}: {}", failure.text()))?;
    // Twice, since a frame must not depend on the one before.
    for _ in 0..2 {
        renderer.draw().map_err(|failure| format!("{what}: {}", failure.text()))?;
    }
    let found = renderer.frames().map_err(|failure| failure.text())?;
    match difference(&plan, &render(&plan, &RenderOptions::default()), &found) {
        Some(text) => Err(format!("{what}: {text}").into()),
        None => Ok(()),
    }
}

/// Loads a scene of the repository; `None` if the file is a part of others.
fn load(path: &Path) -> Option<Scene> {
    ninebit_scene::load(path, &Limits::default()).ok().map(|loaded| loaded.scene)
}

fn committed() -> Result<(), Failed> {
    hold_committed(Text::OfDraw, 1)
}

fn committed_by_one_text() -> Result<(), Failed> {
    hold_committed(Text::OfEveryDraw, 20)
}

/// Draws every nth scene of the repository.
fn hold_committed(text: Text, step: u64) -> Result<(), Failed> {
    let gpu = open();
    let of = |path: &PathBuf| {
        let name = path.to_string_lossy();
        name.ends_with(".ron") && !name.ends_with(".expect.ron")
    };
    let all = WalkDir::new(SCENES).sort_by_file_name().into_iter().map(|entry| entry.unwrap().into_path()).filter(of);
    let mut drawn = 0;
    for path in all.step_by(setting("NINEBIT_WHOLE_EVERY").unwrap_or(step) as usize) {
        let Some(scene) = load(&path) else { continue };
        drawn += 1;
        hold_by(&gpu, (&scene, &path.to_string_lossy()), Policies::DEFAULT, text)?;
    }
    println!("{drawn} scenes");
    if drawn == 0 { Err("no scene was found".into()) } else { Ok(()) }
}

fn random() -> Result<(), Failed> {
    hold_random(Text::OfDraw, 300)
}

fn random_by_one_text() -> Result<(), Failed> {
    hold_random(Text::OfEveryDraw, 10)
}

/// Draws random scenes.
fn hold_random(text: Text, count: u64) -> Result<(), Failed> {
    let (gpu, seed) = (open(), setting("NINEBIT_WHOLE_SEED").unwrap_or(44));
    let (mut runner, mut random) = (runner(seed), Random::seeded(seed));
    let (scenes, count) = (random_scene::sharp(), setting("NINEBIT_GPU_SCENES").unwrap_or(count));
    for number in 0..count {
        let scene = scenes.new_tree(&mut runner).unwrap().current();
        // The text for every draw is compiled for each set of policies.
        let alternatives = if text == Text::OfDraw { number % 2 == 1 } else { number % 100 == 99 };
        let policies = if alternatives { any_policies(&mut random) } else { Policies::DEFAULT };
        hold_by(&gpu, (&scene, &format!("scene {number} of seed {seed}")), policies, text)?;
    }
    Ok(())
}

/// Loads a scene by its name.
fn scene(name: &str) -> Scene {
    load(&Path::new(SCENES).join(name)).unwrap()
}

/// Returns what a renderer is refused for.
fn refusal(gpu: &Gpu, scene: &Scene) -> Failure {
    let plan = Plan::compile(scene, &PlanOptions::default()).unwrap();
    Renderer::new(gpu, scene, &plan, Text::OfDraw).map(|_| ()).unwrap_err()
}

/// Returns whether a scene reads a target as texels of another size.
fn converts(scene: &Scene) -> bool {
    scene.textures.iter().any(|texture| match &texture.image {
        TextureImage::Target { target } => scene.targets[*target].format.bytes() != texture.format.bytes(),
        _ => false,
    })
}

fn converted() -> Result<(), Failed> {
    let scene = scene("buffers/bytes.ron");
    assert!(converts(&scene));
    hold(&open(), &scene, Policies::DEFAULT, "bytes")
}

/// Runs the program by the chosen adapter. Returns what it prints.
fn run(arguments: &[&str]) -> Result<Vec<u8>, Failed> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ninebit-gpu"));
    if let Ok(wanted) = std::env::var("NINEBIT_GPU_ADAPTER") {
        command.args([arguments[0], "--adapter", &wanted]).args(&arguments[1..]);
    } else {
        command.args(arguments);
    }
    let output = command.output()?;
    if output.status.success() { Ok(output.stdout) } else { Err(format!("{output:?}").into()) }
}

fn captured() -> Result<(), Failed> {
    // Frames of one scene, of a scene that reads another, and of two views of a memory.
    let suites = ["Stencil_func", "Surface_clip", "Blend_surface"].map(|suite| ["--suite", suite]);
    let frames = [&["captures", "--step", "11"], suites.as_flattened()].concat();
    let by_gpu = String::from_utf8(run(&frames)?)?;
    let by_cpu = String::from_utf8(run(&[&frames[..], &["--engine", "cpu"]].concat())?)?;
    let words = by_gpu.strip_prefix(&by_cpu).ok_or_else(|| format!("{by_gpu}\n{by_cpu}"))?;
    assert!(by_cpu.contains("Stencil_func") && words.ends_with("have our engine's words\n"), "{by_gpu}");
    Ok(())
}

fn pictures() -> Result<(), Failed> {
    let path = format!("{SCENES}/bench/w1.ron");
    let render = ["render", &path, "-o", "-"];
    let by_gpu = run(&render)?;
    assert!(by_gpu.starts_with(b"\x89PNG"));
    assert_eq!(by_gpu, run(&[&render[..], &["--engine", "cpu"]].concat())?);
    Ok(())
}

fn limits() -> Result<(), Failed> {
    let gpu = open().within(1 << 16);
    let failure = refusal(&gpu, &scene("bench/w1.ron"));
    assert_eq!(failure.exit(), 5);
    assert!(failure.text().contains("NB1702") && failure.text().contains("the words of a target take 1228800 bytes"));
    Ok(())
}

fn found() -> Result<(), Failed> {
    let scene = scene("bench/w1.ron");
    let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    let wanted = render(&plan, &RenderOptions::default());
    let mut found = wanted.clone();
    assert_eq!(difference(&plan, &wanted, &found), None);
    found.surfaces[0].words[641] ^= 1;
    let text = difference(&plan, &wanted, &found).unwrap();
    assert!(text.starts_with("target 0, 1 pixels: word of 1,1 is") && text.contains("texture0.r"), "{text}");
    Ok(())
}

fn chosen() -> Result<(), Failed> {
    let name = adapters()[0].get_info().name;
    assert!(Gpu::open(Some("0")).unwrap().name.starts_with(&name));
    assert!(Gpu::open(Some(&name.to_uppercase())).unwrap().name.starts_with(&name));
    for wanted in ["4096", "no such adapter"] {
        let failure = Gpu::open(Some(wanted)).map(|_| ()).unwrap_err();
        assert_eq!(failure.exit(), 4);
        assert!(failure.text().contains("NB1701") && failure.text().contains(wanted), "{}", failure.text());
    }
    Ok(())
}
