//! The page of the sweeps: prose of `page.md`, with what was measured in its places.

use serde::Serialize;

use super::{Sweep, Threshold, sweeps, threshold};
use crate::chart::page::{File, comma_separated, fill, number, plain, table};
use crate::chart::picture::{Axis, COLORS, Drawing, Join, Mark, Series, Shape};
use ninebit_files::output::OutputError;
use ninebit_scene::SceneError;

/// The prose.
const TEMPLATE: &str = include_str!("page.md");
/// The folder of the files, beside the page.
const FOLDER: &str = "stability";

/// What a sweep yielded.
#[derive(Debug)]
pub struct Measured {
    /// The sweep.
    pub sweep: Sweep,
    /// The errors of each method at the values that are shown.
    pub curves: Vec<Vec<f64>>,
    /// Where each method stops working.
    pub thresholds: Vec<Threshold>,
}

/// Runs every sweep. `progress` is told how many of how many methods are done.
///
/// # Errors
/// A scene of a sweep is not accepted: a fault of the sweep.
pub fn measure(progress: &dyn Fn(usize, usize)) -> Result<Vec<Measured>, Box<SceneError>> {
    let sweeps = sweeps();
    let total = sweeps.iter().map(|sweep| sweep.methods.len()).sum();
    let mut done = 0;
    let mut all = Vec::with_capacity(sweeps.len());
    for sweep in sweeps {
        let (mut curves, mut thresholds) = (Vec::new(), Vec::new());
        for method in &sweep.methods {
            progress(done, total);
            curves.push(sweep.shown.iter().map(|value| (method.measure)(*value)).collect::<Result<_, _>>()?);
            thresholds.push(threshold(&sweep, method)?);
            done += 1;
        }
        all.push(Measured { sweep, curves, thresholds });
    }
    progress(done, total);
    Ok(all)
}

/// The section of the page, and the files that it shows.
///
/// # Errors
/// A picture cannot be encoded.
pub fn files(all: &[Measured]) -> Result<(String, Vec<File>), OutputError> {
    let (mut parts, mut files) = (Vec::new(), Vec::new());
    for measured in all {
        let sweep = &measured.sweep;
        let path = format!("{FOLDER}/{}.svg", sweep.name);
        files.push(File::text(path.clone(), drawing(measured).draw()?.svg));
        let text = format!("![{}]({path})\n\n{}", sweep.title, table(&measured.rows()));
        parts.push((sweep.name.to_owned(), text));
        parts.push((format!("{}.limit", sweep.name), plain(sweep.limit)));
        for (n, (method, threshold)) in sweep.methods.iter().zip(&measured.thresholds).enumerate() {
            let (works, fails) = threshold.ends(method);
            parts.push((format!("{}.{n}.works", sweep.name), works.map_or("nowhere".to_owned(), plain)));
            parts.push((format!("{}.{n}.fails", sweep.name), fails.map_or("nowhere".to_owned(), plain)));
        }
    }
    files.push(File::text(format!("{FOLDER}/curves.csv"), comma_separated(&curve_rows(all))));
    let document: Vec<Record> = all.iter().map(Record::of).collect();
    files.push(File::text(
        format!("{FOLDER}/thresholds.json"),
        serde_json::to_string_pretty(&document).unwrap_or_default() + "\n",
    ));
    Ok((fill(TEMPLATE, &parts), files))
}

impl Measured {
    /// The table of the thresholds.
    fn rows(&self) -> Vec<Vec<String>> {
        let works = format!("{}: works at", self.sweep.parameter);
        let heading = vec!["method".to_owned(), works, "fails at".to_owned()];
        let mut rows = vec![heading];
        for (method, threshold) in self.sweep.methods.iter().zip(&self.thresholds) {
            let (works, fails) = threshold.ends(method);
            let works = works.map_or("nowhere".to_owned(), plain);
            rows.push(vec![method.name.clone(), works, fails.map_or("holds".to_owned(), plain)]);
        }
        rows
    }
}

fn curve_rows(all: &[Measured]) -> Vec<Vec<String>> {
    let mut rows = vec![["sweep", "method", "parameter", "value", "error", "unit"].map(str::to_owned).to_vec()];
    for Measured { sweep, curves, .. } in all {
        for (method, curve) in sweep.methods.iter().zip(curves) {
            for (value, error) in sweep.shown.iter().zip(curve) {
                let cells = [sweep.name, &method.name, sweep.parameter, &plain(*value), &number(*error), sweep.error];
                rows.push(cells.map(str::to_owned).to_vec());
            }
        }
    }
    rows
}

/// The picture of a sweep.
pub fn drawing(measured: &Measured) -> Drawing {
    let Measured { sweep, curves, .. } = measured;
    let series = sweep.methods.iter().zip(curves).enumerate().map(|(n, (method, curve))| Series {
        label: method.name.clone(),
        color: COLORS[n % COLORS.len()],
        shape: if sweep.shown.len() <= 24 { Shape::ALL[n % Shape::ALL.len()] } else { Shape::None },
        join: Join::Solid,
        marks: sweep.shown.iter().zip(curve).map(|(x, y)| Mark { x: *x, y: *y, name: String::new() }).collect(),
    });
    let errors = || curves.iter().flatten().copied().chain([sweep.limit]);
    let wide = match sweep.shown[..] {
        [first, .., last] => first > 0.0 && last / first > 30.0,
        _ => false,
    };
    let x = match sweep.shown[..] {
        [low, .., high] if wide => {
            Axis { label: sweep.parameter.to_owned(), low: low / 1.04, high: high * 1.04, logarithmic: true }
        }
        _ => Axis::linear(sweep.parameter, sweep.shown.iter().copied(), false),
    };
    Drawing {
        title: sweep.title.to_owned(),
        x,
        y: Axis::linear(sweep.error, errors(), true),
        series: series.collect(),
        levels: vec![(sweep.limit, format!("limit {}", plain(sweep.limit)))],
        size: [860.0, 380.0],
    }
}

/// A sweep for programs.
#[derive(Serialize)]
struct Record {
    sweep: &'static str,
    parameter: &'static str,
    error: &'static str,
    limit: f64,
    methods: Vec<MethodRecord>,
}

#[derive(Serialize)]
struct MethodRecord {
    method: String,
    /// `None`: it works nowhere.
    works: Option<f64>,
    /// `None`: it works everywhere.
    fails: Option<f64>,
}

impl Record {
    fn of(measured: &Measured) -> Record {
        let Sweep { name, parameter, error, limit, ref methods, .. } = measured.sweep;
        let methods = methods.iter().zip(&measured.thresholds).map(|(method, threshold)| {
            let (works, fails) = threshold.ends(method);
            MethodRecord { method: method.name.clone(), works, fails }
        });
        Record { sweep: name, parameter, error, limit, methods: methods.collect() }
    }
}
