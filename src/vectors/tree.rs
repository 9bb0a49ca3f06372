//! Leaves as files, written by many workers, and the tree that they become.
//!
//! A worker writes one file a leaf, under a temporary name first: what lies in a folder is whole. A leaf file names its sweep and carries a seal, so
//! that one of another sweep, or one that was changed, is told apart. [`merge`] takes all leaves of one sweep, each once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::exhaustive::Leaf;
use super::{BEHAVIOUR, Exhaustive, Part, VectorError, read_text, units};
use ninebit::limits;
use ninebit::state::{Named, Profile};
use ninebit_files::output::write_file;
use ninebit_files::picture::hexadecimal;
use ninebit_files::read::Kind;

/// `format` of a leaf file.
const LEAF_FORMAT: &str = "ninebit-leaf-1";

/// `format` of a tree.
pub const FORMAT: &str = "ninebit-sweep-1";

/// What all leaves of one sweep have in common.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Of {
    /// Name of the unit.
    pub unit: String,
    /// Which of its rows, as [`Part`] writes it; nothing for all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub only: Vec<String>,
    /// Name of the chip.
    pub profile: String,
    /// What the program computes.
    pub behaviour_rev: u32,
    /// Rows, those included whose inputs do not go together.
    pub size: u64,
    /// How many leaves there are.
    pub leaves: u64,
}

impl Of {
    /// A sweep, by this program.
    pub fn new(sweep: &Exhaustive) -> Of {
        Of {
            unit: sweep.unit.name().to_owned(),
            only: sweep.part.texts().to_vec(),
            profile: sweep.profile.name().to_owned(),
            behaviour_rev: BEHAVIOUR,
            size: sweep.size,
            leaves: sweep.leaves,
        }
    }

    /// The unit, and which of its rows.
    pub fn name(&self) -> String {
        std::iter::once(&self.unit).chain(&self.only).map(String::as_str).collect::<Vec<&str>>().join(" ")
    }

    fn text(&self) -> String {
        let Of { profile, behaviour_rev, size, leaves, .. } = self;
        format!("{} on {profile}, behaviour {behaviour_rev}, {size} rows in {leaves} leaves", self.name())
    }
}

/// A leaf file.
#[derive(Debug, Serialize, Deserialize)]
struct LeafFile {
    format: String,
    #[serde(flatten)]
    of: Of,
    leaf: Leaf,
    /// The first sixteen digits of the SHA-256 of everything above as text.
    seal: String,
}

fn line(leaf: &Leaf) -> String {
    let Leaf { index, rows, low, high, sha256 } = leaf;
    format!("{index} {rows} {low} {high} {sha256}\n")
}

fn seal(of: &Of, leaf: &Leaf) -> String {
    let mut seal = hexadecimal(&Sha256::digest(format!("{LEAF_FORMAT}\n{}\n{}", of.text(), line(leaf))));
    seal.truncate(16);
    seal
}

/// The file of a leaf.
fn place(folder: &Path, index: u64) -> PathBuf {
    folder.join(format!("leaf-{index:04}.json"))
}

/// Reads a leaf file; `None` if it is none, or was changed.
fn read_leaf(path: &Path) -> Result<Option<(Of, Leaf)>, VectorError> {
    let text = read_text(path, Kind::Regular, limits::LEAF, "the folder has changed meanwhile: try again")?;
    let file: Option<LeafFile> = serde_json::from_str(&text).ok();
    let whole = file.filter(|file| file.format == LEAF_FORMAT && file.seal == seal(&file.of, &file.leaf));
    Ok(whole.map(|file| (file.of, file.leaf)))
}

