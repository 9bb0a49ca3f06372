//! Cases of public test suites for pixel shaders, brought through the front end whole: a scene text for each, drawn, one pixel looked at within
//! the suite's own tolerance.
//!
//! `NINEBIT_CASES=FILE` runs another file of the same form instead.
#![allow(
    clippy::unwrap_used,
    clippy::float_arithmetic,
    reason = "a test fails by panicking; colours of suites are floats"
)]

use ninebit::engine::{self, RenderOptions};
use ninebit::limits::Limits;
use ninebit::scene;
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::Path;

#[test]
fn every_case_of_pixel_shaders() {
    let other = std::env::var("NINEBIT_CASES").ok();
    let file = other.as_deref().unwrap_or("vectors/third-party/pixel-shader.json");
    let document: Value = serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap();
    let listed = fs::read_to_string("docs/known-differences.md").unwrap();
    let (mut wrong, mut total, mut excepted) = (Vec::new(), 0, 0);
    for case in document["cases"].as_array().unwrap() {
        // A file may have other kinds of case as well.
        if case["kind"].as_str().is_some_and(|kind| kind != "ps11") {
            continue;
        }
        total += 1;
        let id = case["id"].as_str().unwrap();
        let problem = match scene_of(&case["inputs"]) {
            Ok(text) => differs(case, &text).map(|problem| format!("{problem}\n{text}")),
            Err(reason) => Some(reason),
        };
        match (problem, listed.contains(&format!("`{id}`"))) {
            (None, false) => {}
            (Some(_), true) => excepted += 1,
            (None, true) => wrong.push(format!("{id} is listed as different and is not")),
            (Some(problem), false) => wrong.push(format!("{id}: {problem}")),
        }
    }
    assert!(wrong.is_empty(), "{} of {total} are wrong:\n{}", wrong.len(), wrong.join("\n"));
    assert!(20 * excepted <= total, "{excepted} of {total} are excepted");
}

/// What is wrong with the pixel, if anything. Where a suite says what this family of chips gives, that is expected.
fn differs(case: &Value, text: &str) -> Option<String> {
    let loaded = match scene::parse(text, Path::new("case.ron"), &Limits::default()) {
        Ok(loaded) => loaded,
        Err(error) => return Some(error.render(false)),
    };
    let frames = engine::render(&loaded.plan, &RenderOptions::default());
    let shown = frames.surfaces[0].rgba8()[0];
    let tolerance = case["tolerance"].as_f64().unwrap();
    let expected = ["nvidia", "alt_expected_nv20", "expected"].iter().find_map(|key| case[key].as_array()).unwrap();
    let off = (0..4).any(|n| expected[n].as_f64().is_some_and(|value| (value - f64::from(shown[n])).abs() > tolerance));
    off.then(|| format!("{shown:?}, not {expected:?} within {tolerance}"))
}

fn numbers(value: &Value) -> String {
    let parts: Vec<String> = value.as_array().unwrap().iter().map(Value::to_string).collect();
    format!("({})", parts.join(", "))
}

/// A case as one quad over one pixel.
fn scene_of(inputs: &Value) -> Result<String, String> {
    let shader = shader(inputs)?;
    let mut textures = [const { None }; 4];
    for (unit, slot) in textures.iter_mut().enumerate() {
        *slot = texture(inputs, unit)?;
    }
    let mut table = String::new();
    let mut units = Vec::new();
    for (unit, texture) in textures.iter().enumerate() {
        match texture {
            Some((source, signed)) => {
                writeln!(table, "\"t{unit}\": ({source}),").unwrap();
                units.push(format!(
                    "(texture: \"t{unit}\", signed: {signed}, address: ClampToEdge, min_filter: Nearest, mag_filter: Nearest)"
                ));
            }
            None => units.push("Unbound".to_owned()),
        }
    }
    let color = |name: &str, default: &str| match &inputs[name] {
        Value::Null => default.to_owned(),
        color => format!("Float{}", numbers(color)),
    };
    let (diffuse, specular) = (color("v0", "(255, 255, 255, 255)"), color("v1", "(0, 0, 0, 0)"));
    let sets: Vec<String> = (0..4)
        .map(|set| match (&inputs[&format!("t{set}")], &inputs["t"]) {
            (Value::Null, Value::Null) => format!("t{set}: (0, 0)"),
            (Value::Null, all) => format!("t{set}: {}", numbers(all)),
            (own, _) => format!("t{set}: {}", numbers(own)),
        })
        .collect();
    let corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        .map(|(x, y)| format!("(position: ({x}, {y}), diffuse: {diffuse}, specular: {specular}, {})", sets.join(", ")));
    let table = if table.is_empty() { String::new() } else { format!("textures: {{ {table} }},") };
    Ok(format!(
        "(version: 1, profile: Nv2a, targets: [(name: \"frame\", width: 1, height: 1, format: A8R8G8B8)], {table}\n\
         draws: [(topology: Quads, vertices: Window([{}]), textures: [{}],\nprogram: PixelShader({}{}text: r#\"{shader}\"#))])",
        corners.join(", "),
        units.join(", "),
        constants(inputs),
        bumps(inputs),
    ))
}

/// The text of the shader.
fn shader(inputs: &Value) -> Result<String, String> {
    let version = inputs["version"].as_str().unwrap();
    if version == "atifs" {
        return operation(inputs["operation"].as_str().unwrap());
    }
    let mut text = format!("ps.{version}\n");
    for (register, value) in inputs["defs"].as_object().into_iter().flatten() {
        writeln!(text, "def {register}, {}", numbers(value).trim_matches(['(', ')'])).unwrap();
    }
    for line in inputs["program"].as_array().unwrap() {
        let sources = line["src"].as_array().unwrap().iter().map(|source| source.as_str().unwrap());
        let operands: Vec<&str> = [line["dst"].as_str().unwrap()].into_iter().chain(sources).collect();
        writeln!(text, "{} {}", line["op"].as_str().unwrap(), operands.join(", ")).unwrap();
    }
    Ok(text)
}

