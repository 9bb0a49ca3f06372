//! Examples that rows of units compute, as `ninebit op unit` does. `catalogue.txt` lists them.

use crate::bench::{Bench, Run};
use crate::handbook::{ENTRIES, built, example, page, read};
use crate::{pages, repository};
use ninebit_vectors::units;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

/// Rules whose example is not a row of a unit, with the reason.
const WITHOUT: [(&str, &str); 3] = [
    ("NUM-1", "what a number stands for: nothing is computed"),
    ("CMB-12", "what is refused"),
    ("TSH-11 VTX-4", "the vertex side: matrices, and the loading of a mesh"),
];

/// The sentences of `catalogue.txt`.
static SENTENCES: LazyLock<Vec<Sentence>> = LazyLock::new(|| {
    let mut sentences: Vec<Sentence> = Vec::new();
    let table = include_str!("catalogue.txt");
    for line in table.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if let Some(row) = line.strip_prefix("    ") {
            sentences.last_mut().unwrap().rows.push(Row::from_line(row));
        } else {
            let (rule, text) = line.split_once(": ").unwrap();
            sentences.push(Sentence { rule, text, rows: Vec::new() });
        }
    }
    sentences
});

/// The example of a rule as a sentence.
struct Sentence {
    rule: &'static str,
    text: &'static str,
    rows: Vec<Row>,
}

/// A row of a unit that computes a part of the example.
struct Row {
    command: String,
    /// The columns that the sentence mentions: name, number, and the form in which the sentence writes the number.
    results: Vec<[&'static str; 3]>,
}

impl Row {
    fn from_line(line: &'static str) -> Row {
        let (call, results) = line.split_once(" => ").unwrap_or_else(|| panic!("no results: {line}"));
        let result = |word: &'static str| {
            let (name, value) = word.split_once('=').unwrap_or_else(|| panic!("no result `{word}`: {line}"));
            let (number, written) = value.split_once('~').unwrap_or((value, value));
            [name, number, written]
        };
        let results = results.split(' ').map(result).collect();
        if call.starts_with("op ") {
            return Row { command: format!("ninebit {call}"), results };
        }
        let mut words = call.split(' ');
        let unit = units::by_name(words.next().unwrap()).unwrap_or_else(|| panic!("no unit: {line}"));
        let (mut command, mut given) = (format!("ninebit op unit {}", unit.name()), BTreeMap::new());
        while let Some(word) = words.next() {
            match word.split_once('=') {
                Some((name, value)) => assert!(given.insert(name, value).is_none(), "twice {name}: {line}"),
                None => command += &format!(" {word} {}", words.next().unwrap()),
            }
        }
        for column in unit.inputs() {
            let (_, name) = column.name.split_once('.').unwrap();
            let value = given.remove(name).map_or_else(|| column.kind.write(0), str::to_owned);
            command += &format!(" --in {name}={value}");
        }
        assert!(given.is_empty(), "no inputs {given:?}: {line}");
        Row { command, results }
    }

    /// Returns the differences between this row and what the program computes.
    fn errors(&self, bench: &Bench, text: &str) -> Vec<String> {
        let arguments = format!("{} --format json", self.command.strip_prefix("ninebit ").unwrap());
        // Names of files are those that the page gives.
        let mut command = bench.command(&arguments);
        let run = Run::from_output(command.current_dir(repository::at("")).output().unwrap());
        if run.status != 0 {
            return vec![run.stderr];
        }
        let printed: Value = serde_json::from_slice(&run.stdout).unwrap();
        let mut errors = Vec::new();
        for [name, number, written] in &self.results {
            let value = &printed["results"][name];
            let value = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            if value != *number {
                errors.push(format!("{name} is {value}, not {number}"));
            }
            if !written.is_empty() && !has(text, written) {
                errors.push(format!("{name} is not written as `{written}`"));
            }
        }
        errors
    }
}

/// Returns whether a number or a word occurs in a sentence, other than as a part of a longer one.
fn has(text: &str, word: &str) -> bool {
    let joined = |c: char| c.is_alphanumeric() || c == '.' || c == '_' || c == '-' && !word.starts_with(['-', '+']);
    text.match_indices(word).any(|(at, _)| {
        let mut after = text[at + word.len()..].chars();
        let next = after.next().filter(|c| *c != '.').or_else(|| after.next());
        !text[..at].ends_with(joined) && next.is_none_or(|c| !c.is_alphanumeric())
    })
}

/// Returns whether units compute the example of a rule.
pub fn computes(rule: &str) -> bool {
    SENTENCES.iter().any(|sentence| sentence.rule == rule)
}

#[test]
fn sentences_say_what_units_compute() {
    let (bench, mut wrong) = (Bench::new(), String::new());
    for Sentence { rule, text, rows } in SENTENCES.iter() {
        for row in rows {
            let errors = row.errors(&bench, text);
            wrong.extend(errors.iter().map(|error| format!("{rule}: {error}: {}\n", row.command)));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// The page contains every sentence, and below it the command of each row.
#[test]
fn the_page_repeats_sentences() {
    for Sentence { rule, text, rows } in SENTENCES.iter() {
        example(rule, text);
        let writer = format!("tests/rules ({rule})");
        let lines: String = rows.iter().map(|row| format!("- Command: `{}`\n", row.command)).collect();
        pages::hold(&page(rule), &writer, &lines);
        let [begin, _] = pages::markers(&writer);
        let below = read(page(rule)).contains(&format!("\n- Example: {text}\n{begin}"));
        assert!(below, "{rule}: its commands do not stand below its example");
    }
    let commands: usize = SENTENCES.iter().map(|sentence| sentence.rows.len()).sum();
    let written: usize = ENTRIES.iter().map(|entry| entry.fields("Command").count()).sum();
    assert_eq!(written, commands, "commands of a rule that has no rows");
}

/// Rules without rows are listed by name, so a new rule needs rows. The decision has the same list.
#[test]
fn rules_without_rows_are_named() {
    let without: BTreeSet<&str> = WITHOUT.iter().flat_map(|(rules, _)| rules.split(' ')).collect();
    assert_eq!(without, built().map(|entry| entry.id).filter(|rule| !computes(rule)).collect());
    let rows: String =
        WITHOUT.iter().map(|(rules, why)| format!("| {} | {why} |\n", rules.replace(' ', ", "))).collect();
    let table = format!("| rules | why |\n|---|---|\n{rows}");
    pages::hold("docs/decisions/units.md", "tests/rules (without)", &table);
}
