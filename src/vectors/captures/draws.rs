//! What the programs' draws have in common.

use super::{Drawn, SIZE, images};
use ninebit::state::*;
use ninebit_program::text;
use std::sync::Arc;

/// Source over destination, by the source's alpha.
pub(super) const OVER: Option<Blend> = Some(Blend {
    equation: BlendEquation::Add,
    source: BlendFactor::SourceAlpha,
    destination: BlendFactor::OneMinusSourceAlpha,
});

/// The frame buffer, cleared to a word A8R8G8B8.
pub(super) fn frame_buffer(clear: u32) -> Target {
    Target { clear_color: argb(clear), ..Target::new(SIZE.0, SIZE.1, SurfaceFormat::A8R8G8B8) }
}

/// A scene of the chip that the captures are of.
pub(super) fn scene(targets: Vec<Target>, textures: Vec<Texture>, draws: Vec<Draw>) -> Scene {
    Scene { profile: Profile::Nv2a, targets, textures, draws, ..Scene::default() }
}

/// A program in the combiner language; one that cannot be read shows nothing.
pub(super) fn program(text: &str) -> Combiners {
    text::read(text).map(|program| program.combiners).unwrap_or_default()
}

/// A program whose fragment is the colour of a register, with alpha 1.
pub(super) fn opaque(register: FinalRegister) -> Combiners {
    let mut combiners = Combiners::showing(register);
    let g = &mut combiners.final_combiner.g;
    (g.register, g.invert) = (FinalRegister::Zero, true);
    combiners
}

/// A program whose fragment has the colour of a register and the alpha of the primary colour.
pub(super) fn with_primary_alpha(register: FinalRegister) -> Combiners {
    let mut combiners = Combiners::showing(register);
    combiners.final_combiner.g.register = FinalRegister::PrimaryColor;
    combiners
}

/// A white vertex with coordinates.
pub(super) fn placed(position: [f32; 4], at: [f32; 2]) -> Vertex {
    let diffuse = VertexColor::Bytes([255; 4]);
    Vertex { position, diffuse, texture_coordinates: coordinates(at), ..Vertex::default() }
}

/// Coordinates of all units.
pub(super) fn coordinates([s, t]: [f32; 2]) -> [[f32; 4]; TEXTURE_UNITS] {
    [[s, t, 0.0, 1.0]; TEXTURE_UNITS]
}

/// A vertex at a window position.
pub(super) fn vertex([x, y]: [f32; 2], diffuse: VertexColor) -> Vertex {
    Vertex { position: [x, y, 0.0, 1.0], diffuse, ..Vertex::default() }
}

/// Vertices in their order, blended; the fragment is the primary colour.
pub(super) fn draw(topology: Topology, vertices: Vec<Vertex>) -> Draw {
    Draw {
        indices: (0..vertices.len() as u32).collect::<Arc<[u32]>>(),
        vertices: vertices.into(),
        topology,
        combiners: Combiners::showing(FinalRegister::PrimaryColor),
        blend: OVER,
        ..Draw::default()
    }
}

/// Quads at window positions, in one colour, blended; the fragment is a register.
pub(super) fn quads(corners: &[[f32; 2]], color: VertexColor, shows: FinalRegister) -> Draw {
    let vertices = corners.iter().map(|corner| vertex(*corner, color)).collect();
    Draw { combiners: Combiners::showing(shows), ..draw(Topology::Quads, vertices) }
}

/// Corners of a rectangle, clockwise from the upper left.
pub(super) fn corners([left, top, right, bottom]: [f32; 4]) -> [[f32; 2]; 4] {
    [[left, top], [right, top], [right, bottom], [left, bottom]]
}

/// A rectangle, given by its edges.
pub(super) fn rectangle(edges: [f32; 4], color: VertexColor) -> Draw {
    quads(&corners(edges), color, FinalRegister::PrimaryColor)
}

/// How far the programs' inverse of the viewport lies off, in pixels: positions that went through it have this added.
pub(super) const UNPROJECTED: f32 = 0.53125;

/// A rectangle through the programs' inverse of the viewport.
pub(super) fn unprojected(edges: [f32; 4]) -> [f32; 4] {
    edges.map(|edge| edge + UNPROJECTED)
}

/// Upper left corner and sides as edges.
pub(super) fn sized([left, top]: [f32; 2], [width, height]: [f32; 2]) -> [f32; 4] {
    [left, top, left + width, top + height]
}

/// Places row by row from the upper left one on, so many in a row.
pub(super) fn places([left, top]: [f32; 2], [across, down]: [f32; 2], columns: u8) -> impl Iterator<Item = [f32; 2]> {
    (0..).map(move |n: u8| [left + across * f32::from(n % columns), top + down * f32::from(n / columns)])
}

/// A test of depths in steps of the buffer.
pub(super) fn in_steps(function: CompareFunction, writes: bool, range: Option<DepthRange>) -> DepthTest {
    DepthTest { vertex_depths: VertexDepths::Steps, range, ..DepthTest::new(function, writes) }
}

/// The register that a unit fetches into.
pub(super) const FETCHED: [FinalRegister; TEXTURE_UNITS] =
    [FinalRegister::Texture0, FinalRegister::Texture1, FinalRegister::Texture2, FinalRegister::Texture3];