/// Computes one leaf into a folder that exists, unless it is there. Returns whether it was computed.
///
/// # Errors
/// The folder has that leaf of another sweep, or cannot be written.
pub fn work(folder: &Path, sweep: &Exhaustive, index: u64) -> Result<bool, VectorError> {
    let (path, of) = (place(folder, index), Of::new(sweep));
    if path.exists()
        && let Ok(Some((found, leaf))) = read_leaf(&path)
    {
        if found != of {
            let message = format!("a leaf of {}, not of {}", found.text(), of.text());
            return Err(VectorError::file("NB1021", &path, message, "name an empty folder, or that of this sweep"));
        }
        if leaf.index == index {
            return Ok(false);
        }
    }
    let leaf = sweep.leaf(index);
    let file = LeafFile { format: LEAF_FORMAT.to_owned(), seal: seal(&of, &leaf), of, leaf };
    let text = serde_json::to_string_pretty(&file).unwrap_or_default() + "\n";
    write_file(&path, text.as_bytes())?;
    Ok(true)
}

/// The digests of all rows of a unit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tree {
    /// The version of the format: [`FORMAT`].
    pub format: String,
    /// What was evaluated, so that other trees are told apart.
    #[serde(flatten)]
    pub of: Of,
    /// Rows whose inputs go together.
    pub rows: u64,
    /// SHA-256 of the leaves, one a line: place, rows, low, high, digest, a space between them.
    pub root: String,
    /// The leaves in order.
    pub leaf: Vec<Leaf>,
}

fn root(leaves: &[Leaf]) -> String {
    hexadecimal(&Sha256::digest(leaves.iter().map(line).collect::<String>()))
}

/// Joins the leaves that lie in folders. The result does not depend on how many folders there are, nor on their order.
///
/// # Errors
/// A leaf is missing ([`VectorError::Missing`]), there twice, changed, or of another sweep than the first.
pub fn merge(folders: &[PathBuf]) -> Result<Tree, VectorError> {
    let mut found: BTreeMap<u64, (Leaf, PathBuf)> = BTreeMap::new();
    let mut first: Option<(Of, PathBuf)> = None;
    for path in folders.iter().map(|folder| leaf_files(folder)).collect::<Result<Vec<_>, _>>()?.concat() {
        let Some((of, leaf)) = read_leaf(&path)? else {
            let help = "remove it and sweep again: only that leaf is computed";
            return Err(VectorError::file("NB1020", &path, "not a leaf of a sweep, or changed since", help));
        };
        match &first {
            Some((before, _)) if *before != of => {
                let message = format!("a leaf of {}; the others are of {}", of.text(), before.text());
                let help = "merge the leaves of one sweep by one version";
                return Err(VectorError::file("NB1021", &path, message, help));
            }
            Some(_) => {}
            None => first = Some((of, path.clone())),
        }
        if leaf.index >= first.as_ref().map_or(0, |(of, _)| of.leaves) {
            return Err(VectorError::file("NB1020", &path, format!("there is no leaf {}", leaf.index), "remove it"));
        }
        if let Some((_, other)) = found.get(&leaf.index) {
            let message = format!("leaf {} is in `{}` already", leaf.index, ninebit::shown::path(other));
            let help = "name each folder once, and give each shard to one worker";
            return Err(VectorError::file("NB1022", &path, message, help));
        }
        found.insert(leaf.index, (leaf, path));
    }
    let Some((of, path)) = first else {
        let folder = folders.first().map(PathBuf::as_path).unwrap_or(Path::new("."));
        let help = "no leaves lie there: `ninebit vectors sweep` writes them";
        return Err(VectorError::missing(place(folder, 0), help));
    };
    if let Some(gap) = (0..of.leaves).find(|index| !found.contains_key(index)) {
        let folder = path.parent().unwrap_or(Path::new("."));
        let help = "not all leaves are there: run the missing shards again, what is there is kept";
        return Err(VectorError::missing(place(folder, gap), help));
    }
    let leaf: Vec<Leaf> = found.into_values().map(|(leaf, _)| leaf).collect();
    let rows = leaf.iter().map(|leaf| leaf.rows).sum();
    Ok(Tree { format: FORMAT.to_owned(), of, rows, root: root(&leaf), leaf })
}

