//! Raster operations and the surfaces they write.

use super::{Rectangle, TextureFormat, named};
use std::sync::Arc;

named! {
    /// A comparison of two unsigned integers, incoming value on the left.
    pub enum CompareFunction {
        /// No value passes.
        Never,
        /// incoming < stored.
        Less,
        /// incoming = stored.
        Equal,
        /// incoming <= stored.
        LessOrEqual,
        /// incoming > stored.
        Greater,
        /// incoming != stored.
        NotEqual,
        /// incoming >= stored.
        GreaterOrEqual,
        /// Every value passes.
        Always,
    }
}

impl CompareFunction {
    /// Whether `incoming` passes against `stored`.
    pub fn passes<T: PartialOrd>(self, incoming: T, stored: T) -> bool {
        match self {
            CompareFunction::Never => false,
            CompareFunction::Less => incoming < stored,
            CompareFunction::Equal => incoming == stored,
            CompareFunction::LessOrEqual => incoming <= stored,
            CompareFunction::Greater => incoming > stored,
            CompareFunction::NotEqual => incoming != stored,
            CompareFunction::GreaterOrEqual => incoming >= stored,
            CompareFunction::Always => true,
        }
    }
}

named! {
    /// Blend equations (ROP-2, ROP-3). S and D are source and destination, s8 reads a byte as two's complement.
    pub enum BlendEquation {
        /// S Fs + D Fd.
        Add,
        /// S Fs - D Fd.
        Subtract,
        /// D Fd - S Fs.
        ReverseSubtract,
        /// min(S, D).
        Min,
        /// max(S, D).
        Max,
        /// D + s8(S) (nv2a).
        SignedAdd,
        /// D - s8(S) (nv2a).
        SignedReverseSubtract,
    }
}
named! {
    /// Blend factors (ROP-4).
    pub enum BlendFactor {
        /// 0.
        Zero,
        /// 255.
        One,
        /// The source's own channel.
        SourceColor,
        /// 255 - source colour.
        OneMinusSourceColor,
        /// The source's alpha.
        SourceAlpha,
        /// 255 - source alpha.
        OneMinusSourceAlpha,
        /// The destination's alpha.
        DestinationAlpha,
        /// 255 - destination alpha.
        OneMinusDestinationAlpha,
        /// The destination's own channel.
        DestinationColor,
        /// 255 - destination colour.
        OneMinusDestinationColor,
        /// min(source alpha, 255 - destination alpha) for colour, 255 for alpha.
        SourceAlphaSaturate,
        /// Blend constant's colour.
        ConstantColor,
        /// 255 - blend constant's colour.
        OneMinusConstantColor,
        /// Blend constant's alpha.
        ConstantAlpha,
        /// 255 - blend constant's alpha.
        OneMinusConstantAlpha,
    }
}

/// Alpha test (ROP-1): `function(fragment alpha, reference)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AlphaTest {
    /// How alpha, on the left, is compared.
    pub function: CompareFunction,
    /// What alpha is compared with, 0 to 255.
    pub reference: u8,
}

named! {
    /// What z of a vertex counts.
    pub enum VertexDepths {
        /// 0 is the nearest depth and 1 the farthest that a fixed-point buffer holds; a float buffer holds the number itself.
        Fractions,
        /// Steps of the buffer's last bit, not rounded; a float buffer holds the number itself. Only window positions have them.
        Steps,
    }
}

/// DEP-4: the depths that a draw may have, in steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    /// The lowest, finite.
    pub lowest: f32,
    /// The highest, finite and not below it.
    pub highest: f32,
    /// Whether what lies outside is moved to the nearer limit; it is dropped, pixel by pixel, otherwise.
    pub clamps: bool,
    /// Whether a triangle is dropped whose three vertices lie beyond the same limit.
    pub drops_triangles: bool,
}

/// DEP-5: what is added to the depths of a triangle, in steps. Finite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PolygonOffset {
    /// Added as it is.
    pub bias: f32,
    /// Times the steeper slope of the triangle, in steps a pixel.
    pub factor: f32,
}

/// Depth test (DEP-2): `function(fragment depth, stored depth)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthTest {
    /// How the fragment's depth, on the left, is compared.
    pub function: CompareFunction,
    /// Whether a passing fragment's depth is stored.
    pub write: bool,
    /// What z of a vertex counts.
    pub vertex_depths: VertexDepths,
    /// The range of depths; `None`: what the buffer holds, to which depths are limited.
    pub range: Option<DepthRange>,
    /// What is added to depths; in a w buffer a bias alone.
    pub offset: PolygonOffset,
    /// The buffer holds w, in its own steps, in place of z (DEP-6); limits of the range are of w, and triangles are dropped by z.
    pub w_buffer: bool,
}

