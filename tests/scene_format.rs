//! The document of the scene format, checked; and what scenes become.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use ninebit::engine::{self, RenderOptions};
use ninebit::limits::{self, Limits};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::{
    AddressMode, Blend, BlendEquation, BlendFactor, Component, Cull, DepthBuffer, DepthFormat, Filter, FinalRegister,
    InputMapping, Positions, Profile, Register, SurfaceFormat, TextureFormat, TextureImage, Topology, VertexColor,
};
use ninebit_scene::{self as scene, Loaded, VertexSpans, fields};

fn parse(text: &str) -> Loaded {
    scene::parse(text, Path::new("test.ron"), &Limits::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// A scene of one draw with these fields beside a triangle.
fn draw(profile: &str, top: &str, fields: &str) -> Loaded {
    parse(&format!(
        "(version: 1, profile: {profile}, {top} draws: [(vertices: Window([(position: (0, 0)), (position: (0, 9)), \
         (position: (9, 9))]), {fields})])"
    ))
}

#[test]
fn every_example_of_the_document_is_accepted_without_warnings() {
    let document = fs::read_to_string("docs/scene-format.md").unwrap();
    let examples: Vec<&str> =
        document.split("```ron\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert!(examples.len() >= 3);
    for example in examples {
        let loaded = parse(example);
        assert_eq!(loaded.render_warnings(false), "");
        // Every example shows something.
        let plan = Plan::compile(&loaded.scene, &PlanOptions::default()).unwrap();
        let frames = engine::render(&plan, &RenderOptions::default());
        let words = &frames.surfaces[0].words;
        assert!(words.iter().any(|word| *word != words[0]) || words[0] != 0xff00_0000, "blank: {example}");
    }
}

/// The tables of fields are made from the declarations that the reader reads: `<!-- generated: Fog -->`, or several structures with what each is
/// called in a scene. `BLESS=1` writes them anew.
#[test]
fn the_tables_of_fields_are_those_of_the_declarations() {
    const PAGE: &str = "docs/scene-format.md";
    let page = fs::read_to_string(PAGE).unwrap();
    let mut made = String::new();
    let mut structures = Vec::new();
    let (mut rest, end) = (page.as_str(), "<!-- /generated -->");
    while let Some((before, behind)) = rest.split_once("<!-- generated: ") {
        let (of, behind) = behind.split_once(" -->\n").unwrap();
        let list: Vec<_> = of.split(", ").map(|one| one.split_once('=').unwrap_or((one, one))).collect();
        let table = match of {
            "codes" => fields::codes(),
            _ => fields::table(&list).unwrap_or_else(|| panic!("no structure {of}")),
        };
        structures.extend(list.iter().map(|(_, structure)| *structure).filter(|_| of != "codes"));
        made += &format!("{before}<!-- generated: {of} -->\n{table}{end}");
        rest = behind.split_once(end).unwrap().1;
    }
    made += rest;
    structures.sort_unstable();
    let mut declared = fields::structures();
    declared.sort_unstable();
    assert_eq!(structures, declared, "each structure has its place in the page, once");
    if crate::settings::bless() {
        fs::write(PAGE, &made).unwrap();
    } else {
        snapbox::assert_data_eq!(page, made);
    }
}

#[test]
fn the_document_names_every_limit_field_and_word() {
    let document = fs::read_to_string("docs/scene-format.md").unwrap();
    // The help of an unknown field lists the fields of its place: each of them must be described.
    let places = [
        "(x: 1)",
        "(version: 1, profile: Nv2a, names: (x: 1))",
        "(version: 1, profile: Nv2a, targets: [(x: 1)])",
        "(version: 1, profile: Nv2a, targets: [(clear: (x: 1))])",
        "(version: 1, profile: Nv2a, textures: { \"t\": (x: 1) })",
        "(version: 1, profile: Nv2a, draws: [(x: 1)])",
        "(version: 1, profile: Nv2a, draws: [(vertices: Window([(x: 1)]))])",
        "(version: 1, profile: Nv2a, draws: [(vertices: Matrix(x: 1))])",
        "(version: 1, profile: Nv2a, draws: [(vertices: Program(x: 1))])",
        "(version: 1, profile: Nv2a, draws: [(textures: [(x: 1)])])",
        "(version: 1, profile: Nv2a, draws: [(fog: (x: 1))])",
        "(version: 1, profile: Nv2a, draws: [(topology: x)])",
        "(version: 1, profile: Nv2a, draws: [(cull: x)])",
        "(version: 1, profile: Nv2a, draws: [(program: x)])",
        "(version: 1, profile: Nv2a, draws: [(program: Combiners(x: 1))])",
        "(version: 1, profile: Nv2a, draws: [(program: Combiners(stages: [(x: 1)]))])",
        "(version: 1, profile: Nv2a, draws: [(program: Combiners(stages: [(rgb: (x: 1))]))])",
        "(version: 1, profile: Nv2a, draws: [(program: Combiners(stages: [(rgb: (a: x))]))])",
        "(version: 1, profile: Nv2a, draws: [(program: Combiners(stages: [()], final_combiner: (x: 1)))])",
        "(version: 1, profile: Nv2a, draws: [(program: Combiners(stages: [()], final_combiner: (a: x)))])",
        "(version: 1, profile: Nv2a, draws: [(blend: (equation: x))])",
        "(version: 1, profile: Nv2a, draws: [(blend: (source: x))])",
        "(version: 1, profile: Nv2a, draws: [(depth_test: (function: x))])",
        "(version: 1, profile: Nv2a, targets: [(format: x)])",
        "(version: 1, profile: Nv2a, textures: { \"t\": (format: x) })",
        "(version: 1, profile: Nv2a, textures: { \"t\": (source: x) })",
        "(version: 1, profile: Nv2a, names: (matrices: { \"m\": x }))",
        "(version: 1, profile: Nv2a, names: (meshes: { \"m\": x }))",
    ];
    for place in places {
        let error = scene::parse(place, Path::new("x.ron"), &Limits::default()).unwrap_err();
        let help = error.diagnostics.iter().filter_map(|finding| finding.help.as_deref());
        let known =
            help.clone().find(|help| help.contains("ields here") || help.contains("ne of") || help.contains("All of"));
        let known = known.unwrap_or_else(|| panic!("{place}: {error}"));
        for word in known.split('`').skip(1).step_by(2).filter(|word| *word != "UnsignedInvert") {
            assert!(document.contains(word), "docs/scene-format.md says nothing of `{word}`");
        }
    }
    assert_eq!(limits::table(&Limits::default())[0], ("scene_bytes", 8 << 20, "bytes of the scene file"));
}

#[test]
fn what_is_left_out_has_its_default() {
    let loaded = draw("Nv10", "", "");
    let (scene, draw) = (&loaded.scene, &loaded.scene.draws[0]);
    let target = &scene.targets[0];
    assert_eq!(
        (
            scene.profile,
            target.name.as_str(),
            target.width,
            target.height,
            target.format,
            target.clear_color,
            target.depth
        ),
        (Profile::Nv10, "frame", 640, 480, SurfaceFormat::A8R8G8B8, [0, 0, 0, 255], None)
    );
    assert_eq!((draw.name.as_str(), &draw.indices[..], draw.topology), ("draw 0", &[0, 1, 2][..], Topology::Triangles));
    assert_eq!((draw.positions, draw.cull, draw.perspective), (Positions::Window, Cull::None, true));
    assert_eq!(draw.vertices.at(1).position, [0.0, 9.0, 0.0, 1.0]);
    assert_eq!(draw.vertices.at(1).diffuse, VertexColor::Bytes([255; 4]));
    assert_eq!(draw.vertices.at(1).specular, VertexColor::Bytes([0; 4]));
    let stage = &draw.combiners.stages[0];
    assert_eq!(draw.combiners.stages.len(), 1);
    assert_eq!((stage.rgb.sum_output, stage.alpha.sum_output), (Register::Spare0, Register::Spare0));
    assert_eq!(stage.alpha.inputs[0].component, Component::Alpha);
    let last = &draw.combiners.final_combiner;
    assert_eq!(
        [last.inputs[0].register, last.inputs[1].register, last.inputs[2].register, last.g.register],
        [FinalRegister::Fog, FinalRegister::Spare0PlusSecondary, FinalRegister::Fog, FinalRegister::Spare0]
    );
    assert_eq!((last.inputs[0].component, last.g.component), (Component::Alpha, Component::Alpha));
    assert!(last.color_sum_clamp);
    assert!(loaded.warnings.is_empty());
}

/// A texture register is a register: what a stage has written needs no texture.
#[test]
fn written_texture_registers_are_not_unbound() {
    let program = |first: &str| {
        let stages = format!("[(rgb: (a: (PrimaryColor), ab: {first})), (rgb: (a: (Texture1), ab: Spare0))]");
        draw("Nv2a", "", &format!("program: Combiners(stages: {stages}, final_combiner: (d: (Spare0)))"))
    };
    assert_eq!(program("Texture1").render_warnings(false), "");
    assert!(program("Spare1").render_warnings(false).contains("NB0902"));
}

#[test]
fn constants_become_bytes_and_vertex_colours_stay() {
    let loaded = draw("Nv2a", "", "blend_constant: Float(0.5, 2.0, -1.0)");
    // 255 * 0.5 + 0.5 = 128.
    assert_eq!(loaded.scene.draws[0].blend_constant, [128, 255, 0, 255]);
    let loaded = parse(
        "(version: 1, profile: Nv2a, names: (colors: { \"a\": \"b\", \"b\": Float(0.1, 0.2, 0.3, 0.4) }), \
         draws: [(vertices: Window([(position: (1, 2, 0.5, 2), diffuse: \"a\", t2: (5))]), indices: [0, 0, 0], \
         blend_constant: \"a\")])",
    );
    let vertex = loaded.scene.draws[0].vertices.at(0);
    assert_eq!(vertex.diffuse, VertexColor::Floats([0.1, 0.2, 0.3, 0.4]));
    assert_eq!((vertex.position, vertex.texture_coordinates[2]), ([1.0, 2.0, 0.5, 2.0], [5.0, 0.0, 0.0, 1.0]));
    assert_eq!(loaded.scene.draws[0].blend_constant, [26, 51, 77, 102]);
}

#[test]
fn targets_and_raster_operations() {
    let loaded = draw(
        "Nv2a",
        "targets: [(name: \"a\", width: 8, height: 8, format: X1R5G5B5O, clear: (color: (1, 2, 3, 4), depth: 0.5), depth: Z16)],",
        "scissor: (x: 1, width: 2, height: 3), alpha_test: (function: GreaterOrEqual, reference: 0x80), depth_test: (write: false), \
         blend: (destination: OneMinusSourceAlpha, source: SourceAlpha), color_mask: (true, false, true, false), dither: false, \
         fog: (color: (1, 2, 3))",
    );
    let (target, draw) = (&loaded.scene.targets[0], &loaded.scene.draws[0]);
    assert_eq!(target.clear_color, [1, 2, 3, 4]);
    assert_eq!(target.depth, Some(DepthBuffer { format: DepthFormat::Z16, clear: 32767, clear_stencil: 0 }));
    assert_eq!(draw.alpha_test.unwrap().reference, 128);
    assert!(!draw.depth_test.unwrap().write);
    assert_eq!(
        draw.blend,
        Some(Blend {
            equation: BlendEquation::Add,
            source: BlendFactor::SourceAlpha,
            destination: BlendFactor::OneMinusSourceAlpha
        })
    );
    assert_eq!(draw.color_mask, [true, false, true, false]);
    assert_eq!((draw.fog.enabled, draw.fog.color), (true, [1, 2, 3]));
    let scissor = draw.scissor.unwrap();
    assert_eq!((scissor.x, scissor.y, scissor.width, scissor.height), (1, 0, 2, 3));
}

/// Bytes, floats, and words of which the low eight bits count.
#[test]
fn alpha_references_of_every_form() {
    for (written, byte, warns) in [
        ("7", 7, false),
        ("0x190", 0x90, true),
        ("Float(0.5)", 128, false),
        ("Float(-1)", 0, false),
        ("Float(2.0)", 255, false),
    ] {
        let loaded = draw("Nv10", "", &format!("alpha_test: (function: Less, reference: {written})"));
        assert_eq!(loaded.scene.draws[0].alpha_test.unwrap().reference, byte, "{written}");
        assert_eq!(loaded.warnings.iter().any(|warning| warning.code == "NB0914"), warns, "{written}");
    }
}

#[test]
fn texels_are_packed_by_cutting_off() {
    let words = |format: &str, source: &str| {
        let top = format!("textures: {{ \"t\": (format: {format}, source: {source}) }},");
        let loaded = draw("Nv2a", &top, "textures: [\"t\"]");
        match &loaded.scene.textures[0].image {
            TextureImage::Texels(texels) => texels.words.to_vec(),
            TextureImage::Target { .. } | TextureImage::Depth { .. } => panic!("texels expected"),
        }
    };
    let solid = "Solid(width: 1, height: 1, color: (0x9f, 0x87, 0x4f, 0x12))";
    assert_eq!(words("A8R8G8B8", solid), [0x129f_874f]);
    assert_eq!(words("X8R8G8B8", solid), [0x009f_874f]);
    assert_eq!(words("R5G6B5", solid), [(0x9f >> 3) << 11 | (0x87 >> 2) << 5 | 0x4f >> 3]);
    assert_eq!(words("X1R5G5B5", solid), [(0x9f >> 3) << 10 | (0x87 >> 3) << 5 | 0x4f >> 3]);
    assert_eq!(words("L8", solid), [0x9f]);
    assert_eq!(words("A8", solid), [0x12]);
    assert_eq!(words("G8B8", solid), [0x874f]);
    assert_eq!(words("L8", "Texels(width: 2, height: 2, rows: [\"00 7f\", \"80 ff\"])"), [0, 0x7f, 0x80, 0xff]);
    assert_eq!(words("L8", "Ramp(width: 4, height: 1, from: (0, 0, 0), to: (255, 0, 0))"), [0, 85, 170, 255]);
    assert_eq!(words("L8", "Checker(width: 4, height: 2, cell: 2)"), [255, 255, 0, 0, 255, 255, 0, 0]);
}

/// Words as they are, unused bits too, until a draw writes them.
#[test]
fn targets_begin_as_textures() {
    let loaded = parse(
        "(version: 1, profile: Nv2a, targets: [(name: \"a\", width: 2, height: 1, format: X1R5G5B5O, contents: \"t\")], \
         textures: { \"t\": (format: A1R5G5B5, kind: Rectangle, source: Texels(width: 2, height: 1, rows: [\"0421 7fff\"])) }, draws: [\
         (vertices: Window([(position: (1, 0)), (position: (2, 0)), (position: (2, 1)), (position: (1, 1))]), topology: Quads, \
         program: Combiners(stages: [()], final_combiner: (d: Invert(Zero), g: Zero)))])",
    );
    for engine in [engine::Engine::Scalar, engine::Engine::Fast] {
        let frames = engine::render(&loaded.plan, &RenderOptions { engine, ..RenderOptions::default() });
        assert_eq!(frames.surfaces[0].words, [0x0421, 0xffff], "{engine:?}");
    }
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
}

#[test]
fn units_targets_as_textures_and_combiners() {
    let loaded = parse(
        "(version: 1, profile: Nv2a, targets: [(name: \"a\", width: 8, height: 8), (name: \"b\", width: 4, height: 4, format: B8)], \
         textures: { \"t\": (source: Target(\"b\")) }, draws: [\
         (target: \"b\", vertices: Window([])), \
         (vertices: Window([]), textures: [Unbound, (texture: \"t\", address: Mirror, address_t: ClampToBorder, \
         min_filter: Nearest, coordinates: 3, border_color: (1, 2, 3), signed: (true, false, false, false))], \
         program: Combiners(constants: ((1, 1, 1)), mux_select: Lsb, stages: [\
         (rgb: (a: (Texture1, Alpha), b: ExpandNegate(Texture1), c: SignedNegate(Spare0, Alpha), d: UnsignedInvert(Zero), \
         ab: Spare1, sum: PrimaryColor, ab_dot: true, scale: Two, bias: NegativeHalf, ab_blue_to_alpha: true), \
         alpha: (a: HalfBiasNormal(Texture1, Blue), cd: Spare0)), (constants: ((2, 2, 2, 2), (3, 3, 3, 3)))], \
         final_combiner: (a: Invert(Fog, Alpha), b: ETimesF, e: (Spare1, Alpha), g: (Spare1, Blue), invert_spare0: true)))])",
    );
    let (scene, draw) = (&loaded.scene, &loaded.scene.draws[1]);
    let texture = &scene.textures[0];
    assert_eq!((&texture.image, texture.format), (&TextureImage::Target { target: 1 }, TextureFormat::L8));
    let unit = draw.textures[1].unwrap();
    assert!(draw.textures[0].is_none());
    assert_eq!((draw.texture_shader[1].coordinate_set, unit.mag_filter), (3, Filter::Nearest));
    assert_eq!((unit.address_s, unit.address_t), (AddressMode::Mirror, AddressMode::ClampToBorder));
    assert_eq!((unit.border_color, unit.signed), ([1, 2, 3, 255], [true, false, false, false]));
    let [first, second] = &draw.combiners.stages[..] else { panic!("two stages") };
    assert_eq!(first.rgb.inputs[0].component, Component::Alpha);
    assert_eq!(
        first.rgb.inputs.map(|input| input.mapping),
        [
            InputMapping::UnsignedIdentity,
            InputMapping::ExpandNegate,
            InputMapping::SignedNegate,
            InputMapping::UnsignedInvert
        ]
    );
    assert_eq!(
        (first.rgb.ab_output, first.rgb.cd_output, first.rgb.sum_output),
        (Register::Spare1, Register::Zero, Register::PrimaryColor)
    );
    assert_eq!((first.alpha.inputs[0].component, first.alpha.cd_output), (Component::Blue, Register::Spare0));
    assert_eq!((first.constants, second.constants), ([[1, 1, 1, 255], [0; 4]], [[2; 4], [3; 4]]));
    let last = &draw.combiners.final_combiner;
    assert!(last.inputs[0].invert && last.invert_spare0);
    assert_eq!((last.inputs[1].register, last.inputs[4].component), (FinalRegister::ETimesF, Component::Alpha));
    assert_eq!((last.g.component, last.constants), (Component::Blue, [[1, 1, 1, 255], [0; 4]]));
    assert!(loaded.warnings.is_empty(), "{}", loaded.render_warnings(false));
}

#[test]
fn texture_shaders() {
    use ninebit::state::{DotMapping, ShaderOperation, ShaderStage};
    let loaded = parse(
        "(version: 1, profile: Nv2a, textures: { \"t\": (source: Solid(width: 4, height: 4, color: (1, 2, 3))) }, draws: [\
         (vertices: Window([]), textures: [(texture: \"t\", coordinates: 2), Unbound, \"t\"], texture_shader: [Sample, \
         (operation: DotProduct, mapping: HiloHemisphere), (operation: DotProduct2D, previous: 0, coordinates: 3)]), \
         (vertices: Window([]), textures: [Unbound, \"t\"], texture_shader: [PassThrough, \
         BumpEnvironment(matrix: (1, 2, 3, 4), luminance: (0.5, -1)), CullFragment(t: NotNegative, q: Negative)]), \
         (vertices: Window([]), textures: [Unbound, \"t\"])])",
    );
    assert!(loaded.warnings.is_empty(), "{}", loaded.render_warnings(false));
    let draws = &loaded.scene.draws;
    let stage =
        |operation, coordinate_set, previous, mapping| ShaderStage { operation, coordinate_set, previous, mapping };
    let zero_to_one = DotMapping::ZeroToOne;
    assert_eq!(
        draws[0].texture_shader,
        [
            // The unit's coordinates hold unless the stage names others.
            stage(ShaderOperation::Sample, 2, 0, zero_to_one),
            stage(ShaderOperation::DotProduct, 1, 0, DotMapping::HiloHemisphere),
            stage(ShaderOperation::DotProduct2D, 3, 0, zero_to_one),
            stage(ShaderOperation::None, 3, 2, zero_to_one),
        ]
    );
    let operations = draws[1].texture_shader.map(|stage| stage.operation);
    let bump = ShaderOperation::BumpEnvironment { matrix: [1.0, 2.0, 3.0, 4.0], luminance: Some([0.5, -1.0]) };
    let cull = ShaderOperation::CullFragment { drops_not_negative: [false, true, false, false] };
    assert_eq!(operations, [ShaderOperation::PassThrough, bump, cull, ShaderOperation::None]);
    let conventional = [0, 1, 2, 3].map(|unit| ShaderStage::conventional(unit, unit == 1));
    assert_eq!(draws[2].texture_shader, conventional);
}

#[test]
fn matrices_multiply_column_vectors() {
    let position = |matrix: &str| {
        let text = format!(
            "(version: 1, profile: Nv2a, names: (matrices: {{ \"up\": Translate(0, 0.5, 0) }}), draws: [(vertices: Matrix(\
             matrix: Product({matrix}, \"up\"), vertices: [(position: (0.25, 0, 0))]), indices: [0, 0, 0])])"
        );
        parse(&text).scene.draws[0].vertices.at(0).position
    };
    assert_eq!(position("Identity"), [0.25, 0.5, 0.0, 1.0]);
    assert_eq!(position("Scale(2, 4, 1)"), [0.5, 2.0, 0.0, 1.0]);
    assert_eq!(position("Rows((0, 1, 0, 0), (1, 0, 0, 0), (0, 0, 1, 3), (0, 0, 0, 2))"), [0.5, 0.25, 3.0, 2.0]);
    assert_eq!(position("Rotate(0, 0, 1, 1)"), [-0.5, 0.25, 0.0, 1.0]);
    assert_eq!(position("LookAt(eye: (0, 0, 4), center: (0, 0, 0))"), [0.25, 0.5, -4.0, 1.0]);
    let frustum = "Frustum(left: -1, right: 1, bottom: -1, top: 1, near: 1, far: 3)";
    assert_eq!(position(&format!("{frustum}, Translate(0, 0, -3)")), [0.25, 0.5, 3.0, 3.0]);
}

#[test]
fn meshes_bring_vectors_in_tangent_space() {
    let loaded = parse(
        "(version: 1, profile: Nv2a, draws: [(vertices: Matrix(matrix: Scale(0.5, 0.5, 0.5), mesh: Grid(columns: 1, rows: 1), \
         diffuse: Normal, t1: LightVector(direction: (0, 0, 5)), t2: HalfVector(direction: (0, 0, 1), viewer: (-1, 1, 9)), \
         t3: (1, 2)))])",
    );
    let draw = &loaded.scene.draws[0];
    assert_eq!((draw.vertices.len(), draw.indices.len()), (4, 6));
    let vertex = draw.vertices.at(0);
    assert_eq!(vertex.diffuse, VertexColor::Floats([0.5, 0.5, 1.0, 1.0]));
    assert_eq!(vertex.texture_coordinates[1..], [[0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0], [1.0, 2.0, 0.0, 1.0]]);
    assert!(matches!(loaded.draw_spans[0].vertices, VertexSpans::All(_)));
}

#[test]
fn places_are_where_things_stand() {
    let text = "\u{feff}(version: 1, profile: Nv2a,\r\n  /* é */ draws: [(vertices: Window([(position: (0, 0))]), indices: [0, 0, 0])])";
    let loaded = parse(text);
    let spans = &loaded.draw_spans[0];
    assert_eq!(&loaded.source.text[spans.vertex(0)], "(position: (0, 0))");
    assert_eq!(loaded.source.position(spans.draw.start), (2, 19));
    assert_eq!(&loaded.source.text[spans.vertex(99)], "(");
}

#[test]
fn attributes_type_names_and_options_may_be_written() {
    let loaded = parse(
        "#![enable(implicit_some)]\n/* a /* nested */ comment */ Scene(version: Some(1), profile: Nv2a, names: None, // end\n \
         targets: Some([(name: r\"a\", width: 8 /* wide */, format: R5G6B5 // short\n )]), draws: [],)\n// the end",
    );
    assert_eq!((loaded.scene.targets[0].name.as_str(), loaded.scene.targets[0].format), ("a", SurfaceFormat::R5G6B5));
    let error = scene::parse("#![enable(implicit_some)]\n(profile: Nv2a)", Path::new("x.ron"), &Limits::default());
    assert!(error.unwrap_err().render(false).contains("x.ron:2:1\n"));
}
