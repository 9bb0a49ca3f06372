//! Generates the text of scenes whose geometry is given by formulas.

use crate::geometry::{self, CUBES, FACES, PIXEL_OFFSET};
use crate::textures::RADIAL;
use std::fmt::{Display, Write};

/// The colour to which most of the frames are cleared.
const GREY: &str = "(0x20, 0x20, 0x20, 0xfe)";

/// One vertex: its window position, and its coordinate sets by number.
struct Corner {
    position: Vec<f32>,
    sets: Vec<(usize, Vec<f32>)>,
}

/// Returns numbers as a tuple of the scene format.
fn tuple<T: Display>(numbers: &[T]) -> String {
    let numbers: Vec<String> = numbers.iter().map(T::to_string).collect();
    format!("({})", numbers.join(", "))
}

/// Returns the corners of a rectangle, clockwise from the top left. `sets` has coordinate sets with their values at the first and at the
/// opposite corner.
fn rectangle([x0, y0]: [f32; 2], [x1, y1]: [f32; 2], sets: &[(usize, [f32; 2], [f32; 2])]) -> Vec<Corner> {
    let corner = |right: bool, down: bool| {
        let pick = |a: [f32; 2], b: [f32; 2]| vec![if right { b[0] } else { a[0] }, if down { b[1] } else { a[1] }];
        let sets = sets.iter().map(|(n, from, to)| (*n, pick(*from, *to))).collect();
        Corner { position: pick([x0, y0], [x1, y1]), sets }
    };
    vec![corner(false, false), corner(true, false), corner(true, true), corner(false, true)]
}

/// Truncates a window position to 1/16 pixel, as RAS-1 does. Checks that no position is so close to a multiple that the last bit of a
/// formula would decide.
fn snapped(position: f64) -> f32 {
    let sixteenths = position * 16.0;
    let whole = (sixteenths + 1e-9).trunc();
    assert!(
        (sixteenths - sixteenths.round()).abs() < 1e-9 || (sixteenths - sixteenths.round()).abs() > 1e-3,
        "{position}"
    );
    (whole / 16.0) as f32
}

/// The text of a draw under construction.
struct Draw {
    text: String,
}

impl Draw {
    fn new(name: &str, corners: &[Corner]) -> Draw {
        let mut text = format!("        (\n            name: \"{name}\",\n            vertices: Window([\n");
        for corner in corners {
            write!(text, "                (position: {}", tuple(&corner.position)).unwrap();
            for (n, set) in &corner.sets {
                write!(text, ", t{n}: {}", tuple(set)).unwrap();
            }
            text += "),\n";
        }
        text += "            ]),\n            topology: Quads,\n";
        Draw { text }
    }

    fn line(mut self, line: &str) -> Draw {
        writeln!(self.text, "            {line}").unwrap();
        self
    }
}

/// The common parts of these scenes: every draw shows the texel of one unit, blended by its alpha, over the cleared frame.
struct Sheet<'a> {
    comment: &'a str,
    shown: usize,
    opaque: bool,
    clear: &'a str,
    depth: bool,
    textures: &'a [&'a str],
    draws: Vec<Draw>,
}

impl Sheet<'_> {
    fn text(self) -> String {
        let mut out = String::new();
        for line in self.comment.lines().chain(["", "Written by tests/silicon_scenes; BLESS=1 writes it anew."]) {
            writeln!(out, "// {line}").unwrap();
        }
        let out = out.replace("// \n", "//\n");
        let (unit, clear) = (self.shown, self.clear);
        let alpha = if self.opaque { "Invert(Zero, Alpha)".to_string() } else { format!("(Texture{unit}, Alpha)") };
        let depth = if self.depth { ", depth: Z24S8" } else { "" };
        let mut out = format!(
            "{out}(\n    version: 1,\n    profile: Nv2a,\n    names: (\n        programs: {{ \"texel\": Combiners(stages: [()], \
             final_combiner: (d: Texture{unit}, g: {alpha})) }},\n        blends: {{ \"over\": (source: SourceAlpha, \
             destination: OneMinusSourceAlpha) }},\n    ),\n    targets: [(name: \"frame\", width: 640, height: 480, clear: (color: \
             {clear}){depth})],\n    textures: {{\n"
        );
        for texture in self.textures {
            for line in texture.lines() {
                writeln!(out, "        {line}").unwrap();
            }
        }
        out += "    },\n    draws: [\n";
        for draw in self.draws {
            out += &draw.text;
            if self.depth {
                out += "            depth_test: (),\n";
            }
            out += "            program: \"texel\",\n            blend: \"over\",\n        ),\n";
        }
        out + "    ],\n)\n"
    }
}

