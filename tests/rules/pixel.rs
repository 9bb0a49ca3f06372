//! Scenes of one pixel, rendered and traced.

use crate::build::{draw, target, vertex};
use ninebit::engine::{RenderOptions, render, trace};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;
use ninebit::trace::Step;

/// A pixel that was rendered and traced.
pub struct Pixel {
    /// The word that the surface holds.
    pub word: u32,
    /// The steps of the last draw.
    steps: Vec<Step>,
}

impl Pixel {
    /// Renders and traces pixel (0, 0) of the first target.
    pub fn from_scene(scene: &Scene, policies: Policies) -> Pixel {
        let plan = Plan::compile(scene, &PlanOptions { policies, prune: true }).unwrap();
        let word = render(&plan, &RenderOptions::default()).surfaces[0].words[0];
        let mut trace = trace(&plan, 0, (0, 0), None).unwrap();
        assert_eq!(trace.word, word, "the trace agrees with the picture");
        Pixel { word, steps: trace.draws.pop().map_or(Vec::new(), |draw| draw.steps) }
    }

    /// Returns the last step that yields `name`.
    #[track_caller]
    pub fn step(&self, name: &str) -> &Step {
        let names = || self.steps.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(" ");
        self.steps.iter().rfind(|s| s.name == name).unwrap_or_else(|| panic!("no step `{name}` in {}", names()))
    }

    /// Returns the integer of a step.
    #[track_caller]
    pub fn value(&self, name: &str) -> i64 {
        self.step(name).value
    }
}

/// Returns a scene with one pixel of `format`, cleared to `clear`.
pub fn scene(profile: Profile, format: SurfaceFormat, clear: [u8; 4], draws: Vec<Draw>) -> Scene {
    Scene { profile, targets: vec![target(1, 1, format, clear)], textures: vec![], palettes: vec![], draws }
}

/// Returns a draw that stores the primary colour in the pixel. All corners have the same values, so the result does not depend on weights.
pub fn covering(corner: Vertex) -> Draw {
    let corners = [(0.0, 0.0), (2.0, 0.0), (0.0, 2.0)];
    let place = |(x, y): (f32, f32)| Vertex { position: vertex(x, y, [0; 4]).position, ..corner };
    draw(Topology::Triangles, corners.map(place).to_vec())
}

/// Returns a portion that writes `register` times one to SPARE0.
pub fn load_spare0(component: Component, register: Register) -> Portion {
    let mut portion = Portion::idle(component);
    portion.inputs[0].register = register;
    portion.inputs[1].mapping = InputMapping::UnsignedInvert;
    portion.ab_output = Register::Spare0;
    portion
}
