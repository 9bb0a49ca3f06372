//! What the model refuses of a frame.

use ninebit::plan::{Plan, PlanError, PlanOptions};
use ninebit::state::{Scene, SurfaceFormat, Target, Texture};

use super::Operation;
use crate::class::Family;
use crate::gap::Gap;

/// Returns why a chip does not have a texture. Kelvin's formats are all the model's.
pub(super) fn refusal(family: Family, texture: &Texture) -> Option<String> {
    if family == Family::Kelvin {
        return None;
    }
    let targets = vec![Target::new(1, 1, SurfaceFormat::A8R8G8B8)];
    let scene = Scene { profile: family.profile(), targets, textures: vec![texture.clone()], ..Scene::default() };
    let errors = Plan::compile(&scene, &PlanOptions::default()).err()?;
    errors.into_iter().next().map(|error| error.message)
}

/// Removes the draws that the model refuses, and notes why.
pub(super) fn leave_all_out(scene: &mut Scene, drawn: &mut [Operation]) {
    while !scene.targets.is_empty() && !scene.draws.is_empty() {
        let Err(errors) = Plan::compile(scene, &PlanOptions::default()) else { break };
        if !leave_out(scene, drawn, &errors) {
            break;
        }
    }
}

/// Removes the draws that errors name, and notes the errors. Returns whether there are any.
fn leave_out(scene: &mut Scene, drawn: &mut [Operation], errors: &[PlanError]) -> bool {
    let mut refused: Vec<usize> = errors.iter().filter_map(|error| error.draw).collect();
    refused.sort_unstable();
    refused.dedup();
    if refused.is_empty() {
        // The scene as a whole is too large.
        let message = errors.first().map_or_else(String::new, |error| error.message.clone());
        for entry in drawn.iter_mut() {
            entry.draw = None;
            entry.gaps.push(Gap::TooMany(message.clone()));
        }
        scene.draws.clear();
        return true;
    }
    for index in refused.into_iter().rev() {
        scene.draws.remove(index);
        for entry in drawn.iter_mut() {
            match entry.draw {
                Some(at) if at == index => {
                    entry.draw = None;
                    let of_draw = errors.iter().filter(|error| error.draw == Some(index));
                    entry.gaps.extend(of_draw.map(|error| Gap::NotModelled(error.message.clone())));
                }
                Some(at) if at > index => entry.draw = Some(at - 1),
                _ => {}
            }
        }
    }
    true
}
