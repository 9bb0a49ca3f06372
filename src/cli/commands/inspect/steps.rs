//! What each draw of a scene did: the picture after it, small, and what an import marked about it.

use std::sync::Arc;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use ninebit::engine::{RenderOptions, render};
use ninebit::frame::Surface;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::{Policies, Scene};
use serde_json::{Value, json};

use super::super::{Compression, Failure, encode_png};

/// Most draws that get pictures: they are some kilobytes each.
const MOST_PICTURES: usize = 400;
/// Longest side of a picture.
const SIDE: u32 = 96;
/// How comments of an import begin.
const MARK: &str = "// incomplete: ";

/// Returns, for each draw, its picture and its marks; nothing for a single draw without marks. Each draw is drawn once, into what those before left.
pub(super) fn steps(scene: &Scene, policies: Policies, text: &str) -> Result<Option<Value>, Failure> {
    let marks: Vec<Vec<&str>> = scene.draws.iter().map(|draw| marks(text, &draw.name)).collect();
    if scene.draws.len() < 2 && marks.iter().all(Vec::is_empty) {
        return Ok(None);
    }
    let mut pictures = Vec::new();
    let mut left = Scene { draws: Vec::new(), ..scene.clone() };
    for draw in scene.draws.iter().take(MOST_PICTURES) {
        let target = draw.target;
        left.draws = vec![draw.clone()];
        // A draw that is legal in the scene is so alone.
        let Ok(plan) = Plan::compile(&left, &PlanOptions::default()) else { break };
        let surface = render(&plan.under(policies), &RenderOptions::default()).surfaces.swap_remove(target);
        pictures.push(small(&surface)?);
        let of_target = &mut left.targets[target];
        of_target.contents = Some(Arc::from(surface.words));
        of_target.depth_contents = of_target.depth.map(|_| Arc::from(surface.depth));
    }
    let mut pictures = pictures.into_iter();
    let steps = marks.iter().map(|marks| json!({ "picture": pictures.next(), "marks": marks }));
    Ok(Some(steps.collect()))
}

/// Returns what stands in the comment above a draw.
fn marks<'a>(text: &'a str, name: &str) -> Vec<&'a str> {
    let Some(at) = text.find(&format!("name: {name:?}")) else { return Vec::new() };
    let above = text[..at].lines().rev().map(str::trim);
    let mut marks: Vec<&str> = above
        .skip_while(|line| !line.starts_with("//") && (line.is_empty() || *line == "("))
        .take_while(|line| line.starts_with("//"))
        .filter_map(|line| line.strip_prefix(MARK))
        .collect();
    marks.reverse();
    marks
}

/// Returns a surface as a small PNG in base64, each pixel the nearest one.
fn small(surface: &Surface) -> Result<String, Failure> {
    let Surface { width, height, .. } = *surface;
    let longest = width.max(height).max(SIDE);
    let [columns, rows] = [width, height].map(|side| (side * SIDE).div_ceil(longest).max(1));
    let all = surface.rgba8();
    let at = |x: u32, y: u32| {
        let [r, g, b, _] = all[((y * height / rows) * width + x * width / columns) as usize];
        [r, g, b, 255]
    };
    let pixels: Vec<[u8; 4]> =
        (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect();
    Ok(STANDARD.encode(encode_png(columns, rows, &pixels, Compression::Small)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ninebit::state::{Draw, Profile, SurfaceFormat, Target};

    #[test]
    fn marks_stand_above_their_draw() {
        let text = "(\n    draws: [\n        // incomplete: no memory\n        // incomplete: 3 words\n        (\n            name: \"draw 0\",\n        ),\n        // A note.\n        (\n            name: \"draw 1\",\n        ),\n    ],\n)\n";
        assert_eq!(marks(text, "draw 0"), ["no memory", "3 words"]);
        assert!(marks(text, "draw 1").is_empty() && marks(text, "draw 2").is_empty());
    }

    #[test]
    fn each_draw_has_the_picture_after_it() {
        let target = Target::new(192, 96, SurfaceFormat::A8R8G8B8);
        let draws = vec![Draw::rectangle(96.0, 96.0), Draw::rectangle(192.0, 96.0)];
        let scene = Scene { profile: Profile::Nv2a, targets: vec![target], draws, ..Scene::default() };
        let steps = steps(&scene, Policies::default(), "").expect("encoded").expect("two draws");
        let pictures: Vec<&str> = (0..2).filter_map(|n| steps[n]["picture"].as_str()).collect();
        assert_eq!(pictures.len(), 2);
        assert_ne!(pictures[0], pictures[1]);
        let one = Scene { draws: scene.draws[..1].to_vec(), ..scene };
        assert_eq!(super::steps(&one, Policies::default(), "").ok().flatten(), None);
    }
}
