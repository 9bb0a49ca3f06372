//! Raster operations and the surfaces they write.

use super::{Rectangle, TextureFormat, named};
use std::sync::Arc;

named! {
    /// A comparison of two unsigned integers with the incoming value on the left.
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
    /// Returns whether `incoming` passes against `stored`.
    #[inline(always)]
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
    /// Blend equations (ROP-2, ROP-3). S and D are source and destination, Fs and Fd their factors; s8 reads a byte as
    /// two's complement.
    pub enum BlendEquation {
        /// S Fs + D Fd.
        Add,
        /// S Fs - D Fd.
        Subtract,
        /// D Fd - S Fs.
        ReverseSubtract,
        /// min(S, D), without the factors.
        Min,
        /// max(S, D), without the factors.
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
        /// 0 for all channels.
        Zero,
        /// 255 for all channels.
        One,
        /// The source's own channel.
        SourceColor,
        /// 255 - the source's own channel.
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
        /// 255 - the destination's own channel.
        OneMinusDestinationColor,
        /// min(source alpha, 255 - destination alpha) for colour, 255 for alpha.
        SourceAlphaSaturate,
        /// The colour of the blend constant.
        ConstantColor,
        /// 255 - colour of the blend constant.
        OneMinusConstantColor,
        /// The alpha of the blend constant.
        ConstantAlpha,
        /// 255 - alpha of the blend constant.
        OneMinusConstantAlpha,
    }
}

/// Alpha test (ROP-1): `function(fragment alpha, reference)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AlphaTest {
    /// The comparison, with the fragment's alpha on the left.
    pub function: CompareFunction,
    /// The reference that alpha is compared with, 0 to 255.
    pub reference: u8,
}

named! {
    /// The unit of a vertex's z.
    pub enum VertexDepths {
        /// Fractions from 0, the nearest depth, to 1, the farthest that a fixed-point buffer holds. A float buffer
        /// holds the number itself.
        Fractions,
        /// Steps of the buffer's last bit, not rounded. A float buffer holds the number itself. Only window positions
        /// can use steps.
        Steps,
    }
}

/// DEP-4: the range of depths that a draw may have, in steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange {
    /// Lowest depth, finite.
    pub lowest: f32,
    /// Highest depth, finite and not below `lowest`.
    pub highest: f32,
    /// Whether depths outside the range are clamped to it. Otherwise the pixels with such depths are dropped.
    pub clamps: bool,
    /// Whether a triangle is dropped if all its vertices lie beyond the same limit.
    pub drops_triangles: bool,
}

/// DEP-5: the offset of a triangle's depths, in steps. Both parts are finite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PolygonOffset {
    /// Constant part of the offset.
    pub bias: f32,
    /// Factor of the triangle's steeper slope, which is in steps per pixel.
    pub factor: f32,
}

/// Depth test (DEP-2): `function(fragment depth, stored depth)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthTest {
    /// The comparison, with the fragment's depth on the left.
    pub function: CompareFunction,
    /// Whether the depth of a passing fragment is stored.
    pub write: bool,
    /// The unit of the vertices' z.
    pub vertex_depths: VertexDepths,
    /// The range of depths. If `None`, depths are limited to what the buffer holds.
    pub range: Option<DepthRange>,
    /// The offset that is added to depths. For a w buffer only the bias is allowed.
    pub offset: PolygonOffset,
    /// Whether the buffer holds w in place of z, in its own steps (DEP-6). The limits of `range` then apply to w, but
    /// triangles are dropped by z.
    pub w_buffer: bool,
}

impl DepthTest {
    /// Returns a test of depths between 0 and 1, without an offset or a range.
    pub fn new(function: CompareFunction, write: bool) -> DepthTest {
        let (vertex_depths, range, offset) = (VertexDepths::Fractions, None, PolygonOffset::default());
        DepthTest { function, write, vertex_depths, range, offset, w_buffer: false }
    }

