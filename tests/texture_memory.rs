//! Tests how much memory textures take: levels in addition to level 0, and no second copy.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, reason = "a test binary")]

use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::{Level, Named, TextureFormat, TextureImage};
use ninebit_scene as scene;
use std::path::Path;
use std::sync::Arc;

const SIDE: u32 = 2048;

/// All levels of any format take at most 1.34 times level 0, plus the padding of the last blocks.
#[test]
fn levels_take_a_third_more() {
    for format in TextureFormat::ALL {
        let (levels, words) = Level::chain(*format, SIDE, SIDE, 12, false);
        let first = format.words(SIDE, SIDE);
        assert_eq!((levels.len(), levels[11].width, levels[1].offset), (12, 1, first));
        assert!(words as f64 <= 1.34 * first as f64 + 64.0, "{format:?}: {words} words, {first} of level 0");
    }
}

/// The plan of a scene with a texture of 2048 x 2048 and all levels shares the words with the scene.
#[test]
fn plans_share_the_words() {
    let text = "(version: 1, profile: Nv2a, textures: {\"t\": (levels: All, source: Checker(width: 2048, height: 2048, cell: 3))}, \
                draws: [(vertices: Window([]), textures: [(texture: \"t\", mip_filter: Linear)])])";
    let loaded = scene::parse(text, Path::new("."), &Limits::default()).unwrap();
    let plan = Plan::compile(&loaded.scene, &PlanOptions::default()).unwrap();
    let words = |texture: &ninebit::state::Texture| match &texture.image {
        TextureImage::Texels(texels) => texels.words.clone(),
        TextureImage::Target { .. } | TextureImage::Depth { .. } => panic!("texels expected"),
    };
    let (ours, planned) = (words(&loaded.scene.textures[0]), words(&plan.textures()[0]));
    assert!(Arc::ptr_eq(&ours, &planned));
    assert!(size_of_val(&ours[..]) as f64 <= 1.34 * f64::from(4 * SIDE * SIDE) + 64.0);
}
