//! Checks that the vocabulary, which `docs/trace-format.md` shows, has exactly the fields, names and operations that occur in traces, and
//! that the definitions of the operations are sufficient to recompute a trace under any policy.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

use crate::architecture;
use crate::pages;
use crate::repository::at;
use crate::scene_files;
use ninebit_test_support::random_scene;
use ninebit_test_support::recompute;

use ninebit::engine;
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::random::Random;
use ninebit::state::{POLICIES, Policies};
use ninebit_report::vocabulary;
use ninebit_report::{trace_json, trace_value};
use ninebit_scene as scene;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Number of random scenes whose traces are tested.
const SCENES: usize = 1000;

type Words = BTreeSet<String>;

/// The text of the page, and the vocabulary of its tables.
struct Page {
    text: String,
    document: Words,
    fragment: Words,
    step: Words,
    input: Words,
    texel: Words,
    operations: Words,
    /// Block and name of each kind of step, with placeholders.
    names: Vec<[String; 2]>,
    placeholders: BTreeMap<String, Vec<String>>,
}

/// Returns the words in backticks.
fn quoted(cell: &str) -> Vec<String> {
    cell.split('`').skip(1).step_by(2).map(str::to_string).collect()
}

impl Page {
    fn read() -> Page {
        let text = std::fs::read_to_string(at("docs/trace-format.md")).unwrap();
        // Returns the words in backticks in the first two cells of each row.
        let rows = |name: &str| -> Vec<[Vec<String>; 2]> {
            let tables = vocabulary::tables().into_iter().filter(|table| table.name.starts_with(name));
            let rows: Vec<_> =
                tables.flat_map(|table| table.rows).map(|row| [quoted(row[0]), quoted(row[1])]).collect();
            assert!(!rows.is_empty(), "{name}");
            rows
        };
        let first = |name: &str| -> Words { rows(name).into_iter().flat_map(|[first, _]| first).collect() };
        let (parts, names) = (rows("Parts of names"), rows("Names"));
        Page {
            document: first("The document"),
            fragment: first("A fragment"),
            step: first("A step"),
            input: first("An input"),
            texel: first("A texel"),
            operations: first("Operations"),
            names: names
                .into_iter()
                .flat_map(|[block, names]| names.into_iter().map(move |name| [block[0].clone(), name]))
                .collect(),
            placeholders: parts.into_iter().map(|[part, values]| (part[0].clone(), values)).collect(),
            text,
        }
    }

    /// Returns whether `text` matches `pattern`.
    fn fits(&self, pattern: &str, text: &str) -> bool {
        match pattern.find('{') {
            None => pattern == text,
            Some(at) => {
                let Some(rest) = text.strip_prefix(&pattern[..at]) else { return false };
                let (part, after) = pattern[at..].split_at(pattern[at..].find('}').unwrap() + 1);
                self.placeholders[part]
                    .iter()
                    .any(|value| rest.strip_prefix(value.as_str()).is_some_and(|rest| self.fits(after, rest)))
            }
        }
    }
}

/// What has occurred in traces.
#[derive(Default)]
struct Seen {
    operations: Words,
    /// Names of steps by block.
    names: BTreeMap<String, Words>,
    fragments: usize,
}

/// Checks that a value has all fields of the page. `optional` states which of the optional fields it has to have.
fn fields(value: &Value, page: &Words, optional: &[(&str, bool)]) {
    let left_out = |name: &str| optional.iter().any(|(optional, there)| *optional == name && !there);
    assert!(optional.iter().all(|(name, _)| page.contains(*name)), "not all on the page: {optional:?}");
    let fields = value.as_object().unwrap();
    // Both are sorted.
    if fields.keys().eq(page.iter().filter(|name| !left_out(name))) {
        return;
    }
    let missing: Vec<_> = page.iter().filter(|name| !fields.contains_key(*name) && !left_out(name)).collect();
    let more: Vec<_> = fields.keys().filter(|name| !page.contains(*name) || left_out(name)).collect();
    panic!("without {missing:?}, with {more:?}: {value:#}");
}

/// Checks the fields of a value that may be too large for all readers of JSON, and then has a text as well.
fn fields_with_value(value: &Value, page: &Words, optional: (&str, bool)) {
    let text = value_text(value);
    // Only numbers of WGT-1 have a power of two.
    let exponent = value.get("exponent").is_some_and(|exponent| exponent != 0);
    fields(value, page, &[("value_text", text.is_some()), ("exponent", exponent), optional]);
    assert!(text.is_none_or(|text| value["value_text"] == text), "{value:#}");
}

