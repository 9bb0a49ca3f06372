//! Selection of the scenes to replay: files, folders and their content, filters, shards.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Component, Path, PathBuf};

use globset::{Glob, GlobSet, GlobSetBuilder};
use sha2::{Digest, Sha256};
use thiserror::Error;
use walkdir::WalkDir;

use crate::shard::Shard;
use ninebit::shown;

/// Extension before `.ron` in the names of expectations.
const EXPECTATION: &str = "expect";

/// Extension before `.ron` in the names of files that scenes share.
const FAMILY: &str = "family";

/// An entry that was found in the search for scenes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Name in reports and of its artifacts: the path without `.ron`, with ordinary parts only and `/` between them.
    pub name: String,
    /// Path of the file or folder.
    pub path: PathBuf,
    /// Kind of the entry.
    pub kind: EntryKind,
}

/// Kind of an [`Entry`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EntryKind {
    /// A scene file, which is drawn and compared.
    Scene,
    /// An expectation whose scene is missing.
    Orphan,
    /// A folder or an entry in one that cannot be read, with the reason.
    Unreadable(String),
}

/// Two scenes would have the same name in reports.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "`{}` and `{}` would both be called `{}` in reports",
    shown::path(first),
    shown::path(second),
    shown::name(name)
)]
pub struct FindError {
    /// The common name.
    pub name: String,
    /// Path of one scene.
    pub first: PathBuf,
    /// Path of the other scene.
    pub second: PathBuf,
}

/// Lists the scenes of `places`, sorted by name and without duplicates: files as they are, folders with everything below them.
///
/// In a folder, a scene is a file `NAME.ron` that is neither an expectation nor a family (`NAME.family.ron`). Names that begin with a dot are
/// skipped; links are followed. An expectation (`NAME.expect.ron`) is listed only if its scene is missing, as [`EntryKind::Orphan`].
///
/// # Errors
/// Returns an error if two different files have the same name.
pub fn find(places: &[PathBuf]) -> Result<Vec<Entry>, FindError> {
    let mut found: BTreeMap<String, Entry> = BTreeMap::new();
    for place in places {
        let entries = if place.is_dir() { below(place) } else { file(place).into_iter().collect() };
        for entry in entries {
            if let Some(other) = found.get(&entry.name)
                && other.path != entry.path
                && other.path.canonicalize().ok() != entry.path.canonicalize().ok()
            {
                return Err(FindError { name: entry.name, first: other.path.clone(), second: entry.path });
            }
            found.entry(entry.name.clone()).or_insert(entry);
        }
    }
    Ok(found.into_values().collect())
}

/// Lists the entries below a folder.
fn below(folder: &Path) -> Vec<Entry> {
    let visible = |name: &OsStr| !name.as_encoded_bytes().starts_with(b".") && before_extension(name).1 != Some(FAMILY);
    let walk = WalkDir::new(folder).follow_links(true).sort_by_file_name();
    walk.into_iter()
        .filter_entry(|entry| entry.depth() == 0 || visible(entry.file_name()))
        .filter_map(|entry| match entry {
            Ok(entry) if entry.file_type().is_file() => {
                entry.path().extension().is_some_and(|extension| extension == "ron").then(|| file(entry.path()))?
            }
            Ok(_) => None,
            Err(error) => {
                let path = error.path().unwrap_or(folder).to_path_buf();
                let reason = match error.io_error() {
                    Some(error) => error.to_string(),
                    None => "a link leads back to a folder above it".to_owned(),
                };
                Some(Entry { name: name(&path), path, kind: EntryKind::Unreadable(reason) })
            }
        })
        .collect()
}

/// Returns the entry of a file, or `None` for an expectation whose scene exists.
fn file(path: &Path) -> Option<Entry> {
    let entry = |path: &Path, kind| Entry { name: name(path), path: path.to_path_buf(), kind };
    match before_extension(path.file_name().unwrap_or_default()) {
        (scene, Some(EXPECTATION)) if path.is_file() => {
            let scene = path.with_file_name(scene).with_added_extension("ron");
            (!scene.exists()).then(|| Entry { path: path.to_path_buf(), ..entry(&scene, EntryKind::Orphan) })
        }
        _ => Some(entry(path, EntryKind::Scene)),
    }
}

/// Splits `NAME.KIND.ron` into the name, which need not be UTF-8, and the kind.
fn before_extension(name: &OsStr) -> (&OsStr, Option<&str>) {
    let name = Path::new(name);
    let stem = Path::new(name.file_stem().unwrap_or_default());
    let kind = stem.extension().and_then(OsStr::to_str).filter(|_| name.extension() == Some(OsStr::new("ron")));
    (stem.file_stem().unwrap_or_default(), kind)
}

/// Returns [`Entry::name`] of a path.
fn name(path: &Path) -> String {
    let part = |component| match component {
        Component::Normal(part) => Some(shown::lossless(Path::new(part))),
        _ => None,
    };
    let name = path.components().filter_map(part).collect::<Vec<_>>().join("/");
    name.strip_suffix(".ron").map_or_else(|| name.clone(), str::to_owned)
}

/// Filter for scenes by their names.
#[derive(Clone, Debug)]
pub(crate) struct Filter {
    included: Option<GlobSet>,
    excluded: GlobSet,
}

