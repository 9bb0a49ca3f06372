//! Runs cases of public test suites for everything around the combiners: coordinates, texture units, fog, raster operations. Each case is
//! drawn as a scene with the terms of the interface that it names. `common/third_party.rs` describes how cases are run.
#![allow(
    clippy::unwrap_used,
    clippy::float_arithmetic,
    reason = "a test fails by panicking; colours and coordinates of suites are floats"
)]

#[path = "third_party_pipeline/coordinates.rs"]
mod coordinates;
#[path = "third_party_pipeline/fog.rs"]
mod fog;
#[path = "third_party_pipeline/raster_operations.rs"]
pub(crate) mod raster_operations;
#[path = "third_party_pipeline/shading.rs"]
mod shading;
#[path = "third_party_pipeline/texture_units.rs"]
pub(crate) mod texture_units;
use crate::repository::at;
use crate::third_party;

use serde_json::Value;

/// Returns the fields of a quad over a target of the given size. Each corner has fields of its own.
fn quad(width: f64, height: f64, fields: [String; 4]) -> String {
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    let vertex = |((x, y), fields): ((f64, f64), String)| format!("(position: ({x:?}, {y:?}), {fields})");
    let vertices: Vec<String> = corners.into_iter().zip(fields).map(vertex).collect();
    format!("topology: Quads, vertices: Window([{}])", vertices.join(", "))
}

/// Returns a scene of one draw on one target. `head` has further fields of the scene.
fn scene(profile: &str, target: &str, head: &str, draw: &str) -> String {
    format!("(version: 1, profile: {profile}, {head} targets: [({target})], draws: [({draw})])")
}

/// Returns a number of a case.
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

/// Returns a list of numbers of a case.
fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

/// Of all cases that apply to the chips, at most one in twenty may be listed as different.
#[test]
fn few_cases_are_listed_as_different() {
    let document = std::fs::read_to_string(at("docs/evidence/known-differences.md")).unwrap();
    let (mut cases, mut listed) = (0, 0);
    for entry in std::fs::read_dir(at("vectors/third-party")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "json") {
            continue;
        }
        let file: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        for case in file["cases"].as_array().unwrap().iter().filter(|case| case["profile"] != "none") {
            cases += 1;
            listed += usize::from(document.contains(&format!("`{}`", case["id"].as_str().unwrap())));
        }
    }
    assert!(cases > 600 && 20 * listed <= cases, "{listed} of {cases}");
}
