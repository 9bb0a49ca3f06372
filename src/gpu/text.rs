//! The text of a draw: its function as `ninebit lower --whole` prints it, and the entry point that runs it for the pixels of tiles.

use std::collections::BTreeSet;
use std::fmt::Write;

use ninebit_lower::code::Kind;
use ninebit_lower::{Draw, Field, Function, Input, Language, Result, Setup};

use crate::adapter::{DISPATCH_ROW, TILE};

/// How triangles are given to the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// All of them; each tile has a list of its own.
    ByTile,
    /// One at a time, with its tiles, for few large triangles: their constants are then uniform.
    ByTriangle,
}

/// Words of the structure `Work` before the constants of a triangle.
pub(crate) const WORK: usize = 8;

/// Returns the constants of a triangle that a draw reads, in order.
pub(crate) fn fields(function: &Function, setup: &Setup) -> Vec<Field> {
    let read = function.inputs().into_iter().filter_map(|input| match input {
        Input::Triangle(field) => Some(field),
        _ => None,
    });
    let all: BTreeSet<Field> = setup.outputs.iter().map(|(field, _)| *field).chain(read).collect();
    all.into_iter().collect()
}

/// Returns the words of a triangle's constants.
pub(crate) fn length(fields: &[Field]) -> usize {
    fields.iter().map(|field| field.words(0).len()).sum()
}

/// Prints the shader of a draw. Draws that differ in constants of triangles and textures alone have the same text.
pub(crate) fn shader(function: &Function, setup: &Setup, fields: &[Field], way: Way) -> String {
    let draw = Draw { name: "ninebit_draw".to_string(), about: "the draw".to_string(), function, setup };
    let mut text = Language::Wgsl.print_whole(&[draw]).unwrap_or_default();
    let quads = length(fields).div_ceil(4);
    let constants = match way {
        Way::ByTile => String::new(),
        Way::ByTriangle => format!("    constants: array<vec4<u32>, {quads}>,\n"),
    };
    let _ = write!(
        text,
        "
// What a dispatch draws: columns and rows of the surface, tiles and where they begin, where each unit's memory begins; the constants of one triangle.
struct Work {{
    width: u32,
    height: u32,
    tiles: u32,
    first: u32,
    memory: vec4<u32>,
{constants}}}
@group(0) @binding(0) var<uniform> work: Work;
@group(0) @binding(1) var<storage, read> tiles: array<u32>;
@group(0) @binding(2) var<storage, read> constants: array<u32>;
@group(0) @binding(3) var<storage, read> memory: array<u32>;
@group(0) @binding(4) var<storage, read_write> words: array<u32>;
@group(0) @binding(5) var<storage, read_write> depths: array<u32>;

fn ninebit_texel(unit: i32, at: i32) -> u32 {{ return memory[work.memory[unit] + u32(at)]; }}

// The constants of a triangle, which begin at a word.
fn triangle_at(first: u32) -> NinebitTriangle {{
    var triangle: NinebitTriangle;
{}    return triangle;
}}

// Whether a triangle covers a pixel: by its edges (0), everywhere (1), or by a mask.
fn covers(code: u32, triangle: NinebitTriangle, x: u32, y: u32) -> bool {{
    if code == 0u {{ return ninebit_covers(triangle, i32(x), i32(y)); }}
    if code == 1u {{ return true; }}
    let bit = {TILE}u * (y % {TILE}u) + x % {TILE}u;
    return ((tiles[code + bit / 32u] >> (bit % 32u)) & 1u) != 0u;
}}

// Whether triangles cover all pixels of the tiles.
override is_full: bool = false;

@compute @workgroup_size({TILE}, {TILE})
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {{
    let number = {DISPATCH_ROW}u * group.y + group.x;
    if number >= work.tiles {{ return; }}
    let entry = work.first + {}u * number;
    let across = (work.width + {}u) / {TILE}u;
    let x = {TILE}u * (tiles[entry] % across) + local.x;
    let y = {TILE}u * (tiles[entry] / across) + local.y;
    if x >= work.width || y >= work.height {{ return; }}
    let at = work.width * y + x;
{}}}
",
        assignments(fields, way),
        match way {
            Way::ByTile => 3,
            Way::ByTriangle => 2,
        },
        TILE - 1,
        match way {
            Way::ByTile => by_tile(function, length(fields)),
            Way::ByTriangle => by_triangle(function),
        },
    );
    text
}

/// Returns the text if the function writes depths, or stencils.
fn where_depths_change<'t>(function: &Function, text: &'t str) -> &'t str {
    if matches!(function.result, Result::Pixel { depth: Some(_), .. }) { text } else { "" }
}

/// Prints the loop over the triangles of a tile. What the surface holds is read once and written once.
fn by_tile(function: &Function, length: usize) -> String {
    let kept = where_depths_change(function, "            depth = drawn.depth;\n");
    let stored = where_depths_change(function, "    depths[at] = depth;\n");
    format!(
        "    var word = words[at];
    var depth = depths[at];
    for (var k = tiles[entry + 1u]; k < tiles[entry + 2u]; k += 2u) {{
        let triangle = triangle_at({length}u * tiles[k]);
        if covers(tiles[k + 1u], triangle, x, y) {{
            let drawn = ninebit_draw(triangle, i32(x), i32(y), word, depth);
            word = drawn.word;
{kept}        }}
    }}
    words[at] = word;
{stored}"
    )
}

/// Prints the call for the one triangle.
fn by_triangle(function: &Function) -> String {
    let stored = where_depths_change(function, "        depths[at] = drawn.depth;\n");
    format!(
        "    let triangle = triangle_at(0u);
    if is_full || covers(tiles[entry + 1u], triangle, x, y) {{
        let drawn = ninebit_draw(triangle, i32(x), i32(y), words[at], depths[at]);
        words[at] = drawn.word;
{stored}    }}
"
    )
}

/// Prints how a triangle's constants are read.
fn assignments(fields: &[Field], way: Way) -> String {
    let (mut text, mut at) = (String::new(), 0);
    for field in fields {
        let words: Vec<String> = (at..at + field.words(0).len())
            .map(|at| match way {
                Way::ByTile => format!("constants[first + {at}u]"),
                Way::ByTriangle => format!("work.constants[{}].{}", at / 4, ["x", "y", "z", "w"][at % 4]),
            })
            .collect();
        at += words.len();
        let value = match (field.kind(), &words[..]) {
            (Kind::Binary, [mantissa, exponent]) => format!("vec2<i32>(i32({mantissa}), i32({exponent}))"),
            (_, [low, high]) => format!("vec2<u32>({low}, {high})"),
            _ => format!("i32({})", words.concat()),
        };
        let _ = writeln!(text, "    {} = {value};", Language::Wgsl.field(*field));
    }
    text
}
