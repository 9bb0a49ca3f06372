//! Runs cases of fog. Direct3D's table fog is evaluated at each pixel from z or, with a perspective projection, from w. Its vertex fog is
//! evaluated at each vertex from the magnitude of z in eye space. OpenGL's fog uses the distance from the eye plane.

use super::third_party::{Kind, bytes, differs, pixel, run};
use super::{number, scene};
use serde_json::Value;

/// A fog function and the source of its coordinate.
struct Function {
    mode: &'static str,
    per_vertex: bool,
    source: &'static str,
}

impl Function {
    fn text(&self, inputs: &Value) -> String {
        let range = match self.mode {
            "Linear" => format!("start: {:?}, end: {:?}", value(inputs, "start", 0.0), value(inputs, "end", 1.0)),
            _ => format!("density: {:?}", value(inputs, "density", 1.0)),
        };
        let evaluation = if self.per_vertex { "PerVertex" } else { "PerPixel" };
        let (mode, source) = (self.mode, self.source);
        format!("mode: {mode}, {range}, coordinate_source: {source}, evaluation: {evaluation}")
    }

    /// Returns the profile of a scene with this function. Only nv2a evaluates fog at pixels.
    fn profile<'p>(&self, profile: &'p str) -> &'p str {
        if self.per_vertex { profile } else { "Nv2a" }
    }
}

fn value(inputs: &Value, name: &str, default: f64) -> f64 {
    inputs[name].as_f64().unwrap_or(default)
}

fn mode(name: &str) -> Option<&'static str> {
    match name {
        "LINEAR" => Some("Linear"),
        "EXP" => Some("Exp"),
        "EXP2" => Some("Exp2"),
        "NONE" => None,
        other => panic!("{other}"),
    }
}

fn color_of(inputs: &Value) -> String {
    let [r, g, b] = [0, 1, 2].map(|n| inputs["color"][n].as_u64().unwrap());
    // If a suite does not state alpha, it is one half. One suite reads it, and has this value.
    format!("diffuse: ({r}, {g}, {b}, 128)")
}

#[test]
fn every_case_of_fog() {
    run(&Kind { file: "fog", name: "fog" }, |case, profile| {
        let inputs = &case["inputs"];
        if inputs["vertex_mode"].is_string() {
            return differs(case, interpolated(inputs, profile));
        }
        let test = case["test"].as_str().unwrap();
        let shown = match test {
            "fog_special_test" => across(inputs, profile),
            "test_fog" if inputs["vertex"].is_string() => transformed(inputs, profile),
            "test_table_fog_zw" => with_w(inputs, profile),
            _ => constant(inputs, profile, case["id"].as_str().unwrap().starts_with("piglit.")),
        };
        differs(case, shown)
    });
}

/// Returns a pixel with the same fog coordinate everywhere.
fn constant(inputs: &Value, profile: &str, opengl: bool) -> Result<[u8; 4], String> {
    let Some(mode) = mode(inputs["mode"].as_str().unwrap()) else { return Err("no mode".to_owned()) };
    let vertex_fog = inputs["vertex_fog"] == true;
    let source = if opengl || vertex_fog { "EyePlaneAbsolute" } else { "Depth" };
    let function = Function { mode, per_vertex: vertex_fog, source };
    let coordinate = number(&inputs["coord"]);
    let z = if opengl { -coordinate } else { coordinate };
    let corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        .map(|(x, y)| format!("(position: ({x}, {y}, {z:?}), {})", color_of(inputs)))
        .join(", ");
    let fog = format!("fog: (color: {}, {})", bytes(&inputs["fog_color"]), function.text(inputs));
    let draw = format!("topology: Quads, vertices: Window([{corners}]), {fog}");
    pixel(&scene(function.profile(profile), "name: \"frame\", width: 1, height: 1", "", &draw), (0, 0))
}

/// Returns a pixel of a quad on which z increases from 0 at the left edge to 1 at the right edge, 640 pixels away.
fn gradient(
    inputs: &Value,
    profile: &str,
    fog: &str,
    factors: [f64; 2],
    shade: &str,
    x: u32,
) -> Result<[u8; 4], String> {
    let vertex = |x: &str, y: &str, z: f64, factor: f64| {
        format!("(position: ({x}, {y}, {z:?}), fog: {factor:?}, {})", color_of(inputs))
    };
    let (left, right) = (value(inputs, "z_left", 0.0), value(inputs, "z_right", 1.0));
    let corners = [
        vertex("0.5", "0", left, factors[0]),
        vertex("640.5", "0", right, factors[1]),
        vertex("640.5", "1", right, factors[1]),
        vertex("0.5", "1", left, factors[0]),
    ];
    let fog = format!("fog: (color: {}{fog})", bytes(&inputs["fog_color"]));
    let draw = format!("topology: Quads, vertices: Window([{}]), shade_model: {shade}, {fog}", corners.join(", "));
    pixel(&scene(profile, "name: \"frame\", width: 640, height: 1", "", &draw), (x, 0))
}

