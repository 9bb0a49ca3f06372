//! Tests the program from outside: exit statuses, and what it writes to stdout and to stderr.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::bench;
use crate::repository::at;

use std::fs;
use std::path::Path;

use snapbox::{assert_data_eq, file};

use bench::{Bench, Run};

const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

#[test]
fn help_goes_to_stdout() {
    let bench = Bench::new();
    assert_data_eq!(bench.run("--help").text(), file!["cli/help.txt"]);
    assert_data_eq!(bench.run("check --help").text(), file!["cli/help-check.txt"]);
    assert_data_eq!(bench.run("render --help").text(), file!["cli/help-render.txt"]);
    assert_data_eq!(bench.run("bench --help").text(), file!["cli/help-bench.txt"]);
    assert_data_eq!(bench.run("chart --help").text(), file!["cli/help-chart.txt"]);
    assert_data_eq!(bench.run("diff --help").text(), file!["cli/help-diff.txt"]);
    for operation in ["combiner", "final", "blend", "filter", "address"] {
        let text = bench.run(&format!("op {operation} --help")).text();
        assert!(text.contains("--inputs <FILE.tsv>"), "{text}");
    }
    assert_data_eq!(bench.run("op --help").text(), file!["cli/help-op.txt"]);
    assert_data_eq!(bench.run("op combiner --help").text(), file!["cli/help-op-combiner.txt"]);
    assert_data_eq!(bench.run("trace --help").text(), file!["cli/help-trace.txt"]);
    assert_data_eq!(bench.run("inspect --help").text(), file!["cli/help-inspect.txt"]);
    assert_data_eq!(bench.run("explain --help").text(), file!["cli/help-explain.txt"]);
    assert_data_eq!(bench.run("lower --help").text(), file!["cli/help-lower.txt"]);
    assert_data_eq!(bench.run("registers --help").text(), file!["cli/help-registers.txt"]);
    assert_data_eq!(bench.run("compare --help").text(), file!["cli/help-compare.txt"]);
    assert_data_eq!(bench.run("generate normal-map --help").text(), file!["cli/help-generate-normal-map.txt"]);
    assert_data_eq!(bench.run("measure --help").text(), file!["cli/help-measure.txt"]);
    assert_data_eq!(bench.run("generate --help").text(), file!["cli/help-generate.txt"]);
    assert_data_eq!(bench.run("generate height-rocks --help").text(), file!["cli/help-generate-height-rocks.txt"]);
    assert_data_eq!(
        bench.run("generate hemisphere-normals --help").text(),
        file!["cli/help-generate-hemisphere-normals.txt"]
    );
    assert_eq!(bench.run("--version").text(), concat!("ninebit ", env!("CARGO_PKG_VERSION"), "\n"));
}

