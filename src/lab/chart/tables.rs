//! The tables of the page on speed and accuracy.

use super::evaluators::Evaluator;
use super::page::{Row, number, row, table};
use super::questions::{Light, MAX_SHOWN};
use super::report::{FOLDER, Measurements};
use super::surfaces::SurfaceCost;
use super::techniques::Technique;
use super::timing::Spread;
use crate::accuracy::FrameCost;

/// Error budgets: rms in 8-bit steps.
const BUDGETS: [f64; 5] = [1.0, 2.0, 4.0, 8.0, 16.0];

impl Measurements {
    /// Returns the section of a light with its charts.
    pub(super) fn light_section(light: &Light<'_>) -> String {
        let (name, title) = (&light.name, &light.title);
        let picture = |end: &str, what: &str| format!("![{title}: {what}]({FOLDER}/{name}-{end})\n\n");
        let more = match light.ways.len() {
            n if n > MAX_SHOWN => format!("The {MAX_SHOWN} most exact of {n} ways.\n\n"),
            _ => String::new(),
        };
        format!(
            "### {title}\n\n{more}{}{}",
            picture("chip.svg", "error and cost of each way"),
            picture("pictures.png", "the pictures and their errors")
        )
    }

    /// Returns the section of a family: accuracy, cost and causes of errors of each technique.
    pub(super) fn family_section(&self, family: &str) -> String {
        let title = self.titles.get(family).map_or(family, String::as_str);
        format!(
            "### {title}\n\nHow exact, in 8-bit steps:\n\n{}\nAt what cost, per final pixel, as the program asks; after an arrow what pruning \
             leaves of it:\n\n{}\nWhere the error comes from, rms:\n\n{}\n",
            table(&self.accuracy_rows(family)),
            table(&self.cost_rows(family)),
            table(&self.cause_rows(family))
        )
    }

    fn of<'a>(&'a self, family: &'a str) -> impl Iterator<Item = &'a Technique> {
        self.techniques.iter().filter(move |technique| technique.entry.family == family)
    }

    fn accuracy_rows(&self, family: &str) -> Vec<Row> {
        let row = |technique: &Technique| {
            let (errors, banding) = (&technique.accuracy.errors, &technique.accuracy.banding);
            let steps = [errors.rms(), errors.max(), errors.bias(), errors.psnr()].map(number);
            let counts = [banding.levels, banding.truth_levels, banding.flat_run].map(|count| count.to_string());
            std::iter::once(technique.title.clone()).chain(steps).chain(counts).collect()
        };
        let names = ["technique", "rms", "max", "bias", "PSNR, dB", "levels", "of the truth", "flat run"];
        heading(&names).chain(self.of(family).map(row)).collect()
    }

    fn cost_rows(&self, family: &str) -> Vec<Row> {
        let row = |technique: &Technique| {
            let cost = &technique.accuracy.cost;
            let both = |of: fn(&FrameCost) -> f64| {
                let [asked, pruned] = [&cost.asked, &cost.pruned].map(|cost| number(of(cost)));
                if asked == pruned { asked } else { format!("{asked} → {pruned}") }
            };
            let counts = [
                both(|cost| cost.passes as f64),
                both(|cost| cost.stages),
                both(|cost| cost.fetches),
                both(|cost| cost.blends),
                both(|cost| cost.texels),
                both(|cost| cost.products),
                both(|cost| cost.frame_buffer_bytes),
            ];
            std::iter::once(technique.title.clone()).chain(counts).chain([spread(technique.time)]).collect()
        };
        let names = ["technique", "passes", "stages", "fetches", "blends", "texels", "products", "bytes", "ns here"];
        heading(&names).chain(self.of(family).map(row)).collect()
    }

