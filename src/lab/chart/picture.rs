//! Charts with two axes.

use std::sync::Arc;

use kuva::backend::svg::SvgBackend;
use kuva::plot::legend::{LegendEntry, LegendPosition, LegendShape};
use kuva::plot::scatter::MarkerShape;
use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::annotations::ReferenceLine;
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::{Primitive, Scene, TextAnchor, render_multiple};
use kuva::render::theme::Theme;

pub use super::canvas::Image;
use super::canvas::{Canvas, FONT};
use super::labels::Rect;
use super::page::plain;
use ninebit_files::output::OutputError;

/// An axis of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// Lower end; positive on a logarithmic axis.
    pub low: f64,
    /// Upper end, above the lower one.
    pub high: f64,
    /// Whether the axis is logarithmic.
    pub logarithmic: bool,
}

impl Axis {
    /// Returns a logarithmic axis that contains the positive values and ends at ticks.
    pub fn logarithmic(label: impl Into<String>, values: impl Iterator<Item = f64>) -> Axis {
        let (low, high) = ends(values.filter(|value| *value > 0.0), 1.0);
        Axis {
            label: label.into(),
            low: tick_below(low / 1.05),
            high: 1.0 / tick_below(1.0 / (high * 1.05)),
            logarithmic: true,
        }
    }

    /// Returns a linear axis that contains the values and, with `from_zero`, 0.
    pub fn linear(label: impl Into<String>, values: impl Iterator<Item = f64>, from_zero: bool) -> Axis {
        let (low, high) = ends(values.chain(from_zero.then_some(0.0)), 0.0);
        let room = if high > low { 0.04 * (high - low) } else { 1.0 };
        let low = if from_zero && low >= 0.0 { 0.0 } else { low - room };
        Axis { label: label.into(), low, high: high + room, logarithmic: false }
    }

    /// Returns the position of a value between the ends, 0 to 1.
    pub(super) fn share(&self, value: f64) -> f64 {
        if self.logarithmic {
            (value.max(self.low).ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }
}

/// Renumbers clip regions. The library counts them through all drawings of a process, which would make a drawing's bytes depend on earlier ones.
fn numbered_anew(svg: &str) -> String {
    const NAME: &str = "kuva-clip-";
    let mut pieces = svg.split(NAME);
    let mut text = pieces.next().unwrap_or_default().to_owned();
    let mut known: Vec<&str> = Vec::new();
    for piece in pieces {
        let digits = piece.find(|c: char| !c.is_ascii_digit()).unwrap_or(piece.len());
        let (number, rest) = piece.split_at(digits);
        let place = known.iter().position(|other| *other == number).unwrap_or_else(|| {
            known.push(number);
            known.len() - 1
        });
        text += &format!("plot-{place}{rest}");
    }
    text
}

/// Returns the ticks of a logarithmic axis: 1, 2 and 5 times powers of ten.
pub(super) fn ticks(axis: &Axis) -> Vec<f64> {
    let mut all = Vec::new();
    let mut tick = tick_below(axis.low * 1.000_001);
    while tick <= axis.high * 1.000_001 && all.len() < 64 {
        all.push(tick);
        tick = 1.0 / tick_below(1.0 / (tick * 1.01));
    }
    all
}

/// Returns the largest tick that is not above a positive number: 1, 2 or 5 times a power of ten.
fn tick_below(value: f64) -> f64 {
    let power = 10.0_f64.powf(value.log10().floor());
    [5.0, 2.0].into_iter().map(|n| n * power).find(|tick| *tick <= value).unwrap_or(power)
}

/// Returns the least and the largest of the finite values; both are `empty` if there are none.
fn ends(values: impl Iterator<Item = f64>, empty: f64) -> (f64, f64) {
    let finite = values.filter(|value| value.is_finite());
    let ends = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if ends.0 > ends.1 { (empty, empty) } else { ends }
}

/// Shapes of marks that are easily told apart.
pub const SHAPES: [MarkerShape; 5] =
    [MarkerShape::Circle, MarkerShape::Square, MarkerShape::Triangle, MarkerShape::Diamond, MarkerShape::Cross];

/// A line through points.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Label in the legend.
    pub label: String,
    /// The colour of marks and lines, `#rrggbb`.
    pub color: &'static str,
    /// Shape of the marks; `None` if there is only a line.
    pub shape: Option<MarkerShape>,
    /// The points, in the order in which they are joined.
    pub points: Vec<[f64; 2]>,
}

/// Dark colours that also differ for readers with colour blindness.
pub const COLORS: [&str; 8] = ["#1f5fa8", "#c2401e", "#2f7d4f", "#7b3fa0", "#a67c00", "#00838f", "#ad1457", "#4d4d4d"];

/// A chart with titles, axes, points and lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Title above the chart.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The lines; later ones are drawn over earlier ones.
    pub series: Vec<Series>,
    /// Levels of the vertical axis with their names, drawn as dashed lines.
    pub levels: Vec<(f64, String)>,
    /// Pictures below the legend, each with its caption.
    pub pictures: Vec<(String, Image)>,
    /// Width and height in pixels.
    pub size: [f64; 2],
}