#[test]
fn scenes_become_pages() {
    let bench = Bench::new();
    let scene = "(version: 1, profile: Nv10, targets: [(width: 2, height: 2)], draws: [])";
    bench.write("scene.ron", scene);
    bench.write("bad.ron", "(version: 1, profile: Nv30)");
    assert_eq!(bench.run("inspect scene.ron -o page.html --policy CMB-3=literal").text(), "");
    let page = std::fs::read_to_string(bench.path("page.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
    assert!(page.contains(scene) && page.contains(r#""chosen":{"CMB-3":"literal"}"#));
    let folder = bench.path("");
    assert!(!page.contains(folder.to_str().unwrap().trim_end_matches('/')), "the page says where its scene lay");
    assert_eq!(bench.run("inspect scene.ron -o - --policy CMB-3=literal").text(), page);
    // The picture that the page shows first is drawn with the default policies, so the page does not contain one here.
    assert!(page.contains(r#""picture":null"#));
    assert!(bench.run("inspect scene.ron -o -").text().contains(r#""picture":"iVBORw0KGgo"#));
    bench.run("inspect bad.ron -o bad.html").failed(3, "NB0204");
    assert!(!bench.path("bad.html").exists());
    bench.run("inspect scene.ron -o scene.png").failed(2, "writes HTML");
    let overwriting = bench.run("inspect scene.ron -o scene.ron");
    assert!(overwriting.status != 0 && overwriting.stderr.contains("NB07"), "{}", overwriting.stderr);
    assert_eq!(std::fs::read_to_string(bench.path("scene.ron")).unwrap(), scene);
}

#[test]
fn scenes_become_a_gallery() {
    let bench = Bench::new();
    let scene = "(version: 1, profile: Nv10, targets: [(width: 3, height: 2)], draws: [])";
    std::fs::create_dir_all(bench.path("scenes/deep")).unwrap();
    bench.write("scenes/second.ron", scene);
    bench.write("scenes/deep/first.ron", format!("// A <b>title</b>: what it shows.\n{scene}"));
    bench.write("scenes/bad.ron", "(version: 1, profile: Nv30)");
    let run = bench.run("gallery scenes/deep scenes -o site");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("bad.ron") && run.stderr.contains("NB0204"), "{}", run.stderr);
    let read = |path: &str| std::fs::read_to_string(bench.path(path)).unwrap();
    let index = read("site/index.html");
    // The places are shown in the order that they were named in.
    let titles = ["A &lt;b&gt;title&lt;/b&gt;", "What it shows.", "Second"].map(|title| index.find(title).unwrap());
    assert!(titles.is_sorted() && index.contains("2 scenes") && !index.contains("bad"), "{titles:?}");
    let linked = |attribute: &str| {
        let links = index.split(attribute).skip(1).map(|rest| rest.split('"').next().unwrap().to_owned());
        links.collect::<Vec<_>>()
    };
    let links = [linked("href=\""), linked("src=\"")].concat();
    assert_eq!(links.len(), 4);
    links.iter().for_each(|link| assert!(bench.path("site").join(link).is_file(), "{link}"));
    let page = read("site/scenes/scenes-second.html");
    assert!(page.contains("src=\"../inspector.js\"") && page.contains(scene) && page.len() < 100_000);
    // A gallery is replaced as a whole; another folder is not touched.
    bench.run("gallery scenes/deep -o site --title Two").text();
    assert!(!bench.path("site/scenes/scenes-second.html").exists() && read("site/index.html").contains("<h1>Two</h1>"));
    bench.run("gallery scenes -o scenes").failed(2, "exists, and is no gallery");
    bench.run("gallery scenes/bad.ron -o none").failed(2, "no scene to show");
    assert!(!bench.path("none").exists());
}

#[test]
fn a_wrong_command_line_is_status_2() {
    let bench = Bench::new();
    bench.write("height.png", PNG);
    bench.run("").failed(2, "Usage: ninebit");
    bench.run("frobnicate").failed(2, "unrecognized subcommand 'frobnicate'");
    bench.run("render scene.ron").failed(2, "--output");
    bench.run("render scene.ron -o x.png --threads many").failed(2, "not a number from 0 to 1024");
    bench.run("trace scene.ron").failed(2, "--pixel");
    bench.run("trace scene.ron --pixel 3").failed(2, "not of the form X,Y");
    bench.run("render scene.ron -o - --format json").failed(2, "cannot both go to stdout");
    bench.run("generate normal-map height.png -o n.png --scale NaN").failed(2, "not a finite number");
    bench.run("generate height-rocks -o h.png --size 8").failed(2, "16..=2048");
    bench.run("generate hemisphere-normals").failed(2, "--output");
    for size in ["15", "2049", "64.0"] {
        bench.run(&format!("generate hemisphere-normals -o h.png --size {size}")).failed(2, "--size");
    }
    for noise in ["-0.1", "0.51", "1e300"] {
        let command = format!("generate hemisphere-normals -o h.png --noise {noise}");
        bench.run(&command).failed(2, "not a number from 0 to 0.5");
    }
    for noise in ["NaN", "inf", "much"] {
        let command = format!("generate hemisphere-normals -o h.png --noise {noise}");
        bench.run(&command).failed(2, "not a finite number");
    }
    bench.run("generate hemisphere-normals -o h.png --seed 1.5").failed(2, "--seed");
    bench.run("generate normalisation-cube -o c.dds --size 24").failed(2, "not a power of two from 1 to 1024");
    bench.run("generate half-vector-cube -o c.dds").failed(2, "--light");
    bench.run("generate half-vector-cube -o c.dds --light 0 0 0").failed(2, "points nowhere");
    bench.run("generate sky-cube -o c.dds --sky 1 2 3").failed(2, "--ground");
    bench.run("generate sky-cube -o c.dds --sky 1 2 256 --ground 0 0 0").failed(2, "256");
    bench.run("generate sky-cube -o c.dds --sky 1 2 3 --ground 0 0 0 --axis 0 0 0").failed(2, "points nowhere");
    bench.run("generate power-table -o t.png --exponent 0").failed(2, "--exponent");
    bench.run("generate height-noise -o h.png --octaves 9").failed(2, "--octaves");
    assert!(!bench.path("c.dds").exists() && !bench.path("t.png").exists());
    assert!(!bench.path("h.png").exists());
    bench.run("generate normal-map height.png -o ./height.png").failed(2, "is the input");
    assert_eq!(fs::read(bench.path("height.png")).unwrap(), PNG);
}

#[test]
fn programs_are_printed_in_other_forms() {
    let bench = Bench::new();
    let folder = at("vectors/scenes/programs");
    for name in ["lit-combiners.ron", "lit-text-file.ron", "lit.rc", "hemisphere-normal.png"] {
        fs::copy(folder.join(name), bench.path(name)).unwrap();
    }
    assert_data_eq!(bench.run("lower lit-combiners.ron --to combiners").text(), file!["cli/lower-combiners.txt"]);
    assert_data_eq!(
        bench.run("lower lit-text-file.ron --to registers --draw 0").text(),
        file!["cli/lower-registers.txt"]
    );
    assert_data_eq!(bench.run("registers lit-text-file.ron").text(), file!["cli/registers.txt"]);
    let json = bench.run("registers lit-combiners.ron --draw 0 --format json").text();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["format"], "ninebit-registers-1");
    assert_eq!(json["draws"][0]["words"].as_array().unwrap().len(), 12);
    bench.run("lower lit-combiners.ron").failed(2, "--to");
    // A file whose name tells nothing.
    bench.write(
        "calls.txt",
        "glCombinerInputNV(GL_COMBINER0_NV, GL_RGB, GL_VARIABLE_A_NV, GL_TEXTURE0_ARB, GL_EXPAND_NORMAL_NV, GL_RGB);\n",
    );
    bench
        .run("lower calls.txt --to combiners")
        .failed(3, "`--from` reads it as a program: combiners, registers, combiner-calls");
    assert!(bench.run("lower calls.txt --from combiner-calls --to combiners").text().contains("expand(tex0)"));
    bench.run("lower lit-combiners.ron --to combiners --draw 1").failed(2, "the scene has no draw 1");
    bench.write("lit.rc", "{ rgb { spare0 = texx0; } }");
    bench.run("check lit-text-file.ron").failed(3, "lit.rc:1:18");
    fs::remove_file(bench.path("lit.rc")).unwrap();
    bench.run("check lit-text-file.ron").failed(4, "NB0502");
}

/// Prints a program in each language that has files of its own, in each form of output.
#[test]
fn programs_are_printed_as_functions() {
    let bench = Bench::new();
    let folder = at("vectors/scenes/programs");
    for name in ["lit-words-file.ron", "lit.words", "lit.rc", "dot3.txt", "hemisphere-normal.png"] {
        fs::copy(folder.join(name), bench.path(name)).unwrap();
    }
    for form in ["c99", "glsl", "wgsl", "verilog"] {
        let printed = bench.run(&format!("lower lit-words-file.ron --to {form} --textures words")).text();
        let path = at(format!("tests/cli/lower-{form}.txt"));
        assert_data_eq!(printed, snapbox::Data::read_from(&path, None));
    }
    // Register words, the program that they encode, and the scene that contains them are printed as the same function.
    let body = |text: String| text.split_once("_program(").unwrap().1.to_owned();
    let words = body(bench.run("lower lit.words --profile nv10 --to glsl").text());
    assert_eq!(body(bench.run("lower lit.rc --profile nv10 --to glsl").text()), words);
    let fragment = bench.run("lower lit-words-file.ron --to glsl --fragment").text();
    let lines = |text: &str| text.lines().filter(|line| line.starts_with("    int stage")).count();
    assert_eq!(lines(&fragment), lines(&words));
    assert!(bench.run("lower lit.words --profile nv10 --to wgsl --uniform").text().contains("constants.stage[0].r"));
    bench.write("bump.psh", "ps.1.1\ntex t0\ntexm3x3pad t1, t0\ntexm3x3pad t2, t0\ntexm3x3tex t3, t0\nmov r0, t3\n");
    assert!(bench.run("lower bump.psh --to c99").text().contains("pixel->texture[3][0]"));
    bench.run("lower bump.psh --to c99 --profile nv10").failed(3, "NB");
    let stages = bench.run("lower dot3.txt --from texture-stages --profile nv10 --to combiners").text();
    assert!(stages.contains("expand(tex0) . expand(const0)"), "{stages}");
    bench.write("wrong.words", "RC_IN_RGB 1 2 3\n");
    bench.run("lower wrong.words --profile nv10 --to c99").failed(3, "wrong.words:1:15");
    bench.run("lower --generic --to c99 -o vendor").text();
    let [header, source] = ["h", "c"].map(|end| {
        let path = bench.path(&format!("vendor/ninebit_combiners.{end}"));
        fs::read_to_string(path).unwrap()
    });
    let whole = bench.run("lower --generic --to c99").text();
    assert!(whole.starts_with(&header) && whole.ends_with(source.split_once("h\"\n").unwrap().1), "{whole}");
    assert!(bench.run("lower --generic --to glsl --profile nv10").text().contains("uint rc_in_rgb[2];"));
    bench.run("lower --generic --to wgsl").failed(2, "no generic text");
    bench.run("lower --generic --whole --to c99 -o vendor").text();
    let header = fs::read_to_string(bench.path("vendor/ninebit_pixels.h")).unwrap();
    assert!(header.contains("int nb_draw_pixel(") && bench.path("vendor/ninebit_pixels.c").exists(), "{header}");
    let shader = "int nb_draw_pixel(int triangle, int x, int y, inout uint word, inout uint depth)";
    assert!(bench.run("lower --generic --whole --to glsl").text().contains(shader));
    bench.run("lower --generic --whole --to glsl -o vendor").text();
    assert!(fs::read_to_string(bench.path("vendor/ninebit_pixels.frag")).unwrap().contains(shader));
    assert!(bench.path("vendor/ninebit_pixels.vert").exists());
    let shader = bench.run("lower --generic --whole --to wgsl").text();
    assert!(shader.contains("fn nb_draw_pixel(triangle: i32, x: i32, y: i32, word: ptr<function, u32>,"));
    assert!(!shader.contains('@') && !shader.contains('?'), "{shader}");
    bench.run("lower --generic --whole --to wgsl -o vendor").failed(2, "stdout");
    bench.run("lower --generic --whole --to verilog").failed(2, "--to wgsl");
    bench.run("lower --generic --to glsl -o vendor").failed(2, "stdout");
    bench.run("lower --generic lit.words --to c99").failed(2, "cannot be used with");
    bench.run("lower lit-words-file.ron --whole --to glsl -o shaders").text();
    assert!(fs::read_to_string(bench.path("shaders/draw0.vert")).unwrap().starts_with("#version 450\n"));
    assert!(fs::read_to_string(bench.path("shaders/draw0.frag")).unwrap().contains("ninebit_draw0(ninebit_triangles"));
    bench.run("lower lit-words-file.ron --whole --to c99 -o shaders").failed(2, "take `--to glsl`");
    bench.run("lower lit.words --profile nv10 --to glsl -o shaders").failed(2, "--whole --to glsl");
    for (form, function) in
        [("c99", "static inline int ninebit_draw0("), ("glsl", "bool ninebit_draw0("), ("wgsl", "fn ninebit_draw0(")]
    {
        let whole = bench.run(&format!("lower lit-words-file.ron --whole --to {form}")).text();
        assert!(whole.contains(function) && whole.contains("ninebit_covers("), "{whole}");
    }
    bench.run("lower lit-words-file.ron --whole --to verilog").failed(2, "take `--to c99`");
    bench.run("lower lit.words --profile nv10 --whole --to c99").failed(2, "a program alone");
    let shader =
        bench.run(&format!("lower {} --whole --to c99", at("vectors/scenes/texture-shader/mirror-ball.ron").display()));
    assert!(shader.text().contains("ninebit_single_product("));
    bench.run("registers gone.words").failed(4, "NB0502");
    assert!(bench.run("registers lit.words --profile nv10").text().contains("0c040220"));
}

#[test]
fn whole_programs_run_without_a_scene() {
    let bench = Bench::new();
    let folder = at("vectors/scenes/programs");
    fs::copy(folder.join("lit.words"), bench.path("lit.words")).unwrap();
    let one =
        bench.run("op program --words lit.words --profile nv10 --in tex0=166,115,248 --in primary=0xff,190,120").text();
    assert!(one.contains("result: fragment.r 155  fragment.g 120  fragment.b 103  fragment.a 255\n"), "{one}");
    // The page of `inspect` says it in the same words.
    assert!(one.contains("\nOf the undecided rules CMB-3, "), "{one}");
    bench.write("rows.tsv", "tex0.r\ttex0.g\ttex0.b\tprimary.r\n0x80\t128\t255\t0xff\n166\t115\t248\t255\n");
    let rows = bench.run("op program lit.words --profile nv10 --inputs rows.tsv").text();
    assert_eq!(rows.lines().nth(1).unwrap(), "0x80\t128\t255\t0xff\t220\t80\t92\t255");
    bench.run("op program lit.words --profile nv10 --in const0=3").failed(2, "is no input of a program");
    bench.run("op program lit.txt").failed(2, "--from");
}

/// A scene that is read from standard input is handled like one from a file.
#[test]
fn scenes_come_from_standard_input() {
    let bench = Bench::new();
    let folder = at("vectors/scenes/programs");
    for name in ["lit.words", "lit-words-file.ron", "hemisphere-normal.png"] {
        fs::copy(folder.join(name), bench.path(name)).unwrap();
    }
    let mut command = bench.command("render - -o piped.png");
    let given = fs::File::open(bench.path("lit-words-file.ron")).unwrap();
    Run::from_output(command.stdin(given).output().unwrap()).data();
    bench.run("render lit-words-file.ron -o named.png").data();
    assert_eq!(fs::read(bench.path("piped.png")).unwrap(), fs::read(bench.path("named.png")).unwrap());
    bench.run("render - -o none.png").failed(3, "error");
}

#[test]
fn plans_are_explained() {
    let bench = Bench::new();
    bench.write(
        "scene.ron",
        "(version: 1, profile: Nv10, draws: [(vertices: Window([(position: (0, 0)), (position: (9, 0)), (position: (0, 9))]))])",
    );
    let text = bench.run("explain scene.ron --count").text();
    assert!(text.contains("fragment.rgb = ") && text.contains("cost: 36 fragments"), "{text}");
    assert!(text.contains("bytes written        4 each       144             144   counted 144"), "{text}");
    let json = bench.run("explain scene.ron --format json --count").text();
    let value: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(value["draws"][0]["cost"]["total"], value["draws"][0]["counted"]["work"]);
    assert_eq!(value["draws"][0]["counted"]["fragments"], 36);
    assert_eq!(value["draws"][0]["cost_as_asked"]["counts"]["passes"], 1);
    bench.run("explain missing.ron").failed(4, "NB0111");
}

#[test]
fn policies_are_listed() {
    let text = Bench::new().run("policies").text();
    for rule in ninebit::state::POLICIES {
        assert!(text.contains(rule.rule) && text.contains(rule.values[1].1), "{text}");
    }
}

#[test]
fn limits_are_listed() {
    let text = Bench::new().run("limits").text();
    assert!(text.lines().count() > 3 && text.contains("4096"), "{text}");
}

#[test]
fn rocks_become_a_normal_map() {
    let bench = Bench::new();
    bench.run("generate height-rocks --size 32 --seed 7 -o height.png").data();
    bench.run("generate normal-map height.png -o normal.png --scale 4").data();
    assert!(fs::read(bench.path("normal.png")).unwrap().starts_with(PNG));

    let piped = bench.run("generate height-rocks --size 32 --seed 7 -o -").data();
    assert_eq!(piped, fs::read(bench.path("height.png")).unwrap(), "the same bytes, wherever they go");
    let wrapped = bench.run("generate normal-map height.png -o - --scale 4 --wrap").data();
    assert_eq!(wrapped, fs::read(bench.path("normal.png")).unwrap(), "--wrap is the default");
    assert_ne!(wrapped, bench.run("generate normal-map height.png -o - --scale 4 --no-wrap").data());
    assert_ne!(wrapped, bench.run("generate normal-map height.png -o - --scale -4").data());
    assert_ne!(wrapped, bench.run("generate normal-map height.png -o - --scale 4 --channel alpha").data());
}

#[test]
fn hemispheres_are_made_clean_and_noisy() {
    let bench = Bench::new();
    let made = |options: &str| bench.run(&format!("generate hemisphere-normals -o - --size 32 {options}")).data();
    bench.run("generate hemisphere-normals -o normal.png --size 32").data();
    let clean = fs::read(bench.path("normal.png")).unwrap();
    assert!(clean.starts_with(PNG));
    assert_eq!(made(""), clean, "the same bytes, wherever they go");
    assert_eq!(made("--noise 0 --seed 9"), clean, "no noise is the default, and takes no seed");
    assert_ne!(made("--noise 0.1"), clean);
    assert_ne!(made("--zero-outside"), clean);
    assert_eq!(made("--noise 0.1 --seed 1"), made("--noise 0.1"));
    assert_ne!(made("--noise 0.1 --seed 2"), made("--noise 0.1"));
    assert_ne!(made("--noise 0.5"), made("--noise 0.1"));
}

#[test]
fn a_bad_asset_is_status_3_a_missing_one_4_and_a_large_one_5() {
    let bench = Bench::new();
    bench.write("cut.png", PNG).write("not.png", "GIF89a");
    bench.run("generate normal-map cut.png -o n.png").failed(3, "error[NB0517]");
    bench.run("generate normal-map not.png -o n.png").failed(3, "error[NB0513]");
    bench.run("generate normal-map . -o n.png").failed(3, "error[NB0511]");
    bench.run("generate normal-map missing.png -o n.png").failed(4, "error[NB0510]");
    let mut wide = vec![0; 18];
    (wide[2], wide[12], wide[13], wide[14], wide[16]) = (3, 0xff, 0xff, 1, 8);
    bench.write("wide.tga", &wide);
    bench.run("generate normal-map wide.tga -o n.png").failed(5, "65535 x 1");
    assert!(!bench.path("n.png").exists());
}

#[test]
fn an_output_that_cannot_be_written_is_status_7() {
    let bench = Bench::new();
    bench.run("generate height-rocks --size 16 -o none/h.png").failed(7, "create its folder first");
    bench.run("generate height-rocks --size 16 -o .").failed(7, "is a folder");
    bench.run("generate hemisphere-normals --size 16 -o none/h.png").failed(7, "create its folder first");
    if Path::new("/dev/full").exists() {
        bench.run("generate height-rocks --size 16 -o /dev/full").failed(7, "error[NB0702]");
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let run = bench.command("policies").stdout(full).output().unwrap();
        Run::from_output(run).failed(7, "standard output cannot be written");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    Bench::new().unread("policies");
}

#[test]
fn colour_is_a_choice() {
    let bench = Bench::new();
    let stderr = |arguments: &str| bench.run(arguments).stderr;
    let command = "generate normal-map missing.png -o n.png";
    assert!(!stderr(command).contains('\x1b'), "stderr is no terminal here");
    assert!(stderr(&format!("{command} --color always")).contains('\x1b'));
    assert!(stderr("--color=always frobnicate").contains('\x1b'));
    assert!(!stderr("--color=never frobnicate").contains('\x1b'));
    let forced = bench.command(&format!("{command} --color always")).env("NO_COLOR", "1").output().unwrap();
    assert!(Run::from_output(forced).stderr.contains('\x1b'), "the command line outranks the environment");
}

/// A scene with one red triangle on 8 x 4 pixels and a second target.
const SCENE: &str = r#"(
    version: 1,
    profile: Nv2a,
    targets: [(name: "frame", width: 8, height: 4), (name: "spare", width: 2, height: 2)],
    draws: [(name: "triangle", vertices: Window([
        (position: (0, 0), diffuse: (255, 0, 0, 255)),
        (position: (0, 4), diffuse: (255, 0, 0, 255)),
        (position: (8, 4), diffuse: (255, 0, 0, 255)),
    ]))],
)"#;

#[test]
fn scenes_are_checked() {
    let bench = Bench::new();
    bench.write("scene.ron", SCENE);
    let text = bench.run("check scene.ron").text();
    assert_data_eq!(&text, file!["cli/check.txt"]);
    let json: serde_json::Value = serde_json::from_str(&bench.run("check scene.ron --format json").text()).unwrap();
    assert_eq!((&json["cost"]["triangles"], &json["cost"]["target_pixels"]), (&1.into(), &36.into()));

    bench.write("broken.ron", SCENE.replace("triangle", "triangle\", colour: \""));
    bench.run("check broken.ron").failed(3, "broken.ron:");
    bench.run("check missing.ron").failed(4, "missing.ron");
    bench.write("large.ron", SCENE.replace("width: 8", "width: 5000"));
    bench.run("check large.ron").failed(5, "5000");
    bench.run("check scene.ron --policy CMB-3").failed(2, "RULE=VALUE");
    bench.run("check scene.ron --policy CMB-99=x").failed(2, "CMB-99");
    bench.run("check scene.ron --policy CMB-3=curly").failed(2, "centred, literal");
}

#[test]
fn scenes_are_timed() {
    let bench = Bench::new();
    bench.write("scene.ron", SCENE);
    let text = bench.run("bench scene.ron --frames 2 --threads 1 --isa baseline").text();
    assert!(text.starts_with("engine fast, baseline, 1 thread. ") && text.contains("scene.ron"), "{text}");
    let document: serde_json::Value =
        serde_json::from_slice(&bench.run("bench scene.ron scene.ron --frames 3 --engine scalar --format json").data())
            .unwrap();
    assert_eq!((&document["format"], &document["engine"]), (&"ninebit-bench-1".into(), &"scalar".into()));
    let scenes = document["scenes"].as_array().unwrap();
    assert!(
        scenes.len() == 2
            && scenes.iter().all(|scene| scene["frames"] == 3 && scene["shaded_pixels"].as_u64() > Some(0))
    );
    let spread = &scenes[0]["ns_per_shaded_pixel"];
    assert!(["median", "p10", "p90"].iter().all(|part| spread[part].as_f64() > Some(0.0)), "{spread}");
    assert!(scenes.iter().all(|scene| scene["engine"] == "scalar"));
    let document: serde_json::Value =
        serde_json::from_slice(&bench.run("bench scene.ron --frames 1 --policy CMB-7=each --json").data()).unwrap();
    assert_eq!(document["scenes"][0]["engine"], "fast");
    bench.write("scene.expect.ron", "()");
    assert!(!bench.run("bench scene.expect.ron scene.ron --frames 1").text().contains("expect"));
    bench.run("bench scene.expect.ron").failed(2, "nothing to measure");
    bench.run("bench").failed(2, "<SCENE>...");
    bench.run("bench scene.ron --isa z80").failed(2, "x86-64-v3");
    bench.run("bench scene.ron --frames 0").failed(2, "0 is not in 1..=1000000");
    bench.run("bench missing.ron").failed(4, "missing.ron");
}

#[test]
fn scenes_are_rendered() {
    let bench = Bench::new();
    bench.write("scene.ron", SCENE);
    bench.run("render scene.ron -o frame.png").data();
    let limits = ninebit_scene::image::ImageLimits::default();
    let picture = ninebit_scene::image::load(&bench.path("frame.png"), &limits).unwrap();
    assert_eq!((picture.width(), picture.height(), picture.pixels()[3 * 8]), (8, 4, [255, 0, 0, 255]));

    let bytes = fs::read(bench.path("frame.png")).unwrap();
    for arguments in [
        "-o -",
        "-o - --threads 1",
        "-o - --threads 3 --target frame",
        "-o - --policy CMB-7=each",
        "-o - --engine scalar",
    ] {
        assert_eq!(bench.run(&format!("render scene.ron {arguments}")).data(), bytes, "{arguments}");
    }
    assert_ne!(bench.run("render scene.ron --target spare -o -").data(), bytes);
    bench.run("render scene.ron --target attic -o -").failed(2, "its targets: `frame`, `spare`");
    bench.run("render scene.ron -o none/frame.png").failed(7, "create its folder first");
    bench.run("render scene.ron -o scene.ron").failed(2, "is the input");
    bench.run("render missing.ron -o new.png").failed(4, "missing.ron");
    assert!(!bench.path("new.png").exists());
}

#[test]
fn statistics_are_json_on_stdout() {
    let bench = Bench::new();
    bench.write("scene.ron", SCENE);
    let text = bench.run("render scene.ron -o frame.png --format json").text();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["draws"][0]["name"], "triangle");
    assert_eq!(json["shaded_pixels"], json["draws"][0]["shaded_pixels"]);
    assert!(json["shaded_pixels"].as_u64().is_some_and(|count| count > 8 && count < 32), "{text}");
    assert_eq!(json["targets"][0]["sha256"].as_str().map(str::len), Some(64));
    assert!(json["microseconds"]["render"].is_u64());
}

#[test]
fn pixels_are_traced() {
    let bench = Bench::new();
    bench.write("scene.ron", SCENE);
    assert!(bench.run("trace scene.ron --pixel 0,3").text().contains("triangle"));
    let json = bench.run("trace scene.ron --pixel 0,3 --format json").text();
    assert!(serde_json::from_str::<serde_json::Value>(&json).is_ok(), "{json}");
    bench.run("trace scene.ron --pixel 8,0").failed(2, "columns run from 0 to 7");
    bench.run("trace scene.ron --pixel 0,0 --draw 1").failed(2, "0 `triangle`");
}

#[test]
fn warnings_go_to_stderr_and_change_nothing() {
    let bench = Bench::new();
    bench.write(
        "scene.ron",
        SCENE.replace("profile: Nv2a,", "profile: Nv2a, names: (colors: { \"grey\": (9, 9, 9) }),"),
    );
    let run = bench.run("check scene.ron");
    assert_eq!(run.status, 0);
    assert!(run.stderr.contains("warning") && run.stderr.contains("grey"), "{}", run.stderr);
    assert!(!run.stdout.is_empty());
}

#[test]
fn render_writes_depths_and_stored_words() {
    let bench = Bench::new();
    let draw = "(vertices: Window([(position: (0, 0, 0.25)), (position: (8, 0, 0.25)), (position: (0, 8, 0.25))]), depth_test: (function: Less))";
    for (format, depth, bytes, grey) in [
        ("Z24S8", vec![0, 0xff, 0xff, 0x3f], vec![0, 0xff, 0xff, 0xff], [0x3fff, 0xffff]),
        ("Z16", vec![0xff, 0x3f], vec![0xff, 0xff], [0x3fff, 0xffff]),
    ] {
        let target =
            format!("(name: \"a\", width: 8, height: 8, format: R5G6B5, depth: {format}, clear: (color: (255, 0, 0)))");
        bench.write("a.ron", format!("(version: 1, profile: Nv2a, targets: [{target}], draws: [{draw}])"));
        bench.run("render a.ron -o a.png --depth a.raw --raw colors").data();
        let words = std::fs::read(bench.path("a.raw")).unwrap();
        assert_eq!((&words[..bytes.len()], &words[words.len() - bytes.len()..]), (&depth[..], &bytes[..]), "{format}");
        assert_eq!(words.len(), 64 * bytes.len());
        let colors = std::fs::read(bench.path("colors")).unwrap();
        assert_eq!((colors.len(), &colors[126..]), (128, &[0x00, 0xf8][..]));
        bench.run("render a.ron -o a.png --depth depth.PNG").data();
        let image = image::open(bench.path("depth.PNG")).unwrap().into_luma16();
        assert_eq!([image.get_pixel(0, 0).0[0], image.get_pixel(7, 7).0[0]], grey, "{format}");
    }
    bench.run("render a.ron -o a.png --raw a.png").failed(2, "--raw");
    bench.run("render a.ron -o - --raw -").failed(2, "only one output can go to stdout");
    bench.run("render a.ron -o same --raw same").failed(2, "NB0706");
    bench.write("b.ron", "(version: 1, profile: Nv10, targets: [(name: \"a\", width: 8, height: 8)], draws: [])");
    bench.run("render b.ron -o b.png --depth b.raw").failed(2, "the target `a` has no depth buffer");
}
