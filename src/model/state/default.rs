//! What is left out: the state that a scene file has without saying so, and a draw that code describes by what differs.

use super::*;
use std::sync::Arc;

impl Default for Scene {
    /// An empty scene for [`Profile::Nv10`]; a render needs a target.
    fn default() -> Self {
        Scene { profile: Profile::Nv10, targets: vec![], textures: vec![], palettes: vec![], draws: vec![] }
    }
}

impl Target {
    /// A target of so many columns and rows, cleared to zero, without a depth buffer.
    pub fn new(width: u32, height: u32, format: SurfaceFormat) -> Self {
        Target {
            name: "frame".into(),
            width,
            height,
            format,
            clear_color: [0; 4],
            contents: None,
            depth: None,
            clip: None,
        }
    }
}

impl Default for Draw {
    /// No vertices, window positions, triangles, smooth colours of the vertices; no texture, test or blend.
    ///
    /// [`Draw::texture_shader`] samples no unit: a draw with textures sets both, by [`ShaderStage::conventional`].
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
            scissor: None,
            window_clip: None,
            fog: Fog::default(),
            textures: [None; TEXTURE_UNITS],
            texture_shader: std::array::from_fn(|unit| ShaderStage::conventional(unit, false)),
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

impl Default for Fog {
    /// Fog that is off, and black.
    fn default() -> Self {
        Fog { enabled: false, color: [0; 3], function: None }
    }
}

impl Default for GeneralStage {
    /// A stage that writes nothing.
    fn default() -> Self {
        GeneralStage::idle([[0; 4]; 2])
    }
}

impl Default for FinalCombiner {
    /// Black, with the alpha of SPARE0; the colour sum is limited to 1.0. What a scene's `final_combiner: ()` means.
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
    /// rgb = D = the register, alpha = G = its alpha. The fog register has no alpha here; the input reads it all the same.
    pub fn showing(register: FinalRegister) -> Self {
        let mut shown = FinalCombiner { color_sum_clamp: false, ..FinalCombiner::default() };
        (shown.inputs[3].register, shown.g.register) = (register, register);
        shown
    }
}

impl Default for Combiners {
    /// OpenGL's initial program: one stage that copies the primary colour to SPARE0, then [`FinalCombiner::initial`].
    fn default() -> Self {
        Combiners {
            stages: vec![GeneralStage::initial([[0; 4]; 2])],
            mux_select: MuxSelect::Msb,
            final_combiner: FinalCombiner::initial([[0; 4]; 2]),
        }
    }
}

impl Combiners {
    /// A program without general arithmetic, whose fragment is a [register](FinalCombiner::showing).
    pub fn showing(register: FinalRegister) -> Self {
        Combiners {
            stages: vec![GeneralStage::default()],
            mux_select: MuxSelect::Msb,
            final_combiner: FinalCombiner::showing(register),
        }
    }
}
