//! Runs the cases of public test suites. Each case is read, drawn through the whole front end, and judged with the list of known
//! differences.
//!
//! `NINEBIT_CASES=FILE` runs another file of the same form. If its cases name kinds, a test runs those of its own kind.
//! `vectors/third-party/README.md` describes the form. A case that cannot be expressed as a scene fails by name and does not end the run.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::float_arithmetic,
    reason = "each test uses a part; a test fails by panicking; tolerances are floats"
)]

use super::repository::at;
use ninebit::engine::{self, RenderOptions};
use ninebit::limits::Limits;
use ninebit::state::Named;
use ninebit_scene::{self as scene, LoadedScene};
use serde_json::Value;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// A kind of cases: its file, and the name of the kind in other files.
pub struct Kind {
    pub file: &'static str,
    pub name: &'static str,
}

/// Returns the cases to run, and whether they are those of the repository.
fn cases(kind: &Kind) -> (Vec<Value>, bool) {
    let other = std::env::var("NINEBIT_CASES").ok();
    let own = format!("vectors/third-party/{}.json", kind.file);
    let file = other.as_deref().unwrap_or(&own);
    let text = fs::read_to_string(at(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
    let mut document: Value = serde_json::from_str(&text).unwrap();
    let Value::Array(mut cases) = document["cases"].take() else { panic!("{file} has no cases") };
    cases.retain(|case| case["kind"].as_str().is_none_or(|named| named == kind.name));
    (cases, other.is_none())
}

/// The numbers of cases by outcome.
#[derive(Debug, Default)]
pub struct Outcome {
    pub wrong: Vec<String>,
    /// Cases that differ as the list of known differences states.
    pub excepted: usize,
    /// Cases that apply to one of the chips.
    pub applicable: usize,
}

/// Runs every case of a kind. `problem` gets the case and the profile that it names, and returns what is wrong.
pub fn run(kind: &Kind, problem: impl Fn(&Value, &str) -> Option<String>) {
    let kept = fs::read_to_string(at("docs/evidence/known-differences.md")).unwrap();
    let (cases, own) = cases(kind);
    let Outcome { wrong, excepted, applicable } = judge(&cases, &kept, problem);
    println!("{}: {} cases, {applicable} applicable, {excepted} listed as different", kind.file, cases.len());
    assert!(wrong.is_empty(), "{} of {} are wrong:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
    assert!(!own || applicable > 0, "no cases");
}

/// Judges cases with a text that names the known differences.
pub fn judge(cases: &[Value], kept: &str, problem: impl Fn(&Value, &str) -> Option<String>) -> Outcome {
    let mut outcome = Outcome::default();
    for case in cases {
        let Some(id) = case["id"].as_str() else {
            outcome.wrong.push(format!("a case without an id: {case}"));
            continue;
        };
        if case["profile"] == "none" {
            // If neither chip has the feature that a case needs, the list names the case by its test and this feature.
            let mode = case["inputs"]["mode"].as_str().unwrap_or(id);
            if !kept.contains(&format!("`{mode}`")) {
                outcome.wrong.push(format!("{id} is not applicable and not listed as such"));
            }
            continue;
        }
        outcome.applicable += 1;
        let profile = if case["profile"] == "nv10" { "Nv10" } else { "Nv2a" };
        match (caught(|| problem(case, profile)), kept.contains(&format!("`{id}`"))) {
            (None, false) => {}
            (Some(_), true) => outcome.excepted += 1,
            (None, true) => outcome.wrong.push(format!("{id} is listed as different and is not")),
            (Some(problem), false) => outcome.wrong.push(format!("{id}: {problem}")),
        }
    }
    outcome
}

/// Returns the problem of a case. A panic counts as a problem, so that the other cases still run.
fn caught(problem: impl Fn() -> Option<String>) -> Option<String> {
    catch_unwind(AssertUnwindSafe(problem)).unwrap_or_else(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
        Some(format!("cannot be put as a scene: {}", said.unwrap_or("no reason given")))
    })
}

/// Reads a scene. A finding is a problem.
pub fn load(text: &str) -> Result<LoadedScene, String> {
    scene::parse(text, Path::new("case.ron"), &Limits::default())
        .map_err(|error| format!("{}\n{text}", error.render(false)))
}

/// Returns the colour of a pixel of the first target.
pub fn pixel(text: &str, (x, y): (u32, u32)) -> Result<[u8; 4], String> {
    let loaded = load(text)?;
    let frames = engine::render(&loaded.plan, &RenderOptions::default());
    let width = loaded.plan.targets()[0].width;
    Ok(frames.surfaces[0].rgba8()[(y * width + x) as usize])
}

/// Returns how a colour differs from the expectation of a case by more than its tolerance. What the suite states for the vendor's own chips
/// takes precedence. An expectation may be the name of an input (`framebuffer`), or a list of colours that are all acceptable.
pub fn differs(case: &Value, shown: Result<[u8; 4], String>) -> Option<String> {
    let expected = ["nvidia", "alt_expected_nv20", "expected"].iter().map(|field| &case[*field]).find(|v| !v.is_null());
    let expected = match expected {
        Some(Value::String(input)) => &case["inputs"][input],
        expected => expected.unwrap_or(&Value::Null),
    };
    let Some(colors) = expected.as_array().filter(|colors| !colors.is_empty()) else {
        panic!("expects no colour: {expected}")
    };
    let tolerance = case["tolerance"].as_f64().unwrap_or_else(|| panic!("has no tolerance"));
    if colors.iter().all(Value::is_array) {
        let problems: Vec<String> = colors
            .iter()
            .map(|color| differs_from(color.as_array().unwrap(), tolerance, shown.clone()))
            .collect::<Option<_>>()?;
        return Some(problems.join("; "));
    }
    differs_from(colors, tolerance, shown)
}

/// Like [`differs`], with an expectation from the caller, in which null accepts any value.
pub fn differs_from(expected: &[Value], tolerance: f64, shown: Result<[u8; 4], String>) -> Option<String> {
    let shown = match shown {
        Ok(shown) => shown,
        Err(problem) => return Some(problem),
    };
    let channels = expected.iter().zip(shown);
    let off = channels
        .clone()
        .any(|(value, shown)| value.as_f64().is_some_and(|value| (value - f64::from(shown)).abs() > tolerance));
    off.then(|| format!("{shown:?}, not {expected:?} within {tolerance}"))
}

/// Returns a colour of bytes in scene notation: `(255, 128, 0)`. Channels that the suite does not state are 255, which is also the alpha
/// that a target without alpha yields.
pub fn bytes(value: &Value) -> String {
    color_text(value, "255")
}

/// Returns a colour of floats in scene notation.
pub fn floats(value: &Value) -> String {
    format!("Float{}", color_text(value, "1"))
}

fn color_text(value: &Value, full: &str) -> String {
    let channels = value.as_array().unwrap_or_else(|| panic!("not a colour: {value}"));
    let parts: Vec<String> =
        channels.iter().map(|channel| if channel.is_null() { full.to_owned() } else { channel.to_string() }).collect();
    format!("({})", parts.join(", "))
}

/// Returns the colour of the given name, which has bytes, or of the name with `_f`, which has floats.
pub fn color(inputs: &Value, name: &str) -> Option<String> {
    let exact = &inputs[format!("{name}_f")];
    if exact.is_array() {
        return Some(floats(exact));
    }
    (!inputs[name].is_null()).then(|| bytes(&inputs[name]))
}

/// Returns further fields of a target that clear it to the values before the draw, by the names that the suites use.
pub fn cleared(inputs: &Value) -> String {
    let names = ["framebuffer", "clear", "clear_color", "dst", "dest"];
    let color = names.iter().find_map(|name| color(inputs, name));
    color.map_or(String::new(), |color| format!(", clear: (color: {color})"))
}

/// Returns the texels of a map of 128 x 128.
fn map_of(texel: impl Fn(i32, i32) -> String) -> String {
    let row = |y| (0..128).map(|x| texel(x, y)).collect::<Vec<String>>().join(" ");
    let rows: Vec<String> = (0..128).map(|y| format!("\"{}\"", row(y))).collect();
    format!("source: Texels(width: 128, height: 128, rows: [{}])", rows.join(", "))
}

/// Returns Wine's displacement map in V8U8, which points away from the centre along the nearer axis. V and U are in the bytes of green and
/// blue.
pub fn displacement_map() -> String {
    map_of(|x, y| {
        let (v, u) = match (x - 64).abs() > (y - 64).abs() {
            true => (if x < 64 { 0xc0 } else { 0x40 }, 0),
            false => (0, if y < 64 { 0x40 } else { 0xc0 }),
        };
        format!("ff00{v:02x}{u:02x}")
    })
}

/// Returns Wine's map of positions, in which red and green are twice the column and the row.
pub fn place_map() -> String {
    map_of(|x, y| format!("ff{:02x}{:02x}00", 2 * x, 2 * y))
}

/// Returns only the letters and digits of a name, in lower case.
pub fn folded(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}

/// Returns the name of a variant that a suite spells in capitals.
pub fn named<T: Named>(name: &str) -> &'static str {
    let found = T::NAMES.iter().find(|known| folded(known) == folded(name));
    found.unwrap_or_else(|| panic!("{name} is not in {:?}", T::NAMES))
}

/// Returns a blend factor by its name in OpenGL or Direct3D.
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
