//! Runs cases of addressing, cube maps, levels, and units without a texture.

use super::third_party::{Kind, bytes, differs, differs_from, load, pixel, run};
use super::{number, numbers, quad, scene};
use ninebit::engine::trace;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::Texture;
use serde_json::{Value, json};
use std::sync::OnceLock;

/// A program that shows the first texture.
const SHOWN: &str = "program: TextureStages(stages: [(color_op: SelectArg1, color_arg1: Texture, alpha_op: SelectArg1, alpha_arg1: Texture)])";

/// Returns a scene with a quad of one pixel, whose corners all have the same coordinates.
fn sampled(profile: &str, texture: &str, unit: &str, coordinates: &str) -> String {
    let corner = format!("t0: {coordinates}");
    let quad = quad(1.0, 1.0, [0; 4].map(|_| corner.clone()));
    let head = format!("textures: {{ \"t\": ({texture}) }},");
    let draw = format!("{quad}, textures: [(texture: \"t\", {unit})], {SHOWN}");
    scene(profile, "name: \"frame\", width: 1, height: 1", &head, &draw)
}

/// Returns one of eight texels, which are all different.
fn texel(index: u64) -> [u64; 4] {
    [20 * index + 15, 240 - 30 * index, (index * 90) % 256, 255 - index]
}

const BORDER: [u64; 4] = [200, 10, 100, 60];

#[test]
fn every_case_of_addressing() {
    run(&Kind { file: "addressing", name: "address" }, |case, profile| {
        let inputs = &case["inputs"];
        if case["test"] == "conditional_np2_repeat_test" {
            return differs(case, conditional(inputs));
        }
        // Only nv2a has border colours.
        let (mode, profile) = match inputs["mode"].as_str().unwrap() {
            "REPEAT" => ("Wrap", profile),
            "MIRRORED_REPEAT" => ("Mirror", profile),
            "CLAMP_TO_EDGE" => ("ClampToEdge", profile),
            "CLAMP_TO_BORDER" => ("ClampToBorder", "Nv2a"),
            "CLAMP" => ("Clamp", "Nv2a"),
            other => panic!("{other}"),
        };
        let size = inputs["size"].as_u64().unwrap();
        let row: Vec<String> = (0..size)
            .map(|n| {
                let [r, g, b, a] = texel(n);
                format!("{:08x}", a << 24 | r << 16 | g << 8 | b)
            })
            .collect();
        let filter = if inputs["filter"] == "NEAREST" { "Nearest" } else { "Linear" };
        let border = if profile == "Nv2a" {
            format!(", border_color: {BORDER:?}").replace(['[', ']'], "|")
        } else {
            String::new()
        };
        let border = border.replacen('|', "(", 1).replacen('|', ")", 1);
        let text = sampled(
            profile,
            &format!("source: Texels(width: {size}, height: 1, rows: [\"{}\"])", row.join(" ")),
            &format!("min_filter: {filter}, address_s: {mode}{border}"),
            &format!("({:?}, 0.5)", number(&inputs["coord"])),
        );
        let share = number(&case["border_factor"]);
        let inside = case["expected_index"].as_u64().map_or([0; 4], texel);
        let expected: Vec<Value> =
            (0..4).map(|n| json!(share * BORDER[n] as f64 + (1.0 - share) * inside[n] as f64)).collect();
        // The suite allows one hundredth.
        differs_from(&expected, 2.55, pixel(&text, (0, 0)))
    });
}

/// Draws a texture whose sides are not powers of two. Direct3D's coordinates refer to the whole image, the chip's to texels, and such a
/// texture clamps regardless of the address mode.
fn conditional(inputs: &Value) -> Result<[u8; 4], String> {
    let size = inputs["size"].as_u64().unwrap();
    let rows: Vec<String> = (0..size)
        .map(|y| {
            let edge = |n| n == 0 || n == size - 1;
            let texels: Vec<&str> =
                (0..size).map(|x| if edge(x) || edge(y) { "ffff0000" } else { "ff0000ff" }).collect();
            format!("\"{}\"", texels.join(" "))
        })
        .collect();
    let uv: Vec<String> = numbers(&inputs["uv"]).iter().map(|c| format!("{:?}", c * size as f64)).collect();
    let text = sampled(
        "Nv2a",
        &format!("kind: Rectangle, source: Texels(width: {size}, height: {size}, rows: [{}])", rows.join(", ")),
        "min_filter: Nearest, address: ClampToEdge",
        &format!("({})", uv.join(", ")),
    );
    pixel(&text, (0, 0))
}

