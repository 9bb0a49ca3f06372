//! RAS-1 to RAS-3: vertices at and near sixteenths of a pixel, on the frame buffer and on textures; edges through pixel centres.

use super::*;

/// The bias that is added to positions, as the names of frames have it and as a number.
const BIASES: [(&str, f32); 9] = [
    ("0.0000", 0.0),
    ("0.0010", 0.001),
    ("0.4999", 0.4999),
    ("0.5000", 0.5),
    ("0.5624", 0.5624),
    ("0.5625", 0.5625),
    ("0.5626", 0.5626),
    ("0.9990", 0.999),
    ("1.0000", 1.0),
];

const GREEN: u32 = 0xff00_9900;

fn patch(edges: [f32; 4], color: u32) -> Draw {
    without_alpha(rectangle(edges, VertexColor::Bytes(abgr(color))), FinalRegister::PrimaryColor)
}

/// Draws a biased rectangle over an unbiased one of the same position.
fn geometry(canvas: &mut Canvas, bias: f32) {
    canvas.draw(patch([200.0, 120.0, 440.0, 360.0], 0xffff_00ff));
    canvas.draw(patch([200.0 + bias, 120.0 + bias, 440.0, 360.0], GREEN));
}

/// Draws eight biased squares that share edges.
fn adjacent(canvas: &mut Canvas, bias: f32) {
    canvas.draw(patch([120.0, 140.0, 520.0, 340.0], 0xffe0_e0e0));
    for top in [140.0, 240.0] {
        for left in [120.0, 220.0, 320.0, 420.0] {
            canvas.draw(patch([left, top, left + 100.0, top + 100.0].map(|edge: f32| edge + bias), GREEN));
        }
    }
}

/// Sizes of the four rectangles that are drawn on textures.
const SIZES: [[u32; 2]; 4] = [[128, 128], [128, 32], [32, 128], [16, 64]];

/// Draws a rectangle on each of four textures. These are as large as the rectangle or, if `is_large`, larger than the screen; then only their first
/// rows hold what the last frame left.
fn on_textures(canvas: &mut Canvas, bias: f32, is_large: bool) {
    let first = |_, y| if y < 16 { argb(0xffff_00ff) } else { abgr(GREEN) };
    let large = images::texture(TextureFormat::A8R8G8B8, [1024, 1024], first);
    let mut shown = Vec::new();
    for ([width, height], corner) in SIZES.into_iter().zip(places([248.0, 168.0], [144.0; 2], 2)) {
        let size = [width, height].map(|side| f32::from(side as u16));
        let draws = [patch([bias, bias, size[0] + bias, size[1] + bias], GREEN)];
        let target = if is_large {
            canvas.painted(&large, SurfaceFormat::A8R8G8B8, draws)
        } else {
            let clear_color = argb(0xffff_00ff);
            let target = canvas.target(Target { clear_color, ..Target::new(width, height, SurfaceFormat::A8R8G8B8) });
            canvas.draw_into(target, draws);
            target
        };
        let texture = canvas.shown(target, TextureKind::Rectangle, TextureFormat::X8R8G8B8);
        let draw = pasted(sized(corner, size), 0, nearest(texture), [0.0, 0.0, size[0], size[1]]);
        shown.push(without_alpha(draw, FinalRegister::Texture0));
    }
    canvas.draw_into(0, shown);
}

/// Returns the next smaller number of a positive one.
fn before(value: f32) -> f32 {
    f32::from_bits(value.to_bits() - 1)
}

/// The corners of a polygon.
type Corners = Vec<[f32; 2]>;

/// Adds thin shapes along an axis, from position `at` on. `across` has four positions on the other axis. If `is_down`, the axis is y: x and y are
/// exchanged.
fn combs(shapes: &mut Vec<Corners>, mut at: f32, across: [f32; 4], patches: [f32; 3], length: f32, is_down: bool) {
    let [a0, a1, a2, a3] = across;
    let mut put = |corners: &[[f32; 2]]| {
        let corners = corners.iter().map(|[along, across]| if is_down { [*across, *along] } else { [*along, *across] });
        shapes.push(corners.collect());
    };
    let step = 4.0_f32;
    for n in 0..20_u8 {
        let to = at + 0.5 + f32::from(n) * 0.0625;
        if is_down {
            put(&[[at + 1.9, a0], [before(at + 0.5), a0], [to, a2], [at + 1.9, a2]]);
        } else {
            put(&[[before(at + 0.5), a0], [at + 1.9, a0], [at + 1.9, a2], [to, a2]]);
        }
        at += step;
    }
    for n in 0..16_u8 {
        let by = f32::from(n) * 0.0625;
        let left = before((at + 0.5) - by);
        if is_down {
            put(&[[left, a0], [left, a3], [at + 0.5625 + by, a3]]);
        } else {
            put(&[[left, a0], [at + 0.5625 + by, a3], [left, a3]]);
        }
        at += step;
    }
    let mut bar = |from: f32, across: [f32; 2], to: f32| {
        if is_down {
            put(&[[from, across[0]], [from, across[1]], [to, across[1]], [to, across[0]]]);
        } else {
            put(&[[from, across[0]], [to, across[0]], [to, across[1]], [from, across[1]]]);
        }
    };
    bar(at + 0.9, [a0, a3], at + 1.1);
    at += step;
    bar(at, [a0, a3], at + 0.5);
    at += step;
    bar(at + 0.4, [a0, a3], at + 0.6);
    at += step;
    bar(at + 0.5, [a0, a1], at + 2.4);
    bar(before(at + 0.5625), [a1, a2], at + 2.4);
    bar(at + 0.5625, [a2, a3], at + 2.4);
    at += step;
    bar(at + 0.5, [a0, a1], at + 1.0);
    bar(at + 0.5, [a1, a2], before(at + 1.5625));
    bar(at + 0.5, [a2, a3], at + 1.5625);
    at += 5.0 * step;
    let starts = [before(at + 0.5), at + 0.4375, at + 0.5];
    for (start, place) in starts.into_iter().zip(patches) {
        bar(start, [place, place + length], at + 0.5625);
    }
    for (start, place) in [-0.0625, -0.0624, 0.0].into_iter().zip(patches) {
        bar(start, [place, place + length], 1.0);
    }
}

