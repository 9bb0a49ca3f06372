//! Checks tables of the documents row by row: the names in a row exist, and the table has all of them.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod pages;
mod programs;

use crate::bench::Bench;
use crate::docs::pages_below;
use crate::repository::at;
use ninebit_vectors::units;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;

/// Returns the cells of the rows of a table that this file holds.
fn rows(page: &str, table: &str) -> Vec<Vec<String>> {
    let text = fs::read_to_string(at(page)).unwrap();
    let [begin, end] = ["begin", "end"].map(|word| format!("<!-- held by tests/tables.rs ({table}): {word} -->\n"));
    let (_, rest) = text.split_once(&begin).unwrap_or_else(|| panic!("{page} has no line {begin}"));
    let (lines, _) = rest.split_once(&end).unwrap_or_else(|| panic!("{page} has no line {end}"));
    let lines = lines.lines().filter_map(|line| line.strip_prefix("| ")?.strip_suffix(" |"));
    let rows: Vec<Vec<String>> =
        lines.skip(1).map(|line| line.split(" | ").map(|cell| cell.trim().to_owned()).collect()).collect();
    assert!(rows.len() > 2, "{page}: {table}");
    rows
}

/// Returns the code spans of a cell.
fn spans(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// Returns the code spans of the first cells of a table.
fn names(page: &str, table: &str) -> BTreeSet<String> {
    rows(page, table).iter().flat_map(|row| spans(&row[0])).map(str::to_owned).collect()
}

/// Every command, option, mode or form of a table is in the help of the command.
#[test]
fn names_are_in_the_help() {
    for (page, table, command) in [
        ("README.md", "commands", ""),
        ("docs/accuracy.md", "modes", "compare"),
        ("docs/ci.md", "options", "replay"),
        ("docs/ci.md", "reports", "replay"),
        ("docs/evidence/captures.md", "options", "captures check"),
        ("docs/evidence/shortcuts.md", "options", "score"),
        ("docs/lower.md", "languages", "lower"),
        ("docs/op.md", "operations", "op"),
    ] {
        let help = Bench::new().run(&format!("{command} --help")).text();
        let words: BTreeSet<&str> =
            help.split(|c: char| !c.is_alphanumeric() && c != '-').filter(|word| !word.is_empty()).collect();
        for row in rows(page, table) {
            for span in spans(&row[0]) {
                let name = span.strip_prefix("ninebit ").unwrap_or(span);
                let name = name.strip_prefix(command).unwrap_or(name).trim_start();
                let name = name.split([' ', '=']).next().unwrap();
                assert!(words.contains(name), "{page}: the help of `{command}` has no `{name}`");
            }
        }
    }
}

/// The table of questions has every deciding scene in a row that begins with its rule, and only units that exist.
#[test]
fn questions_have_their_scenes_and_units() {
    let mut named = BTreeSet::new();
    for row in rows("docs/evidence/hardware.md", "questions") {
        for span in spans(&row[3]) {
            let path = at("vectors/scenes").join(span);
            assert!(path.is_file() || units::by_name(span).is_some(), "{span} is no scene and no unit");
            if let Some(name) = span.strip_prefix("deciding/") {
                let rule: Vec<&str> = name.split('-').take(2).collect();
                assert!(row[1].contains(&rule.join("-")), "{span} stands beside {}", row[1]);
                named.insert(name.to_owned());
            }
        }
    }
    let scenes = fs::read_dir(at("vectors/scenes/deciding")).unwrap();
    let scenes = scenes.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let scenes: BTreeSet<String> =
        scenes.filter(|name| name.ends_with(".ron") && !name.ends_with(".expect.ron")).collect();
    assert_eq!(named, scenes);
}

/// Returns the names of an object's fields.
fn keys(value: &Value) -> BTreeSet<String> {
    value.as_object().unwrap().keys().cloned().collect()
}

#[test]
fn fields_of_reports_are_listed() {
    let bench = Bench::new();
    let picture = at("docs/images/lit-stone.png");
    let picture = picture.to_str().unwrap();
    let document: Value =
        serde_json::from_str(&bench.run(&format!("diff {picture} {picture} --format json")).text()).unwrap();
    assert_eq!(names("docs/ci.md", "fields of diff"), keys(&document));

    let folder = at("vectors/scenes/dot3");
    let replay = format!("replay {} --policy CMB-8=each --report json=-", folder.to_str().unwrap());
    let document: Value = serde_json::from_slice(&bench.run(&replay).stdout).unwrap();
    let listed = names("docs/ci.md", "fields of replay");
    let scenes = document["scenes"].as_array().unwrap();
    let differing = scenes.iter().find(|scene| scene["status"] == "differs").unwrap();
    let of_scenes = rows("docs/ci.md", "fields of replay").into_iter().find(|row| row[0] == "`scenes`").unwrap();
    let all: BTreeSet<String> =
        listed.iter().map(String::as_str).chain(spans(&of_scenes[1])).map(str::to_owned).collect();
    for key in keys(&document).into_iter().chain(keys(differing)) {
        assert!(all.contains(&key), "the page does not list `{key}`");
    }
}

/// A replay's statuses are those of its source.
#[test]
fn statuses_are_listed() {
    let source = fs::read_to_string(at("src/cli/replay/outcome.rs")).unwrap();
    let words = source.lines().filter(|line| line.trim_start().starts_with("Outcome::"));
    let words = words.filter_map(|line| line.split_once("=> \"")?.1.split('"').next());
    assert_eq!(names("docs/ci.md", "statuses"), words.map(str::to_owned).collect());
}

#[test]
fn fields_of_expectations_are_listed() {
    let source = fs::read_to_string(at("src/cli/expectation.rs")).unwrap();
    let (_, fields) = source.split_once("pub struct Expectation {").unwrap();
    let (fields, _) = fields.split_once("\n}").unwrap();
    let fields = fields.lines().filter_map(|line| line.trim_start().strip_prefix("pub ")?.split(':').next());
    assert_eq!(names("docs/scene-format.md", "expectations"), fields.map(str::to_owned).collect());
}

/// A pack has the files that its page lists, its tables the columns and values.
#[test]
fn packs_are_as_described() {
    const PAGE: &str = "docs/vectors.md";
    let bench = Bench::new();
    bench.run("vectors export --unit product --view hex --view jsonl --view c --gpu-batches -o pack").data();
    for name in names(PAGE, "files") {
        let stem = "units/product";
        let path = match name.strip_prefix('.') {
            Some(ending) => format!("{stem}.{ending}"),
            None => name.replace("UNIT", "product"),
        };
        let path = path.replace("*.schema.json", "row.schema.json");
        assert!(bench.path("pack").join(&path).is_file(), "the pack has no {path}");
    }
    let (columns, reaches) = (names(PAGE, "columns"), names(PAGE, "reach"));
    let mut found = BTreeSet::new();
    for folder in ["vectors/packs/nv2a", "vectors/packs/nv10"] {
        for entry in fs::read_dir(at(folder)).unwrap() {
            let text = fs::read_to_string(entry.unwrap().path()).unwrap();
            let mut lines = text.lines().filter(|line| !line.starts_with('#'));
            let header: Vec<&str> = lines.next().unwrap().split('\t').collect();
            for column in &header {
                let group = column.split_once('.').map_or((*column).to_owned(), |(group, _)| format!("{group}."));
                assert!(columns.contains(&group), "{column}");
            }
            let reach = header.iter().position(|column| *column == "reach").unwrap();
            found.extend(lines.map(|line| line.split('\t').nth(reach).unwrap().to_owned()));
        }
    }
    assert_eq!(found, reaches);
}

/// Every input of the combiner language is read, and printed as it stands.
#[test]
fn inputs_of_the_combiner_language_are_read() {
    const PAGE: &str = "docs/languages/combiner-language.md";
    let bench = Bench::new();
    for input in names(PAGE, "mappings").into_iter().filter(|span| span.contains("tex0")) {
        bench.write("block.rc", format!("{{ rgb {{ spare0 = {input} * tex1; }} }} out.rgb = spare0; out.a = fog.a;"));
        let printed = bench.run("lower block.rc --to combiners --profile nv2a").text();
        assert!(printed.contains(&format!("spare0 = {input} * tex1;")), "{input}: {printed}");
    }
    for name in names(PAGE, "registers").into_iter().filter(|name| !name.contains('.')) {
        let more = "color_sum = spare0 + col1; final_product = tex0 * tex1; out.a = tex0.a;";
        bench.write("block.rc", format!("{{ rgb {{ spare0 = tex0; spare1 = tex1; }} }} {more} out.rgb = {name};"));
        let run = bench.run("lower block.rc --to combiners --profile nv2a");
        assert_eq!(run.status, 0, "{name}: {}", run.stderr);
    }
}

/// The handbook's pages are all in the table of its index.
#[test]
fn pages_of_rules_are_listed() {
    let table = rows("docs/rules/README.md", "pages");
    let linked: BTreeSet<String> = table
        .iter()
        .map(|row| format!("docs/rules/{}", row[0].split(['(', ')']).nth(1).unwrap()))
        .chain(["docs/rules/README.md".to_owned()])
        .collect();
    assert_eq!(linked, pages_below("docs/rules").into_iter().collect());
    for row in table {
        let page = row[0].split(['(', ')']).nth(1).unwrap();
        let prefixes = |rule: &ninebit_handbook::Rule<'_>| rule.id.split('-').next().unwrap().to_owned();
        let found: BTreeSet<String> =
            ninebit_handbook::RULES.iter().filter(|rule| rule.page == page).map(prefixes).collect();
        assert_eq!(row[1].split(", ").map(str::to_owned).collect::<BTreeSet<_>>(), found, "{page}");
    }
}

/// Every modifier, selector and mask of pixel shaders is read.
#[test]
fn modifiers_of_pixel_shaders_are_read() {
    let bench = Bench::new();
    for span in names("docs/languages/pixel-shader.md", "modifiers") {
        let instruction = match span.as_str() {
            ".a" => "mov r0, t0.a".to_owned(),
            ".b" => "mov r0.a, t0.b".to_owned(),
            mask if mask.starts_with('.') => format!("mov r0{mask}, t0"),
            suffix if suffix.starts_with('_') => format!("mov{suffix} r0, t0"),
            source => format!("mov r0, {}", source.replacen('x', "t0", 1)),
        };
        bench.write("block.psh", format!("ps.1.1\ntex t0\nmov r0, t0\n{instruction}\n"));
        let run = bench.run("lower block.psh --to combiners --profile nv2a");
        assert_eq!(run.status, 0, "{instruction}: {}", run.stderr);
    }
}

/// The page of commands leads from every command to its page, that of errors has every exit code.
#[test]
fn commands_and_exit_codes_are_listed() {
    let help = Bench::new().run("--help").text();
    let (_, commands) = help.split_once("Commands:\n").unwrap();
    let (commands, _) = commands.split_once("\nOptions:").unwrap();
    let commands = commands.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let commands = commands.filter(|name| !name.is_empty() && *name != "help").map(str::to_owned);
    assert_eq!(names("docs/commands.md", "pages"), commands.collect());
    let (_, codes) = help.split_once("Exit status:\n").unwrap();
    let codes: Vec<&str> = codes.lines().filter_map(|line| line.trim().split(' ').next()).collect();
    let listed = rows("docs/errors.md", "exit codes");
    assert_eq!(listed.iter().map(|row| row[0].as_str()).collect::<Vec<_>>(), codes);
}

/// Frames are left out of suites that are drawn.
#[test]
fn omitted_frames_are_of_known_suites() {
    let suites: BTreeSet<&str> = ninebit_captures::suites().collect();
    for row in rows("docs/evidence/captures.md", "omitted") {
        for part in row[0].split("; ") {
            let name = part.split([' ', ',']).next().unwrap();
            let is_captured = ninebit_captures::captured().any(|(suite, _)| suite == name);
            assert!(is_captured || suites.iter().any(|suite| suite.starts_with(name)), "{name}");
        }
    }
}

/// The modules of the model are files or folders.
#[test]
fn modules_exist() {
    for row in rows("docs/architecture.md", "modules") {
        for name in spans(&row[0]) {
            let path = at("src/model").join(name.replace("::", "/"));
            assert!(path.is_dir() || path.with_extension("rs").is_file(), "{name}");
        }
    }
}

/// Texture instructions are made of units that exist.
#[test]
fn units_of_instructions_exist() {
    for row in rows("docs/vectors.md", "instructions") {
        let units = spans(&row[1]);
        assert!(!units.is_empty() && units.iter().all(|name| units::by_name(name).is_some()), "{units:?}");
    }
}
