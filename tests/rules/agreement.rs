//! The handbook against the sources: ids, grades, counts, policies, files, tests and vectors.

use crate::handbook::{ENTRIES, Entry, built, declares, files, id_literals, ids, read, root};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::{Named, POLICIES, Profile, Scene};
use ninebit::trace::Rule;
use ninebit_report::compare::bound;
use std::collections::{BTreeMap, BTreeSet};

const GRADES: [&str; 4] = ["SILICON", "DOCUMENT", "INFERRED", "CHOSEN"];
const FIELDS: [&str; 6] = ["Grade", "Formula", "Range", "Source", "Example", "Error"];

/// Tests that hold ids of rules that do not exist.
const INVENTED: [&str; 2] = ["tests/cli.rs", "tests/rules/handbook.rs"];

/// Where the scenes of captured frames lie.
const CAPTURED_SCENES: &str = "vectors/scenes/silicon/";

/// The test that draws the vectors of `vectors/silicon`.
const PROBES: &str = "tests/silicon/probes.rs";

fn find(id: &str) -> Option<&'static Entry> {
    ENTRIES.iter().find(|e| e.id == id)
}

#[test]
fn entries_are_complete() {
    assert!(ENTRIES.len() > 70, "{} entries", ENTRIES.len());
    let mut seen = BTreeSet::new();
    for entry in ENTRIES.iter() {
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
fn every_id_that_is_mentioned_has_an_entry() {
    let sources = ["src", "tests", "benches", "fuzz/fuzz_targets"].into_iter().flat_map(|folder| files(folder, "rs"));
    let documents = ["docs", "vectors"].into_iter().flat_map(|folder| files(folder, "md"));
    let named = ["README.md", "CHANGELOG.md", "fuzz/README.md"].into_iter().map(|file| root().join(file));
    let unread = INVENTED.map(|file| root().join(file));
    for file in sources.chain(documents).chain(named).filter(|file| !unread.contains(file)) {
        for id in ids(&read(&file)) {
            assert!(find(&id).is_some(), "{} mentions {id}, which docs/numerics.md does not have", file.display());
        }
    }
}

/// A step of a trace, a policy or an error of a plan names a rule that is built. A diagnostic may name one that is not: it says so.
#[test]
fn rules_that_are_applied_are_built() {
    let mut applied = BTreeSet::new();
    for file in files("src", "rs") {
        let source = read(&file);
        for (before, id) in id_literals(&source) {
            let diagnostic = before.trim_end().ends_with(".rule(");
            let known = find(id).is_some_and(|e| e.built || diagnostic);
            assert!(known, "{}: \"{id}\" is not a built rule of docs/numerics.md", file.display());
            applied.insert(id.to_string());
        }
    }
    assert!(applied.len() > 40, "only {} rules are applied: {applied:?}", applied.len());
}

#[test]
fn code_of_built_rules_exists_and_names_them() {
    for entry in built() {
        let code = entry.references("Code");
        for (file, name) in &code {
            let source = read(file);
            if let Some(name) = name {
                assert!(declares(&source, name), "{}: {file} does not declare {name}", entry.id);
            }
        }
        let mentions = code.iter().any(|(file, _)| ids(&read(file)).contains(&entry.id));
        assert!(mentions, "none of the files that {} names mentions it", entry.id);
    }
}

#[test]
fn built_rules_are_pinned() {
    for entry in built() {
        let pinned = entry.references("Pinned by");
        assert!(!pinned.is_empty(), "nothing pins {}", entry.id);
        for (file, test) in pinned {
            let source = read(&file);
            if let Some(test) = &test {
                assert!(source.contains(&format!("fn {test}(")), "{}: {file} has no test {test}", entry.id);
            }
        }
    }
}

/// Exactly one test opens the example of a rule, and the rule says where that is.
#[test]
fn examples_of_built_rules_are_computed() {
    let examples: Vec<(String, String)> = files("tests/rules", "rs")
        .into_iter()
        .map(|file| (format!("tests/rules/{}", file.file_name().unwrap().to_str().unwrap()), read(&file)))
        .collect();
    for entry in built() {
        let opens = |source: &str| {
            let literals = id_literals(source);
            literals.iter().filter(|(before, id)| *id == entry.id && before.trim_end().ends_with("example(")).count()
        };
        let computed: Vec<&str> =
            examples.iter().flat_map(|(file, source)| std::iter::repeat_n(file.as_str(), opens(source))).collect();
        let pinned = entry.references("Pinned by");
        let named: Vec<&str> =
            pinned.iter().map(|(file, _)| file.as_str()).filter(|file| file.starts_with("tests/rules/")).collect();
        assert_eq!(computed.len(), 1, "{}: its example is computed in {computed:?}", entry.id);
        assert_eq!(named, computed, "{}: its entry names the left, its example is computed in the right", entry.id);
    }
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
    assert!(order.is_sorted(), "POLICIES is not in the order of docs/numerics.md");
}

/// Rules by grade: built and not built by their first grade, and how many name the grade for a part.
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
            counts.entry(grade).or_default()[column] += 1;
        }
    }
    counts
}

