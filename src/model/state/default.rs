//! Default state: what a scene file means where it says nothing, and the base for draws that code describes by their
//! differences.

use super::*;
use std::sync::Arc;

impl Default for Scene {
    /// Returns an empty scene for [`Profile::Nv10`]. A render needs at least one target.
    fn default() -> Self {
        Scene { profile: Profile::Nv10, targets: vec![], textures: vec![], palettes: vec![], draws: vec![] }
    }
}

impl Target {
    /// Returns a target of `width` columns and `height` rows, cleared to zero, without a depth buffer.
    pub fn new(width: u32, height: u32, format: SurfaceFormat) -> Self {
        Target {
            name: "frame".into(),
            width,
            height,
            format,
            clear_color: [0; 4],
            contents: None,
            depth_contents: None,
            depth: None,
            clip: None,
        }
    }
}

impl Default for Draw {
    /// Returns a draw without vertices: window positions, triangles, smooth vertex colours, no texture, no test and no
    /// blending.
    ///
    /// No unit samples; [`Draw::texture`] binds a texture to a unit that does.
    fn default() -> Self {
        Draw {
            name: "draw".into(),
            target: 0,
            positions: Positions::Window,
            vertices: Vertices::new(),
            indices: Arc::default(),
            topology: Topology::Triangles,
            shade_model: ShadeModel::Smooth,
            provoking_vertex: ProvokingVertex::Last,
            perspective: true,
            cull: Cull::None,
            front_face: FrontFace::CounterClockwise,
            polygon_modes: PolygonModes::FILL,
            edge_flags: None,
            polygon_stipple: None,
            smooth_polygons: false,
            lines: Lines::default(),
            point_size: 8,
            point_sizes: None,
            point_rasterization: PointRasterization::Rectangular,
            point_sprite: false,
            scissor: None,
            window_clip: None,
            fog: Fog::default(),
            textures: [None; TEXTURE_UNITS],
            texture_shader: std::array::from_fn(|unit| ShaderStage::conventional(unit, false)),
            convert_yuv: false,
            combiners: Combiners::default(),
            program_origin: vec![],
            vertex_program: None,
            alpha_test: None,
            stencil_test: None,
            depth_test: None,
            blend: None,
            blend_constant: [0; 4],
            color_mask: [true; 4],
        }
    }
}

impl Vertex {
    /// Returns the default vertex at (x, y, 0, 1).
    pub fn at(x: f32, y: f32) -> Vertex {
        Vertex { position: [x, y, 0.0, 1.0], ..Vertex::default() }
    }
}

impl Draw {
    /// Returns the default draw of vertices, each once and in order: three of them make a triangle.
    pub fn from_vertices(vertices: impl Into<Vertices>) -> Draw {
        let vertices = vertices.into();
        // A plan takes far fewer than an index can name.
        let indices = (0..u32::try_from(vertices.len()).unwrap_or(u32::MAX)).collect();
        Draw { vertices, indices, ..Draw::default() }
    }

    /// Returns the default draw of a rectangle from the upper left corner of the target, whose sizes are in pixels. Over it s and t of every
    /// coordinate set run from 0 to 1.
    pub fn rectangle(width: f32, height: f32) -> Draw {
        let corner =
            |(x, s), (y, t)| Vertex { texture_coordinates: [[s, t, 0.0, 1.0]; TEXTURE_UNITS], ..Vertex::at(x, y) };
        let ([left, right], [top, bottom]) = ([(0.0, 0.0), (width, 1.0)], [(0.0, 0.0), (height, 1.0)]);
        let corners = vec![corner(left, top), corner(right, top), corner(left, bottom), corner(right, bottom)];
        Draw { topology: Topology::TriangleStrip, ..Draw::from_vertices(corners) }
    }

    /// Returns the draw with a texture bound to unit `index`, which samples it with coordinate set `index`. A unit that does something else by the
    /// texture shader goes on doing it, with this texture.
    ///
    /// # Panics
    /// Panics if `index` is not below [`TEXTURE_UNITS`].
    #[must_use]
    pub fn texture(mut self, index: usize, unit: TextureUnit) -> Draw {
        self.textures[index] = Some(unit);
        if self.texture_shader[index].operation == ShaderOperation::None {
            self.texture_shader[index] = ShaderStage::conventional(index, true);
        }
        self
    }
}

impl Default for Lines {
    /// Returns rectangles of one pixel's width.
    fn default() -> Self {
        Lines { width: 8, rasterization: LineRasterization::Rectangular }
    }
}

impl Default for Fog {
    /// Returns disabled, black fog.
    fn default() -> Self {
        Fog { enabled: false, color: [0; 3], function: None }
    }
}

impl Default for GeneralStage {
    /// Returns a stage that writes nothing.
    fn default() -> Self {
        GeneralStage::idle([[0; 4]; 2])
    }
}

impl Default for FinalCombiner {
    /// Returns black with the alpha of SPARE0, and with the colour sum limited to 1.0. That is what `final_combiner:
    /// ()` means in a scene.
    fn default() -> Self {
        FinalCombiner {
            inputs: [FinalInput::zero(Component::Rgb); 6],
            g: FinalInput { register: FinalRegister::Spare0, ..FinalInput::zero(Component::Alpha) },
            color_sum_clamp: true,
            invert_spare0: false,
            invert_secondary: false,
            constants: [[0; 4]; 2],
        }
    }
}

impl FinalCombiner {
    /// Returns a final combiner whose fragment is `register`: D reads its RGB and G its alpha. Although the fog
    /// register has no alpha in G, the input reads it anyway.
    pub fn showing(register: FinalRegister) -> Self {
        let mut shown = FinalCombiner { color_sum_clamp: false, ..FinalCombiner::default() };
        (shown.inputs[3].register, shown.g.register) = (register, register);
        shown
    }
}

impl Default for Combiners {
    /// Returns OpenGL's initial program: one stage that copies the primary colour to SPARE0, and
    /// [`FinalCombiner::initial`].
    fn default() -> Self {
        Combiners {
            stages: vec![GeneralStage::initial([[0; 4]; 2])],
            mux_select: MuxSelect::Msb,
            final_combiner: FinalCombiner::initial([[0; 4]; 2]),
        }
    }
}

impl Combiners {
    /// Returns a program without general arithmetic whose fragment is [`register`](FinalCombiner::showing).
    pub fn showing(register: FinalRegister) -> Self {
        Combiners {
            stages: vec![GeneralStage::default()],
            mux_select: MuxSelect::Msb,
            final_combiner: FinalCombiner::showing(register),
        }
    }
}
