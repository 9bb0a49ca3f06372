//! The captured frames R1 to R7 as scenes, with the geometry of the programs that drew them and pass-through colours.

use crate::build::{draw, target, vertex};
use ninebit::state::*;

/// A captured frame, and the part of it that the model reproduces.
pub struct Case {
    /// The name, R1 to R7.
    pub name: &'static str,
    /// Path of the picture among the golden results.
    pub capture: &'static str,
    /// The scene. Cleared pixels have alpha 0 and fragments alpha 255, so alpha shows the coverage.
    pub scene: Scene,
    /// The background colour of both the captured and the rendered frame.
    pub background: [u8; 3],
    /// Whether a pixel belongs to the case. Text and other draws are still included.
    pub region: fn(u32, u32) -> bool,
    /// Number of covered pixels that are compared.
    pub covered: usize,
    /// Number of pixels that are known to differ.
    pub differing: usize,
}

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

fn scene(background: [u8; 3], draws: Vec<Draw>) -> Scene {
    let [r, g, b] = background;
    let target = target(WIDTH, HEIGHT, SurfaceFormat::A8R8G8B8, [r, g, b, 0]);
    Scene { profile: Profile::Nv2a, targets: vec![target], textures: vec![], palettes: vec![], draws }
}

/// Returns a vertex at a position in 1/16 pixel.
fn snapped(x: i32, y: i32, [r, g, b]: [u8; 3]) -> Vertex {
    vertex(x as f32 / 16.0, y as f32 / 16.0, [r, g, b, 255])
}

fn everywhere(_: u32, _: u32) -> bool {
    true
}

/// RAS-1 to RAS-3: slivers whose edges lie on the sample points, or one float below them.
pub fn r1() -> Case {
    let color = [51, 119, 136, 255];
    let dec = f32::next_down;
    let (mut quads, mut triangles) = (Vec::new(), Vec::new());
    let mut quad = |points: [(f32, f32); 4]| quads.extend(points.map(|(x, y)| vertex(x, y, color)));
    let mut triangle = |points: [(f32, f32); 3]| triangles.extend(points.map(|(x, y)| vertex(x, y, color)));
    let rect = |x0: f32, x1: f32, y0: f32, y1: f32| [(x0, y0), (x1, y0), (x1, y1), (x0, y1)];
    let sixteenth = |i: u32| i as f32 / 16.0;

    let mut x = 4.0_f32;
    for i in 0..20 {
        quad([(dec(x + 0.5), 45.0), (x + 1.9, 45.0), (x + 1.9, 315.0), (x + 0.5 + sixteenth(i), 315.0)]);
        x += 4.0;
    }
    for i in 0..16 {
        let left = dec(x + 0.5 - sixteenth(i));
        triangle([(left, 45.0), (x + 0.5625 + sixteenth(i), 450.0), (left, 450.0)]);
        x += 4.0;
    }
    for (from, to) in [(0.9, 1.1), (0.0, 0.5), (0.4, 0.6)] {
        quad(rect(x + from, x + to, 45.0, 450.0));
        x += 4.0;
    }
    quad(rect(x + 0.5, x + 2.4, 45.0, 135.0));
    quad(rect(dec(x + 0.5625), x + 2.4, 135.0, 315.0));
    quad(rect(x + 0.5625, x + 2.4, 315.0, 450.0));
    x += 4.0;
    quad(rect(x + 0.5, x + 1.0, 45.0, 135.0));
    quad(rect(x + 0.5, dec(x + 1.5625), 135.0, 315.0));
    quad(rect(x + 0.5, x + 1.5625, 315.0, 450.0));
    x += 20.0;
    quad(rect(dec(x + 0.5), x + 0.5625, 50.0, 100.0));
    quad(rect(x + 0.4375, x + 0.5625, 150.0, 200.0));
    quad(rect(x + 0.5, x + 0.5625, 250.0, 300.0));

    let mut y = 45.0_f32;
    for i in 0..20 {
        quad([(320.0, y + 1.9), (320.0, dec(y + 0.5)), (520.0, y + 0.5 + sixteenth(i)), (520.0, y + 1.9)]);
        y += 4.0;
    }
    for i in 0..16 {
        let top = dec(y + 0.5 - sixteenth(i));
        triangle([(320.0, top), (620.0, top), (620.0, y + 0.5625 + sixteenth(i))]);
        y += 4.0;
    }
    for (from, to) in [(0.9, 1.1), (0.0, 0.5), (0.4, 0.6)] {
        quad(rect(320.0, 620.0, y + from, y + to));
        y += 4.0;
    }
    quad(rect(320.0, 420.0, y + 0.5, y + 2.4));
    quad(rect(420.0, 520.0, dec(y + 0.5625), y + 2.4));
    quad(rect(520.0, 620.0, y + 0.5625, y + 2.4));
    y += 4.0;
    quad(rect(320.0, 420.0, y + 0.5, y + 1.0));
    quad(rect(420.0, 520.0, y + 0.5, dec(y + 1.5625)));
    quad(rect(520.0, 620.0, y + 0.5, y + 1.5625));
    y += 20.0;
    quad(rect(320.0, 380.0, dec(y + 0.5), y + 0.5625));
    quad(rect(440.0, 500.0, y + 0.4375, y + 0.5625));
    quad(rect(560.0, 620.0, y + 0.5, y + 0.5625));

    quad(rect(10.0, 630.0, 455.5, 456.6));
    quad(rect(10.0, 630.0, 460.4, 461.5));
    for (n, from) in [(0.0, -0.0625), (1.0, -0.0624), (2.0, 0.0)] {
        quad(rect(from, 1.0, 50.0 + 100.0 * n, 100.0 + 100.0 * n));
        quad(rect(320.0 + 120.0 * n, 380.0 + 120.0 * n, from, 1.0));
    }

    let background = [32, 34, 36];
    Case {
        name: "R1",
        capture: "Vertex_shader_rounding_tests/TopLeftRaster.png",
        scene: scene(background, vec![draw(Topology::Quads, quads), draw(Topology::Triangles, triangles)]),
        background,
        region: everywhere,
        covered: 22_625,
        differing: 0,
    }
}

