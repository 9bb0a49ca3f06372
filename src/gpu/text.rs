//! The text of a draw: its function as `ninebit lower --whole` prints it, and the entry point that runs it for the pixels of tiles.

use std::collections::BTreeSet;
use std::fmt::Write;

use ninebit_lower::code::Kind;
use ninebit_lower::{Draw, Field, Function, Generic, Input, Language, Result, Setup};

use crate::adapter::{DISPATCH_ROW, TILE};
use crate::bins::TILE_WORDS;

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

/// Returns the words of a triangle's constants, which are fours.
pub(crate) fn length(fields: &[Field]) -> usize {
    fields.iter().map(|field| field.words(0).len()).sum::<usize>().next_multiple_of(4)
}

/// Prints the shader of a draw. Draws that differ in constants of triangles and textures alone have the same text.
pub(crate) fn shader(function: &Function, setup: &Setup, fields: &[Field], way: Way) -> String {
    let draw = Draw { name: "ninebit_draw".to_string(), about: "the draw".to_string(), function, setup };
    let text = Language::Wgsl.print_whole(&[draw]).unwrap_or_default();
    let quads = length(fields) / 4;
    let stored = where_depths_change(function, "    depths[at] = depth;\n");
    let (constants, tile_words, triangle, functions, body) = match way {
        Way::ByTile => (String::new(), TILE_WORDS, "", NEXT.to_string(), by_tile(&drawn(function, quads), stored)),
        Way::ByTriangle => {
            let constants = format!("    constants: array<vec4<u32>, {quads}>,\n");
            let covers = COVERS.replace("TILE", &TILE.to_string());
            (constants, 2, "    let triangle = triangle_at(0u);\n", covers, by_triangle(function))
        }
    };
    let constants_read = assignments(fields, way);
    let functions = format!(
        "@group(0) @binding(2) var<storage, read> constants: array<vec4<u32>>;

// The constants of a triangle, which begin at a four.
fn triangle_at(first: u32) -> NinebitTriangle {{
    var triangle: NinebitTriangle;
{constants_read}    return triangle;
}}
{functions}"
    );
    text + &host((&constants, tile_words, &functions), &format!("{triangle}{BOUNDS}{body}"))
}

/// Prints the shader of every draw, by tile.
pub(crate) fn generic_shader(generic: &Generic) -> String {
    let functions = format!(
        "@group(0) @binding(2) var<storage, read> ninebit_triangles: array<NinebitTriangle>;
@group(0) @binding(6) var<storage, read> ninebit_state: NinebitState;
{NEXT}"
    );
    let call = "            nb_draw_pixel(i32(tiles[k] & 0xffffu), i32(x), i32(y), &word, &depth);\n";
    let body = format!("{BOUNDS}{}", by_tile(call, "    depths[at] = depth;\n"));
    generic.whole_wgsl() + &host(("", TILE_WORDS, &functions), &body)
}

/// What ends an invocation that has no pixel.
const BOUNDS: &str = "    if number >= work.tiles || x >= work.width || y >= work.height { return; }
    let at = work.width * y + x;
";

/// Prints what draws the pixels of tiles around a text: more constants of a dispatch, words of a tile, functions; the end of the entry point.
fn host((constants, tile_words, functions): (&str, usize, &str), body: &str) -> String {
    format!(
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
@group(0) @binding(3) var<storage, read> memory: array<u32>;
@group(0) @binding(4) var<storage, read_write> words: array<u32>;
@group(0) @binding(5) var<storage, read_write> depths: array<u32>;

// Where the memory of each unit begins.
var<private> bases: vec4<u32>;

fn ninebit_texel(unit: i32, at: i32) -> u32 {{ return memory[bases[unit] + u32(at)]; }}

{functions}
@compute @workgroup_size({TILE}, {TILE})
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {{
    // What is the same in all invocations is read before any branch: there drivers that run on a CPU read it once.
    bases = work.memory;
    let number = {DISPATCH_ROW}u * group.y + group.x;
    let entry = work.first + {tile_words}u * number;
    let tile = tiles[entry];
    let across = (work.width + {}u) / {TILE}u;
    let x = {TILE}u * (tile % across) + local.x;
    let y = {TILE}u * (tile / across) + local.y;
{body}}}
",
        TILE - 1,
    )
}

/// The function that finds triangles in the list of a tile's row.
const NEXT: &str = "
// The next triangle that covers a column, from number k of a list on.
fn next(start: u32, end: u32, column: u32) -> u32 {
    var k = start;
    while k < end && ((tiles[k] >> (16u + column)) & 1u) == 0u { k++; }
    return k;
}
";

/// The function that tests coverage where tiles are those of one triangle.
const COVERS: &str = "
// Whether the triangle covers a pixel: by its edges (0), or by a mask.
fn covers(code: u32, triangle: NinebitTriangle, x: u32, y: u32) -> bool {
    if code == 0u { return ninebit_covers(triangle, i32(x), i32(y)); }
    let bit = TILEu * (y % TILEu) + x % TILEu;
    return ((tiles[code + bit / 32u] >> (bit % 32u)) & 1u) != 0u;
}

// Whether the triangle covers all pixels of the tiles.
override is_full: bool = false;
";

/// Returns the text if the function writes depths, or stencils.
fn where_depths_change<'t>(function: &Function, text: &'t str) -> &'t str {
    if matches!(function.result, Result::Pixel { depth: Some(_), .. }) { text } else { "" }
}

/// Prints the call for a triangle of a row of a tile.
fn drawn(function: &Function, quads: usize) -> String {
    let kept = where_depths_change(function, "            depth = drawn.depth;\n");
    format!(
        "            let triangle = triangle_at({quads}u * (tiles[k] & 0xffffu));
            let drawn = ninebit_draw(triangle, i32(x), i32(y), word, depth);
            word = drawn.word;
{kept}"
    )
}

/// Prints the loop over the triangles of a row of a tile. What the surface holds is read once and written once. Drivers that run neighbouring invocations
/// in step run them once for each triangle of a pixel, not for each of the tile, and test the end last.
fn by_tile(call: &str, stored: &str) -> String {
    format!(
        "    var word = words[at];
    var depth = depths[at];
    let end = tiles[entry + local.y + 2u];
    var k = next(tiles[entry + local.y + 1u], end, local.x);
    loop {{
        if k < end {{
{call}        }}
        k = next(k + 1u, end, local.x);
        continuing {{ break if k >= end; }}
    }}
    words[at] = word;
{stored}"
    )
}

/// Prints the call for the one triangle.
fn by_triangle(function: &Function) -> String {
    let stored = where_depths_change(function, "        depths[at] = drawn.depth;\n");
    format!(
        "    if is_full || covers(tiles[entry + 1u], triangle, x, y) {{
        let drawn = ninebit_draw(triangle, i32(x), i32(y), words[at], depths[at]);
        words[at] = drawn.word;
{stored}    }}
"
    )
}

/// Prints how a triangle's constants are read.
fn assignments(fields: &[Field], way: Way) -> String {
    let (mut text, mut at) = (String::new(), 0);
    let fours = match way {
        Way::ByTile => "constants[first + ",
        Way::ByTriangle => "work.constants[",
    };
    for n in 0..length(fields) / 4 {
        let _ = writeln!(text, "    let four{n} = {fours}{n}u];");
    }
    for field in fields {
        let words: Vec<String> = (at..at + field.words(0).len())
            .map(|at| format!("four{}.{}", at / 4, ["x", "y", "z", "w"][at % 4]))
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
