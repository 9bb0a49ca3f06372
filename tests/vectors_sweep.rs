//! Tests sweeps: the root does not depend on who computes the leaves; leaves that are missing, changed, duplicated or of another sweep are
//! refused; and the committed trees agree with the model.
#![allow(clippy::unwrap_used, missing_docs, reason = "a test fails by panicking")]

use crate::repository::at;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use ninebit::random::Random;
use ninebit::state::{Policies, Profile};
use ninebit_vectors::exhaustive::Exhaustive;
use ninebit_vectors::part::Part;
use ninebit_vectors::tree::{self, Tree};
use ninebit_vectors::unit::{Conditions, Unit};
use ninebit_vectors::{cases, units};
use rayon::prelude::*;

fn sweep(unit: &str) -> Exhaustive {
    Exhaustive::new(units::by_name(unit).unwrap(), Profile::Nv2a).unwrap()
}

fn part(unit: &str, only: &[&str]) -> Exhaustive {
    let unit = units::by_name(unit).unwrap();
    Exhaustive::from_part(unit, Profile::Nv2a, Part::new(unit, only).unwrap()).unwrap()
}

fn ninebit(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ninebit")).current_dir(at("")).arg("vectors").args(arguments).output().unwrap()
}

/// All leaves of one unit, computed once for all tests.
static LEAVES: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
    let (folder, sweep) = (tempfile::tempdir().unwrap(), sweep("linear-step"));
    (0..sweep.leaves()).into_par_iter().for_each(|leaf| assert!(tree::work(folder.path(), &sweep, leaf).unwrap()));
    folder
});

/// Copies the leaves of a folder to the folders of `count` shards, and returns these in random order.
fn dealt(leaves: &Path, folder: &Path, count: u64, random: &mut Random) -> Vec<PathBuf> {
    let mut shards: Vec<PathBuf> = (0..count).map(|n| folder.join(format!("{count}-{n}"))).collect();
    shards.iter().for_each(|shard| std::fs::create_dir(shard).unwrap());
    for (n, entry) in std::fs::read_dir(leaves).unwrap().enumerate() {
        let path = entry.unwrap().path();
        let shard = &shards[n % count as usize];
        std::fs::copy(&path, shard.join(path.file_name().unwrap())).unwrap();
    }
    for n in (1..shards.len()).rev() {
        shards.swap(n, random.below(n as u128 + 1) as usize);
    }
    shards
}

#[test]
fn the_root_depends_on_neither_shards_nor_order_nor_deaths() {
    let folder = tempfile::tempdir().unwrap();
    let shared = folder.path().join("shared");
    let root = tree::merge(&[LEAVES.path().to_path_buf()]).unwrap();
    assert_eq!((root.rows, root.leaf.len() as u64), (1 << 24, sweep("linear-step").leaves()));
    let mut random = Random::new(5, "shards");
    for count in [1, 2, 7, 64] {
        let shards = dealt(LEAVES.path(), folder.path(), count, &mut random);
        assert_eq!(tree::merge(&shards).unwrap(), root, "{count} shards");
    }

    // A worker that is killed leaves only whole leaves. The next worker computes those that are missing.
    let worker = || {
        let shard = ["vectors", "sweep", "--unit", "linear-step", "--shard", "2/2", "-o", shared.to_str().unwrap()];
        Command::new(env!("CARGO_BIN_EXE_ninebit")).args(shard).stdout(std::process::Stdio::null()).spawn().unwrap()
    };
    let mut killed = worker();
    while !shared.exists() {
        std::thread::yield_now();
    }
    killed.kill().unwrap();
    killed.wait().unwrap();
    for shard in ["1/2", "2/2", "1/2"] {
        let output = ninebit(&["sweep", "--unit", "linear-step", "--shard", shard, "-o", shared.to_str().unwrap()]);
        assert!(output.status.success(), "{output:?}");
    }
    assert_eq!(tree::merge(&[shared]).unwrap(), root);
}

