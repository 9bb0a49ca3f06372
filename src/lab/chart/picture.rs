//! Charts with two axes, as SVG and PNG.

use std::sync::Arc;

use kuva::backend::png::PngBackend;
use kuva::backend::svg::SvgBackend;
use kuva::plot::legend::{LegendEntry, LegendPosition, LegendShape};
use kuva::plot::scatter::MarkerShape;
use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::annotations::ReferenceLine;
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::{Primitive, Scene, TextAnchor, render_multiple};
use kuva::render::theme::Theme;

use super::labels::{self, Named, Rect};
use super::page::plain;
use ninebit_files::output::OutputError;

/// An axis of a chart.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
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
    pub(crate) fn logarithmic(label: impl Into<String>, values: impl Iterator<Item = f64>) -> Axis {
        let (low, high) = ends(values.filter(|value| *value > 0.0), 1.0);
        Axis {
            label: label.into(),
            low: tick_below(low / 1.05),
            high: 1.0 / tick_below(1.0 / (high * 1.05)),
            logarithmic: true,
        }
    }

    /// Returns a linear axis that contains the values and, with `from_zero`, 0.
    pub(crate) fn linear(label: impl Into<String>, values: impl Iterator<Item = f64>, from_zero: bool) -> Axis {
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

/// Returns the error for a picture that cannot be encoded as PNG.
pub(super) fn encode_error([width, height]: [u32; 2], reason: String) -> OutputError {
    OutputError::Encode { width, height, reason }
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
pub(crate) const SHAPES: [MarkerShape; 5] =
    [MarkerShape::Circle, MarkerShape::Square, MarkerShape::Triangle, MarkerShape::Diamond, MarkerShape::Cross];

/// The line that joins the points of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Join {
    /// Points are not joined by a line.
    None,
    /// A solid line.
    Solid,
    /// A dashed line.
    Dashed,
}

/// A point and its name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mark {
    /// Value on the horizontal axis.
    pub x: f64,
    /// Value on the vertical axis.
    pub y: f64,
    /// Text beside the point; empty for none.
    pub name: String,
}

/// A series of points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Series {
    /// Label in the legend; an empty one is left out.
    pub label: String,
    /// The colour of marks and lines, `#rrggbb`.
    pub color: &'static str,
    /// Shape of the marks; `None` if there is only a line.
    pub shape: Option<MarkerShape>,
    /// The line that joins the points.
    pub join: Join,
    /// The points, in the order in which they are joined.
    pub marks: Vec<Mark>,
}

/// Dark colours that also differ for readers with colour blindness.
pub(crate) const COLORS: [&str; 8] =
    ["#1f5fa8", "#c2401e", "#2f7d4f", "#7b3fa0", "#a67c00", "#00838f", "#ad1457", "#4d4d4d"];

/// A chart with titles, axes, points and lines.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Drawing {
    /// Title above the chart.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Points and lines; later series are drawn over earlier ones.
    pub series: Vec<Series>,
    /// Levels of the vertical axis with their names, drawn as dashed lines.
    pub levels: Vec<(f64, String)>,
    /// Width and height in pixels of the SVG; the PNG has [`SCALE`] times as many in each direction.
    pub size: [f64; 2],
}

/// A chart in both formats.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Picture {
    /// The text of the SVG.
    pub svg: String,
    /// The bytes of the PNG.
    pub png: Vec<u8>,
}

/// Margins of the plot in pixels: left, right, top, bottom.
const MARGINS: [f64; 4] = [58.0, 24.0, 58.0, 56.0];
/// Font size of names.
const NAME: u32 = 11;
/// Font size of labels.
const BODY: u32 = 12;
/// Colour of grid lines: pale, because names stand on them.
const GRID: &str = "#e4e4e4";
/// Pixels of the PNG for one of the SVG, in each direction.
pub(super) const SCALE: f32 = 2.0;

impl Drawing {
    /// Draws the chart in both formats.
    ///
    /// # Errors
    /// Returns an error if the PNG cannot be encoded.
    pub(crate) fn draw(&self) -> Result<Picture, OutputError> {
        let scene = self.scene();
        let fail = |reason| encode_error(self.size.map(|side| (side * f64::from(SCALE)) as u32), reason);
        let png = PngBackend::new().with_scale(SCALE).render_scene(&scene).map_err(fail)?;
        Ok(Picture { svg: text_of(&scene), png })
    }

    /// Draws the chart as SVG.
    pub(crate) fn svg(&self) -> String {
        text_of(&self.scene())
    }

    fn scene(&self) -> Scene {
        let legend = self.legend();
        let widest = legend.iter().map(|entry| labels::text_width(&entry.label, f64::from(BODY))).fold(0.0, f64::max);
        let [left, right, top, bottom] = MARGINS;
        let right = if legend.is_empty() { right } else { widest + 56.0 };
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
        if !legend.is_empty() {
            let place = LegendPosition::Custom(self.size[0] - right + 10.0, top);
            layout = layout.with_legend_entries(legend).with_legend_position(place).with_legend_box(false);
        }
        for (level, name) in &self.levels {
            layout = layout
                .with_reference_line(ReferenceLine::horizontal(*level).with_color("#444444").with_label(name.as_str()));
        }
        let mut scene = render_multiple(self.series.iter().flat_map(Series::plots).collect(), layout);
        let plot = Rect { x: left, y: top, width: self.size[0] - left - right, height: self.size[1] - top - bottom };
        self.write_names(&mut scene, &plot);
        // The label of the vertical axis stands above it, where it can be read horizontally.
        scene.add(text([12.0, top - 10.0], TextAnchor::Start, BODY, None, &self.y.label));
        scene
    }

