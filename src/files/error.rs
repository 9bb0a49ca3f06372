//! Why an output was not written.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use ninebit::shown;

/// The error that an output was not written, not even in part.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The path is a folder.
    #[error("`{}` is a folder", shown::path(path))]
    Folder {
        /// Path of the output.
        path: PathBuf,
    },
    /// The file system refused to write it.
    #[error("`{}` cannot be written: {source}", shown::path(path))]
    Write {
        /// Path of the output.
        path: PathBuf,
        /// Error of the file system.
        source: io::Error,
    },
    /// The output would replace a file that was read.
    #[error("`{}` is the input{}: nothing was written", shown::path(path), called(path, input))]
    Input {
        /// Path of the output.
        path: PathBuf,
        /// Path under which the file was read.
        input: PathBuf,
    },
    /// The output would replace another output of the same run.
    #[error("`{}` would be written twice", shown::path(path))]
    Twice {
        /// Path of both outputs.
        path: PathBuf,
    },
    /// The output would replace a file under version control.
    #[error("`{}` is there, in a folder under version control", shown::path(path))]
    Versioned {
        /// Path of the output.
        path: PathBuf,
    },
    /// Standard output could not be written.
    #[error("standard output cannot be written: {source}")]
    Stdout {
        /// Error of the file system.
        source: io::Error,
    },
    /// The picture could not be encoded.
    #[error("a picture of {width} x {height} cannot be encoded: {reason}")]
    Encode {
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
        /// Message of the encoder.
        reason: String,
    },
}

impl OutputError {
    /// Returns the code, which `docs/errors.md` lists.
    pub fn code(&self) -> &'static str {
        match self {
            OutputError::Folder { .. } => "NB0701",
            OutputError::Write { .. } => "NB0702",
            OutputError::Stdout { .. } => "NB0703",
            OutputError::Encode { .. } => "NB0704",
            OutputError::Input { .. } => "NB0705",
            OutputError::Twice { .. } => "NB0706",
            OutputError::Versioned { .. } => "NB0707",
        }
    }

    /// Returns what to do about it.
    pub fn help(&self) -> &'static str {
        match self {
            OutputError::Folder { .. } => "name a file in it",
            OutputError::Write { source, .. } => match source.kind() {
                io::ErrorKind::NotFound => "create its folder first",
                io::ErrorKind::PermissionDenied => "check that the file and its folder may be written to",
                io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "free some space on that disk",
                _ => "write to another place",
            },
            OutputError::Stdout { .. } => "write to a file with `-o FILE`",
            OutputError::Encode { .. } => "pictures need at least one pixel",
            OutputError::Input { .. } => "write the output to another file",
            OutputError::Twice { .. } => "give each output a file of its own",
            OutputError::Versioned { .. } => "write to another folder, or say `--overwrite`",
        }
    }

    /// Returns whether writing was not tried because the output would replace something else, so that the command line is wrong.
    pub fn is_refused(&self) -> bool {
        matches!(self, OutputError::Input { .. } | OutputError::Twice { .. } | OutputError::Versioned { .. })
    }

    /// Returns whether the reader of standard output has gone away, as `head` does. That needs no message.
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, OutputError::Stdout { source } if source.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// Returns the name of an input for the message, if the output has another name.
fn called(path: &Path, input: &Path) -> String {
    if path == input { String::new() } else { format!(" `{}`", shown::path(input)) }
}
