//! Writes files, [as a whole or not at all](crate::pending), and standard output.

use std::ffi::OsStr;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::files;
use crate::pending::{FaultPoint, PendingFile};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use ninebit::shown;

pub use crate::error::OutputError;
pub use crate::pending::make_folder;

/// A destination of output: a file, or standard output for `-`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Destination {
    /// A file, which is replaced as a whole.
    File(PathBuf),
    /// Standard output, which the command line calls `-`.
    Stdout,
}

impl From<&OsStr> for Destination {
    fn from(text: &OsStr) -> Self {
        if text == "-" { Destination::Stdout } else { Destination::File(text.into()) }
    }
}

impl Destination {
    /// Writes `bytes` to the destination.
    ///
    /// # Errors
    /// Those of [`files::claim`] and [`write_file`], or standard output cannot be written.
    pub fn write(&self, bytes: &[u8]) -> Result<(), OutputError> {
        match self {
            Destination::File(path) => {
                files::claim(path)?;
                write_file(path, bytes)
            }
            Destination::Stdout => write_stdout(bytes),
        }
    }

    /// Refuses the destination if the output would replace a file that was read. Call this before a long computation.
    ///
    /// # Errors
    /// See [`files::check`].
    pub fn check(&self) -> Result<(), OutputError> {
        files::check(self.path())
    }

    /// Returns the path of the file; `None` for standard output.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Destination::File(path) => Some(path),
            Destination::Stdout => None,
        }
    }
}

/// Replaces the file at `path` by `bytes`, as a whole or not at all.
///
/// A link is followed: the file that it points to is replaced, not the link. An existing file's permissions are kept. Other
/// things than regular files, such as `/dev/null`, are written to directly.
///
/// # Errors
/// The path is a folder or a read-only file, its folder is missing or not writable, or the disk is full.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let mut file = PendingFile::create(path)?;
    file.write_all(bytes).map_err(|error| file.refused(error))?;
    file.commit()
}

/// Writes an output, and makes its folder if it does not exist.
///
/// # Errors
/// Those of [`files::claim`], [`write_file`] and [`make_folder`].
pub fn write_below(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    path.parent().map_or(Ok(()), make_folder)?;
    files::claim(path)?;
    write_file(path, bytes)
}

/// Writes `bytes` to standard output and flushes it.
///
/// # Errors
/// Standard output cannot be written; see [`OutputError::is_broken_pipe`].
pub fn write_stdout(bytes: &[u8]) -> Result<(), OutputError> {
    write_stdout_with(|out| out.write_all(bytes))
}

/// Writes what `fill` writes to standard output, like [`write_stdout`].
///
/// # Errors
/// Those of [`write_stdout`].
pub fn write_stdout_with(fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), OutputError> {
    let mut stdout = BufWriter::new(FaultPoint(io::stdout().lock()));
    fill(&mut stdout).and_then(|()| stdout.flush()).map_err(|source| OutputError::Stdout { source })
}

/// Writes a text for people to standard output, in the form of [`shown::lines`].
///
/// # Errors
/// Those of [`write_stdout`].
pub fn write_text(text: &str) -> Result<(), OutputError> {
    write_stdout(shown::lines(text).as_bytes())
}

/// Writes a JSON document to standard output, in the form of [`shown::json`], and ends its last line.
///
/// # Errors
/// Those of [`write_stdout`].
pub fn write_json(document: &str) -> Result<(), OutputError> {
    write_stdout(format!("{}\n", shown::json(document.trim_end())).as_bytes())
}

/// Compression of a PNG; its pixels do not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compression {
    /// For frames: fast, with files about half as large again.
    Fast,
    /// For pictures that are kept, such as textures: small files.
    Small,
}

/// Encodes a PNG with channels R, G, B, A of 8 bits. The pixels are row by row from the top.
///
/// # Errors
/// There are no pixels, or not `width * height` of them.
pub fn encode_png(
    width: u32,
    height: u32,
    pixels: &[[u8; 4]],
    compression: Compression,
) -> Result<Vec<u8>, OutputError> {
    encode((width, height), pixels.len(), pixels.as_flattened(), ExtendedColorType::Rgba8, compression)
}

/// Encodes a PNG of 16-bit grey. The pixels are row by row from the top.
///
/// # Errors
/// Those of [`encode_png`].
pub fn encode_grey_png(width: u32, height: u32, pixels: &[u16]) -> Result<Vec<u8>, OutputError> {
    let bytes: Vec<u8> = pixels.iter().flat_map(|grey| grey.to_ne_bytes()).collect();
    encode((width, height), pixels.len(), &bytes, ExtendedColorType::L16, Compression::Fast)
}

fn encode(
    (width, height): (u32, u32),
    count: usize,
    samples: &[u8],
    color: ExtendedColorType,
    compression: Compression,
) -> Result<Vec<u8>, OutputError> {
    let refuse = |reason: String| OutputError::Encode { width, height, reason };
    if u64::from(width) * u64::from(height) != count as u64 || count == 0 {
        return Err(refuse(format!("{count} pixels were given")));
    }
    let quality = match compression {
        Compression::Fast => CompressionType::Fast,
        Compression::Small => CompressionType::Default,
    };
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, quality, FilterType::Adaptive)
        .write_image(samples, width, height, color)
        .map_err(|error| refuse(error.to_string()))?;
    Ok(bytes)
}
