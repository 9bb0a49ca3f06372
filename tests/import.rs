//! `ninebit import` and `ninebit export`.
#![allow(missing_docs, clippy::unwrap_used, unreachable_pub, reason = "a test binary")]

use crate::bench::Bench;
use crate::repository::at;

use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
use ninebit::state::Policies;

/// A log of a triangle of immediate vertices on a surface of 16 x 16, with one stage of combiners.
const LOG: &str = "\
nv2a_pgraph_method 0: 0x97 -> 0x0200 NV097_SET_SURFACE_CLIP_HORIZONTAL[0] 0x100000
nv2a_pgraph_method 0: 0x97 -> 0x0204 NV097_SET_SURFACE_CLIP_VERTICAL[0] 0x100000
nv2a_pgraph_method 0: 0x97 -> 0x0208 NV097_SET_SURFACE_FORMAT[0] 0x128
nv2a_pgraph_method 0: 0x97 -> 0x0260 NV097_SET_COMBINER_ALPHA_ICW[0] 0x0
nv2a_pgraph_method 0: 0x97 -> 0x0ac0 NV097_SET_COMBINER_COLOR_ICW[0] 0x4010000
nv2a_pgraph_method 0: 0x97 -> 0x0a60 NV097_SET_COMBINER_FACTOR0[0] 0xff804020
nv2a_pgraph_method 0: 0x97 -> 0x1e40 NV097_SET_COMBINER_COLOR_OCW[0] 0xc00
nv2a_pgraph_method 0: 0x97 -> 0x1e60 NV097_SET_COMBINER_CONTROL[0] 0x101
nv2a_pgraph_method 0: 0x97 -> 0x0288 NV097_SET_COMBINER_SPECULAR_FOG_CW0[0] 0xc
nv2a_pgraph_method 0: 0x97 -> 0x028c NV097_SET_COMBINER_SPECULAR_FOG_CW1[0] 0x1c80
nv2a_pgraph_method 0: 0x97 -> 0x1e94 NV097_SET_TRANSFORM_EXECUTION_MODE[0] 0x6
nv2a_pgraph_method 0: 0x97 -> 0x17fc NV097_SET_BEGIN_END[0] 0x5
nv2a_pgraph_method 0: 0x97 -> 0x17fc NV097_SET_BEGIN_END[0] 0x0
nv2a_pgraph_method 0: 0x97 -> 0x0310 NV097_SET_DITHER_ENABLE[0] 0x1
nv2a_pgraph_flip_stall
";

#[test]
fn a_scene_goes_there_and_back() {
    let bench = Bench::new();
    let scene = at("vectors/scenes/sampling/shadow-map.ron");
    let scene = scene.display();
    for (form, log) in [("methods", "there/methods.log"), ("pushbuffer", "")] {
        let text = bench.run(&format!("export {scene} --to {form} -o there")).text();
        assert!(text.contains("memory.bin") && text.contains("frame"), "{text}");
        let words = std::fs::read(bench.path("there/pushbuffer.bin")).unwrap_or_default();
        let source = if log.is_empty() {
            // The words behind the memory, as a program's push buffer lies in it.
            let mut memory = std::fs::read(bench.path("there/memory.bin")).unwrap();
            let first = memory.len();
            memory.extend(&words);
            bench.write("there/memory.bin", &memory);
            format!("--push-buffer 0x{first:x}..0x{:x}", memory.len())
        } else {
            log.to_owned()
        };
        let command = format!("import {source} --memory there/memory.bin --surfaces-in-memory -o back");
        let text = bench.run(&command).text();
        assert!(text.contains("of 3 that were asked for 3 are complete"), "{text}");
        bench.run("render back/frame-0000.ron -o back.png").text();
        bench.run(&format!("render {scene} -o scene.png")).text();
        assert!(bench.run("diff back.png scene.png").text().contains("equal"));
        for folder in ["there", "back"] {
            std::fs::remove_dir_all(bench.path(folder)).unwrap();
        }
        for picture in ["back.png", "scene.png"] {
            std::fs::remove_file(bench.path(picture)).unwrap();
        }
    }
}

