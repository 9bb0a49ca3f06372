//! Vertices, and how they form triangles.

use super::named;

named! {
    /// How a list of indices forms triangles (RAS-4), lines or points.
    pub enum Topology {
        /// Three indices for each triangle.
        Triangles,
        /// Triangle i is (i, i+1, i+2) if i is even and (i+1, i, i+2) if i is odd.
        TriangleStrip,
        /// Triangle i is (0, i, i+1).
        TriangleFan,
        /// Four indices for each quad, which is the triangles (0, 1, 2) and (0, 2, 3).
        Quads,
        /// Two more indices for each quad, which is the triangles (0, 1, 2) and (2, 1, 3).
        QuadStrip,
        /// One polygon, whose triangle i is (0, i, i+1).
        Polygon,
        /// One index for each point.
        Points,
        /// Two indices for each line.
        Lines,
        /// Line i is (i, i+1).
        LineStrip,
        /// A strip, and the line from the last index to the first.
        LineLoop,
    }
}

impl Topology {
    /// Returns whether it forms triangles, which have faces and are filled.
    pub fn has_faces(self) -> bool {
        !matches!(self, Topology::Points | Topology::Lines | Topology::LineStrip | Topology::LineLoop)
    }
}

named! {
    /// How lines become pixels.
    pub enum LineRasterization {
        /// A rectangle as wide as the line (LIN-1).
        Rectangular,
        /// One pixel for each step of the longer axis, whatever the width (LIN-2).
        Bresenham,
        /// A rectangle with smooth edges (SMO-1).
        RectangularSmooth,
    }
}

/// State of lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lines {
    /// Width in 1/8 pixel, at most [`LARGEST_SIZE`].
    pub width: u16,
    /// How they become pixels.
    pub rasterization: LineRasterization,
}

named! {
    /// How points become pixels (PNT-1).
    pub enum PointRasterization {
        /// A square as wide as the point.
        Rectangular,
        /// One pixel, whatever the size.
        Thin,
    }
}

/// Largest width of a line and largest size of a point, in 1/8 pixel: the registers have nine bits.
pub const LARGEST_SIZE: u16 = 0x1ff;

named! {
    /// What is drawn of a triangle.
    pub enum PolygonMode {
        /// Its pixels.
        Fill,
        /// Its edges, as lines.
        Line,
        /// Its corners, as points.
        Point,
    }
}

/// What is drawn of triangles on each of their sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PolygonModes {
    /// Of triangles that face the viewer.
    pub front: PolygonMode,
    /// Of the others.
    pub back: PolygonMode,
}

impl PolygonModes {
    /// Both sides are filled.
    pub const FILL: PolygonModes = PolygonModes { front: PolygonMode::Fill, back: PolygonMode::Fill };
}

/// The unit whose coordinates sprites have (PNT-2).
pub const SPRITE_UNIT: usize = 3;

/// A pattern of 32 x 32 pixels, which repeats: where its bit is 0, filled triangles are not drawn (STP-1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PolygonStipple(pub [u32; 32]);

named! {
    /// Whether colours are interpolated.
    pub enum ShadeModel {
        /// Colours are interpolated.
        Smooth,
        /// The whole triangle has the colours of its provoking vertex.
        Flat,
    }
}
named! {
    /// The vertex that provides flat colours (RAS-5). Quads, quad strips and polygons ignore it.
    pub enum ProvokingVertex {
        /// The first vertex of the primitive.
        First,
        /// The last vertex of the primitive.
        Last,
    }
}
named! {
    /// Faces that are culled.
    pub enum Cull {
        /// All faces are drawn.
        None,
        /// Front faces are culled.
        Front,
        /// Back faces are culled.
        Back,
    }
}
named! {
    /// The winding that makes a front face, as the viewer sees it on a screen whose y points down.
    pub enum FrontFace {
        /// Counter-clockwise triangles face the viewer.
        CounterClockwise,
        /// Clockwise triangles face the viewer.
        Clockwise,
    }
}

named! {
    /// Range of clip-space z before the division by w.
    pub enum ClipDepth {
        /// -w to w, as OpenGL's projections produce.
        MinusOneToOne,
        /// 0 to w, as Direct3D's projections produce.
        ZeroToOne,
    }
}

/// How [`Vertex::position`] is interpreted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Positions {
    /// Window x and y in pixels (origin at the top left, y down), depth from 0 to 1, and w.
    Window,
    /// Clip-space x, y, z, w, which are clipped (RAS-6), divided by w and mapped by the viewport in f32 (RAS-0).
    Clip(Viewport),
}

/// The mapping of normalised device coordinates to the window: x' = x + (ndc.x + 1) * width / 2, y' = y + (1 - ndc.y) *
/// height / 2, z' = near + (ndc.z + 1) * (far - near) / 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Left edge in pixels.
    pub x: f32,
    /// Top edge in pixels.
    pub y: f32,
    /// Width in pixels. It may be a fraction.
    pub width: f32,
    /// Height in pixels. It may be a fraction.
    pub height: f32,
    /// Depth of ndc.z = -1.
    pub near: f32,
    /// Depth of ndc.z = 1.
    pub far: f32,
    /// Where the near plane lies (RAS-6). It does not change the mapping above.
    pub clip_depth: ClipDepth,
    /// Whether depths of vertices are limited to 0..1 instead of triangles being clipped at the near and the far plane
    /// (RAS-6).
    pub depth_clamp: bool,
}

