//! Runs cases of blending and of the alpha test.

use super::third_party::{Kind, blend_factor, bytes, cleared, color, differs, named, pixel, run};
use super::{quad, scene};
use ninebit::state::{BlendEquation, CompareFunction};
use serde_json::Value;

fn drawn(profile: &str, format: &str, source: &str, inputs: &Value, rest: &str) -> String {
    let corner = format!("diffuse: {source}");
    let target = format!("name: \"frame\", width: 1, height: 1, format: {format}{}", cleared(inputs));
    let quad = quad(1.0, 1.0, [0; 4].map(|_| corner.clone()));
    scene(profile, &target, "", &format!("{quad}, {rest}"))
}

#[test]
fn every_case_of_blending() {
    run(&Kind { file: "blend", name: "blend" }, blending);
}

pub(crate) fn blending(case: &Value, profile: &str) -> Option<String> {
    let inputs = &case["inputs"];
    let equation = match inputs["op"].as_str().unwrap() {
        "REVSUBTRACT" => "ReverseSubtract",
        name => named::<BlendEquation>(name),
    };
    let [source, destination] =
        ["src", "dst"].map(|side| blend_factor(inputs[format!("{side}_factor")].as_str().unwrap()));
    let constant = color(inputs, "constant").unwrap_or("(0, 0, 0, 0)".to_owned());
    let format = if inputs["target_has_alpha"] == false { "X8R8G8B8O" } else { "A8R8G8B8" };
    let blend = format!(
        "blend: (equation: {equation}, source: {source}, destination: {destination}), blend_constant: {constant}"
    );
    differs(case, pixel(&drawn(profile, format, &color(inputs, "src").unwrap(), inputs, &blend), (0, 0)))
}

#[test]
fn every_case_of_the_alpha_test() {
    run(&Kind { file: "alpha-test", name: "alpha_test" }, alpha_test);
}

pub(crate) fn alpha_test(case: &Value, profile: &str) -> Option<String> {
    let inputs = &case["inputs"];
    let function = match inputs["func"].as_str().unwrap() {
        "LESSEQUAL" => "LessOrEqual",
        "GREATEREQUAL" => "GreaterOrEqual",
        name => named::<CompareFunction>(name),
    };
    let test = format!("alpha_test: (function: {function}, reference: {})", inputs["ref"]);
    differs(case, pixel(&drawn(profile, "A8R8G8B8", &bytes(&inputs["fragment"]), inputs, &test), (0, 0)))
}