/// One program draws all scenes; what a console answers is told as the answer of a card is.
#[test]
fn a_console_answers() {
    let bench = Bench::new();
    let folder = at("vectors/scenes/deciding");
    let left_out = at("vectors/scenes/fog/corridor-nv10.ron");
    bench.write("broken.ron", "(version: 1)");
    let command = format!("export {} {} --to pgraph-c -o console", folder.display(), left_out.display());
    let text = bench.run(&command).text();
    let last: Vec<&str> = text.lines().rev().take(2).collect();
    assert!(last[1].starts_with("corridor-nv10            left out: draw 0: linear fog that is"), "{text}");
    assert!(text.contains("CMB-8-dot                     509 words"), "{text}");
    let root = last[0].strip_prefix("root ").unwrap();
    for file in
        ["main.c", "archive.c", "program.c", "scene-15.c", "bin/memory-15.bin", "scenes/CMB-8-dot@CMB-8=each.png"]
    {
        assert!(bench.path("console").join(file).exists(), "{file}");
    }
    // A scene that is not read is told, and the others are drawn.
    bench.run("export broken.ron --to pgraph-c -o broken").failed(3, "NB");
    assert!(!bench.path("broken").exists());
    let run = bench.run(&format!("export broken.ron {} --to pgraph-c -o others", folder.display()));
    assert!(run.status == 3 && run.stderr.contains("broken.ron") && bench.path("others/scene-15.c").exists());

    let answer = |name: &str, policies: Policies| {
        let plan = ninebit_scene::load(&folder.join(format!("{name}.ron")), &Limits::default()).unwrap().plan;
        let surface = render(&plan.under(policies), &RenderOptions::default()).surfaces.swap_remove(0);
        let mut bytes = b"ninebit-surface 1 X8R8G8B8O 256 192 pitch 1024\n".to_vec();
        bytes.extend(surface.words.iter().flat_map(|word| word.to_le_bytes()));
        bytes
    };
    std::fs::create_dir(bench.path("answers")).unwrap();
    let mut device = serde_json::json!({
        "format": "ninebit-device-1", "pack": root, "vendor": "NVIDIA", "renderer": "NV2A 02a000a3", "version": "kernel 1.0.5838.1",
        "surface": "memory", "surface_format": "that of each scene", "extensions": "",
    });
    bench.write("answers/device.json", device.to_string());
    bench.write("answers/CMB-7-sum.surface", answer("CMB-7-sum", Policies::DEFAULT));
    let text = bench.run("vectors compare console answers").text();
    assert!(
        text.contains("NV2A 02a000a3, kernel 1.0.5838.1\n") && text.contains("CMB-7-sum               as expected\n"),
        "{text}"
    );
    assert!(text.contains("CMB-8-dot               not asked\n") && !text.contains("corridor-nv10"), "{text}");
    let mut policies = Policies::DEFAULT;
    policies.set("CMB-8=each").unwrap();
    bench.write("answers/CMB-8-dot.surface", answer("CMB-8-dot", policies));
    let run = bench.run("vectors compare console answers --format json");
    let told: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    let of_dot = told["scenes"].as_array().unwrap().iter().find(|told| told["scene"] == "CMB-8-dot").unwrap();
    assert!(run.status == 1 && of_dot["reading"] == "as CMB-8=each", "{told}");
    bench.write("answers/CMB-8-dot.surface", "ninebit-surface 1 X8R8G8B8O 256 192 pitch 1024\n");
    bench.run("vectors compare console answers").failed(3, "NB1030");
    device["pack"] = "0".into();
    bench.write("answers/device.json", device.to_string());
    bench.run("vectors compare console answers").failed(3, "NB1031");
}

