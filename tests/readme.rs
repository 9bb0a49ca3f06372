//! Checks that the picture and the excerpt of a trace in the README are what the program produces.
#![allow(clippy::unwrap_used, missing_docs, reason = "a test")]

use crate::repository::at;
use ninebit::engine::{self, RenderOptions};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit_report::trace_text;
use ninebit_scene as scene;

fn plan(name: &str) -> Plan {
    let path = at("vectors/scenes/dot3").join(name);
    let loaded = scene::load(&path, &Limits::default()).unwrap_or_else(|e| panic!("{}", e.render(false)));
    Plan::compile(&loaded.scene, &PlanOptions::default()).unwrap()
}

#[test]
fn the_picture_is_the_scene() {
    let frames = engine::render(&plan("lit-stone.ron"), &RenderOptions::default());
    let shown = image::open(at("docs/images/lit-stone.png")).unwrap().to_rgba8();
    let surface = &frames.surfaces[0];
    assert_eq!(shown.dimensions(), (surface.width, surface.height));
    assert_eq!(shown.into_raw(), surface.rgba8().concat(), "render the scene again into docs/images/lit-stone.png");
}

#[test]
fn the_excerpt_is_in_the_trace() {
    let readme = std::fs::read_to_string(at("README.md")).unwrap();
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let excerpt = readme.split("```text\n").nth(1).unwrap().split("```").next().unwrap();
    let plan = plan("lit-stone.ron");
    let trace = trace_text(&plan, &engine::trace(&plan, 0, (200, 300), None).unwrap());
    let lines: Vec<String> = trace.lines().map(words).collect();
    for line in excerpt.lines() {
        assert!(lines.contains(&words(line)), "the trace has no line `{line}`:\n{trace}");
    }
}

#[test]
fn what_is_installed_is_a_package() {
    let readme = std::fs::read_to_string(at("README.md")).unwrap();
    let path = readme.split("cargo install --path ").nth(1).unwrap().split('`').next().unwrap();
    let manifest = std::fs::read_to_string(at(path).join("Cargo.toml")).unwrap();
    assert!(manifest.contains("[[bin]]"), "{path} is no package with a program");
}