/// WGT-1: vertical ramps with a tie in every eighth row.
pub fn r2() -> Case {
    let (black, white) = ([0; 3], [255; 3]);
    let mut vertices = Vec::new();
    for x in [2048, 3072, 6144, 7168, 8192] {
        vertices.extend([snapped(x, 2304, black), snapped(x + 819, 2304, black)]);
        vertices.extend([snapped(x + 819, 6912, white), snapped(x, 6912, white)]);
    }
    let background = [100, 149, 237];
    Case {
        name: "R2",
        capture: "Attrib_float/0_1.png",
        scene: scene(background, vec![draw(Topology::Quads, vertices)]),
        background,
        region: |x, y| {
            [128, 192, 384, 448, 512].iter().any(|x0| (*x0..=*x0 + 50).contains(&x)) && (144..432).contains(&y)
        },
        covered: 73_440,
        differing: 0,
    }
}

/// WGT-1 with three colours, and DEP-1.
pub fn r3() -> Case {
    // DEP-2: z (2^24 - 1), rounded down, is 11184809 above and 16777214 below.
    let (above, below) = (11_184_810.0 / 16_777_216.0, 16_777_215.0 / 16_777_216.0);
    let mut vertices = vec![
        snapped(2048, 640, [0, 255, 0]),
        snapped(8192, 640, [255, 0, 0]),
        snapped(8192, 7040, [102, 76, 0]),
        snapped(2048, 7040, [0, 0, 255]),
    ];
    for (vertex, z) in vertices.iter_mut().zip([above, above, below, below]) {
        vertex.position[2] = z;
    }
    let background = [0; 3];
    let mut quad = draw(Topology::Quads, vertices);
    quad.depth_test = Some(DepthTest::new(CompareFunction::Always, true));
    let mut scene = scene(background, vec![quad]);
    scene.targets[0].depth = Some(DepthBuffer { format: DepthFormat::Z24S8, clear: 0xff_ffff, clear_stencil: 0 });
    Case {
        name: "R3",
        capture: "Depth_buffer/DepthFmt_z24_Cn_FZn_Mffffff.png",
        scene,
        background,
        region: |x, y| (128..512).contains(&x) && (40..440).contains(&y),
        covered: 85_756,
        differing: 0,
    }
}

