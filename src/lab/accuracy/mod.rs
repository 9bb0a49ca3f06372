//! Accuracy of a technique: a scene's picture against its ground truth, the error by cause, and the cost on the chip.
//!
//! The truth turns into the picture in steps, each of which is a cause of errors:
//!
//! ```text
//! truth                      the equation, per pixel, in float64                       truth::evaluate
//!   | quantised normals      the same from the normals as the scene's bytes hold them  (where the truth names their register)
//!   | method                 the ideal of the technique: what it computes instead      compare, mode follow
//!   | interpolation, filtering, expansion, product and sum, store                      compare, mode follow
//! picture                    the model
//! ```
//!
//! All errors are the picture minus the truth, in steps of 1/255, over R, G and B.
#![allow(clippy::float_arithmetic, reason = "statistics of errors; nothing of this is stored")]

mod banding;
mod cost;
mod normals;
mod report;

use ninebit::plan::Plan;
use ninebit::rop::surface;
use ninebit::state::{Named, Scene};
use ninebit::threads::on_threads;
use ninebit::trace::Part;
use ninebit_report::compare::{CompareOptions, Comparison, Mode, Statistics, compare};
use ninebit_scene::truth::{Space, Truth, TruthFrame, Visible};
use ninebit_scene::vector::Vector;
use rayon::prelude::*;

pub use banding::Banding;
pub use cost::{FrameCost, HardwareCost};
pub use normals::NormalError;
pub use report::{accuracy_text, accuracy_value};

/// Index of the target that is measured.
const TARGET: usize = 0;

/// Mask of the channels R, G and B.
const COLORS: u8 = 7;

/// The error of a technique that is due to one cause.
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    /// Name: "quantised normals", "method", or the name of a [`Part`].
    pub name: &'static str,
    /// The errors that it adds.
    pub errors: Statistics,
}

/// Accuracy of a scene's picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Accuracy {
    /// Width of the target in pixels.
    pub width: u32,
    /// Height of the target in pixels.
    pub height: u32,
    /// Number of measured pixels: those that have a truth.
    pub pixels: u64,
    /// Number of pixels that are drawn but have no truth.
    pub without: u64,
    /// Errors of R, G and B together.
    pub errors: Statistics,
    /// Errors of R, G and B.
    pub channels: [Statistics; 3],
    /// Errors by cause. In each pixel they add up to its error.
    pub causes: Vec<Cause>,
    /// Banding of the highlight.
    pub banding: Banding,
    /// Errors of the technique's normals, if the truth names their register.
    pub normals: Option<NormalError>,
    /// Cost on the chip.
    pub cost: HardwareCost,
    /// The pictures that were compared.
    pub pictures: Pictures,
}

/// A picture and its truth, pixel by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Pictures {
    /// Width in pixels.
    pub(crate) width: u32,
    /// Height in pixels.
    pub(crate) height: u32,
    /// The picture: R, G, B, A.
    pub(crate) shown: Vec<[u8; 4]>,
    /// The truth: R, G, B from 0 to 1; `None` where a pixel is not measured.
    pub(crate) truth: Vec<Option<[f64; 3]>>,
}

impl Pictures {
    /// Returns R, G, B, A of the picture, row by row from the top.
    pub fn pixels(&self) -> &[[u8; 4]] {
        &self.shown
    }

    /// Returns R, G, B of the truth, 0 to 1; `None` where a pixel is not measured.
    pub fn truth(&self) -> &[Option<[f64; 3]>] {
        &self.truth
    }
}

