//! Reads PNG, TGA and DDS files that are not trusted.
//!
//! The order of checks matters: the kind of the file and its size, then the header against the limits, then the decoder, which runs under
//! [`catch_panic`] because decoders panic on some malformed files. Only the chunks of a PNG that decide its pixels reach the decoder,
//! so compressed text and profiles are never unpacked. Bytes are returned as they are stored: no gamma, no colour management.

use std::io::{self, Cursor};
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageFormat};
use thiserror::Error;

use super::assets::{Assets, Folder};
use super::dds::{self, Dds};
use ninebit::limits::{FileLimit, Limits};
use ninebit_files::catch_panic;
use ninebit_files::read::ReadError;

mod png;

/// Limits of an image file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageLimits {
    /// Largest number of columns, and of rows.
    pub maximum_side: u32,
    /// Largest size of the decoded pixels, in bytes, at four bytes a pixel.
    pub maximum_decoded_bytes: u64,
    /// Largest size of the file, in bytes.
    pub maximum_file_bytes: u64,
}

impl Default for ImageLimits {
    fn default() -> Self {
        ImageLimits { maximum_side: 4096, maximum_decoded_bytes: 64 << 20, maximum_file_bytes: 64 << 20 }
    }
}

impl ImageLimits {
    pub(super) fn file(&self) -> FileLimit {
        Limits { image_file_bytes: self.maximum_file_bytes, ..Limits::default() }.image_file()
    }

    /// Refuses an image without pixels, or with a side above `limit`.
    pub(super) fn check_sides(&self, width: u32, height: u32, limit: u32) -> Result<(), ImageFault> {
        match width.max(height) {
            _ if width == 0 || height == 0 => Err(ImageFault::Damaged(format!("it is {width} x {height}"))),
            longer if longer > limit => Err(ImageFault::Side { width, height, limit }),
            _ => Ok(()),
        }
    }

    /// Refuses an image that decodes to too many bytes.
    pub(super) fn check_decoded(&self, bytes: u64) -> Result<(), ImageFault> {
        let limit = self.maximum_decoded_bytes;
        if bytes > limit { Err(ImageFault::DecodedBytes { bytes, limit }) } else { Ok(()) }
    }
}

/// A decoded image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rgba {
    /// Number of columns.
    pub(crate) width: u32,
    /// Number of rows.
    pub(crate) height: u32,
    /// `width * height` pixels R, G, B, A, row by row from the top. Alpha is 255 if the file has none.
    pub(crate) pixels: Vec<[u8; 4]>,
}

impl Rgba {
    /// Returns the image of pixels R, G, B, A, row by row from the top. Pixels that do not fill a row are dropped.
    pub fn new(width: u32, mut pixels: Vec<[u8; 4]>) -> Rgba {
        let rows = pixels.len().checked_div(width as usize).unwrap_or(0);
        pixels.truncate(rows * width as usize);
        Rgba { width, height: rows as u32, pixels }
    }

    /// Returns the number of columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the pixels R, G, B, A, row by row from the top.
    pub fn pixels(&self) -> &[[u8; 4]] {
        &self.pixels
    }

    /// Returns the pixels, which may be changed.
    pub fn pixels_mut(&mut self) -> &mut [[u8; 4]] {
        &mut self.pixels
    }
}

/// Contents of an image file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Contents {
    /// Pixels of a PNG or TGA file.
    Picture(Rgba),
    /// Texels of a DDS file.
    Texture(Dds),
}

/// The error that an image was not read.
#[derive(Debug, Error)]
#[error("image `{}` {fault}", ninebit::shown::path(path))]
pub struct ImageError {
    /// Path of the image file.
    pub(crate) path: PathBuf,
    /// What is wrong with it.
    pub(crate) fault: ImageFault,
}

