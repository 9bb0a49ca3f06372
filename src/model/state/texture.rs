//! Texture images, and the units that sample them.

mod format;

pub use format::TextureFormat;

use super::{CompareFunction, Profile, named};
use std::sync::Arc;

/// Number of texture units in the state. NV10 has the first two.
pub const TEXTURE_UNITS: usize = 4;

/// Number of border texels that a texture stores beyond each edge, if it has border texels (TEX-7).
pub const BORDER_TEXELS: u32 = 4;

/// Longest side of a volume texture, and its largest number of layers.
pub const LARGEST_VOLUME: u32 = 512;

/// Number of faces of a cube map, in the order +X, -X, +Y, -Y, +Z, -Z (TEX-12).
pub const CUBE_FACES: u32 = 6;

named! {
    /// How a texture is addressed.
    pub enum TextureKind {
        /// Two coordinates, where 1.0 spans the whole texture. Sides are powers of two.
        TwoDimensional,
        /// Six square faces, chosen by a direction (TEX-12).
        Cube,
        /// Two coordinates in texels. Sides are arbitrary, and there is one level (the chip's linear layouts).
        Rectangle,
        /// A volume: a third coordinate, where 1.0 spans all layers, chooses the layer. Sides and the number of layers
        /// are powers of two, and there is one level (VOL-1; nv2a).
        ThreeDimensional,
    }
}

impl TextureKind {
    /// Returns the longest side that the chip accepts, in texels.
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
    /// What happens to a texel index outside the image (TEX-7). i is the index and n the number of texels.
    pub enum AddressMode {
        /// i mod n.
        Wrap,
        /// Repeats back and forth; the edge texel occurs twice.
        Mirror,
        /// i limited to 0..n-1.
        ClampToEdge,
        /// Texels outside are the border colour, or the texture's own border texels (nv2a).
        ClampToBorder,
        /// OpenGL's clamp, which behaves as clamp to edge.
        Clamp,
    }
}
named! {
    /// Filter within a level: nearest or bilinear (TEX-5, TEX-6).
    pub enum Filter {
        /// One texel is read.
        Nearest,
        /// Four texels are read and interpolated.
        Linear,
    }
}
named! {
    /// How levels are chosen when a texture is minified (TEX-9).
    pub enum MipFilter {
        /// Only level 0 is read.
        None,
        /// The nearest level is read.
        Nearest,
        /// Two levels are read and interpolated.
        Linear,
    }
}

/// A named texture image.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Name that the scene and messages use.
    pub name: String,
    /// How the texture is addressed.
    pub kind: TextureKind,
    /// How its words encode colours or depths.
    pub format: TextureFormat,
    /// The texels, or the render target that holds them.
    pub image: TextureImage,
}

impl Texture {
    /// Returns a two-dimensional texture named `texture`, of one level without a border, from its [words](Texels::words). `size` is in texels.
    ///
    /// [`Plan::compile`](crate::plan::Plan::compile) refuses a size that the chip cannot address, and words that are too few or too many.
    pub fn from_words(format: TextureFormat, size: [u32; 2], words: impl Into<Arc<[u32]>>) -> Texture {
        let [width, height] = size;
        let texels = Texels { width, height, levels: 1, layers: 1, border: false, words: words.into() };
        let (kind, image) = (TextureKind::TwoDimensional, TextureImage::Texels(texels));
        Texture { name: "texture".into(), kind, format, image }
    }
}

/// The texels of a texture: given by the scene, or the contents of an earlier render target.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureImage {
    /// Texels that the scene provides.
    Texels(Texels),
    /// The colour words of a render target, which have as many bytes as the texture's format. There is one level.
    Target {
        /// Index into [`Scene::targets`](super::Scene::targets).
        target: usize,
    },
    /// The depth buffer of a render target, read in a depth format of as many bytes. There is one level.
    Depth {
        /// Index into [`Scene::targets`](super::Scene::targets).
        target: usize,
    },
}

impl TextureImage {
    /// Returns the index of the render target whose colours or depths it shows, if it shows one.
    pub fn target(&self) -> Option<usize> {
        match self {
            TextureImage::Texels(_) => None,
            TextureImage::Target { target } | TextureImage::Depth { target } => Some(*target),
        }
    }
}

/// Raw texels of all faces, layers and levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Texels {
    /// Columns of level 0, without border texels.
    pub width: u32,
    /// Rows of level 0, without border texels.
    pub height: u32,
    /// Number of levels, at least 1. Each level has half the sides of the one before, rounded down, but at least 1.
    pub levels: u32,
    /// Number of layers of a volume; 1 for all other kinds.
    pub layers: u32,
    /// Whether each level stores [`BORDER_TEXELS`] more texels beyond each of its edges.
    pub border: bool,
    /// The words: face after face (one, the six of a cube map, or the layers of a volume), within it level after level,
    /// within that row after row from the top. Each texel is one word whose unused high bits are zero; a depth is
    /// packed as by [`depth_stencil`](super::depth_stencil). A compressed block is two (DXT1) or four little-endian
    /// words, and blocks are stored row after row. Shared, because plans hold them too.
    pub words: Arc<[u32]>,
}

