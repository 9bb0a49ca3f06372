//! Renders a scene from its text to a picture in memory, as a test of an emulator would.
//!
//! `cargo run -p ninebit-scene --example render`

use std::path::Path;

use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;

const SCENE: &str = r#"(
    version: 1,
    profile: Nv2a,
    targets: [(name: "frame", width: 8, height: 4)],
    draws: [(
        vertices: Window([
            (position: (0, 0), diffuse: (255, 0, 0)), (position: (8, 0), diffuse: (0, 255, 0)), (position: (0, 4), diffuse: (0, 0, 255)),
        ]),
        program: Combiners(stages: [(rgb: (a: PrimaryColor, b: UnsignedInvert(Zero), ab: Spare0))], final_combiner: (d: Spare0)),
    )],
)"#;

fn main() {
    let loaded = match ninebit_scene::parse(SCENE, Path::new("scene.ron"), &Limits::default()) {
        Ok(loaded) => loaded,
        Err(error) => return eprintln!("{error}"),
    };
    for row in render(&loaded.plan, &RenderOptions::default()).surfaces[0].words.chunks(8) {
        println!("{}", row.iter().map(|word| format!("{word:08x} ")).collect::<String>());
    }
}

#[cfg(test)]
#[test]
fn runs() {
    assert!(ninebit_scene::parse(SCENE, Path::new("scene.ron"), &Limits::default()).is_ok());
    main();
}
