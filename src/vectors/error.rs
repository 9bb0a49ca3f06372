//! What can be wrong with tables and packs.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::output::OutputError;

/// Why a table or a pack cannot be used.
#[derive(Debug, Error)]
pub enum VectorError {
    /// A file is not there.
    #[error("`{}` does not exist", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// What to do.
        help: &'static str,
    },
    /// A file cannot be read.
    #[error("`{}` cannot be read: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A file does not say what it should.
    #[error("{}: {message}", place(path, *line))]
    Invalid {
        /// Stable code.
        code: &'static str,
        /// The file.
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
    if line == 0 { format!("`{}`", path.display()) } else { format!("`{}`, line {line}", path.display()) }
}

impl VectorError {
    /// A file that does not say what it should; `line` is 0 for the file as a whole.
    pub fn invalid(
        code: &'static str,
        path: &Path,
        line: usize,
        message: impl Into<String>,
        help: &'static str,
    ) -> VectorError {
        VectorError::Invalid { code, path: path.to_path_buf(), line, message: message.into(), help }
    }

    /// Stable code.
    pub fn code(&self) -> &'static str {
        match self {
            VectorError::Missing { .. } => "NB1001",
            VectorError::Unreadable { .. } => "NB1002",
            VectorError::Invalid { code, .. } => code,
            VectorError::Output(error) => error.code(),
        }
    }

    /// What to do.
    pub fn help(&self) -> &'static str {
        match self {
            VectorError::Missing { help, .. } | VectorError::Invalid { help, .. } => help,
            VectorError::Unreadable { .. } => "check that it is a text file that may be read",
            VectorError::Output(error) => error.help(),
        }
    }
}

/// Reads a text file.
///
/// # Errors
/// It does not exist, cannot be read, or is not UTF-8.
pub fn read_text(path: &Path, missing: &'static str) -> Result<String, VectorError> {
    let bytes = std::fs::read(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => VectorError::Missing { path: path.to_path_buf(), help: missing },
        _ => VectorError::Unreadable { path: path.to_path_buf(), reason: error.to_string() },
    })?;
    String::from_utf8(bytes)
        .map_err(|_| VectorError::Unreadable { path: path.to_path_buf(), reason: "it is not UTF-8 text".to_owned() })
}
