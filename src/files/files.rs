//! Which files this run has read and written, so that no output takes the place of one of them.
//!
//! The program [`watch`]es; a library's caller, who may well write what it read, need not. Readers [`note`] what they open. Outputs that somebody
//! named are compared with all of it, links followed, before they are written: [`check`] early, where much is to be computed first, [`claim`]
//! at last. Files that a command is there to bring up to date, such as an expectation, are not claimed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::output::OutputError;

/// Files by the place where they really are; what they were called.
#[derive(Debug, Default)]
struct Seen {
    read: BTreeMap<PathBuf, PathBuf>,
    written: BTreeMap<PathBuf, PathBuf>,
}

static WATCHING: AtomicBool = AtomicBool::new(false);
static SEEN: Mutex<Seen> = Mutex::new(Seen { read: BTreeMap::new(), written: BTreeMap::new() });

fn seen() -> MutexGuard<'static, Seen> {
    SEEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on files are remembered and outputs compared with them.
pub fn watch() {
    WATCHING.store(true, Ordering::Relaxed);
}

/// Remembers a file that is read, or is about to be. What is no regular file, such as a terminal, can be read and written.
pub fn note(path: &Path) {
    if WATCHING.load(Ordering::Relaxed)
        && let Some(place) = place(path)
    {
        seen().read.entry(place).or_insert_with(|| path.to_path_buf());
    }
}

/// Where a file really is, or will be; nothing for what is no regular file.
fn place(path: &Path) -> Option<PathBuf> {
    match path.canonicalize() {
        Ok(place) => place.is_file().then_some(place),
        Err(_) => {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            Some(folder.canonicalize().ok()?.join(path.file_name()?))
        }
    }
}

impl Seen {
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

/// Refuses outputs that would take the place of a file that was read or written, or of one another.
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
        let Some(place) = place(path) else { continue };
        seen.compare(&place, path)?;
        if places.contains(&place) {
            return Err(OutputError::Twice { path: path.to_path_buf() });
        }
        places.push(place);
    }
    Ok(())
}

/// [`check`]s an output that is about to be written, and remembers it.
///
/// # Errors
/// As [`check`].
pub fn claim(path: &Path) -> Result<(), OutputError> {
    if !WATCHING.load(Ordering::Relaxed) {
        return Ok(());
    }
    let Some(place) = place(path) else { return Ok(()) };
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
        let mut seen = Seen::default();
        let place = |path: &Path| place(path).expect("a place");
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
        assert_eq!(super::place(Path::new("/dev/null")), None);
    }
}
