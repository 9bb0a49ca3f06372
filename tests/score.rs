//! Tests the scorecard: planted causes are found, right pictures have none, and noise is not explained. No captures are needed: the model's own frames
//! stand for the chip's.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::bench::Bench;
use crate::pages;
use crate::repository::at;
use crate::settings::number;

use std::collections::BTreeMap;
use std::fs;

use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::shortcut::{self, Shortcut, Shortcuts};
use ninebit::state::Named;
use ninebit_files::output::{Compression, encode_png};
use ninebit_scene::image::Rgba;
use ninebit_score::{Class, Explanation, FrameScore, Renderer, Subject, Truth, causes, of_scene, score};

/// Scenes of several units.
const SCENES: [&str; 14] = [
    "fog/modes",
    "fog/corridor",
    "dot3/constant-light",
    "dot3/block",
    "dot3/lit-stone",
    "programs/dot3-combiners",
    "programs/lit-combiners",
    "programs/tangent-space-highlight",
    "texture-shader/mirror-ball",
    "buffers/float-depth",
    "buffers/mirror",
    "lines/widths",
    "sampling/anisotropy",
    "deciding/CMB-10-mux",
];

/// Causes of one shortcut that are planted in a scene, and of two.
const OF_SCENE: usize = 3;

/// Causes that are planted in all.
const ALL_PLANTED: usize = 60;

/// So many pixels of a frame have to change before a cause can be told from chance.
const ENOUGH: usize = 200;

fn subject(name: &str) -> Option<Subject> {
    let path = at("vectors/scenes").join(format!("{name}.ron"));
    // The images of the captured programs need not be there.
    let loaded = ninebit_scene::load(&path, &Limits::default()).ok()?;
    let (suite, own) = name.split_once('/')?;
    of_scene(suite.to_owned(), own.to_owned(), loaded.scene)
}

fn renderer(subject: &Subject) -> Box<dyn Renderer> {
    subject.drawing.as_ref().unwrap().renderer().unwrap()
}

fn draw(subject: &Subject, shortcuts: Shortcuts) -> Option<Rgba> {
    let Truth::Model(width) = subject.truth else { return None };
    Some(Rgba::new(width, renderer(subject).draw(shortcuts, None)?))
}

fn explanation(scored: &FrameScore) -> &Explanation {
    scored.explanation.as_ref().unwrap()
}

/// Returns whether pictures differ in so many pixels, and in so many ways, that a cause can be told from chance. A step that most pixels of the
/// picture take is no evidence: every change that adds steps takes it.
fn differ_enough(a: &Rgba, b: &Rgba) -> bool {
    let steps = |(a, b): (&[u8; 4], &[u8; 4])| [0, 1, 2].map(|n| i16::from(a[n]) - i16::from(b[n]));
    let mut counts = BTreeMap::<[i16; 3], usize>::new();
    for step in a.pixels().iter().zip(b.pixels()).map(steps).filter(|step| *step != [0; 3]) {
        *counts.entry(step).or_default() += 1;
    }
    let most = counts.values().max().copied().unwrap_or(0);
    counts.values().sum::<usize>() >= ENOUGH && counts.len() >= 4 && most * 5 <= a.pixels().len() * 2
}

/// Returns variants of a scene that can be told from chance, with their pictures: up to `most` of one shortcut and as many of two.
fn variants(subject: &Subject, truth: &Rgba, most: usize) -> Vec<(Shortcuts, Rgba)> {
    let concerning: Vec<Shortcut> = renderer(subject).shortcuts().iter().collect();
    let drawn = |variant: Shortcuts| draw(subject, variant).map(|picture| (variant, picture));
    let is_told = |(_, picture): &(Shortcuts, Rgba)| differ_enough(truth, picture);
    let one = concerning.iter().map(|shortcut| Shortcuts::NONE.with(*shortcut)).filter_map(drawn).filter(is_told);
    let pair = |n: usize| {
        let step = 1 + n % 3;
        let (first, second) = (concerning.get(n)?, concerning.get(n + step)?);
        Some([*first, *second].into_iter().collect::<Shortcuts>())
    };
    let two = (0..concerning.len()).filter_map(pair).filter_map(drawn).filter(is_told);
    one.take(most).chain(two.take(most)).collect()
}

