//! Building blocks that the programs' draws share.

use super::{FrameDrawing, SIZE, images};
use ninebit::state::*;
pub(super) use ninebit_program::registers::color_of as argb;
use ninebit_program::text;
use std::sync::Arc;

/// Blends source over destination by the source's alpha.
pub(super) const OVER: Option<Blend> = Some(Blend {
    equation: BlendEquation::Add,
    source: BlendFactor::SourceAlpha,
    destination: BlendFactor::OneMinusSourceAlpha,
});

/// Both sides of faces as lines.
pub(super) const WIREFRAME: PolygonModes = PolygonModes { front: PolygonMode::Line, back: PolygonMode::Line };

/// Returns the frame buffer as a target, cleared to an A8R8G8B8 word.
pub(super) fn frame_buffer(clear: u32) -> Target {
    Target { clear_color: argb(clear), ..Target::new(SIZE.0, SIZE.1, SurfaceFormat::A8R8G8B8) }
}

/// Returns a scene of the captured chip.
pub(super) fn scene(targets: Vec<Target>, textures: Vec<Texture>, draws: Vec<Draw>) -> Scene {
    Scene { profile: Profile::Nv2a, targets, textures, draws, ..Scene::default() }
}

/// Parses a program in the combiner language. Text that does not parse yields the default combiners, whose frame then differs.
pub(super) fn program(text: &str) -> Combiners {
    text::read(text).map(|program| program.combiners).unwrap_or_default()
}

/// Returns combiners that output the colour of a register with alpha 1.
pub(super) fn opaque(register: FinalRegister) -> Combiners {
    let mut combiners = Combiners::showing(register);
    let g = &mut combiners.final_combiner.g;
    (g.register, g.invert) = (FinalRegister::Zero, true);
    combiners
}

/// Returns combiners that output the colour of a register and the alpha of the primary colour.
pub(super) fn with_primary_alpha(register: FinalRegister) -> Combiners {
    let mut combiners = Combiners::showing(register);
    combiners.final_combiner.g.register = FinalRegister::PrimaryColor;
    combiners
}

/// Returns a white vertex with the same texture coordinates for all units.
pub(super) fn placed(position: [f32; 4], at: [f32; 2]) -> Vertex {
    let diffuse = VertexColor::Bytes([255; 4]);
    Vertex { position, diffuse, texture_coordinates: coordinates(at), ..Vertex::default() }
}

/// Returns texture coordinates s, t for all units.
pub(super) fn coordinates([s, t]: [f32; 2]) -> [[f32; 4]; TEXTURE_UNITS] {
    [[s, t, 0.0, 1.0]; TEXTURE_UNITS]
}

/// Returns a vertex at a window position, with w = 1.
pub(super) fn vertex([x, y]: [f32; 2], diffuse: VertexColor) -> Vertex {
    Vertex { position: [x, y, 0.0, 1.0], diffuse, ..Vertex::default() }
}

/// Returns a blended draw of vertices in the given order, which shows the primary colour.
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

/// Returns blended quads at window positions, in one colour, which show a register.
pub(super) fn quads(corners: &[[f32; 2]], color: VertexColor, shows: FinalRegister) -> Draw {
    let vertices = corners.iter().map(|corner| vertex(*corner, color)).collect();
    Draw { combiners: Combiners::showing(shows), ..draw(Topology::Quads, vertices) }
}

/// Returns the corners of a rectangle, clockwise from the upper left.
pub(super) fn corners([left, top, right, bottom]: [f32; 4]) -> [[f32; 2]; 4] {
    [[left, top], [right, top], [right, bottom], [left, bottom]]
}

/// Returns a rectangle of one colour, given its left, top, right and bottom edges.
pub(super) fn rectangle(edges: [f32; 4], color: VertexColor) -> Draw {
    quads(&corners(edges), color, FinalRegister::PrimaryColor)
}

/// Error of the programs' inverse viewport transform, in pixels: it is added to every position that went through it.
pub(super) const UNPROJECTED: f32 = 0.53125;

/// Moves edges as the programs' inverse viewport transform does.
pub(super) fn unprojected(edges: [f32; 4]) -> [f32; 4] {
    edges.map(|edge| edge + UNPROJECTED)
}

/// Returns the edges of a rectangle, given its upper left corner and its size.
pub(super) fn sized([left, top]: [f32; 2], [width, height]: [f32; 2]) -> [f32; 4] {
    [left, top, left + width, top + height]
}

/// Returns grid positions row by row, with `columns` in a row, from the upper left one on.
pub(super) fn places([left, top]: [f32; 2], [across, down]: [f32; 2], columns: u8) -> impl Iterator<Item = [f32; 2]> {
    (0..).map(move |n: u8| [left + across * f32::from(n % columns), top + down * f32::from(n / columns)])
}

/// Returns a depth test whose vertex depths are given in steps of the buffer.
pub(super) fn in_steps(function: CompareFunction, writes: bool, range: Option<DepthRange>) -> DepthTest {
    DepthTest { vertex_depths: VertexDepths::Steps, range, ..DepthTest::new(function, writes) }
}

