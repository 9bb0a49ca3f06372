//! Tests the results of cards: they are compared with their pack, refused if they are incomplete, and adopted if they come from silicon.
#![allow(clippy::unwrap_used, missing_docs, reason = "a test fails by panicking")]

use crate::repository::at;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use ninebit::state::{Named, Policies};
use ninebit_vectors::BEHAVIOUR;
use ninebit_vectors::cases::Level;
use ninebit_vectors::column::Kind;
use ninebit_vectors::pack::{self, Manifest, Options};
use ninebit_vectors::read::Table;
use ninebit_vectors::results::adopt::AdoptionRecord;
use ninebit_vectors::results::compare::{Comparison, compare};
use ninebit_vectors::results::waiver::Waiver;
use ninebit_vectors::results::{self, parse};
use ninebit_vectors::unit::Conditions;
use ninebit_vectors::units;

const UNITS: [&str; 3] = ["product", "scale-bias", "input-mapping"];

/// A vector pack, and a folder for the results of a card.
struct Export {
    folder: tempfile::TempDir,
    manifest: Manifest,
    tables: Vec<Table>,
}

impl Export {
    fn new() -> Export {
        Export::of(&UNITS)
    }

    fn of(units: &[&str]) -> Export {
        let folder = tempfile::tempdir().unwrap();
        let options = Options {
            profile: *units::by_name(units[0]).unwrap().profiles().last().unwrap(),
            level: Level::L0,
            seed: 1,
            units: units.iter().map(|name| units::by_name(name).unwrap()).collect(),
            deciding: false,
            views: vec![],
        };
        pack::export(&folder.path().join("pack"), &options).unwrap();
        let (manifest, tables) = pack::open(&folder.path().join("pack")).unwrap();
        let asked = Export { folder, manifest, tables };
        asked.answer("NVIDIA Corporation", "GeForce 256/AGP", Policies::DEFAULT);
        asked
    }

    fn results(&self) -> PathBuf {
        self.folder.path().join("results")
    }

    fn path(&self, unit: &str) -> PathBuf {
        self.results().join(format!("{unit}.tsv"))
    }

    /// Writes the results of a card that follows these policies. Rows with real numbers are left out.
    fn answer(&self, vendor: &str, renderer: &str, policies: Policies) {
        self.answer_in(vendor, renderer, policies, None);
    }

    /// Writes results that also follow this reading of an open question.
    fn answer_in(&self, vendor: &str, renderer: &str, policies: Policies, reading: Option<i64>) {
        fs::create_dir_all(self.results()).unwrap();
        let device = serde_json::json!({
            "format": "ninebit-device-1", "pack": self.manifest.root, "vendor": vendor, "renderer": renderer, "version": "1.2",
            "surface": "GLX window", "surface_format": "R8 G8 B8 A8, 0 sample buffers", "extensions": "GL_NV_register_combiners",
        });
        fs::write(self.results().join("device.json"), device.to_string()).unwrap();
        for table in &self.tables {
            let (unit, profile) = (table.writer.contents().unit, table.writer.contents().profile);
            let columns = unit.results();
            let out: Vec<usize> = (0..columns.len()).filter(|n| columns[*n].name.starts_with("out.")).collect();
            let names: Vec<&str> = out.iter().map(|n| columns[*n].name.as_str()).collect();
            let mut body = format!(
                "# ninebit-results 1\n# unit {}\n# profile {}\n# level L0\n# seed 1\n# behaviour {BEHAVIOUR}\nid\t{}\tstatus\n",
                unit.name(),
                profile.name(),
                names.join("\t"),
            );
            for row in &table.rows {
                let mut answer = vec![0; row.results.len()];
                let mut inputs = row.inputs.clone();
                inputs[0] = reading.unwrap_or(inputs[0]);
                unit.evaluate(&inputs, &Conditions { profile, policies }, &mut answer);
                let text = |n: &usize| match columns[*n].kind {
                    Kind::Hex(_) => answer[*n].to_string(),
                    kind => kind.write(answer[*n]),
                };
                let texts: Vec<String> = out.iter().map(text).collect();
                if texts.iter().all(|text| !text.contains('.')) {
                    body += &format!("{}\t{}\tok\n", row.id, texts.join("\t"));
                }
            }
            body += "# unsupported 0\n";
            fs::write(self.path(unit.name()), sealed(&body)).unwrap();
        }
    }

