//! Scenes become methods, and the methods become scenes with the same pictures. Of the committed scenes every eighth goes;
//! with `NINEBIT_ROUND_TRIP=1` every one. Scenes of nv10 go as such, by Celsius, and as scenes of nv2a.
#![allow(missing_docs, clippy::unwrap_used, reason = "tests fail by panicking")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::{PointRasterization, PolygonMode, Profile, Scene};
use ninebit_methods::export::{Methods, export, push_buffer, trace};
use ninebit_methods::import::{Options, import};
use ninebit_methods::memory::Memory;
use ninebit_methods::state::State;
use ninebit_test_support::frames::difference;
use rayon::prelude::*;

/// Returns the scene that a log of methods states.
fn back(methods: &Methods, text: &str) -> Result<Scene, String> {
    let memory = Memory::new(methods.memory.clone());
    let options = Options { surfaces_in_memory: true, ..Options::default() };
    let (mut frames, summary) = import(text.as_bytes(), State::default(), &memory, options);
    if frames.len() != 1 || summary.fault_count + summary.unknown_lines.0 > 0 {
        return Err(format!("{} frames, {summary:?}", frames.len()));
    }
    let frame = frames.remove(0);
    if let Some(drawn) = frame.drawn.iter().find(|drawn| !drawn.gaps.is_empty()) {
        return Err(format!(
            "{}: {}",
            drawn.name,
            drawn.gaps.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
        ));
    }
    Ok(frame.scene)
}

/// Returns what differs after a scene has gone there and back; `Err` if it cannot go.
fn trip(scene: &Scene, plan: &Plan, as_words: bool) -> Result<Option<String>, String> {
    let methods = export(scene, plan).map_err(|error| error.message)?;
    let text = if as_words {
        push_buffer(&methods).iter().map(|word| format!("0x{word:08x}\n")).collect()
    } else {
        trace(&methods)
    };
    let scene = match back(&methods, &text) {
        Ok(scene) => scene,
        Err(message) => return Ok(Some(message)),
    };
    let again = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    let options = RenderOptions::default();
    Ok(difference(&render(&again, &options), &render(plan, &options), "the scene"))
}

fn below(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            below(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "ron") {
            found.push(path);
        }
    }
}

#[test]
fn committed_scenes_come_back() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vectors/scenes");
    let mut paths = Vec::new();
    below(&root, &mut paths);
    paths.sort();
    paths.retain(|path| {
        let name = path.file_name().unwrap().to_string_lossy();
        !name.ends_with(".expect.ron") && !name.ends_with(".family.ron")
    });
    let step = std::env::var("NINEBIT_ROUND_TRIP").ok().map_or(8, |text| text.parse().unwrap());
    let chosen: Vec<(usize, PathBuf)> = paths.into_iter().enumerate().step_by(step).collect();
    let trips = chosen.into_par_iter().flat_map_iter(|(number, path)| {
        let loaded = ninebit_scene::load(&path, &Limits::default()).ok().map(|loaded| loaded.scene);
        let name = path.strip_prefix(&root).unwrap().to_string_lossy().into_owned();
        let own = loaded.clone().filter(|scene| scene.profile == Profile::Nv10);
        // What only the GeForce 256 does differs; the rest is a scene of nv2a, too.
        let as_nv2a = loaded.map(|scene| Scene { profile: Profile::Nv2a, ..scene });
        own.into_iter()
            .chain(as_nv2a)
            .map(move |scene| Trip::new(format!("{:?} {name}", scene.profile), scene, number % 3 == 0))
    });
    let report = Report::of(trips.collect());
    println!("{report}");
    assert!(report.wrong.is_empty(), "{report}");
    assert!(report.same("Nv2a") * step > 150 && report.same("Nv10") * step > 60, "{report}");
}

/// A scene that went there and back.
struct Trip {
    /// The name of the scene, its chip first.
    name: String,
    /// What differs; `Err` if it cannot go.
    result: Result<Option<String>, String>,
}