/// Measures a scene against its truth. Returns `None` if no pixel with a truth is drawn.
pub fn measure(scene: &Scene, plan: &Plan, truth: &Truth) -> Option<Accuracy> {
    let visible = Visible::new(plan, truth, TARGET);
    let ideal = evaluate(&visible, |_| None);
    let options = CompareOptions { mode: Mode::Follow, target: TARGET, threads: 0, channels: COLORS };
    let technique = compare(plan, &options);
    let shown = draw_pixels(plan);
    let measured: Vec<usize> = (0..ideal.pixels.len())
        .filter(|at| ideal.pixels[*at].is_some() && technique.errors[*at][0].is_finite())
        .collect();
    if measured.is_empty() {
        return None;
    }
    let drawn = technique.errors.iter().filter(|errors| errors[0].is_finite()).count();
    let read = truth.shading_normal.map(|register| normals::read(scene, plan, truth, register, &measured));
    let quantised = read.as_ref().map(|read| evaluate(&visible, |at| Some(((*read.ideal.get(at)?)?, read.space))));
    let mut errors = [Statistics::default(); 3];
    let (mut inputs, mut method) = (Statistics::default(), Statistics::default());
    for at in &measured {
        let Some(pixel) = &ideal.pixels[*at] else { continue };
        for n in 0..3 {
            let wanted = 255.0 * pixel.color[n];
            let byte = f64::from(shown[*at][n]);
            errors[n].add(byte - wanted);
            let from_bytes = color(quantised.as_ref(), *at, n).unwrap_or(wanted);
            inputs.add(from_bytes - wanted);
            method.add(byte - f64::from(technique.errors[*at][n]) - from_bytes);
        }
    }
    let mut all = Statistics::default();
    errors.iter().for_each(|channel| all.merge(channel));
    let pixels = measured.len() as u64;
    let mut wanted = vec![None; ideal.pixels.len()];
    for at in &measured {
        wanted[*at] = ideal.pixels[*at].as_ref().map(|pixel| pixel.color);
    }
    let banding = Banding::from_pixels(&ideal, &shown, &measured);
    Some(Accuracy {
        width: ideal.width,
        height: ideal.height,
        pixels,
        without: drawn as u64 - pixels,
        errors: all,
        channels: errors,
        causes: causes(read.is_some().then_some(inputs), method, &technique),
        banding,
        normals: read.map(|read| NormalError::from_normals(&ideal, &read, &measured)),
        cost: HardwareCost::from_scene(scene, plan, pixels),
        pictures: Pictures { width: ideal.width, height: ideal.height, shown, truth: wanted },
    })
}

/// Computes the truth of the pixels, on all cores. `given` is that of [`Visible::row`].
fn evaluate(visible: &Visible<'_>, given: impl Fn(usize) -> Option<(Vector, Space)> + Sync) -> TruthFrame {
    let (width, height) = visible.size();
    let rows = || (0..height).into_par_iter().flat_map_iter(|row| visible.row(row, &given)).collect();
    TruthFrame { width, height, pixels: on_threads(0, rows) }
}

/// Returns a channel of a pixel's truth, in steps of 1/255.
fn color(frame: Option<&TruthFrame>, at: usize, channel: usize) -> Option<f64> {
    frame.and_then(|frame| frame.pixels[at].as_ref()).map(|pixel| 255.0 * pixel.color[channel])
}

fn causes(inputs: Option<Statistics>, method: Statistics, technique: &Comparison) -> Vec<Cause> {
    let inputs = inputs.map(|errors| Cause { name: "quantised normals", errors });
    let method = Cause { name: "method", errors: method };
    let parts =
        technique.parts.iter().map(|(part, errors): &(Part, Statistics)| Cause { name: part.name(), errors: *errors });
    inputs.into_iter().chain([method]).chain(parts).collect()
}

/// Draws the picture. Returns R, G, B, A of each pixel.
fn draw_pixels(plan: &Plan) -> Vec<[u8; 4]> {
    let frames = ninebit::engine::render(plan, &ninebit::engine::RenderOptions::default());
    let words = frames.surfaces.get(TARGET).map_or(&[][..], |surface| &surface.words);
    words.iter().map(|word| surface::final_channels(plan.targets()[TARGET].format, *word)).collect()
}
