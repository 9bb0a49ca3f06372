//! Charts of the page.
#![allow(clippy::float_arithmetic, reason = "coordinates of a drawing")]

use maud::{Markup, html};

use ninebit_score::Run;

use super::{percent, thousands};

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
    html! {
        ul.history {
            @for run in runs {
                @let total = run.total();
                @let part = |count: u64| format!("{:.2}", 100.0 * count as f64 / total.frames.max(1) as f64);
                li {
                    strong { (run.name) } " "
                    span.quiet {
                        (thousands(total.exact)) " of " (thousands(total.frames)) " exact, " (thousands(total.off_by_one)) " off by one, "
                        (percent(total.pixels.wrong, total.pixels.compared)) " of pixels wrong"
                    }
                    svg viewBox="0 0 100 3" preserveAspectRatio="none" aria-hidden="true" {
                        rect.wrong width="100" height="3" {}
                        rect.one width=(part(total.exact + total.off_by_one)) height="3" {}
                        rect.exact width=(part(total.exact)) height="3" {}
                    }
                }
            }
        }
    }
}
