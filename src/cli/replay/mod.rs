//! Draws scenes and compares them with their expectations: golden tests for any project that keeps scenes.
//!
//! [`find()`] lists the scenes of files and folders. [`replay()`] draws them, each on one thread and many in parallel, and compares each with
//! `NAME.expect.ron` beside it. The result for a scene depends only on its files and the [`Options`], not on other scenes, their order or the number
//! of threads. [`report`] prints the results.

mod bless;
mod cause;
mod find;
mod outcome;
mod panels;
pub mod report;
mod scene;

use std::path::PathBuf;

use rayon::prelude::*;

use ninebit::engine::RenderOptions;
use ninebit::limits::Limits;
use ninebit::state::{Policies, Profile};
use ninebit::threads::on_threads;
use ninebit_files::catch_panic::catch_panic;

pub use cause::Cause;
pub use find::{Entry, EntryKind, FindError, find};
pub(crate) use find::{Filter, part};
use outcome::Summary;
pub use outcome::{Comparison, Difference, Origin, Outcome, Pixel, Problem, ProblemKind, SceneReplay, Traces};

/// Options of a replay.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Options for drawing. `threads` is the number of scenes that are drawn in parallel; 0 means one per core.
    pub render: RenderOptions,
    /// Limits of the scenes.
    pub limits: Limits,
    /// Policies for drawing.
    pub policies: Policies,
    /// If set, scenes of other chips are skipped.
    pub profile: Option<Profile>,
    /// Whether to write expectations that are missing or not met, from what is drawn.
    pub bless: bool,
    /// Folder with pictures of an earlier run, as [`pictures`](Self::pictures) writes them. They show where a picture with another digest differs.
    pub expected: Option<PathBuf>,
    /// Folder to which the picture of every scene is written.
    pub pictures: Option<PathBuf>,
    /// Folder to which the details of every difference are written.
    pub artifacts: Option<PathBuf>,
}

/// Replays scenes. Returns their results in the order of `entries`. Calls `progress` with the number of finished scenes, from any thread.
///
/// A panic becomes the result of its scene: [`ProblemKind::Internal`].
pub fn replay(entries: &[Entry], options: &Options, progress: &(dyn Fn(usize) + Sync)) -> Vec<SceneReplay> {
    each(entries, options.render.threads, progress, &|entry| scene::replay(entry, options))
}

/// Runs `work` for each entry. A panic affects only its entry.
fn each(
    entries: &[Entry],
    threads: usize,
    progress: &(dyn Fn(usize) + Sync),
    work: &(dyn Fn(&Entry) -> SceneReplay + Sync),
) -> Vec<SceneReplay> {
    let done = std::sync::atomic::AtomicUsize::new(0);
    let one = |entry: &Entry| {
        let replayed = catch_panic(|| work(entry)).unwrap_or_else(|panic| SceneReplay {
            name: entry.name.clone(),
            path: entry.path.clone(),
            outcome: Outcome::Failed(Problem::internal(&panic)),
            unwritten: Vec::new(),
        });
        progress(done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1);
        replayed
    };
    on_threads(threads, || entries.par_iter().map(one).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_what_became_of_one_scene() {
        let entry =
            |name: &str| Entry { name: name.into(), path: format!("{name}.ron").into(), kind: EntryKind::Scene };
        let entries = ["a", "b", "c", "d"].map(entry);
        let work = |entry: &Entry| {
            assert!(entry.name != "b", "a table of {} rows", 3);
            let Entry { name, path, .. } = entry.clone();
            SceneReplay { name, path, outcome: Outcome::Match, unwritten: Vec::new() }
        };
        let done = std::sync::Mutex::new(Vec::new());
        let progress = |count| done.lock().expect("no panic here").push(count);
        for threads in [1, 3] {
            let replayed = each(&entries, threads, &progress, &work);
            let codes: Vec<u8> = replayed.iter().map(SceneReplay::exit_code).collect();
            assert_eq!(codes, [0, 6, 0, 0]);
            let Outcome::Failed(problem) = &replayed[1].outcome else { panic!("{replayed:?}") };
            assert_eq!((problem.code, problem.kind), ("NB0801", ProblemKind::Internal));
            assert!(
                problem.text.contains("src/cli/replay/mod.rs:") && problem.text.contains("a table of 3 rows"),
                "{problem:?}"
            );
            let text = report::text(&replayed);
            assert!(
                text.contains("failed   b.ron\n    error[NB0801]: internal error: src/cli/replay/mod.rs:"),
                "{text}"
            );
            assert!(text.ends_with("4 scenes: 3 as expected, 1 failed\n"), "{text}");
            for report in [
                report::junit(&replayed),
                report::json(&replayed),
                report::html(&replayed),
                report::annotations(&replayed),
            ] {
                assert!(report.contains("NB0801") && report.contains("a table of 3 rows"), "{report}");
            }
        }
        assert_eq!(done.into_inner().expect("no panic here").len(), 8);
    }
}
