//! Checks that handbook and sources agree on ids, grades, counts, policies, files, tests and vectors.

use crate::catalogue;
use crate::handbook::{ENTRIES, Entry, INDEX, built, declares, files, id_literals, ids, read, superseded};
use crate::pages;
use crate::repository;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::{Named, POLICIES, Profile, Scene};
use ninebit::trace::Rule;
use ninebit_handbook::{GRADES, meaning};
use ninebit_report::compare::bound;
use ninebit_vectors::units;
use std::collections::{BTreeMap, BTreeSet};

/// The fields that a built rule must have. *Range* and *Error* are optional.
const FIELDS: [&str; 4] = ["Grade", "Formula", "Source", "Example"];

/// Files with ids of rules that do not exist, which are skipped.
const INVENTED: [&str; 2] = ["tests/cli.rs", "tests/rules/handbook.rs"];

/// Folder of the scenes of captured frames.
const CAPTURED_SCENES: &str = "vectors/scenes/silicon/";

/// The test that draws the vectors of `vectors/silicon`.
const PROBES: &str = "tests/silicon/probes.rs";

fn find(id: &str) -> Option<&'static Entry> {
    ENTRIES.iter().find(|e| e.id == id)
}

#[test]
fn superseded_rules_have_no_entry() {
    let old = superseded();
    assert!(!old.is_empty() && old.iter().all(|id| find(id).is_none()), "{old:?}");
}

#[test]
fn entries_are_complete() {
    assert!(ENTRIES.len() > 70, "{} entries", ENTRIES.len());
    let mut seen = BTreeSet::new();
    for entry in ENTRIES.iter() {
        assert_eq!(ids(entry.id), BTreeSet::from([entry.id.to_owned()]), "heading of {}", entry.id);
        assert!(seen.insert(entry.id), "{} has two entries", entry.id);
        for grade in entry.grades() {
            assert!(GRADES.contains(&grade), "{}: `{grade}` is no grade", entry.id);
        }
        let needed: &[&str] = if entry.built { &FIELDS } else { &FIELDS[..2] };
        for label in needed {
            assert!(!entry.field(label).is_empty(), "{} has no {label}", entry.id);
        }
    }
}

/// Only documents mention rules that were replaced, since decisions and the history of changes stay as they were.
#[test]
fn every_id_that_is_mentioned_has_an_entry() {
    let old = superseded();
    let sources = ["src", "tests", "benches", "fuzz/fuzz_targets"].into_iter().flat_map(|folder| files(folder, "rs"));
    let documents = ["docs", "vectors"].into_iter().flat_map(|folder| files(folder, "md"));
    let named = ["README.md", "CHANGELOG.md", "fuzz/README.md"].into_iter().map(repository::at);
    let unread = INVENTED.map(repository::at);
    for file in sources.chain(documents).chain(named).filter(|file| !unread.contains(file)) {
        let document = file.extension().is_some_and(|extension| extension == "md");
        for id in ids(&read(&file)) {
            let known = find(&id).is_some() || document && old.contains(&id);
            assert!(known, "{} mentions {id}, which docs/rules does not have", file.display());
        }
    }
}

/// Steps of traces, policies and errors of plans name only rules that are built. A diagnostic may name one that is not built, and then says
/// so.
#[test]
fn rules_that_are_applied_are_built() {
    let mut applied = BTreeSet::new();
    for file in files("src", "rs") {
        let source = read(&file);
        for (before, id) in id_literals(&source) {
            let diagnostic = before.trim_end().ends_with(".rule(");
            let known = find(id).is_some_and(|e| e.built || diagnostic);
            assert!(known, "{}: \"{id}\" is not a built rule of docs/rules", file.display());
            applied.insert(id.to_string());
        }
    }
    assert!(applied.len() > 40, "only {} rules are applied: {applied:?}", applied.len());
}

#[test]
fn code_of_built_rules_exists_and_names_them() {
    for entry in built() {
        let code = entry.references("Code");
        for &(file, name) in &code {
            let source = read(file);
            if let Some(name) = name {
                assert!(declares(&source, name), "{}: {file} does not declare {name}", entry.id);
            }
        }
        let mentions = code.iter().any(|(file, _)| ids(&read(file)).contains(entry.id));
        assert!(mentions, "none of the files that {} names mentions it", entry.id);
    }
}

