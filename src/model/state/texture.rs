//! Texture images and the units that sample them.

use super::{CompareFunction, DepthFormat, Profile, named};
use std::sync::Arc;

/// Number of texture units in the state. NV10 has the first two.
pub const TEXTURE_UNITS: usize = 4;

/// Texels that a texture with border texels stores beyond each edge (TEX-7).
pub const BORDER_TEXELS: u32 = 4;

/// The longest side of a volume, and the most layers.
pub const LARGEST_VOLUME: u32 = 512;

/// Faces of a cube map, in the order +X, -X, +Y, -Y, +Z, -Z (TEX-12).
pub const CUBE_FACES: u32 = 6;

named! {
    /// What a texture is sampled as.
    pub enum TextureKind {
        /// Two coordinates, 1.0 the whole texture; sides are powers of two.
        TwoDimensional,
        /// Six square faces, chosen by a direction (TEX-12).
        Cube,
        /// Two coordinates in texels; any sides, one level (the chip's linear layouts).
        Rectangle,
        /// Layers that a third coordinate chooses from, 1.0 all of them; sides and layers are powers of two, one level (VOL-1; nv2a).
        ThreeDimensional,
    }
}

impl TextureKind {
    /// The longest side that the chip takes.
    pub fn largest_side(self, format: TextureFormat, profile: Profile) -> u32 {
        let large = matches!(
            format,
            TextureFormat::A8R8G8B8
                | TextureFormat::X8R8G8B8
                | TextureFormat::P8
                | TextureFormat::Dxt3
                | TextureFormat::Dxt5
        );
        match (profile, self) {
            (_, TextureKind::ThreeDimensional) => LARGEST_VOLUME,
            (Profile::Nv2a, _) => 4096,
            (Profile::Nv10, TextureKind::TwoDimensional) => 2048,
            (Profile::Nv10, TextureKind::Rectangle) => 2047,
            (Profile::Nv10, TextureKind::Cube) => {
                if large {
                    512
                } else {
                    1024
                }
            }
        }
    }
}

named! {
    /// How the bits of a texel become R, G, B, A (TEX-1 to TEX-4).
    pub enum TextureFormat {
        /// 32 bits, A in the top byte.
        A8R8G8B8,
        /// 32 bits, top byte ignored, alpha 255.
        X8R8G8B8,
        /// 32 bits, A in the top byte, then B, G, R (nv2a).
        A8B8G8R8,
        /// 32 bits, B in the top byte, then G, R, A (nv2a).
        B8G8R8A8,
        /// 32 bits, R in the top byte, then G, B, A (nv2a).
        R8G8B8A8,
        /// 16 bits, alpha 255.
        R5G6B5,
        /// 16 bits: 6, 5, 5; alpha 255 (nv2a).
        R6G5B5,
        /// 16 bits, top bit ignored, alpha 255.
        X1R5G5B5,
        /// 16 bits, the top bit is alpha: 0 or 255.
        A1R5G5B5,
        /// 16 bits, 4 a channel.
        A4R4G4B4,
        /// Luminance byte: L, L, L, 255.
        L8,
        /// Intensity byte (the Xbox's AY8): L, L, L, L.
        I8,
        /// Alpha byte: 255, 255, 255, A.
        A8,
        /// 16 bits, A in the high byte: L, L, L, A (nv2a).
        A8L8,
        /// 16 bits, G in the high byte: R = B, A = G (nv2a).
        G8B8,
        /// 16 bits, R in the high byte: G = B, A = R (nv2a).
        R8B8,
        /// Two halves of 16 bits, filtered at 16 bits, read as the bytes of A8R8G8B8 (nv2a; HILO).
        R16B16,
        /// 16 bits, filtered at 16 bits: R 255, G the high byte, B the low byte, A 255 (nv2a).
        Y16,
        /// A byte that is looked up in the unit's palette, index masked to its length.
        P8,
        /// Blocks of 4 x 4 texels in 8 bytes; dithered on nv2a (TEX-3, TEX-4).
        Dxt1 = "DXT1",
        /// Blocks of 4 x 4 texels in 16 bytes, 4 bits of alpha each.
        Dxt3 = "DXT3",
        /// Blocks of 4 x 4 texels in 16 bytes, alpha between two bytes.
        Dxt5 = "DXT5",
        /// A depth of 16 bits, which is compared (SHD-1; nv2a).
        Z16,
        /// A depth of 24 bits above eight bits that are ignored, likewise.
        Z24S8,
        /// A depth of 16 bits, a float, likewise.
        Z16F,
        /// A depth of 24 bits, a float, above eight bits that are ignored, likewise.
        Z24S8F,
    }
}

