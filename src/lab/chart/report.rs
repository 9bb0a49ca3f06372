//! What was measured, as the files of the page on speed and accuracy.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::curves::{self, Curve};
use super::evaluators::Evaluator;
use super::front::front;
use super::page::{File, comma_separated, fill, number, table};
use super::picture::{Axis, COLORS, Drawing, Join, Mark, Series, Shape};
use super::surfaces::SurfaceCost;
use super::techniques::Technique;
use super::timing::Spread;
use crate::accuracy::accuracy_value;
use ninebit::engine::Isa;
use ninebit::state::Named;
use ninebit_files::output::OutputError;

/// The prose.
const TEMPLATE: &str = include_str!("page.md");
/// The folder of the files, beside the page; also the name of the page.
const FOLDER: &str = "speed-accuracy";
/// Errors that a reader may allow, rms in steps.
const BUDGETS: [f64; 5] = [1.0, 2.0, 4.0, 8.0, 16.0];
const TIME: &str = "ns per final pixel, one thread";
const ERROR: &str = "rms error against the truth, 8-bit steps";

/// Everything that the page shows.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// Scenes with a truth, by family.
    pub techniques: Vec<Technique>,
    /// Titles of families.
    pub titles: BTreeMap<String, String>,
    /// Ways of evaluating a scene.
    pub evaluators: Vec<Evaluator>,
    /// Surfaces with more and more state.
    pub surfaces: Vec<SurfaceCost>,
    /// How cost grows.
    pub curves: Vec<Curve>,
    /// Few frames were timed.
    pub quick: bool,
    /// What is missing, because this program failed on it.
    pub failed: Vec<String>,
}

