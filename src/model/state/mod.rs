//! Decoded hardware state: what the chip is told to do, in its own terms.
//!
//! State is plain data with exhaustive enums and public fields; nothing here renders, parses or fails. The scene front
//! end produces a [`Scene`], the [plan](crate::plan) reduces it to what can reach the frame, and the independent oracle
//! of the test suite reads it directly. State knows neither RON nor image files.

mod column;
mod combiner;
mod default;
mod inputs;
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
    ClipDepth, Cull, Fog, FogFunction, FogMode, FrontFace, LARGEST_SIZE, LineRasterization, Lines, PointRasterization,
    PolygonMode, PolygonModes, PolygonStipple, Positions, ProvokingVertex, Rectangle, SPRITE_UNIT, ShadeModel,
    Topology, Vertex, VertexColor, VertexProgram, Viewport,
};
pub use rop::{
    AlphaTest, Blend, BlendEquation, BlendFactor, Buffer, CompareFunction, DepthBuffer, DepthFormat, DepthRange,
    DepthTest, PolygonOffset, StencilOperation, StencilTest, SurfaceFormat, Target, VertexDepths,
    WINDOW_CLIP_RECTANGLES, WindowClip, depth_of, depth_stencil, stencil_of,
};
pub use shader::{DotMapping, ShaderOperation, ShaderStage};
pub use texture::{
    AddressMode, BORDER_TEXELS, CUBE_FACES, ColorKey, ColorKeyMode, Filter, LARGEST_VOLUME, Level, MipFilter, Palette,
    ShadowComparison, ShadowReference, TEXTURE_UNITS, Texels, Texture, TextureFormat, TextureImage, TextureKind,
    TextureUnit, largest_anisotropy,
};
pub use vertices::{TriangleVertices, Vertices};

named! {
    /// The chip that is modelled. It decides the limits and which variant of a rule applies.
    pub enum Profile {
        /// GeForce 256 (NV10): two general stages and two texture units.
        Nv10,
        /// The Xbox's NV2A: eight general stages, four texture units, and blue-to-alpha outputs. Its rules were
        /// measured.
        Nv2a,
    }
}

impl Profile {
    /// Returns the number of general combiner stages that the chip has.
    pub fn general_stages(self) -> usize {
        match self {
            Profile::Nv10 => 2,
            Profile::Nv2a => 8,
        }
    }

    /// Returns the number of texture units that the chip has.
    pub fn texture_units(self) -> usize {
        match self {
            Profile::Nv10 => 2,
            Profile::Nv2a => 4,
        }
    }
}

/// A scene: render targets, textures, and draws in order.
///
/// A valid scene has every index in range, every size within the [limits](crate::limits::Limits), only combinations
/// that are legal for the profile, and positions within the limits of RAS-0.
/// [`Plan::compile`](crate::plan::Plan::compile) refuses any other scene, however it was made. The columns of
/// [`Vertices`] cannot differ in length.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The chip that draws. It decides what is legal.
    pub profile: Profile,
    /// Render targets. The first is the default target.
    pub targets: Vec<Target>,
    /// Textures. [`TextureUnit::texture`] is an index into this list.
    pub textures: Vec<Texture>,
    /// Palettes. [`TextureUnit::palette`] is an index into this list.
    pub palettes: Vec<Palette>,
    /// Draws in submission order.
    pub draws: Vec<Draw>,
}

/// One draw call with all of its state.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// Name that messages and traces show.
    pub name: String,
    /// The target that is drawn to, as an index into [`Scene::targets`].
    pub target: usize,
    /// How the positions of the vertices are interpreted.
    pub positions: Positions,
    /// The vertices, before triangles are assembled.
    pub vertices: Vertices,
    /// Indices into `vertices`, in the order that `topology` requires. The plan shares them.
    pub indices: Arc<[u32]>,
    /// How the indices form triangles (RAS-4), lines or points.
    pub topology: Topology,
    /// Whether colours are interpolated or flat (RAS-5).
    pub shade_model: ShadeModel,
    /// Which vertex gives the colour of a flat triangle (RAS-5).
    pub provoking_vertex: ProvokingVertex,
    /// Whether weights are perspective-corrected (WGT-1); otherwise they are linear on the screen.
    pub perspective: bool,
    /// Which faces are culled.
    pub cull: Cull,
    /// Which winding on the screen makes a front face.
    pub front_face: FrontFace,
    /// What is drawn of triangles: their pixels, edges or corners.
    pub polygon_modes: PolygonModes,
    /// The edge flag of each vertex: whether its edge to the next one of a triangle, quad or polygon is drawn (POL-1). `None` means that all are.
    pub edge_flags: Option<Arc<[bool]>>,
    /// The pattern that filled triangles have. `None` means that all of their pixels are drawn.
    pub polygon_stipple: Option<PolygonStipple>,
    /// Whether filled triangles have smooth edges (SMO-1).
    pub smooth_polygons: bool,
    /// State of lines.
    pub lines: Lines,
    /// Size of points in 1/8 pixel, at most [`LARGEST_SIZE`] (PNT-1).
    pub point_size: u16,
    /// Size of the point at each vertex, in place of `point_size` (PNT-3).
    pub point_sizes: Option<Arc<[u16]>>,
    /// How points become pixels.
    pub point_rasterization: PointRasterization,
    /// Whether unit 3 takes s and t of a point from the pixel's place in it (PNT-2, nv2a).
    pub point_sprite: bool,
    /// Scissor rectangle: pixels outside are not drawn. `None` means the whole target.
    pub scissor: Option<Rectangle>,
    /// Window clip rectangles, inside or outside of which pixels are drawn (CLP-1). `None` turns the test off.
    pub window_clip: Option<WindowClip>,
    /// Fog colour, and whether the fog factor of the vertices is used.
    pub fog: Fog,
    /// Texture units. `None` is an unbound unit (TEX-16). [`Draw::texture`] binds one and lets it sample.
    pub textures: [Option<TextureUnit>; TEXTURE_UNITS],
    /// What each unit does: [`ShaderStage::conventional`] unless the draw has a texture shader (nv2a). A bound unit whose operation is
    /// [`ShaderOperation::None`] is not sampled.
    pub texture_shader: [ShaderStage; TEXTURE_UNITS],
    /// Whether R, G and B of all texture registers become those of the Y, Cb and Cr that they hold (TEX-19, nv2a).
    pub convert_yuv: bool,
    /// The combiner program, which computes each pixel.
    pub combiners: Combiners,
    /// The source text of each general stage. Empty if the program was written directly for the combiners.
    pub program_origin: Vec<StageOrigin>,
    /// The vertex program that computed the vertices, if one did.
    pub vertex_program: Option<VertexProgram>,
    /// Alpha test (ROP-1). `None` means that every fragment passes.
    pub alpha_test: Option<AlphaTest>,
    /// Stencil test (STN-1). `None` means that the stencil is neither tested nor written.
    pub stencil_test: Option<StencilTest>,
    /// Depth test (DEP-1, DEP-2). `None` means that the depth is neither tested nor written.
    pub depth_test: Option<DepthTest>,
    /// Blending (ROP-2 to ROP-4). `None` means that the source replaces the destination.
    pub blend: Option<Blend>,
    /// Blend constant as R, G, B, A bytes (NUM-5).
    pub blend_constant: [u8; 4],
    /// Colour mask: whether R, G, B and A are written (ROP-6).
    pub color_mask: [bool; 4],
}
