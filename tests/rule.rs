//! Tests `ninebit rule`: the handbook of the program, and what points to it.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::bench::Bench;
use crate::docs::pages_below;
use crate::repository::at;
use ninebit_handbook::{PAGES, RULES};
use serde_json::Value;
use std::collections::BTreeSet;

#[test]
fn the_program_has_the_handbook_of_the_repository() {
    for (name, text) in PAGES {
        let same = text == std::fs::read_to_string(at("docs/rules").join(name)).unwrap();
        assert!(same, "{name} is another");
    }
    let pages: BTreeSet<String> = pages_below("docs/rules").into_iter().collect();
    let names = PAGES.iter().map(|(name, _)| *name).chain(["README.md"]);
    assert_eq!(pages, names.map(|name| format!("docs/rules/{name}")).collect());
}

#[test]
fn a_rule_is_printed_with_all_that_is_known_of_it() {
    let bench = Bench::new();
    let text = bench.run("rule cmb-8").text();
    for part in [
        "CMB-8 Dot products\n    rnd255(A_r B_r",
        "\n  grade       CHOSEN: nothing decides it",
        "\n  source      none for the rounding",
        "\n  policy      `--policy CMB-8=once` is the rule",
        "\n  decided by  `vectors/scenes/deciding/CMB-8-dot.ron`\n",
        "\n  code        `src/model/combiner/general.rs` `dot`",
        "\n  units       dot-product, general-stage,",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(text.matches("  command ").count(), 1, "{text}");
    // Commands can be copied.
    let command = text.lines().find(|line| line.contains("--policy CMB-8=each --in")).unwrap().trim();
    assert!(bench.run(command.strip_prefix("ninebit ").unwrap()).text().contains("out.dot 234"), "{command}");
    let text = bench.run("rule NUM-2 CMB-3").text();
    assert!(text.contains("SILICON: read off") && text.contains("INFERRED: follows from"), "{text}");
    assert!(text.contains("\n\nCMB-3 "), "{text}");
}

#[test]
fn rules_are_listed() {
    let bench = Bench::new();
    let text = bench.run("rule").text();
    for rule in RULES.iter() {
        let line = text.lines().find(|line| line.trim_start().starts_with(&format!("{} ", rule.id)));
        let line = line.unwrap_or_else(|| panic!("{} is not listed", rule.id));
        assert!(line.ends_with(rule.title) && line.contains(&rule.grades().join(", ")), "{line}");
    }
    let document: Value = serde_json::from_str(&bench.run("rule --format json").text()).unwrap();
    assert_eq!(document["format"], "ninebit-rules-1");
    assert_eq!(document["rules"].as_array().unwrap().len(), RULES.len());
    let one: Value = serde_json::from_str(&bench.run("rule CMB-8 --format json").text()).unwrap();
    let rule = &one["rules"][0];
    assert_eq!((&rule["id"], &rule["grades"][0], &rule["built"]), (&"CMB-8".into(), &"CHOSEN".into(), &true.into()));
    assert_eq!(rule["policy"]["values"][1]["value"], "each");
    assert_eq!(rule["code"][0]["name"], "dot");
    assert!(rule["units"].as_array().unwrap().contains(&"dot-product".into()));
}

/// The table of docs/commands.md names the fields of each form, and no others.
#[test]
fn forms_of_json_are_on_the_page() {
    let bench = Bench::new();
    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<BTreeSet<String>>();
    let words = |text: &str| text.split('`').skip(1).step_by(2).map(str::to_owned).collect::<BTreeSet<String>>();
    let page = std::fs::read_to_string(at("docs/commands.md")).unwrap();
    let (_, table) = page.split_once("<!-- held by tests/rule.rs: begin -->").unwrap();
    let (table, _) = table.split_once("<!-- held by tests/rule.rs: end -->").unwrap();
    let unit_table = at("vectors/packs/nv2a/mux.tsv");
    let mux = std::fs::read_to_string(&unit_table).unwrap();
    let (row, _) = mux.lines().last().unwrap().split_once('\t').unwrap();
    let show = format!("vectors show {} {row}", unit_table.display());
    let mut rows = 0;
    for (command, list) in [("rule", "rules"), (show.as_str(), ""), ("op unit mux --columns", "columns")] {
        let document: Value = serde_json::from_str(&bench.run(&format!("{command} --format json")).text()).unwrap();
        let format = document["format"].as_str().unwrap();
        let line = table.lines().find(|line| line.starts_with(&format!("| `{format}` "))).unwrap();
        let mut fields = keys(&document);
        fields.remove("format");
        // Every item has the same fields, and so has each of its parts.
        for item in document[list].as_array().into_iter().flatten() {
            fields.extend(keys(item));
            let parts = item["code"].as_array().into_iter().flatten().chain([&item["policy"]]);
            fields.extend(parts.filter(|part| part.is_object()).flat_map(keys));
        }
        let mut told = words(line.rsplit(" | ").next().unwrap());
        told.remove("null");
        if told.remove("op") {
            let op = bench.run("op unit mux --in select=Msb --in spare0.a=-256 --format json").text();
            let op: Value = serde_json::from_str(&op).unwrap();
            told.extend(keys(&op).into_iter().filter(|key| key != "format"));
        }
        assert_eq!(told, fields, "{format}");
        rows += 1;
    }
    assert_eq!(table.lines().filter(|line| line.starts_with("| `ninebit-")).count(), rows);
}

#[test]
fn unknown_rules_get_what_was_meant() {
    let bench = Bench::new();
    for (id, said) in [
        ("CMB12", "did you mean CMB-12?"),
        ("txe-6", "did you mean TEX-6?"),
        ("Mux", "`Mux` is in the title of CMB-10"),
        ("nonsense-of-no-kind", "`ninebit rule` lists all rules"),
    ] {
        bench.run(&format!("rule {id}")).failed(2, &format!("error[NB1301]: there is no rule `{id}`\n  help: {said}"));
    }
}

#[test]
fn a_family_is_listed() {
    let bench = Bench::new();
    let ids = |text: String| -> Vec<String> {
        let ids = text.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next().map(str::to_owned));
        ids.collect()
    };
    assert_eq!(ids(bench.run("rule fin-").text()), ["FIN-1", "FIN-2", "FIN-3", "FIN-4", "FIN-5"]);
    assert_eq!(ids(bench.run("rule SMO CMB-8").text()), ["SMO-1", "SMO-2", "CMB-8"]);
    let json: Value = serde_json::from_str(&bench.run("rule SMO --format json").text()).unwrap();
    assert_eq!(json["rules"].as_array().unwrap().len(), 2);
}

/// Beside each rule of a trace stand the letters of its grades, and a line says what they mean.
#[test]
fn traces_show_grades() {
    let scene = at("vectors/scenes/dot3/lit-stone.ron");
    let text = Bench::new().run(&format!("trace {} --pixel 200,300", scene.to_str().unwrap())).text();
    for (rule, mark) in [("CMB-8", "C"), ("NUM-2", "SI"), ("CMB-10", "SC")] {
        let lines: Vec<&str> = text.lines().filter(|line| line.contains(&format!("  {rule} "))).collect();
        assert!(lines.iter().all(|line| line.contains(&format!("  {rule:6} {mark}"))), "{lines:?}");
        assert!(rule == "CMB-10" || !lines.is_empty(), "no {rule}: {text}");
    }
    assert!(text.lines().last().unwrap().starts_with("grades beside rules: S SILICON, D DOCUMENT,"), "{text}");
}