/// Copies the leaves to a folder, applies `change`, and returns status and message of `merge`.
fn merged(change: impl Fn(&Path)) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    let leaves = folder.path().join("a");
    std::fs::create_dir(&leaves).unwrap();
    for entry in std::fs::read_dir(LEAVES.path()).unwrap() {
        let path = entry.unwrap().path();
        std::fs::copy(&path, leaves.join(path.file_name().unwrap())).unwrap();
    }
    change(folder.path());
    let output = ninebit(&["merge", leaves.to_str().unwrap(), folder.path().to_str().unwrap()]);
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn merging_refuses_what_is_not_one_whole_sweep() {
    let edit = |folder: &Path, from: &str, to: &str| {
        let path = folder.join("a/leaf-0001.json");
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{text}");
        std::fs::write(path, text.replacen(from, to, 1)).unwrap();
    };
    let expected = |change: &dyn Fn(&Path), exit: i32, code: &str| {
        let (status, text) = merged(change);
        assert_eq!(status, Some(exit), "{text}");
        assert!(text.contains(code), "{text}");
    };
    expected(&|folder| std::fs::remove_file(folder.join("a/leaf-0000.json")).unwrap(), 4, "NB1001");
    expected(&|folder| std::fs::remove_dir_all(folder.join("a")).unwrap(), 4, "NB1001");
    expected(
        &|folder| drop(std::fs::copy(folder.join("a/leaf-0001.json"), folder.join("leaf-0001.json"))),
        3,
        "NB1022",
    );
    expected(&|folder| edit(folder, "\"behaviour_rev\": 1", "\"behaviour_rev\": 2"), 3, "NB1020");
    expected(&|folder| edit(folder, "\"rows\": 8", "\"rows\": 9"), 3, "NB1020");
    expected(&|folder| edit(folder, "\"seal\": \"", "\"seal\": \"0"), 3, "NB1020");
    expected(&|folder| edit(folder, "}", ""), 3, "NB1020");
    let other = |folder: &Path| {
        tree::work(folder, &sweep("mux"), 0).unwrap();
    };
    expected(&other, 3, "NB1021");
    // The leaves of a part differ from those of the whole and of another part.
    let some = part("linear-step", &["in.first=0..127"]);
    expected(&|folder| assert!(tree::work(folder, &some, 0).unwrap()), 3, "NB1021");
    let folder = tempfile::tempdir().unwrap();
    assert!(tree::work(folder.path(), &some, 0).unwrap());
    let error = tree::work(folder.path(), &part("linear-step", &["in.first=128..255"]), 0).unwrap_err();
    assert_eq!(error.code(), "NB1021");
    assert!(error.to_string().contains("linear-step in.first=0..127 on Nv2a"), "{error}");
    // A worker does not add to the leaves of another sweep either.
    let folder = tempfile::tempdir().unwrap();
    other(folder.path());
    let error = tree::work(folder.path(), &sweep("product"), 0).unwrap_err();
    assert_eq!(error.code(), "NB1021");
}

