//! Runs cases of public test suites for pixel shaders. Each case becomes the text of a scene, which is read and drawn, and one pixel is
//! compared within the tolerance of the suite.
//!
//! `common/third_party.rs` describes how cases are run.
#![allow(
    clippy::unwrap_used,
    clippy::float_arithmetic,
    reason = "a test fails by panicking; colours of suites are floats"
)]

use crate::third_party::{Kind, bytes, cleared, differs, displacement_map, floats, pixel, place_map, run};

use serde_json::Value;
use std::fmt::Write;

#[test]
fn every_case_of_pixel_shaders() {
    run(&Kind { file: "pixel-shader", name: "ps11" }, pixel_shader);
}

/// Returns how the pixel differs, if it does. Pixel shaders need nv2a, whatever profile the case names.
pub(crate) fn pixel_shader(case: &Value, _profile: &str) -> Option<String> {
    match scene_of(&case["inputs"]) {
        Ok(text) => differs(case, pixel(&text, (0, 0))).map(|problem| format!("{problem}\n{text}")),
        Err(reason) => Some(reason),
    }
}

fn numbers(value: &Value) -> String {
    let parts: Vec<String> = value.as_array().unwrap().iter().map(Value::to_string).collect();
    format!("({})", parts.join(", "))
}

/// Returns the scene of a case: a quad of one pixel.
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
        color => floats(color),
    };
    let (diffuse, specular) = (color("v0", "(255, 255, 255, 255)"), color("v1", "(0, 0, 0, 0)"));
    let sets: Vec<String> = (0..4)
        .map(|set| {
            // The coordinates are those of one set, or of all sets under one of two names.
            let own = [format!("t{set}"), "t".to_owned(), "uv".to_owned()];
            let given = own.iter().map(|name| &inputs[name]).find(|value| !value.is_null());
            format!("t{set}: {}", given.map_or("(0, 0)".to_owned(), numbers))
        })
        .collect();
    let corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        .map(|(x, y)| format!("(position: ({x}, {y}), diffuse: {diffuse}, specular: {specular}, {})", sets.join(", ")));
    let table = if table.is_empty() { String::new() } else { format!("textures: {{ {table} }},") };
    Ok(format!(
        "(version: 1, profile: Nv2a, targets: [(name: \"frame\", width: 1, height: 1, format: A8R8G8B8{})], {table}\n\
         draws: [(topology: Quads, vertices: Window([{}]), textures: [{}],\nprogram: PixelShader({}{}text: r#\"{shader}\"#))])",
        cleared(inputs),
        corners.join(", "),
        units.join(", "),
        constants(inputs),
        bumps(inputs),
    ))
}

/// Returns the text of the shader.
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

/// Returns an instruction for an operation of ATI_fragment_shader, whose first colour becomes v0.
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

/// Returns the bump matrices of texture stages (BUMPENVMAT00, 01, 10, 11), and the scale and offset of luminance. Each has the number of
/// its unit, or no number, and then applies to every bumped unit.
fn bumps(inputs: &Value) -> String {
    let bumped = |unit: usize| {
        let register = format!("t{unit}");
        let program = inputs["program"].as_array().into_iter().flatten();
        program.into_iter().any(|line| {
            line["op"].as_str().is_some_and(|op| op.starts_with("texbem")) && line["dst"].as_str() == Some(&register)
        })
    };
    let field = |unit: usize, names: [&str; 2]| {
        let numbered = names.iter().find_map(|name| inputs.get(format!("{name}{unit}")));
        numbered.or_else(|| names.iter().filter(|_| bumped(unit)).find_map(|name| inputs.get(*name)))
    };
    let entries: Vec<String> = (0..4)
        .filter_map(|unit| {
            let matrix = field(unit, ["bumpenvmat", "bump_matrix"])?;
            let [scale, offset] = [(["bumpenvlscale", "lscale"], "1"), (["bumpenvloffset", "loffset"], "0")]
                .map(|(names, default)| field(unit, names).map_or(default.to_owned(), Value::to_string));
            Some(format!("\"t{unit}\": (matrix: {}, luminance: ({scale}, {offset}))", numbers(matrix)))
        })
        .collect();
    if entries.is_empty() { String::new() } else { format!("bump: {{ {} }}, ", entries.join(", ")) }
}

/// Returns the source of a unit's texture, and which of its channels are signed.
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
    let solid = |color: String| format!("source: Solid(width: 1, height: 1, color: {color})");
    let exact = &inputs[&format!("tex{unit}_f")];
    if exact.is_array() {
        return Ok(Some((solid(floats(exact)), unsigned)));
    }
    match texture {
        Value::Null => return Ok(None),
        Value::Array(_) => return Ok(Some((solid(bytes(texture)), unsigned))),
        Value::String(text) if text.contains("texbem") => {
            let map = if text.contains("tex0") { displacement_map() } else { place_map() };
            return Ok(Some((map, unsigned)));
        }
        Value::String(text) => return Ok(Some((texels(text)?, unsigned))),
        _ => {}
    }
    if let Some(pair) = texture["V8U8"].as_array() {
        let [u, v] = [0, 1].map(|n| pair[n].as_i64().unwrap() as u8);
        return Ok(Some((solid(format!("(0, {v}, {u}, 255)")), unsigned)));
    }
    let format = texture["format"].as_str().ok_or_else(|| format!("tex{unit} is {texture}"))?;
    let texel = texture["texel"].as_u64().ok_or_else(|| format!("tex{unit} has no texel"))?;
    let byte = |shift: u32| (texel >> shift) as u8;
    // The API defines five signed bits as divided by 16 if negative and by 15 if positive. The chip's own format widens them by repetition,
    // which no suite of an API expects.
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

/// Returns the source of texels that are described as "8x8: texel(col 6,row 4)=ff0000, ..., all others 0000ff; ...".
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
