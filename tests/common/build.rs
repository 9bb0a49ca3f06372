//! Scenes from few words: what the captured programs leave at its default, written once.

use ninebit::state::*;

/// A colour target.
pub fn target(width: u32, height: u32, format: SurfaceFormat, clear_color: [u8; 4]) -> Target {
    Target { name: "frame".to_string(), width, height, format, clear_color, depth: None }
}

/// A vertex in the window.
pub fn vertex(x: f32, y: f32, diffuse: [u8; 4]) -> Vertex {
    Vertex { position: [x, y, 0.0, 1.0], diffuse: VertexColor::Bytes(diffuse), ..Vertex::default() }
}

/// rgb = D = `register`, alpha = G = its alpha; one general stage that writes nothing.
pub fn shows(register: FinalRegister) -> Combiners {
    let mut inputs = [FinalInput::zero(Component::Rgb); 6];
    inputs[3].register = register;
    let final_combiner = FinalCombiner {
        inputs,
        g: FinalInput { register, component: Component::Alpha, invert: false },
        color_sum_clamp: false,
        invert_spare0: false,
        invert_secondary: false,
        constants: [[0; 4]; 2],
    };
    let stage = GeneralStage {
        rgb: Portion::idle(Component::Rgb),
        alpha: Portion::idle(Component::Alpha),
        constants: [[0; 4]; 2],
    };
    Combiners { stages: vec![stage], mux_select: MuxSelect::Msb, final_combiner }
}

/// A draw of `vertices` in order that stores the primary colour.
pub fn draw(topology: Topology, vertices: Vec<Vertex>) -> Draw {
    Draw {
        name: "draw".to_string(),
        target: 0,
        positions: Positions::Window,
        indices: (0..vertices.len() as u32).collect(),
        vertices: vertices.into(),
        topology,
        shade_model: ShadeModel::Smooth,
        provoking_vertex: ProvokingVertex::First,
        perspective: true,
        cull: Cull::None,
        front_face: FrontFace::CounterClockwise,
        scissor: None,
        fog: Fog { enabled: false, color: [0; 3], function: None },
        textures: [None; TEXTURE_UNITS],
        texture_shader: [0, 1, 2, 3].map(|unit| ShaderStage::conventional(unit, false)),
        combiners: shows(FinalRegister::PrimaryColor),
        program_origin: vec![],
        vertex_program: None,
        alpha_test: None,
        depth_test: None,
        blend: None,
        blend_constant: [0; 4],
        color_mask: [true; 4],
    }
}
