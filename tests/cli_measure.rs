//! Tests `ninebit measure`, and the generators of the tables that lighting techniques look up.

use crate::bench::Bench;

const SCENE: &str = "(version: 1, profile: Nv10, targets: [(width: 16, height: 16)], truth: (hemisphere: (sky: (51, 51, 51), ground: (51, 51, 51))), \
    draws: [(vertices: Matrix(matrix: Identity, mesh: Grid(columns: 1, rows: 1), diffuse: (52, 51, 51)))])";

#[test]
fn scenes_are_measured_as_text_and_as_json() {
    let bench = Bench::new();
    bench.write("a.ron", SCENE);
    let text = bench.run("measure a.ron --picture truth.png").text();
    assert!(text.starts_with("a.ron\n16 x 16, measured: 256 pixels\n"), "{text}");
    assert!(text.contains("r                      1.0000   1.0000   1.0000   1.0000"), "{text}");
    assert!(bench.path("truth.png").exists());
    let document: serde_json::Value =
        serde_json::from_str(&bench.run("measure a.ron a.ron --format json").text()).unwrap();
    assert_eq!(document["format"], "ninebit-accuracy-2");
    assert_eq!(document["scenes"][1]["scene"], "a.ron");
    assert_eq!(document["scenes"][0]["channels"]["r"]["max"], 1.0);
    assert_eq!(document["scenes"][0]["cost"]["as_asked"]["per_final_pixel"]["frame_buffer_bytes"], 4.0);
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let bench = Bench::new();
    bench.write("a.ron", SCENE);
    bench.write("none.ron", SCENE.replace("truth: (hemisphere: (sky: (51, 51, 51), ground: (51, 51, 51))),", ""));
    bench.write("hidden.ron", SCENE.replace("Identity", "Translate(9, 0, 0)"));
    bench.run("measure none.ron").failed(3, "NB0396");
    bench.run("measure hidden.ron").failed(3, "NB0395");
    bench.run("measure a.ron a.ron --picture t.png").failed(2, "one picture of several truths");
    bench.run("measure a.ron --picture -").failed(2, "cannot both go to stdout");
    bench.run("measure a.ron --picture a.ron").failed(2, "is the input");
    bench.run("measure").failed(2, "SCENE");
}

#[test]
fn generators_write_files_that_scenes_read() {
    let bench = Bench::new();
    bench.run("generate height-noise -o height.png --size 32").text();
    bench.run("generate normal-map height.png -o normal.png").text();
    bench.run("generate occlusion height.png -o open.png").text();
    bench.run("generate occlusion height.png --normal-map normal.png -o both.png").text();
    bench.run("generate normalisation-cube -o cube.dds --size 8").text();
    bench.run("generate half-vector-cube -o half.dds --size 8 --light 1 -2 0.5 --from-viewer").text();
    bench.run("generate half-component normal.png --axis x --negative -o half.png").text();
    bench.run("generate half-component normal.png --axis w -o x.png").failed(2, "--axis");
    bench.run("generate half-component normal.png --axis x -o normal.png").failed(2, "is the input");
    bench
        .run("generate sky-cube -o sky.dds --size 8 --axis 0 0 -1 --sky 9 8 7 --ground 0 0 0 --integral simplified")
        .text();
    bench.run("generate power-table -o table.png --exponent 16 --width 2 --height 64").text();
    for (file, said) in [
        ("cube.dds", "cube"),
        ("half.dds", "cube"),
        ("sky.dds", "cube"),
        ("table.png", "2 x 64"),
        ("both.png", "32 x 32"),
    ] {
        let text = bench.run(&format!("texture {file}")).text();
        assert!(text.to_lowercase().contains(said), "{file}: {text}");
    }
    bench.run("generate height-noise -o small.png --size 16").text();
    bench.run("generate occlusion height.png --normal-map small.png -o x.png").failed(3, "NB0521");
    bench.run("generate occlusion height.png --normal-map normal.png -o normal.png").failed(2, "is the input");
}
