//! Broad random scenes. A wider random scene gets what small ones lack: long rows, large textures, and meshes of small triangles.

use super::super::{Choices, SHARED, Tape, texture};
use super::{FIRST, WIDER, attempt, legal, widened};
use ninebit::state::*;
use ninebit::vertex::fog::passed;
use proptest::prelude::*;
use std::sync::Arc;

/// Numbers of tape words in addition to those of a wider scene: for each draw, and for all changes.
const BROAD_DRAW: usize = 64;
pub(super) const BROAD: usize = SHARED + 4 * BROAD_DRAW;

/// Largest number of pixels of a target, and of texels of a level of a texture.
const MOST_PIXELS: u32 = 16_384;
const MOST_TEXELS: u32 = 65_536;

/// Returns valid scenes of rows, textures and meshes that are larger than those of [`scene`](super::scene).
pub fn scene() -> BoxedStrategy<Scene> {
    Tape(FIRST + WIDER + BROAD).prop_map(|tape| broadened(&tape)).prop_filter("RAS-0", legal).boxed()
}

/// Builds the scene of a tape.
pub(super) fn broadened(tape: &[u32]) -> Scene {
    let (first, rest) = tape.split_at((FIRST + WIDER).min(tape.len()));
    let mut scene = widened(first);
    let mut tape = Choices { tape: rest };
    let mut c = tape.part(SHARED);
    for target in 0..scene.targets.len() {
        let c = &mut c.part(8);
        attempt(&mut scene, |scene| stretch(c, scene, target));
    }
    // Half of the scenes have textures of a single format, because most formats are rare otherwise.
    let format: Option<TextureFormat> = c.once_in(2).then(|| c.any());
    for texture in 0..scene.textures.len() {
        let c = &mut c.part(8);
        attempt(&mut scene, |scene| enlarge(c, &mut scene.textures[texture]));
        if let Some(format) = format {
            attempt(&mut scene, |scene| remake(scene, texture, format));
        }
    }
    for index in 0..scene.draws.len() {
        let c = &mut tape.part(BROAD_DRAW);
        attempt(&mut scene, |scene| mesh(c, scene, index));
    }
    // What draws leave behind must not matter to any other.
    let more = if c.once_in(3) { c.size(1, 8) } else { 0 };
    for _ in 0..more {
        let again = scene.draws[c.below(scene.draws.len() as u32) as usize].clone();
        scene.draws.push(again);
    }
    scene
}

/// Makes a target larger, with all that is drawn there.
fn stretch(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let target = &mut scene.targets[index];
    let [x, y] = c.pick(&[[1, 1], [8, 1], [1, 8], [4, 4], [32, 1], [3, 2], [16, 2], [7, 1]]);
    let (width, height) = (target.width * x, target.height * y);
    if x * y == 1 || width > 4096 || width * height > MOST_PIXELS {
        return;
    }
    let stretched = |r: Rectangle| Rectangle { x: r.x * x, y: r.y * y, width: r.width * x, height: r.height * y };
    (target.width, target.height) = (width, height);
    target.clip = target.clip.map(stretched);
    for contents in [&mut target.contents, &mut target.depth_contents].into_iter().flatten() {
        *contents = contents.iter().copied().cycle().take((width * height) as usize).collect();
    }
    let (x, y) = (x as f32, y as f32);
    for draw in scene.draws.iter_mut().filter(|draw| draw.target == index) {
        draw.scissor = draw.scissor.map(stretched);
        if let Some(clip) = &mut draw.window_clip {
            clip.rectangles.iter_mut().for_each(|r| *r = stretched(*r));
        }
        match &mut draw.positions {
            Positions::Window => draw.vertices.map_positions(|[px, py, z, w]| [px * x, py * y, z, w]),
            Positions::Clip(port) => {
                (port.x, port.y, port.width, port.height) = (port.x * x, port.y * y, port.width * x, port.height * y);
            }
        }
    }
}

/// Makes a texture larger.
fn enlarge(c: &mut Choices<'_>, texture: &mut Texture) {
    let (more, same) = (c.pick(&[[1, 1], [2, 2], [8, 8], [16, 4], [4, 32], [64, 64]]), c.once_in(2));
    let of_words = (c.once_in(2), c.word(), c.word());
    let TextureImage::Texels(texels) = &texture.image else { return };
    let [x, y] = if texture.kind == TextureKind::Cube { [more[0]; 2] } else { more };
    let (width, height) = (texels.width * x, texels.height * y);
    if x * y == 1 || width.max(height) > 4096 || width * height * texels.layers > MOST_TEXELS {
        return;
    }
    let has_levels = matches!(texture.kind, TextureKind::TwoDimensional | TextureKind::Cube);
    let most = if has_levels { Level::most(width, height) } else { 1 };
    let texels = Texels { width, height, levels: if same { texels.levels } else { most }, ..texels.clone() };
    texture.image = texture::filled(texture.kind, texture.format, texels, of_words);
}

/// Gives a texture other texels of a format.
fn remake(scene: &mut Scene, index: usize, format: TextureFormat) {
    let texture = &mut scene.textures[index];
    let TextureImage::Texels(texels) = &texture.image else { return };
    let (seed, texels) = (texels.words[0], texels.clone());
    texture.format = format;
    texture.image = texture::filled(texture.kind, format, texels, (false, seed, 0));
    for unit in scene.draws.iter_mut().flat_map(|draw| draw.textures.iter_mut().flatten()) {
        if unit.texture == index {
            unit.palette = (format == TextureFormat::P8).then_some(unit.palette.unwrap_or(0));
        }
    }
}

