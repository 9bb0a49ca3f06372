//! DEP-4 to DEP-6: depths beyond the depth range that are culled or clamped, and triangles that are culled whole.

use super::*;

/// The deepest value of a 24-bit depth buffer.
const DEEPEST: f32 = 16_777_215.0;

const WHOLE_RANGE: DepthRange = DepthRange { lowest: 0.0, highest: DEEPEST, clamps: false, drops_triangles: false };

/// Returns a quad of the world with a texture of 256 x 256 texels.
fn textured(corners: [[f32; 3]; 4], depth_test: DepthTest) -> Draw {
    let matrix = space::product(space::eye(), space::window_to(f64::from(DEEPEST)));
    let vertex = |n: usize| {
        let [x, y, z] = corners[n];
        placed(space::fixed_function_to([x, y, z, 1.0], &matrix), draws::corners([0.0, 0.0, 256.0, 256.0])[n])
    };
    let draw = fetching(draw(Topology::Quads, [0, 1, 2, 3].map(vertex).to_vec()), 0, nearest(0));
    Draw { depth_test: Some(depth_test), ..draw }
}

/// Draws two upright quads and a floor through both; only the floor's depths are limited to `range`.
fn floor(canvas: &mut Canvas, w_buffer: bool, range: DepthRange, bias: f32) {
    canvas.frame_buffer().depth = Some(FAR_DEPTHS);
    let fields = checker([argb(0xff00_ffff), argb(0xff00_0000)], 8);
    canvas.texture(&images::in_texels(images::texture(TextureFormat::A8R8G8B8, [256, 256], fields)));
    let test = |range| DepthTest { w_buffer, ..in_steps(CompareFunction::Less, true, Some(range)) };
    for (left, z) in [(-2.0, 2.0), (1.0, 10.0)] {
        let right = left + 1.0;
        let corners = [[left, 2.0, z], [right, 2.0, z], [right, -6.5, z], [left, -6.5, z]];
        canvas.draw(textured(corners, test(WHOLE_RANGE)));
    }
    let corners = [[-10.0, -2.5, 20.0], [10.0, -2.5, 20.0], [10.0, -2.5, 0.0], [-10.0, -2.5, 0.0]];
    let offset = PolygonOffset { bias, factor: 0.0 };
    canvas.draw(textured(corners, DepthTest { offset, ..test(range) }));
}

/// Adds the frames of Depth_Clamp.
pub(super) fn clamped(frames: &mut Frames) {
    equal(frames);
    let buffers = [(false, [14_988_020.0, 15_869_663.0], -500_000.0), (true, [9.01, 16.49], -5.0)];
    for (w_buffer, limits, offset) in buffers {
        for [clamps, biased, whole] in [0, 1, 2, 3, 4, 5, 6, 7].map(|n: u8| [n & 4 != 0, n & 2 != 0, n & 1 != 0]) {
            let [lowest, highest] = if whole { [0.0, DEEPEST] } else { limits };
            let range = DepthRange { lowest, highest, clamps, drops_triangles: false };
            let bias = if biased { offset } else { 0.0 };
            let [w, clamps, biased, whole] = [w_buffer, clamps, biased, whole].map(u8::from);
            // The programs' vertex program yields the same positions as the fixed function.
            for program in [0, 1] {
                let name = format!("depth_clamp_W{w}_C{clamps}_ZB{biased}_FR{whole}_VSH{program}");
                frames.paint(name, 0xfe25_1135, move |canvas| floor(canvas, w_buffer, range, bias));
            }
        }
    }
}

/// Adds those frames of Depth_Clamp that draw a floor twice: the second time, in red, where its depths are the same. Half of the floor lies behind the
/// eye.
fn equal(frames: &mut Frames) {
    for (buffer, w_buffer, scale, lowest) in [("", false, 1.0_f32, 14_988_020.0), ("WBuf_", true, 100.0, 255.99)] {
        for offset in [0.685_f32, 0.822, 3.015, 3.216] {
            frames.paint(format!("depth_equal_{buffer}Ofs{offset}"), 0xfe25_1135, move |canvas| {
                canvas.frame_buffer().depth = Some(FAR_DEPTHS);
                let fields = checker([argb(0xff00_ffff), argb(0xff00_0000)], 8);
                canvas.texture(&images::in_texels(images::texture(TextureFormat::A8R8G8B8, [256, 256], fields)));
                let [side, y] = [10.0, -2.5].map(|n| n * scale);
                let [far, near] = [200.0 * scale - offset, -20.0 + offset];
                let corners = [[-side, y, far], [side, y, far], [side, y, near], [-side, y, near]];
                let test = |function, clamps| {
                    let range = DepthRange { lowest, highest: DEEPEST, clamps, drops_triangles: false };
                    DepthTest { w_buffer, ..in_steps(function, true, Some(range)) }
                };
                let floor = textured(corners, test(CompareFunction::Less, false));
                let red = VertexColor::Floats([1.0, 0.0, 0.0, 1.0]);
                let vertices = floor.vertices.iter().map(|vertex| Vertex { diffuse: red, ..vertex }).collect();
                let depth_test = Some(test(CompareFunction::Equal, true));
                canvas.draw(floor);
                canvas.draw(Draw { depth_test, ..draw(Topology::Quads, vertices) });
            });
        }
    }
}

