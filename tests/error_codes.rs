//! `docs/errors.md` is made of the program's lists of codes, and the sources use no others.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::pages;
use ninebit_scene::code::CODES;
use ninebit_scene::ways_out::{OTHER_CODES, WAYS_OUT};
use ninebit_scene::{Diagnostic, Severity};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The chapters of the page, by the first two digits of their codes.
const CHAPTERS: [&str; 11] = ["01", "02", "03", "04", "05", "06", "07", "08", "09", "10", "12"];

/// Codes that occur in the files of a folder.
fn used(folder: &Path, codes: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            used(&path, codes);
            continue;
        }
        // A list of all codes uses none of them.
        if path.extension().is_some_and(|ending| ending == "gz") || path.ends_with("scene/ways_out.rs") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        for (at, _) in text.match_indices("\"NB") {
            let code = &text[at + 1..text[at + 1..].find('"').map_or(text.len(), |end| at + 1 + end)];
            if code.len() == 6 && code[2..].bytes().all(|digit| digit.is_ascii_digit()) {
                codes.insert(code.to_string());
            }
        }
    }
}

#[test]
fn the_lists_have_every_code_and_no_other() {
    let mut sources = BTreeSet::new();
    used(Path::new("src"), &mut sources);
    let listed: BTreeSet<String> = WAYS_OUT.iter().map(|(code, _)| (*code).to_owned()).collect();
    assert_eq!(listed, sources);
    assert!(WAYS_OUT.is_sorted_by(|a, b| a.0 < b.0), "the ways out are in the order of their codes");
    let meanings: BTreeSet<&str> = CODES.iter().chain(OTHER_CODES).map(|(code, _)| *code).collect();
    assert_eq!(meanings.len(), CODES.len() + OTHER_CODES.len(), "a code has two meanings");
    assert!(listed.iter().all(|code| meanings.contains(code.as_str())), "a code has no meaning");
}

/// The exit code of a finding about a scene, or of what is none.
fn exit(code: &'static str) -> u8 {
    if CODES.iter().any(|(known, _)| *known == code) {
        let finding = Diagnostic {
            code,
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
        _ => 6,
    }
}

#[test]
fn the_page_is_made_of_the_lists() {
    let meanings: BTreeMap<&str, &str> = CODES.iter().chain(OTHER_CODES).copied().collect();
    let mut written = 0;
    for chapter in CHAPTERS {
        let mut table = "| code | meaning | exit | way out |\n|---|---|---:|---|\n".to_owned();
        for (code, way_out) in WAYS_OUT.iter().filter(|(code, _)| &code[2..4] == chapter) {
            table += &format!("| {code} | {} | {} | {way_out} |\n", meanings[code], exit(code));
            written += 1;
        }
        pages::hold("docs/errors.md", &format!("tests/error_codes.rs ({chapter})"), &table);
    }
    assert_eq!(written, WAYS_OUT.len(), "a code belongs to no chapter");
}
