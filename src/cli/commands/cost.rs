//! Cost of rendering a scene, estimated without rendering it.

use ninebit::state::{Draw, Scene, Target, TextureImage, Topology};
use serde::Serialize;

/// Estimated cost of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Cost {
    /// Number of draws.
    pub(crate) draws: u64,
    /// Number of triangles in all draws, before culling.
    pub(crate) triangles: u64,
    /// Number of vertices in all draws.
    pub(crate) vertices: u64,
    /// Number of pixels in all targets.
    pub(crate) target_pixels: u64,
    /// Size of all textures on the chip, in bytes.
    pub(crate) texture_bytes: u64,
    /// Approximate memory for rendering, in bytes.
    pub(crate) memory_bytes: u64,
}

impl Cost {
    /// Estimates the cost of a scene.
    pub(crate) fn from_scene(scene: &Scene) -> Cost {
        let (mut texels, mut texture_bytes) = (0, 0);
        for texture in &scene.textures {
            if let TextureImage::Texels(image) = &texture.image {
                let words = image.words.len() as u64;
                texels += words;
                texture_bytes +=
                    words * if texture.format.is_compressed() { 4 } else { u64::from(texture.format.bytes()) };
            }
        }
        let target_pixels = scene.targets.iter().map(pixels).sum();
        let words: u64 = scene.targets.iter().map(|t| pixels(t) * if t.depth.is_some() { 2 } else { 1 }).sum();
        let vertices = scene.draws.iter().map(|draw| draw.vertices.len() as u64).sum();
        let triangles = scene.draws.iter().map(triangles).sum();
        Cost {
            draws: scene.draws.len() as u64,
            triangles,
            vertices,
            target_pixels,
            texture_bytes,
            // Targets and texels are stored as words of four bytes.
            memory_bytes: 4 * (words + texels) + scene.draws.iter().map(geometry).sum::<u64>(),
        }
    }
}

/// Approximate size of a draw's state in scene and plan, in bytes.
const DRAW: u64 = 4096;

/// Returns the approximate size of a draw in bytes: its state, its vertices and indices, and their share of the plan.
fn geometry(draw: &Draw) -> u64 {
    // A window position and a snapped corner.
    let planned = 16 + 20;
    DRAW + (draw.vertices.bytes() + draw.vertices.len() * planned + size_of_val(&draw.indices[..])) as u64
}

/// Returns the number of pixels of a target.
fn pixels(target: &Target) -> u64 {
    u64::from(target.width) * u64::from(target.height)
}

/// Returns the number of triangles, lines or points that a draw's indices form (RAS-4).
fn triangles(draw: &Draw) -> u64 {
    let count = draw.indices.len() as u64;
    match draw.topology {
        Topology::Triangles => count / 3,
        Topology::TriangleStrip | Topology::TriangleFan | Topology::Polygon => count.saturating_sub(2),
        Topology::Quads => count / 4 * 2,
        Topology::QuadStrip => (count / 2).saturating_sub(1) * 2,
        // Lines and points.
        Topology::Lines => count / 2,
        Topology::LineStrip => count.saturating_sub(1),
        Topology::LineLoop | Topology::Points => count,
    }
}
