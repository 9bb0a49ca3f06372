//! Meshes that the programs light.

use flate2::read::GzDecoder;
use ninebit_data::meshes;
use std::io::Read;

/// The largest number of bytes that a mesh may have.
const LIMIT: u64 = 1 << 20;

/// Position and normal of a vertex.
pub(super) type Place = ([f32; 3], [f32; 3]);

/// Reads a packed mesh: the number of its vertices, then two lists, positions and normals. Each list begins with the number of its floats. A file
/// that is not whole has no vertices.
fn read(packed: &[u8]) -> Vec<Place> {
    let mut bytes = Vec::new();
    // What cannot be read leaves the lists short.
    let _ = GzDecoder::new(packed).take(LIMIT).read_to_end(&mut bytes);
    let words: Vec<u32> = bytes.as_chunks().0.iter().map(|four| u32::from_le_bytes(*four)).collect();
    let list = |at: usize| {
        let count = words.get(at).map_or(0, |count| *count as usize);
        words.get(at + 1..at + 1 + count).unwrap_or_default()
    };
    let positions = list(1);
    let places = |list: &[u32]| -> Vec<[f32; 3]> {
        list.as_chunks().0.iter().map(|place: &[u32; 3]| place.map(f32::from_bits)).collect()
    };
    places(positions).into_iter().zip(places(list(2 + positions.len()))).collect()
}

/// A square of 50 by 50 fields across the line of sight.
pub(super) fn grid() -> Vec<Place> {
    read(meshes::GRID)
}

/// A cylinder.
pub(super) fn cylinder() -> Vec<Place> {
    read(meshes::CYLINDER)
}

/// A cone, a cylinder, a sphere, a head and a torus, which the programs draw together.
pub(super) fn solids() -> [Vec<Place>; 5] {
    [meshes::CONE, meshes::CYLINDER, meshes::SPHERE, meshes::HEAD, meshes::TORUS].map(read)
}
