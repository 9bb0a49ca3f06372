//! Tests scenes with programs of other APIs.

use crate::repository::at;
use ninebit::engine::{self, RenderOptions};
use ninebit::limits::Limits;
use ninebit::state::TextureImage;
use ninebit_report::explain::{explain, explanation_text};
use ninebit_report::{trace_json, trace_text};
use ninebit_scene::{self as scene, LoadedScene};
use std::path::Path;

fn load(name: &str) -> LoadedScene {
    let path = format!("vectors/scenes/programs/{name}.ron");
    scene::load(&at(&path), &Limits::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_surface_in_every_notation_has_the_same_bytes() {
    let words =
        |loaded: &LoadedScene| engine::render(&loaded.plan, &RenderOptions::default()).surfaces[0].words.clone();
    let definition = words(&load("dot3-combiners"));
    let stages = load("dot3-texture-stages");
    for name in ["dot3-texture-stages-text", "dot3-texture-stages-effect"] {
        assert_eq!(load(name).scene.draws[0].combiners, stages.scene.draws[0].combiners, "{name}");
    }
    assert_eq!(words(&stages), definition);
    let environment = load("dot3-texture-environment");
    let pasted = load("dot3-texture-environment-text");
    assert_eq!(pasted.scene.draws[0].combiners, environment.scene.draws[0].combiners);
    for name in [
        "texture-environment",
        "texture-environment-text",
        "combiner-calls",
        "combiner-text",
        "pixel-shader",
        "register-words",
    ] {
        assert_eq!(words(&load(&format!("dot3-{name}"))), definition, "{name}");
    }
}

#[test]
fn traces_and_explanations_show_both_sides() {
    let loaded = load("dot3-texture-stages");
    let trace = engine::trace(&loaded.plan, 0, (64, 64), None).unwrap();
    let text = trace_text(&loaded.plan, &trace);
    let block = "general stage 0 rgb: texture stage 0: ColorOp DotProduct3(Texture, TextureFactor)";
    assert!(text.contains(block), "{text}");
    assert!(trace_json(&loaded.plan, &trace).contains("texture stage 1: ColorOp Modulate(Current, Diffuse)"));
    let explanation = explanation_text(&loaded.plan, &explain(&loaded.scene, &loaded.plan), None);
    assert!(explanation.contains(block), "{explanation}");
    let environment = load("dot3-texture-environment");
    let explanation = explanation_text(&environment.plan, &explain(&environment.scene, &environment.plan), None);
    let part = "texture unit 0: Combine RGB Dot3RgbaArb(SourceColor of Texture, SourceColor of Constant)";
    assert!(explanation.contains(part), "{explanation}");
    let shader = load("dot3-pixel-shader");
    let trace = trace_text(&shader.plan, &engine::trace(&shader.plan, 0, (64, 64), None).unwrap());
    assert!(trace.contains("general stage 0 rgb: pixel shader: dp3_sat r0, t0_bx2, v1_bx2"), "{trace}");
    let explanation = explanation_text(&shader.plan, &explain(&shader.scene, &shader.plan), None);
    assert!(explanation.contains("general stage 1 alpha: pixel shader: mul r0, r0, v0"), "{explanation}");
}

#[test]
fn a_pixel_shader_that_moves_coordinates() {
    let text = |profile: &str, program: &str| {
        format!(
            "(version: 1, profile: {profile}, targets: [(name: \"f\", width: 2, height: 2)], textures: {{ \
             \"offsets\": (source: Solid(width: 1, height: 1, color: (0, 0, 64, 255))), \
             \"map\": (source: Ramp(width: 4, height: 1, from: (0, 0, 0), to: (255, 255, 255), axis: Horizontal)) }}, \
             draws: [(vertices: Window([(position: (0, 0)), (position: (4, 0)), (position: (0, 4))]), \
             textures: [\"offsets\", (texture: \"map\", min_filter: Nearest, mag_filter: Nearest)], \
             program: PixelShader({program}))])"
        )
    };
    let parse = |text: &str| scene::parse(text, Path::new("bump.ron"), &Limits::default());
    let shader = |more: &str| format!("text: \"ps.1.1\ntex t0\ntexbem t1, t0\nmov r0, t1\", {more}");
    let loaded = parse(&text("Nv2a", &shader("bump: { \"t1\": (matrix: (1, 0, 0, 1)) }")))
        .unwrap_or_else(|error| panic!("{error}"));
    let [r, ..] = engine::render(&loaded.plan, &RenderOptions::default()).surfaces[0].rgba8()[0];
    // Blue 64 moves the lookup by half a texture to the right, to the third of four texels.
    assert_eq!(r, 170);
    assert_eq!(parse(&text("Nv2a", &shader(""))).unwrap_err().diagnostics[0].code, "NB0378");
    let nv10 = parse(&text("Nv10", &shader("bump: { \"t1\": (matrix: (1, 0, 0, 1)) }"))).unwrap_err();
    let finding = &nv10.diagnostics[0];
    assert_eq!((finding.code, finding.message.as_str()), ("NB0340", "texbem needs the texture shader; nv10 has none"));
    assert!(finding.notes[0].contains("AddSigned"), "{finding:?}");
}

#[test]
fn a_bump_environment_map_in_a_scene() {
    let text = |profile: &str, more: &str| {
        format!(
            "(version: 1, profile: {profile}, targets: [(name: \"f\", width: 2, height: 2)], textures: {{ \
             \"offsets\": (source: Solid(width: 1, height: 1, color: (0, 0, 64, 255))), \
             \"map\": (source: Ramp(width: 4, height: 1, from: (0, 0, 0), to: (255, 255, 255), axis: Horizontal)) }}, \
             draws: [(vertices: Window([(position: (0, 0)), (position: (4, 0)), (position: (0, 4))]), \
             textures: [\"offsets\", (texture: \"map\", min_filter: Nearest, mag_filter: Nearest)], {more} \
             program: TextureStages(stages: [(color_op: BumpEnvMap, bump_matrix: (1, 0, 0, 1)), \
             (color_op: SelectArg1, color_arg1: Texture)]))])"
        )
    };
    let parse = |text: &str| scene::parse(text, Path::new("bump.ron"), &Limits::default());
    let loaded = parse(&text("Nv2a", "")).unwrap_or_else(|error| panic!("{error}"));
    let frames = engine::render(&loaded.plan, &RenderOptions::default());
    // Blue 64 moves the lookup by half a texture to the right, to the third of four texels.
    let [r, ..] = frames.surfaces[0].rgba8()[0];
    assert_eq!(r, 170);
    assert_eq!(parse(&text("Nv10", "")).unwrap_err().diagnostics[0].code, "NB0340");
    let shader = parse(&text("Nv2a", "texture_shader: [Sample, Sample],")).unwrap_err();
    assert_eq!(shader.diagnostics[0].code, "NB0352");
}

#[test]
fn camera_space_coordinates_take_a_set_that_nothing_reads() {
    let text = |more: &str| {
        format!(
            "(version: 1, profile: Nv10, textures: {{ \"t\": (source: Solid(width: 1, height: 1, color: (1, 2, 3))) }}, \
             draws: [(vertices: Window([(position: (0, 0)), (position: (4, 0)), (position: (0, 4))]), \
             textures: [\"t\", \"t\"], {more} program: TextureStages(stages: [\
             (texture_coordinate_index: CameraSpaceNormal), (color_op: Modulate, texture_coordinate_index: 0)]))])"
        )
    };
    let parse = |text: &str| scene::parse(text, Path::new("made.ron"), &Limits::default());
    let loaded = parse(&text("")).unwrap_or_else(|error| panic!("{error}"));
    let draw = &loaded.scene.draws[0];
    // Unit 1 reads set 0 as it was given, so the normals move to set 1.
    assert_eq!([0, 1].map(|unit| draw.texture_shader[unit].coordinate_set), [1, 0]);
    assert_eq!(draw.vertices.at(0).texture_coordinates[1], [0.0, 0.0, 0.0, 1.0]);
    assert_eq!(parse(&text("texgen: [CameraSpacePosition],")).unwrap_err().diagnostics[0].code, "NB0352");
}

/// Renders a quad of 8 x 8 pixels with the given fields of its draw. Returns the scene and the pixels.
fn drawn(profile: &str, textures: &str, vertex: &str, fields: &str) -> (LoadedScene, Vec<[u8; 4]>) {
    let corner = |x: i32, y: i32| format!("(position: ({x}, {y}, {}), {vertex})", f64::from(x) / 8.0);
    let text = format!(
        "(version: 1, profile: {profile}, targets: [(name: \"f\", width: 8, height: 8)], textures: {{ {textures} }}, draws: [\
         (topology: Quads, vertices: Window([{}, {}, {}, {}]), {fields})])",
        corner(0, 0),
        corner(8, 0),
        corner(8, 8),
        corner(0, 8)
    );
    let loaded =
        scene::parse(&text, Path::new("quad.ron"), &Limits::default()).unwrap_or_else(|error| panic!("{error}"));
    let shown = engine::render(&loaded.plan, &RenderOptions::default()).surfaces[0].rgba8();
    (loaded, shown)
}

const CHECKS: &str =
    "\"t\": (source: Checker(width: 8, height: 8, colors: ((255, 200, 100), (0, 10, 20))), levels: All)";

/// A texture matrix belongs to the stage, not to the coordinate set. Here one set is read with two matrices, and by a stage without one.
#[test]
fn stages_read_one_set_through_their_own_matrices() {
    let (loaded, _) = drawn(
        "Nv2a",
        CHECKS,
        "t0: (0.25, 0.5)",
        "textures: [\"t\", \"t\", \"t\"], texture_matrices: [Scale(2, 4, 1), Rows((1, 0, 3, 0), (0, 1, 5, 0), (0, 0, 1, 0), (0, 0, 0, 1)), \
         Scale(9, 9, 9)], program: TextureStages(stages: [(texture_transform_flags: Count2), \
         (color_op: Add, texture_coordinate_index: 0, texture_transform_flags: Count2), (color_op: Add, texture_coordinate_index: 0)])",
    );
    let draw = &loaded.scene.draws[0];
    let of = |unit: usize| draw.vertices.at(0).texture_coordinates[draw.texture_shader[unit].coordinate_set];
    // A matrix is applied to (s, t, 1, 0), so its third row translates.
    assert_eq!(of(0), [0.5, 2.0, 1.0, 1.0]);
    assert_eq!(of(1), [3.25, 5.5, 1.0, 1.0]);
    assert_eq!(of(2), [0.25, 0.5, 0.0, 1.0]);
    // If no stage has flags, the matrix of the set applies.
    let (loaded, _) = drawn(
        "Nv2a",
        CHECKS,
        "t0: (0.25, 0.5)",
        "textures: [\"t\"], texture_matrices: [Scale(2, 4, 1)], program: TextureStages(stages: [()])",
    );
    assert_eq!(loaded.scene.draws[0].vertices.at(0).texture_coordinates[0], [0.5, 2.0, 0.0, 1.0]);
}

/// Fog factors for each vertex and for each pixel agree within the rounding of bytes, on both chips. Distances are interpolated, and the
/// fog function is applied to the result.
#[test]
fn fog_of_vertices_and_of_pixels() {
    for mode in ["Exp, density: 4", "Exp2, density: 3", "Linear, start: 0.125, end: 0.75"] {
        let fog = |profile, more: &str| {
            let fields = format!("fog: (color: (255, 255, 255), mode: {mode}, coordinate_source: Depth{more})");
            drawn(profile, "", "diffuse: (0, 0, 0)", &fields).1
        };
        let (pixels, vertices) = (fog("Nv2a", ""), fog("Nv2a", ", evaluation: PerVertex"));
        for other in [vertices, fog("Nv10", "")] {
            for (one, other) in pixels.iter().flatten().zip(other.iter().flatten()) {
                assert!(one.abs_diff(*other) <= 2, "{mode}: {one} {other}");
            }
        }
        // The fog function is not linear between the vertices.
        let [middle, ..] = pixels[4];
        if mode.starts_with("Exp,") {
            // The factor in the middle is e^-2.
            assert!((i32::from(middle) - 227).abs() < 8, "{middle}");
        }
    }
}

/// A texture with `first_level: 1` has level 1 of the whole texture and the levels after it.
#[test]
fn first_levels_are_left_out() {
    let (whole, _) = drawn("Nv2a", CHECKS, "t0: (0.25, 0.5)", "textures: [\"t\"]");
    let later = CHECKS.replace("levels: All", "levels: All, first_level: 1");
    let (later, _) = drawn("Nv2a", &later, "t0: (0.25, 0.5)", "textures: [\"t\"]");
    let texels = |loaded: &LoadedScene| match &loaded.scene.textures[0].image {
        TextureImage::Texels(texels) => (texels.width, texels.height, texels.levels, texels.words.clone()),
        TextureImage::Target { .. } | TextureImage::Depth { .. } => panic!("texels were given"),
    };
    let ((width, height, levels, words), rest) = (texels(&whole), texels(&later));
    assert_eq!((width, height, levels), (8, 8, 4));
    assert_eq!((rest.0, rest.1, rest.2, &rest.3[..]), (4, 4, 3, &words[64..]));
}

/// With an infinite viewer a flat mirror reflects a single direction. With a local viewer the direction varies.
#[test]
fn a_viewer_far_away_sees_one_reflection() {
    let places = |viewer: &str| {
        let fields = format!("textures: [\"t\"], texgen: [CameraSpaceReflectionVector], {viewer}");
        let (loaded, _) = drawn("Nv2a", CHECKS, "normal: (0, 0, 1)", &fields);
        [0, 2].map(|vertex: usize| loaded.scene.draws[0].vertices.at(vertex).texture_coordinates[0])
    };
    let [first, last] = places("");
    assert_ne!(first, last);
    assert_eq!(places("viewer: Local"), [first, last]);
    assert_eq!(places("viewer: Infinite"), [[0.0, 0.0, 1.0, 1.0]; 2]);
    assert_eq!(places("viewer: Infinite(0, 0, 2)"), [[0.0, 0.0, -1.0, 1.0]; 2]);
}

/// Direct3D tests s, t and r, whereas the chip tests q as well.
#[test]
fn texkill_looks_at_three_coordinates() {
    let shown = |t0: &str, more: &str, program: &str| {
        let fields = format!("{more} program: PixelShader(\"ps.1.1\n{program}\nmov r0, v0\")");
        let (loaded, pixels) =
            drawn("Nv2a", CHECKS, &format!("diffuse: (255, 255, 255), t0: {t0}, t1: (0.5, 0.5, 0.5, -1)"), &fields);
        (loaded, pixels[9])
    };
    let white = [255; 4];
    for (t0, kept) in [
        ("(1, 1, 1, -1)", true),
        ("(0, 0, 0, -0.5)", true),
        ("(1, 1, -1, 1)", false),
        ("(-1, 1, 1, 1)", false),
        ("(1, -1, 1, -1)", false),
    ] {
        assert_eq!(shown(t0, "", "texkill t0").1 == white, kept, "{t0}");
    }
    // Another unit that reads the same set keeps its q.
    let fields = "textures: [(texture: \"t\", coordinates: 1), (texture: \"t\", coordinates: 1)],";
    let (loaded, pixel) = shown("(1, 1, 1, 1)", fields, "tex t0\ntexkill t1");
    assert_eq!(pixel, white);
    let draw = &loaded.scene.draws[0];
    let q =
        [0, 1].map(|unit: usize| draw.vertices.at(0).texture_coordinates[draw.texture_shader[unit].coordinate_set][3]);
    assert_eq!(q, [-1.0, 1.0]);
}

/// A shader that is pasted from C source is the text between the quotes.
#[test]
fn shaders_out_of_c_are_the_same() {
    let program = |text: &str| {
        let fields = format!("textures: [\"t\"], program: PixelShader(r##\"{text}\"##)");
        drawn("Nv2a", CHECKS, "diffuse: (255, 200, 100), t0: (0.25, 0.5)", &fields).1
    };
    let plain = program("ps.1.1\ndef c0, 0.5, 0.5, 0.5, 1\ntex t0\nmul r0, t0, v0\nmul r0, r0, c0");
    let quoted = program(
        "#define HALF \"c0\"\nconst char shader[] = // darker\n  \"ps.1.1\\n\"\n  \"def \" HALF \", 0.5, 0.5, 0.5, 1\\n\"\n  \"tex t0 ; base\\n\"\n  \
         \"mul r0, t0, v0\\n\"\n  \"mul r0, r0, \" HALF \"\\n\";",
    );
    let named = program(
        "#define HALF c0\n#define BASE t0\nps.1.1\ndef HALF, 0.5, 0.5, 0.5, 1\ntex BASE\nmul r0, BASE, v0\nmul r0, r0, HALF",
    );
    assert_eq!(quoted, plain);
    assert_eq!(named, plain);
    let vertices = |text: &str| {
        let scene = format!(
            "(version: 1, profile: Nv2a, targets: [(name: \"f\", width: 8, height: 8)], draws: [(vertices: Program(text: r##\"{text}\"##, \
             vertices: [(position: (-1, -1)), (position: (1, -1)), (position: (0, 1))], inputs: (v0: Position)))])"
        );
        let loaded = scene::parse(&scene, Path::new("program.ron"), &Limits::default())
            .unwrap_or_else(|error| panic!("{error}"));
        engine::render(&loaded.plan, &RenderOptions::default()).surfaces[0].rgba8()
    };
    let plain = vertices("vs.1.1\nmov oPos, v0\nmov oD0, v0");
    assert_eq!(vertices("\"vs.1.1\\n\"\n\"mov oPos, v0\\n\"\n\"mov oD0, v0\\n\""), plain);
    assert_eq!(vertices("#define OUT oPos, v0\nvs.1.1\nmov OUT\nmov oD0, v0"), plain);
}
