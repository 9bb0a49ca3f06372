//! Words of texture units, the texture shader, fog, and of depth and stencil, as the NV20 class writes them: methods, codes and fields. Names and
//! numbers are those of nxdk's headers, in lower case.

use super::layout::Field;
use ninebit::state::{
    AddressMode, ColorKeyMode, CompareFunction, DotMapping, Filter, FogMode, MipFilter, Named, StencilOperation,
    TextureFormat,
};

/// Words of the state: elements of one or more words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Words {
    /// Name of the method.
    pub name: &'static str,
    /// Method of the first word.
    pub method: u32,
    /// Number of elements, and the bytes from one to the next.
    pub elements: (usize, u32),
    /// Number of words of an element, which follow one another.
    pub words: usize,
}

impl Words {
    const fn one(name: &'static str, method: u32) -> Words {
        Words { name, method, elements: (1, 4), words: 1 }
    }

    const fn some(name: &'static str, method: u32, count: usize) -> Words {
        Words { elements: (count, 4), ..Words::one(name, method) }
    }

    const fn of_units(name: &'static str, method: u32, words: usize) -> Words {
        Words { name, method, elements: (4, 64), words }
    }
}

/// The words that a pixel reads beside those of the combiners and of [blending](super::raster).
pub const WORDS: [Words; 36] = [
    Words::one("control0", 0x290),
    Words::one("fog_mode", 0x29c),
    Words::one("fog_enable", 0x2a4),
    Words::one("fog_color", 0x2a8),
    Words::one("depth_test_enable", 0x30c),
    Words::one("point_smooth_enable", 0x31c),
    Words::one("stencil_test_enable", 0x32c),
    Words::one("depth_func", 0x354),
    Words::one("depth_mask", 0x35c),
    Words::one("stencil_mask", 0x360),
    Words::one("stencil_func", 0x364),
    Words::one("stencil_func_ref", 0x368),
    Words::one("stencil_func_mask", 0x36c),
    Words::one("stencil_op_fail", 0x370),
    Words::one("stencil_op_zfail", 0x374),
    Words::one("stencil_op_zpass", 0x378),
    Words::one("clip_min", 0x394),
    Words::one("clip_max", 0x398),
    Words::some("fog_params", 0x9c0, 3),
    Words::some("color_key_color", 0xae0, 4),
    Words::one("shader_clip_plane_mode", 0x17f8),
    Words::some("eye_vector", 0x181c, 3),
    Words::of_units("texture_format", 0x1b04, 1),
    Words::of_units("texture_address", 0x1b08, 1),
    Words::of_units("texture_control0", 0x1b0c, 1),
    Words::of_units("texture_filter", 0x1b14, 1),
    Words::of_units("texture_image_rect", 0x1b1c, 1),
    Words::of_units("texture_border_color", 0x1b24, 1),
    Words::of_units("texture_set_bump_env_mat", 0x1b28, 4),
    Words::of_units("texture_set_bump_env_scale", 0x1b38, 1),
    Words::of_units("texture_set_bump_env_offset", 0x1b3c, 1),
    Words::one("zmin_max_control", 0x1d78),
    Words::one("shadow_compare_func", 0x1e6c),
    Words::one("shader_stage_program", 0x1e70),
    Words::one("dot_rgbmapping", 0x1e74),
    Words::one("shader_other_stage_input", 0x1e78),
];

/// Fields of `texture_format`: whether the image is a cube map, whether what lies outside is the border colour, dimensions, code of the format, and
/// levels.
pub const CUBE: Field = Field::new(2, 1);
/// See [`CUBE`].
pub const BORDER_COLOR: Field = Field::new(3, 1);
/// See [`CUBE`].
pub const DIMENSIONS: Field = Field::new(4, 4);
/// See [`CUBE`].
pub const FORMAT: Field = Field::new(8, 8);
/// See [`CUBE`].
pub const LEVELS: Field = Field::new(16, 4);
/// Fields of `texture_format`: binary logarithms of columns, rows and layers.
pub const SIZES: [Field; 3] = [Field::new(20, 4), Field::new(24, 4), Field::new(28, 4)];
/// Fields of `texture_image_rect`: columns and rows of a rectangle.
pub const RECTANGLE: [Field; 2] = [Field::new(16, 16), Field::new(0, 16)];
/// Fields of `texture_address`: the modes along s, t and r.
pub const MODES: [Field; 3] = [Field::new(0, 4), Field::new(8, 4), Field::new(16, 4)];
/// Field of `texture_control0`: whether the unit has a texture.
pub const ENABLE: Field = Field::new(30, 1);
/// Fields of `texture_control0`: the colour key's mode, the binary logarithm of the anisotropy, the largest and the least lod.
pub const COLOR_KEY: Field = Field::new(0, 2);
/// See [`COLOR_KEY`].
pub const ANISOTROPY: Field = Field::new(4, 2);
/// See [`COLOR_KEY`].
pub const MAX_LOD: Field = Field::new(6, 12);
/// See [`COLOR_KEY`].
pub const MIN_LOD: Field = Field::new(18, 12);
/// Fields of `texture_filter`: the bias, which is signed, the minification and the magnification filter.
pub const LOD_BIAS: Field = Field::new(0, 13);
/// See [`LOD_BIAS`].
pub const MIN_FILTER: Field = Field::new(16, 8);
/// See [`LOD_BIAS`].
pub const MAG_FILTER: Field = Field::new(24, 4);
/// Fields of `texture_filter`: whether R, G, B and A are signed.
pub const SIGNED: [Field; 4] = [Field::new(29, 1), Field::new(30, 1), Field::new(31, 1), Field::new(28, 1)];
/// Fields of `control0`: whether stencils are written, depths are floats, the buffer holds w, and attributes are in perspective.
pub const STENCIL_WRITE: Field = Field::new(0, 1);
/// See [`STENCIL_WRITE`].
pub const FLOAT_DEPTH: Field = Field::new(12, 1);
/// See [`STENCIL_WRITE`].
pub const W_BUFFER: Field = Field::new(16, 1);
/// See [`STENCIL_WRITE`].
pub const PERSPECTIVE: Field = Field::new(20, 1);
/// Field of `control0`: how the colours of units are converted (TEX-19): 0 not at all, 1 from Y, Cb and Cr.
pub const CONVERSION: Field = Field::new(28, 4);
/// Field of `zmin_max_control`: whether depths outside of the range are clamped.
pub const CLAMPS_DEPTH: Field = Field::new(4, 1);
/// Field of `surface_format`: whether the depth buffer has 16 bits (1) or 24 and a stencil (2).
pub const SURFACE_DEPTH: Field = Field::new(4, 4);

