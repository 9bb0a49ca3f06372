//! Tests the passes of orthogonal illumination mapping: which are left out, and what that changes.

use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
use ninebit_report::explain::explain;
use ninebit_scene::{self as scene, LoadedScene};

fn load(name: &str) -> LoadedScene {
    let path = super::folder().join("orthogonal-illumination-mapping").join(name).with_extension("ron");
    scene::load(&path, &Limits::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn words(loaded: &LoadedScene) -> Vec<u32> {
    render(&loaded.plan, &RenderOptions::default()).surfaces[0].words.clone()
}

/// Returns the names of the draws that are left out because they change nothing visible.
fn left_out(loaded: &LoadedScene) -> Vec<String> {
    let draws = explain(&loaded.scene, &loaded.plan);
    let gone = draws.into_iter().filter(|draw| draw.dropped.iter().any(|line| line.starts_with("the whole draw:")));
    gone.map(|draw| draw.name).collect()
}

#[test]
fn half_components_that_are_zero_drop_their_passes() {
    let (twelve, five) = (load("height-12"), load("height-5"));
    assert_eq!((twelve.scene.draws.len(), five.scene.draws.len()), (12, 5));
    let expected = ["x- L.x-", "y- L.y-", "z- L.z-", "x+ L.x-", "y+ L.y-", "z+ L.z-", "z- L.z+"];
    assert_eq!(left_out(&twelve), expected.map(|pair| format!("n.{pair}")));
    assert!(left_out(&five).is_empty());
    assert_eq!(words(&twelve), words(&five));
}

#[test]
fn three_passes_of_two_units_are_nearly_the_same() {
    let (five, three) = (load("height-5"), load("height-3"));
    assert_eq!(three.scene.draws.len(), 3);
    let apart = |(a, b): (&u32, &u32)| (a & 0xff).abs_diff(b & 0xff);
    assert!(words(&five).iter().zip(&words(&three)).map(apart).max() <= Some(2));
}

/// At every pixel only one of the four halves of a product is not zero, so the approximate subtraction has nothing to subtract from.
#[test]
fn one_signed_product_does_not_tell_the_subtractions_apart() {
    assert_eq!(words(&load("signed-product")), words(&load("signed-product-approximate")));
    assert_ne!(words(&load("difference")), words(&load("difference-approximate")));
}

#[test]
fn the_full_illumination_takes_26_passes_a_lamp() {
    assert_eq!(load("illumination").scene.draws.len(), 26);
    assert_eq!(load("illumination-two-lamps").scene.draws.len(), 52);
}
