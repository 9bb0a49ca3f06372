//! Tests RAS-6 and RAS-7 on whole scenes: outside the planes nothing is drawn, inside them everything stays where it was, and traces and
//! explanations report the cut.
use super::bench::Bench;
use crate::repository::at;
use ninebit::engine::{RenderOptions, render, trace};
use ninebit::frame::Frames;
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::raster::project::ClipPlane;
use ninebit::state::{Positions, Scene};
use ninebit_scene::{self as scene, LoadedScene};
use ninebit_test_support::random_scene;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use std::path::Path;

/// Returns a scene of one draw, white on black, on 64 x 64 pixels.
fn text(vertices: &str) -> String {
    format!(
        "(version: 1, profile: Nv2a, targets: [(name: \"frame\", width: 64, height: 64)], draws: [(name: \"it\", vertices: {vertices}, \
         topology: Quads)])"
    )
}

fn plan(text: &str) -> Plan {
    scene::parse(text, Path::new("."), &Limits::default()).unwrap_or_else(|e| panic!("{e:?}")).plan
}

fn drawn(plan: &Plan) -> Frames {
    render(plan, &RenderOptions::default())
}

/// Returns the number of white pixels.
fn white(plan: &Plan) -> usize {
    drawn(plan).surfaces[0].words.iter().filter(|word| **word == 0xffff_ffff).count()
}

const VIEW: &str = "Frustum(left: -1, right: 1, bottom: -1, top: 1, near: 1, far: 10)";

fn floor(matrix: &str, from: f32, to: f32) -> String {
    text(&format!(
        "Matrix(matrix: {matrix}, vertices: [(position: (-1000, -1, {from})), (position: (1000, -1, {from})), (position: (1000, -1, {to})), \
         (position: (-1000, -1, {to}))])"
    ))
}

#[test]
fn a_floor_that_passes_the_viewer_reaches_from_near_to_far() {
    // At z = -10 the floor appears at y = -0.1, row 35.2. It covers the rows below, down to the last one at z = -1.
    let whole = plan(&floor(VIEW, 50.0, -500.0));
    assert_eq!(white(&whole), 64 * (64 - 35));
    let planes: Vec<ClipPlane> = ClipPlane::in_set(whole.draws()[0].assembly.clipping.planes).collect();
    assert_eq!(planes, [ClipPlane::Near, ClipPlane::Far, ClipPlane::Left, ClipPlane::Right]);
    // A floor that already ends at both planes yields the same picture.
    assert_eq!(white(&plan(&floor(VIEW, -1.0, -10.0))), white(&whole));
}

#[test]
fn what_lies_beyond_a_plane_is_not_drawn() {
    let quad = |matrix: &str, z: f32| {
        text(&format!(
            "Matrix(matrix: {matrix}, vertices: [(position: (-9, -9, {z})), (position: (9, -9, {z})), (position: (9, 9, {z})), (position: \
             (-9, 9, {z}))])"
        ))
    };
    let ortho = "Orthographic(left: -1, right: 1, bottom: -1, top: 1, near: -2, far: 2)";
    for (matrix, z, pixels) in [
        (VIEW, -1.001, 4096),
        (VIEW, -0.99, 0),
        (VIEW, -9.99, 3325),
        (VIEW, -10.01, 0),
        (VIEW, 5.0, 0),
        (ortho, 2.0, 4096),
        (ortho, -2.0, 4096),
        (ortho, 2.01, 0),
        (ortho, -2.01, 0),
    ] {
        let plan = plan(&quad(matrix, z));
        let got = white(&plan);
        assert!(got.abs_diff(pixels) < 250 && (got == 0) == (pixels == 0), "{matrix} at {z}: {got}");
        assert_eq!(plan.draws()[0].assembly.clipping.removed, if pixels == 0 { 2 } else { 0 });
    }
    // With clamped depths everything in front of the viewer is drawn.
    let clamped = quad(VIEW, -10.5).replace("vertices: [(", "viewport: (depth_clamp: true), vertices: [(");
    assert!(white(&plan(&clamped)) > 2500);
}

#[test]
fn flat_pieces_take_the_colour_of_their_triangle() {
    // The provoking vertex, which is the last one, is red and lies behind the viewer.
    let text = format!(
        "(version: 1, profile: Nv2a, targets: [(name: \"frame\", width: 64, height: 64)], draws: [(name: \"it\", shade_model: Flat, \
         vertices: Matrix(matrix: {VIEW}, vertices: [(position: (-2, -1, -2), diffuse: (0, 255, 0)), (position: (2, -1, -2), diffuse: (0, 255, 0)), \
         (position: (0, -1, 4), diffuse: (255, 0, 0))]))])"
    );
    let frames = drawn(&plan(&text));
    let colours: std::collections::BTreeSet<u32> = frames.surfaces[0].words.iter().copied().collect();
    assert_eq!(colours.into_iter().collect::<Vec<_>>(), [0xff00_0000, 0xffff_0000]);
}