/// Bits of a stage's code in `shader_stage_program`.
pub const STAGE_BITS: u32 = 5;
/// The codes of `shader_stage_program` that sample at a unit's own coordinates: two dimensions, three, a cube map. The others are those of
/// [`ShaderOperation`](ninebit::state::ShaderOperation).
pub const STAGE_TWO: u32 = 1;
/// See [`STAGE_TWO`].
pub const STAGE_THREE: u32 = 2;
/// See [`STAGE_TWO`].
pub const STAGE_CUBE: u32 = 3;
/// See [`STAGE_TWO`].
pub const STAGE_PASS_THROUGH: u32 = 4;
/// See [`STAGE_TWO`].
pub const STAGE_CULL: u32 = 5;
/// See [`STAGE_TWO`].
pub const STAGE_BUMP: u32 = 6;
/// See [`STAGE_TWO`].
pub const STAGE_BUMP_LUMINANCE: u32 = 7;
/// See [`STAGE_TWO`].
pub const STAGE_DOT_2D: u32 = 9;
/// See [`STAGE_TWO`].
pub const STAGE_REFLECT_DIFFUSE: u32 = 0xb;
/// See [`STAGE_TWO`].
pub const STAGE_REFLECT_SPECULAR: u32 = 0xc;
/// See [`STAGE_TWO`].
pub const STAGE_DOT_3D: u32 = 0xd;
/// See [`STAGE_TWO`].
pub const STAGE_DOT_CUBE: u32 = 0xe;
/// See [`STAGE_TWO`].
pub const STAGE_ALPHA_RED: u32 = 0xf;
/// See [`STAGE_TWO`].
pub const STAGE_GREEN_BLUE: u32 = 0x10;
/// See [`STAGE_TWO`].
pub const STAGE_DOT: u32 = 0x11;
/// See [`STAGE_TWO`].
pub const STAGE_REFLECT_CONSTANT: u32 = 0x12;
/// Bits of a mapping in `dot_rgbmapping`, that of unit 1 first.
pub const MAPPING_BITS: u32 = 4;
/// Fields of `shader_other_stage_input`: the earlier unit that units 2 and 3 read. Unit 1 reads unit 0.
pub const PREVIOUS: [Field; 2] = [Field::new(16, 4), Field::new(20, 4)];
/// Bits of a unit in `shader_clip_plane_mode`: s, t, r, q, each set where what is not negative is dropped.
pub const CLIP_BITS: u32 = 4;

/// The magnification filters' codes.
pub const MAG_FILTERS: [(Filter, u32); 2] = [(Filter::Nearest, 1), (Filter::Linear, 2)];

/// The colour keys' codes; 0 is none.
pub const COLOR_KEYS: [(ColorKeyMode, u32); 3] =
    [(ColorKeyMode::Alpha, 1), (ColorKeyMode::Color, 2), (ColorKeyMode::Texel, 3)];

/// The stencil operations' values, in the order of [`StencilOperation`].
pub const STENCIL_OPERATIONS: [u32; StencilOperation::ALL.len()] =
    [0x1e00, 0, 0x1e01, 0x1e02, 0x1e03, 0x150a, 0x8507, 0x8508];

