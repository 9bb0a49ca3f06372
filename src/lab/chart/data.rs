//! The measurements as data: a table as comma-separated values, and everything as one JSON document.

use serde::Deserialize;
use serde_json::{Value, json};

use super::curves::Curve;
use super::evaluators::Evaluator;
use super::page::row;
use super::questions::Light;
use super::report::Measurements;
use super::surfaces::SurfaceCost;
use super::tables::{cause, causes, degrees};
use super::techniques::{Entry, Technique};
use super::timing::Spread;
use crate::accuracy::{FrameCost, HardwareCost, accuracy_value};
use ninebit::shown;

/// A column: its name, its meaning, and the function to its value, which may be empty.
struct Column {
    name: String,
    meaning: String,
    of: Box<dyn Fn(&Technique) -> String>,
}

/// A column of the costs: its name, its meaning, and the function to its value.
type Count = (&'static str, &'static str, fn(&FrameCost) -> f64);

const COUNTS: [Count; 10] = [
    ("passes", "draws, a whole number", |cost| cost.passes as f64),
    ("most_stages", "the most general stages of a pass, a whole number", |cost| cost.most_stages as f64),
    ("most_units", "the most texture units of a pass, a whole number", |cost| cost.most_units as f64),
    ("stages", "general stages run, per final pixel", |cost| cost.stages),
    ("fetches", "texture units read, per final pixel", |cost| cost.fetches),
    ("blends", "fragments blended with the frame buffer, per final pixel", |cost| cost.blends),
    ("fragments", "fragments of all passes, per final pixel", |cost| cost.fragments),
    ("texels", "texels looked up, per final pixel", |cost| cost.texels),
    ("products", "products of combiners, per final pixel", |cost| cost.products),
    ("frame_buffer_bytes", "bytes of colour read and written, per final pixel", |cost| cost.frame_buffer_bytes),
];

impl Measurements {
    /// Returns the columns after those that identify the technique.
    fn columns(&self) -> Vec<Column> {
        let mut all = Vec::new();
        let mut add = |name: &str, meaning: &str, of: Box<dyn Fn(&Technique) -> String>| {
            all.push(Column { name: name.to_owned(), meaning: meaning.to_owned(), of });
        };
        add("rms", "root mean square of the error, 8-bit steps", Box::new(|t| real(t.rms())));
        add("max", "largest error, steps", Box::new(|t| real(t.accuracy.errors.max())));
        add("bias", "mean error with its sign, steps", Box::new(|t| real(t.accuracy.errors.bias())));
        add("psnr_db", "20 log10(255 / rms); empty if nothing is off", Box::new(|t| real(t.accuracy.errors.psnr())));
        add("levels", "different bytes over the highlight", Box::new(|t| t.accuracy.banding.levels.to_string()));
        add("truth_levels", "those of the truth, rounded", Box::new(|t| t.accuracy.banding.truth_levels.to_string()));
        add("flat_run", "longest row of equal pixels there", Box::new(|t| t.accuracy.banding.flat_run.to_string()));
        let turned = |t: &Technique| degrees(t).map_or_else(String::new, real);
        add("degrees", "mean angle by which normals are turned; empty if not measured", Box::new(turned));
        for name in causes(self.techniques.iter()) {
            let meaning = format!("what {name} adds to the error, rms; empty if it has no part in it");
            let of = move |t: &Technique| cause(t, name).map_or_else(String::new, real);
            add(&format!("cause_{}", name.replace(' ', "_")), &meaning, Box::new(of));
        }
        type Of = fn(&HardwareCost) -> &FrameCost;
        let costs: [(&str, &str, Of); 2] =
            [("asked", "as the program asks", |cost| &cost.asked), ("pruned", "after pruning", |cost| &cost.pruned)];
        for (when, about, cost) in costs {
            for (name, meaning, of) in COUNTS {
                let of = move |t: &Technique| real(of(cost(&t.accuracy.cost)));
                add(&format!("{when}_{name}"), &format!("{about}: {meaning}"), Box::new(of));
            }
        }
        let about = "nanoseconds per final pixel here, median; one thread, 512 columns";
        add("ns", about, Box::new(|t| real(t.time.median)));
        add("ns_lower", "a quarter of the frames took less", Box::new(|t| real(t.time.lower)));
        add("ns_upper", "a quarter took more", Box::new(|t| real(t.time.upper)));
        all
    }

