//! Traces one pixel with every integer on its way, to find the first number that differs from another implementation's.
//!
//! `cargo run -p ninebit-report --example trace`

use ninebit::engine::trace;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::{Combiners, Draw, FinalRegister, Profile, Scene, SurfaceFormat, Target, Vertex, VertexColor};
use ninebit_report::trace_text;

fn main() {
    let combiners = Combiners::showing(FinalRegister::PrimaryColor);
    let corner = |x: f32, y: f32, diffuse| Vertex { diffuse, ..Vertex::at(x, y) };
    let vertices = vec![
        corner(0.0, 0.0, VertexColor::Bytes([255, 0, 0, 255])),
        corner(8.0, 0.0, VertexColor::Bytes([0, 255, 0, 255])),
        corner(0.0, 8.0, VertexColor::Bytes([0, 0, 255, 255])),
    ];
    let draw = Draw { combiners, ..Draw::from_vertices(vertices) };
    let targets = vec![Target::new(8, 8, SurfaceFormat::A8R8G8B8)];
    let scene = Scene { profile: Profile::Nv2a, targets, draws: vec![draw], ..Scene::default() };
    match Plan::compile(&scene, &PlanOptions::default()) {
        Ok(plan) => {
            println!("{}", trace(&plan, 0, (2, 3), None).map_or_else(|e| e.to_string(), |t| trace_text(&plan, &t)))
        }
        Err(errors) => errors.iter().for_each(|error| eprintln!("{error}")),
    }
}
