//! Draws line charts as SVG with a fixed size and fixed decimals, so that the bytes are the same on every machine.

use std::fmt::Write;

/// A line of the chart.
pub struct Line<'a> {
    pub label: &'a str,
    pub color: &'a str,
    /// Whether the line is drawn broad and pale, so that a line on top of it remains distinguishable.
    pub beneath: bool,
    pub points: Vec<[f64; 2]>,
}

/// An axis: its label, its ends, and its ticks with their labels.
pub struct Axis<'a> {
    pub label: &'a str,
    pub range: [f64; 2],
    pub ticks: Vec<(f64, String)>,
}

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 300.0;
/// Left, top, right and bottom of the plot.
const PLOT: [f64; 4] = [62.0, 16.0, 612.0, 246.0];

pub const BLUE: &str = "#2364aa";
pub const RED: &str = "#c8402f";
pub const GREEN: &str = "#3d8b4f";

/// Returns a chart of lines over two linear axes. The legend is at the upper left or, if asked for, at the upper right.
pub fn chart(x: &Axis<'_>, y: &Axis<'_>, lines: &[Line<'_>], legend_right: bool) -> String {
    let across = |v: f64| PLOT[0] + (v - x.range[0]) / (x.range[1] - x.range[0]) * (PLOT[2] - PLOT[0]);
    let up = |v: f64| PLOT[3] - (v - y.range[0]) / (y.range[1] - y.range[0]) * (PLOT[3] - PLOT[1]);
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
         font-family=\"sans-serif\" font-size=\"12\" fill=\"#333\">\n<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#fff\"/>"
    );
    for (v, label) in &x.ticks {
        let at = across(*v);
        let _ = writeln!(
            out,
            "<path d=\"M{at:.1} {:.1}V{:.1}\" stroke=\"#ddd\"/>\n<text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
            PLOT[1],
            PLOT[3],
            PLOT[3] + 17.0
        );
    }
    for (v, label) in &y.ticks {
        let at = up(*v);
        let _ = writeln!(
            out,
            "<path d=\"M{:.1} {at:.1}H{:.1}\" stroke=\"#ddd\"/>\n<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
            PLOT[0],
            PLOT[2],
            PLOT[0] - 6.0,
            at + 4.0
        );
    }
    let (middle, center) = ((PLOT[0] + PLOT[2]) / 2.0, (PLOT[1] + PLOT[3]) / 2.0);
    let _ = writeln!(
        out,
        "<text x=\"{middle:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\n\
         <text transform=\"translate(14 {center:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        HEIGHT - 12.0,
        x.label,
        y.label
    );
    for (n, line) in lines.iter().enumerate() {
        let points: Vec<String> = line.points.iter().map(|[a, b]| format!("{:.1},{:.1}", across(*a), up(*b))).collect();
        let (color, label) = (line.color, line.label);
        let style = if line.beneath { "stroke-width=\"7\" stroke-opacity=\"0.35\"" } else { "stroke-width=\"2\"" };
        let left = if legend_right { PLOT[2] - 230.0 } else { PLOT[0] + 12.0 };
        let top = PLOT[1] + 16.0 + 18.0 * n as f64;
        let _ = writeln!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" {style}/>\n\
             <path d=\"M{left:.1} {top:.1}h22\" stroke=\"{color}\" {style}/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\">{label}</text>",
            points.join(" "),
            left + 28.0,
            top + 4.0
        );
    }
    out + "</svg>\n"
}

/// Returns ticks at whole numbers from `low` to `high`.
pub fn ticks(low: i64, high: i64, step: usize, label: impl Fn(i64) -> String) -> Vec<(f64, String)> {
    (low..=high).step_by(step).map(|n| (n as f64, label(n))).collect()
}
