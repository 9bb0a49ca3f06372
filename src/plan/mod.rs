//! Stand-in for the interface.
use crate::state::{Policies, Scene};
/// Options.
#[derive(Clone, Copy, Debug)]
pub struct PlanOptions {
    /// Policies.
    pub policies: Policies,
    /// Drop what cannot reach the frame.
    pub prune: bool,
}
impl Default for PlanOptions {
    fn default() -> Self {
        PlanOptions { policies: Policies::DEFAULT, prune: true }
    }
}
/// A compiled scene.
#[derive(Clone, Debug)]
pub struct Plan {
    scene: Scene,
}
/// Why a scene cannot be planned (RAS-0 and memory limits).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanError {
    /// Index of the draw.
    pub draw: usize,
    /// Index of the vertex, if one is to blame.
    pub vertex: Option<usize>,
    /// Rule or limit, for example "RAS-0".
    pub rule: &'static str,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
}
impl Plan {
    /// Compiles.
    ///
    /// # Errors
    /// All draws that break a limit of RAS-0.
    pub fn compile(scene: &Scene, _options: &PlanOptions) -> Result<Plan, Vec<PlanError>> {
        Ok(Plan { scene: scene.clone() })
    }
    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
}
