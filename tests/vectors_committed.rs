//! Tests the files under `vectors` other than scenes: packs, schemas, the list of mutations.
#![allow(clippy::unwrap_used, missing_docs, reason = "a test fails by panicking")]

use crate::repository::at;
use crate::settings::bless;
use std::fs;
use std::path::Path;
use std::process::Command;

use ninebit::state::{Named, Policies, Profile};
use ninebit_vectors::cases::{self, Level};
use ninebit_vectors::pack::{self, Manifest, Options};
use ninebit_vectors::unit::Conditions;
use ninebit_vectors::view::View;
use ninebit_vectors::{Unit, exhaustive::Exhaustive, tree, units};
use serde_json::Value;

fn json(path: impl AsRef<Path>) -> Value {
    serde_json::from_str(&std::fs::read_to_string(at(path)).unwrap()).unwrap()
}

/// Returns the rows of a unit on a chip, with inputs and results.
fn rows(profile: Profile, unit: &'static dyn ninebit_vectors::Unit) -> Vec<Vec<i64>> {
    let conditions = Conditions { profile, policies: Policies::DEFAULT };
    let (columns, mut rows) = (unit.results().len(), Vec::new());
    cases::visit(unit, profile, Level::L0, 1, |inputs, _| {
        let mut results = vec![0; columns];
        unit.evaluate(inputs, &conditions, &mut results);
        rows.push([inputs, &results].concat());
    });
    rows
}

/// Returns the units of a committed pack: all of nv2a; of nv10 its own and those whose rows differ.
fn committed_units(profile: Profile) -> Vec<&'static dyn Unit> {
    let has = |unit: &dyn Unit, profile| unit.profiles().contains(&profile);
    let differs =
        |unit: &'static dyn Unit| !has(unit, Profile::Nv2a) || rows(Profile::Nv10, unit) != rows(Profile::Nv2a, unit);
    let units = units::all().into_iter().filter(|unit| has(*unit, profile));
    units.filter(|unit| profile == Profile::Nv2a || differs(*unit)).collect()
}

/// Returns the lines of a table that are committed: the head, every tenth row, and the regressions.
fn sample(table: &str) -> String {
    let (head, rows): (Vec<&str>, Vec<&str>) =
        table.split_inclusive('\n').partition(|line| line.starts_with('#') || line.starts_with("id\t"));
    let rows = rows.into_iter().enumerate().filter(|(n, row)| n % 10 == 0 || row.contains("\tregression"));
    head.into_iter().chain(rows.map(|(_, row)| row)).collect()
}

/// The packs of the model are those of the committed manifests, and have the committed rows. `BLESS=1` writes both: say why under *Numerics* in
/// CHANGELOG.md.
#[test]
fn committed_packs_are_what_the_model_says() {
    let folder = tempfile::tempdir().unwrap();
    for profile in Profile::ALL {
        let name = profile.name().to_lowercase();
        let (manifest_file, samples) = (at(format!("vectors/packs/{name}.json")), at(format!("vectors/packs/{name}")));
        let units = committed_units(*profile);
        let options = Options { profile: *profile, level: Level::L0, seed: 1, units, deciding: false, views: vec![] };
        let fresh = folder.path().join(&name);
        let again = pack::export(&fresh, &options).unwrap();
        let tables: Vec<(String, String)> = again
            .files
            .iter()
            .filter(|file| !file.unit.is_empty())
            .map(|file| (format!("{}.tsv", file.unit), sample(&fs::read_to_string(fresh.join(&file.path)).unwrap())))
            .collect();
        if bless() {
            fs::remove_dir_all(&samples).unwrap();
            fs::create_dir(&samples).unwrap();
            tables.iter().for_each(|(file, rows)| fs::write(samples.join(file), rows).unwrap());
            fs::copy(fresh.join("MANIFEST.json"), &manifest_file).unwrap();
        }
        let manifest: Manifest = serde_json::from_value(json(&manifest_file)).unwrap();
        for (file, committed_file) in again.files.iter().zip(&manifest.files) {
            assert_eq!(file, committed_file, "{name}: BLESS=1 writes it; `ninebit vectors diff` shows the rows");
        }
        assert_eq!(again, manifest);
        for (file, rows) in &tables {
            assert_eq!(*rows, fs::read_to_string(samples.join(file)).unwrap(), "{name}/{file}");
        }
        assert_eq!(fs::read_dir(samples).unwrap().count(), tables.len());
    }
}

/// The repository's files are at most 30 MB: a clone takes seconds, and generated bulk is noticed.
#[test]
fn the_repository_is_small() {
    const LARGEST: u64 = 30_000_000;
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(at("")).output();
    let Some(listed) = listed.ok().filter(|output| output.status.success()) else {
        println!("skipped: there is no git, or this is no checkout");
        return;
    };
    let paths = String::from_utf8(listed.stdout).unwrap();
    let mut sizes: Vec<(u64, &str)> = paths
        .split_terminator('\0')
        .filter_map(|path| Some((fs::symlink_metadata(at(path)).ok()?.len(), path)))
        .collect();
    sizes.sort_unstable_by(|a, b| b.cmp(a));
    let sum: u64 = sizes.iter().map(|(bytes, _)| bytes).sum();
    assert!(sum > 1_000_000, "{sum} bytes in {} files", sizes.len());
    assert!(sum <= LARGEST, "{sum} bytes, {LARGEST} are allowed; the largest: {:?}", &sizes[..10]);
}

