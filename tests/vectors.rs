//! Tests packs of vectors: they survive writing and reading, changed files are refused, and rows that contradict the model are found.
#![allow(clippy::unwrap_used, missing_docs, reason = "a test fails by panicking")]

use crate::bench;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use ninebit::state::{Policies, Profile};
use ninebit_vectors::cases::{self, Level};
use ninebit_vectors::pack::{self, Options};
use ninebit_vectors::read::parse;
use ninebit_vectors::table::{Contents, Writer};
use ninebit_vectors::unit::{Conditions, alternatives};
use ninebit_vectors::units;
use ninebit_vectors::view::View;

fn options(units: &[&str]) -> Options {
    let units = units.iter().map(|name| units::by_name(name).unwrap()).collect();
    Options {
        profile: Profile::Nv2a,
        level: Level::L0,
        seed: 1,
        units,
        deciding: false,
        views: vec![View::Hex, View::Jsonl],
    }
}

/// Returns a whole table as text.
fn text(writer: &Writer) -> String {
    let mut text = writer.head();
    let rows = writer.each(false, |row| {
        text += &(writer.line(row) + "\n");
        Ok::<(), ()>(())
    });
    assert!(rows.is_ok());
    text
}

fn vectors(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ninebit")).arg("vectors").args(arguments).output().unwrap()
}

/// Tests the tables of every unit on every chip that has it: they can be read, agree with the model, and have the right number of rows.
#[test]
fn tables_of_all_units_are_sound() {
    for unit in units::all() {
        for profile in unit.profiles() {
            let contents = Contents { unit, profile: *profile, level: Level::L0, seed: 7 };
            let writer = Writer::new(contents);
            let text = text(&writer);
            let table = parse(&text, Path::new("table")).unwrap();
            assert_eq!(table.differences(), vec![], "{}", unit.name());
            let (rows, whole) = (table.rows.len(), cases::size(&unit.inputs()).min(900));
            assert!((whole..=1_000).contains(&(rows as u128)), "{}: {rows} rows", unit.name());
        }
    }
}

/// Checks the range of every number in more rows than a table has.
#[test]
fn numbers_fit_their_columns() {
    for unit in units::all() {
        let columns: Vec<_> = unit.inputs().into_iter().chain(unit.results()).collect();
        let results = unit.results().len();
        for profile in unit.profiles() {
            let conditions = Conditions { profile: *profile, policies: Policies::DEFAULT };
            for seed in 3..7 {
                cases::visit(unit, *profile, Level::L0, seed, |inputs, _| {
                    let mut row = inputs.to_vec();
                    row.resize(inputs.len() + results, 0);
                    let (inputs, outputs) = row.split_at_mut(inputs.len());
                    unit.evaluate(inputs, &conditions, outputs);
                    for (column, value) in columns.iter().zip(&row) {
                        assert!(column.kind.holds(*value), "{}: {} = {value} in {row:?}", unit.name(), column.name);
                    }
                });
            }
        }
    }
}

/// Every operation of an API has a program on the chip, and at least one row that is not black.
#[test]
fn programs_of_every_operation_run() {
    for (name, column) in
        [("texture-stage", 0), ("texture-environment", 0), ("texture-combine", 1), ("pixel-shader", 0)]
    {
        let unit = units::by_name(name).unwrap();
        let numbers = unit.inputs()[column].boundary();
        for profile in unit.profiles() {
            let writer = Writer::new(Contents { unit, profile: *profile, level: Level::L0, seed: 1 });
            let mut lit = std::collections::BTreeSet::new();
            cases::visit(unit, *profile, Level::L0, 1, |inputs, origin| {
                let row = writer.row(inputs, origin);
                if row.results[4..].iter().any(|value| *value != 0) {
                    lit.insert(inputs[column]);
                }
            });
            assert_eq!(lit.into_iter().collect::<Vec<_>>(), numbers, "{name}");
        }
    }
}

