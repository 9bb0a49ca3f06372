//! A small program: its log and its memory become the frame that a scene, stated by hand, draws.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_arithmetic, reason = "tests fail by panicking")]

use std::fmt::Write;
use std::sync::Arc;

use ninebit::engine::{RenderOptions, render};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;
use ninebit::vertex::fog;
use ninebit_methods::class::{self, Family};
use ninebit_methods::import::{Options, Part, import};
use ninebit_methods::memory::{Layout, Memory, bytes};
use ninebit_methods::state::State;
use ninebit_methods::vertex::microcode::{Instruction, Mac, Operand, Source, encode};
use ninebit_program::registers::encode as register_words;
use ninebit_test_support::frames::difference;

/// Draws of the frame besides the first, which goes into the other surface.
const DRAWS: usize = 200;
/// Vertices of each.
const VERTICES: usize = 4;

/// Plays a program: what it sends and what it has in memory.
struct Program {
    log: String,
    memory: Vec<u8>,
}

impl Program {
    fn send(&mut self, method: u32, word: u32) {
        let label = Family::Kelvin.find(method).map_or("?", |place| place.method.name);
        writeln!(self.log, "4711@17.000001:nv2a_pgraph_method 0: 0x97 -> 0x{method:04x} NV097_{label}[0] 0x{word:x}")
            .unwrap();
    }

    fn send_all(&mut self, words: &[(u32, u32)]) {
        words.iter().for_each(|(method, word)| self.send(*method, *word));
    }

    fn floats(&mut self, method: u32, numbers: &[f32]) {
        (0..).zip(numbers).for_each(|(n, number)| self.send(method + 4 * n, number.to_bits()));
    }

    /// Puts bytes into memory, and returns their address.
    fn put(&mut self, bytes: &[u8]) -> u32 {
        let at = self.memory.len() as u32;
        self.memory.extend_from_slice(bytes);
        self.memory.resize(self.memory.len().next_multiple_of(256), 0);
        at
    }
}

fn noise(n: u32) -> u32 {
    n.wrapping_mul(0x9e37_79b9).rotate_left(13).wrapping_mul(0x85eb_ca6b)
}

/// Position, colour and coordinates of a vertex of a draw.
fn vertex(draw: usize, corner: usize) -> ([f32; 4], [u8; 4], [i16; 2]) {
    let (column, row) = ((draw % 20) as f32, (draw / 20) as f32);
    let [x, y] = [corner & 1, corner >> 1].map(|n| n as f32);
    let position = [12.0 * column + 11.5 * x, 25.0 * row + 23.25 * y, 1000.0 * draw as f32, 1.0 + 0.25 * x];
    let color = noise((draw * VERTICES + corner) as u32).to_le_bytes();
    (position, color, [corner as i16 & 1, corner as i16 >> 1])
}

/// What all draws move by; the program's constant.
const OFFSET: [f32; 4] = [3.0, 2.5, 4096.0, 0.0];

/// The textures of the frame, in the order of the draws that use them.
fn textures() -> (Vec<Texture>, Vec<u32>) {
    let words = |count: usize, mask: u32| -> Arc<[u32]> { (0..count as u32).map(|n| noise(n) & mask).collect() };
    let texels = |width, height, levels, words| {
        TextureImage::Texels(Texels { width, height, levels, layers: 1, border: false, words })
    };
    let texture = |name: &str, kind, format, image| Texture { name: name.into(), kind, format, image };
    let (flat, cube) = (TextureKind::TwoDimensional, TextureKind::Cube);
    let all = vec![
        texture(
            "levels",
            flat,
            TextureFormat::A8R8G8B8,
            texels(16, 8, 5, words(16 * 8 + 8 * 4 + 4 * 2 + 2 + 1, u32::MAX)),
        ),
        texture("blocks", flat, TextureFormat::Dxt1, texels(16, 16, 1, words(32, u32::MAX))),
        texture("indices", flat, TextureFormat::P8, texels(8, 8, 1, words(64, 0xff))),
        texture("faces", cube, TextureFormat::R5G6B5, texels(4, 4, 1, words(96, 0xffff))),
        texture("rows", TextureKind::Rectangle, TextureFormat::X8R8G8B8, texels(10, 6, 1, words(60, u32::MAX))),
        texture("surface", flat, TextureFormat::R5G6B5, TextureImage::Target { target: 1 }),
    ];
    (all, words(64, u32::MAX).to_vec())
}

