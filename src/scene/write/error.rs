//! The error that state cannot be written.

/// The error that no scene says what the state says.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place} cannot be written as a scene: {reason}")]
pub struct Unwritable {
    /// Which part of the state, such as a draw with its name.
    pub place: String,
    /// What no scene says.
    pub reason: String,
}
