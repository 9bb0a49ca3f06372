//! Examples of the section "Raster operations".

use crate::handbook::example;
use crate::pixel::{Pixel, covering, scene};
use ninebit::combiner::direct::Direct;
use ninebit::plan::{Plan, PlanOptions};
use ninebit::rop::{blend, stencil, surface};
use ninebit::state::*;
use ninebit::trace::Silent;

const OVER: Blend = Blend {
    equation: BlendEquation::Add,
    source: BlendFactor::SourceAlpha,
    destination: BlendFactor::OneMinusSourceAlpha,
};

/// R, G, B, A of a blend of all channels.
fn blended(blend: Blend, source: [i32; 4], destination: [i32; 4]) -> [i32; 4] {
    blend::run(&blend, 15, [0; 4], &source, &destination, &mut Silent)
}

#[test]
fn examples_of_raster_operations() {
    let rop1 = example("ROP-1", "alpha 127 against reference 127: Greater fails, GreaterOrEqual passes.");
    let passes = |function| blend::alpha_test(&AlphaTest { function, reference: 127 }, 127, &mut Silent);
    rop1.gives("Greater", passes(CompareFunction::Greater), false);
    rop1.gives("GreaterOrEqual", passes(CompareFunction::GreaterOrEqual), true);

    let rop2 = example(
        "ROP-2",
        "S 200 with alpha 128 over D 51: rnd255(200 * 128 + 51 * 127) = rnd255(32077) = 126; two roundings would give 100 + 25.",
    );
    rop2.gives("the sum", 200 * 128 + 51 * 127, 32_077);
    rop2.gives("the blend", blended(OVER, [200, 200, 200, 128], [51; 4])[0], 126);
    // One of the two terms at a time.
    let alone = |source, destination| blended(OVER, [source, source, source, 128], [destination; 4])[0];
    rop2.gives("the terms alone", [alone(200, 0), alone(0, 51)], [100, 25]);

    let rop3 = example("ROP-3", "S = 200 is -56: D = 127 becomes 71, reverse 183.");
    let signed = |equation| blended(Blend { equation, ..OVER }, [200; 4], [127; 4])[0];
    rop3.gives("s8(200)", 200_u8 as i8, -56).gives("SignedAdd", signed(BlendEquation::SignedAdd), 71);
    rop3.gives("SignedReverseSubtract", signed(BlendEquation::SignedReverseSubtract), 183);

    let rop4 = example("ROP-4", "sa 100, da 200: saturate is 55 for colour, 255 for alpha.");
    // Times a source of 255 a factor is itself; alpha is the source's 100.
    let source = BlendFactor::SourceAlphaSaturate;
    let saturated = blended(
        Blend { equation: BlendEquation::Add, source, destination: BlendFactor::Zero },
        [255, 255, 255, 100],
        [0, 0, 0, 200],
    );
    rop4.gives("colour times 255, alpha times 100", saturated, [55, 55, 55, 100]);
    let factor = |channel| {
        let mut silent = Silent;
        let mut direct = Direct::plain(&mut silent);
        blend::factor(source, channel, &[255, 255, 255, 100], &[0, 0, 0, 200], &[0; 4], &mut direct)
    };
    rop4.gives("the factors", [0, 1, 2, 3].map(factor), [55, 55, 55, 255]);

    let rop5 =
        example("ROP-5", "R5G6B5, red S = 203, sa = 128, stored 12: rnd255(200 * 128 + 96 * 127) = 148, stored 18.");
    let diffuse = VertexColor::Bytes([203, 0, 0, 128]);
    let draw = Draw { blend: Some(OVER), ..covering(Vertex { diffuse, ..Vertex::default() }) };
    let pixel = Pixel::from_scene(
        &scene(Profile::Nv10, SurfaceFormat::R5G6B5, [12 << 3, 0, 0, 0], vec![draw]),
        Policies::DEFAULT,
    );
    rop5.gives("stored before", pixel.value("destination.word") >> 11, 12);
    rop5.gives("S and D", ["source.r", "destination.r"].map(|name| pixel.value(name)), [200, 96]);
    rop5.gives("the blend", pixel.value("blend.r"), 148).gives("stored", pixel.word >> 11, 18);

    let rop6 = example("ROP-6", "A8R8G8B8 with R and A let through has the mask 0xffff0000.");
    let mask = surface::write_mask(SurfaceFormat::A8R8G8B8, [true, false, false, true]);
    rop6.gives("the mask", mask, 0xffff_0000);
}

/// The pixels that a draw may touch.
fn touched(target: Target, draw: Draw) -> Vec<(u32, u32)> {
    let draw = Draw { color_mask: [true; 4], ..draw };
    let scene = Scene { targets: vec![target], draws: vec![draw], ..Scene::default() };
    let plan = Plan::compile(&scene, &PlanOptions { prune: false, ..PlanOptions::default() }).unwrap();
    let pixels = |w: &Rectangle| {
        let (columns, rows) = (w.x..w.x + w.width, w.y..w.y + w.height);
        rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
    };
    plan.draws[0].windows.iter().flat_map(pixels).collect()
}

#[test]
fn examples_of_tests() {
    let stn1 = example(
        "STN-1",
        "R = 127 replaces 128; incremented that is 128 again; 0 decremented is 255, and stays 0 if it saturates.",
    );
    use StencilOperation::*;
    let test = StencilTest {
        function: CompareFunction::Always,
        reference: 127,
        mask: 255,
        write_mask: 255,
        fail: Keep,
        depth_fail: Keep,
        pass: Keep,
    };
    let after = |operation, stored| stencil::written(&test, operation, stored);
    stn1.gives("replaced", after(Replace, 128), 127).gives("incremented", after(Increment, 127), 128);
    stn1.gives("decremented", after(Decrement, 0), 255).gives("saturated", after(DecrementSaturate, 0), 0);

    let clp1 = example(
        "CLP-1",
        "registers (0, 0) to (1, 1) are 2 columns and 2 rows: 4 pixels of an 8 x 8 target inclusive, 60 exclusive.",
    );
    let clipped = |exclusive| {
        let rectangles = vec![Rectangle { x: 0, y: 0, width: 2, height: 2 }];
        let draw = Draw { window_clip: Some(WindowClip { rectangles, exclusive }), ..Draw::default() };
        touched(Target::new(8, 8, SurfaceFormat::A8R8G8B8), draw).len()
    };
    clp1.gives("inclusive", clipped(false), 4).gives("exclusive", clipped(true), 60);

    let clp2 = example("CLP-2", "x 2, width 3 of an 8 x 1 target: columns 2 to 4. Width 0: none.");
    let columns = |width| {
        let clip = Some(Rectangle { x: 2, y: 0, width, height: 1 });
        let target = Target { clip, ..Target::new(8, 1, SurfaceFormat::R5G6B5) };
        touched(target, Draw::default()).iter().map(|(x, _)| *x).collect::<Vec<_>>()
    };
    clp2.gives("columns", columns(3), vec![2, 3, 4]).gives("none", columns(0), vec![]);
}
