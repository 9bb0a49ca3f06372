//! Tests of which it is known only when they start which there are, or whether they can run here: a scene is a test of its own, and what
//! this machine cannot do is *ignored*, not passed.
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
