//! Tests that depend on the machine: a device that is always full, a small disk, and a folder that the user may not write to.

use libtest_mimic::Trial;

#[cfg(not(unix))]
pub fn trials() -> Vec<Trial> {
    vec![]
}

#[cfg(unix)]
pub use unix::trials;

#[cfg(unix)]
mod unix {
    use super::Trial;
    use ninebit_files::output::write_file;
    use std::fs::{self, Permissions};
    use std::os::unix::fs::PermissionsExt;
    use std::path::Path;
    use std::process::Command;

    /// Returns the tests. Those that cannot run on this machine are marked as ignored.
    pub fn trials() -> Vec<Trial> {
        let test = |name: &str, test: fn(), possible: bool, kind: &str| {
            let trial = Trial::test(format!("machine::{name}"), move || {
                test();
                Ok(())
            });
            if possible { trial } else { trial.with_ignored_flag(true).with_kind(kind) }
        };
        let disk = Disk::mounted("64k").is_some();
        let (refused, full) = (folders_are_refused(), Path::new("/dev/full").exists());
        let (no_disk, superuser) = ("this user cannot mount a disk", "this user may write to every folder");
        vec![
            test("an_unwritable_folder_keeps_its_file", an_unwritable_folder_keeps_its_file, refused, superuser),
            test("a_full_device_is_reported", a_full_device_is_reported, full, "there is no /dev/full"),
            test("a_full_disk_leaves_the_old_file", a_full_disk_leaves_the_old_file, disk, no_disk),
            test("a_full_disk_leaves_no_pack", a_full_disk_leaves_no_pack, disk, no_disk),
        ]
    }

    /// A small disk that is mounted on a temporary folder, and unmounted when this value is dropped.
    struct Disk(tempfile::TempDir);

    impl Disk {
        fn mounted(size: &str) -> Option<Disk> {
            let folder = tempfile::tempdir().unwrap();
            let size = format!("size={size}");
            let mount = Command::new("mount").args(["-t", "tmpfs", "-o", &size, "tmpfs"]).arg(folder.path()).output();
            mount.is_ok_and(|output| output.status.success()).then(|| Disk(folder))
        }

        fn path(&self) -> &Path {
            self.0.path()
        }
    }

    impl Drop for Disk {
        fn drop(&mut self) {
            let _ = Command::new("umount").arg(self.path()).status();
        }
    }

    /// Returns whether this user is bound by the permissions of folders. A superuser is not.
    fn folders_are_refused() -> bool {
        let folder = tempfile::tempdir().unwrap();
        fs::set_permissions(folder.path(), Permissions::from_mode(0o555)).unwrap();
        fs::write(folder.path().join("probe"), b"x").is_err()
    }

    /// Returns the names in a folder, sorted.
    fn listing(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).into_iter().flatten();
        let mut names: Vec<String> = names.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn an_unwritable_folder_keeps_its_file() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("frame.png");
        fs::write(&place, b"old").unwrap();
        fs::set_permissions(folder.path(), Permissions::from_mode(0o555)).unwrap();
        let result = write_file(&place, b"new");
        fs::set_permissions(folder.path(), Permissions::from_mode(0o755)).unwrap();
        assert_eq!(result.expect_err("unwritable").code(), "NB0702");
        assert_eq!(fs::read(&place).unwrap(), b"old");
    }

    fn a_full_device_is_reported() {
        assert!(!Path::new("/dev/full").metadata().unwrap().is_file());
        let error = write_file(Path::new("/dev/full"), b"x").expect_err("full");
        assert_eq!(error.help(), "free some space on that disk");
    }

    fn a_full_disk_leaves_the_old_file() {
        let disk = Disk::mounted("64k").unwrap();
        let place = disk.path().join("frame.png");
        write_file(&place, b"old").unwrap();
        let error = write_file(&place, &vec![7; 1 << 20]).expect_err("full");
        assert_eq!((error.code(), error.help()), ("NB0702", "free some space on that disk"));
        assert_eq!(fs::read(&place).unwrap(), b"old");
        assert_eq!(listing(disk.path()), ["frame.png"]);
    }

    /// If the disk becomes full during an export, the exit status reports it, and there is no manifest that would make an incomplete pack
    /// valid.
    fn a_full_disk_leaves_no_pack() {
        let disk = Disk::mounted("256k").unwrap();
        let run = |arguments: &[&str], place: &Path| {
            Command::new(env!("CARGO_BIN_EXE_ninebit")).args(arguments).arg("-o").arg(place).output().unwrap()
        };
        let (pack, leaves) = (disk.path().join("pack"), disk.path().join("leaves"));
        let exported = run(&["vectors", "export", "--unit", "general-stage", "--unit", "mux"], &pack);
        let left = listing(&pack.join("units"));
        assert!(exported.status.code() == Some(7) && !pack.join("MANIFEST.json").exists(), "{exported:?}");
        assert!(String::from_utf8_lossy(&exported.stderr).contains("free some space"), "{exported:?}");
        assert!(left.iter().all(|name| name == "mux.tsv"), "{left:?}");

        assert!(fs::write(disk.path().join("filler"), vec![1; 1 << 20]).is_err());
        let swept = run(&["vectors", "sweep", "--unit", "mux"], &leaves);
        assert!(swept.status.code() == Some(7) && listing(&leaves).is_empty(), "{swept:?}");
    }
}
