//! Files and folders under construction: a reader never sees a part of one.
//!
//! A file is written under a temporary name in its own folder, flushed to the disk and renamed. If anything goes wrong before the
//! rename, the old file is unchanged and the temporary one is removed. [`abandon`] removes the temporary files of a process that is told to end; what
//! a killed one leaves, [the next one clears](crate::leftover).

use std::collections::BTreeSet;
use std::fs::Metadata;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::error::OutputError;
use crate::files;
use crate::leftover::{self, is_leftover};
use ninebit::faults::{self, Operation};

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
        let _ = leftover::remove(path);
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
        faults::check(Operation::Write)?;
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

/// Makes a folder, including the folders around it.
///
/// # Errors
/// The folder cannot be made, or is called `-`.
pub fn make_folder(path: &Path) -> Result<(), OutputError> {
    refuse_stdout(path)?;
    faults::check(Operation::Write)
        .and_then(|()| std::fs::create_dir_all(path))
        .map_err(|source| OutputError::Write { path: path.to_path_buf(), source })
}

/// Refuses `-` where a folder is meant: several files do not go to standard output.
fn refuse_stdout(folder: &Path) -> Result<(), OutputError> {
    if folder.as_os_str() != "-" {
        return Ok(());
    }
    let source =
        io::Error::new(io::ErrorKind::InvalidInput, "several files do not go to standard output; name a folder");
    Err(OutputError::Write { path: folder.to_path_buf(), source })
}

/// A folder under construction. Like a [`PendingFile`], it appears at its path as a whole or not at all.
#[derive(Debug)]
pub struct PendingFolder {
    place: PathBuf,
    /// Whether there is a folder at that path, whose place this one takes.
    replaces: bool,
    temporary: tempfile::TempDir,
    _pending: Pending,
}

impl PendingFolder {
    /// Begins a folder at `place`, which must not exist. The folder around it is made if it does not exist.
    ///
    /// # Errors
    /// The folder around it cannot be made or written, or it is called `-`.
    pub fn create(place: &Path) -> Result<PendingFolder, OutputError> {
        refuse_stdout(place)?;
        make_folder(files::folder_around(place))?;
        PendingFolder::begin(place.to_path_buf(), false)
    }

    /// Begins a folder that is to take the place of the folder at `place`. `None` if that one cannot be renamed: it is the working folder or around
    /// it, another file system begins there, or the folder around it cannot be written.
    ///
    /// # Errors
    /// There is no such folder, or a temporary one cannot be made beside it.
    pub fn replacing(place: &Path) -> Result<Option<PendingFolder>, OutputError> {
        let refused = |source| OutputError::Write { path: place.to_path_buf(), source };
        let whole = place.canonicalize().map_err(refused)?;
        let metadata = whole.metadata().map_err(refused)?;
        let around = files::folder_around(&whole).metadata().map_err(refused)?;
        let works_there = std::env::current_dir().and_then(|folder| folder.canonicalize());
        if works_there.is_ok_and(|folder| folder.starts_with(&whole)) || !is_one_file_system(&metadata, &around) {
            return Ok(None);
        }
        let begun = match PendingFolder::begin(whole, true) {
            Err(OutputError::Write { source, .. }) if source.kind() == io::ErrorKind::PermissionDenied => {
                return Ok(None);
            }
            begun => begun?,
        };
        std::fs::set_permissions(begun.path(), metadata.permissions()).map_err(refused)?;
        Ok(Some(begun))
    }

    fn begin(place: PathBuf, replaces: bool) -> Result<PendingFolder, OutputError> {
        let around = files::folder_around(&place);
        leftover::clear(around);
        let prefix = leftover::prefix();
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(leftover::SUFFIX);
        let made = Pending::enter(|| builder.tempdir_in(around), |folder| folder.path());
        match made {
            Ok((temporary, pending)) => Ok(PendingFolder { place, replaces, temporary, _pending: pending }),
            Err(error) => Err(OutputError::Write { path: place, source: without_path(error) }),
        }
    }

    /// Returns the temporary path of the folder, where its files are to be written.
    pub fn path(&self) -> &Path {
        self.temporary.path()
    }

