//! Values of attributes that no vertex gives, and swizzled moves of vertex programs: what vertices become before they reach the model's stages.

use super::*;

/// How a program passes vertices, in the names of frames; and the value that it gives the attribute in question.
const MODES: [(&str, [f32; 4]); 4] = [
    ("0.1_0.0_1.0_1.0-da", [0.05, 0.0, 1.0, 1.0]),
    ("0.8_0.0_0.0_1.0-ib", [0.75, 0.0, 0.0, 1.0]),
    ("0.5_0.0_0.0_1.0-ia", [0.5, 0.0, 0.0, 1.0]),
    ("0.2_0.0_0.6_1.0-ie", [0.25, 0.0, 0.6, 1.0]),
];

/// How many components of an attribute a program sets, and how it shows them.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// One number, shown as red and green beside full blue. The second value is that of the vertex before the last.
    Number(f32),
    /// A point size. Vertices in line do not have one, so the value before them stays.
    PointSize,
    Normal,
    Color,
    /// Two numbers in an array, all four in line.
    Coordinates,
}

const ATTRIBUTES: [(&str, Kind); 12] = [
    ("w", Kind::Number(0.66)),
    ("n", Kind::Normal),
    ("d", Kind::Color),
    ("s", Kind::Color),
    ("fc", Kind::Number(0.5)),
    ("ps", Kind::PointSize),
    ("bd", Kind::Color),
    ("bs", Kind::Color),
    ("t0", Kind::Coordinates),
    ("t1", Kind::Coordinates),
    ("t2", Kind::Coordinates),
    ("t3", Kind::Coordinates),
];

/// Returns the colour of a vertex that has none of its own: the attribute of the last vertex before it. Vertices by index end with another one.
fn carried(mode: &str, kind: Kind, [r, g, b, a]: [f32; 4]) -> [f32; 4] {
    let (by_index, in_line) = (mode.ends_with("ie"), mode.ends_with("ib"));
    match kind {
        Kind::Number(number) if by_index => [number, number, 1.0, 1.0],
        Kind::PointSize if by_index => [0.7, 0.7, 1.0, 1.0],
        Kind::PointSize if in_line => [0.5, 0.5, 1.0, 1.0],
        _ if by_index => [0.0, 1.0, 0.0, 1.0],
        Kind::Number(_) | Kind::PointSize => [r, r, 1.0, 1.0],
        Kind::Normal => [r, g, b, 1.0],
        Kind::Color => [r, g, b, a],
        Kind::Coordinates if in_line => [r, g, b, a],
        Kind::Coordinates => [r, g, 0.0, 1.0],
    }
}

const GREEN: [f32; 4] = [0.0, 1.0, 0.0, 1.0];
const MAGENTA: [f32; 4] = [1.0, 0.0, 1.0, 1.0];

/// Adds the frames of Attrib_carryover: a line or triangle with the attribute, then one without.
pub(super) fn carryover(frames: &mut Frames) {
    for (attribute, kind) in ATTRIBUTES {
        for (mode, value) in MODES {
            let color = VertexColor::Floats(carried(mode, kind, value));
            let by_index = mode.ends_with("ie");
            let last = if attribute == "d" { value } else { MAGENTA };
            let shape = move |corners: &[[f32; 2]], colors: &[VertexColor], order: &[u32]| {
                let topology = if corners.len() == 2 { Topology::Lines } else { Topology::Triangles };
                let vertices = corners.iter().zip(colors).map(|(at, color)| vertex(*at, *color)).collect();
                let shape = draw(topology, vertices);
                if by_index { Draw { indices: order.into(), ..shape } } else { shape }
            };
            frames.paint(format!("L-{attribute}{mode}"), 0xff44_4444, move |canvas| {
                let colors = [GREEN, last].map(VertexColor::Floats);
                canvas.draw(shape(&[[128.0, 80.0], [512.0, 80.0]], &colors, &[1, 0]));
                canvas.draw(shape(&[[128.0, 400.0], [512.0, 400.0]], &[color; 2], &[1, 0]));
            });
            frames.paint(format!("T-{attribute}{mode}"), 0xff44_4444, move |canvas| {
                let colors = [[1.0; 4], GREEN, last].map(VertexColor::Floats);
                canvas.draw(shape(&[[128.0, 80.0], [320.0, 80.0], [224.0, 400.0]], &colors, &[2, 0, 1]));
                canvas.draw(shape(&[[320.0, 80.0], [512.0, 80.0], [416.0, 400.0]], &[color; 3], &[2, 0, 1]));
            });
        }
    }
}

