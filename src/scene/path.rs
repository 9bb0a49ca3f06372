//! Resolves names of files in a scene, so that they cannot leave the scene's folder.
//!
//! Scenes are untrusted. The rule for names is the same on every system: relative, with `/` between the
//! parts, every part an ordinary name. Links are followed, but their targets have to lie in the folder as well.

use std::io;
use std::path::{Path, PathBuf};

use ninebit_program::spelling::closest;
use thiserror::Error;

/// The error that a name was not accepted.
#[derive(Debug, Error)]
#[error("`{name}` {fault}")]
pub struct PathError {
    /// The name, shortened for messages.
    pub(crate) name: String,
    /// The fault of the name.
    pub(crate) fault: PathFault,
}

/// The fault of a name.
#[derive(Debug, Error)]
pub(crate) enum PathFault {
    /// The name is not a plain relative path; the text says why.
    #[error("is not a plain relative path: {0}")]
    Form(&'static str),
    /// There is no such file in the given folder.
    #[error("does not exist in `{}`", ninebit::shown::path(.0))]
    Missing(PathBuf),
    /// A link leads out of the given folder.
    #[error("leads out of `{}`", ninebit::shown::path(.0))]
    Escape(PathBuf),
    /// The file system refused access.
    #[error("cannot be reached: {0}")]
    Unreachable(io::Error),
}

impl PathFault {
    /// Makes the error that a name has this fault.
    fn at(self, name: &str) -> PathError {
        PathError { name: shorten(name), fault: self }
    }

    /// Returns the stable code, and the help: what to do about the fault.
    fn message_and_help(&self) -> (&'static str, &'static str) {
        match self {
            PathFault::Form(_) => (
                "NB0501",
                "write it relative to the scene's folder with `/` between the parts, such as `maps/rocks.png`",
            ),
            PathFault::Missing(_) => {
                ("NB0502", "names are relative to the folder of the scene file; upper and lower case count")
            }
            PathFault::Escape(_) => ("NB0503", "copy the file into the scene's folder: links may not lead out of it"),
            PathFault::Unreachable(_) => ("NB0504", "check that the folders on the way can be read"),
        }
    }
}

impl PathError {
    /// Makes the error that there is no file of a name.
    pub(crate) fn missing(folder: &Path, name: &str) -> PathError {
        PathFault::Missing(folder.to_path_buf()).at(name)
    }

    /// Returns the code, which `docs/errors.md` lists.
    pub fn code(&self) -> &'static str {
        self.fault.message_and_help().0
    }

    /// Returns what to do about it.
    pub fn help(&self) -> String {
        let meant = match &self.fault {
            PathFault::Missing(folder) => similar(&folder.join(&self.name)),
            _ => None,
        };
        // As a scene writes it: relative to the folder.
        let written = |file: String| match self.name.rsplit_once('/') {
            Some((inside, _)) => format!("did you mean `{inside}/{file}`?"),
            None => format!("did you mean `{file}`?"),
        };
        meant.map_or_else(|| self.fault.message_and_help().1.to_owned(), written)
    }

    /// Returns whether the file does not exist; other errors concern files that may not be used.
    pub fn is_missing(&self) -> bool {
        matches!(self.fault, PathFault::Missing(_))
    }
}

/// Most entries of a folder that are looked at for similar names.
const MOST_ENTRIES: usize = 10_000;

/// Returns the name of the file that is most like that of a missing one, in the same folder.
pub fn similar(missing: &Path) -> Option<String> {
    let name = missing.file_name()?.to_str()?;
    let folder = missing.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).ok()?.take(MOST_ENTRIES);
    let mut names: Vec<String> = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    // The order of a folder is the system's.
    names.sort_unstable();
    closest(name, names.iter().map(String::as_str).filter(|other| *other != name)).map(str::to_owned)
}

/// Returns advice for a missing file that the command line names: a similar name in its folder, if there is one.
pub fn advice(missing: &Path) -> String {
    match similar(missing) {
        Some(name) => format!("did you mean `{}`?", ninebit::shown::path(&missing.with_file_name(name))),
        None => "check the spelling and the folder; upper and lower case count".to_owned(),
    }
}

/// Finds the file `name` under `folder`.
///
/// The result is canonical: it contains no links, and starts with the canonical form of `folder`. The file may be
/// of any kind; whoever opens it has to check that it is a regular file.
///
/// # Errors
/// The name is absolute, or has `..`, `.`, an empty part, a backslash, a colon or a control character; the file is missing; a
/// link leads out of `folder`; the file system refuses access.
pub fn resolve(folder: &Path, name: &str) -> Result<PathBuf, PathError> {
    check(name)?;
    // The path of a scene in the current folder has an empty parent.
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let classify = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => PathError::missing(folder, name),
        _ => PathFault::Unreachable(source).at(name),
    };
    let root = folder.canonicalize().map_err(classify)?;
    let file = root.join(name).canonicalize().map_err(classify)?;
    if !file.starts_with(&root) {
        return Err(PathFault::Escape(folder.to_path_buf()).at(name));
    }
    Ok(file)
}

/// Checks that `name` has the form of a plain relative path.
///
/// # Errors
/// [`PathFault::Form`].
pub(crate) fn check(name: &str) -> Result<(), PathError> {
    objection(name).map_or(Ok(()), |reason| Err(PathFault::Form(reason).at(name)))
}

/// Returns what is wrong with the form of `name`, if anything. The decision uses the text alone, so it is the same on every system.
fn objection(name: &str) -> Option<&'static str> {
    let whole = [
        (name.is_empty(), "it is empty"),
        (name.starts_with('/'), "it is absolute"),
        (name.contains('\\'), "it has a backslash"),
        (name.contains(':'), "it has a colon"),
        (name.chars().any(char::is_control), "it has a control character"),
    ];
    let part = |part| match part {
        "" => Some("it has an empty part"),
        "." | ".." => Some("it has a `.` or `..` part"),
        _ => None,
    };
    let whole = whole.into_iter().find_map(|(objects, what)| objects.then_some(what));
    whole.or_else(|| name.split('/').find_map(part))
}

/// Returns a name for messages: without control characters, and at most 120 characters long.
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
    fn a_misspelt_file_has_a_similar_one() {
        let folder = scene_folder();
        let help = |name| resolve(folder.path(), name).expect_err(name).help();
        assert_eq!(help("maps/rock.png"), "did you mean `maps/rocks.png`?");
        assert_eq!(help("map"), "did you mean `maps`?");
        assert!(help("maps/gravel-normals.png").starts_with("names are relative"));
        assert!(help("other/rocks.png").starts_with("names are relative"));
        let meant = folder.path().join("maps/rocks.png");
        assert_eq!(advice(&folder.path().join("maps/rucks.png")), format!("did you mean `{}`?", meant.display()));
        assert!(advice(&folder.path().join("x.ron")).starts_with("check the spelling"));
        assert!(advice(Path::new("/")).starts_with("check the spelling"));
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
