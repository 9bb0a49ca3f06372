//! What the pages on commands show is what the commands print.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::bench;

use bench::Bench;
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
