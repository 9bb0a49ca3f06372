//! Tests per-pixel lighting and renormalisation: the error of each picture, and the limits of a technique.
//!
//! Bounds are wide, in steps of 1/255. They state what a technique is good for, not its exact bits.

use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
use ninebit_scene as scene;

use super::{Figures, all_pinned, folder, pinned};

/// Scene, and the lowest and highest RMS error that it may have.
const BOUNDS: &[(&str, f64, f64)] = &[
    ("coarse-light", 6.5, 9.9),
    ("coarse-light-renormalised", 3.3, 5.0),
    ("dotproduct3-fallback", 1.8, 2.8),
    ("dotproduct3-fallback-stone", 1.0, 1.7),
    ("emboss", 65.0, 89.0),
    ("emboss-2x", 26.0, 36.0),
    ("emboss-2x-blend", 26.0, 36.0),
    ("emboss-2x-far", 16.0, 22.0),
    ("emboss-specular", 37.0, 51.0),
    ("emboss-specular-far", 33.0, 46.0),
    ("emboss-specular-map", 71.0, 98.0),
    ("hemisphere-exact", 0.3, 0.5),
    ("hemisphere-exact-occlusion", 0.4, 0.7),
    ("hemisphere-exact-occlusion-sun", 0.7, 1.1),
    ("hemisphere-pixel", 0.4, 0.7),
    ("hemisphere-pixel-cube", 0.3, 0.7),
    ("hemisphere-pixel-for-exact", 16.0, 23.0),
    ("hemisphere-pixel-half-ball", 0.4, 0.8),
    ("hemisphere-pixel-occlusion", 0.5, 0.8),
    ("hemisphere-pixel-occlusion-sun", 0.7, 1.1),
    ("hemisphere-pixel-saturated", 17.0, 24.0),
    ("hemisphere-pixel-saturated-for-exact", 13.0, 19.0),
    ("hemisphere-pixel-stone", 0.7, 1.2),
    ("hemisphere-pixel-sun", 0.6, 1.1),
    ("hemisphere-vertex", 0.3, 0.5),
    ("hemisphere-vertex-bumps", 8.0, 12.0),
    ("hemisphere-vertex-bumps-exact", 3.9, 5.4),
    ("hemisphere-vertex-exact", 0.2, 0.5),
    ("hemisphere-vertex-occlusion", 3.3, 5.1),
    ("hemisphere-vertex-sun", 0.3, 0.5),
    ("highlight-map", 38.0, 53.0),
    ("specular-16", 9.0, 14.0),
    ("specular-16-diffuse", 4.3, 6.6),
    ("specular-16-renormalised", 2.9, 4.4),
    ("specular-2", 3.0, 4.7),
    ("specular-32", 13.0, 18.0),
    ("specular-4", 4.6, 7.0),
    ("specular-8", 6.6, 10.0),
    ("specular-8-renormalised", 2.1, 3.2),
    ("specular-table-100-1024", 7.3, 11.1),
    ("specular-table-100-256", 7.2, 10.9),
    ("specular-table-100-256-coarse", 16.0, 22.0),
    ("specular-table-100-256-fine", 6.0, 9.2),
    ("specular-table-100-32", 17.0, 25.0),
    ("specular-table-16-256", 3.6, 5.5),
    ("specular-table-32-256", 5.2, 7.3),
    ("specular-table-400-1024", 9.0, 13.0),
    ("specular-table-400-256", 8.0, 13.0),
    ("specular-table-8-256", 2.6, 3.9),
    ("specular-table-diffuse", 2.2, 3.4),
    ("tangent-space-diffuse", 1.8, 2.8),
    ("tangent-space-diffuse-cross", 1.8, 2.8),
    ("tangent-space-diffuse-stone", 1.0, 1.7),
    ("world-space-diffuse", 1.1, 1.7),
];

fn of(name: &str) -> Figures {
    pinned(&format!("per-pixel-lighting/{name}"))
}

fn rms(name: &str) -> f64 {
    of(name).rms
}

