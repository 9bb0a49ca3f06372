//! Files written so that a reader never sees half of one.
//!
//! A file is written under a temporary name in its own folder, flushed to the disk and renamed. Whatever goes wrong before the
//! rename, the old file is untouched and the temporary one is removed.

use std::ffi::OsStr;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use thiserror::Error;

/// Why an output was not written. Nothing of it exists then.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The place does not take files.
    #[error("`{}` is a folder", path.display())]
    Folder {
        /// The output.
        path: PathBuf,
    },
    /// The file system refused.
    #[error("`{}` cannot be written: {source}", path.display())]
    Write {
        /// The output.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Standard output refused.
    #[error("standard output cannot be written: {source}")]
    Stdout {
        /// Why.
        source: io::Error,
    },
    /// The encoder refused the picture.
    #[error("a picture of {width} x {height} cannot be encoded: {reason}")]
    Encode {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Why.
        reason: String,
    },
}

impl OutputError {
    /// Stable code.
    pub fn code(&self) -> &'static str {
        match self {
            OutputError::Folder { .. } => "NB0701",
            OutputError::Write { .. } => "NB0702",
            OutputError::Stdout { .. } => "NB0703",
            OutputError::Encode { .. } => "NB0704",
        }
    }

    /// What to do about it.
    pub fn help(&self) -> &'static str {
        match self {
            OutputError::Folder { .. } => "name a file in it",
            OutputError::Write { source, .. } => match source.kind() {
                io::ErrorKind::NotFound => "create its folder first",
                io::ErrorKind::PermissionDenied => "check that the file and its folder may be written to",
                io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "free some space on that disk",
                _ => "write to another place",
            },
            OutputError::Stdout { .. } => "write to a file with `-o FILE`",
            OutputError::Encode { .. } => "pictures need at least one pixel",
        }
    }

    /// The reader of standard output went away, as `head` does: no reason for a message.
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, OutputError::Stdout { source } if source.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// Where output goes: a file, or standard output for `-`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Destination {
    /// A file, replaced as a whole.
    File(PathBuf),
    /// Standard output.
    Stdout,
}

impl From<&OsStr> for Destination {
    fn from(text: &OsStr) -> Self {
        if text == "-" { Destination::Stdout } else { Destination::File(text.into()) }
    }
}

impl Destination {
    /// Writes `bytes` there.
    ///
    /// # Errors
    /// See [`write_file`]; standard output refuses.
    pub fn write(&self, bytes: &[u8]) -> Result<(), OutputError> {
        match self {
            Destination::File(path) => write_file(path, bytes),
            Destination::Stdout => write_stdout(bytes),
        }
    }
}

/// Replaces the file at `path` by `bytes`, as a whole or not at all.
///
/// A link is followed, so that what it points to is replaced and not the link. An existing file's permissions are kept. A place
/// that is not a regular file, such as `/dev/null`, is written to directly.
///
/// # Errors
/// The place is a folder, a read-only file, its folder is missing or not writable, the disk is full.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    write_file_with(path, |out| out.write_all(bytes))
}

/// Makes a folder, and those that it lies in.
///
/// # Errors
/// It cannot be made.
pub fn make_folder(path: &Path) -> Result<(), OutputError> {
    std::fs::create_dir_all(path).map_err(|source| OutputError::Write { path: path.to_path_buf(), source })
}

/// [`write_file`] in a folder that is made if it is not there.
///
/// # Errors
/// As [`write_file`] and [`make_folder`].
pub fn write_below(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    path.parent().map_or(Ok(()), make_folder)?;
    write_file(path, bytes)
}

/// [`write_file`] of what `fill` writes; returns what it returns.
///
/// # Errors
/// As [`write_file`].
pub fn write_file_with<T>(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<T>) -> Result<T, OutputError> {
    let mut file = PendingFile::create(path)?;
    let result = fill(&mut file).map_err(|error| file.refused(error))?;
    file.commit()?;
    Ok(result)
}

/// A file under construction: nothing is at its place until it is [committed](Self::commit), and nothing is left of it if it is not.
#[derive(Debug)]
pub struct PendingFile {
    path: PathBuf,
    target: Target,
}

/// Where the bytes go.
#[derive(Debug)]
enum Target {
    /// A temporary file and what it will replace.
    Temporary(BufWriter<tempfile::NamedTempFile>, PathBuf),
    /// A place that is no regular file.
    Device(std::fs::File),
}