/// An invalid pattern.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{pattern}` is not a pattern: {reason}")]
pub(crate) struct FilterError {
    /// The pattern, as given.
    pub(crate) pattern: String,
    /// Reason why it is invalid.
    pub(crate) reason: String,
}

impl Filter {
    /// Returns a filter that accepts names that match one of the patterns, or all names if there is none, except those that match a pattern with a
    /// leading `!`.
    ///
    /// # Errors
    /// Returns an error if a pattern is invalid.
    pub(crate) fn new(patterns: &[String]) -> Result<Self, FilterError> {
        let (excluded, included): (Vec<&String>, Vec<&String>) = patterns.iter().partition(|p| p.starts_with('!'));
        Ok(Filter {
            included: if included.is_empty() { None } else { Some(set(&included)?) },
            excluded: set(&excluded)?,
        })
    }

    /// Returns whether the filter accepts an entry: its name, or its name with `.ron`.
    pub(crate) fn takes(&self, entry: &Entry) -> bool {
        let scene = format!("{}.ron", entry.name);
        let within = |set: &GlobSet| set.is_match(&entry.name) || set.is_match(&scene);
        self.included.as_ref().is_none_or(within) && !within(&self.excluded)
    }
}

fn set(patterns: &[&String]) -> Result<GlobSet, FilterError> {
    let refused = |pattern: &str, error: globset::Error| FilterError {
        pattern: pattern.to_owned(),
        reason: error.kind().to_string(),
    };
    let mut builder = GlobSetBuilder::new();
    for pattern in patterns {
        builder.add(Glob::new(pattern.trim_start_matches('!')).map_err(|error| refused(pattern, error))?);
    }
    builder.build().map_err(|error| refused("", error))
}

/// Returns the entries of a shard. The shard depends only on a scene's name, so that a new scene does not move others to another machine, which does
/// not have their pictures of an earlier run.
pub(crate) fn part(entries: Vec<Entry>, shard: Shard) -> Vec<Entry> {
    let number = |name: &str| {
        let digest = Sha256::digest(name.as_bytes());
        digest.iter().take(8).fold(0_u64, |number, byte| number << 8 | u64::from(*byte))
    };
    entries.into_iter().filter(|entry| shard.takes(number(&entry.name))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(name: &str) -> Entry {
        Entry { name: name.to_owned(), path: PathBuf::from(name), kind: EntryKind::Scene }
    }

    #[test]
    fn names_are_plain() {
        for (path, expected) in [("a/b.ron", "a/b"), ("./a/../b.ron", "a/b"), ("/a/b.c.ron", "a/b.c"), ("x", "x")] {
            assert_eq!(name(Path::new(path)), expected, "{path}");
        }
    }

    #[test]
    fn families_are_no_scenes() {
        let folder = tempfile::tempdir().expect("temporary folder");
        for name in ["a.ron", "all.family.ron", ".hidden.ron"] {
            std::fs::write(folder.path().join(name), "()").expect("written");
        }
        let found = find(&[folder.path().to_path_buf()]).expect("all of different names");
        let names: Vec<_> = found.iter().filter_map(|entry| entry.path.file_name()).collect();
        assert_eq!(names, ["a.ron"]);
    }

    #[test]
    fn filters_include_and_exclude() {
        let takes = |patterns: &[&str], name: &str| {
            let patterns: Vec<String> = patterns.iter().map(|p| (*p).to_owned()).collect();
            Filter::new(&patterns).unwrap_or_else(|error| panic!("{error}")).takes(&entry(name))
        };
        assert!(takes(&[], "a/b"));
        assert!(takes(&["a/*"], "a/b") && takes(&["a/*"], "a/c/b") && !takes(&["a/*"], "b/a"));
        assert!(takes(&["**/b.ron"], "a/b") && takes(&["**/b"], "a/b") && !takes(&["b"], "a/b"));
        assert!(takes(&["!*c*"], "a/b") && !takes(&["!*b*"], "a/b") && !takes(&["a/*", "!a/b"], "a/b"));
        assert!(takes(&["x/*", "a/*"], "a/b") && !takes(&["{x,y}/*"], "a/b"));
        let error = Filter::new(&["a[".to_owned()]).expect_err("no pattern");
        assert_eq!(error.pattern, "a[");
    }

    #[test]
    fn shards_share_everything() {
        let all: Vec<Entry> = (0..10).map(|n| entry(&n.to_string())).collect();
        for count in 1..13 {
            let mut joined: Vec<Entry> =
                (1..=count).filter_map(|index| Some(part(all.clone(), Shard::new(index, count)?))).flatten().collect();
            joined.sort_by(|a, b| a.name.cmp(&b.name));
            assert_eq!(joined, all, "{count}");
            // A scene's shard does not depend on other scenes.
            for index in 1..=count {
                let alone = |entry: &Entry| Shard::new(index, count).map(|shard| part(vec![entry.clone()], shard));
                let one_by_one: Vec<Entry> = all.iter().filter_map(alone).flatten().collect();
                assert_eq!(Shard::new(index, count).map(|shard| part(all.clone(), shard)), Some(one_by_one));
            }
        }
        assert_eq!((Shard::new(0, 2), Shard::new(3, 2), Shard::new(0, 0)), (None, None, None));
    }
}
