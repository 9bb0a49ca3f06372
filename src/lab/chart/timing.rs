//! How long drawing takes here, in processor time: what other programs take meanwhile does not count.

use std::time::Duration;

use cpu_time::ProcessTime;
use serde::{Deserialize, Serialize};

use ninebit::engine::{RenderOptions, Renderer};
use ninebit::plan::Plan;

/// The middle of some times and where the middle half of them lies, in nanoseconds per final pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// Half of the times are below.
    pub median: f64,
    /// A quarter of the times are below.
    pub lower: f64,
    /// A quarter are above.
    pub upper: f64,
}

impl Spread {
    /// The median and the quartiles of some times; zeros if there are none.
    pub fn from_times(times: &mut [f64]) -> Spread {
        times.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let index = ((times.len().saturating_sub(1)) as f64 * share).round() as usize;
            times.get(index).copied().unwrap_or(0.0)
        };
        Spread { median: at(0.5), lower: at(0.25), upper: at(0.75) }
    }
}

/// How long to go on measuring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// The least number of times that a frame is drawn.
    pub times: usize,
    /// And so long, a hundred times as often at most.
    pub duration: Duration,
}

impl Effort {
    /// What figures that are kept are measured with.
    pub const FULL: Effort = Effort { times: 9, duration: Duration::from_millis(100) };
    /// The least that shows whether everything works.
    pub const QUICK: Effort = Effort { times: 1, duration: Duration::ZERO };

    /// Times `work` again and again, once before that unmeasured; nanoseconds for each of `pixels`. Work runs on one thread, whichever:
    /// the time is that of the whole process.
    pub fn measure(&self, pixels: u64, mut work: impl FnMut()) -> Spread {
        work();
        let (begin, mut times) = (ProcessTime::now(), Vec::new());
        while times.len() < self.times || (begin.elapsed() < self.duration && times.len() < 100 * self.times) {
            let start = ProcessTime::now();
            work();
            times.push(start.elapsed().as_secs_f64() * 1e9 / pixels.max(1) as f64);
        }
        Spread::from_times(&mut times)
    }
}

/// Times frames of a plan on one thread; textures are decoded and draws compiled before.
pub fn frames(plan: &Plan, options: &RenderOptions, pixels: u64, effort: &Effort) -> Spread {
    let renderer = Renderer::new(plan, &RenderOptions { threads: 1, ..*options });
    let (mut frames, _) = renderer.render();
    // Fragments of a second frame would fail the depth test of a first: then the clear belongs to the frame.
    let clears = plan.draws.iter().any(|draw| draw.depth_test.is_some());
    effort.measure(pixels, || {
        if clears {
            std::hint::black_box(renderer.render());
        } else {
            renderer.redraw(&mut frames);
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_is_the_middle_half() {
        let mut times: Vec<f64> = (0..101).rev().map(f64::from).collect();
        assert_eq!(Spread::from_times(&mut times), Spread { median: 50.0, lower: 25.0, upper: 75.0 });
        assert_eq!(Spread::from_times(&mut []), Spread::default());
    }

    #[test]
    fn work_is_done_as_often_as_asked_for_and_once_before() {
        let mut count = 0;
        Effort::QUICK.measure(1, || count += 1);
        assert_eq!(count, 2);
    }
}