/// Returns the texture of T6, which has eight levels of different colours.
fn levels() -> String {
    const COLORS: [&str; 8] = [
        "(0, 0, 255)",
        "(0, 255, 0)",
        "(255, 0, 0)",
        "(255, 255, 255)",
        "(0, 255, 255)",
        "(255, 0, 255)",
        "(255, 255, 0)",
        "(128, 128, 128)",
    ];
    let level = |n: usize| {
        let (side, color) = (512 >> n, COLORS[n]);
        format!("Checker(width: {side}, height: {side}, cell: 4, colors: ({color}, (5, 5, 5)))")
    };
    let mips: String = (1..8).map(|n| format!("        {},\n", level(n))).collect();
    format!("\"levels\": (\n    source: {},\n    mips: [\n{mips}    ],\n),", level(0))
}

/// Returns a square with that texture.
fn square_of_levels(name: &str, from: [f32; 2], side: f32, bias: &str) -> Draw {
    let corners = rectangle(from, [from[0] + side, from[1] + side], &[(0, [0.0, 0.0], [1.0, 1.0])]);
    Draw::new(name, &corners).line(&format!(
        "textures: [(texture: \"levels\", address: ClampToEdge, min_filter: Linear, mag_filter: Nearest, mip_filter: Linear{bias})],"
    ))
}

fn level_scene(comment: &str, draws: Vec<Draw>) -> String {
    let sheet = Sheet { comment, shown: 0, opaque: true, clear: GREY, depth: false, textures: &[&levels()], draws };
    sheet.text()
}

/// T6: squares with fifteen values of the lod bias.
pub fn lod_bias() -> String {
    const BIASES: [f32; 15] = [-15.0, -4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 15.0, -0.8, 1.2, 1.8, 2.5, 3.5];
    let draws = BIASES.iter().enumerate().map(|(n, bias)| {
        let from = [192.0 + 96.0 * (n % 5) as f32, [200.0, 296.0, 392.0][n / 5]];
        square_of_levels(&format!("bias {bias}"), from, 64.0, &format!(", lod_bias: {bias}"))
    });
    level_scene(
        "Mipmaps under fifteen LOD biases: This scene repeats part of a frame captured from an Xbox, a texture of eight\n\
         levels at one eighth of its size, under fifteen biases of the lod. It shows which level is read, or which two, and\n\
         how they mix (TEX-9, TEX-6).",
        draws.collect(),
    )
}

/// The left part of the same frame: the texture in sizes from its own down to 1/128.
pub fn nested_levels() -> String {
    let draws = (0..8).map(|n| {
        let side = (512 >> n) as f32;
        square_of_levels(&format!("level {n}"), [160.0 - side, 272.0 - side / 2.0], side, "")
    });
    level_scene(
        "Mipmaps at eight sizes: This scene repeats part of a frame captured from an Xbox, a texture of eight levels at its\n\
         own size and at every half of it down to 1/128 (TEX-9, TEX-11).",
        draws.collect(),
    )
}

/// T7: returns the nine quads of group 0 to 5. `sides` are the values of s, and of t, at the four lines between the quads.
fn nine_quads(group: usize, sides: [f32; 4]) -> Vec<Corner> {
    const CELL: [f64; 2] = [(5.5 - 0.2) / 9.0, (3.5 - 0.1) / 6.0];
    let left = -2.75 + (group % 3) as f64 * ((5.5 - 0.2) / 3.0 + 0.1);
    let top = if group < 3 { 1.75 + 0.425 + 0.1 } else { -0.2 };
    let corner = |column: usize, row: usize| {
        let [x, y, w] =
            geometry::project([left + column as f64 * CELL[0], top - row as f64 * CELL[1], 1.0], PIXEL_OFFSET);
        Corner {
            position: vec![snapped(x), snapped(y), 0.0, w as f32],
            sets: vec![(0, vec![sides[column], sides[row]])],
        }
    };
    let cells = (0..3).flat_map(|row| (0..3).map(move |column| (column, row)));
    let around = [(0, 0), (1, 0), (1, 1), (0, 1)];
    cells.flat_map(|(column, row)| around.map(|(right, down)| corner(column + right, row + down))).collect()
}

