//! Checks that the pages show what the commands print.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::bench;
use crate::pages;
use crate::repository::{at, name};

use bench::Bench;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Runs the `$ ninebit` lines of a page's console blocks in order, in one folder, and compares the output with the lines that follow each.
/// `...` on a line of its own stands for any lines.
fn commands_print_what_is_shown(page: &str) {
    let bench = Bench::new();
    copy(&at("vectors/scenes"), &bench.path("vectors/scenes"));
    let text = fs::read_to_string(at(page)).unwrap();
    for block in text.split("```console\n").skip(1) {
        let block = block.split("```").next().unwrap();
        for part in block.split("$ ").skip(1) {
            let (command, shown) = part.split_once('\n').unwrap();
            if let Some(file) = command.strip_prefix("cat ") {
                bench.write(file, shown);
                continue;
            }
            let run = bench.run(command.strip_prefix("ninebit ").unwrap());
            let printed = String::from_utf8(run.stdout).unwrap() + &run.stderr;
            snapbox::assert_data_eq!(printed.trim_end(), shown.trim_end().to_owned());
        }
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &to.join(entry.file_name()));
        } else {
            fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
        }
    }
}

#[test]
fn commands() {
    commands_print_what_is_shown("docs/commands.md");
}

#[test]
fn compare() {
    commands_print_what_is_shown("docs/compare.md");
}

#[test]
fn diff() {
    commands_print_what_is_shown("docs/diff.md");
}

#[test]
fn op() {
    commands_print_what_is_shown("docs/op.md");
}

/// The page on testing lists exactly the variables that the tests read.
#[test]
fn variables_of_tests_are_listed() {
    let page = fs::read_to_string(at("docs/testing.md")).unwrap();
    let listed =
        page.lines().filter_map(|line| line.strip_prefix("| `")).filter_map(|line| line.split(['`', '=']).next());
    let listed: BTreeSet<String> = listed.filter(|name| name.starts_with("NINEBIT_")).map(str::to_owned).collect();
    let mut read = BTreeSet::new();
    let mut folders = vec![at("tests"), at("src")];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(path).unwrap();
                let names = text.split("(\"NINEBIT_").skip(1).map(|rest| rest.split('"').next().unwrap());
                let is_name =
                    |name: &&str| !name.is_empty() && name.bytes().all(|b| b.is_ascii_uppercase() || b == b'_');
                read.extend(names.filter(is_name).map(|name| format!("NINEBIT_{name}")));
            }
        }
    }
    assert!(read.len() >= 8, "{read:?}");
    assert_eq!(listed, read);
}

/// Largest number of words in all documents that are written and maintained by hand, as opposed to those that a program writes or a test
/// checks row by row.
const MAX_WORDS: usize = 45_000;

/// Pages whose console blocks are run, so that the text after a command is its output.
const RUN: [&str; 5] = ["docs/answers.md", "docs/commands.md", "docs/compare.md", "docs/diff.md", "docs/op.md"];

/// Templates that programs fill in. They count as written by hand.
const TEMPLATES: [&str; 2] = ["src/lab/chart/page.md", "src/lab/experiments/page.md"];

/// Returns the pages in a folder and below it, sorted.
fn pages_below(folder: &str) -> Vec<String> {
    let (mut found, mut folders) = (Vec::new(), vec![at(folder)]);
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                found.push(name(&path));
            }
        }
    }
    found.sort();
    found
}

/// Returns the paths of the documents.
fn documents() -> Vec<String> {
    let top = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md"].map(Into::into);
    top.into_iter().chain(pages_below("docs")).collect()
}

/// Numbers of words in a document as `wc -w` counts them: written by hand, in tables that a test checks row by row, and generated.
#[derive(Clone, Copy, Default)]
struct Words {
    by_hand: usize,
    held: usize,
    generated: usize,
}

impl Words {
    fn from_page(page: &str) -> Words {
        let text = fs::read_to_string(at(page)).unwrap();
        let (mut words, mut inside, mut console) = (Words::default(), None, false);
        for line in text.lines() {
            if TEMPLATES.contains(&page) {
                words.by_hand += line.split_whitespace().count();
                continue;
            }
            if line.starts_with("<!-- ") && line.ends_with(": begin -->") {
                assert!(inside.is_none(), "{page}: {line} stands inside another");
                inside = Some(if line.starts_with("<!-- generated by ") { "generated" } else { "held" });
                continue;
            } else if line.starts_with("<!-- ") && line.ends_with(": end -->") {
                assert!(inside.take().is_some(), "{page}: {line} ends nothing");
                continue;
            }
            if line.starts_with("```") {
                console = line == "```console" && RUN.contains(&page);
            }
            let output = console && !line.starts_with("```") && !line.starts_with("$ ");
            let written = page == "docs/numerics.md" && line.starts_with("- Example: ")
                || page == "docs/answers.md" && line.starts_with("- Rules: ");
            let checked = match page {
                "docs/numerics.md" => &["- Code: ", "- Decided by: ", "- Pinned by: ", "- Policy: "][..],
                "docs/answers.md" => &["- Vectors: "],
                _ => &[],
            };
            let count = line.split_whitespace().count();
            match inside {
                Some("held") => words.held += count,
                Some(_) => words.generated += count,
                None if output || written => words.generated += count,
                None if checked.iter().any(|start| line.starts_with(start)) => words.held += count,
                None => words.by_hand += count,
            }
        }
        assert!(inside.is_none(), "{page}: a part does not end");
        words
    }
}

