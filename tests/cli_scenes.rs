//! Tests what commands say of scenes: how much work they are, that a picture is see-through, that a name is misspelt.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use ninebit_scene::image::{ImageLimits, load};

use crate::bench::Bench;

/// A triangle of 28 pixels with an alpha of 100.
const SCENE: &str = r#"(version: 1, profile: Nv10, targets: [(width: 8, height: 8)], draws: [(
    name: "glass", vertices: Window([(position: (0, 0), diffuse: (9, 9, 9, 100)), (position: (8, 0), diffuse: (9, 9, 9, 100)),
    (position: (0, 8), diffuse: (9, 9, 9, 100))]))])"#;

#[test]
fn work_is_said_and_limited() {
    let bench = Bench::new();
    bench.write("scene.ron", SCENE);
    assert!(bench.run("check scene.ron").text().contains("shaded pixels   28, less than a second on one core\n"));
    let json: serde_json::Value = serde_json::from_str(&bench.run("check scene.ron --format json").text()).unwrap();
    assert_eq!((&json["shaded"]["pixels"], &json["shaded"]["exact"]), (&28.into(), &true.into()));
    assert!(bench.run("explain scene.ron").text().contains("\nshaded pixels: 28, less than a second on one core\n"));
    for command in [
        "render scene.ron -o new.png",
        "trace scene.ron --pixel 1,1",
        "inspect scene.ron -o new.html",
        "compare scene.ron",
        "explain scene.ron --count",
        "bench scene.ron --frames 1",
    ] {
        bench
            .run(&format!("{command} --work 27"))
            .failed(5, "error[NB0611]: the draws shade 28 pixels; 27 are allowed");
        assert_eq!(bench.run(&format!("{command} --work 28")).status, 0, "{command}");
    }
    let replayed = bench.run("replay scene.ron --work 27");
    assert_eq!(replayed.status, 5);
    assert!(String::from_utf8(replayed.stdout).unwrap().contains("NB0611"));
    fs::copy(bench.path("new.png"), bench.path("old.png")).unwrap();
    bench.run("diff new.png old.png --scene scene.ron --work 27").failed(5, "NB0611");
    assert!(bench.run("limits").text().contains("shaded_pixels         100000000000"));
}

#[test]
fn a_limit_is_refused_before_anything_is_written() {
    let bench = Bench::new();
    bench.write("scene.ron", SCENE);
    bench.run("render scene.ron -o new.png --work 1").failed(5, "`--work`");
    bench.run("inspect scene.ron -o new.html --work 1").failed(5, "most of them in this draw");
    assert!(!bench.path("new.png").exists() && !bench.path("new.html").exists());
}

#[test]
fn pictures_that_are_see_through_are_noted() {
    let bench = Bench::new();
    bench.write("scene.ron", SCENE);
    let run = bench.run("render scene.ron -o noted.png");
    assert_eq!((run.status, run.stdout.as_slice()), (0, &b""[..]));
    let said = "note: 28 pixels of the picture have an alpha below 255: viewers show them see-through\n  \
                help: `--opaque` writes the colours alone; `--alpha` says that alpha is wanted\n";
    assert_eq!(run.stderr, said);
    bench.run("render scene.ron -o alpha.png --alpha").data();
    bench.run("render scene.ron -o opaque.png --opaque").data();
    let picture = |name: &str| load(&bench.path(name), &ImageLimits::default()).unwrap();
    assert_eq!(picture("noted.png"), picture("alpha.png"));
    assert_eq!((picture("alpha.png").pixels()[0], picture("opaque.png").pixels()[0]), ([9, 9, 9, 100], [9, 9, 9, 255]));
    bench.run("render scene.ron -o both.png --alpha --opaque").failed(2, "cannot be used with");
}

#[test]
fn a_scene_in_place_of_a_command_is_told_apart() {
    let bench = Bench::new();
    bench.run("my-scene.ron").failed(2, "did you mean `ninebit render my-scene.ron -o my-scene.png`?");
    bench.write("lit-stone.ron", SCENE);
    bench.run("lit-stoen.ron").failed(2, "did you mean `ninebit render lit-stone.ron -o lit-stone.png`?");
    bench.write("frame.png", "");
    bench.run("frame.png").failed(2, "`frame.png` names a file, not a command");
    bench.run("rendr scene.ron").failed(2, "a similar subcommand exists: 'render'");
}

#[test]
fn misspelt_files_have_similar_ones() {
    let bench = Bench::new();
    bench.write("lit-stone.ron", SCENE);
    bench.run("check lit-stoen.ron").failed(4, "help: did you mean `lit-stone.ron`?");
    bench.run("check other.ron").failed(4, "help: check the spelling and the folder");
    fs::create_dir(bench.path("maps")).unwrap();
    bench.write("maps/rocks.png", "");
    bench.write(
        "textured.ron",
        SCENE.replace("draws:", "textures: { \"t\": (source: File(\"maps/rock.png\")) }, draws:"),
    );
    bench.run("check textured.ron").failed(4, "help: did you mean `maps/rocks.png`?");
    bench.run("diff maps/rockz.png maps/rocks.png").failed(4, "did you mean `maps/rocks.png`?");
}

#[test]
fn smooth_edges_are_not_printed() {
    let bench = Bench::new();
    bench.write("smooth.ron", SCENE.replace("vertices:", "smooth_polygons: true, vertices:"));
    for options in ["--to c99", "--whole --to wgsl"] {
        let help = "error[NB0402]: the smooth edges of draw 0 are not printed";
        bench.run(&format!("lower smooth.ron {options}")).failed(3, help);
    }
    assert_eq!(bench.run("lower smooth.ron --to c99 --fragment").status, 0);
}
