//! The score of a folder of pictures: all of its frames, in parallel.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

use ninebit::shortcut::Shortcuts;
use ninebit_scene::image::{ImageError, ImageLimits, Rgba, load};
use rayon::prelude::*;

use crate::causes::{Causes, choose};
use crate::explain::{Class, Counts, Explained, FrameScore, score};
use crate::folder::Pictures;
use crate::subject::{Subject, Truth};

/// The score of one folder of pictures.
#[derive(Clone, Debug)]
pub struct Run {
    /// The name of the folder.
    pub name: String,
    /// The scores, in the order of the subjects.
    pub frames: Vec<FrameScore>,
    /// Pictures that no subject has.
    pub foreign: Vec<String>,
    /// The causes; `None` if they were not asked for.
    pub causes: Option<Causes>,
}

/// Sums over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Total {
    /// Frames that have a picture.
    pub frames: u64,
    /// Frames without a difference.
    pub exact: u64,
    /// Frames whose differences are one step.
    pub off_by_one: u64,
    /// Frames that differ by more.
    pub wrong: u64,
    /// Frames without a picture.
    pub missing: u64,
    /// Pictures that could not be read or have another size.
    pub unreadable: u64,
    /// Pixels.
    pub pixels: Counts,
}

impl Total {
    /// Adds a frame.
    pub fn add(&mut self, frame: &FrameScore) {
        let count = match frame.class {
            Class::Exact => &mut self.exact,
            Class::OffByOne => &mut self.off_by_one,
            Class::Wrong => &mut self.wrong,
            Class::Missing => &mut self.missing,
            Class::Unreadable => &mut self.unreadable,
        };
        *count += 1;
        self.frames += u64::from(frame.class != Class::Missing);
        let (all, of) = (&mut self.pixels, frame.counts);
        all.compared += of.compared;
        all.wrong += of.wrong;
        all.by_one += of.by_one;
        all.far += of.far;
    }

    /// Returns the exact frames of a hundred that have a picture.
    #[allow(clippy::float_arithmetic, reason = "a share for people")]
    pub fn percent(&self) -> f64 {
        100.0 * self.exact as f64 / self.frames.max(1) as f64
    }
}

impl Run {
    /// Returns the sums over all frames.
    pub fn total(&self) -> Total {
        let mut total = Total::default();
        self.frames.iter().for_each(|frame| total.add(frame));
        total
    }

    /// Returns the sums of each suite that has a picture.
    pub fn suites(&self) -> BTreeMap<&str, Total> {
        let mut suites = BTreeMap::<&str, Total>::new();
        self.frames.iter().for_each(|frame| suites.entry(&frame.suite).or_default().add(frame));
        suites.retain(|_, total| total.frames > 0);
        suites
    }

    /// Returns the explained pixels of a suite, and all wrong pixels of those of its frames that the model draws.
    pub fn explained_of(&self, suite: &str) -> (u64, u64) {
        let variants = self.causes.as_ref().map(Causes::variants).unwrap_or_default();
        let frames = self.frames.iter().filter(|frame| frame.suite == suite);
        let covered = frames.filter_map(|frame| Some(frame.explained.as_ref()?.covered(&variants)));
        covered.fold((0, 0), |all, one| (all.0 + one.0, all.1 + one.1))
    }
}

impl Explained {
    /// Returns the wrong pixels that one of the variants yields, and all wrong pixels.
    pub fn covered(&self, variants: &[Shortcuts]) -> (u64, u64) {
        let is_among = |n: usize| variants.contains(&self.variants[n]);
        let mask: u64 = (0..self.variants.len()).filter(|n| is_among(*n)).map(|n| 1 << n).sum();
        let all = self.signatures.values().sum();
        (self.signatures.iter().filter(|(of, _)| *of & mask != 0).map(|(_, count)| count).sum(), all)
    }
}

/// Reads or draws the picture that counts as right.
///
/// # Errors
/// The file cannot be read. A scene that cannot be drawn is an empty picture.
pub fn truth(subject: &Subject) -> Result<Rgba, ImageError> {
    match &subject.truth {
        Truth::File(path) => load(path, &ImageLimits::default()),
        Truth::Model(width) => {
            let drawn = subject.drawing.as_ref().and_then(|drawing| drawing.draw(Shortcuts::NONE, None));
            Ok(Rgba::new(*width, drawn.unwrap_or_default()))
        }
    }
}

/// Reads another renderer's picture of a subject.
///
/// # Errors
/// The file cannot be read.
pub fn other(subject: &Subject, pictures: &Pictures) -> Result<Rgba, ImageError> {
    let path = pictures.folder.join(&subject.suite).join(format!("{}.{}", subject.name, "png"));
    load(&path, &ImageLimits::default())
}

/// Scores a folder of pictures. With `explain` causes are looked for. `progress` receives the number of finished frames, from any thread.
///
/// # Errors
/// A picture that counts as right cannot be read.
pub fn run(
    subjects: &[Subject],
    pictures: &Pictures,
    explain: bool,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Run, ImageError> {
    let done = AtomicU64::new(0);
    let one = |subject: &Subject| {
        let key = (subject.suite.clone(), subject.name.clone());
        let scored = if pictures.files.binary_search(&key).is_err() {
            Ok(FrameScore::without(subject, Class::Missing))
        } else {
            match other(subject, pictures) {
                Ok(other) => truth(subject).map(|truth| score(subject, &truth, &other, explain)),
                Err(_) => Ok(FrameScore::without(subject, Class::Unreadable)),
            }
        };
        progress(done.fetch_add(1, Ordering::Relaxed) + 1);
        scored
    };
    let frames: Vec<FrameScore> = subjects.par_iter().map(one).collect::<Result<_, _>>()?;
    let known: std::collections::BTreeSet<(&str, &str)> =
        subjects.iter().map(|subject| (subject.suite.as_str(), subject.name.as_str())).collect();
    let is_foreign = |(suite, name): &&(String, String)| !known.contains(&(suite.as_str(), name.as_str()));
    let foreign = pictures.files.iter().filter(is_foreign).map(|(suite, name)| format!("{suite}/{name}")).collect();
    let causes = explain.then(|| choose(frames.iter().filter_map(|frame| frame.explained.as_ref())));
    Ok(Run { name: pictures.name.clone(), frames, foreign, causes })
}
