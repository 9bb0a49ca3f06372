//! Writes files so that a reader never sees a part of one.
//!
//! A file is written under a temporary name in its own folder, flushed to the disk and renamed. If anything goes wrong before the
//! rename, the old file is unchanged and the temporary one is removed. [`abandon`] removes the temporary files of a process that is told to end. A
//! process that is killed leaves its temporary files behind as [leftovers](is_leftover), which readers of folders ignore.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use thiserror::Error;

use crate::files;
use ninebit::shown;

/// The error that an output was not written, not even in part.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The path is a folder.
    #[error("`{}` is a folder", shown::path(path))]
    Folder {
        /// Path of the output.
        path: PathBuf,
    },
    /// The file system refused to write it.
    #[error("`{}` cannot be written: {source}", shown::path(path))]
    Write {
        /// Path of the output.
        path: PathBuf,
        /// Error of the file system.
        source: io::Error,
    },
    /// The output would replace a file that was read.
    #[error("`{}` is the input{}: nothing was written", shown::path(path), called(path, input))]
    Input {
        /// Path of the output.
        path: PathBuf,
        /// Path under which the file was read.
        input: PathBuf,
    },
    /// The output would replace another output of the same run.
    #[error("`{}` would be written twice", shown::path(path))]
    Twice {
        /// Path of both outputs.
        path: PathBuf,
    },
    /// The output would replace a file under version control.
    #[error("`{}` is there, in a folder under version control", shown::path(path))]
    Versioned {
        /// Path of the output.
        path: PathBuf,
    },
    /// Standard output could not be written.
    #[error("standard output cannot be written: {source}")]
    Stdout {
        /// Error of the file system.
        source: io::Error,
    },
    /// The picture could not be encoded.
    #[error("a picture of {width} x {height} cannot be encoded: {reason}")]
    Encode {
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
        /// Message of the encoder.
        reason: String,
    },
}

impl OutputError {
    /// Returns the code, which `docs/errors.md` lists.
    pub fn code(&self) -> &'static str {
        match self {
            OutputError::Folder { .. } => "NB0701",
            OutputError::Write { .. } => "NB0702",
            OutputError::Stdout { .. } => "NB0703",
            OutputError::Encode { .. } => "NB0704",
            OutputError::Input { .. } => "NB0705",
            OutputError::Twice { .. } => "NB0706",
            OutputError::Versioned { .. } => "NB0707",
        }
    }

    /// Returns what to do about it.
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
            OutputError::Input { .. } => "write the output to another file",
            OutputError::Twice { .. } => "give each output a file of its own",
            OutputError::Versioned { .. } => "write to another folder, or say `--overwrite`",
        }
    }

    /// Returns whether writing was not tried because the output would replace something else, so that the command line is wrong.
    pub fn is_refused(&self) -> bool {
        matches!(self, OutputError::Input { .. } | OutputError::Twice { .. } | OutputError::Versioned { .. })
    }

    /// Returns whether the reader of standard output has gone away, as `head` does. That needs no message.
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, OutputError::Stdout { source } if source.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// Returns the name of an input for the message, if the output has another name.
fn called(path: &Path, input: &Path) -> String {
    if path == input { String::new() } else { format!(" `{}`", shown::path(input)) }
}

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

/// Makes a folder, including the folders around it.
///
/// # Errors
/// The folder cannot be made.
pub fn make_folder(path: &Path) -> Result<(), OutputError> {
    std::fs::create_dir_all(path).map_err(|source| OutputError::Write { path: path.to_path_buf(), source })
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

/// Prefix and suffix of the names of temporary files.
const TEMPORARY: (&str, &str) = (".ninebit-", ".part");

/// Returns whether a file of this name is temporary. If no run is at work, a killed one has left it, and nobody reads it.
pub fn is_leftover(name: &OsStr) -> bool {
    name.to_str().is_some_and(|name| name.starts_with(TEMPORARY.0) && name.ends_with(TEMPORARY.1))
}

/// Removes the temporary files that killed runs have left in a folder, in which no run may be at work.
///
/// # Errors
/// The folder cannot be read, or a file in it cannot be removed.
pub fn remove_leftovers(folder: &Path) -> Result<(), OutputError> {
    let refused = |source| OutputError::Write { path: folder.to_path_buf(), source };
    for entry in std::fs::read_dir(folder).map_err(refused)? {
        let entry = entry.map_err(refused)?;
        if is_leftover(&entry.file_name()) {
            remove(&entry.path()).map_err(refused)?;
        }
    }
    Ok(())
}

fn remove(path: &Path) -> io::Result<()> {
    if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) }
}

/// Temporary files and folders that currently exist.
static PENDING: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn pending() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    PENDING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes all temporary files and folders of a process that is about to end. Threads that begin or finish a file afterwards wait for ever.
pub fn abandon() {
    let pending = pending();
    for path in pending.iter() {
        // Nobody is left to be told of an error.
        let _ = remove(path);
    }
    std::mem::forget(pending);
}

/// An entry of [`PENDING`], which is removed when this is dropped.
#[derive(Debug)]
struct Pending(PathBuf);

impl Pending {
    /// Makes something temporary and enters it, while [`abandon`] has to wait.
    fn enter<T>(make: impl FnOnce() -> io::Result<T>, path: impl FnOnce(&T) -> &Path) -> io::Result<(T, Pending)> {
        let mut pending = pending();
        let made = make()?;
        let path = path(&made).to_path_buf();
        pending.insert(path.clone());
        Ok((made, Pending(path)))
    }
}

