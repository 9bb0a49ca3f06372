//! Compares the complete diagnostics of broken scenes with stored texts.
//!
//! `tests/bad/NAME.ron` is refused, or causes a warning, with the text in `NAME.txt`. `BLESS=1` rewrites the texts; read the difference
//! before you keep it.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::repository::{at, seen};
use std::fs;

use ninebit::limits::Limits;
use ninebit_scene::{self as scene, ErrorKind};

#[test]
fn every_broken_scene_says_what_is_wrong() {
    let bless = crate::settings::bless();
    let mut names: Vec<String> = fs::read_dir(at("tests/bad"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter_map(|name| name.strip_suffix(".ron").map(str::to_owned))
        .collect();
    names.sort();
    assert!(names.len() >= 30);
    let mut wrong = Vec::new();
    for name in names {
        let path = format!("tests/bad/{name}.ron");
        let limits = Limits::default();
        let loaded = scene::load(&at(&path), &limits);
        // What draws compares the work as well.
        let said = match loaded.and_then(|loaded| loaded.affordable(limits.shaded_pixels).map(|()| loaded)) {
            Ok(loaded) => format!("accepted\n\n{}", loaded.render_warnings(false)),
            Err(error) => format!("exit code {}\n\n{}", error.exit_code(), error.render(false)),
        };
        let said = seen(&said);
        let pinned = at(format!("tests/bad/{name}.txt"));
        if bless {
            fs::write(&pinned, &said).unwrap();
        } else if fs::read_to_string(&pinned).unwrap_or_default() != said {
            wrong.push(format!("{path} now says:\n{said}"));
        }
    }
    assert!(wrong.is_empty(), "{}\nBLESS=1 accepts what is said now", wrong.join("\n"));
}

#[test]
fn codes_are_listed() {
    let listed = crate::error_codes::rows();
    for entry in fs::read_dir(at("tests/bad")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "txt") {
            let text = fs::read_to_string(&path).unwrap();
            for code in text.split('[').skip(1).filter_map(|rest| rest.split_once(']')).map(|(code, _)| code) {
                if code.starts_with("NB") {
                    assert!(listed.iter().any(|row| row.code == code), "{code} of {} is not listed", path.display());
                }
            }
        }
    }
}

#[test]
fn a_missing_scene_is_missing() {
    let error = scene::load(&at("tests/bad/there-is-none.ron"), &Limits::default()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Missing);
    assert_eq!(
        seen(&error.render(false)),
        "error[NB0111]: there is no such scene file\n--> tests/bad/there-is-none.ron\n = help: check the spelling and \
         the folder; upper and lower case count\n"
    );
}

#[test]
fn a_folder_is_no_scene() {
    let error = scene::load(&at("tests/bad"), &Limits::default()).unwrap_err();
    assert_eq!((error.exit_code(), error.diagnostics[0].code), (3, "NB0112"));
}

#[test]
fn a_scene_of_20_megabytes_is_refused_unread() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.ron");
    fs::write(&path, vec![b' '; 20 << 20]).unwrap();
    let error = scene::load(&path, &Limits::default()).unwrap_err();
    assert_eq!((error.exit_code(), error.diagnostics[0].code), (5, "NB0601"));
    assert!(error.render(false).contains("larger than 8388608 bytes"));
}