fn unit(texture: usize) -> TextureUnit {
    let mut unit = TextureUnit::new(texture);
    unit.palette = (texture == 2).then_some(0);
    if texture == 0 {
        unit.mip_filter = MipFilter::Nearest;
    }
    if texture == 4 {
        (unit.address_s, unit.address_t) = (AddressMode::ClampToEdge, AddressMode::ClampToEdge);
    }
    unit
}

const FOG: FogFunction = FogFunction { mode: FogMode::Linear, p0: 2.0, p1: -0.000_003, p2: 0.0, per_vertex: false };

fn combiners() -> Combiners {
    let mut combiners = Combiners { stages: vec![GeneralStage::default()], ..Combiners::default() };
    combiners.final_combiner = FinalCombiner::default()
        .a(FinalRegister::Fog.alpha())
        .b(FinalRegister::Texture0.rgb())
        .c(FinalRegister::Fog.rgb())
        .d(FinalRegister::PrimaryColor.alpha().inverted())
        .g(FinalRegister::PrimaryColor.alpha());
    combiners
}

/// The scene, stated by hand.
fn stated() -> Scene {
    let (textures, palette) = textures();
    let frame = Target {
        depth: Some(DepthBuffer { format: DepthFormat::Z24S8, clear: 0xff_ffff, clear_stencil: 7 }),
        clear_color: [0x20, 0x40, 0x60, 0xff],
        ..Target::new(256, 256, SurfaceFormat::A8R8G8B8)
    };
    let small =
        Target { name: "small".into(), clear_color: [0, 0, 0, 255], ..Target::new(32, 32, SurfaceFormat::R5G6B5) };
    let mut first = Draw { name: "first".into(), target: 1, topology: Topology::TriangleFan, ..Draw::default() };
    let corners = [(0.0, 0.0), (32.0, 0.0), (32.0, 32.0), (0.0, 32.0)];
    first.vertices = corners
        .into_iter()
        .zip(0..)
        .map(|((x, y), n)| Vertex {
            position: [x, y, 0.0, 1.0],
            diffuse: VertexColor::Bytes(noise(77 + n).to_le_bytes()),
            ..Vertex::default()
        })
        .collect();
    first.indices = Arc::new([0, 1, 2, 3]);
    first.combiners = combiners();
    first.combiners.final_combiner = FinalCombiner::showing(FinalRegister::PrimaryColor);
    let mut draws = vec![first];
    for draw in 0..DRAWS {
        let texture = draw % 6;
        let mut state = Draw {
            name: format!("draw {draw}"),
            topology: Topology::TriangleStrip,
            combiners: combiners(),
            ..Draw::default()
        };
        state.vertices = (0..VERTICES)
            .map(|corner| {
                let (position, color, coordinates) = vertex(draw, corner);
                let position: [f32; 4] = std::array::from_fn(|n| position[n] + OFFSET[n]);
                let d = position[2];
                let [s, t] = coordinates.map(f32::from);
                Vertex {
                    position,
                    diffuse: VertexColor::Bytes(color),
                    fog: fog::passed(&FOG, Profile::Nv2a, d),
                    fog_coordinate: Some(d),
                    texture_coordinates: [[s, t, 0.0, 1.0]; 4],
                    ..Vertex::default()
                }
            })
            .collect();
        state.indices = Arc::new([0, 1, 2, 3]);
        state.fog = Fog { enabled: true, color: [10, 200, 30], function: Some(FOG) };
        state.depth_test = Some(DepthTest {
            vertex_depths: VertexDepths::Steps,
            ..DepthTest::new(CompareFunction::LessOrEqual, true)
        });
        draws.push(state.texture(0, unit(texture)));
    }
    let palettes = vec![Palette { name: "palette".into(), entries: palette.into() }];
    Scene { profile: Profile::Nv2a, targets: vec![frame, small], textures, palettes, draws }
}