/// Returns a case with a smooth draw on the usual background, with the numbers of pixels that it covers and of those that differ.
fn shaded(name: &'static str, capture: &'static str, draw: Draw, [covered, differing]: [usize; 2]) -> Case {
    let background = [44, 48, 46];
    Case { name, capture, scene: scene(background, vec![draw]), background, region: everywhere, covered, differing }
}

/// INT-2: triangles with equal w at all vertices.
pub fn r4() -> Case {
    let corners = [
        (1529, 1554, [0, 0, 255]),
        (5119, 1554, [0, 255, 0]),
        (1529, 3839, [255, 0, 0]),
        (8710, 1554, [204, 204, 204]),
        (5250, 6125, [204, 51, 255]),
        (5446, 3839, [51, 204, 255]),
        (4597, 6125, [51, 255, 204]),
        (3291, 5668, [204, 255, 51]),
        (5119, 3839, [255, 204, 51]),
    ];
    shaded("R4", "Shade_model/Prog_Tri_Smooth_First.png", draw(Topology::Triangles, equal_w(&corners)), [36_035, 1])
}

/// INT-2: quads with equal w at all vertices.
pub fn r5() -> Case {
    let corners = [
        (1529, 1554, [0, 0, 255]),
        (4597, 1554, [0, 255, 0]),
        (4597, 6125, [255, 0, 0]),
        (1529, 6125, [204, 204, 204]),
        (5315, 1554, [204, 51, 255]),
        (8710, 1554, [51, 204, 255]),
        (8710, 6125, [51, 255, 204]),
        (5119, 6125, [204, 255, 51]),
    ];
    shaded("R5", "Shade_model/Prog_Quad_Smooth_First.png", draw(Topology::Quads, equal_w(&corners)), [116_958, 1])
}

fn equal_w(corners: &[(i32, i32, [u8; 3])]) -> Vec<Vertex> {
    let mut vertices: Vec<Vertex> = corners.iter().map(|(x, y, color)| snapped(*x, *y, *color)).collect();
    vertices.iter_mut().for_each(|v| v.position[3] = 7.1);
    vertices
}

/// WGT-1: without the perspective flag w has no effect. RAS-1: positions left of the screen are truncated toward zero.
pub fn r6() -> Case {
    let mut vertices = vec![
        vertex(-162.311_39, -242.311_39, [255, 0, 0, 255]),
        snapped(7446, 1530, [0, 255, 0]),
        snapped(12853, 11573, [0, 0, 255]),
        snapped(2810, 6166, [255, 255, 255]),
    ];
    for (vertex, w) in vertices.iter_mut().zip([2.1, 7.0, 2.1, 7.0]) {
        vertex.position[3] = w;
    }
    let mut quad = draw(Topology::Quads, vertices);
    quad.perspective = false;
    let background = [37, 17, 53];
    Case {
        name: "R6",
        capture: "Texture_perspective/tex_diff_pers_n_quad.png",
        scene: scene(background, vec![quad]),
        background,
        region: everywhere,
        covered: 200_120,
        differing: 1,
    }
}

/// NUM-4: thousands of float colours. The top rows are left out, because another draw covers them.
pub fn r7() -> Case {
    fn advance(state: &mut [f32; 3]) {
        for (value, step) in state.iter_mut().zip([0.03, 0.05, 0.01]) {
            *value += step;
            if *value > 1.0 {
                *value -= 1.0;
            }
        }
    }
    let mut state = [0.0_f32, 0.5, 0.75];
    let mut vertices = Vec::new();
    for y in (48..480).step_by(6) {
        for x in (0..106).map(|n| 2 + 6 * n) {
            for (dx, dy) in [(0, 0), (6, 0), (6, 6), (0, 6)] {
                let [r, g, b] = state;
                let mut corner = snapped(16 * (x + dx), 16 * (y + dy), [0; 3]);
                corner.diffuse = VertexColor::Floats([r, g, b, 1.0]);
                vertices.push(corner);
                advance(&mut state);
                advance(&mut state);
            }
        }
    }
    let background = [68; 3];
    Case {
        name: "R7",
        capture: "High_vertex_count/HighVtxCount-inlinebuffers.png",
        scene: scene(background, vec![draw(Topology::Quads, vertices)]),
        background,
        region: |_, y| y >= 120,
        covered: 228_960,
        differing: 0,
    }
}
