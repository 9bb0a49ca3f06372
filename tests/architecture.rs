//! Checks that the sources follow the module dependencies of `docs/architecture.md`.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::circles::circles;
use crate::pages;
use crate::repository::{at, name};
use std::path::{Path, PathBuf};

/// Modules that may use only one another and the standard library.
const CORE: [&str; 8] = ["state", "number", "trace", "algebra", "raster", "texture", "combiner", "rop"];

/// Appends all files below a folder except for compressed ones.
pub fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_none_or(|ending| ending != "gz") {
            found.push(path);
        }
    }
}

/// Returns the path and the text of each source in a folder, without comments and unit tests.
fn sources(folder: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    files(&at(folder), &mut found);
    found
        .into_iter()
        .filter(|path| !name(path).ends_with("_tests.rs"))
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            let code = text.split("\nmod tests {").next().unwrap().lines();
            let code: Vec<&str> = code.filter(|line| !line.trim_start().starts_with("//")).collect();
            (name(&path), code.join("\n"))
        })
        .collect()
}

/// Returns the names that follow `prefix` in a text.
fn names_after<'a>(text: &'a str, prefix: &str) -> Vec<&'a str> {
    text.split(prefix)
        .skip(1)
        .map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap())
        .collect()
}

/// Returns the names of the workspace's dependencies except for the model.
fn crates() -> Vec<String> {
    let manifest = std::fs::read_to_string(at("Cargo.toml")).unwrap();
    let dependencies = manifest.split("[workspace.dependencies]").nth(1).unwrap().split("\n[").next().unwrap();
    dependencies
        .lines()
        .filter(|line| !line.starts_with("ninebit = "))
        .filter_map(|line| line.split_once(" = "))
        .map(|(name, _)| name.replace('-', "_"))
        .collect()
}

#[test]
fn the_core_uses_itself_and_the_standard_library() {
    let crates = crates();
    assert!(crates.iter().any(|name| name == "rayon"));
    for module in CORE {
        for (file, text) in sources(&format!("src/model/{module}")) {
            for name in names_after(&text, "crate::") {
                // `$crate::state` in a macro counts as well. The macro `named` is allowed.
                assert!(CORE.contains(&name) || name == "named", "{file} uses {name}");
            }
            for name in &crates {
                assert!(!text.contains(&format!("{name}::")), "{file} uses the crate {name}");
            }
        }
    }
}

/// `number` must not depend on observers, and `algebra` must not depend on the modules that run its operations.
#[test]
fn numbers_and_the_algebra_stand_below() {
    for (module, below) in [("number", &["state", "number"][..]), ("algebra", &["state", "algebra", "trace"])] {
        for (file, text) in sources(&format!("src/model/{module}")) {
            for name in names_after(&text, "crate::") {
                assert!(below.contains(&name) || name == "named", "{file} uses {name}");
            }
        }
    }
}

#[test]
fn only_the_combiners_read_policies() {
    for module in CORE.into_iter().filter(|module| !["state", "algebra", "combiner"].contains(module)) {
        for (file, text) in sources(&format!("src/model/{module}")) {
            assert!(!text.contains("Policies"), "{file}");
        }
    }
}

#[test]
fn the_oracle_is_independent() {
    for (file, text) in sources("tests/oracle") {
        for name in names_after(&text, "ninebit::") {
            assert!(name == "state" || name == "frame", "{file} uses ninebit::{name}");
        }
    }
}

/// Names from outside are printed and reported only through `shown`, which makes them safe.
#[test]
fn names_are_shown_in_one_place() {
    for (file, text) in sources("src") {
        assert!(file == "src/model/shown.rs" || !text.contains(".display()"), "{file}: `shown::path` shows a path");
        // The exceptions: annotations are commands, tables of numbers contain no names, and a trace is streamed in parts that `shown` has
        // already made safe.
        let bytes = [
            "src/files/output.rs",
            "src/cli/commands/replay.rs",
            "src/cli/commands/op/table.rs",
            "src/cli/commands/trace.rs",
        ];
        assert!(
            bytes.contains(&file.as_str()) || !text.contains("write_stdout"),
            "{file}: `write_text` or `write_json`"
        );
    }
}

/// Files in `tests` do not become test binaries by themselves. A file that neither the suite nor the manifest names would never run.
#[test]
fn every_test_file_runs() {
    let (suite, manifest) =
        ["tests/suite.rs", "src/cli/Cargo.toml"].map(|file| std::fs::read_to_string(at(file)).unwrap()).into();
    for entry in std::fs::read_dir(at("tests")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        if path.extension().is_some_and(|extension| extension == "rs") {
            let named = suite.contains(&format!("mod {name};")) || manifest.contains(&format!("/tests/{name}.rs\""));
            assert!(named, "neither tests/suite.rs nor src/cli/Cargo.toml names {}", path.display());
        }
    }
}

/// Limits and the record of inputs apply only to files that are read through `read`, so every file has to be.
#[test]
fn files_are_read_in_one_place() {
    for (file, text) in sources("src").into_iter().filter(|(file, _)| file != "src/files/read.rs") {
        for call in ["fs::read(", "fs::read_to_string(", "File::open("] {
            assert!(!text.contains(call), "{file} has {call}");
        }
    }
}