impl TextureFormat {
    /// Whether texels have an alpha of their own.
    pub fn has_alpha(self) -> bool {
        !matches!(
            self,
            TextureFormat::X8R8G8B8
                | TextureFormat::R5G6B5
                | TextureFormat::R6G5B5
                | TextureFormat::X1R5G5B5
                | TextureFormat::L8
                | TextureFormat::Y16
        ) && self.depth().is_none()
    }

    /// The format of the depths that it holds, if it holds depths: a unit compares them (SHD-1).
    #[inline(always)]
    pub fn depth(self) -> Option<DepthFormat> {
        match self {
            TextureFormat::Z16 => Some(DepthFormat::Z16),
            TextureFormat::Z24S8 => Some(DepthFormat::Z24S8),
            TextureFormat::Z16F => Some(DepthFormat::Z16F),
            TextureFormat::Z24S8F => Some(DepthFormat::Z24S8F),
            _ => None,
        }
    }

    /// Bytes of one texel, or of one block of a compressed format.
    pub fn bytes(self) -> u32 {
        match self {
            TextureFormat::Dxt3 | TextureFormat::Dxt5 => 16,
            TextureFormat::Dxt1 => 8,
            TextureFormat::A8R8G8B8
            | TextureFormat::X8R8G8B8
            | TextureFormat::A8B8G8R8
            | TextureFormat::B8G8R8A8
            | TextureFormat::R8G8B8A8
            | TextureFormat::R16B16
            | TextureFormat::Z24S8
            | TextureFormat::Z24S8F => 4,
            TextureFormat::R5G6B5
            | TextureFormat::R6G5B5
            | TextureFormat::X1R5G5B5
            | TextureFormat::A1R5G5B5
            | TextureFormat::A4R4G4B4
            | TextureFormat::A8L8
            | TextureFormat::G8B8
            | TextureFormat::R8B8
            | TextureFormat::Y16
            | TextureFormat::Z16
            | TextureFormat::Z16F => 2,
            TextureFormat::L8 | TextureFormat::I8 | TextureFormat::A8 | TextureFormat::P8 => 1,
        }
    }

    /// Whether texels come in blocks of 4 x 4.
    pub fn is_compressed(self) -> bool {
        matches!(self, TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5)
    }

    /// Whether only nv2a has it.
    pub fn is_nv2a_only(self) -> bool {
        matches!(
            self,
            TextureFormat::A8B8G8R8
                | TextureFormat::B8G8R8A8
                | TextureFormat::R8G8B8A8
                | TextureFormat::R6G5B5
                | TextureFormat::A8L8
                | TextureFormat::G8B8
                | TextureFormat::R8B8
                | TextureFormat::R16B16
                | TextureFormat::Y16
        ) || self.depth().is_some()
    }

    /// Whether the chip has a linear layout of it, which rectangle textures need.
    pub fn is_linear(self, profile: Profile) -> bool {
        match profile {
            Profile::Nv2a => self != TextureFormat::P8 && !self.is_compressed(),
            Profile::Nv10 => matches!(
                self,
                TextureFormat::A1R5G5B5 | TextureFormat::R5G6B5 | TextureFormat::A8R8G8B8 | TextureFormat::I8
            ),
        }
    }