/// The fault of an image file.
#[derive(Debug, Error)]
pub(crate) enum ImageFault {
    /// There is no such file.
    #[error("does not exist")]
    Missing,
    /// The path is a folder, a device or a pipe.
    #[error("is not a regular file")]
    NotAFile,
    /// The file system refused to read it.
    #[error("cannot be read: {0}")]
    Unreadable(io::Error),
    /// The file has none of the supported formats; the text says which were expected.
    #[error("is {0}")]
    Format(&'static str),
    /// The file has more bytes than [`ImageLimits::maximum_file_bytes`].
    #[error("is larger than {0}")]
    FileBytes(FileLimit),
    /// The image has more columns or rows than allowed.
    #[error("is {width} x {height}; a side may have {limit} pixels at most")]
    Side {
        /// Number of its columns.
        width: u32,
        /// Number of its rows.
        height: u32,
        /// The largest side: [`ImageLimits::maximum_side`].
        limit: u32,
    },
    /// The image has more pixels than allowed.
    #[error("decodes to {bytes} bytes; {limit} are allowed")]
    DecodedBytes {
        /// Number of bytes that its pixels need.
        bytes: u64,
        /// The largest number: [`ImageLimits::maximum_decoded_bytes`].
        limit: u64,
    },
    /// The contents make no sense; the text says why.
    #[error("is damaged: {0}")]
    Damaged(String),
    /// A DDS file holds a kind of texture that no texture unit of the model reads.
    #[error("holds {0}, which this program does not read")]
    Unsupported(String),
    /// A cube map lacks these of its six faces.
    #[error("is a cube map without {}", .0.join(", "))]
    MissingFaces(Vec<&'static str>),
    /// The channels have more than 8 bits: this many.
    #[error("has {0} bits a channel; 8 are the most")]
    Depth(u8),
}

impl ImageFault {
    /// Makes the error that the file at `path` has this fault.
    pub(super) fn at(self, path: &Path) -> ImageError {
        ImageError { path: path.to_path_buf(), fault: self }
    }

    /// Returns the stable code, and the help: what to do about the fault.
    fn message_and_help(&self) -> (&'static str, &'static str) {
        let smaller = "scale the image down; `ninebit limits` prints what is allowed";
        match self {
            ImageFault::Missing => (
                "NB0510",
                "check the spelling: upper and lower case count, and names in a scene are relative to its folder",
            ),
            ImageFault::NotAFile => ("NB0511", "name a PNG or TGA file, not a folder or a device"),
            ImageFault::Unreadable(_) => ("NB0512", "check the file's permissions"),
            ImageFault::Format(_) => ("NB0513", "convert it to PNG, or to TGA with the extension `.tga`"),
            ImageFault::FileBytes(_) => ("NB0514", "store the image compressed, or smaller"),
            ImageFault::Side { .. } => ("NB0515", smaller),
            ImageFault::DecodedBytes { .. } => ("NB0516", smaller),
            ImageFault::Damaged(_) => ("NB0517", "open the file in an image editor and save it again"),
            ImageFault::Depth(_) => {
                ("NB0518", "save it with 8 bits a channel: which of the 16 bits are to be kept is yours to decide")
            }
            ImageFault::Unsupported(_) => (
                "NB0519",
                "save it as DXT1, DXT3, DXT5, A8R8G8B8, X8R8G8B8, R5G6B5, A1R5G5B5, A4R4G4B4 or L8, with 2D levels or six faces",
            ),
            ImageFault::MissingFaces(_) => ("NB0520", "save it with all six faces"),
        }
    }
}

impl ImageError {
    /// Returns the code, which `docs/errors.md` lists.
    pub fn code(&self) -> &'static str {
        self.fault.message_and_help().0
    }

    /// Returns what to do about it.
    pub fn help(&self) -> &'static str {
        self.fault.message_and_help().1
    }

    /// Returns the path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns whether the file exceeds a limit, without another fault having been found.
    pub fn is_limit(&self) -> bool {
        matches!(self.fault, ImageFault::FileBytes(_) | ImageFault::Side { .. } | ImageFault::DecodedBytes { .. })
    }

    /// Returns whether there is no such file.
    pub fn is_missing(&self) -> bool {
        matches!(self.fault, ImageFault::Missing)
    }
}

/// Reads the PNG or TGA file at `path`.
///
/// A PNG is recognised by its first eight bytes, whatever its name; a TGA has no such mark and is recognised by its extension.
///
/// # Errors
/// See [`ImageError`]. No input makes this panic.
pub fn load(path: &Path, limits: &ImageLimits) -> Result<Rgba, ImageError> {
    let bytes = read(&Folder, path, limits.file())?;
    decode(&bytes, path, limits)
}

/// Reads the PNG or TGA file at `path`, which may also be a grey PNG of 16 bits. Returns the pixels, and whether they are those of 16-bit words, as
/// [`pixel_of_word`] makes them.
///
/// # Errors
/// See [`ImageError`]. No input makes this panic.
pub fn load_words(path: &Path, limits: &ImageLimits) -> Result<(Rgba, bool), ImageError> {
    let bytes = read(&Folder, path, limits.file())?;
    picture(&bytes, path, limits, 16).map_err(|fault| fault.at(path))
}

/// Returns the pixel that stands for a word of 16 bits: the high byte in red, the low byte in green.
pub fn pixel_of_word(word: u16) -> [u8; 4] {
    [(word >> 8) as u8, word as u8, 0, 255]
}

/// Reads the PNG, TGA or DDS file at `path`. A DDS is recognised by its first four bytes, whatever its name.
///
/// # Errors
/// See [`ImageError`]. No input makes this panic.
pub fn open(path: &Path, limits: &ImageLimits) -> Result<Contents, ImageError> {
    contents(&read(&Folder, path, limits.file())?, path, limits)
}

