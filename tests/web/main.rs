//! Tests the page of `ninebit inspect`: in node the embedded module draws and finds the same as the program, and the page works in a
//! browser. So does the report of `ninebit replay`.
//!
//! Tests that need node, Chromium (`CHROMIUM` names it), Firefox (`FIREFOX`) or axe-core (`vectors/harness/install`) are *ignored* if these are missing. Forty
//! scenes are drawn; `NINEBIT_WEB_SCENES=0` draws all of them.
#![allow(clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test fails by panicking")]

#[path = "../common/repository.rs"]
mod repository;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use libtest_mimic::{Arguments, Failed, Trial};
use ninebit::engine::{RenderOptions, render, trace};
use ninebit::frame::Surface;
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::shortcut::{self, Shortcuts};
use ninebit::state::{Named, Policies};
use ninebit_files::output::{Compression, encode_png};
use ninebit_files::picture::surface_digest;
use ninebit_scene::assets::RecordingFolder;
use ninebit_scene::{LoadedScene, load_with, parse};
use ninebit_web::Session;
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const WASM: &str = "src/cli/page/module.wasm.gz";
const AXE: &str = "target/harness/node_modules/axe-core/axe.min.js";

fn main() {
    repository::enter();
    let arguments = Arguments::from_args();
    let node = runs("node", "--version");
    let called = |name: &str, program: &str| std::env::var(name).unwrap_or_else(|_| program.to_owned());
    let browser = node && runs(&called("CHROMIUM", "chromium"), "--version");
    let firefox = node && runs(&called("FIREFOX", "firefox"), "--version");
    let trials = vec![
        Trial::test("frames_are_the_programs", frames).with_ignored_flag(!node),
        Trial::test("findings_are_the_programs", findings).with_ignored_flag(!node),
        Trial::test("the_page_works_in_chromium", || page("chromium")).with_ignored_flag(!browser),
        Trial::test("the_page_works_in_firefox", || page("firefox")).with_ignored_flag(!firefox),
        Trial::test("the_report_works_in_a_browser", report).with_ignored_flag(!browser),
        Trial::test("pages_meet_level_aa", accessible).with_ignored_flag(!browser || !Path::new(AXE).exists()),
        Trial::test("requests_that_make_no_sense_are_refused", refused),
        Trial::test("shortcuts_draw_as_the_library_does", shortcuts),
        Trial::test("places_count_as_scripts_do", places),
        Trial::test("every_part_of_a_program_can_be_changed", edits),
        Trial::test("programs_of_every_language_can_be_changed", languages),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}

fn runs(program: &str, argument: &str) -> bool {
    Command::new(program).arg(argument).stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|s| s.success())
}

/// Returns the files below a folder with the given extension, sorted.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, ending));
        } else if path.to_str().unwrap().ends_with(ending) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Returns the module's answers, in node, to scenes and the files that belong to them.
fn node(what: &str, scenes: &[(PathBuf, Vec<String>)]) -> Vec<Value> {
    let mut child = Command::new("node")
        .args(["tests/web/model.mjs", what, WASM])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let lines: String =
        scenes.iter().map(|(path, files)| format!("{}\n", json!({ "path": path, "files": files }))).collect();
    child.stdin.take().unwrap().write_all(lines.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    let answers = String::from_utf8(output.stdout).unwrap();
    answers.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn load(path: &Path) -> Option<(LoadedScene, Vec<String>)> {
    let gathered = RecordingFolder::default();
    let loaded = load_with(path, &Limits::default(), &gathered).ok()?;
    Some((loaded, gathered.bundle().files.into_keys().collect()))
}

fn digests(plan: &Plan) -> Vec<String> {
    render(plan, &RenderOptions::default()).surfaces.iter().map(surface_digest).collect()
}

/// Returns the digests of a scene's targets, and the library's trace of the pixel in the middle of the first target.
fn drawn(path: &Path, files: &[String]) -> (Vec<String>, Value) {
    let loaded = load(path).unwrap().0;
    let [width, height] = [loaded.scene.targets[0].width, loaded.scene.targets[0].height];
    let request = json!({ "do": "trace", "target": 0, "pixel": [width >> 1, height >> 1], "until": null });
    (digests(&loaded.plan), Native::with_scene(path, files).ask(request))
}

/// Returns whether two documents are equal. Large floats that a script prints are not read back as exactly the same.
#[allow(clippy::float_arithmetic, reason = "comparing what was printed and read")]
fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => {
            let [a, b] = [a, b].map(|n| n.as_f64().unwrap());
            (a - b).abs() <= 1e-14 * a.abs()
        }
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len() && a.iter().all(|(name, a)| b.get(name).is_some_and(|b| same(a, b)))
        }
        (a, b) => a == b,
    }
}