    /// Words that a level of so many texels takes: one a texel, whatever its size; two (DXT1) or four a block.
    pub fn words(self, width: u32, height: u32) -> usize {
        if self.is_compressed() {
            (self.bytes() / 4 * width.div_ceil(4) * height.div_ceil(4)) as usize
        } else {
            width as usize * height as usize
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
        /// Outside reads the border: the border colour, or the texture's own border texels (nv2a).
        ClampToBorder,
        /// OpenGL's clamp, taken as clamp to edge.
        Clamp,
    }
}
named! {
    /// Nearest or bilinear (TEX-5, TEX-6).
    pub enum Filter {
        /// One texel is read.
        Nearest,
        /// Four texels are read and mixed.
        Linear,
    }
}
named! {
    /// Which levels are mixed when a texture is minified (TEX-9).
    pub enum MipFilter {
        /// Level 0 only.
        None,
        /// The nearest level.
        Nearest,
        /// Two levels are read and mixed.
        Linear,
    }
}

/// A named image.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Name in the scene.
    pub name: String,
    /// What it is sampled as.
    pub kind: TextureKind,
    /// Meaning of its words.
    pub format: TextureFormat,
    /// The texels, or the surface that holds them.
    pub image: TextureImage,
}

/// Texels given, or the contents of a render target drawn before.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureImage {
    /// Texels that the scene brings.
    Texels(Texels),
    /// The words of a render target, of as many bytes as the format has; one level.
    Target {
        /// Index into [`Scene::targets`](super::Scene::targets).
        target: usize,
    },
    /// The depth buffer of a render target, read in a format of depths of as many bytes; one level.
    Depth {
        /// Index into [`Scene::targets`](super::Scene::targets).
        target: usize,
    },
}

impl TextureImage {
    /// The target whose colours or depths it shows.
    pub fn target(&self) -> Option<usize> {
        match self {
            TextureImage::Texels(_) => None,
            TextureImage::Target { target } | TextureImage::Depth { target } => Some(*target),
        }
    }
}

/// Raw texels of all faces and levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Texels {
    /// Columns of level 0, border texels not counted.
    pub width: u32,
    /// Rows of level 0.
    pub height: u32,
    /// Levels, at least 1. Sides halve from level to level, rounded down, at least 1.
    pub levels: u32,
    /// Layers of a volume; of other kinds 1.
    pub layers: u32,
    /// Each level stores [`BORDER_TEXELS`] more texels beyond each of its edges.
    pub border: bool,
    /// The words: face after face (one, six of a cube map, or a volume's layers), in it level after level, in it row after row from the top. One word a
    /// texel, unused high bits zero; of depths as [`depth_stencil`](super::depth_stencil) has them; a compressed block is 2 (DXT1) or 4 words, little-endian, row of blocks after row of blocks.
    /// Shared, because plans hold them too.
    pub words: Arc<[u32]>,
}

/// Where one level of one face lies in [`Texels::words`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    /// Index of its first word.
    pub offset: usize,
    /// Columns, border texels not counted.
    pub width: u32,
    /// Texels down.
    pub height: u32,
}

impl Level {
    /// How many levels a texture of these sides can have: down to 1 x 1.
    pub fn most(width: u32, height: u32) -> u32 {
        width.max(height).max(1).ilog2() + 1
    }

    /// All levels of one face, level 0 first, and the words of one face.
    pub fn chain(format: TextureFormat, width: u32, height: u32, levels: u32, border: bool) -> (Vec<Level>, usize) {
        let beyond = if border { 2 * BORDER_TEXELS } else { 0 };
        let mut offset = 0;
        let levels = (0..levels)
            .map(|n| {
                let (width, height) = ((width >> n).max(1), (height >> n).max(1));
                let level = Level { offset, width, height };
                offset += format.words(width + beyond, height + beyond);
                level
            })
            .collect();
        (levels, offset)
    }
}

/// Colours that texels of [`TextureFormat::P8`] stand for.
#[derive(Clone, Debug, PartialEq)]
pub struct Palette {
    /// Name in the scene.
    pub name: String,
    /// 32, 64, 128 or 256 words, A8R8G8B8.
    pub entries: Arc<[u32]>,
}

impl Palette {
    /// The numbers of entries that a palette can have. nv10 has the longest only, which the scene format says (NB0332); an index is masked to any of them.
    pub const LENGTHS: [usize; 4] = [32, 64, 128, 256];
}

named! {
    /// What a texel that equals the colour key becomes (KEY-1).
    pub enum ColorKeyMode {
        /// Its alpha is 0.
        Alpha,
        /// All of its channels are 0.
        Color,
        /// Nothing: the fragment is dropped, whether or not anything reads the unit.
        Texel,
    }
}

