//! The evaluators of a scene: their speed, and their deviation from the stored bytes.

use serde::{Deserialize, Serialize};

use super::surfaces::Surface;
use super::timing::{Effort, Spread, frames};
use ninebit::engine::{self, Engine, Isa, RenderOptions, render};
use ninebit::number::Ideal;
use ninebit::plan::Plan;
use ninebit::shown;
use ninebit::state::Named;
use ninebit_report::compare::{CompareOptions, Mode, Statistics, compare, real_frame};
use ninebit_scene::SceneError;

/// A way of evaluating a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evaluator {
    /// Name in tables.
    pub name: String,
    /// Name of the surface that is drawn.
    pub surface: String,
    /// Description of its results.
    pub yields: String,
    /// Nanoseconds per pixel on one thread.
    pub time: Spread,
    /// Root mean square error of R, G, B against the stored bytes, in steps of 1/255.
    pub error: f64,
    /// Largest such error.
    pub largest: f64,
}

/// A JSON document of evaluators that were measured elsewhere.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: String,
    evaluators: Vec<Evaluator>,
}

/// Value of `format` in such a document.
const FORMAT: &str = "ninebit-evaluators-1";

/// Parses a JSON document of evaluators that were measured elsewhere: `format` and a list of [`Evaluator`].
///
/// # Errors
/// Returns a message if the document is not valid: its notation, a field, an empty name, or a number that no measurement yields.
pub fn parse(text: &[u8]) -> Result<Vec<Evaluator>, String> {
    let document: Document = serde_json::from_slice(text).map_err(|error| error.to_string())?;
    if document.format != FORMAT {
        return Err(format!("its format is not `{FORMAT}`"));
    }
    for evaluator in &document.evaluators {
        let Evaluator { name, error, largest, time, .. } = evaluator;
        let times = [time.lower, time.median, time.upper];
        if name.is_empty() {
            return Err("an evaluator has no name".to_owned());
        }
        if !(0.0..=255.0).contains(error) || !(0.0..=255.0).contains(largest) {
            return Err(format!("`{}`: errors are steps from 0 to 255", shown::name(name)));
        }
        if !times.iter().all(|time| *time > 0.0) || !times.is_sorted() {
            return Err(format!("`{}`: times are above 0 and in ascending order", shown::name(name)));
        }
    }
    Ok(document.evaluators)
}

