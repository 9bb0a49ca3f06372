//! Folders of pictures, as test programs and their runners leave them: `SUITE/NAME.png`, below folders for versions and hosts.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use walkdir::WalkDir;

/// Most files that are looked at.
const MOST_FILES: usize = 1_000_000;

/// Deepest folder that is looked at.
const DEEPEST: usize = 12;

/// A folder with pictures of suites.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pictures {
    /// The folder that the folders of suites lie in.
    pub folder: PathBuf,
    /// The folder's name for people: its path below the place that was asked for, or its own name.
    pub name: String,
    /// Suite and name of each picture, in order.
    pub files: Vec<(String, String)>,
}

/// Returns the folders below `place` that hold folders of pictures, in the order of their names. Names that are no UTF-8 are left out.
///
/// # Errors
/// A folder cannot be read.
pub fn find(place: &Path) -> Result<Vec<Pictures>, walkdir::Error> {
    let mut found = BTreeMap::<PathBuf, Vec<(String, String)>>::new();
    for entry in WalkDir::new(place).max_depth(DEEPEST).into_iter().take(MOST_FILES) {
        let entry = entry?;
        let path = entry.path();
        let is_picture = path.extension().is_some_and(|extension| extension == "png");
        if !entry.file_type().is_file() || !is_picture {
            continue;
        }
        let (Some(name), Some(suite)) = (path.file_stem().and_then(OsStr::to_str), path.parent()) else { continue };
        let (Some(around), Some(suite)) = (suite.parent(), suite.file_name().and_then(OsStr::to_str)) else { continue };
        if suite == "." || !path.starts_with(place) || path.parent() == Some(place) {
            continue;
        }
        found.entry(around.to_path_buf()).or_default().push((suite.to_owned(), name.to_owned()));
    }
    let named = |(folder, mut files): (PathBuf, Vec<(String, String)>)| {
        files.sort();
        let below = folder.strip_prefix(place).ok().filter(|below| !below.as_os_str().is_empty());
        let name = below.or_else(|| place.file_name().map(Path::new)).unwrap_or(place);
        Pictures { name: ninebit::shown::path(name), folder, files }
    };
    Ok(found.into_iter().map(named).collect())
}

/// Returns the pictures below `place` as those of one renderer, with the folder of each, below `place`, as its suite.
///
/// # Errors
/// A folder cannot be read.
pub fn beside_scenes(place: &Path) -> Result<Pictures, walkdir::Error> {
    let mut files = Vec::new();
    for entry in WalkDir::new(place).max_depth(DEEPEST).into_iter().take(MOST_FILES) {
        let entry = entry?;
        let below = entry.path().strip_prefix(place).unwrap_or(entry.path());
        if !entry.file_type().is_file() || below.extension().is_none_or(|extension| extension != "png") {
            continue;
        }
        let suite = below.parent().and_then(Path::to_str).unwrap_or_default();
        if let Some(name) = below.file_stem().and_then(OsStr::to_str) {
            files.push((suite.to_owned(), name.to_owned()));
        }
    }
    files.sort();
    Ok(Pictures { folder: place.to_path_buf(), name: ninebit::shown::path(place), files })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_suites_at_any_depth() {
        let place = tempfile::tempdir().expect("a folder");
        let write = |path: &str| {
            let path = place.path().join(path);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("folders");
            std::fs::write(path, b"").expect("a file");
        };
        for path in ["v1/host/Fog/a.png", "v1/host/Blend/a.png", "v2/Fog/a.png", "v2/notes.txt", "stray.png"] {
            write(path);
        }
        let found = find(place.path()).expect("folders");
        let names: Vec<&str> = found.iter().map(|pictures| pictures.name.as_str()).collect();
        assert_eq!(names, ["v1/host", "v2"]);
        let file = |suite: &str, name: &str| (suite.to_owned(), name.to_owned());
        assert_eq!(found[0].files, [file("Blend", "a"), file("Fog", "a")]);
        assert!(find(&place.path().join("none")).is_err());
    }
}
