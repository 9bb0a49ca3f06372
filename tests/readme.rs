//! Checks that the picture and the excerpt of a trace in the README are what the program produces.
#![allow(clippy::unwrap_used, missing_docs, reason = "a test")]

use crate::pages;
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

/// Each published crate but the program, whose readme is the README, and the handbook, whose readme is the handbook, says what it is and shows one of
/// the examples that are run.
#[test]
fn readmes_of_crates_show_an_example() {
    let examples = [
        ("files", "src/files/examples/whole.rs"),
        ("lab", "src/lab/examples/accuracy.rs"),
        ("lower", "src/lower/examples/shader.rs"),
        ("model", "src/cli/examples/pixel.rs"),
        ("program", "src/program/examples/translate.rs"),
        ("report", "src/report/examples/trace.rs"),
        ("scene", "src/scene/examples/render.rs"),
        ("captures", "src/captures/examples/frame.rs"),
        ("score", "src/score/examples/score.rs"),
        ("vectors", "src/vectors/examples/unit.rs"),
    ];
    for (name, example) in examples {
        let [manifest, example] = [format!("src/{name}/Cargo.toml"), example.to_owned()]
            .map(|file| std::fs::read_to_string(at(file)).unwrap());
        let description = manifest.split("description = \"").nth(1).unwrap().split("\"\n").next().unwrap();
        // The command of the repository, and tests of the example, are nothing to who reads it there.
        let shown = example.split("\n#[cfg(test)]").next().unwrap();
        let shown: Vec<&str> = shown.lines().filter(|line| !line.starts_with("//! `cargo run")).collect();
        let shown = shown.join("\n").replace("\n//!\n\n", "\n\n");
        let text = format!(
            "{description}.\n\nA part of [ninebit](https://docs.rs/ninebit), which says `ninebit` to the model as this example does:\n\n```rust\n{}\n```\n",
            shown.trim_end()
        );
        pages::hold(&format!("src/{name}/README.md"), "tests/readme.rs", &text);
    }
}

/// What is published has a version, a readme and the texts of its licences; what is not is never named with a version, so that packages leave it out.
#[test]
fn published_crates_are_whole() {
    let root = std::fs::read_to_string(at("Cargo.toml")).unwrap();
    let field = |text: &str, start: &str| {
        text.lines().find_map(|line| Some(line.strip_prefix(start)?.split('"').next().unwrap().to_owned()))
    };
    let version = field(&root, "version = \"").unwrap();
    let members = root.split("members = [").nth(1).unwrap().split(']').next().unwrap();
    let mut published = 0;
    for folder in members.split('"').skip(1).step_by(2) {
        let manifest = std::fs::read_to_string(at(folder).join("Cargo.toml")).unwrap();
        let name = field(&manifest, "name = \"").unwrap();
        let dependency = field(&root, &format!("{name} = {{ path = \"{folder}\", version = \""));
        if manifest.contains("\npublish = false\n") {
            assert_eq!(dependency, None, "{name} is not published");
            continue;
        }
        published += 1;
        assert!(name == "ninebit" || dependency == Some(version.clone()), "{name}: {dependency:?}");
        let readme = field(&manifest, "readme = \"").unwrap_or_else(|| panic!("{name} has no readme"));
        assert!(at(folder).join(readme).is_file(), "{name} has no readme");
        let licences = if name == "ninebit-data" { &["LICENSE"][..] } else { &["LICENSE-MIT", "LICENSE-APACHE"] };
        for licence in licences {
            let text = std::fs::read_to_string(at(folder).join(licence)).unwrap_or_default();
            assert!(text.len() > 400, "{name} has no {licence}");
        }
    }
    assert!(published >= 11, "{published} crates");
}
