//! Report as an HTML page that needs no other file. Its content security policy allows its own script and style by their hashes, and nothing else.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::page::{head, source_hash};
use crate::replay::panels::{GAP, opaque};
use crate::replay::{Comparison, Difference, Origin, Outcome, SceneReplay, Summary, Traces};
use ninebit::shown;
use ninebit_report::SideBySideLine;
use ninebit_scene::diff::{CHANNELS, Histogram, ranges};

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("report.js");

/// Returns a page with all details of the scenes that are not as expected, and a list of all scenes. Pictures are embedded.
pub fn html(all: &[SceneReplay]) -> String {
    let summary = Summary::from_replays(all);
    let wrong: Vec<&SceneReplay> = all.iter().filter(|one| one.exit_code() != 0).collect();
    let style = STYLE.to_owned() + &wrong.iter().enumerate().map(|(n, one)| shape(n, one)).collect::<String>();
    let (script, styled) = (source_hash(SCRIPT), source_hash(&style));
    let policy = format!(
        "default-src 'none'; img-src data:; script-src {script}; style-src {styled}; base-uri 'none'; form-action 'none'"
    );
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            (head(&policy, &format!("ninebit replay: {summary}"), &style))
            body {
                header {
                    h1 { "ninebit replay" }
                    p { (summary) }
                }
                main aria-label="Scenes" {
                    @if !wrong.is_empty() {
                        ul.wrong { @for one in &wrong { li { (status(one)) " " a href={ "#" (shown::name(&one.name)) } { (shown::name(&one.name)) } } } }
                    }
                    @for (n, one) in wrong.iter().enumerate() { (scene(n, one)) }
                    h2 { "All scenes" }
                    div.scroll { table {
                        @for one in all {
                            tr {
                                td { (status(one)) }
                                td { code { (shown::path(&one.path)) } }
                                td { @if matches!(one.outcome, Outcome::Skipped(_) | Outcome::Blessed { .. }) { (one.message()) } }
                            }
                        }
                    } }
                }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    page.into_string() + "\n"
}

fn status(one: &SceneReplay) -> Markup {
    html! { span class={ "status " (one.status()) } { (one.status()) } }
}

/// Returns the rules that give a scene's figure the shape of its pictures. Each title is as wide as its panel; a tall picture is narrower than the
/// page, but wide enough for its titles.
fn shape(n: usize, one: &SceneReplay) -> String {
    let Outcome::Differs(difference) = &one.outcome else { return String::new() };
    let Some(known) = &difference.known else { return String::new() };
    let (width, height) = (known.difference.width, known.difference.height);
    let [panel, gap] = [width as usize, GAP].map(|columns| format!("minmax(0, {columns}fr)"));
    let whole = 3 * width as usize + 2 * GAP;
    format!(
        "#figure{n}:not(.live) {{ max-width: max(22rem, calc(45rem * {whole} / {height})); }}\n\
         #figure{n} .titles {{ grid-template-columns: {panel} {gap} {panel} {gap} {panel}; }}\n"
    )
}

fn scene(n: usize, one: &SceneReplay) -> Markup {
    html! {
        section id=(shown::name(&one.name)) {
            h2 { (shown::name(&one.name)) " " (status(one)) }
            @match &one.outcome {
                Outcome::Differs(difference) => (self::difference(n, difference)),
                Outcome::Failed(problem) => pre { (shown::lines(&problem.text)) },
                _ => {}
            }
            @for problem in &one.unwritten { pre { (shown::lines(&problem.text)) } }
        }
    }
}

fn image(png: &[u8], class: &str, text: &str) -> Markup {
    html! { img class=(class) alt=(text) src={ "data:image/png;base64," (STANDARD.encode(png)) }; }
}

fn difference(n: usize, difference: &Difference) -> Markup {
    html! {
        p { (shown::name(&difference.verdict())) }
        @match &difference.known {
            Some(known) => (pictures(n, known)),
            None => {
                p { "Only the digest of the expected picture is known; this was drawn:" }
                figure data-panels="1" { (image(&opaque(&difference.picture), "panels", "drawn")) }
            }
        }
        @for remark in &difference.remarks { p { (shown::name(remark)) } }
        details.quiet {
            summary { "Target " code { (shown::name(&difference.target)) } ", digests" }
            table {
                tr { th { "expected" } td { code { (shown::name(&difference.expected)) } } }
                tr { th { "drawn" } td { code { (difference.drawn) } } }
                @if let Some(Comparison { origin: Origin::File(path), .. }) = &difference.known {
                    tr { th { "expected picture" } td { code { (shown::path(path)) } } }
                }
            }
        }
        @if let Some(known) = &difference.known {
            h3 { "Drawn less expected, in pixels" }
            (histogram(known))
            @if let Some(traces) = &known.traces { (self::traces(known, traces)) }
        }
    }
}

fn pictures(n: usize, known: &Comparison) -> Markup {
    let first = &known.first;
    html! {
        figure id={ "figure" (n) } data-panels="3" data-scale=(known.scale) data-first={ (first.x) "," (first.y) } {
            div.titles {
                span { "expected" } span {} span { "drawn" } span {} span { "difference, times " (known.scale) }
            }
            (image(&known.panels, "panels", "expected, drawn, difference"))
        }
    }
}

fn histogram(known: &Comparison) -> Markup {
    let channels = &known.difference.channels;
    let rows = ranges().into_iter().filter(|(from, to)| channels.iter().any(|h| h.between(*from, *to) > 0));
    let row = |title: &str, value: &dyn Fn(&Histogram) -> u64| {
        html! { tr { th { (title) } @for channel in channels { td.number { (value(channel)) } } } }
    };
    html! {
        table {
            tr { th {} @for channel in CHANNELS { th.number { (channel) } } }
            @for (from, to) in rows {
                (row(&if from == to { format!("{from:+}") } else { format!("{from:+} to {to:+}") }, &|h| h.between(from, to)))
            }
            (row("pixels", &Histogram::different))
            (row("largest", &|h| u64::from(h.largest())))
        }
    }
}

fn traces(known: &Comparison, traces: &Traces) -> Markup {
    let first = &known.first;
    // The common beginning of both traces is folded away; the block in which they diverge is shown completely.
    let parted = traces.lines.iter().position(SideBySideLine::differs).unwrap_or(0);
    let begin = traces.lines.iter().take(parted + 1).rposition(|line| line.heading.is_some()).unwrap_or(0);
    html! {
        details open[!traces.lines.is_empty()] {
            summary { "How the first differing pixel, " (first.x) "," (first.y) ", came to be" }
            @if traces.lines.is_empty() {
                pre { (shown::lines(&traces.text)) }
            } @else {
                @let (before, after) = traces.lines.split_at(begin);
                @if !before.is_empty() {
                    details { summary { (before.len()) " steps before, the same in both" } (table(before)) }
                }
                (table(after))
            }
        }
    }
}

fn table(lines: &[SideBySideLine]) -> Markup {
    html! {
        div.scroll { table.trace {
            tr { th { "what" } th.number { "expected" } th.number { "drawn" } th { "rule" } th { "how" } }
            @for line in lines {
                @if let Some(heading) = &line.heading { tr.heading { td colspan="5" { (shown::name(heading)) } } }
                tr.other[line.differs()] {
                    td { (shown::name(&line.name)) }
                    @for side in [&line.first, &line.second] {
                        td.number { @if let Some((_, integer)) = side { (integer) } }
                    }
                    td { (line.rule) }
                    td { (how(line.first.as_ref(), line.second.as_ref())) }
                }
            }
        } }
    }
}

/// Returns the formula of a value, once if it is the same in both traces.
fn how(first: Option<&(String, String)>, second: Option<&(String, String)>) -> Markup {
    let (first, second) = (first.map(|(how, _)| how), second.map(|(how, _)| how));
    html! {
        @match (first, second) {
            (Some(a), Some(b)) if a != b => { (shown::name(a)) br; (shown::name(b)) }
            (Some(how), _) | (None, Some(how)) => (shown::name(how)),
            (None, None) => {}
        }
    }
}