impl Drop for Pending {
    fn drop(&mut self) {
        pending().remove(&self.0);
    }
}

/// A folder under construction. Like a [`PendingFile`], it appears at its path as a whole or not at all.
#[derive(Debug)]
pub struct PendingFolder {
    place: PathBuf,
    temporary: tempfile::TempDir,
    _pending: Pending,
}

impl PendingFolder {
    /// Begins a folder at `place`, which must not exist. The folder around it is made if it does not exist.
    ///
    /// # Errors
    /// The folder around it cannot be made or written.
    pub fn create(place: &Path) -> Result<PendingFolder, OutputError> {
        let around = files::folder_around(place);
        make_folder(around)?;
        let mut builder = tempfile::Builder::new();
        builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
        let made = Pending::enter(|| builder.tempdir_in(around), |folder| folder.path());
        let (temporary, pending) =
            made.map_err(|error| OutputError::Write { path: place.to_path_buf(), source: without_path(error) })?;
        Ok(PendingFolder { place: place.to_path_buf(), temporary, _pending: pending })
    }

    /// Returns the temporary path of the folder, where its files are to be written.
    pub fn path(&self) -> &Path {
        self.temporary.path()
    }

    /// Moves the folder to its path.
    ///
    /// # Errors
    /// Something exists at that path, or the file system refuses.
    pub fn commit(self) -> Result<(), OutputError> {
        {
            let _pending = pending();
            std::fs::rename(self.temporary.path(), &self.place)
                .map_err(|source| OutputError::Write { path: self.place.clone(), source })?;
        }
        // The folder has no longer this name, so nothing is left to remove.
        let _ = self.temporary.keep();
        Ok(())
    }
}

/// A file under construction. It appears at its path when it is [committed](Self::commit); otherwise nothing remains of it.
#[derive(Debug)]
pub struct PendingFile {
    path: PathBuf,
    target: Target,
}

/// Where the bytes are written.
#[derive(Debug)]
enum Target {
    /// A temporary file, the path that it will get, and its entry, which has to be dropped after the file.
    Temporary(BufWriter<tempfile::NamedTempFile>, PathBuf, Pending),
    /// Something else than a regular file, which is written directly.
    Device(std::fs::File),
}

impl PendingFile {
    /// Begins a file; see [`write_file`].
    ///
    /// # Errors
    /// The path is a folder or a read-only file, or its folder is missing or not writable.
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
            // A rename would replace the file nevertheless, but whoever protected it did not want that.
            return Err(refused(io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only")));
        }
        let place = if existing.is_some() { path.canonicalize().map_err(refused)? } else { path.to_path_buf() };
        let folder = files::folder_around(&place);
        let mut builder = tempfile::Builder::new();
        builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
        let permissions = existing.as_ref().map(std::fs::Metadata::permissions);
        if let Some(permissions) = permissions.or_else(ordinary_permissions) {
            // On systems where the mode of new files is subject to the user's mask, this one is as well.
            builder.permissions(permissions);
        }
        let made = Pending::enter(|| builder.tempfile_in(folder), |file| file.path());
        let (temporary, pending) = made.map_err(|error| refused(without_path(error)))?;
        let target = Target::Temporary(BufWriter::new(temporary), place, pending);
        Ok(PendingFile { path: path.to_path_buf(), target })
    }

    /// Turns an error of writing this file into an [`OutputError`].
    pub fn refused(&self, error: io::Error) -> OutputError {
        OutputError::Write { path: self.path.clone(), source: without_path(error) }
    }

    /// Moves the file to its path.
    ///
    /// # Errors
    /// The disk is full, or the file system refuses.
    pub fn commit(self) -> Result<(), OutputError> {
        let path = self.path;
        let refused = |error: io::Error| OutputError::Write { path: path.clone(), source: without_path(error) };
        match self.target {
            Target::Device(mut device) => device.flush().map_err(refused),
            Target::Temporary(buffered, place, _entry) => {
                let temporary = buffered.into_inner().map_err(|error| refused(error.into_error()))?;
                temporary.as_file().sync_all().map_err(refused)?;
                let _pending = pending();
                temporary.persist(&place).map(|_| ()).map_err(|error| refused(error.error))
            }
        }
    }
}

impl Write for PendingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.target {
            Target::Temporary(buffered, ..) => buffered.write(bytes),
            Target::Device(device) => device.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.target {
            Target::Temporary(buffered, ..) => buffered.flush(),
            Target::Device(device) => device.flush(),
        }
    }
}

/// Removes the path from an error. It is that of the temporary file, which the user does not know.
fn without_path(error: io::Error) -> io::Error {
    if error.get_ref().is_some() { error.kind().into() } else { error }
}

/// Returns the permissions of an ordinary new file. Temporary files cannot be read by others, but outputs can.
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
/// Standard output cannot be written; see [`OutputError::is_broken_pipe`].
pub fn write_stdout(bytes: &[u8]) -> Result<(), OutputError> {
    write_stdout_with(|out| out.write_all(bytes))
}

/// Writes what `fill` writes to standard output, like [`write_stdout`].
///
/// # Errors
/// Those of [`write_stdout`].
pub fn write_stdout_with(fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), OutputError> {
    let mut stdout = BufWriter::new(io::stdout().lock());
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
