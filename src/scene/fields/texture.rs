//! Declares the fields of textures, of the units that sample them, and of texture shaders.

use super::*;
use ninebit::state::{AddressMode, LARGEST_VOLUME, MipFilter, ShadowReference};

/// The largest unsigned 4.8 number: bound of the limits and biases of the lod (TEX-9).
const MAX_LOD: f32 = 4095.0 / 256.0;

source! {
    struct ColorKey "colour key" {
        /// the colour
        color: Color [required],
        /// texels of this colour get alpha 0, become 0, or drop the fragment
        mode: Name<state::ColorKeyMode> [required],
    }
    struct Texture "texture" {
        /// `TwoDimensional`; `Cube`: six square faces, sampled with a direction (TEX-12); `Rectangle`: any sides, one level, coordinates in texels;
        /// `ThreeDimensional`: layers that r chooses from, one level (VOL-1)
        kind: Word [or "`Cube` for six faces, `ThreeDimensional` for layers, else `TwoDimensional`"],
        /// [how texels are stored](#texture-formats)
        format: Name<state::TextureFormat> [or "that of the DDS file or target; else `A8R8G8B8`"],
        /// where the texels come from, below
        source: ImageSource [required],
        /// `4`, or `All` for levels down to 1 x 1. Of a file with several levels so many are taken; a raw file holds so many; otherwise levels are made
        /// from level 0
        levels: Word [or "as many as the file has; 1"],
        /// in place of `levels`: a list of sources, level 1 first. Sides halve from level to level, rounded down, and are at least 1
        mips: List<'a, ImageSource> [or "none"],
        /// name of the [palette](#palettes) of a `P8` texture; a unit may name another
        palette: String [or "that of the DDS file"],
        /// every source has 4 more texels on each side, which `ClampToBorder` reads: 8 columns and rows more than the texture (TEX-7). Nv2a; two dimensions,
        /// uncompressed
        border: bool = false,
        /// the level to begin with: those before it are left out, and its sides are the texture's
        first_level: u32 [or "`0`"],
    }
    struct RawFile "texture" {
        /// a file of texels or blocks as they lie in memory
        file: String [required],
        /// columns and rows
        width: u32 [required], height: u32 [required],
        /// so many follow one another
        layers: u32 [or "a texture without layers" in 1..=LARGEST_VOLUME, "the layers"],
    }
    struct Faces "cube map" {
        /// sources of the same size, format and number of levels
        positive_x: ImageSource [required], negative_x: ImageSource [required], positive_y: ImageSource [required],
        negative_y: ImageSource [required], positive_z: ImageSource [required], negative_z: ImageSource [required],
    }
    struct TexelRows "texture" {
        /// columns and rows
        width: u32 [required], height: u32 [required],
        /// a text for each row from the top, in it a hexadecimal word for each texel (8, 4 or 2 digits by format)
        rows: List<'a, String> [required],
    }
    struct SolidImage "texture" {
        /// columns and rows
        width: u32 [required], height: u32 [required],
        /// the colour
        color: Color [required],
    }
    struct CheckerImage "texture" {
        /// columns and rows
        width: u32 [required], height: u32 [required],
        /// the side of a square in texels
        cell: u32 [in 1..=4096, "the side of a cell"] = 1,
        /// two colours, the first top left
        colors: Tuple<'a, Color> [or "`((255, 255, 255), (0, 0, 0))`"],
    }
    struct RampImage "texture" {
        /// columns and rows
        width: u32 [required], height: u32 [required],
        /// colours of the first and the last column or row; between them each channel is rounded to the nearest step
        from: Color [required], to: Color [required],
        /// along rows, or down
        axis: Word [one of "axis": "Horizontal", "Vertical"],
    }
    struct UnitState "texture unit" {
        /// its name
        texture: String [required],
        /// of a `P8` texture: name of its [palette](#palettes)
        palette: String [or "that of the texture"],
        /// which of the four sets of coordinates
        coordinates: u32 [or "number of the unit" in 0..=3, "a set of texture coordinates"],
        /// outside the texture, along every axis (TEX-7); `ClampToBorder` on Nv2a
        address: Name<state::AddressMode> = AddressMode::Wrap,
        /// along one of them
        address_s: Name<state::AddressMode> [or "`address`"], address_t: Name<state::AddressMode> [or "`address`"],
        address_r: Name<state::AddressMode> [or "`address`"],
        /// where the texture is minified (lod > 0) and magnified (TEX-5, TEX-6)
        min_filter: Name<state::Filter> [or "each other; `Linear`"], mag_filter: Name<state::Filter> [or "each other; `Linear`"],
        /// levels where it is minified: level 0, the nearest, two (TEX-9)
        mip_filter: Name<state::MipFilter> = MipFilter::None,
        /// colour outside, for `ClampToBorder` (Nv2a)
        border_color: Color [color] = [0; 4],
        /// `(red, green, blue, alpha)`: channels read as two's complement (TEX-18; Nv2a)
        signed: Tuple<'a, bool> [flags "four", help(super::scene::CHANNELS)] = [false; 4],
        /// added to the lod, cut to 1/256 toward zero
        lod_bias: f32 [in -16.0..=MAX_LOD, "a lod bias", rule("TEX-9")] = 0.0,
        /// limits of the lod; with a `min_lod` above 0 nothing is magnified
        min_lod: f32 [in 0.0..=MAX_LOD, "a least lod", rule("TEX-9")] = 0.0,
        max_lod: f32 [in 0.0..=MAX_LOD, "a greatest lod", rule("TEX-9")] = MAX_LOD,
        /// 1, 2, 4 or 8: how many times as long as wide a footprint may be; several taps along its longer axis (TEX-17). One filter, no levels, a flat
        /// texture; 4 and 8 on Nv2a
        anisotropy: u32 [in 1..=8, "anisotropy"] = 1,
        /// `(s, t)`: between two vertices a coordinate goes the shorter way around (CYL-1). Of `TwoDimensional` textures with q = 1
        cylindrical_wrap: Tuple<'a, bool>
            [flags "two", label("for s and t"), help("write `(true, false)`, for example")] = [false; 2],
        /// texels of one colour are left out (KEY-1); both filters `Nearest`
        color_key: ColorKey<'a> [or "none"],
        /// 255 where a depth compares so, else 0 (SHD-1; Nv2a). Textures of depths need it; both filters `Nearest`, one function for all units
        shadow: ShadowComparison<'a>,
    }
    struct ShadowComparison "shadow comparison" {
        /// how the reference compares with the texel
        function: Name<state::CompareFunction> [required value],
        /// r/q, in steps of the buffer, or 0
        reference: Name<state::ShadowReference> = ShadowReference::R,
    }
    struct StageState "texture shader stage" {
        /// one of those below
        operation: ShaderOperation [required],
        /// the earlier unit whose colour it reads: 0 or 1 for unit 2, 0 to 2 for unit 3
        previous: u32 [or "the unit before" in 0..=2, "an earlier texture unit"],
        /// of a dot product: what that colour's bytes stand for (TSH-1 to TSH-3)
        mapping: Name<state::DotMapping> = state::DotMapping::ZeroToOne,
        /// which of the four sets of coordinates
        coordinates: u32 [or "the unit's `coordinates`, else its number" in 0..=3, "a set of texture coordinates"],
    }
    struct CullFragment {
        /// what drops the fragment
        s: Word [one of "sign to be dropped": "Negative", "NotNegative"],
        t: Word [one of "sign to be dropped": "Negative", "NotNegative"],
        r: Word [one of "sign to be dropped": "Negative", "NotNegative"],
        q: Word [one of "sign to be dropped": "Negative", "NotNegative"],
    }
    struct BumpEnvironment "operation" {
        /// `(m0, m1, m2, m3)`
        matrix: Numbers [required],
        /// `(scale, offset)` (TSH-8)
        luminance: Numbers [or "the colour as it is"],
    }
    struct ConstantEye "operation" {
        /// the eye vector `(x, y, z)`
        eye: Numbers [required numbers 3..=3, "an eye vector"],
    }
}
