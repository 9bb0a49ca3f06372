//! The choice of causes: the smallest set of shortcuts that explains the most.

use std::collections::BTreeMap;

use ninebit::shortcut::{Shortcut, Shortcuts};

use crate::chance::{Chance, Differences};
use crate::search::{Explanation, OPEN};

/// A variant and what it explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cause {
    /// One shortcut, or two.
    pub variant: Shortcuts,
    /// Pixels that are attributed to it: by [`choose`] an estimate from the samples, in a [`Run`](crate::Run) counted.
    pub pixels: u64,
    /// All pixels that it yields by the samples, and those that it would yield by chance.
    pub chance: Chance,
}

/// The causes of a set of frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Causes {
    /// The causes, most pixels first.
    pub causes: Vec<Cause>,
    /// Wrong pixels of the frames that the model draws.
    pub wrong: u64,
    /// Of these, pixels where the rules do not yield the chip's bytes.
    pub open: u64,
}

impl Causes {
    /// Returns the number of explained pixels.
    pub fn explained(&self) -> u64 {
        self.causes.iter().map(|cause| cause.pixels).sum()
    }

    /// Returns the number of pixels that a cause has to exceed.
    pub(crate) fn least(&self) -> u64 {
        (self.wrong / LEAST_SHARE).max(15)
    }

    /// Returns the variants with their numbers, in the order in which pixels are attributed to them: one shortcut before two, and a whole shader
    /// in floats after its parts.
    pub fn narrow_first(&self) -> Vec<(usize, Shortcuts)> {
        let mut all: Vec<(usize, Shortcuts)> = self.variants().into_iter().enumerate().collect();
        all.sort_by_key(|(number, variant)| (width(*variant), std::cmp::Reverse(self.causes[*number].chance.hits)));
        all
    }

    /// Returns the variants.
    pub fn variants(&self) -> Vec<Shortcuts> {
        self.causes.iter().map(|cause| cause.variant).collect()
    }
}

/// A shortcut has to explain one in so many wrong pixels in addition to the others.
const LEAST_SHARE: u64 = 20_000;

/// Chooses the causes of frames.
pub fn choose<'a>(frames: impl Iterator<Item = &'a Explanation> + Clone) -> Causes {
    let mut actual = Differences::default();
    let mut predicted = BTreeMap::<Shortcuts, (u64, Differences)>::new();
    let mut groups = BTreeMap::<Vec<Shortcuts>, u64>::new();
    let (mut wrong, mut open) = (0, 0);
    for frame in frames {
        actual.merge(&frame.actual);
        for (variant, differences) in frame.variants.iter().zip(&frame.predicted) {
            predicted.entry(*variant).or_default().1.merge(differences);
        }
        for (signature, count) in &frame.signatures {
            wrong += count;
            if signature & OPEN != 0 {
                open += count;
                continue;
            }
            let variants = frame.variants.iter().enumerate().filter(|(n, _)| signature >> n & 1 != 0);
            let mut variants: Vec<Shortcuts> = variants.map(|(_, variant)| *variant).collect();
            variants.sort_unstable();
            for variant in &variants {
                predicted.entry(*variant).or_default().0 += count;
            }
            if !variants.is_empty() {
                *groups.entry(variants).or_default() += count;
            }
        }
    }
    let chances: BTreeMap<Shortcuts, Chance> = predicted
        .into_iter()
        .map(|(variant, (hits, predicted))| (variant, Chance::new(hits, &predicted, &actual)))
        .filter(|(_, chance)| chance.is_exceeded())
        .collect();
    let groups: Vec<(Vec<Shortcuts>, u64)> = groups
        .into_iter()
        .map(|(variants, count)| (variants.into_iter().filter(|v| chances.contains_key(v)).collect::<Vec<_>>(), count))
        .filter(|(variants, _)| !variants.is_empty())
        .collect();
    let none = Causes { causes: Vec::new(), wrong, open };
    let chosen = cover(&groups, &chances, none.least());
    Causes { causes: attribute(&groups, &chances, chosen), ..none }
}

/// Returns the shortcuts of a greedy cover: each step adds the variant that explains the most more pixels for each added shortcut.
fn cover(groups: &[(Vec<Shortcuts>, u64)], chances: &BTreeMap<Shortcuts, Chance>, least: u64) -> Shortcuts {
    let is_within = |variant: Shortcuts, set: Shortcuts| variant.iter().all(|shortcut| set.contains(shortcut));
    let explained = |set: Shortcuts| -> u64 {
        let has = |variants: &[Shortcuts]| variants.iter().any(|variant| is_within(*variant, set));
        groups.iter().filter(|(variants, _)| has(variants)).map(|(_, count)| count).sum()
    };
    let (mut chosen, mut before) = (Shortcuts::NONE, 0);
    loop {
        let mut best = (0, chosen);
        for variant in chances.keys().filter(|variant| !is_within(**variant, chosen)) {
            let set: Shortcuts = chosen.iter().chain(variant.iter()).collect();
            let added = (set.iter().count() - chosen.iter().count()) as u64;
            let gain = (explained(set) - before) / added;
            if gain > best.0 {
                best = (gain, set);
            }
        }
        if best.0 <= least {
            return chosen;
        }
        (chosen, before) = (best.1, explained(best.1));
    }
}

/// Returns how wide a variant is: the number of its shortcuts, and whether one of them is a whole shader.
fn width(variant: Shortcuts) -> (usize, bool) {
    (variant.iter().count(), variant.contains(Shortcut::FloatShader))
}

/// Attributes each pixel to the narrowest variant of the chosen shortcuts that yields it: to a part of a shader in floats before the whole, to
/// one shortcut before two, and among equals to the one that yields the most.
fn attribute(
    groups: &[(Vec<Shortcuts>, u64)],
    chances: &BTreeMap<Shortcuts, Chance>,
    mut chosen: Shortcuts,
) -> Vec<Cause> {
    if chosen.contains(Shortcut::FloatShader) {
        chosen = Shortcut::PARTS_OF_SHADER.iter().fold(chosen, |set, part| set.with(*part));
    }
    let mut pixels = BTreeMap::<Shortcuts, u64>::new();
    for (variants, count) in groups {
        let allowed = variants.iter().filter(|variant| variant.iter().all(|shortcut| chosen.contains(shortcut)));
        if let Some(variant) = allowed.min_by_key(|v| (width(**v), std::cmp::Reverse(chances[*v].hits))) {
            *pixels.entry(*variant).or_default() += count;
        }
    }
    let mut causes: Vec<Cause> =
        pixels.into_iter().map(|(variant, pixels)| Cause { variant, pixels, chance: chances[&variant] }).collect();
    causes.sort_by_key(|cause| std::cmp::Reverse(cause.pixels));
    causes
}
