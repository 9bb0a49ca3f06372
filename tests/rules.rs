//! `docs/numerics.md` against the sources: ids, grades, counts, policies, files, tests; and its worked examples, computed.
//!
//! A rule's entry is a heading `### ID title` followed by a list of fields, one a line: `- Grade: ...`.
#![allow(clippy::unwrap_used, reason = "a test")]

use ninebit::state::POLICIES;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

const PREFIXES: [&str; 9] = ["NUM", "RAS", "INT", "DEP", "TEX", "TSH", "CMB", "FIN", "ROP"];
const GRADES: [&str; 4] = ["SILICON", "DOCUMENT", "INFERRED", "CHOSEN"];
const FIELDS: [&str; 6] = ["Grade", "Formula", "Range", "Source", "Example", "Error"];

/// Suites that a checkout may lack: they compare with captures and with the independent oracle.
const SUITES: [&str; 3] = ["tests/oracle.rs", "tests/silicon_frames.rs", "tests/silicon_probes.rs"];

struct Entry {
    id: String,
    built: bool,
    /// Label and text of each field, in order.
    fields: Vec<(String, String)>,
}

impl Entry {
    fn field(&self, label: &str) -> &str {
        self.fields.iter().find(|f| f.0 == label).map_or("", |f| f.1.as_str())
    }

    /// The grades: each is a word that may be followed by a part in brackets.
    fn grades(&self) -> Vec<String> {
        let mut depth = 0;
        let mut plain = String::new();
        for c in self.field("Grade").chars() {
            match c {
                '(' => depth += 1,
                ')' => depth -= 1,
                c if depth == 0 => plain.push(c),
                _ => {}
            }
        }
        plain.split(',').map(|g| g.trim().to_string()).collect()
    }
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn handbook() -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    let (mut built, mut open) = (true, false);
    for line in read("docs/numerics.md").lines() {
        if let Some(title) = line.strip_prefix("## ") {
            built &= title != "Known, not built yet";
            open = false;
        } else if let Some(title) = line.strip_prefix("### ") {
            let id = title.split(' ').next().unwrap().to_string();
            entries.push(Entry { id, built, fields: Vec::new() });
            open = true;
        } else if let (true, Some((label, text))) = (open, line.strip_prefix("- ").and_then(|l| l.split_once(": "))) {
            entries.last_mut().unwrap().fields.push((label.to_string(), text.to_string()));
        }
    }
    entries
}

/// Files below a folder, sorted; none where the folder does not exist.
fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(found) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = found.map(|e| e.unwrap().path()).collect();
    paths.sort();
    paths.into_iter().flat_map(|p| if p.is_dir() { files(&p) } else { vec![p] }).collect()
}

/// Every rule id in a text: a prefix, a dash, a number, at most one letter.
fn ids(text: &str) -> BTreeSet<String> {
    let bytes = text.as_bytes();
    let mut found = BTreeSet::new();
    for (dash, _) in text.match_indices('-') {
        let Some(prefix) = dash.checked_sub(3).and_then(|start| text.get(start..dash)) else { continue };
        let joined = dash > 3 && bytes[dash - 4].is_ascii_alphanumeric();
        let digits = bytes[dash + 1..].iter().take_while(|b| b.is_ascii_digit()).count();
        if !PREFIXES.contains(&prefix) || joined || digits == 0 {
            continue;
        }
        let mut end = dash + 1 + digits;
        let letters = bytes[end..].iter().take_while(|b| b.is_ascii_alphanumeric()).count();
        if letters > 1 {
            continue;
        }
        end += letters;
        found.insert(text[dash - 3..end].to_string());
    }
    found
}

/// `file` and the names that follow it, from a Code or Pinned line.
fn references(text: &str) -> Vec<(String, Option<String>)> {
    let mut out: Vec<(String, Option<String>)> = Vec::new();
    for part in text.split(", ") {
        let mut quoted = part.split('`').skip(1).step_by(2);
        let file = quoted.next().unwrap_or_else(|| panic!("no file in `{part}`")).to_string();
        out.push((file, quoted.next().map(str::to_string)));
    }
    out
}

#[test]
fn ids_are_found_in_text() {
    let text = "CMB-3, INT-4t and (TEX-18); CMB-9=after, INT-5n. Not XCMB-3, CMB-x, CMB-, INT-4tt, UTF-8.";
    let want: BTreeSet<String> =
        ["CMB-3", "CMB-9", "INT-4t", "INT-5n", "TEX-18"].into_iter().map(str::to_string).collect();
    assert_eq!(ids(text), want);
}

#[test]
fn entries_are_complete() {
    let entries = handbook();
    assert!(entries.len() > 70, "{} entries", entries.len());
    let mut seen = BTreeSet::new();
    for entry in &entries {
        assert_eq!(ids(&entry.id), BTreeSet::from([entry.id.clone()]), "heading of {}", entry.id);
        assert!(seen.insert(&entry.id), "{} has two entries", entry.id);
        for grade in entry.grades() {
            assert!(GRADES.contains(&grade.as_str()), "{}: `{grade}` is no grade", entry.id);
        }
        let needed: &[&str] = if entry.built { &FIELDS } else { &FIELDS[..2] };
        for label in needed {
            assert!(!entry.field(label).is_empty(), "{} has no {label}", entry.id);
        }
    }
}

