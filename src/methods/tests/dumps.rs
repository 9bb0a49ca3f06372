//! The folder of a hardware tracer: each draw begins as the chip's surface was, reads the textures that were dumped, and ends as the surface that
//! followed. The chip is played by the model.
#![allow(missing_docs, clippy::unwrap_used, reason = "tests fail by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use ninebit::engine::{RenderOptions, render};
use ninebit::frame::Surface;
use ninebit::limits::LOG;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;
use ninebit_files::read::Kind;
use ninebit_methods::class;
use ninebit_methods::dumps::{Dumps, LOG_FILE};
use ninebit_methods::export::{Methods, export, trace};
use ninebit_methods::frame::Frame;
use ninebit_methods::gap::Gap;
use ninebit_methods::import::{Importer, Options, Part, Sources, Summary};
use ninebit_methods::log::Reader;
use ninebit_methods::memory::{Layout, bytes};
use ninebit_methods::pgraph::DUMP_BYTES;
use ninebit_methods::state::State;
use ninebit_methods::vertex::microcode::{SLOTS, passthrough};

const SIDES: [u32; 2] = [20, 12];

fn scene() -> Scene {
    let texture =
        Texture::from_words(TextureFormat::A8R8G8B8, [4, 4], (0..16).map(|n| n * 0x0f0f_1f2f).collect::<Vec<u32>>());
    let depth = DepthBuffer { format: DepthFormat::Z24S8, clear: 0xff_ffff, clear_stencil: 3 };
    let target = Target { depth: Some(depth), ..Target::new(SIDES[0], SIDES[1], SurfaceFormat::A8R8G8B8) };
    let at = |depth: f32, side: f32| {
        let mut draw = Draw::rectangle(side, side);
        draw.vertices.map_positions(|[x, y, _, w]| [x, y, depth, w]);
        draw.depth_test = Some(DepthTest::new(CompareFunction::Less, true));
        draw
    };
    let textured = |draw: Draw| {
        let mut draw = draw.texture(0, TextureUnit::new(0));
        let shown = FinalInput { register: FinalRegister::Texture0, component: Component::Rgb, invert: false };
        draw.combiners.final_combiner.inputs = [FinalInput::zero(Component::Rgb); 6];
        draw.combiners.final_combiner.inputs[3] = shown;
        draw
    };
    let (source, destination) = (BlendFactor::ConstantColor, BlendFactor::One);
    let blended = |draw: Draw, constant: [u8; 4]| Draw {
        blend: Some(Blend { equation: BlendEquation::Add, source, destination }),
        blend_constant: constant,
        ..draw
    };
    let draws = vec![
        Draw { name: "textured".into(), ..textured(at(0.5, 9.0)) },
        Draw { name: "behind".into(), ..blended(at(0.75, 12.0), [40, 60, 80, 255]) },
        Draw { name: "before".into(), ..blended(textured(at(0.25, 11.0)), [90, 50, 30, 20]) },
    ];
    Scene { profile: Profile::Nv2a, targets: vec![target], textures: vec![texture], palettes: vec![], draws }
}

fn surface_after(scene: &Scene, draws: usize) -> Surface {
    let scene = Scene { draws: scene.draws[..draws].to_vec(), ..scene.clone() };
    let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    render(&plan, &RenderOptions::default()).surfaces.remove(0)
}

fn read(path: &Path) -> Vec<u8> {
    ninebit_files::read::bytes(path, Kind::Regular, LOG).unwrap()
}

fn word(methods: &Methods, method: u32) -> u32 {
    methods.writes.iter().find(|(number, _)| *number == method).unwrap().1
}