    /// Returns whether pixels are dropped for their depth before any test (DEP-4).
    pub fn drops_by_range(&self) -> bool {
        self.range.is_some_and(|range| !range.clamps)
    }
}

named! {
    /// What a stencil test stores (STN-1). S is the stored stencil, R the reference.
    pub enum StencilOperation {
        /// S: the stored value stays.
        Keep,
        /// 0: the value is cleared.
        Zero,
        /// R: the reference replaces the value.
        Replace,
        /// min(S + 1, 255).
        IncrementSaturate,
        /// max(S - 1, 0).
        DecrementSaturate,
        /// 255 - S.
        Invert,
        /// S + 1, wrapping from 255 to 0.
        Increment,
        /// S - 1, wrapping from 0 to 255.
        Decrement,
    }
}

/// Stencil test (STN-1): `function(reference & mask, stored & mask)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilTest {
    /// The comparison, with the reference on the left.
    pub function: CompareFunction,
    /// The reference R, 0 to 255, that the stencil is compared with.
    pub reference: u8,
    /// Mask of the bits that are compared.
    pub mask: u8,
    /// Mask of the bits that are written.
    pub write_mask: u8,
    /// Operation if the stencil test fails.
    pub fail: StencilOperation,
    /// Operation if the stencil test passes and the depth test fails.
    pub depth_fail: StencilOperation,
    /// Operation if both tests pass. A draw without a depth test passes it.
    pub pass: StencilOperation,
}

/// Window clip (CLP-1): rectangles that limit where a draw has pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WindowClip {
    /// One to [`WINDOW_CLIP_RECTANGLES`] rectangles. Their right and bottom edges are exclusive.
    pub rectangles: Vec<Rectangle>,
    /// Whether pixels inside of any rectangle are dropped. Otherwise pixels outside of all rectangles are.
    pub exclusive: bool,
}

/// Most rectangles that a window clip can have.
pub const WINDOW_CLIP_RECTANGLES: usize = 8;

/// Blend function. Min, Max and the signed equations ignore the factors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blend {
    /// How the two products are combined.
    pub equation: BlendEquation,
    /// Factor of the source.
    pub source: BlendFactor,
    /// Factor of the destination.
    pub destination: BlendFactor,
}

named! {
    /// Colour surface formats (ROP-5). A trailing Z or O says that the unused bits are written as zeros or ones.
    pub enum SurfaceFormat {
        /// 32 bits, A in the top byte.
        A8R8G8B8,
        /// 32 bits, top byte written as 0; destination alpha is 255.
        X8R8G8B8Z,
        /// 32 bits, top byte written as 255; destination alpha is 255.
        X8R8G8B8O,
        /// 16 bits, truncated; destination alpha is 255.
        R5G6B5,
        /// 16 bits, truncated, top bit written as 0 (nv2a).
        X1R5G5B5Z,
        /// 16 bits, truncated, top bit written as 1 (nv2a).
        X1R5G5B5O,
        /// 32 bits with seven bits of alpha, top bit written as 0 (nv2a).
        X1A7R8G8B8Z,
        /// 32 bits with seven bits of alpha, top bit written as 1 (nv2a).
        X1A7R8G8B8O,
        /// The blue byte only; blending is not allowed.
        B8,
        /// Blue in the low and green in the high byte; blending is not allowed (nv2a).
        G8B8,
    }
}

impl BlendEquation {
    /// Returns whether only nv2a has the equation.
    pub fn is_nv2a_only(self) -> bool {
        matches!(self, BlendEquation::SignedAdd | BlendEquation::SignedReverseSubtract)
    }
}

impl SurfaceFormat {
    /// Returns whether only nv2a has the format.
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

    /// Returns the bytes of one pixel.
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

    /// Returns the texture format that shows the surface as a picture: the same bits, read by TEX-1.
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

/// A buffer of a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Buffer {
    /// Colours.
    Color,
    /// Depths and stencils.
    Depth,
}

