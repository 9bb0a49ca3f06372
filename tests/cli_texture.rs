//! Tests `ninebit texture` from outside.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::bench;
use crate::dds;

use bench::Bench;
use dds::File;
use ninebit_files::output::{Compression, encode_png};
use snapbox::{assert_data_eq, file};

/// Returns a cube map in DXT1 with two levels. The faces have the red levels 0 to 5 of 31.
fn cube() -> Vec<u8> {
    let block = |n: u16| [(n << 11).to_le_bytes(), (n << 11).to_le_bytes(), [0; 2], [0; 2]].concat();
    let faces: Vec<u8> = (0..6).flat_map(|n| [block(n), block(n)].concat()).collect();
    File::coded(b"DXT1", 4, 4, 2, faces).with(dds::CAPS2, dds::CUBE).bytes()
}

const SCENE: &str = r#"(
    version: 1,
    profile: Nv10,
    targets: [(name: "frame", width: 8, height: 4, clear: (color: (1, 2, 3))), (name: "spare")],
    palettes: { "red": ["PALETTE"], "blue": ["EULAP"] },
    textures: {
        "indices": (format: P8, source: Texels(width: 2, height: 1, rows: ["00 ff"]), palette: "red"),
        "frame as texture": (source: Target("frame")),
        "bricks": (format: L8, source: Checker(width: 4, height: 2), levels: All),
    },
    draws: [
        (vertices: Window([]), textures: ["indices", "bricks"]),
        (vertices: Window([]), textures: [(texture: "indices", palette: "blue")]),
        (target: "spare", vertices: Window([]), textures: ["frame as texture"]),
    ],
)"#;

fn scene(bench: &Bench) {
    let entries = |word: &str| [word; 256].join(" ");
    bench.write("scene.ron", SCENE.replace("PALETTE", &entries("ffff0000")).replace("EULAP", &entries("ff0000ff")));
}

/// Returns width, height and pixels of a PNG.
fn picture(png: &[u8]) -> (u32, u32, Vec<[u8; 4]>) {
    let picture = image::load_from_memory(png).unwrap().to_rgba8();
    (picture.width(), picture.height(), picture.pixels().map(|pixel| pixel.0).collect())
}

#[test]
fn files_are_described() {
    let bench = Bench::new();
    let png = encode_png(3, 2, &[[1, 2, 3, 4]; 6], Compression::Small).unwrap();
    let indices = File::plain(dds::P8, 2, 1, 1, vec![0; 1026]).bytes();
    bench.write("cube.dds", cube()).write("picture.png", png).write("indices.dds", indices);
    assert_data_eq!(bench.run("texture --help").text(), file!["cli/help-texture.txt"]);
    let told = ["cube.dds", "picture.png --format r5g6b5", "indices.dds", "indices.dds --format A8"];
    let text: String = told.map(|arguments| bench.run(&format!("texture {arguments}")).text()).concat();
    assert_data_eq!(text, file!["cli/texture.txt"]);
}

#[test]
fn faces_make_a_cross_and_levels_a_column() {
    let bench = Bench::new();
    bench.write("cube.dds", cube());
    bench.run("texture cube.dds --decode -o cube.png --profile Nv10").data();
    let (width, height, pixels) = picture(&std::fs::read(bench.path("cube.png")).unwrap());
    assert_eq!((width, height), (4 * 4 + 4 * 2, 3 * 4));
    let at = |x: usize, y: usize| pixels[y * width as usize + x];
    let red = |n: u8| [n << 3 | n >> 2, 0, 0, 255];
    // Faces +X, -X, +Y, -Y, +Z, -Z of level 0, then +Z of level 1, then an empty corner of the cross.
    let found = [at(8, 4), at(0, 4), at(4, 0), at(4, 8), at(4, 4), at(12, 4), at(16 + 2, 2), at(0, 0)];
    assert_eq!(found, [red(0), red(1), red(2), red(3), red(4), red(5), red(4), [0; 4]]);
    for (face, n) in [("+x", 0), ("-X", 1), ("-z", 5)] {
        let png = bench.run(&format!("texture cube.dds --decode -o - --profile nv10 --level 1 --face {face}")).data();
        assert_eq!(picture(&png), (2, 2, vec![red(n); 4]));
    }
    // Dither makes red depend on the position.
    let dithered = picture(&bench.run("texture cube.dds --decode -o - --level 0 --face -Z").data()).2;
    assert!(dithered.iter().any(|pixel| *pixel != dithered[0]), "{dithered:?}");
}

#[test]
fn textures_of_scenes_are_seen() {
    let bench = Bench::new();
    scene(&bench);
    let decoded = |arguments: &str| {
        let run = bench.run(&format!("texture {arguments} --decode -o -"));
        assert_eq!(run.status, 0, "{}", run.stderr);
        picture(&run.stdout)
    };
    assert_eq!(decoded("scene.ron:indices"), (2, 1, vec![[255, 0, 0, 255]; 2]));
    assert_eq!(decoded("scene.ron:indices --palette blue"), (2, 1, vec![[0, 0, 255, 255]; 2]));
    assert_eq!(decoded("scene.ron:bricks --level 2"), (1, 1, vec![[128, 128, 128, 255]]));
    assert_eq!(decoded("scene.ron:bricks").0, 4 + 2);
    let named = bench.command("texture").arg("scene.ron:frame as texture").output().unwrap();
    let text = String::from_utf8(named.stdout).unwrap();
    assert!(text.contains("contents render target `frame` after the last draw"), "{text}");
}

#[test]
fn what_does_not_go_together_is_refused() {
    let bench = Bench::new();
    scene(&bench);
    bench.write("cube.dds", cube()).write("cut.dds", &cube()[..150]).write("no.png", "no picture");
    for (arguments, status, said) in [
        ("missing.dds", 4, "NB0510"),
        ("cut.dds", 3, "NB0517"),
        ("no.png", 3, "neither a PNG, a TGA nor a DDS file"),
        ("cube.dds --decode", 2, "--output"),
        ("cube.dds -o x.png", 2, "--decode"),
        ("cube.dds --face +Q --decode -o x.png", 2, "not one of +X, -X"),
        ("cube.dds --level 2 --decode -o x.png", 2, "its levels are 0 to 1"),
        ("cube.dds --format DXT3", 2, "holds DXT1, not DXT3"),
        ("cube.dds --format DXT2", 2, "not one of A8R8G8B8"),
        ("cube.dds --profile nv11", 2, "not one of Nv10, Nv2a"),
        ("cube.dds --palette red", 2, "SCENE.ron:NAME"),
        ("cube.dds --decode -o cube.dds", 2, "this command writes PNG"),
        ("scene.ron", 2, "scene.ron:bricks"),
        ("scene.ron:gravel", 2, "no texture `gravel`"),
        ("scene.ron:bricks --profile Nv2a", 2, "leave out `--profile`"),
        ("scene.ron:bricks --face +X --decode -o x.png", 2, "it is no cube map"),
        ("scene.ron:bricks --palette red", 2, "reads no palette"),
        ("scene.ron:indices --palette green", 2, "its palettes: `red`, `blue`"),
        ("missing.ron:bricks", 4, "NB0111"),
    ] {
        bench.run(&format!("texture {arguments}")).failed(status, said);
    }
    assert!(!bench.path("x.png").exists());
}