/// Returns the index of a component in the letters of masks or swizzles.
fn component(letter: char) -> usize {
    "rgba".find(letter).or_else(|| "xyzw".find(letter)).unwrap_or(0)
}

/// Returns the colour that a move writes: `mask` of the four components, read in the order of `swizzle`, whose last letter repeats.
fn moved(mask: &str, swizzle: &str) -> [f32; 4] {
    let given = [0.6, 0.7, 0.8, 1.0];
    let mut color = [0.33; 4];
    let read: Vec<usize> = swizzle.chars().map(component).collect();
    for at in mask.chars().map(component) {
        color[at] = given[read[at.min(read.len() - 1)]];
    }
    color
}

/// Draws nine squares on a dark background, each in the colour of a move.
fn moves(canvas: &mut Canvas, colors: &[[f32; 4]], opaque: bool) {
    let fields = checker([abgr(0xff20_2020), abgr(0xff00_0000)], 24);
    let texture = canvas.texture(&images::texture(TextureFormat::A8B8G8R8, [256; 2], fields));
    let background = pasted([0.0, 0.0, 640.0, 480.0], 0, nearest(texture), WHOLE);
    canvas.draw(without_alpha(background, FinalRegister::Texture0));
    for (color, at) in colors.iter().zip(places([88.0, 58.0], [184.0, 154.0], 3)) {
        let square = rectangle(sized(at, [96.0; 2]), VertexColor::Floats(*color));
        canvas.draw(if opaque { without_alpha(square, FinalRegister::PrimaryColor) } else { square });
    }
}

/// Adds the frames of Vertex_shader_swizzle_tests. A program that moves nothing leaves the colour that it starts with.
pub(super) fn swizzles(frames: &mut Frames) {
    let (masks, swizzles) = ("ra r gb rgba ga ba rg b gba a rba rga rb rgb g", "xw zy yw yzw yx wzy xzw zx zxy wz");
    let (opaque_masks, opaque_swizzles) = ("g rb rg b gb r rgb", "wz xw zx xy yzw wzy zy yw xzw zxy yx wy");
    for (suffix, masks, swizzles, opaque) in [("", masks, swizzles, false), ("NA", opaque_masks, opaque_swizzles, true)]
    {
        let each = |mask: &'static str| swizzles.split(' ').map(move |swizzle| moved(mask, swizzle));
        let colors: Vec<[f32; 4]> = masks.split(' ').flat_map(each).collect();
        for (n, nine) in colors.chunks(9).enumerate() {
            let nine = nine.to_vec();
            frames.paint(format!("{suffix}Mov{n:02}"), 0xfe31_2f31, move |canvas| moves(canvas, &nine, opaque));
        }
        frames.paint(format!("Control{suffix}"), 0xfe31_2f31, move |canvas| moves(canvas, &[[0.33; 4]], opaque));
    }
}

/// Returns the number that a program gets of a signed word, which it moves to 0 to 1.
fn of_word(value: f32) -> f32 {
    let word = (value * 65535.0 - 32768.0) as i16;
    (f32::from(word) + 32768.0) * (1.0 / 65535.0)
}

/// Returns the number that a program gets of a normal's word, moved to 0 to 1.
fn of_normal(word: i16) -> f32 {
    (f32::from(word) / 32767.0 + 1.0) * 0.5
}

/// Returns colours that an attribute becomes: of three or four numbers, or of words.
fn setter(name: &str, values: [[f32; 4]; 3]) -> [VertexColor; 3] {
    let (words, count) = (name.ends_with('s'), name.chars().rev().nth(1).and_then(|n| n.to_digit(10)).unwrap_or(4));
    values.map(|[r, g, b, a]| {
        let all = [r, g, b, a].map(|value| if words { of_word(value) } else { value });
        // Components that are not set are those of black.
        let black = [0.0, 0.0, 0.0, 1.0];
        VertexColor::Floats(std::array::from_fn(|n| if n < count as usize { all[n] } else { black[n] }))
    })
}

