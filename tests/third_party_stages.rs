//! Runs cases of public test suites for Direct3D texture stages and the OpenGL texture environment. Each case becomes the text of a scene,
//! which is read and drawn, and one pixel is compared within the tolerance of the suite.
//!
//! `common/third_party.rs` describes how cases are run.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::third_party;

use ninebit_program::texture_environment::{EnvironmentSource, Function, Mode};
use ninebit_program::texture_stages::{ArgumentSource, Operation};
use serde_json::Value;
use third_party::{Kind, blend_factor, bytes, cleared, color, differs, floats, named, pixel, run};

#[test]
fn every_case_of_texture_stages() {
    run_all(&Kind { file: "texture-stages", name: "tss" }, stages_scene);
}

#[test]
fn every_case_of_the_texture_environment() {
    run_all(&Kind { file: "texture-environment", name: "texenv" }, environment_scene);
}

fn run_all(kind: &Kind, text_of: fn(&Value, &str) -> String) {
    run(kind, |case, profile| problem(case, text_of(&case["inputs"], profile)));
}

fn problem(case: &Value, text: String) -> Option<String> {
    differs(case, pixel(&text, (0, 0))).map(|problem| format!("{problem}\n{text}"))
}

/// Returns how a case of Direct3D texture stages differs, if it does.
pub(crate) fn stages(case: &Value, profile: &str) -> Option<String> {
    problem(case, stages_scene(&case["inputs"], profile))
}

/// Returns a scene with a quad of one pixel, on a target with further fields.
fn scene_text(
    profile: &str,
    target: &str,
    textures: &[(usize, String)],
    diffuse: &str,
    specular: &str,
    rest: &str,
) -> String {
    let table: Vec<String> = textures.iter().map(|(unit, fields)| format!("\"t{unit}\": ({fields})")).collect();
    let most = textures.iter().map(|(unit, _)| unit + 1).max().unwrap_or(0);
    let units: Vec<String> = (0..most)
        .map(|unit| match textures.iter().find(|(bound, _)| *bound == unit) {
            Some((_, fields)) if fields.contains("V8U8") => {
                format!("(texture: \"t{unit}\", signed: (true, true, true, true), min_filter: Nearest)")
            }
            Some(_) => format!("\"t{unit}\""),
            None => "Unbound".to_owned(),
        })
        .collect();
    format!(
        "(version: 1, profile: {profile}, targets: [(name: \"frame\", width: 1, height: 1, format: A8R8G8B8{target})], \
         textures: {{ {} }}, draws: [(topology: Quads, vertices: Window([{}]), textures: [{}], {rest})])",
        table.join(", "),
        [(0, 0), (1, 0), (1, 1), (0, 1)]
            .map(|(x, y)| format!("(position: ({x}, {y}), diffuse: {diffuse}, specular: {specular})"))
            .join(", "),
        units.join(", "),
    )
}

/// Returns the blend after the stages, and the clear colour of the target, which belongs to the blend or to the case.
fn blend(inputs: &Value, name: &str) -> (String, String) {
    let blend = &inputs[name];
    if !blend.is_object() {
        return (String::new(), cleared(inputs));
    }
    let [source, destination] = ["src", "dst"].map(|side| blend_factor(blend[side].as_str().unwrap()));
    let before = color(blend, "dest").map_or(cleared(inputs), |color| format!(", clear: (color: {color})"));
    (format!("blend: (equation: Add, source: {source}, destination: {destination}), "), before)
}