/// Draws the frame TopLeftRaster.
fn edges(canvas: &mut Canvas) {
    let mut shapes = Vec::new();
    combs(&mut shapes, 4.0, [45.0, 135.0, 315.0, 450.0], [50.0, 150.0, 250.0], 50.0, false);
    combs(&mut shapes, 45.0, [320.0, 420.0, 520.0, 620.0], [320.0, 440.0, 560.0], 60.0, true);
    for [top, bottom] in [[455.5, 456.6], [460.4, 461.5]] {
        shapes.push(vec![[10.0, top], [630.0, top], [630.0, bottom], [10.0, bottom]]);
    }
    for shape in shapes {
        let vertices = shape.into_iter().map(|corner| vertex(corner, VertexColor::Bytes([51, 119, 136, 255])));
        let draw = draw(Topology::Polygon, vertices.collect());
        canvas.draw(Draw { combiners: opaque(FinalRegister::PrimaryColor), blend: None, ..draw });
    }
}

/// Adds the frames of Vertex_shader_rounding_tests.
pub(super) fn frames(frames: &mut Frames) {
    for (name, bias) in BIASES {
        frames.paint(format!("Geometry_{name}"), 0xfe40_4040, move |canvas| geometry(canvas, bias));
        frames.paint(format!("AdjacentGeometry_{name}"), 0xfe40_4040, move |canvas| adjacent(canvas, bias));
        frames.paint(format!("GeometrySubscreen_{name}"), 0xfe41_4041, move |canvas| on_textures(canvas, bias, false));
        frames.paint(format!("GeometrySuperscreen_{name}"), 0xfe41_4041, move |canvas| on_textures(canvas, bias, true));
    }
    for (name, bias) in BIASES {
        frames.paint(format!("ProjAdjacentGeometry_{name}"), 0xfe40_4040, move |canvas| {
            transformed(canvas, bias, UNPROJECTED, [GREEN, 0xff00_bb00]);
        });
    }
    transfers::composites(frames);
    frames.paint("TopLeftRaster", 0xff20_2224, edges);
    frames.paint("TopLeftRaster_Fixed", 0xff20_2224, edges);
}

/// Returns edges as they come out of the transform: those from the centre to the right, and all rows, lack a last bit.
fn projected(edges: [f32; 4], moved: f32) -> [f32; 4] {
    let [left, top, right, bottom] = edges.map(|edge| edge + moved);
    let low = |edge: f32| edge - 1.0 / 16384.0;
    let column = |edge: f32| if edge < 319.0 { edge } else { low(edge) };
    [column(left), low(top), column(right), low(bottom)]
}

/// Draws squares through a vertex program, and others through the fixed function, which alone is moved by `offset`.
fn transformed(canvas: &mut Canvas, bias: f32, offset: f32, colors: [u32; 2]) {
    canvas.draw(patch(projected([120.0, 140.0, 520.0, 340.0], 0.0), 0xffe0_e0e0));
    let squares: Vec<[f32; 4]> =
        places([120.0, 140.0], [100.0; 2], 4).take(8).map(|corner| sized(corner, [100.0; 2])).collect();
    for number in [0, 2, 5, 7] {
        canvas.draw(patch(projected(squares[number], bias), colors[0]));
    }
    for number in [1, 3, 4, 6] {
        canvas.draw(patch(projected(squares[number], bias + offset), colors[1]));
    }
}

/// Adds the frames of Viewport: only the fixed function reads the offset, and nothing reads the scale.
pub(super) fn viewports(frames: &mut Frames) {
    let offsets = [("-1.000", -1.0), ("-0.531", -0.53125), ("0.000", 0.0), ("0.531", 0.53125), ("1.000", 1.0)];
    for (name, offset) in offsets {
        for scale in ["0.000", "2.000"] {
            frames.paint(format!("{name}_{name}-{scale}_0.000"), 0xfe40_4040, move |canvas| {
                transformed(canvas, 0.0, offset, [0xff00_1199, 0xff00_33bb]);
            });
        }
    }
    for (name, offset) in [("0.562", 0.5625), ("-0.438", -0.4375)] {
        frames.paint(format!("{name}_{name}-0.000_0.000"), 0xfe40_4040, move |canvas| {
            transformed(canvas, 0.0, offset, [0xff00_1199, 0xff00_33bb]);
        });
    }
}
