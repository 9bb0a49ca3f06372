//! RAS-8: vertices behind the eye, and w between 2^-64 and 2^64: W_param, Texture_perspective_enable.

use super::*;
use ninebit::number::transform;
use ninebit::vertex::unit;

/// The smallest w that the programs name, and the largest.
const LEAST: f32 = 1.0 / MOST;
pub(super) const MOST: f32 = 18_446_744_073_709_551_616.0;

/// Factors of those, as the names of frames have them.
const FACTORS: [(&str, f32); 20] = [
    ("0.00", 0.0),
    ("0.25", 0.25),
    ("0.50", 0.5),
    ("1.00", 1.0),
    ("2.00", 2.0),
    ("4.00", 4.0),
    ("inf", f32::INFINITY),
    ("-inf", f32::NEG_INFINITY),
    ("-4.00", -4.0),
    ("-2.00", -2.0),
    ("-1.00", -1.0),
    ("-0.50", -0.5),
    ("-0.25", -0.25),
    ("-0.00", -0.0),
    ("-3.08e-33", -LEAST * (1_048_576.0 * LEAST)),
    ("-0.96e-34", -LEAST * (32_768.0 * LEAST)),
    ("-1.50e-36", -LEAST * (512.0 * LEAST)),
    ("-7.52e-37", -LEAST * (256.0 * LEAST)),
    ("-3.76e-37", -LEAST * (128.0 * LEAST)),
    ("-1.88e-37", -LEAST * (64.0 * LEAST)),
];

/// The vertices of two triangles that share an edge, and those of the same as a quad.
const TRIANGLES: [usize; 6] = [0, 1, 3, 2, 3, 1];
const QUAD: [usize; 4] = [0, 1, 2, 3];

/// Returns a draw of triangles or of a quad.
fn shape(is_quad: bool, vertices: &[Vertex; 4]) -> Draw {
    match is_quad {
        true => draw(Topology::Quads, QUAD.map(|n| vertices[n]).to_vec()),
        false => draw(Topology::Triangles, TRIANGLES.map(|n| vertices[n]).to_vec()),
    }
}

/// Puts the largest w in place of an infinite one, which a scene may not have.
fn finite([x, y, z, w]: [f32; 4]) -> [f32; 4] {
    [x, y, z, w.clamp(-MOST, MOST)]
}

/// Adds the colours of a draw to those of the frame buffer.
fn added(draw: Draw) -> Draw {
    let blend = Blend { equation: BlendEquation::Add, source: BlendFactor::One, destination: BlendFactor::One };
    Draw { blend: Some(blend), ..draw }
}

/// Draws a shape with a checkered texture.
fn checkered(canvas: &mut Canvas, colors: [u32; 2], drawn: Draw) {
    let fields = checker(colors.map(argb), 8);
    canvas.texture(&images::in_texels(images::texture(TextureFormat::A8R8G8B8, [256, 256], fields)));
    canvas.draw(fetching(drawn, 0, nearest(0)));
}

const TEXELS: [f32; 4] = [0.0, 0.0, 256.0, 256.0];

/// Adds the frames of W_param.
pub(super) fn frames(frames: &mut Frames) {
    for is_quad in [false, true] {
        let kind = if is_quad { "quad" } else { "bitri" };
        for (name, factor) in FACTORS {
            let (first, last) = (LEAST / factor, MOST * factor);
            // Elsewhere a corner is infinitely far away.
            let is_finite = factor.abs() >= 0.25;
            if is_finite {
                frames.paint(format!("ff_w_zero_inf__{kind}_w{name}"), 0xfe25_1135, move |canvas| {
                    let (w, scale) = ([first, 1.0, last, 1.0], [LEAST, 1.0, MOST, 1.0]);
                    let vertex = |n: usize| {
                        let [x, y] = corners([-80.0, -80.0, 80.0, 80.0])[n].map(|at| at * scale[n]);
                        let seen = unit::transform(&space::rows(&space::IDENTITY), unit::words([x, y, 0.0, w[n]]));
                        placed(finite(unit::window(seen, [320.0, 240.0, 0.0])), corners(TEXELS)[n])
                    };
                    checkered(canvas, [0xff00_ffff, 0xffff_0000], added(shape(is_quad, &[0, 1, 2, 3].map(vertex))));
                });
            }
            frames.paint(format!("prog_w_zero_inf__{kind}_w{name}"), 0xfe25_1135, move |canvas| {
                let place = |n: usize, w: f32| {
                    // What lies behind the eye is given on the other side.
                    let corner = if w.is_sign_negative() { 2 - n } else { n };
                    let [x, y] = corners([160.0, 70.0, 480.0, 390.0])[corner];
                    placed(finite([x, y, 0.0, w]), corners(TEXELS)[n])
                };
                let drawn = match is_quad {
                    true => shape(true, &[place(0, first), place(1, 1.0), place(2, last), place(3, 1.0)]),
                    false => {
                        let near = [place(0, first), place(1, LEAST), place(3, LEAST)];
                        let far = [place(2, last), place(3, MOST), place(1, MOST)];
                        draw(Topology::Triangles, near.into_iter().chain(far).collect())
                    }
                };
                checkered(canvas, [0xff00_c0c0, 0xffc0_0000], added(drawn));
            });
            if !is_quad && is_finite {
                frames.paint(format!("rcc_w_zero_inf__z{name}"), 0xfe25_1135, move |canvas| {
                    reciprocals(canvas, first, last)
                });
            }
        }
    }
    for (suffix, perspective) in [("", false), ("_tex_persp", true)] {
        frames.paint(format!("w_pos_strip{suffix}"), 0xff00_0000, move |canvas| {
            let corner = |at: [f32; 2], w: f32, [r, g, b]: [f32; 3]| Vertex {
                position: finite([at[0], at[1], 0.0, w]),
                diffuse: VertexColor::Floats([r, g, b, 1.0]),
                ..Vertex::default()
            };
            let vertices = vec![
                corner([128.0, 400.0], 0.0, [0.75; 3]),
                corner([128.0, 80.0], f32::INFINITY, [0.0, 1.0, 0.0]),
                corner([320.0, 400.0], 0.1, [1.0, 0.0, 0.0]),
                corner([320.0, 80.0], 0.5, [0.0, 0.0, 1.0]),
                corner([512.0, 400.0], 1.5, [0.0, 0.5, 0.75]),
                corner([512.0, 80.0], 10.5, [0.7, 0.9, 0.2]),
            ];
            canvas.draw(Draw { perspective, ..draw(Topology::TriangleStrip, vertices) });
        });
    }
}