impl PendingFile {
    /// Begins a file; see [`write_file`].
    ///
    /// # Errors
    /// The place is a folder, a read-only file, its folder is missing or not writable.
    pub fn create(path: &Path) -> Result<PendingFile, OutputError> {
        let refused = |error: io::Error| OutputError::Write { path: path.to_path_buf(), source: error };
        let existing = path.metadata().ok();
        if existing.as_ref().is_some_and(std::fs::Metadata::is_dir) {
            return Err(OutputError::Folder { path: path.to_path_buf() });
        }
        if existing.as_ref().is_some_and(|metadata| !metadata.is_file()) {
            let device = std::fs::OpenOptions::new().write(true).open(path).map_err(refused)?;
            return Ok(PendingFile { path: path.to_path_buf(), target: Target::Device(device) });
        }
        if existing.as_ref().is_some_and(|metadata| metadata.permissions().readonly()) {
            // A rename would replace it all the same; whoever protected it meant the name.
            return Err(refused(io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only")));
        }
        let place = if existing.is_some() { path.canonicalize().map_err(refused)? } else { path.to_path_buf() };
        let folder = match place.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".ninebit-").suffix(".part");
        let permissions = match &existing {
            Some(metadata) => Some(metadata.permissions()),
            None => ordinary_permissions(),
        };
        if let Some(permissions) = permissions {
            // On systems where the mode of a new file is subject to the user's mask, so is this one.
            builder.permissions(permissions);
        }
        let temporary = builder.tempfile_in(folder).map_err(|error| refused(without_path(error)))?;
        Ok(PendingFile { path: path.to_path_buf(), target: Target::Temporary(BufWriter::new(temporary), place) })
    }

    /// An error of writing to it, for people.
    pub fn refused(&self, error: io::Error) -> OutputError {
        OutputError::Write { path: self.path.clone(), source: without_path(error) }
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// The disk is full, or the place refuses.
    pub fn commit(self) -> Result<(), OutputError> {
        let path = self.path;
        let refused = |error: io::Error| OutputError::Write { path: path.clone(), source: without_path(error) };
        match self.target {
            Target::Device(mut device) => device.flush().map_err(refused),
            Target::Temporary(buffered, place) => {
                let temporary = buffered.into_inner().map_err(|error| refused(error.into_error()))?;
                temporary.as_file().sync_all().map_err(refused)?;
                temporary.persist(&place).map(|_| ()).map_err(|error| refused(error.error))
            }
        }
    }
}

impl Write for PendingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.target {
            Target::Temporary(buffered, _) => buffered.write(bytes),
            Target::Device(device) => device.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.target {
            Target::Temporary(buffered, _) => buffered.flush(),
            Target::Device(device) => device.flush(),
        }
    }
}

/// The temporary file's errors name a file that the user has never heard of: what is said is their kind.
fn without_path(error: io::Error) -> io::Error {
    if error.get_ref().is_some() { error.kind().into() } else { error }
}

/// What a file made in the ordinary way may be used for: temporary files are closed to others, outputs are not.
#[cfg(unix)]
fn ordinary_permissions() -> Option<std::fs::Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(std::fs::Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn ordinary_permissions() -> Option<std::fs::Permissions> {
    None
}

/// Writes `bytes` to standard output and flushes it.
///
/// # Errors
/// Standard output refuses; see [`OutputError::is_broken_pipe`].
pub fn write_stdout(bytes: &[u8]) -> Result<(), OutputError> {
    write_stdout_with(|out| out.write_all(bytes))
}

/// [`write_stdout`] of what `fill` writes.
///
/// # Errors
/// As [`write_stdout`].
pub fn write_stdout_with(fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), OutputError> {
    let mut stdout = BufWriter::new(io::stdout().lock());
    fill(&mut stdout).and_then(|()| stdout.flush()).map_err(|source| OutputError::Stdout { source })
}

/// What a PNG is made for. The pixels are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compression {
    /// Frames: written quickly, about half as large again.
    Fast,
    /// Pictures that are kept, such as textures.
    Small,
}

/// A PNG of 8 bits a channel, R, G, B, A, row by row from the top.
///
/// # Errors
/// No pixels, or not `width * height` of them.
pub fn encode_png(
    width: u32,
    height: u32,
    pixels: &[[u8; 4]],
    compression: Compression,
) -> Result<Vec<u8>, OutputError> {
    let refuse = |reason: String| OutputError::Encode { width, height, reason };
    if u64::from(width) * u64::from(height) != pixels.len() as u64 || pixels.is_empty() {
        return Err(refuse(format!("{} pixels were given", pixels.len())));
    }
    let quality = match compression {
        Compression::Fast => CompressionType::Fast,
        Compression::Small => CompressionType::Default,
    };
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, quality, FilterType::Adaptive)
        .write_image(pixels.as_flattened(), width, height, ExtendedColorType::Rgba8)
        .map_err(|error| refuse(error.to_string()))?;
    Ok(bytes)
}
