//! Checks indexes of pages, and tables of forms, functions and words.

use super::{names, rows, spans};
use crate::bench::Bench;
use crate::docs::{documents, pages_below};
use crate::repository::at;
use std::collections::BTreeSet;
use std::fs;

/// Returns the pages below `docs` that a table links to.
fn linked(page: &str, table: &str) -> BTreeSet<String> {
    let (folder, _) = page.rsplit_once('/').unwrap();
    let cells = rows(page, table).concat();
    let links = cells.iter().flat_map(|cell| cell.split("](").skip(1)).filter_map(|rest| rest.split([')', '#']).next());
    links
        .filter(|link| link.ends_with(".md") && !link.starts_with(".."))
        .map(|link| format!("{folder}/{link}"))
        .collect()
}

/// The index of each folder links to every page of the folder; that of all documents also to the folders' indexes.
#[test]
fn indexes_have_every_page() {
    for (folder, table) in [("docs", "pages"), ("docs/evidence", "pages"), ("docs/languages", "languages")] {
        let index = format!("{folder}/README.md");
        let linked = linked(&index, table);
        let inside = |page: &&String| page.strip_prefix(folder).is_some_and(|name| name[1..].split('/').count() == 1);
        // Old addresses of rules end on a page of links.
        let missing: Vec<String> = pages_below(folder)
            .iter()
            .filter(inside)
            .filter(|page| **page != index && *page != "docs/numerics.md" && !linked.contains(*page))
            .cloned()
            .collect();
        assert!(missing.is_empty(), "{index} does not link to {missing:?}");
    }
    let folders = ["decisions", "evidence", "lab", "languages", "rules"].map(|name| format!("docs/{name}/README.md"));
    let linked = linked("docs/README.md", "pages");
    assert!(folders.iter().all(|page| linked.contains(page)), "{linked:?}");
}

/// Every example of a form of logs is read as a log.
#[test]
fn forms_of_logs_are_read() {
    let bench = Bench::new();
    let mut examples = 0;
    for row in rows("docs/import.md", "forms") {
        for span in spans(&row[1]).into_iter().filter(|span| !span.starts_with("...")) {
            bench.write("example.log", format!("{span}\n"));
            let said = bench.run("import example.log --explain").text();
            assert!(said.contains("methods modelled: 1"), "{span}: {said}");
            examples += 1;
        }
    }
    assert!(examples > 8);
}

/// The table has every function of the header.
#[test]
fn functions_for_c_are_listed() {
    let header = fs::read_to_string(at("src/c/include/ninebit.h")).unwrap();
    let declared = header.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_lowercase()));
    let declared = declared.filter_map(|line| line.split_once('(')?.0.rsplit([' ', '*']).next());
    let declared: BTreeSet<&str> = declared.filter(|name| name.starts_with("ninebit_")).collect();
    let cells = rows("docs/c.md", "functions").concat();
    let listed: BTreeSet<&str> =
        cells.iter().flat_map(|cell| spans(cell)).filter(|span| span.starts_with("ninebit_")).collect();
    assert_eq!(listed, declared);
}

/// The causes of a technique's error, and the kinds of work, stand in the reports.
#[test]
fn causes_and_work_are_those_of_reports() {
    let bench = Bench::new();
    let run = |command: &str, scene: &str| {
        bench.run(&format!("{command} {}", at("vectors/scenes").join(scene).display())).text()
    };
    let measured = run("measure", "techniques/dot-product-texture-blending/diffuse-ceiling-own-normal.ron");
    let works = run("explain", "techniques/dot-product-texture-blending/diffuse-ceiling-own-normal.ron")
        + &run("explain", "texture-shader/mirror-ball.ron")
        + &run("explain", "buffers/mirror.ron");
    for (page, table, report) in [("docs/accuracy.md", "causes", &measured), ("docs/plan.md", "work", &works)] {
        for row in rows(page, table) {
            let names = row[0].replace("bytes read, written", "bytes read, bytes written");
            for name in names.split(", ") {
                assert!(report.contains(name), "{page}: {name} is not in the report:\n{report}");
            }
        }
    }
}

