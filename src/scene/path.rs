//! Names of files inside a scene, resolved so that they cannot leave the scene's folder.
//!
//! A scene may come from anywhere. The files it names are found by the same rule on every system: relative, `/` between the
//! parts, every part an ordinary name. Links are followed, but what they lead to must lie under the folder as well.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a name was not accepted.
#[derive(Debug, Error)]
pub enum PathError {
    /// The name is not a plain relative one.
    #[error("`{name}` is not a plain relative path: {reason}")]
    Form {
        /// As given, shortened for messages.
        name: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// There is no such file.
    #[error("`{name}` does not exist in `{}`", ninebit::shown::path(folder))]
    Missing {
        /// As given.
        name: String,
        /// Where it was looked for.
        folder: PathBuf,
    },
    /// A link leads out of the folder.
    #[error("`{name}` leads out of `{}`", ninebit::shown::path(folder))]
    Escape {
        /// As given.
        name: String,
        /// The folder that must not be left.
        folder: PathBuf,
    },
    /// The file system refused.
    #[error("`{name}` cannot be reached: {source}")]
    Unreachable {
        /// As given.
        name: String,
        /// Why.
        source: io::Error,
    },
}

impl PathError {
    /// There is no file of that name.
    pub(crate) fn missing(folder: &Path, name: &str) -> PathError {
        PathError::Missing { name: shorten(name), folder: folder.to_path_buf() }
    }

    /// Stable code.
    pub fn code(&self) -> &'static str {
        match self {
            PathError::Form { .. } => "NB0501",
            PathError::Missing { .. } => "NB0502",
            PathError::Escape { .. } => "NB0503",
            PathError::Unreachable { .. } => "NB0504",
        }
    }

    /// What to do about it.
    pub fn help(&self) -> &'static str {
        match self {
            PathError::Form { .. } => {
                "write it relative to the scene's folder with `/` between the parts, such as `maps/rocks.png`"
            }
            PathError::Missing { .. } => {
                "names are relative to the folder of the scene file; upper and lower case count"
            }
            PathError::Escape { .. } => "copy the file into the scene's folder: links may not lead out of it",
            PathError::Unreachable { .. } => "check that the folders on the way can be read",
        }
    }

    /// The file is not there (as opposed to: it may not be used).
    pub fn is_missing(&self) -> bool {
        matches!(self, PathError::Missing { .. })
    }
}

/// Finds the file `name` under `folder`.
///
/// The result is canonical: no links are left in it, and it starts with the canonical form of `folder`. The file may still be
/// of any kind; whoever opens it checks that it is a regular one.
///
/// # Errors
/// The name is not relative, has `..`, `.`, an empty part, a backslash, a colon or a control character; the file is missing; a
/// link leads out of `folder`; the file system refuses.
pub fn resolve(folder: &Path, name: &str) -> Result<PathBuf, PathError> {
    check(name)?;
    // The path of a scene in the current folder has an empty parent.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let classify = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => PathError::missing(folder, name),
        _ => PathError::Unreachable { name: shorten(name), source },
    };
    let root = folder.canonicalize().map_err(classify)?;
    let file = root.join(name).canonicalize().map_err(classify)?;
    if !file.starts_with(&root) {
        return Err(PathError::Escape { name: shorten(name), folder: folder.to_path_buf() });
    }
    Ok(file)
}

/// Whether `name` has the form of a plain relative path.
///
/// # Errors
/// [`PathError::Form`].
pub(crate) fn check(name: &str) -> Result<(), PathError> {
    objection(name).map_or(Ok(()), |reason| Err(PathError::Form { name: shorten(name), reason }))
}

/// What is wrong with the form of `name`, if anything. Decided on the text alone, alike on every system.
fn objection(name: &str) -> Option<&'static str> {
    if name.is_empty() {
        return Some("it is empty");
    }
    if name.starts_with('/') {
        return Some("it is absolute");
    }
    if name.contains('\\') {
        return Some("it has a backslash");
    }
    if name.contains(':') {
        return Some("it has a colon");
    }
    if name.chars().any(char::is_control) {
        return Some("it has a control character");
    }
    for part in name.split('/') {
        match part {
            "" => return Some("it has an empty part"),
            "." | ".." => return Some("it has a `.` or `..` part"),
            _ => {}
        }
    }
    None
}

/// A name as it appears in messages: no control characters, at most 120 characters.
fn shorten(name: &str) -> String {
    name.chars().take(120).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn scene_folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().expect("temporary folder");
        fs::create_dir(folder.path().join("maps")).expect("folder");
        fs::write(folder.path().join("maps/rocks.png"), b"x").expect("file");
        folder
    }

    #[test]
    fn plain_names_are_found() {
        let folder = scene_folder();
        let found = resolve(folder.path(), "maps/rocks.png").expect("resolves");
        assert!(found.ends_with("maps/rocks.png") && found.is_absolute());
    }

    #[test]
    fn forms_that_differ_between_systems_are_refused() {
        let folder = scene_folder();
        for name in [
            "",
            "/etc/passwd",
            "//host/share",
            "..",
            "../rocks.png",
            "maps/../maps/rocks.png",
            "./maps/rocks.png",
            "maps/./rocks.png",
            "maps//rocks.png",
            "maps/",
            "maps\\rocks.png",
            "C:/rocks.png",
            "maps/rocks.png:stream",
            "maps/rocks.png\0",
            "maps/\nrocks.png",
        ] {
            let error = resolve(folder.path(), name).expect_err(name);
            assert_eq!(error.code(), "NB0501", "{name:?}: {error}");
            assert!(!error.is_missing());
            assert!(!error.to_string().contains('\0'));
        }
    }

    #[test]
    fn a_missing_file_is_told_apart() {
        let folder = scene_folder();
        for name in ["maps/moss.png", "moss/rocks.png", "maps/rocks.png/inside"] {
            let error = resolve(folder.path(), name).expect_err(name);
            assert!(error.is_missing(), "{name}: {error}");
        }
    }

    #[test]
    fn long_names_are_shortened_in_messages() {
        let folder = scene_folder();
        let error = resolve(folder.path(), &"a".repeat(100_000)).expect_err("too long for any file system");
        assert!(error.to_string().len() < 400, "{}", error.to_string().len());
    }

    #[cfg(unix)]
    #[test]
    fn links_may_not_leave_the_folder() {
        use std::os::unix::fs::symlink;
        let outside = tempfile::tempdir().expect("temporary folder");
        fs::write(outside.path().join("secret.png"), b"x").expect("file");
        let folder = scene_folder();
        symlink(outside.path().join("secret.png"), folder.path().join("file.png")).expect("link");
        symlink(outside.path(), folder.path().join("folder")).expect("link");
        symlink("maps/rocks.png", folder.path().join("inside.png")).expect("link");
        symlink("loop.png", folder.path().join("loop.png")).expect("link");
        for name in ["file.png", "folder/secret.png"] {
            let error = resolve(folder.path(), name).expect_err(name);
            assert_eq!(error.code(), "NB0503", "{error}");
        }
        assert!(resolve(folder.path(), "inside.png").is_ok());
        assert_eq!(resolve(folder.path(), "loop.png").expect_err("loop").code(), "NB0504");
    }
}