const FACES: [(&str, &str); 6] = [
    ("+X", "positive_x"),
    ("-X", "negative_x"),
    ("+Y", "positive_y"),
    ("-Y", "negative_y"),
    ("+Z", "positive_z"),
    ("-Z", "negative_z"),
];

/// Returns a cube map. `source` returns the source of a face.
fn cube(source: impl Fn(&str) -> String) -> String {
    let faces: Vec<String> = FACES.iter().map(|(name, field)| format!("{field}: {}", source(name))).collect();
    format!("source: Faces({})", faces.join(", "))
}

#[test]
fn every_case_of_cube_faces() {
    run(&Kind { file: "cube-faces", name: "cube_face" }, cube_face);
}

pub(crate) fn cube_face(case: &Value, profile: &str) -> Option<String> {
    let inputs = &case["inputs"];
    let direction: Vec<String> = numbers(&inputs["direction"]).iter().map(|c| format!("{c:?}")).collect();
    let direction = format!("({})", direction.join(", "));
    if !case["expected_st"].is_null() {
        return place_on_face(case, &direction);
    }
    let expected_faces = if case["expected_face"].is_null() { vec![] } else { faces_of(&case["expected_face"]) };
    let hex = |color: &Value| {
        let [r, g, b] = [0, 1, 2].map(|n| color[n].as_u64().unwrap());
        format!("ff{r:02x}{g:02x}{b:02x}")
    };
    let faces = cube(|name| {
        if inputs["face_colors"].is_object() {
            return format!("Solid(width: 1, height: 1, color: {})", bytes(&inputs["face_colors"][name]));
        }
        // Only the expected faces have the two colours of the case. The others have a third one.
        let [first, second] = if expected_faces.iter().any(|face| face == name) {
            ["first", "second"].map(|n| hex(&inputs[n]))
        } else {
            ["ff101010".to_owned(), "ff101010".to_owned()]
        };
        format!("Texels(width: 2, height: 2, rows: [\"{second} {first}\", \"{first} {first}\"])")
    });
    let shown = pixel(&sampled(profile, &faces, "min_filter: Nearest", &direction), (0, 0));
    if case["expected"].is_null() && inputs["face_colors"].is_object() {
        // If a case names only faces, their colours are the expectation.
        let colors: Vec<&Value> = expected_faces.iter().map(|face| &inputs["face_colors"][face]).collect();
        return differs(&json!({ "expected": colors, "tolerance": case["tolerance"] }), shown);
    }
    differs(case, shown)
}

/// Returns the faces that an expectation names: one, or several that are tied, as a list or in one text (`+X +Y`, `+X|+Y`).
fn faces_of(expected: &Value) -> Vec<String> {
    let texts: Vec<&str> = match expected {
        Value::Array(faces) => faces.iter().filter_map(Value::as_str).collect(),
        face => face.as_str().into_iter().collect(),
    };
    let named = |text: &str| {
        FACES
            .iter()
            .filter(|(name, _)| text.to_uppercase().contains(name))
            .map(|(name, _)| (*name).to_owned())
            .collect()
    };
    let faces: Vec<String> = texts.into_iter().flat_map(|text| -> Vec<String> { named(text) }).collect();
    assert!(!faces.is_empty(), "names no face: {expected}");
    faces
}