/// The leaf files of a folder, by name.
fn leaf_files(folder: &Path) -> Result<Vec<PathBuf>, VectorError> {
    let entries = std::fs::read_dir(folder).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => VectorError::missing(folder, "name folders that `ninebit vectors sweep` wrote"),
        _ => VectorError::unreadable(folder, error),
    })?;
    let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| name(path).starts_with("leaf-") && name(path).ends_with(".json"));
    paths.sort();
    Ok(paths)
}

impl Tree {
    /// The tree as a file: a leaf a line.
    pub fn text(&self) -> String {
        let Of { unit, only, profile, behaviour_rev, size, leaves } = &self.of;
        let only = match only.is_empty() {
            true => String::new(),
            false => format!("  \"only\": {},\n", serde_json::to_string(only).unwrap_or_default()),
        };
        let lines: Vec<String> =
            self.leaf.iter().map(|leaf| format!("    {}", serde_json::to_string(leaf).unwrap_or_default())).collect();
        format!(
            "{{\n  \"format\": \"{FORMAT}\",\n  \"unit\": \"{unit}\",\n{only}  \"profile\": \"{profile}\",\n  \"behaviour_rev\": {behaviour_rev},\n  \"size\": {size},\n  \"leaves\": {leaves},\n  \"rows\": {},\n  \"root\": \"{}\",\n  \"leaf\": [\n{}\n  ]\n}}\n",
            self.rows,
            self.root,
            lines.join(",\n")
        )
    }

    /// Reads a tree, and the sweep that it is of.
    ///
    /// # Errors
    /// There is no such file, it is no tree or was changed, or it is of a unit, chip or number of rows that this program does not have.
    pub fn read(path: &Path) -> Result<(Tree, Exhaustive), VectorError> {
        let text = read_text(path, Kind::Stream, limits::TREE, "name a tree: `ninebit vectors merge` writes one")?;
        let wrong = |message: &str| VectorError::file("NB1023", path, message, "merge the leaves again");
        let no_tree = |error| wrong(&format!("not a tree of digests: {error}"));
        let value: serde_json::Value = serde_json::from_str(&text).map_err(no_tree)?;
        let format = value.get("format").and_then(|format| format.as_str()).unwrap_or_default();
        let help = "use the program that wrote it, or sweep again";
        if format != FORMAT {
            let message = format!("the format is `{format:.60}`, not `{FORMAT}`");
            return Err(VectorError::file("NB1003", path, message, help));
        }
        let tree: Tree = serde_json::from_value(value).map_err(no_tree)?;
        let in_order = tree.leaf.iter().zip(0..).all(|(leaf, index)| leaf.index == index);
        if !in_order || tree.leaf.len() as u64 != tree.of.leaves {
            return Err(wrong("its leaves are not those of a whole sweep, in order"));
        }
        let rows = tree.leaf.iter().try_fold(0_u64, |sum, leaf| sum.checked_add(leaf.rows));
        if tree.root != root(&tree.leaf) || rows != Some(tree.rows) {
            return Err(wrong("its root is not that of its leaves: it was changed by hand"));
        }
        let sweep = units::by_name(&tree.of.unit).zip(Profile::from_name(&tree.of.profile));
        let sweep = sweep.filter(|(unit, profile)| unit.profiles().contains(profile));
        let sweep = sweep.and_then(|(unit, profile)| {
            let part = Part::new(unit, &tree.of.only).ok().filter(|part| part.texts() == tree.of.only)?;
            Exhaustive::from_part(unit, profile, part)
        });
        match sweep {
            Some(sweep) if (sweep.size, sweep.leaves) == (tree.of.size, tree.of.leaves) => Ok((tree, sweep)),
            _ => {
                let message = format!("this program has no sweep of {}", tree.of.text());
                Err(VectorError::file("NB1005", path, message, help))
            }
        }
    }
}
