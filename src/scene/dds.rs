//! Reads DDS files: textures with their levels and faces, stored as they lie in memory.
//!
//! Nothing in the header is trusted: sides, levels and faces are compared first with the limits, then with the number of bytes
//! that follow. The flags that say which fields are valid are ignored: the reader does not need them, and writers set them at will. The
//! pitch is read only to find out whether rows may be padded. Texels are returned as they are stored.

use std::path::Path;

use super::image::{ImageError, ImageFault, ImageLimits};
use ninebit::state::{CUBE_FACES, LARGEST_VOLUME, Level, TextureFormat};
use ninebit_files::texels;

mod pixel_format;

/// The first bytes of every DDS file.
pub const SIGNATURE: [u8; 4] = *b"DDS ";

/// Number of bytes of signature and header.
const HEADER: usize = 128;
/// Number of bytes of the second header, which the four characters `DX10` announce.
const FURTHER: usize = 20;
/// Largest side, whatever the limits are: products of sides, levels and faces stay within 64 bits.
const LARGEST_SIDE: u32 = 1 << 20;
/// Number of bytes of a palette: 256 entries of R, G, B, A.
const PALETTE: usize = 1024;

const ALL_FACES: u32 = 0xfc00;
const CUBE: u32 = 0x200;
const VOLUME: u32 = 0x20_0000;

/// Names of the faces, in their order in files and in the state.
pub const FACES: [&str; CUBE_FACES as usize] = ["+X", "-X", "+Y", "-Y", "+Z", "-Z"];

/// Contents of a DDS file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dds {
    /// Whether the file holds the six faces of a cube map instead of one picture.
    pub cube: bool,
    /// Number of layers of a volume texture, `None` for other textures.
    pub layers: Option<u32>,
    /// Format of the texels.
    pub format: TextureFormat,
    /// Number of columns of level 0.
    pub width: u32,
    /// Number of rows of level 0.
    pub height: u32,
    /// Number of levels, from 1 to as many as the sides can be halved; 1 for a volume, whose other levels are not read.
    pub levels: u32,
    /// Face after face (or layer after layer), and within it level after level, as in [`Texels::words`](ninebit::state::Texels::words).
    pub words: Vec<u32>,
    /// 256 words A8R8G8B8 if the format is [`TextureFormat::P8`].
    pub palette: Option<Vec<u32>>,
}

impl Dds {
    /// Returns the words reinterpreted in another format of the same size; `None` if that is impossible, as with compressed blocks.
    pub fn words_as(&self, format: TextureFormat) -> Option<Vec<u32>> {
        let blocks = format.is_compressed() || format.is_paired() || self.format.is_compressed();
        if format != self.format && (blocks || format.bytes() != self.format.bytes()) {
            return None;
        }
        let used = texels::used_bits(format);
        Some(self.words.iter().map(|word| texels::stored(word & used, format)).collect())
    }
}

/// The fields of a header that has passed its first checks.
struct Header {
    cube: bool,
    layers: Option<u32>,
    format: TextureFormat,
    width: u32,
    height: u32,
    levels: u32,
    /// Number of bytes before the texels.
    before: usize,
    /// Number of bytes from row to row of level 0, if the file gives it.
    pitch: u32,
}

/// Decodes the contents of a DDS file; `path` names it in errors.
///
/// # Errors
/// The file is cut off or longer than its header says, its sides exceed the limits, a face is missing, or its texture is of a kind that no
/// texture unit of the model reads. No input makes this panic.
pub fn decode(bytes: &[u8], path: &Path, limits: &ImageLimits) -> Result<Dds, ImageError> {
    texture(bytes, limits).map_err(|fault| fault.at(path))
}

fn texture(bytes: &[u8], limits: &ImageLimits) -> Result<Dds, ImageFault> {
    let damaged = ImageFault::Damaged;
    let header = header(bytes)?;
    let Header { cube, layers, format, width, height, levels, before, .. } = header;
    limits.check_sides(width, height, limits.maximum_side.min(LARGEST_SIDE))?;
    if let Some(layers) = layers
        && !(1..=LARGEST_VOLUME).contains(&layers)
    {
        return Err(damaged(format!("it has {layers} layers, and 1 to {LARGEST_VOLUME} can be")));
    }
    if cube && width != height {
        return Err(damaged(format!("faces of a cube map are square, and it is {width} x {height}")));
    }
    let most = Level::most(width.max(layers.unwrap_or(1)), height);
    if levels > most {
        return Err(damaged(format!("it claims {levels} levels, and {width} x {height} texels have {most} at most")));
    }
    let faces = if cube { CUBE_FACES } else { 1 };
    let decoded: u64 =
        u64::from(faces) * sides(&header).map(|(w, h, layers)| 4 * layers * words(format, w, h)).sum::<u64>();
    limits.check_decoded(decoded)?;
    let palette = match (format, bytes.get(HEADER..HEADER + PALETTE)) {
        (TextureFormat::P8, None) => return Err(damaged("its palette is cut off".to_owned())),
        (TextureFormat::P8, Some(palette)) => Some(entries(palette)),
        _ => None,
    };
    let texels = bytes.get(before..).unwrap_or_default();
    let [needs, padded] = [false, true].map(|padded| u64::from(faces) * stored(&header, padded));
    // Rows are padded only if the pitch of level 0 says so.
    let row = u64::from(format.bytes()) * u64::from(width);
    let may_be_padded = !format.is_compressed() && u64::from(header.pitch) == row.next_multiple_of(4);
    let has = texels.len() as u64;
    let mut words = if has == needs {
        texels::from_bytes(texels, format)
    } else if may_be_padded && has == padded {
        texels::from_bytes(&without_padding(&header, texels), format)
    } else {
        let what = if has < needs { "is cut off" } else { "is longer than its header says" };
        return Err(damaged(format!("it {what}: {has} bytes of texels, {needs} are expected")));
    };
    let levels = if layers.is_some() { 1 } else { levels };
    if let Some(layers) = layers {
        words.truncate(layers as usize * format.words(width, height));
    }
    Ok(Dds { cube, layers, format, width, height, levels, words, palette })
}