fn frames() -> Result<(), Failed> {
    let wanted = std::env::var("NINEBIT_WEB_SCENES").ok().and_then(|n| n.parse().ok()).unwrap_or(40_usize);
    let all: Vec<(PathBuf, Vec<String>)> = files(Path::new("vectors/scenes"), ".ron")
        .into_iter()
        .filter(|path| !path.to_str().unwrap().ends_with(".expect.ron"))
        // Families are not scenes, and scenes that need captured images cannot be drawn here.
        .filter_map(|path| load(&path).map(|(_, files)| (path, files)))
        .collect();
    let step = if wanted == 0 { 1 } else { all.len().div_ceil(wanted) };
    let scenes: Vec<_> = all.into_iter().step_by(step).collect();
    // The module and the library draw at the same time.
    let (answers, drawn) = std::thread::scope(|scope| {
        let answers = scope.spawn(|| node("frames", &scenes));
        let drawn: Vec<_> = scenes.iter().map(|(path, files)| drawn(path, files)).collect();
        (answers.join().unwrap(), drawn)
    });
    assert_eq!(answers.len(), scenes.len());
    for (((path, _), answer), (digests, trace)) in scenes.iter().zip(answers).zip(drawn) {
        assert_eq!(answer["digests"], json!(digests), "{}: {answer}", path.to_str().unwrap());
        let traced = &answer["trace"];
        let differs = format!("{}: the page traces {traced}, the program {trace}", path.to_str().unwrap());
        assert!(same(traced, &trace), "{differs}\nIf that is meant, make the module anew: src/web/build");
    }
    println!("{} scenes", scenes.len());
    Ok(())
}

/// The library that the module contains, called directly.
#[derive(Default)]
struct Native(Session);

impl Native {
    /// Returns a session with files from the folder of `beside`.
    fn with(beside: &Path, files: &[String]) -> Native {
        let mut native = Native::default();
        for name in files {
            let file = std::fs::read(beside.with_file_name(name)).unwrap();
            native.0.answer(json!({ "do": "file", "name": name }).to_string().as_bytes(), file);
        }
        native
    }

    /// Returns a session with the scene open.
    fn from_path(path: &Path) -> Native {
        Native::with_scene(path, &load(path).unwrap().1)
    }

    /// Returns a session with the scene open, which needs `files` from its folder.
    fn with_scene(path: &Path, files: &[String]) -> Native {
        let mut native = Native::with(path, files);
        native.open(&std::fs::read_to_string(path).unwrap());
        native
    }

    fn ask(&mut self, request: Value) -> Value {
        serde_json::from_str(&self.0.answer(request.to_string().as_bytes(), Vec::new())).unwrap()
    }

    fn open(&mut self, text: &str) -> Value {
        self.ask(json!({ "do": "open", "text": text, "name": "a.ron" }))
    }

    /// Edits a program. Returns the new text, and the digest of its picture.
    fn edited(&mut self, path: Value, value: &str) -> (String, String) {
        let edited = self.ask(json!({ "do": "edit", "draw": 0, "path": path, "value": value }));
        let text = edited["text"].as_str().unwrap_or_else(|| panic!("{edited}")).to_owned();
        let opened = self.open(&text);
        assert!(opened["scene"].is_object(), "{opened}\n{text}");
        (text, self.digest(None))
    }

    fn digest(&mut self, until: Option<usize>) -> String {
        let answer = self.ask(json!({ "do": "draw", "target": 0, "until": until }));
        answer["digest"].as_str().unwrap_or_else(|| panic!("{answer}")).to_owned()
    }

    /// Returns the page's text for a comparison.
    fn differing(&mut self, against: Value, until: Option<usize>) -> String {
        let heat = self.ask(json!({ "do": "heat", "target": 0, "against": against, "until": until }));
        let left = heat["diverged"]
            .as_u64()
            .filter(|n| *n > 0)
            .map(|n| format!("; {n} more are left out: a test or a choice differs"));
        let named = heat["regions"].as_array().unwrap().len() as u64;
        let regions = heat["region_count"].as_u64().filter(|all| *all > named);
        let regions = regions.map(|all| format!("; the {named} largest of {all} regions"));
        format!("{} pixels differ{}{}", heat["differing"], regions.unwrap_or_default(), left.unwrap_or_default())
    }
}