#[test]
fn a_damaged_leaf_is_computed_again() {
    let folder = tempfile::tempdir().unwrap();
    let (sweep, path) = (sweep("mux"), folder.path().join("leaf-0000.json"));
    assert!(tree::work(folder.path(), &sweep, 0).unwrap());
    let text = std::fs::read(&path).unwrap();
    assert!(!tree::work(folder.path(), &sweep, 0).unwrap(), "what is there is kept");
    for damaged in [&text[..text.len() / 2], b"", b"\xff\xfe", b"{}"] {
        std::fs::write(&path, damaged).unwrap();
        assert!(tree::work(folder.path(), &sweep, 0).unwrap());
        assert_eq!(std::fs::read(&path).unwrap(), text);
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing else is left");
}

#[test]
fn places_that_cannot_be_written_are_refused() {
    for place in ["/dev/null/leaves", "/proc/leaves"] {
        let output = ninebit(&["sweep", "--unit", "mux", "-o", place]);
        assert_eq!(output.status.code(), Some(7), "{output:?}");
    }
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().to_str().unwrap();
    assert_eq!(ninebit(&["sweep", "--unit", "mux", "-o", folder]).status.code(), Some(0));
    assert_eq!(ninebit(&["merge", folder, "-o", "/dev/null/tree"]).status.code(), Some(7));
    assert_eq!(ninebit(&["sweep", "--unit", "general-stage", "-o", folder]).status.code(), Some(2));
    assert_eq!(ninebit(&["sweep", "--unit", "mux", "--shard", "0/2", "-o", folder]).status.code(), Some(2));
    assert_eq!(ninebit(&["sweep", "--unit", "shader-remap", "--profile", "nv10", "-o", folder]).status.code(), Some(2));
}

#[test]
fn a_part_has_the_rows_of_the_whole_that_it_allows() {
    // Rows with the same value in the first column are adjacent in the whole.
    let whole = sweep("alpha-test");
    let functions = ["Never", "Less", "Equal", "LessOrEqual", "Greater", "NotEqual", "GreaterOrEqual", "Always"];
    for (place, function) in (0..).zip(functions) {
        let some = part("alpha-test", &[&format!("cfg.function={function}")]);
        assert_eq!(some.size(), 1 << 16);
        assert_eq!(some.digest(0..1 << 16), whole.digest(place << 16..(place + 1) << 16), "{function}");
    }
    // Parts that are computed in block lanes have the same rows as well.
    let some = part("sum", &["in.a=-256", "in.b=3..4", "in.c=255..256", "in.d=-100..200"]);
    let rows = |b: u64, c: u64| (b * 513 + c) * 513 + 156..(b * 513 + c) * 513 + 457;
    assert_eq!(some.size(), 4 * 301);
    for (place, (b, c)) in (0..).zip([(259, 511), (259, 512), (260, 511), (260, 512)]) {
        assert_eq!(some.digest(place * 301..(place + 1) * 301), sweep("sum").digest(rows(b, c)), "{b} {c}");
    }
}

#[test]
fn a_part_is_swept_merged_and_digested_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let [leaves, tree] = ["leaves", "tree.json"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    let run = |arguments: &[&str]| {
        let output = ninebit(arguments);
        (output.status.code(), String::from_utf8([output.stdout, output.stderr].concat()).unwrap())
    };
    let only = ["--only", "in.word=00000000..0000ffff", "--only", "cfg.format=R5G6B5"];
    let sweep = [&["sweep", "--unit", "texel-expansion", "-o", &leaves][..], &only].concat();
    let name = "texel-expansion cfg.format=R5G6B5 in.word=00000000..0000ffff Nv2a";
    let (exit, text) = run(&sweep);
    assert_eq!((exit, text), (Some(0), format!("{name}, shard 1/1: 1 of 1 leaves, 1 computed, 0 were there\n")));
    let (exit, text) = run(&["merge", &leaves, "-o", &tree]);
    assert_eq!((exit, text.lines().next()), (Some(0), Some(format!("{name}: 65536 rows in 1 leaves").as_str())));
    let (exit, text) = run(&["digest", &tree]);
    assert_eq!((exit, text), (Some(0), format!("{name}: 1 of 1 leaves computed, all as the tree has them\n")));
    assert_eq!(
        std::fs::read(&tree).unwrap(),
        std::fs::read(at("vectors/digests/texel-expansion/R5G6B5.json")).unwrap()
    );

    for only in [&["cfg.select=Msb"], &["cfg.format=r5g6b5"], &["in.word=ffff"], &["cfg.format"], &["out.r=1"]] {
        let arguments = only.iter().flat_map(|only| ["--only", *only]);
        let arguments: Vec<&str> = sweep[..5].iter().copied().chain(arguments).collect();
        let (exit, text) = run(&arguments);
        assert_eq!(exit, Some(2), "{text}");
        assert!(text.contains("--only: "), "{text}");
    }
    let (exit, text) = run(&["sweep", "--unit", "blend", "--only", "cfg.equation=Add", "-o", &leaves]);
    assert_eq!(exit, Some(2), "{text}");
    assert!(text.contains("`blend cfg.equation=Add` has more than"), "{text}");
}

/// Returns the paths of the trees under `vectors/digests`: those of units, and those of parts in a folder with the name of their unit.
fn trees() -> Vec<PathBuf> {
    let list = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
    };
    let top = list(&at("vectors/digests")).into_iter();
    let mut paths: Vec<PathBuf> = top.flat_map(|path| if path.is_dir() { list(&path) } else { vec![path] }).collect();
    paths.sort();
    paths
}

/// Units for which a leaf of eight million rows is fast enough for a test. `ninebit vectors digest` recomputes those of the other units.
const QUICK: [&str; 6] =
    ["blend", "dependent-coordinate", "shader-remap", "surface-load", "surface-store", "texel-expansion"];

