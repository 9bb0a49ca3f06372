//! How calls fail.

use ninebit_scene::{ErrorKind, SceneError};

/// Status of a call. The numbers are the exit statuses of the program.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NinebitStatus {
    /// The call succeeded.
    Ok = 0,
    /// An argument is wrong: a null pointer, a number that is too large, or a buffer of the wrong size.
    Argument = 2,
    /// A scene, one of its files, or the register words are invalid.
    Invalid = 3,
    /// A file is missing.
    Missing = 4,
    /// A limit has been exceeded, or the system has no thread left.
    Limit = 5,
    /// A fault of this library has occurred.
    Internal = 6,
}

/// The status and the message of a call that failed.
pub(crate) struct Failure {
    pub(crate) status: NinebitStatus,
    pub(crate) text: String,
}

impl Failure {
    pub(crate) fn argument(text: impl Into<String>) -> Failure {
        Failure { status: NinebitStatus::Argument, text: text.into() }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Failure {
        let status = match error.kind() {
            ErrorKind::Invalid => NinebitStatus::Invalid,
            ErrorKind::Missing => NinebitStatus::Missing,
            ErrorKind::Limit => NinebitStatus::Limit,
        };
        Failure { status, text: error.render(false) }
    }
}
