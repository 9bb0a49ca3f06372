//! Direct3D texture stage states (Direct3D 6 to 9), and how they are lowered to general stages.
//!
//! Each stage becomes one general stage, except that BUMPENVMAP becomes the texture shader of the next unit. Stages end before the first one whose
//! colour operation is Disable. `docs/languages/programs.md` has the form of each operation.

mod lower;
mod operation;
mod text;

use crate::{Span, Spanned};
use ninebit::state::named;

pub use lower::{Context, LoweredProgram, UnitChange, lower};
pub use operation::Operation;
pub use text::parse;

/// D3DTTFF_PROJECTED: the flag that coordinates are divided by the last one.
pub const PROJECTED: u32 = 256;

/// Number of stages that the API has.
pub const STAGES: usize = 8;

named! {
    /// D3DTA: the source of an argument.
    pub enum ArgumentSource {
        /// 0: the interpolated diffuse colour.
        Diffuse,
        /// 1: the result of the stages before; diffuse in stage 0.
        Current,
        /// 2: the texture of the stage's number; opaque white if none is set.
        Texture,
        /// 3: D3DRS_TEXTUREFACTOR.
        TextureFactor,
        /// 4: the interpolated specular colour.
        Specular,
        /// 5: the second result register, 0 at first.
        Temp,
        /// 6: D3DTSS_CONSTANT of the stage.
        Constant,
    }
}
named! {
    /// D3DTSS_RESULTARG: the destination of a stage's result.
    pub enum ResultArgument {
        /// 1: what the next stage reads as Current.
        Current,
        /// 5: Temp.
        Temp,
    }
}

/// D3DTA with its modifiers: an argument of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageArgument {
    /// Register or constant that is read.
    pub source: ArgumentSource,
    /// D3DTA_COMPLEMENT (16): whether the argument is 1 - x.
    pub complement: bool,
    /// D3DTA_ALPHAREPLICATE (32): whether alpha is read in all channels.
    pub alpha_replicate: bool,
}

impl StageArgument {
    /// Makes an argument without modifiers.
    pub const fn new(source: ArgumentSource) -> StageArgument {
        StageArgument { source, complement: false, alpha_replicate: false }
    }

    /// Returns the argument of a D3DTA value; `None` if there is no such value.
    pub(crate) fn from_value(value: u32) -> Option<StageArgument> {
        use ninebit::state::Named;
        let source = ArgumentSource::ALL.get(value as usize & 15)?;
        (value < 64).then_some(StageArgument {
            source: *source,
            complement: value & 16 != 0,
            alpha_replicate: value & 32 != 0,
        })
    }
}

named! {
    /// D3DTSS_TCI: coordinates that the vertex side generates, in the order of the values 1 to 4.
    pub enum Generation {
        /// The normal in eye space.
        CameraSpaceNormal,
        /// The position in eye space.
        CameraSpacePosition,
        /// The reflected line of sight in eye space.
        CameraSpaceReflectionVector,
        /// The place in a sphere map where the reflection is seen.
        SphereMap,
    }
}

/// D3DTSS_TEXCOORDINDEX: the coordinate set of a stage, and how its coordinates are generated, if they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CoordinateIndex {
    /// The low half: number of the coordinate set.
    pub set: u32,
    /// The high half: 0 pass through, 1 camera-space normal, 2 position, 3 reflection vector, 4 sphere map.
    pub generation: u32,
}

/// The operation and the arguments of the colour or the alpha of a stage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Half {
    /// COLOROP or ALPHAOP.
    pub operation: Spanned<Operation>,
    /// ARG0, ARG1, ARG2.
    pub arguments: [Spanned<StageArgument>; 3],
}

/// One texture stage.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureStage {
    /// COLOROP and its arguments.
    pub color: Half,
    /// ALPHAOP and its arguments.
    pub alpha: Half,
    /// RESULTARG: destination of the result.
    pub result: ResultArgument,
    /// CONSTANT: bytes R, G, B, A.
    pub constant: [u8; 4],
    /// TEXCOORDINDEX; `None` if the texture unit determines it.
    pub coordinate_index: Option<Spanned<CoordinateIndex>>,
    /// TEXTURETRANSFORMFLAGS: a count from 0 to 4, and [`PROJECTED`]. If no stage sets them, the draw's texture matrices apply as they
    /// do to other programs.
    pub transform_flags: Spanned<u32>,
    /// BUMPENVMAT00, 01, 10, 11.
    pub bump_matrix: [f32; 4],
    /// Scale and offset of luminance: BUMPENVLSCALE, BUMPENVLOFFSET.
    pub bump_luminance: [f32; 2],
    /// Place where the stage is written, for findings about states that are not; empty if it is not written.
    pub span: Span,
}

impl TextureStage {
    /// Returns the API's initial state of stage `index`.
    pub fn initial(index: usize) -> TextureStage {
        let half = |operation| Half {
            operation: Spanned::default_of(operation),
            arguments: [ArgumentSource::Current, ArgumentSource::Texture, ArgumentSource::Current]
                .map(|source| Spanned::default_of(StageArgument::new(source))),
        };
        let [color, alpha] = match index {
            0 => [Operation::Modulate, Operation::SelectArg1],
            _ => [Operation::Disable; 2],
        };
        TextureStage {
            color: half(color),
            alpha: half(alpha),
            result: ResultArgument::Current,
            constant: [0; 4],
            coordinate_index: None,
            transform_flags: Spanned::default_of(0),
            bump_matrix: [0.0; 4],
            bump_luminance: [0.0; 2],
            span: 0..0,
        }
    }
}

/// The state of all stages.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureStages {
    /// Stages, starting with stage 0; stages that are not listed are in their initial state.
    pub stages: Vec<TextureStage>,
    /// D3DRS_TEXTUREFACTOR: bytes R, G, B, A.
    pub texture_factor: [u8; 4],
    /// D3DRS_SPECULARENABLE: whether the specular colour is added at the end.
    pub specular_enable: bool,
}

impl Default for TextureStages {
    /// The API's initial state.
    fn default() -> Self {
        TextureStages { stages: vec![TextureStage::initial(0)], texture_factor: [255; 4], specular_enable: false }
    }
}

impl TextureStages {
    /// Returns stage `index`, after adding it and those before it if needed. Returns `None` if the API has no such stage.
    pub fn stage_mut(&mut self, index: usize) -> Option<&mut TextureStage> {
        while self.stages.len() <= index && index < STAGES {
            self.stages.push(TextureStage::initial(self.stages.len()));
        }
        self.stages.get_mut(index)
    }
}
