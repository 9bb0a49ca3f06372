//! Line charts of the page.

use ninebit_lab::chart::picture::{Axis, COLORS, Drawing, Series};

/// Returns a chart of lines, without title and axes.
pub fn lines(series: Vec<Series>) -> Drawing {
    let axis = || Axis::linear("", [0.0, 1.0].into_iter(), true);
    Drawing {
        title: String::new(),
        x: axis(),
        y: axis(),
        series,
        levels: vec![],
        pictures: vec![],
        size: [940.0, 360.0],
    }
}

/// Returns the n-th line.
pub fn line(n: usize, label: &str, points: Vec<[f64; 2]>) -> Series {
    Series { label: label.to_string(), color: COLORS[n], shape: None, points }
}
