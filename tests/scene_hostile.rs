//! Checks that no text makes the scene reader panic, hang, or use memory without limit.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::repository::at;
use std::fs;
use std::path::Path;

use ninebit::limits::Limits;
use ninebit_scene::{self as scene, SceneError};
use proptest::prelude::*;

/// Returns the error of a text. Rendering the error is part of the test.
fn refuse(text: &str) -> SceneError {
    let error = scene::parse(text, Path::new("hostile.ron"), &Limits::default()).unwrap_err();
    let rendered = error.render(false);
    assert!(rendered.starts_with("error["), "{rendered}");
    assert!(rendered.len() < 200_000, "{} bytes of message", rendered.len());
    error
}

fn survive(text: &str) {
    match scene::parse(text, Path::new("hostile.ron"), &Limits::default()) {
        Ok(loaded) => drop(loaded.render_warnings(false)),
        Err(error) => drop((error.render(false), error.render(true))),
    }
}

#[test]
fn a_million_brackets() {
    for bracket in ["(", "[", "{", "Some(", "(a:", "[(", "/*", "//", "\"", "\\", "'"] {
        refuse(&bracket.repeat(1_000_000));
        refuse(&format!("(version: 1, profile: Nv2a, draws: {}", bracket.repeat(1_000_000)));
    }
}

#[test]
fn nesting_is_limited() {
    for (open, close) in [("(", ")"), ("[", "]"), ("Product(", ")")] {
        let deep = format!("(version: 1, profile: Nv2a, draws: {}{})", open.repeat(100_000), close.repeat(100_000));
        let error = refuse(&deep);
        assert_eq!((error.diagnostics[0].code, error.exit_code()), ("NB0602", 5));
    }
    let matrix = format!("{}Identity{}", "Product(".repeat(50), ")".repeat(50));
    survive(&format!("(version: 1, profile: Nv2a, names: (matrices: {{ \"m\": {matrix} }}))"));
}

#[test]
fn a_chain_of_names_is_limited() {
    let chain: String = (0..50_000).map(|i| format!("\"c{i}\": \"c{}\",\n", i + 1)).collect();
    let error = refuse(&format!("(version: 1, profile: Nv2a, names: (colors: {{ {chain} }}))"));
    assert!(error.diagnostics.iter().any(|finding| finding.code == "NB0602"));
}

#[test]
fn many_findings_are_counted_not_kept() {
    let vertices = "(position: (NaN, 0)),".repeat(100_000);
    let error = refuse(&format!("(version: 1, profile: Nv2a, draws: [(vertices: Window([{vertices}]))])"));
    assert!(error.diagnostics.len() <= 64);
    assert_eq!(error.suppressed + error.diagnostics.len(), 100_001);
}

#[test]
fn a_scene_larger_than_allowed() {
    let error = refuse(&" ".repeat(20 << 20));
    assert_eq!((error.diagnostics[0].code, error.exit_code()), ("NB0601", 5));
}

#[test]
fn too_many_of_anything() {
    let head = "(version: 1, profile: Nv2a, ";
    let square = |count: usize| "(name: \"a\"),".repeat(count);
    assert_eq!(refuse(&format!("{head} targets: [{}])", square(17))).diagnostics[0].code, "NB0608");
    assert_eq!(refuse(&format!("{head} draws: [{}])", "(),".repeat(4097))).diagnostics[0].code, "NB0604");
    let textures: String = (0..4097).map(|i| format!("\"{i}\": (),")).collect();
    assert_eq!(refuse(&format!("{head} textures: {{ {textures} }})")).diagnostics[0].code, "NB0605");
    let list = "(position: (0, 0)),".repeat(3000);
    let draws = "(vertices: Window(\"v\")),".repeat(400);
    let error = refuse(&format!("{head} names: (vertices: {{ \"v\": [{list}] }}), draws: [{draws}])"));
    assert_eq!(error.diagnostics[0].code, "NB0603");
    let solid = "(source: Solid(width: 4096, height: 4096, color: (0, 0, 0))),";
    let textures: String = (0..5).map(|i| format!("\"{i}\": {solid}")).collect();
    assert_eq!(refuse(&format!("{head} textures: {{ {textures} }})")).diagnostics[0].code, "NB0607");
}

#[test]
fn a_large_valid_scene_loads() {
    let vertex = "(position: (10.25, 20.5, 0.5), diffuse: (255, 128, 0, 255), t0: (0.125, 0.75)),\n";
    let count = ((8 << 20) - 200) / vertex.len() / 3 * 3;
    let text = format!("(version: 1, profile: Nv2a, draws: [(vertices: Window([{}]))])", vertex.repeat(count));
    let loaded = scene::parse(&text, Path::new("large.ron"), &Limits::default()).unwrap();
    assert_eq!(loaded.scene.draws[0].vertices.len(), count);
}

