//! Decoded hardware state: what the chip is told to do, in its own terms.
//!
//! Plain data with exhaustive enums and public fields; nothing here renders, parses or fails. The scene front end produces a
//! [`Scene`], the [plan](crate::plan) reduces it to what can reach the frame, and the independent oracle of the test suite
//! reads it directly. State knows neither RON nor image files.

mod column;
mod combiner;
mod default;
mod named;
mod policy;
mod primitive;
mod rop;
mod shader;
mod texture;
mod vertices;

use std::sync::Arc;

pub use crate::named;
pub use combiner::{
    Bias, CombinerInput, Combiners, Component, FinalCombiner, FinalInput, FinalRegister, GeneralStage, InputMapping,
    MuxSelect, Portion, Register, Scale, StageOrigin,
};
pub use named::Named;
pub use policy::{
    DependentScale, DotRounding, ExpandCentre, HalfBiasConstant, LerpRounding, MuxNegative, OutputRounding, POLICIES,
    Policies, Policy, PolicyError, RegisterFloor, SumRounding,
};
pub use primitive::{
    ClipDepth, Cull, Fog, FogFunction, FogMode, FrontFace, Positions, ProvokingVertex, Rectangle, ShadeModel, Topology,
    Vertex, VertexColor, VertexProgram, Viewport,
};
pub use rop::{
    AlphaTest, Blend, BlendEquation, BlendFactor, CompareFunction, DepthBuffer, DepthFormat, DepthRange, DepthTest,
    PolygonOffset, StencilOperation, StencilTest, SurfaceFormat, Target, VertexDepths, WINDOW_CLIP_RECTANGLES,
    WindowClip, depth_of, depth_stencil, stencil_of,
};
pub use shader::{DotMapping, ShaderOperation, ShaderStage};
pub use texture::{
    AddressMode, BORDER_TEXELS, CUBE_FACES, ColorKey, ColorKeyMode, Filter, LARGEST_VOLUME, Level, MipFilter, Palette,
    ShadowComparison, ShadowReference, TEXTURE_UNITS, Texels, Texture, TextureFormat, TextureImage, TextureKind,
    TextureUnit, largest_anisotropy,
};
pub use vertices::{TriangleVertices, Vertices};

named! {
    /// Which chip is modelled: its limits and the rules that differ.
    pub enum Profile {
        /// GeForce 256 (NV10): two general stages, two texture units.
        Nv10,
        /// The Xbox's NV2A: eight general stages, four texture units, blue-to-alpha. The measured profile.
        Nv2a,
    }
}

impl Profile {
    /// General combiner stages available.
    pub fn general_stages(self) -> usize {
        match self {
            Profile::Nv10 => 2,
            Profile::Nv2a => 8,
        }
    }

    /// Texture units available.
    pub fn texture_units(self) -> usize {
        match self {
            Profile::Nv10 => 2,
            Profile::Nv2a => 4,
        }
    }
}

/// A scene: render targets, textures, and draws in order.
///
/// Every index is in range, every size within the [limits](crate::limits::Limits) and every combination legal for the profile; positions
/// are within the limits of RAS-0. [`Plan::compile`](crate::plan::Plan::compile) refuses a scene of which that is not so, wherever
/// it comes from. Columns of [`Vertices`] cannot be of different lengths.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The chip that draws, which decides what is legal.
    pub profile: Profile,
    /// Render targets; the first is the default one.
    pub targets: Vec<Target>,
    /// Textures, referred to by index from [`TextureUnit::texture`].
    pub textures: Vec<Texture>,
    /// Palettes, referred to by index from [`TextureUnit::palette`].
    pub palettes: Vec<Palette>,
    /// Draws in submission order.
    pub draws: Vec<Draw>,
}

/// One draw call with all of its state.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// Name for messages and traces.
    pub name: String,
    /// Index into [`Scene::targets`].
    pub target: usize,
    /// How positions are to be read.
    pub positions: Positions,
    /// The vertices, before they are assembled.
    pub vertices: Vertices,
    /// Indices into `vertices`, in the order of `topology`. The plan shares them.
    pub indices: Arc<[u32]>,
    /// How indices form triangles (RAS-4).
    pub topology: Topology,
    /// Smooth or flat colours (RAS-5).
    pub shade_model: ShadeModel,
    /// Which vertex gives the colour of a flat triangle (RAS-5).
    pub provoking_vertex: ProvokingVertex,
    /// Perspective-corrected weights (INT-1); off: screen-linear.
    pub perspective: bool,
    /// Which faces are dropped.
    pub cull: Cull,
    /// Which winding on screen is the front.
    pub front_face: FrontFace,
    /// Pixels outside are not drawn. `None`: the whole target.
    pub scissor: Option<Rectangle>,
    /// Rectangles that pixels are drawn inside of, or outside (CLP-1). `None`: the test is off.
    pub window_clip: Option<WindowClip>,
    /// Fog colour and whether the vertices' fog factor is used.
    pub fog: Fog,
    /// Texture units; `None` is an unbound unit (TEX-16).
    pub textures: [Option<TextureUnit>; TEXTURE_UNITS],
    /// What each unit does; [`ShaderStage::conventional`] unless a texture shader is given (nv2a).
    pub texture_shader: [ShaderStage; TEXTURE_UNITS],
    /// The program of each pixel.
    pub combiners: Combiners,
    /// What each general stage was written as; empty if the program was written for the combiners.
    pub program_origin: Vec<StageOrigin>,
    /// The vertex program that made the vertices, if one did.
    pub vertex_program: Option<VertexProgram>,
    /// Alpha test (ROP-1). `None`: every fragment passes.
    pub alpha_test: Option<AlphaTest>,
    /// Stencil test (STN-1). `None`: neither test nor write.
    pub stencil_test: Option<StencilTest>,
    /// Depth test (DEP-1, DEP-2). `None`: neither test nor write.
    pub depth_test: Option<DepthTest>,
    /// Blend (ROP-2 to ROP-4). `None`: the source replaces the destination.
    pub blend: Option<Blend>,
    /// Blend constant, R, G, B, A bytes (NUM-5).
    pub blend_constant: [u8; 4],
    /// Channels that are written, R, G, B, A (ROP-6).
    pub color_mask: [bool; 4],
}