named! {
    /// Depth buffer formats (DEP-2, DEP-3).
    pub enum DepthFormat {
        /// 16 bits of depth, no stencil.
        Z16,
        /// 24 bits of depth and eight of stencil.
        Z24S8,
        /// A float depth of 16 bits: four of exponent, twelve of fraction (nv2a).
        Z16F,
        /// A float depth of 24 bits, eight of exponent and sixteen of fraction, with eight bits of stencil (nv2a).
        Z24S8F,
    }
}

impl DepthFormat {
    /// Returns the texture format whose texels are these words.
    pub fn texture_format(self) -> TextureFormat {
        match self {
            DepthFormat::Z16 => TextureFormat::Z16,
            DepthFormat::Z24S8 => TextureFormat::Z24S8,
            DepthFormat::Z16F => TextureFormat::Z16F,
            DepthFormat::Z24S8F => TextureFormat::Z24S8F,
        }
    }

    /// Returns the bits of a stored word: depth and stencil.
    pub fn stored_bits(self) -> u32 {
        if self.has_stencil() { 32 } else { self.bits() }
    }

    /// Returns the bits of depth.
    pub fn bits(self) -> u32 {
        match self {
            DepthFormat::Z16 | DepthFormat::Z16F => 16,
            DepthFormat::Z24S8 | DepthFormat::Z24S8F => 24,
        }
    }

    /// Returns whether depths are floats.
    #[inline(always)]
    pub fn is_float(self) -> bool {
        matches!(self, DepthFormat::Z16F | DepthFormat::Z24S8F)
    }

    /// Returns the largest depth word.
    #[inline(always)]
    pub fn largest(self) -> u32 {
        (1 << self.bits()) - 1
    }

    /// Returns whether the format has a stencil byte.
    pub fn has_stencil(self) -> bool {
        matches!(self, DepthFormat::Z24S8 | DepthFormat::Z24S8F)
    }
}

/// A depth buffer and its clear values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthBuffer {
    /// How depth and stencil are stored.
    pub format: DepthFormat,
    /// Depth word that the clear writes, below 2^bits.
    pub clear: u32,
    /// Stencil byte that the clear writes. It is 0 if the format has no stencil.
    pub clear_stencil: u8,
}

impl DepthBuffer {
    /// Returns the cleared pixel as a surface holds it: the depth in the low 24 bits, the stencil above.
    pub fn cleared(&self) -> u32 {
        depth_stencil(self.clear, self.clear_stencil)
    }
}

/// Packs a depth of at most 24 bits and a stencil as a surface holds them, with the stencil above the depth.
#[inline(always)]
pub fn depth_stencil(depth: u32, stencil: u8) -> u32 {
    u32::from(stencil) << 24 | depth
}

/// Returns the depth of a word packed by [`depth_stencil`].
#[inline(always)]
pub fn depth_of(word: u32) -> u32 {
    word & 0x00ff_ffff
}

/// Returns the stencil of a word packed by [`depth_stencil`].
#[inline(always)]
pub fn stencil_of(word: u32) -> u8 {
    (word >> 24) as u8
}

/// A render target.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Name that the scene, messages and outputs use.
    pub name: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// How colours are stored.
    pub format: SurfaceFormat,
    /// Clear colour as R, G, B, A bytes, which the clear stores by the rule of the format.
    pub clear_color: [u8; 4],
    /// Contents before the first draw, in place of the cleared colour: one word for each pixel, row by row from the
    /// top, with no bit set above those of the format. Bits that the format does not use are kept until a draw writes
    /// the pixel.
    pub contents: Option<Arc<[u32]>>,
    /// Depth buffer, if the target has one.
    pub depth: Option<DepthBuffer>,
    /// Contents of the depth buffer before the first draw, in place of what the clear stores: one word for each pixel, as
    /// [`depth_stencil`] packs it. Nothing without a depth buffer.
    pub depth_contents: Option<Arc<[u32]>>,
    /// Surface clip (CLP-2): nothing is drawn outside. `None` means the whole target.
    pub clip: Option<Rectangle>,
}
