//! The page of a report.

use std::collections::BTreeSet;

use base64::Engine as _;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use maud::{DOCTYPE, Markup, html};
use ninebit::shortcut::Shortcuts;
use ninebit::shown;
use ninebit_score::causes::{Cause, Causes};
use ninebit_score::{COLORS, Evidence, Exhibit, Run, Total};

use super::{chart, first_rule, grade, percent, thousands};
use crate::page::{head, source_hash};

const STYLE: &str = include_str!("style.css");

/// Most frames with unexplained pixels that are listed.
const MOST_LISTED: usize = 100;

/// What a page shows.
pub(super) struct Report<'a> {
    /// The title.
    pub(super) title: &'a str,
    /// What the pictures are compared with, for a sentence.
    pub(super) against: &'a str,
    /// All runs. The last is shown in full.
    pub(super) runs: &'a [Run],
    pub(super) exhibits: &'a [Exhibit],
    /// The frames that have a page of the inspector.
    pub(super) inspected: &'a [usize],
    pub(super) evidence: &'a [Option<Evidence>],
    /// The command that made the report, without suites.
    pub(super) command: &'a str,
}

impl Report<'_> {
    /// Returns the address of the inspector's page of a frame, at a pixel as a variant draws it, if there is one.
    fn inspector(&self, frame: usize, shown: Option<((u32, u32), Shortcuts)>) -> Option<String> {
        let exhibit = self.exhibits.iter().find(|exhibit| exhibit.frame == frame)?;
        let state = |((x, y), variant): ((u32, u32), Shortcuts)| {
            URL_SAFE_NO_PAD.encode(format!("{{\"p\":[{x},{y}],\"s\":\"{}\"}}", variant.names()))
        };
        let state = shown.map(state);
        let hash = state.map_or_else(String::new, |state| format!("#{state}"));
        self.inspected.contains(&frame).then(|| format!("scenes/{}.html{hash}", exhibit.file))
    }
}

pub(super) fn page(report: &Report<'_>) -> String {
    let policy = format!(
        "default-src 'none'; img-src 'self' file:; style-src {}; base-uri 'none'; form-action 'none'",
        source_hash(STYLE)
    );
    let none = Causes::default();
    let page = report.runs.last().map(|run| {
        let causes = run.causes.as_ref().unwrap_or(&none);
        html! {
            (DOCTYPE)
            html lang="en" {
                (head(&policy, report.title, STYLE))
                body {
                    header {
                        h1 { (report.title) }
                        p { "Results of " (shown::name(&run.name)) ", compared with " (report.against) "." }
                        (tiles(run, causes))
                    }
                    main {
                        @if report.runs.len() > 1 { h2 { "History" } (chart::history(report.runs)) (news(report.runs)) }
                        @if !causes.causes.is_empty() { (table_of_causes(causes)) (cases(report, causes)) }
                        (table_of_suites(report.runs))
                        (figures(report, run))
                        (rest(run))
                    }
                }
            }
        }
        .into_string()
    });
    page.unwrap_or_default() + "\n"
}

fn tiles(run: &Run, causes: &Causes) -> Markup {
    let total = run.total();
    let one = |value: String, label: &str| html! { li { strong { (value) } (label) } };
    html! {
        ul.tiles {
            (one(format!("{} of {}", thousands(total.exact), thousands(total.frames)), "frames exact"))
            (one(thousands(total.off_by_one), "more differ by one step at most"))
            (one(percent(total.pixels.wrong, total.pixels.compared), "of all pixels wrong"))
            @if causes.wrong > 0 {
                (one(percent(causes.explained(), causes.wrong), "of the wrong pixels of drawn frames explained"))
            }
            @if total.missing > 0 { (one(thousands(total.missing), "frames without a picture")) }
            @if total.unreadable > 0 { (one(thousands(total.unreadable), "pictures of another size, or not readable")) }
            @if !run.foreign.is_empty() { (one(thousands(run.foreign.len() as u64), "without a frame of the chip")) }
        }
    }
}

fn color(number: usize) -> String {
    let [r, g, b] = COLORS[number.min(COLORS.len() - 1)];
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn swatch(number: usize) -> Markup {
    html! { svg.swatch viewBox="0 0 12 12" width="12" height="12" aria-hidden="true" { rect width="12" height="12" rx="2" fill=(color(number)) {} } }
}

/// Returns what the shortcuts of a variant do, as a sentence's end.
fn does(variant: Shortcuts) -> String {
    variant.iter().map(|shortcut| shortcut.reading().does).collect::<Vec<_>>().join("; and ")
}

fn table_of_causes(causes: &Causes) -> Markup {
    let most = causes.causes.iter().map(|cause| cause.pixels).max().unwrap_or(1);
    let shown = causes.causes.len().min(COLORS.len());
    html! {
        h2 { "Causes" }
        p.quiet {
            "A pixel is explained where the model yields the chip's bytes by its rules and the other renderer's with a shortcut. \
             Each is counted once, under the fewest shortcuts. \"By chance\" is the number that a shortcut would yield if the errors were dealt out at random."
        }
        (rows_of_causes(&causes.causes[..shown], 0, most))
        @if causes.causes.len() > shown {
            details { summary { (causes.causes.len() - shown) " more causes" } (rows_of_causes(&causes.causes[shown..], shown, most)) }
        }
    }
}

/// Returns the main rule of each shortcut of a variant, once.
fn main_rules(variant: Shortcuts) -> Vec<&'static str> {
    let mut rules: Vec<&str> = variant.iter().map(|shortcut| shortcut.reading().rules[0]).collect();
    rules.dedup();
    rules
}