/// Draws scenes as a renderer with one shortcut does, and with two, and looks for the causes.
#[test]
fn planted_causes_are_found() {
    let wanted = number("NINEBIT_SCORE_PLANTED", 12_usize).min(ALL_PLANTED);
    let (mut planted, mut missed) = (0, Vec::new());
    for (scene, name) in SCENES.into_iter().enumerate() {
        let Some(subject) = subject(name) else { continue };
        let truth = draw(&subject, Shortcuts::NONE).unwrap();
        for (n, (variant, other)) in variants(&subject, &truth, OF_SCENE).into_iter().enumerate() {
            if planted == wanted || (scene + n) % (ALL_PLANTED / wanted.max(1)).max(1) != 0 {
                continue;
            }
            planted += 1;
            let scored = score(&subject, &truth, &other, true);
            let found = causes::choose([explanation(&scored)].into_iter());
            // Another set may draw the same pixels.
            if found.explained() * 100 < found.wrong * 95 {
                let (explained, wrong) = (found.explained(), found.wrong);
                missed.push(format!("{subject:?} {}: {explained} of {wrong}, {:?}", variant.names(), found.variants()));
            }
        }
    }
    eprintln!("{planted} planted");
    assert!(missed.is_empty(), "{} of {planted} missed: {missed:#?}", missed.len());
    assert!(planted * 10 >= wanted * 9, "{planted} planted, {wanted} wanted");
}

#[test]
fn right_pictures_have_no_causes() {
    for name in ["dot3/block", "fog/modes"] {
        let subject = subject(name).unwrap();
        let truth = draw(&subject, Shortcuts::NONE).unwrap();
        let scored = score(&subject, &truth, &truth, true);
        assert_eq!((scored.class, scored.counts.wrong), (Class::Exact, 0));
        assert!(scored.explanation.is_none());
    }
}

/// Errors of one to three steps, of a tenth of the pixels and of all, are no cause.
#[test]
fn noise_is_not_explained() {
    for (name, share) in [("dot3/block", 10), ("fog/modes", 1_u128)] {
        let subject = subject(name).unwrap();
        let truth = draw(&subject, Shortcuts::NONE).unwrap();
        let mut random = Random::seeded(71);
        let mut noisy = truth.clone();
        for pixel in noisy.pixels_mut() {
            if random.below(share) == 0 {
                (0..3).for_each(|n| pixel[n] = pixel[n].saturating_add_signed(random.below(7) as i8 - 3));
            }
        }
        let scored = score(&subject, &truth, &noisy, true);
        assert_eq!(scored.class, Class::Wrong);
        let found = causes::choose([explanation(&scored)].into_iter());
        assert!(found.explained() * 100 < found.wrong, "{name} {share}: {found:?}");
    }
}

/// Writes a folder of pictures of scenes as a renderer with shortcuts draws them.
fn pictures(bench: &Bench, folder: &str, shortcuts: &str) {
    for name in ["fog/modes", "fog/corridor"] {
        let picture = draw(&subject(name).unwrap(), Shortcuts::from_names(shortcuts).unwrap_or_default()).unwrap();
        let png = encode_png(picture.width(), picture.height(), picture.pixels(), Compression::Fast).unwrap();
        let path = bench.path(folder).join(format!("{}.png", name.trim_start_matches("fog/")));
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, png).unwrap();
    }
}