/// T7: five address modes, with coordinates from one width before the texture to one after it.
pub fn border() -> String {
    let groups: [(usize, &str); 5] = [
        (0, "Wrap"),
        (1, "Mirror"),
        (2, "ClampToEdge"),
        (3, "ClampToBorder, border_color: (0xff, 0x00, 0xff, 0xf0)"),
        (5, "Clamp"),
    ];
    let draws = groups.iter().map(|(group, mode)| {
        Draw::new(mode.split(',').next().unwrap(), &nine_quads(*group, [-1.0, 0.0, 1.0, 2.0]))
            .line(&format!("textures: [(texture: \"stripes\", address: {mode}, min_filter: Nearest)],"))
    });
    let sheet = Sheet {
        comment: "Five texture address modes: This scene repeats part of a frame captured from an Xbox, five address modes of nine\n\
                  quads each, which together show a texture from -1 to 2 along both sides (TEX-7).",
        shown: 0,
        opaque: false,
        clear: GREY,
        depth: false,
        textures: &["\"stripes\": (source: File(\"textures/stripes.png\")),"],
        draws: draws.collect(),
    };
    sheet.text()
}

/// The sixth group of the same frame, whose texture has a border of texels.
pub fn border_texels() -> String {
    let draw = Draw::new("border texels", &nine_quads(4, [-0.125, 0.0, 1.0, 1.125]))
        .line("textures: [(texture: \"stripes\", address: ClampToBorder, min_filter: Nearest)],");
    let sheet = Sheet {
        comment: "Texture with border texels: This scene repeats part of a frame captured from an Xbox, a texture with border texels\n\
                  on nine quads, the outer ones four texels wide (TEX-7).",
        shown: 0,
        opaque: false,
        clear: GREY,
        depth: false,
        textures: &["\"stripes\": (border: true, source: File(\"textures/bordered-stripes.png\")),"],
        draws: vec![draw],
    };
    sheet.text()
}

/// Returns the faces of the two cubes. `sets` returns the coordinates of a corner by cube, face and corner.
fn cubes(line: &str, sets: impl Fn(usize, usize, usize) -> Vec<(usize, Vec<f32>)>) -> Vec<Draw> {
    CUBES
        .iter()
        .enumerate()
        .map(|(c, cube)| {
            let corners: Vec<Corner> = (0..6)
                .flat_map(|face| (0..4).map(move |corner| (face, corner)))
                .map(|(face, corner)| {
                    let at = cube.corner(FACES[face][corner]);
                    let [x, y, w] = geometry::project(at, 0.0);
                    // Any depth that increases with the distance is sufficient.
                    let z = (w as f32 - 1.0) / 199.0;
                    Corner { position: vec![snapped(x), snapped(y), z, w as f32], sets: sets(c, face, corner) }
                })
                .collect();
            Draw::new(["left cube", "right cube"][c], &corners).line(line)
        })
        .collect()
}

/// T8: a cube map, looked up with the corners of a cube. q is 0.
pub fn cube_map() -> String {
    const COLORS: [(&str, [u32; 2]); 6] = [
        ("positive_x", [0xff77_77ff, 0xff22_2222]),
        ("negative_x", [0xff55_3366, 0xffdd_dddd]),
        ("positive_y", [0xff55_ff55, 0xff22_2222]),
        ("negative_y", [0xff33_aaaa, 0xffdd_dddd]),
        ("positive_z", [0xffff_5555, 0xff22_2222]),
        ("negative_z", [0xffaa_aa33, 0xffdd_dddd]),
    ];
    let faces: String = COLORS
        .iter()
        .map(|(name, words)| {
            let [first, second] = words.map(|word| tuple(&word.to_le_bytes()));
            format!("    {name}: Checker(width: 64, height: 64, cell: 4, colors: ({first}, {second})),\n")
        })
        .collect();
    let texture = format!("\"checkers\": (kind: Cube, source: Faces(\n{faces})),");
    let line = "textures: [(texture: \"checkers\", min_filter: Nearest)],";
    let sheet = Sheet {
        comment: "Two cubes under a cube map: This scene repeats a frame captured from an Xbox, two cubes under a cube map that is\n\
                  looked up with their corners. q is 0, and the lookup does not read it (TEX-12).",
        shown: 0,
        opaque: false,
        clear: "(0x12, 0x12, 0x12, 0xfe)",
        depth: true,
        textures: &[&texture],
        draws: cubes(line, |_, face, corner| {
            let [x, y, z] = FACES[face][corner].map(f32::from);
            vec![(0, vec![x, y, z, 0.0])]
        }),
    };
    sheet.text()
}