    /// Takes over those files of the folder that is replaced, and of folders in it, that this one does not have and `is_kept` wants. It is given
    /// their paths below the folder.
    ///
    /// # Errors
    /// A file can be neither linked nor copied.
    pub fn take_over(&self, is_kept: &dyn Fn(&Path) -> bool) -> Result<(), OutputError> {
        let mut folders = vec![PathBuf::new()];
        while let Some(below) = folders.pop() {
            let refused = |source| OutputError::Write { path: self.place.join(&below), source: without_path(source) };
            for entry in std::fs::read_dir(self.place.join(&below)).map_err(refused)? {
                let entry = entry.map_err(refused)?;
                let path = below.join(entry.file_name());
                let to = self.path().join(&path);
                if is_leftover(&entry.file_name()) {
                    continue;
                } else if entry.file_type().map_err(refused)?.is_dir() {
                    make_folder(&to)?;
                    folders.push(path);
                } else if is_kept(&path) && to.symlink_metadata().is_err() {
                    faults::check(Operation::Write)
                        .and_then(|()| std::fs::hard_link(entry.path(), &to))
                        .or_else(|_| std::fs::copy(entry.path(), &to).map(drop))
                        .map_err(refused)?;
                }
            }
        }
        Ok(())
    }

    /// Moves the folder to its path. A folder that it replaces is gone afterwards; if the system can exchange two names, there is one of both at any
    /// time.
    ///
    /// # Errors
    /// Something exists at that path that is not replaced, or the file system refuses.
    pub fn commit(self) -> Result<(), OutputError> {
        {
            let _pending = pending();
            let (from, to) = (self.temporary.path(), &self.place);
            faults::check(Operation::Write)
                .and_then(|()| if self.replaces { swap(from, to) } else { std::fs::rename(from, to) })
                .map_err(|source| OutputError::Write { path: self.place.clone(), source })?;
        }
        if !self.replaces {
            // The folder has no longer this name, so nothing is left to remove.
            let _ = self.temporary.keep();
        }
        Ok(())
    }
}

/// Puts the folder `new` at the path `place`, and the folder of that path at the other, or nowhere.
fn swap(new: &Path, place: &Path) -> io::Result<()> {
    if exchange(new, place).is_ok() {
        return Ok(());
    }
    // Not by a name that is cleared: if this process ends here, it holds the only folder.
    let aside = new.with_extension("old");
    std::fs::rename(place, &aside)?;
    if let Err(error) = std::fs::rename(new, place) {
        std::fs::rename(&aside, place)?;
        return Err(error);
    }
    // The new folder is in its place; nobody needs this one.
    let _ = std::fs::remove_dir_all(aside);
    Ok(())
}

#[cfg(any(target_os = "linux", target_os = "macos"))]
fn exchange(a: &Path, b: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, a, CWD, b, RenameFlags::EXCHANGE)?)
}

#[cfg(not(any(target_os = "linux", target_os = "macos")))]
fn exchange(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(unix)]
fn is_one_file_system(a: &Metadata, b: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    a.dev() == b.dev()
}

#[cfg(not(unix))]
fn is_one_file_system(_: &Metadata, _: &Metadata) -> bool {
    true
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
    Temporary(BufWriter<FaultPoint<tempfile::NamedTempFile>>, PathBuf, Pending),
    /// Something else than a regular file, which is written directly.
    Device(FaultPoint<std::fs::File>),
}

impl PendingFile {
    /// Begins a file; see `output::write_file`.
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
            return Ok(PendingFile { path: path.to_path_buf(), target: Target::Device(FaultPoint(device)) });
        }
        if existing.as_ref().is_some_and(|metadata| metadata.permissions().readonly()) {
            // A rename would replace the file nevertheless, but whoever protected it did not want that.
            return Err(refused(io::Error::new(io::ErrorKind::PermissionDenied, "the file is read-only")));
        }
        let place = if existing.is_some() { path.canonicalize().map_err(refused)? } else { path.to_path_buf() };
        let folder = files::folder_around(&place);
        leftover::clear(folder);
        let prefix = leftover::prefix();
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(leftover::SUFFIX);
        let permissions = existing.as_ref().map(std::fs::Metadata::permissions);
        if let Some(permissions) = permissions.or_else(ordinary_permissions) {
            // On systems where the mode of new files is subject to the user's mask, this one is as well.
            builder.permissions(permissions);
        }
        let made = Pending::enter(|| builder.tempfile_in(folder), |file| file.path());
        let (temporary, pending) = made.map_err(|error| refused(without_path(error)))?;
        let target = Target::Temporary(BufWriter::new(FaultPoint(temporary)), place, pending);
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
                let FaultPoint(temporary) = buffered.into_inner().map_err(|error| refused(error.into_error()))?;
                let synced = faults::check(Operation::Write).and_then(|()| temporary.as_file().sync_all());
                synced.map_err(refused)?;
                let _pending = pending();
                faults::check(Operation::Write).map_err(refused)?;
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

/// A writer that a test can make fail. It fails as a full disk does: a part has been written.
#[derive(Debug)]
pub(crate) struct FaultPoint<W>(pub(crate) W);

impl<W: Write> Write for FaultPoint<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Err(error) = faults::check(Operation::Write) {
            self.0.write_all(&bytes[..bytes.len() / 2])?;
            return Err(error);
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
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
