//! Combines many probes in one scene. Every target is one row of pixels, and probe i is pixel i.

use crate::build::{draw, target, vertex};
use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;

/// Largest number of probes in a sheet.
pub const WIDTH: usize = 512;

/// Blends the source over the destination by source alpha.
pub const OVER: Blend = Blend {
    equation: BlendEquation::Add,
    source: BlendFactor::SourceAlpha,
    destination: BlendFactor::OneMinusSourceAlpha,
};

/// Colour mask that writes R, G and B.
pub const RGB_ONLY: [bool; 4] = [true, true, true, false];
/// Colour mask that writes A.
pub const ALPHA_ONLY: [bool; 4] = [false, false, false, true];

/// A scene under construction.
pub struct Sheet {
    scene: Scene,
}

impl Sheet {
    /// Returns a sheet without targets.
    pub fn new() -> Sheet {
        Sheet {
            scene: Scene { profile: Profile::Nv2a, targets: vec![], textures: vec![], palettes: vec![], draws: vec![] },
        }
    }

    /// Adds a target and returns its number.
    pub fn target(&mut self, format: SurfaceFormat, clear_color: [u8; 4]) -> usize {
        self.scene.targets.push(target(WIDTH as u32, 1, format, clear_color));
        self.scene.targets.len() - 1
    }

    /// Adds a texture that reads a target, and returns its number.
    pub fn reads(&mut self, target: usize, format: TextureFormat) -> usize {
        self.texture(format, TextureImage::Target { target })
    }

    /// Adds a texture with one texel for each probe, and returns its number.
    pub fn texels(&mut self, texels: impl Iterator<Item = [u8; 4]>) -> usize {
        self.texels_of(TextureFormat::A8R8G8B8, texels)
    }

    /// Like [`Sheet::texels`], in a format whose words have the same layout as A8R8G8B8.
    pub fn texels_of(&mut self, format: TextureFormat, texels: impl Iterator<Item = [u8; 4]>) -> usize {
        let mut words: Vec<u32> = texels.map(|[r, g, b, a]| u32::from_be_bytes([a, r, g, b])).collect();
        words.resize(WIDTH, 0);
        let (width, words) = (WIDTH as u32, words.into());
        let texels = Texels { width, height: 1, levels: 1, layers: 1, border: false, words };
        self.texture(format, TextureImage::Texels(texels))
    }

    fn texture(&mut self, format: TextureFormat, image: TextureImage) -> usize {
        let kind = TextureKind::TwoDimensional;
        self.scene.textures.push(Texture { name: "texture".to_string(), kind, format, image });
        self.scene.textures.len() - 1
    }

    /// Adds a draw to the scene.
    pub fn draw(&mut self, draw: Draw) {
        self.scene.draws.push(draw);
    }

    /// Renders the scene and returns the first `count` pixels of a target.
    pub fn show(&self, target: usize, count: usize) -> Vec<[u8; 4]> {
        // Each probe may add a texture, which are more than a scene file may have.
        let limits = Limits { textures: self.scene.textures.len(), ..Limits::default() };
        let plan = Plan::compile_within(&self.scene, &PlanOptions::default(), &limits).unwrap();
        let mut pixels = render(&plan, &RenderOptions::default()).surfaces[target].rgba8();
        pixels.truncate(count);
        pixels
    }
}

/// Returns a quad over the pixels `from` to `to`, each of which reads its own texel.
fn span(target: usize, from: usize, to: usize, color: [u8; 4]) -> Draw {
    let corners = [(from, 0.0), (to, 0.0), (to, 1.0), (from, 1.0)];
    let vertices = corners.map(|(x, y)| {
        let mut corner = vertex(x as f32, y, color);
        corner.texture_coordinates = [[x as f32 / WIDTH as f32, y, 0.0, 1.0]; 4];
        corner
    });
    Draw { target, ..draw(Topology::Quads, vertices.to_vec()) }
}

/// Returns a draw that stores a colour in pixel `probe`.
pub fn cell(target: usize, probe: usize, color: [u8; 4]) -> Draw {
    span(target, probe, probe + 1, color)
}

/// Returns a draw that copies a texture to every pixel.
pub fn copy(target: usize, texture: usize) -> Draw {
    let mut draw = span(target, 0, WIDTH, [255; 4]);
    bind(&mut draw, 0, texture);
    draw.combiners = Combiners::showing(FinalRegister::Texture0);
    draw
}

/// Binds a texture to a unit, with nearest filters and clamping.
pub fn bind(draw: &mut Draw, unit: usize, texture: usize) {
    draw.textures[unit] = Some(TextureUnit {
        address_s: AddressMode::ClampToEdge,
        address_t: AddressMode::ClampToEdge,
        min_filter: Filter::Nearest,
        mag_filter: Filter::Nearest,
        ..TextureUnit::new(texture)
    });
    draw.texture_shader[unit] = ShaderStage::conventional(unit, true);
}

/// Makes the alpha of the fragments 255.
pub fn opaque(draw: &mut Draw) {
    draw.combiners.final_combiner.g =
        FinalInput { register: FinalRegister::Zero, component: Component::Alpha, invert: true };
}

/// Returns an input A to F of the final combiner that reads a register.
pub fn input(register: FinalRegister) -> FinalInput {
    FinalInput { register, component: Component::Rgb, invert: false }
}
