//! A texture unit as a plan has it, and the image that it samples.

use crate::state::{Level, MipFilter, ShaderStage, TextureFormat, TextureKind, TextureUnit};
use std::sync::Arc;

/// A texture unit with the image it samples.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedUnit {
    /// The unit's number.
    pub index: usize,
    /// The unit's registers.
    pub state: TextureUnit,
    /// Its part of the texture shader.
    pub stage: ShaderStage,
    /// What the image is sampled as.
    pub kind: TextureKind,
    /// Format of the image.
    pub format: TextureFormat,
    /// Its levels, as they lie in each face.
    pub levels: Vec<Level>,
    /// Words of each face.
    pub face_words: usize,
    /// Layers of a volume; of other kinds 1.
    pub layers: u32,
    /// Each level has border texels.
    pub border: bool,
    /// DXT1 is dithered (TEX-3; nv10: TEX-4).
    pub dithered: bool,
    /// The colours of a palette format.
    pub palette: Option<Arc<[u32]>>,
    /// Channels R, G, B, A (bits 1, 2, 4, 8) that anybody reads.
    pub live: u8,
}

impl PlannedUnit {
    /// Whether the lod can make a difference.
    pub fn needs_lod(&self) -> bool {
        self.state.min_filter != self.state.mag_filter
            || (self.levels.len() > 1 && self.state.mip_filter != MipFilter::None)
    }
}

/// The image that a unit samples, as it stands when a draw begins.
#[derive(Clone, Copy, Debug)]
pub struct Image<'a, L> {
    /// The words of all faces and levels, as they are stored.
    pub words: &'a [u32],
    /// What the lane holds of them, where the image is a surface read in its own format, and of which channels (bits R, G, B, A).
    pub memory: Option<(&'a [[L; 4]], u8)>,
}