/// Draws two triangles whose x and y a vertex program multiplies by the limited reciprocal of z.
fn reciprocals(canvas: &mut Canvas, first: f32, last: f32) {
    let vertex = |[x, y]: [f32; 2], scale: f32, z: f32, [r, g, b]: [f32; 3]| {
        let reciprocal = transform::limited_reciprocal(z.to_bits());
        let sign = 1.0_f32.copysign(z);
        let [x, y] = [x, y].map(|at| f32::from_bits(transform::product((sign * at * scale).to_bits(), reciprocal)));
        Vertex { position: [x, y, 0.0, 1.0], diffuse: VertexColor::Floats([r, g, b, 1.0]), ..Vertex::default() }
    };
    let (red, yellow, cyan, green) = ([1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, 1.0, 0.0]);
    let vertices = vec![
        vertex([160.0, 70.0], LEAST, first, red),
        vertex([480.0, 70.0], LEAST, LEAST, yellow),
        vertex([160.0, 390.0], LEAST, LEAST, cyan),
        vertex([480.0, 390.0], MOST, last, green),
        vertex([160.0, 390.0], MOST, MOST, cyan),
        vertex([480.0, 70.0], MOST, MOST, yellow),
    ];
    canvas.draw(added(draw(Topology::Triangles, vertices)));
}

/// Adds the frames of Texture_perspective_enable: two rectangles each without perspective and with it. The chip culls the triangle whose corner lies behind
/// the eye, because the eye sees its other side.
pub(super) fn perspective(frames: &mut Frames) {
    let last = [[f32::INFINITY, 1.0, 0.980_578, 0.0], [f32::INFINITY, 1.0, 2.980_578, -0.5]];
    let (red, grey, blue, green) = ([1.0, 0.0, 0.0], [0.5; 3], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]);
    for (name, is_textured) in [("Untextured", false), ("Textured", true)] {
        frames.paint(format!("TexPerspective_{name}"), 0xfe32_3232, move |canvas| {
            if is_textured {
                let fields = checker([0xffff_ff00, 0xff00_0000].map(argb), 8);
                canvas.texture(&images::texture(TextureFormat::A8R8G8B8, [256, 256], fields));
            }
            for (left, perspective) in [(128.0, false), (384.0, true)] {
                for (top, w) in [96.0, 288.0].into_iter().zip(last) {
                    let vertex = |n: usize| {
                        let [x, y] = corners([left, top, left + 128.0, top + 96.0])[n];
                        let [r, g, b] = [red, grey, blue, green][n];
                        let place = placed(finite([x, y, 1.0, w[n]]), corners([0.0, 0.0, 1.0, 1.0])[n]);
                        Vertex { diffuse: VertexColor::Floats([r, g, b, 1.0]), ..place }
                    };
                    // A scene has no vertex behind the eye without perspective.
                    let all =
                        [[0, 2, 3], [0, 1, 2]].into_iter().filter(|of| perspective || of.iter().all(|n| w[*n] >= 0.0));
                    let vertices = all.flat_map(|of| of.map(vertex)).collect();
                    let (cull, front_face) = (Cull::Back, FrontFace::Clockwise);
                    let drawn = Draw { perspective, cull, front_face, ..draw(Topology::Triangles, vertices) };
                    let unit = TextureUnit {
                        address_s: AddressMode::ClampToEdge,
                        address_t: AddressMode::ClampToEdge,
                        ..nearest(0)
                    };
                    canvas.draw(if is_textured { fetching(drawn, 0, unit) } else { drawn });
                }
            }
        });
    }
}
