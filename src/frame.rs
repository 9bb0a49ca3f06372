//! What a render leaves behind: surfaces of stored words.

use crate::state::SurfaceFormat;

/// A render target's memory after (or during) a render.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Surface {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Format of the words.
    pub format: SurfaceFormat,
    /// `width * height` stored pixels, row by row from the top; unused high bits zero.
    pub words: Vec<u32>,
    /// Stored depths in the same order; empty without a depth buffer.
    pub depth: Vec<u32>,
}

/// Every surface of a scene, in the order of [`Scene::targets`](crate::state::Scene::targets).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frames {
    /// The surfaces.
    pub surfaces: Vec<Surface>,
}