/// Returns the folder and the manifest of each crate.
fn manifests() -> Vec<(PathBuf, String)> {
    let folders = std::fs::read_dir(at("src")).unwrap().map(|entry| entry.unwrap().path());
    let mut folders: Vec<PathBuf> =
        folders.chain([at("vectors")]).filter(|folder| folder.join("Cargo.toml").exists()).collect();
    folders.sort();
    let text = |folder: &PathBuf| std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
    folders.into_iter().map(|folder| (folder.clone(), text(&folder))).collect()
}

/// The page's table of crates is generated from their manifests.
#[test]
fn crates_are_listed() {
    let mut table = "| folder | crate | what it is for | uses |\n|---|---|---|---|\n".to_owned();
    for (folder, manifest) in manifests() {
        let package = manifest.split("[package]\n").nth(1).unwrap();
        let field = |name: &str| {
            let start = format!("{name} = \"");
            package.lines().find_map(|line| Some(line.strip_prefix(&start)?.trim_end_matches('"').to_owned())).unwrap()
        };
        let dependencies = package.split("\n[dependencies]\n").nth(1).unwrap_or("").split("\n[").next().unwrap();
        let own = dependencies.lines().filter(|line| line.starts_with("ninebit"));
        // The model by its alias.
        let own = own.map(|line| line.split([' ', '.', '=']).next().unwrap());
        let named = own.map(|name| if name == "ninebit" { "`ninebit-model`".to_owned() } else { format!("`{name}`") });
        let uses = named.collect::<Vec<_>>().join(", ");
        table += &format!("| `{}` | `{}` | {} | {uses} |\n", name(&folder), field("name"), field("description"));
    }
    pages::hold("docs/architecture.md", "tests/architecture.rs", &table);
}

/// A crate whose documentation has no examples has its doc tests turned off, because rustdoc needs a second for each crate even to find
/// none. Such a crate must not get examples.
#[test]
fn crates_without_tests_of_documentation_have_no_examples() {
    let mut silent = 0;
    for (folder, _) in manifests().into_iter().filter(|(_, manifest)| manifest.contains("doctest = false")) {
        silent += 1;
        let mut found = Vec::new();
        files(&folder, &mut found);
        for path in found.iter().filter(|path| path.extension().is_some_and(|ending| ending == "rs")) {
            let text = std::fs::read_to_string(path).unwrap();
            let comments = text.lines().map(str::trim_start).filter_map(|line| {
                line.strip_prefix("///")
                    .or_else(|| line.strip_prefix("//!"))
                    .or(line.strip_prefix("#![doc = include_str!"))
            });
            let lines: Vec<&str> = comments.map(str::trim_start).collect();
            let fences = lines.windows(2).filter_map(|pair| Some((pair[0].strip_prefix("```")?, pair[1])));
            // Every second fence ends a block. Included text is an example that is tested elsewhere.
            let opening = fences.step_by(2).find(|(words, next)| !words.starts_with("text") && !next.starts_with('('));
            assert!(opening.is_none(), "{}: {opening:?}", path.display());
        }
    }
    assert!(silent > 0);
}

/// The Rust version that is pinned for builds of the repository is the version that the crates declare.
#[test]
fn the_pinned_compiler_is_the_promised_one() {
    let value = |path: &str, key: &str| {
        let text = std::fs::read_to_string(at(path)).unwrap();
        let line = text.lines().find_map(|line| line.strip_prefix(key)).unwrap();
        line.trim_matches(['=', ' ', '"']).to_owned()
    };
    let (pinned, promised) = (value("rust-toolchain.toml", "channel"), value("Cargo.toml", "rust-version"));
    assert_eq!(pinned, format!("{promised}.0"));
}

/// Recipes of the justfile run only Cargo or scripts of the repository.
#[test]
fn recipes_run_what_there_is() {
    let text = std::fs::read_to_string(at("justfile")).unwrap();
    let commands = text.lines().filter_map(|line| line.strip_prefix("    "));
    let programs: Vec<&str> =
        commands.map(|line| line.trim_start_matches("BLESS=1 ").split(' ').next().unwrap()).collect();
    assert!(programs.len() >= 10, "{programs:?}");
    for program in programs.into_iter().filter(|program| !["cargo", "@just"].contains(program)) {
        assert!(at(program).is_file(), "the justfile runs {program}");
    }
}

#[test]
fn no_circle_of_imports_spans_more_than_two_files() {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(at("src")).unwrap() {
        let folder = name(&entry.unwrap().path());
        let prefix = format!("{folder}/");
        let files: Vec<(String, String)> = sources(&folder)
            .into_iter()
            .filter_map(|(file, text)| Some((file.strip_prefix(&prefix)?.to_owned(), text)))
            .filter(|(file, _)| file.ends_with(".rs") && !file.starts_with("examples/") && !file.starts_with("tests/"))
            .collect();
        assert!(!files.is_empty(), "{folder} has no sources");
        for circle in circles(&files).into_iter().filter(|circle| circle.len() > 2) {
            found.extend(circle.iter().map(|(file, used)| format!("{prefix}{file} imports {}", used.join(", "))));
        }
    }
    assert!(found.is_empty(), "files that import one another:\n{}", found.join("\n"));
}
