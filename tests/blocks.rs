//! Runs the documents as a reader would: every console block in the order of its page, with the files that the page shows before, and every code
//! block in what reads its language.
//!
//! A block that cannot run says why in the line above it: `<!-- not run: needs a card -->`. A code block whose first line names a file in a comment
//! is written to that file for the commands that follow. Blocks of `text` are nothing that runs: diagrams, grammars, excerpts, which other tests hold.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use ninebit::engine::{self, RenderOptions};
use ninebit::limits::Limits;
use rayon::prelude::*;

use crate::bench::Bench;
use crate::docs::{documents, pages_below};
use crate::repository::at;

/// What stands above a block that is not run.
const NOT_RUN: &str = "<!-- not run: ";

/// A fenced block.
#[derive(Debug)]
pub struct Block {
    pub page: String,
    /// Number of its first line.
    pub line: usize,
    pub language: String,
    pub text: String,
    /// Why it is not run.
    pub reason: Option<String>,
}

impl Block {
    /// Returns the file that the first line names, as in `/* first.c */` or `// folder/a.ron`.
    fn file(&self) -> Option<&str> {
        let first = self.text.lines().next()?;
        let comment = first.strip_prefix("/* ").or(first.strip_prefix("// ")).or(first.strip_prefix("# "))?;
        let name = comment.split([' ', ':']).next()?;
        name.contains('.').then_some(name)
    }
}

/// Returns the blocks of a page.
pub fn blocks(page: &str) -> Vec<Block> {
    let text = fs::read_to_string(at(page)).unwrap();
    let (mut blocks, mut open, mut above) = (Vec::<Block>::new(), false, "");
    for (n, line) in text.lines().enumerate() {
        let fence = line.trim_start().strip_prefix("```");
        match (open, fence) {
            (false, Some(language)) => {
                let reason = above.trim_start().strip_prefix(NOT_RUN).and_then(|reason| reason.strip_suffix(" -->"));
                let (page, language, reason) = (page.to_owned(), language.to_owned(), reason.map(str::to_owned));
                blocks.push(Block { page, line: n + 2, language, text: String::new(), reason });
                open = true;
            }
            (true, Some(_)) => open = false,
            (true, None) => blocks.last_mut().unwrap().text += &format!("{line}\n"),
            (false, None) => above = line,
        }
    }
    assert!(!open, "{page}: a block does not end");
    blocks
}

/// Returns the pages with blocks: the documents, and those of vectors, fuzzing and benchmarks.
fn pages() -> Vec<String> {
    let others = ["vectors", "fuzz", "benches"].into_iter().flat_map(pages_below);
    documents().into_iter().chain(others).filter(|page| !page.contains("/target/")).collect()
}

/// What a page's reader has before the first command.
const GIVEN: &[(&str, &str)] = &[
    (
        "docs/evidence/hardware.md",
        // The picture of a card that takes the other alternative.
        "ninebit render vectors/scenes/deciding/CMB-3-expand.ron --policy CMB-3=literal -o captured.png",
    ),
    (
        "docs/ci.md",
        "mkdir scenes && cp vectors/scenes/dot3/constant-light.ron scenes/wall.ron && cp vectors/scenes/dot3/rocks-normal.png scenes && \
         ninebit render scenes/wall.ron --policy CMB-8=each -o scenes/wall.png && \
         printf '(version: 1, target: \"frame\", width: 640, height: 480, sha256: \"\", allowance: (picture: \"wall.png\", pixels: 0, \
         difference: 0, reason: \"an emulator\"))' > scenes/wall.expect.ron",
    ),
    ("docs/vectors.md", "ninebit vectors export --unit sum --unit product -o old-pack"),
];

/// Copies a folder, without what git ignores.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        if !entry.file_type().unwrap().is_dir() {
            fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
        } else if entry.file_name() != "captured" {
            copy(&entry.path(), &to.join(entry.file_name()));
        }
    }
}

/// Runs a command line in a shell. Returns its status and what it prints, errors last.
fn shell(bench: &Bench, command: &str) -> (Option<i32>, String) {
    let program = Path::new(env!("CARGO_BIN_EXE_ninebit")).parent().unwrap();
    let path = std::env::join_paths(
        [program.to_path_buf()].into_iter().chain(std::env::split_paths(&std::env::var_os("PATH").unwrap())),
    );
    let mut run = Command::new("sh");
    run.args(["-c", command]).current_dir(bench.path("")).stdin(Stdio::null()).env("PATH", path.unwrap());
    for name in ["CI", "NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "COLUMNS"] {
        run.env_remove(name);
    }
    let output = run.output().unwrap();
    (output.status.code(), String::from_utf8(output.stdout).unwrap() + &String::from_utf8(output.stderr).unwrap())
}

/// Runs the commands of a console block, and compares what each prints with the lines below it. `...` on a line of its own stands for any lines.
/// A command below which nothing stands has to succeed, or to find a difference (exit status 1).
fn run(bench: &Bench, block: &Block) {
    let mut commands: Vec<(String, String)> = Vec::new();
    for line in block.text.lines() {
        match (line.strip_prefix("$ "), commands.last_mut()) {
            (Some(command), _) => commands.push((command.replace("cargo run -- ", "ninebit "), String::new())),
            (None, Some((_, shown))) => *shown += &format!("{line}\n"),
            (None, None) => panic!("{}:{}: `{line}` stands before a command", block.page, block.line),
        }
    }
    assert!(!commands.is_empty(), "{}:{}: there is no command", block.page, block.line);
    for (command, shown) in commands {
        if let Some(file) = command.strip_prefix("cat ") {
            bench.write(file, shown);
            continue;
        }
        let (status, printed) = shell(bench, &command);
        if shown.is_empty() {
            assert!(matches!(status, Some(0 | 1)), "{}:{}: {command}: {printed}", block.page, block.line);
        } else {
            println!("{}:{}: {command}", block.page, block.line);
            snapbox::assert_data_eq!(printed.trim_end(), shown.trim_end().to_owned());
        }
    }
}

