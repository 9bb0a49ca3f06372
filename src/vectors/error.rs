//! What can be wrong with tables and packs.

use std::path::{Path, PathBuf};

use thiserror::Error;

use ninebit::limits::FileLimit;
use ninebit_files::output::OutputError;
use ninebit_files::read::{self, Kind, ReadError};

/// Why a table or a pack cannot be used.
#[derive(Debug, Error)]
pub enum VectorError {
    /// A file is not there.
    #[error("`{}` does not exist", ninebit::shown::path(path))]
    Missing {
        /// The file that was looked for.
        path: PathBuf,
        /// What to do.
        help: &'static str,
    },
    /// A file cannot be read.
    #[error("`{}` cannot be read: {reason}", ninebit::shown::path(path))]
    Unreadable {
        /// The file that was opened.
        path: PathBuf,
        /// What the file system said.
        reason: String,
    },
    /// A file has more bytes than it may.
    #[error("`{}` is larger than {limit}", ninebit::shown::path(path))]
    TooLarge {
        /// The file that was opened.
        path: PathBuf,
        /// How many it may have.
        limit: FileLimit,
    },
    /// A file does not say what it should.
    #[error("{}: {message}", place(path, *line))]
    Invalid {
        /// The code of `docs/errors.md`.
        code: &'static str,
        /// The file that was read.
        path: PathBuf,
        /// Line, counted from 1; 0 for the file as a whole.
        line: usize,
        /// What is wrong.
        message: String,
        /// What to do.
        help: &'static str,
    },
    /// An output was not written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

fn place(path: &Path, line: usize) -> String {
    if line == 0 {
        format!("`{}`", ninebit::shown::path(path))
    } else {
        format!("`{}`, line {line}", ninebit::shown::path(path))
    }
}

impl VectorError {
    /// A line, counted from 1, that does not say what it should.
    pub fn line(code: &'static str, path: &Path, line: usize, message: String, help: &'static str) -> VectorError {
        VectorError::Invalid { code, path: path.to_path_buf(), line, message, help }
    }

    /// A file that does not say what it should.
    pub fn file(code: &'static str, path: &Path, message: impl Into<String>, help: &'static str) -> VectorError {
        VectorError::line(code, path, 0, message.into(), help)
    }

    /// A file or folder that is not there.
    pub fn missing(path: impl Into<PathBuf>, help: &'static str) -> VectorError {
        VectorError::Missing { path: path.into(), help }
    }

    /// A file or folder that cannot be read.
    pub fn unreadable(path: &Path, reason: impl ToString) -> VectorError {
        VectorError::Unreadable { path: path.to_path_buf(), reason: reason.to_string() }
    }

    /// The code of `docs/errors.md`.
    pub fn code(&self) -> &'static str {
        match self {
            VectorError::Missing { .. } => "NB1001",
            VectorError::Unreadable { .. } => "NB1002",
            VectorError::TooLarge { .. } => "NB1013",
            VectorError::Invalid { code, .. } => code,
            VectorError::Output(error) => error.code(),
        }
    }

    /// What to do.
    pub fn help(&self) -> &'static str {
        match self {
            VectorError::Missing { help, .. } | VectorError::Invalid { help, .. } => help,
            VectorError::Unreadable { .. } => "check that it is a text file that may be read",
            VectorError::TooLarge { .. } => "`ninebit limits` prints what is allowed; is it the file that was meant?",
            VectorError::Output(error) => error.help(),
        }
    }
}

/// Why a file could not be read, as an error about it; `missing` says what to do if it is not there.
pub fn unread(error: ReadError, path: &Path, missing: &'static str) -> VectorError {
    match error {
        ReadError::Missing => VectorError::missing(path, missing),
        ReadError::TooLarge(limit) => VectorError::TooLarge { path: path.to_path_buf(), limit },
        error => VectorError::unreadable(path, error),
    }
}

/// Reads a text file.
///
/// # Errors
/// It does not exist, is larger than the limit, cannot be read, or is not UTF-8.
pub fn read_text(path: &Path, kind: Kind, limit: FileLimit, missing: &'static str) -> Result<String, VectorError> {
    let bytes = read::bytes(path, kind, limit).map_err(|error| unread(error, path, missing))?;
    String::from_utf8(bytes).map_err(|_| VectorError::unreadable(path, "it is not UTF-8 text"))
}
