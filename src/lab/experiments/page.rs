//! The page of the experiments: the template `page.md`, filled in with measurements.

use serde::Serialize;

use super::{Experiment, Method, Outcome, Threshold, experiments, threshold};
use crate::chart::page::{File, comma_separated, fill, number, plain, table};
use crate::chart::picture::{Axis, COLORS, Drawing, Image, SHAPES, Series};
use ninebit_files::output::OutputError;
use ninebit_scene::SceneError;

/// The section's template.
const TEMPLATE: &str = include_str!("page.md");
/// Name of the folder of the page's files, beside it.
const FOLDER: &str = "stability";

/// Measurements of an experiment.
#[derive(Debug)]
pub struct Measurement {
    /// The experiment that was measured.
    pub experiment: Experiment,
    /// Errors of each method at the values that the chart shows.
    pub curves: Vec<Vec<f64>>,
    /// Threshold of each method.
    pub thresholds: Vec<Threshold>,
    /// Method and value of the parameter of the chart's picture, and what is drawn there.
    worst: (usize, f64, Outcome),
}

/// Runs all experiments. Calls `progress` with the number of finished methods and their total.
///
/// # Errors
/// Returns an error if a scene is not valid, which is a fault of the experiment.
pub fn measure(progress: &dyn Fn(usize, usize)) -> Result<Vec<Measurement>, Box<SceneError>> {
    let experiments = experiments();
    let total = experiments.iter().map(|experiment| experiment.methods.len()).sum();
    let mut done = 0;
    let mut all = Vec::with_capacity(experiments.len());
    for experiment in experiments {
        let (mut curves, mut thresholds) = (Vec::new(), Vec::new());
        for method in &experiment.methods {
            progress(done, total);
            let error = |value: &f64| (method.measure)(*value).map(|outcome| outcome.error);
            curves.push(experiment.shown.iter().map(error).collect::<Result<_, _>>()?);
            thresholds.push(threshold(&experiment, method)?);
            done += 1;
        }
        let worst = worst(&experiment, &curves, &thresholds)?;
        all.push(Measurement { experiment, curves, thresholds, worst });
    }
    progress(done, total);
    Ok(all)
}

/// Returns the methods, the one that holds longest first.
fn ranked(methods: &[Method], thresholds: &[Threshold]) -> Vec<usize> {
    let share = |n: usize| match thresholds[n] {
        Threshold::Between { works, .. } => {
            let Method { works: from, fails: to, .. } = methods[n];
            (works - from) / (to - from)
        }
        Threshold::Holds => 1.0,
        Threshold::Fails => 0.0,
    };
    let mut order: Vec<usize> = (0..methods.len()).collect();
    order.sort_by(|a, b| share(*b).total_cmp(&share(*a)));
    order
}

/// Returns the method that fails first, and what it draws where it is furthest off.
fn worst(
    experiment: &Experiment,
    curves: &[Vec<f64>],
    thresholds: &[Threshold],
) -> Result<(usize, f64, Outcome), Box<SceneError>> {
    let method = ranked(&experiment.methods, thresholds).last().copied().unwrap_or_default();
    let errors = experiment.shown.iter().zip(&curves[method]);
    let value = errors.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0.0, |(value, _)| *value);
    Ok((method, value, (experiment.methods[method].measure)(value)?))
}

/// Returns the section of the page, and the files that it links to.
///
/// # Errors
/// Returns an error if a picture cannot be encoded.
pub fn files(all: &[Measurement]) -> Result<(String, Vec<File>), OutputError> {
    let (mut parts, mut files) = (Vec::new(), Vec::new());
    for measured in all {
        let experiment = &measured.experiment;
        let path = format!("{FOLDER}/{}.svg", experiment.name);
        files.push(File::text(path.clone(), drawing(measured).svg()?));
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
    Ok((fill(TEMPLATE, &parts), files))
}

impl Measurement {
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
fn curve_rows(all: &[Measurement]) -> Vec<Vec<String>> {
    let mut rows = vec![["sweep", "method", "value", "error"].map(str::to_owned).to_vec()];
    for Measurement { experiment, curves, .. } in all {
        for (method, curve) in experiment.methods.iter().zip(curves) {
            for (value, error) in experiment.shown.iter().zip(curve) {
                let cells = [experiment.name, &method.name, &plain(*value), &number(*error)];
                rows.push(cells.map(str::to_owned).to_vec());
            }
        }
    }
    rows
}

/// Returns the chart of an experiment. Colours have an order: the first is that of the method that holds longest, the second that of the one that
/// fails first.
fn drawing(measured: &Measurement) -> Drawing {
    let Measurement { experiment, curves, thresholds, worst: (first, value, outcome) } = measured;
    let order = ranked(&experiment.methods, thresholds);
    let series = order.iter().enumerate().map(|(rank, n)| {
        let color = match rank {
            0 => 0,
            rank if rank + 1 == order.len() => 1,
            rank => rank + 1,
        };
        Series {
            label: experiment.methods[*n].name.clone(),
            color: COLORS[color % COLORS.len()],
            shape: (experiment.shown.len() <= 24).then(|| SHAPES[color % SHAPES.len()]),
            points: experiment.shown.iter().zip(&curves[*n]).map(|(x, y)| [*x, *y]).collect(),
        }
    });
    let image = |row: &[u8]| Image { width: row.len(), pixels: row.iter().map(|byte| [*byte; 3]).collect() };
    let pictures = vec![
        (format!("Exact, at {}", plain(*value)), image(&outcome.exact)),
        (format!("Drawn: {}", experiment.methods[*first].name), image(&outcome.drawn)),
    ];
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
        levels: vec![(experiment.limit, format!("fails above {}", plain(experiment.limit)))],
        pictures,
        size: [940.0, 380.0],
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
    fn from_measured(measured: &Measurement) -> Record {
        let Experiment { name, parameter, error, limit, ref methods, .. } = measured.experiment;
        let methods = methods.iter().zip(&measured.thresholds).map(|(method, threshold)| {
            let (works, fails) = threshold.ends(method);
            MethodRecord { method: method.name.clone(), works, fails }
        });
        Record { experiment: name, parameter, error, limit, methods: methods.collect() }
    }
}
