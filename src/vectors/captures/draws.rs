//! What the programs' draws have in common.

use super::SIZE;
use ninebit::state::{
    AddressMode, Blend, BlendEquation, BlendFactor, Combiners, Draw, Filter, FinalRegister, Profile, Scene,
    ShaderStage, SurfaceFormat, TEXTURE_UNITS, Target, Texels, Texture, TextureFormat, TextureImage, TextureKind,
    TextureUnit, Topology, Vertex, VertexColor,
};
use std::sync::Arc;

/// Source over destination, by the source's alpha.
pub(super) const OVER: Option<Blend> = Some(Blend {
    equation: BlendEquation::Add,
    source: BlendFactor::SourceAlpha,
    destination: BlendFactor::OneMinusSourceAlpha,
});

/// The frame buffer, cleared to a word A8R8G8B8.
pub(super) fn frame_buffer(clear: u32) -> Target {
    let [b, g, r, a] = clear.to_le_bytes();
    Target { clear_color: [r, g, b, a], ..Target::new(SIZE.0, SIZE.1, SurfaceFormat::A8R8G8B8) }
}

/// A scene of the chip that the captures are of.
pub(super) fn scene(targets: Vec<Target>, textures: Vec<Texture>, draws: Vec<Draw>) -> Scene {
    Scene { profile: Profile::Nv2a, targets, textures, draws, ..Scene::default() }
}

/// A program whose fragment is the colour of a register, with alpha 1.
pub(super) fn opaque(register: FinalRegister) -> Combiners {
    let mut combiners = Combiners::showing(register);
    let g = &mut combiners.final_combiner.g;
    (g.register, g.invert) = (FinalRegister::Zero, true);
    combiners
}

/// A program whose fragment has the colour of a register and the alpha of the primary colour.
pub(super) fn opaque_alpha(register: FinalRegister) -> Combiners {
    let mut combiners = Combiners::showing(register);
    combiners.final_combiner.g.register = FinalRegister::PrimaryColor;
    combiners
}

/// Quads at window positions, in one colour, blended; the fragment is a register.
pub(super) fn quads(corners: &[[f32; 2]], color: VertexColor, shows: FinalRegister) -> Draw {
    let vertex = |[x, y]: &[f32; 2]| Vertex { position: [*x, *y, 0.0, 1.0], diffuse: color, ..Vertex::default() };
    let vertices: Vec<Vertex> = corners.iter().map(vertex).collect();
    let indices: Arc<[u32]> = (0..vertices.len() as u32).collect();
    Draw {
        vertices: vertices.into(),
        indices,
        topology: Topology::Quads,
        combiners: Combiners::showing(shows),
        blend: OVER,
        ..Draw::default()
    }
}

/// A rectangle, given by its edges.
pub(super) fn rectangle([left, top, right, bottom]: [f32; 4], color: VertexColor) -> Draw {
    let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
    quads(&corners, color, FinalRegister::PrimaryColor)
}

/// A draw whose first unit shows a texture by coordinates in texels: those of `texels` at its four vertices.
pub(super) fn textured(draw: Draw, unit: usize, state: TextureUnit, texels: [[f32; 2]; 4]) -> Draw {
    let mut vertices: Vec<Vertex> = (0..draw.vertices.len()).map(|n| draw.vertices.at(n)).collect();
    for (vertex, [s, t]) in vertices.iter_mut().zip(texels) {
        vertex.texture_coordinates = [[s, t, 0.0, 1.0]; TEXTURE_UNITS];
    }
    let mut draw = Draw { vertices: vertices.into(), ..draw };
    draw.textures[unit] = Some(state);
    draw.texture_shader[unit] = ShaderStage::conventional(unit, true);
    draw
}

/// A unit that reads a texture as it is.
pub(super) fn nearest(texture: usize) -> TextureUnit {
    TextureUnit {
        min_filter: Filter::Nearest,
        mag_filter: Filter::Nearest,
        address_s: AddressMode::ClampToEdge,
        address_t: AddressMode::ClampToEdge,
        ..TextureUnit::new(texture)
    }
}

/// An image whose coordinates are texels.
pub(super) fn linear_texture(format: TextureFormat, side: u32, texel: impl Fn(u32, u32) -> u32) -> Texture {
    rectangle_kind(format, (side, side), (0..side * side).map(|at| texel(at % side, at / side)).collect())
}

/// The same, of any sides.
pub(super) fn rectangle_kind(format: TextureFormat, (width, height): (u32, u32), words: Arc<[u32]>) -> Texture {
    let texels = Texels { width, height, levels: 1, layers: 1, border: false, words };
    let (name, kind, image) = (String::from("image"), TextureKind::Rectangle, TextureImage::Texels(texels));
    Texture { name, kind, format, image }
}

/// A render target, read by coordinates in texels.
pub(super) fn target_texture(format: TextureFormat, target: usize) -> Texture {
    let (name, kind) = (String::from("target"), TextureKind::Rectangle);
    Texture { name, kind, format, image: TextureImage::Target { target } }
}
