//! Draws one pixel, without a scene file.

use ninebit::engine::{RenderOptions, render};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;

fn main() {
    let mut halves = FinalCombiner { constants: [[128; 4], [0; 4]], ..FinalCombiner::default() };
    halves.inputs[0].register = FinalRegister::ConstantColor0; // A
    halves.inputs[1].register = FinalRegister::PrimaryColor; // B
    let combiners = Combiners { final_combiner: halves, ..Combiners::default() };
    let corner = |x: f32, y: f32| Vertex { position: [x, y, 0.0, 1.0], ..Vertex::default() };
    let vertices = vec![corner(0.0, 0.0), corner(2.0, 0.0), corner(0.0, 2.0)].into();
    let draw = Draw { vertices, indices: [0, 1, 2].into(), combiners, ..Draw::default() };
    let targets = vec![Target::new(1, 1, SurfaceFormat::A8R8G8B8)];
    let scene = Scene { profile: Profile::Nv2a, targets, draws: vec![draw], ..Scene::default() };
    let plan = Plan::compile(&scene, &PlanOptions::default()).expect("within the limits");
    let frames = render(&plan, &RenderOptions::default());
    assert_eq!(frames.surfaces[0].words, [0xff80_8080]);
}
