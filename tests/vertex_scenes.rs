//! Tests vertex programs and meshes in scenes by what reaches the rasteriser.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, reason = "a test fails by panicking")]

use ninebit::engine::{RenderOptions, render, trace};
use ninebit::limits::Limits;
use ninebit::state::{Vertex, VertexColor, Vertices};
use ninebit_report::explain::{explain, explanation_json, explanation_text};
use ninebit_scene::{LoadedScene, parse};
use std::path::Path;

#[track_caller]
fn loaded(text: &str) -> LoadedScene {
    parse(text, Path::new("tests/scene.ron"), &Limits::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn refused(text: &str) -> Vec<&'static str> {
    let Err(error) = parse(text, Path::new("tests/scene.ron"), &Limits::default()) else { panic!("accepted") };
    error.diagnostics.iter().map(|finding| finding.code).collect()
}

/// Returns a scene whose draw has these fields.
fn scene(profile: &str, fields: &str) -> String {
    format!("(version: 1, profile: {profile}, targets: [(width: 64, height: 64)], draws: [({fields})])")
}

const TRIANGLE: &str = "vertices: [(position: (-1, -1, 0.5), diffuse: (255, 0, 51), t0: (0.25, 0.5)), (position: (3, -1, 0.5)), (position: (-1, 3, 0.5))]";

fn vertices(program: &str) -> Vertices {
    loaded(&scene("Nv2a", &format!("vertices: Program({TRIANGLE}, {program})"))).scene.draws[0].vertices.clone()
}

#[test]
fn outputs_reach_the_rasteriser() {
    let made = vertices(
        "constants: { c0: Matrix(Translate(1, 2, 3)), c9: (0.5, 2), 10: Color((255, 51, 0)), c11: Color(Float(0.5, 0, 0, 0.25)) }, \
         text: \"m4x4 oPos, v0, c0 \\n mad oD0.xyz, v5, c9.x, c9.x \\n mov oD1, c10 \\n mov oT0.xy, v7 \\n mov oT3, c11 \\n mov oFog, c9.y\"",
    );
    let vertex = made.at(0);
    assert_eq!(vertex.position, [0.0, 1.0, 3.5, 1.0]);
    assert_eq!(vertex.diffuse, VertexColor::Floats([1.0, 0.5, 0.6, 1.0]));
    assert_eq!(vertex.specular, VertexColor::Floats([1.0, 0.2, 0.0, 1.0]));
    let sets = [[0.25, 0.5, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0], [0.5, 0.0, 0.0, 0.25]];
    assert_eq!(vertex.texture_coordinates, sets);
    assert_eq!(vertex.fog, 1.0);
    let bare = vertices("text: \"mov oPos, v0\"").at(0);
    assert_eq!(bare, Vertex { position: [-1.0, -1.0, 0.5, 1.0], ..Vertex::default() });
}

#[test]
fn a_program_that_only_multiplies_is_the_fixed_pipe() {
    let mesh = "mesh: Sphere(slices: 12, stacks: 6, repeat: (2, 1))";
    let matrix = "Product(Frustum(left: -0.5, right: 0.5, bottom: -0.5, top: 0.5, near: 1, far: 10), LookAt(eye: (1, 1, 3), center: (0, 0, 0)))";
    let fixed = loaded(&scene("Nv2a", &format!("vertices: Matrix(matrix: {matrix}, {mesh}, diffuse: Tangent)")));
    let program = loaded(&scene(
        "Nv2a",
        &format!(
            "vertices: Program({mesh}, constants: {{ c0: Matrix({matrix}), c4: (0.5, 0.5, 0.5) }}, inputs: (v8: Tangent), text: \
             \"m4x4 oPos, v0, c0 \\n mad oD0.xyz, v8, c4, c4 \\n mov oT0.xy, v7 \\n mov oT1.xy, v7 \\n mov oT2.xy, v7 \\n mov oT3.xy, v7\")"
        ),
    ));
    let frames =
        [&fixed, &program].map(|scene| render(&scene.plan, &RenderOptions::default()).surfaces[0].words.clone());
    assert_eq!(fixed.scene.draws[0].indices, program.scene.draws[0].indices);
    for (a, b) in fixed.scene.draws[0].vertices.iter().zip(program.scene.draws[0].vertices.iter()) {
        assert_eq!((a.position, a.texture_coordinates), (b.position, b.texture_coordinates));
    }
    assert_eq!(frames[0], frames[1]);
}

#[test]
fn direct3d_depths_begin_at_zero() {
    let depth = |fields: &str| {
        let text = scene("Nv2a", &format!("vertices: Program({TRIANGLE}, {fields} text: \"mov oPos, v0\")"));
        let ninebit::state::Positions::Clip(viewport) = loaded(&text).scene.draws[0].positions else { panic!() };
        ninebit::raster::project::window([0.0, 0.0, 0.5, 1.0], &viewport)[2]
    };
    assert_eq!(depth(""), 0.75);
    assert_eq!(depth("clip_depth: ZeroToOne,"), 0.5);
    assert_eq!(depth("clip_depth: ZeroToOne, viewport: (near: 0.5, far: 1),"), 0.75);
}

#[test]
fn fog_comes_from_the_program() {
    let fog = |profile: &str, fog: &str, program: &str| {
        let fields = format!(
            "vertices: Program({TRIANGLE}, constants: {{ c0: (12, 0, 0) }}, text: \"mov oPos, v0 \\n {program}\"), fog: {fog}"
        );
        scene(profile, &fields)
    };
    let linear = "(mode: Linear, start: 8, end: 16)";
    let written = "mov oFog.x, c0.x";
    assert_eq!(loaded(&fog("Nv2a", linear, written)).scene.draws[0].vertices.at(0).fog, 12.0);
    assert_eq!(loaded(&fog("Nv10", linear, written)).scene.draws[0].vertices.at(0).fog, 1.5);
    let beyond = "rcp oFog.x, c0.y";
    assert_eq!(loaded(&fog("Nv2a", linear, beyond)).scene.draws[0].vertices.at(0).fog, f32::INFINITY);
    assert_eq!(loaded(&fog("Nv2a", "(color: (9, 9, 9))", beyond)).scene.draws[0].vertices.at(0).fog, 1.0);
    let nothing = "rcp r0.x, c0.y \\n add oFog.x, r0.x, -r0.x";
    assert!(loaded(&fog("Nv2a", linear, nothing)).scene.draws[0].vertices.at(0).fog.is_nan());
    assert_eq!(refused(&fog("Nv2a", "(color: (9, 9, 9))", nothing)), ["NB0207"]);
    assert_eq!(loaded(&fog("Nv2a", "(color: (9, 9, 9))", written)).scene.draws[0].vertices.at(0).fog, 1.0);
    assert_eq!(refused(&fog("Nv2a", linear, "mov oD0, c0")), ["NB0389"]);
    assert_eq!(refused(&fog("Nv2a", "(mode: Linear, coordinate_source: EyePlane)", written)), ["NB0389"]);
}

#[test]
fn people_see_the_program() {
    let text = scene(
        "Nv10",
        &format!(
            "vertices: Program({TRIANGLE}, constants: {{ c0: (0.25, 0.5, 0.75, 1) }}, text: \"m4x4 r0, v0, c4 // rows \\n def c4, 1,0,0,0 \\n def c5, 0,1,0,0 \\n def c6, 0,0,1,0 \\n def c7, 0,0,0,1 \\n mov oPos, r0 \\n MOV oD0, c00\")"
        ),
    );
    let scene = loaded(&text);
    let draws = explain(&scene.scene, &scene.plan);
    let said = explanation_text(&scene.plan, &draws, None);
    assert!(
        said.contains("vertex program: 3 instructions, 6 slots, for each of 3 vertices, run by the driver"),
        "{said}"
    );
    assert!(said.contains("    mov oD0, c0\n"), "{said}");
    let json: serde_json::Value = serde_json::from_str(&explanation_json(&scene.plan, &draws, None)).unwrap();
    assert_eq!(json["draws"][0]["vertex_program"]["slots"], 6);
    let traced = trace(&scene.plan, 0, (20, 40), None).unwrap();
    let notes: Vec<_> = traced.draws[0].steps.iter().filter_map(|step| step.note.clone()).collect();
    assert!(notes.contains(&"from oD0.y = 0.5".to_owned()), "{notes:?}");
}

#[test]
fn listed_triangles_are_a_mesh() {
    let mesh = "mesh: Triangles(vertices: [(position: (0, 1), t0: (0, 0)), (position: (1, 1), t0: (1, 0)), (position: (2, 1), t0: (0, 0)), \
                (position: (0, 0), t0: (0, 1)), (position: (1, 0), t0: (1, 1)), (position: (2, 0), t0: (0, 1))], \
                indices: [0, 3, 4, 0, 4, 1, 1, 4, 5, 1, 5, 2])";
    let text = scene(
        "Nv2a",
        &format!(
            "vertices: Program({mesh}, inputs: (v8: Tangent, v9: Binormal), text: \"mov oPos, v0 \\n mov oT0, v8 \\n mov oT1, v9\")"
        ),
    );
    let draw = &loaded(&text).scene.draws[0];
    assert_eq!((draw.vertices.len(), draw.indices.len()), (8, 12));
    assert_eq!(draw.vertices.at(0).texture_coordinates[0], [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(draw.vertices.at(2).texture_coordinates[0], [-1.0, 0.0, 0.0, 1.0]);
    assert!(draw.vertices.iter().all(|vertex| vertex.texture_coordinates[1] == [0.0, 1.0, 0.0, 1.0]));
}