/// Returns the text of a value that does not fit a signed number of 32 bits.
fn value_text(value: &Value) -> Option<String> {
    let integer = value["value"].as_i64().unwrap();
    let text = || if value["per_one"] == 0 { format!("{integer:#010x}") } else { integer.to_string() };
    i32::try_from(integer).is_err().then(text)
}

impl Seen {
    /// Adds what has occurred in other traces.
    fn add(&mut self, other: Seen) {
        self.operations.extend(other.operations);
        self.fragments += other.fragments;
        for (block, names) in other.names {
            self.names.entry(block).or_default().extend(names);
        }
    }

    /// Compares the fields of a document with the page, and records its operations and names.
    fn document(&mut self, page: &Page, document: &Value) {
        let word = document["word"].as_u64().unwrap();
        let long = word >> 31 != 0;
        fields(document, &page.document, &[("left_out", false), ("word_text", long)]);
        assert!(!long || document["word_text"] == format!("{word:#010x}"));
        assert_eq!((&document["format"], &document["version"]), (&"ninebit-trace".into(), &2.into()));
        for draw in document["draws"].as_array().unwrap() {
            self.fragments += 1;
            // Only pieces of clipped triangles have this field.
            let figure = draw.get("figure").is_some_and(|figure| figure == "line" || figure == "point");
            fields(draw, &page.fragment, &[("clipped", draw.get("clipped").is_some()), ("figure", figure)]);
            let mut made = BTreeMap::new();
            for (number, step) in draw["steps"].as_array().unwrap().iter().enumerate() {
                let fetched = step["operation"] == "fetch";
                assert_eq!(step["id"], number);
                fields_with_value(step, &page.step, ("texel", fetched));
                let inputs = step["inputs"].as_array().unwrap();
                if fetched {
                    fields(&step["texel"], &page.texel, &[]);
                    assert_eq!(step["texel"]["word"], format!("{:#010x}", step["value"].as_u64().unwrap()));
                    // The texel has the position that the operands give, if they are coordinates.
                    for (axis, input) in ["x", "y"].into_iter().zip(inputs) {
                        assert_eq!(step["texel"][axis], input["value"], "{step:#}");
                    }
                }
                for input in inputs {
                    // An input that no step yields is a parameter.
                    let maker = made.get(input["name"].as_str().unwrap());
                    assert_eq!(input.get("step").and_then(Value::as_u64), maker.map(|step: &usize| *step as u64));
                    fields_with_value(input, &page.input, ("step", maker.is_some()));
                }
                let word = |field: &str| step[field].as_str().unwrap();
                made.insert(word("name"), number);
                if !self.operations.contains(word("operation")) {
                    assert!(page.operations.contains(word("operation")), "not on the page: {step:#}");
                    self.operations.insert(word("operation").to_owned());
                }
                if self.names.get(word("block")).is_none_or(|names| !names.contains(word("name"))) {
                    self.names.entry(word("block").to_owned()).or_default().insert(word("name").to_owned());
                }
            }
        }
    }
}

/// Returns the trace of a pixel as a document.
fn trace(plan: &Plan, target: usize, pixel: (u32, u32)) -> Value {
    trace_value(plan, &engine::trace(plan, target, pixel, None).unwrap())
}

/// Like [`trace`], read back from the printed text.
fn trace_of_text(plan: &Plan, target: usize, pixel: (u32, u32)) -> Value {
    serde_json::from_str(&trace_json(plan, &engine::trace(plan, target, pixel, None).unwrap())).unwrap()
}

fn plan_of(path: &Path) -> Plan {
    scene::load(path, &Limits::default()).unwrap_or_else(|error| panic!("{}", error.render(false))).plan
}

#[test]
fn the_page_shows_the_vocabulary() {
    for table in vocabulary::tables() {
        let line = |cells: &[&str]| format!("| {} |\n", cells.join(" | "));
        let made: String = [line(&table.columns), format!("|{}\n", "---|".repeat(table.columns.len()))]
            .into_iter()
            .chain(table.rows.iter().map(|row| line(row)))
            .collect();
        pages::hold("docs/trace-format.md", &format!("tests/trace_format.rs ({})", table.name), &made);
    }
}

