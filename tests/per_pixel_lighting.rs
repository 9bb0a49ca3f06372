//! The techniques of per-pixel lighting: how far each picture is from its truth, and where a technique breaks.
//!
//! Bounds are coarse, in steps of 1/255: they say what a technique is good for, not which bits it has.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use ninebit::accuracy::{Accuracy, measure};
use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
use ninebit::scene;
use rayon::prelude::*;

use crate::scene_files;

/// Scene, and between which RMS errors it lies.
const BOUNDS: &[(&str, f64, f64)] = &[
    ("coarse-light", 6.5, 9.9),
    ("coarse-light-renormalised", 3.3, 5.0),
    ("dotproduct3-fallback", 2.3, 3.6),
    ("dotproduct3-fallback-stone", 1.2, 1.9),
    ("emboss", 65.0, 89.0),
    ("emboss-2x", 26.0, 36.0),
    ("emboss-2x-blend", 26.0, 36.0),
    ("emboss-2x-far", 16.0, 22.0),
    ("emboss-specular", 36.0, 49.0),
    ("emboss-specular-far", 32.0, 44.0),
    ("emboss-specular-map", 73.0, 99.0),
    ("filtered-normals", 7.5, 11.4),
    ("filtered-normals-renormalised", 2.0, 3.2),
    ("hemisphere-exact", 0.2, 0.5),
    ("hemisphere-exact-occlusion", 0.4, 0.7),
    ("hemisphere-exact-occlusion-sun", 0.8, 1.3),
    ("hemisphere-pixel", 0.4, 0.8),
    ("hemisphere-pixel-for-exact", 16.0, 23.0),
    ("hemisphere-pixel-occlusion", 0.5, 0.9),
    ("hemisphere-pixel-occlusion-sun", 0.8, 1.3),
    ("hemisphere-pixel-stone", 0.7, 1.2),
    ("hemisphere-pixel-sun", 0.8, 1.3),
    ("hemisphere-vertex", 0.3, 0.6),
    ("hemisphere-vertex-bumps", 8.0, 12.0),
    ("hemisphere-vertex-exact", 0.3, 0.6),
    ("hemisphere-vertex-occlusion", 3.3, 5.1),
    ("hemisphere-vertex-sun", 0.4, 0.8),
    ("highlight-map", 38.0, 52.0),
    ("specular-16", 13.0, 19.0),
    ("specular-16-diffuse", 6.1, 9.2),
    ("specular-16-renormalised", 2.7, 4.2),
    ("specular-2", 4.5, 6.8),
    ("specular-32", 17.0, 25.0),
    ("specular-4", 6.8, 10.3),
    ("specular-8", 10.0, 14.0),
    ("specular-8-renormalised", 2.0, 3.1),
    ("specular-table-100-1024", 16.0, 23.0),
    ("specular-table-100-256", 16.0, 22.0),
    ("specular-table-100-256-fine", 6.0, 9.2),
    ("specular-table-100-32", 18.0, 25.0),
    ("specular-table-16-256", 8.0, 13.0),
    ("specular-table-400-1024", 13.0, 19.0),
    ("specular-table-400-256", 13.0, 19.0),
    ("specular-table-diffuse", 4.9, 7.5),
    ("tangent-space-diffuse", 2.3, 3.6),
    ("tangent-space-diffuse-cross", 2.3, 3.6),
    ("tangent-space-diffuse-stone", 1.2, 1.9),
    ("world-space-diffuse", 1.1, 1.7),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("vectors/scenes/techniques/per-pixel-lighting")
}

fn load(path: &Path) -> scene::Loaded {
    let loaded = scene::load(path, &Limits::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.render_warnings(false), "", "{}", path.display());
    loaded
}

/// Every scene of the folder, measured once for all tests.
fn measured() -> &'static BTreeMap<String, Accuracy> {
    static MEASURED: OnceLock<BTreeMap<String, Accuracy>> = OnceLock::new();
    MEASURED.get_or_init(|| {
        let files = scene_files::below(&folder());
        let figures = files.par_iter().map(|path| {
            let loaded = load(path);
            let truth = loaded.truth.as_ref().unwrap_or_else(|| panic!("{} has no truth", path.display()));
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            (name, measure(&loaded.scene, &loaded.plan, truth).unwrap())
        });
        figures.collect()
    })
}

fn of(name: &str) -> &'static Accuracy {
    measured().get(name).unwrap_or_else(|| panic!("no scene {name}"))
}

fn rms(name: &str) -> f64 {
    of(name).errors.rms()
}

/// The first target's words.
fn picture(name: &str) -> Vec<u32> {
    let plan = load(&folder().join(format!("{name}.ron"))).plan;
    render(&plan, &RenderOptions::default()).surfaces.swap_remove(0).words
}

#[test]
fn techniques_are_as_exact_as_they_ought_to_be() {
    let names: Vec<&str> = BOUNDS.iter().map(|(name, ..)| *name).collect();
    assert_eq!(measured().keys().map(String::as_str).collect::<Vec<_>>(), names);
    let outside: Vec<String> = BOUNDS
        .iter()
        .filter(|(name, least, most)| !(*least..=*most).contains(&rms(name)))
        .map(|(name, least, most)| format!("{name}: {:.3}, not {least} to {most}", rms(name)))
        .collect();
    assert!(outside.is_empty(), "{}", outside.join("\n"));
}