#[test]
fn draws_are_explained() {
    let bench = Bench::new();
    bench.write("game.log", LOG);
    let vertices = "0x194c 0xff0000ff\n0x1500 0x0\n0x1504 0x0\n0x1508 0x0\n".repeat(3);
    let whole = LOG.replace("[0] 0x5\n", &format!("[0] 0x5\n{vertices}")).replace("[0] 0x6\n", "[0] 0x4\n");
    bench.write("whole.log", &whole);
    let text = bench.run("import whole.log --explain").text();
    assert!(
        text.contains("SET_COMPOSITE_MATRIX[0] to 0x06bc SET_COMPOSITE_MATRIX[15] were never set in this log"),
        "{text}"
    );
    assert!(text.contains("frames 1, draws 1; of 1 that were asked for 0 are complete"), "{text}");
    // The same log is a program.
    let text = bench.run("registers game.log").text();
    assert!(text.contains("RC_IN_RGB") && text.contains("04010000"), "{text}");
    let text = bench.run("op program --words game.log --in primary=255,255,255,255").text();
    assert!(text.contains("128"), "{text}");
    // What the user knows fills in.
    bench.write("known.txt", "SET_COMPOSITE_MATRIX[0] 1.0\n# and so on\n");
    let text = bench.run("import whole.log --explain --assume known.txt").text();
    assert!(text.contains("0x0684 SET_COMPOSITE_MATRIX[1] to"), "{text}");
}

/// A scene of nv10 becomes a log of its class, with the lines of a PC emulator.
#[test]
fn a_scene_of_nv10_goes_there_and_back() {
    let bench = Bench::new();
    let scene = at("vectors/scenes/dot3/lit-stone.ron");
    let scene = scene.display();
    bench.run(&format!("export {scene} --to methods -o there")).text();
    let log = std::fs::read_to_string(bench.path("there/methods.log")).unwrap();
    assert!(log.lines().all(|line| line.starts_with("execute_command: obj 0x0, class 0x0056, method 0x")), "{log}");
    let text = bench.run("import there/methods.log --memory there/memory.bin --surfaces-in-memory -o back").text();
    assert!(text.contains("frame-0000.ron\n") && !text.contains("incomplete"), "{text}");
    bench.run("render back/frame-0000.ron -o back.png").text();
    bench.run(&format!("render {scene} -o scene.png")).text();
    assert!(bench.run("diff back.png scene.png").text().contains("equal"));
    // Lines that name no class are of the one that the user names.
    let bare = log.replace("obj 0x0, class 0x0056", "chid 0x0, subc 0x0");
    bench.write("bare.log", bare);
    let text = bench.run("import bare.log --class 0x56 --memory there/memory.bin --surfaces-in-memory").text();
    assert!(!text.contains("no memory") && text.contains("frames 1"), "{text}");
    let text = bench.run("registers bare.log --profile nv10").text();
    assert!(text.contains("profile Nv10") && text.contains("RC_IN_RGB[0]"), "{text}");
}