/// Returns the library's answer to a scene whose folder has exactly these files.
fn native(path: &Path, files: &[String]) -> Value {
    let text = String::from_utf8_lossy(&std::fs::read(path).unwrap()).into_owned();
    let name = path.file_name().unwrap().to_str().unwrap();
    Native::with(path, files).ask(json!({ "do": "open", "text": text, "name": name }))
}

fn rendered(answer: &Value) -> Value {
    let each = || answer["findings"].as_array().unwrap().iter().map(|f| f["rendered"].as_str().unwrap());
    answer.get("rendered").cloned().unwrap_or_else(|| json!(each().collect::<Vec<_>>().join("\n")))
}

fn bad_scenes() -> Vec<(PathBuf, Vec<String>)> {
    let folder = Path::new("tests/bad");
    let beside: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap())
        .filter(|entry| entry.file_type().unwrap().is_file())
        .map(|entry| entry.file_name().into_string().unwrap())
        .filter(|name| !name.ends_with(".ron") && !name.ends_with(".txt"))
        .collect();
    files(folder, ".ron")
        .into_iter()
        .filter(|path| path.parent() == Some(folder))
        .map(|path| (path, beside.clone()))
        .collect()
}

fn findings() -> Result<(), Failed> {
    // A page contains only texts. Other files are refused when the page is written.
    let text = |path: &Path| std::fs::read_to_string(path).is_ok();
    let scenes: Vec<_> = bad_scenes().into_iter().filter(|(path, _)| text(path)).collect();
    assert!(scenes.len() > 100);
    let answers = node("findings", &scenes);
    for ((path, files), answer) in scenes.iter().zip(answers) {
        let expected = rendered(&native(path, files));
        assert_eq!(answer["rendered"], expected, "{}: {answer}", path.to_str().unwrap());
        assert!(expected.as_str().unwrap().contains("NB"), "{} is not bad", path.to_str().unwrap());
    }
    println!("{} scenes", scenes.len());
    Ok(())
}

/// A scene, a shortcut, the digest of the picture with it, and how many pixels it changes.
const VARIANT: (&str, &str) = ("vectors/scenes/fog/modes.ron", "float-fog");

/// Returns the digest of a scene under shortcuts, and the stored word of a pixel.
fn varied(path: &Path, shortcuts: &str, pixel: (u32, u32)) -> (String, u32) {
    let (plan, shortcuts) = (load(path).unwrap().0.plan, Shortcuts::from_names(shortcuts).unwrap());
    let frames = shortcut::drawn(&plan, shortcuts, &RenderOptions::default(), None);
    let traced = shortcut::trace(&plan, shortcuts, 0, pixel, 8).unwrap();
    (surface_digest(&frames.surfaces[0]), traced.word)
}

fn shortcuts() -> Result<(), Failed> {
    let (path, names) = (Path::new(VARIANT.0), VARIANT.1);
    let mut native = Native::from_path(path);
    let rules = native.digest(None);
    native.ask(json!({ "do": "policies", "values": {}, "shortcuts": names }));
    let heat = native.ask(json!({ "do": "heat", "target": 0, "until": null, "against": "rules" }));
    let first = &heat["regions"][0]["first"];
    let pixel = [0, 1].map(|n| u32::try_from(first[n].as_u64().unwrap()).unwrap());
    let traced = native.ask(json!({ "do": "trace", "target": 0, "pixel": pixel, "until": null }));
    let (digest, word) = varied(path, names, pixel.into());
    assert_eq!((native.digest(None), &traced["trace"]["word"]), (digest.clone(), &json!(word)));
    assert_ne!(digest, rules);
    native.ask(json!({ "do": "policies", "values": {} }));
    assert_eq!(native.digest(None), rules);
    Ok(())
}