/// Limits the words by hand. `cargo test --test suite docs::words -- --nocapture` prints the table.
#[test]
fn words() {
    let mut table = format!("{:>8} {:>8} {:>9}\n", "by hand", "held", "generated");
    let mut all = Words::default();
    let documents = documents();
    for page in documents.iter().map(String::as_str).chain(TEMPLATES) {
        let Words { by_hand, held, generated } = Words::from_page(page);
        table += &format!("{by_hand:>8} {held:>8} {generated:>9} {page}\n");
        all = Words { by_hand: all.by_hand + by_hand, held: all.held + held, generated: all.generated + generated };
    }
    table += &format!("{:>8} {:>8} {:>9} together", all.by_hand, all.held, all.generated);
    println!("{table}");
    assert!(all.by_hand <= MAX_WORDS, "{} words by hand, {MAX_WORDS} are allowed:\n{table}", all.by_hand);
}

/// Returns the anchors of a page's headings as GitHub forms them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut code = false;
    for line in text.lines() {
        code ^= line.starts_with("```");
        let Some(title) = line.trim_start_matches('#').strip_prefix(' ').filter(|_| line.starts_with('#') && !code)
        else {
            continue;
        };
        let kept = title.to_lowercase().replace(' ', "-");
        let slug: String = kept.chars().filter(|c| c.is_alphanumeric() || ['-', '_'].contains(c)).collect();
        let repeated = (1..).map(|n| format!("{slug}-{n}")).find(|other| !found.contains(other)).unwrap();
        found.insert(if found.contains(&slug) { repeated } else { slug });
    }
    found
}

/// Every link in the documents and in the pages of vectors, fuzzing and benchmarks leads to a file, and if it has an anchor to a heading.
#[test]
fn links_lead_somewhere() {
    let mut broken = Vec::new();
    let others = ["vectors", "fuzz", "benches"].into_iter().flat_map(pages_below);
    for page in documents().into_iter().chain(others).filter(|page| !page.contains("/target/")) {
        let text = fs::read_to_string(at(&page)).unwrap();
        let folder = at(&page).parent().unwrap().to_path_buf();
        let mut code = false;
        for line in text.lines() {
            code ^= line.trim_start().starts_with("```");
            if code {
                continue;
            }
            let targets = line.split("](").skip(1).filter_map(|rest| rest.split(')').next());
            for target in targets.filter(|target| !target.contains("://")) {
                let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
                let path = if file.is_empty() { at(&page) } else { folder.join(file) };
                let known = if anchor.is_empty() {
                    path.exists()
                } else {
                    fs::read_to_string(&path).is_ok_and(|text| anchors(&text).contains(anchor))
                };
                if !known {
                    broken.push(format!("{page}: {target}"));
                }
            }
        }
    }
    assert!(broken.is_empty(), "these links lead nowhere:\n{}", broken.join("\n"));
}

/// The list of decisions is generated from their titles.
#[test]
fn decisions_are_listed() {
    let mut files: Vec<_> = fs::read_dir(at("docs/decisions")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let mut table = "| number | decision |\n|---|---|\n".to_owned();
    for file in files.iter().filter(|file| !file.ends_with("README.md")) {
        let (name, text) = (file.file_name().unwrap().to_str().unwrap(), fs::read_to_string(file).unwrap());
        let title = text.lines().next().unwrap().strip_prefix("# ").unwrap();
        let (number, title) = title.split_once(' ').unwrap();
        assert!(name.starts_with(&format!("{number}-")), "{name} is called {number}");
        let status = text.lines().nth(2).unwrap();
        assert!(status.starts_with("*20") && status.ends_with(".*"), "{name}: its third line says since when it holds");
        table += &format!("| [{number}]({name}) | {title} |\n");
    }
    pages::hold("docs/decisions/README.md", "tests/docs.rs", &table);
}