impl Trip {
    fn new(name: String, scene: Scene, as_words: bool) -> Trip {
        let result = match Plan::compile(&scene, &PlanOptions::default()) {
            Ok(plan) => trip(&scene, &plan, as_words),
            Err(_) => Err("only of nv10".to_owned()),
        };
        Trip { name, result }
    }
}

/// The trips by what came of them.
struct Report {
    same: Vec<String>,
    wrong: Vec<String>,
    refused: BTreeMap<String, usize>,
}

impl Report {
    fn of(trips: Vec<Trip>) -> Report {
        let mut report = Report { same: Vec::new(), wrong: Vec::new(), refused: BTreeMap::new() };
        for Trip { name, result } in trips {
            match result {
                Ok(None) => report.same.push(name),
                Ok(Some(difference)) => report.wrong.push(format!("{name}: {difference}")),
                Err(reason) => *report.refused.entry(reason).or_default() += 1,
            }
        }
        report
    }

    fn same(&self, prefix: &str) -> usize {
        self.same.iter().filter(|name| name.starts_with(prefix)).count()
    }
}

impl std::fmt::Display for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Report { same, wrong, refused } = self;
        writeln!(f, "{} came back, {} differ; refused: {refused:#?}", same.len(), wrong.len())?;
        wrong.iter().try_for_each(|line| writeln!(f, "{line}"))
    }
}

/// The frames that are stated for captures: a sample, or with `NINEBIT_ROUND_TRIP=1` all.
#[test]
fn captured_frames_come_back() {
    let frames = ninebit_captures::frames(&[]).unwrap();
    let all = std::env::var("NINEBIT_ROUND_TRIP").is_ok();
    let frames = if all { frames } else { ninebit_captures::sample(frames, 60) };
    let count = frames.len();
    let trips = frames.into_par_iter().enumerate().map(|(number, frame)| {
        let name = format!("{}/{}", frame.suite, frame.name);
        match frame.scene(&RenderOptions::default()).unwrap() {
            Some(scene) => Trip::new(name, scene, number % 5 == 0),
            None => Trip { name, result: Err("two formats of one surface".into()) },
        }
    });
    let report = Report::of(trips.collect());
    println!("of {count} frames {report}");
    assert!(report.wrong.is_empty(), "{report}");
    assert!(10 * report.same.len() > 8 * count, "{report}");
}

/// Textures of pairs go as bytes of both orders, and the conversion as bits of the draw's state (TEX-19).
#[test]
fn video_comes_back() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vectors/scenes/texture-shader/video.ron");
    let scene = ninebit_scene::load(&path, &Limits::default()).unwrap().scene;
    let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    let back = back(&export(&scene, &plan).unwrap(), &trace(&export(&scene, &plan).unwrap())).unwrap();
    assert_eq!(back.draws.iter().map(|draw| draw.convert_yuv).collect::<Vec<_>>(), [true, true, true, false]);
    for as_words in [false, true] {
        assert_eq!(trip(&scene, &plan, as_words), Ok(None));
    }
}

#[test]
fn smooth_edges_come_back() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vectors/scenes/lines/smooth.ron");
    let mut scene = ninebit_scene::load(&path, &Limits::default()).unwrap().scene;
    assert_eq!(Trip::new("smooth".into(), scene.clone(), true).result, Ok(None));
    // One register has the points sharp and the polygons smooth.
    scene.draws[0].polygon_modes.back = PolygonMode::Point;
    let sharp = Trip::new("points".into(), scene.clone(), true);
    assert!(sharp.result.is_err_and(|message| message.contains("smooth polygons")));
    scene.draws[0].point_rasterization = PointRasterization::Thin;
    assert_eq!(Trip::new("thin points".into(), scene.clone(), true).result, Ok(None));
    // Celsius has neither register nor thin points.
    scene.profile = Profile::Nv10;
    assert!(Trip::new("nv10".into(), scene, true).result.is_err_and(|message| message.contains("thin points")));
}
