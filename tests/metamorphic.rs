//! Relations between pictures that hold whatever an engine does, over random scenes of all sequences.
//!
//! `NINEBIT_METAMORPHIC_SCENES` is the number of scenes of each sequence, `NINEBIT_ENGINE_SEED` selects another one.

use crate::engines::{simplify, tree};
use crate::repository::at;
use crate::scene_files;
use crate::settings::number;
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::Scene;
use ninebit_scene as scene;
use ninebit_test_support::{
    metamorphic::{RELATIONS, check},
    random_scene,
};
use proptest::strategy::{Strategy, ValueTree};

/// Checks the scenes of a sequence; of a slow one a part.
fn hold(sequence: &impl Strategy<Value = Scene>, one_of: u32) {
    let (scenes, seed) =
        (number("NINEBIT_METAMORPHIC_SCENES", 300_u32).div_ceil(one_of), number("NINEBIT_ENGINE_SEED", 5));
    let mut counts = [0; RELATIONS.len()];
    for number in 0..scenes {
        let mut tree = tree(sequence, seed, number);
        match check(&tree.current(), number.into()) {
            Ok(changes) => counts.iter_mut().zip(changes).for_each(|(count, changes)| *count += u32::from(changes)),
            Err(reason) => {
                simplify(&mut tree, |scene| check(scene, number.into()).is_err());
                let simplest = tree.current();
                let told = check(&simplest, number.into()).err();
                panic!("scene {number}: {reason}\nat its simplest: {told:?} {simplest:#?}");
            }
        }
    }
    println!("{scenes} scenes, {counts:?} of them changed");
    assert!(scenes < 30 || counts.iter().all(|count| *count > scenes / 20), "{counts:?}");
}

#[test]
fn relations_hold_in_random_scenes() {
    hold(&random_scene::scene(), 1);
}

#[test]
fn relations_hold_in_wider_random_scenes() {
    hold(&random_scene::wide::scene(), 1);
}

#[test]
fn relations_hold_in_broad_random_scenes() {
    hold(&random_scene::wide::broad::scene(), 10);
}

#[test]
fn relations_hold_in_extreme_random_scenes() {
    hold(&random_scene::wide::extreme::scene(), 1);
}

/// Small scenes of the repository; large ones would take as long as all others together.
#[test]
fn relations_hold_in_scenes_of_the_repository() {
    let mut checked = 0;
    for path in scene_files::below(&at("vectors/scenes")) {
        let scene = scene::load(&path, &Limits::default()).unwrap().scene;
        let pixels: u32 = scene.targets.iter().map(|target| target.width * target.height).sum();
        if pixels <= 320 * 240 && Plan::compile(&scene, &PlanOptions::default()).is_ok() {
            check(&scene, 1).unwrap_or_else(|reason| panic!("{}: {reason}", path.display()));
            checked += 1;
        }
    }
    assert!(checked > 20, "{checked}");
}
