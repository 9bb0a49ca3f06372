//! Writes DDS files of cube maps with one level in A8R8G8B8.

use crate::image::Rgba;

/// Flags: caps, height, width and pixel format are given.
const FLAGS: u32 = 0x1007;
/// Flags of the pixel format: RGB with alpha.
const PIXEL_FLAGS: u32 = 0x41;
/// Caps: a texture that is complex, being a cube.
const CAPS: u32 = 0x1008;
/// Further caps: a cube with all six faces.
const CUBE: u32 = 0xfe00;

/// Returns the bytes of a file with these faces, which have the same size and the order +X, -X, +Y, -Y, +Z, -Z.
pub fn cube(faces: &[Rgba]) -> Vec<u8> {
    let (width, height) = faces.first().map_or((0, 0), |face| (face.width, face.height));
    let mut words = [0_u32; 31];
    (words[0], words[1], words[2], words[3]) = (124, FLAGS, height, width);
    (words[18], words[19], words[21]) = (32, PIXEL_FLAGS, 32);
    words[22..26].copy_from_slice(&[0x00ff_0000, 0x0000_ff00, 0x0000_00ff, 0xff00_0000]);
    (words[26], words[27]) = (CAPS, CUBE);
    let mut bytes = b"DDS ".to_vec();
    bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
    for [r, g, b, a] in faces.iter().flat_map(|face| &face.pixels) {
        bytes.extend([*b, *g, *r, *a]);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::cube::{Content, faces};
    use crate::image::{Contents, ImageLimits, open};

    #[test]
    fn it_reads_back() {
        let faces = faces(4, Content::Direction);
        let file = tempfile::NamedTempFile::new().expect("temporary file");
        std::fs::write(file.path(), cube(&faces)).expect("written");
        let Ok(Contents::Texture(read)) = open(file.path(), &ImageLimits::default()) else { panic!("no texture") };
        assert!(read.cube && (read.width, read.height, read.levels) == (4, 4, 1));
        let words: Vec<u32> = faces
            .iter()
            .flat_map(|face| &face.pixels)
            .map(|[r, g, b, a]| u32::from_be_bytes([*a, *r, *g, *b]))
            .collect();
        assert_eq!(read.words, words);
    }
}
