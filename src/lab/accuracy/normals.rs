//! The normals that a technique holds in a register, read out and compared with the surface's.

use super::{COLORS, TARGET};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::{Combiners, Component, ExpandCentre, FinalInput, FinalRegister, Scene};
use ninebit_report::compare::{CompareOptions, Mode, Statistics, compare};
use ninebit_scene::truth::{ShadingNormal, Space, Truth, TruthFrame};
use ninebit_scene::vector::{Vector, cross, dot, unit_or_zero};

/// How far a technique's normals are turned away from the surface's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalError {
    /// Angles in degrees, none negative.
    pub degrees: Statistics,
    /// Lengths of the technique's normals; 1 is right.
    pub lengths: Statistics,
}

/// Normals by pixel: what a register holds before the first general stage.
pub(super) struct Normals {
    /// The register's bytes as `expand` reads them.
    stored: Vec<Option<Vector>>,
    /// The same if nothing on the way to the register had been rounded: 2x - 1 of the ideal of the texels or colours.
    pub(super) ideal: Vec<Option<Vector>>,
    /// Their space.
    pub(super) space: Space,
}

/// Reads a register of the draws that have a truth: the scene is drawn once more with programs that show it.
pub(super) fn read(scene: &Scene, plan: &Plan, truth: &Truth, normal: ShadingNormal) -> Normals {
    let mut probe = scene.clone();
    for (number, draw) in probe.draws.iter_mut().enumerate() {
        if truth.meshes.get(number).is_some_and(Option::is_some) {
            draw.combiners = showing(normal.register.into());
            (draw.blend, draw.alpha_test, draw.color_mask) = (None, None, [true; 4]);
            draw.program_origin.clear();
        }
    }
    let Ok(probe) = Plan::compile(&probe, &PlanOptions { policies: plan.policies, prune: true }) else {
        return Normals { stored: Vec::new(), ideal: Vec::new(), space: normal.space };
    };
    let options = CompareOptions { mode: Mode::Follow, target: TARGET, threads: 0, channels: COLORS };
    let comparison = compare(&probe, &options);
    let shown = super::Shown::new(&probe);
    let drawn = |at: usize| comparison.errors[at][0].is_finite();
    let zero = match plan.policies.expand_centre {
        ExpandCentre::Centred => 128.0,
        ExpandCentre::Literal => 127.5,
    };
    let pixels = 0..comparison.errors.len();
    let stored = |at: usize| [0, 1, 2].map(|n| (f64::from(shown.0[at][n]) - zero) / 127.5);
    let ideal = |at: usize| {
        let error = comparison.errors[at];
        [0, 1, 2].map(|n| (f64::from(shown.0[at][n]) - f64::from(error[n])) / 127.5 - 1.0)
    };
    Normals {
        stored: pixels.clone().map(|at| drawn(at).then(|| stored(at))).collect(),
        ideal: pixels.map(|at| drawn(at).then(|| ideal(at))).collect(),
        space: normal.space,
    }
}

/// A program that shows a register, opaque.
fn showing(register: FinalRegister) -> Combiners {
    let mut shown = Combiners::showing(register);
    shown.final_combiner.g = FinalInput { invert: true, ..FinalInput::zero(Component::Alpha) };
    shown
}

impl NormalError {
    /// Over the measured pixels; where the surface has no normal there is no angle.
    pub(super) fn of(truth: &TruthFrame, normals: &Normals, measured: &[usize]) -> NormalError {
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

/// The angle between two unit vectors, in degrees; exact for small ones too.
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
