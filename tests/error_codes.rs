//! `docs/errors.md` and the sources have the same codes, with the same meanings and exit codes.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use ninebit_scene::code::CODES;
use ninebit_scene::{Diagnostic, Severity};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Meaning and exit code of each code of the page.
fn page() -> BTreeMap<String, (String, u8)> {
    let text = std::fs::read_to_string("docs/errors.md").unwrap();
    let mut codes = BTreeMap::new();
    for line in text.lines().filter(|line| line.starts_with("| NB")) {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [_, code, meaning, exit, way_out, _] = cells[..] else { panic!("{line}") };
        assert!(!way_out.is_empty(), "{line}");
        let before = codes.insert(code.to_string(), (meaning.to_string(), exit.parse().unwrap()));
        assert!(before.is_none(), "{code} stands twice");
    }
    codes
}

/// Codes that occur in the files of a folder.
fn used(folder: &Path, codes: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            used(&path, codes);
            continue;
        }
        if path.extension().is_some_and(|ending| ending == "gz") {
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
fn the_page_has_every_code_and_no_other() {
    let mut sources = BTreeSet::new();
    used(Path::new("src"), &mut sources);
    assert_eq!(page().into_keys().collect::<BTreeSet<_>>(), sources);
}

#[test]
fn meanings_and_exit_codes_are_those_of_the_program() {
    let page = page();
    for (code, meaning) in CODES.iter().copied() {
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
        let exit = if code.starts_with("NB09") { 0 } else { finding.kind().exit_code() };
        assert_eq!(page[code], (meaning.to_string(), exit), "{code}");
    }
    // Outputs, faults, packs of vectors and replays are no findings about a scene.
    for (code, (_, exit)) in page.iter().filter(|(code, _)| !CODES.iter().any(|(known, _)| known == code)) {
        let expected = match &code[..4] {
            "NB07" if ["NB0705", "NB0706", "NB0707"].contains(&code.as_str()) => 2,
            "NB07" => 7,
            "NB10" if code == "NB1001" => 4,
            "NB10" if code == "NB1013" => 5,
            "NB10" => 3,
            "NB12" if ["NB1201", "NB1202", "NB1203"].contains(&code.as_str()) => 4,
            "NB12" if code == "NB1207" => 5,
            "NB12" => 3,
            _ => 6,
        };
        assert_eq!(*exit, expected, "{code}");
    }
}
