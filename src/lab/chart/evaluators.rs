//! The ways in which a scene can be evaluated here: how long each takes, and how far it is from the stored bytes.

use serde::Serialize;

use super::surfaces::Surface;
use super::timing::{Effort, Spread, frames};
use ninebit::engine::{self, Engine, Isa, RenderOptions, render};
use ninebit::number::Ideal;
use ninebit::plan::Plan;
use ninebit::state::Named;
use ninebit_report::compare::{CompareOptions, Mode, Statistics, compare, real_frame};
use ninebit_scene::SceneError;

/// A way of evaluating a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Evaluator {
    /// Its name.
    pub name: String,
    /// What is drawn.
    pub surface: String,
    /// What comes out.
    pub yields: &'static str,
    /// Nanoseconds per pixel, one thread.
    pub time: Spread,
    /// Root mean square of R, G, B against the stored bytes, in steps.
    pub error: f64,
    /// The largest such error.
    pub largest: f64,
}

/// The surfaces that evaluators are timed on.
fn workloads() -> [(&'static str, Surface); 2] {
    let lit = Surface { stages: 1, units: 1, filtered: true, ..Surface::default() };
    [
        ("one unit, one stage", lit),
        ("two units, two stages, blend", Surface { stages: 2, units: 2, alpha: true, blend: true, ..lit }),
    ]
}

/// Times every evaluator. `progress` is told of each.
///
/// # Errors
/// A surface's scene is not accepted: a fault of its template.
pub fn measure(side: usize, effort: &Effort, progress: &dyn Fn()) -> Result<Vec<Evaluator>, Box<SceneError>> {
    let mut all = Vec::new();
    for (surface, state) in workloads() {
        let plan = state.plan(side)?;
        let definition = rendered(&plan, &RenderOptions { engine: Engine::Scalar, ..RenderOptions::default() });
        let pixels = plan.draws.iter().map(|draw| engine::fragments(&plan, draw)).sum::<u64>().max(1);
        let mut add = |name: String, yields, time, errors: Statistics| {
            let (error, largest) = (errors.rms(), errors.max());
            all.push(Evaluator { name, surface: surface.to_owned(), yields, time, error, largest });
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
        add("float32".to_owned(), "the real-number text, single precision", time, errors);
        let (time, errors) = real::<f64>(&plan, &definition, pixels, effort);
        add("float64".to_owned(), "the real-number text", time, errors);
        for mode in Mode::ALL {
            let options = CompareOptions { mode: *mode, target: 0, threads: 1, channels: 15 };
            let time = effort.measure(pixels, || drop(compare(&plan, &options)));
            add(format!("compare {}", mode.name()), "both, and their differences", time, Statistics::default());
        }
    }
    Ok(all)
}

/// How many evaluators [`measure`] times.
pub fn count() -> usize {
    let widths = Isa::ALL.iter().filter(|isa| isa.is_available()).count();
    workloads().len() * (widths + 4 + Mode::ALL.len())
}

/// R, G, B that an engine stores.
fn rendered(plan: &Plan, options: &RenderOptions) -> Vec<[f64; 3]> {
    let frames = render(plan, options);
    let bytes = frames.surfaces.first().map(ninebit::frame::Surface::rgba8).unwrap_or_default();
    bytes.iter().map(|[r, g, b, _]| [*r, *g, *b].map(f64::from)).collect()
}

/// Errors against the definition's bytes, of all numbers that are there.
fn against(definition: &[[f64; 3]], frame: &[[f64; 3]]) -> Statistics {
    let mut errors = Statistics::default();
    for (byte, value) in definition.iter().flatten().zip(frame.iter().flatten()).filter(|(_, value)| !value.is_nan()) {
        errors.add(value - byte);
    }
    errors
}

/// The ideal in a lane of real numbers.
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

/// Traces of pixels spread over the frame.
fn traced(plan: &Plan, definition: &[[f64; 3]], side: usize, effort: &Effort) -> (Spread, Statistics) {
    /// Pixels that are traced, along each side.
    const GRID: usize = 8;
    let places: Vec<(u32, u32)> = (0..GRID * GRID)
        .map(|n| [n % GRID, n / GRID].map(|k| ((k * side + side / 2) / GRID) as u32))
        .map(|[x, y]| (x, y))
        .collect();
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
