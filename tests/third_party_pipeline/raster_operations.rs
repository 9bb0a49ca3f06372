//! Blending and the alpha test.

use super::third_party::{Kind, blend_factor, bytes, differs, floats, named, pixel, run};
use super::{quad, scene};
use ninebit::state::{BlendEquation, CompareFunction};
use serde_json::Value;

/// A colour under either name, of floats or bytes.
fn color(inputs: &Value, name: &str) -> String {
    let exact = &inputs[format!("{name}_f")];
    if exact.is_array() { floats(exact) } else { bytes(&inputs[name]) }
}

fn drawn(profile: &str, format: &str, source: &str, destination: &str, rest: &str) -> String {
    let corner = format!("diffuse: {source}");
    let target = format!("name: \"frame\", width: 1, height: 1, format: {format}, clear: (color: {destination})");
    let quad = quad(1.0, 1.0, [0; 4].map(|_| corner.clone()));
    scene(profile, &target, "", &format!("{quad}, {rest}"))
}

#[test]
fn every_case_of_blending() {
    run(&Kind { file: "blend", name: "blend" }, |case, profile| {
        let inputs = &case["inputs"];
        let equation = match inputs["op"].as_str().unwrap() {
            "REVSUBTRACT" => "ReverseSubtract",
            name => named::<BlendEquation>(name),
        };
        let [source, destination] =
            ["src", "dst"].map(|side| blend_factor(inputs[format!("{side}_factor")].as_str().unwrap()));
        let constant = color_or(inputs, "constant", "(0, 0, 0, 0)");
        let format = if inputs["target_has_alpha"] == false { "X8R8G8B8O" } else { "A8R8G8B8" };
        let blend = format!(
            "blend: (equation: {equation}, source: {source}, destination: {destination}), blend_constant: {constant}"
        );
        differs(case, pixel(&drawn(profile, format, &color(inputs, "src"), &color(inputs, "dst"), &blend), (0, 0)))
    });
}

fn color_or(inputs: &Value, name: &str, default: &str) -> String {
    if inputs[name].is_array() || inputs[format!("{name}_f")].is_array() {
        color(inputs, name)
    } else {
        default.to_owned()
    }
}

#[test]
fn every_case_of_the_alpha_test() {
    run(&Kind { file: "alpha-test", name: "alpha_test" }, |case, profile| {
        let inputs = &case["inputs"];
        let function = match inputs["func"].as_str().unwrap() {
            "LESSEQUAL" => "LessOrEqual",
            "GREATEREQUAL" => "GreaterOrEqual",
            name => named::<CompareFunction>(name),
        };
        let test = format!("alpha_test: (function: {function}, reference: {})", inputs["ref"]);
        let text = drawn(profile, "A8R8G8B8", &bytes(&inputs["fragment"]), &bytes(&inputs["framebuffer"]), &test);
        differs(case, pixel(&text, (0, 0)))
    });
}
