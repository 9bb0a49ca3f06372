//! Methods of the raster operations and their values, which are the same in the NV10 and the NV20 class. Names are those of the Xbox's
//! headers, in lower case.

use super::layout::Field;
use ninebit::state::{BlendEquation, BlendFactor, CompareFunction, Named, SurfaceFormat, named};

named! {
    /// A method of the raster operations.
    pub enum Method =>
    /// Returns the offset of the method in the chip's 3D class.
    number: u32 {
        /// Format of the surface; the lowest four bits are the format of its colour.
        SurfaceFormat = "surface_format" => 0x208,
        /// Whether the alpha test is enabled.
        AlphaTestEnable = "alpha_test_enable" => 0x300,
        /// Whether blending is enabled.
        BlendEnable = "blend_enable" => 0x304,
        /// Comparison of the alpha test.
        AlphaFunc = "alpha_func" => 0x33c,
        /// Reference of the alpha test, 0 to 255.
        AlphaRef = "alpha_ref" => 0x340,
        /// Blend factor of the source.
        BlendFuncSfactor = "blend_func_sfactor" => 0x344,
        /// Blend factor of the destination.
        BlendFuncDfactor = "blend_func_dfactor" => 0x348,
        /// Constant colour of blending, A8R8G8B8.
        BlendColor = "blend_color" => 0x34c,
        /// Equation that combines source and destination.
        BlendEquation = "blend_equation" => 0x350,
        /// Channels that are written.
        ColorMask = "color_mask" => 0x358,
    }
}

/// The field of [`Method::SurfaceFormat`] with the format of the colour.
pub const SURFACE_COLOR: Field = Field::new(0, 4);

/// The fields R, G, B, A of [`Method::ColorMask`].
pub const COLOR_MASK: [Field; 4] = [Field::new(16, 1), Field::new(8, 1), Field::new(0, 1), Field::new(24, 1)];

/// Returns the value of a comparison.
pub fn compare_function(function: CompareFunction) -> u32 {
    0x200 + function as u32
}

/// The values of blend factors, in the order of [`BlendFactor`].
const BLEND_FACTORS: [u32; BlendFactor::ALL.len()] =
    [0, 1, 0x300, 0x301, 0x302, 0x303, 0x304, 0x305, 0x306, 0x307, 0x308, 0x8001, 0x8002, 0x8003, 0x8004];

/// Returns the value of a blend factor.
pub fn blend_factor(factor: BlendFactor) -> u32 {
    BLEND_FACTORS[factor as usize]
}

/// The values of blend equations, in the order of [`BlendEquation`].
const BLEND_EQUATIONS: [u32; BlendEquation::ALL.len()] = [0x8006, 0x800a, 0x800b, 0x8007, 0x8008, 0xf006, 0xf005];

/// Returns the value of a blend equation.
pub fn blend_equation(equation: BlendEquation) -> u32 {
    BLEND_EQUATIONS[equation as usize]
}

/// Returns the value of a surface format, for [`SURFACE_COLOR`].
pub fn surface_format(format: SurfaceFormat) -> u32 {
    match format {
        SurfaceFormat::X1R5G5B5Z => 1,
        SurfaceFormat::X1R5G5B5O => 2,
        SurfaceFormat::R5G6B5 => 3,
        SurfaceFormat::X8R8G8B8Z => 4,
        SurfaceFormat::X8R8G8B8O => 5,
        SurfaceFormat::X1A7R8G8B8Z => 6,
        SurfaceFormat::X1A7R8G8B8O => 7,
        SurfaceFormat::A8R8G8B8 => 8,
        SurfaceFormat::B8 => 9,
        SurfaceFormat::G8B8 => 10,
    }
}
