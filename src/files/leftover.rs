//! Temporary files and folders: their names, and how those are cleared that killed processes have left behind.
//!
//! A name says who writes: `.ninebit-MACHINE-PROCESS-RANDOM.part`. Whoever begins to write in a folder clears it of those whose process is
//! gone. Of a process on another machine, which shares the folder, only age tells: nothing takes a day without writing. Readers of folders ignore
//! them all.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use sha2::{Digest, Sha256};

use crate::picture::hexadecimal;
use crate::read;

/// Beginning and end of the names of temporary files.
const PREFIX: &str = ".ninebit-";
pub(crate) const SUFFIX: &str = ".part";

/// Age from which on a temporary file is left over, whoever has written it.
const OLD: Duration = Duration::from_secs(24 * 60 * 60);

/// Number of entries of a folder that are looked at. One with more is no place for outputs.
const ENTRIES: usize = 1 << 16;

/// Number of folders in each other in which something younger is looked for.
const DEPTH: u32 = 3;

/// Eight digits for this machine since it was started, and for the numbers that it gives to processes: containers have their own. Empty where the
/// system does not tell.
static MACHINE: LazyLock<String> = LazyLock::new(|| {
    let boot = read::page(Path::new("/proc/sys/kernel/random/boot_id"));
    let numbers = std::fs::read_link("/proc/self/ns/pid").ok();
    let digest = |(boot, numbers): (String, PathBuf)| {
        Sha256::new().chain_update(boot).chain_update(numbers.as_os_str().as_encoded_bytes()).finalize()
    };
    boot.zip(numbers).map(digest).map_or(String::new(), |digest| hexadecimal(&digest[..4]))
});

/// Returns the beginning of the names of this process's temporary files.
pub(crate) fn prefix() -> String {
    format!("{PREFIX}{}-{}-", *MACHINE, std::process::id())
}

/// Returns whether a file of this name is temporary: some process writes it, or has left it behind. Nobody reads it.
pub fn is_leftover(name: &OsStr) -> bool {
    name.to_str().is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX))
}

/// Removes what killed processes have left in a folder, the first time that this process writes in it. What cannot be removed stays: it is in
/// nobody's way.
pub(crate) fn clear(folder: &Path) {
    static CLEARED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    if !CLEARED.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_path_buf()) {
        return;
    }
    let entries = std::fs::read_dir(folder).into_iter().flatten().take(ENTRIES).flatten();
    for entry in entries.filter(|entry| is_leftover(&entry.file_name())) {
        let Ok(metadata) = entry.metadata() else { continue };
        let name = entry.file_name();
        if is_gone(name.to_str().unwrap_or_default(), &metadata) || is_old(&entry.path(), &metadata, DEPTH) {
            // The user has not asked for it.
            let _ = remove(&entry.path());
        }
    }
}

/// Removes a file, or a folder with all that is in it.
pub(crate) fn remove(path: &Path) -> std::io::Result<()> {
    if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) }
}

/// Returns whether the process that wrote a temporary file has ended. Of other machines' processes this is not known, nor of other users', whom the
/// system may hide.
fn is_gone(name: &str, metadata: &Metadata) -> bool {
    let mut parts = name.trim_start_matches(PREFIX).split('-');
    let (machine, process) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
    let is_number = !process.is_empty() && process.bytes().all(|digit| digit.is_ascii_digit());
    let is_here = !MACHINE.is_empty() && machine == *MACHINE && is_number;
    is_here && is_own(metadata) && !Path::new("/proc").join(process).exists()
}

/// Returns whether a file is this user's.
#[cfg(unix)]
fn is_own(metadata: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    std::fs::metadata("/proc/self").is_ok_and(|own| own.uid() == metadata.uid())
}

#[cfg(not(unix))]
fn is_own(_: &Metadata) -> bool {
    false
}

/// Returns whether nothing in a file or folder is younger than [`OLD`].
fn is_old(path: &Path, metadata: &Metadata, depth: u32) -> bool {
    let age = metadata.modified().ok().and_then(|then| SystemTime::now().duration_since(then).ok());
    if age.is_none_or(|age| age <= OLD) {
        return false;
    }
    if !metadata.is_dir() || depth == 0 {
        return true;
    }
    let mut entries = std::fs::read_dir(path).into_iter().flatten().take(ENTRIES).flatten();
    entries.all(|entry| entry.metadata().is_ok_and(|metadata| is_old(&entry.path(), &metadata, depth - 1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::{File, FileTimes};

    /// Makes a file or, if it has a file in it, a folder. Sets how long ago it was written.
    fn make(folder: &Path, name: &str, inside: Option<Duration>, ago: Duration) {
        let then = |ago| FileTimes::new().set_modified(SystemTime::now() - ago);
        let path = folder.join(name);
        let file = if let Some(inside) = inside {
            std::fs::create_dir(&path).expect("a folder");
            File::create(path.join("file")).and_then(|file| file.set_times(then(inside))).expect("a file");
            File::open(&path).expect("a folder")
        } else {
            File::create(&path).expect("a file")
        };
        file.set_times(then(ago)).expect("times");
    }

    #[cfg(unix)]
    #[test]
    fn age_and_writer_decide() {
        let folder = tempfile::tempdir().expect("a folder");
        let (hour, week) = (Duration::from_secs(3600), Duration::from_secs(7 * 24 * 3600));
        // No process has the number 4194305 of Linux, whose largest is 4194304.
        let gone = format!("{PREFIX}{}-4194305-x{SUFFIX}", *MACHINE);
        for (name, inside, ago) in [
            (gone.as_str(), None, hour),
            (&format!("{}own{SUFFIX}", prefix()), None, hour),
            (".ninebit-00000000-4194305-x.part", None, hour),
            (".ninebit-unknown.part", None, hour),
            (".ninebit-00000000-1-old.part", None, week),
            (".ninebit-unknown-old.part", None, week),
            (".ninebit-old.part", Some(week), week),
            (".ninebit-written.part", Some(hour), week),
            (".ninebit-old.png", None, week),
            ("old.part", None, week),
        ] {
            make(folder.path(), name, inside, ago);
        }
        clear(folder.path());
        let mut left: Vec<String> = std::fs::read_dir(folder.path())
            .expect("a folder")
            .flatten()
            .filter_map(|entry| entry.file_name().into_string().ok())
            .collect();
        left.sort();
        let mut kept = vec![
            format!("{}own{SUFFIX}", prefix()),
            ".ninebit-00000000-4194305-x.part".to_owned(),
            ".ninebit-unknown.part".to_owned(),
            ".ninebit-written.part".to_owned(),
            ".ninebit-old.png".to_owned(),
            "old.part".to_owned(),
        ];
        if MACHINE.is_empty() {
            kept.push(gone);
        }
        kept.sort();
        assert_eq!(left, kept);
    }
}
