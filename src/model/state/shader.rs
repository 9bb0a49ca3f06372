//! The texture shader: what each texture unit does with its coordinates and with what units before it have fetched (nv2a).
//!
//! On nv10, and on nv2a without a texture shader, every bound unit is [`ShaderOperation::Sample`] and every unbound one
//! [`ShaderOperation::None`].

use super::{Named, TEXTURE_UNITS, TextureKind, named};

named! {
    /// How a byte of a fetched colour becomes a number for a dot product (TSH-1 to TSH-3).
    pub enum DotMapping {
        /// v / 255.
        ZeroToOne,
        /// (v - 128) / 127.
        MinusOneToOneD3d,
        /// (2s + 1) / 255 of the two's complement s.
        MinusOneToOneGl,
        /// s / 127 of the two's complement s.
        MinusOneToOne,
        /// Two halves of 16 bits / 65535; the third component is 1.
        Hilo1,
        /// Two signed halves / 32768; the third component completes a unit vector.
        HiloHemisphere,
    }
}

/// What a unit does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShaderOperation {
    /// Nothing: black, opaque (TEX-16).
    None,
    /// Samples the unit's texture, whatever its kind, at the interpolated coordinates.
    Sample,
    /// The coordinates s, t, r, q as a colour (TSH-9).
    PassThrough,
    /// Drops the fragment when a coordinate is on the wrong side (TSH-10): of s, t, r, q, `true` tests for >= 0 being dropped,
    /// `false` for < 0. Otherwise black, opaque.
    CullFragment {
        /// For s, t, r, q.
        drops_not_negative: [bool; 4],
    },
    /// Samples at the coordinates moved by a matrix times the blue and green of an earlier unit (TSH-7).
    BumpEnvironment {
        /// m0 to m3 in register order: u + (m0 B + m3 G)/128, v + (m1 B + m2 G)/128.
        matrix: [f32; 4],
        /// Scale and offset of the luminance, which multiplies the colour (TSH-8).
        luminance: Option<[f32; 2]>,
    },
    /// Samples at alpha and red of an earlier unit (TSH-6).
    DependentAlphaRed,
    /// Samples at green and blue of an earlier unit (TSH-6).
    DependentGreenBlue,
    /// The dot product of the coordinates and an earlier unit's colour, for a later unit (TSH-4). Transparent black.
    DotProduct,
    /// The second dot product; samples a 2D texture at the two (texm3x2tex).
    DotProduct2D,
    /// The third dot product; samples a cube map in the direction of the three (texm3x3tex).
    DotProductCube,
    /// The second dot product; samples a cube map with the vector of all three, the normal itself (the third is the next unit's).
    DotReflectDiffuse,
    /// The third dot product; samples a cube map in the direction reflected about it, the eye from the three q (texm3x3vspec; TSH-5).
    DotReflectSpecular,
    /// The same with a constant eye vector (texm3x3spec).
    DotReflectConstantEye {
        /// Toward the eye.
        eye: [f32; 3],
    },
}

impl ShaderOperation {
    /// Its name in scenes, messages and traces.
    pub fn name(&self) -> &'static str {
        match self {
            ShaderOperation::None => "None",
            ShaderOperation::Sample => "Sample",
            ShaderOperation::PassThrough => "PassThrough",
            ShaderOperation::CullFragment { .. } => "CullFragment",
            ShaderOperation::BumpEnvironment { .. } => "BumpEnvironment",
            ShaderOperation::DependentAlphaRed => "DependentAlphaRed",
            ShaderOperation::DependentGreenBlue => "DependentGreenBlue",
            ShaderOperation::DotProduct => "DotProduct",
            ShaderOperation::DotProduct2D => "DotProduct2D",
            ShaderOperation::DotProductCube => "DotProductCube",
            ShaderOperation::DotReflectDiffuse => "DotReflectDiffuse",
            ShaderOperation::DotReflectSpecular => "DotReflectSpecular",
            ShaderOperation::DotReflectConstantEye { .. } => "DotReflectConstantEye",
        }
    }

    /// Whether it samples the unit's texture.
    pub fn samples(&self) -> bool {
        !matches!(
            self,
            ShaderOperation::None
                | ShaderOperation::PassThrough
                | ShaderOperation::CullFragment { .. }
                | ShaderOperation::DotProduct
        )
    }

    /// Whether it reads the colour of an earlier unit, [`ShaderStage::previous`].
    pub fn reads_previous(&self) -> bool {
        !matches!(
            self,
            ShaderOperation::None
                | ShaderOperation::Sample
                | ShaderOperation::PassThrough
                | ShaderOperation::CullFragment { .. }
        )
    }

    /// The kinds of texture that it samples; of one that samples nothing they say nothing.
    pub fn kinds(&self) -> &'static [TextureKind] {
        match self {
            ShaderOperation::BumpEnvironment { .. }
            | ShaderOperation::DependentAlphaRed
            | ShaderOperation::DependentGreenBlue
            | ShaderOperation::DotProduct2D => &[TextureKind::TwoDimensional, TextureKind::Rectangle],
            ShaderOperation::Sample => TextureKind::ALL,
            _ => &[TextureKind::Cube],
        }
    }

    /// Whether it takes a dot product.
    pub fn is_dot(&self) -> bool {
        matches!(
            self,
            ShaderOperation::DotProduct
                | ShaderOperation::DotProduct2D
                | ShaderOperation::DotProductCube
                | ShaderOperation::DotReflectDiffuse
                | ShaderOperation::DotReflectSpecular
                | ShaderOperation::DotReflectConstantEye { .. }
        )
    }
}

