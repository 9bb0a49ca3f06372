//! Stand-in for the interface.
use crate::frame::{Frames, Surface};
use crate::plan::Plan;
/// Options.
#[derive(Clone, Copy, Debug)]
pub struct RenderOptions {
    /// Threads; 0 takes all cores.
    pub threads: usize,
}
impl Default for RenderOptions {
    fn default() -> Self {
        RenderOptions { threads: 1 }
    }
}
/// Draws everything.
pub fn render(plan: &Plan, _options: &RenderOptions) -> Frames {
    let blank = |t: &crate::state::Target| {
        let pixels = (t.width * t.height) as usize;
        let depth = t.depth.map_or(Vec::new(), |d| vec![d.clear; pixels]);
        Surface { width: t.width, height: t.height, format: t.format, words: vec![0; pixels], depth }
    };
    Frames { surfaces: plan.scene().targets.iter().map(blank).collect() }
}
