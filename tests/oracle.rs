//! The crate against a second model written from the rules: the same words and depths, pixel by pixel.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

#[path = "oracle/mod.rs"]
mod model;
