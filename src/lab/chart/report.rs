//! The files of the page on speed and accuracy.

use std::collections::BTreeMap;

use super::curves::{self, Curve};
use super::evaluators::Evaluator;
use super::page::{File, comma_separated, fill, table, words};
use super::picture::{Axis, COLORS, Drawing, Join, Mark, Picture, SHAPES, Series};
use super::questions::{Light, lights};
use super::surfaces::SurfaceCost;
use super::techniques::{LARGE, Technique};
use super::{dots, strip};
use ninebit::engine::Isa;
use ninebit::state::Named;
use ninebit_files::output::OutputError;

/// The page's template.
const TEMPLATE: &str = include_str!("page.md");
/// Name of the page, and of the folder of its files beside it.
pub(super) const FOLDER: &str = "speed-accuracy";
const ERROR: &str = "rms error against the truth, 8-bit steps";

/// All measurements that the page shows.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// Measured scenes with a truth, sorted by family.
    pub techniques: Vec<Technique>,
    /// Titles of the families.
    pub titles: BTreeMap<String, String>,
    /// Evaluators that were measured.
    pub evaluators: Vec<Evaluator>,
    /// Surfaces that were measured.
    pub surfaces: Vec<SurfaceCost>,
    /// Measured cost curves.
    pub curves: Vec<Curve>,
    /// Whether only few frames were timed.
    pub quick: bool,
    /// Names of scenes that are missing because of an internal error.
    pub failed: Vec<String>,
}

impl Measured {
    /// Returns the lights of the techniques.
    pub(super) fn lights(&self) -> Vec<Light<'_>> {
        lights(&self.techniques, |family| self.titles.get(family).cloned().unwrap_or_else(|| family.to_owned()))
    }

    /// Returns the page and all its files.
    ///
    /// # Errors
    /// Returns an error if a picture cannot be encoded.
    pub fn files(&self) -> Result<Vec<File>, OutputError> {
        let lights = self.lights();
        let several = |asked: bool| lights.iter().filter(move |light| light.asked == asked && light.ways.len() > 1);
        // Folders of a user have no questions, so each light with several techniques is charted.
        let charted: Vec<&Light<'_>> =
            if several(true).count() > 0 { several(true).collect() } else { several(false).collect() };
        let mut files = Vec::new();
        let lines = |name: &str, svg: String| File::text(format!("{FOLDER}/{name}.svg"), svg);
        let pixels = |name: &str, png: Vec<u8>| File { path: format!("{FOLDER}/{name}.png"), bytes: png };
        let both = |name: &str, picture: Picture| [lines(name, picture.svg), pixels(name, picture.png)];
        files.extend(both("speed-accuracy", dots::overview(&charted).draw()?));
        for light in &charted {
            files.extend(both(&format!("{}-chip", light.name), dots::of_light(light).draw()?));
            files.extend(both(&format!("{}-here", light.name), time_drawing(light).draw()?));
            // It is a PNG only: it has no lines that an SVG would help.
            files.push(pixels(&format!("{}-pictures", light.name), strip::of_light(light).draw()?.png));
        }
        files.extend(both("evaluators", self.evaluators_drawing().draw()?));
        for (name, drawing) in curves::drawings(&self.curves) {
            files.push(lines(name, drawing.svg()));
        }
        let mut parts = Vec::new();
        let mut part = |name: &str, text: String| parts.push((name.to_owned(), text));
        part("machine", self.machine());
        part("answers", words(&self.answers()));
        part("claims", words(&self.claims()));
        part("lights", charted.iter().map(|light| Self::light_section(light)).collect());
        part("budgets", table(&Self::budget_rows(&lights)));
        part("families", self.titles.keys().map(|family| self.family_section(family)).collect());
        part("evaluators", table(&self.evaluator_rows()));
        part("surfaces", table(&self.surface_rows()));
        part("columns", words(&self.column_rows()));
        files.push(File::text(format!("{FOLDER}.md"), fill(TEMPLATE, &parts)));
        files.push(File::text(format!("{FOLDER}/techniques.csv"), comma_separated(&self.data_rows(&lights))));
        files.push(File::text(format!("{FOLDER}/figures.json"), format!("{}\n", self.document(&lights))));
        Ok(files)
    }

    fn machine(&self) -> String {
        let effort = if self.quick { "one frame each, to see that it works" } else { "medians of several frames" };
        let missing = match &self.failed[..] {
            [] => String::new(),
            failed => format!(" Internal errors kept out: {}.", failed.join(", ")),
        };
        format!(
            "Measured by ninebit {} on {} {}, instruction set {}, one thread, processor time, {effort}.{missing}",
            env!("CARGO_PKG_VERSION"),
            std::env::consts::ARCH,
            std::env::consts::OS,
            Isa::best().name()
        )
    }

    /// Returns the chart of the evaluators on the first surface.
    fn evaluators_drawing(&self) -> Drawing {
        let surface = self.evaluators.first().map_or("", |evaluator| evaluator.surface.as_str());
        let own: Vec<&Evaluator> = self.evaluators.iter().filter(|evaluator| evaluator.surface == surface).collect();
        let named = |e: &&Evaluator| Mark { x: e.time.median, y: e.error, name: e.name.clone() };
        let (exact, others): (Vec<&Evaluator>, Vec<&Evaluator>) = own.iter().copied().partition(|e| e.largest == 0.0);
        let series = |label: &str, n: usize, marks: &[&Evaluator]| {
            let (color, shape) = (COLORS[n], Some(SHAPES[n]));
            Series { label: label.to_owned(), color, shape, join: Join::None, marks: marks.iter().map(named).collect() }
        };
        let errors = own.iter().map(|evaluator| evaluator.error);
        Drawing {
            title: format!("Ways of evaluating a scene: {surface}"),
            x: Axis::logarithmic("ns per pixel, one thread", own.iter().map(|e| e.time.median)),
            y: Axis { low: -0.35, ..Axis::linear("rms error against the stored bytes, 8-bit steps", errors, true) },
            series: vec![series("the stored bytes", 0, &exact), series("other numbers", 1, &others)],
            levels: Vec::new(),
            size: [980.0, 420.0],
        }
    }
}

/// Returns the chart of a light's techniques by time and error.
fn time_drawing(light: &Light<'_>) -> Drawing {
    let (ways, front) = (light.shown(), light.front_by_time());
    let mark = |way: &Technique, name: String| Mark { x: way.time.median, y: way.rms(), name };
    let joined = front.iter().map(|n| mark(ways[*n], String::new())).collect();
    let marks = |kept: bool| {
        let ways = ways.iter().enumerate().filter(|(n, _)| front.contains(n) == kept);
        ways.map(|(_, way)| mark(way, way.entry.name())).collect()
    };
    let series = |label: &str, color, shape, join, marks| Series { label: label.to_owned(), color, shape, join, marks };
    Drawing {
        title: light.title.clone(),
        x: Axis::logarithmic(
            format!("ns per final pixel of this program, {LARGE} columns, one thread"),
            ways.iter().map(|way| way.time.median),
        ),
        y: Axis::logarithmic(ERROR, ways.iter().map(|way| way.rms())),
        series: vec![
            series("", "#b9cde6", None, Join::Solid, joined),
            series("", "#767676", Some(SHAPES[0]), Join::None, marks(false)),
            series("", COLORS[0], Some(SHAPES[0]), Join::None, marks(true)),
        ],
        levels: Vec::new(),
        size: [900.0, 430.0],
    }
}