#[test]
fn pins_exist() {
    for entry in built() {
        for (file, test) in entry.references("Pinned by") {
            let source = read(file);
            if let Some(test) = &test {
                assert!(source.contains(&format!("fn {test}(")), "{}: {file} has no test {test}", entry.id);
            }
        }
    }
}

/// Entries name exactly the scenes that are there to be drawn on a card.
#[test]
fn deciding_scenes_are_named_by_their_rules() {
    let named: BTreeSet<String> =
        ENTRIES.iter().flat_map(|e| e.references("Decided by")).map(|(file, _)| file.to_owned()).collect();
    let scenes = files("vectors/scenes/deciding", "ron").into_iter().map(|path| repository::name(&path));
    assert_eq!(named, scenes.filter(|name| !name.ends_with(".expect.ron")).collect());
    for entry in ENTRIES.iter() {
        for (file, _) in entry.references("Decided by") {
            assert!(file.starts_with(&format!("vectors/scenes/deciding/{}-", entry.id)), "{} names {file}", entry.id);
        }
    }
}

/// Returns where the example of a rule is computed: in the catalogue of units, in a file of `tests/rules`, or in both.
fn computed(entry: &Entry, examples: &[(String, String)]) -> String {
    let opens = |call: &str| {
        let opened = |source: &str| {
            let literals = id_literals(source);
            literals.iter().filter(|(before, id)| *id == entry.id && before.trim_end().ends_with(call)).count()
        };
        examples.iter().flat_map(|(file, source)| std::iter::repeat_n(file.as_str(), opened(source))).collect()
    };
    let [alone, beside]: [Vec<&str>; 2] = ["example(", "beside_rows("].map(opens);
    match (catalogue::computes(entry.id), &alone[..], &beside[..]) {
        (false, [file], []) => (*file).to_owned(),
        (true, [], []) => "catalogue".to_owned(),
        (true, [], [file]) => format!("catalogue, {file}"),
        _ => panic!("{}: its example is computed in {alone:?}, beside its rows in {beside:?}", entry.id),
    }
}

/// Returns the names of files, without folder and extension, each with its text.
fn named(folder: &str, extension: &str) -> Vec<(String, String)> {
    let name = |file: &std::path::Path| file.file_stem().unwrap().to_str().unwrap().to_owned();
    files(folder, extension).into_iter().map(|file| (name(&file), read(&file))).collect()
}

