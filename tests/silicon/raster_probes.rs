//! Probes of interpolated colours (WGT-1, INT-2).

use crate::build::{draw, target, vertex};
use crate::cases;
use crate::probes::{Answers, single};
use crate::sheet::OVER;
use crate::table::Row;
use ninebit::engine::{RenderOptions, render};
use ninebit::plan::{Plan, PlanOptions};
use ninebit::state::*;

/// Renders a whole frame and returns the pixels that the rows name.
fn pixels(scene: &Scene, rows: &[Row]) -> Answers {
    let plan = Plan::compile(scene, &PlanOptions::default()).unwrap();
    let frame = &render(&plan, &RenderOptions::default()).surfaces[0];
    let shown = frame.rgba8();
    let index = |row: &Row| row.number::<usize>("y") * frame.width as usize + row.number::<usize>("x");
    single(rows.iter().map(|row| shown[index(row)]).collect())
}

/// Draws the rows of `alpha-ramp`: quads of 512 x 64 pixels. Their area is a power of two, so S is, and no weight is cut.
pub fn alpha_ramp(rows: &[Row]) -> Answers {
    let frame = target(640, 480, SurfaceFormat::A8R8G8B8, rows[0].bytes("destination"));
    let mut scene =
        Scene { profile: Profile::Nv2a, targets: vec![frame], textures: vec![], palettes: vec![], draws: vec![] };
    for top in [149, 213, 277] {
        let Some(row) = rows.iter().find(|row| (top..top + 64).contains(&row.number::<u32>("y"))) else { continue };
        let [r, g, b] = row.bytes("source");
        let (left, right) = (row.number("left"), row.number("right"));
        let (y0, y1) = (top as f32, (top + 64) as f32);
        let corners = [(64.0, y0, left), (576.0, y0, right), (576.0, y1, right), (64.0, y1, left)];
        let vertices = corners.map(|(x, y, a)| vertex(x, y, [r, g, b, a]));
        scene.draws.push(Draw { blend: Some(OVER), ..draw(Topology::Quads, vertices.to_vec()) });
    }
    for row in rows {
        assert_eq!(row.number::<u32>("column") + 64, row.number::<u32>("x"));
    }
    pixels(&scene, rows)
}

/// Draws the rows of `triangle-weights`: the first triangle of R4, whose corners are pure blue, green and red.
pub fn triangle_weights(rows: &[Row]) -> Answers {
    let mut scene = cases::r4().scene;
    let draw = &mut scene.draws[0];
    draw.indices = draw.indices[..3].into();
    for row in rows {
        for (vertex, column) in draw.vertices.iter().zip(["color0", "color1", "color2"]) {
            let [r, g, b] = row.bytes(column);
            assert_eq!(vertex.diffuse, VertexColor::Bytes([r, g, b, 255]), "another triangle");
        }
    }
    pixels(&scene, rows)
}