/// A white rectangle that shows the texture of a unit: coordinates at its edges.
pub(super) fn pasted(edges: [f32; 4], unit: usize, state: TextureUnit, texels: [f32; 4]) -> Draw {
    textured(rectangle(edges, VertexColor::Bytes([255; 4])), unit, state, corners(texels))
}

/// The draw so far away.
pub(super) fn far(mut draw: Draw, w: f32) -> Draw {
    draw.vertices.update(|_, vertex| vertex.position[3] = w);
    draw
}

/// Coordinates of a whole texture whose size counts as 1.
pub(super) const WHOLE: [f32; 4] = [0.0, 0.0, 1.0, 1.0];

/// The draw with a fragment of alpha 1.
pub(super) fn without_alpha(draw: Draw, shows: FinalRegister) -> Draw {
    Draw { combiners: opaque(shows), ..draw }
}

/// A word A8B8G8R8 as a colour of bytes.
pub(super) fn abgr(word: u32) -> [u8; 4] {
    word.to_le_bytes()
}

/// A word A8R8G8B8 as a colour of bytes.
pub(super) fn argb(word: u32) -> [u8; 4] {
    let [b, g, r, a] = word.to_le_bytes();
    [r, g, b, a]
}

/// A depth buffer that is cleared to the farthest.
pub(super) const FAR_DEPTHS: DepthBuffer =
    DepthBuffer { format: DepthFormat::Z24S8, clear: 0xff_ffff, clear_stencil: 0 };

/// A draw alone, and its texture. Depths that it tests begin as the farthest.
pub(super) fn one(clear: u32, texture: Option<&Texture>, draw: Draw) -> Drawn {
    let depth = draw.depth_test.is_some().then_some(FAR_DEPTHS);
    let target = Target { depth, ..frame_buffer(clear) };
    Drawn::colors(scene(vec![target], texture.into_iter().cloned().collect(), vec![draw]))
}

/// What is drawn, in which textures and targets stand under the numbers that they are given here.
#[derive(Default)]
pub(super) struct Canvas {
    scene: Scene,
}

impl Canvas {
    /// The frame buffer, cleared to a word A8R8G8B8.
    pub(super) fn new(clear: u32) -> Canvas {
        Canvas { scene: scene(vec![frame_buffer(clear)], vec![], vec![]) }
    }

    /// The frame buffer.
    pub(super) fn frame_buffer(&mut self) -> &mut Target {
        &mut self.scene.targets[0]
    }

    pub(super) fn texture(&mut self, texture: &Texture) -> usize {
        self.scene.textures.push(texture.clone());
        self.scene.textures.len() - 1
    }

    pub(super) fn palette(&mut self, entries: impl Iterator<Item = u32>) -> usize {
        let name = format!("palette {}", self.scene.palettes.len());
        self.scene.palettes.push(Palette { name, entries: entries.collect() });
        self.scene.palettes.len() - 1
    }

    pub(super) fn target(&mut self, target: Target) -> usize {
        let name = format!("target {}", self.scene.targets.len());
        self.scene.targets.push(Target { name, ..target });
        self.scene.targets.len() - 1
    }

    /// Another target that begins as an image of its size, and its draws.
    pub(super) fn painted(
        &mut self,
        first: &Texture,
        format: SurfaceFormat,
        draws: impl IntoIterator<Item = Draw>,
    ) -> usize {
        let TextureImage::Texels(Texels { width, height, words, .. }) = &first.image else { return 0 };
        let contents = Some(Arc::clone(words));
        let target = self.target(Target { contents, ..Target::new(*width, *height, format) });
        self.draw_into(target, draws);
        target
    }

    /// A texture that shows a target.
    pub(super) fn shown(&mut self, target: usize, kind: TextureKind, format: TextureFormat) -> usize {
        self.texture(&Texture { kind, ..target_texture(format, target) })
    }

    pub(super) fn draw(&mut self, draw: Draw) {
        self.scene.draws.push(draw);
    }

    pub(super) fn draw_into(&mut self, target: usize, draws: impl IntoIterator<Item = Draw>) {
        self.scene.draws.extend(draws.into_iter().map(|draw| Draw { target, ..draw }));
    }

    /// The colours of the frame buffer.
    pub(super) fn colors(self) -> Drawn {
        Drawn::colors(self.scene)
    }
}

/// A draw whose unit shows a texture by coordinates in texels: those of `texels` at its four vertices.
pub(super) fn textured(mut draw: Draw, unit: usize, state: TextureUnit, texels: [[f32; 2]; 4]) -> Draw {
    draw.vertices.update(|n, vertex| vertex.texture_coordinates = coordinates(texels[n]));
    fetching(draw, unit, state)
}

/// The draw whose fragment is what a unit fetches from a texture.
pub(super) fn fetching(draw: Draw, unit: usize, state: TextureUnit) -> Draw {
    let mut draw = Draw { combiners: Combiners::showing(FETCHED[unit]), ..draw };
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
    let words = (0..side * side).map(|at| texel(at % side, at / side)).collect();
    images::of_words(TextureKind::Rectangle, format, [side, side], 1, words)
}

/// A render target, read by coordinates in texels.
pub(super) fn target_texture(format: TextureFormat, target: usize) -> Texture {
    let (name, kind) = (String::from("target"), TextureKind::Rectangle);
    Texture { name, kind, format, image: TextureImage::Target { target } }
}