/// How z and w vary over the quads of a block.
#[derive(Clone, Copy)]
enum Block {
    GrowingZ,
    GrowingW,
    SmallW,
    Ramps,
    Growing,
    WOfTen,
}

/// Adds a block of 40 quads of 16 x 16 pixels, whose depths or w grow from quad to quad. `place` yields the positions from those of the window.
fn block([left, top]: [f32; 2], block: Block, place: impl Fn([f32; 4]) -> [f32; 4], vertices: &mut Vec<Vertex>) {
    let step = 150.0_f32 / 41.0;
    let (mut z, mut w) = (0.0_f32, 0.0_f32);
    for row in 0..8_u8 {
        for column in 0..5_u8 {
            let (x, y) = (left + 20.0 * f32::from(column), top + 20.0 * f32::from(row));
            let shade = |value: f32| 0.25 + value / 150.0 * 0.75;
            let [mut zs, mut ws] = [[z, z + step * 0.75], [w, w + step * 0.75]];
            let (z_shades, w_shades) = (zs.map(shade), ws.map(shade));
            let by_side = |color: fn(f32, f32) -> [f32; 3]| [0, 1].map(|n: usize| color(z_shades[n], w_shades[n]));
            let colors = match block {
                Block::GrowingZ => {
                    ws = [1.0; 2];
                    by_side(|z, _| [z; 3])
                }
                Block::Growing => by_side(|z, w| [z, 0.25, w]),
                Block::GrowingW => {
                    zs = [8.0, 120.0];
                    by_side(|_, w| [0.33, 0.25, w])
                }
                Block::Ramps => {
                    (zs, ws) = ([8.0, 120.0], [8.0, 120.0]);
                    [[0.33, 0.75, 0.25], [0.33, 0.75, 0.8]]
                }
                Block::WOfTen => {
                    ws = [10.0; 2];
                    let [left, right] = z_shades;
                    [[left, left, 0.25], [right, right, 0.8]]
                }
                Block::SmallW => {
                    ws = [0.01, 0.0001];
                    let [left, right] = z_shades;
                    [[0.75, left, left], [right, right, 0.8]]
                }
            };
            for (side, dx, dy) in [(0, 0.0, 0.0), (1, 16.0, 0.0), (1, 16.0, 16.0), (0, 0.0, 16.0)] {
                let [r, g, b] = colors[side];
                let position = place([x + dx, y + dy, zs[side], ws[side]]);
                let diffuse = VertexColor::Floats([r, g, b, 1.0]);
                vertices.push(Vertex { position, diffuse, ..Vertex::default() });
            }
            // A block that overrides z or w continues from its own values.
            (z, w) = (zs[0] + step, ws[0] + step);
        }
    }
}

/// Returns the quads of ZMinMaxControl.
fn blocks(place: impl Fn([f32; 4]) -> [f32; 4]) -> Draw {
    let mut vertices = Vec::new();
    let columns = [90.0_f32, 90.0 + 126.72 + 90.0, 90.0 + 126.72 + 90.0 + 126.72 + 90.0];
    for (column, [upper, lower]) in columns.into_iter().zip([
        [Block::GrowingZ, Block::GrowingW],
        [Block::SmallW, Block::Ramps],
        [Block::Growing, Block::WOfTen],
    ]) {
        block([column, 60.0], upper, &place, &mut vertices);
        block([column, 252.0], lower, &place, &mut vertices);
    }
    draw(Topology::Quads, vertices)
}

/// Adds the frames of ZMinMaxControl.
pub(super) fn controls(frames: &mut Frames) {
    let matrix = space::product(space::moved_by([0.0, 0.0, -3.0]), space::parallel_window([10.0, 100.0]));
    let inverse = space::inverse(&matrix);
    // The program multiplies the points of the world by w.
    let through_world = |[x, y, z, w]: [f32; 4]| {
        let [x, y, z, _] = space::unproject_depth([x, y, z, 1.0], &inverse);
        space::fixed_function_to([x * w, y * w, z * w, w], &matrix)
    };
    for (kind, quads) in [("Ctrl", blocks(|place| place)), ("CtrlFixed", blocks(through_world))] {
        for (prefix, drops_triangles) in [("", false), ("NEARFAR_", true)] {
            for (mode, clamps) in [("ZCULL", false), ("ZCLAMP", true)] {
                for (buffer, w_buffer) in [("", false), ("WBuf_", true)] {
                    let range = DepthRange { lowest: 10.0, highest: 100.0, clamps, drops_triangles };
                    let depth_test = in_steps(CompareFunction::Always, false, Some(range));
                    let depth_test = Some(DepthTest { w_buffer, ..depth_test });
                    let drawn = one(0xff22_2228, None, Draw { depth_test, ..quads.clone() });
                    // The control bit CULL_IGNORE_W changes nothing here.
                    for suffix in ["", "_IgnW"] {
                        frames.push(format!("{kind}_{buffer}{prefix}{mode}{suffix}"), drawn.clone());
                    }
                }
            }
        }
    }
}
