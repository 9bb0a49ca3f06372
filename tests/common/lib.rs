//! What tests share that computes much: random scenes and programs, traces recomputed from their own numbers, decoded blocks.
//!
//! Strategies are boxed, so that their code is made here. The other files of this folder are modules of the tests that name them.
#![allow(
    unreachable_pub,
    missing_docs,
    missing_debug_implementations,
    clippy::unwrap_used,
    clippy::float_arithmetic,
    reason = "tests fail by panicking"
)]

pub mod blocks;
pub mod random_program;
pub mod random_scene;
pub mod random_vertex_program;
pub mod recompute;
