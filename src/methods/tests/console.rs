//! The program for a console: compiled against a stub of its headers and run, while the importer is the chip.
#![allow(missing_docs, clippy::unwrap_used, reason = "tests fail by panicking")]

use std::io::{BufRead, BufReader, Cursor, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};

use ninebit::engine::{RenderOptions, render};
use ninebit::frame::Surface;
use ninebit::limits::{Limits, MEMORY_IMAGE};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::{Profile, TextureFormat};
use ninebit_files::read::{self, Kind};
use ninebit_methods::console::{ConsoleProgram, ConsoleScene, program, surface};
use ninebit_methods::export::{FIRST, export};
use ninebit_methods::frame::Frame;
use ninebit_methods::import::{Importer, Options, Sources};
use ninebit_methods::log::Reader;
use ninebit_methods::memory::{Layout, Memory, bytes};
use ninebit_methods::state::State;

fn content(path: &Path) -> Vec<u8> {
    read::bytes(path, Kind::Regular, MEMORY_IMAGE).unwrap()
}

/// Returns the scenes that decide, as scenes of nv2a, and two with several targets or a stencil, each with its surface.
fn scenes() -> Vec<(ConsoleScene, Surface)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vectors/scenes");
    let entries = std::fs::read_dir(root.join("deciding")).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "ron"));
    paths.retain(|path| !path.to_string_lossy().ends_with(".expect.ron"));
    paths.extend(["sampling/shadow-map.ron", "buffers/mirror.ron", "buffers/bytes.ron"].map(|path| root.join(path)));
    paths.sort();
    let scene = |path: &PathBuf| {
        let mut scene = ninebit_scene::load(path, &Limits::default()).unwrap().scene;
        scene.profile = Profile::Nv2a;
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        let methods = export(&scene, &plan).unwrap();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let drawn = render(&plan, &RenderOptions::default()).surfaces.swap_remove(0);
        (ConsoleScene { name, methods, target: scene.targets[0].clone() }, drawn)
    };
    paths.iter().map(scene).collect()
}

/// Writes the program and the stub into a folder and compiles them. `None` without a compiler.
fn compiled(folder: &Path, written: &ConsoleProgram) -> Option<PathBuf> {
    let put = |name: &str, content: &[u8]| {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, content).unwrap();
    };
    for (name, content) in &written.files {
        // What lies beside the program is its drive D.
        put(&name.strip_prefix("bin/").map_or_else(|| name.clone(), |name| format!("D:\\{name}")), content);
    }
    let stub = include_bytes!("console/stub.h");
    let headers = ["hal/debug.h", "hal/video.h", "nxdk/mount.h", "pbkit/pbkit.h", "windows.h", "xboxkrnl/xboxkrnl.h"];
    headers.iter().for_each(|header| put(header, stub));
    put("stub.h", stub);
    put("stub.c", include_bytes!("console/stub.c"));
    let sources = written.files.iter().map(|(name, _)| name.as_str()).filter(|name| name.ends_with(".c"));
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let mut command = Command::new(compiler);
    command.current_dir(folder).args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O1", "-I."]);
    match command.args(["-o", "program"]).args(sources).arg("stub.c").output() {
        Ok(output) => assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr)),
        Err(error) => {
            println!("no compiler for C, so the program was not run: {error}");
            return None;
        }
    }
    Some(folder.join("program"))
}

/// The chip: the importer, whose state stays from scene to scene.
struct Chip {
    folder: PathBuf,
    state: State,
}

impl Chip {
    /// Does the words of a scene: draws them, and puts the surfaces into memory.
    fn play(&mut self, base: u32, scene: &ConsoleScene) {
        let words = content(&self.folder.join("words"));
        let word = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap());
        let log: String =
            words.chunks(8).map(|pair| format!("0x{:x} 0x{:x}\n", word(&pair[..4]), word(&pair[4..]))).collect();
        let path = self.folder.join("memory");
        let mut memory = content(&path);
        let image = [vec![0; base as usize], memory.clone()].concat();
        let frame = self.frame(log.as_bytes(), Memory::new(image));
        let drawn: Vec<_> = frame.drawn.iter().filter(|drawn| !drawn.gaps.is_empty()).collect();
        assert!(drawn.is_empty(), "{}: {drawn:?}", scene.name);
        let plan = Plan::compile(&frame.scene, &PlanOptions::default()).unwrap();
        for (target, surface) in frame.scene.targets.iter().zip(render(&plan, &RenderOptions::default()).surfaces) {
            let address = target.name.split(' ').find_map(|word| u32::from_str_radix(word, 16).ok()).unwrap();
            let place = address - base;
            let number = scene.methods.surfaces.iter().position(|at| at - FIRST == place).unwrap();
            let format = match target.format.bytes() {
                4 => TextureFormat::A8R8G8B8,
                2 => TextureFormat::R5G6B5,
                _ => TextureFormat::L8,
            };
            let layout = if scene.methods.swizzled[number] {
                Layout::Swizzled
            } else {
                Layout::Pitch((target.width * target.format.bytes()).next_multiple_of(64))
            };
            let stored = bytes(&surface.words, format, [target.width, target.height, 1], layout);
            memory[place as usize..][..stored.len()].copy_from_slice(&stored);
        }
        std::fs::write(path, memory).unwrap();
    }

    fn frame(&mut self, log: &[u8], memory: Memory) -> Frame {
        let mut frames = Vec::new();
        let mut each = |frame| frames.push(frame);
        let options = Options { surfaces_in_memory: true, ..Options::default() };
        let state = std::mem::take(&mut self.state);
        let mut importer = Importer::new(state, Sources { memory, ..Sources::default() }, options, &mut each);
        let mut reader = Reader::default();
        reader.feed(log, &mut |entry| importer.take(&entry));
        reader.finish(&mut |entry| importer.take(&entry));
        self.state = importer.state().clone();
        importer.finish(Some(&reader));
        assert_eq!(frames.len(), 1);
        frames.remove(0)
    }
}