/// Reads a code block in what reads its language.
fn read(bench: &Bench, block: &Block) {
    let place = format!("{}:{}", block.page, block.line);
    match block.language.as_str() {
        "c" => {
            let name = "block.c";
            bench.write(name, &block.text);
            let include = at("src/c/include");
            let flags = "-std=c99 -Wall -Wextra -Werror -pedantic -fsyntax-only";
            // Without a compiler there is nothing that reads it.
            let command = format!("! command -v cc > /dev/null || cc {flags} -I '{}' -I . {name}", include.display());
            let (status, printed) = shell(bench, &command);
            assert_eq!(status, Some(0), "{place}: {printed}");
        }
        "ron" if block.text.contains("sha256:") => {
            ninebit::expectation::Expectation::parse(&block.text).unwrap_or_else(|error| panic!("{place}: {error}"));
        }
        "ron" => {
            let loaded = ninebit_scene::parse(&block.text, Path::new("block.ron"), &Limits::default());
            let loaded = loaded.unwrap_or_else(|error| panic!("{place}: {error}"));
            assert_eq!(loaded.render_warnings(false), "", "{place}");
            // Every example draws something visible.
            let words = &engine::render(&loaded.plan, &RenderOptions::default()).surfaces[0].words;
            assert!(words.iter().any(|word| *word != words[0]) || words[0] != 0xff00_0000, "{place}: blank");
        }
        "json" => drop(
            serde_json::from_str::<serde_json::Value>(&block.text).unwrap_or_else(|error| panic!("{place}: {error}")),
        ),
        "text" => {}
        // The tests of vertex programs run theirs (tests/vertex_programs.rs).
        "vs" => {}
        "combiners" | "pixel-shader" | "texture-stages" | "texture-environment" | "combiner-calls" => {
            bench.write("block", &block.text);
            let command = format!("ninebit lower block --from {} --to combiners", block.language);
            let (status, printed) = shell(bench, &command);
            assert_eq!(status, Some(0), "{place}: {printed}");
        }
        // The tests of the package run the code of its page (src/python/check).
        "python" if block.page == "docs/python.md" => {}
        language => panic!(
            "{place}: nothing here reads `{language}`: say in this test how, or above the block why it is not run"
        ),
    }
}

/// Runs the blocks of a page in order, in a folder of their own.
fn follow(page: &str) {
    let blocks = blocks(page);
    let reads_vectors = blocks.iter().any(|block| block.language == "console" && block.reason.is_none());
    let bench = Bench::new();
    if reads_vectors {
        for folder in ["vectors/scenes", "vectors/digests", "vectors/harness/c", "vectors/harness/lower"] {
            copy(&at(folder), &bench.path(folder));
        }
    }
    for (_, command) in GIVEN.iter().filter(|(given, _)| *given == page) {
        let (status, printed) = shell(&bench, command);
        assert_eq!(status, Some(0), "{command}: {printed}");
    }
    for block in blocks.iter().filter(|block| block.reason.is_none()) {
        if block.language == "console" {
            run(&bench, block);
            continue;
        }
        read(&bench, block);
        if let Some(file) = block.file() {
            fs::create_dir_all(bench.path(file).parent().unwrap()).unwrap();
            bench.write(file, &block.text);
        }
    }
}

#[cfg(unix)]
#[test]
fn every_block_does_what_the_page_shows() {
    let pages: Vec<String> = pages().into_iter().filter(|page| !blocks(page).is_empty()).collect();
    assert!(pages.len() > 15, "{pages:?}");
    // A page waits for its commands; those of several do side by side.
    let failed: Vec<&String> =
        pages.par_iter().filter(|page| std::panic::catch_unwind(|| follow(page)).is_err()).collect();
    assert!(failed.is_empty(), "{failed:?}: what differs stands above");
}

/// A reason is one, and stands above a block.
#[test]
fn blocks_that_are_not_run_say_why() {
    for page in pages() {
        let text = fs::read_to_string(at(&page)).unwrap();
        let reasons: Vec<String> = blocks(&page).into_iter().filter_map(|block| block.reason).collect();
        let written = text.lines().filter(|line| line.trim_start().starts_with(NOT_RUN)).count();
        assert_eq!(reasons.len(), written, "{page}: a reason without a block below");
        assert!(reasons.iter().all(|reason| reason.len() > 10), "{page}: {reasons:?}");
    }
}

/// A block that is wrong is noticed, whatever it is.
#[test]
fn wrong_blocks_are_noticed() {
    for (language, text) in [
        ("c", "int main(void) { return 0 }\n"),
        ("ron", "(version: 1)\n"),
        ("ron", "(version: 1, sha256: 3)\n"),
        ("json", "{\"a\": }\n"),
        ("sh", "true\n"),
        ("console", "$ ninebit limits --nothing\n"),
        ("console", "$ ninebit --version\nninebit 0.0.0\n"),
    ] {
        let block = Block { page: "x".into(), line: 1, language: language.into(), text: text.into(), reason: None };
        let bench = Bench::new();
        let held = || if language == "console" { run(&bench, &block) } else { read(&bench, &block) };
        assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(held)).is_err(), "{language}: {text}");
    }
}