/// Writes what the tracer writes: the log, a texture before each draw that has one, both buffers after the clear and after each draw.
fn play(folder: &Path, scene: &Scene) {
    let methods = export(scene, &Plan::compile(scene, &PlanOptions::default()).unwrap()).unwrap();
    fs::write(folder.join(LOG_FILE), format!("pgraph method log from nvtrc\n{}", trace(&methods))).unwrap();
    let pitch = word(&methods, class::SET_SURFACE_PITCH);
    let texture = word(&methods, class::SET_TEXTURE_OFFSET) as usize;
    for dump in 0..=scene.draws.len() {
        // The clear has the number of the draw that follows it.
        let (draw, surface) = (dump.saturating_sub(1), surface_after(scene, dump));
        let buffers = [
            ("Color", class::SET_SURFACE_COLOR_OFFSET, &surface.words, TextureFormat::A8R8G8B8, pitch & 0xffff),
            ("Depth", class::SET_SURFACE_ZETA_OFFSET, &surface.depth, TextureFormat::Z24S8, pitch >> 16),
        ];
        for (buffer, offset, words, format, pitch) in buffers {
            let stem = format!("{:010}_{draw}_{dump}_Surface_{buffer}", 10 * dump);
            let image = bytes(words, format, [SIDES[0], SIDES[1], 1], Layout::Pitch(pitch));
            fs::write(folder.join(format!("{stem}.bin")), image).unwrap();
            let at = word(&methods, offset);
            let text = format!(
                "{{\n  \"surface\": {{\n    \"description\": \"20 x 12 [pitch = {pitch}], at 0x{at:08X}, format 0xC\"\n  }}\n}}\n"
            );
            fs::write(folder.join(format!("{stem}.txt")), text).unwrap();
        }
        if dump > 0 && scene.draws[draw].textures[0].is_some() {
            let name = format!("{:010}_{draw}_{dump}_Texture_0_0.bin", 10 * dump - 1);
            fs::write(folder.join(name), &methods.memory[texture..texture + 64]).unwrap();
        }
    }
}

fn import(folder: &Path, part: Part) -> (Vec<Frame>, Summary) {
    let sources = Sources { dumps: Dumps::open(folder).unwrap(), ..Sources::default() };
    let mut frames = Vec::new();
    let mut each = |frame| frames.push(frame);
    let mut importer = Importer::new(State::default(), sources, Options { part, ..Options::default() }, &mut each);
    let mut reader = Reader::new();
    reader.feed(&read(&folder.join(LOG_FILE)), &mut |entry| importer.take(&entry));
    let summary = importer.finish(Some(&reader));
    assert_eq!(reader.unknown, 0, "{:?}", reader.first_unknown);
    (frames, summary)
}

fn drawn(frame: &Frame) -> Surface {
    let plan = Plan::compile(&frame.scene, &PlanOptions::default()).unwrap();
    render(&plan, &RenderOptions::default()).surfaces.remove(0)
}

#[test]
fn each_draw_begins_and_ends_as_the_chips_surface() {
    let (folder, scene) = (tempfile::tempdir().unwrap(), scene());
    play(folder.path(), &scene);
    let (frames, summary) = import(folder.path(), Part::EachDraw);
    assert_eq!((frames.len(), summary.draws, summary.complete), (3, 3, 3), "{frames:#?}");
    for (number, frame) in frames.iter().enumerate() {
        let (held, surface) = (&frame.held[0], drawn(frame));
        let expected = surface_after(&scene, number + 1);
        assert_eq!((frame.number, held.draw, held.target), (number as u64, number as u64, 0));
        assert_eq!(held.words.as_ref(), Some(&expected.words), "draw {number}");
        assert_eq!(held.depth.as_ref(), Some(&expected.depth), "draw {number}");
        assert_eq!((surface.words, surface.depth), (expected.words, expected.depth), "draw {number}");
    }
    assert_ne!(surface_after(&scene, 2).words, surface_after(&scene, 3).words);
}

#[test]
fn a_frame_ends_as_its_last_surface() {
    let (folder, scene) = (tempfile::tempdir().unwrap(), scene());
    play(folder.path(), &scene);
    for part in [Part::All, Part::Frame(0), Part::Draw(2)] {
        let (frames, _) = import(folder.path(), part);
        let (frame, expected) = (&frames[0], surface_after(&scene, 3));
        assert!(frame.is_complete(), "{:?}", frame.drawn);
        assert_eq!(frame.held[0].words.as_ref(), Some(&expected.words));
        assert_eq!(drawn(frame).words, expected.words, "{part:?}");
    }
}