/// Decodes the contents of a PNG, TGA or DDS file; `path` gives the extension and names the file in errors.
///
/// # Errors
/// Those of [`open`], except for errors of reading.
pub(crate) fn contents(bytes: &[u8], path: &Path, limits: &ImageLimits) -> Result<Contents, ImageError> {
    if bytes.starts_with(&dds::SIGNATURE) {
        return dds::decode(bytes, path, limits).map(Contents::Texture);
    }
    picture(bytes, path, limits, 8).map(|(picture, _)| Contents::Picture(picture)).map_err(|fault| match fault {
        ImageFault::Format(_) => ImageFault::Format("neither a PNG, a TGA nor a DDS file").at(path),
        fault => fault.at(path),
    })
}

/// Decodes the contents of an image file; `path` gives the extension and names the file in errors.
///
/// # Errors
/// Those of [`load`], except for errors of reading.
pub fn decode(bytes: &[u8], path: &Path, limits: &ImageLimits) -> Result<Rgba, ImageError> {
    picture(bytes, path, limits, 8).map(|(picture, _)| picture).map_err(|fault| fault.at(path))
}

/// Decodes a PNG or TGA file whose channels have at most `bits` bits. Returns the pixels, and whether they are those of 16-bit words.
fn picture(bytes: &[u8], path: &Path, limits: &ImageLimits, bits: u8) -> Result<(Rgba, bool), ImageFault> {
    let damaged = |reason: &str| ImageFault::Damaged(reason.to_owned());
    let (format, header, bytes) = if bytes.starts_with(&png::SIGNATURE) {
        let reduced = png::essential(bytes).map_err(damaged)?;
        (ImageFormat::Png, reduced.header, std::borrow::Cow::Owned(reduced.bytes))
    } else if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("tga")) {
        let header = tga_header(bytes).ok_or_else(|| damaged("the header is cut off"))?;
        (ImageFormat::Tga, header, std::borrow::Cow::Borrowed(bytes))
    } else {
        return Err(ImageFault::Format("neither a PNG nor a TGA file"));
    };
    limits.check_sides(header.width, header.height, limits.maximum_side)?;
    limits.check_decoded(4 * u64::from(header.width) * u64::from(header.height))?;
    if header.bits > bits {
        return Err(ImageFault::Depth(header.bits));
    }

    let mut allowed = image::Limits::default();
    allowed.max_image_width = Some(limits.maximum_side);
    allowed.max_image_height = Some(limits.maximum_side);
    // The decoder needs its row buffers in addition to the pixels.
    allowed.max_alloc = Some(limits.maximum_decoded_bytes.saturating_add(4 << 20));
    let decoded = catch_panic::quietly(|| {
        let mut reader = image::ImageReader::with_format(Cursor::new(&*bytes), format);
        reader.limits(allowed);
        reader.decode()
    })
    .map_err(|panic| damaged(&format!("the decoder gave up ({panic})")))?
    .map_err(|error| damaged(&error.to_string()))?;
    Ok((to_rgba(decoded)?, header.bits > 8))
}

/// The fields of a header, which is read before anything is decoded.
#[derive(Clone, Copy, Debug)]
struct Header {
    width: u32,
    height: u32,
    /// Number of bits of a channel.
    bits: u8,
}

/// Reads the header of a TGA file; `None` if the file ends within it.
fn tga_header(bytes: &[u8]) -> Option<Header> {
    let header: &[u8; 18] = bytes.first_chunk()?;
    let side = |low: usize| u32::from(u16::from_le_bytes([header[low], header[low + 1]]));
    Some(Header { width: side(12), height: side(14), bits: 8 })
}

/// Converts the decoder's pixels into R, G, B, A. Grey stands for all three colours.
fn to_rgba(decoded: DynamicImage) -> Result<Rgba, ImageFault> {
    let (width, height) = (decoded.width(), decoded.height());
    let pixels = match decoded {
        DynamicImage::ImageLuma8(grey) => grey.pixels().map(|p| [p[0], p[0], p[0], 255]).collect(),
        DynamicImage::ImageLumaA8(grey) => grey.pixels().map(|p| [p[0], p[0], p[0], p[1]]).collect(),
        DynamicImage::ImageRgb8(color) => color.pixels().map(|p| [p[0], p[1], p[2], 255]).collect(),
        DynamicImage::ImageRgba8(color) => color.pixels().map(|p| p.0).collect(),
        DynamicImage::ImageLuma16(grey) => grey.pixels().map(|p| pixel_of_word(p[0])).collect(),
        // Colours of 16 bits are refused here too, in case a decoder widens its pixels.
        _ => return Err(ImageFault::Depth(16)),
    };
    Ok(Rgba { width, height, pixels })
}

/// Reads a file within a limit.
pub(super) fn read(assets: &dyn Assets, path: &Path, limit: FileLimit) -> Result<Vec<u8>, ImageError> {
    let fault = |error| match error {
        ReadError::Missing => ImageFault::Missing,
        ReadError::NotRegular => ImageFault::NotAFile,
        ReadError::TooLarge(limit) => ImageFault::FileBytes(limit),
        ReadError::Refused(error) => ImageFault::Unreadable(error),
    };
    assets.bytes(path, limit).map_err(|error| fault(error).at(path))
}
