//! Files written so that a reader never sees half of one.
//!
//! A file is written under a temporary name in its own folder, flushed to the disk and renamed. Whatever goes wrong before the
//! rename, the old file is untouched and the temporary one is removed; [`abandon`] removes those of a process that is told to end. What a
//! process leaves that is killed outright is a [leftover](is_leftover), which readers of folders pass over.

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

/// Why an output was not written. Nothing of it exists then.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The place does not take files.
    #[error("`{}` is a folder", shown::path(path))]
    Folder {
        /// Where the output would have gone.
        path: PathBuf,
    },
    /// The file system refused.
    #[error("`{}` cannot be written: {source}", shown::path(path))]
    Write {
        /// Where the output would have gone.
        path: PathBuf,
        /// What the file system said.
        source: io::Error,
    },
    /// It would take the place of a file that was read.
    #[error("`{}` is the input{}: nothing was written", shown::path(path), called(path, input))]
    Input {
        /// Where the output would have gone.
        path: PathBuf,
        /// What the file was called when it was read.
        input: PathBuf,
    },
    /// It would take the place of another output of the same run.
    #[error("`{}` would be written twice", shown::path(path))]
    Twice {
        /// Where both would have gone.
        path: PathBuf,
    },
    /// It would take the place of a file under version control.
    #[error("`{}` is there, in a folder under version control", shown::path(path))]
    Versioned {
        /// Where the output would have gone.
        path: PathBuf,
    },
    /// Standard output refused.
    #[error("standard output cannot be written: {source}")]
    Stdout {
        /// What the file system said.
        source: io::Error,
    },
    /// The encoder refused the picture.
    #[error("a picture of {width} x {height} cannot be encoded: {reason}")]
    Encode {
        /// Columns of the picture.
        width: u32,
        /// Rows of the picture.
        height: u32,
        /// What the encoder said.
        reason: String,
    },
}

impl OutputError {
    /// The code of `docs/errors.md`.
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
            OutputError::Input { .. } => "write the output to another file",
            OutputError::Twice { .. } => "give each output a file of its own",
            OutputError::Versioned { .. } => "write to another folder, or say `--overwrite`",
        }
    }

    /// It was not tried, because it would take the place of something else: the command line is wrong.
    pub fn is_refused(&self) -> bool {
        matches!(self, OutputError::Input { .. } | OutputError::Twice { .. } | OutputError::Versioned { .. })
    }

    /// The reader of standard output went away, as `head` does: no reason for a message.
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, OutputError::Stdout { source } if source.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// The name of an input, where the output is called otherwise.
fn called(path: &Path, input: &Path) -> String {
    if path == input { String::new() } else { format!(" `{}`", shown::path(input)) }
}

/// Where output goes: a file, or standard output for `-`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Destination {
    /// A file, replaced as a whole.
    File(PathBuf),
    /// Standard output, written as `-`.
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
    /// See [`files::claim`] and [`write_file`]; standard output refuses.
    pub fn write(&self, bytes: &[u8]) -> Result<(), OutputError> {
        match self {
            Destination::File(path) => {
                files::claim(path)?;
                write_file(path, bytes)
            }
            Destination::Stdout => write_stdout(bytes),
        }
    }

    /// Refuses the output if it would take the place of a file that was read. Ask before much is computed.
    ///
    /// # Errors
    /// See [`files::check`].
    pub fn check(&self) -> Result<(), OutputError> {
        files::check(self.path())
    }

    /// The file that it names; `None` of standard output.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Destination::File(path) => Some(path),
            Destination::Stdout => None,
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

