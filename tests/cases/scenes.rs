//! Compares every scene under `vectors/scenes` with its expectation.
//!
//! `ninebit replay --bless vectors/scenes` rewrites the expectations except for those that come from a capture. Look at the pictures and at
//! the difference before you commit.

use std::path::{Path, PathBuf};
use std::slice;

use libtest_mimic::{Failed, Trial};
use ninebit::engine::RenderOptions;
use ninebit::expectation::Expectation;
use ninebit::replay::{Entry, Options, Outcome, find, replay, report};

const FOLDER: &str = "vectors/scenes";

/// Returns one test for each scene. A test is marked as ignored if images that its scene needs are missing.
pub fn trials() -> Vec<Trial> {
    let entries = find(&[PathBuf::from(FOLDER)]).unwrap_or_else(|error| panic!("{error}"));
    assert!(entries.len() > 150, "{} scenes", entries.len());
    entries.into_iter().map(trial).collect()
}

fn trial(entry: Entry) -> Trial {
    let complete = complete(&entry.path);
    let name = entry.name.strip_prefix(FOLDER).unwrap_or(&entry.name).trim_start_matches('/');
    let trial = Trial::test(format!("scenes::{}", name.replace('/', "::")), move || shows_what_is_expected(&entry));
    if complete { trial } else { trial.with_ignored_flag(true).with_kind("its images are not here") }
}

/// Returns whether all images that a scene needs are there. Errors in the expectation itself are left for the test to report.
fn complete(scene: &Path) -> bool {
    let text = std::fs::read_to_string(scene.with_extension("expect.ron")).unwrap_or_default();
    let folder = scene.parent().unwrap_or(Path::new(""));
    Expectation::parse(&text)
        .is_ok_and(|expectation| expectation.missing(folder).is_ok_and(|missing| missing.is_empty()))
}

fn shows_what_is_expected(entry: &Entry) -> Result<(), Failed> {
    // The tests already run in parallel, so each takes one thread.
    let options = Options { render: RenderOptions { threads: 1, ..RenderOptions::default() }, ..Options::default() };
    let replayed = replay(slice::from_ref(entry), &options, &|_| {});
    match (replayed[0].exit_code(), &replayed[0].outcome) {
        (0, Outcome::Match) => Ok(()),
        _ => Err(report::text(&replayed).into()),
    }
}