/// Checks that a document has exactly the properties of its schema, on every level.
fn fits(schema: &Value, value: &Value, place: &str) {
    if let (Some(properties), Some(object)) = (schema["properties"].as_object(), value.as_object()) {
        let patterns: Vec<&String> =
            schema["patternProperties"].as_object().into_iter().flat_map(|p| p.keys()).collect();
        let columns = |name: &str| ["cfg.", "in.", "mid.", "out."].iter().any(|prefix| name.starts_with(prefix));
        for (name, value) in object {
            match properties.get(name) {
                Some(property) => fits(property, value, &format!("{place}.{name}")),
                None => assert!(!patterns.is_empty() && columns(name), "{place}.{name} is not in the schema"),
            }
        }
        for name in schema["required"].as_array().unwrap() {
            assert!(object.contains_key(name.as_str().unwrap()), "{place} lacks {name}");
        }
        assert_eq!(schema["additionalProperties"], Value::Bool(false), "{place}");
    }
    if let Some(items) = value.as_array().filter(|_| schema.get("items").is_some()) {
        items.iter().for_each(|item| fits(&schema["items"], item, &format!("{place}[]")));
    }
    if let Some(constant) = schema.get("const") {
        assert_eq!(value, constant, "{place}");
    }
    if let Some(known) = schema["enum"].as_array() {
        assert!(known.contains(value), "{place}: {value}");
    }
    if let Some(kind) = schema["type"].as_str() {
        let is = match kind {
            "object" => value.is_object(),
            "array" => value.is_array(),
            "string" => value.is_string(),
            "boolean" => value.is_boolean(),
            "integer" => value.is_i64() || value.is_u64(),
            other => panic!("{place}: {other}"),
        };
        assert!(is, "{place} is no {kind}: {value}");
    }
}

/// Tests the names of properties. `vectors/schema/check` validates the same documents with a complete validator.
#[test]
fn documents_have_the_properties_of_their_schemas() {
    let folder = tempfile::tempdir().unwrap();
    let chosen = ["product", "mux", "general-stage"].map(|name| units::by_name(name).unwrap()).to_vec();
    let views = vec![View::Hex, View::Jsonl];
    let options = Options { profile: Profile::Nv2a, level: Level::L0, seed: 1, units: chosen, deciding: true, views };
    let place = folder.path();
    pack::export(place, &options).unwrap();
    let schema = |name: &str| json(place.join(format!("schema/{name}.schema.json")));
    fits(&schema("manifest"), &json(place.join("MANIFEST.json")), "manifest");
    for unit in ["product", "mux", "general-stage"] {
        fits(&schema("layout"), &json(place.join(format!("units/{unit}.layout.json"))), unit);
        let rows = std::fs::read_to_string(place.join(format!("units/{unit}.jsonl"))).unwrap();
        rows.lines().for_each(|row| fits(&schema("row"), &serde_json::from_str(row).unwrap(), unit));
    }
    tree::work(place, &Exhaustive::new(units::by_name("mux").unwrap(), Profile::Nv2a).unwrap(), 0).unwrap();
    fits(&schema("leaf"), &json(place.join("leaf-0000.json")), "leaf");
    let list = |folder: &Path| std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    for path in list(&at("vectors/digests")) {
        let paths: Vec<_> = if path.is_dir() { list(&path).collect() } else { vec![path] };
        paths.iter().for_each(|path| fits(&schema("sweep"), &json(path), "sweep"));
    }
}

/// Each mutation still has exactly one place in the sources. `vectors/mutation/run` applies all of them.
#[test]
fn mutations_are_of_texts_that_occur_once() {
    let mutants = json("vectors/mutation/mutants.json");
    let mutants = mutants.as_array().unwrap();
    let table = std::fs::read_to_string(at("vectors/mutation/mutations.tsv")).unwrap();
    assert!(mutants.len() > 150);
    for mutant in mutants {
        let [rule, what, file, old, new] =
            ["rule", "what", "file", "old", "new"].map(|key| mutant[key].as_str().unwrap());
        let text = std::fs::read_to_string(at(file)).unwrap();
        assert_eq!(text.matches(old).count(), 1, "vectors/mutation/mutants.json has to follow {file}: {what}: {old}");
        assert!(old != new && ninebit_handbook::find(rule).is_some(), "{what}");
        let row = format!("\n{rule}\t{file}\t{what}\t");
        assert!(table.contains(&row), "run vectors/mutation/run: mutations.tsv has no {row}");
    }
}