#[test]
fn reports_of_folders() {
    let bench = Bench::new();
    pictures(&bench, "old", "float-fog+vertex-fog");
    pictures(&bench, "new", "float-fog");
    let scenes = at("vectors/scenes/fog");
    let command = |rest: &str| format!("score --scenes {} {rest}", scenes.display());
    let text = bench.run(&command("--results old --results new -o report")).text();
    assert!(text.contains("FOG-2") && text.contains("float-fog") && text.contains("(100.0 %)"), "{text}");
    let page = fs::read_to_string(bench.path("report/index.html")).unwrap();
    for part in ["History", "Cause by cause", "For a bug report", "ninebit rule FOG-2", "-causes.png"] {
        assert!(page.contains(part), "{part}");
    }
    let document: serde_json::Value =
        serde_json::from_slice(&fs::read(bench.path("report/score.json")).unwrap()).unwrap();
    assert_eq!(document["format"], "ninebit-score-1");
    assert_eq!(document["runs"][1]["total"]["missing"], 1);
    assert!(fs::read_to_string(bench.path("report/badge.svg")).unwrap().starts_with("<svg"));
    // An earlier report is replaced, another folder is not.
    bench.run(&command("--results new -o report --no-causes")).text();
    bench.run(&command("--results new -o new")).failed(2, "is no report");
    bench.run(&command("--results new --no-causes --at-least 0")).text();
    assert_eq!(bench.run(&command("--results new --no-causes --at-least 100")).status, 1);
    let text = bench.run(&command("--results old --results new --no-causes --without CORR")).text();
    assert!(text.contains("  1 frames: 0 exact"), "{text}");
    bench.run(&command("--results none")).failed(3, "NB0526");
    fs::create_dir(bench.path("empty")).unwrap();
    bench.run(&command("--results empty")).failed(3, "`empty` has no picture of a frame that is scored");
    bench.run("score --results new").failed(2, "--captures");
}

/// Pictures that are damaged, of another size, or of no frame are counted, and stop nothing.
#[test]
fn hostile_pictures() {
    let bench = Bench::new();
    pictures(&bench, "results", "");
    bench.write("results/modes.png", b"\x89PNG\r\n\x1a\n and no more");
    let small = encode_png(2, 2, &[[0, 0, 0, 255]; 4], Compression::Fast).unwrap();
    bench.write("results/corridor.png", small);
    bench.write("results/stranger.png", b"");
    let scenes = at("vectors/scenes/fog");
    let run = bench.run(&format!("score --scenes {} --results results --format json", scenes.display()));
    let document: serde_json::Value = serde_json::from_slice(&run.data()).unwrap();
    let run = &document["runs"][0];
    assert_eq!((&run["total"]["unreadable"], &run["foreign"][0]), (&2.into(), &"/stranger".into()));
}

/// The catalogue of shortcuts is that of the code.
#[test]
fn the_catalogue_is_written() {
    let mut table = String::from("| shortcut | rules | a renderer that |\n|---|---|---|\n");
    for shortcut in Shortcut::ALL {
        let link = |id: &&str| format!("[{id}](../rules/{})", ninebit_handbook::find(id).unwrap().link());
        let rules: Vec<String> = shortcut.reading().rules.iter().map(link).collect();
        table += &format!("| `{}` | {} | {} |\n", shortcut.name(), rules.join(", "), shortcut.reading().does);
    }
    pages::hold("docs/evidence/shortcuts.md", "tests/score.rs (shortcuts)", &table);
}

/// The word of a pixel does not depend on how many of its fragments a trace passes on.
#[test]
fn fragments_that_a_trace_leaves_out_are_drawn_with_shortcuts() {
    let shortcuts: Shortcuts = [Shortcut::FloatBlend, Shortcut::FloatShader].into_iter().collect();
    let mut left_out = 0;
    for name in ["buffers/mirror", "bench/w12", "bench/w4"] {
        let path = at("vectors/scenes").join(format!("{name}.ron"));
        let scene = ninebit_scene::load(&path, &Limits::default()).unwrap().scene;
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        let (width, height) = (plan.targets()[0].width, plan.targets()[0].height);
        for (x, y) in (0..64).map(|n| (n % 8, n / 8)).map(|(i, j)| (i * width / 8, j * height / 8)) {
            let trace = |fragments| shortcut::trace(&plan, shortcuts, 0, (x, y), fragments).unwrap();
            let (last, all) = (trace(1), trace(u64::MAX));
            assert_eq!((last.word, last.shown), (all.word, all.shown), "{name}, pixel {x},{y}");
            left_out += last.left_out;
        }
    }
    assert!(left_out > 64, "{left_out}");
}