/// Recomputes traces of random scenes and compares them with the page.
fn random_traces(page: &Page) -> Seen {
    let mut seen = Seen::default();
    let mut runner = TestRunner::deterministic();
    let mut sequence = Random::seeded(3);
    let mut random = move |below: u32| sequence.below(below.into()) as u32;
    for number in 0..SCENES {
        let scene = match number % 4 {
            2.. => random_scene::wide::scene().new_tree(&mut runner).unwrap().current(),
            _ => random_scene::scene().new_tree(&mut runner).unwrap().current(),
        };
        let mut policies = Policies::DEFAULT;
        if number % 2 == 1 {
            for policy in POLICIES {
                policies.choose(policy.rule, random(policy.values.len() as u32) as usize);
            }
        }
        let plan = Plan::compile(&scene, &PlanOptions { policies, prune: true }).unwrap();
        for (target, size) in plan.targets().iter().map(|t| (t.width, t.height)).enumerate() {
            for _ in 0..3 {
                let document = trace(&plan, target, (random(size.0), random(size.1)));
                for draw in document["draws"].as_array().unwrap() {
                    let known = recompute::fragment(draw, &document["policies"])
                        .unwrap_or_else(|error| panic!("{error}: tests/common/recompute.rs\n{draw:#}"));
                    assert_eq!(draw["stored"].as_bool(), Some(known.contains_key("stored.word")));
                }
                seen.document(page, &document);
            }
        }
    }
    seen
}

/// Compares traces of the scenes of the repository with the page.
fn repository_traces(page: &Page) -> Seen {
    let mut seen = Seen::default();
    let files = scene_files::below(&at("vectors/scenes"));
    assert!(!files.is_empty());
    for path in files {
        let plan = plan_of(&path);
        for (target, size) in plan.targets().iter().map(|t| (t.width, t.height)).enumerate() {
            seen.document(page, &trace_of_text(&plan, target, (size.0 / 2, size.1 / 2)));
            seen.document(page, &trace_of_text(&plan, target, (size.0 / 3, size.1 * 2 / 3)));
        }
    }
    seen
}

#[test]
fn traces_and_the_page_agree() {
    let page = Page::read();
    // Both run at the same time, because one alone would take longest of all tests.
    let seen = std::thread::scope(|scope| {
        let random = scope.spawn(|| random_traces(&page));
        let mut seen = repository_traces(&page);
        seen.add(random.join().unwrap());
        seen
    });
    println!("{} fragments", seen.fragments);
    let unseen: Vec<_> = page.operations.difference(&seen.operations).collect();
    assert!(unseen.is_empty(), "operations of the page that no trace has: {unseen:?}");
    let fits = |[block, name]: &[String; 2], [of_block, of_name]: &[String; 2]| {
        page.fits(block, of_block) && page.fits(name, of_name)
    };
    let names: Vec<[String; 2]> = seen
        .names
        .into_iter()
        .flat_map(|(block, names)| names.into_iter().map(move |name| [block.clone(), name]))
        .collect();
    for step in &names {
        assert!(page.names.iter().any(|row| fits(row, step)), "not on the page: {step:?}");
    }
    for row in &page.names {
        assert!(names.iter().any(|step| fits(row, step)), "no trace has {row:?}");
    }
}

#[test]
fn the_example_is_a_step_of_its_trace() {
    let page = Page::read();
    let example: Value =
        serde_json::from_str(page.text.split("```json\n").nth(1).unwrap().split("```").next().unwrap()).unwrap();
    let document = trace_of_text(&plan_of(&at("vectors/scenes/dot3/constant-light.ron")), 0, (200, 300));
    assert!(document["draws"][0]["steps"].as_array().unwrap().contains(&example), "{example:#}");
}

/// The operations of the page occur in the sources, and are exactly those that the tests can recompute.
#[test]
fn the_page_lists_what_the_sources_have() {
    let page = Page::read();
    let mut files = Vec::new();
    architecture::files(&at("src"), &mut files);
    let sources: String = files.iter().map(|path| std::fs::read_to_string(path).unwrap()).collect();
    for operation in &page.operations {
        assert!(sources.contains(&format!("\"{operation}\"")), "{operation} is not in the sources");
    }
    let recompute = std::fs::read_to_string(at("tests/common/recompute.rs")).unwrap();
    let arms = recompute.split("Some(match operation {").nth(1).unwrap().split("_ => return None,").next().unwrap();
    // The arms of the outermost match begin with eight spaces, followed by the names in front of the arrow.
    let mut known: Words = arms
        .lines()
        .filter_map(|line| line.strip_prefix("        \"")?.split_once("=>").map(|(names, _)| names))
        .flat_map(|names| names.split('"').step_by(2).map(str::to_string).collect::<Vec<_>>())
        .filter(|name| !name.is_empty())
        .collect();
    known.extend(["given", "fetch", "palette", "border_color", "chain"].map(str::to_string));
    assert_eq!(page.operations, known);
}