/// Reads the header; refuses kinds of textures that the model lacks.
fn header(bytes: &[u8]) -> Result<Header, ImageFault> {
    let damaged = |reason: &str| ImageFault::Damaged(reason.to_owned());
    let unsupported = ImageFault::Unsupported;
    let Some(fixed) = bytes.first_chunk::<HEADER>() else { return Err(damaged("the header is cut off")) };
    let field = |at: usize| u32::from_le_bytes([fixed[at], fixed[at + 1], fixed[at + 2], fixed[at + 3]]);
    if field(4) != 124 || field(76) != 32 {
        return Err(damaged("the sizes in its header are not those of a DDS file"));
    }
    let (mut cube, caps, mut before) = (field(112) & CUBE != 0, field(112), HEADER);
    let mut layers = (caps & VOLUME != 0).then(|| field(24));
    let pixels = pixel_format::PixelFormat {
        flags: field(80),
        four_characters: field(84).to_le_bytes(),
        bits: field(88),
        masks: [92, 96, 100, 104].map(field),
    };
    let format = if pixels.has_further_header() {
        let Some(further) = bytes.get(HEADER..HEADER + FURTHER) else {
            return Err(damaged("the header is cut off"));
        };
        let word =
            |n: usize| u32::from_le_bytes([further[4 * n], further[4 * n + 1], further[4 * n + 2], further[4 * n + 3]]);
        match word(1) {
            3 => {}
            4 => layers = Some(field(24)),
            _ => return Err(unsupported("a texture of one dimension".to_owned())),
        }
        if word(3) > 1 {
            return Err(unsupported(format!("an array of {} textures", word(3))));
        }
        cube |= word(2) & 4 != 0;
        before += FURTHER;
        pixel_format::of_number(word(0)).map_err(unsupported)?
    } else {
        if cube && caps & ALL_FACES != ALL_FACES {
            let missing = (0..6).filter(|face| caps >> (10 + face) & 1 == 0).map(|face| FACES[face]).collect();
            return Err(ImageFault::MissingFaces(missing));
        }
        pixels.format().map_err(unsupported)?
    };
    if cube && layers.is_some() {
        return Err(damaged("it claims to be a cube map and a volume"));
    }
    if format == TextureFormat::P8 {
        before += PALETTE;
    }
    let (width, height, levels, pitch) = (field(16), field(12), field(28).max(1), field(20));
    Ok(Header { cube, layers, format, width, height, levels, before, pitch })
}

/// Returns the columns, rows and layers of each level.
fn sides(header: &Header) -> impl Iterator<Item = (u32, u32, u64)> {
    let (width, height, layers) = (header.width, header.height, header.layers.unwrap_or(1));
    (0..header.levels.min(32))
        .map(move |n| ((width >> n).max(1), (height >> n).max(1), u64::from((layers >> n).max(1))))
}

/// Returns the number of words of a decoded level.
fn words(format: TextureFormat, width: u32, height: u32) -> u64 {
    if format.is_compressed() {
        u64::from(format.bytes() / 4) * u64::from(width.div_ceil(4)) * u64::from(height.div_ceil(4))
    } else {
        u64::from(width) * u64::from(height)
    }
}

/// Returns the number of bytes of all levels of a face in the file. Rows follow each other at once, or each is filled up to a multiple of four bytes.
fn stored(header: &Header, padded: bool) -> u64 {
    let level = |(width, height, layers): (u32, u32, u64)| {
        if header.format.is_compressed() {
            return 4 * layers * words(header.format, width, height);
        }
        let row = u64::from(header.format.bytes()) * u64::from(width);
        layers * u64::from(height) * if padded { row.next_multiple_of(4) } else { row }
    };
    sides(header).map(level).sum()
}

/// Removes the padding of rows; the length of `texels` has been checked.
fn without_padding(header: &Header, texels: &[u8]) -> Vec<u8> {
    let mut tight = Vec::with_capacity(texels.len());
    let mut rest = texels;
    while !rest.is_empty() {
        for (width, height, layers) in sides(header) {
            let row = (header.format.bytes() * width) as usize;
            for _ in 0..u64::from(height) * layers {
                let (padded, after) = rest.split_at(row.next_multiple_of(4).min(rest.len()));
                tight.extend_from_slice(&padded[..row.min(padded.len())]);
                rest = after;
            }
        }
    }
    tight
}

/// Converts entries R, G, B, A into words A8R8G8B8.
fn entries(palette: &[u8]) -> Vec<u32> {
    let word = |entry: &[u8; 4]| u32::from_be_bytes([entry[3], entry[0], entry[1], entry[2]]);
    palette.as_chunks::<4>().0.iter().map(word).collect()
}
