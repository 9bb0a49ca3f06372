//! Pixel programs in the language of an API, and how they become register combiners.
//!
//! [`texture_stages`] is Direct3D's, [`texture_environment`] OpenGL's. Both write each of their stages as equations over
//! [arguments](cascade::Argument); [`cascade`] turns equations into general stages. None of them knows scene files: they take
//! plain values with their [places](At) and return state or [`Finding`]s.

pub mod cascade;
mod finding;
pub mod texture_environment;
pub mod texture_stages;

pub use finding::{At, Finding};
