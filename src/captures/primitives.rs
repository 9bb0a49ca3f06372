//! RAS-1 to RAS-5, WGT-1, NUM-4: every topology, smooth and flat, with and without perspective; float colours; large vertex counts.

use super::lighting::{Light, LitVertex, POWER_10, SurfaceSide, lit, material, shading};
use super::space::without_depth;
use super::*;

/// Colours of the vertices, A8B8G8R8.
const COLORS: [[u32; 5]; 2] = [
    [0xffff_0000, 0xff00_ff00, 0xff00_00ff, 0xffcc_cccc, 0xffff_33cc],
    [0xffff_cc33, 0xffcc_ff33, 0xff33_ffcc, 0xff33_ccff, 0xffcc_33ff],
];

/// A vertex: x, y, z in world space, red, green, blue, and s, t. What no frame shows is 0.
type Corner = [f32; 8];

const TRIANGLES: &[Corner] = &[
    [-2.75, 1.75, 1.0, 0.25, 0.25, 0.25, 0.0, 0.0],
    [0.0, 1.75, 1.0, 0.55, 0.55, 0.55, 1.0, 0.0],
    [-2.75, 0.0, 1.0, 0.75, 0.75, 0.75, 0.0, 1.0],
    [2.75, 1.75, 1.0, 0.8, 0.25, 0.1, 1.0, 0.0],
    [0.1, -1.75, 5.0, 0.1, 0.85, 0.1, 0.1, 1.0],
    [0.25, 0.0, 1.0, 0.1, 0.25, 0.9, 0.25, 0.5],
    [-0.4, -1.75, 5.0, 0.8, 0.25, 0.9, 0.5, 1.0],
    [-1.4, -1.4, 5.0, 0.1, 0.85, 0.9, 0.2, 0.5],
    [0.0, 0.0, 5.0, 0.85, 0.95, 0.1, 1.0, 0.0],
];
const STRIP: &[Corner] = &[
    [-2.75, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [-2.25, 1.75, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0],
    [-2.0, -1.75, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
    [-1.3, 1.6, 1.15, 0.25, 0.0, 0.8, 1.15, 0.25],
    [0.0, -1.5, 1.3, 0.75, 0.0, 0.25, 1.3, 0.75],
    [0.4, 1.0, 1.7, 0.33, 0.33, 0.33, 1.7, 0.33],
    [1.4, -0.6, 5.0, 0.7, 0.7, 0.7, 0.7, 0.7],
    [2.75, 1.75, 5.0, 0.5, 0.5, 0.6, 0.5, 0.5],
];
const FAN: &[Corner] = &[
    [0.0, -0.75, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0],
    [-2.25, -1.75, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
    [-2.0, 1.75, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0],
    [-0.6, 0.65, 1.15, 0.25, 0.0, 0.8, 1.15, 0.25],
    [0.0, 1.5, 1.3, 0.75, 0.0, 0.25, 1.3, 0.75],
    [0.4, 1.0, 1.7, 0.33, 0.33, 0.33, 1.7, 0.33],
    [2.4, 0.6, 5.0, 0.7, 0.7, 0.7, 0.7, 0.7],
    [2.75, -1.75, 5.0, 0.5, 0.5, 0.6, 0.5, 0.5],
];
const QUADS: &[Corner] = &[
    [-2.75, 1.75, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-0.4, 1.75, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    [-0.4, -1.75, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0],
    [-2.75, -1.75, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
    [0.15, 1.75, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [2.75, 1.75, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    [2.75, -1.75, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0],
    [0.0, -1.75, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
];
const SOLID_QUADS: &[Corner] = &[
    [-2.75, 1.75, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0],
    [-0.6, 1.6, 1.7, 0.5, 0.5, 0.6, 0.0, 0.0],
    [-1.35, -0.6, 1.7, 0.7, 0.7, 0.7, 0.0, 0.0],
    [-2.4, -1.75, 1.7, 0.33, 0.33, 0.33, 0.0, 0.0],
    [0.06, -0.09, 1.0, 1.0, 0.0, 1.0, 0.0, 0.0],
    [1.9, -0.25, 1.0, 0.1, 0.3, 0.6, 0.0, 0.0],
    [2.62, -1.03, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
    [1.25, -1.65, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0],
    [-1.25, 1.3, 5.0, 0.25, 0.25, 0.25, 0.0, 0.0],
    [0.3, 1.25, 5.0, 0.1, 0.3, 0.1, 0.0, 0.0],
    [2.62, -0.03, 5.0, 0.65, 0.65, 0.65, 0.0, 0.0],
    [-1.0, -1.0, 5.0, 0.45, 0.45, 0.45, 0.0, 0.0],
];
const QUAD_STRIP: &[Corner] = &[
    [-2.75, -1.75, 1.0, 0.33, 0.33, 0.33, 0.33, 0.33],
    [-2.75, 1.75, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0],
    [0.0, -1.35, 1.0, 0.7, 0.1, 0.0, 0.7, 0.1],
    [0.0, 1.0, 1.0, 0.0, 0.9, 0.2, 0.0, 0.9],
    [2.75, -1.75, 1.0, 0.33, 0.33, 0.33, 0.33, 0.33],
    [2.75, 1.75, 1.0, 0.0, 0.7, 0.9, 0.0, 0.7],
];
const POLYGON: &[Corner] = &[
    [-2.75, -1.75, 1.0, 0.33, 0.33, 0.33, 0.33, 0.33],
    [-1.4, 1.1, 1.0, 0.7, 0.1, 0.0, 0.7, 0.1],
    [-0.3, 1.75, 1.0, 0.1, 0.7, 0.5, 0.1, 0.7],
    [2.0, 0.3, 1.0, 0.0, 0.9, 0.2, 0.0, 0.9],
    [2.75, -1.5, 1.0, 0.7, 0.7, 0.7, 0.7, 0.7],
];

/// A shape: name, topology and vertices.
type Shape = (&'static str, Topology, &'static [Corner]);

/// The shapes of Shade_model.
const SHAPES: [Shape; 6] = [
    ("Tri", Topology::Triangles, TRIANGLES),
    ("TriStrip", Topology::TriangleStrip, STRIP),
    ("TriFan", Topology::TriangleFan, FAN),
    ("Quad", Topology::Quads, QUADS),
    ("QuadStrip", Topology::QuadStrip, QUAD_STRIP),
    ("Poly", Topology::Polygon, POLYGON),
];

/// The normals of vertices in Shade_model.
const NORMALS: [[f32; 3]; 9] = [
    [0.577_350_26, -0.577_350_26, 0.577_350_26],
    [0.0, 0.0, 1.0],
    [0.408_248_28, 0.408_248_28, 0.816_496_6],
    [-0.666_67, 0.666_67, 0.333_333_3],
    [0.301_5, 0.301_5, 0.904_5],
    [0.485_1, 0.485_1, 0.727_6],
    [0.624_7, 0.624_7, 0.468_5],
    [0.267_3, 0.534_5, 0.801_8],
    [0.676_7, 0.676_7, 0.29],
];

/// Returns a shape whose vertices a light behind the viewer lights.
fn lit_shape(topology: Topology, points: &[Corner], at: impl Iterator<Item = f32>) -> Draw {
    let light = Light::Infinite { direction: [0.0, 0.0, 1.0], half: [0.0; 3] };
    let lamp = (light, [[0.0; 3], [0.0, 1.0, 0.7], [0.0; 3]]);
    let shading = shading(&[lamp], material([0.0; 3], 1.0, POWER_10), 1 << 16 | 1);
    let given = points.iter().zip(NORMALS).zip(at).map(|(([x, y, ..], normal), w)| LitVertex {
        position: [*x, *y, 0.1, w],
        normal,
        diffuse: [1.0; 4],
        specular: [0.0; 4],
    });
    draw(topology, given.map(|given| lit(&given, &shading, SurfaceSide::Front)).collect())
}

/// Adds the frames of Shade_model: colours, smooth and flat by either provoking vertex, and textures, which the shade model does not affect.
pub(super) fn shade_model(frames: &mut Frames) {
    let colors = [abgr(0xff20_c0c0), abgr(0xff00_0070)];
    let texture = images::texture(TextureFormat::A8B8G8R8, [64, 64], checker(colors, 8));
    for (name, topology, points) in SHAPES {
        let programmed = points.iter().map(|[x, y, ..]| without_depth(space::programmed([*x, *y, 0.1, 1.0])));
        let programmed: Vec<[f32; 4]> = programmed.collect();
        // The w of the vertices grows by `more` from one to the next.
        let growing = |w: f32, more: f32| std::iter::successors(Some(w), move |w| Some(w + more));
        let fixed = |w: f32, more: f32| {
            points.iter().zip(growing(w, more)).map(|([x, y, ..], w)| space::flat([*x, *y, 0.1, w])).collect()
        };
        let lit = [("Fixed", 1.0, 0.0), ("W_Fixed", 0.5, 0.05)]
            .map(|(name, w, more)| (name, lit_shape(topology, points, growing(w, more))));
        let pictures = |positions: Vec<[f32; 4]>| {
            let vertices = positions.iter().zip(points).map(|(at, [.., s, t])| placed(*at, [*s, *t]));
            one(0xff2c_302e, Some(&texture), fetching(draw(topology, vertices.collect()), 0, nearest(0)))
        };
        let [program, flat_w, varying_w] = [programmed.clone(), fixed(1.0, 0.0), fixed(0.5, 0.05)].map(pictures);
        let shaded = programmed.into_iter().zip(COLORS.as_flattened()).map(|(position, color)| Vertex {
            position,
            diffuse: VertexColor::Bytes(abgr(*color)),
            ..Vertex::default()
        });
        let shaded = draw(topology, shaded.collect());
        for (mode, shade_model) in [("Smooth", ShadeModel::Smooth), ("Flat", ShadeModel::Flat)] {
            for (vertex, provoking_vertex) in [("First", ProvokingVertex::First), ("Last", ProvokingVertex::Last)] {
                let suffix = format!("{name}_{mode}_{vertex}");
                let colored = Draw { shade_model, provoking_vertex, ..shaded.clone() };
                let lines = Draw { polygon_modes: WIREFRAME, ..colored.clone() };
                frames.push(format!("ProgLM_{suffix}"), one(0xff2c_302e, None, lines));
                frames.push(format!("Prog_{suffix}"), one(0xff2c_302e, None, colored));
                frames.push(format!("ProgTex_{suffix}"), program.clone());
                frames.push(format!("FixedTex_{suffix}"), flat_w.clone());
                for (name, shape) in &lit {
                    let shape = Draw { shade_model, provoking_vertex, ..shape.clone() };
                    frames.push(format!("{name}_{suffix}"), one(0xff2c_302e, None, shape));
                }
                frames.push(format!("W_FixedTex_{suffix}"), varying_w.clone());
            }
        }
    }
}

/// Adds the frames of Texture_perspective: a square whose corners differ in w, with and without perspective, as two triangles and as a quad.
pub(super) fn perspective(frames: &mut Frames) {
    let colors = [argb(0xff00_ffff), argb(0xff00_0000)];
    let texture = images::texture(TextureFormat::A8R8G8B8, [256, 256], checker(colors, 8));
    let texture = images::in_texels(texture);
    let place = |n: usize, w: f32| {
        let [x, y] = corners([-1.75, 1.75, 1.75, -1.75])[n];
        space::flat([x, y, 0.0, w])
    };
    for (letter, perspective) in [("y", true), ("n", false)] {
        for (kind, topology, order) in
            [("bitri", Topology::Triangles, &[0, 1, 3, 2, 3, 1][..]), ("quad", Topology::Quads, &[0, 1, 2, 3])]
        {
            let bytes = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255; 4]];
            let colored = |n: usize| {
                let position = place(n, [0.3, 1.0, 0.3, 1.0][n]);
                Vertex { position, diffuse: VertexColor::Bytes(bytes[n]), ..Vertex::default() }
            };
            let all = draw(topology, order.iter().map(|n| colored(*n)).collect());
            let all = Draw { perspective, ..all };
            frames.push(format!("tex_diff_pers_{letter}_{kind}"), one(0xfe25_1135, None, all));
            let shown = |n: usize| placed(place(n, [0.3, 1.0, 3.0, 1.0][n]), corners([0.0, 0.0, 256.0, 256.0])[n]);
            let all = fetching(draw(topology, order.iter().map(|n| shown(*n)).collect()), 0, nearest(0));
            let all = Draw { perspective, ..all };
            frames.push(format!("tex_tex_pers_{letter}_{kind}"), one(0xfe25_1135, Some(&texture), all));
        }
    }
}

/// The values that the frames of Attrib_float give to colours, from the top to the bottom.
const FLOATS: [(&str, [f32; 2]); 11] = [
    ("0_1", [0.0, 1.0]),
    ("-1_1", [-1.0, 1.0]),
    ("-8_1", [-8.0, 1.0]),
    ("0_8", [0.0, 8.0]),
    ("-NaNq_NaNq", [-f32::NAN, f32::NAN]),
    ("-NaNs_NaNs", [-f32::NAN, f32::NAN]),
    ("-INF_INF", [f32::NEG_INFINITY, f32::INFINITY]),
    ("-Max_Max", [f32::MIN, f32::MAX]),
    ("-MinN_MinN", [-f32::MIN_POSITIVE, f32::MIN_POSITIVE]),
    ("-MaxSN_MaxSN", [f32::from_bits(0x807f_ffff), f32::from_bits(0x007f_ffff)]),
    ("-Min_Min", [f32::from_bits(0x8000_0001), f32::from_bits(1)]),
];

/// Returns the product that a vertex program makes: 0 of 0 and whatever it is, else a positive NaN of one.
fn product(a: f32, b: f32) -> f32 {
    let [a, b] = [a, b].map(|factor| if factor.is_subnormal() { 0.0 } else { factor });
    match () {
        () if a == 0.0 || b == 0.0 => 0.0,
        () if a.is_nan() || b.is_nan() => f32::NAN,
        () => a * b,
    }
}

/// Returns the colour of a float as a scene may have it: a positive NaN is all of a colour, a negative one nothing.
pub(super) fn limited(value: f32) -> f32 {
    if value.is_nan() { f32::from(u8::from(value.is_sign_positive())) } else { value.clamp(-8.0, 8.0) }
}

/// Adds the frames of Attrib_float: colours outside 0 to 1, as they are, and times numbers, infinities and NaN.
pub(super) fn float_colors(frames: &mut Frames) {
    for (name, values) in FLOATS {
        let mut canvas = Canvas::new(0xff64_95ed);
        let inset = 0.2_f32;
        let tall = 1.0 - 2.0 * inset;
        let wide = tall / 6.0;
        let factors = [1.0, 0.0, f32::NEG_INFINITY, f32::INFINITY, -f32::NAN, f32::NAN];
        let factors = [None].into_iter().chain(factors.map(Some)).zip(0_u8..);
        for (factor, column) in factors {
            let (x, y) = ((inset + f32::from(column) * wide) * 640.0, (inset + 0.1) * 480.0);
            let (right, bottom) = (x + wide * 0.8 * 640.0, y + tall * 480.0);
            let shades = values.map(|value| limited(factor.map_or(value, |factor| product(value, factor))));
            let corners = corners([x, y, right, bottom]).into_iter().zip([shades[0], shades[0], shades[1], shades[1]]);
            let corners =
                corners.map(|(corner, shade)| vertex(corner, VertexColor::Floats([shade, shade, shade, 1.0])));
            canvas.draw(draw(Topology::Quads, corners.collect()));
        }
        frames.push(name, canvas.colors());
    }
    frames.paint("Colors", 0xff33_3333, |canvas| {
        // The secondary colour is not enabled.
        for (left, [r, g, b]) in [(128.0, [255, 0, 255]), (384.0, [0; 3])] {
            for top in [64.0, 208.0] {
                canvas.draw(rectangle(sized([left, top], [128.0; 2]), VertexColor::Bytes([r, g, b, 255])));
            }
        }
    });
}

/// Adds the frames of High_vertex_count: 34,952 vertices of small squares over each other. The way that vertices reach the chip changes no pixel.
pub(super) fn many_vertices(frames: &mut Frames) {
    const SQUARES: u32 = 0x7ffff / 60;
    let mut vertices = Vec::new();
    let mut color = [0.0_f32, 0.5, 0.75];
    let (mut top, mut alpha, mut count) = (48.0_f32, 1.0_f32, 0);
    while count < SQUARES {
        for column in 0..106_u8.min((SQUARES - count).min(106) as u8) {
            let left = 2.0 + 6.0 * f32::from(column);
            for corner in corners(sized([left, top], [6.0; 2])) {
                let [r, g, b] = color;
                vertices.push(vertex(corner, VertexColor::Floats([r, g, b, alpha])));
                for _ in 0..2 {
                    for (channel, more) in color.iter_mut().zip([0.03, 0.05, 0.01]) {
                        *channel += more;
                        if *channel > 1.0 {
                            *channel -= 1.0;
                        }
                    }
                }
            }
            count += 1;
        }
        top += 6.0;
        if top > 474.0 {
            (top, color, alpha) = (48.0, [1.0, 0.0, 1.0], alpha * 0.75);
        }
    }
    let drawn = one(0xff44_4444, None, draw(Topology::Quads, vertices));
    for kind in ["arrays", "inlinearrays", "inlinebuffers", "inlineelements"] {
        frames.push(format!("HighVtxCount-{kind}"), drawn.clone());
    }
}

/// The ends of the lines of 3D_primitive.
const SOLID_LINES: &[Corner] = &[
    [-2.75, 1.75, 1.0, 0.75, 0.75, 0.75, 0.0, 0.0],
    [2.75, 1.75, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0],
    [-2.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [2.0, 0.0, 5.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [1.5, 0.5, 5.0, 0.0, 1.0, 0.0, 0.0, 0.0],
    [-1.5, 0.75, 5.0, 0.0, 1.0, 0.0, 0.0, 0.0],
    [2.75, 0.25, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0],
    [1.75, 1.25, 1.0, 0.15, 0.15, 0.15, 0.0, 0.0],
    [-2.75, 1.0, 1.0, 0.25, 0.25, 1.0, 0.0, 0.0],
    [-2.75, -1.0, 1.0, 0.65, 0.65, 1.0, 0.0, 0.0],
    [-2.75, -1.75, 5.0, 0.0, 1.0, 1.0, 0.0, 0.0],
    [2.75, -1.75, 5.0, 0.5, 0.5, 1.0, 0.0, 0.0],
];

/// The shapes of 3D_primitive.
const SOLIDS: [Shape; 10] = [
    ("Points", Topology::Points, SOLID_LINES),
    ("Lines", Topology::Lines, SOLID_LINES),
    ("LineLoop", Topology::LineLoop, SOLID_LINES),
    ("LineStrip", Topology::LineStrip, SOLID_LINES),
    ("Triangles", Topology::Triangles, TRIANGLES),
    ("TriStrip", Topology::TriangleStrip, STRIP),
    ("TriFan", Topology::TriangleFan, FAN),
    ("Quads", Topology::Quads, SOLID_QUADS),
    ("QuadStrip", Topology::QuadStrip, QUAD_STRIP),
    ("Polygon", Topology::Polygon, POLYGON),
];

/// Returns the shapes of 3D_primitive with their names.
pub(super) fn solids() -> impl Iterator<Item = (&'static str, Draw)> {
    SOLIDS.into_iter().map(|(name, topology, vertices)| {
        let depth_test = Some(in_steps(CompareFunction::Less, true, None));
        (name, Draw { depth_test, ..lines::thin(draw(topology, vertices.iter().map(solid).collect())) })
    })
}

/// Adds the frames of Zero_stride: colours that lie no bytes apart are all the first one.
pub(super) fn one_color(frames: &mut Frames) {
    let diffuse = VertexColor::Floats([0.25, 0.25, 0.25, 1.0]);
    let vertex = |corner: &Corner| Vertex { diffuse, ..solid(corner) };
    let depth_test = Some(in_steps(CompareFunction::Less, true, None));
    let shape = Draw { depth_test, ..draw(Topology::Triangles, TRIANGLES.iter().map(vertex).collect()) };
    let drawn = one(0xff30_3030, None, shape);
    for name in ["DrawArrays", "InlineElements"] {
        frames.push(name, drawn.clone());
    }
}

/// Returns a vertex of the fixed function, and its colour. The transform unit leaves fractions of a step of depth.
fn solid([x, y, z, r, g, b, ..]: &Corner) -> Vertex {
    let [x, y, z, w] = space::fixed_function([*x, *y, *z, 1.0]);
    Vertex { position: [x, y, z, w], diffuse: VertexColor::Floats([*r, *g, *b, 1.0]), ..Vertex::default() }
}

/// The strip of Overlapping_draw_modes.
const MIXED_STRIP: &[Corner] = &[
    [-2.75, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [-1.75, 1.75, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0],
    [-2.25, -1.75, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
    [-1.25, 1.25, 1.0, 0.25, 0.0, 0.8, 0.0, 0.0],
    [-0.75, -1.25, 1.0, 0.75, 0.0, 0.25, 0.0, 0.0],
    [-0.25, 0.75, 1.0, 0.33, 0.33, 0.33, 0.0, 0.0],
    [0.25, -0.75, 1.0, 0.7, 0.7, 0.7, 0.0, 0.0],
    [0.75, 1.75, 1.0, 0.5, 0.5, 0.6, 0.0, 0.0],
];
/// Its triangles.
const MIXED_TRIANGLES: [[Corner; 3]; 4] = [
    [
        [-2.75, 1.75, 1.0, 0.25, 0.25, 0.25, 0.0, 0.0],
        [0.0, 1.75, 1.0, 0.55, 0.55, 0.55, 0.0, 0.0],
        [-2.75, 0.0, 1.0, 0.75, 0.75, 0.75, 0.0, 0.0],
    ],
    [
        [2.75, 1.75, 1.0, 0.8, 0.25, 0.1, 0.0, 0.0],
        [0.1, -1.75, 1.0, 0.1, 0.85, 0.1, 0.0, 0.0],
        [0.25, 0.0, 1.0, 0.1, 0.25, 0.9, 0.0, 0.0],
    ],
    [
        [-0.4, -1.75, 1.0, 0.8, 0.25, 0.9, 0.0, 0.0],
        [-1.4, -1.4, 1.0, 0.1, 0.85, 0.9, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.85, 0.95, 0.1, 0.0, 0.0],
    ],
    [
        [-2.75, -1.75, 1.0, 0.2, 0.4, 0.8, 0.0, 0.0],
        [-2.75, 0.0, 1.0, 0.3, 0.5, 0.9, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.4, 0.3, 0.7, 0.0, 0.0],
    ],
];

/// Adds the frames of Overlapping_draw_modes: vertices that reach the chip in several ways between one begin and its end.
pub(super) fn mixed_modes(frames: &mut Frames) {
    let strip = draw(Topology::TriangleStrip, MIXED_STRIP.iter().map(solid).collect());
    frames.push("ArrElm_DrwArr_ArrElm", one(0xfe24_2424, None, strip));
    for (name, numbers) in
        [("DrwArr_DrwArr", &[0, 2][..]), ("SquashOpt", &[0, 1, 2, 3]), ("SquashOptSingleArray", &[2, 3, 0, 1])]
    {
        let vertices = numbers.iter().flat_map(|number: &usize| MIXED_TRIANGLES[*number].iter().map(solid));
        frames.push(name, one(0xfe24_2424, None, draw(Topology::Triangles, vertices.collect())));
    }
}
