//! The ways in which a scene can be evaluated here: how long each takes, and how far it is from the stored bytes.

use serde::Serialize;

use super::surfaces::Surface;
use super::timing::{Effort, Spread, frames};
use crate::compare::{CompareOptions, Mode, compare, real_frame};
use crate::engine::{self, Engine, Isa, RenderOptions, render};
use crate::number::Ideal;
use crate::plan::Plan;
use crate::scene::SceneError;
use crate::state::Named;

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
        let pixels = plan.draws.iter().map(|draw| engine::fragments(&plan, draw)).sum::<u64>().max(1);
        let mut add = |name: String, yields, time, (error, largest)| {
            all.push(Evaluator { name, surface: surface.to_owned(), yields, time, error, largest });
            progress();
        };
        for isa in Isa::ALL.iter().rev().filter(|isa| isa.is_available()) {
            let options = RenderOptions { isa: Some(*isa), ..RenderOptions::default() };
            let name = format!("fast, {}", isa.name());
            let same = against(&plan, &rendered(&plan, &options));
            add(name, "the stored bytes", frames(&plan, &options, pixels, effort), same);
        }
        let scalar = RenderOptions { engine: Engine::Scalar, ..RenderOptions::default() };
        let same = against(&plan, &rendered(&plan, &scalar));
        add("scalar".to_owned(), "the stored bytes", frames(&plan, &scalar, pixels, effort), same);
        let (time, error) = traced(&plan, side, effort);
        add("traced".to_owned(), "every integer of each pixel", time, error);
        let (time, error) = real::<f32>(&plan, pixels, effort);
        add("float32".to_owned(), "the real-number text, single precision", time, error);
        let (time, error) = real::<f64>(&plan, pixels, effort);
        add("float64".to_owned(), "the real-number text", time, error);
        for mode in Mode::ALL {
            let options = CompareOptions { mode: *mode, target: 0, threads: 1, channels: 15 };
            let time = effort.measure(pixels, || drop(compare(&plan, &options)));
            add(format!("compare {}", mode.name()), "both, and their differences", time, (0.0, 0.0));
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
    let bytes = frames.surfaces.first().map(crate::frame::Surface::rgba8).unwrap_or_default();
    bytes.iter().map(|[r, g, b, _]| [*r, *g, *b].map(f64::from)).collect()
}

/// Root mean square and largest error against the definition's bytes, over all numbers that are there.
fn against(plan: &Plan, frame: &[[f64; 3]]) -> (f64, f64) {
    let bytes = rendered(plan, &RenderOptions { engine: Engine::Scalar, ..RenderOptions::default() });
    let errors = bytes.iter().flatten().zip(frame.iter().flatten()).map(|(byte, value)| value - byte);
    let errors: Vec<f64> = errors.filter(|error| !error.is_nan()).collect();
    let mean = errors.iter().map(|error| error * error).sum::<f64>() / errors.len().max(1) as f64;
    (mean.sqrt(), errors.iter().fold(0.0, |most: f64, error| most.max(error.abs())))
}

/// The ideal in a lane of real numbers.
fn real<L: Ideal + Send + Sync>(plan: &Plan, pixels: u64, effort: &Effort) -> (Spread, (f64, f64)) {
    let time = effort.measure(pixels, || drop(real_frame::<L>(plan, 0, 1)));
    let colors = |pixel: &Option<[L; 4]>| pixel.map_or([f64::NAN; 3], |[r, g, b, _]| [r, g, b].map(L::real));
    let frame: Vec<[f64; 3]> = real_frame::<L>(plan, 0, 1).iter().map(colors).collect();
    (time, against(plan, &frame))
}

/// Traces of pixels spread over the frame.
fn traced(plan: &Plan, side: usize, effort: &Effort) -> (Spread, (f64, f64)) {
    /// Pixels that are traced, along each side.
    const GRID: usize = 8;
    let bytes = rendered(plan, &RenderOptions { engine: Engine::Scalar, ..RenderOptions::default() });
    let places: Vec<(u32, u32)> = (0..GRID * GRID)
        .map(|n| [n % GRID, n / GRID].map(|k| ((k * side + side / 2) / GRID) as u32))
        .map(|[x, y]| (x, y))
        .collect();
    let trace = |place: &(u32, u32)| engine::trace(plan, 0, *place, None);
    let time = effort.measure(places.len() as u64, || places.iter().for_each(|place| drop(trace(place))));
    let mut largest: f64 = 0.0;
    for (x, y) in &places {
        let Ok(pixel) = trace(&(*x, *y)) else { continue };
        let Some([r, g, b]) = bytes.get(*y as usize * side + *x as usize) else { continue };
        let shown = pixel.shown.map(f64::from);
        largest = [r - shown[0], g - shown[1], b - shown[2]].iter().fold(largest, |most, e| most.max(e.abs()));
    }
    (time, (largest, largest))
}
