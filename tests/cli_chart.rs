//! `ninebit chart`: everything is written from measurements, and again after it was deleted.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::bench::Bench;

/// A square of one colour whose truth is another: off by two steps of red.
const SCENE: &str = "(version: 1, profile: Nv10, targets: [(width: 16, height: 16)], truth: (hemisphere: (sky: (51, 51, 51), ground: (51, 51, 51))), \
    draws: [(vertices: Matrix(matrix: Identity, mesh: Grid(columns: 1, rows: 1), diffuse: (RED, 51, 51)))])";

fn scenes() -> Bench {
    let bench = Bench::new();
    fs::create_dir_all(bench.path("techniques/flat")).unwrap();
    fs::create_dir_all(bench.path("techniques/other")).unwrap();
    bench.write("techniques/flat/README.md", "# Flat surfaces\n");
    bench.write("techniques/flat/tone-4.ron", SCENE.replace("RED", "55"));
    bench.write("techniques/flat/tone-16.ron", SCENE.replace("RED", "67"));
    bench.write("techniques/other/tone.ron", SCENE.replace("RED", "53"));
    bench
}

fn files(folder: &Path) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|below| format!("{name}/{below}")));
        } else {
            found.insert(name);
        }
    }
    found
}

#[test]
fn deleting_the_folder_and_charting_restores_every_file() {
    let bench = scenes();
    let run = || bench.run("chart techniques --quick --out out").data();
    assert!(run().is_empty());
    let first = files(&bench.path("out"));
    for name in ["speed-accuracy.md", "stability.md", "speed-accuracy/techniques.csv", "speed-accuracy/figures.json"] {
        assert!(first.contains(name), "{name}: {first:?}");
    }
    for name in
        ["speed-accuracy", "flat", "other", "evaluators", "cost-pixels", "cost-draws", "cost-triangles", "cost-stages"]
    {
        for format in ["svg", "png"] {
            assert!(first.contains(&format!("speed-accuracy/{name}.{format}")), "{name}: {first:?}");
        }
    }
    let page = fs::read_to_string(bench.path("out/speed-accuracy.md")).unwrap();
    assert!(!page.contains("{{"), "{page}");
    assert!(page.contains("### Flat surfaces\n") && page.contains("| tone 16 | "), "{page}");
    // Two squares of a family have the same truth, that of the other family stands alone.
    assert!(page.contains("\n| tone 4, tone 16 | tone 4 (2.31 steps) | none | none | tone 4 ("), "{page}");
    // The error is that of red alone: 2, 4 and 16 steps, over the root of three.
    for technique in ["| tone | 1.15 | 2 |", "| tone 4 | 2.31 | 4 |", "| tone 16 | 9.24 | 16 |"] {
        assert!(page.contains(technique), "{technique}: {page}");
    }
    for picture in page.split("](speed-accuracy/").skip(1).map(|rest| rest.split(')').next().unwrap()) {
        assert!(first.contains(&format!("speed-accuracy/{picture}")), "{picture}");
    }
    let document: serde_json::Value =
        serde_json::from_slice(&fs::read(bench.path("out/speed-accuracy/figures.json")).unwrap()).unwrap();
    assert_eq!(document["format"], "ninebit-chart-1");
    assert_eq!(document["techniques"][1]["parameter"], 16);
    assert_eq!(document["techniques"][2]["cost"]["per_final_pixel"]["frame_buffer_bytes"], 4.0);
    for evaluator in document["evaluators"].as_array().unwrap() {
        // Only the real numbers differ from the stored bytes.
        let real = evaluator["name"].as_str().unwrap().starts_with("float");
        assert_eq!(evaluator["error"].as_f64().unwrap() > 0.0, real, "{evaluator}");
    }
    fs::remove_dir_all(bench.path("out")).unwrap();
    run();
    assert_eq!(files(&bench.path("out")), first);
}

#[test]
fn a_page_alone_keeps_what_is_not_its_own() {
    let bench = scenes();
    fs::create_dir(bench.path("out")).unwrap();
    bench.write("out/stability.md", "# Mine\n\n<!-- sweeps -->\nold\n<!-- /sweeps -->\n\nafter\n");
    bench.run("chart --only stability --out out").data();
    let page = fs::read_to_string(bench.path("out/stability.md")).unwrap();
    assert!(page.starts_with("# Mine\n\n<!-- sweeps -->\n## Where methods fail\n"), "{page}");
    assert!(page.ends_with("<!-- /sweeps -->\n\nafter\n") && !page.contains("\nold\n"), "{page}");
    assert!(!bench.path("out/speed-accuracy.md").exists());
}

#[test]
fn what_cannot_be_charted_is_refused_and_nothing_is_written() {
    let bench = scenes();
    bench.run("chart nowhere --quick --out out").failed(4, "`nowhere` cannot be read");
    bench.write("techniques/other/broken.ron", "(version: 1");
    bench.run("chart techniques --quick --out out").failed(3, "broken.ron");
    fs::create_dir(bench.path("plain")).unwrap();
    bench.write("plain/a.ron", "(version: 1, profile: Nv10)");
    bench.run("chart plain --quick --out out").failed(3, "NB0396");
    bench.run("chart --only everything").failed(2, "--only");
    assert!(!bench.path("out").exists());
}