/// Lines without a draw are told by what they set.
#[test]
fn a_log_without_draws_is_explained_by_its_state() {
    let bench = Bench::new();
    let state: Vec<&str> = LOG.lines().filter(|line| !line.contains("BEGIN_END")).collect();
    bench.write("state.log", state.join("\n"));
    let text = bench.run("import state.log --explain").text();
    for part in
        ["no draw: the state that the log leaves", "0x0310 SET_DITHER_ENABLE", "00000001  on", "RC_IN_RGB", "A8R8G8B8"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
}

/// The page of an imported frame has each draw's picture, and what is incomplete beside it.
#[test]
fn the_inspector_marks_incomplete_draws() {
    let bench = Bench::new();
    let vertices = "0x194c 0xff0000ff\n0x1500 0x0\n0x1504 0x0\n0x1508 0x0\n".repeat(3);
    let whole = LOG.replace("[0] 0x5\n", &format!("[0] 0x5\n{vertices}")).replace("[0] 0x6\n", "[0] 0x4\n");
    bench.write("whole.log", &whole);
    bench.run("import whole.log -o frames").text();
    // Its one triangle lies at one point, of which a warning tells.
    assert_eq!(bench.run("inspect frames/frame-0000.ron -o page.html").status, 0);
    let page = std::fs::read_to_string(bench.path("page.html")).unwrap();
    let marks = page.split("\"steps\":").nth(1).unwrap();
    let marks = &marks[..marks.len().min(4000)];
    assert!(marks.contains("SET_COMPOSITE_MATRIX[0] to") && marks.contains("\"picture\":\"iVBOR"), "{marks}");
}

#[test]
fn wrong_inputs_are_refused() {
    let bench = Bench::new();
    bench
        .write("game.log", LOG)
        .write("empty.log", "hello\n")
        .write("ram.bin", [1, 0, 0, 0])
        .write("state.txt", "SET_NOTHING 1\n");
    bench.run("import no.log --explain").failed(4, "NB1602");
    bench.run("import empty.log --explain").failed(3, "NB1605");
    bench
        .write("blank.log", "")
        .run("import blank.log -o out")
        .failed(3, "`blank.log` has no method that is known; it is empty");
    bench.run("import game.log --explain --assume state.txt").failed(3, "NB1601");
    assert!(bench.run("import game.log").text().contains("draws 1; of 1 that were asked for 0 are complete"));
    bench.run("import game.log --frame 7 -o out").failed(2, "no frame 7");
    bench.run("import --memory ram.bin --push-buffer 0x0..0x8 --explain").failed(3, "NB1604");
    bench.run("import --memory ram.bin --push-buffer 0x8..0x4 --explain").failed(2, "two addresses");
    assert!(!bench.path("out").exists());
    bench.run("import game.log --class 0x44").failed(2, "0x97");
    let scene = at("vectors/scenes/fog/corridor-nv10.ron");
    for form in ["methods", "pgraph-c"] {
        bench.run(&format!("export {} --to {form} -o out", scene.display())).failed(3, "NB1610");
    }
    bench.run(&format!("export {0} {0} --to methods -o out", scene.display())).failed(2, "only a program");
    assert!(!bench.path("out").exists());
}

/// The folder of a hardware tracer: the log without an extension that says so, and a surface after its one draw, in which one pixel is not as drawn.
#[test]
fn a_tracers_folder_is_compared_with_the_chips_surfaces() {
    let bench = Bench::new();
    let vertices = "0x194c 0xff0000ff\n0x1500 0x0\n0x1504 0x0\n0x1508 0x0\n".repeat(3);
    let log = LOG.replace("[0] 0x5\n", &format!("[0] 0x5\n{vertices}")).replace("[0] 0x6\n", "[0] 0x4\n");
    let log = log.replace("nv2a_pgraph_flip_stall\n", "");
    let clear = "nv2a_pgraph_method 0: 0x97 -> 0x1d90 0xff204060\nnv2a_pgraph_method 0: 0x97 -> 0x1d94 0xf0\n";
    let pitch = "nv2a_pgraph_method 0: 0x97 -> 0x020c 0x400040\nnv2a_pgraph_method 0: 0x97 -> 0x0210 0x1000\n\
                 nv2a_pgraph_method 0: 0x97 -> 0x1d98 0xf0000\nnv2a_pgraph_method 0: 0x97 -> 0x1d9c 0xf0000\n";
    let (state, draw) = log.split_at(log.find("nv2a_pgraph_method 0: 0x97 -> 0x17fc").unwrap());
    std::fs::create_dir(bench.path("trace")).unwrap();
    bench.write("trace/nv2a_log.txt", format!("pgraph method log from nvtrc\n{state}{pitch}{clear}{draw}"));
    let mut surface: Vec<u8> = [0x60, 0x40, 0x20, 0xff].repeat(256);
    bench.write("trace/0000000001_0_0_Surface_Color.bin", &surface);
    surface[4 * 17] = 0x61;
    bench.write("trace/0000000002_0_1_Surface_Color.bin", &surface);
    let text = bench.run("import trace --each-draw -o draws").text();
    assert!(text.contains("surfaces compared with the chip's: 1, exact 0"), "{text}");
    assert!(text.contains("colours in 1 of 256 pixels, first 1,1: 0xff204061 by the chip, 0xff204060 here"), "{text}");
    let replayed = bench.run("replay draws");
    let text = String::from_utf8(replayed.stdout).unwrap();
    assert!(replayed.status == 1 && text.contains("1 of 256 pixels"), "{text} {}", replayed.stderr);
    let frames = bench.run("import trace").text();
    assert!(frames.contains("frame 0: surface 00001000 differs from the chip's"), "{frames}");
}