    fn compare(&self, waivers: &[Waiver]) -> Comparison {
        let results = results::open(&self.results(), &self.manifest).unwrap();
        compare(&self.tables, &results, waivers, 3).unwrap()
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ninebit"));
        command.current_dir(self.folder.path()).arg("vectors").args(arguments);
        command.output().unwrap()
    }

    /// Returns the score of the results, with the exit status.
    fn score(&self, more: &[&str]) -> (serde_json::Value, Option<i32>) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ninebit"));
        let arguments = ["score", "--pack", "pack", "--results", "results", "--format", "json"];
        let output = command.current_dir(self.folder.path()).args(arguments).args(more).output().unwrap();
        (serde_json::from_slice(&output.stdout).unwrap_or_default(), output.status.code())
    }
}

/// Returns the text with a last line that has its row count and checksum.
fn sealed(body: &str) -> String {
    let rows = body.lines().filter(|line| !line.starts_with('#')).count().saturating_sub(1);
    format!("{body}# end {rows} {:08x}\n", crc32fast::hash(body.as_bytes()))
}

/// Changes a file of results and replaces its last line with a correct one.
fn changed(path: &Path, change: impl Fn(&str) -> String) {
    let text = fs::read_to_string(path).unwrap();
    let body = &text[..text.rfind("# end").unwrap()];
    let body = change(body);
    fs::write(path, sealed(&body)).unwrap();
}

/// Replaces the result of the first row of product whose result is 78.
fn with_product(asked: &Export, found: &str) {
    changed(&asked.path("product"), |body| {
        let row = body.lines().find(|line| line.contains("\t78\t")).unwrap();
        body.replacen(row, &row.replace("\t78\t", &format!("\t{found}\t")), 1)
    });
}

/// A card that rounds late and expands to the letter: the scorecard names both as the causes, and explains every row.
#[test]
fn the_scorecard_names_the_causes_of_rows() {
    let asked = Export::new();
    let (right, _) = asked.score(&[]);
    assert_eq!(right["runs"][0]["total"]["exact"], UNITS.len());
    let mut policies = Policies::default();
    ["CMB-3=literal", "CMB-9=after"].into_iter().for_each(|policy| policies.set(policy).unwrap());
    asked.answer("Mesa", "llvmpipe", policies);
    let (document, status) = asked.score(&["--at-least", "100", "-o", "report"]);
    assert_eq!(status, Some(1));
    let run = &document["runs"][0];
    let causes = run["causes"]["causes"].as_array().unwrap();
    let names: Vec<&str> =
        causes.iter().flat_map(|c| c["shortcuts"].as_array().unwrap()).map(|s| s.as_str().unwrap()).collect();
    assert!(names.contains(&"literal-expand") && names.contains(&"late-rounding"), "{names:?}");
    assert!(names.iter().all(|name| ["literal-expand", "late-rounding"].contains(name)), "{names:?}");
    assert_eq!(run["causes"]["explained_pixels"], run["causes"]["wrong_pixels"]);
    let wrong: usize = asked.compare(&[]).units.iter().map(|unit| unit.asked - unit.exact).sum();
    assert_eq!(run["total"]["pixels"]["wrong"], wrong);
    assert!(run["name"].as_str().unwrap().starts_with("llvmpipe"));
    let page = fs::read_to_string(asked.folder.path().join("report/index.html")).unwrap();
    assert!(page.contains("a row as a pixel") && page.contains("ninebit rule CMB-9") && page.contains("late-rounding"));
    // Results of another pack are refused.
    let other = Export::of(&["product"]);
    fs::copy(other.path("product"), asked.path("product")).unwrap();
    fs::copy(other.results().join("device.json"), asked.results().join("device.json")).unwrap();
    assert_eq!(asked.score(&[]).1, Some(3));
}

