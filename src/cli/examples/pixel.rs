//! Draws one pixel, without a scene file.

use ninebit::engine::{RenderOptions, render};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;

fn main() {
    let halves = FinalCombiner { constants: [[128; 4], [0; 4]], ..FinalCombiner::default() };
    let halves = halves.a(FinalRegister::ConstantColor0.rgb()).b(FinalRegister::PrimaryColor.rgb());
    let combiners = Combiners { final_combiner: halves, ..Combiners::default() };
    let vertices = vec![Vertex::at(0.0, 0.0), Vertex::at(2.0, 0.0), Vertex::at(0.0, 2.0)];
    let draw = Draw { combiners, ..Draw::from_vertices(vertices) };
    let targets = vec![Target::new(1, 1, SurfaceFormat::A8R8G8B8)];
    let scene = Scene { profile: Profile::Nv2a, targets, draws: vec![draw], ..Scene::default() };
    let plan = Plan::compile(&scene, &PlanOptions::default()).expect("within the limits");
    let frames = render(&plan, &RenderOptions::default());
    assert_eq!(frames.surfaces[0].words, [0xff80_8080]);
}
