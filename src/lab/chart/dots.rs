//! Charts of the cost on the chip: a row per method, with its error on an axis and its counts beside it.

use super::canvas::{Canvas, TextAnchor};
use super::labels::{Rect, text_width};
use super::page::{number, plain};
use super::picture::{Axis, ticks};
use super::questions::Light;
use super::techniques::Technique;

/// The counted quantities. All but the passes are per final pixel.
const COUNTS: [&str; 4] = ["passes", "stages", "fetches", "blends"];
const WIDTH: f64 = 1010.0;
const ROW: f64 = 23.0;
/// Right end of the names, in pixels.
const NAMES: f64 = 318.0;
/// Left and right end of the axis, in pixels.
const AXIS: [f64; 2] = [334.0, 622.0];
/// Left end of the first column of counts, and distance between columns, in pixels.
const COLUMNS: [f64; 2] = [650.0, 88.0];
/// Length of the longest bar, in pixels.
const BAR: f64 = 30.0;
const INK: &str = "#222222";
const PALE: &str = "#767676";
const GRID: &str = "#e4e4e4";
const BEST: &str = "#1f5fa8";
const SPARED: &str = "#b9cde6";

/// Methods under a heading.
struct Group<'a> {
    heading: Option<&'a str>,
    /// Each method, and whether it is on the Pareto front.
    rows: Vec<(&'a Technique, bool)>,
}

/// Returns the chart of one light: all its methods, with their Pareto front marked.
pub(super) fn of_light(light: &Light<'_>) -> Canvas {
    let front = light.front_by_counts();
    let rows = light.techniques().iter().enumerate().map(|(n, way)| (*way, front.contains(&n))).collect();
    let other = "another way is as exact, and costs no more of anything";
    chart(&light.title, "", other, &[Group { heading: None, rows }])
}

/// Returns the chart of several lights: for each its Pareto front and its least accurate method.
pub(super) fn overview(lights: &[&Light<'_>]) -> Canvas {
    let groups: Vec<Group<'_>> = lights
        .iter()
        .map(|light| {
            let front = light.front_by_counts();
            let last = light.techniques().len().saturating_sub(1);
            let kept = |n: &usize| front.contains(n) || *n == last;
            let rows = (0..=last).filter(kept).filter_map(|n| Some((*light.techniques().get(n)?, front.contains(&n))));
            Group { heading: Some(&light.title), rows: rows.collect() }
        })
        .collect();
    let about = "Ways to draw a picture, each with its error, and its cost for every pixel of the picture. ";
    chart("What accuracy costs the chip", about, "the least exact way, for comparison", &groups)
}

/// Draws the legend.
fn legend(canvas: &mut Canvas, y: f64, other: &str) {
    let entries = [(true, "every other way is less exact, or costs more of something"), (false, other)];
    let mut x = 22.0;
    for (best, text) in entries {
        canvas.disc([x, y - 4.0], 4.5, if best { BEST } else { PALE }, best);
        canvas.text([x + 12.0, y], TextAnchor::Start, 11, INK, text);
        x += text_width(text, 11.0) + 34.0;
    }
    let y = y + 18.0;
    let mut x = 17.0;
    for (color, text) in [
        (BEST, "what the chip does"),
        (SPARED, "what the program asks for, but nothing sees (5 → 3: of 5, 3 are left)"),
    ] {
        canvas.rectangle(Rect { x, y: y - 9.0, width: 10.0, height: 10.0 }, color);
        canvas.text([x + 17.0, y], TextAnchor::Start, 11, INK, text);
        x += text_width(text, 11.0) + 39.0;
    }
}

fn chart(title: &str, about: &str, other: &str, groups: &[Group<'_>]) -> Canvas {
    let all = || groups.iter().flat_map(|group| &group.rows).map(|(way, _)| *way);
    let lines: usize = groups.iter().map(|group| group.rows.len() + usize::from(group.heading.is_some())).sum();
    let says = if about.is_empty() { 0.0 } else { 18.0 };
    let top = 100.0 + says;
    let bottom = top + ROW * lines as f64 + 6.0;
    let mut canvas = Canvas::new(WIDTH, bottom + 30.0);
    canvas.text([16.0, 26.0], TextAnchor::Start, 15, INK, title);
    canvas.text([16.0, 46.0], TextAnchor::Start, 11, PALE, about);
    legend(&mut canvas, 48.0 + says, other);
    let axis = Axis::logarithmic("", all().map(Technique::rms));
    let at = |value: f64| AXIS[0] + (AXIS[1] - AXIS[0]) * axis.share(value);
    canvas.text([AXIS[0], top - 10.0], TextAnchor::Start, 11, INK, "rms error, 8-bit steps");
    for tick in ticks(&axis) {
        canvas.line([at(tick), top], [at(tick), bottom], GRID, 1.0);
        canvas.text([at(tick), bottom + 16.0], TextAnchor::Middle, 11, PALE, &plain(tick));
    }
    for (n, name) in COUNTS.iter().enumerate() {
        canvas.text([column(n), top - 10.0], TextAnchor::Start, 11, INK, name);
    }
    let most = all().flat_map(|way| counts(way).map(|[asked, _]| asked)).fold(1.0, f64::max);
    let mut y = top + ROW / 2.0;
    for group in groups {
        if let Some(heading) = group.heading {
            canvas.text([16.0, y + 5.0], TextAnchor::Start, 12, INK, heading);
            canvas.line([16.0, y + ROW / 2.0], [WIDTH - 16.0, y + ROW / 2.0], GRID, 1.0);
            y += ROW;
        }
        for (way, best) in &group.rows {
            row(&mut canvas, way, *best, at(way.rms()), y, most);
            y += ROW;
        }
    }
    canvas
}

fn row(canvas: &mut Canvas, way: &Technique, best: bool, x: f64, y: f64, most: f64) {
    let color = if best { BEST } else { PALE };
    canvas.text([NAMES, y + 4.0], TextAnchor::End, 11, color, &way.title);
    canvas.disc([x, y], 4.5, color, best);
    let rms = number(way.rms());
    let (anchor, beside) = if x > AXIS[1] - 50.0 { (TextAnchor::End, x - 9.0) } else { (TextAnchor::Start, x + 9.0) };
    canvas.text([beside, y + 4.0], anchor, 10, INK, &rms);
    for (n, [asked, pruned]) in counts(way).into_iter().enumerate() {
        let x = column(n);
        let length = |count: f64| BAR * count / most;
        let bar = |count| Rect { x, y: y - 5.0, width: length(count), height: 10.0 };
        canvas.rectangle(bar(asked), SPARED);
        canvas.rectangle(bar(pruned), color);
        let text = if number(asked) == number(pruned) {
            number(asked)
        } else {
            format!("{} → {}", number(asked), number(pruned))
        };
        let color = if asked == 0.0 { PALE } else { INK };
        canvas.text(
            [x + length(asked) + if asked == 0.0 { 0.0 } else { 4.0 }, y + 4.0],
            TextAnchor::Start,
            10,
            color,
            &text,
        );
    }
}

fn column(n: usize) -> f64 {
    COLUMNS[0] + COLUMNS[1] * n as f64
}

/// Returns the count of each column as asked and after pruning.
fn counts(way: &Technique) -> [[f64; 2]; 4] {
    let both = [&way.accuracy.cost.asked, &way.accuracy.cost.pruned];
    [
        both.map(|cost| cost.passes as f64),
        both.map(|cost| cost.stages),
        both.map(|cost| cost.fetches),
        both.map(|cost| cost.blends),
    ]
}
