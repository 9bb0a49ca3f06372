//! Generates the textures of `vectors/scenes/stability`, which are content and no part of the chip.

use super::blocks;
use super::view::FOLDER;
use crate::dds;
use crate::repository::at;
use ninebit_files::output::{Compression, encode_png};
use ninebit_scene::generate::{height_field, normal_map};
use ninebit_scene::image::Rgba;
use std::sync::Once;

/// Number of rows of `angle-pairs.png`.
pub const PAIRS: usize = 256;

/// Texels along a side of a face of `directions-8.dds`.
pub const FACE: u32 = 8;

/// Returns the angle between the two normals of a row of `angle-pairs.png`, in degrees. Four rows make three degrees, and the last 16 rows
/// have 180.
pub fn pair_angle(row: usize) -> f64 {
    (0.75 * row as f64).min(180.0)
}

/// Returns the two normals of a row as bytes. They lie on both sides of z.
pub fn pair(row: usize) -> [[u8; 3]; 2] {
    let half = pair_angle(row).to_radians() / 2.0;
    [-half, half].map(|a| normal_map::encode([a.sin(), 0.0, a.cos()]))
}

/// Returns the normal map of a stone that several scenes share. It has 64 x 64 texels and repeats.
pub fn stone() -> Rgba {
    let options = normal_map::Options { scale: 6.0, ..normal_map::Options::default() };
    normal_map::from_height(&height_field::rocks(64, 5), &options)
}

/// Texels along a side of `ball-normal.png`.
pub const BALL: u32 = 4;

/// Returns normals of the middle of a ball, up to 0.7 of its radius along x and y.
pub fn ball(side: u32) -> Rgba {
    let normal = |n: u32| {
        let along = |index: u32| 0.7 * (f64::from(2 * index + 1) / f64::from(side) - 1.0);
        let (x, y) = (along(n % side), -along(n / side));
        let [r, g, b] = normal_map::encode([x, y, (1.0 - x * x - y * y).sqrt()]);
        [r, g, b, 255]
    };
    Rgba::new(side, (0..side * side).map(normal).collect())
}

/// Returns a normalisation cube map as words A8R8G8B8, face after face. Each texel is the direction through its centre.
pub fn directions(side: u32) -> Vec<u32> {
    use ninebit::state::Named;
    use ninebit::texture::cube::Face;
    let mut words = Vec::new();
    for face in Face::ALL {
        for texel in 0..side * side {
            let along = |n: u32| (2 * n + 1) as f64 / f64::from(side) - 1.0;
            let on_face = [along(texel % side), along(texel / side), 1.0];
            let mut direction = [0.0; 3];
            for (component, value) in face.components().into_iter().zip(on_face) {
                direction[component.axis] = if component.negative { -value } else { value };
            }
            let [r, g, b] = normal_map::encode(unit(direction)).map(u32::from);
            words.push(255 << 24 | r << 16 | g << 8 | b);
        }
    }
    words
}

pub fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = length(v);
    v.map(|n| n / length)
}

pub fn length(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns every file with its name and its bytes.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let png = |image: Rgba| encode_png(image.width(), image.height(), image.pixels(), Compression::Small).unwrap();
    let pairs = (0..PAIRS).flat_map(|row| pair(row).map(|[r, g, b]| [r, g, b, 255])).collect();
    let faces = directions(FACE).into_iter().flat_map(u32::to_le_bytes).collect();
    let curved = ball(64);
    let coded = |code: &[u8; 4]| dds::File::coded(code, 64, 64, 1, blocks::encode(&curved, code)).bytes();
    vec![
        ("angle-pairs.png", png(Rgba::new(2, pairs))),
        ("ball-normal.png", png(ball(BALL))),
        ("stone-normal.png", png(stone())),
        ("curved-normal.png", png(curved.clone())),
        ("curved-normal-dxt1.dds", coded(b"DXT1")),
        ("curved-normal-dxt3.dds", coded(b"DXT3")),
        ("curved-normal-dxt5.dds", coded(b"DXT5")),
        ("directions-8.dds", dds::File::plain(dds::A8R8G8B8, FACE, FACE, 1, faces).with(dds::CAPS2, dds::CUBE).bytes()),
    ]
}

static MADE: Once = Once::new();

/// Writes the files once, if expectations are to be rewritten.
pub fn bless() {
    if crate::settings::bless() {
        MADE.call_once(|| {
            for (name, bytes) in files() {
                std::fs::write(at(FOLDER).join(name), bytes).unwrap();
            }
        });
    }
}

/// Checks that the stored files are those generated here. PNG files are compared by their pixels, which do not depend on the encoder.
pub fn check() {
    bless();
    for (name, bytes) in files() {
        let stored = std::fs::read(at(FOLDER).join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let same = if name.ends_with(".png") {
            image::load_from_memory(&stored).unwrap() == image::load_from_memory(&bytes).unwrap()
        } else {
            stored == bytes
        };
        assert!(same, "{name} is another; BLESS=1 writes it");
    }
}