/// Returns the point at (u, v) of a patch whose corners are given in the order of a quad.
fn patch([a, b, c, d]: [f32; 4], [u, v]: [f32; 2]) -> f32 {
    if a == b && b == c && c == d {
        return a;
    }
    a * (1.0 - u) * (1.0 - v) + b * u * (1.0 - v) + c * u * v + d * (1.0 - u) * v
}

fn patch_of<const N: usize>(corners: [[f32; N]; 4], at: [f32; 2]) -> [f32; N] {
    std::array::from_fn(|n| patch(corners.map(|corner| corner[n]), at))
}

fn patch_color(corners: [VertexColor; 4], at: [f32; 2]) -> VertexColor {
    let numbers = corners.map(|corner| match corner {
        VertexColor::Bytes(bytes) => bytes.map(f32::from),
        VertexColor::Floats(numbers) => numbers,
    });
    match corners[0] {
        VertexColor::Bytes(_) => VertexColor::Bytes(patch_of(numbers, at).map(|number| number as u8)),
        VertexColor::Floats(_) => VertexColor::Floats(patch_of(numbers, at)),
    }
}

/// Draws a mesh of small triangles between the first four vertices of a draw.
fn mesh(c: &mut Choices<'_>, scene: &mut Scene, index: usize) {
    let profile = scene.profile;
    let draw = &mut scene.draws[index];
    if c.below(3) == 0 || draw.vertices.is_empty() {
        return;
    }
    let sides = [2, 1, 3, 5, 8, 13, 21, 34];
    let (columns, rows) = (c.pick(&sides), c.pick(&sides));
    let corners = [0, 1, 2, 3].map(|n| draw.vertices.at(n % draw.vertices.len()));
    let (shaken, shaking) = (c.below(6), c.pick(&[0.25, 1.0, 3.0]));
    let seed = c.word();
    let noise = |n: u32| (texture::scrambled(seed, n) >> 12) as f32 / 524_288.0 - 1.0;
    let vertex = |n: u32| {
        let at = [(n % (columns + 1)) as f32 / columns as f32, (n / (columns + 1)) as f32 / rows as f32];
        let mut vertex = Vertex {
            position: patch_of(corners.map(|v| v.position), at),
            diffuse: patch_color(corners.map(|v| v.diffuse), at),
            specular: patch_color(corners.map(|v| v.specular), at),
            fog: patch(corners.map(|v| v.fog), at),
            fog_coordinate: corners[0].fog_coordinate,
            texture_coordinates: [0, 1, 2, 3]
                .map(|set| patch_of(corners.map(|corner| corner.texture_coordinates[set]), at)),
        };
        if let (Some(_), Some(function)) = (vertex.fog_coordinate, draw.fog.function) {
            let coordinate = patch(corners.map(|v| v.fog_coordinate.unwrap_or_default()), at);
            (vertex.fog_coordinate, vertex.fog) = (Some(coordinate), passed(&function, profile, coordinate));
        }
        let set = (seed % 4) as usize;
        match shaken {
            0 => {}
            1 if draw.positions == Positions::Window => {
                vertex.position[0] += shaking * noise(2 * n);
                vertex.position[1] += shaking * noise(2 * n + 1);
            }
            2 if draw.positions == Positions::Window => {
                // On corners and centres of pixels.
                let step = if seed.is_multiple_of(3) { 1.0 } else { 2.0 };
                for axis in &mut vertex.position[..2] {
                    *axis = (*axis * step).round() / step;
                }
            }
            3 => vertex.texture_coordinates[set] = vertex.texture_coordinates[set].map(|s| s + shaking * noise(n)),
            4 => {
                let texels = 16.0 * shaking;
                vertex.texture_coordinates[set][..2].iter_mut().for_each(|s| *s = (*s * texels).round() / texels);
            }
            _ => {
                let (more, set) = (1.0 + noise(n).abs(), &mut vertex.texture_coordinates[set]);
                *set = set.map(|s| s * more);
            }
        }
        vertex
    };
    let vertices: Vec<Vertex> = (0..(columns + 1) * (rows + 1)).map(vertex).collect();
    let corner = |x: u32, y: u32| y * (columns + 1) + x;
    let cells = (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y)));
    let (topology, indices): (Topology, Vec<u32>) = match c.below(4) {
        0 => {
            let of = |(x, y)| {
                let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
                [a, b, c, a, c, d]
            };
            (Topology::Triangles, cells.flat_map(of).collect())
        }
        1 => {
            let of = |(x, y)| [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
            (Topology::Quads, cells.flat_map(of).collect())
        }
        2 => {
            // Triangles without an area lead from one row to the next.
            let row = |y: u32| {
                let first = corner(0, y);
                let zigzag = (0..=columns).flat_map(move |x| [corner(x, y), corner(x, y + 1)]);
                std::iter::once(first).chain(zigzag).chain([corner(columns, y + 1)])
            };
            (Topology::TriangleStrip, (0..rows).flat_map(row).collect())
        }
        _ => {
            let around = (0..columns).map(|x| corner(x, 0)).chain((0..rows).map(|y| corner(columns, y)));
            let back = (0..columns).map(|x| corner(columns - x, rows)).chain((0..=rows).map(|y| corner(0, rows - y)));
            let centre = corner(columns / 2, rows / 2);
            (Topology::TriangleFan, std::iter::once(centre).chain(around).chain(back).collect())
        }
    };
    draw.vertices = vertices.into();
    draw.topology = topology;
    draw.indices = Arc::from(indices);
}