/// Recomputes small trees of parts as a whole, and one leaf of one larger tree for each of the quick units.
#[test]
fn committed_trees_of_parts_are_what_the_model_says() {
    let mut large: BTreeMap<String, Vec<(Tree, Exhaustive)>> = BTreeMap::new();
    for path in trees() {
        let (tree, sweep) = Tree::read(&path).unwrap();
        if tree.header.only.is_empty() {
            continue;
        }
        assert_eq!(tree.text(), std::fs::read_to_string(&path).unwrap());
        assert_eq!(path.parent().unwrap().file_name().unwrap().to_str().unwrap(), tree.header.unit);
        if sweep.size() <= 1 << 16 {
            assert_eq!(sweep.leaf(0), tree.leaf[0], "vectors/distributed/renew {}", path.display());
        } else if QUICK.contains(&tree.header.unit.as_str()) {
            large.entry(tree.header.unit.clone()).or_default().push((tree, sweep));
        }
    }
    large.into_par_iter().for_each(|(unit, trees)| {
        let mut random = Random::new(13, &unit);
        let (tree, sweep) = &trees[random.below(trees.len() as u128) as usize];
        let leaf = random.below(u128::from(sweep.leaves())) as u64;
        assert_eq!(sweep.leaf(leaf), tree.leaf[leaf as usize], "{} leaf {leaf}", tree.header.name());
    });
}

/// Units with up to 2^32 rows once their configuration is fixed, and the column of the configuration. Each has a tree for each value of it.
const BY_CONFIGURATION: [(&str, &str); 4] = [
    ("shader-remap", "cfg.mapping"),
    ("surface-load", "cfg.format"),
    ("surface-store", "cfg.format"),
    ("texel-expansion", "cfg.format"),
];

/// Columns that a part fixes are not read: every row of the whole has the results of the row that the part has in its place.
#[test]
fn parts_by_configuration_are_whole() {
    let outputs = |unit: &dyn Unit, inputs: &[i64]| {
        let columns = unit.results();
        let mut results = vec![0; columns.len()];
        let conditions = Conditions { profile: Profile::Nv2a, policies: Policies::DEFAULT };
        unit.evaluate(inputs, &conditions, &mut results);
        let outputs = columns.iter().zip(results).filter(|(column, _)| column.name.starts_with("out."));
        outputs.map(|(_, value)| value).collect::<Vec<i64>>()
    };
    for (name, configuration) in BY_CONFIGURATION {
        let unit = units::by_name(name).unwrap();
        let values = unit.inputs()[0].clone();
        assert_eq!(values.name, configuration);
        for place in 0..values.size() {
            let (value, text) = (values.nth(place), values.kind.write(values.nth(place)));
            let tree = format!("vectors/digests/{name}/{text}.json");
            let (tree, sweep) = Tree::read(&at(&tree)).unwrap_or_else(|error| {
                panic!("{tree}: {error}: docs/vectors.md shows below Every row how to make a tree")
            });
            assert_eq!(tree.header.only[0], format!("{configuration}={text}"));
            let mut random = Random::new(17, &tree.header.name());
            for _ in 0..500 {
                let mut row: Vec<i64> = unit.inputs().iter().map(|c| c.nth(random.below(c.size()))).collect();
                row[0] = value;
                unit.fit(&mut row);
                let columns = sweep.part().columns();
                let kept: Vec<i64> =
                    row.iter().zip(columns).map(|(value, c)| c.nth(*value as u128 % c.size())).collect();
                assert_eq!(outputs(unit, &row), outputs(unit, &kept), "{} {row:?}", tree.header.name());
            }
        }
    }
    // No unit is missing from the list.
    for unit in units::all().into_iter().filter(|unit| cases::size(&unit.inputs()) > 1 << 32) {
        let inputs = unit.inputs().into_iter().filter(|column| column.name.starts_with("in.")).collect::<Vec<_>>();
        let has = BY_CONFIGURATION.iter().any(|(name, _)| *name == unit.name()) || unit.name() == "depth";
        assert_eq!(cases::size(&inputs) <= 1 << 32, has, "{}", unit.name());
    }
}

