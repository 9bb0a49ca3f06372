//! Computes the examples of the section "Raster operations".

use crate::handbook::beside_rows;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::rop::surface;
use ninebit::state::*;

#[test]
fn examples_of_raster_operations() {
    beside_rows("ROP-2").gives("the sum", 200 * 128 + 51 * 127, 32_077);
    beside_rows("ROP-3").gives("s8(200)", 200_u8 as i8, -56);

    let rop6 = beside_rows("ROP-6");
    let mask = surface::write_mask(SurfaceFormat::A8R8G8B8, [true, false, false, true]);
    rop6.gives("the mask", mask, 0xffff_0000);
}

/// Returns the pixels that a draw may touch.
fn touched(target: Target, draw: Draw) -> Vec<(u32, u32)> {
    let draw = Draw { color_mask: [true; 4], ..draw };
    let scene = Scene { targets: vec![target], draws: vec![draw], ..Scene::default() };
    let plan = Plan::compile(&scene, &PlanOptions { prune: false, ..PlanOptions::default() }).unwrap();
    let pixels = |w: &Rectangle| {
        let (columns, rows) = (w.x..w.x + w.width, w.y..w.y + w.height);
        rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
    };
    plan.draws()[0].windows.iter().flat_map(pixels).collect()
}

#[test]
fn examples_of_tests() {
    let clp1 = beside_rows("CLP-1");
    let clipped = |exclusive| {
        let rectangles = vec![Rectangle { x: 0, y: 0, width: 2, height: 2 }];
        let draw = Draw { window_clip: Some(WindowClip { rectangles, exclusive }), ..Draw::default() };
        touched(Target::new(8, 8, SurfaceFormat::A8R8G8B8), draw).len()
    };
    clp1.gives("inclusive", clipped(false), 4).gives("exclusive", clipped(true), 60);
}