/// Returns the scene of a Direct3D case.
fn stages_scene(inputs: &Value, profile: &str) -> String {
    let mut textures = Vec::new();
    for (unit, texture) in inputs["textures"].as_object().into_iter().flatten() {
        let fields = match texture.get("V8U8") {
            Some(pair) => {
                let [u, v] = [0, 1].map(|n| pair[n].as_i64().unwrap() as u8);
                format!("/* V8U8 */ source: Solid(width: 1, height: 1, color: (0, {v}, {u}, 255))")
            }
            None => format!("source: Solid(width: 1, height: 1, color: {})", bytes(texture)),
        };
        textures.push((unit.parse().unwrap(), fields));
    }
    let mut stages = Vec::new();
    for stage in inputs["stages"].as_array().unwrap() {
        let mut fields = Vec::new();
        for half in ["color", "alpha"] {
            for (key, value) in stage[half].as_object().into_iter().flatten() {
                let value = value.as_str().unwrap();
                let key = if key == "op" { "_op".to_owned() } else { key.replace("arg", "_arg") };
                let value = if key == "_op" { named::<Operation>(value).to_owned() } else { argument(value) };
                fields.push(format!("{half}{key}: {value}"));
            }
        }
        if let Some(result) = stage["result"].as_str() {
            fields.push(format!("result_arg: {}", named::<ArgumentSource>(result)));
        }
        if stage["constant"].is_array() {
            fields.push(format!("constant: {}", bytes(&stage["constant"])));
        }
        if stage["bumpenvmat"].is_array() {
            fields.push(format!("bump_matrix: {}", bytes(&stage["bumpenvmat"])));
        }
        stages.push(format!("({})", fields.join(", ")));
    }
    let factor = &inputs["tfactor"];
    let factor = if factor.is_array() { format!(", texture_factor: {}", bytes(factor)) } else { String::new() };
    let specular = inputs["specular_enable"] == true;
    let (blend, target) = blend(inputs, "blend");
    let rest = format!(
        "program: TextureStages(stages: [{}]{factor}, specular_enable: {specular}), {blend}",
        stages.join(", ")
    );
    let [diffuse, specular] =
        ["diffuse", "specular"].map(|name| color(inputs, name).unwrap_or("(0, 0, 0, 0)".to_owned()));
    scene_text(profile, &target, &textures, &diffuse, &specular, &rest)
}

/// Returns an argument in scene notation. Suites write it as `CURRENT|ALPHAREPLICATE`.
fn argument(text: &str) -> String {
    let words: Vec<&str> = text
        .split('|')
        .map(|word| match word.trim() {
            "COMPLEMENT" => "Complement",
            "ALPHAREPLICATE" => "AlphaReplicate",
            "TFACTOR" => "TextureFactor",
            word => named::<ArgumentSource>(word),
        })
        .collect();
    if words.len() == 1 { words[0].to_owned() } else { format!("({})", words.join(", ")) }
}

/// Returns the scene of an OpenGL case.
fn environment_scene(inputs: &Value, profile: &str) -> String {
    let several = |value: &Value| match value[0].is_array() {
        true => value.as_array().unwrap().clone(),
        false => vec![value.clone()],
    };
    let constants = several(&inputs["constant_f"]);
    let mode = named::<Mode>(inputs["mode"].as_str().unwrap().trim_end_matches("_NV"));
    let format = inputs["format"].as_str();
    let mut textures = Vec::new();
    let mut units = Vec::new();
    for (index, color) in several(&inputs["texture_f"]).iter().enumerate() {
        let (texture, base) = texture(color, format);
        textures.push((index, texture));
        let mut fields = vec![format!("mode: {mode}"), format!("color: {}", floats(&constants[index]))];
        if let Some(base) = base {
            fields.push(format!("base_format: {base}"));
        }
        if mode == "Combine4" {
            fields.extend(four(inputs));
        } else if let Some(unit) = inputs["units"].get(index) {
            fields.extend(combine(unit));
        }
        units.push(format!("({})", fields.join(", ")));
    }
    let (blend, target) = blend(inputs, "then_blend");
    let rest = format!("program: TextureEnvironment(units: [{}]), {blend}", units.join(", "));
    scene_text(profile, &target, &textures, &floats(&inputs["primary_f"]), "(0, 0, 0, 0)", &rest)
}

