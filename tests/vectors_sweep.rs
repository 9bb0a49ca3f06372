//! Sweeps: the same root whoever computes the leaves; what is missing, changed, there twice or of another sweep is refused; the committed trees are
//! what the model says.
#![allow(clippy::unwrap_used, missing_docs, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

use ninebit::state::Profile;
use ninebit::vectors::random::Random;
use ninebit::vectors::sweep::Sweep;
use ninebit::vectors::tree::{self, Tree};
use ninebit::vectors::units;
use rayon::prelude::*;

fn sweep(unit: &str) -> Sweep {
    Sweep::new(units::by_name(unit).unwrap(), Profile::Nv2a).unwrap()
}

fn ninebit(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ninebit")).arg("vectors").args(arguments).output().unwrap()
}

/// All leaves of one unit, computed once for all tests.
static LEAVES: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
    let (folder, sweep) = (tempfile::tempdir().unwrap(), sweep("linear-step"));
    (0..sweep.leaves).into_par_iter().for_each(|leaf| assert!(tree::work(folder.path(), &sweep, leaf).unwrap()));
    folder
});

/// Copies leaf files of one folder to `count` shards' folders and returns these in a drawn order.
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
    assert_eq!((root.rows, root.leaf.len() as u64), (1 << 24, sweep("linear-step").leaves));
    let mut random = Random::new(5, "shards");
    for count in [1, 2, 7, 64] {
        let shards = dealt(LEAVES.path(), folder.path(), count, &mut random);
        assert_eq!(tree::merge(&shards).unwrap(), root, "{count} shards");
    }

    // A worker that is killed at any time leaves whole leaves or none; the one after it computes what is missing.
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

/// A folder of leaves, by `change`, and what `merge` says of it.
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
    // Nor does a worker add to the leaves of another sweep.
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
    assert_eq!(ninebit(&["sweep", "--unit", "fog-factor", "--profile", "nv10", "-o", folder]).status.code(), Some(2));
}

/// The trees under `vectors/digests`.
fn trees() -> Vec<PathBuf> {
    let entries = std::fs::read_dir("vectors/digests").unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

/// Small trees whole; of the others leaves drawn by a seed. None of these units differs between the chips.
#[test]
fn committed_trees_are_what_the_model_says() {
    let mut names = Vec::new();
    for path in trees() {
        let (tree, sweep) = Tree::read(&path).unwrap();
        assert_eq!(tree.text(), std::fs::read_to_string(&path).unwrap());
        assert_eq!(path.file_stem().unwrap().to_str().unwrap(), tree.of.unit);
        names.push(tree.of.unit.clone());
        let drawn = Random::new(11, &tree.of.unit).below(u128::from(sweep.leaves)) as u64;
        let chosen: Vec<u64> = if sweep.size <= 1 << 23 { (0..sweep.leaves).collect() } else { vec![drawn] };
        let nv10 = Sweep::new(sweep.unit, Profile::Nv10).unwrap();
        chosen.into_par_iter().for_each(|leaf| {
            assert_eq!(sweep.leaf(leaf), tree.leaf[leaf as usize], "{} leaf {leaf}", tree.of.unit);
            if sweep.size <= 1 << 23 {
                assert_eq!(nv10.leaf(leaf), tree.leaf[leaf as usize], "{} leaf {leaf} of nv10", tree.of.unit);
            }
        });
    }
    // Every unit of at most 2^32 rows has one, and the product sum.
    let mut expected: Vec<&str> = vec!["depth", "sum"];
    let all = units::all().into_iter().filter_map(|unit| Sweep::new(unit, Profile::Nv2a));
    expected.extend(all.filter(|sweep| sweep.size <= 1 << 32).map(|sweep| sweep.unit.name()));
    expected.sort_unstable();
    assert_eq!(names, expected);
}

#[test]
fn trees_that_were_changed_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tree.json");
    let text = std::fs::read_to_string("vectors/digests/mux.json").unwrap();
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
    // A wrong digest with a fitting root is what `digest` finds.
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
