//! The page of the experiments: the template `page.md`, filled in with measurements.

use serde::Serialize;

use super::{Experiment, Threshold, experiments, threshold};
use crate::chart::page::{File, comma_separated, fill, number, plain, table};
use crate::chart::picture::{Axis, COLORS, Drawing, Join, Mark, SHAPES, Series};
use ninebit_scene::SceneError;

/// The section's template.
const TEMPLATE: &str = include_str!("page.md");
/// Name of the folder of the page's files, beside it.
const FOLDER: &str = "stability";

/// Measurements of an experiment.
#[derive(Debug)]
pub struct Measured {
    /// The experiment that was measured.
    pub experiment: Experiment,
    /// Errors of each method at the values that the chart shows.
    pub curves: Vec<Vec<f64>>,
    /// Threshold of each method.
    pub thresholds: Vec<Threshold>,
}

/// Runs all experiments. Calls `progress` with the number of finished methods and their total.
///
/// # Errors
/// Returns an error if a scene is not valid, which is a fault of the experiment.
pub fn measure(progress: &dyn Fn(usize, usize)) -> Result<Vec<Measured>, Box<SceneError>> {
    let experiments = experiments();
    let total = experiments.iter().map(|experiment| experiment.methods.len()).sum();
    let mut done = 0;
    let mut all = Vec::with_capacity(experiments.len());
    for experiment in experiments {
        let (mut curves, mut thresholds) = (Vec::new(), Vec::new());
        for method in &experiment.methods {
            progress(done, total);
            curves.push(experiment.shown.iter().map(|value| (method.measure)(*value)).collect::<Result<_, _>>()?);
            thresholds.push(threshold(&experiment, method)?);
            done += 1;
        }
        all.push(Measured { experiment, curves, thresholds });
    }
    progress(done, total);
    Ok(all)
}

/// Returns the section of the page, and the files that it links to.
pub fn files(all: &[Measured]) -> (String, Vec<File>) {
    let (mut parts, mut files) = (Vec::new(), Vec::new());
    for measured in all {
        let experiment = &measured.experiment;
        let path = format!("{FOLDER}/{}.svg", experiment.name);
        files.push(File::text(path.clone(), drawing(measured).svg()));
        let text = format!("![{}]({path})\n\n{}", experiment.title, table(&measured.rows()));
        parts.push((experiment.name.to_owned(), text));
        parts.push((format!("{}.limit", experiment.name), plain(experiment.limit)));
        for (n, (method, threshold)) in experiment.methods.iter().zip(&measured.thresholds).enumerate() {
            let (works, fails) = threshold.ends(method);
            parts.push((format!("{}.{n}.works", experiment.name), works.map_or("nowhere".to_owned(), plain)));
            parts.push((format!("{}.{n}.fails", experiment.name), fails.map_or("nowhere".to_owned(), plain)));
        }
    }
    files.push(File::text(format!("{FOLDER}/curves.csv"), comma_separated(&curve_rows(all))));
    let document: Vec<Record> = all.iter().map(Record::from_measured).collect();
    files.push(File::text(
        format!("{FOLDER}/thresholds.json"),
        serde_json::to_string_pretty(&document).unwrap_or_default() + "\n",
    ));
    (fill(TEMPLATE, &parts), files)
}

impl Measured {
    /// Returns the table of the thresholds.
    fn rows(&self) -> Vec<Vec<String>> {
        let works = format!("{}: works at", self.experiment.parameter);
        let heading = vec!["method".to_owned(), works, "fails at".to_owned()];
        let mut rows = vec![heading];
        for (method, threshold) in self.experiment.methods.iter().zip(&self.thresholds) {
            let (works, fails) = threshold.ends(method);
            let works = works.map_or("nowhere".to_owned(), plain);
            rows.push(vec![method.name.clone(), works, fails.map_or("holds".to_owned(), plain)]);
        }
        rows
    }
}

/// Returns the points of all curves. What a sweep changes and the unit of its errors stand in `thresholds.json`.
fn curve_rows(all: &[Measured]) -> Vec<Vec<String>> {
    let mut rows = vec![["sweep", "method", "value", "error"].map(str::to_owned).to_vec()];
    for Measured { experiment, curves, .. } in all {
        for (method, curve) in experiment.methods.iter().zip(curves) {
            for (value, error) in experiment.shown.iter().zip(curve) {
                let cells = [experiment.name, &method.name, &plain(*value), &number(*error)];
                rows.push(cells.map(str::to_owned).to_vec());
            }
        }
    }
    rows
}

/// Returns the chart of an experiment.
fn drawing(measured: &Measured) -> Drawing {
    let Measured { experiment, curves, .. } = measured;
    let series = experiment.methods.iter().zip(curves).enumerate().map(|(n, (method, curve))| Series {
        label: method.name.clone(),
        color: COLORS[n % COLORS.len()],
        shape: (experiment.shown.len() <= 24).then(|| SHAPES[n % SHAPES.len()]),
        join: Join::Solid,
        marks: experiment.shown.iter().zip(curve).map(|(x, y)| Mark { x: *x, y: *y, name: String::new() }).collect(),
    });
    let errors = || curves.iter().flatten().copied().chain([experiment.limit]);
    let x = match experiment.shown[..] {
        [low, .., high] if low > 0.0 && high / low > 30.0 => {
            Axis { label: experiment.parameter.to_owned(), low: low / 1.04, high: high * 1.04, logarithmic: true }
        }
        _ => Axis::linear(experiment.parameter, experiment.shown.iter().copied(), false),
    };
    Drawing {
        title: experiment.title.to_owned(),
        x,
        y: Axis::linear(experiment.error, errors(), true),
        series: series.collect(),
        levels: vec![(experiment.limit, format!("limit {}", plain(experiment.limit)))],
        size: [860.0, 380.0],
    }
}

/// An experiment as JSON.
#[derive(Serialize)]
struct Record {
    #[serde(rename = "sweep")]
    experiment: &'static str,
    parameter: &'static str,
    error: &'static str,
    limit: f64,
    methods: Vec<MethodRecord>,
}

#[derive(Serialize)]
struct MethodRecord {
    method: String,
    /// Last value at which it works; `None` if it works nowhere.
    works: Option<f64>,
    /// First value at which it fails; `None` if it works everywhere.
    fails: Option<f64>,
}

impl Record {
    fn from_measured(measured: &Measured) -> Record {
        let Experiment { name, parameter, error, limit, ref methods, .. } = measured.experiment;
        let methods = methods.iter().zip(&measured.thresholds).map(|(method, threshold)| {
            let (works, fails) = threshold.ends(method);
            MethodRecord { method: method.name.clone(), works, fails }
        });
        Record { experiment: name, parameter, error, limit, methods: methods.collect() }
    }
}
