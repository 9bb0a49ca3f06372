//! What the pages on commands show is what the commands print.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::bench;

use bench::Bench;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Runs the `$ ninebit` lines of a page's console blocks in order, in one folder; what follows each is its output. A line of three
/// dots stands for any lines.
fn commands_print_what_is_shown(page: &str) {
    let bench = Bench::new();
    copy(Path::new("vectors/scenes"), &bench.path("vectors/scenes"));
    let text = fs::read_to_string(page).unwrap();
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
fn diff() {
    commands_print_what_is_shown("docs/diff.md");
}

#[test]
fn op() {
    commands_print_what_is_shown("docs/op.md");
}

/// The variables that tests and the program's own unit tests read are those that the page lists.
#[test]
fn variables_of_tests_are_listed() {
    let page = fs::read_to_string("docs/testing.md").unwrap();
    let listed =
        page.lines().filter_map(|line| line.strip_prefix("| `")).filter_map(|line| line.split(['`', '=']).next());
    let listed: BTreeSet<String> = listed.filter(|name| name.starts_with("NINEBIT_")).map(str::to_owned).collect();
    let mut read = BTreeSet::new();
    let mut folders = vec![Path::new("tests").to_path_buf(), Path::new("src").to_path_buf()];
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
