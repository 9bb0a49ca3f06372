//! Tests that outputs are written as a whole or not at all.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::ffi::OsStr;
use std::fs;
use std::path::Path;

use ninebit_files::output::{Compression, Destination, encode_png, write_file};

/// Returns the names in a folder, sorted.
fn listing(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn files_are_replaced_as_a_whole() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("frame.png");
    write_file(&place, b"one").unwrap();
    assert_eq!(fs::read(&place).unwrap(), b"one");
    write_file(&place, b"second").unwrap();
    assert_eq!(fs::read(&place).unwrap(), b"second");
    assert_eq!(listing(folder.path()), ["frame.png"]);
}

#[test]
fn folders_and_missing_folders_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let error = write_file(folder.path(), b"x").expect_err("a folder");
    assert_eq!(error.code(), "NB0701");
    let error = write_file(&folder.path().join("none/frame.png"), b"x").expect_err("no such folder");
    assert_eq!((error.code(), error.help()), ("NB0702", "create its folder first"));
    assert!(!error.to_string().contains(".ninebit-"), "{error}");
    let file = folder.path().join("file");
    write_file(&file, b"x").unwrap();
    assert_eq!(write_file(&file.join("frame.png"), b"x").expect_err("a file").code(), "NB0702");
    assert_eq!(listing(folder.path()), ["file"]);
}

#[test]
fn a_dash_is_standard_output() {
    assert_eq!(Destination::from(OsStr::new("-")), Destination::Stdout);
    assert_eq!(Destination::from(OsStr::new("./-")), Destination::File("./-".into()));
}

#[test]
fn pictures_need_their_pixels() {
    assert_eq!(encode_png(2, 2, &[[0; 4]; 3], Compression::Fast).expect_err("three of four").code(), "NB0704");
    assert_eq!(encode_png(0, 0, &[], Compression::Fast).expect_err("none").code(), "NB0704");
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{PermissionsExt, symlink};

    #[test]
    fn outputs_are_ordinary_files() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("frame.png");
        let ordinary = folder.path().join("ordinary");
        write_file(&place, b"one").unwrap();
        fs::write(&ordinary, b"two").unwrap();
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&place), mode(&ordinary));
        fs::set_permissions(&place, fs::Permissions::from_mode(0o640)).unwrap();
        write_file(&place, b"three").unwrap();
        assert_eq!(mode(&place), 0o640);
    }

    #[test]
    fn read_only_files_are_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("frame.png");
        fs::write(&place, b"old").unwrap();
        fs::set_permissions(&place, fs::Permissions::from_mode(0o444)).unwrap();
        let error = write_file(&place, b"new").expect_err("read-only");
        assert!(error.to_string().contains("read-only") && error.code() == "NB0702", "{error}");
        assert_eq!(fs::read(&place).unwrap(), b"old");
    }

    #[test]
    fn links_stay_links() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, b"old").unwrap();
        symlink("file", &link).unwrap();
        write_file(&link, b"new").unwrap();
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
    }

    #[test]
    fn devices_are_written_to() {
        write_file(Path::new("/dev/null"), b"gone").unwrap();
        assert!(!Path::new("/dev/null").metadata().unwrap().is_file());
    }
}

/// Neither a folder that is abandoned nor one that cannot be moved to its place leaves anything behind.
#[test]
fn folders_arrive_whole_or_not_at_all() {
    use ninebit_files::pending::PendingFolder;
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("around/made");
    let begin = || {
        let pending = PendingFolder::create(&place).unwrap();
        write_file(&pending.path().join("file"), b"x").unwrap();
        pending
    };
    drop(begin());
    assert_eq!(listing(&folder.path().join("around")), [""; 0]);
    begin().commit().unwrap();
    assert_eq!(listing(&place), ["file"]);
    assert_eq!(begin().commit().expect_err("something is there").code(), "NB0702");
    assert_eq!(listing(&folder.path().join("around")), ["made"]);
    write_file(&folder.path().join("file"), b"x").unwrap();
    PendingFolder::create(&folder.path().join("file/made")).expect_err("no folder can be made there");
}

/// A folder that takes another one's place has the files that it takes over, and is never absent. Nothing of the other one is left beside it.
#[test]
fn folders_are_replaced_as_a_whole() {
    use ninebit_files::pending::PendingFolder;
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("pack");
    fs::create_dir_all(place.join("below/deeper")).unwrap();
    for name in ["old", "kept", "both", "below/kept", "below/deeper/kept", "below/.ninebit-x.part"] {
        fs::write(place.join(name), b"old").unwrap();
    }
    let begin = || {
        let pending = PendingFolder::replacing(&place).unwrap().expect("it can be renamed");
        write_file(&pending.path().join("both"), b"new").unwrap();
        pending
    };
    drop(begin());
    assert_eq!(fs::read(place.join("both")).unwrap(), b"old");
    let pending = begin();
    pending.take_over(&|path| !path.ends_with("old")).unwrap();
    pending.commit().unwrap();
    assert_eq!(listing(folder.path()), ["pack"]);
    assert_eq!(listing(&place), ["below", "both", "kept"]);
    assert_eq!(fs::read(place.join("both")).unwrap(), b"new");
    assert_eq!(
        (listing(&place.join("below")), listing(&place.join("below/deeper"))),
        (vec!["deeper".into(), "kept".into()], vec!["kept".into()])
    );
    // Where the program works, no other folder can come.
    assert!(PendingFolder::replacing(Path::new(".")).unwrap().is_none());
    assert_eq!(PendingFolder::replacing(&folder.path().join("none")).expect_err("none").code(), "NB0702");
}

#[test]
fn leftovers_are_known_by_their_names() {
    use ninebit_files::leftover::is_leftover;
    assert!(is_leftover(OsStr::new(".ninebit-x.part")) && !is_leftover(OsStr::new("x.part")));
    assert!(!is_leftover(OsStr::new(".ninebit-x.png")) && !is_leftover(OsStr::new("ninebit-x.part")));
}
