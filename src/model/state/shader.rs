//! The texture shader: what each texture unit does with its coordinates and with the colours that earlier units fetched
//! (nv2a).
//!
//! On nv10, and on nv2a without a texture shader, every bound unit is [`ShaderOperation::Sample`] and every unbound
//! unit is [`ShaderOperation::None`].

use super::{Named, TEXTURE_UNITS, TextureKind, named};

named! {
    /// How the bytes of a fetched colour become numbers for a dot product (TSH-1 to TSH-3).
    pub enum DotMapping {
        /// v / 255.
        ZeroToOne,
        /// (v - 128) / 127.
        MinusOneToOneD3d,
        /// (2s + 1) / 255, where s is the byte as two's complement.
        MinusOneToOneGl,
        /// s / 127, where s is the byte as two's complement.
        MinusOneToOne,
        /// Two 16-bit halves, each divided by 65535. The third component is 1.
        Hilo1,
        /// Two signed 16-bit halves, each divided by 32768. The third component completes a unit vector.
        HiloHemisphere,
    }
}

/// The operation of a texture unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShaderOperation {
    /// Does nothing; the result is opaque black (TEX-16).
    None,
    /// Samples the unit's texture, of any kind, at the interpolated coordinates.
    Sample,
    /// Samples a cube map or a volume as a stage for two dimensions does (TEX-20).
    Sample2D,
    /// Samples a two-dimensional texture as a stage for cube maps does (TEX-20).
    SampleCube,
    /// Returns the coordinates s, t, r, q as a colour (TSH-9).
    PassThrough,
    /// Drops the fragment if one of its coordinates has the wrong sign (TSH-10). Otherwise the result is opaque black.
    CullFragment {
        /// For each of s, t, r, q: `true` drops the fragment if the coordinate is >= 0, `false` if it is < 0.
        drops_not_negative: [bool; 4],
    },
    /// Samples at the coordinates displaced by a matrix times the blue and green of an earlier unit (TSH-7).
    BumpEnvironment {
        /// m0 to m3 in register order: u + (m0 B + m3 G)/128 and v + (m1 B + m2 G)/128.
        matrix: [f32; 4],
        /// Scale and offset of the luminance, which multiplies the colour (TSH-8).
        luminance: Option<[f32; 2]>,
    },
    /// Samples at the alpha and red of an earlier unit (TSH-6).
    DependentAlphaRed,
    /// Samples at the green and blue of an earlier unit (TSH-6).
    DependentGreenBlue,
    /// Computes the dot product of the coordinates and an earlier unit's colour, for a later unit (TSH-4). The result
    /// is transparent black.
    DotProduct,
    /// Computes the second dot product and samples a 2D texture at the two (texm3x2tex).
    DotProduct2D,
    /// Computes the third dot product and samples at the first two (TEX-20).
    DotProduct3D,
    /// Computes the third dot product and samples in the direction of the three (texm3x3tex).
    DotProductCube,
    /// Computes the second dot product and samples in the direction of the vector of all three, which is the
    /// normal. The next unit computes the third product.
    DotReflectDiffuse,
    /// Computes the third dot product and samples in the direction of the eye vector reflected about the
    /// normal. The eye vector is the q of the three units (texm3x3vspec; TSH-5).
    DotReflectSpecular,
    /// Like [`DotReflectSpecular`](Self::DotReflectSpecular), but with a constant eye vector (texm3x3spec).
    DotReflectConstantEye {
        /// Vector toward the eye.
        eye: [f32; 3],
    },
}