/// T9: normals from a map, which three dot products turn into the direction of a cube map.
pub fn dot_cube() -> String {
    // Left, top, right and bottom of each face in the map.
    const PLACES: [[f32; 4]; 6] = [
        [0.25, 0.375, 0.5, 0.625],
        [0.75, 0.375, 1.0, 0.625],
        [0.5, 0.375, 0.75, 0.625],
        [0.0, 0.375, 0.25, 0.625],
        [0.25, 0.625, 0.5, 0.875],
        [0.25, 0.125, 0.5, 0.375],
    ];
    let names = ["positive_x", "negative_x", "positive_y", "negative_y", "positive_z", "negative_z"];
    let faces: String = names
        .iter()
        .zip(RADIAL)
        .map(|(face, (name, _))| format!("    {face}: File(\"textures/radial-{name}.png\"),\n"))
        .collect();
    let texture = format!("\"radial\": (kind: Cube, source: Faces(\n{faces})),");
    let rows = CUBES.map(|cube| cube.window_to_object());
    let line = "textures: [(texture: \"normals\", address: ClampToEdge, min_filter: Nearest), Unbound, Unbound, (texture: \"radial\", \
                min_filter: Nearest)],\n            texture_shader: [\n                Sample,\n                (operation: \
                DotProduct, mapping: MinusOneToOneGl),\n                (operation: DotProduct, previous: 0, mapping: \
                MinusOneToOneGl),\n                (operation: DotProductCube, previous: 0, mapping: MinusOneToOneGl),\n            ],";
    let sheet = Sheet {
        comment: "Cube map by three dot products: This scene repeats a frame captured from an Xbox, in which three dot products of a\n\
                  normal map with a matrix give the direction that looks up a cube map (TSH-2, TSH-4).\n\
                  \n\
                  The normal map is not part of the repository: see README.md.",
        shown: 3,
        opaque: false,
        clear: "(0x13, 0x13, 0x13, 0xfe)",
        depth: true,
        textures: &["\"normals\": (source: File(\"captured/cube_normals_object_space.png\")),", &texture],
        draws: cubes(line, |cube, face, corner| {
            let [u0, v0, u1, v1] = PLACES[face];
            let at = [[u0, v0], [u1, v0], [u1, v1], [u0, v1]][corner];
            let mut sets = vec![(0, at.to_vec())];
            sets.extend((0..3).map(|n| (n + 1, rows[cube][n][..3].iter().map(|c| *c as f32).collect())));
            sets
        }),
    };
    sheet.text()
}

/// T10: two dot products of a normal map are the coordinates of a texture.
pub fn dot_2d() -> String {
    const EYE: [f32; 3] = [0.0, 0.0, -7.0];
    const LAMP: [f32; 3] = [-1.5, 5.0, 0.0];
    const CORNERS: [[f32; 3]; 4] = [[-1.0, 1.0, 4.0], [1.0, 1.0, 7.0], [1.0, -2.0, 6.0], [-1.0, -2.0, 4.0]];
    let mut corners = rectangle([192.5, 112.5], [448.5, 368.5], &[(0, [0.0, 0.0], [128.0, 128.0])]);
    for (corner, at) in corners.iter_mut().zip(CORNERS) {
        corner.sets.push((1, geometry::direction(EYE, at).to_vec()));
        corner.sets.push((2, geometry::direction(at, LAMP).to_vec()));
    }
    let draw = Draw::new("quad", &corners)
        .line(
            "textures: [(texture: \"water\", address: ClampToEdge, min_filter: Nearest), Unbound, (texture: \"image\", address: \
             ClampToEdge, min_filter: Nearest)],",
        )
        .line("texture_shader: [Sample, DotProduct, (operation: DotProduct2D, previous: 0)],");
    let sheet = Sheet {
        comment: "Texture lookup by two dot products: This scene repeats a frame captured from an Xbox, in which two dot products of\n\
                  a normal map with interpolated vectors are the coordinates of a texture (TSH-1, TSH-4).\n\
                  \n\
                  The images are not part of the repository: see README.md.",
        shown: 2,
        opaque: false,
        clear: "(0x22, 0x22, 0x22, 0xff)",
        depth: false,
        textures: &[
            "\"water\": (kind: Rectangle, source: File(\"captured/water_bump_map.png\")),",
            "\"image\": (source: File(\"captured/bump_map_test_image.png\")),",
        ],
        draws: vec![draw],
    };
    sheet.text()
}