/// The register that each unit fetches into.
pub(super) const FETCHED: [FinalRegister; TEXTURE_UNITS] =
    [FinalRegister::Texture0, FinalRegister::Texture1, FinalRegister::Texture2, FinalRegister::Texture3];

/// Returns a white rectangle that shows a unit's texture. `texels` are the texture coordinates at its edges.
pub(super) fn pasted(edges: [f32; 4], unit: usize, state: TextureUnit, texels: [f32; 4]) -> Draw {
    textured(rectangle(edges, VertexColor::Bytes([255; 4])), unit, state, corners(texels))
}

/// Returns the draw with `w` for every vertex.
pub(super) fn far(mut draw: Draw, w: f32) -> Draw {
    draw.vertices.update(|_, vertex| vertex.position[3] = w);
    draw
}

/// Edges of a whole texture in normalised coordinates.
pub(super) const WHOLE: [f32; 4] = [0.0, 0.0, 1.0, 1.0];

/// Returns the draw with combiners that output a register's colour and alpha 1.
pub(super) fn without_alpha(draw: Draw, shows: FinalRegister) -> Draw {
    Draw { combiners: opaque(shows), ..draw }
}

/// Converts an A8B8G8R8 word to R, G, B, A.
pub(super) fn abgr(word: u32) -> [u8; 4] {
    word.to_le_bytes()
}

/// A depth buffer that is cleared to the farthest depth.
pub(super) const FAR_DEPTHS: DepthBuffer =
    DepthBuffer { format: DepthFormat::Z24S8, clear: 0xff_ffff, clear_stencil: 0 };

/// Returns a frame of a single draw and its texture. If it tests depths, the buffer starts at the farthest depth.
pub(super) fn one(clear: u32, texture: Option<&Texture>, draw: Draw) -> FrameDrawing {
    let depth = draw.depth_test.is_some().then_some(FAR_DEPTHS);
    let target = Target { depth, ..frame_buffer(clear) };
    FrameDrawing::colors(scene(vec![target], texture.into_iter().cloned().collect(), vec![draw]))
}

/// A scene under construction. Methods that add textures, palettes and targets return their indices.
#[derive(Default)]
pub(super) struct Canvas {
    scene: Scene,
}

impl Canvas {
    /// Returns an empty scene whose frame buffer is cleared to an A8R8G8B8 word.
    pub(super) fn new(clear: u32) -> Canvas {
        Canvas { scene: scene(vec![frame_buffer(clear)], vec![], vec![]) }
    }

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

    /// Adds a target that starts out as an image and has that image's size, and its draws. Returns its index.
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

    /// Adds a texture that reads a target. Returns its index.
    pub(super) fn shown(&mut self, target: usize, kind: TextureKind, format: TextureFormat) -> usize {
        self.texture(&Texture { kind, ..target_texture(format, target) })
    }

    pub(super) fn draw(&mut self, draw: Draw) {
        self.scene.draws.push(draw);
    }

    pub(super) fn draw_into(&mut self, target: usize, draws: impl IntoIterator<Item = Draw>) {
        self.scene.draws.extend(draws.into_iter().map(|draw| Draw { target, ..draw }));
    }

    /// Finishes a frame that shows the colours of the frame buffer.
    pub(super) fn colors(self) -> FrameDrawing {
        FrameDrawing::colors(self.scene)
    }
}

/// Returns the draw with a textured unit. `texels` are the texture coordinates of its four vertices.
pub(super) fn textured(mut draw: Draw, unit: usize, state: TextureUnit, texels: [[f32; 2]; 4]) -> Draw {
    draw.vertices.update(|n, vertex| vertex.texture_coordinates = coordinates(texels[n]));
    fetching(draw, unit, state)
}

/// Returns the draw with combiners that show what a unit fetches from a texture.
pub(super) fn fetching(draw: Draw, unit: usize, state: TextureUnit) -> Draw {
    let mut draw = Draw { combiners: Combiners::showing(FETCHED[unit]), ..draw };
    draw.textures[unit] = Some(state);
    draw.texture_shader[unit] = ShaderStage::conventional(unit, true);
    draw
}

/// Returns a unit with nearest filtering that clamps to the edge.
pub(super) fn nearest(texture: usize) -> TextureUnit {
    TextureUnit {
        min_filter: Filter::Nearest,
        mag_filter: Filter::Nearest,
        address_s: AddressMode::ClampToEdge,
        address_t: AddressMode::ClampToEdge,
        ..TextureUnit::new(texture)
    }
}

/// Returns a square rectangle texture, whose coordinates are in texels.
pub(super) fn linear_texture(format: TextureFormat, side: u32, texel: impl Fn(u32, u32) -> u32) -> Texture {
    let words = (0..side * side).map(|at| texel(at % side, at / side)).collect();
    images::of_words(TextureKind::Rectangle, format, [side, side], 1, words)
}

/// Returns a rectangle texture that reads a render target.
pub(super) fn target_texture(format: TextureFormat, target: usize) -> Texture {
    let (name, kind) = (String::from("target"), TextureKind::Rectangle);
    Texture { name, kind, format, image: TextureImage::Target { target } }
}
