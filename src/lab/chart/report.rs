//! The files of the page on speed and accuracy.

use std::collections::BTreeMap;

use super::curves::{self, Curve};
use super::evaluators::Evaluator;
use super::page::{File, comma_separated, fill, table, words};
use super::questions::{Light, lights};
use super::surfaces::SurfaceCost;
use super::techniques::Technique;
use super::{bars, dots, strip};
use ninebit_files::output::OutputError;

/// The page's template.
const TEMPLATE: &str = include_str!("page.md");
/// Name of the page, and of the folder of its files beside it.
pub(super) const FOLDER: &str = "speed-accuracy";

/// All measurements that the page shows.
#[derive(Clone, Debug, Default)]
pub struct Measurements {
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
    /// Instruction set that was timed.
    pub isa: String,
    /// Whether only few frames were timed.
    pub quick: bool,
    /// Names of scenes that are missing because of an internal error.
    pub failed: Vec<String>,
}

impl Measurements {
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
        let overview = dots::overview(&charted);
        // Where the README is shown may be no place for an SVG.
        files.extend([lines("speed-accuracy", overview.svg()?), pixels("speed-accuracy", overview.png()?)]);
        for light in &charted {
            files.push(lines(&format!("{}-chip", light.name), dots::of_light(light).svg()?));
            // It is a PNG only: it has no lines that an SVG would help.
            files.push(pixels(&format!("{}-pictures", light.name), strip::of_light(light).png()?));
        }
        files.push(lines("evaluators", bars::of_evaluators(&self.evaluators).svg()?));
        files.push(lines("cost", curves::drawing(&self.curves).svg()?));
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
        // First, because it may be refused: times can come from a file of that name.
        files.insert(0, File::text(format!("{FOLDER}/figures.json"), format!("{}\n", self.document(&lights))));
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
            self.isa
        )
    }
}