/// A colour key (KEY-1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColorKey {
    /// The colour that texels are compared with, R, G, B, A bytes; without A where the format has none.
    pub color: [u8; 4],
    /// What those that are equal become.
    pub mode: ColorKeyMode,
}

/// What a depth that a unit fetches is compared with (SHD-1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShadowComparison {
    /// The reference stands on its left, the texel on its right. The chip has one for all units.
    pub function: CompareFunction,
    /// What texels are compared with.
    pub reference: ShadowReference,
}

named! {
    /// The reference of a comparison (SHD-1).
    pub enum ShadowReference {
        /// r/q: the stage projects in three dimensions.
        R,
        /// 0: the stage projects in two.
        Zero,
    }
}

/// Most taps that anisotropy can ask for along an axis of the screen (TEX-17), by profile.
pub fn largest_anisotropy(profile: Profile) -> u32 {
    match profile {
        Profile::Nv10 => 2,
        Profile::Nv2a => 8,
    }
}

/// A texture unit's state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUnit {
    /// Index into [`Scene::textures`](super::Scene::textures).
    pub texture: usize,
    /// Index into [`Scene::palettes`](super::Scene::palettes); given where the texture's format is [`TextureFormat::P8`].
    pub palette: Option<usize>,
    /// Along s. Cube maps ignore it (TEX-14).
    pub address_s: AddressMode,
    /// How t addresses texels outside the image.
    pub address_t: AddressMode,
    /// Along the layers of a volume.
    pub address_r: AddressMode,
    /// Filter within a level where the texture is minified (lod > 0).
    pub min_filter: Filter,
    /// Filter where it is magnified (lod <= 0).
    pub mag_filter: Filter,
    /// Levels where it is minified.
    pub mip_filter: MipFilter,
    /// Added to the lod: signed 5.8, -4096..=4095 (TEX-9).
    pub lod_bias: i32,
    /// Least lod, unsigned 4.8, 0..=4095.
    pub min_lod: i32,
    /// Greatest lod, unsigned 4.8, 0..=4095.
    pub max_lod: i32,
    /// Border colour, R, G, B, A bytes (NUM-5).
    pub border_color: [u8; 4],
    /// Channels (R, G, B, A) read as two's complement (TEX-18; nv2a).
    pub signed: [bool; 4],
    /// Colour key; the unit's filters are then nearest (KEY-1).
    pub color_key: Option<ColorKey>,
    /// How long a footprint may be compared with its width: 1, 2, 4 or 8 (TEX-17). Levels are then not mixed.
    pub anisotropy: u32,
    /// Along s and t the vertices' coordinates go the shorter way around (CYL-1). Of 2D textures that are not projected.
    pub cylindrical_wrap: [bool; 2],
    /// What depths are compared with; given where the texture's format is one of depths, whose filters are nearest (SHD-1).
    pub shadow: Option<ShadowComparison>,
}

impl TextureUnit {
    /// Whether a texel can drop the fragment (KEY-1).
    pub fn kills(&self) -> bool {
        self.color_key.is_some_and(|key| key.mode == ColorKeyMode::Texel)
    }

    /// Whether the unit reads texels as they are, one at a time, from one level.
    pub fn is_nearest(&self) -> bool {
        (self.min_filter, self.mag_filter) == (Filter::Nearest, Filter::Nearest) && self.mip_filter != MipFilter::Linear
    }

    /// The unit as it is unless a scene says otherwise: wraps, bilinear without levels, no bias, all lods, nothing signed.
    pub fn new(texture: usize) -> TextureUnit {
        TextureUnit {
            texture,
            palette: None,
            address_s: AddressMode::Wrap,
            address_t: AddressMode::Wrap,
            address_r: AddressMode::Wrap,
            min_filter: Filter::Linear,
            mag_filter: Filter::Linear,
            mip_filter: MipFilter::None,
            lod_bias: 0,
            min_lod: 0,
            max_lod: 4095,
            border_color: [0; 4],
            signed: [false; 4],
            color_key: None,
            anisotropy: 1,
            cylindrical_wrap: [false; 2],
            shadow: None,
        }
    }
}