impl DepthTest {
    /// A test of depths between 0 and 1, without an offset or a range.
    pub fn new(function: CompareFunction, write: bool) -> DepthTest {
        let (vertex_depths, range, offset) = (VertexDepths::Fractions, None, PolygonOffset::default());
        DepthTest { function, write, vertex_depths, range, offset, w_buffer: false }
    }

    /// Whether pixels are dropped for their depth before any test (DEP-4).
    pub fn drops_by_range(&self) -> bool {
        self.range.is_some_and(|range| !range.clamps)
    }
}

named! {
    /// What a stencil test stores (STN-1). S is what is stored, R the reference.
    pub enum StencilOperation {
        /// S.
        Keep,
        /// 0.
        Zero,
        /// R.
        Replace,
        /// min(S + 1, 255).
        IncrementSaturate,
        /// max(S - 1, 0).
        DecrementSaturate,
        /// 255 - S.
        Invert,
        /// S + 1, and 0 after 255.
        Increment,
        /// S - 1, and 255 after 0.
        Decrement,
    }
}

/// Stencil test (STN-1): `function(reference & mask, stored & mask)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilTest {
    /// How the reference, on the left, is compared.
    pub function: CompareFunction,
    /// R, 0 to 255: what the stencil is compared with.
    pub reference: u8,
    /// Bits that are compared.
    pub mask: u8,
    /// Bits that are written.
    pub write_mask: u8,
    /// What is stored where the stencil test fails.
    pub fail: StencilOperation,
    /// Where it passes and the depth test fails.
    pub depth_fail: StencilOperation,
    /// Where both pass; without a depth test that passes.
    pub pass: StencilOperation,
}

/// Window clip (CLP-1): pixels of a draw that are left out by rectangles.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WindowClip {
    /// One to [`WINDOW_CLIP_RECTANGLES`] of them; their right and bottom edges are outside.
    pub rectangles: Vec<Rectangle>,
    /// Pixels inside any rectangle are left out; otherwise those inside none are.
    pub exclusive: bool,
}

/// Rectangles that the window clip has.
pub const WINDOW_CLIP_RECTANGLES: usize = 8;

/// Blend function. Factors are ignored by Min, Max and the signed equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blend {
    /// How both products are combined.
    pub equation: BlendEquation,
    /// Factor of the source.
    pub source: BlendFactor,
    /// Factor of the destination.
    pub destination: BlendFactor,
}

named! {
    /// Colour surface formats (ROP-5). A trailing Z or O says what the unused bits are written with.
    pub enum SurfaceFormat {
        /// 32 bits, A in the top byte.
        A8R8G8B8,
        /// 32 bits, top byte written 0; destination alpha 255.
        X8R8G8B8Z,
        /// 32 bits, top byte written 255; destination alpha 255.
        X8R8G8B8O,
        /// 16 bits, truncated; destination alpha 255.
        R5G6B5,
        /// 16 bits, truncated, top bit written 0 (nv2a).
        X1R5G5B5Z,
        /// 16 bits, truncated, top bit written 1 (nv2a).
        X1R5G5B5O,
        /// 32 bits, seven bits of alpha, top bit written 0 (nv2a).
        X1A7R8G8B8Z,
        /// 32 bits, seven bits of alpha, top bit written 1 (nv2a).
        X1A7R8G8B8O,
        /// Blue byte only; blending is not allowed.
        B8,
        /// Blue and green bytes, green high; blending is not allowed (nv2a).
        G8B8,
    }
}

impl BlendEquation {
    /// Whether only nv2a has it.
    pub fn is_nv2a_only(self) -> bool {
        matches!(self, BlendEquation::SignedAdd | BlendEquation::SignedReverseSubtract)
    }
}

impl SurfaceFormat {
    /// Whether only nv2a has it.
    pub fn is_nv2a_only(self) -> bool {
        matches!(
            self,
            SurfaceFormat::X1R5G5B5Z
                | SurfaceFormat::X1R5G5B5O
                | SurfaceFormat::X1A7R8G8B8Z
                | SurfaceFormat::X1A7R8G8B8O
                | SurfaceFormat::G8B8
        )
    }

