//! What the page shows of frames and causes: pictures, and a pixel traced twice.

use ninebit::plan::{Plan, PlanOptions};
use ninebit::shortcut::{self, Shortcuts};
use ninebit::state::Scene;
use ninebit_report::{SideBySideLine, side_by_side};
use ninebit_scene::image::Rgba;

use rayon::prelude::*;

use crate::causes::{Cause, Causes};
use crate::explain::FrameScore;
use crate::folder::Pictures;
use crate::pixels::{COLORS, CauseMap, Sample, difference};
use crate::run::{Run, other, truth};
use crate::subject::{Drawing, Subject};

/// A frame with its pictures.
#[derive(Clone, Debug)]
pub struct Exhibit {
    /// Index of the frame in the run.
    pub frame: usize,
    /// Name of the pictures' files, without what tells them apart.
    pub file: String,
    /// The chip's picture, the other renderer's, the difference, and the causes.
    pub pictures: [(&'static str, Rgba); 4],
    /// The scene, if it is what the model draws of the frame, with the cause of the most pixels.
    pub scene: Option<(Scene, usize)>,
}

/// A pixel that shows a cause.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// Suite and name of the frame, and its index in the run.
    pub frame: (String, usize),
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
    for (frame, _) in (0..causes.causes.len().min(COLORS.len())).filter_map(|number| run.samples.get(&number)) {
        if !wanted.contains(frame) {
            wanted.push(*frame);
        }
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
    let shown = |frame: usize| exhibit(frame, run, subjects.get(frame)?, pictures, &variants);
    wanted.into_par_iter().filter_map(shown).collect()
}

fn exhibit(
    frame: usize,
    run: &Run,
    subject: &Subject,
    pictures: &Pictures,
    variants: &[(usize, Shortcuts)],
) -> Option<Exhibit> {
    let (truth, other) = (truth(subject).ok()?, other(subject, pictures).ok()?);
    let scored = &run.frames[frame];
    let map = CauseMap::new(subject, (&truth, &other), scored.explanation.as_ref(), variants);
    let color = |number: usize| COLORS[number.min(COLORS.len() - 1)];
    let difference = difference(subject, &truth, &other);
    let file = format!("{}-{}", scored.suite, scored.name).replace(|c: char| !c.is_ascii_alphanumeric(), "_");
    let pictures = [("chip", truth), ("other", other), ("difference", difference), ("causes", map.picture(color))];
    Some(Exhibit { frame, file: format!("{frame:04}-{file}"), pictures, scene: scene(subject, scored) })
}

/// Returns the scene of a frame with the cause of the most of its pixels.
fn scene(subject: &Subject, frame: &FrameScore) -> Option<(Scene, usize)> {
    let (drawing, best) = (subject.drawing.as_ref()?, frame.attributed.iter().max_by_key(|(_, pixels)| *pixels)?.0);
    let scene = drawing.scene()?;
    let alone = scene.renderer()?.draw(Shortcuts::NONE, None)?;
    // A frame that shows depths is no picture of its scene.
    (drawing.renderer()?.draw(Shortcuts::NONE, None)? == alone).then_some((scene, best))
}

/// Returns for each cause a pixel that shows it, traced twice.
pub fn evidence(run: &Run, subjects: &[Subject]) -> Vec<Option<Evidence>> {
    let Some(causes) = &run.causes else { return Vec::new() };
    let of = |(number, cause): (usize, &Cause)| {
        let (frame, sample) = run.samples.get(&number)?;
        let subject = &subjects[*frame];
        let lines = traced(subject, cause.variant, sample.at).unwrap_or_default();
        let frame = (format!("{}/{}", subject.suite, subject.name), *frame);
        Some(Evidence { frame, sample: *sample, lines })
    };
    causes.causes.par_iter().enumerate().map(of).collect()
}

/// Returns the lines in which the traces of a pixel by the rules and by a variant differ.
fn traced(subject: &Subject, variant: Shortcuts, pixel: (u32, u32)) -> Option<Vec<SideBySideLine>> {
    let scene = subject.drawing.as_ref()?.scene()?;
    let plan = Plan::compile(&scene, &PlanOptions::default()).ok()?;
    let rules = ninebit::engine::trace_last(&plan, 0, pixel, None, FRAGMENTS).ok()?;
    let other = shortcut::trace(&plan, variant, 0, pixel, FRAGMENTS).ok()?;
    let mut lines = side_by_side(&rules, &other);
    lines.retain(SideBySideLine::differs);
    lines.truncate(MOST_LINES);
    Some(lines)
}
