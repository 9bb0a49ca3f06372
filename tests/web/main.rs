//! The page of `ninebit inspect`: the embedded module draws what the program draws and finds what it finds, in node; the page works in a browser.
//!
//! Without node, Chromium (`CHROMIUM` names it) or Firefox, what needs them is *ignored*. Of the scenes forty are drawn; `NINEBIT_WEB_SCENES=0` draws all.
#![allow(clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test fails by panicking")]

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use libtest_mimic::{Arguments, Failed, Trial};
use ninebit::engine::{RenderOptions, render, trace};
use ninebit::limits::Limits;
use ninebit::plan::Plan;
use ninebit::state::Policies;
use ninebit_files::output::{Compression, encode_png};
use ninebit_files::picture::surface_digest;
use ninebit_scene::assets::Gathered;
use ninebit_scene::{Loaded, load_with, parse};
use ninebit_web::Session;
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const WASM: &str = "src/web/module.wasm.gz";

fn main() {
    let arguments = Arguments::from_args();
    let node = runs("node", "--version");
    let chromium = std::env::var("CHROMIUM").unwrap_or_else(|_| "chromium".to_owned());
    let browser = node && runs(&chromium, "--version");
    let trials = vec![
        Trial::test("frames_are_the_programs", frames).with_ignored_flag(!node),
        Trial::test("findings_are_the_programs", findings).with_ignored_flag(!node),
        Trial::test("the_page_works_in_a_browser", page).with_ignored_flag(!browser),
        Trial::test("the_page_opens_in_firefox", firefox).with_ignored_flag(!node || !runs("firefox", "--version")),
        Trial::test("requests_that_make_no_sense_are_refused", refused),
        Trial::test("places_count_as_scripts_do", places),
        Trial::test("every_part_of_a_program_can_be_changed", edits),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}

fn runs(program: &str, argument: &str) -> bool {
    Command::new(program).arg(argument).stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|s| s.success())
}

/// The files below a folder with that ending, in their order.
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

/// Answers of the module in node to scenes and the files that go with them.
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

fn load(path: &Path) -> Option<(Loaded, Vec<String>)> {
    let gathered = Gathered::default();
    let loaded = load_with(path, &Limits::default(), &gathered).ok()?;
    Some((loaded, gathered.bundle().files.into_keys().collect()))
}

fn digests(plan: &Plan) -> Vec<String> {
    render(plan, &RenderOptions::default()).surfaces.iter().map(surface_digest).collect()
}

fn frames() -> Result<(), Failed> {
    let wanted = std::env::var("NINEBIT_WEB_SCENES").ok().and_then(|n| n.parse().ok()).unwrap_or(40_usize);
    let all: Vec<PathBuf> = files(Path::new("vectors/scenes"), ".ron")
        .into_iter()
        .filter(|path| !path.to_str().unwrap().ends_with(".expect.ron"))
        // Families are no scenes, and scenes that need captured images cannot be drawn here.
        .filter(|path| load(path).is_some())
        .collect();
    let step = if wanted == 0 { 1 } else { all.len().div_ceil(wanted) };
    let scenes: Vec<(PathBuf, Vec<String>)> =
        all.into_iter().step_by(step).map(|path| (path.clone(), load(&path).unwrap().1)).collect();
    let answers = node("frames", &scenes);
    assert_eq!(answers.len(), scenes.len());
    for ((path, _), answer) in scenes.iter().zip(answers) {
        assert_eq!(
            answer["digests"],
            json!(digests(&load(path).unwrap().0.plan)),
            "{}: {answer}",
            path.to_str().unwrap()
        );
    }
    println!("{} scenes", scenes.len());
    Ok(())
}

