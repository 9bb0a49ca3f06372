//! Direct3D texture stage states (Direct3D 6 to 9) and how they become general stages.
//!
//! A stage becomes one general stage; BUMPENVMAP becomes the texture shader of the next unit instead. Stages end at the first whose
//! colour operation is Disable. See `docs/programs.md` for the form that each operation takes.

mod lower;
mod operation;
mod text;

use crate::{Span, Spanned};
use ninebit::state::named;

pub use lower::{Context, Lowered, UnitChange, lower};
pub use operation::Operation;
pub use text::parse;

/// D3DTTFF_PROJECTED.
pub const PROJECTED: u32 = 256;

/// Stages that the API has.
pub const STAGES: usize = 8;

named! {
    /// D3DTA, the selector.
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
    /// D3DTSS_RESULTARG.
    pub enum ResultArgument {
        /// 1: what the next stage reads as Current.
        Current,
        /// 5: Temp.
        Temp,
    }
}

/// D3DTA with its modifiers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageArgument {
    /// The register or constant that is read.
    pub source: ArgumentSource,
    /// D3DTA_COMPLEMENT (16): 1 - x.
    pub complement: bool,
    /// D3DTA_ALPHAREPLICATE (32): alpha in all channels.
    pub alpha_replicate: bool,
}

impl StageArgument {
    /// A selector without modifiers.
    pub const fn new(source: ArgumentSource) -> StageArgument {
        StageArgument { source, complement: false, alpha_replicate: false }
    }

    /// The argument of a D3DTA value; `None` if there is no such value.
    pub fn from_value(value: u32) -> Option<StageArgument> {
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
    /// D3DTSS_TCI: coordinates that the vertex side makes, in the order of its values 1 to 4.
    pub enum Generation {
        /// The normal in eye space.
        CameraSpaceNormal,
        /// The position in eye space.
        CameraSpacePosition,
        /// The reflected line of sight in eye space.
        CameraSpaceReflectionVector,
        /// Where a mirroring sphere shows the reflection.
        SphereMap,
    }
}

/// D3DTSS_TEXCOORDINDEX: the coordinate set, and whether the vertices' coordinates are replaced by generated ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CoordinateIndex {
    /// The low half.
    pub set: u32,
    /// The high half: 0 pass through, 1 camera-space normal, 2 position, 3 reflection vector, 4 sphere map.
    pub generation: u32,
}

/// Operation and arguments 0, 1, 2 of the colour or the alpha of a stage.
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
    /// RESULTARG.
    pub result: ResultArgument,
    /// CONSTANT, R, G, B, A bytes.
    pub constant: [u8; 4],
    /// TEXCOORDINDEX; `None`: as the texture unit says.
    pub coordinate_index: Option<Spanned<CoordinateIndex>>,
    /// TEXTURETRANSFORMFLAGS: a count 0 to 4, and [`PROJECTED`]. Where no stage writes them the draw's texture matrices apply as they
    /// do to other programs.
    pub transform_flags: Spanned<u32>,
    /// BUMPENVMAT00, 01, 10, 11.
    pub bump_matrix: [f32; 4],
    /// BUMPENVLSCALE, BUMPENVLOFFSET.
    pub bump_luminance: [f32; 2],
    /// Where the stage is written, for findings about what is not; empty if it is not.
    pub span: Span,
}

impl TextureStage {
    /// The API's initial state of stage `index`.
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
    /// Stages from 0; those not given are in their initial state.
    pub stages: Vec<TextureStage>,
    /// D3DRS_TEXTUREFACTOR, R, G, B, A bytes.
    pub texture_factor: [u8; 4],
    /// D3DRS_SPECULARENABLE.
    pub specular_enable: bool,
}

impl Default for TextureStages {
    /// The API's initial state.
    fn default() -> Self {
        TextureStages { stages: vec![TextureStage::initial(0)], texture_factor: [255; 4], specular_enable: false }
    }
}

impl TextureStages {
    /// Stage `index`, below [`STAGES`], brought into being with all before it.
    pub fn stage_mut(&mut self, index: usize) -> Option<&mut TextureStage> {
        while self.stages.len() <= index && index < STAGES {
            self.stages.push(TextureStage::initial(self.stages.len()));
        }
        self.stages.get_mut(index)
    }
}
