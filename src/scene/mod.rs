//! The scene front end: files, paths, meshes.

pub mod image;
pub mod mesh;
pub mod path;

use crate::limits::Limits;
use crate::state::Scene;

/// Stand-in for the interface.
#[derive(Debug)]
pub struct Loaded {
    /// Checked.
    pub scene: Scene,
    /// Worth telling.
    pub warnings: Vec<String>,
}
/// Stand-in for the interface.
#[derive(Debug)]
pub struct SceneError {}
/// Stand-in for the interface.
///
/// # Errors
/// Always.
pub fn load(_path: &std::path::Path, _limits: &Limits) -> Result<Loaded, SceneError> {
    Err(SceneError {})
}
