//! Sources of the files that a scene names: its folder, or a bundle in memory.
//!
//! The loader resolves a name and gets the file's bytes, within a limit. A [`Folder`] reads the file system. A [`Bundle`] needs no file system. A
//! [`RecordingFolder`] reads a folder and keeps what it read, which makes a bundle.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use ninebit::limits::FileLimit;
use ninebit_files::read::{self, Kind, ReadError};

use crate::path::{self, PathError};

/// A source of files. Names have the form that [`path::resolve`] accepts.
pub trait Assets: fmt::Debug {
    /// Returns the path of the file `name`, beside a scene in `folder`, in the form that [`bytes`](Self::bytes) takes.
    ///
    /// # Errors
    /// The name is malformed, there is no such file, or it lies outside `folder`.
    fn resolve(&self, folder: &Path, name: &str) -> Result<PathBuf, PathError>;

    /// Returns the contents of a file.
    ///
    /// # Errors
    /// The file cannot be read, or is larger than the limit.
    fn bytes(&self, file: &Path, limit: FileLimit) -> Result<Vec<u8>, ReadError>;
}

/// The file system: regular files in the scene's folder.
#[derive(Clone, Copy, Debug)]
pub struct Folder;

impl Assets for Folder {
    fn resolve(&self, folder: &Path, name: &str) -> Result<PathBuf, PathError> {
        path::resolve(folder, name)
    }

    fn bytes(&self, file: &Path, limit: FileLimit) -> Result<Vec<u8>, ReadError> {
        read::bytes(file, Kind::Regular, limit)
    }
}

/// Files in memory, under the names that scenes give them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Bundle {
    /// Contents of the files by name.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl Assets for Bundle {
    fn resolve(&self, folder: &Path, name: &str) -> Result<PathBuf, PathError> {
        path::check(name)?;
        if self.files.contains_key(name) { Ok(name.into()) } else { Err(PathError::missing(folder, name)) }
    }

    fn bytes(&self, file: &Path, limit: FileLimit) -> Result<Vec<u8>, ReadError> {
        let bytes = file.to_str().and_then(|name| self.files.get(name)).ok_or(ReadError::Missing)?;
        if bytes.len() as u64 > limit.bytes { Err(ReadError::TooLarge(limit)) } else { Ok(bytes.clone()) }
    }
}

/// A [`Folder`] that keeps every file it reads.
#[derive(Debug, Default)]
pub struct RecordingFolder {
    names: RefCell<BTreeMap<PathBuf, Vec<String>>>,
    bundle: RefCell<Bundle>,
}

impl RecordingFolder {
    /// Returns the files that have been read so far.
    pub fn bundle(self) -> Bundle {
        self.bundle.into_inner()
    }
}

impl Assets for RecordingFolder {
    fn resolve(&self, folder: &Path, name: &str) -> Result<PathBuf, PathError> {
        let file = Folder.resolve(folder, name)?;
        self.names.borrow_mut().entry(file.clone()).or_default().push(name.to_owned());
        Ok(file)
    }

    fn bytes(&self, file: &Path, limit: FileLimit) -> Result<Vec<u8>, ReadError> {
        let bytes = Folder.bytes(file, limit)?;
        let mut bundle = self.bundle.borrow_mut();
        // Links give a file several names.
        for name in self.names.borrow().get(file).into_iter().flatten() {
            bundle.files.insert(name.clone(), bytes.clone());
        }
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{load, parse_with};
    use ninebit::engine::{RenderOptions, render};
    use ninebit::limits::Limits;

    #[test]
    fn a_scene_draws_the_same_from_memory() {
        // Tests of a crate run in its folder.
        let path = Path::new("../../vectors/scenes/dot3/lit-stone.ron");
        let limits = Limits::default();
        let text = std::fs::read_to_string(path).expect("a scene");
        let gathered = RecordingFolder::default();
        parse_with(&text, path, &limits, &gathered).expect("sound");
        let bundle = gathered.bundle();
        assert_eq!(bundle.files.keys().collect::<Vec<_>>(), ["rocks-normal.png"]);
        let loaded = parse_with(&text, Path::new("scene.ron"), &limits, &bundle).expect("sound");
        let beside = load(path, &limits).expect("sound");
        let options = RenderOptions::default();
        assert_eq!(render(&loaded.plan, &options).surfaces, render(&beside.plan, &options).surfaces);
    }

    #[test]
    fn names_of_a_bundle_are_held_to_the_same_form() {
        let bundle = Bundle { files: BTreeMap::from([("../a".to_owned(), vec![1]), ("b".to_owned(), vec![0; 9])]) };
        let folder = Path::new("");
        assert_eq!(bundle.resolve(folder, "../a").expect_err("not a plain name").code(), "NB0501");
        assert_eq!(bundle.resolve(folder, "c").expect_err("not there").code(), "NB0502");
        let limit = |bytes| FileLimit { name: "test_bytes", bytes, counted: "bytes of a test" };
        let file = bundle.resolve(folder, "b").expect("there");
        assert_eq!(bundle.bytes(&file, limit(9)).expect("at the limit").len(), 9);
        assert!(matches!(bundle.bytes(&file, limit(8)), Err(ReadError::TooLarge(_))));
    }
}