/// Plays the program.
fn played() -> Program {
    let (textures, palette) = textures();
    let mut program = Program { log: String::new(), memory: vec![0; 0x1000] };
    // Colours of the frame, its depths, and the small surface, which is swizzled.
    let [frame, depths, small] =
        [256 * 256 * 4, 256 * 256 * 4, 32 * 32 * 2].map(|count| program.put(&vec![0xcd; count]));
    let mut places = Vec::new();
    for texture in &textures {
        let TextureImage::Texels(texels) = &texture.image else {
            places.push(small);
            continue;
        };
        let mut image = Vec::new();
        let mut words = texels.words.iter().copied();
        let faces = if texture.kind == TextureKind::Cube { 6 } else { 1 };
        for _ in 0..faces {
            image.resize(image.len().next_multiple_of(128), 0);
            for level in 0..texels.levels {
                let size = [(texels.width >> level).max(1), (texels.height >> level).max(1), 1];
                let layout = if texture.kind == TextureKind::Rectangle { Layout::Pitch(64) } else { Layout::Swizzled };
                let level: Vec<u32> = words.by_ref().take(texture.format.words(size[0], size[1])).collect();
                image.extend(bytes(&level, texture.format, size, layout));
            }
        }
        places.push(program.put(&image));
    }
    let palette_bytes: Vec<u8> = palette.iter().flat_map(|word| word.to_le_bytes()).collect();
    let palette = program.put(&palette_bytes);
    // The vertices, interleaved: position, colour, coordinates.
    let mut array = Vec::new();
    for draw in 0..DRAWS {
        for corner in 0..VERTICES {
            let (position, color, coordinates) = vertex(draw, corner);
            array.extend(position.iter().flat_map(|number| number.to_le_bytes()));
            array.extend([color[2], color[1], color[0], color[3]]);
            array.extend(coordinates.iter().flat_map(|number| number.to_le_bytes()));
        }
    }
    let array = program.put(&array);

    // What the driver sets first.
    program.send_all(&[
        (class::SET_SHADE_MODEL, 0x1d01),
        (class::SET_FRONT_POLYGON_MODE, 0x1b02),
        (class::SET_BACK_POLYGON_MODE, 0x1b02),
        (class::SET_POLY_SMOOTH_ENABLE, 0),
        (class::SET_STIPPLE_ENABLE, 0),
        (class::SET_CULL_FACE_ENABLE, 0),
        (class::SET_FOG_ENABLE, 0),
        (class::SET_ALPHA_TEST_ENABLE, 0),
        (class::SET_BLEND_ENABLE, 0),
        (class::SET_STENCIL_TEST_ENABLE, 0),
        (class::SET_DEPTH_TEST_ENABLE, 0),
        (class::SET_COLOR_MASK, 0x0101_0101),
        (class::SET_CONTROL0, 0x10_0001),
        (class::SET_SPECULAR_ENABLE, 0),
        (class::SET_SHADER_STAGE_PROGRAM, 0),
        (class::SET_TRANSFORM_EXECUTION_MODE, 2),
        (class::SET_TRANSFORM_PROGRAM_START, 0),
        (class::SET_TRANSFORM_PROGRAM_LOAD, 0),
    ]);
    let copy = |from: u8, to: u8, mac: Mac, is_last: bool| {
        let constant = Operand::new(Source::Constant);
        let operands = [
            Operand::new(Source::Input),
            Operand::default(),
            if mac == Mac::Add { constant } else { Operand::default() },
        ];
        encode(&Instruction {
            mac,
            operands,
            input: from,
            constant: 96,
            output_mask: 15,
            output_address: to,
            is_last,
            ..Instruction::default()
        })
    };
    let mut fog = Instruction {
        mac: Mac::Add,
        input: 0,
        constant: 96,
        output_mask: 1,
        output_address: 5,
        ..Instruction::default()
    };
    let z = |source| Operand { swizzle: [2; 4], ..Operand::new(source) };
    fog.operands = [z(Source::Input), Operand::default(), z(Source::Constant)];
    let slots = [copy(0, 0, Mac::Add, false), copy(3, 3, Mac::Mov, false), encode(&fog), copy(9, 9, Mac::Mov, true)];
    for slot in slots {
        (0..).zip(slot).for_each(|(n, word)| program.send(class::SET_TRANSFORM_PROGRAM + 4 * n, word));
    }
    program.send(class::SET_TRANSFORM_CONSTANT_LOAD, 96);
    program.floats(class::SET_TRANSFORM_CONSTANT, &[0.0; 4]);
    for attribute in 0..16 {
        program.send(class::SET_VERTEX_DATA_ARRAY_FORMAT + 4 * attribute, 2);
    }
    let send_combiners = |program: &mut Program, combiners: &Combiners| {
        for (word, index, value) in register_words(combiners, Profile::Nv2a).all() {
            program.send(word.method(Profile::Nv2a) + 4 * index as u32, value);
        }
    };

    // The small surface.
    let scene = stated();
    send_combiners(&mut program, &scene.draws[0].combiners);
    program.send_all(&[
        (class::SET_SURFACE_CLIP_HORIZONTAL, 32 << 16),
        (class::SET_SURFACE_CLIP_VERTICAL, 32 << 16),
        (class::SET_SURFACE_FORMAT, 3 | 2 << 4 | 2 << 8 | 5 << 16 | 5 << 24),
        (class::SET_SURFACE_PITCH, 64 | 128 << 16),
        (class::SET_SURFACE_COLOR_OFFSET, small),
        (class::SET_SURFACE_ZETA_OFFSET, depths),
        (class::SET_CLEAR_RECT_HORIZONTAL, 31 << 16),
        (class::SET_CLEAR_RECT_VERTICAL, 31 << 16),
        (class::SET_COLOR_CLEAR_VALUE, 0),
        (class::CLEAR_SURFACE, 0xf0),
    ]);
    // The program reads coordinates.
    program.floats(0x1590, &[0.0, 0.0]);
    program.send(class::SET_BEGIN_END, 7);
    for (corner, n) in [[0.0, 0.0], [32.0, 0.0], [32.0, 32.0], [0.0, 32.0_f32]].into_iter().zip(0..) {
        program.send(0x194c, noise(77 + n));
        program.floats(0x1500, &[corner[0], corner[1], 0.0]);
    }
    program.send(class::SET_BEGIN_END, 0);

    // The frame.
    send_combiners(&mut program, &scene.draws[1].combiners);
    program.send_all(&[
        (class::SET_SURFACE_CLIP_HORIZONTAL, 256 << 16),
        (class::SET_SURFACE_CLIP_VERTICAL, 256 << 16),
        (class::SET_SURFACE_FORMAT, 8 | 2 << 4 | 1 << 8),
        (class::SET_SURFACE_PITCH, 1024 | 1024 << 16),
        (class::SET_SURFACE_COLOR_OFFSET, frame),
        (class::SET_CLEAR_RECT_HORIZONTAL, 255 << 16),
        (class::SET_CLEAR_RECT_VERTICAL, 255 << 16),
        (class::SET_COLOR_CLEAR_VALUE, 0xff20_4060),
        (class::SET_ZSTENCIL_CLEAR_VALUE, 0xffff_ff07),
        (class::CLEAR_SURFACE, 0xf3),
        (class::SET_DEPTH_TEST_ENABLE, 1),
        (class::SET_DEPTH_FUNC, 0x203),
        (class::SET_DEPTH_MASK, 1),
        (class::SET_POLY_OFFSET_FILL_ENABLE, 0),
        (class::SET_FOG_ENABLE, 1),
        (class::SET_FOG_COLOR, 0x001e_c80a),
        (class::SET_FOG_MODE, 0x2601),
    ]);
    program.floats(class::SET_FOG_PARAMS, &[FOG.p0, FOG.p1, 0.0]);
    program.send(class::SET_TRANSFORM_CONSTANT_LOAD, 96);
    program.floats(class::SET_TRANSFORM_CONSTANT, &OFFSET);
    for (attribute, format, offset) in [(0, 0x42 | 24 << 8, 0), (3, 0x40 | 24 << 8, 16), (9, 0x25 | 24 << 8, 20)] {
        program.send(class::SET_VERTEX_DATA_ARRAY_FORMAT + 4 * attribute, format);
        program.send(class::SET_VERTEX_DATA_ARRAY_OFFSET + 4 * attribute, array + offset);
    }
    // Codes of formats, sides, levels and kinds.
    let formats = [
        1 | 1 << 3 | 2 << 4 | 0x06 << 8 | 5 << 16 | 4 << 20 | 3 << 24,
        1 | 1 << 3 | 2 << 4 | 0x0c << 8 | 1 << 16 | 4 << 20 | 4 << 24,
        1 | 1 << 3 | 2 << 4 | 0x0b << 8 | 1 << 16 | 3 << 20 | 3 << 24,
        1 | 1 << 2 | 1 << 3 | 2 << 4 | 0x05 << 8 | 1 << 16 | 2 << 20 | 2 << 24,
        1 | 1 << 3 | 2 << 4 | 0x1e << 8 | 1 << 16,
        1 | 1 << 3 | 2 << 4 | 0x05 << 8 | 1 << 16 | 5 << 20 | 5 << 24,
    ];
    for draw in 0..DRAWS {
        let texture = draw % 6;
        let address = if texture == 4 { 0x0303 } else { 0x1_0101 };
        let min = if texture == 0 { 4 } else { 2 };
        program.send_all(&[
            (class::SET_TEXTURE_OFFSET, places[texture]),
            (class::SET_TEXTURE_FORMAT, formats[texture]),
            (class::SET_TEXTURE_ADDRESS, address),
            (class::SET_TEXTURE_CONTROL0, 1 << 30 | 4095 << 6),
            (class::SET_TEXTURE_CONTROL1, 64 << 16),
            (class::SET_TEXTURE_IMAGE_RECT, 10 << 16 | 6),
            (class::SET_TEXTURE_FILTER, 2 << 24 | min << 16),
            (class::SET_TEXTURE_PALETTE, palette | 2 << 2),
            (class::SET_SHADER_STAGE_PROGRAM, if texture == 3 { 3 } else { 1 }),
        ]);
        let first = (draw * VERTICES) as u32;
        program.send(class::SET_BEGIN_END, 6);
        match draw % 3 {
            0 => program.send(class::DRAW_ARRAYS, first | 3 << 24),
            1 => (0..4).for_each(|n| program.send(class::ARRAY_ELEMENT32, first + n)),
            _ => {
                (0..2).for_each(|n| program.send(class::ARRAY_ELEMENT16, (first + 2 * n) | ((first + 2 * n + 1) << 16)))
            }
        }
        program.send(class::SET_BEGIN_END, 0);
    }
    program.log.push_str("nv2a_pgraph_flip_stall\n");
    program
}