/// An operation of ATI_fragment_shader, whose first colour is v0, as an instruction.
fn operation(text: &str) -> Result<String, String> {
    let (name, operands) = text.split_once(' ').ok_or(text)?;
    let mut scale = "";
    let operands: Result<Vec<String>, String> = operands
        .split(',')
        .map(|operand| {
            let operand = operand.trim().replace("c0", "v0");
            Ok(match operand.as_str() {
                "4*v0" | "2*v0" => {
                    scale = if operand.starts_with('4') { "_x4" } else { "_x2" };
                    "v0".to_owned()
                }
                "(1-v0)-0.5" => "-v0_bias".to_owned(),
                other => match other.strip_suffix("-0.5") {
                    Some(register) => format!("{register}_bias"),
                    None => other.to_owned(),
                },
            })
        })
        .collect();
    let name = if name == "lerp" { "lrp" } else { name };
    Ok(format!("ps.1.1\n{name}{scale} r0, {}\n", operands?.join(", ")))
}

fn constants(inputs: &Value) -> String {
    let constants = inputs["consts"].as_object().into_iter().flatten();
    let entries: Vec<String> =
        constants.map(|(register, value)| format!("\"{register}\": Float{}", numbers(value))).collect();
    if entries.is_empty() { String::new() } else { format!("constants: {{ {} }}, ", entries.join(", ")) }
}

/// BUMPENVMAT00, 01, 10, 11 of texture stages.
fn bumps(inputs: &Value) -> String {
    let matrix = |unit: usize| inputs.get(format!("bumpenvmat{unit}"));
    let entries: Vec<String> = (0..4)
        .filter_map(|unit| Some(format!("\"t{unit}\": (matrix: {}, luminance: (1, 0))", numbers(matrix(unit)?))))
        .collect();
    if entries.is_empty() { String::new() } else { format!("bump: {{ {} }}, ", entries.join(", ")) }
}

/// What a unit's texture is made of, and which of its channels are signed.
fn texture(inputs: &Value, unit: usize) -> Result<Option<(String, String)>, String> {
    let unsigned = "(false, false, false, false)".to_owned();
    if let Some(pair) = inputs.get(format!("du_dv_{unit}")) {
        let [u, v] = [0, 1].map(|n| pair[n].as_i64().unwrap() as u8);
        return Ok(Some((format!("source: Solid(width: 1, height: 1, color: (0, {v}, {u}, 255))"), unsigned)));
    }
    let shared =
        inputs.as_object().unwrap().iter().find(|(key, _)| key.len() > 4 && key.contains(&format!("tex{unit}")));
    if let Some((_, text)) = shared {
        return Ok(Some((texels(text.as_str().ok_or("a texture without texels")?)?, unsigned)));
    }
    let texture = &inputs[&format!("tex{unit}")];
    let Some(format) = texture["format"].as_str() else { return Ok(None) };
    let texel = texture["texel"].as_u64().unwrap();
    let byte = |shift: u32| (texel >> shift) as u8;
    // Five bits with a sign as the API has them, negative ones over 16 and positive ones over 15. The chip's own format of such bits is
    // widened by replication, which no suite of an API knows.
    let five = |shift: u32| match byte(shift) & 31 {
        n @ 0..16 => (u32::from(n) * 127 / 15) as u8,
        n => n << 3,
    };
    let flags = |r, g, b, a| format!("({r}, {g}, {b}, {a})");
    let (color, signed) = match format {
        "V8U8" => ([byte(0), byte(8), 255, 255], flags(true, true, false, false)),
        "Q8W8V8U8" => ([byte(0), byte(8), byte(16), byte(24)], flags(true, true, true, true)),
        "X8L8V8U8" => ([byte(0), byte(8), byte(16), 255], flags(true, true, false, false)),
        "V16U16" => ([byte(8), byte(24), 255, 255], flags(true, true, false, false)),
        "L6V5U5" => {
            let l = byte(10) & 63;
            ([five(0), five(5), l << 2 | l >> 4, 255], flags(true, true, false, false))
        }
        other => return Err(format!("format {other}")),
    };
    let [r, g, b, a] = color;
    Ok(Some((format!("source: Solid(width: 1, height: 1, color: ({r}, {g}, {b}, {a}))"), signed)))
}

/// "8x8: texel(col 6,row 4)=ff0000, ..., all others 0000ff; ..."
fn texels(text: &str) -> Result<String, String> {
    let word = |text: &str| text.split(|c: char| !c.is_ascii_alphanumeric()).next().map(str::to_owned);
    let others = text.split("others ").nth(1).and_then(word).ok_or(text)?;
    let mut rows = vec![vec![format!("ff{others}"); 8]; 8];
    for part in text.split("col ").skip(1) {
        let column: usize = word(part).ok_or(text)?.parse().map_err(|_| text)?;
        let row: usize = part.split("row ").nth(1).and_then(word).ok_or(text)?.parse().map_err(|_| text)?;
        let color = part.split('=').nth(1).and_then(word).ok_or(text)?;
        rows[row][column] = format!("ff{color}");
    }
    let rows: Vec<String> = rows.iter().map(|row| format!("\"{}\"", row.join(" "))).collect();
    Ok(format!("source: Texels(width: 8, height: 8, rows: [{}])", rows.join(", ")))
}