/// A texture that was not dumped is said; so is a surface that no dump shows.
#[test]
fn what_was_not_dumped_is_missing() {
    let (folder, scene) = (tempfile::tempdir().unwrap(), scene());
    play(folder.path(), &scene);
    for entry in fs::read_dir(folder.path()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if name.contains("Texture") || name.contains("_0_0_Surface_Color") {
            fs::remove_file(path).unwrap();
        }
    }
    let (frames, summary) = import(folder.path(), Part::EachDraw);
    let kinds = |frame: &Frame| frame.drawn[0].gaps.iter().map(Gap::kind).collect::<BTreeSet<_>>();
    let gaps: Vec<Vec<&str>> = frames.iter().map(|frame| kinds(frame).into_iter().collect()).collect();
    assert_eq!(
        gaps,
        [vec!["contents from before the log", "no memory was given"], vec![], vec!["no memory was given"]]
    );
    assert_eq!((summary.complete, frames[0].held.len()), (1, 1));
}

/// State that the log lacks comes from the registers and the constants that were dumped with the draw.
#[test]
fn registers_and_constants_complete_the_state() {
    let (folder, scene) = (tempfile::tempdir().unwrap(), scene());
    play(folder.path(), &scene);
    let log = String::from_utf8(read(&folder.path().join(LOG_FILE))).unwrap();
    let lacking = |line: &&str| !["_BLEND_", "SET_DEPTH_FUNC"].iter().any(|name| line.contains(name));
    let lines: Vec<&str> = log.lines().filter(lacking).collect();
    fs::write(folder.path().join(LOG_FILE), lines.join("\n")).unwrap();
    let (frames, summary) = import(folder.path(), Part::EachDraw);
    assert_eq!(summary.complete, 0, "{frames:#?}");
    let mut registers = vec![0; DUMP_BYTES];
    let mut put = |at: usize, word: u32| registers[at..at + 4].copy_from_slice(&word.to_le_bytes());
    // Less; add, the constant colour and one; what is in the log as well has nonsense here.
    put(0x194c, 1 << 16 | 0xff);
    put(0x1804, 2 | 1 << 3 | 0xc << 4 | 1 << 8);
    put(0x1808, 0xff28_3c50);
    fs::write(folder.path().join("0000000020_1_PGRAPH.bin"), registers).unwrap();
    fs::write(folder.path().join("0000000020_1_RDI_Constants_0.bin"), [0; 64]).unwrap();
    let (frames, summary) = import(folder.path(), Part::EachDraw);
    assert_eq!(summary.complete, 2, "{:#?}", frames.iter().map(|frame| &frame.drawn).collect::<Vec<_>>());
    assert_eq!(frames[1].scene.draws[0].blend, scene.draws[1].blend);
    assert_eq!(drawn(&frames[1]).words, surface_after(&scene, 2).words);
}

/// The vertex program lies in the dump from the last word of a slot to the first.
#[test]
fn a_dumped_program_stands_for_the_log_s() {
    let (folder, scene) = (tempfile::tempdir().unwrap(), scene());
    play(folder.path(), &scene);
    let log = String::from_utf8(read(&folder.path().join(LOG_FILE))).unwrap();
    let lines: Vec<&str> = log.lines().filter(|line| !line.contains("SET_TRANSFORM_PROGRAM[")).collect();
    fs::write(folder.path().join(LOG_FILE), lines.join("\n")).unwrap();
    assert_eq!(import(folder.path(), Part::EachDraw).1.complete, 0);
    let mut slots = passthrough();
    slots.resize(SLOTS, [0; 4]);
    let bytes: Vec<u8> =
        slots.iter().flat_map(|[a, b, c, d]| [d, c, b, a]).flat_map(|word| word.to_le_bytes()).collect();
    fs::write(folder.path().join("0000000001_0_RDI_Shader.bin"), bytes).unwrap();
    let (frames, summary) = import(folder.path(), Part::EachDraw);
    assert_eq!(summary.complete, 3, "{:#?}", frames.iter().map(|frame| &frame.drawn).collect::<Vec<_>>());
    assert_eq!(drawn(&frames[2]).words, surface_after(&scene, 3).words);
}