fn examples() -> Vec<String> {
    let mut texts: Vec<String> = fs::read_dir(at("tests/bad"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "ron"))
        .filter_map(|path| fs::read_to_string(path).ok())
        .collect();
    let document = fs::read_to_string(at("docs/scene-format.md")).unwrap();
    texts.extend(document.split("```ron\n").skip(1).filter_map(|rest| rest.split("```").next()).map(str::to_owned));
    texts
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_survived(text in "\\PC{0,200}") {
        survive(&text);
    }

    #[test]
    fn any_ron_like_text_is_survived(text in "[(){}\\[\\],:\"a-z0-9.#!/* \n-]{0,300}") {
        survive(&text);
        survive(&format!("(version: 1, profile: Nv10, draws: [(vertices: {text})])"));
    }

    #[test]
    fn any_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.ron");
        fs::write(&path, &bytes).unwrap();
        if let Err(error) = scene::load(&path, &Limits::default()) {
            error.render(true);
        }
    }

    #[test]
    fn damaged_scenes_are_survived(
        which in any::<prop::sample::Index>(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0usize..6, "[(){}\\[\\],:\"a-zA-Z0-9.é\r\n-]{0,6}"), 1..6),
    ) {
        let examples = examples();
        let mut text: Vec<char> = which.get(&examples).chars().collect();
        for (place, cut, insert) in edits {
            let at = place.index(text.len() + 1);
            let end = (at + cut).min(text.len());
            text.splice(at..end, insert.chars());
        }
        survive(&text.into_iter().collect::<String>());
    }

    #[test]
    fn truncated_scenes_are_survived(which in any::<prop::sample::Index>(), place in any::<prop::sample::Index>()) {
        let examples = examples();
        let text: Vec<char> = which.get(&examples).chars().collect();
        survive(&text[..place.index(text.len() + 1)].iter().collect::<String>());
    }
}

/// Findings that are only counted need no suggestion, so the time grows linearly with the text, not quadratically.
#[test]
fn thousands_of_misspelt_names_are_refused() {
    let list = |line: &dyn Fn(usize) -> String| (0..8000).map(line).collect::<String>();
    let tables = [
        (
            format!("colors: {{{}}}", list(&|n| format!("\"colour-number-{n:04}\": (1, 2, 3),"))),
            list(&|n| format!("(position: (0, 0), diffuse: \"color-numbre-{n:04}\"),")),
        ),
        (
            format!("vectors: {{{}}}", list(&|n| format!("\"vector-number-{n:04}\": (1, 2, 3),"))),
            list(&|n| format!("(position: \"vectro-number-{n:04}\"),")),
        ),
    ];
    for (names, vertices) in tables {
        let text = format!("(version: 1, profile: Nv2a, names: ({names}), draws: [(vertices: Window([{vertices}]))])");
        let error = refuse(&text);
        assert!(error.diagnostics.iter().all(|finding| finding.code == "NB0208"), "{error:.2000}");
        assert!(error.suppressed >= 7900, "{}", error.suppressed);
        let help = error.diagnostics.iter().filter_map(|finding| finding.help.as_deref());
        assert!(help.filter(|help| help.contains("did you mean")).count() > 50, "{error:.2000}");
    }
}

#[test]
fn too_many_of_something_says_so_once_and_by_how_much() {
    let triangle = "vertices: Window([(position: (0, 0)), (position: (1, 0)), (position: (0, 1))])";
    let list = |count: usize, line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();
    let textures = list(4097, &|n| format!("\"t{n}\": (source: Solid(width: 1, height: 1, color: (0, 0, 0))),"));
    let uses = list(4096, &|n| format!("({triangle}, textures: [\"t{n}\"]),"));
    let targets = list(20, &|n| format!("(name: \"g{n}\", width: 1, height: 1),"));
    let aimed = list(20, &|n| format!("(target: \"g{n}\", {triangle}),"));
    for (text, code, message) in [
        (
            format!("(version: 1, profile: Nv2a, textures: {{{textures}}}, draws: [{uses}])"),
            "NB0605",
            "4097 textures are 1 more than the limit `textures` of 4096 allows",
        ),
        (
            format!("(version: 1, profile: Nv2a, targets: [{targets}], draws: [{aimed}])"),
            "NB0608",
            "20 render targets are 4 more than the limit `targets` of 16 allows",
        ),
    ] {
        let error = refuse(&text);
        let codes: Vec<&str> = error.diagnostics.iter().map(|finding| finding.code).collect();
        assert_eq!(codes, [code], "{error}");
        assert_eq!(error.diagnostics[0].message, message);
    }
}