#[test]
fn traces_and_explanations_tell_what_was_cut() {
    let bench = Bench::new();
    bench.write("floor.ron", floor(VIEW, 50.0, -500.0)).write("far.ron", floor(VIEW, -2.0, -8.0).replace("1000", "2"));
    let told = |arguments: &str| String::from_utf8(bench.run(arguments).data()).unwrap();
    assert!(
        told("trace floor.ron --pixel 32,60").contains(", cut off triangle 0 (RAS-6: near, far, left, right)"),
        "{}",
        told("trace floor.ron --pixel 32,60")
    );
    let document: serde_json::Value =
        serde_json::from_str(&told("trace floor.ron --pixel 32,60 --format json")).unwrap();
    assert_eq!(document["draws"][0]["clipped"]["triangle"], 0);
    assert_eq!(document["draws"][0]["clipped"]["planes"][0], "near");
    let explained = told("explain floor.ron");
    assert!(explained.contains("clipping (RAS-6): 2 triangles: 0 removed and 2 cut into"), "{explained}");
    let whole = told("trace far.ron --pixel 32,44 --format json");
    assert!(whole.contains("\"triangle\"") && !whole.contains("clipped"), "{whole}");
    assert!(!told("explain far.ron").contains("RAS-6"));
}

/// Random scenes with vertices around the viewer: clipped pieces are in the order of their triangles, at most eight for each, and pixels
/// can be traced.
#[test]
fn pieces_of_random_scenes_are_in_order() {
    let strategy = random_scene::wide::scene();
    let mut runner = TestRunner::deterministic();
    let (mut pieces, mut planes) = (0, 0);
    for _ in 0..600 {
        let scene = strategy.new_tree(&mut runner).unwrap().current();
        let plan = Plan::compile(&scene, &PlanOptions::default()).unwrap();
        for (draw, planned) in scene.draws.iter().zip(plan.draws()) {
            let clipping = &planned.assembly.clipping;
            assert!(clipping.planes == 0 || matches!(draw.positions, Positions::Clip(_)));
            assert!(clipping.pieces.windows(2).all(|pair| pair[0].number < pair[1].number && pair[0].of <= pair[1].of));
            assert!(clipping.pieces.iter().all(|piece| piece.number < planned.assembly.triangles.len()));
            assert!(clipping.cut <= clipping.pieces.len() && clipping.pieces.len() <= 8 * clipping.cut);
            planes |= clipping.planes;
            pieces += clipping.pieces.len();
        }
        trace(&plan, 0, (0, 0), None).unwrap();
    }
    assert!(pieces > 500 && planes == 0x7f, "{pieces} pieces, planes {planes:#x}");
}

#[test]
fn the_corridor_is_cut_on_all_sides() {
    let path = at("vectors/scenes/clipping/corridor.ron");
    let LoadedScene { scene, plan, .. } = scene::load(&path, &Limits::default()).unwrap();
    let planes = plan.draws().iter().fold(0, |set, draw| set | draw.assembly.clipping.planes);
    for plane in [ClipPlane::Near, ClipPlane::Far] {
        assert!(planes & plane.bit() != 0, "{plane:?}");
    }
    assert!(planes & !(ClipPlane::Near.bit() | ClipPlane::Far.bit() | ClipPlane::W.bit()) != 0, "no guard band");
    // The viewer stands inside the corridor, so every pixel is drawn except for those at the far end.
    let empty = Plan::compile(&Scene { draws: Vec::new(), ..scene }, &PlanOptions::default()).unwrap();
    let clear = drawn(&empty).surfaces[0].words[0];
    let open = drawn(&plan).surfaces[0].words.iter().filter(|word| **word == clear).count();
    assert!(open < 480 * 360 / 50, "{open}");
}

/// A mesh whose sides are those of the clip space fills the largest target, and no triangle is removed.
#[test]
fn the_largest_target_is_within_reach() {
    let text = "(version: 1, profile: Nv2a, targets: [(name: \"a\", width: 4096, height: 4096)],
        draws: [(vertices: Matrix(mesh: Grid(columns: 1, rows: 1), matrix: Orthographic(left: -1, right: 1, bottom: -1, top: 1, near: -2, far: 2)))])";
    let plan = plan(text);
    assert_eq!(plan.draws()[0].assembly.clipping.removed, 0);
    assert_eq!(white(&plan), 4096 * 4096);
}