/// Each policy that a unit's rules name changes a row of the unit, and no other policy does.
#[test]
fn policies_change_the_units_of_their_rules() {
    let mut found: Vec<(String, &str)> = Vec::new();
    for unit in units::all() {
        for profile in unit.profiles() {
            cases::visit(unit, *profile, Level::L0, 1, |inputs, _| {
                let columns = unit.results();
                let mut results = vec![0; columns.len()];
                let conditions = Conditions { profile: *profile, policies: Policies::DEFAULT };
                unit.evaluate(inputs, &conditions, &mut results);
                for alternative in alternatives(unit, &columns, inputs, &conditions, &results) {
                    let rule = alternative.rule;
                    assert!(unit.rules().contains(&rule), "{} does not name {rule}", unit.name());
                    if !found.contains(&(alternative.policy.clone(), unit.name())) {
                        found.push((alternative.policy, unit.name()));
                    }
                }
            });
        }
    }
    for policy in ninebit::state::POLICIES {
        for (index, (value, _)) in policy.values.iter().enumerate() {
            let name = format!("{}={value}", policy.rule);
            let default = Policies::DEFAULT.chosen(policy.rule) == index;
            assert_eq!(found.iter().any(|(policy, _)| *policy == name), !default, "{name}");
        }
    }
}

#[test]
fn a_pack_is_whole_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let pack = place("pack");
    let manifest = pack::export(&pack, &options(&["product", "mux"])).unwrap();
    assert_eq!(manifest.files.len(), 18);
    let again = pack::export(&place("again"), &options(&["mux", "product"])).unwrap();
    assert_eq!(manifest, again, "the order of the units does not count");
    let (_, tables) = pack::open(&pack).unwrap();
    assert!(tables.iter().all(|table| table.differences().is_empty() && table.is_current()));

    let table = pack.join("units/mux.tsv");
    let text = std::fs::read_to_string(&table).unwrap();
    let refused = |code: &str| {
        let error = pack::open(&pack).unwrap_err();
        assert_eq!(error.code(), code, "{error}");
    };
    std::fs::write(&table, text.replacen('1', "0", 1)).unwrap();
    refused("NB1011");
    std::fs::remove_file(&table).unwrap();
    refused("NB1001");
    std::fs::write(&table, &text).unwrap();
    std::fs::write(pack.join("units/other.tsv"), "").unwrap();
    refused("NB1012");
    std::fs::remove_file(pack.join("units/other.tsv")).unwrap();
    let manifest = pack.join("MANIFEST.json");
    let json = std::fs::read_to_string(&manifest).unwrap();
    for (from, to, code) in [
        ("\"seed\": 1", "\"seed\": 2", "NB1011"),
        ("ninebit-vectors-1", "ninebit-vectors-9", "NB1003"),
        ("\"rows\"", "\"row\"", "NB1010"),
        ("units/mux.tsv", "../mux.tsv", "NB1010"),
        ("units/mux.tsv", "units/mux.hex", "NB1010"),
        ("units/mux.tsv", "units/zzz.tsv", "NB1010"),
        ("{", "", "NB1010"),
    ] {
        std::fs::write(&manifest, json.replacen(from, to, 1)).unwrap();
        refused(code);
    }
    std::fs::remove_file(&manifest).unwrap();
    refused("NB1001");
}

