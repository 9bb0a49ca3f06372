//! Leaf files, which several workers write, and the tree that they are merged into.
//!
//! A worker writes one file per leaf, first under a temporary name: a file in the folder is always complete. A leaf file names its sweep and carries
//! a seal, which tells leaves of other sweeps and changed leaves apart. [`merge`] takes all leaves of one sweep, each once.

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

/// Value of `format` in a leaf file.
const LEAF_FORMAT: &str = "ninebit-leaf-1";

/// Value of `format` in a tree.
const FORMAT: &str = "ninebit-sweep-1";

/// Description of a sweep, which all its leaves share.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SweepHeader {
    /// Name of the unit.
    pub unit: String,
    /// The restrictions on its rows, as [`Part`] writes them; empty for all rows.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub only: Vec<String>,
    /// Name of the chip.
    pub profile: String,
    /// The model's [`BEHAVIOUR`].
    pub behaviour_rev: u32,
    /// Number of rows, including those that the unit does not accept.
    pub size: u64,
    /// Number of leaves.
    pub leaves: u64,
}

impl SweepHeader {
    /// Returns the description of a sweep by this program.
    pub fn new(sweep: &Exhaustive) -> SweepHeader {
        SweepHeader {
            unit: sweep.unit().name().to_owned(),
            only: sweep.part().texts().to_vec(),
            profile: sweep.profile.name().to_owned(),
            behaviour_rev: BEHAVIOUR,
            size: sweep.size(),
            leaves: sweep.leaves(),
        }
    }

    /// Returns the name of the unit and the restrictions on its rows, separated by spaces.
    pub fn name(&self) -> String {
        std::iter::once(&self.unit).chain(&self.only).map(String::as_str).collect::<Vec<&str>>().join(" ")
    }

    fn text(&self) -> String {
        let SweepHeader { profile, behaviour_rev, size, leaves, .. } = self;
        format!("{} on {profile}, behaviour {behaviour_rev}, {size} rows in {leaves} leaves", self.name())
    }
}

/// Content of a leaf file.
#[derive(Debug, Serialize, Deserialize)]
struct LeafFile {
    format: String,
    #[serde(flatten)]
    header: SweepHeader,
    leaf: Leaf,
    /// First sixteen digits of the SHA-256 of everything above as text.
    seal: String,
}

fn line(leaf: &Leaf) -> String {
    let Leaf { index, rows, low, high, sha256 } = leaf;
    format!("{index} {rows} {low} {high} {sha256}\n")
}

fn seal(header: &SweepHeader, leaf: &Leaf) -> String {
    let mut seal = hexadecimal(&Sha256::digest(format!("{LEAF_FORMAT}\n{}\n{}", header.text(), line(leaf))));
    seal.truncate(16);
    seal
}

/// Returns the path of a leaf's file.
fn leaf_path(folder: &Path, index: u64) -> PathBuf {
    folder.join(format!("leaf-{index:04}.json"))
}

/// Reads a leaf file. Returns `None` if it is not a leaf file or was changed.
fn read_leaf(path: &Path) -> Result<Option<(SweepHeader, Leaf)>, VectorError> {
    let text = read_text(path, Kind::Regular, limits::LEAF, "the folder has changed meanwhile: try again")?;
    let file: Option<LeafFile> = serde_json::from_str(&text).ok();
    let whole = file.filter(|file| file.format == LEAF_FORMAT && file.seal == seal(&file.header, &file.leaf));
    Ok(whole.map(|file| (file.header, file.leaf)))
}

/// Computes one leaf and writes its file to an existing folder, unless the file exists. Returns whether it was computed.
///
/// # Errors
/// Returns an error if the folder has that leaf of another sweep, or cannot be written.
pub fn work(folder: &Path, sweep: &Exhaustive, index: u64) -> Result<bool, VectorError> {
    let (path, header) = (leaf_path(folder, index), SweepHeader::new(sweep));
    if path.exists()
        && let Ok(Some((found, leaf))) = read_leaf(&path)
    {
        if found != header {
            let message = format!("a leaf of {}, not of {}", found.text(), header.text());
            return Err(VectorError::file("NB1021", &path, message, "name an empty folder, or that of this sweep"));
        }
        if leaf.index == index {
            return Ok(false);
        }
    }
    let leaf = sweep.leaf(index);
    let file = LeafFile { format: LEAF_FORMAT.to_owned(), seal: seal(&header, &leaf), header, leaf };
    let text = serde_json::to_string_pretty(&file).unwrap_or_default() + "\n";
    write_file(&path, text.as_bytes())?;
    Ok(true)
}

