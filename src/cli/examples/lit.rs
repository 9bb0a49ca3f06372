//! Lights a map of two normals by one dot product a pixel.

use ninebit::engine::{RenderOptions, render};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;

fn main() {
    // Towards the viewer, and halfway to the right: -1 is 0, 1 is 255.
    let map = Texture::from_words(TextureFormat::X8R8G8B8, [2, 1], [0x80_80ff, 0xda_80da]);
    let unit = TextureUnit { mag_filter: Filter::Nearest, min_filter: Filter::Nearest, ..TextureUnit::new(0) };
    let [normal, light] =
        [Register::Texture0, Register::ConstantColor0].map(|from| from.rgb().mapped(InputMapping::ExpandNormal));
    let dot = Portion { ab_dot_product: true, ab_output: Register::Spare0, ..Portion::idle(Component::Rgb) };
    let stage = GeneralStage {
        rgb: dot.a(normal).b(light),
        constants: [[128, 128, 255, 0], [0; 4]],
        ..GeneralStage::default()
    };
    let combiners = Combiners {
        stages: vec![stage],
        final_combiner: FinalCombiner::showing(FinalRegister::Spare0),
        ..Combiners::default()
    };
    let scene = Scene {
        profile: Profile::Nv2a,
        targets: vec![Target::new(4, 1, SurfaceFormat::A8R8G8B8)],
        textures: vec![map],
        draws: vec![Draw { combiners, ..Draw::rectangle(4.0, 1.0).texture(0, unit) }],
        ..Scene::default()
    };
    let plan = Plan::compile(&scene, &PlanOptions::default()).expect("a legal scene");
    let frames = render(&plan, &RenderOptions::default());
    assert_eq!(frames.surfaces[0].words, [0xfffd_fdfd, 0xfffd_fdfd, 0xffb3_b3b3, 0xffb3_b3b3]);
}