#[test]
fn tables_that_were_tampered_with_are_refused() {
    let unit = units::by_name("product").unwrap();
    let writer = Writer::new(Contents { unit, profile: Profile::Nv10, level: Level::L0, seed: 1 });
    let text = text(&writer);
    let lines: Vec<&str> = text.lines().collect();
    let row = lines[12];
    let fields: Vec<&str> = row.split('\t').collect();
    let with = |n: usize, value: &str| {
        let mut fields = fields.clone();
        fields[n] = value;
        text.replacen(row, &fields.join("\t"), 1)
    };
    let other = if fields[1] == "5" { "6" } else { "5" };
    let broken = [
        (String::new(), "NB1004"),
        (text.replacen("vectors 1", "vectors 2", 1), "NB1003"),
        (text.replacen("# unit product", "# unit produce", 1), "NB1005"),
        (text.replacen("# profile Nv10", "# profile Nv30", 1), "NB1005"),
        (text.replacen("# level L0", "# level L9", 1), "NB1005"),
        (text.replacen("# seed 1", "# seed x", 1), "NB1004"),
        (text.replacen("in.a", "in.x", 1), "NB1006"),
        (text.replacen("s10", "s11", 1), "NB1006"),
        (with(1, other), "NB1008"),
        (with(1, "512"), "NB1007"),
        (with(1, "+5"), "NB1007"),
        (with(3, ""), "NB1007"),
        (with(fields.len() - 4, "odd"), "NB1007"),
        (with(fields.len() - 1, "-\t-"), "NB1007"),
        (format!("{text}{row}\n"), "NB1009"),
        (text[..text.len() - 1].to_owned(), "NB1007"),
        (text[..text.len() - 9].to_owned(), "NB1007"),
        (text.replacen(row, "", 1), "NB1007"),
        (text.replacen('\n', "\r\n", 1), "NB1004"),
        (text.replacen(row, &format!("{row}\r"), 1), "NB1004"),
        (text.replacen("in.a\tin.b", "in.b\tin.a", 1), "NB1006"),
        (text.replacen("# seed 1\n", "", 1), "NB1004"),
    ];
    for (text, code) in broken {
        let error = parse(&text, Path::new("table")).unwrap_err();
        assert_eq!(error.code(), code, "{error}");
    }
    // A wrong result does not make a table invalid, because finding it is the purpose of the table.
    let wrong = with(4, if fields[4] == "7" { "8" } else { "7" });
    let table = parse(&wrong, Path::new("table")).unwrap();
    let differences = table.differences();
    assert_eq!(differences.len(), 1);
    assert_eq!(
        (differences[0].column.as_str(), differences[0].model.as_str(), differences[0].line),
        ("out.ab", fields[4], 13)
    );
}

/// Files that were truncated, reordered or exchanged after the export do not match the manifest. Nor does a table of another pack.
#[test]
fn files_that_were_changed_after_the_export_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (pack, other) = (folder.path().join("pack"), folder.path().join("other"));
    pack::export(&pack, &options(&["product", "mux"])).unwrap();
    pack::export(&other, &Options { seed: 2, ..options(&["product", "mux"]) }).unwrap();
    let table = pack.join("units/product.tsv");
    let text = std::fs::read_to_string(&table).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    lines.swap(20, 21);
    let reordered = lines.join("\n") + "\n";
    let doubled = format!("{text}{}\n", lines[30]);
    let foreign = std::fs::read_to_string(other.join("units/product.tsv")).unwrap();
    for changed in [reordered.as_str(), &doubled, &foreign, &text[..text.len() / 2], ""] {
        std::fs::write(&table, changed).unwrap();
        assert_eq!(pack::open(&pack).unwrap_err().code(), "NB1011");
    }
    std::fs::write(&table, text).unwrap();
    pack::open(&pack).unwrap();
    // The manifest and the tables have to agree on the properties of the pack.
    let manifest = std::fs::read_to_string(pack.join("MANIFEST.json")).unwrap();
    for (from, to) in [
        ("\"behaviour_rev\": 1", "\"behaviour_rev\": 7"),
        ("\"seed\": 1", "\"seed\": 2"),
        ("\"level\": \"L0\"", "\"level\": \"L1\""),
        ("\"profile\": \"Nv2a\"", "\"profile\": \"Nv10\""),
        ("\"rows\": 1000", "\"rows\": 999"),
    ] {
        assert!(manifest.contains(from), "{from}");
        std::fs::write(pack.join("MANIFEST.json"), manifest.replace(from, to)).unwrap();
        assert_eq!(pack::open(&pack).map(|_| ()).unwrap_err().code(), "NB1011", "{to}");
    }
    // The manifest of another pack names that pack, so neither the files nor the root match.
    std::fs::copy(other.join("MANIFEST.json"), pack.join("MANIFEST.json")).unwrap();
    assert_eq!(pack::open(&pack).unwrap_err().code(), "NB1011");
    std::fs::remove_dir_all(pack.join("schema")).unwrap();
    assert_eq!(pack::open(&pack).unwrap_err().code(), "NB1001");
    for place in ["/dev/null/pack", "/proc/pack"] {
        assert_eq!(vectors(&["export", "--unit", "mux", "-o", place]).status.code(), Some(7));
    }
}

