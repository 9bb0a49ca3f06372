//! Lists the scenes of the repository.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use ninebit::expectation::Expectation;
use ninebit::replay::find;

/// The folder, beside the scenes that need it, of images that are not part of the repository.
pub const CAPTURED: &str = "captured/";

/// Returns the images of [`CAPTURED`] that a scene refers to.
pub fn captured(text: &str) -> Vec<String> {
    let strings = text.split('"').skip(1).step_by(2);
    let names: BTreeSet<&str> = strings.filter(|name| name.starts_with(CAPTURED)).collect();
    names.into_iter().map(str::to_owned).collect()
}

/// Returns every scene below a folder that can be drawn with the files of the repository, sorted.
#[allow(dead_code, reason = "not every test that shares this file lists scenes")]
pub fn below(folder: &Path) -> Vec<PathBuf> {
    let entries = find(&[folder.to_path_buf()]).unwrap_or_else(|error| panic!("{error}"));
    let complete = |path: &PathBuf| {
        let text = std::fs::read_to_string(path.with_extension("expect.ron")).unwrap_or_default();
        let expectation = Expectation::parse(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        expectation.missing(path.parent().unwrap()).is_ok_and(|missing| missing.is_empty())
    };
    entries.into_iter().map(|entry| entry.path).filter(complete).collect()
}