/// The place of one level of one face in [`Texels::words`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    /// Index of the level's first word, counted from the start of its face.
    pub offset: usize,
    /// Columns, without border texels.
    pub width: u32,
    /// Rows, without border texels.
    pub height: u32,
}

impl Level {
    /// Returns the most levels that a texture of these sides can have, down to 1 x 1.
    pub fn most(width: u32, height: u32) -> u32 {
        width.max(height).max(1).ilog2() + 1
    }

    /// Returns all levels of one face, starting at level 0, and the number of words of one face.
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

/// The colours that the texels of [`TextureFormat::P8`] index.
#[derive(Clone, Debug, PartialEq)]
pub struct Palette {
    /// Name that the scene and messages use.
    pub name: String,
    /// 32, 64, 128 or 256 words in the format A8R8G8B8.
    pub entries: Arc<[u32]>,
}

impl Palette {
    /// The numbers of entries that a palette can have. The scene format allows only the longest on nv10 (NB0332).
    /// Indices are masked to the length.
    pub const LENGTHS: [usize; 4] = [32, 64, 128, 256];
}

named! {
    /// What happens to a texel that equals the colour key (KEY-1).
    pub enum ColorKeyMode {
        /// The texel's alpha becomes 0.
        Alpha,
        /// All channels of the texel become 0.
        Color,
        /// The fragment is dropped, even if nothing reads the unit.
        Texel,
    }
}

/// A colour key (KEY-1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColorKey {
    /// The colour that texels are compared with, as R, G, B, A bytes. A is ignored if the format has no alpha.
    pub color: [u8; 4],
    /// What happens to texels that are equal.
    pub mode: ColorKeyMode,
}

/// The comparison of a depth that a unit fetches (SHD-1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShadowComparison {
    /// The comparison, with the reference on the left and the texel on the right. The chip has one for all units.
    pub function: CompareFunction,
    /// The reference that texels are compared with.
    pub reference: ShadowReference,
}

named! {
    /// The reference of a shadow comparison (SHD-1).
    pub enum ShadowReference {
        /// r/q, if the stage projects in three dimensions.
        R,
        /// 0, if the stage projects in two dimensions.
        Zero,
    }
}

/// Returns the most taps that a unit of this profile can take along an axis of anisotropy (TEX-17).
pub fn largest_anisotropy(profile: Profile) -> u32 {
    match profile {
        Profile::Nv10 => 2,
        Profile::Nv2a => 8,
    }
}

/// State of a texture unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUnit {
    /// The bound texture, as an index into [`Scene::textures`](super::Scene::textures).
    pub texture: usize,
    /// The palette, as an index into [`Scene::palettes`](super::Scene::palettes). Present if the texture's format is
    /// [`TextureFormat::P8`].
    pub palette: Option<usize>,
    /// Address mode along s. Cube maps ignore it (TEX-14).
    pub address_s: AddressMode,
    /// Address mode along t. Cube maps ignore it (TEX-14).
    pub address_t: AddressMode,
    /// Address mode along the layers of a volume.
    pub address_r: AddressMode,
    /// Filter within a level if the texture is minified (lod > 0).
    pub min_filter: Filter,
    /// Filter if the texture is magnified (lod <= 0).
    pub mag_filter: Filter,
    /// How levels are chosen if the texture is minified.
    pub mip_filter: MipFilter,
    /// Bias that is added to the lod: signed 5.8 fixed point, -4096..=4095 (TEX-9).
    pub lod_bias: i32,
    /// Smallest lod: unsigned 4.8 fixed point, 0..=4095.
    pub min_lod: i32,
    /// Largest lod: unsigned 4.8 fixed point, 0..=4095.
    pub max_lod: i32,
    /// Border colour as R, G, B, A bytes (NUM-5).
    pub border_color: [u8; 4],
    /// Whether R, G, B and A are read as two's complement (TEX-18; nv2a).
    pub signed: [bool; 4],
    /// Colour key. A unit with one must use nearest filters (KEY-1).
    pub color_key: Option<ColorKey>,
    /// Largest ratio of a footprint's length to its width: 1, 2, 4 or 8 (TEX-17). Above 1, levels are not interpolated.
    pub anisotropy: u32,
    /// Whether s and t of the vertices are interpolated along the shorter way around (CYL-1). Only for 2D textures that
    /// are not projected.
    pub cylindrical_wrap: [bool; 2],
    /// Comparison of depths. Present if the texture's format holds depths, which are fetched with nearest filters
    /// (SHD-1).
    pub shadow: Option<ShadowComparison>,
}

impl TextureUnit {
    /// Returns whether a texel can drop the fragment (KEY-1).
    pub fn kills(&self) -> bool {
        self.color_key.is_some_and(|key| key.mode == ColorKeyMode::Texel)
    }

    /// Returns whether the unit reads single texels of one level, without interpolation.
    pub fn is_nearest(&self) -> bool {
        (self.min_filter, self.mag_filter) == (Filter::Nearest, Filter::Nearest) && self.mip_filter != MipFilter::Linear
    }

    /// Returns the default state of a unit: wraps, bilinear without levels, no bias, all lods, unsigned channels.
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
