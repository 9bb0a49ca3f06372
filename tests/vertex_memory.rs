//! Tests how much memory vertices take: what a scene holds for each of them, and the peak of the program.

use super::bench::Bench;
use ninebit::limits::Limits;
use ninebit::plan::{Plan, PlanOptions};
use ninebit_scene as scene;
use std::path::Path;

/// Returns a scene with a mesh over the whole frame. Its vertices differ in x, y, s, t and two channels of the diffuse colour.
fn text(columns: u32, rows: u32, width: u32, height: u32) -> String {
    format!(
        "(version: 1, profile: Nv2a, targets: [(name: \"frame\", width: {width}, height: {height})], \
         textures: {{\"checks\": (source: Checker(width: 64, height: 64, cell: 8))}}, \
         draws: [(vertices: Matrix(matrix: Identity, mesh: Grid(columns: {columns}, rows: {rows}, repeat: (9, 7)), diffuse: Position), \
         textures: [(texture: \"checks\", min_filter: Linear, mag_filter: Linear)])])"
    )
}

/// The scene and the plan each hold six columns of floats. Beyond that, the triangles of the plan hold only their corners.
#[test]
fn what_vertices_have_in_common_is_held_once() {
    let loaded = scene::parse(&text(100, 50, 64, 64), Path::new("."), &Limits::default()).unwrap();
    let draw = &loaded.scene.draws[0];
    let plan = Plan::compile(&loaded.scene, &PlanOptions::default()).unwrap();
    let assembly = &plan.draws()[0].assembly;
    assert_eq!((draw.vertices.len(), assembly.triangles.len()), (101 * 51, 100 * 50 * 2));
    assert_eq!(draw.vertices.bytes(), 6 * 4 * draw.vertices.len());
    assert_eq!(assembly.vertices.bytes(), draw.vertices.bytes());
    assert!(size_of_val(&assembly.corners[..]) <= 20 * draw.vertices.len());
}

/// A million triangles need at most 64 MB besides the frame, from the text to the picture. On systems that do not report the peak nothing
/// is tested.
#[test]
fn a_million_triangles_fit_into_64_megabytes() {
    let bench = Bench::new();
    bench.write("grid.ron", text(1000, 500, 1600, 1250));
    let told = bench.run("bench grid.ron --frames 1 --format json --threads 1").data();
    let told: serde_json::Value = serde_json::from_slice(&told).unwrap();
    if let Some(peak) = told["scenes"][0]["peak_memory_bytes"].as_u64() {
        assert!(peak <= (64 << 20) + 4 * 1600 * 1250, "{peak} bytes");
    }
}
