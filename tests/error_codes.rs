//! Checks that `docs/errors.md` lists exactly the codes that the sources use, with the right exit codes.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::architecture;
use crate::repository::at;
use ninebit_scene::{Diagnostic, Severity};
use std::collections::BTreeSet;
use std::path::Path;

/// Chapters with codes that are no findings about a scene: outputs, internal faults, vector packs, replays, rules, planes, logs and GPUs.
const OTHERS: [&str; 8] = ["07", "08", "10", "12", "13", "14", "16", "17"];

/// A row of the page's tables.
pub struct Row {
    /// The two digits in the heading above the row.
    chapter: String,
    /// The code, such as `NB0101`.
    pub code: String,
    /// What the code means.
    pub meaning: String,
    exit: String,
    way_out: String,
}

/// Returns the rows of the page in order.
pub fn rows() -> Vec<Row> {
    let (mut rows, mut chapter) = (Vec::new(), String::new());
    for line in std::fs::read_to_string(at("docs/errors.md")).unwrap().lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            chapter = heading.rsplit_once('(').map_or(String::new(), |(_, digits)| digits.replace(')', ""));
        } else if line.starts_with("| NB") {
            let cells = line.trim_matches('|').split(" | ").map(|cell| cell.trim().to_owned());
            let [code, meaning, exit, way_out] = cells.collect::<Vec<_>>().try_into().expect(line);
            rows.push(Row { chapter: chapter.clone(), code, meaning, exit, way_out });
        }
    }
    rows
}

/// Returns the codes that occur in the files of a folder.
fn used(folder: &Path) -> BTreeSet<String> {
    let (mut found, mut codes) = (Vec::new(), BTreeSet::new());
    architecture::files(folder, &mut found);
    for path in found {
        let text = std::fs::read_to_string(&path).unwrap();
        for (at, _) in text.match_indices("\"NB") {
            let code = &text[at + 1..text[at + 1..].find('"').map_or(text.len(), |end| at + 1 + end)];
            if code.len() == 6 && code[2..].bytes().all(|digit| digit.is_ascii_digit()) {
                codes.insert(code.to_string());
            }
        }
    }
    codes
}

#[test]
fn the_page_has_every_code_and_no_other() {
    let sources = used(&at("src"));
    let rows = rows();
    assert_eq!(rows.iter().map(|row| row.code.clone()).collect::<BTreeSet<_>>(), sources);
    assert!(
        rows.is_sorted_by(|a, b| a.code < b.code),
        "the rows are in the order of their codes, each of which is there once"
    );
    for row in rows {
        assert_eq!(row.code[2..4], row.chapter, "{} stands in another chapter", row.code);
        assert!(!row.meaning.is_empty() && !row.way_out.is_empty(), "{} has no meaning, or no way out", row.code);
    }
}

/// Returns the exit code of an error code.
fn exit(code: &str) -> u8 {
    if !OTHERS.contains(&&code[2..4]) {
        let finding = Diagnostic {
            code: code.to_owned().leak(),
            severity: Severity::Error,
            message: String::new(),
            span: None,
            label: String::new(),
            related: Vec::new(),
            rule: None,
            notes: Vec::new(),
            help: None,
            file: None,
        };
        return if code.starts_with("NB09") { 0 } else { finding.kind().exit_code() };
    }
    match &code[..4] {
        "NB07" if ["NB0705", "NB0706", "NB0707"].contains(&code) => 2,
        "NB07" => 7,
        "NB10" if code == "NB1001" => 4,
        "NB10" if code == "NB1013" => 5,
        "NB10" => 3,
        "NB12" if ["NB1201", "NB1202", "NB1203"].contains(&code) => 4,
        "NB12" if code == "NB1207" => 5,
        "NB12" => 3,
        "NB08" if code == "NB0802" => 5,
        "NB13" | "NB14" => 2,
        "NB16" if code == "NB1602" => 4,
        "NB16" if ["NB1603", "NB1606"].contains(&code) => 5,
        "NB16" if code == "NB1607" => 0,
        "NB16" => 3,
        "NB17" if code == "NB1701" => 4,
        "NB17" if code == "NB1702" => 5,
        _ => 6,
    }
}

#[test]
fn the_page_has_the_exit_code_of_each() {
    for row in rows() {
        assert_eq!(row.exit, exit(&row.code).to_string(), "{}", row.code);
    }
}
