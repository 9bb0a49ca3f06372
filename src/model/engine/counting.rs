//! Counts the work of a render while it is done, and the fragments of a draw without shading them.

use super::{TextureWords, cleared, walk};
use crate::plan::{Plan, PlannedDraw};
use crate::state::Named;
use crate::trace::{Observer, Step, Work};

/// The work of one draw.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawCounts {
    /// Number of covered pixels, counted once for each triangle that covers them.
    pub fragments: u64,
    /// Number of fragments that passed the tests.
    pub stored: u64,
    /// Amount of each kind of work, in the order of `Work::ALL`.
    pub work: [u64; Work::ALL.len()],
}

impl Observer for DrawCounts {
    const ON: bool = false;
    const COUNTS: bool = true;
    fn step(&mut self, _step: Step) {}
    fn count(&mut self, work: Work, amount: u64) {
        self.work[work as usize] += amount;
    }
}

/// Renders a plan on one thread, and returns the counts of each draw.
pub fn count(plan: &Plan) -> Vec<DrawCounts> {
    let mut frames = cleared(plan);
    let mut all = Vec::with_capacity(plan.draws.len());
    for planned in &plan.draws {
        let mut counts = DrawCounts::default();
        let target = &mut frames.surfaces[planned.target];
        let width = target.width as usize;
        let (mut words, mut depth) = (std::mem::take(&mut target.words), std::mem::take(&mut target.depth));
        let texture_words = TextureWords::new(plan, std::slice::from_ref(planned), &frames.surfaces);
        let textures = texture_words.images();
        let mut band = walk::Band { first_row: 0, width, words: &mut words, depth: &mut depth };
        (counts.fragments, counts.stored) = walk::draw(plan, planned, &textures, &mut band, &mut counts);
        let target = &mut frames.surfaces[planned.target];
        (target.words, target.depth) = (words, depth);
        all.push(counts);
    }
    all
}

/// Returns the number of covered pixels of a draw, without shading them.
pub fn fragments(plan: &Plan, planned: &PlannedDraw) -> u64 {
    let mut count = 0;
    walk::covered(plan, planned, (0, i64::from(plan.targets[planned.target].height)), |_, _, _| count += 1);
    count
}
