//! The list of evaluators: a row for each, with its time as a bar.

use super::canvas::{Canvas, TextAnchor};
use super::evaluators::Evaluator;
use super::labels::Rect;
use super::page::number;
use super::picture::{Axis, COLORS, ticks};

const WIDTH: f64 = 1010.0;
const ROW: f64 = 22.0;
/// Right end of the names, in pixels.
const NAMES: f64 = 140.0;
/// Left and right end of the axis, in pixels.
const AXIS: [f64; 2] = [152.0, 520.0];
const INK: &str = "#222222";
const PALE: &str = "#767676";
const GRID: &str = "#e4e4e4";

/// Returns the list, grouped by surface.
pub(super) fn of_evaluators(evaluators: &[Evaluator]) -> Canvas {
    let mut surfaces: Vec<&str> = Vec::new();
    for evaluator in evaluators.iter().filter(|evaluator| !evaluator.surface.is_empty()) {
        if !surfaces.contains(&evaluator.surface.as_str()) {
            surfaces.push(&evaluator.surface);
        }
    }
    let top = 92.0;
    let bottom = top + ROW * (evaluators.len() + surfaces.len()) as f64 + 6.0;
    let mut canvas = Canvas::new(WIDTH, bottom + 26.0);
    canvas.text([16.0, 26.0], TextAnchor::Start, 15, INK, "Ways to evaluate a scene");
    let mut x = 17.0;
    for (color, text) in [
        (COLORS[0], "yields exactly the stored bytes, or contains them"),
        (COLORS[1], "yields other numbers, off by the error beside it"),
    ] {
        canvas.rectangle(Rect { x, y: 38.0, width: 10.0, height: 10.0 }, color);
        canvas.text([x + 17.0, 47.0], TextAnchor::Start, 11, INK, text);
        x += 340.0;
    }
    let axis = Axis::logarithmic("", evaluators.iter().map(|evaluator| evaluator.time.median));
    let at = |value: f64| AXIS[0] + (AXIS[1] - AXIS[0]) * axis.share(value);
    canvas.text([AXIS[0], top - 12.0], TextAnchor::Start, 11, INK, "nanoseconds per pixel, one thread");
    for tick in ticks(&axis).into_iter().filter(|tick| tick.log10().fract().abs() < 1e-9) {
        canvas.line([at(tick), top - 4.0], [at(tick), bottom], GRID, 1.0);
        canvas.text([at(tick), bottom + 16.0], TextAnchor::Middle, 11, PALE, &number(tick));
    }
    let mut y = top + ROW / 2.0;
    for surface in surfaces {
        canvas.text([16.0, y + 4.0], TextAnchor::Start, 12, INK, surface);
        y += ROW;
        let mut own: Vec<&Evaluator> = evaluators.iter().filter(|evaluator| evaluator.surface == surface).collect();
        own.sort_by(|a, b| a.time.median.total_cmp(&b.time.median));
        for evaluator in own {
            let exact = evaluator.largest == 0.0;
            let end = at(evaluator.time.median);
            canvas.text([NAMES, y + 4.0], TextAnchor::End, 11, INK, &evaluator.name);
            let bar = Rect { x: AXIS[0], y: y - 6.0, width: (end - AXIS[0]).max(1.0), height: 12.0 };
            canvas.rectangle(bar, if exact { COLORS[0] } else { COLORS[1] });
            canvas.text([end + 5.0, y + 4.0], TextAnchor::Start, 10, INK, &number(evaluator.time.median));
            let [rms, largest] = [evaluator.error, evaluator.largest].map(number);
            // A remark after a colon or in parentheses stands in the table.
            let yields = evaluator.yields.split([':', '(']).next().unwrap_or_default().trim();
            let told = if exact { yields.to_owned() } else { format!("{yields}: {rms} steps rms, at most {largest}") };
            canvas.text([AXIS[1] + 58.0, y + 4.0], TextAnchor::Start, 11, INK, &told);
            y += ROW;
        }
    }
    canvas
}