#[test]
fn a_program_s_frame_is_the_stated_one() {
    let program = played();
    let memory = Memory::new(program.memory);
    let (frames, summary) = import(program.log.as_bytes(), State::default(), &memory, Options::default());
    assert_eq!(
        (frames.len(), summary.draws, summary.complete),
        (1, DRAWS as u64 + 1, DRAWS as u64 + 1),
        "{:?}",
        summary.gaps
    );
    let imported = &frames[0].scene;
    let plan = |scene: &Scene| Plan::compile(scene, &PlanOptions::default()).unwrap();
    let options = RenderOptions::default();
    let (mut got, expected) = (render(&plan(imported), &options), render(&plan(&stated()), &options));
    // The log draws the small surface first.
    got.surfaces.swap(0, 1);
    assert_eq!(difference(&got, &expected, "the stated scene"), None);
    let colors: std::collections::BTreeSet<u32> = got.surfaces[0].words.iter().copied().collect();
    assert!(colors.len() > 1000, "{} colours", colors.len());
}

#[test]
fn what_is_missing_is_said() {
    let program = played();
    let (frames, summary) = import(program.log.as_bytes(), State::default(), &Memory::default(), Options::default());
    assert_eq!(summary.complete, 1, "only the first draw needs no memory");
    let text: Vec<String> = frames[0].drawn.iter().flat_map(|drawn| &drawn.gaps).map(ToString::to_string).collect();
    assert!(
        text.iter().any(|gap| gap.starts_with("vertex array 0 at 0x") && gap.ends_with("no memory was given")),
        "{text:?}"
    );
    // As xemu drops them.
    let dropped = program
        .log
        .replace("NV097_ARRAY_ELEMENT16[0] 0x", "NV097_ARRAY_ELEMENT16 * 1 0x")
        .replace("nv2a_pgraph_method 0: 0x97 -> 0x1800", "nv2a_pgraph_method_abbrev 0: 0x97 -> 0x1800");
    let memory = Memory::new(program.memory);
    let options = Options { part: Part::Draw(3), ..Options::default() };
    let (frames, _) = import(dropped.as_bytes(), State::default(), &memory, options);
    assert_eq!(frames[0].drawn.len(), 1);
    let gaps: Vec<String> = frames[0].drawn[0].gaps.iter().map(ToString::to_string).collect();
    assert!(gaps.iter().any(|gap| gap == "2 words of indices were not recorded"), "{gaps:?}");
}