#[test]
fn every_id_in_the_sources_has_an_entry() {
    let known: BTreeSet<String> = handbook().into_iter().map(|e| e.id).collect();
    for file in files(&root().join("src")) {
        for id in ids(&read(&file)) {
            assert!(known.contains(&id), "{} mentions {id}, which docs/numerics.md does not have", file.display());
        }
    }
}

#[test]
fn every_id_in_the_documents_has_an_entry() {
    let known: BTreeSet<String> = handbook().into_iter().map(|e| e.id).collect();
    for file in files(&root().join("docs")).into_iter().chain([root().join("CHANGELOG.md")]) {
        for id in ids(&read(&file)) {
            assert!(known.contains(&id), "{} mentions {id}, which docs/numerics.md does not have", file.display());
        }
    }
}

#[test]
fn code_of_built_rules_exists_and_names_them() {
    for entry in handbook().iter().filter(|e| e.built) {
        let code = references(entry.field("Code"));
        for (file, function) in &code {
            let text = read(file);
            if let Some(function) = function {
                assert!(text.contains(&format!("fn {function}")), "{}: {file} has no fn {function}", entry.id);
            }
        }
        let mentions = code.iter().any(|(file, _)| ids(&read(file)).contains(&entry.id));
        assert!(mentions, "none of the files that {} names mentions it", entry.id);
    }
}

#[test]
fn built_rules_are_pinned() {
    for entry in handbook().iter().filter(|e| e.built) {
        let mut pinned = 0;
        for (file, test) in references(entry.field("Pinned by")) {
            if !root().join(&file).exists() && SUITES.contains(&file.as_str()) {
                continue;
            }
            let text = read(&file);
            if let Some(test) = &test {
                assert!(text.contains(&format!("fn {test}")), "{}: {file} has no test {test}", entry.id);
            }
            pinned += 1;
        }
        assert!(pinned > 0, "nothing pins {}", entry.id);
    }
}

#[test]
fn policies_are_spelled_out() {
    let entries = handbook();
    let mut spelled: Vec<String> = Vec::new();
    for policy in POLICIES {
        let entry = entries.iter().find(|e| e.id == policy.rule).unwrap_or_else(|| panic!("no {}", policy.rule));
        let text = entry.field("Policy");
        let mut from = 0;
        for (value, _) in policy.values {
            let flag = format!("`--policy {}={value}`", policy.rule);
            let at = text[from..].find(&flag).unwrap_or_else(|| panic!("{}: {flag} is missing, or not in order", entry.id));
            from += at + flag.len();
            spelled.push(flag);
        }
    }
    for entry in &entries {
        for flag in entry.field("Policy").split('`').filter(|t| t.starts_with("--policy")) {
            assert!(spelled.contains(&format!("`{flag}`")), "{}: `{flag}` does not exist", entry.id);
        }
        let is_policy = POLICIES.iter().any(|p| p.rule == entry.id);
        assert_eq!(is_policy, !entry.field("Policy").is_empty(), "{}", entry.id);
    }
    let order: Vec<usize> = POLICIES.iter().map(|p| entries.iter().position(|e| e.id == p.rule).unwrap()).collect();
    assert!(order.is_sorted(), "POLICIES is not in the order of docs/numerics.md");
}

#[test]
fn the_table_counts_right() {
    let entries = handbook();
    let mut want: BTreeMap<String, [usize; 3]> = BTreeMap::new();
    for entry in &entries {
        for (n, grade) in entry.grades().iter().enumerate() {
            let column = match (n, entry.built) {
                (0, true) => 0,
                (0, false) => 1,
                (_, true) => 2,
                (_, false) => continue,
            };
            want.entry(grade.clone()).or_default()[column] += 1;
        }
    }
    let all = want.values().fold([0; 3], |a, b| std::array::from_fn(|n| a[n] + b[n]));
    want.insert("all".to_string(), all);
    let text = read("docs/numerics.md");
    for (grade, counts) in want {
        let line = format!("| {grade} | {} | {} | {} |", counts[0], counts[1], counts[2]);
        assert!(text.contains(&line), "the table of grades should have the line\n{line}");
    }
}

/// Vector files name the rules that they pin in comment lines at their top.
#[test]
fn vector_files_name_known_rules() {
    let known: BTreeSet<String> = handbook().into_iter().map(|e| e.id).collect();
    for file in files(&root().join("vectors/silicon")) {
        let Ok(text) = std::fs::read_to_string(&file) else { continue };
        let header: String = text.lines().take_while(|l| l.starts_with('#') || l.starts_with("//")).collect();
        for id in ids(&header) {
            assert!(known.contains(&id), "{}: no rule {id}", file.display());
        }
    }
}