fn quoted<'n>(names: impl IntoIterator<Item = &'n String>) -> String {
    names.into_iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// Returns for each rule the documents outside of the handbook that name it, as links from the index.
fn naming_documents() -> BTreeMap<String, Vec<String>> {
    let mut naming: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let documents = files("docs", "md").into_iter().map(|path| repository::name(&path));
    for document in documents.filter(|document| !document.starts_with("docs/rules/")) {
        let (text, short) = (read(&document), document.strip_prefix("docs/").unwrap());
        let name = short.trim_end_matches("/README.md").trim_end_matches(".md");
        for id in ids(&text) {
            naming.entry(id).or_default().push(format!("[{name}](../{short})"));
        }
    }
    naming
}

/// The index leads from each rule to all that belongs to it.
#[test]
fn the_index_is_right() {
    let naming = naming_documents();
    let mut table = "| rule | grade | functions | units | deciding scene | policy | documents |\n".to_owned();
    table += "|---|---|---|---|---|---|---|\n";
    for entry in ENTRIES.iter() {
        let link = |(path, name): (&str, Option<&str>)| {
            let name = name.unwrap_or_else(|| path.rsplit('/').next().unwrap());
            format!("[`{name}`](../../{path})")
        };
        let links = |label: &str| entry.references(label).into_iter().map(link).collect::<Vec<_>>().join(", ");
        let units: Vec<String> = units::all()
            .into_iter()
            .filter(|unit| unit.rules().contains(&entry.id))
            .map(|unit| unit.name().to_owned())
            .collect();
        let policy = POLICIES.iter().find(|policy| policy.rule == entry.id);
        let values: Vec<String> =
            policy.into_iter().flat_map(|policy| policy.values).map(|(value, _)| (*value).to_owned()).collect();
        let cells = [
            format!("[{}]({}) {}", entry.id, entry.link(), entry.title),
            format!("{}{}", entry.grades()[0], if entry.built { "" } else { ", not built" }),
            links("Code"),
            quoted(&units),
            links("Decided by"),
            quoted(&values),
            naming.get(entry.id).cloned().unwrap_or_default().join(", "),
        ];
        table += &format!("| {} |\n", cells.join(" | "));
    }
    pages::hold(INDEX, "tests/rules (index)", &table);
}

/// The second table lists for each rule which tests of the whole cover it.
#[test]
fn the_table_of_tests_is_right() {
    let (examples, vectors, scenes) = (named("tests/rules", "rs"), vectors(), captured());
    let oracle: BTreeSet<String> = named("tests/oracle", "rs").iter().flat_map(|(_, source)| ids(source)).collect();
    let mut table = "| rule | example | oracle | measured rows | captured scenes |\n|---|---|---|---|---|\n".to_owned();
    for entry in built() {
        let cells = [
            format!("[{}]({})", entry.id, entry.link()),
            computed(entry, &examples),
            if oracle.contains(entry.id) { "yes".to_owned() } else { String::new() },
            quoted(vectors.get(entry.id).into_iter().flatten()),
            quoted(scenes.get(entry.id).into_iter().flatten()),
        ];
        table += &format!("| {} |\n", cells.join(" | "));
    }
    pages::hold(INDEX, "tests/rules (tests)", &table);
}

#[test]
fn policies_are_spelled_out() {
    let mut spelled: Vec<String> = Vec::new();
    for policy in POLICIES {
        let entry = find(policy.rule).unwrap_or_else(|| panic!("no {}", policy.rule));
        let text = entry.field("Policy");
        let mut from = 0;
        for (value, _) in policy.values {
            let flag = format!("`--policy {}={value}`", policy.rule);
            let at =
                text[from..].find(&flag).unwrap_or_else(|| panic!("{}: {flag} is missing, or not in order", entry.id));
            from += at + flag.len();
            spelled.push(flag);
        }
    }
    for entry in ENTRIES.iter() {
        for flag in entry.field("Policy").split('`').filter(|t| t.starts_with("--policy")) {
            assert!(spelled.contains(&format!("`{flag}`")), "{}: `{flag}` does not exist", entry.id);
        }
        let is_policy = POLICIES.iter().any(|p| p.rule == entry.id);
        assert_eq!(is_policy, !entry.field("Policy").is_empty(), "{}", entry.id);
    }
    let order: Vec<usize> = POLICIES.iter().map(|p| ENTRIES.iter().position(|e| e.id == p.rule).unwrap()).collect();
    assert!(order.is_sorted(), "POLICIES is not in the order of docs/rules");
}

/// Counts rules by grade: built and not built by their first grade, and built ones that name the grade for a part.
fn counts() -> BTreeMap<String, [usize; 3]> {
    let mut counts: BTreeMap<String, [usize; 3]> = BTreeMap::new();
    for entry in ENTRIES.iter() {
        for (n, grade) in entry.grades().into_iter().enumerate() {
            let column = match (n, entry.built) {
                (0, true) => 0,
                (0, false) => 1,
                (_, true) => 2,
                (_, false) => continue,
            };
            counts.entry(grade.to_owned()).or_default()[column] += 1;
        }
    }
    counts
}

#[test]
fn the_table_counts_right() {
    let counts = counts();
    let all = counts.values().fold([0; 3], |a, b| std::array::from_fn(|n| a[n] + b[n]));
    let rows = GRADES.iter().map(|grade| (*grade, counts[*grade])).chain([("all", all)]);
    let mut table = "| grade | meaning | built | not built | built, in part |\n|---|---|---:|---:|---:|\n".to_owned();
    for (grade, [built, not_built, in_part]) in rows {
        table += &format!("| {grade} | {} | {built} | {not_built} | {in_part} |\n", meaning(grade));
    }
    pages::hold(INDEX, "tests/rules (counts)", &table);
}

/// The README has the handbook's grades, their meanings and counts.
#[test]
fn the_readme_counts_right() {
    let counts = counts();
    let mut table = "| grade | meaning | rules built |\n|---|---|---:|\n".to_string();
    for grade in GRADES {
        table += &format!("| {grade} | {} | {} |\n", meaning(grade), counts[grade][0]);
    }
    pages::hold("README.md", "tests/rules (grades)", &table);
}

/// Returns for each rule the names of the vector files whose header names it.
fn vectors() -> BTreeMap<String, BTreeSet<String>> {
    let mut vectors: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let probes = read(PROBES);
    for file in files("vectors/silicon", "tsv") {
        let name = file.file_stem().unwrap().to_str().unwrap().to_string();
        assert!(probes.contains(&format!("(\"{name}\", ")), "{PROBES} does not draw {}", file.display());
        let text = read(&file);
        let rules = text.lines().find_map(|line| line.strip_prefix("# rules: "));
        for rule in rules.unwrap_or_else(|| panic!("{} names no rules", file.display())).split(' ') {
            vectors.entry(rule.to_string()).or_default().insert(name.clone());
        }
    }
    vectors
}

#[test]
fn vectors_name_built_rules() {
    for (rule, names) in &vectors() {
        assert!(find(rule).is_some_and(|e| e.built), "{names:?} pin {rule}, which is not a built rule");
    }
}

/// Returns for each rule the names of the captured scenes that pin it, according to the table beside them.
fn captured() -> BTreeMap<String, BTreeSet<String>> {
    let mut pinned: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for line in read(format!("{CAPTURED_SCENES}README.md")).lines().filter(|line| line.starts_with("| `")) {
        let scene = line.split('`').nth(1).unwrap();
        for rule in ids(line) {
            pinned.entry(rule).or_default().insert(scene.to_owned());
        }
    }
    pinned
}

/// The table of `vectors/scenes/silicon/README.md` lists every scene in the folder, and its rules are built.
#[test]
fn scenes_of_captures_name_built_rules() {
    let pinned = captured();
    for (rule, scenes) in &pinned {
        assert!(find(rule).is_some_and(|e| e.built), "{scenes:?} pin {rule}, which is not a built rule");
    }
    let scenes: BTreeSet<String> = pinned.into_values().flatten().collect();
    let stored = named(CAPTURED_SCENES.trim_end_matches('/'), "ron").into_iter().map(|(name, _)| name);
    assert_eq!(scenes, stored.filter(|name| !name.ends_with(".expect")).collect());
}

/// The table of `vectors/silicon/README.md` agrees with the headers of the files.
#[test]
fn the_table_of_vectors_is_right() {
    let vectors = vectors();
    let mut listed = BTreeSet::new();
    for line in read("vectors/silicon/README.md").lines().filter(|line| line.starts_with("| `")) {
        let names = line.split(" | ").next().unwrap().split('`').skip(1).step_by(2);
        // `-b` after `blend-stack-a` means `blend-stack-b`.
        let mut stem = "";
        let names: Vec<String> = names
            .map(|name| {
                stem = if name.starts_with('-') { stem } else { name };
                if name == stem { name.to_string() } else { format!("{}{name}", &stem[..stem.len() - name.len()]) }
            })
            .collect();
        let pinned = vectors.iter().filter(|(_, pinning)| names.iter().any(|name| pinning.contains(name)));
        let expected: BTreeSet<String> = pinned.map(|(rule, _)| rule.clone()).collect();
        assert_eq!(ids(line), expected, "vectors/silicon/README.md names the left, {names:?} the right");
        listed.extend(names);
    }
    let all: BTreeSet<String> = vectors.values().flatten().cloned().collect();
    assert_eq!(listed, all, "vectors/silicon/README.md lists the left, the right exist");
}

/// The table of bounds has the limits that comparisons apply.
#[test]
fn bounds_are_those_of_the_comparison() {
    let scene = Scene { profile: Profile::Nv2a, targets: vec![], textures: vec![], palettes: vec![], draws: vec![] };
    let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    let mut table = "| rule | lowest | highest |\n|---|---:|---:|\n".to_owned();
    for rule in Rule::ALL {
        // The bound of INT-4 allows for the last bits of float64, which would print as -0.000.
        let number = |n: f64| format!("{n:.3}").replace("-0.000", "0.000");
        if let Some((low, high)) = bound::error_range(*rule, &plan) {
            table += &format!("| {} | {} | {} |\n", rule.name(), number(low), number(high));
        }
    }
    pages::hold(INDEX, "tests/rules (bounds)", &table);
}
