//! Errors of tables, packs, sweeps and results.

use std::path::{Path, PathBuf};

use thiserror::Error;

use ninebit::limits::FileLimit;
use ninebit_files::output::OutputError;
use ninebit_files::read::{self, Kind, ReadError};

/// Reason why a file of this crate cannot be used or written.
#[derive(Debug, Error)]
pub enum VectorError {
    /// A file does not exist.
    #[error("`{}` does not exist", ninebit::shown::path(path))]
    Missing {
        /// The file that was looked for.
        path: PathBuf,
        /// Advice to the user.
        help: &'static str,
    },
    /// A file cannot be read.
    #[error("`{}` cannot be read: {reason}", ninebit::shown::path(path))]
    Unreadable {
        /// The file that was opened.
        path: PathBuf,
        /// Message of the file system.
        reason: String,
    },
    /// A file exceeds its size limit.
    #[error("`{}` is larger than {limit}", ninebit::shown::path(path))]
    TooLarge {
        /// The file that was opened.
        path: PathBuf,
        /// The limit that the file exceeds.
        limit: FileLimit,
    },
    /// The content of a file is not valid.
    #[error("{}: {message}", location(path, *line))]
    Invalid {
        /// Error code, as `docs/errors.md` lists it.
        code: &'static str,
        /// The file that was read.
        path: PathBuf,
        /// Line number from 1; 0 means the file as a whole.
        line: usize,
        /// Description of the error.
        message: String,
        /// Advice to the user.
        help: &'static str,
    },
    /// An output was not written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

fn location(path: &Path, line: usize) -> String {
    if line == 0 {
        format!("`{}`", ninebit::shown::path(path))
    } else {
        format!("`{}`, line {line}", ninebit::shown::path(path))
    }
}

impl VectorError {
    /// Returns the error for an invalid line, counted from 1.
    pub(crate) fn line(
        code: &'static str,
        path: &Path,
        line: usize,
        message: String,
        help: &'static str,
    ) -> VectorError {
        VectorError::Invalid { code, path: path.to_path_buf(), line, message, help }
    }

    /// Names an output in a temporary folder by the path that it would have got.
    pub(crate) fn named(self, temporary: &Path, folder: &Path) -> VectorError {
        match self {
            VectorError::Output(OutputError::Write { path, source }) => {
                let path = path.strip_prefix(temporary).map(|below| folder.join(below)).unwrap_or(path);
                VectorError::Output(OutputError::Write { path, source })
            }
            other => other,
        }
    }

    /// A file that does not say what it should.
    pub(crate) fn file(code: &'static str, path: &Path, message: impl Into<String>, help: &'static str) -> VectorError {
        VectorError::line(code, path, 0, message.into(), help)
    }

    /// Returns the error for a file or folder that does not exist.
    pub(crate) fn missing(path: impl Into<PathBuf>, help: &'static str) -> VectorError {
        VectorError::Missing { path: path.into(), help }
    }

    /// Returns the error for a file or folder that cannot be read.
    pub(crate) fn unreadable(path: &Path, reason: impl ToString) -> VectorError {
        VectorError::Unreadable { path: path.to_path_buf(), reason: reason.to_string() }
    }

    /// Returns the error code, as `docs/errors.md` lists it.
    pub fn code(&self) -> &'static str {
        match self {
            VectorError::Missing { .. } => "NB1001",
            VectorError::Unreadable { .. } => "NB1002",
            VectorError::TooLarge { .. } => "NB1013",
            VectorError::Invalid { code, .. } => code,
            VectorError::Output(error) => error.code(),
        }
    }

    /// Returns the advice to the user.
    pub fn help(&self) -> &'static str {
        match self {
            VectorError::Missing { help, .. } | VectorError::Invalid { help, .. } => help,
            VectorError::Unreadable { .. } => "check that it is a text file that may be read",
            VectorError::TooLarge { .. } => "`ninebit limits` prints what is allowed; is it the file that was meant?",
            VectorError::Output(error) => error.help(),
        }
    }
}

/// Converts a read error of `path`. `missing` is the advice for a file that does not exist.
pub(crate) fn unread(error: ReadError, path: &Path, missing: &'static str) -> VectorError {
    match error {
        ReadError::Missing => VectorError::missing(path, missing),
        ReadError::TooLarge(limit) => VectorError::TooLarge { path: path.to_path_buf(), limit },
        error => VectorError::unreadable(path, error),
    }
}

/// Reads a text file. `missing` is the advice for a file that does not exist.
///
/// # Errors
/// Returns an error if the file does not exist, is larger than the limit, cannot be read, or is not UTF-8.
pub(crate) fn read_text(
    path: &Path,
    kind: Kind,
    limit: FileLimit,
    missing: &'static str,
) -> Result<String, VectorError> {
    let bytes = read::bytes(path, kind, limit).map_err(|error| unread(error, path, missing))?;
    String::from_utf8(bytes).map_err(|_| VectorError::unreadable(path, "it is not UTF-8 text"))
}
