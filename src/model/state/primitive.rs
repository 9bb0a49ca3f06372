//! Vertices and how they become triangles.

use super::named;

named! {
    /// How a list of indices forms triangles (RAS-4).
    pub enum Topology {
        /// Three indices each.
        Triangles,
        /// Triangle i: even (i, i+1, i+2), odd (i+1, i, i+2).
        TriangleStrip,
        /// Triangle i: (0, i, i+1).
        TriangleFan,
        /// Four indices each: (0, 1, 2) (0, 2, 3).
        Quads,
        /// Two more indices each: (0, 1, 2) (2, 1, 3).
        QuadStrip,
        /// One polygon: (0, i, i+1).
        Polygon,
    }
}
named! {
    /// Smooth or flat colours.
    pub enum ShadeModel {
        /// Colours are interpolated.
        Smooth,
        /// The provoking vertex's colours hold for the whole triangle.
        Flat,
    }
}
named! {
    /// Which vertex provides flat colours (RAS-5). Quads, quad strips and polygons ignore it.
    pub enum ProvokingVertex {
        /// The first vertex of the primitive.
        First,
        /// The last vertex of the primitive.
        Last,
    }
}
named! {
    /// Faces that are dropped.
    pub enum Cull {
        /// All faces are drawn.
        None,
        /// Front faces are dropped.
        Front,
        /// Back faces are dropped.
        Back,
    }
}
named! {
    /// The winding, on screen with y down as the viewer sees it, that makes a front face.
    pub enum FrontFace {
        /// Counter-clockwise triangles face the viewer.
        CounterClockwise,
        /// Clockwise triangles face the viewer.
        Clockwise,
    }
}

named! {
    /// Depths of clip space before the division by w.
    pub enum ClipDepth {
        /// -w to w, as of OpenGL's projections.
        MinusOneToOne,
        /// 0 to w, as of Direct3D's.
        ZeroToOne,
    }
}

/// How [`Vertex::position`] is to be read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Positions {
    /// Window x, y in pixels (origin top left, y down), depth 0..1, and w.
    Window,
    /// Clip-space x, y, z, w: clipped (RAS-6), divided by w and mapped by the viewport in f32 (RAS-0).
    Clip(Viewport),
}

/// Maps normalised device coordinates to the window: x' = x + (ndc.x + 1) * width / 2, y' = y + (1 - ndc.y) * height / 2,
/// z' = near + (ndc.z + 1) * (far - near) / 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Left edge, pixels.
    pub x: f32,
    /// Top edge, pixels.
    pub y: f32,
    /// Pixels across; may be a fraction.
    pub width: f32,
    /// Pixels down; may be a fraction.
    pub height: f32,
    /// Depth of ndc.z = -1.
    pub near: f32,
    /// Depth of ndc.z = 1.
    pub far: f32,
    /// Where the near plane lies (RAS-6). The mapping is the one above in any case.
    pub clip_depth: ClipDepth,
    /// Nothing is clipped at the near and the far plane: depths of vertices are limited to 0..1 instead (RAS-6).
    pub depth_clamp: bool,
}

/// A vertex colour as it was given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VertexColor {
    /// R, G, B, A bytes, used as they are.
    Bytes([u8; 4]),
    /// R, G, B, A floats, converted by NUM-4.
    Floats([f32; 4]),
}

/// A vertex in clip or window coordinates, with all its attributes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position, read as [`Positions`] says.
    pub position: [f32; 4],
    /// Diffuse: the primary colour. Absent in a scene: white, opaque.
    pub diffuse: VertexColor,
    /// Specular: the secondary colour. Absent in a scene: zero.
    pub specular: VertexColor,
    /// What the rasteriser interpolates for fog: a factor, 0 (all fog) to 1 (no fog), or with a [fog function](FogFunction) the d' or e that
    /// the vertex side made of the coordinate (FOG-2, FOG-3, INT-5n); then it need not be finite.
    pub fog: f32,
    /// The fog coordinate that `fog` was made of, for the float64 ideal and for traces; `None`: the ideal starts from `fog`.
    pub fog_coordinate: Option<f32>,
    /// Four coordinate sets of s, t, r, q. Absent components are 0, 0, 0, 1.
    pub texture_coordinates: [[f32; 4]; 4],
}

impl Default for Vertex {
    fn default() -> Self {
        Vertex {
            position: [0.0, 0.0, 0.0, 1.0],
            diffuse: VertexColor::Bytes([255; 4]),
            specular: VertexColor::Bytes([0; 4]),
            fog: 1.0,
            fog_coordinate: None,
            texture_coordinates: [[0.0, 0.0, 0.0, 1.0]; 4],
        }
    }
}

/// The vertex program that made the vertices of a draw. Only reports read it: the vertices are there already.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VertexProgram {
    /// The program in its language, without comments.
    pub text: String,
    /// The number of its instructions.
    pub instructions: usize,
    /// The number of instruction slots that they take.
    pub slots: usize,
    /// It writes oFog.
    pub writes_fog: bool,
}

named! {
    /// The curve of a [`FogFunction`]: the factor as a real function of the coordinate d, x being p0 + p1 d + p2 d^2 - 3/2 (FOG-2, FOG-4).
    pub enum FogMode {
        /// p0 + p1 d - 1.
        Linear,
        /// 2^(16 x), 1 above 0.
        Exp,
        /// 2^(-32 x^2).
        Exp2,
        /// `Linear` of the magnitude of d.
        LinearAbs,
        /// 2^(-16 |x|).
        ExpAbs,
        /// 2^(-32 x^2).
        Exp2Abs,
    }
}

impl FogMode {
    /// The factor is a straight line.
    pub fn is_linear(self) -> bool {
        matches!(self, FogMode::Linear | FogMode::LinearAbs)
    }
}

/// Fog of a coordinate d: coefficients at the vertices or, of linear fog, at each pixel, and a curve at each pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogFunction {
    /// How the coordinate becomes a factor.
    pub mode: FogMode,
    /// First parameter, the bias.
    pub p0: f32,
    /// Second parameter, the multiplier of d.
    pub p1: f32,
    /// Third parameter, the multiplier of d^2; it has no part in linear fog whose coefficients act at the pixels.
    pub p2: f32,
    /// Linear fog too has its coefficients applied at the vertices, which pass e: nv10, and nv2a where a draw asks for it (INT-5n).
    pub per_vertex: bool,
}

impl FogFunction {
    /// Whether the vertices pass e and not d' (FOG-2, FOG-3, INT-5n).
    pub fn takes_e(&self) -> bool {
        self.per_vertex || !self.mode.is_linear()
    }
}

/// Fog colour, and how the fog of the vertices reaches FOG.a (off: 255).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// The fog of the vertices is used.
    pub enabled: bool,
    /// R, G, B bytes of the fog register.
    pub color: [u8; 3],
    /// What it goes through (FOG-2 to FOG-5); `None`: the vertices give factors, which are interpolated (INT-5n).
    pub function: Option<FogFunction>,
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// Its first column.
    pub x: u32,
    /// Its first row.
    pub y: u32,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
}