/// Returns causes as rows of a table. The first has a number.
fn rows_of_causes(causes: &[Cause], first: usize, most: u64) -> Markup {
    html! {
        div.scroll { table {
            tr { th { "the renderer ..." } th.n { "pixels" } th {} th.n { "by chance" } th { "rule" } th { "grade" } }
            @for (n, cause) in causes.iter().enumerate().map(|(n, cause)| (first + n, cause)) {
                @let id = first_rule(cause.variant);
                tr {
                    td.wide { (swatch(n)) a href={ "#cause" (n) } { (does(cause.variant)) } }
                    td.n { (thousands(cause.pixels)) }
                    td { (chart::bar(cause.pixels, most, "cause")) }
                    td.n { (thousands(cause.chance.expected as u64)) }
                    td { @for rule in main_rules(cause.variant) { span.rule { (rule) } " " } }
                    td { (grade(id)) }
                }
            }
        } }
    }
}

fn cases(report: &Report<'_>, causes: &Causes) -> Markup {
    html! {
        h2 { "Cause by cause" }
        @let (first, rest) = causes.causes.split_at(causes.causes.len().min(COLORS.len()));
        @for (n, cause) in first.iter().enumerate() { (folded(report, n, cause)) }
        @if !rest.is_empty() {
            details {
                summary { (rest.len()) " more causes" }
                @for (n, cause) in rest.iter().enumerate() { (folded(report, first.len() + n, cause)) }
            }
        }
    }
}

fn folded(report: &Report<'_>, n: usize, cause: &Cause) -> Markup {
    html! {
        details id={ "cause" (n) } open[n == 0] {
            summary { (swatch(n)) code { (cause.variant.names()) } ": " (thousands(cause.pixels)) " pixels" }
            (case(report, cause, report.evidence.get(n).and_then(Option::as_ref)))
        }
    }
}

fn case(report: &Report<'_>, cause: &Cause, evidence: Option<&Evidence>) -> Markup {
    let all: BTreeSet<&str> = cause.variant.iter().flat_map(|shortcut| shortcut.reading().rules).copied().collect();
    let rules: Vec<&str> = all.into_iter().collect();
    html! {
        @for id in &rules {
            @if let Some(rule) = super::rule(id) {
                p { strong { (id) " " (rule.title) } ", " (rule.grades().first().copied().unwrap_or_default()) }
                pre { (rule.field("Formula")) }
            }
        }
        @if let Some(Evidence { frame: (frame, index), sample, lines }) = evidence {
            @let suite = frame.rsplit_once('/').map_or("", |(suite, _)| suite);
            p {
                "Pixel " (sample.at.0) ", " (sample.at.1) " of " code { (shown::name(frame)) } ": the chip shows "
                (pixel(sample.truth)) ", the renderer " (pixel(sample.other)) "."
                @if let Some(place) = report.inspector(*index, Some((sample.at, cause.variant))) { " " a href=(place) { "Open in the inspector" } }
            }
            @if !lines.is_empty() {
                div.scroll { table {
                    tr { th { "step" } th { "rule" } th.n { "chip" } th.n { "with the shortcut" } th { "how" } }
                    @for line in lines {
                        @let part = |side: &Option<(String, String)>| side.clone().unwrap_or_default();
                        @let (first, second) = (part(&line.first), part(&line.second));
                        tr {
                            td { code { (line.name) } } td.rule { (line.rule) } td.n { (first.1) } td.n { (second.1) }
                            td { code { (if first.0 == second.0 { first.0 } else { format!("{} | {}", first.0, second.0) }) } }
                        }
                    }
                } }
            }
            h3 { "For a bug report" }
            p {
                "The renderer " (does(cause.variant)) ". The chip does not (" (rules.join(", ")) "): pixel " (sample.at.0) ", " (sample.at.1) " of "
                (shown::name(frame)) " is " (pixel(sample.truth)) " on it, and " (pixel(sample.other)) " here. "
                (thousands(cause.pixels)) " pixels of these programs differ for it. The rules:"
            }
            pre { @for id in &rules { "ninebit rule " (id) "\n" } (report.command) " --suite " (suite) }
        } @else {
            h3 { "For a bug report" }
            p { "The renderer " (does(cause.variant)) ". The chip does not: " (thousands(cause.pixels)) " results differ for it. The rules:" }
            pre { @for id in &rules { "ninebit rule " (id) "\n" } (report.command) }
        }
        @let rows: Vec<&str> = rules.iter().filter_map(|id| super::rule(id)?.fields("Command").next()).collect();
        @if !rows.is_empty() {
            h3 { "For a unit test" }
            pre { @for row in rows { (row.trim_matches('`')) "\n" } }
        }
    }
}

