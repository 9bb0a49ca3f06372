//! Reads the handbook, `docs/rules`: its entries, its examples, and ids that occur in files.

use crate::catalogue;
use crate::pages;
use crate::repository;
use crate::settings::bless;
use ninebit_handbook::{PAGES, Rule, parse};
use std::collections::BTreeSet;
use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

const PREFIXES: [&str; 24] = [
    "NUM", "RAS", "WGT", "INT", "FOG", "DEP", "TEX", "KEY", "TSH", "CMB", "FIN", "ROP", "STN", "CLP", "VTX", "VOL",
    "SHD", "CYL", "LIN", "PNT", "POL", "STP", "CLR", "SMO",
];

/// The entry of one rule.
pub type Entry = Rule<'static>;

/// Path of the handbook's index.
pub const INDEX: &str = "docs/rules/README.md";

/// All entries of the handbook in order, as the documents have them now.
pub static ENTRIES: LazyLock<Vec<Entry>> = LazyLock::new(|| {
    let pages = PAGES.iter().map(|(name, _)| (*name, read(format!("docs/rules/{name}")).leak()));
    pages.flat_map(|(name, text)| parse(name, text)).collect()
});

/// Returns the path of the page that has a rule.
pub fn page(rule: &str) -> String {
    let entry = ENTRIES.iter().find(|e| e.id == rule).unwrap_or_else(|| panic!("the handbook has no rule {rule}"));
    format!("docs/rules/{}", entry.page)
}

/// Returns the ids of rules that were replaced, from the table of the section "Superseded".
pub fn superseded() -> BTreeSet<String> {
    let page = read(INDEX);
    let (_, section) = page.split_once("\n## Superseded\n").unwrap();
    let section = section.split("\n## ").next().unwrap();
    section.lines().filter_map(|line| line.strip_prefix("| ")?.split_once(" | ")).flat_map(|(id, _)| ids(id)).collect()
}

/// Returns the rules that are built.
pub fn built() -> impl Iterator<Item = &'static Entry> {
    ENTRIES.iter().filter(|e| e.built)
}

/// The example of a rule while it is being computed.
pub struct Example {
    rule: &'static str,
}

/// Begins the example of `rule`. `text` is the line that the handbook shows; `BLESS=1` writes it there.
#[track_caller]
pub fn example(rule: &'static str, text: &str) -> Example {
    let entry = ENTRIES.iter().find(|e| e.id == rule).unwrap_or_else(|| panic!("the handbook has no rule {rule}"));
    let line = entry.field("Example");
    if line != text && bless() {
        let _writing = pages::WRITING.lock();
        let (path, page) = (page(rule), read(page(rule)));
        let start = page.find(&format!("\n### {rule} ")).unwrap();
        let at =
            start + page[start..].find("\n- Example: ").unwrap_or_else(|| panic!("{rule} has no line of its example"));
        let end = at + 1 + page[at + 1..].find('\n').unwrap();
        let written = format!("{}\n- Example: {text}{}", &page[..at], &page[end..]);
        pages::write(&repository::at(path), &written);
    } else {
        assert!(
            line == text,
            "{rule}: the example of the handbook is\n{line}\nand the test computes\n{text}\nBLESS=1 writes it"
        );
    }
    Example { rule }
}

/// Begins the parts of an example that the rows in `catalogue.txt` do not compute.
#[track_caller]
pub fn beside_rows(rule: &'static str) -> Example {
    assert!(catalogue::computes(rule), "{rule} has no rows");
    Example { rule }
}

impl Example {
    /// Compares a number of the example with the number that the model computes.
    #[track_caller]
    pub fn gives<T: PartialEq + Debug>(&self, what: &str, got: T, expected: T) -> &Example {
        assert!(got == expected, "{}: {what}: expected {expected:?}, the model gives {got:?}", self.rule);
        self
    }