#[test]
fn what_agrees_is_exact() {
    let asked = Export::new();
    let comparison = asked.compare(&[]);
    assert!(comparison.is_clean() && comparison.explanation.is_none());
    for unit in &comparison.units {
        assert_eq!((unit.exact, unit.not_asked, unit.rows.len()), (1000, 0, 0), "{}", unit.unit);
    }
    let output = asked.run(&["compare", "pack", "results"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(String::from_utf8(output.stdout).unwrap().contains("everything that was asked is exact"));
}

/// If a card follows another value of a policy, the comparison names it.
#[test]
fn the_policy_that_a_card_follows_is_named() {
    let asked = Export::new();
    for (policy, unit) in
        [("CMB-9=after", "scale-bias"), ("CMB-3=literal", "input-mapping"), ("CMB-4=127", "input-mapping")]
    {
        let mut policies = Policies::DEFAULT;
        policies.set(policy).unwrap();
        asked.answer("NVIDIA Corporation", "GeForce 256", policies);
        let comparison = asked.compare(&[]);
        let best = comparison.explanation.unwrap();
        assert_eq!((best.policy.as_str(), best.breaks), (policy, 0));
        let compared = comparison.units.iter().find(|compared| compared.unit == unit).unwrap();
        assert_eq!(compared.policies[0].explains, compared.off_by_one + compared.worse);
        let rule = format!("policy:{}", policy.split('=').next().unwrap());
        assert!(compared.tags[&rule].differ >= best.explains, "{:?}", compared.tags);
    }
}

/// If a card follows one reading of an open question, the comparison names it, and rows of the other readings contradict nothing.
#[test]
fn the_reading_that_a_card_follows_is_named() {
    for unit in units::all().into_iter().filter(|unit| !unit.readings().is_empty()) {
        let name = unit.name();
        let asked = Export::of(&[name]);
        for (reading, value) in (0..).zip(unit.readings()) {
            asked.answer_in("NVIDIA Corporation", "GeForce3", Policies::DEFAULT, Some(reading));
            let comparison = asked.compare(&[]);
            let compared = &comparison.units[0];
            let best = comparison.explanation.as_ref().unwrap();
            let said = format!("{}={value}", unit.rules()[0]);
            assert_eq!((&best.policy, best.breaks), (&said, 0));
            assert!(compared.waived > 100 && compared.waived == compared.off_by_one + compared.worse, "{compared:?}");
            assert!(comparison.is_clean() && compared.reason.as_ref().unwrap().contains(&said));
            let output = asked.run(&["compare", "pack", "results"]);
            assert_eq!(output.status.code(), Some(0), "{output:?}");
            assert!(String::from_utf8(output.stdout).unwrap().contains(&format!("{said} explains the most")));
        }
        let output = asked.run(&["adopt", "pack", "results", "-o", "adopted", "--device", "geforce3"]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let record = fs::read(asked.folder.path().join("adopted/geforce3/ADOPTED.json")).unwrap();
        let record: AdoptionRecord = serde_json::from_slice(&record).unwrap();
        assert_eq!((record.behaviour_rev, record.units[0].contradicted), (BEHAVIOUR, 0));
        // A row that no reading explains is a difference.
        changed(&asked.path(name), |body| {
            let row = body.lines().nth(8).unwrap();
            let (before, last) = row.strip_suffix("\tok").unwrap().rsplit_once('\t').unwrap();
            let wrong = if last == "7" { "5" } else { "7" };
            body.replacen(row, &format!("{before}\t{wrong}\tok"), 1)
        });
        assert!(!asked.compare(&[]).is_clean(), "{name}");
    }
}

#[test]
fn differences_are_told_with_intermediates_and_waived_by_name_only() {
    let asked = Export::new();
    with_product(&asked, "79");
    let waiver = |maximum, count| Waiver { unit: "product".to_owned(), maximum, count, reason: "known".to_owned() };
    let comparison = asked.compare(&[]);
    let product = &comparison.units[1];
    assert_eq!((product.unit, product.off_by_one, product.worse, product.largest), ("product", 1, 0, 1));
    assert_eq!(product.rows[0].differences, [("out.ab".to_owned(), "78".to_owned(), "79".to_owned())]);
    assert!(product.rows[0].row.iter().any(|field| field.starts_with("mid.product=")));
    assert!(!comparison.is_clean() && asked.compare(&[waiver(1, 1)]).is_clean());

    with_product(&asked, "80");
    let comparison = asked.compare(&[waiver(1, 2)]);
    assert_eq!((comparison.units[1].off_by_one, comparison.units[1].worse), (1, 1));
    assert!(!comparison.is_clean(), "a difference of two is not waived by a maximum of one");
    assert!(!asked.compare(&[waiver(2, 1)]).is_clean(), "two rows are not waived by a count of one");
    assert!(asked.compare(&[waiver(2, 2)]).is_clean());

    let file = asked.folder.path().join("waivers.json");
    for (text, exit) in [
        (r#"[{"unit": "product", "maximum": 2, "count": 2, "reason": "known"}]"#, 0),
        (r#"[{"unit": "product", "maximum": 2, "count": 1, "reason": "known"}]"#, 1),
        (r#"[{"unit": "produce", "maximum": 2, "count": 2, "reason": "known"}]"#, 3),
        (r#"[{"unit": "product", "maximum": 2, "count": 2, "reason": " "}]"#, 3),
        (r#"[{"unit": "product", "maximum": 2, "count": 2}]"#, 3),
    ] {
        fs::write(&file, text).unwrap();
        let output = asked.run(&["compare", "pack", "results", "--waivers", "waivers.json"]);
        assert_eq!(output.status.code(), Some(exit), "{output:?}");
    }
    assert_eq!(asked.run(&["compare", "pack", "results", "--waivers", "none.json"]).status.code(), Some(4));
    let output = asked.run(&["compare", "pack", "results", "--format", "json"]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(value["comparison"]["units"][1]["worse"], 1);
}

/// Every kind of damage to a file of results has its code.
#[test]
fn spoiled_results_are_refused() {
    let asked = Export::new();
    let path = asked.path("product");
    let good = fs::read_to_string(&path).unwrap();
    let row = good.lines().nth(9).unwrap();
    let next = good.lines().nth(10).unwrap();
    let body = &good[..good.rfind("# end").unwrap()];
    let broken = [
        (String::new(), "NB1030"),
        (good[..good.len() - 1].to_owned(), "NB1030"),
        (good[..good.len() / 2].to_owned(), "NB1030"),
        (body.to_owned(), "NB1030"),
        (good.replacen(row, next, 1), "NB1030"),
        (good.replacen(&format!("{row}\n{next}\n"), &format!("{next}\n{row}\n"), 1), "NB1030"),
        (good.replacen("results 1", "results 2", 1), "NB1003"),
        (sealed(&body.replacen("# unit product", "# unit produce", 1)), "NB1005"),
        (sealed(&body.replacen("# seed 1", "# sead 1", 1)), "NB1032"),
        (sealed(&body.replacen("out.ab", "out.xy", 1)), "NB1032"),
        (sealed(&body.replacen("out.ab", "mid.product", 1)), "NB1032"),
        (sealed(&body.replacen("out.ab", "out.ab>>99", 1)), "NB1032"),
        (sealed(&body.replacen(row, &format!("{row}\n{row}"), 1)), "NB1009"),
        (sealed(&body.replacen(row, &row.replacen("\tok", "\tfine", 1), 1)), "NB1032"),
        (sealed(&body.replacen(row, &row.replacen("\tok", "\terror", 1), 1)), "NB1032"),
        (sealed(&body.replacen(row, &row.replacen('\t', "\t+", 1), 1)), "NB1032"),
        (sealed(&body.replacen(row, &format!("x{}", &row[1..]), 1)), "NB1032"),
        (sealed(&body.replacen(row, &row[..12], 1)), "NB1032"),
        (sealed(&body.replacen("# unsupported 0\n", "", 1)), "NB1032"),
    ];
    for (text, code) in broken {
        let error = parse(&text, Path::new("results")).unwrap_err();
        assert_eq!(error.code(), code, "{error}");
    }
    assert_eq!(parse(&good, &path).unwrap().rows.len(), 1000);
}

/// If the chip cannot show the results of a unit, none of its rows was asked. Its table has neither observed columns nor rows.
#[test]
fn a_unit_that_a_card_cannot_show_was_not_asked() {
    let asked = Export::new();
    let of_columns = |columns: &str, row: &str| {
        changed(&asked.path("product"), |body| {
            let head: String = body.lines().take(6).map(|line| format!("{line}\n")).collect();
            format!("{head}{columns}\n{row}# unsupported 0\n")
        });
    };
    of_columns("id\tstatus", "");
    let comparison = asked.compare(&[]);
    assert!(comparison.is_clean());
    assert_eq!(
        (comparison.units[1].unit, comparison.units[1].asked, comparison.units[1].not_asked),
        ("product", 0, 1000)
    );
    let output = asked.run(&["compare", "pack", "results"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let output = asked.run(&["adopt", "pack", "results", "-o", "adopted", "--device", "geforce-256"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(!asked.folder.path().join("adopted/geforce-256/product.tsv").exists(), "nothing was asked of it");

    // A row without results confirms nothing.
    let id =
        asked.tables.iter().find(|table| table.writer.contents().unit.name() == "product").unwrap().rows[0].id.clone();
    for (columns, row) in [
        ("id\tstatus", format!("{id}\tok\n")),
        ("idstatus", String::new()),
        ("id\t\tstatus", String::new()),
        ("status\tid", String::new()),
        ("id", String::new()),
        ("", String::new()),
    ] {
        of_columns(columns, &row);
        let output = asked.run(&["compare", "pack", "results"]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(3) && said.contains("NB1032"), "{columns:?} {row:?}: {said}");
    }
}

/// Tests errors that only the folder as a whole shows.
#[test]
fn results_of_something_else_are_refused() {
    let asked = Export::new();
    let refused = |code: &str, exit: i32| {
        for command in ["compare", "adopt"] {
            let output = asked.run(&[command, "pack", "results"]);
            let said = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(exit), "{said}");
            assert!(said.contains(code) && said.contains("help: "), "{said}");
        }
        asked.answer("NVIDIA Corporation", "GeForce 256", Policies::DEFAULT);
    };
    let device = asked.results().join("device.json");
    let text = fs::read_to_string(&device).unwrap();
    fs::write(&device, text.replace(&asked.manifest.root, &"0".repeat(64))).unwrap();
    refused("NB1031", 3);
    fs::write(&device, text.replace("ninebit-device-1", "ninebit-device-2")).unwrap();
    refused("NB1003", 3);
    fs::write(&device, "{").unwrap();
    refused("NB1033", 3);
    fs::remove_file(&device).unwrap();
    refused("NB1001", 4);
    changed(&asked.path("product"), |body| body.replacen("# seed 1", "# seed 2", 1));
    refused("NB1031", 3);
    changed(&asked.path("product"), |body| format!("{body}0123456789ab\t1\tok\n"));
    refused("NB1035", 3);
    fs::rename(asked.path("product"), asked.path("sum")).unwrap();
    refused("NB1032", 3);
    fs::remove_file(asked.path("sum")).unwrap();
    fs::write(asked.results().join("sum.part"), "").unwrap();
    refused("NB1030", 3);
    fs::remove_file(asked.results().join("sum.part")).unwrap();
    UNITS.iter().for_each(|unit| fs::remove_file(asked.path(unit)).unwrap());
    refused("NB1001", 4);
}

/// Batches ask rows of their table, and refer to bytes that exist.
#[test]
fn batches_ask_rows_of_their_table() {
    const DRAWN: [&str; 4] = ["compressed-block", "filtered-shadow", "mux", "product"];
    let folder = tempfile::tempdir().unwrap();
    let pack = folder.path().join("pack");
    let arguments =
        ["product", "compressed-block", "filtered-shadow", "mux", "depth"].map(|unit| ["--unit", unit]).concat();
    let mut command = Command::new(env!("CARGO_BIN_EXE_ninebit"));
    let output =
        command.args(["vectors", "export"]).args(arguments).args(["--gpu-batches", "-o"]).arg(&pack).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let (manifest, tables) = pack::open(&pack).unwrap();
    let batches = manifest.files.iter().filter(|file| file.path.ends_with(".gpu.txt"));
    assert_eq!(batches.map(|file| file.unit.as_str()).collect::<Vec<_>>(), DRAWN);
    for unit in DRAWN {
        let text = fs::read_to_string(pack.join(format!("units/{unit}.gpu.txt"))).unwrap();
        let raw = fs::read(pack.join(format!("units/{unit}.gpu.raw"))).unwrap();
        let table = tables.iter().find(|table| table.writer.contents().unit.name() == unit).unwrap();
        let (mut place, mut rows, mut asked) = (0, 0, 0);
        for line in text.lines() {
            let words: Vec<&str> = line.split(' ').collect();
            let number = |n: usize| words[n].parse::<usize>().unwrap();
            match words[0] {
                "batch" => rows = number(1),
                "ids" => {
                    assert_eq!(number(1), place);
                    for id in raw[place..place + 6 * rows].chunks(6) {
                        let id: String = id.iter().map(|byte| format!("{byte:02x}")).collect();
                        assert!(table.rows.iter().any(|row| row.id == id), "{unit}: {id}");
                    }
                    place += 6 * rows;
                    asked += rows;
                }
                "source" => {
                    assert_eq!(number(3), place);
                    place += number(2) * rows;
                }
                _ => {}
            }
        }
        assert_eq!(place, raw.len(), "{unit}");
        assert!(asked >= 500, "{unit}: {asked} rows");
    }
}

/// Scenes lie beside the tables, with the picture of each reading, by which a card's answer is named.
#[test]
fn scenes_are_asked_and_named_by_their_reading() {
    let asked = Export::new();
    let scenes = ["vectors/scenes/deciding", "vectors/scenes/fog/corridor.ron", "vectors/harness/gl/scenes"];
    let scenes = scenes.map(|scenes| at(scenes).display().to_string());
    let mut arguments = vec!["export"];
    UNITS.iter().for_each(|unit| arguments.extend(["--unit", unit]));
    scenes.iter().for_each(|scenes| arguments.extend(["--scenes", scenes]));
    arguments.extend(["-o", "pack"]);
    let output = asked.run(&arguments);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    let left_out: Vec<&str> = text.lines().filter(|line| line.contains("left out: ")).collect();
    assert_eq!(
        left_out,
        [
            "DEP-6-slope              left out: a w buffer",
            "FOG-3-third              left out: fog by parameters that no range or density gives",
        ]
    );
    let place = asked.folder.path().join("pack/scenes");
    let files = |name: &str| {
        let lines = fs::read_to_string(place.join(format!("{name}.scene.txt"))).unwrap();
        (lines, fs::read(place.join(format!("{name}.scene.raw"))).unwrap())
    };
    for (name, draws, parts) in [
        (
            "CMB-9-scale",
            12,
            &["needs GL_NV_register_combiners2", "scissor 0 0 ", "combiners 1", "blend FUNC_REVERSE_SUBTRACT ONE ONE"]
                [..],
        ),
        (
            "TSH-6-dependent",
            3,
            &["needs GL_NV_texture_shader", "shader 1 SHADER_OPERATION_NV DEPENDENT_GB_TEXTURE_2D_NV"],
        ),
        (
            "SHD-1-filter",
            3,
            &["needs GL_ARB_shadow", "depths 0 2 1 16 0", "compare 0 LESS", "env 0 TEXTURE_ENV_MODE REPLACE"],
        ),
        ("TEX-17-weights", 6, &["needs GL_EXT_texture_filter_anisotropic", "anisotropy 0 4"]),
        ("corridor", 1, &["needs GL_EXT_fog_coord", "fog_density EXP2 ", "fog_color 150 160 180"]),
        (
            "depths",
            4,
            &[
                "clear 9 8 7 255",
                "mask 0 0 0 0",
                "mask 1 1 1 0",
                "clear_depth 12582911 3",
                "depth LESS 0",
                "offset -1 -2",
                "stencil_test EQUAL 3 255 6 KEEP KEEP INVERT",
            ],
        ),
        ("fogs", 2, &["needs GL_EXT_secondary_color", "fog_range 1 3", "fog_density EXP2 0.4999", "color_sum"]),
    ] {
        let (lines, raw) = files(name);
        let vertices: Vec<&str> = lines.lines().filter(|line| line.starts_with("vertices ")).collect();
        for line in &vertices {
            let [count, first] = [2, 3].map(|n| line.split(' ').nth(n).unwrap().parse::<usize>().unwrap());
            assert!(count % 3 == 0 && first + 92 * count <= raw.len(), "{line}");
        }
        assert_eq!(vertices.len(), draws, "{lines}");
        for part in parts {
            assert!(lines.lines().any(|line| line.starts_with(part)), "{part}: {lines}");
        }
    }
    // What OpenGL computes without combiners asks for none.
    for name in ["SHD-1-filter", "TEX-17-weights", "depths", "fogs"] {
        assert!(!files(name).0.contains("combiners"), "{name}");
    }
    let answers = asked.results();
    fs::copy(place.join("CMB-3-expand.png"), answers.join("CMB-3-expand.png")).unwrap();
    let compared = || {
        let output = asked.run(&["compare", "pack", "results"]);
        (output.status.code(), String::from_utf8(output.stdout).unwrap())
    };
    let (status, text) = compared();
    assert!(status == Some(0) && text.contains("CMB-3-expand            as expected\n"), "{text}");
    assert!(text.contains("CMB-8-dot               not asked"), "{text}");
    fs::copy(place.join("CMB-8-dot@CMB-8=each.png"), answers.join("CMB-8-dot.png")).unwrap();
    let (status, text) = compared();
    assert!(status == Some(1) && text.contains("CMB-8-dot               as CMB-8=each, "), "{text}");
}

/// Returns the adopted records that contradict the current model, or whose files were changed.
fn owed(folder: &Path) -> Vec<String> {
    use sha2::{Digest, Sha256};
    let mut owed = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let place = entry.unwrap().path();
        let text = fs::read_to_string(place.join("ADOPTED.json")).unwrap();
        let adopted: AdoptionRecord = serde_json::from_str(&text).unwrap();
        if adopted.behaviour_rev > BEHAVIOUR {
            owed.push(format!("{} wants behaviour {}", adopted.device, adopted.behaviour_rev));
        }
        for unit in adopted.units {
            let bytes = fs::read(place.join(format!("{}.tsv", unit.unit))).unwrap();
            let digest: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
            if digest != unit.sha256 {
                owed.push(format!("{}: {} was changed", adopted.device, unit.unit));
            }
        }
    }
    owed
}

#[test]
fn cards_are_adopted_and_the_model_owes_what_they_contradict() {
    let asked = Export::new();
    let adopted = asked.folder.path().join("adopted");
    let output = asked.run(&["adopt", "pack", "results", "-o", "adopted"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let text = fs::read_to_string(adopted.join("geforce-256-agp/ADOPTED.json")).unwrap();
    let record: AdoptionRecord = serde_json::from_str(&text).unwrap();
    assert_eq!((record.grade.as_str(), record.behaviour_rev, record.units.len()), ("SILICON", BEHAVIOUR, 3));
    assert_eq!(owed(&adopted), [""; 0]);

    // The same device is refused a second time, but another name is not. Results that contradict the model are listed as owed.
    assert_eq!(asked.run(&["adopt", "pack", "results", "-o", "adopted"]).status.code(), Some(3));
    with_product(&asked, "79");
    let output = asked.run(&["adopt", "pack", "results", "-o", "adopted", "--device", "geforce-256-ddr"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(String::from_utf8(output.stdout).unwrap().contains(&format!("set BEHAVIOUR to {}", BEHAVIOUR + 1)));
    assert_eq!(owed(&adopted), [format!("geforce-256-ddr wants behaviour {}", BEHAVIOUR + 1)]);
    fs::write(adopted.join("geforce-256-agp/product.tsv"), "").unwrap();
    assert_eq!(owed(&adopted).len(), 2);
    assert_eq!(
        owed(&at("vectors/results")),
        [""; 0],
        "what cards said is in the repository, the model does not follow"
    );
}

#[test]
fn nothing_is_adopted_by_halves() {
    let asked = Export::new();
    let left = || fs::read_dir(asked.folder.path().join("adopted")).map_or(0, Iterator::count);
    let refused = |arguments: &[&str], exit: i32| {
        let output = asked.run(&[&["adopt", "pack", "results"], arguments].concat());
        assert_eq!(output.status.code(), Some(exit), "{output:?}");
        assert_eq!(left(), 0);
    };
    for name in ["Up", "../up", "a--b", ""] {
        refused(&["-o", "adopted", "--device", name], 3);
    }
    for (vendor, renderer) in [
        ("Mesa/X.org", "llvmpipe (LLVM 15.0.6, 256 bits)"),
        ("Microsoft Corporation", "GDI Generic"),
        ("Google Inc.", "SwiftShader"),
        ("Apple", "Apple Software Renderer"),
        ("ninebit recorder", "ninebit recorder"),
    ] {
        asked.answer(vendor, renderer, Policies::DEFAULT);
        refused(&["-o", "adopted"], 3);
    }
    asked.answer("NVIDIA Corporation", "GeForce 256", Policies::DEFAULT);
    let device = asked.results().join("device.json");
    for (version, exit) in [("4.6.0 NVIDIA 580.159.04", 3), ("2.1.2", 3), ("1.5.8 NVIDIA 96.43.23", 7), ("1.2", 7)] {
        let mut changed: serde_json::Value = serde_json::from_str(&fs::read_to_string(&device).unwrap()).unwrap();
        changed["version"] = version.into();
        fs::write(&device, changed.to_string()).unwrap();
        refused(&["-o", "pack/MANIFEST.json"], exit);
    }
    changed(&asked.path("product"), |body| {
        let row = body.lines().nth(9).unwrap();
        body.replacen(row, &format!("{}\t-\terror", &row[..12]), 1)
    });
    refused(&["-o", "adopted"], 3);
    assert_eq!(asked.run(&["compare", "pack", "results"]).status.code(), Some(1), "a failed draw is a difference");
}

#[test]
fn what_a_killed_run_left_and_what_a_card_calls_itself_harm_nobody() {
    let asked = Export::new();
    asked.answer("::error::injected\n::error::again", "\u{1b}[31mred\u{202e}##[error]old", Policies::DEFAULT);
    fs::write(asked.results().join(".ninebit-a1B2c3.part"), "half a file").unwrap();
    for command in ["compare", "adopt"] {
        let output = asked.run(&[command, "pack", "results"]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8(output.stdout).unwrap();
        let order = |line: &str| {
            line.trim_start().starts_with("::") || line.contains("##[") || line.contains(['\u{1b}', '\u{202e}'])
        };
        assert!(!text.lines().any(order), "{text:?}");
        assert!(text.contains(r"\u{1b}[31mred\u{202e}"), "{text:?}");
    }
}
