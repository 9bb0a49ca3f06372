//! Reads files. This is the only place that does: it never reads more than a limit, and notes each file in [`files`].
//!
//! The caller says what a file may be. A file that a scene or a folder names has to be regular, which is checked before it is opened: opening a pipe
//! would wait for its other end. A file that the user names on the command line may be a pipe.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;

use thiserror::Error;

use crate::files;
use ninebit::faults::{self, Operation};
use ninebit::limits::{FileLimit, PAGE};

/// The kinds of file that may be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A regular file only.
    Regular,
    /// Anything that can be read, including pipes and devices.
    Stream,
}

/// The error that a file was not read.
#[derive(Debug, Error)]
pub enum ReadError {
    /// There is no such file.
    #[error("there is no such file")]
    Missing,
    /// The path is a folder, or a device or pipe where a regular file is required.
    #[error("it is not a regular file")]
    NotRegular,
    /// The file has more bytes than the limit.
    #[error("it is larger than {0}")]
    TooLarge(FileLimit),
    /// The file system refused to read it.
    #[error("{0}")]
    Refused(io::Error),
}

impl From<io::Error> for ReadError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => ReadError::Missing,
            _ => ReadError::Refused(error),
        }
    }
}

/// Returns the bytes of a file.
///
/// # Errors
/// The file does not exist, is not of the given kind, is larger than the limit, or cannot be read.
pub fn bytes(path: &Path, kind: Kind, limit: FileLimit) -> Result<Vec<u8>, ReadError> {
    let (file, metadata) = open(path, kind, limit)?;
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len().min(limit.bytes)).unwrap_or(0));
    within(file, limit, |part| bytes.extend_from_slice(part))?;
    Ok(bytes)
}

/// Passes the bytes of a file to `take` part by part, for files that need not be in memory as a whole. Returns the number of bytes.
///
/// # Errors
/// Those of [`bytes`]; parts may have been passed before.
pub fn parts(path: &Path, kind: Kind, limit: FileLimit, take: impl FnMut(&[u8])) -> Result<u64, ReadError> {
    within(open(path, kind, limit)?.0, limit, take)
}

/// Returns the text of a page that the program can do without; `None` if it cannot be read.
pub fn page(path: &Path) -> Option<String> {
    String::from_utf8(bytes(path, Kind::Regular, PAGE).ok()?).ok()
}

/// Returns the bytes of a reader, such as standard input.
///
/// # Errors
/// There are more bytes than the limit, or they cannot be read.
pub fn all(reader: impl Read, limit: FileLimit) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    within(reader, limit, |part| bytes.extend_from_slice(part))?;
    Ok(bytes)
}

fn open(path: &Path, kind: Kind, limit: FileLimit) -> Result<(File, Metadata), ReadError> {
    faults::check(Operation::Read)?;
    let metadata = path.metadata()?;
    if metadata.is_dir() || kind == Kind::Regular && !metadata.is_file() {
        return Err(ReadError::NotRegular);
    }
    if metadata.is_file() && metadata.len() > limit.bytes {
        return Err(ReadError::TooLarge(limit));
    }
    files::note(path);
    Ok((File::open(path)?, metadata))
}

/// Reads up to the limit. The bytes are counted as they arrive, since the size of a file may be outdated and a device has none.
fn within(mut reader: impl Read, limit: FileLimit, mut take: impl FnMut(&[u8])) -> Result<u64, ReadError> {
    let mut part = vec![0; 64 << 10];
    let mut taken = 0_u64;
    loop {
        let read = match faults::check(Operation::Read).and_then(|()| reader.read(&mut part)) {
            Ok(0) => return Ok(taken),
            Ok(read) => read,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error.into()),
        };
        taken += read as u64;
        if taken > limit.bytes {
            return Err(ReadError::TooLarge(limit));
        }
        take(&part[..read]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMIT: FileLimit = FileLimit { name: "test_bytes", bytes: 100_000, counted: "bytes of a test" };

    #[test]
    fn a_file_at_the_limit_is_read_and_one_beyond_is_not() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("file");
        std::fs::write(&path, vec![7; 100_000]).expect("writes");
        assert_eq!(bytes(&path, Kind::Regular, LIMIT).expect("at the limit"), vec![7; 100_000]);
        let mut sum = 0;
        assert_eq!(parts(&path, Kind::Regular, LIMIT, |part| sum += part.len()).expect("at the limit"), 100_000);
        assert_eq!(sum, 100_000);
        std::fs::write(&path, vec![7; 100_001]).expect("writes");
        let error = bytes(&path, Kind::Regular, LIMIT).expect_err("beyond");
        assert_eq!(error.to_string(), "it is larger than 100000 bytes, the limit `test_bytes`");
    }

    #[test]
    fn what_has_no_size_is_read_up_to_the_limit() {
        assert_eq!(all(io::repeat(1).take(100_000), LIMIT).expect("at the limit").len(), 100_000);
        assert!(matches!(all(io::repeat(1), LIMIT), Err(ReadError::TooLarge(LIMIT))));
    }

    #[cfg(unix)]
    #[test]
    fn devices_and_folders_are_no_regular_files() {
        let zero = Path::new("/dev/zero");
        assert!(matches!(bytes(zero, Kind::Regular, LIMIT), Err(ReadError::NotRegular)));
        assert!(matches!(bytes(zero, Kind::Stream, LIMIT), Err(ReadError::TooLarge(_))));
        assert!(matches!(bytes(Path::new("."), Kind::Stream, LIMIT), Err(ReadError::NotRegular)));
        assert!(matches!(bytes(Path::new("nothing"), Kind::Stream, LIMIT), Err(ReadError::Missing)));
    }
}
