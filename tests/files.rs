//! Tests that files of every kind are read within a limit, and that the program does not wait for files that are not regular ones.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs::File;

use crate::bench::Bench;

/// A scene of one triangle with a program in a file.
const SCENE: &str = r#"(version: 1, profile: Nv2a, targets: [(name: "frame", width: 8, height: 8)], draws: [(
    vertices: Window([(position: (0, 0)), (position: (8, 0)), (position: (0, 8))]),
    program: CombinerText(file: "program.txt"),
)])"#;

fn sparse(bench: &Bench, name: &str) {
    let path = bench.path(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    File::create(path).unwrap().set_len(64 << 30).unwrap();
}

/// Checks that the command is refused with this code and names the limit. Without a limit it would read 64 GB.
fn beyond(bench: &Bench, command: &str, code: &str, limit: &str) {
    let run = bench.run(command);
    let text = run.stderr.clone() + &String::from_utf8_lossy(&run.stdout);
    assert_eq!(run.status, 5, "{command}: {text}");
    assert!(text.contains(code) && text.contains(&format!("`{limit}`")), "{command}: {text}");
    let listed = bench.run("limits").text();
    assert!(listed.lines().any(|line| line.split(' ').next() == Some(limit)), "{listed}");
}

#[test]
fn every_kind_of_file_has_a_limit() {
    let bench = Bench::new();
    sparse(&bench, "sparse");
    beyond(&bench, "check sparse", "NB0601", "scene_bytes");
    sparse(&bench, "program.txt");
    bench.write("scene.ron", SCENE);
    beyond(&bench, "check scene.ron", "NB0610", "program_bytes");
    beyond(&bench, "diff sparse sparse", "NB0514", "image_file_bytes");
    beyond(&bench, "op combiner --inputs sparse", "NB0534", "operation_table_bytes");
    beyond(&bench, "chart --evaluators sparse", "NB0538", "evaluators_bytes");
    beyond(&bench, "vectors digest sparse", "NB1013", "tree_bytes");
    sparse(&bench, "pack/MANIFEST.json");
    beyond(&bench, "vectors check pack", "NB1013", "manifest_bytes");
    beyond(&bench, "vectors compare --waivers sparse pack pack", "NB1013", "waivers_bytes");
    sparse(&bench, "leaves/leaf-0000.json");
    beyond(&bench, "vectors merge leaves", "NB1013", "leaf_bytes");
    std::fs::create_dir(bench.path("scenes")).unwrap();
    bench.write("scenes/scene.ron", SCENE);
    sparse(&bench, "scenes/scene.expect.ron");
    beyond(&bench, "replay scenes", "NB1207", "expectation_bytes");
}

#[test]
fn files_of_packs_and_results_have_limits() {
    let bench = Bench::new();
    bench.run("vectors export --unit product -o pack").text();
    let results = bench.path("results");
    std::fs::create_dir(&results).unwrap();
    sparse(&bench, "results/device.json");
    beyond(&bench, "vectors compare pack results", "NB1013", "device_bytes");
    let root = {
        let manifest = std::fs::read_to_string(bench.path("pack/MANIFEST.json")).unwrap();
        let value: serde_json::Value = serde_json::from_str(&manifest).unwrap();
        value["root"].as_str().unwrap().to_owned()
    };
    let device = format!(
        r#"{{"format": "ninebit-device-1", "pack": "{root}", "vendor": "", "renderer": "", "version": "", "surface": "", "surface_format": "", "extensions": ""}}"#
    );
    bench.write("results/device.json", device);
    sparse(&bench, "results/product.tsv");
    beyond(&bench, "vectors compare pack results", "NB1013", "vector_table_bytes");
    // Of a file that the manifest lists, not more bytes are read than it lists.
    sparse(&bench, "pack/units/product.tsv");
    bench.run("vectors check pack").failed(3, "NB1011");
}

#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_neither_waited_for_nor_read_for_ever() {
    use std::os::unix::fs::symlink;
    let bench = Bench::new();
    let pipe = bench.path("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for (n, other) in [pipe.as_path(), std::path::Path::new("/dev/zero")].into_iter().enumerate() {
        let place = |name: &str| bench.path(&format!("{n}-{name}"));
        for folder in ["pack", "leaves", "replayed", "scenes"] {
            std::fs::create_dir(place(folder)).unwrap();
        }
        bench.write("scene.ron", SCENE);
        let _ = std::fs::remove_file(bench.path("program.txt"));
        std::fs::hard_link(&pipe, bench.path("program.txt")).unwrap();
        bench.run("check scene.ron").failed(3, "NB0540");
        symlink(other, place("pack/MANIFEST.json")).unwrap();
        bench.run(&format!("vectors check {n}-pack")).failed(3, "NB1002");
        symlink(other, place("leaves/leaf-0000.json")).unwrap();
        bench.run(&format!("vectors merge {n}-leaves")).failed(3, "NB1002");
        bench.write(&format!("{n}-replayed/scene.ron"), SCENE);
        symlink(other, place("replayed/scene.expect.ron")).unwrap();
        let run = bench.run(&format!("replay {n}-replayed"));
        assert_eq!(run.status, 3, "{run:?}");
        symlink(other, place("scenes/scene.ron")).unwrap();
        let run = bench.run(&format!("replay {n}-scenes"));
        assert!(matches!(run.status, 3..=5), "{run:?}");
    }
}