/// Recomputes small trees as a whole, and a random leaf of each other tree. None of these units differs between the chips.
#[test]
fn committed_trees_are_what_the_model_says() {
    let mut names = Vec::new();
    for path in trees() {
        let (tree, sweep) = Tree::read(&path).unwrap();
        if !tree.header.only.is_empty() {
            continue;
        }
        assert_eq!(tree.text(), std::fs::read_to_string(&path).unwrap());
        assert_eq!(path.file_stem().unwrap().to_str().unwrap(), tree.header.unit);
        names.push(tree.header.unit.clone());
        let drawn = Random::new(11, &tree.header.unit).below(u128::from(sweep.leaves())) as u64;
        let chosen: Vec<u64> = if sweep.size() <= 1 << 23 { (0..sweep.leaves()).collect() } else { vec![drawn] };
        let nv10 = Exhaustive::new(sweep.unit(), Profile::Nv10).unwrap();
        chosen.into_par_iter().for_each(|leaf| {
            assert_eq!(
                sweep.leaf(leaf),
                tree.leaf[leaf as usize],
                "leaf {leaf}: vectors/distributed/renew {}",
                path.display()
            );
            if sweep.size() <= 1 << 23 {
                assert_eq!(nv10.leaf(leaf), tree.leaf[leaf as usize], "{} leaf {leaf} of nv10", tree.header.unit);
            }
        });
    }
    // Every unit with at most 2^32 rows has a tree, and so have depth and the product sum.
    let mut expected: Vec<&str> = vec!["depth", "sum"];
    let all = units::all().into_iter().filter_map(|unit| Exhaustive::new(unit, Profile::Nv2a));
    expected.extend(all.filter(|sweep| sweep.size() <= 1 << 32).map(|sweep| sweep.unit().name()));
    expected.sort_unstable();
    assert_eq!(names, expected);
}

#[test]
fn trees_that_were_changed_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tree.json");
    let text = std::fs::read_to_string(at("vectors/digests/mux.json")).unwrap();
    let code = |text: &str| {
        std::fs::write(&path, text).unwrap();
        Tree::read(&path).unwrap_err().code()
    };
    for (from, to, expected) in [
        ("ninebit-sweep-1", "ninebit-sweep-2", "NB1003"),
        ("\"rows\"", "\"row\"", "NB1023"),
        ("\"low\":", "\"low\":1", "NB1023"),
        ("\"leaves\": 1", "\"leaves\": 2", "NB1023"),
        ("\"size\": 1024", "\"size\": 1023", "NB1005"),
        ("\"unit\": \"mux\"", "\"unit\": \"mix\"", "NB1005"),
        ("{", "", "NB1023"),
    ] {
        assert!(text.contains(from), "{from}");
        assert_eq!(code(&text.replacen(from, to, 1)), expected, "{from}");
    }
    let text = std::fs::read_to_string(at("vectors/digests/texel-expansion/L8.json")).unwrap();
    for (from, to) in [
        ("cfg.format=L8", "cfg.format=L9"),
        ("cfg.format=L8", "cfg.format=L8..L8"),
        ("cfg.format=L8", "cfg.format=L8..I8"),
        ("000000ff", "000000fe"),
        ("cfg.format", "format"),
    ] {
        assert!(text.contains(from), "{from}");
        assert_eq!(code(&text.replacen(from, to, 1)), "NB1005", "{from} {to}");
    }
    let text = std::fs::read_to_string(at("vectors/digests/mux.json")).unwrap();
    // `digest` finds a wrong digest even if the root matches it.
    let mut tree: Tree = serde_json::from_str(&text).unwrap();
    tree.leaf[0].sha256 = tree.leaf[0].sha256.replace(|c: char| c.is_ascii_digit(), "a");
    let line = format!("0 {} {} {} {}\n", tree.rows, tree.leaf[0].low, tree.leaf[0].high, tree.leaf[0].sha256);
    tree.root = {
        use sha2::{Digest, Sha256};
        Sha256::digest(line).iter().map(|byte| format!("{byte:02x}")).collect()
    };
    std::fs::write(&path, tree.text()).unwrap();
    assert_eq!(ninebit(&["digest", path.to_str().unwrap()]).status.code(), Some(1));
    assert_eq!(ninebit(&["digest", "vectors/digests/mux.json", "--sample", "1"]).status.code(), Some(0));
    assert_eq!(ninebit(&["digest", "vectors/digests/none.json"]).status.code(), Some(4));
}