/// Returns a pack with one wrong row and matching digests.
fn with_a_wrong_row(folder: &Path) -> PathBuf {
    use sha2::{Digest, Sha256};
    let pack = folder.join("wrong");
    pack::export(&pack, &options(&["mux"])).unwrap();
    let table = pack.join("units/mux.tsv");
    let text = std::fs::read_to_string(&table).unwrap();
    let row = text.lines().nth(20).unwrap();
    let mut fields: Vec<&str> = row.split('\t').collect();
    fields[3] = if fields[3] == "0" { "1" } else { "0" };
    let text = text.replacen(row, &fields.join("\t"), 1);
    std::fs::write(&table, &text).unwrap();
    let mut manifest = pack::manifest(&pack).unwrap();
    let hex = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let mut sums = String::new();
    for file in &mut manifest.files {
        if file.path == "units/mux.tsv" {
            file.sha256 = hex(&Sha256::digest(&text));
        }
        sums += &format!("{}  {}\n", file.sha256, file.path);
    }
    manifest.root = hex(&Sha256::digest(&sums));
    std::fs::write(pack.join("MANIFEST.json"), serde_json::to_string(&manifest).unwrap()).unwrap();
    pack
}

#[test]
fn the_command_line_tells_packs_apart() {
    let folder = tempfile::tempdir().unwrap();
    let good = folder.path().join("good");
    let output =
        vectors(&["export", "--unit", "mux", "--view", "hex", "--view", "jsonl", "-o", good.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let wrong = with_a_wrong_row(folder.path());
    let [good, wrong] = [&good, &wrong].map(|path| path.to_str().unwrap());

    let said = |output: &Output| String::from_utf8(output.stdout.clone()).unwrap();
    assert_eq!(vectors(&["check", good]).status.code(), Some(0));
    let output = vectors(&["check", wrong]);
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output).contains("mux: 1 of 1000 rows differ"), "{output:?}");
    assert_eq!(vectors(&["diff", good, good]).status.code(), Some(0));
    let output = vectors(&["diff", good, wrong]);
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output).contains("mux: 0 rows more, 0 fewer, 1 changed"), "{output:?}");
    assert_eq!(vectors(&["check", folder.path().to_str().unwrap()]).status.code(), Some(4));
    assert_eq!(vectors(&["export", "--unit", "mix", "-o", good]).status.code(), Some(2));
    assert_eq!(vectors(&["export", "--unit", "shader-remap", "--profile", "nv10", "-o", good]).status.code(), Some(2));
    let listed = said(&vectors(&["list"]));
    for unit in units::all() {
        assert!(listed.contains(unit.name()) && listed.contains(unit.about()));
    }
}