/// Returns a texture of one texel with those channels of the colour that the base format keeps, and the base format itself if no texel
/// format implies it.
fn texture(color: &Value, format: Option<&str>) -> (String, Option<&'static str>) {
    let [r, _, _, a] = [0, 1, 2, 3].map(|n| color[n].as_f64().unwrap());
    let plain = floats(color);
    let (texel, color, base) = match format {
        None | Some("RGBA") => ("A8R8G8B8", plain, None),
        Some("RGB") => ("X8R8G8B8", plain, None),
        Some("ALPHA") => ("A8", plain, None),
        Some("LUMINANCE") => ("L8", plain, None),
        Some("INTENSITY") => ("I8", plain, None),
        Some("LUMINANCE_ALPHA") => ("A8R8G8B8", format!("Float({r}, {r}, {r}, {a})"), Some("LuminanceAlpha")),
        Some(other) => panic!("{other}"),
    };
    (format!("format: {texel}, source: Solid(width: 1, height: 1, color: {color})"), base)
}

/// Returns the fields of a unit whose sources and operands are the same for colour and alpha.
fn four(inputs: &Value) -> Vec<String> {
    let function = named::<Function>(inputs["combine"].as_str().unwrap());
    let list = |value: &Value, name: fn(&str) -> String| {
        let names: Vec<String> = value.as_array().unwrap().iter().map(|v| name(v.as_str().unwrap())).collect();
        format!("[{}]", names.join(", "))
    };
    let sources = list(&inputs["sources"], |name| named::<EnvironmentSource>(name).to_owned());
    let color = list(&inputs["operands"], |name| operand(&format!("{name}_COLOR")).to_owned());
    let alpha = list(&inputs["operands"], |name| operand(&format!("{name}_ALPHA")).to_owned());
    vec![
        format!("combine_rgb: {function}, combine_alpha: {function}"),
        format!("sources_rgb: {sources}, sources_alpha: {sources}, operands_rgb: {color}, operands_alpha: {alpha}"),
    ]
}

fn operand(name: &str) -> &'static str {
    match name {
        "SRC_COLOR" => "SourceColor",
        "ONE_MINUS_SRC_COLOR" => "OneMinusSourceColor",
        "SRC_ALPHA" => "SourceAlpha",
        "ONE_MINUS_SRC_ALPHA" => "OneMinusSourceAlpha",
        other => panic!("{other}"),
    }
}

/// Returns the fields of a combining unit. What a case does not state has the default of the API.
fn combine(unit: &Value) -> Vec<String> {
    let mut fields = Vec::new();
    for (half, color) in [("RGB", true), ("ALPHA", false)] {
        let get = |name: String| unit[&name].as_str();
        let lower = half.to_lowercase();
        if let Some(function) = get(format!("COMBINE_{half}")) {
            let function = match function {
                "DOT3_RGB" | "DOT3_RGBA" => format!("{function}_ARB"),
                other => other.to_owned(),
            };
            fields.push(format!("combine_{lower}: {}", named::<Function>(&function)));
        }
        let sources: Vec<&str> = ["TEXTURE", "PREVIOUS", "CONSTANT"]
            .iter()
            .enumerate()
            .map(|(n, default)| named::<EnvironmentSource>(get(format!("SOURCE{n}_{half}")).unwrap_or(default)))
            .collect();
        let plain = if color { "SRC_COLOR" } else { "SRC_ALPHA" };
        let operands: Vec<&str> = [plain, plain, "SRC_ALPHA"]
            .iter()
            .enumerate()
            .map(|(n, default)| operand(get(format!("OPERAND{n}_{half}")).unwrap_or(default)))
            .collect();
        fields.push(format!("sources_{lower}: [{}], operands_{lower}: [{}]", sources.join(", "), operands.join(", ")));
        if let Some(scale) = unit[&format!("{half}_SCALE")].as_u64() {
            fields.push(format!("scale_{lower}: {scale}"));
        }
    }
    fields
}
