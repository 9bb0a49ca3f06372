//! Timing of draws in processor time, which excludes other programs.

use std::time::Duration;

use cpu_time::ProcessTime;
use serde::{Deserialize, Serialize};

use ninebit::engine::{RenderOptions, Renderer};
use ninebit::plan::Plan;

/// Median and quartiles of some times, in nanoseconds per final pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// Median of the times.
    pub(crate) median: f64,
    /// Lower quartile of the times.
    pub(crate) lower: f64,
    /// Upper quartile of the times.
    pub(crate) upper: f64,
}

impl Spread {
    /// Computes the median and quartiles of some times; all are zero if there are none.
    fn from_times(times: &mut [f64]) -> Spread {
        times.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let index = ((times.len().saturating_sub(1)) as f64 * share).round() as usize;
            times.get(index).copied().unwrap_or(0.0)
        };
        Spread { median: at(0.5), lower: at(0.25), upper: at(0.75) }
    }
}

/// Duration of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Minimum number of times that a frame is drawn.
    times: usize,
    /// Minimum duration; a frame is drawn at most 100 times as often as `times`.
    duration: Duration,
}

impl Effort {
    /// For published figures.
    pub const FULL: Effort = Effort { times: 9, duration: Duration::from_millis(100) };
    /// For tests that everything works.
    pub const QUICK: Effort = Effort { times: 1, duration: Duration::ZERO };

    /// Times `work` repeatedly, after one run that is not measured. Returns nanoseconds for each of `pixels`. `work` has to run on one thread at a
    /// time, because the time is that of the whole process.
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

/// Times frames of a plan on one thread. Textures are decoded and draws compiled beforehand.
pub(crate) fn frames(plan: &Plan, options: &RenderOptions, pixels: u64, effort: &Effort) -> Spread {
    let renderer = Renderer::new(plan, &RenderOptions { threads: 1, ..*options });
    let (mut frames, _) = renderer.render();
    // A second frame would fail the depth test against the first, so the clear has to be part of the frame.
    let clears = plan.draws().iter().any(|draw| draw.depth_test.is_some());
    effort.measure(pixels, || {
        if clears {
            renderer.clear(&mut frames);
        }
        renderer.redraw(&mut frames);
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
