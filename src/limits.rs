//! Stand-in for the interface.
/// Limits.
#[derive(Clone, Copy, Debug, Default)]
pub struct Limits {}
