//! A draw compiled to rows.

use super::node::Node;
use super::shader::Shader;
use crate::engine::rows::sampling::sampler::Sampler;
use crate::state::TEXTURE_UNITS;
use std::sync::Arc;

/// A draw compiled to rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct CompiledDraw {
    /// Operations in order, each with the row of its result.
    pub(crate) operations: Vec<(Node, usize)>,
    /// What each row is filled with when a draw begins, unless an operation computes it.
    pub(crate) rows: Vec<Option<i16>>,
    pub(crate) primary: [Option<u16>; 4],
    pub(crate) secondary: [Option<u16>; 4],
    pub(crate) fog: Option<u16>,
    pub(crate) textures: [[Option<u16>; 4]; TEXTURE_UNITS],
    pub(crate) destination: [Option<u16>; 4],
    /// Rows of the stored R, G, B and A.
    pub(crate) stored: [u16; 4],
    /// Row of the alpha that is tested.
    pub(crate) alpha: u16,
    /// Channels of the primary and of the secondary colour that are read, as masks of bytes.
    pub(crate) read: [u32; 2],
    pub(crate) samplers: Vec<Sampler>,
    /// Whether something follows from the positions of pixels.
    pub(crate) interpolates: bool,
    /// The texture shader, if there is one.
    pub(crate) shader: Option<Arc<Shader>>,
    /// Whether the scalar engine draws it, because rows do not sample its textures, decoding them would not pay, or its edges are smooth.
    pub(crate) is_scalar: bool,
    /// Whether all pixels of the quads that a triangle meets are lanes: levels of detail or taps follow from them.
    pub(crate) takes_quads: bool,
    /// Whether the surface or its depths are read when a block is computed: for blending, or for tests that are late.
    pub(crate) reads_surface: bool,
    /// Whether something other than the depth test can drop fragments. If nothing else can, depths are tested before anything else.
    pub(crate) drops_late: bool,
    /// Whether parts of the surface's words may stay: bits that are not written, or dropped fragments.
    pub(crate) merges: bool,
    /// Whether all bits of a pixel are written.
    pub(crate) writes_whole: bool,
}

impl CompiledDraw {
    /// Returns whether a colour that is read varies across a triangle whose corners have these colours.
    #[inline(always)]
    pub(crate) fn varies(&self, primary: &[[u8; 4]; 3], secondary: &[[u8; 4]; 3]) -> bool {
        let [primary, secondary] = [primary, secondary].map(|colors| {
            let [a, b, c] = colors.map(u32::from_le_bytes);
            (a ^ b) | (b ^ c)
        });
        (primary & self.read[0]) | (secondary & self.read[1]) != 0
    }
}