/// The attributes of Attrib_setter: number of components, words (`s`) or floats (`f`), and the values of three vertices.
const SETTERS: [(&str, [[f32; 4]; 3]); 21] = [
    ("d3f", [[0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]]),
    ("d4f", [[0.0, 0.0, 1.0, 0.75], [1.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, 0.45]]),
    ("s4f", [[0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [1.0, 0.0, 0.0, 1.0]]),
    ("s3f", [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 0.0]]),
    ("s4f", [[0.0, 1.0, 0.0, 0.75], [0.0, 0.0, 1.0, 0.5], [1.0, 0.0, 0.0, 0.45]]),
    ("t4f", [[0.0, 1.0, 0.0, 0.75], [0.0, 0.0, 1.0, 0.5], [1.0, 0.0, 0.5, 0.45]]),
    ("t2s", [[0.25, 0.0, 0.0, 0.0], [0.0, 0.75, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0]]),
    ("t4s", [[1.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 0.5], [0.5, 0.5, 0.5, 0.75]]),
    ("t2f", [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.65, 0.65, 0.0, 0.0]]),
    ("t2f", [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.65, 0.65, 0.0, 0.0]]),
    ("t2s", [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.4, 0.7, 0.0, 0.0]]),
    ("t4f", [[0.0, 0.0, 1.0, 0.75], [1.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, 0.45]]),
    ("t4s", [[0.0, 0.0, 1.0, 0.75], [1.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, 0.45]]),
    ("t2f", [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.65, 0.65, 0.0, 0.0]]),
    ("t2s", [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.6, 0.6, 0.0, 0.0]]),
    ("t4f", [[1.0, 0.0, 0.0, 0.75], [0.0, 0.0, 1.0, 0.5], [0.0, 1.0, 0.0, 0.45]]),
    ("t4s", [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]]),
    ("t2f", [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.65, 0.65, 0.0, 0.0]]),
    ("t2s", [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.3, 0.3, 0.0, 0.0]]),
    ("t4f", [[0.0, 1.0, 0.0, 0.75], [1.0, 0.0, 0.0, 0.5], [0.0, 0.0, 1.0, 0.45]]),
    ("t4s", [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.1, 1.0, 0.8]]),
];

/// Adds the frames of Attrib_setter: triangles in the colours of attributes, on the background and on what one of them leaves.
pub(super) fn setters(frames: &mut Frames) {
    let normal = setter("n3f", [[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.8, 0.0], [0.0, 0.0, 1.0, 0.0]]);
    let words = [[32767, -32768, 0], [1024, 16536, -32768], [-32768, -4500, 24000]];
    let words = words.map(|[x, y, z]| VertexColor::Floats([of_normal(x), of_normal(y), of_normal(z), 1.0]));
    let bytes = [0xffff_0000, 0xff00_00ff, 0xff00_ff00].map(|word| VertexColor::Bytes(abgr(word)));
    let setters = SETTERS.map(|(name, values)| setter(name, values));
    let all: Vec<[VertexColor; 3]> = [normal, words, bytes].into_iter().chain(setters).collect();
    for (name, is_filled) in [("Setters-alpha", false), ("Setters-visible", true)] {
        let mut canvas = Canvas::new(0xff33_3333);
        if is_filled {
            canvas.draw(rectangle([0.0, 0.0, 640.0, 480.0], VertexColor::Bytes([0, 128, 0, 255])));
        }
        for (colors, [x, y]) in all.iter().zip(places([128.0, 80.0], [52.0, 72.0], 7)) {
            let corners = [[x, y], [x + 45.0, y], [x + 22.5, y + 40.0]];
            let corners = corners.into_iter().zip(colors).map(|(corner, color)| vertex(corner, *color));
            canvas.draw(draw(Topology::Triangles, corners.collect()));
        }
        frames.push(name, canvas.colors());
    }
}
