//! Grouping of techniques by the light that they approximate, and the questions that charts answer.

use super::pareto::pareto_front;
use super::techniques::Technique;

/// A question: a light whose techniques are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Question {
    /// Name of its files, and of its truth in the data.
    pub name: &'static str,
    /// Title above its charts.
    pub title: &'static str,
    /// Family and technique (with its parameter) of a scene of this light. Every scene with an equal truth is a technique for it.
    like: (&'static str, &'static str),
}

/// The questions, in the order of the page.
pub(super) const QUESTIONS: [Question; 6] = [
    question("diffuse", "Diffuse light on bumps", PER_PIXEL, "tangent space diffuse"),
    question("highlight", "A highlight on bumps, exponent 8", PER_PIXEL, "specular 8"),
    question("hemisphere", "Light of sky and ground on bumps", PER_PIXEL, "hemisphere exact"),
    question("signed-arithmetic", "A dot product of signed vectors", "orthogonal-illumination-mapping", "height 12"),
    question("normalisation", "A highlight on a coarse ball: vectors brought to unit length", BALL, "smooth plain"),
    question("normalisation-bumps", "The same ball with bumps", BALL, "bumps plain"),
];
const PER_PIXEL: &str = "per-pixel-lighting";
const BALL: &str = "normalisation";

const fn question(name: &'static str, title: &'static str, family: &'static str, technique: &'static str) -> Question {
    Question { name, title, like: (family, technique) }
}

/// Maximum number of techniques in a chart; the most accurate ones are kept.
pub(super) const MAX_SHOWN: usize = 12;

/// A light, and all techniques that approximate it.
#[derive(Clone, Debug)]
pub(super) struct Light<'a> {
    /// Name of its files, and of its truth in the data.
    pub name: String,
    /// Title above its charts.
    pub title: String,
    /// Whether one of [`QUESTIONS`] asks for it.
    pub asked: bool,
    /// The techniques, the most accurate first.
    pub ways: Vec<&'a Technique>,
}

/// Groups techniques by light. Lights of [`QUESTIONS`] come first. `title` returns the title of a family.
pub(super) fn lights<'a>(techniques: &'a [Technique], title: impl Fn(&str) -> String) -> Vec<Light<'a>> {
    let mut left: Vec<&Technique> = techniques.iter().collect();
    let mut all = Vec::new();
    for question in &QUESTIONS {
        let (family, name) = question.like;
        let like = techniques.iter().find(|way| way.entry.family == family && way.entry.name() == name);
        let Some(like) = like else { continue };
        let (ways, others) = left.into_iter().partition(|way| way.truth == like.truth);
        left = others;
        all.push(Light { name: question.name.to_owned(), title: question.title.to_owned(), asked: true, ways });
    }
    for way in left {
        let same = |light: &&mut Light<'_>| {
            !light.asked
                && light.ways.iter().all(|other| other.truth == way.truth && other.entry.family == way.entry.family)
        };
        if let Some(light) = all.iter_mut().find(same) {
            light.ways.push(way);
            continue;
        }
        let family = &way.entry.family;
        let before =
            all.iter().filter(|light| !light.asked && light.ways.iter().all(|other| other.entry.family == *family));
        let number = before.count() + 1;
        let (name, title) = (format!("{family}-{number}"), format!("{}, {number}", title(family)));
        all.push(Light { name, title, asked: false, ways: vec![way] });
    }
    for light in &mut all {
        light.ways.sort_by(|a, b| a.rms().total_cmp(&b.rms()));
    }
    all
}

impl<'a> Light<'a> {
    /// Returns the techniques that a chart shows.
    pub(super) fn techniques(&self) -> &[&'a Technique] {
        &self.ways[..self.ways.len().min(MAX_SHOWN)]
    }

    /// Returns the indices of the shown techniques on the Pareto front of error, passes, stages, fetches and blends.
    pub(super) fn front_by_counts(&self) -> Vec<usize> {
        let point = |way: &&Technique| {
            let cost = &way.accuracy.cost.asked;
            [way.rms(), cost.passes as f64, cost.stages, cost.fetches, cost.blends]
        };
        pareto_front(&self.techniques().iter().map(point).collect::<Vec<_>>())
    }

    /// Returns the technique of the given name.
    pub(super) fn way(&self, name: &str) -> Option<&'a Technique> {
        self.ways.iter().copied().find(|way| way.entry.name() == name)
    }
}
