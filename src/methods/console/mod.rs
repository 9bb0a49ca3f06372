//! A program for a console, which draws scenes and keeps what the chip has stored of them.

mod answer;

use std::fmt::Write;

use ninebit::state::Target;
use ninebit_data::archive;
use ninebit_files::picture::hexadecimal;
use sha2::{Digest, Sha256};

pub use answer::surface;

use crate::class;
use crate::export::{FIRST, Methods};

/// A scene of the program.
#[derive(Clone, Debug)]
pub struct ConsoleScene {
    /// Its name: letters, digits, `-`, `_` and `.`, as the answer is called.
    pub name: String,
    /// Its words.
    pub methods: Methods,
    /// Its first target, which is kept.
    pub target: Target,
}

/// The files of a program for nxdk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConsoleProgram {
    /// Paths in the program's folder, and contents.
    pub files: Vec<(String, Vec<u8>)>,
    /// A digest of all words and images, which the answers name.
    pub root: String,
}

/// Longest name of a scene.
pub const LONGEST_NAME: usize = 60;

/// Returns the program that draws scenes one after another.
pub fn program(scenes: &[ConsoleScene]) -> ConsoleProgram {
    let mut files: Vec<(String, Vec<u8>)> = [
        ("main.c", include_str!("main.c")),
        ("program.h", include_str!("program.h")),
        ("Makefile", include_str!("Makefile")),
        ("archive.c", archive::SOURCE),
        ("archive.h", archive::HEADER),
    ]
    .map(|(name, text)| (name.to_owned(), text.as_bytes().to_vec()))
    .to_vec();
    let (mut declarations, mut entries, mut largest) = (String::new(), String::new(), 0);
    let mut hash = Sha256::new();
    for (number, scene) in scenes.iter().enumerate() {
        let table = table(number, scene);
        let image = scene.methods.memory.get(FIRST as usize..).unwrap_or_default();
        let layout = answer::layout(&scene.target, scene.methods.swizzled[0]);
        let size = [scene.target.width, scene.target.height, 1];
        let (bytes, head) =
            (layout.extent(size, scene.target.format.bytes().into()), answer::head(&scene.target, layout));
        let (name, place) = (&scene.name, scene.methods.surfaces[0] - FIRST);
        let count = words(&scene.methods).count();
        // Writing to a string cannot fail.
        let _ = writeln!(declarations, "extern const uint32_t scene_{number}[{count}][2];");
        let _ = writeln!(
            entries,
            "    {{ \"{name}\", scene_{number}, {count}, {}u, {place}u, {bytes}u, \"{}\\n\" }},",
            image.len(),
            head.trim_end()
        );
        largest = largest.max(image.len());
        for part in [name.as_bytes(), head.as_bytes(), table.as_bytes(), image] {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
        files.push((format!("scene-{number}.c"), table.into_bytes()));
        files.push((format!("bin/memory-{number}.bin"), image.to_vec()));
    }
    let root = hexadecimal(&hash.finalize());
    let text = format!(
        "#include \"program.h\"\n\n{declarations}\nconst scene scenes[] = {{\n{entries}}};\nconst int scene_count = {};\n\
         const uint32_t largest_memory = {largest}u;\nconst uint32_t first_place = {FIRST}u;\nconst char root[] = \"{root}\";\n",
        scenes.len()
    );
    files.push(("program.c".to_owned(), text.into_bytes()));
    ConsoleProgram { files, root }
}

/// Returns the words of a scene. The program waits for the chip itself.
fn words(methods: &Methods) -> impl Iterator<Item = &(u32, u32)> {
    methods.writes.iter().filter(|(method, _)| *method != class::FLIP_STALL)
}

/// Returns the table of a scene's words.
fn table(number: usize, scene: &ConsoleScene) -> String {
    let mut rows = String::with_capacity(24 * scene.methods.writes.len());
    for (method, word) in words(&scene.methods) {
        // Writing to a string cannot fail.
        let _ = writeln!(rows, "    {{0x{method:x}, 0x{word:x}}},");
    }
    format!(
        "/* Methods of {} with their words. */\n#include \"program.h\"\n\nextern const uint32_t scene_{number}[][2];\n\
         const uint32_t scene_{number}[][2] = {{\n{rows}}};\n",
        scene.name
    )
}