/// How many bytes two pictures differ in, and by how much at most.
fn difference(names: [&str; 2]) -> (usize, u8) {
    let [one, other] = names.map(|name| picture(name).into_iter().flat_map(u32::to_le_bytes).collect::<Vec<u8>>());
    let differences = one.into_iter().zip(other).map(|(a, b)| a.abs_diff(b)).filter(|difference| *difference != 0);
    differences.fold((0, 0), |(count, largest), difference| (count + 1, largest.max(difference)))
}

/// One runs on the Xbox, the other on the GeForce 256, which places coordinates a little differently where they run fast.
#[test]
fn the_fallback_by_dot_product_shows_what_the_pixel_shader_shows() {
    for end in ["", "-stone"] {
        let names = ["tangent-space-diffuse", "dotproduct3-fallback"].map(|name| format!("{name}{end}"));
        let (count, largest) = difference(names.each_ref().map(String::as_str));
        assert!(count <= 20 && largest <= 4, "{end}: {count} {largest}");
    }
}

#[test]
fn a_binormal_made_by_a_cross_product_is_the_mesh_s() {
    assert_eq!(difference(["tangent-space-diffuse", "tangent-space-diffuse-cross"]), (0, 0));
}

/// The third stage reads nine bits with a sign, blending the eight of the frame buffer.
#[test]
fn doubling_by_blending_is_doubling_in_the_stages() {
    let (_, largest) = difference(["emboss-2x", "emboss-2x-blend"]);
    assert!((1..=2).contains(&largest), "{largest}");
}

/// Each squaring halves the levels that are left of the highlight, whose truth has 128; a table keeps them.
#[test]
fn squaring_bands_and_a_table_does_not() {
    let levels = [2, 4, 8, 16, 32].map(|exponent| of(&format!("specular-{exponent}")).banding.levels);
    assert!(levels.windows(2).all(|pair| pair[1] * 4 <= pair[0] * 3), "{levels:?}");
    assert!(levels[3] <= 20 && levels[4] <= 12, "{levels:?}");
    assert!(of("specular-table-16-256").banding.levels >= 100);
    assert!(of("specular-16").banding.truth_levels >= 100);
}

/// Of 32 entries hardly two lie within a highlight to the power of 100, and straight lines between them are what shows.
#[test]
fn a_small_table_is_too_coarse_for_a_large_exponent() {
    let levels = |entries: u32| of(&format!("specular-table-100-{entries}")).banding.levels;
    assert!(levels(32) < 30 && levels(256) > 80 && levels(1024) > 80);
    assert!(rms("specular-table-100-32") > rms("specular-table-100-256") + 1.0);
    // More entries do not help: what is left comes from half vectors that are too short between the vertices.
    assert!((rms("specular-table-100-1024") - rms("specular-table-100-256")).abs() < 0.5);
    assert!(rms("specular-table-100-256-fine") < 0.6 * rms("specular-table-100-256"));
}

/// (3 - v.v) / 2 brings back most of what a filter or an interpolation took from a vector's length.
#[test]
fn vectors_brought_back_to_length_pay() {
    for (name, most) in [("filtered-normals", 0.4), ("coarse-light", 0.6), ("specular-8", 0.3), ("specular-16", 0.3)] {
        let [without, with] = [name.to_owned(), format!("{name}-renormalised")].map(|name| rms(&name));
        assert!(with < most * without, "{name}: {without} {with}");
    }
    let stages = |name: &str| of(name).cost.stages;
    assert_eq!(stages("filtered-normals-renormalised") - stages("filtered-normals"), 2.0);
    assert!(of("filtered-normals").normals.is_some_and(|normals| normals.lengths.low < 0.75));
}

/// The simplified integral is its own truth; of the exact one it is off by what a quarter circle is off its chord.
#[test]
fn the_simplified_integral_is_not_the_exact_one() {
    assert!(rms("hemisphere-pixel") < 1.0 && rms("hemisphere-exact") < 1.0);
    assert!(rms("hemisphere-pixel-for-exact") > 15.0);
    assert!(picture("hemisphere-pixel") == picture("hemisphere-pixel-for-exact"));
    // Light of the vertices knows nothing of bumps.
    assert!(rms("hemisphere-vertex") < 1.0 && rms("hemisphere-vertex-bumps") > 8.0);
}

/// Emboss alone is about one half everywhere; with the light of the smooth surface it is a light, and a longer way a stronger one.
#[test]
fn emboss_needs_the_light_of_the_smooth_surface() {
    assert!(rms("emboss") > 60.0 && rms("emboss-2x") < 35.0);
    assert!(rms("emboss-2x-far") < 0.7 * rms("emboss-2x"));
    assert!(rms("tangent-space-diffuse") < 0.2 * rms("emboss-2x-far"));
    // A highlight less the heights is further off than a highlight without any bumps.
    assert!(rms("emboss-specular-map") > 1.5 * rms("highlight-map"));
    assert!(rms("emboss-specular") < rms("highlight-map"));
}
