//! Shared parts of tests that need much computation: random scenes and programs, recomputed traces, decoded blocks.
//!
//! Strategies are boxed, so that their code is compiled in this crate. The other files of this folder are modules of the tests that include
//! them.
#![allow(
    unreachable_pub,
    missing_docs,
    missing_debug_implementations,
    clippy::unwrap_used,
    clippy::float_arithmetic,
    reason = "tests fail by panicking"
)]

pub mod blocks;
pub mod changed_scene;
pub mod frames;
#[path = "../../src/model/engine/rows/lattice.rs"]
pub mod lattice;
pub mod metamorphic;
pub mod random_program;
pub mod random_scene;
pub mod random_vertex_program;
pub mod recompute;
