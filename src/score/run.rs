//! The score of a folder of pictures: all of its frames, in parallel.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicU64, Ordering};

use ninebit::shortcut::Shortcuts;
use ninebit_scene::image::{ImageError, ImageLimits, Rgba, load};
use rayon::prelude::*;

use crate::causes::{Cause, Causes, choose};
use crate::explain::{Class, Counts, FrameScore, score};
use crate::folder::Pictures;
use crate::pixels::{CauseMap, Sample};
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
    /// Of each cause, by its number, the frame that it explains the most of, and a pixel.
    pub samples: BTreeMap<usize, (usize, Sample)>,
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
        let drawn = self.frames.iter().filter(|frame| frame.suite == suite && frame.explanation.is_some());
        drawn.fold((0, 0), |(explained, wrong), frame| (explained + frame.explained(), wrong + frame.counts.wrong))
    }

    /// Returns the causes of a suite's pixels by their numbers, those with the most pixels first.
    pub fn causes_of(&self, suite: &str) -> Vec<(usize, u64)> {
        let mut all = BTreeMap::<usize, u64>::new();
        for (number, pixels) in self.frames.iter().filter(|f| f.suite == suite).flat_map(|f| &f.attributed) {
            *all.entry(*number).or_default() += pixels;
        }
        let mut all: Vec<(usize, u64)> = all.into_iter().collect();
        all.sort_by_key(|(_, pixels)| std::cmp::Reverse(*pixels));
        all
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
            let renderer = subject.drawing.as_ref().and_then(|drawing| drawing.renderer());
            let drawn = renderer.and_then(|renderer| renderer.draw(Shortcuts::NONE, None));
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

/// Scores a folder of pictures. With `explain` causes are looked for. `progress` receives the part that is done, from any thread.
///
/// # Errors
/// A picture that counts as right cannot be read.
pub fn run(
    subjects: &[Subject],
    pictures: &Pictures,
    explain: bool,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<Run, ImageError> {
    let done = AtomicU64::new(0);
    let all = subjects.len() as u64 * if explain { 2 } else { 1 };
    let step = || progress(done.fetch_add(1, Ordering::Relaxed) + 1, all);
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
        step();
        scored
    };
    let mut frames: Vec<FrameScore> = subjects.par_iter().map(one).collect::<Result<_, _>>()?;
    let known: BTreeSet<(&str, &str)> =
        subjects.iter().map(|subject| (subject.suite.as_str(), subject.name.as_str())).collect();
    let is_foreign = |(suite, name): &&(String, String)| !known.contains(&(suite.as_str(), name.as_str()));
    let foreign = pictures.files.iter().filter(is_foreign).map(|(suite, name)| format!("{suite}/{name}")).collect();
    let (mut causes, mut samples) = (None, BTreeMap::new());
    if explain {
        let mut chosen = choose(frames.iter().filter_map(|frame| frame.explanation.as_ref()));
        let order = chosen.narrow_first();
        let attribute = |(subject, frame): (&Subject, &FrameScore)| {
            let map = frame.explanation.as_ref().and_then(|explanation| {
                let (truth, other) = (truth(subject).ok()?, other(subject, pictures).ok()?);
                Some(CauseMap::new(subject, (&truth, &other), Some(explanation), &order))
            });
            step();
            map.map(|map| (map.found, map.open)).unwrap_or_default()
        };
        let maps: Vec<_> = subjects.par_iter().zip(&frames).map(attribute).collect();
        samples = attributed(&mut chosen, &mut frames, maps);
        causes = Some(chosen);
    }
    Ok(Run { name: pictures.name.clone(), frames, foreign, causes, samples })
}

/// The causes of a frame's pixels by their numbers, each with a sample, and the number of pixels beyond the rules.
type Attribution = (BTreeMap<usize, (u64, Sample)>, u64);

/// Counts the pixels of causes and frames, orders causes by them, and drops those that turn out to be too few. Returns of each cause the frame
/// that it explains the most of, and a pixel.
fn attributed(
    causes: &mut Causes,
    frames: &mut [FrameScore],
    maps: Vec<Attribution>,
) -> BTreeMap<usize, (usize, Sample)> {
    causes.open = maps.iter().map(|(_, open)| open).sum();
    causes.wrong = frames.iter().filter(|f| f.explanation.is_some()).map(|f| f.counts.wrong).sum();
    let mut all: Vec<(usize, Cause)> = causes.causes.drain(..).enumerate().collect();
    let found = |number: usize| maps.iter().filter_map(move |(found, _)| found.get(&number)).map(|(pixels, _)| pixels);
    all.iter_mut().for_each(|(number, cause)| cause.pixels = found(*number).sum());
    all.retain(|(_, cause)| cause.pixels > causes.least());
    all.sort_by_key(|(_, cause)| std::cmp::Reverse(cause.pixels));
    let mut samples = BTreeMap::new();
    for (number, (before, cause)) in all.into_iter().enumerate() {
        let mut best = 0;
        for (frame, (pixels, sample)) in maps.iter().enumerate().filter_map(|(n, map)| Some((n, map.0.get(&before)?))) {
            frames[frame].attributed.push((number, *pixels));
            if *pixels > best {
                best = *pixels;
                samples.insert(number, (frame, *sample));
            }
        }
        causes.causes.push(cause);
    }
    samples
}