    /// Returns the table of each cause's contribution to the error.
    fn cause_rows(&self, family: &str) -> Vec<Row> {
        let causes = causes(self.of(family));
        let names: Vec<&str> =
            ["technique"].into_iter().chain(causes.iter().copied()).chain(["normals off by, degrees"]).collect();
        let row = |technique: &Technique| {
            let of = |name: &&str| cause(technique, name).map_or("-".to_owned(), number);
            let degrees = degrees(technique).map_or("-".to_owned(), number);
            std::iter::once(technique.title.clone()).chain(causes.iter().map(of)).chain([degrees]).collect()
        };
        heading(&names).chain(self.of(family).map(row)).collect()
    }

    /// Returns the fastest technique within each budget, for each light with several techniques.
    pub(super) fn budget_rows(lights: &[Light<'_>]) -> Vec<Row> {
        let names = ["picture".to_owned(), "most exact way".to_owned()]
            .into_iter()
            .chain(BUDGETS.iter().map(|budget| format!("rms up to {}", number(*budget))));
        let named = |way: &Technique, value: f64, unit: &str| format!("{} ({} {unit})", way.title, number(value));
        let row = |light: &Light<'_>| {
            let titles: Vec<&str> = light.ways.iter().map(|way| way.title.as_str()).collect();
            let name = if light.asked { light.title.clone() } else { titles.join(", ") };
            let exact = light.ways.first().map_or(String::new(), |best| named(best, best.rms(), "steps"));
            let fastest = |budget: &f64| {
                let within = light.ways.iter().filter(|way| way.rms() <= *budget);
                let best = within.min_by(|a, b| a.time.median.total_cmp(&b.time.median));
                best.map_or("none".to_owned(), |best| named(best, best.time.median, "ns"))
            };
            [name, exact].into_iter().chain(BUDGETS.iter().map(fastest)).collect()
        };
        let several = lights.iter().filter(|light| light.ways.len() > 1);
        std::iter::once(names.collect()).chain(several.map(row)).collect()
    }

    pub(super) fn evaluator_rows(&self) -> Vec<Row> {
        let names = ["evaluator", "surface", "ns per pixel", "rms error, steps", "largest", "what it yields"];
        let row = |e: &Evaluator| {
            [&e.name, &e.surface, &spread(e.time), &number(e.error), &number(e.largest), &e.yields]
                .map(String::clone)
                .to_vec()
        };
        heading(&names).chain(self.evaluators.iter().map(row)).collect()
    }

    pub(super) fn surface_rows(&self) -> Vec<Row> {
        let names = ["surface", "texels", "operations", "bytes", "ns, fast engine", "ns, definition"];
        let row = |s: &SurfaceCost| {
            let counts = [s.texels, s.operations, s.bytes].map(number);
            [s.name.clone()].into_iter().chain(counts).chain([s.fast, s.scalar].map(spread)).collect()
        };
        heading(&names).chain(self.surfaces.iter().map(row)).collect()
    }
}

fn heading(names: &[&str]) -> impl Iterator<Item = Row> {
    std::iter::once(row(names))
}

/// Returns all causes of some techniques, in the order of the steps from the truth to the picture.
pub(super) fn causes<'a>(techniques: impl Iterator<Item = &'a Technique>) -> Vec<&'static str> {
    let mut causes: Vec<&'static str> = Vec::new();
    for cause in techniques.flat_map(|technique| &technique.accuracy.causes) {
        if !causes.contains(&cause.name) {
            causes.push(cause.name);
        }
    }
    // Not every technique has this cause, but it is always the first step.
    causes.sort_by_key(|name| usize::from(*name != "quantised normals"));
    causes
}

/// Returns the rms of a cause's contribution to a technique's error, or `None` if it has none.
pub(super) fn cause(technique: &Technique, name: &str) -> Option<f64> {
    technique.accuracy.causes.iter().find(|cause| cause.name == name).map(|cause| cause.errors.rms())
}

/// Returns the mean angle error of a technique's normals in degrees, or `None` if it was not measured.
pub(super) fn degrees(technique: &Technique) -> Option<f64> {
    technique.accuracy.normals.as_ref().map(|normals| normals.degrees.mean())
}

/// Formats a median and its quartiles.
pub(super) fn spread(spread: Spread) -> String {
    format!("{} ({} to {})", number(spread.median), number(spread.lower), number(spread.upper))
}