/// One unit's part of the texture shader.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShaderStage {
    /// What it does.
    pub operation: ShaderOperation,
    /// Which of the vertex's four coordinate sets is its own.
    pub coordinate_set: usize,
    /// The earlier unit whose colour it reads, if it reads one: always 0 for unit 1.
    pub previous: usize,
    /// How that colour enters a dot product.
    pub mapping: DotMapping,
}

impl ShaderStage {
    /// The stage of unit `index` without a texture shader.
    pub fn conventional(index: usize, bound: bool) -> ShaderStage {
        ShaderStage {
            operation: if bound { ShaderOperation::Sample } else { ShaderOperation::None },
            coordinate_set: index,
            previous: index.saturating_sub(1),
            mapping: DotMapping::ZeroToOne,
        }
    }

    /// TSH-10: why the operation of stage `index` may not stand where it does: where it belongs. `None`: it may.
    pub fn misplaced(stages: &[ShaderStage; TEXTURE_UNITS], index: usize) -> Option<&'static str> {
        use ShaderOperation as Op;
        let at = |n: usize| stages.get(n).map_or(Op::None, |stage| stage.operation);
        let before = |back: usize| index.checked_sub(back).map_or(Op::None, at);
        let pad = |operation| matches!(operation, Op::DotProduct);
        let two_pads = pad(before(2)) && pad(before(1));
        match at(index) {
            Op::None | Op::Sample | Op::PassThrough | Op::CullFragment { .. } => None,
            Op::BumpEnvironment { .. } => (index == 0
                || index == 1 && matches!(before(1), Op::None | Op::CullFragment { .. }))
            .then_some("it moves coordinates by the colour of an earlier unit: put it after a stage that has one, at stage 1, 2 or 3"),
            Op::DependentAlphaRed | Op::DependentGreenBlue => {
                (index == 0).then_some("it reads the colour of an earlier unit: put it at stage 1, 2 or 3")
            }
            Op::DotProduct => (index == 0 || index == 3)
                .then_some("it reads an earlier unit and leaves its result to the next stage: put it at stage 1 or 2"),
            Op::DotProduct2D => {
                (!pad(before(1))).then_some("put `DotProduct` at the stage before it, which makes it stage 2 or 3")
            }
            Op::DotProductCube => (!two_pads).then_some("put `DotProduct` at stages 1 and 2, and this at stage 3"),
            Op::DotReflectDiffuse => {
                let next = matches!(at(index + 1), Op::DotReflectSpecular | Op::DotReflectConstantEye { .. });
                (!pad(before(1)) || index == 3 || !next)
                    .then_some("put `DotProduct` at stage 1, this at stage 2, and `DotReflectSpecular` or `DotReflectConstantEye` at stage 3")
            }
            Op::DotReflectSpecular | Op::DotReflectConstantEye { .. } => {
                let second = matches!(before(1), Op::DotProduct | Op::DotReflectDiffuse);
                (!pad(before(2)) || !second)
                    .then_some("put `DotProduct` at stage 1, `DotProduct` or `DotReflectDiffuse` at stage 2, and this at stage 3")
            }
        }
    }

    /// TSH-10: whether stage `index` reads unit 2 although its dot product is needed at stage 2 already.
    pub fn reads_too_late(stages: &[ShaderStage; TEXTURE_UNITS], index: usize) -> bool {
        index == 3 && matches!(stages[2].operation, ShaderOperation::DotReflectDiffuse) && stages[3].previous == 2
    }
}
