//! Charts of the page.
#![allow(clippy::float_arithmetic, reason = "coordinates of a drawing")]

use maud::{Markup, html};

use ninebit_score::{Run, Total};

use super::{percent, thousands};

/// Width of a chart.
const WIDTH: f64 = 640.0;

/// Returns a bar as long as a share of the longest.
pub(super) fn bar(value: u64, most: u64, class: &str) -> Markup {
    let width = 160.0 * value as f64 / most.max(1) as f64;
    html! {
        svg.bar viewBox="0 0 160 12" width="160" height="12" aria-hidden="true" {
            rect class=(class) width={ (format!("{width:.1}")) } height="12" rx="2" {}
        }
    }
}

/// Returns the history: a bar for each run, with the shares of exact frames, of those off by one, and of wrong ones.
pub(super) fn history(runs: &[Run]) -> Markup {
    let totals: Vec<Total> = runs.iter().map(Run::total).collect();
    let height = 46 * runs.len();
    html! {
        svg.history viewBox={ "0 0 " (WIDTH) " " (height) } role="img" aria-label="Shares of frames by folder of results" {
            @for (n, (run, total)) in runs.iter().zip(&totals).enumerate() {
                @let (top, all) = (46 * n, total.frames.max(1) as f64);
                @let part = |count: u64| WIDTH * count as f64 / all;
                @let (exact, by_one) = (part(total.exact), part(total.off_by_one));
                text x="0" y=(top + 13) { (run.name) }
                text.value x=(WIDTH) y=(top + 13) text-anchor="end" {
                    (thousands(total.exact)) " of " (thousands(total.frames)) " exact, " (percent(total.pixels.wrong, total.pixels.compared)) " of pixels wrong"
                }
                rect.wrong x="0" y=(top + 19) width=(WIDTH) height="16" rx="2" {}
                rect.one x="0" y=(top + 19) width={ (format!("{:.1}", exact + by_one)) } height="16" rx="2" {}
                rect.exact x="0" y=(top + 19) width={ (format!("{exact:.1}")) } height="16" rx="2" {}
            }
        }
    }
}
