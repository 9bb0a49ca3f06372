//! Scenes that decide claims of 2002, and listings of published texts that fail, tested with wide bounds.

use super::pinned;
use ninebit::limits::Limits;
use ninebit_lab::accuracy::measure;
use ninebit_scene as scene;

fn rms(name: &str) -> f64 {
    pinned(name).rms
}

/// Normalisation in combiner stages is better than a cube map with 8 bits, and a map with 16 bits is better than both. All are better than
/// lighting at the vertices, which is better than no normalisation.
#[test]
fn sixteen_bits_then_stages_then_eight_bits() {
    let of = |name: &str| rms(&format!("normalisation/smooth-{name}"));
    let order = ["cube-16-table", "combiners", "cube-8", "vertex", "plain"].map(of);
    assert!(order.windows(2).all(|pair| 1.2 * pair[0] < pair[1]), "{order:?}");
    assert!(order[0] < 1.0, "{order:?}");
}

#[test]
fn a_table_keeps_the_levels_that_squaring_loses() {
    let levels = |name: &str| {
        let figures = pinned(&format!("normalisation/smooth-{name}"));
        (figures.levels, figures.truth_levels)
    };
    let (squared, table) = (levels("cube-8"), levels("cube-8-table"));
    assert!(squared.0 < 40 && table.0 > 110 && table.1 > 110, "{squared:?} {table:?}");
}

#[test]
fn the_neutral_normal_is_upright() {
    let path = super::folder().join("normalisation/neutral.ron");
    let loaded = scene::load(&path, &Limits::default()).unwrap_or_else(|error| panic!("{error}"));
    let accuracy = measure(&loaded.scene, &loaded.plan, loaded.truth.as_ref().unwrap()).unwrap();
    assert_eq!(accuracy.normals.unwrap().degrees.max(), 0.0);
}

/// A value that saturates before one half is added ends at one half. The error is up to half of the difference between sky and ground.
#[test]
fn a_listing_that_saturates_too_early_fails_below_the_horizon() {
    let of = |name: &str| pinned(&format!("per-pixel-lighting/{name}"));
    let (early, right) = (of("hemisphere-pixel-saturated"), of("hemisphere-pixel"));
    assert!(early.max > 80.0 && early.max <= 105.0, "{}", early.max);
    assert!(early.rms > 20.0 * right.rms && early.bias > 0.0);
}

#[test]
fn a_ceiling_may_be_lit_with_its_own_normal() {
    assert!(rms("dot-product-texture-blending/diffuse-ceiling-own-normal") < 3.0);
}

/// Twelve passes are asked for, and a chip has to draw all of them. Pruning leaves five. With two units three passes are enough.
#[test]
fn passes_as_asked_and_after_pruning() {
    let passes = |name: &str| pinned(&format!("orthogonal-illumination-mapping/{name}")).passes;
    assert_eq!(["height-12", "height-5", "height-3"].map(passes), [(12, 5), (5, 5), (3, 3)]);
    assert_eq!(["dot-12", "illumination"].map(passes), [(12, 9), (26, 20)]);
}
