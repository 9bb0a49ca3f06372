//! Library of the program `ninebit`. Other programs should use the crates below it: this interface follows the program's needs.
//!
//! * [`main`] runs a command line.
//! * [`replay`] compares scenes with their [expectations](expectation); [`ninebit_scene::diff`] compares two pictures.

mod commands;
pub mod expectation;
mod page;
pub mod replay;
pub mod shard;
mod undecided;

use std::ffi::OsString;

pub use commands::main;

/// Runs a command line in this process, with the program's name first. Returns its exit status. Does not catch panics.
pub fn run(arguments: &[OsString]) -> u8 {
    commands::run(arguments) as u8
}