fn refused() -> Result<(), Failed> {
    let mut native = Native::default();
    let mut ask =
        |request: &str| -> Value { serde_json::from_str(&native.0.answer(request.as_bytes(), Vec::new())).unwrap() };
    for request in
        ["", "[", "{}", r#"{"do":"fly"}"#, r#"{"do":"draw","target":0}"#, r#"{"do":"trace","target":0,"pixel":[0,0]}"#]
    {
        assert!(ask(request)["error"].is_string(), "{request}");
    }
    let text = std::fs::read_to_string("vectors/scenes/deciding/CMB-7-sum.ron").unwrap();
    assert!(ask(&json!({ "do": "open", "text": text, "name": "a.ron" }).to_string())["scene"].is_object());
    for request in [
        r#"{"do":"draw","target":9}"#,
        r#"{"do":"trace","target":0,"pixel":[99999,0]}"#,
        r#"{"do":"trace","target":0,"pixel":[-1,"a"]}"#,
        r#"{"do":"heat","target":0,"against":"picture"}"#,
        r#"{"do":"depth","target":0}"#,
        r#"{"do":"heat","target":0,"against":{"CMB-3":"neither"}}"#,
        r#"{"do":"policies","values":{"NUM":"x"}}"#,
        r#"{"do":"policies","values":{},"shortcuts":"mist"}"#,
        r#"{"do":"program","draw":99}"#,
        r#"{"do":"edit","draw":0,"path":["stages",99,"rgb","scale"],"value":"Two"}"#,
        r#"{"do":"edit","draw":0,"path":["stages",0,"rgb","scale"],"value":"Nine"}"#,
        r#"{"do":"edit","draw":0,"path":["stages",0,"rgb","inputs",9,"mapping"],"value":"Zero"}"#,
        r#"{"do":"edit","draw":0,"path":["constants",0],"value":[1,2,300,4]}"#,
        r#"{"do":"paste","draw":0,"language":"Fortran","program":""}"#,
        r#"{"do":"lower","draw":0,"language":"verilog"}"#,
        r#"{"do":"lower","draw":99,"language":"glsl"}"#,
        r#"{"do":"picture","name":"","width":3,"height":2}"#,
    ] {
        assert!(ask(request)["error"].is_string(), "{request}");
    }
    // The scene that was open stays open.
    assert!(ask(r#"{"do":"draw","target":0,"until":null}"#)["digest"].is_string());
    Ok(())
}

/// Places are counted in UTF-16 units. The text of each value lies where the outline says, behind characters of one to four bytes.
fn places() -> Result<(), Failed> {
    fn check(node: &Value, units: &[u16]) -> usize {
        let at = |n: usize| usize::try_from(node["span"][n].as_u64().unwrap()).unwrap();
        if let Some(text) = node["text"].as_str() {
            assert_eq!(String::from_utf16(&units[at(0)..at(1)]).unwrap(), text);
        }
        1 + node["parts"].as_array().into_iter().flatten().map(|part| check(part, units)).sum::<usize>()
    }
    let text = "// \u{e9} \u{20ac} \u{1f600}\n(version: 1, profile: Nv10, /* \u{1f600} */ targets: [(name: \"\u{e9}\u{1f600}\", width: 2, height: 2)], draws: [])";
    let mut native = Native::default();
    assert!(native.open(text)["scene"].is_object());
    let units: Vec<u16> = text.encode_utf16().collect();
    assert!(check(&native.ask(json!({ "do": "outline" }))["tree"], &units) >= 8);
    // Places of findings are counted in the same way.
    let broken = text.replace("Nv10", "Nv30");
    let finding = &native.open(&broken)["findings"][0];
    let at = |n: usize| usize::try_from(finding["span"][n].as_u64().unwrap()).unwrap();
    let units: Vec<u16> = broken.encode_utf16().collect();
    assert_eq!(String::from_utf16(&units[at(0)..at(1)]).unwrap(), "Nv30");
    Ok(())
}

/// Changes every part of a program to every choice. The new text is either a program with this choice, or is refused with findings.
fn edits() -> Result<(), Failed> {
    let text = std::fs::read_to_string("vectors/scenes/programs/lit-combiners.ron").unwrap();
    let mut native = Native::from_path(Path::new("vectors/scenes/programs/lit-combiners.ron"));
    let mut ask = |request: Value| native.ask(request);
    let open = json!({ "do": "open", "text": text, "name": "a.ron" });
    let program = ask(json!({ "do": "program", "draw": 0 }))["program"].clone();
    let words = |kind: &str| program["choices"][kind].as_array().unwrap().clone();
    let mut changes: Vec<(Value, Value)> =
        vec![(json!(["constants", 1]), json!([9, 8, 7, 6])), (json!(["final", "color_sum_clamp"]), json!(true))];
    for portion in ["rgb", "alpha"] {
        for (field, kind) in
            [("scale", "scale"), ("bias", "bias"), ("ab_output", "destination"), ("sum_output", "destination")]
        {
            changes.extend(words(kind).into_iter().map(|word| (json!(["stages", 0, portion, field]), word)));
        }
        for (field, kind) in [("register", "register"), ("component", "component"), ("mapping", "mapping")] {
            changes
                .extend(words(kind).into_iter().map(|word| (json!(["stages", 0, portion, "inputs", 1, field]), word)));
        }
    }
    for (field, kind) in [("register", "final_register"), ("component", "component")] {
        changes.extend(words(kind).into_iter().map(|word| (json!(["final", "inputs", 2, field]), word)));
    }
    let mut sound = 0;
    for (path, value) in changes {
        ask(open.clone());
        let answer = ask(json!({ "do": "edit", "draw": 0, "path": path, "value": value }));
        let changed = answer["text"].as_str().unwrap_or_else(|| panic!("{path} {value}: {answer}"));
        let opened = ask(json!({ "do": "open", "text": changed, "name": "a.ron" }));
        if opened.get("scene").is_none() {
            assert!(!opened["findings"].as_array().unwrap().is_empty());
            continue;
        }
        sound += 1;
        let mut now = &ask(json!({ "do": "program", "draw": 0 }))["program"].clone();
        let path = path.as_array().unwrap().clone();
        let path = if path[0] == "constants" { vec![json!("final"), path[0].clone(), path[1].clone()] } else { path };
        for part in &path {
            now = part.as_str().map_or_else(|| &now[part.as_u64().unwrap() as usize], |name| &now[name]);
        }
        assert_eq!(now, &value, "{path:?}");
    }
    assert!(sound > 40, "{sound}");
    Ok(())
}

/// Tests that a program in any language can be edited by its boxes. Writing a scale that it already has leaves the picture unchanged.
fn languages() -> Result<(), Failed> {
    let all = files(Path::new("vectors/scenes"), ".ron");
    let (mut rewritten, mut refused) = (0, Vec::new());
    for path in all.iter().filter(|path| !path.to_str().unwrap().ends_with(".expect.ron")) {
        let Some((loaded, _)) = load(path) else { continue };
        let Some(number) = loaded.scene.draws.iter().position(|draw| !draw.program_origin.is_empty()) else { continue };
        let scale = loaded.scene.draws[number].combiners.stages[0].rgb.scale.name();
        let mut native = Native::from_path(path);
        let edit = json!({ "do": "edit", "draw": number, "path": ["stages", 0, "rgb", "scale"], "value": scale });
        let edited = native.ask(edit);
        let Some(text) = edited["text"].as_str() else {
            let error = edited["error"].as_str().unwrap();
            assert!(error.contains("change it in the scene's text"), "{}: {error}", path.to_str().unwrap());
            refused.push(path.to_str().unwrap().to_owned());
            continue;
        };
        assert_eq!(edited["rewritten"], true);
        let before = native.digest(None);
        assert!(native.open(text)["scene"].is_object(), "{}", path.to_str().unwrap());
        assert_eq!(native.digest(None), before, "{}", path.to_str().unwrap());
        rewritten += 1;
    }
    println!("{rewritten} programs rewritten; {} refused: {}", refused.len(), refused.join(" "));
    assert!(rewritten > 60 && refused.is_empty());
    Ok(())
}

fn inspect(scene: &Path, page: &Path) {
    inspect_with(&[], scene, page);
}

fn inspect_with(options: &[&str], scene: &Path, page: &Path) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ninebit"));
    let Output { status, stderr, .. } =
        command.arg("inspect").args(options).arg(scene).arg("-o").arg(page).output().unwrap();
    assert!(status.success(), "{}", String::from_utf8_lossy(&stderr));
}

/// Returns a surface with four changed pixels as PNG.
fn four_off(surface: &Surface) -> Vec<u8> {
    let mut pixels = surface.rgba8();
    for at in [0, 1, 640, 5000] {
        pixels[at][1] ^= 16;
    }
    encode_png(surface.width, surface.height, &pixels, Compression::Fast).unwrap()
}

/// A scene of two draws, of which the second lies behind the first in one corner and counts in the stencil buffer.
const STEPS: &str = r#"(version: 1, profile: Nv2a, targets: [(name: "frame", width: 64, height: 64, format: A8R8G8B8, depth: Z24S8)],
draws: [
    (name: "near", vertices: Window([(position: (0, 0, 0.25), diffuse: (255, 0, 0)), (position: (50, 0, 0.5), diffuse: (0, 255, 0)), (position: (0, 50, 0.5), diffuse: (0, 0, 255))]),
        program: Combiners(stages: [(rgb: (a: PrimaryColor, b: UnsignedInvert(Zero), c: ConstantColor0, d: UnsignedInvert(Zero), sum: Spare0))], final_combiner: (d: Spare0)),
        depth_test: (function: LessOrEqual), stencil_test: (function: Always, reference: 7, pass: Replace)),
    (name: "over", vertices: Window([(position: (0, 0, 0.125), diffuse: (9, 99, 200)), (position: (45, 0, 0.125), diffuse: (77, 7, 70)), (position: (0, 45, 0.125), diffuse: (5, 6, 250))]),
        program: Combiners(stages: [(rgb: (a: PrimaryColor, b: UnsignedInvert(Zero), c: ConstantColor0, d: UnsignedInvert(Zero), sum: Spare0))], final_combiner: (d: Spare0)),
        depth_test: (function: LessOrEqual), stencil_test: (function: Always, pass: IncrementSaturate)),
])"#;

/// Runs a script of a browser. Its last argument is perhaps a folder for pictures.
fn browse(script: &str, arguments: &[&Path]) -> Result<(), Failed> {
    let pictures = std::env::var("NINEBIT_WEB_PICTURES").ok().filter(|folder| !["", "0"].contains(&folder.as_str()));
    let run = Command::new("node").arg(script).args(arguments).args(pictures).output().unwrap();
    print!("{}", String::from_utf8_lossy(&run.stdout));
    if run.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&run.stderr).into_owned().into()) }
}

