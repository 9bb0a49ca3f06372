//! A small program of the NV10 class, in the lines of a PC emulator: fixed function, arrays in memory and among the words, indices, textures. Its
//! frame is that of a scene, stated by hand.
#![allow(missing_docs, clippy::unwrap_used, clippy::float_arithmetic, reason = "tests fail by panicking")]

use std::fmt::Write;

use ninebit::engine::{RenderOptions, render};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;
use ninebit_methods::class::{Family, Treatment};
use ninebit_methods::import::{Options, import};
use ninebit_methods::memory::{Layout, Memory, bytes};
use ninebit_methods::state::State;
use ninebit_program::registers::encode;
use ninebit_test_support::frames::difference;

/// Plays a program: what it sends and what it has in memory.
#[derive(Default)]
struct Program {
    log: String,
    memory: Vec<u8>,
}

impl Program {
    fn send(&mut self, name: &str, offset: u32, word: u32) {
        let method = Family::Celsius.methods().iter().find(|method| method.name == name).unwrap();
        let number = (method.number + 4 * offset) / 4;
        writeln!(
            self.log,
            "00012i[GEFORC] execute_command: obj 0x7, class 0x0056, method 0x{number:x}, param 0x{word:x}"
        )
        .unwrap();
    }

    fn floats(&mut self, name: &str, offset: u32, numbers: &[f32]) {
        (offset..).zip(numbers).for_each(|(n, number)| self.send(name, n, number.to_bits()));
    }

    fn put(&mut self, bytes: &[u8]) -> u32 {
        let at = self.memory.len() as u32;
        self.memory.extend_from_slice(bytes);
        self.memory.resize(self.memory.len().next_multiple_of(256), 0);
        at
    }

    fn combiners(&mut self, combiners: &Combiners) {
        for (word, index, value) in encode(combiners, Profile::Nv10).all() {
            let number = (word.method(Profile::Nv10) + 4 * index as u32) / 4;
            writeln!(self.log, "execute_command: obj 0x7, class 0x0096, method 0x{number:x}, param 0x{value:x}")
                .unwrap();
        }
    }
}

const SIDE: u32 = 64;