    /// Bytes of one pixel.
    pub fn bytes(self) -> u32 {
        match self {
            SurfaceFormat::R5G6B5 | SurfaceFormat::X1R5G5B5Z | SurfaceFormat::X1R5G5B5O | SurfaceFormat::G8B8 => 2,
            SurfaceFormat::B8 => 1,
            SurfaceFormat::A8R8G8B8
            | SurfaceFormat::X8R8G8B8Z
            | SurfaceFormat::X8R8G8B8O
            | SurfaceFormat::X1A7R8G8B8Z
            | SurfaceFormat::X1A7R8G8B8O => 4,
        }
    }

    /// The texture format that shows the surface as a picture: the same bits, read by TEX-1.
    pub fn texture_format(self) -> TextureFormat {
        match self {
            SurfaceFormat::A8R8G8B8 | SurfaceFormat::X1A7R8G8B8Z | SurfaceFormat::X1A7R8G8B8O => {
                TextureFormat::A8R8G8B8
            }
            SurfaceFormat::X8R8G8B8Z | SurfaceFormat::X8R8G8B8O => TextureFormat::X8R8G8B8,
            SurfaceFormat::R5G6B5 => TextureFormat::R5G6B5,
            SurfaceFormat::X1R5G5B5Z | SurfaceFormat::X1R5G5B5O => TextureFormat::X1R5G5B5,
            SurfaceFormat::B8 => TextureFormat::L8,
            SurfaceFormat::G8B8 => TextureFormat::G8B8,
        }
    }
}

named! {
    /// Depth buffer formats (DEP-2, DEP-3).
    pub enum DepthFormat {
        /// 16 bits of depth, no stencil.
        Z16,
        /// 24 bits of depth, eight of stencil.
        Z24S8,
        /// A float of 16 bits: four of exponent, twelve of fraction (nv2a).
        Z16F,
        /// A float of 24 bits, eight of exponent and sixteen of fraction, and eight bits of stencil (nv2a).
        Z24S8F,
    }
}

impl DepthFormat {
    /// Bits of depth.
    pub fn bits(self) -> u32 {
        match self {
            DepthFormat::Z16 | DepthFormat::Z16F => 16,
            DepthFormat::Z24S8 | DepthFormat::Z24S8F => 24,
        }
    }

    /// Whether its words are floats.
    #[inline(always)]
    pub fn is_float(self) -> bool {
        matches!(self, DepthFormat::Z16F | DepthFormat::Z24S8F)
    }

    /// Its largest word.
    #[inline(always)]
    pub fn largest(self) -> u32 {
        (1 << self.bits()) - 1
    }

    /// Whether it has a stencil byte.
    pub fn has_stencil(self) -> bool {
        matches!(self, DepthFormat::Z24S8 | DepthFormat::Z24S8F)
    }
}

/// A depth buffer and what it is cleared to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthBuffer {
    /// How depth and stencil are stored.
    pub format: DepthFormat,
    /// Integer written by the clear, below 2^bits.
    pub clear: u32,
    /// Stencil byte written by the clear; 0 where the format has none.
    pub clear_stencil: u8,
}

impl DepthBuffer {
    /// The cleared pixel as a surface holds it: the depth in the low 24 bits, the stencil above.
    pub fn cleared(&self) -> u32 {
        depth_stencil(self.clear, self.clear_stencil)
    }
}

/// A depth, of at most 24 bits, and a stencil as a surface holds them: the stencil above the depth.
#[inline(always)]
pub fn depth_stencil(depth: u32, stencil: u8) -> u32 {
    u32::from(stencil) << 24 | depth
}

/// The depth of such a word.
#[inline(always)]
pub fn depth_of(word: u32) -> u32 {
    word & 0x00ff_ffff
}

/// The stencil of such a word.
#[inline(always)]
pub fn stencil_of(word: u32) -> u8 {
    (word >> 24) as u8
}

/// A render target.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Name in the scene.
    pub name: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// How colours are stored.
    pub format: SurfaceFormat,
    /// R, G, B, A bytes; the clear stores them by the format's own rule.
    pub clear_color: [u8; 4],
    /// What the target holds before the first draw, in place of the cleared colour: a word a pixel, row by row from the top, with no bit above
    /// the format's. Bits that the format does not use are kept until a draw writes them.
    pub contents: Option<Arc<[u32]>>,
    /// Depth buffer, if there is one.
    pub depth: Option<DepthBuffer>,
    /// Surface clip (CLP-2): nothing is drawn outside. `None`: the whole target.
    pub clip: Option<Rectangle>,
}
