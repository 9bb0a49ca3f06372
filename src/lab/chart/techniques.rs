//! Scenes that say what their picture ought to show, found in folders: how exact each is, how fast, and at what cost.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::timing::{Effort, Spread, frames};
use crate::accuracy::{self, Accuracy};
use ninebit::engine::RenderOptions;
use ninebit::limits::Limits;
use ninebit_files::read::page;
use ninebit_scene::truth::Truth;
use ninebit_scene::{SceneError, load};

/// A scene to be measured.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// The folder it stands in, below the one that was searched; of scenes directly in that, its own name.
    pub family: String,
    /// Its file's name without the parameter.
    pub technique: String,
    /// The number that the file's name ends in.
    pub parameter: Option<u32>,
    /// Its file.
    pub path: PathBuf,
}

impl Entry {
    /// Technique and parameter in words.
    pub fn name(&self) -> String {
        let words = self.technique.replace('-', " ");
        self.parameter.map_or(words.clone(), |parameter| format!("{words} {parameter}"))
    }
}

/// What was measured of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Technique {
    /// The scene.
    pub entry: Entry,
    /// What its picture ought to show, without what tells how the technique does it. Scenes of which this is equal are ways to the same
    /// light.
    pub truth: Truth,
    /// How far its picture is from its truth, and what it costs the chip.
    pub accuracy: Accuracy,
    /// Drawing it here, nanoseconds per final pixel, fast engine, one thread.
    pub time: Spread,
}

/// Why a scene was not measured.
#[derive(Debug)]
pub enum TechniqueError {
    /// A folder cannot be read.
    Folder(PathBuf, io::Error),
    /// A scene is not accepted.
    Scene(Box<SceneError>),
    /// No pixel of a scene that has a truth is drawn.
    Unseen(PathBuf),
}

/// Every scene file in a folder and below, by family, technique and parameter.
///
/// # Errors
/// A folder cannot be read.
pub fn find(folder: &Path) -> Result<Vec<Entry>, TechniqueError> {
    let mut found = Vec::new();
    let own = folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    search(folder, &own, true, &mut found)?;
    found.sort();
    Ok(found)
}

fn search(folder: &Path, family: &str, top: bool, found: &mut Vec<Entry>) -> Result<(), TechniqueError> {
    let fail = |error| TechniqueError::Folder(folder.to_path_buf(), error);
    for entry in fs::read_dir(folder).map_err(fail)? {
        let path = entry.map_err(fail)?.path();
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        if path.is_dir() {
            search(&path, if top { &name } else { family }, false, found)?;
        } else if let Some(stem) = name.strip_suffix(".ron").filter(|stem| !stem.contains('.')) {
            let (technique, parameter) = parted(stem);
            found.push(Entry { family: family.to_owned(), technique, parameter, path });
        }
    }
    Ok(())
}

/// `squaring-16` as its two parts.
fn parted(stem: &str) -> (String, Option<u32>) {
    let parts = stem.rsplit_once('-').and_then(|(name, number)| Some((name.to_owned(), Some(number.parse().ok()?))));
    parts.unwrap_or((stem.to_owned(), None))
}

/// The name of a family: the first heading of the page in its folder, or the folder's name in words.
pub fn title(folder: &Path, family: &str) -> String {
    let page = page(&folder.join(family).join("README.md")).unwrap_or_default();
    let heading = page.lines().find_map(|line| line.strip_prefix("# ")).map(|line| line.replace('`', ""));
    heading.unwrap_or_else(|| family.replace('-', " "))
}

/// Measures a scene. `None` if it says nothing of what its picture ought to show.
///
/// # Errors
/// The scene is not accepted, or nothing of it is seen.
pub fn measure(entry: &Entry, effort: &Effort) -> Result<Option<Technique>, TechniqueError> {
    let loaded = load(&entry.path, &Limits::default()).map_err(|error| TechniqueError::Scene(Box::new(error)))?;
    let Some(truth) = &loaded.truth else { return Ok(None) };
    let Some(accuracy) = accuracy::measure(&loaded.scene, &loaded.plan, truth) else {
        return Err(TechniqueError::Unseen(entry.path.clone()));
    };
    let time = frames(&loaded.plan, &RenderOptions::default(), accuracy.pixels, effort);
    let truth = Truth { shading_normal: None, meshes: Vec::new(), ..truth.clone() };
    Ok(Some(Technique { entry: entry.clone(), truth, accuracy, time }))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_found_with_family_technique_and_parameter() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        for name in ["gloss/squaring-16.ron", "gloss/squaring-2.ron", "gloss/deep/table.ron", "flat/one-2x.ron"] {
            write(name, "");
        }
        write("flat/one-2x.expect.ron", "");
        write("gloss/README.md", "text\n# Highlights by `power`\n");
        let found = find(folder.path()).unwrap();
        let names: Vec<(String, String)> = found.iter().map(|entry| (entry.family.clone(), entry.name())).collect();
        let expected = [("flat", "one 2x"), ("gloss", "squaring 2"), ("gloss", "squaring 16"), ("gloss", "table")];
        assert_eq!(names, expected.map(|(family, name)| (family.to_owned(), name.to_owned())));
        assert_eq!(title(folder.path(), "gloss"), "Highlights by power");
        assert_eq!(title(folder.path(), "flat"), "flat");
        assert!(matches!(find(&folder.path().join("nothing")), Err(TechniqueError::Folder(..))));
    }
}
