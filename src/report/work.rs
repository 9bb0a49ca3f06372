//! The work of drawing a scene, in words.
#![allow(clippy::float_arithmetic, reason = "an estimate of time")]

use ninebit::engine;

/// What the fast engine takes for a pixel on one core, in nanoseconds: two to sixteen, by what a draw asks for.
const NANOSECONDS: f64 = 8.0;

/// The shaded pixels of all draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingWork {
    /// Their number, or an upper bound of it.
    pub pixels: u64,
    /// Whether they were counted.
    pub exact: bool,
    /// About how many seconds they take on one core.
    pub seconds: f64,
}

impl ShadingWork {
    /// Adds the pixels of draws.
    pub fn from_draws(draws: impl IntoIterator<Item = engine::ShadedPixels>) -> ShadingWork {
        let (mut pixels, mut exact) = (0_u64, true);
        for draw in draws {
            pixels = pixels.saturating_add(draw.pixels);
            exact &= draw.exact;
        }
        ShadingWork { pixels, exact, seconds: pixels as f64 * NANOSECONDS / 1e9 }
    }

    /// Returns number and time for people: `307200, less than a second`.
    pub fn text(&self) -> String {
        let units = [("day", 86_400.0), ("hour", 3600.0), ("minute", 60.0), ("second", 1.0)];
        let time = units.into_iter().find(|(_, seconds)| self.seconds >= *seconds).map(|(unit, seconds)| {
            let count = (self.seconds / seconds).round();
            format!("some {count} {unit}{}", if count == 1.0 { "" } else { "s" })
        });
        let (bound, time) = (if self.exact { "" } else { "at most " }, time.unwrap_or("less than a second".to_owned()));
        format!("{bound}{}, {time} on one core", self.pixels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_said_in_words() {
        let text = |pixels, exact| ShadingWork::from_draws([engine::ShadedPixels { pixels, exact }]).text();
        assert_eq!(text(307_200, true), "307200, less than a second on one core");
        assert_eq!(text(150_000_000, true), "150000000, some 1 second on one core");
        assert_eq!(text(100_000_000_000, false), "at most 100000000000, some 13 minutes on one core");
        assert_eq!(text(6_800_000_000_000, false), "at most 6800000000000, some 15 hours on one core");
        let both = [(1, true), (2, false)].map(|(pixels, exact)| engine::ShadedPixels { pixels, exact });
        assert_eq!((ShadingWork::from_draws(both).pixels, ShadingWork::from_draws(both).exact), (3, false));
    }
}