/// Has axe-core look at a page of each kind.
fn accessible() -> Result<(), Failed> {
    let folder = tempfile::tempdir().unwrap();
    let [page, gallery] = ["stone.html", "gallery"].map(|name| folder.path().join(name));
    inspect(Path::new("vectors/scenes/dot3/lit-stone.ron"), &page);
    write_gallery(&gallery);
    let run = Command::new("node").args(["tests/web/axe.mjs", AXE]).args([page, gallery.join("index.html")]).output();
    let run = run.unwrap();
    print!("{}", String::from_utf8_lossy(&run.stdout));
    if run.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&run.stderr).into_owned().into()) }
}

fn write_gallery(folder: &Path) {
    let status = Command::new(env!("CARGO_BIN_EXE_ninebit"))
        .args(["gallery", "vectors/scenes/fog", "vectors/scenes/dot3/lit-stone.ron", "-o"])
        .arg(folder)
        .status();
    assert!(status.unwrap().success());
}

/// Replays three scenes: of one another value of a policy is expected, of one only a digest is known, one is broken.
fn report() -> Result<(), Failed> {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir(at("scenes")).unwrap();
    let copied = files(Path::new("vectors/scenes/dot3"), ".png").into_iter();
    for path in
        copied.chain(["constant-light.ron", "hemisphere.ron"].map(|name| Path::new("vectors/scenes/dot3").join(name)))
    {
        std::fs::copy(&path, at("scenes").join(path.file_name().unwrap())).unwrap();
    }
    let ninebit = |arguments: &str| {
        let arguments = arguments.split(' ');
        let run = Command::new(env!("CARGO_BIN_EXE_ninebit"))
            .args(arguments)
            .current_dir(folder.path())
            .env_remove("CI")
            .output();
        run.unwrap().status.code()
    };
    assert_eq!(ninebit("replay --bless scenes"), Some(0));
    let plan = load(&at("scenes/constant-light.ron")).unwrap().0.plan;
    let mut policies = Policies::default();
    policies.set("CMB-8=each").unwrap();
    for (name, digest) in
        [("constant-light", digests(&plan.under(policies))[0].clone()), ("hemisphere", "0".repeat(64))]
    {
        let expectation = at(&format!("scenes/{name}.expect.ron"));
        let text = std::fs::read_to_string(&expectation).unwrap();
        let (before, rest) = text.split_once("sha256: \"").unwrap();
        std::fs::write(&expectation, format!("{before}sha256: \"{digest}{}", &rest[64..])).unwrap();
    }
    std::fs::write(at("scenes/broken.ron"), "(version: 1, profile: Nv11)").unwrap();
    assert_eq!(ninebit("replay scenes --report html=report.html"), Some(3));
    browse("tests/web/report.mjs", &[folder.path()])
}