    /// Compares a real number, which the example gives with `digits` decimals.
    #[track_caller]
    pub fn shows(&self, what: &str, got: f64, digits: usize, expected: &str) -> &Example {
        self.gives(what, format!("{got:.digits$}"), expected.to_string())
    }
}

/// Returns the text of a file of the repository.
pub fn read(path: impl AsRef<Path>) -> String {
    let path = repository::at(path);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Returns the files below a folder that have the given extension, sorted.
pub fn files(folder: impl AsRef<Path>, extension: &str) -> Vec<PathBuf> {
    let folder = repository::at(folder);
    let found = std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut paths: Vec<PathBuf> = found.map(|e| e.unwrap().path()).collect();
    paths.sort();
    let inside = |p: PathBuf| if p.is_dir() { files(&p, extension) } else { vec![p] };
    paths.into_iter().flat_map(inside).filter(|p| p.extension().is_some_and(|e| e == extension)).collect()
}

/// Returns every rule id in a text: a prefix, a dash, a number, at most one letter.
pub fn ids(text: &str) -> BTreeSet<String> {
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

/// Returns the string literals that have the form of an id, whatever their prefix, each with the code before it.
pub fn id_literals(source: &str) -> Vec<(&str, &str)> {
    let shaped = |text: &str| {
        let Some((prefix, number)) = text.split_once('-') else { return false };
        let digits = number.trim_end_matches(|c: char| c.is_ascii_lowercase());
        prefix.len() == 3
            && prefix.bytes().all(|b| b.is_ascii_uppercase())
            && !digits.is_empty()
            && digits.bytes().all(|b| b.is_ascii_digit())
    };
    let literal = |quote: usize| source[quote + 1..].split('"').next().filter(|text| shaped(text));
    source.match_indices('"').filter_map(|(at, _)| Some((&source[..at], literal(at)?))).collect()
}

/// Returns whether a source declares a function, type, trait or constant of that name. A mere mention does not count.
pub fn declares(source: &str, name: &str) -> bool {
    let named = |line: &str, keyword: &str| {
        line.match_indices(keyword).any(|(at, _)| {
            let rest = &line[at + keyword.len()..];
            let word = |c: char| c.is_alphanumeric() || c == '_';
            !line[..at].ends_with(word) && rest.strip_prefix(name).is_some_and(|rest| !rest.starts_with(word))
        })
    };
    let code = source.lines().map(str::trim_start).filter(|line| !line.starts_with("//"));
    code.into_iter().any(|line| ["fn ", "struct ", "enum ", "trait ", "const "].iter().any(|k| named(line, k)))
}

#[test]
fn ids_are_found_in_text() {
    let text = "CMB-3, INT-4t and (TEX-18); CMB-9=after, INT-5n. Not XCMB-3, CMB-x, CMB-, INT-4tt, UTF-8.";
    let want: BTreeSet<String> =
        ["CMB-3", "CMB-9", "INT-4t", "INT-5n", "TEX-18"].into_iter().map(str::to_string).collect();
    assert_eq!(ids(text), want);
}

#[test]
fn literals_are_found_whatever_their_prefix() {
    let source = r#"given("a", "RSA-3", '"', "RAS-3 is not one").rule("ROP-7"), "CMB-13", "INT-4t", "B8-1""#;
    let found: Vec<&str> = id_literals(source).into_iter().map(|found| found.1).collect();
    assert_eq!(found, ["RSA-3", "ROP-7", "CMB-13", "INT-4t"]);
}

#[test]
fn declarations_are_told_from_mentions() {
    let source = "// fn gone\n/// struct Gone\npub struct Registers<L> {\n    pub(super) fn run_all() {}\nconst TWO: i32 = 2; // see gone";
    for name in ["Registers", "run_all", "TWO"] {
        assert!(declares(source, name), "{name}");
    }
    for name in ["gone", "Gone", "Register", "run", "i32"] {
        assert!(!declares(source, name), "{name}");
    }
}
