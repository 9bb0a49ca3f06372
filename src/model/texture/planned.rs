//! A texture unit as the plan prepares it, and the image that it samples.

use crate::state::{Level, MipFilter, ShaderOperation, ShaderStage, TextureFormat, TextureKind, TextureUnit};
use std::sync::Arc;

/// A texture unit with the properties of the image that it samples.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedUnit {
    /// Number of the unit, 0 to 3.
    pub index: usize,
    /// State of the unit.
    pub state: TextureUnit,
    /// The unit's stage of the texture shader.
    pub stage: ShaderStage,
    /// How the image is addressed. A volume of which only the first layer is read counts as two-dimensional (TEX-20).
    pub kind: TextureKind,
    /// Format of the image's words.
    pub format: TextureFormat,
    /// Levels of the image. Their offsets are relative to the face.
    pub levels: Vec<Level>,
    /// Number of words of each face or layer.
    pub face_words: usize,
    /// Number of layers of a volume; 1 for all other kinds.
    pub layers: u32,
    /// Whether each level has border texels.
    pub border: bool,
    /// Whether DXT1 is dithered (TEX-3), which it is not on nv10 (TEX-4).
    pub dithered: bool,
    /// The entries of the palette, if the format is P8.
    pub palette: Option<Arc<[u32]>>,
    /// Channels that are read, as bits 1, 2, 4, 8 for R, G, B, A.
    pub live: u8,
}

impl PlannedUnit {
    /// Returns whether the coordinates are a direction.
    pub fn takes_direction(&self) -> bool {
        self.stage.operation.takes_direction(self.kind)
    }

    /// Returns whether the coordinates are those of another kind than the image (TEX-20).
    pub fn is_other_kind(&self) -> bool {
        self.takes_direction() != (self.kind == TextureKind::Cube)
    }

    /// Returns whether s and t lie on face +X of a cube map (TEX-20).
    pub fn is_on_face(&self) -> bool {
        self.kind == TextureKind::Cube && self.stage.operation == ShaderOperation::Sample2D
    }

    /// Returns whether the lod can affect the result.
    pub fn needs_lod(&self) -> bool {
        self.state.min_filter != self.state.mag_filter
            || (self.levels.len() > 1 && self.state.mip_filter != MipFilter::None)
    }
}

/// The image that a unit samples, as it is when a draw begins.
#[derive(Clone, Copy, Debug)]
pub struct Image<'a, L> {
    /// The stored words of all faces and levels.
    pub words: &'a [u32],
    /// If the image is a surface that is read in its own format: the lane's values of its pixels, and the channels they
    /// hold (bits R, G, B, A).
    pub memory: Option<(&'a [[L; 4]], u8)>,
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Returns a unit that samples an image of one texel.
    pub(crate) fn unit() -> PlannedUnit {
        PlannedUnit {
            index: 0,
            state: TextureUnit::new(0),
            stage: ShaderStage::conventional(0, true),
            kind: TextureKind::TwoDimensional,
            format: TextureFormat::A8R8G8B8,
            levels: vec![Level { offset: 0, width: 1, height: 1 }],
            face_words: 1,
            layers: 1,
            border: false,
            dithered: true,
            palette: None,
            live: 15,
        }
    }
}
