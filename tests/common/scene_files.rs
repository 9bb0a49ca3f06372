//! The scenes of the repository.

use std::path::{Path, PathBuf};

/// The folder of images that are not part of the repository, beside the scenes that need them.
pub const CAPTURED: &str = "captured/";

/// Whether a scene needs such images.
pub fn needs_captured(text: &str) -> bool {
    text.contains(&format!("\"{CAPTURED}"))
}

/// Every scene below a folder that can be drawn with what the repository has, sorted.
#[allow(dead_code, reason = "not every test that shares this file lists scenes")]
pub fn below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            files.extend(below(&path));
        } else if name.ends_with(".ron")
            && !name.ends_with(".expect.ron")
            && !name.ends_with(".family.ron")
            && !needs_captured(&std::fs::read_to_string(&path).unwrap())
        {
            files.push(path);
        }
    }
    files.sort();
    files
}