/// Compares the face, and the position on it, with the trace of a pixel that samples a map of large faces.
fn place_on_face(case: &Value, direction: &str) -> Option<String> {
    const SIZE: u32 = 1024;
    // The six million texels are the same for all cases, so they are generated once. Each scene is read with faces of one texel, which are
    // then replaced.
    static LARGE: OnceLock<Texture> = OnceLock::new();
    let looking = |size: u32| {
        let faces = cube(|_| format!("Solid(width: {size}, height: {size}, color: (1, 2, 3))"));
        load(&sampled("Nv2a", &format!("format: L8, {faces}"), "min_filter: Nearest", direction))
    };
    let mut scene = match looking(1) {
        Ok(loaded) => loaded.scene,
        Err(problem) => return Some(problem),
    };
    scene.textures[0] = LARGE.get_or_init(|| looking(SIZE).unwrap().scene.textures[0].clone()).clone();
    let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    let traced = trace(&plan, 0, (0, 0), None).unwrap();
    let step = |name: &str| traced.draws[0].steps.iter().find(|step| step.name == name).unwrap().value;
    let face = FACES[step("unit0.face") as usize].0;
    let place = ["u", "v"].map(|axis| step(&format!("unit0.{axis}")) as f64 / f64::from(256 * SIZE));
    let expected_faces = faces_of(&case["expected_face"]);
    // If a case names one of several tied faces, this only reflects the order of its reference implementation; the suite itself accepts the
    // other faces. If it names several, they are the suite's own requirement.
    let direction = numbers(&case["inputs"]["direction"]);
    let magnitude = |face: &str| direction["XYZ".find(&face[1..]).unwrap()].abs();
    if let [one] = &expected_faces[..]
        && one != face
        && magnitude(one) == magnitude(face)
    {
        return None;
    }
    let Some(tied) = expected_faces.iter().position(|expected| expected == face) else {
        return Some(format!("face {face}, not {}", expected_faces.join(" or ")));
    };
    // If there are several faces, each has its position by name or in the order of the faces, or all have the same one.
    let expected = match &case["expected_st"] {
        Value::Object(of_faces) => of_faces.get(face).unwrap_or_else(|| panic!("has no place on face {face}")),
        Value::Array(places) if places.iter().all(Value::is_array) => &places[tied],
        place => place,
    };
    let expected = numbers(expected);
    let tolerance = number(&case["tolerance_st"]);
    let off = (0..2).any(|n| (place[n] - expected[n]).abs() > tolerance);
    off.then(|| format!("face {face} at {place:?}, not {expected:?} within {tolerance}"))
}

const LEVELS: [[u64; 3]; 3] = [[255, 0, 0], [0, 255, 0], [0, 0, 255]];

/// Returns a scene with a texture of three levels in three colours on a square, with 2^lambda texels for each pixel.
fn levels(profile: &str, texture: &str, unit: &str, lambda: f64) -> String {
    let mips = [1, 2].map(|n| {
        let [r, g, b] = LEVELS[n];
        format!("Solid(width: {side}, height: {side}, color: ({r}, {g}, {b}))", side = 4 >> n)
    });
    let head = format!(
        "textures: {{ \"t\": (source: Solid(width: 4, height: 4, color: (255, 0, 0)), mips: [{}], {texture}) }},",
        mips.join(", ")
    );
    let far = 4.0 * lambda.exp2() / 4.0;
    let quad =
        quad(4.0, 4.0, [(0.0, 0.0), (far, 0.0), (far, far), (0.0, far)].map(|(s, t)| format!("t0: ({s:?}, {t:?})")));
    let draw = format!("{quad}, textures: [(texture: \"t\", min_filter: Nearest, {unit})], {SHOWN}");
    scene(profile, "name: \"frame\", width: 4, height: 4", &head, &draw)
}

#[test]
fn every_case_of_levels() {
    run(&Kind { file: "levels", name: "mip" }, |case, profile| {
        let inputs = &case["inputs"];
        assert_eq!(inputs["levels"], 3);
        let filter = match inputs["mipfilter"].as_str().unwrap() {
            "NONE" => "None",
            "POINT" | "NEAREST" => "Nearest",
            "LINEAR" => "Linear",
            other => panic!("{other}"),
        };
        if let Some(bias) = inputs["bias"].as_f64() {
            let unit = format!("mip_filter: {filter}, lod_bias: {bias:?}");
            let text = levels(profile, "", &unit, number(&inputs["lambda_unbiased"]));
            let [r, g, b] = LEVELS[case["expected_level"].as_u64().unwrap() as usize];
            return differs_from(&[json!(r), json!(g), json!(b), json!(null)], 0.0, pixel(&text, (1, 1)));
        }
        // Direct3D counts its largest level from that of the whole texture, the chip from the level with which the texture begins.
        let [first, most] = ["setlod", "maxmiplevel"].map(|name| inputs[name].as_u64().unwrap());
        let unit = format!("mip_filter: {filter}, min_lod: {}", most.saturating_sub(first));
        let text = levels(profile, &format!("first_level: {first}"), &unit, number(&inputs["lod"]));
        differs(case, pixel(&text, (1, 1)))
    });
}

/// A unit without a texture has no kind of texture either.
#[test]
fn every_case_of_unbound_textures() {
    run(&Kind { file: "unbound-textures", name: "texture_unbound" }, |case, profile| {
        let quad = quad(1.0, 1.0, [0; 4].map(|_| "t0: (0.5, 0.5, 0.5)".to_owned()));
        let program = "program: Combiners(stages: [()], final_combiner: (d: Texture0, g: Texture0))";
        let draw = format!("{quad}, textures: [Unbound], {program}");
        differs(case, pixel(&scene(profile, "name: \"frame\", width: 1, height: 1", "", &draw), (0, 0)))
    });
}
