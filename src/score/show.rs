//! What the page shows of frames and causes: pictures, and a pixel traced twice.

use ninebit::plan::{Plan, PlanOptions};
use ninebit::shortcut::{self, Shortcuts};
use ninebit_report::{SideBySideLine, side_by_side};
use ninebit_scene::image::Rgba;

use crate::causes::{Cause, Causes};
use crate::folder::Pictures;
use crate::pixels::{COLORS, CauseMap, Sample, difference};
use crate::run::{Run, other, truth};
use crate::subject::Subject;

/// A frame with its pictures.
#[derive(Clone, Debug)]
pub struct Exhibit {
    /// Index of the frame in the run.
    pub frame: usize,
    /// Name of the pictures' files, without what tells them apart.
    pub file: String,
    /// The chip's picture, the other renderer's, the difference, and the causes.
    pub pictures: [(&'static str, Rgba); 4],
    /// For each cause, a pixel that it explains.
    samples: Vec<Option<Sample>>,
}

/// A pixel that shows a cause.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// Suite and name of the frame.
    pub frame: String,
    /// The pixel.
    pub sample: Sample,
    /// The pixel traced by the rules and by the variant, where it can be: the lines that differ.
    pub lines: Vec<SideBySideLine>,
}

/// Most lines of a pair of traces.
const MOST_LINES: usize = 24;

/// Fragments of a trace.
const FRAGMENTS: u64 = 8;

/// Returns up to `most` frames with pictures: of each suite the one with the most wrong pixels, and those in which a cause explains the most.
pub fn exhibits(run: &Run, subjects: &[Subject], pictures: &Pictures, most: usize) -> Vec<Exhibit> {
    let none = Causes::default();
    let causes = run.causes.as_ref().unwrap_or(&none);
    let mut wanted: Vec<usize> = Vec::new();
    for cause in causes.causes.iter().take(COLORS.len()) {
        let yields = |n: &usize| run.frames[*n].explained.as_ref().map_or(0, |e| e.covered(&[cause.variant]).0);
        let best = (0..run.frames.len()).max_by_key(yields).filter(|n| yields(n) > 0);
        wanted.extend(best.filter(|n| !wanted.contains(n)));
    }
    let mut by_suite = std::collections::BTreeMap::<&str, usize>::new();
    for (n, frame) in run.frames.iter().enumerate().filter(|(_, frame)| frame.counts.wrong > 0) {
        let best = by_suite.entry(&frame.suite).or_insert(n);
        if run.frames[*best].counts.wrong < frame.counts.wrong {
            *best = n;
        }
    }
    let mut worst: Vec<usize> = by_suite.into_values().filter(|n| !wanted.contains(n)).collect();
    worst.sort_by_key(|n| std::cmp::Reverse(run.frames[*n].counts.wrong));
    wanted.extend(worst);
    wanted.truncate(most);
    let variants = causes.narrow_first();
    wanted.into_iter().filter_map(|frame| exhibit(frame, run, &subjects[frame], pictures, &variants)).collect()
}

fn exhibit(
    frame: usize,
    run: &Run,
    subject: &Subject,
    pictures: &Pictures,
    variants: &[(usize, Shortcuts)],
) -> Option<Exhibit> {
    let (truth, other) = (truth(subject).ok()?, other(subject, pictures).ok()?);
    let sets: Vec<Shortcuts> = variants.iter().map(|(_, variant)| *variant).collect();
    let map = CauseMap::new(subject, &truth, &other, &sets);
    let color = |n: usize| COLORS[variants[n].0.min(COLORS.len() - 1)];
    let mut samples = vec![None; variants.len()];
    for ((number, _), sample) in variants.iter().zip(&map.samples) {
        samples[*number] = *sample;
    }
    let difference = difference(subject, &truth, &other);
    let scored = &run.frames[frame];
    let file = format!("{}-{}", scored.suite, scored.name).replace(|c: char| !c.is_ascii_alphanumeric(), "_");
    let pictures = [("chip", truth), ("other", other), ("difference", difference), ("causes", map.picture(color))];
    Some(Exhibit { frame, file: format!("{frame:04}-{file}"), pictures, samples })
}

/// Returns for each cause a pixel of the exhibits, traced twice.
pub fn evidence(run: &Run, subjects: &[Subject], exhibits: &[Exhibit]) -> Vec<Option<Evidence>> {
    let Some(causes) = &run.causes else { return Vec::new() };
    let of = |(number, cause): (usize, &Cause)| {
        let size = |sample: &Sample| (0..3).map(|n| sample.truth[n].abs_diff(sample.other[n])).max();
        let found = exhibits.iter().filter_map(|exhibit| Some((exhibit, exhibit.samples[number]?)));
        let (exhibit, sample) = found.max_by_key(|(_, sample)| size(sample))?;
        let subject = &subjects[exhibit.frame];
        let lines = traced(subject, cause.variant, sample.at).unwrap_or_default();
        Some(Evidence { frame: format!("{}/{}", subject.suite, subject.name), sample, lines })
    };
    causes.causes.iter().enumerate().map(of).collect()
}

/// Returns the lines in which the traces of a pixel by the rules and by a variant differ.
fn traced(subject: &Subject, variant: Shortcuts, pixel: (u32, u32)) -> Option<Vec<SideBySideLine>> {
    let scene = subject.drawing.as_ref()?.scene();
    let plan = Plan::compile(&scene, &PlanOptions::default()).ok()?;
    let of = |shortcuts: Shortcuts| {
        shortcut::trace(&plan.clone().with_shortcuts(shortcuts), shortcuts, pixel, FRAGMENTS).ok()
    };
    let (rules, other) = (ninebit::engine::trace_last(&plan, 0, pixel, None, FRAGMENTS).ok()?, of(variant)?);
    let mut lines = side_by_side(&rules, &other);
    lines.retain(SideBySideLine::differs);
    lines.truncate(MOST_LINES);
    Some(lines)
}
