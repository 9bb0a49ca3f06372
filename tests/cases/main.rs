//! Tests whose number, or whose ability to run on this machine, is known only at start. Each scene is a test of its own. A test that this
//! machine cannot run is reported as *ignored*, not as passed.
//!
//! `cargo test --test cases scenes::fog` runs the scenes of `vectors/scenes/fog`.
#![allow(clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test fails by panicking")]

mod machine;
#[path = "../common/repository.rs"]
mod repository;
mod scenes;

fn main() {
    repository::enter();
    let arguments = libtest_mimic::Arguments::from_args();
    let trials = scenes::trials().into_iter().chain(machine::trials()).collect();
    libtest_mimic::run(&arguments, trials).exit();
}