    fn legend(&self) -> Vec<LegendEntry> {
        let named = self.series.iter().filter(|series| !series.label.is_empty());
        named
            .map(|series| LegendEntry {
                label: series.label.clone(),
                color: series.color.to_owned(),
                shape: series.shape.map_or(LegendShape::Line, LegendShape::Marker),
                dasharray: (series.join == Join::Dashed).then(|| "6 4".to_owned()),
            })
            .collect()
    }

    /// Writes the names of the marks, with a thin line to those that stand apart.
    fn write_names(&self, scene: &mut Scene, plot: &Rect) {
        let at = |mark: &Mark| {
            [plot.x + plot.width * self.x.share(mark.x), plot.y + plot.height * (1.0 - self.y.share(mark.y))]
        };
        let mut lines = Vec::new();
        for series in self.series.iter().filter(|series| series.join != Join::None) {
            lines.extend(series.marks.windows(2).map(|pair| (at(&pair[0]), at(&pair[1]))));
        }
        let marks = self.series.iter().flat_map(|series| series.marks.iter().map(move |mark| (series, mark)));
        let marks: Vec<(&Series, &Mark)> =
            marks.filter(|(series, mark)| series.shape.is_some() || !mark.name.is_empty()).collect();
        let size = f64::from(NAME);
        let named = |(_, mark): &(&Series, &Mark)| {
            let height = if mark.name.is_empty() { 0.0 } else { size + 2.0 };
            Named { at: at(mark), size: [labels::text_width(&mark.name, size), height] }
        };
        let named: Vec<Named> = marks.iter().map(named).collect();
        let places = labels::place(&named, plot, &lines);
        for (((series, mark), named), place) in marks.iter().zip(&named).zip(&places) {
            if mark.name.is_empty() {
                continue;
            }
            if let Some(([x1, y1], [x2, y2])) = labels::leader(named, place) {
                let stroke = "#999999".into();
                scene.add(Primitive::Line { x1, y1, x2, y2, stroke, stroke_width: 0.7, stroke_dasharray: None });
            }
            // The text is aligned to its mark, so that it stays near if it is narrower than estimated.
            let (x, anchor) = if place.x + place.width <= named.at[0] {
                (place.x + place.width, TextAnchor::End)
            } else if place.x >= named.at[0] {
                (place.x, TextAnchor::Start)
            } else {
                (place.x + place.width / 2.0, TextAnchor::Middle)
            };
            scene.add(text([x, place.y + size - 0.5], anchor, NAME, Some(series.color), &mark.name));
        }
    }
}

/// Returns a text whose baseline is at `y`.
pub(super) fn text([x, y]: [f64; 2], anchor: TextAnchor, size: u32, color: Option<&str>, content: &str) -> Primitive {
    let (content, color) = (content.to_owned(), color.map(Into::into));
    Primitive::Text { x, y, content, size, anchor, rotate: None, bold: false, color }
}

/// Returns the text of an SVG.
fn text_of(scene: &Scene) -> String {
    numbered_anew(&SvgBackend::new().render_scene(scene)) + "\n"
}

impl Series {
    fn plots(&self) -> Vec<Plot> {
        let points = || self.marks.iter().map(|mark| (mark.x, mark.y));
        let mut plots = Vec::new();
        let line = || LinePlot::new().with_data(points()).with_color(self.color).with_stroke_width(1.6);
        match self.join {
            Join::None => {}
            Join::Solid => plots.push(Plot::Line(line())),
            Join::Dashed => plots.push(Plot::Line(line().with_dashed())),
        }
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
    fn a_drawing_holds_its_names_and_both_formats_are_the_same_each_time() {
        let mark = |x: f64, y: f64, name: &str| Mark { x, y, name: name.to_owned() };
        let series = Series {
            label: "a family".to_owned(),
            color: COLORS[0],
            shape: Some(MarkerShape::Circle),
            join: Join::Dashed,
            marks: vec![mark(1.0, 2.0, "one < two"), mark(5.0, 8.0, "other")],
        };
        let drawing = Drawing {
            title: "title".to_owned(),
            x: Axis::logarithmic("ns", [1.0, 5.0].into_iter()),
            y: Axis::linear("error", [2.0, 8.0].into_iter(), true),
            series: vec![series],
            levels: vec![(4.0, "limit 4".to_owned())],
            size: [400.0, 300.0],
        };
        let picture = drawing.draw().unwrap();
        for text in ["title", "a family", "one &lt; two", "other", "limit 4"] {
            assert!(picture.svg.contains(text), "{text}");
        }
        let png = image::load_from_memory(&picture.png).unwrap();
        assert_eq!((png.width(), png.height()), (800, 600));
        assert_eq!(drawing.draw().unwrap(), picture);
        assert_eq!(drawing.svg(), picture.svg);
    }
}