/// T12: eight matrices of a bump map.
pub fn bump_matrices() -> String {
    const MATRICES: [[f32; 4]; 8] = [
        [-1.0, 0.0, 1.0, 0.0],
        [1.0, 1.0, 1.0, 1.0],
        [0.0, 0.2, 0.0, 0.75],
        [0.5, -0.5, 0.5, -0.5],
        [0.3, 0.5, 0.7, 1.0],
        [0.0, 1.0, -1.0, 0.0],
        [0.0, 0.0, 1.0, 1.0],
        [0.5, 0.8, 0.0, 0.0],
    ];
    let draws = MATRICES.iter().enumerate().map(|(n, matrix)| {
        let (x, y) = (152.5 + 144.0 * (n % 3) as f32, 64.5 + 144.0 * (n / 3) as f32);
        let texels = |set| (set, [0.0, 0.0], [128.0, 128.0]);
        let corners = rectangle([x, y], [x + 128.0, y + 128.0], &[texels(0), texels(1)]);
        let matrix = tuple(matrix);
        Draw::new(&format!("matrix {n}"), &corners)
            .line(
                "textures: [(texture: \"water\", address: ClampToEdge, min_filter: Nearest), (texture: \"image\", address: ClampToEdge, \
                 min_filter: Nearest)],",
            )
            .line(&format!("texture_shader: [Sample, BumpEnvironment(matrix: {matrix})],"))
    });
    let sheet = Sheet {
        comment: "Eight bump environment matrices: This scene repeats part of a frame captured from an Xbox, a texture whose\n\
                  coordinates are moved by blue and green of another, by eight matrices (TSH-7). Both are rectangles: what is added\n\
                  is texels.\n\
                  \n\
                  The images are not part of the repository: see README.md.",
        shown: 1,
        opaque: false,
        clear: "(0x22, 0x22, 0x22, 0xff)",
        depth: false,
        textures: &[
            "\"water\": (kind: Rectangle, source: File(\"captured/water_bump_map.png\")),",
            "\"image\": (kind: Rectangle, source: File(\"captured/bump_map_test_image.png\")),",
        ],
        draws: draws.collect(),
    };
    sheet.text()
}

/// T13: a step from below to above one half, filtered as unsigned and as signed channels.
pub fn bump_signs() -> String {
    let draws = [(false, false), (true, false), (false, true), (true, true)].iter().enumerate().map(|(n, (blue, green))| {
        let (x, y) = (146.0 + 180.0 * (n % 2) as f32, 66.0 + 180.0 * (n / 2) as f32);
        let (from, to) = ([1.0 / 256.0; 2], [3.0 / 256.0; 2]);
        let corners = rectangle([x, y], [x + 168.0, y + 168.0], &[(0, from, to), (1, [0.0; 2], [1.0; 2])]);
        let sign = |signed: bool| if signed { "signed" } else { "unsigned" };
        Draw::new(&format!("blue {}, green {}", sign(*blue), sign(*green)), &corners)
            .line(&format!(
                "textures: [(texture: \"step\", address: ClampToEdge, min_filter: Linear, signed: (false, {green}, {blue}, false)), \
                 (texture: \"squares\", address: ClampToEdge, min_filter: Nearest)],"
            ))
            .line("texture_shader: [Sample, BumpEnvironment(matrix: (0, -0.1, 0.3, 0))],")
    });
    let sheet = Sheet {
        comment: "Signed and unsigned bump maps: This scene repeats a frame captured from an Xbox, a bump map of two channels with a\n\
                  step across one half, filtered (TEX-6). As unsigned bytes the step is small; as two's complement it runs from the\n\
                  largest number to the smallest (TEX-18). What moves the squares is signed either way (TSH-7).",
        shown: 1,
        opaque: false,
        clear: GREY,
        depth: false,
        textures: &[
            "\"step\": (format: G8B8, source: File(\"textures/step.png\")),",
            "\"squares\": (source: Checker(width: 256, height: 256, cell: 8, colors: ((0xfe, 0x00, 0x00, 0xff), (0x22, 0x21, 0x20, 0x7f)))),",
        ],
        draws: draws.collect(),
    };
    sheet.text()
}
