//! The model in a browser.
//!
//! [`Session`] holds a scene and answers JSON requests with JSON; pictures are bytes. `boundary` exports both to a WebAssembly host. The page of
//! `ninebit inspect` is such a host; its scripts are in `src/cli/page`. [`Session`] does not depend on it.

mod boundary;
mod frame;
mod program;
mod session;
mod shader;
mod tree;

pub use session::Session;

/// Reason why a request was refused, as a message.
pub(crate) type Refused = String;