    /// Returns a heading and one row per technique.
    pub(super) fn data_rows(&self, lights: &[Light<'_>]) -> Vec<Vec<String>> {
        let columns = self.columns();
        let heading = ["family", "technique", "parameter", "title", "truth"].into_iter().map(str::to_owned);
        let row = |technique: &Technique| {
            let entry = &technique.entry;
            let parameter = entry.parameter.map_or_else(String::new, |parameter| parameter.to_string());
            let truth = meant(lights, entry).unwrap_or_default().to_owned();
            let cells = columns.iter().map(|column| (column.of)(technique));
            [entry.family.clone(), entry.technique.clone(), parameter, technique.title.clone(), truth]
                .into_iter()
                .chain(cells)
                .collect()
        };
        let heading = heading.chain(columns.iter().map(|column| column.name.clone())).collect();
        std::iter::once(heading).chain(self.techniques.iter().map(row)).collect()
    }

    /// Returns the table that explains the columns.
    pub(super) fn column_rows(&self) -> Vec<Vec<String>> {
        let fixed = [
            ["column", "what it holds"],
            ["`family`", "the folder of the scene"],
            ["`technique`", "its file's name without the parameter"],
            ["`parameter`", "the number that the name ends in; empty if there is none"],
            ["`title`", "the technique's name"],
            ["`truth`", "which light was meant: techniques of one truth are ways to the same picture"],
        ];
        let columns = self.columns().into_iter().map(|column| vec![format!("`{}`", column.name), column.meaning]);
        fixed.iter().map(|cells| row(cells)).chain(columns).collect()
    }

    /// Returns all measurements of the page as one JSON document, with at most nine significant digits.
    pub(super) fn document(&self, lights: &[Light<'_>]) -> Value {
        let technique = |technique: &Technique| {
            let mut value = accuracy_value(&technique.accuracy);
            let entry = &technique.entry;
            value["family"] = entry.family.as_str().into();
            value["technique"] = entry.technique.as_str().into();
            value["parameter"] = entry.parameter.into();
            value["title"] = technique.title.as_str().into();
            value["truth"] = meant(lights, entry).into();
            value["nanoseconds_per_pixel"] = json!(technique.time);
            value
        };
        let mut document = json!({
            "format": FORMAT,
            "version": env!("CARGO_PKG_VERSION"),
            "isa": self.isa,
            "quick": self.quick,
            "techniques": self.techniques.iter().map(technique).collect::<Vec<Value>>(),
            "evaluators": self.evaluators,
            "surfaces": self.surfaces,
            "curves": self.curves,
            "failed": self.failed,
        });
        shorten(&mut document);
        document
    }
}

/// Value of `format` in the document.
const FORMAT: &str = "ninebit-chart-2";

/// Everything in a document that takes a clock to measure.
#[derive(Debug, Deserialize)]
pub struct Times {
    format: String,
    /// Instruction set of the machine.
    pub isa: String,
    /// Whether only few frames were timed.
    pub quick: bool,
    techniques: Vec<TechniqueTime>,
    /// Evaluators, those that were measured elsewhere included.
    pub evaluators: Vec<Evaluator>,
    /// Costs of surfaces.
    pub surfaces: Vec<SurfaceCost>,
    /// Cost curves.
    pub curves: Vec<Curve>,
}

#[derive(Debug, Deserialize)]
struct TechniqueTime {
    family: String,
    technique: String,
    parameter: Option<u32>,
    nanoseconds_per_pixel: Spread,
}

impl Times {
    /// Reads a document that [`Measurements`] wrote.
    ///
    /// # Errors
    /// Returns a message if it is no such document.
    pub fn parse(text: &[u8]) -> Result<Times, String> {
        let times: Times = serde_json::from_slice(text).map_err(|error| error.to_string())?;
        if times.format == FORMAT { Ok(times) } else { Err(format!("its format is not `{FORMAT}`")) }
    }

    /// Returns the time of a technique.
    ///
    /// # Errors
    /// Returns a message if the document has none.
    pub fn spread_of(&self, entry: &Entry) -> Result<Spread, String> {
        let is = |time: &&TechniqueTime| {
            (&time.family, &time.technique, time.parameter) == (&entry.family, &entry.technique, entry.parameter)
        };
        let found = self.techniques.iter().find(is).map(|time| time.nanoseconds_per_pixel);
        found.ok_or_else(|| {
            format!("it has no time of `{}` in `{}`", shown::name(&entry.name()), shown::name(&entry.family))
        })
    }
}

/// Rounds all numbers that are not whole to nine significant digits: more than any measurement has, and half as long.
fn shorten(value: &mut Value) {
    match value {
        Value::Array(values) => values.iter_mut().for_each(shorten),
        Value::Object(values) => values.values_mut().for_each(shorten),
        Value::Number(number) if number.is_f64() => {
            let rounded = number.as_f64().and_then(|number| format!("{number:.8e}").parse::<f64>().ok());
            *value = json!(rounded);
        }
        _ => {}
    }
}

/// Returns the name of the light that a scene approximates.
fn meant<'l>(lights: &'l [Light<'_>], entry: &Entry) -> Option<&'l str> {
    let light = lights.iter().find(|light| light.ways.iter().any(|way| way.entry == *entry));
    light.map(|light| light.name.as_str())
}

/// Formats a number with at most four decimals, and without any if it is whole. Numbers that are not finite become empty.
fn real(value: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::real;

    #[test]
    fn whole_numbers_have_no_decimals() {
        assert_eq!(
            [12.0, 0.5, 1.23456, -0.25, 0.0, f64::INFINITY].map(real),
            ["12", "0.5", "1.2346", "-0.25", "0", ""]
        );
    }
}