/// Returns the surfaces that evaluators are timed on, by name.
fn workloads() -> [(&'static str, Surface); 2] {
    let lit = Surface { stages: 1, units: 1, filtered: true, ..Surface::default() };
    [
        ("one unit, one stage", lit),
        ("two units, two stages, blend", Surface { stages: 2, units: 2, alpha: true, blend: true, ..lit }),
    ]
}

/// Times every evaluator. Calls `progress` after each.
///
/// # Errors
/// Returns an error if a surface's scene is not valid, which is a fault of its template.
pub fn measure(side: usize, effort: &Effort, progress: &dyn Fn()) -> Result<Vec<Evaluator>, Box<SceneError>> {
    let mut all = Vec::new();
    for (surface, state) in workloads() {
        let plan = state.plan(side)?;
        let definition = rendered(&plan, &RenderOptions { engine: Engine::Scalar, ..RenderOptions::default() });
        let pixels = plan.draws().iter().map(|draw| engine::fragments(&plan, draw)).sum::<u64>().max(1);
        let mut add = |name: String, yields: &str, time, errors: Statistics| {
            let (error, largest) = (errors.rms(), errors.max());
            all.push(Evaluator { name, surface: surface.to_owned(), yields: yields.to_owned(), time, error, largest });
            progress();
        };
        for isa in Isa::ALL.iter().rev().filter(|isa| isa.is_available()) {
            let options = RenderOptions { isa: Some(*isa), ..RenderOptions::default() };
            let name = format!("fast, {}", isa.name());
            let errors = against(&definition, &rendered(&plan, &options));
            add(name, "the stored bytes", frames(&plan, &options, pixels, effort), errors);
        }
        let scalar = RenderOptions { engine: Engine::Scalar, ..RenderOptions::default() };
        let time = frames(&plan, &scalar, pixels, effort);
        add("scalar".to_owned(), "the stored bytes", time, against(&definition, &definition));
        let (time, errors) = traced(&plan, &definition, side, effort);
        add("traced".to_owned(), "every integer of each pixel", time, errors);
        let (time, errors) = real::<f32>(&plan, &definition, pixels, effort);
        add("float32".to_owned(), "real numbers, single precision", time, errors);
        let (time, errors) = real::<f64>(&plan, &definition, pixels, effort);
        add("float64".to_owned(), "real numbers, double precision", time, errors);
        for mode in Mode::ALL {
            let options = CompareOptions { mode: *mode, target: 0, threads: 1, channels: 15 };
            let time = effort.measure(pixels, || drop(compare(&plan, &options)));
            add(
                format!("compare {}", mode.name()),
                "the stored bytes, float64 and their differences",
                time,
                Statistics::default(),
            );
        }
    }
    Ok(all)
}

/// Returns the number of evaluators that [`measure`] times.
pub fn count() -> usize {
    let widths = Isa::ALL.iter().filter(|isa| isa.is_available()).count();
    workloads().len() * (widths + 4 + Mode::ALL.len())
}

/// Returns R, G, B of the pixels that an engine stores.
fn rendered(plan: &Plan, options: &RenderOptions) -> Vec<[f64; 3]> {
    let bytes = render(plan, options).surfaces.first().map(ninebit::frame::Surface::rgba8).unwrap_or_default();
    bytes.iter().map(|[r, g, b, _]| [*r, *g, *b].map(f64::from)).collect()
}

/// Returns the errors against the definition's bytes, without NaN.
fn against(definition: &[[f64; 3]], frame: &[[f64; 3]]) -> Statistics {
    let mut errors = Statistics::default();
    for (byte, value) in definition.iter().flatten().zip(frame.iter().flatten()).filter(|(_, value)| !value.is_nan()) {
        errors.add(value - byte);
    }
    errors
}

/// Measures the ideal in a lane of real numbers.
fn real<L: Ideal + Send + Sync>(
    plan: &Plan,
    definition: &[[f64; 3]],
    pixels: u64,
    effort: &Effort,
) -> (Spread, Statistics) {
    let time = effort.measure(pixels, || drop(real_frame::<L>(plan, 0, 1)));
    let colors = |pixel: &Option<[L; 4]>| pixel.map_or([f64::NAN; 3], |[r, g, b, _]| [r, g, b].map(L::real));
    let frame: Vec<[f64; 3]> = real_frame::<L>(plan, 0, 1).iter().map(colors).collect();
    (time, against(definition, &frame))
}

/// Measures traces of pixels that are spread over the frame.
fn traced(plan: &Plan, definition: &[[f64; 3]], side: usize, effort: &Effort) -> (Spread, Statistics) {
    /// Number of traced pixels along each side.
    const GRID: usize = 8;
    let along = |k: usize| ((k * side + side / 2) / GRID) as u32;
    let places: Vec<(u32, u32)> = (0..GRID * GRID).map(|n| (along(n % GRID), along(n / GRID))).collect();
    let trace = |place: &(u32, u32)| engine::trace(plan, 0, *place, None);
    let time = effort.measure(places.len() as u64, || places.iter().for_each(|place| drop(trace(place))));
    let mut errors = Statistics::default();
    for place in &places {
        let Ok(pixel) = trace(place) else { continue };
        let Some(bytes) = definition.get(place.1 as usize * side + place.0 as usize) else { continue };
        bytes.iter().zip(pixel.shown).for_each(|(byte, shown)| errors.add(f64::from(shown) - byte));
    }
    (time, errors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evaluators_of_a_file_are_read_and_what_is_wrong_is_said() {
        let text = |error: &str, lower: &str, more: &str| {
            format!(
                r#"{{"format": "ninebit-evaluators-1", "evaluators": [{{"name": "a", "surface": "s", "yields": "y", "error": {error},
                "largest": 2, "time": {{"median": 5, "lower": {lower}, "upper": 6}}{more}}}]}}"#
            )
        };
        let read = parse(text("0.5", "4", "").as_bytes()).unwrap();
        assert_eq!((read[0].name.as_str(), read[0].error, read[0].time.lower), ("a", 0.5, 4.0));
        for (text, said) in [
            (text("-1", "4", ""), "steps from 0 to 255"),
            (text("1", "7", ""), "ascending"),
            (text("1", "4", ", \"speed\": 1"), "unknown field"),
            (text("1", "4", "").replace("-1\"", "-9\""), "format"),
            (text("1", "4", "").replace("\"a\"", "\"\""), "no name"),
            ("[".to_owned(), "EOF"),
        ] {
            let error = parse(text.as_bytes()).unwrap_err();
            assert!(error.contains(said), "{said}: {error}");
        }
    }
}