/// Writes an output, in a folder that is made if it is not there.
///
/// # Errors
/// As [`files::claim`], [`write_file`] and [`make_folder`].
pub fn write_below(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    path.parent().map_or(Ok(()), make_folder)?;
    files::claim(path)?;
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

/// How the names of temporary files begin and end.
const TEMPORARY: (&str, &str) = (".ninebit-", ".part");

/// Whether a file of that name was left by a run that was killed: nobody reads it.
pub fn is_leftover(name: &OsStr) -> bool {
    name.to_str().is_some_and(|name| name.starts_with(TEMPORARY.0) && name.ends_with(TEMPORARY.1))
}

/// Removes what runs that were killed left in a folder. None may be at work in it.
///
/// # Errors
/// The folder cannot be read, a file in it not removed.
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

/// Temporary files and folders that are there right now.
static PENDING: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn pending() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    PENDING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every temporary file and folder, for a process that ends at once: threads that begin or finish a file from now on wait for ever.
pub fn abandon() {
    let pending = pending();
    for path in pending.iter() {
        // There is nobody left to tell.
        let _ = remove(path);
    }
    std::mem::forget(pending);
}

/// An entry of [`PENDING`].
#[derive(Debug)]
struct Pending(PathBuf);

impl Pending {
    /// Makes something temporary and enters it, between which no signal falls.
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

/// A folder under construction: as a [`PendingFile`], it is at its place as a whole or not at all.
#[derive(Debug)]
pub struct PendingFolder {
    place: PathBuf,
    temporary: tempfile::TempDir,
    _pending: Pending,
}

impl PendingFolder {
    /// Begins the folder `place`, which must not be there, in a folder that is made if it is not there.
    ///
    /// # Errors
    /// The folder around it cannot be made, or is not writable.
    pub fn create(place: &Path) -> Result<PendingFolder, OutputError> {
        let around = place.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        make_folder(around)?;
        let mut builder = tempfile::Builder::new();
        builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
        let made = Pending::enter(|| builder.tempdir_in(around), |folder| folder.path());
        let (temporary, pending) =
            made.map_err(|error| OutputError::Write { path: place.to_path_buf(), source: without_path(error) })?;
        Ok(PendingFolder { place: place.to_path_buf(), temporary, _pending: pending })
    }

    /// Where its files are written.
    pub fn path(&self) -> &Path {
        self.temporary.path()
    }

    /// Puts the folder in its place.
    ///
    /// # Errors
    /// Something is there, or the place refuses.
    pub fn commit(self) -> Result<(), OutputError> {
        {
            let _pending = pending();
            std::fs::rename(self.temporary.path(), &self.place)
                .map_err(|source| OutputError::Write { path: self.place.clone(), source })?;
        }
        // Under its old name there is nothing left to remove.
        let _ = self.temporary.keep();
        Ok(())
    }
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
    /// A temporary file, what it will replace, and its entry, which goes after the file.
    Temporary(BufWriter<tempfile::NamedTempFile>, PathBuf, Pending),
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
        builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
        let permissions = match &existing {
            Some(metadata) => Some(metadata.permissions()),
            None => ordinary_permissions(),
        };
        if let Some(permissions) = permissions {
            // On systems where the mode of a new file is subject to the user's mask, so is this one.
            builder.permissions(permissions);
        }
        let made = Pending::enter(|| builder.tempfile_in(folder), |file| file.path());
        let (temporary, pending) = made.map_err(|error| refused(without_path(error)))?;
        Ok(PendingFile {
            path: path.to_path_buf(),
            target: Target::Temporary(BufWriter::new(temporary), place, pending),
        })
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

/// Writes a text for people to standard output, as [`shown::lines`] has it.
///
/// # Errors
/// As [`write_stdout`].
pub fn write_text(text: &str) -> Result<(), OutputError> {
    write_stdout(shown::lines(text).as_bytes())
}

/// Writes a JSON document to standard output, as [`shown::json`] has it, and ends its last line.
///
/// # Errors
/// As [`write_stdout`].
pub fn write_json(document: &str) -> Result<(), OutputError> {
    write_stdout(format!("{}\n", shown::json(document.trim_end())).as_bytes())
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
    encode((width, height), pixels.len(), pixels.as_flattened(), ExtendedColorType::Rgba8, compression)
}

/// A PNG of 16 bits of grey, row by row from the top.
///
/// # Errors
/// As [`encode_png`].
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
