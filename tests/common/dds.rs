//! Builds DDS files field by field.
#![allow(dead_code, unreachable_pub, missing_docs, reason = "each test binary uses its part")]

/// A DDS file whose fields can be made wrong before it is written.
#[derive(Clone)]
pub struct File {
    /// The 31 words of the header after the signature.
    pub words: [u32; 31],
    /// The bytes after the header: additional header, palette, texels.
    pub rest: Vec<u8>,
}

/// Indices of fields in [`File::words`].
pub const FLAGS: usize = 1;
pub const HEIGHT: usize = 2;
pub const WIDTH: usize = 3;
pub const PITCH: usize = 4;
pub const LEVELS: usize = 6;
pub const PIXEL_FLAGS: usize = 19;
pub const FOUR_CHARACTERS: usize = 20;
pub const BITS: usize = 21;
pub const MASKS: usize = 22;
pub const CAPS2: usize = 27;

pub const CUBE: u32 = 0xfe00;
pub const VOLUME: u32 = 0x20_0000;

/// A pixel format: flags, bits for each texel, masks of R, G, B, A.
pub type Pixels = (u32, u32, [u32; 4]);
pub const A8R8G8B8: Pixels = (0x41, 32, [0xff_0000, 0xff00, 0xff, 0xff00_0000]);
pub const R5G6B5: Pixels = (0x40, 16, [0xf800, 0x7e0, 0x1f, 0]);
pub const L8: Pixels = (0x2_0000, 8, [0xff, 0, 0, 0]);
pub const P8: Pixels = (0x20, 8, [0; 4]);

impl File {
    fn new(width: u32, height: u32, levels: u32, rest: Vec<u8>) -> File {
        let mut words = [0; 31];
        (words[0], words[18]) = (124, 32);
        words[FLAGS] = 0x1007 | if levels > 1 { 0x2_0000 } else { 0 };
        (words[HEIGHT], words[WIDTH], words[LEVELS]) = (height, width, levels);
        words[26] = 0x1000;
        File { words, rest }
    }

    /// Returns a file with uncompressed texels or palette indices.
    pub fn plain((flags, bits, masks): Pixels, width: u32, height: u32, levels: u32, rest: Vec<u8>) -> File {
        let mut file = File::new(width, height, levels, rest);
        (file.words[PIXEL_FLAGS], file.words[BITS]) = (flags, bits);
        file.words[MASKS..MASKS + 4].copy_from_slice(&masks);
        file
    }

    /// Returns a file whose format is a four-character code.
    pub fn coded(code: &[u8; 4], width: u32, height: u32, levels: u32, rest: Vec<u8>) -> File {
        let mut file = File::new(width, height, levels, rest);
        (file.words[PIXEL_FLAGS], file.words[FOUR_CHARACTERS]) = (4, u32::from_le_bytes(*code));
        file
    }

    /// Returns a file with the DX10 header, which has a DXGI format number and the number of textures in the array.
    pub fn numbered(number: u32, dimension: u32, misc: u32, array: u32, width: u32, height: u32, rest: &[u8]) -> File {
        let further = [number, dimension, misc, array, 0].map(u32::to_le_bytes).concat();
        File::coded(b"DX10", width, height, 1, [&further, rest].concat())
    }

    /// Returns the file with one word changed.
    pub fn with(mut self, place: usize, word: u32) -> File {
        self.words[place] = word;
        self
    }

    pub fn bytes(&self) -> Vec<u8> {
        let header = self.words.map(u32::to_le_bytes).concat();
        [b"DDS ", header.as_slice(), &self.rest].concat()
    }
}