/// Types of columns read a number at the end of their range.
#[test]
fn types_of_columns_are_read() {
    use ninebit_vectors::units;
    let used: BTreeSet<String> = units::all()
        .iter()
        .flat_map(|unit| unit.inputs().into_iter().chain(unit.results()))
        .map(|column| column.kind.code().trim_end_matches(|c: char| c.is_ascii_digit()).to_owned())
        .map(|code| if code.starts_with("e:") { "e:".to_owned() } else { code })
        .collect();
    let listed = names("docs/vectors.md", "types").into_iter();
    let listed = listed.map(|name| match name.split_once(':') {
        Some((letter, _)) => format!("{letter}:"),
        None => name.trim_end_matches(|c: char| c.is_ascii_digit()).to_owned(),
    });
    assert_eq!(listed.collect::<BTreeSet<_>>(), used);
}

/// Commands of tests name targets of Cargo, and modules or folders of scenes.
#[test]
fn commands_of_tests_name_what_there_is() {
    let manifest = fs::read_to_string(at("src/cli/Cargo.toml")).unwrap();
    let mut checked = 0;
    for (page, table) in [("docs/testing.md", "tests"), ("CONTRIBUTING.md", "blessing")] {
        let cells = rows(page, table).concat();
        for command in cells.iter().flat_map(|cell| spans(cell)).filter(|span| span.contains("cargo test")) {
            let words: Vec<&str> = command.split(' ').skip_while(|word| *word != "test").skip(1).collect();
            if let Some(at_target) = words.iter().position(|word| *word == "--test") {
                let target = words[at_target + 1];
                assert!(manifest.contains(&format!("name = \"{target}\"")), "{command}");
                if let Some(filter) = words.get(at_target + 2).filter(|word| !word.starts_with('-')) {
                    let path = filter.trim_end_matches("::").replace("::", "/").replace("scenes/", "vectors/scenes/");
                    let found = [format!("tests/{path}.rs"), path.clone(), format!("{path}.ron")];
                    assert!(found.iter().any(|path| at(path).exists()), "{command}: {found:?}");
                }
            }
            checked += 1;
        }
    }
    assert!(checked >= 7, "{checked}");
}

/// Each folder of `src` stands in one ring.
#[test]
fn rings_have_every_folder() {
    let cells: Vec<String> = rows("docs/architecture.md", "rings").into_iter().map(|row| row[1].clone()).collect();
    let named: Vec<&str> = cells.iter().flat_map(|cell| spans(cell)).filter(|span| !span.contains('/')).collect();
    for entry in fs::read_dir(at("src")).unwrap() {
        let folder = entry.unwrap().file_name().into_string().unwrap();
        assert_eq!(named.iter().filter(|name| **name == folder).count(), 1, "{folder}");
    }
    assert!(named.iter().all(|name| at("src").join(name).is_dir() || at(name).is_dir()), "{named:?}");
}

/// Documents beside the glossary use each of its words.
#[test]
fn words_of_the_glossary_are_used() {
    let pages = documents().into_iter().filter(|page| page != "docs/glossary.md" && page != "CHANGELOG.md");
    let text: String = pages.map(|page| fs::read_to_string(at(page)).unwrap()).collect();
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase();
    for row in ["chip", "evidence", "program", "fast engine"].iter().flat_map(|table| rows("docs/glossary.md", table)) {
        for word in row[0].split(", ") {
            assert!(text.contains(&word.to_lowercase()), "no document uses `{word}`");
        }
    }
}

/// Each section on texture units has its symptom in the list at the head, in order.
#[test]
fn symptoms_lead_to_every_section() {
    let page = fs::read_to_string(at("docs/lab/stability.md")).unwrap();
    let (list, sections) = page.split_once("<!-- held by tests/tables.rs (symptoms): end -->").unwrap();
    let listed = list.lines().filter_map(|line| line.strip_prefix("- [")?.split_once("](#")?.1.strip_suffix(')'));
    let titles = sections.lines().filter_map(|line| line.strip_prefix("## "));
    let titles = titles.take_while(|title| *title != "Where methods fail").map(crate::docs::slug);
    assert_eq!(listed.map(str::to_owned).collect::<Vec<_>>(), titles.collect::<Vec<_>>());
}