/// The packed view has the same bits as the table.
#[test]
fn packed_rows_are_the_rows() {
    use ninebit_vectors::view::{Layout, packed};
    for name in ["input-mapping", "general-stage", "shader-remap"] {
        let unit = units::by_name(name).unwrap();
        let writer = Writer::new(Contents { unit, profile: Profile::Nv2a, level: Level::L0, seed: 1 });
        let layout = Layout::new(&writer);
        let mut left = 50;
        cases::visit(unit, Profile::Nv2a, Level::L0, 1, |inputs, origin| {
            if left == 0 {
                return;
            }
            left -= 1;
            let row = writer.row(inputs, origin);
            let word = packed(&layout, &row);
            assert_eq!(word.len(), layout.width.div_ceil(4) as usize);
            let bit = |n: u32| {
                let digit = word.as_bytes()[word.len() - 1 - n as usize / 4] as char;
                digit.to_digit(16).unwrap() >> (n % 4) & 1
            };
            for (slice, value) in layout.slices.iter().zip(row.inputs.iter().chain(&row.results)) {
                let bits: i64 = (slice.low..=slice.high).map(|n| i64::from(bit(n)) << (n - slice.low)).sum();
                let width = slice.high - slice.low + 1;
                let signed = slice.column.kind.is_signed() && bits >> (width - 1) & 1 != 0;
                assert_eq!(if signed { bits - (1 << width) } else { bits }, *value, "{name} {}", slice.column.name);
            }
        });
    }
}

/// A row is found by its id, in a pack or in a table, and shown as the model computes it.
#[test]
fn a_row_is_shown_as_a_trace() {
    let bench = bench::Bench::new();
    bench.run("vectors export --unit scale-bias --unit general-stage -o pack").data();
    let (pack, table) = ("pack", bench.path("pack/units/scale-bias.tsv"));
    let text = std::fs::read_to_string(&table).unwrap();
    let (line, row) = (1..).zip(text.lines()).find(|(_, line)| line.contains("policy:CMB-9")).unwrap();
    let id = row.split('\t').next().unwrap();
    let shown = bench.run(&format!("vectors show {pack} {id}")).text();
    assert!(shown.starts_with(&format!("row {id}, line {line} of `")), "{shown}");
    for part in [
        "\n  inputs         cfg.scale ",
        "\n  intermediates  mid.product ",
        "\n  outputs        out.value ",
        "\n  rules          CMB-9  SC   Output\n",
        "Of the undecided rules CMB-9 would change this result.\n  CMB-9=after ",
    ] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    let stage = std::fs::read_to_string(bench.path("pack/units/general-stage.tsv")).unwrap();
    let stage = stage.lines().last().unwrap().split('\t').next().unwrap().to_uppercase();
    assert!(bench.run(&format!("vectors show {pack} {stage}")).text().contains("stage0.rgb.AB.r"));
    let document = bench.run(&format!("vectors show {} {id} --format json", table.to_str().unwrap())).text();
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    assert_eq!((&document["format"], &document["row"]), (&"ninebit-row-1".into(), &id.into()));
    assert_eq!(document["results"], document["model"]);
    bench.run(&format!("vectors show {pack} 000000000000")).failed(3, "error[NB1014]");
    bench.run("vectors show nowhere 000000000000").failed(4, "error[NB1001]");
    // A table that says something else than the model.
    let fields: Vec<&str> = row.split('\t').collect();
    let at = text
        .lines()
        .find(|line| line.starts_with("id\t"))
        .unwrap()
        .split('\t')
        .position(|name| name == "out.value")
        .unwrap();
    let mut other = fields.clone();
    let wrong = if fields[at] == "9" { "8" } else { "9" };
    other[at] = wrong;
    bench.write("scale-bias.tsv", text.replace(row, &other.join("\t")));
    let run = bench.run(&format!("vectors show scale-bias.tsv {id}"));
    assert_eq!(run.status, 1);
    let said = String::from_utf8(run.stdout).unwrap();
    assert!(said.ends_with(&format!("the table has out.value {wrong}, the model {}\n", fields[at])), "{said}");
    // A row whose inputs were changed is not the row of that id.
    bench.write("scale-bias.tsv", text.replace(row, &row.replacen(&format!("\t{}\t", fields[3]), "\t77\t", 1)));
    bench.run(&format!("vectors show scale-bias.tsv {id}")).failed(3, "error[NB1008]");
}