fn page(browser: &str) -> Result<(), Failed> {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let path = Path::new("vectors/scenes/dot3/lit-stone.ron");
    inspect(path, &at("stone.html"));
    let (loaded, images) = load(path).unwrap();
    let image: u64 = images.iter().map(|name| std::fs::metadata(path.with_file_name(name)).unwrap().len()).sum();
    let text = std::fs::read_to_string(at("stone.html")).unwrap();
    let first = text.split_once("\"picture\":\"").unwrap().1.find('"').unwrap() as u64;
    println!("page without its images {} bytes", text.len() as u64 - image * 4 / 3 - first);

    // Scenes with markup in their names, and one with a picture of 256 x 256.
    let triangle = |name: &str, side: u32| {
        format!(
            "(version: 1, profile: Nv2a, targets: [(name: \"frame\", width: {side}, height: {side}, format: A8R8G8B8)],\n draws: [(name: \"{name}\", vertices: Window([\n (position: (0, 0), diffuse: (255, 0, 0)), (position: ({}, 0), diffuse: (0, 255, 0)), (position: (0, {}), diffuse: (0, 0, 255))]),\n program: Combiners(stages: [(rgb: (a: PrimaryColor, b: UnsignedInvert(Zero), c: ConstantColor0, d: UnsignedInvert(Zero), sum: Spare0))], final_combiner: (d: Spare0)))])",
            2 * side,
            2 * side
        )
    };
    for (name, text) in
        [("markup", triangle("<img src=x onerror=alert(1)></script>", 32)), ("small", triangle("one", 256))]
    {
        let scene = at(&format!("{name}.ron"));
        std::fs::write(&scene, text).unwrap();
        inspect(&scene, &at(&format!("{name}.html")));
    }

    write_gallery(&at("gallery"));

    // The values that the page has to show, computed by the library.
    let pixel = (200, 300);
    let traced = trace(&loaded.plan, 0, pixel, None).unwrap();
    let mut native = Native::from_path(path);
    let ideal = native.differing(json!("ideal"), None);
    let against_literal = native.differing(json!({ "CMB-3": "literal" }), None);
    let asked = native.ask(json!({ "do": "alternatives", "target": 0, "pixel": [pixel.0, pixel.1], "until": null }));
    let mut open: Vec<&str> = Vec::new();
    let mut readings: Vec<Value> = Vec::new();
    for rule in asked["rules"].as_array().unwrap() {
        let values = rule["values"].as_array().unwrap();
        let chosen = values.iter().find(|value| value["chosen"] == json!(true)).unwrap();
        for value in values.iter().filter(|value| value["word"] != chosen["word"]) {
            let name = rule["rule"].as_str().unwrap();
            let [r, g, b] = [0, 1, 2].map(|n| &value["shown"][n]);
            let shown = if r == g && g == b { r.to_string() } else { format!("R {r} G {g} B {b}") };
            readings.push(json!({ "name": format!("{name}={}", value["value"].as_str().unwrap()), "shown": shown }));
            open.push(name);
        }
    }
    open.dedup();
    let undecided = format!("Of the undecided rules {} would change this pixel.", open.join(", "));
    assert!(!open.is_empty());
    let (text, edited) = native.edited(json!(["stages", 0, "rgb", "inputs", 0, "mapping"]), "UnsignedIdentity");
    let changed = parse(&text, path, &Limits::default()).unwrap();
    assert_eq!(digests(&changed.plan)[0], edited);
    let mut policies = Policies::default();
    policies.set("CMB-3=literal").unwrap();
    let literal = loaded.plan.clone().under(policies);
    let frame = &render(&loaded.plan, &RenderOptions::default()).surfaces[0];
    let png =
        |pixels: &[[u8; 4]]| STANDARD.encode(encode_png(frame.width, frame.height, pixels, Compression::Fast).unwrap());
    let pixels = frame.rgba8();
    let bad: Vec<Value> = bad_scenes()
        .into_iter()
        .filter(|(path, _)| std::fs::metadata(path).unwrap().len() < 20_000)
        .filter_map(|(path, _)| Some((path.clone(), std::fs::read_to_string(path).ok()?)))
        .filter_map(|(path, text)| {
            // A text area has no carriage returns.
            let text = text.replace('\r', "");
            let open = json!({ "do": "open", "text": text, "name": "lit-stone.ron" });
            let answer = Native::with(Path::new("vectors/scenes/dot3/lit-stone.ron"), &images).ask(open);
            let each: Vec<&str> =
                answer["findings"].as_array()?.iter().map(|f| f["rendered"].as_str().unwrap().trim_end()).collect();
            let name = path.to_str()?.to_owned();
            answer.get("scene").is_none().then(|| json!({ "name": name, "text": text, "rendered": each.join("\n\n") }))
        })
        .collect();
    assert!(bad.len() > 100, "{}", bad.len());

    // Two draws on top of each other, with depth and stencil tests.
    std::fs::write(at("steps.ron"), STEPS).unwrap();
    inspect(&at("steps.ron"), &at("steps.html"));
    let mut native = Native::from_path(&at("steps.ron"));
    let steps: Vec<Value> = (0..2)
        .map(|until| {
            let mut after = |what: &str| native.ask(json!({ "do": what, "target": 0, "pixel": [20, 20], "until": until }));
            let (word, deep) = (after("trace")["trace"]["word"].clone(), after("depth"));
            let [low, middle, high, stencil] = native.0.picture()[20 * 64 + 20];
            assert!(deep["low"].as_u64() < deep["high"].as_u64(), "{deep}");
            json!({
                "until": until, "digest": native.digest(Some(until)), "word": word, "stencil": stencil,
                "depth": u32::from_le_bytes([low, middle, high, 0]), "ideal": native.differing(json!("ideal"), Some(until)),
            })
        })
        .collect();
    assert!(
        ["digest", "word", "stencil", "depth"].iter().all(|field| steps[0][*field] != steps[1][*field]),
        "{steps:?}"
    );
    assert_eq!(steps[1]["digest"], digests(&load(&at("steps.ron")).unwrap().0.plan)[0]);

    let lowered = |language: &str| {
        let run = Command::new(env!("CARGO_BIN_EXE_ninebit"))
            .args(["lower", "--fragment", "--to", language])
            .arg(path)
            .output();
        String::from_utf8(run.unwrap().stdout).unwrap()
    };
    // Programs in other languages.
    let rewritten: Vec<Value> = ["dot3-pixel-shader", "dot3-texture-stages"]
        .map(|name| {
            let path = PathBuf::from(format!("vectors/scenes/programs/{name}.ron"));
            let page = format!("{name}.html");
            inspect(&path, &at(&page));
            let (text, digest) = Native::from_path(&path).edited(json!(["stages", 1, "rgb", "scale"]), "Two");
            json!({ "page": page, "part": "Scale of stage 1 rgb", "value": "Two", "text": text, "digest": digest })
        })
        .to_vec();
    inspect(Path::new("vectors/scenes/texture-shader/mirror-ball.ron"), &at("mirror-ball.html"));
    inspect_with(&["--shortcuts", VARIANT.1], Path::new(VARIANT.0), &at("variant.html"));
    let path_of_variant = Path::new(VARIANT.0);
    let by_rules = digests(&load(path_of_variant).unwrap().0.plan)[0].clone();
    let variant = [varied(path_of_variant, VARIANT.1, (0, 0)).0, by_rules];
    // One change after another.
    let mut twice = Native::from_path(Path::new("vectors/scenes/programs/dot3-texture-stages.ron"));
    let (_, once) = twice.edited(json!(["stages", 0, "rgb", "scale"]), "Two");
    assert_ne!(twice.edited(json!(["stages", 1, "rgb", "scale"]), "Two").1, once);
    let words = std::fs::read_to_string("vectors/scenes/programs/lit.words").unwrap();
    let mut native = Native::from_path(Path::new("vectors/scenes/programs/dot3-texture-stages.ron"));
    let pasted = native.ask(json!({ "do": "paste", "draw": 0, "language": "RegisterWords", "program": words }));
    let opened = native.open(pasted["text"].as_str().unwrap());
    assert!(opened["scene"].is_object(), "{opened}");
    let texture = format!("scene/textures/{}", loaded.plan.textures()[0].name);
    let shown = traced.shown.map(|byte| byte.to_string()).join(", ");
    let expected = json!({
        "variant": variant, "digest": digests(&loaded.plan)[0], "pixel": pixel, "word": traced.word, "shown": shown,
        "ideal": ideal, "undecided": undecided, "readings": readings, "against_literal": against_literal, "steps": steps, "rewritten": rewritten, "words": words,
        "lowered": { "glsl": lowered("glsl"), "c99": lowered("c99") },
        "pasted": native.digest(None), "texture": texture, "edited": edited, "text": text, "literal": digests(&literal)[0],
        "same": png(&pixels), "other": STANDARD.encode(four_off(frame)), "differing": "4 pixels differ", "bad": bad,
    });
    std::fs::write(at("expected.json"), expected.to_string()).unwrap();
    browse("tests/web/page.mjs", &[Path::new(browser), folder.path(), &at("expected.json")])
}
