//! The model in a browser.
//!
//! [`Session`] holds a scene and answers requests, JSON in and JSON out; pictures are bytes. `boundary` hands both to a WebAssembly host. The page of
//! `ninebit inspect` is that host; `src/web/page` has its scripts. [`Session`] knows nothing of it.

mod boundary;
mod frame;
mod program;
mod session;
mod shader;
mod tree;

pub use session::Session;

/// What a request needs and does not say, or what it says and is not so.
pub(crate) type Refused = String;