impl ShaderOperation {
    /// Returns the name in scenes, messages and traces.
    pub fn name(&self) -> &'static str {
        match self {
            ShaderOperation::None => "None",
            ShaderOperation::Sample => "Sample",
            ShaderOperation::Sample2D => "Sample2D",
            ShaderOperation::SampleCube => "SampleCube",
            ShaderOperation::PassThrough => "PassThrough",
            ShaderOperation::CullFragment { .. } => "CullFragment",
            ShaderOperation::BumpEnvironment { .. } => "BumpEnvironment",
            ShaderOperation::DependentAlphaRed => "DependentAlphaRed",
            ShaderOperation::DependentGreenBlue => "DependentGreenBlue",
            ShaderOperation::DotProduct => "DotProduct",
            ShaderOperation::DotProduct2D => "DotProduct2D",
            ShaderOperation::DotProduct3D => "DotProduct3D",
            ShaderOperation::DotProductCube => "DotProductCube",
            ShaderOperation::DotReflectDiffuse => "DotReflectDiffuse",
            ShaderOperation::DotReflectSpecular => "DotReflectSpecular",
            ShaderOperation::DotReflectConstantEye { .. } => "DotReflectConstantEye",
        }
    }

    /// Returns whether the operation samples the unit's texture.
    pub fn samples(&self) -> bool {
        !matches!(
            self,
            ShaderOperation::None
                | ShaderOperation::PassThrough
                | ShaderOperation::CullFragment { .. }
                | ShaderOperation::DotProduct
        )
    }

    /// Returns whether the operation samples the unit's texture at the interpolated coordinates.
    pub fn samples_own(&self) -> bool {
        matches!(self, ShaderOperation::Sample | ShaderOperation::Sample2D | ShaderOperation::SampleCube)
    }

    /// Returns whether the operation samples an image of a kind in a direction.
    pub fn takes_direction(&self, kind: TextureKind) -> bool {
        match self {
            ShaderOperation::Sample => kind == TextureKind::Cube,
            ShaderOperation::SampleCube
            | ShaderOperation::DotProductCube
            | ShaderOperation::DotReflectDiffuse
            | ShaderOperation::DotReflectSpecular
            | ShaderOperation::DotReflectConstantEye { .. } => true,
            _ => false,
        }
    }

    /// Returns whether the operation reads the colour of an earlier unit, [`ShaderStage::previous`].
    pub fn reads_previous(&self) -> bool {
        !self.samples_own()
            && !matches!(
                self,
                ShaderOperation::None | ShaderOperation::PassThrough | ShaderOperation::CullFragment { .. }
            )
    }

    /// Returns the kinds of texture that the operation can sample. Meaningless for an operation that samples nothing.
    pub fn kinds(&self) -> &'static [TextureKind] {
        match self {
            ShaderOperation::BumpEnvironment { .. }
            | ShaderOperation::DependentAlphaRed
            | ShaderOperation::DependentGreenBlue
            | ShaderOperation::DotProduct2D => &[TextureKind::TwoDimensional, TextureKind::Rectangle],
            ShaderOperation::Sample => TextureKind::ALL,
            ShaderOperation::Sample2D => &[TextureKind::Cube, TextureKind::ThreeDimensional],
            ShaderOperation::SampleCube => &[TextureKind::TwoDimensional],
            _ => &[TextureKind::Cube, TextureKind::TwoDimensional],
        }
    }

    /// Returns whether the operation computes a dot product.
    pub fn is_dot(&self) -> bool {
        matches!(
            self,
            ShaderOperation::DotProduct
                | ShaderOperation::DotProduct2D
                | ShaderOperation::DotProduct3D
                | ShaderOperation::DotProductCube
                | ShaderOperation::DotReflectDiffuse
                | ShaderOperation::DotReflectSpecular
                | ShaderOperation::DotReflectConstantEye { .. }
        )
    }
}

/// The part of the texture shader that one unit runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShaderStage {
    /// The operation of the unit.
    pub operation: ShaderOperation,
    /// Index of the vertex's coordinate set that the unit uses, 0 to 3.
    pub coordinate_set: usize,
    /// Index of the earlier unit whose colour the operation reads, if it reads one. For unit 1 it is always 0.
    pub previous: usize,
    /// How that colour enters a dot product.
    pub mapping: DotMapping,
}

impl ShaderStage {
    /// Returns the stage of unit `index` without a texture shader: it samples if a texture is bound.
    pub fn conventional(index: usize, bound: bool) -> ShaderStage {
        ShaderStage {
            operation: if bound { ShaderOperation::Sample } else { ShaderOperation::None },
            coordinate_set: index,
            previous: index.saturating_sub(1),
            mapping: DotMapping::ZeroToOne,
        }
    }

    /// TSH-10: returns the reason why the operation of stage `index` may not stand there, including where it belongs,
    /// or `None` if it may.
    pub fn misplaced(stages: &[ShaderStage; TEXTURE_UNITS], index: usize) -> Option<&'static str> {
        use ShaderOperation as Op;
        let at = |n: usize| stages.get(n).map_or(Op::None, |stage| stage.operation);
        let before = |back: usize| index.checked_sub(back).map_or(Op::None, at);
        let pad = |operation| matches!(operation, Op::DotProduct);
        let two_pads = pad(before(2)) && pad(before(1));
        match at(index) {
            Op::None | Op::Sample | Op::Sample2D | Op::SampleCube | Op::PassThrough | Op::CullFragment { .. } => None,
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
            Op::DotProduct3D | Op::DotProductCube => (!two_pads).then_some("put `DotProduct` at stages 1 and 2, and this at stage 3"),
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

    /// TSH-10: returns whether stage `index` reads unit 2 although stage 2 already needs its dot product.
    pub fn reads_too_late(stages: &[ShaderStage; TEXTURE_UNITS], index: usize) -> bool {
        index == 3 && matches!(stages[2].operation, ShaderOperation::DotReflectDiffuse) && stages[3].previous == 2
    }
}