/// The digests of all rows of a unit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tree {
    /// Version of the format: `ninebit-sweep-1`.
    pub format: String,
    /// The properties of the sweep.
    #[serde(flatten)]
    pub header: SweepHeader,
    /// Number of rows that the unit accepts.
    pub rows: u64,
    /// SHA-256 of the leaves as lines: index, rows, low, high and digest, separated by spaces.
    pub root: String,
    /// The leaves, in the order of their indices.
    pub leaf: Vec<Leaf>,
}

fn root(leaves: &[Leaf]) -> String {
    hexadecimal(&Sha256::digest(leaves.iter().map(line).collect::<String>()))
}

/// Merges the leaves in several folders into a tree. The result depends neither on the number of folders nor on their order.
///
/// # Errors
/// Returns an error if a leaf is missing ([`VectorError::Missing`]), exists twice, was changed, or is of another sweep than the first.
pub fn merge(folders: &[PathBuf]) -> Result<Tree, VectorError> {
    let mut found: BTreeMap<u64, (Leaf, PathBuf)> = BTreeMap::new();
    let mut first: Option<(SweepHeader, PathBuf)> = None;
    for path in folders.iter().map(|folder| leaf_files(folder)).collect::<Result<Vec<_>, _>>()?.concat() {
        let Some((header, leaf)) = read_leaf(&path)? else {
            let help = "remove it and sweep again: only that leaf is computed";
            return Err(VectorError::file("NB1020", &path, "not a leaf of a sweep, or changed since", help));
        };
        match &first {
            Some((before, _)) if *before != header => {
                let message = format!("a leaf of {}; the others are of {}", header.text(), before.text());
                let help = "merge the leaves of one sweep by one version";
                return Err(VectorError::file("NB1021", &path, message, help));
            }
            Some(_) => {}
            None => first = Some((header, path.clone())),
        }
        if leaf.index >= first.as_ref().map_or(0, |(header, _)| header.leaves) {
            return Err(VectorError::file("NB1020", &path, format!("there is no leaf {}", leaf.index), "remove it"));
        }
        if let Some((_, other)) = found.get(&leaf.index) {
            let message = format!("leaf {} is in `{}` already", leaf.index, ninebit::shown::path(other));
            let help = "name each folder once, and give each shard to one worker";
            return Err(VectorError::file("NB1022", &path, message, help));
        }
        found.insert(leaf.index, (leaf, path));
    }
    let Some((header, path)) = first else {
        let folder = folders.first().map(PathBuf::as_path).unwrap_or(Path::new("."));
        let help = "no leaves lie there: `ninebit vectors sweep` writes them";
        return Err(VectorError::missing(leaf_path(folder, 0), help));
    };
    if let Some(gap) = (0..header.leaves).find(|index| !found.contains_key(index)) {
        let folder = path.parent().unwrap_or(Path::new("."));
        let help = "not all leaves are there: run the missing shards again, what is there is kept";
        return Err(VectorError::missing(leaf_path(folder, gap), help));
    }
    let leaf: Vec<Leaf> = found.into_values().map(|(leaf, _)| leaf).collect();
    let rows = leaf.iter().map(|leaf| leaf.rows).sum();
    Ok(Tree { format: FORMAT.to_owned(), header, rows, root: root(&leaf), leaf })
}

/// Returns the leaf files of a folder, sorted by name.
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
    /// Returns the tree as JSON, with one leaf per line.
    pub fn text(&self) -> String {
        let SweepHeader { unit, only, profile, behaviour_rev, size, leaves } = &self.header;
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

    /// Reads a tree. Returns it and its sweep.
    ///
    /// # Errors
    /// Returns an error if the file does not exist, is not a tree or was changed, or is of a unit, chip or number of rows that this program does not
    /// have.
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
        if !in_order || tree.leaf.len() as u64 != tree.header.leaves {
            return Err(wrong("its leaves are not those of a whole sweep, in order"));
        }
        let rows = tree.leaf.iter().try_fold(0_u64, |sum, leaf| sum.checked_add(leaf.rows));
        if tree.root != root(&tree.leaf) || rows != Some(tree.rows) {
            return Err(wrong("its root is not that of its leaves: it was changed by hand"));
        }
        let sweep = units::by_name(&tree.header.unit).zip(Profile::from_name(&tree.header.profile));
        let sweep = sweep.filter(|(unit, profile)| unit.profiles().contains(profile));
        let sweep = sweep.and_then(|(unit, profile)| {
            let part = Part::new(unit, &tree.header.only).ok().filter(|part| part.texts() == tree.header.only)?;
            Exhaustive::from_part(unit, profile, part)
        });
        match sweep {
            Some(sweep) if (sweep.size(), sweep.leaves()) == (tree.header.size, tree.header.leaves) => {
                Ok((tree, sweep))
            }
            _ => {
                let message = format!("this program has no sweep of {}", tree.header.text());
                Err(VectorError::file("NB1005", path, message, help))
            }
        }
    }
}