/// What the library answers to a scene whose folder is that bundle.
fn native(path: &Path, files: &[String]) -> Value {
    let mut session = Session::default();
    let mut ask = |request: Value, file: Vec<u8>| -> Value {
        serde_json::from_str(&session.answer(request.to_string().as_bytes(), file)).unwrap()
    };
    for name in files {
        ask(json!({ "do": "file", "name": name }), std::fs::read(path.with_file_name(name)).unwrap());
    }
    let text = String::from_utf8_lossy(&std::fs::read(path).unwrap()).into_owned();
    ask(json!({ "do": "open", "text": text, "name": path.file_name().unwrap().to_str().unwrap() }), Vec::new())
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
    // A page holds texts: what is none is refused when the page is written.
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

fn refused() -> Result<(), Failed> {
    let mut session = Session::default();
    let mut ask =
        |request: &str| -> Value { serde_json::from_str(&session.answer(request.as_bytes(), Vec::new())).unwrap() };
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
        r#"{"do":"heat","target":0,"against":{"CMB-3":"neither"}}"#,
        r#"{"do":"policies","values":{"NUM":"x"}}"#,
        r#"{"do":"program","draw":99}"#,
        r#"{"do":"edit","draw":0,"path":["stages",99,"rgb","scale"],"value":"Two"}"#,
        r#"{"do":"edit","draw":0,"path":["stages",0,"rgb","scale"],"value":"Nine"}"#,
        r#"{"do":"edit","draw":0,"path":["stages",0,"rgb","inputs",9,"mapping"],"value":"Zero"}"#,
        r#"{"do":"edit","draw":0,"path":["constants",0],"value":[1,2,300,4]}"#,
        r#"{"do":"paste","draw":0,"language":"Fortran","program":""}"#,
    ] {
        assert!(ask(request)["error"].is_string(), "{request}");
    }
    // What was open still is.
    assert!(ask(r#"{"do":"draw","target":0,"until":null}"#)["digest"].is_string());
    Ok(())
}

/// Places are UTF-16 units: each value's text lies where the tree says, behind characters of one to four bytes.
fn places() -> Result<(), Failed> {
    fn check(node: &Value, units: &[u16]) -> usize {
        let at = |n: usize| usize::try_from(node["span"][n].as_u64().unwrap()).unwrap();
        if let Some(text) = node["text"].as_str() {
            assert_eq!(String::from_utf16(&units[at(0)..at(1)]).unwrap(), text);
        }
        1 + node["parts"].as_array().into_iter().flatten().map(|part| check(part, units)).sum::<usize>()
    }
    let text = "// \u{e9} \u{20ac} \u{1f600}\n(version: 1, profile: Nv10, /* \u{1f600} */ targets: [(name: \"\u{e9}\u{1f600}\", width: 2, height: 2)], draws: [])";
    let mut session = Session::default();
    let mut ask = |request: Value| -> Value {
        serde_json::from_str(&session.answer(request.to_string().as_bytes(), Vec::new())).unwrap()
    };
    assert!(ask(json!({ "do": "open", "text": text, "name": "a.ron" }))["scene"].is_object());
    let units: Vec<u16> = text.encode_utf16().collect();
    assert!(check(&ask(json!({ "do": "outline" }))["tree"], &units) >= 8);
    // So are places of findings.
    let broken = text.replace("Nv10", "Nv30");
    let finding = &ask(json!({ "do": "open", "text": broken, "name": "a.ron" }))["findings"][0];
    let at = |n: usize| usize::try_from(finding["span"][n].as_u64().unwrap()).unwrap();
    let units: Vec<u16> = broken.encode_utf16().collect();
    assert_eq!(String::from_utf16(&units[at(0)..at(1)]).unwrap(), "Nv30");
    Ok(())
}

/// Every part that a program names is changed to every choice: the text reads back as a program that has it, or says why it is not one.
fn edits() -> Result<(), Failed> {
    let text = std::fs::read_to_string("vectors/scenes/programs/lit-combiners.ron").unwrap();
    let mut session = Session::default();
    let folder = Path::new("vectors/scenes/programs/lit-combiners.ron");
    for name in load(folder).unwrap().1 {
        let file = std::fs::read(folder.with_file_name(&name)).unwrap();
        session.answer(json!({ "do": "file", "name": name }).to_string().as_bytes(), file);
    }
    let mut ask = |request: Value| -> Value {
        serde_json::from_str(&session.answer(request.to_string().as_bytes(), Vec::new())).unwrap()
    };
    let open = json!({ "do": "open", "text": text, "name": "a.ron" });
    assert!(ask(open.clone())["scene"].is_object());
    let program = ask(json!({ "do": "program", "draw": 0 }))["program"].clone();
    let words = |kind: &str| program["choices"][kind].as_array().unwrap().clone();
    let mut changes: Vec<(Value, Value)> =
        vec![(json!(["constants", 1]), json!([9, 8, 7, 6])), (json!(["final", "color_sum_clamp"]), json!(true))];
    for portion in ["rgb", "alpha"] {
        for (field, kind) in
            [("scale", "scale"), ("bias", "bias"), ("ab_output", "register"), ("sum_output", "register")]
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

fn inspect(scene: &Path, page: &Path) {
    let Output { status, stderr, .. } =
        Command::new(env!("CARGO_BIN_EXE_ninebit")).arg("inspect").arg(scene).arg("-o").arg(page).output().unwrap();
    assert!(status.success(), "{}", String::from_utf8_lossy(&stderr));
}

/// Opens, clicks, edits and undoes.
fn firefox() -> Result<(), Failed> {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("stone.html");
    let path = Path::new("vectors/scenes/dot3/lit-stone.ron");
    inspect(path, &page);
    let plan = load(path).unwrap().0.plan;
    let word = trace(&plan, 0, (200, 300), None).unwrap().word;
    let arguments = [page.to_str().unwrap(), &digests(&plan)[0], &word.to_string()];
    let run = Command::new("node").arg("tests/web/firefox.mjs").args(arguments).output().unwrap();
    print!("{}", String::from_utf8_lossy(&run.stdout));
    if run.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&run.stderr).into_owned().into()) }
}

fn page() -> Result<(), Failed> {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let path = Path::new("vectors/scenes/dot3/lit-stone.ron");
    inspect(path, &at("stone.html"));
    let (loaded, images) = load(path).unwrap();
    let image: u64 = images.iter().map(|name| std::fs::metadata(path.with_file_name(name)).unwrap().len()).sum();
    let text = std::fs::read_to_string(at("stone.html")).unwrap();
    let first = text.split_once("\"picture\":\"").unwrap().1.find('"').unwrap() as u64;
    println!("page without its images {} bytes", text.len() as u64 - image * 4 / 3 - first);

    // Names with markup in them, and a picture of 256 x 256.
    let triangle = |name: &str, side: u32| {
        format!(
            "(version: 1, profile: Nv2a, targets: [(name: \"frame\", width: {side}, height: {side}, format: A8R8G8B8)],\n draws: [(name: \"{name}\", vertices: Window([\n (position: (0, 0), diffuse: (255, 0, 0)), (position: ({}, 0), diffuse: (0, 255, 0)), (position: (0, {}), diffuse: (0, 0, 255))]),\n program: Combiners(stages: [(rgb: (a: PrimaryColor, b: UnsignedInvert(Zero), ab: Spare0))], final_combiner: (a: Spare0)))])",
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

    // What the page has to show, by the library.
    let pixel = (200, 300);
    let traced = trace(&loaded.plan, 0, pixel, None).unwrap();
    let mut session = Session::default();
    for name in &images {
        session.answer(
            json!({ "do": "file", "name": name }).to_string().as_bytes(),
            std::fs::read(path.with_file_name(name)).unwrap(),
        );
    }
    session.answer(
        json!({ "do": "open", "text": loaded.source.text, "name": "lit-stone.ron" }).to_string().as_bytes(),
        Vec::new(),
    );
    let change = json!({ "do": "edit", "draw": 0, "path": ["stages", 0, "rgb", "inputs", 0, "mapping"], "value": "UnsignedIdentity" });
    let edited: Value = serde_json::from_str(&session.answer(change.to_string().as_bytes(), Vec::new())).unwrap();
    let text = edited["text"].as_str().unwrap();
    let changed = parse(text, path, &Limits::default()).unwrap();
    let mut policies = Policies::default();
    policies.set("CMB-3=literal").unwrap();
    let literal = Plan { policies, ..loaded.plan.clone() };
    let frame = &render(&loaded.plan, &RenderOptions::default()).surfaces[0];
    let png =
        |pixels: &[[u8; 4]]| STANDARD.encode(encode_png(frame.width, frame.height, pixels, Compression::Fast).unwrap());
    let pixels = frame.rgba8();
    let mut other = pixels.clone();
    for at in [0, 1, 640, 5000] {
        other[at][1] ^= 16;
    }
    let bad: Vec<Value> = bad_scenes()
        .into_iter()
        .filter(|(path, _)| std::fs::metadata(path).unwrap().len() < 20_000)
        .filter_map(|(path, _)| Some((path.clone(), std::fs::read_to_string(path).ok()?)))
        .step_by(9)
        .filter_map(|(path, text)| {
            // An area of text has no carriage returns.
            let text = text.replace('\r', "");
            let mut session = Session::default();
            for name in &images {
                let file = std::fs::read(Path::new("vectors/scenes/dot3").join(name)).unwrap();
                session.answer(json!({ "do": "file", "name": name }).to_string().as_bytes(), file);
            }
            let open = json!({ "do": "open", "text": text, "name": "lit-stone.ron" });
            let answer: Value = serde_json::from_str(&session.answer(open.to_string().as_bytes(), Vec::new())).unwrap();
            let each: Vec<&str> =
                answer["findings"].as_array()?.iter().map(|f| f["rendered"].as_str().unwrap().trim_end()).collect();
            let name = path.to_str()?.to_owned();
            answer.get("scene").is_none().then(|| json!({ "name": name, "text": text, "rendered": each.join("\n\n") }))
        })
        .collect();
    assert!(bad.len() > 10, "{}", bad.len());
    let shown = traced.shown.map(|byte| byte.to_string()).join(", ");
    let expected = json!({
        "digest": digests(&loaded.plan)[0], "pixel": pixel, "word": traced.word, "shown": shown,
        "edited": digests(&changed.plan)[0], "text": text, "literal": digests(&literal)[0],
        "same": png(&pixels), "other": png(&other), "differing": "4 pixels differ", "bad": bad,
    });
    std::fs::write(at("expected.json"), expected.to_string()).unwrap();
    let pictures = std::env::var("NINEBIT_WEB_PICTURES").ok().filter(|folder| !["", "0"].contains(&folder.as_str()));
    let arguments = [folder.path().to_path_buf(), at("expected.json")].into_iter().chain(pictures.map(PathBuf::from));
    let run = Command::new("node").arg("tests/web/page.mjs").args(arguments).output().unwrap();
    print!("{}", String::from_utf8_lossy(&run.stdout));
    if run.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&run.stderr).into_owned().into()) }
}