/// A number of something, with its place in tables and data.
type Column = (&'static str, fn(&Technique) -> f64);

/// What is said of each technique.
const COLUMNS: [Column; 17] = [
    ("rms", rms),
    ("max", |t| t.accuracy.errors.max()),
    ("bias", |t| t.accuracy.errors.bias()),
    ("PSNR, dB", |t| t.accuracy.errors.psnr()),
    ("levels", |t| t.accuracy.banding.levels as f64),
    ("of the truth", |t| t.accuracy.banding.truth_levels as f64),
    ("flat run", |t| t.accuracy.banding.flat_run as f64),
    ("passes", |t| t.accuracy.cost.passes as f64),
    ("fetches", |t| t.accuracy.cost.fetches),
    ("texels", |t| t.accuracy.cost.texels),
    ("stages", |t| t.accuracy.cost.stages),
    ("products", |t| t.accuracy.cost.products),
    ("blends", |t| t.accuracy.cost.blends),
    ("bytes", |t| t.accuracy.cost.frame_buffer_bytes),
    ("ns", |t| t.time.median),
    ("lower ns", |t| t.time.lower),
    ("upper ns", |t| t.time.upper),
];
/// Where the columns of accuracy end.
const ACCURACY: usize = 7;

impl Measured {
    /// The page and all its files.
    ///
    /// # Errors
    /// A picture cannot be encoded.
    pub fn files(&self) -> Result<Vec<File>, OutputError> {
        let mut files = Vec::new();
        let mut parts = Vec::new();
        let mut picture = |name: &str, drawing: &Drawing| -> Result<(), OutputError> {
            let picture = drawing.draw()?;
            files.push(File::text(format!("{FOLDER}/{name}.svg"), picture.svg));
            files.push(File { path: format!("{FOLDER}/{name}.png"), bytes: picture.png });
            Ok(())
        };
        picture("speed-accuracy", &self.overview())?;
        picture("evaluators", &self.evaluators_drawing())?;
        for family in self.titles.keys() {
            picture(family, &self.family_drawing(family))?;
        }
        for (name, drawing) in curves::drawings(&self.curves) {
            picture(name, &drawing)?;
        }
        let mut part = |name: &str, text: String| parts.push((name.to_owned(), text));
        part("machine", self.machine());
        part("budgets", table(&self.budget_rows()));
        part("families", self.titles.keys().map(|family| self.family_section(family)).collect());
        part("evaluators", table(&self.evaluator_rows()));
        part("surfaces", table(&self.surface_rows()));
        files.push(File::text(format!("{FOLDER}.md"), fill(TEMPLATE, &parts)));
        files.push(File::text(format!("{FOLDER}/techniques.csv"), comma_separated(&self.data_rows())));
        files.push(File::text(format!("{FOLDER}/figures.json"), format!("{:#}\n", self.document())));
        Ok(files)
    }

    fn of<'a>(&'a self, family: &'a str) -> impl Iterator<Item = &'a Technique> {
        self.techniques.iter().filter(move |technique| technique.entry.family == family)
    }

    fn machine(&self) -> String {
        let effort = if self.quick { "one frame each, to see that it works" } else { "medians of at least 21 frames" };
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

    /// Every technique, families coloured.
    fn overview(&self) -> Drawing {
        let all: Vec<&Technique> = self.techniques.iter().collect();
        let mut series = vec![front_series(&all)];
        for (n, (family, title)) in self.titles.iter().enumerate() {
            let marks = self.of(family).map(|technique| mark(technique, technique.entry.name())).collect();
            series.push(marks_series(title.clone(), n, marks));
        }
        drawing("Speed and accuracy of every technique", &all, series, [1180.0, 780.0])
    }

    /// The techniques of a family; parameters of one technique are joined.
    fn family_drawing(&self, family: &str) -> Drawing {
        let all: Vec<&Technique> = self.of(family).collect();
        // Names stand at the marks: no legend, and more room for them.
        let mut series = vec![Series { label: String::new(), ..front_series(&all) }];
        let mut names: Vec<&str> = all.iter().map(|technique| technique.entry.technique.as_str()).collect();
        names.dedup();
        for (n, name) in names.iter().enumerate() {
            let own = all.iter().filter(|technique| technique.entry.technique == *name);
            let marks = own.map(|technique| mark(technique, technique.entry.name())).collect();
            let mut own = marks_series(String::new(), n, marks);
            own.join = Join::Solid;
            series.push(own);
        }
        drawing(self.titles.get(family).map_or(family, String::as_str), &all, series, [980.0, 560.0])
    }

    fn family_section(&self, family: &str) -> String {
        let title = self.titles.get(family).map_or(family, String::as_str);
        let accuracy: Vec<&Column> = COLUMNS[..ACCURACY].iter().collect();
        let cost: Vec<&Column> = COLUMNS[ACCURACY..COLUMNS.len() - 2].iter().collect();
        let rows = |columns: &[&Column]| {
            let heading = std::iter::once("technique").chain(columns.iter().map(|(name, _)| *name)).map(str::to_owned);
            let row = |technique: &Technique| {
                let cells = columns.iter().map(|(name, of)| match *name {
                    "ns" => spread(technique.time),
                    _ => number(of(technique)),
                });
                std::iter::once(technique.entry.name()).chain(cells).collect()
            };
            std::iter::once(heading.collect()).chain(self.of(family).map(row)).collect::<Vec<Vec<String>>>()
        };
        format!(
            "### {title}\n\n![{title}]({FOLDER}/{family}.png)\n\nHow exact, in 8-bit steps:\n\n{}\nAt what cost, per final pixel:\n\n{}\n\
             Where the error comes from, rms:\n\n{}\n",
            table(&rows(&accuracy)),
            table(&rows(&cost)),
            table(&self.cause_rows(family))
        )
    }

    /// What each cause adds to the error.
    fn cause_rows(&self, family: &str) -> Vec<Vec<String>> {
        let mut causes: Vec<&str> = Vec::new();
        for cause in self.of(family).flat_map(|technique| &technique.accuracy.causes) {
            if !causes.contains(&cause.name) {
                causes.push(cause.name);
            }
        }
        // Not every technique has normals that bytes hold: that cause comes first all the same.
        causes.sort_by_key(|name| usize::from(*name != "quantised normals"));
        let heading = ["technique"].into_iter().chain(causes.iter().copied()).chain(["normals off by, degrees"]);
        let row = |technique: &Technique| {
            let of = |name: &&str| {
                let cause = technique.accuracy.causes.iter().find(|cause| cause.name == *name);
                cause.map_or("-".to_owned(), |cause| number(cause.errors.rms()))
            };
            let normals = technique.accuracy.normals.as_ref();
            let degrees = normals.map_or("-".to_owned(), |normals| number(normals.degrees.mean()));
            std::iter::once(technique.entry.name()).chain(causes.iter().map(of)).chain([degrees]).collect()
        };
        std::iter::once(heading.map(str::to_owned).collect()).chain(self.of(family).map(row)).collect()
    }

    /// Of each light that there are several ways to, the fastest one within each budget.
    fn budget_rows(&self) -> Vec<Vec<String>> {
        let mut lights: Vec<Vec<&Technique>> = Vec::new();
        for technique in &self.techniques {
            let same = |light: &&mut Vec<&Technique>| {
                light.iter().all(|other| other.truth == technique.truth && other.entry.family == technique.entry.family)
            };
            match lights.iter_mut().find(same) {
                Some(light) => light.push(technique),
                None => lights.push(vec![technique]),
            }
        }
        lights.retain(|light| light.len() > 1);
        let heading = ["ways to the same light".to_owned(), "most exact".to_owned()]
            .into_iter()
            .chain(BUDGETS.iter().map(|budget| format!("rms up to {}", number(*budget))));
        let named = |technique: &Technique, of: fn(&Technique) -> f64, unit: &str| {
            format!("{} ({} {unit})", technique.entry.name(), number(of(technique)))
        };
        let row = |light: &Vec<&Technique>| {
            let names: Vec<String> = light.iter().map(|technique| technique.entry.name()).collect();
            let exact = light.iter().min_by(|a, b| rms(a).total_cmp(&rms(b)));
            let exact = exact.map_or(String::new(), |best| named(best, rms, "steps"));
            let fastest = |budget: &f64| {
                let within = light.iter().filter(|technique| rms(technique) <= *budget);
                let best = within.min_by(|a, b| a.time.median.total_cmp(&b.time.median));
                best.map_or("none".to_owned(), |best| named(best, |technique| technique.time.median, "ns"))
            };
            [names.join(", "), exact].into_iter().chain(BUDGETS.iter().map(fastest)).collect()
        };
        std::iter::once(heading.collect()).chain(lights.iter().map(row)).collect()
    }

    fn evaluator_rows(&self) -> Vec<Vec<String>> {
        let heading = ["evaluator", "surface", "ns per pixel", "rms error, steps", "largest", "what it yields"];
        let row = |e: &Evaluator| {
            let cells = [&e.name, &e.surface, &spread(e.time), &number(e.error), &number(e.largest), e.yields];
            cells.map(str::to_owned).to_vec()
        };
        std::iter::once(heading.map(str::to_owned).to_vec()).chain(self.evaluators.iter().map(row)).collect()
    }

    fn evaluators_drawing(&self) -> Drawing {
        let mut surfaces: Vec<&str> = self.evaluators.iter().map(|evaluator| evaluator.surface.as_str()).collect();
        surfaces.dedup();
        let series = surfaces.iter().enumerate().map(|(n, surface)| {
            let own = self.evaluators.iter().filter(|evaluator| evaluator.surface == *surface);
            let marks = own.map(|e| Mark { x: e.time.median, y: e.error, name: e.name.clone() }).collect();
            marks_series((*surface).to_owned(), n, marks)
        });
        let errors = self.evaluators.iter().map(|evaluator| evaluator.error);
        Drawing {
            title: "Ways of evaluating a scene".to_owned(),
            x: Axis::logarithmic("ns per pixel, one thread", self.evaluators.iter().map(|e| e.time.median)),
            y: Axis { low: -0.35, ..Axis::linear("rms error against the stored bytes, 8-bit steps", errors, true) },
            series: series.collect(),
            levels: Vec::new(),
            size: [1080.0, 460.0],
        }
    }

    fn surface_rows(&self) -> Vec<Vec<String>> {
        let heading = ["surface", "texels", "operations", "bytes", "ns, fast engine", "ns, definition"];
        let row = |s: &SurfaceCost| {
            let counts = [s.texels, s.operations, s.bytes].map(number);
            [s.name.clone()].into_iter().chain(counts).chain([s.fast, s.scalar].map(spread)).collect()
        };
        std::iter::once(heading.map(str::to_owned).to_vec()).chain(self.surfaces.iter().map(row)).collect()
    }

    fn data_rows(&self) -> Vec<Vec<String>> {
        let heading = ["family", "technique", "parameter"].into_iter().chain(COLUMNS.iter().map(|(name, _)| *name));
        let row = |technique: &Technique| {
            let entry = &technique.entry;
            let parameter = entry.parameter.map_or(String::new(), |parameter| parameter.to_string());
            let cells = COLUMNS.iter().map(|(_, of)| format!("{:.4}", of(technique)));
            [entry.family.clone(), entry.technique.clone(), parameter].into_iter().chain(cells).collect()
        };
        std::iter::once(heading.map(str::to_owned).collect()).chain(self.techniques.iter().map(row)).collect()
    }

    fn document(&self) -> Value {
        let technique = |technique: &Technique| {
            let mut value = accuracy_value(&technique.accuracy);
            let entry = &technique.entry;
            value["family"] = entry.family.as_str().into();
            value["technique"] = entry.technique.as_str().into();
            value["parameter"] = entry.parameter.into();
            value["nanoseconds_per_pixel"] = json!(technique.time);
            value
        };
        json!({
            "format": "ninebit-chart-1",
            "version": env!("CARGO_PKG_VERSION"),
            "isa": Isa::best().name(),
            "quick": self.quick,
            "techniques": self.techniques.iter().map(technique).collect::<Vec<Value>>(),
            "evaluators": self.evaluators,
            "surfaces": self.surfaces,
            "curves": self.curves,
            "failed": self.failed,
        })
    }
}

/// The error that charts show.
fn rms(technique: &Technique) -> f64 {
    technique.accuracy.errors.rms()
}

/// A median with the ends of the middle half.
fn spread(spread: Spread) -> String {
    format!("{} ({} to {})", number(spread.median), number(spread.lower), number(spread.upper))
}

fn mark(technique: &Technique, name: String) -> Mark {
    Mark { x: technique.time.median, y: rms(technique), name }
}

fn marks_series(label: String, n: usize, marks: Vec<Mark>) -> Series {
    let (color, shape) = (COLORS[n % COLORS.len()], Shape::ALL[n % Shape::ALL.len()]);
    Series { label, color, shape, join: Join::None, marks }
}

/// The techniques that nothing beats at both.
fn front_series(all: &[&Technique]) -> Series {
    let points: Vec<[f64; 2]> = all.iter().map(|technique| [technique.time.median, rms(technique)]).collect();
    let marks = front(&points).into_iter().map(|n| mark(all[n], String::new())).collect();
    let label = "nothing is faster and more exact".to_owned();
    Series { label, color: "#888888", shape: Shape::None, join: Join::Dashed, marks }
}

fn drawing(title: &str, all: &[&Technique], series: Vec<Series>, size: [f64; 2]) -> Drawing {
    Drawing {
        title: title.to_owned(),
        x: Axis::logarithmic(TIME, all.iter().map(|technique| technique.time.median)),
        y: Axis::logarithmic(ERROR, all.iter().map(|technique| rms(technique))),
        series,
        levels: Vec::new(),
        size,
    }
}