/// Positions in object space, and what becomes of them: 16 pixels a unit, from the middle; y up.
const CORNERS: [[f32; 2]; 4] = [[-1.0, 1.0], [1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];

fn in_window([x, y]: [f32; 2], moved: f32) -> [f32; 4] {
    [16.0 * x + 32.0 + moved, -16.0 * y + 32.0, 0.0, 1.0]
}

fn color(draw: usize, corner: usize) -> [u8; 4] {
    let n = (draw * 4 + corner) as u8;
    [n.wrapping_mul(37), n.wrapping_mul(91), n.wrapping_mul(53), 255]
}

fn texture() -> Texture {
    Texture::from_words(TextureFormat::R5G6B5, [8, 8], (0..64).map(|n| (n * 1031) & 0xffff).collect::<Vec<u32>>())
}

fn combiners() -> Combiners {
    let mut combiners = Combiners { stages: vec![GeneralStage::default()], ..Combiners::default() };
    combiners.final_combiner = FinalCombiner::default()
        .a(FinalRegister::Fog.alpha())
        .b(FinalRegister::PrimaryColor.rgb())
        .c(FinalRegister::Texture0.rgb())
        .g(FinalRegister::PrimaryColor.alpha());
    combiners
}

const FOG: FogFunction = FogFunction { mode: FogMode::Linear, p0: 1.25, p1: -0.5, p2: 0.0, per_vertex: true };

/// The fog coordinate of a corner.
fn distance(corner: usize) -> f32 {
    0.25 * corner as f32
}

/// The scene, stated by hand: three draws, one after the other moved to the right, the last one blended.
fn stated() -> Scene {
    let draw = |number: usize| {
        let moved = 6.0 * number as f32;
        let vertex = |corner: usize| {
            let [s, t] = [corner & 1, corner >> 1].map(|n| n as f32);
            Vertex {
                position: in_window(CORNERS[corner], moved),
                diffuse: VertexColor::Bytes(color(number, corner)),
                fog_coordinate: Some(distance(corner)),
                fog: ninebit::vertex::fog::passed(&FOG, Profile::Nv10, distance(corner)),
                texture_coordinates: [[s, t, 0.0, 1.0]; TEXTURE_UNITS],
                ..Vertex::at(0.0, 0.0)
            }
        };
        let blend = Blend {
            equation: BlendEquation::Add,
            source: BlendFactor::SourceColor,
            destination: BlendFactor::OneMinusSourceColor,
        };
        Draw {
            topology: Topology::TriangleStrip,
            fog: Fog { enabled: true, color: [200, 100, 50], function: Some(FOG) },
            combiners: combiners(),
            blend: (number == 2).then_some(blend),
            ..Draw::from_vertices((0..4).map(vertex).collect::<Vec<_>>())
        }
        .texture(0, TextureUnit { mag_filter: Filter::Linear, ..TextureUnit::new(0) })
    };
    Scene {
        profile: Profile::Nv10,
        targets: vec![Target::new(SIDE, SIDE, SurfaceFormat::A8R8G8B8)],
        textures: vec![texture()],
        palettes: vec![],
        draws: (0..3).map(draw).collect(),
    }
}

/// The bytes of a vertex in an array: position, fog coordinate, coordinates, colour.
fn vertex_bytes(draw: usize, corner: usize) -> Vec<u8> {
    let [x, y] = CORNERS[corner];
    let [s, t] = [corner & 1, corner >> 1].map(|n| n as f32);
    // In the order of the class's arrays, as inline vertices have it: position, colour, coordinates, fog.
    let mut bytes: Vec<u8> = [x, y, 0.0].iter().flat_map(|n: &f32| n.to_le_bytes()).collect();
    bytes.extend(color(draw, corner));
    bytes.extend([s, t, distance(corner)].iter().flat_map(|n: &f32| n.to_le_bytes()));
    bytes
}

const STRIDE: u32 = 28;

fn played() -> Program {
    let mut program = Program::default();
    program.put(&[0; 256]);
    let surface = program.put(&vec![0; (SIDE * SIDE * 4) as usize]);
    let Texture { image: TextureImage::Texels(texels), format, .. } = texture() else { unreachable!() };
    let image = program.put(&bytes(&texels.words, format, [8, 8, 1], Layout::Swizzled));
    let array: Vec<u8> = (0..4).flat_map(|corner| vertex_bytes(0, corner)).collect();
    let indexed: Vec<u8> = [3, 1, 2, 0].into_iter().flat_map(|corner| vertex_bytes(1, corner)).collect();
    let arrays = [program.put(&array), program.put(&indexed)];
    let state = [
        ("RT_HORIZ", SIDE << 16),
        ("RT_VERT", SIDE << 16),
        ("RT_FORMAT", 8 | 1 << 8),
        ("RT_PITCH", (SIDE * 4) | ((SIDE * 4) << 16)),
        ("COLOR_OFFSET", surface),
        ("CONFIG", 0x10_0001),
        ("VIEWPORT_CLIP_MODE", 0),
        ("VIEWPORT_CLIP_HORIZ", (SIDE - 1) << 16 | 0x0800_0800),
        ("VIEWPORT_CLIP_VERT", (SIDE - 1) << 16 | 0x0800_0800),
        ("TEX_OFFSET", image),
        ("TEX_FORMAT", 1 | 0x50 | 5 << 7 | 1 << 12 | 3 << 16 | 3 << 20 | 1 << 24 | 1 << 28),
        ("TEX_FILTER", 1 << 24 | 2 << 28),
        ("TEX_ENABLE", 1 << 30 | 0xfff << 6),
        ("FOG_MODE", 0x2601),
        ("FOG_COORD", 0),
        ("FOG_ENABLE", 1),
        ("FOG_COLOR", 0x0032_64c8),
        ("VIEW_MATRIX_ENABLE", 6),
        ("SHADE_MODEL", 0x1d01),
        ("POLYGON_MODE_FRONT", 0x1b02),
        ("POLYGON_MODE_BACK", 0x1b02),
        ("COLOR_MASK", 0x0101_0101),
        ("BLEND_FACTOR_SRC", 0x300),
        ("BLEND_FACTOR_DST", 0x301),
        ("BLEND_EQUATION", 0x8006),
        ("EDGEFLAG", 1),
    ];
    state.iter().for_each(|(name, word)| program.send(name, 0, *word));
    program.send("TEX_ENABLE", 1, 0);
    let off = [
        "ALPHA_FUNC_ENABLE",
        "BLEND_FUNC_ENABLE",
        "CULL_FACE_ENABLE",
        "DEPTH_TEST_ENABLE",
        "DITHER_ENABLE",
        "LIGHTING_ENABLE",
        "POINT_PARAMETERS_ENABLE",
        "POLYGON_SMOOTH_ENABLE",
        "VERTEX_WEIGHT_ENABLE",
        "STENCIL_ENABLE",
        "SEPARATE_SPECULAR_ENABLE",
    ];
    off.iter().for_each(|name| program.send(name, 0, 0));
    ["S", "T", "R", "Q"].iter().for_each(|c| program.send(&format!("TEX_GEN_MODE_{c}"), 0, 0));
    program.send("TEX_MATRIX_ENABLE", 0, 0);
    program.floats("FOG_COEFF", 0, &[FOG.p0, FOG.p1, FOG.p2]);
    program.combiners(&combiners());
    // Of the other arrays there is none.
    for name in ["COL2", "TX1", "NOR", "WGH"] {
        program.send(&format!("VTXBUF_FMT_{name}"), 0, 2);
    }
    for number in 0..3 {
        let moved = 6.0 * number as f32;
        let rows = [[16.0, 0.0, 0.0, 0.0], [0.0, -16.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
        program.floats("PROJECTION_MATRIX", 0, &rows.concat());
        program.floats("VIEWPORT_TRANSLATE", 0, &[32.0 + moved - 2048.0, 32.0 - 2048.0, 0.0, 0.0]);
        for (name, offset, format) in [("POS", 0, 0x32), ("COL", 12, 0x44), ("TX0", 16, 0x22), ("FOG", 24, 0x12)] {
            program.send(&format!("VTXBUF_OFFSET_{name}"), 0, arrays[number.min(1)] + offset);
            program.send(&format!("VTXBUF_FMT_{name}"), 0, format | STRIDE << 8);
        }
        match number {
            0 => {
                program.send("VTXBUF_BEGIN_END", 0, 6);
                program.send("VTXBUF_BATCH", 0, 3 << 24);
                program.send("VTXBUF_BEGIN_END", 0, 0);
            }
            1 => {
                program.send("VERTEX_BEGIN_END", 0, 6);
                program.send("VTXBUF_ELEMENT_U16", 0, 1 << 16 | 3);
                program.send("VTXBUF_ELEMENT_U16", 1, 2);
                program.send("VTXBUF_ELEMENT_U32", 0, 0);
                program.send("VERTEX_BEGIN_END", 0, 0);
            }
            _ => {
                program.send("BLEND_FUNC_ENABLE", 0, 1);
                program.send("VTXBUF_DATA_BEGIN_END", 0, 6);
                let all: Vec<u8> = (0..4).flat_map(|corner| vertex_bytes(2, corner)).collect();
                for (n, word) in all.as_chunks::<4>().0.iter().enumerate() {
                    program.send("VTXBUF_DATA", n as u32 % 512, u32::from_le_bytes(*word));
                }
                program.send("VTXBUF_DATA_BEGIN_END", 0, 0);
            }
        }
    }
    program
}

#[test]
fn a_program_of_the_nv10_class_becomes_its_frame() {
    let program = played();
    let options = Options { surfaces_in_memory: true, ..Options::default() };
    let memory = Memory::new(program.memory);
    let (frames, summary) = import(program.log.as_bytes(), State::default(), &memory, options);
    assert_eq!((frames.len(), summary.draws, summary.unknown_lines.0), (1, 3, 0), "{:?}", summary.unknown_lines);
    assert_eq!(summary.words(Some(Treatment::Open)), 0, "{:?}", summary.methods);
    let gaps: Vec<String> = frames[0].drawn.iter().flat_map(|drawn| &drawn.gaps).map(ToString::to_string).collect();
    assert_eq!(gaps, [""; 0]);
    assert_eq!(frames[0].scene.profile, Profile::Nv10);
    let draw =
        |scene: &Scene| render(&Plan::compile(scene, &PlanOptions::default()).unwrap(), &RenderOptions::default());
    assert_eq!(difference(&draw(&frames[0].scene), &draw(&stated()), "the program"), None);
}

/// What the class has and the model does not is said of its draws.
#[test]
fn what_is_not_modelled_is_said() {
    let program = played();
    let damaged = |name: &str, word: u32| {
        let mut played = Program::default();
        played.send(name, 0, word);
        // Before the last draw.
        let at = program.log.rfind("method 0x3f,").or_else(|| program.log.rfind("method 0x5ff, param 0x6")).unwrap();
        let at = program.log[..at].rfind('\n').unwrap() + 1;
        let log = format!("{}{}{}", &program.log[..at], played.log, &program.log[at..]);
        let (frames, _) =
            import(log.as_bytes(), State::default(), &Memory::new(program.memory.clone()), Options::default());
        let gaps = &frames[0].drawn[2].gaps;
        gaps.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    };
    assert!(
        damaged("TEX_FORMAT", 1 | 0x28 | 5 << 7 | 1 << 12 | 3 << 16 | 3 << 20 | 3 << 24 | 3 << 28)
            .contains("from the texels' centres at unit 0")
    );
    assert!(damaged("TEX_FORMAT", 0x51 | 0x1b << 7).contains("texture format 0xff of unit 0"));
    assert!(damaged("VIEW_MATRIX_ENABLE", 7).contains("fog of vertices that are not transformed"));
    assert!(damaged("CLIPID_ENABLE", 1).contains("0x0d74 CLIPID_ENABLE"));
    assert!(damaged("SHADE_MODEL", 5).contains("0x037c SHADE_MODEL does not take 0x5"));
    assert!(damaged("FOG_MODE", 0x804).contains("0x029c FOG_MODE"));
}

/// A state that was never set has the class's own name.
#[test]
fn gaps_have_the_names_of_the_class() {
    let log = "execute_command: obj 0x7, class 0x0056, method 0x5ff, param 0x6\nexecute_command: obj 0x7, class 0x0056, method 0x600, param 0x0\n\
               execute_command: obj 0x7, class 0x0056, method 0x5ff, param 0x0\n";
    let (frames, summary) = import(log.as_bytes(), State::default(), &Memory::default(), Options::default());
    assert_eq!((summary.draws, summary.complete), (1, 0));
    let gaps: Vec<String> = frames[0].drawn[0].gaps.iter().map(ToString::to_string).collect();
    assert!(gaps.iter().any(|gap| gap.contains("0x0200 RT_HORIZ")), "{gaps:?}");
    assert!(gaps.iter().all(|gap| !gap.contains("SET_")), "{gaps:?}");
}
