//! Building blocks of the experiments' scenes: strips of pixels, rows of texels, and errors of pictures.

use super::{Outcome, cos, encode, sin};
pub(super) use crate::stages::*;
use ninebit::engine::{RenderOptions, render};
pub(super) use ninebit::state::*;
use ninebit_scene::SceneError;
pub(super) use ninebit_scene::generate::byte;

/// Default number of pixels in a strip.
pub(super) const WIDTH: usize = 256;

/// R, G, B, A of a strip's pixels, or the error of its scene.
pub(super) type Pixels = Result<Vec<[u8; 4]>, Box<SceneError>>;

/// Draws into a row of pixels that starts black and transparent.
pub(super) fn drawn(profile: Profile, width: usize, textures: Vec<Texture>, draws: Vec<Draw>) -> Pixels {
    let targets = vec![Target::new(width as u32, 1, SurfaceFormat::A8R8G8B8)];
    let scene = Scene { profile, targets, textures, draws, ..Scene::default() };
    let plan = planned(&scene)?;
    let frames = render(&plan, &RenderOptions::default());
    Ok(frames.surfaces.first().map(ninebit::frame::Surface::rgba8).unwrap_or_default())
}

/// Returns a vertex whose coordinate set 0 is s, t, r.
pub(super) fn vertex([s, t, r]: [f64; 3]) -> Vertex {
    let mut vertex = Vertex::default();
    vertex.texture_coordinates[0] = [s as f32, t as f32, r as f32, 1.0];
    vertex
}

/// Returns a vertex with a vector in its primary colour; components from -1 to 1 become 0 to 1.
pub(super) fn pointing(vector: [f64; 3]) -> Vertex {
    let [x, y, z] = vector.map(|n| (0.5 + 0.5 * n) as f32);
    Vertex { diffuse: VertexColor::Floats([x, y, z, 1.0]), ..Vertex::default() }
}

/// Returns a quad that covers the row between two positions.
pub(super) fn quad([from, to]: [f64; 2], [left, right]: [Vertex; 2]) -> [Vertex; 4] {
    let corner = |x: f64, y, vertex| Vertex { position: [x as f32, y, 0.0, 1.0], ..vertex };
    [corner(from, 0.0, left), corner(to, 0.0, right), corner(to, 1.0, right), corner(from, 1.0, left)]
}

pub(super) fn quads(vertices: Vec<Vertex>, units: &[TextureUnit], combiners: Combiners) -> Draw {
    let indices = (0..vertices.len() as u32).collect();
    let mut draw = Draw { vertices: vertices.into(), indices, topology: Topology::Quads, combiners, ..Draw::default() };
    for (index, unit) in units.iter().enumerate() {
        draw.textures[index] = Some(*unit);
        draw.texture_shader[index] = ShaderStage::conventional(index, true);
    }
    draw
}

/// Returns a draw that covers the row; coordinate set 0 is interpolated between `ends`.
pub(super) fn row(width: usize, ends: [[f64; 3]; 2], unit: TextureUnit, combiners: Combiners) -> Draw {
    quads(quad([0.0, width as f64], ends.map(vertex)).into(), &[unit], combiners)
}

/// Returns a draw that covers the row with texture `n`, unfiltered.
pub(super) fn whole_row(width: usize, n: usize, combiners: Combiners) -> Draw {
    let unit = TextureUnit { mag_filter: Filter::Nearest, ..TextureUnit::new(n) };
    row(width, [[0.0; 3], [1.0, 0.0, 0.0]], unit, combiners)
}

/// Returns a 2D texture of one level.
pub(super) fn texture(format: TextureFormat, width: usize, words: Vec<u32>) -> Texture {
    let (columns, rows) = (width as u32, (words.len() / width.max(1)) as u32);
    let texels = Texels { width: columns, height: rows, levels: 1, layers: 1, border: false, words: words.into() };
    let (kind, image) = (TextureKind::TwoDimensional, TextureImage::Texels(texels));
    Texture { name: "texels".to_owned(), kind, format, image }
}

/// Returns a texture with one row of colours.
pub(super) fn colors(texels: impl Iterator<Item = [u8; 3]>) -> Texture {
    let words: Vec<u32> = texels.map(|[r, g, b]| u32::from_be_bytes([0xff, r, g, b])).collect();
    texture(TextureFormat::A8R8G8B8, words.len(), words)
}

/// Returns a texture with one row of bytes, which is read as red, green, blue and alpha.
pub(super) fn bytes(texels: impl Iterator<Item = u8>) -> Texture {
    let words: Vec<u32> = texels.map(u32::from).collect();
    texture(TextureFormat::I8, words.len(), words)
}

/// Returns the position of a pixel's centre along the strip, 0 to 1.
pub(super) fn centre(pixel: usize, width: usize) -> f64 {
    (pixel as f64 + 0.5) / width as f64
}

/// Interpolates between two angles in degrees. Returns radians.
pub(super) fn angle(low: f64, high: f64, share: f64) -> f64 {
    (low + (high - low) * share).to_radians()
}

/// Compares a channel with a formula of the pixel's centre, whose values are clamped to 0..1. `error` makes one number of the errors, in steps.
pub(super) fn compared(
    pixels: Pixels,
    channel: usize,
    ideal: impl Fn(f64) -> f64,
    error: impl FnOnce(&[f64]) -> f64,
) -> Result<Outcome, Box<SceneError>> {
    let pixels = pixels?;
    let width = pixels.len();
    let drawn: Vec<u8> = pixels.iter().map(|pixel| pixel[channel]).collect();
    let wanted: Vec<f64> = (0..width).map(|x| ideal(centre(x, width)).clamp(0.0, 1.0)).collect();
    let errors: Vec<f64> =
        drawn.iter().zip(&wanted).map(|(drawn, wanted)| f64::from(*drawn) - 255.0 * wanted).collect();
    Ok(Outcome { error: error(&errors), drawn, exact: wanted.into_iter().map(byte).collect() })
}

/// Returns the largest magnitude of the errors.
pub(super) fn largest(errors: &[f64]) -> f64 {
    errors.iter().fold(0.0, |most: f64, error| most.max(error.abs()))
}

/// Measures the largest magnitude of a channel's errors.
pub(super) fn largest_error(
    pixels: Pixels,
    channel: usize,
    ideal: impl Fn(f64) -> f64,
) -> Result<Outcome, Box<SceneError>> {
    compared(pixels, channel, ideal, largest)
}

/// Returns `count` stages that square SPARE0.
pub(super) fn squarings(count: usize) -> impl Iterator<Item = GeneralStage> {
    let base = plain(Register::Spare0);
    std::iter::repeat_n(product(base, base), count)
}

/// Returns combiners with the dot product of a register's normals and a constant direction, squared `count` times.
pub(super) fn highlight(normals: Register, direction: [u8; 3], count: usize) -> Combiners {
    let dot = dot_product(expanded(normals), expanded(Register::ConstantColor0));
    program(direction, std::iter::once(dot).chain(squarings(count)).collect())
}

/// Returns a map of normals that are tilted along x.
pub(super) fn leaning(count: usize, tilt: impl Fn(usize) -> f64) -> Texture {
    colors((0..count).map(|n| encode([sin(tilt(n)), 0.0, cos(tilt(n))])))
}

pub(super) fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