#[test]
fn the_table_counts_right() {
    let mut counts = counts();
    let all = counts.values().fold([0; 3], |a, b| std::array::from_fn(|n| a[n] + b[n]));
    counts.insert("all".to_string(), all);
    let text = read("docs/numerics.md");
    for (grade, [built, not_built, in_part]) in counts {
        let line = format!("| {grade} | {built} | {not_built} | {in_part} |");
        assert!(text.contains(&line), "the table of grades should have the line\n{line}");
    }
}

/// The README has the handbook's grades, meanings and counts.
#[test]
fn the_readme_counts_right() {
    let (handbook, readme) = (read("docs/numerics.md"), read("README.md"));
    let table = readme.split_once("<!-- grades -->\n").and_then(|(_, rest)| rest.split_once("<!-- /grades -->"));
    let (table, _) = table.expect("README.md has a table between <!-- grades --> and <!-- /grades -->");
    let counts = counts();
    let mut expected = "| grade | meaning | rules built |\n|---|---|---:|\n".to_string();
    for grade in GRADES {
        let row = |line: &str| Some(line.strip_prefix(&format!("| {grade} | "))?.strip_suffix(" |")?.to_string());
        let meaning = handbook.lines().find_map(row).unwrap_or_else(|| panic!("docs/numerics.md: what is {grade}?"));
        expected += &format!("| {grade} | {meaning} | {} |\n", counts[grade][0]);
    }
    assert!(table == expected, "the grades of README.md should be\n{expected}\nand are\n{table}");
}

/// Names of the files of vectors that name a rule in their header, by rule.
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

/// A rule names the vectors that pin it, and only those; so do the vectors.
#[test]
fn vectors_and_rules_name_each_other() {
    let vectors = vectors();
    for (rule, names) in &vectors {
        assert!(find(rule).is_some_and(|e| e.built), "{names:?} pin {rule}, which is not a built rule");
    }
    for entry in ENTRIES.iter() {
        let named: BTreeSet<String> = entry.references("Vectors").into_iter().map(|(name, _)| name).collect();
        let pinning = vectors.get(&entry.id).cloned().unwrap_or_default();
        assert_eq!(named, pinning, "{}: its entry names the left, the vectors say the right", entry.id);
        let drawn = entry.references("Pinned by").iter().any(|(file, _)| file == PROBES);
        assert_eq!(drawn, !pinning.is_empty(), "{}: whether {PROBES} pins it, and whether there are vectors", entry.id);
    }
}

/// The table of `vectors/scenes/silicon/README.md` says which rules a scene of a captured frame pins, and the rules say the same.
#[test]
fn scenes_of_captures_and_rules_name_each_other() {
    let mut pinned = BTreeSet::new();
    for line in read("vectors/scenes/silicon/README.md").lines().filter(|line| line.starts_with("| `")) {
        let scene = line.split('`').nth(1).unwrap();
        pinned.extend(ids(line).into_iter().map(|rule| (format!("{CAPTURED_SCENES}{scene}.ron"), rule)));
    }
    let mut named = BTreeSet::new();
    for entry in ENTRIES.iter() {
        let files = entry.references("Pinned by").into_iter().map(|(file, _)| file);
        named.extend(files.filter(|f| f.starts_with(CAPTURED_SCENES)).map(|file| (file, entry.id.clone())));
    }
    assert_eq!(pinned, named, "the table names the left, docs/numerics.md the right");
    let scenes: BTreeSet<String> = pinned.into_iter().map(|(scene, _)| scene).collect();
    let stored = files(CAPTURED_SCENES.trim_end_matches('/'), "ron").into_iter();
    let stored = stored.map(|file| format!("{CAPTURED_SCENES}{}", file.file_name().unwrap().to_str().unwrap()));
    assert_eq!(scenes, stored.filter(|file| !file.ends_with(".expect.ron")).collect());
}

/// The table of `vectors/silicon/README.md` says the same as the files.
#[test]
fn the_table_of_vectors_is_right() {
    let vectors = vectors();
    let mut listed = BTreeSet::new();
    for line in read("vectors/silicon/README.md").lines().filter(|line| line.starts_with("| `")) {
        let names = line.split(" | ").next().unwrap().split('`').skip(1).step_by(2);
        // `-b` after `blend-stack-a` stands for `blend-stack-b`.
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

/// The table of bounds is what comparisons are held to.
#[test]
fn bounds_are_those_of_the_comparison() {
    let scene = Scene { profile: Profile::Nv2a, targets: vec![], textures: vec![], palettes: vec![], draws: vec![] };
    let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
    let text = read("docs/numerics.md");
    for rule in Rule::ALL {
        let line = bound::of(*rule, &plan).map(|(low, high)| {
            // INT-4 allows for the last bits of float64.
            let number = |n: f64| format!("{n:.3}").replace("-0.000", "0.000");
            format!("| {} | {} | {} |", rule.name(), number(low), number(high))
        });
        match line {
            Some(line) => assert!(text.contains(&line), "the table of bounds should have the line\n{line}"),
            None => assert!(!text.contains(&format!("\n| {} |", rule.name())), "{} has no bound", rule.name()),
        }
    }
}
