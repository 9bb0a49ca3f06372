//! Scenes drawn again and held against what is expected of them: the golden test of any project that keeps scenes.
//!
//! [`find()`] lists the scenes of files and folders, [`replay()`] draws them, each on one thread and many side by side, and says of each
//! whether it shows what `NAME.expect.ron` beside it states. What is said of a scene depends on nothing but its files and the [`Options`]: not
//! on the other scenes, their order or the threads. [`report`] writes it all down.

mod bless;
mod cause;
mod find;
mod outcome;
mod panels;
pub mod report;
mod scene;

use std::path::PathBuf;

use rayon::prelude::*;

use crate::engine::RenderOptions;
use crate::state::{Policies, Profile};
use crate::threads::on_threads;

pub use cause::Cause;
pub use find::{Entry, EntryKind, Filter, FilterError, FindError, find, part};
pub use outcome::{Difference, Known, Origin, Outcome, Pixel, Problem, Replayed, Summary, Traces};

/// How scenes are replayed.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// How each scene is drawn; `threads` counts scenes that are drawn side by side, 0 as many as there are cores.
    pub render: RenderOptions,
    /// Answers to what no capture decides.
    pub policies: Policies,
    /// Only scenes of this chip; others are skipped.
    pub profile: Option<Profile>,
    /// Write expectations that are missing or not met, from what is drawn.
    pub bless: bool,
    /// A folder of pictures of an earlier run, as [`pictures`](Self::pictures) writes them: where a digest differs, they show where.
    pub expected: Option<PathBuf>,
    /// A folder that takes the picture of every scene.
    pub pictures: Option<PathBuf>,
    /// A folder that takes what is known of every difference.
    pub artifacts: Option<PathBuf>,
}

/// Replays scenes; what became of each, in the order of `entries`. `progress` is told how many are done, from any thread.
pub fn replay(entries: &[Entry], options: &Options, progress: &(dyn Fn(usize) + Sync)) -> Vec<Replayed> {
    let done = std::sync::atomic::AtomicUsize::new(0);
    let one = |entry: &Entry| {
        let replayed = scene::replay(entry, options);
        progress(done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1);
        replayed
    };
    on_threads(options.render.threads, || entries.par_iter().map(one).collect())
}