/// Returns the bytes of the first target.
fn picture(name: &str) -> Vec<u8> {
    let path = folder().join(format!("per-pixel-lighting/{name}.ron"));
    let plan = scene::load(&path, &Limits::default()).unwrap_or_else(|error| panic!("{error}")).plan;
    let words = render(&plan, &RenderOptions::default()).surfaces.swap_remove(0).words;
    words.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// Returns in how many bytes two pictures differ, and the largest difference.
fn difference(names: [&str; 2]) -> (usize, u8) {
    let [one, other] = names.map(picture);
    let differences = one.into_iter().zip(other).map(|(a, b)| a.abs_diff(b)).filter(|difference| *difference != 0);
    differences.fold((0, 0), |(count, largest), difference| (count + 1, largest.max(difference)))
}

#[test]
fn techniques_are_as_exact_as_they_ought_to_be() {
    let names: Vec<&str> = BOUNDS.iter().map(|(name, ..)| *name).collect();
    let known = all_pinned();
    assert_eq!(known.keys().filter_map(|name| name.strip_prefix("per-pixel-lighting/")).collect::<Vec<_>>(), names);
    let outside: Vec<String> = BOUNDS
        .iter()
        .map(|(name, least, most)| (name, least..=most, rms(name)))
        .filter(|(_, bounds, rms)| !bounds.contains(&rms))
        .map(|(name, bounds, rms)| format!("{name}: {rms:.3}, not {bounds:?}"))
        .collect();
    assert!(outside.is_empty(), "{}", outside.join("\n"));
}

/// One scene runs on the Xbox, the other on the GeForce 256, whose coordinates differ slightly where they change quickly.
#[test]
fn the_fallback_by_dot_product_shows_what_the_pixel_shader_shows() {
    for end in ["", "-stone"] {
        let names = ["tangent-space-diffuse", "dotproduct3-fallback"].map(|name| format!("{name}{end}"));
        let (count, largest) = difference(names.each_ref().map(String::as_str));
        assert!(count <= 40 && largest <= 6, "{end}: {count} {largest}");
    }
}

#[test]
fn a_binormal_made_by_a_cross_product_is_the_mesh_s() {
    assert_eq!(difference(["tangent-space-diffuse", "tangent-space-diffuse-cross"]), (0, 0));
}

/// The third stage reads nine bits with a sign, whereas blending reads the eight of the frame buffer.
#[test]
fn doubling_by_blending_is_doubling_in_the_stages() {
    let (_, largest) = difference(["emboss-2x", "emboss-2x-blend"]);
    assert!((1..=2).contains(&largest), "{largest}");
}

/// Each squaring loses many of the remaining levels of the highlight, whose truth has 128. A table keeps them.
#[test]
fn squaring_bands_and_a_table_does_not() {
    let levels = [2, 4, 8, 16, 32].map(|exponent| of(&format!("specular-{exponent}")).levels);
    assert!(levels.windows(2).all(|pair| pair[1] * 4 <= pair[0] * 3), "{levels:?}");
    assert!(levels[3] <= 24 && levels[4] <= 14, "{levels:?}");
    assert!(of("specular-table-16-256").levels >= 100);
    assert!(of("specular-16").truth_levels >= 100);
}

/// The last of 32 entries stands for 63/64. To the power of 100 this is a fifth, so the highlight is a single dim grey.
#[test]
fn a_small_table_is_too_coarse_for_a_large_exponent() {
    let levels = |entries: u32| of(&format!("specular-table-100-{entries}")).levels;
    assert!(levels(32) <= 3 && levels(256) > 80 && levels(1024) > 80);
    assert!(rms("specular-table-100-32") > 1.5 * rms("specular-table-100-256"));
    // More entries do not help. The remaining error comes from half vectors that interpolation shortens, and from filtered normals.
    assert!((rms("specular-table-100-1024") - rms("specular-table-100-256")).abs() < 0.5);
    assert!(rms("specular-table-100-256-fine") < rms("specular-table-100-256"));
    assert!(rms("specular-table-100-256-coarse") > 1.5 * rms("specular-table-100-256"));
}

/// (3 - v.v) / 2 restores most of the length that a vector lost in filtering or interpolation.
#[test]
fn vectors_brought_back_to_length_pay() {
    for (name, most) in [("coarse-light", 0.6), ("specular-8", 0.5), ("specular-16", 0.5)] {
        let [without, with] = [name.to_owned(), format!("{name}-renormalised")].map(|name| rms(&name));
        assert!(with < most * without, "{name}: {without} {with}");
    }
    for name in ["diffuse", "specular"] {
        let [without, with] = ["plain", "renormalised"].map(|end| pinned(&format!("renormalisation/{name}-{end}")).rms);
        assert!(with < 0.4 * without, "{name}: {without} {with}");
    }
}

/// The simplified integral matches its own truth. Compared with the exact integral it has too much contrast.
#[test]
fn the_simplified_integral_is_not_the_exact_one() {
    assert!(rms("hemisphere-pixel") < 1.0 && rms("hemisphere-exact") < 1.0);
    assert!(rms("hemisphere-pixel-for-exact") > 15.0);
    assert_eq!(difference(["hemisphere-pixel", "hemisphere-pixel-for-exact"]), (0, 0));
    // Lighting at the vertices does not see bumps.
    assert!(rms("hemisphere-vertex") < 1.0 && rms("hemisphere-vertex-bumps") > 8.0);
}

/// Emboss alone is about one half everywhere. Multiplied by the light of the smooth surface it resembles lighting, and a larger offset
/// makes it stronger.
#[test]
fn emboss_needs_the_light_of_the_smooth_surface() {
    assert!(rms("emboss") > 60.0 && rms("emboss-2x") < 35.0);
    assert!(rms("emboss-2x-far") < 0.7 * rms("emboss-2x"));
    assert!(rms("tangent-space-diffuse") < 0.2 * rms("emboss-2x-far"));
    // Subtracting the embossed heights from a highlight makes a larger error than a highlight without bumps.
    assert!(rms("emboss-specular-map") > 1.5 * rms("highlight-map"));
    assert!(rms("emboss-specular") < rms("highlight-map"));
}
