//! Remembers the files that this run has read and written, so that no output replaces one of them.
//!
//! Only the program calls [`watch`]; a user of the library may want to overwrite what was read. Readers [`note`] what they open. Outputs that the
//! user has named are compared with all these files, following links, before they are written: [`check`] does it early, if a long computation comes
//! first, and [`claim`] at the end. Files that a command has to update, such as an expectation, are not claimed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::error::OutputError;

/// The files of this run: canonical paths, and the names under which they were used.
#[derive(Debug, Default)]
struct FileUse {
    read: BTreeMap<PathBuf, PathBuf>,
    written: BTreeMap<PathBuf, PathBuf>,
}

static WATCHING: AtomicBool = AtomicBool::new(false);
static SEEN: Mutex<FileUse> = Mutex::new(FileUse { read: BTreeMap::new(), written: BTreeMap::new() });

fn seen() -> MutexGuard<'static, FileUse> {
    SEEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts remembering files and comparing outputs with them.
pub fn watch() {
    WATCHING.store(true, Ordering::Relaxed);
}

/// Remembers a file that has been or will be read. Other things than regular files, such as terminals, are ignored: they may be read and written.
pub fn note(path: &Path) {
    if WATCHING.load(Ordering::Relaxed)
        && let Some(place) = canonical_path(path)
    {
        seen().read.entry(place).or_insert_with(|| path.to_path_buf());
    }
}

/// Returns the canonical path of a file, which need not exist; `None` for other things than regular files.
fn canonical_path(path: &Path) -> Option<PathBuf> {
    match path.canonicalize() {
        Ok(place) => place.is_file().then_some(place),
        Err(_) => Some(folder_around(path).canonicalize().ok()?.join(path.file_name()?)),
    }
}

pub(crate) fn folder_around(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

impl FileUse {
    fn compare(&self, place: &Path, path: &Path) -> Result<(), OutputError> {
        let path = path.to_path_buf();
        if let Some(input) = self.read.get(place) {
            return Err(OutputError::Input { path, input: input.clone() });
        }
        if self.written.contains_key(place) {
            return Err(OutputError::Twice { path });
        }
        Ok(())
    }
}

/// Refuses outputs that would replace a file that was read or written, or one another.
///
/// # Errors
/// [`OutputError::Input`], [`OutputError::Twice`].
pub fn check<'a>(outputs: impl IntoIterator<Item = &'a Path>) -> Result<(), OutputError> {
    if !WATCHING.load(Ordering::Relaxed) {
        return Ok(());
    }
    let seen = seen();
    let mut places = Vec::new();
    for path in outputs {
        let Some(place) = canonical_path(path) else { continue };
        seen.compare(&place, path)?;
        if places.contains(&place) {
            return Err(OutputError::Twice { path: path.to_path_buf() });
        }
        places.push(place);
    }
    Ok(())
}

/// Checks an output that is about to be written, like [`check`], and remembers it.
///
/// # Errors
/// Those of [`check`].
pub fn claim(path: &Path) -> Result<(), OutputError> {
    if !WATCHING.load(Ordering::Relaxed) {
        return Ok(());
    }
    let Some(place) = canonical_path(path) else { return Ok(()) };
    let mut seen = seen();
    seen.compare(&place, path)?;
    seen.written.insert(place, path.to_path_buf());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outputs_are_compared_with_what_was_read_and_written() {
        let folder = tempfile::tempdir().expect("temporary folder");
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("read.png"), b"").expect("written");
        let mut seen = FileUse::default();
        let place = |path: &Path| canonical_path(path).expect("a place");
        seen.read.insert(place(&at("read.png")), at("read.png"));
        seen.written.insert(place(&at("new.png")), at("new.png"));
        std::fs::create_dir(at("below")).expect("made");
        for name in ["read.png", "./read.png", "below/../read.png"] {
            let refused = seen.compare(&place(&at(name)), &at(name));
            assert!(matches!(refused, Err(OutputError::Input { .. })), "{name}: {refused:?}");
        }
        for name in ["new.png", "below/../new.png"] {
            assert!(matches!(seen.compare(&place(&at(name)), &at(name)), Err(OutputError::Twice { .. })), "{name}");
        }
        assert!(seen.compare(&place(&at("other.png")), &at("other.png")).is_ok());
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("read.png", at("link.png")).expect("link");
            let refused = seen.compare(&place(&at("link.png")), &at("link.png"));
            assert!(matches!(refused, Err(OutputError::Input { .. })), "{refused:?}");
        }
        assert_eq!(super::canonical_path(Path::new("/dev/null")), None);
    }
}