/// Runs the program to its end, and returns what it has printed.
fn printed(program: &mut Child, chip: &mut Chip, scenes: &[(ConsoleScene, Surface)]) -> Vec<String> {
    let mut answer: ChildStdin = program.stdin.take().unwrap();
    let (mut lines, mut played) = (Vec::new(), 0);
    for line in BufReader::new(program.stdout.take().unwrap()).lines().map(Result::unwrap) {
        match line.strip_prefix("play ") {
            Some(base) => {
                chip.play(base.parse().unwrap(), &scenes[played].0);
                played += 1;
                writeln!(answer, "played").unwrap();
            }
            None => lines.push(line),
        }
    }
    lines
}

#[test]
fn the_program_draws_what_the_model_draws() {
    let scenes = scenes();
    let written = program(&scenes.iter().map(|(scene, _)| scene.clone()).collect::<Vec<_>>());
    let folder = tempfile::tempdir().unwrap();
    let Some(path) = compiled(folder.path(), &written) else { return };
    // The last image of memory is cut off.
    let last = scenes.len() - 1;
    let cut = folder.path().join(format!("D:\\memory-{last}.bin"));
    let image = content(&cut);
    std::fs::write(&cut, &image[1..]).unwrap();
    let mut command = Command::new(path);
    command.current_dir(folder.path()).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut running = command.spawn().unwrap();
    let mut chip = Chip { folder: folder.path().to_path_buf(), state: State::default() };
    let lines = printed(&mut running, &mut chip, &scenes);
    assert_eq!(running.wait().unwrap().code(), Some(1), "{lines:?}");
    let mut expected: Vec<String> =
        (1..).zip(&scenes).map(|(number, (scene, _))| format!("{number} of {} {}", scenes.len(), scene.name)).collect();
    expected.push(format!("  D:\\memory-{last}.bin was not read"));
    expected.push(format!("{last} of {} scenes are in E:\\ninebit.zip", scenes.len()));
    assert_eq!(lines, expected);

    let file = content(&folder.path().join("E:\\ninebit.zip"));
    let mut archive = zip::ZipArchive::new(Cursor::new(file)).unwrap();
    assert_eq!(archive.len(), scenes.len());
    let mut entry = |name: &str| {
        let mut bytes = Vec::new();
        archive.by_name(name).unwrap().read_to_end(&mut bytes).unwrap();
        bytes
    };
    let device = String::from_utf8(entry("device.json")).unwrap();
    for part in [&written.root, "NV2A 02a000a3", "kernel 1.0.5838.1"] {
        assert!(device.contains(part), "{device}");
    }
    for (scene, drawn) in &scenes[..last] {
        let kept = surface(&entry(&format!("{}.surface", scene.name))).unwrap();
        assert_eq!((kept.width, kept.height, kept.format), (drawn.width, drawn.height, drawn.format), "{}", scene.name);
        let differing = kept.words.iter().zip(&drawn.words).filter(|(kept, drawn)| kept != drawn).count();
        assert_eq!(differing, 0, "{}", scene.name);
    }
}

/// The texts are the same whatever the number of scenes, and the table of a scene that decides is short.
#[test]
fn one_scene_is_the_same_program() {
    let mut all: Vec<ConsoleScene> = scenes().into_iter().map(|(scene, _)| scene).collect();
    all.retain(|scene| scene.name.starts_with(|c: char| c.is_ascii_uppercase()));
    let (one, several) = (program(&all[..1]), program(&all));
    let shared = |written: &ConsoleProgram| {
        let is_shared = |name: &str| !name.starts_with("scene-") && !name.starts_with("bin/") && name != "program.c";
        written.files.iter().filter(|(name, _)| is_shared(name)).cloned().collect::<Vec<_>>()
    };
    assert_eq!(shared(&one), shared(&several));
    assert_ne!(one.root, several.root);
    assert_eq!(several.files.len() - one.files.len(), 2 * (all.len() - 1));
    let largest = several.files.iter().filter(|(name, _)| name.ends_with(".c")).map(|(_, text)| text.len()).max();
    assert!(all.len() > 12 && largest < Some(16 << 10), "{largest:?}");
}