/// A vertex colour in the form in which it was given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VertexColor {
    /// R, G, B, A bytes, which are used without conversion.
    Bytes([u8; 4]),
    /// R, G, B, A floats, which NUM-4 converts.
    Floats([f32; 4]),
}

/// A vertex in clip or window coordinates with all its attributes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position, interpreted as [`Positions`] says.
    pub position: [f32; 4],
    /// Diffuse, the primary colour. A scene that omits it means opaque white.
    pub diffuse: VertexColor,
    /// Specular, the secondary colour. A scene that omits it means zero.
    pub specular: VertexColor,
    /// The value that the rasteriser interpolates for fog. Without a [fog function](FogFunction) it is a factor from 0
    /// (all fog) to 1 (no fog). With one it is the d' or e that the vertex side computed from the fog coordinate
    /// (FOG-2, FOG-3, INT-5n) and need not be finite.
    pub fog: f32,
    /// The fog coordinate that `fog` was computed from, for the float64 ideal and for traces. If `None`, the ideal
    /// starts from `fog`.
    pub fog_coordinate: Option<f32>,
    /// Four coordinate sets of s, t, r, q. Omitted components are 0, 0, 0, 1.
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

/// The vertex program that computed the vertices of a draw. Only reports read it, because the vertices are computed
/// already.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VertexProgram {
    /// The program in its own language, without comments.
    pub text: String,
    /// Number of instructions.
    pub instructions: usize,
    /// Number of instruction slots that the instructions take.
    pub slots: usize,
    /// Whether the program writes oFog.
    pub writes_fog: bool,
}

named! {
    /// The curve of a [`FogFunction`]: the factor as a real function of the coordinate d, where x is p0 + p1 d + p2 d^2
    /// - 3/2 (FOG-2, FOG-4).
    pub enum FogMode {
        /// p0 + p1 d - 1.
        Linear,
        /// 2^(16 x), limited to 1 where x is positive.
        Exp,
        /// 2^(-32 x^2), for x of either sign.
        Exp2,
        /// [`Linear`](FogMode::Linear) of |d|.
        LinearAbs,
        /// 2^(-16 |x|), for x of either sign.
        ExpAbs,
        /// 2^(-32 x^2), the same curve as [`Exp2`](FogMode::Exp2).
        Exp2Abs,
    }
}

impl FogMode {
    /// Returns whether the factor is linear in the coordinate.
    pub fn is_linear(self) -> bool {
        matches!(self, FogMode::Linear | FogMode::LinearAbs)
    }
}

/// Fog as a function of a coordinate d. The coefficients apply at the vertices or, for linear fog, at each pixel; the
/// curve applies at each pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogFunction {
    /// The curve, which turns the coordinate into a factor.
    pub mode: FogMode,
    /// First parameter, the bias.
    pub p0: f32,
    /// Second parameter, the multiplier of d.
    pub p1: f32,
    /// Third parameter, the multiplier of d^2. It does not affect linear fog whose coefficients apply at the pixels.
    pub p2: f32,
    /// Whether the coefficients of linear fog also apply at the vertices, which then pass e: on nv10, and on nv2a if a
    /// draw asks for it (INT-5n).
    pub per_vertex: bool,
}

impl FogFunction {
    /// Returns whether the vertices pass e instead of d' (FOG-2, FOG-3, INT-5n).
    pub fn takes_e(&self) -> bool {
        self.per_vertex || !self.mode.is_linear()
    }

    /// Returns the coordinate of a vertex, if it is known: a vertex that passes e may not say what it is of.
    pub fn coordinate(&self, vertex: &Vertex) -> Option<f32> {
        vertex.fog_coordinate.or((!self.takes_e()).then_some(vertex.fog))
    }
}

/// Fog colour, and how the fog of the vertices becomes FOG.a. FOG.a is 255 if fog is disabled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Whether the fog of the vertices is used.
    pub enabled: bool,
    /// R, G, B bytes of the fog register.
    pub color: [u8; 3],
    /// The function that the coordinate goes through (FOG-2 to FOG-5). If `None`, the vertices give factors, which are
    /// interpolated (INT-5n).
    pub function: Option<FogFunction>,
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// Column of the leftmost pixels.
    pub x: u32,
    /// Row of the topmost pixels.
    pub y: u32,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}

impl Rectangle {
    /// Returns the pixels that two rectangles have in common. The first must end within 32 bits.
    #[must_use]
    pub fn intersection(self, other: Rectangle) -> Rectangle {
        let axis = |a: u32, length: u32, b: u32, other: u32| {
            let end = a + length;
            let start = b.clamp(a, end);
            (start, b.saturating_add(other).clamp(start, end) - start)
        };
        let (x, width) = axis(self.x, self.width, other.x, other.width);
        let (y, height) = axis(self.y, self.height, other.y, other.height);
        Rectangle { x, y, width, height }
    }
}