fn pixel([r, g, b, _]: [u8; 4]) -> String {
    format!("({r}, {g}, {b})")
}

fn table_of_suites(runs: &[Run]) -> Markup {
    let (Some(run), before) = (runs.last(), runs.len().checked_sub(2).map(|n| runs[n].suites())) else {
        return html! {};
    };
    let has_causes = run.causes.is_some();
    html! {
        h2 { "Suites" }
        div.scroll { table {
            tr {
                th { "suite" } th.n { "frames" } th.n { "exact" } th.n { "by one" } th.n { "wrong pixels" } th.n { "of all" }
                @if has_causes { th.n { "explained" } }
                @if before.is_some() { th.n { "wrong pixels before" } }
            }
            @for (name, total) in run.suites() {
                @let before = before.as_ref().map(|before| before.get(name).copied().unwrap_or_default());
                tr.differs[before.is_some_and(|before| jumps(&before, &total))] {
                    td { (shown::name(name)) }
                    td.n { (total.frames) } td.n { (total.exact) } td.n { (total.off_by_one) }
                    td.n { (thousands(total.pixels.wrong)) } td.n { (percent(total.pixels.wrong, total.pixels.compared)) }
                    @if has_causes {
                        @let (explained, all) = run.explained_of(name);
                        td.n { @if all > 0 { (percent(explained, all)) } }
                    }
                    @if let Some(before) = before { td.n { (thousands(before.pixels.wrong)) @if jumps(&before, &total) { " (new)" } } }
                }
            }
        } }
    }
}

/// Returns whether so many more pixels of a suite are wrong than before that it is news: twice as many, and a hundredth of all.
fn jumps(before: &Total, now: &Total) -> bool {
    before.frames > 0 && now.pixels.wrong > 2 * before.pixels.wrong && now.pixels.wrong > now.pixels.compared / 100
}

/// Returns the suites that have become much worse since the run before the last.
fn news(runs: &[Run]) -> Markup {
    let [.., before, now] = runs else { return html! {} };
    let (before, now) = (before.suites(), now.suites());
    let both = now.iter().filter_map(|(suite, now)| Some((suite, before.get(suite)?, now)));
    let worse: Vec<_> = both.filter(|(_, before, now)| jumps(before, now)).collect();
    html! {
        @if !worse.is_empty() {
            p { "New in the last:" }
            ul {
                @for (suite, before, now) in worse {
                    li {
                        (shown::name(suite)) ": " (thousands(now.pixels.wrong)) " wrong pixels, "
                        (thousands(before.pixels.wrong)) " before; " (now.exact) " of " (now.frames) " frames exact, "
                        (before.exact) " of " (before.frames) " before"
                    }
                }
            }
        }
    }
}

fn figures(report: &Report<'_>, run: &Run) -> Markup {
    html! {
        @if !report.exhibits.is_empty() {
            h2 { "Frames" }
            p.quiet { "Differences are eight times as bright, and never faint. In the last picture each colour is a cause, white is unexplained." }
            @for exhibit in report.exhibits {
                @let frame = &run.frames[exhibit.frame];
                @let name = format!("{}/{}", frame.suite, frame.name);
                figure {
                    figcaption {
                        strong { (shown::name(&name)) } ": " (thousands(frame.counts.wrong)) " pixels wrong"
                        @if let Some(place) = report.inspector(exhibit.frame, None) { ", " a href=(place) { "open in the inspector" } }
                    }
                    div.pictures {
                        @for (kind, _) in &exhibit.pictures {
                            a href={ "pictures/" (exhibit.file) "-" (kind) ".png" } {
                                img src={ "pictures/" (exhibit.file) "-" (kind) ".png" } alt={ (kind) " of " (shown::name(&name)) } loading="lazy" width="640" height="480";
                                span { (kind) }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Returns the list of frames in which the most pixels are unexplained.
fn rest(run: &Run) -> Markup {
    let left = |frame: &ninebit_score::FrameScore| frame.counts.wrong - frame.explained();
    let mut frames: Vec<_> =
        run.frames.iter().map(|frame| (left(frame), frame)).filter(|(left, _)| *left > 0).collect();
    frames.sort_by_key(|(left, _)| std::cmp::Reverse(*left));
    html! {
        @if run.causes.is_some() && !frames.is_empty() {
            details {
                summary { "What is left, by frame: " (frames.len()) " frames" }
                div.scroll { table {
                    tr { th { "frame" } th.n { "unexplained pixels" } th {} }
                    @for (left, frame) in frames.iter().take(MOST_LISTED) {
                        tr {
                            td { (shown::name(&format!("{}/{}", frame.suite, frame.name))) } td.n { (thousands(*left)) }
                            td { @if frame.explanation.is_none() { "the model does not draw it" } }
                        }
                    }
                } }
                @if frames.len() > MOST_LISTED { p { "The document " code { "score.json" } " has all of them." } }
            }
        }
    }
}
