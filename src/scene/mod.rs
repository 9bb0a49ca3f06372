//! The scene front end: files, paths, meshes.

pub mod image;
pub mod mesh;
pub mod path;