/// Margins of the plot in pixels: left, right, top, bottom. The legend has the right one, so that plots are equally wide, whatever it says.
const MARGINS: [f64; 4] = [58.0, 318.0, 58.0, 56.0];
/// Distance of the legend from the plot, and of captions from each other, in pixels.
const GAP: f64 = 14.0;
/// Height of a picture below the legend.
const STRIP: f64 = 30.0;
/// Font size of captions.
const NAME: u32 = 11;
/// Font size of labels.
const BODY: u32 = 12;
/// Colour of grid lines: pale, because names stand on them.
const GRID: &str = "#e4e4e4";

impl Drawing {
    /// Draws the chart as SVG.
    ///
    /// # Errors
    /// Returns an error if a picture in it cannot be encoded.
    pub fn svg(&self) -> Result<String, OutputError> {
        let mut canvas = Canvas::over(self.scene(), self.size);
        let [_, right, _, bottom] = MARGINS;
        let left = self.size[0] - right + GAP;
        let height = 2.0 * GAP + STRIP;
        let mut y = self.size[1] - bottom - height * self.pictures.len() as f64 + GAP;
        for (caption, image) in &self.pictures {
            canvas.text([left, y + 6.0], TextAnchor::Start, NAME, "#222222", caption);
            let place = Rect { x: left, y: y + GAP, width: right - 2.0 * GAP, height: STRIP };
            // A frame, on which white ends.
            canvas.rectangle(
                Rect { x: place.x - 1.0, y: place.y - 1.0, width: place.width + 2.0, height: STRIP + 2.0 },
                "#999999",
            );
            canvas.image(place, image.clone());
            y += height;
        }
        canvas.svg()
    }

    fn scene(&self) -> Scene {
        let [left, right, top, bottom] = MARGINS;
        let mut layout = Layout::new((self.x.low, self.x.high), (self.y.low, self.y.high))
            .with_width(self.size[0])
            .with_height(self.size[1])
            .with_force_margins(left, right)
            .with_force_margins_y(top, bottom)
            .with_x_axis_min(self.x.low)
            .with_x_axis_max(self.x.high)
            .with_y_axis_min(self.y.low)
            .with_y_axis_max(self.y.high)
            .with_title(self.title.as_str())
            .with_x_label(self.x.label.as_str())
            .with_title_size(15)
            .with_label_size(13)
            .with_tick_size(11)
            .with_body_size(BODY)
            .with_theme(Theme { grid_color: GRID.to_owned(), ..Theme::light() });
        if self.x.logarithmic {
            layout = layout.with_log_x().with_x_tick_format(TickFormat::Custom(Arc::new(plain)));
        }
        if self.y.logarithmic {
            layout = layout.with_log_y().with_y_tick_format(TickFormat::Custom(Arc::new(plain)));
        }
        let place = LegendPosition::Custom(self.size[0] - right + GAP, top);
        layout = layout.with_legend_entries(self.legend()).with_legend_position(place).with_legend_box(false);
        for (level, name) in &self.levels {
            layout = layout
                .with_reference_line(ReferenceLine::horizontal(*level).with_color("#444444").with_label(name.as_str()));
        }
        let mut scene = render_multiple(self.series.iter().flat_map(Series::plots).collect(), layout);
        scene.font_family = Some(FONT.to_owned());
        // The label of the vertical axis stands above it, where it can be read horizontally.
        scene.add(text([12.0, top - 10.0], TextAnchor::Start, BODY, None, &self.y.label));
        scene
    }

