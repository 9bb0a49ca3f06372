//! Cases of public test suites: reading them, bringing each through the front end whole, and holding what comes out against the list
//! of known differences.
//!
//! `NINEBIT_CASES=FILE` runs another file of the same form instead; of one that names kinds, those of the test.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::float_arithmetic,
    reason = "each test uses a part; a test fails by panicking; tolerances are floats"
)]

use ninebit::engine::{self, RenderOptions};
use ninebit::limits::Limits;
use ninebit::scene::{self, Loaded};
use ninebit::state::Named;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A kind of cases: its file, and the name that other files have for it.
pub struct Kind {
    pub file: &'static str,
    pub name: &'static str,
}

/// The cases to run, and whether they are the repository's own.
fn cases(kind: &Kind) -> (Vec<Value>, bool) {
    let other = std::env::var("NINEBIT_CASES").ok();
    let own = format!("vectors/third-party/{}.json", kind.file);
    let file = other.as_deref().unwrap_or(&own);
    let text = fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let mut document: Value = serde_json::from_str(&text).unwrap();
    let Value::Array(mut cases) = document["cases"].take() else { panic!("{file} has no cases") };
    cases.retain(|case| case["kind"].as_str().is_none_or(|named| named == kind.name));
    (cases, other.is_none())
}

/// Runs every case of a kind: `problem` says what is wrong with it, given the case and the profile it names.
pub fn run(kind: &Kind, problem: impl Fn(&Value, &str) -> Option<String>) {
    let kept = fs::read_to_string("docs/known-differences.md").unwrap();
    let (cases, own) = cases(kind);
    let (mut wrong, mut excepted, mut applicable) = (Vec::new(), 0, 0);
    for case in &cases {
        let id = case["id"].as_str().unwrap();
        let listed = kept.contains(&format!("`{id}`"));
        if case["profile"] == "none" {
            // Neither chip has what it asks for: the list says so by the test's name and what is asked for.
            let mode = case["inputs"]["mode"].as_str().unwrap();
            if !kept.contains(&format!("`{mode}`")) {
                wrong.push(format!("{id} is not applicable and not listed as such"));
            }
            continue;
        }
        applicable += 1;
        let profile = if case["profile"] == "nv10" { "Nv10" } else { "Nv2a" };
        match (problem(case, profile), listed) {
            (None, false) => {}
            (Some(_), true) => excepted += 1,
            (None, true) => wrong.push(format!("{id} is listed as different and is not")),
            (Some(problem), false) => wrong.push(format!("{id}: {problem}")),
        }
    }
    println!("{}: {} cases, {applicable} applicable, {excepted} listed as different", kind.file, cases.len());
    assert!(wrong.is_empty(), "{} of {} are wrong:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
    assert!(!own || applicable > 0, "no cases");
}

/// Reads a scene; a finding is a problem.
pub fn load(text: &str) -> Result<Loaded, String> {
    scene::parse(text, Path::new("case.ron"), &Limits::default())
        .map_err(|error| format!("{}\n{text}", error.render(false)))
}

/// What a scene shows in a pixel of its first target.
pub fn pixel(text: &str, (x, y): (u32, u32)) -> Result<[u8; 4], String> {
    let loaded = load(text)?;
    let frames = engine::render(&loaded.plan, &RenderOptions::default());
    let width = loaded.plan.targets[0].width;
    Ok(frames.surfaces[0].rgba8()[(y * width + x) as usize])
}

/// What is wrong with a colour, by the case's expectation and tolerance. What the suite states for the vendor's chips counts first.
pub fn differs(case: &Value, shown: Result<[u8; 4], String>) -> Option<String> {
    let expected = ["nvidia", "alt_expected_nv20", "expected"].iter().find_map(|field| case[*field].as_array());
    let expected = expected.unwrap_or_else(|| panic!("{} expects nothing", case["id"]));
    differs_from(expected, case["tolerance"].as_f64().unwrap(), shown)
}

/// The same with an expectation of the caller's: null is not looked at.
pub fn differs_from(expected: &[Value], tolerance: f64, shown: Result<[u8; 4], String>) -> Option<String> {
    let shown = match shown {
        Ok(shown) => shown,
        Err(problem) => return Some(problem),
    };
    let off = (0..4).any(|n| expected[n].as_f64().is_some_and(|value| (value - f64::from(shown[n])).abs() > tolerance));
    off.then(|| format!("{shown:?}, not {expected:?} within {tolerance}"))
}

/// A colour of bytes as a scene's: `(255, 128, 0)`.
pub fn bytes(value: &Value) -> String {
    let parts: Vec<String> = value.as_array().unwrap().iter().map(Value::to_string).collect();
    format!("({})", parts.join(", "))
}

/// A colour of floats as a scene's.
pub fn floats(value: &Value) -> String {
    format!("Float{}", bytes(value))
}

/// Letters and digits alone, in lower case.
pub fn folded(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}

/// The name of an enumeration that a suite spells in capitals.
pub fn named<T: Named>(name: &str) -> &'static str {
    let found = T::NAMES.iter().find(|known| folded(known) == folded(name));
    found.unwrap_or_else(|| panic!("{name} is not in {:?}", T::NAMES))
}

/// A blend factor by its name in OpenGL or Direct3D.
pub fn blend_factor(name: &str) -> &'static str {
    let name = folded(name);
    let (inverse, plain) = match name.strip_prefix("oneminus").or_else(|| name.strip_prefix("inv")) {
        Some(plain) => ("OneMinus", plain),
        None => ("", name.as_str()),
    };
    let plain = match plain {
        "zero" => "Zero",
        "one" => "One",
        "srccolor" => "SourceColor",
        "srcalpha" => "SourceAlpha",
        "srcalphasat" | "srcalphasaturate" => "SourceAlphaSaturate",
        "dstcolor" | "destcolor" => "DestinationColor",
        "dstalpha" | "destalpha" => "DestinationAlpha",
        "constantcolor" | "blendfactor" => "ConstantColor",
        "constantalpha" => "ConstantAlpha",
        other => panic!("{other}"),
    };
    let name = format!("{inverse}{plain}");
    named::<ninebit::state::BlendFactor>(&name)
}
