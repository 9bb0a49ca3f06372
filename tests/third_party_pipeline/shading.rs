//! Runs cases of flat and smooth colours in strips and lists of Direct3D, whose pixel centres lie at whole numbers.

use super::scene;
use super::third_party::{Kind, bytes, cleared, differs, pixel, run};

#[test]
fn every_case_of_shading() {
    run(&Kind { file: "shading", name: "shade" }, |case, profile| {
        let inputs = &case["inputs"];
        let [width, height] = [0, 1].map(|n| inputs["size"][n].as_u64().unwrap());
        let [x, y] = [0, 1].map(|n| inputs["pixel"][n].as_u64().unwrap() as u32);
        let corner = |name: &str| {
            let (right, bottom) = (name.ends_with('r'), name.starts_with('b'));
            let at = |far: bool, size: u64| format!("{}.5", if far { size } else { 0 });
            let color = bytes(&inputs["corner_colors"][name]);
            format!("(position: ({}, {}), diffuse: {color})", at(right, width), at(bottom, height))
        };
        let (topology, corners): (_, &[&str]) = if case["id"].as_str().unwrap().contains("strip") {
            ("TriangleStrip", &["bl", "tl", "br", "tr"])
        } else {
            ("Triangles", &["bl", "tl", "br", "br", "tl", "tr"])
        };
        let vertices: Vec<String> = corners.iter().map(|name| corner(name)).collect();
        let mode = if inputs["mode"] == "FLAT" { "Flat" } else { "Smooth" };
        let draw = format!(
            "topology: {topology}, vertices: Window([{}]), shade_model: {mode}, provoking_vertex: First, \
             scissor: (x: {x}, y: {y}, width: 1, height: 1)",
            vertices.join(", ")
        );
        let target = format!("name: \"frame\", width: {width}, height: {height}{}", cleared(inputs));
        differs(case, pixel(&scene(profile, &target, "", &draw), (x, y)))
    });
}
