//! Draws fog at the pixels of `fog-lerp` from the vertices of the captured programs.
//!
//! Four white triangles lie before a viewer at z = -7, in linear fog from 1 to 200 or in fog of density 0.025. The suites differ only in
//! the position of the viewport.

use crate::table;
use ninebit::engine::{RenderOptions, render};
use ninebit::frame::Surface;
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit_scene as scene;
use std::collections::BTreeMap;
use std::path::Path;

/// x, y and z of the vertices, three for each triangle.
const VERTICES: &str = "(position: (-1.5, -1.5, 0)), (position: (-2.5, 0.6, 0)), (position: (-0.5, 0.6, 0)), \
     (position: (0, -1.5, 5)), (position: (-1, 0.75, 10)), (position: (2, 0.75, 20)), \
     (position: (5, -2, 30)), (position: (3, 2, 40)), (position: (12, 2, 70)), \
     (position: (20, -10, 50)), (position: (12, 10, 125)), (position: (80, 10, 200))";

/// Renders one of the frames.
fn frame(suite: &str, case: &str) -> Surface {
    let offset = if suite == "Fog" { 0.53125 } else { 0.0 };
    let (mode, parameters) = match case {
        "AFF-linear_abs-planar" => ("LinearAbs", "start: 1, end: 200"),
        "AFF-exp_abs-planar" => ("ExpAbs", "density: 0.025"),
        "AFF-exp2-planar" => ("Exp2", "density: 0.025"),
        "AFF-exp2_abs-planar" => ("Exp2Abs", "density: 0.025"),
        _ => panic!("{case}"),
    };
    // The field of view is 45 degrees: 1 / tan(22.5 degrees) vertically, and 3/4 of it horizontally.
    let text = format!(
        "(version: 1, profile: Nv2a, targets: [(width: 640, height: 480)], draws: [(vertices: Matrix( \
         matrix: Rows((1.8106601, 0, 0, 0), (0, 2.4142135, 0, 0), (0, 0, 0, 0), (0, 0, 1, 7)), \
         model_view: Translate(0, 0, 7), viewport: (x: {offset}, y: {offset}), vertices: [{VERTICES}]), \
         fog: (mode: {mode}, {parameters}, coordinate_source: EyePlane, color: (48, 32, 127)))])"
    );
    let loaded = scene::parse(&text, Path::new("fog.ron"), &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
    let plan = Plan::compile(&loaded.scene, &PlanOptions::default()).unwrap();
    render(&plan, &RenderOptions::default()).surfaces.remove(0)
}

/// Returns the fog byte that blends white and the fog colour to this colour.
fn byte([r, g, b]: [u8; 3]) -> i32 {
    let lerp = |a: i32, c: i32| (2 * (255 * a + (255 - a) * c) + 255) / 510;
    let found: Vec<i32> = (0..256).filter(|a| [48, 32, 127].map(|c| lerp(*a, c)) == [r, g, b].map(i32::from)).collect();
    assert_eq!(found.len(), 1, "{r} {g} {b}");
    found[0]
}

/// The fog byte equals the captured one at every pixel and in each mode.
#[test]
fn fog_of_the_captured_triangles() {
    let mut frames: BTreeMap<(String, String), Surface> = BTreeMap::new();
    let mut differences: BTreeMap<(String, i32), usize> = BTreeMap::new();
    for row in &table::read("fog-lerp") {
        let (suite, case) = (row.text("suite"), row.text("case"));
        let surface = frames.entry((suite.to_string(), case.to_string())).or_insert_with(|| frame(suite, case));
        let at = |column: &str| row.number::<usize>(column);
        let word = surface.words[at("y") * 640 + at("x")];
        let captured = row.captured();
        let shown = [16, 8, 0].map(|bits| (word >> bits) as u8);
        let difference = byte(shown) - byte([captured[0], captured[1], captured[2]]);
        *differences.entry((case.to_string(), difference)).or_default() += 1;
    }
    println!("{differences:?}");
    // One pixel of the 1,493 lies at a tie of the coordinate (WGT-1) and differs by one step.
    let wrong: Vec<_> = differences.iter().filter(|((_, difference), _)| *difference != 0).collect();
    assert_eq!(wrong, [(&("AFF-exp_abs-planar".to_string(), 1), &1)], "{differences:?}");
    assert_eq!(differences[&("AFF-linear_abs-planar".to_string(), 0)], 458);
    assert_eq!(differences.values().sum::<usize>(), 1493);
}
