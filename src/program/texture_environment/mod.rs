//! The OpenGL texture environment (OpenGL 1.3 and extensions of its time), and how it is lowered to general stages.
//!
//! Each unit becomes one general stage. `docs/languages/programs.md` has the form of each function.

mod combine;
mod lower;
mod text;

use crate::finding::finding;
use crate::{Span, Spanned};
use ninebit::diagnostic::Diagnostic;
use ninebit::state::{Scale, TEXTURE_UNITS, TextureFormat, named};

pub use crate::cascade::LoweredProgram;
pub use lower::{Context, lower};
pub use text::parse;

named! {
    /// TEXTURE_ENV_MODE: what a unit does.
    pub enum Mode {
        /// The texture's colour.
        Replace,
        /// The incoming colour times the texture's.
        Modulate,
        /// The incoming and the texture's colour, blended by the texture's alpha.
        Decal,
        /// The incoming and the environment colour, blended by the texture's colour.
        Blend,
        /// The incoming colour plus the texture's.
        Add,
        /// The result of the combine functions.
        Combine,
        /// COMBINE4_NV (NV_texture_env_combine4): sums of two products.
        Combine4,
    }
}
named! {
    /// COMBINE_RGB, COMBINE_ALPHA: a combine function. a0 to a3 are the arguments; results are scaled, then clamped to 0..1.
    pub enum Function {
        /// a0.
        Replace,
        /// a0 a1.
        Modulate,
        /// a0 + a1. Combine4: a0 a1 + a2 a3.
        Add,
        /// a0 + a1 - 1/2. Combine4: a0 a1 + a2 a3 - 1/2.
        AddSigned,
        /// a0 a2 + a1 (1 - a2).
        Interpolate,
        /// a0 - a1.
        Subtract,
        /// The sum over R, G, B of (2 a0 - 1)(2 a1 - 1), scaled (ARB_texture_env_dot3). RGB only.
        Dot3RgbArb,
        /// The same dot product in all four channels.
        Dot3RgbaArb,
        /// The dot product without scale (EXT_texture_env_dot3). RGB only.
        Dot3RgbExt,
        /// The same dot product in all four channels, without scale.
        Dot3RgbaExt,
    }
}
named! {
    /// SOURCE0_RGB and the like: the source of an argument.
    pub enum EnvironmentSource {
        /// The unit's own texture.
        Texture,
        /// Unit 0's texture (crossbar).
        Texture0,
        /// Unit 1's texture (crossbar).
        Texture1,
        /// Unit 2's texture (crossbar).
        Texture2,
        /// Unit 3's texture (crossbar).
        Texture3,
        /// The environment colour of the unit.
        Constant,
        /// The interpolated primary colour.
        PrimaryColor,
        /// The result of the unit before; the primary colour in unit 0.
        Previous,
        /// 0 in every channel (Combine4).
        Zero,
    }
}
named! {
    /// OPERAND0_RGB and the like: what an argument takes of its source.
    pub enum Operand {
        /// The colour of the source.
        SourceColor,
        /// 1 minus the colour.
        OneMinusSourceColor,
        /// The alpha of the source.
        SourceAlpha,
        /// 1 minus the alpha.
        OneMinusSourceAlpha,
    }
}
named! {
    /// The base internal format of a texture, which says what its R, G, B and A are.
    pub enum BaseFormat {
        /// 0, 0, 0, A.
        Alpha,
        /// L, L, L, 1.
        Luminance,
        /// L, L, L, A.
        LuminanceAlpha,
        /// I, I, I, I.
        Intensity,
        /// R, G, B, 1.
        Rgb,
        /// R, G, B, A.
        Rgba,
    }
}

impl BaseFormat {
    /// Returns OpenGL's base format of a texel format.
    pub fn from_format(format: TextureFormat) -> BaseFormat {
        match format {
            TextureFormat::A8 => BaseFormat::Alpha,
            TextureFormat::L8 => BaseFormat::Luminance,
            TextureFormat::A8L8 => BaseFormat::LuminanceAlpha,
            TextureFormat::I8 => BaseFormat::Intensity,
            // No unit reads depths as colours.
            _ if format.has_alpha() || format.depth().is_some() => BaseFormat::Rgba,
            _ => BaseFormat::Rgb,
        }
    }
}

/// The colour or the alpha half of a combining unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Half {
    /// COMBINE_RGB or COMBINE_ALPHA.
    pub function: Spanned<Function>,
    /// SOURCE0 to SOURCE3.
    pub sources: [Spanned<EnvironmentSource>; 4],
    /// OPERAND0 to OPERAND3.
    pub operands: [Spanned<Operand>; 4],
    /// RGB_SCALE or ALPHA_SCALE: One, Two, Four.
    pub scale: Scale,
}

/// The environment of one texture unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unit {
    /// The mode, TEXTURE_ENV_MODE.
    pub mode: Mode,
    /// COMBINE_RGB and its arguments and scale.
    pub rgb: Half,
    /// COMBINE_ALPHA and its arguments and scale.
    pub alpha: Half,
    /// TEXTURE_ENV_COLOR: bytes R, G, B, A.
    pub color: [u8; 4],
    /// The base format of the texture; `None` if it follows from the texel format.
    pub base_format: Option<BaseFormat>,
    /// Place where the unit is written; empty if it is not.
    pub span: Span,
}

impl Unit {
    /// Returns the API's initial state. It is the same for Combine and Combine4, as far as both read it.
    pub fn initial() -> Unit {
        let half = |operands: [Operand; 4]| Half {
            function: Spanned::default_of(Function::Modulate),
            sources: [
                EnvironmentSource::Texture,
                EnvironmentSource::Previous,
                EnvironmentSource::Constant,
                EnvironmentSource::Zero,
            ]
            .map(Spanned::default_of),
            operands: operands.map(Spanned::default_of),
            scale: Scale::One,
        };
        let (color, alpha) = (Operand::SourceColor, Operand::SourceAlpha);
        Unit {
            mode: Mode::Modulate,
            rgb: half([color, color, alpha, Operand::OneMinusSourceColor]),
            alpha: half([alpha, alpha, alpha, Operand::OneMinusSourceAlpha]),
            color: [0; 4],
            base_format: None,
            span: 0..0,
        }
    }
}

/// The texture environment of all units.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextureEnvironment {
    /// Units, starting with unit 0; units that are not listed are in their initial state.
    pub units: Vec<Unit>,
    /// COLOR_SUM, or a separate specular colour: whether the secondary colour is added at the end.
    pub color_sum: bool,
}
