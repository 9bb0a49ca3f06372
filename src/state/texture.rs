//! Texture images and the units that sample them.

use super::named;
use std::sync::Arc;

/// Number of texture units in the state. NV10 has the first two.
pub const TEXTURE_UNITS: usize = 4;

named! {
    /// How the bits of a texel become R, G, B, A (TEX-1).
    pub enum TextureFormat {
        /// 32 bits, A in the top byte.
        A8R8G8B8,
        /// 32 bits, top byte ignored, alpha 255.
        X8R8G8B8,
        /// 16 bits, alpha 255.
        R5G6B5,
        /// 16 bits, top bit ignored, alpha 255.
        X1R5G5B5,
        /// 16 bits, the top bit is alpha: 0 or 255.
        A1R5G5B5,
        /// Luminance byte: L, L, L, 255.
        L8,
        /// Alpha byte: 255, 255, 255, A.
        A8,
        /// 16 bits, G in the high byte: R = B, A = G (nv2a).
        G8B8,
    }
}

impl TextureFormat {
    /// Bytes of one texel.
    pub fn bytes(self) -> u32 {
        match self {
            TextureFormat::A8R8G8B8 | TextureFormat::X8R8G8B8 => 4,
            TextureFormat::R5G6B5 | TextureFormat::X1R5G5B5 | TextureFormat::A1R5G5B5 | TextureFormat::G8B8 => 2,
            TextureFormat::L8 | TextureFormat::A8 => 1,
        }
    }
}

named! {
    /// What happens to a texel index outside the image (TEX-7).
    pub enum AddressMode {
        /// i mod n.
        Wrap,
        /// Back and forth, the edge texel doubled.
        Mirror,
        /// 0..n-1.
        ClampToEdge,
        /// Outside reads the border colour (nv2a).
        ClampToBorder,
        /// OpenGL's clamp, taken as clamp to edge.
        Clamp,
    }
}
named! {
    /// Nearest or bilinear (TEX-5, TEX-6).
    pub enum Filter {
        /// One texel.
        Nearest,
        /// Four texels.
        Linear,
    }
}

/// A named image.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Name in the scene.
    pub name: String,
    /// Where the texels are.
    pub image: TextureImage,
}

/// Texels given, or the contents of a render target drawn before.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureImage {
    /// Raw texels, row by row from the top; one word a texel, unused high bits zero. Sides are powers of two.
    Texels {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Meaning of the words.
        format: TextureFormat,
        /// `width * height` raw texels; shared, because plans hold them too.
        words: Arc<[u32]>,
    },
    /// The words of a render target, read as `format` (of the same number of bytes).
    Target {
        /// Index into [`Scene::targets`](super::Scene::targets).
        target: usize,
        /// Meaning of the words.
        format: TextureFormat,
    },
}

/// A texture unit's state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUnit {
    /// Index into [`Scene::textures`](super::Scene::textures).
    pub texture: usize,
    /// Which of the vertex's four coordinate sets is used.
    pub coordinate_set: usize,
    /// Along s.
    pub address_s: AddressMode,
    /// Along t.
    pub address_t: AddressMode,
    /// Filter.
    pub filter: Filter,
    /// Border colour, R, G, B, A bytes (NUM-5).
    pub border_color: [u8; 4],
    /// Channels (R, G, B, A) read as two's complement (TEX-18; nv2a).
    pub signed: [bool; 4],
}
