//! The normals that a technique has in a register, read back and compared with those of the surface.

use super::{COLORS, TARGET};
use ninebit::engine::{DrawTrace, trace};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::{Combiners, Component, ExpandCentre, FinalInput, FinalRegister, Register, Scene};
use ninebit::threads::on_threads;
use ninebit_report::compare::{CompareOptions, Mode, Statistics, compare};
use ninebit_scene::truth::{NormalHolder, ShadingNormal, Space, Truth, TruthFrame};
use ninebit_scene::vector::{Vector, cross, dot, unit_or_zero};
use rayon::prelude::*;

/// Deviation of a technique's normals from the surface's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalError {
    /// Angles between them in degrees, not negative.
    pub degrees: Statistics,
    /// Lengths of the technique's normals; they should be 1.
    pub lengths: Statistics,
}

/// Normals by pixel: those in a register before the first general stage, or those that a dot product of the texture shader reads.
pub(super) struct Normals {
    /// The stored vectors: a register's bytes as `expand` reads them, or the vectors of the texture shader.
    stored: Vec<Option<Vector>>,
    /// The vectors without any rounding before the register: 2x - 1 of the ideal texels or colours.
    pub(super) ideal: Vec<Option<Vector>>,
    /// The space in which the vectors are given.
    pub(super) space: Space,
}

/// Reads the normals of the draws that have a truth. `measured` lists the pixels that the caller needs.
pub(super) fn read(scene: &Scene, plan: &Plan, truth: &Truth, normal: ShadingNormal, measured: &[usize]) -> Normals {
    match normal.holder {
        NormalHolder::Register(register) => of_register(scene, plan, truth, normal.space, register),
        NormalHolder::DotProduct(unit) => of_dot_product(plan, truth, normal.space, unit, measured),
    }
}

/// Reads the vectors of a texture shader's dot product from the trace of each pixel. They are those of the last draw that has a truth and reads them.
fn of_dot_product(plan: &Plan, truth: &Truth, space: Space, unit: usize, measured: &[usize]) -> Normals {
    let width = plan.targets()[TARGET].width as usize;
    let components = ["x", "y", "z"].map(|axis| format!("unit{unit}.vector.{axis}"));
    let one = |at: usize| {
        let pixel = ((at % width) as u32, (at / width) as u32);
        let traced = trace(plan, TARGET, pixel, None).ok()?;
        let told = traced.draws.iter().rev().filter(|draw| truth.meshes.get(draw.draw).is_some_and(Option::is_some));
        let read = |draw: &DrawTrace| -> Option<(Vector, Vector)> {
            let mut vectors = ([0.0; 3], [0.0; 3]);
            for (n, name) in components.iter().enumerate() {
                let step = draw.steps.iter().find(|step| step.name == *name)?;
                (vectors.0[n], vectors.1[n]) = (step.real(), step.ideal?);
            }
            Some(vectors)
        };
        told.filter(|draw| draw.stored).find_map(read)
    };
    let vectors: Vec<Option<(Vector, Vector)>> = on_threads(0, || measured.par_iter().map(|at| one(*at)).collect());
    let pixels = measured.last().map_or(0, |last| last + 1);
    let mut normals = Normals { stored: vec![None; pixels], ideal: vec![None; pixels], space };
    for (at, (stored, ideal)) in measured.iter().zip(vectors).filter_map(|(at, read)| Some((*at, read?))) {
        (normals.stored[at], normals.ideal[at]) = (Some(stored), Some(ideal));
    }
    normals
}

/// Reads a register by drawing the scene once more, with combiners that show it.
fn of_register(scene: &Scene, plan: &Plan, truth: &Truth, space: Space, register: Register) -> Normals {
    let mut probe = scene.clone();
    for (number, draw) in probe.draws.iter_mut().enumerate() {
        if truth.meshes.get(number).is_some_and(Option::is_some) {
            draw.combiners = showing(register.into());
            (draw.blend, draw.alpha_test, draw.color_mask) = (None, None, [true; 4]);
            draw.program_origin.clear();
        }
    }
    let Ok(probe) = Plan::compile(&probe, &PlanOptions { policies: plan.policies, prune: true }) else {
        return Normals { stored: Vec::new(), ideal: Vec::new(), space };
    };
    let options = CompareOptions { mode: Mode::Follow, target: TARGET, threads: 0, channels: COLORS };
    let comparison = compare(&probe, &options);
    let shown = super::draw_pixels(&probe);
    let drawn = |at: usize| comparison.errors[at][0].is_finite();
    let zero = match plan.policies.expand_centre {
        ExpandCentre::Centred => 128.0,
        ExpandCentre::Literal => 127.5,
    };
    let pixels = 0..comparison.errors.len();
    let stored = |at: usize| [0, 1, 2].map(|n| (f64::from(shown[at][n]) - zero) / 127.5);
    let ideal = |at: usize| {
        let error = comparison.errors[at];
        [0, 1, 2].map(|n| (f64::from(shown[at][n]) - f64::from(error[n])) / 127.5 - 1.0)
    };
    Normals {
        stored: pixels.clone().map(|at| drawn(at).then(|| stored(at))).collect(),
        ideal: pixels.map(|at| drawn(at).then(|| ideal(at))).collect(),
        space,
    }
}

/// Returns combiners that show a register with alpha 1.
fn showing(register: FinalRegister) -> Combiners {
    let mut shown = Combiners::showing(register);
    shown.final_combiner.g = FinalInput { invert: true, ..FinalInput::zero(Component::Alpha) };
    shown
}

impl NormalError {
    /// Computes the errors over the measured pixels. Pixels where the surface has no normal have no angle.
    pub(super) fn from_normals(truth: &TruthFrame, normals: &Normals, measured: &[usize]) -> NormalError {
        let (mut degrees, mut lengths) = (Statistics::default(), Statistics::default());
        for at in measured {
            let (Some(pixel), Some(Some(stored))) = (&truth.pixels[*at], normals.stored.get(*at)) else { continue };
            let held = pixel.object(*stored, normals.space);
            lengths.add(dot(*stored, *stored).sqrt());
            if pixel.normal != [0.0; 3] {
                degrees.add(angle(pixel.normal, unit_or_zero(held)));
            }
        }
        NormalError { degrees, lengths }
    }
}

/// Returns the angle between two unit vectors in degrees. It is also accurate for small angles.
fn angle(a: Vector, b: Vector) -> f64 {
    let across = cross(a, b);
    libm::atan2(dot(across, across).sqrt(), dot(a, b)).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::angle;

    #[test]
    fn angles() {
        assert!((angle([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]) - 90.0).abs() < 1e-12);
        assert!((angle([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]) - 180.0).abs() < 1e-12);
        let small = 1e-9_f64;
        assert!((angle([1.0, 0.0, 0.0], [1.0, small, 0.0]).to_radians() / small - 1.0).abs() < 1e-6);
    }
}
