//! What the program `ninebit` is made of. Other programs take the crates below it: this one's interface follows the program's needs.
//!
//! * [`main`] runs a command line.
//! * [`replay`] holds scenes against what is [expected](expectation) of them; [`ninebit_scene::diff`] holds two pictures against each other.

mod commands;
pub mod expectation;
mod page;
pub mod replay;
pub mod shard;

use std::ffi::OsString;

pub use commands::main;

/// Runs a command line, the program's name first, in this process; its exit status. A panic is the caller's.
pub fn run(arguments: &[OsString]) -> u8 {
    commands::run(arguments) as u8
}