    fn legend(&self) -> Vec<LegendEntry> {
        let entry = |series: &Series| LegendEntry {
            label: series.label.clone(),
            color: series.color.to_owned(),
            shape: series.shape.map_or(LegendShape::Line, LegendShape::Marker),
            dasharray: None,
        };
        self.series.iter().map(entry).collect()
    }
}

/// Returns a text whose baseline is at `y`.
pub(super) fn text([x, y]: [f64; 2], anchor: TextAnchor, size: u32, color: Option<&str>, content: &str) -> Primitive {
    let (content, color) = (content.to_owned(), color.map(Into::into));
    Primitive::Text { x, y, content, size, anchor, rotate: None, bold: false, color }
}

/// Returns the text of an SVG.
pub(super) fn text_of(scene: &Scene) -> String {
    numbered_anew(&SvgBackend::new().render_scene(scene)) + "\n"
}

impl Series {
    fn plots(&self) -> Vec<Plot> {
        let points = || self.points.iter().map(|[x, y]| (*x, *y));
        let line = LinePlot::new().with_data(points()).with_color(self.color).with_stroke_width(1.6);
        let mut plots = vec![Plot::Line(line)];
        if let Some(marker) = self.shape {
            plots.push(Plot::Scatter(
                ScatterPlot::new().with_data(points()).with_color(self.color).with_size(4.5).with_marker(marker),
            ));
        }
        plots
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithmic_axes_end_at_ticks() {
        let axis = |values: &[f64]| {
            let axis = Axis::logarithmic("", values.iter().copied());
            (axis.low, (axis.high * 1e6).round() / 1e6)
        };
        assert_eq!(axis(&[3.0, 70.0]), (2.0, 100.0));
        assert_eq!(axis(&[1.06, 1.5, 0.0, f64::NAN]), (1.0, 2.0));
        assert_eq!(axis(&[1.0, 20.0]), (0.5, 50.0));
        assert_eq!(axis(&[]), (0.5, 2.0));
        let ticks = ticks(&Axis::logarithmic("", [0.3, 70.0].into_iter()));
        assert_eq!(
            ticks.iter().copied().map(plain).collect::<Vec<_>>(),
            ["0.2", "0.5", "1", "2", "5", "10", "20", "50", "100"]
        );
    }

    #[test]
    fn a_drawing_holds_its_texts_and_is_the_same_each_time() {
        let series = Series {
            label: "a < b".to_owned(),
            color: COLORS[0],
            shape: Some(MarkerShape::Circle),
            points: vec![[1.0, 2.0], [5.0, 8.0]],
        };
        let drawing = Drawing {
            title: "title".to_owned(),
            x: Axis::logarithmic("ns", [1.0, 5.0].into_iter()),
            y: Axis::linear("error", [2.0, 8.0].into_iter(), true),
            series: vec![series],
            levels: vec![(4.0, "fails above 4".to_owned())],
            pictures: vec![("drawn".to_owned(), Image { width: 2, pixels: vec![[0; 3], [255; 3]] })],
            size: [700.0, 300.0],
        };
        let svg = drawing.svg().unwrap();
        for text in ["title", "a &lt; b", "ns", "error", "fails above 4", "drawn", "data:image/png;base64,"] {
            assert!(svg.contains(text), "{text}");
        }
        assert_eq!(drawing.svg().unwrap(), svg);
    }
}