fn across(inputs: &Value, profile: &str) -> Result<[u8; 4], String> {
    let mode = mode(inputs["mode"].as_str().unwrap()).ok_or("no mode")?;
    let per_vertex = inputs["vertex_fog"] == true;
    let function = Function { mode, per_vertex, source: if per_vertex { "EyePlaneAbsolute" } else { "Depth" } };
    let x = (640.0 * number(&inputs["coord"])).round() as u32;
    gradient(inputs, function.profile(profile), &format!(", {}", function.text(inputs)), [1.0; 2], "Smooth", x)
}

/// Table fog takes precedence over vertex fog. Without either, the factors of the vertices are used, which are the alpha of their specular
/// colour.
fn interpolated(inputs: &Value, profile: &str) -> Result<[u8; 4], String> {
    let [vertex, table] = ["vertex_mode", "table_mode"].map(|name| mode(inputs[name].as_str().unwrap()));
    let function = match (vertex, table) {
        (_, Some(mode)) => Some(Function { mode, per_vertex: false, source: "Depth" }),
        (Some(mode), None) => Some(Function { mode, per_vertex: true, source: "EyePlaneAbsolute" }),
        (None, None) => None,
    };
    let factors = ["left", "right"].map(|side| number(&inputs[format!("specular_alpha_{side}")]) / 255.0);
    let shade = if inputs["shade"] == "FLAT" { "Flat" } else { "Smooth" };
    let text = function.as_ref().map_or(String::new(), |function| format!(", {}", function.text(inputs)));
    let profile = function.as_ref().map_or(profile, |function| function.profile(profile));
    gradient(inputs, profile, &text, factors, shade, (640.0 * number(&inputs["x"])).round() as u32)
}

/// Returns a pixel with table fog, for vertices that are already transformed, or that a view and a projection transform.
fn transformed(inputs: &Value, profile: &str) -> Result<[u8; 4], String> {
    let mode = mode(inputs["mode"].as_str().unwrap()).ok_or("no mode")?;
    // A projection whose last column is not that of a parallel projection selects w.
    let perspective = number(&inputs["proj_44"]) != 1.0;
    let function = Function { mode, per_vertex: false, source: if perspective { "W" } else { "Depth" } };
    let z = number(&inputs["position_z"]);
    let corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)];
    let vertices = if inputs["vertex"] == "RHW" {
        let w = 1.0 / number(&inputs["position_w"]);
        let vertex = |(x, y): (i32, i32)| {
            format!("(position: ({}, {}, {z:?}, {w:?}), {})", x.max(0), y.max(0), color_of(inputs))
        };
        format!("Window([{}])", corners.map(vertex).join(", "))
    } else {
        let (along_z, w) = (number(&inputs["view_33"]), number(&inputs["view_44"]) * number(&inputs["proj_44"]));
        let vertex = |(x, y): (i32, i32)| format!("(position: ({x}, {y}, {z:?}), {})", color_of(inputs));
        format!(
            "Matrix(matrix: Rows(({w:?}, 0, 0, 0), (0, {w:?}, 0, 0), (0, 0, {along_z:?}, 0), (0, 0, 0, {w:?})), vertices: [{}])",
            corners.map(vertex).join(", ")
        )
    };
    let fog = format!("fog: (color: {}, {})", bytes(&inputs["fog_color"]), function.text(inputs));
    let draw = format!("topology: Quads, vertices: {vertices}, {fog}");
    pixel(&scene(function.profile(profile), "name: \"frame\", width: 1, height: 1", "", &draw), (0, 0))
}

/// Returns a pixel with z fog, for transformed vertices with a reciprocal w, which has no effect. 0 stands for the largest possible w.
fn with_w(inputs: &Value, profile: &str) -> Result<[u8; 4], String> {
    let function = Function { mode: "Linear", per_vertex: false, source: "Depth" };
    let (z, rhw) = (number(&inputs["coord"]), number(&inputs["rhw"]));
    let w = if rhw > 0.0 { 1.0 / rhw } else { 1_048_576.0 };
    let corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        .map(|(x, y)| format!("(position: ({x}, {y}, {z:?}, {w:?}), {})", color_of(inputs)))
        .join(", ");
    let test = if inputs["z_test"] == true { "depth_test: (function: LessOrEqual)," } else { "" };
    let fog = format!("fog: (color: {}, {})", bytes(&inputs["fog_color"]), function.text(inputs));
    let draw = format!("topology: Quads, vertices: Window([{corners}]), {test} {fog}");
    pixel(&scene(function.profile(profile), "name: \"frame\", width: 1, height: 1, depth: Z24S8", "", &draw), (0, 0))
}