/// The fog modes' values, in the order of [`FogMode`].
pub const FOG_MODES: [(FogMode, u32); FogMode::ALL.len()] = [
    (FogMode::Linear, 0x2601),
    (FogMode::Exp, 0x800),
    (FogMode::Exp2, 0x801),
    (FogMode::LinearAbs, 0x804),
    (FogMode::ExpAbs, 0x802),
    (FogMode::Exp2Abs, 0x803),
];

/// The codes of texture formats: swizzled, or compressed, or with a pitch.
pub const FORMATS: [(u32, TextureFormat, bool); 50] = [
    (0x00, TextureFormat::L8, false),
    (0x01, TextureFormat::I8, false),
    (0x02, TextureFormat::A1R5G5B5, false),
    (0x03, TextureFormat::X1R5G5B5, false),
    (0x04, TextureFormat::A4R4G4B4, false),
    (0x05, TextureFormat::R5G6B5, false),
    (0x06, TextureFormat::A8R8G8B8, false),
    (0x07, TextureFormat::X8R8G8B8, false),
    (0x0b, TextureFormat::P8, false),
    (0x0c, TextureFormat::Dxt1, false),
    (0x0e, TextureFormat::Dxt3, false),
    (0x0f, TextureFormat::Dxt5, false),
    (0x10, TextureFormat::A1R5G5B5, true),
    (0x11, TextureFormat::R5G6B5, true),
    (0x12, TextureFormat::A8R8G8B8, true),
    (0x13, TextureFormat::L8, true),
    (0x16, TextureFormat::R8B8, true),
    (0x17, TextureFormat::G8B8, true),
    (0x19, TextureFormat::A8, false),
    (0x1a, TextureFormat::A8L8, false),
    (0x1b, TextureFormat::I8, true),
    (0x1c, TextureFormat::X1R5G5B5, true),
    (0x1d, TextureFormat::A4R4G4B4, true),
    (0x1e, TextureFormat::X8R8G8B8, true),
    (0x1f, TextureFormat::A8, true),
    (0x20, TextureFormat::A8L8, true),
    (0x24, TextureFormat::Yuy2, true),
    (0x25, TextureFormat::Uyvy, true),
    (0x27, TextureFormat::R6G5B5, false),
    (0x28, TextureFormat::G8B8, false),
    (0x29, TextureFormat::R8B8, false),
    (0x2a, TextureFormat::Z24S8, false),
    (0x2b, TextureFormat::Z24S8F, false),
    (0x2c, TextureFormat::Z16, false),
    (0x2d, TextureFormat::Z16F, false),
    (0x2e, TextureFormat::Z24S8, true),
    (0x2f, TextureFormat::Z24S8F, true),
    (0x30, TextureFormat::Z16, true),
    (0x31, TextureFormat::Z16F, true),
    (0x32, TextureFormat::Y16, false),
    (0x33, TextureFormat::R16B16, false),
    (0x35, TextureFormat::Y16, true),
    (0x36, TextureFormat::R16B16, true),
    (0x37, TextureFormat::R6G5B5, true),
    (0x3a, TextureFormat::A8B8G8R8, false),
    (0x3b, TextureFormat::B8G8R8A8, false),
    (0x3c, TextureFormat::R8G8B8A8, false),
    (0x3f, TextureFormat::A8B8G8R8, true),
    (0x40, TextureFormat::B8G8R8A8, true),
    (0x41, TextureFormat::R8G8B8A8, true),
];

/// The address modes' codes.
pub const ADDRESS_MODES: [(AddressMode, u32); 5] = [
    (AddressMode::Wrap, 1),
    (AddressMode::Mirror, 2),
    (AddressMode::ClampToEdge, 3),
    (AddressMode::ClampToBorder, 4),
    (AddressMode::Clamp, 5),
];

/// The minification filters' codes.
pub const MIN_FILTERS: [((Filter, MipFilter), u32); 6] = [
    ((Filter::Nearest, MipFilter::None), 1),
    ((Filter::Linear, MipFilter::None), 2),
    ((Filter::Nearest, MipFilter::Nearest), 3),
    ((Filter::Linear, MipFilter::Nearest), 4),
    ((Filter::Nearest, MipFilter::Linear), 5),
    ((Filter::Linear, MipFilter::Linear), 6),
];

/// The shadow comparisons' codes.
pub const SHADOW_FUNCTIONS: [(CompareFunction, u32); 8] = [
    (CompareFunction::Never, 0),
    (CompareFunction::Greater, 1),
    (CompareFunction::Equal, 2),
    (CompareFunction::GreaterOrEqual, 3),
    (CompareFunction::Less, 4),
    (CompareFunction::NotEqual, 5),
    (CompareFunction::LessOrEqual, 6),
    (CompareFunction::Always, 7),
];

/// The codes of the dot mappings.
pub const DOT_MAPPINGS: [(DotMapping, u32); 6] = [
    (DotMapping::ZeroToOne, 0),
    (DotMapping::MinusOneToOneD3d, 1),
    (DotMapping::MinusOneToOneGl, 2),
    (DotMapping::MinusOneToOne, 3),
    (DotMapping::Hilo1, 4),
    (DotMapping::HiloHemisphere, 7),
];
