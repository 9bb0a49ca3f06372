//! Prints draws whole in GLSL and WGSL, which have no integers of 64 bits: numbers that need them are pairs of words, the lower one first.

use super::whole::{Draw, WholeSyntax};
use super::*;
use crate::input::Local;

const ABOUT: &str = "\
// Numbers that need more than 32 bits are pairs of words, the lower one first. The host provides ninebit_texel(unit, at): word `at` of the memory of
// a unit, with one word for each texel: palettes looked up, and blocks decoded to A8R8G8B8. It makes the constants of triangles, as the C text does.
";

const WGSL_HEAD: &str = "
struct NinebitTriangle {
    edge_x: array<i32, 3>,
    edge_y: array<i32, 3>,
    edge: array<vec2<u32>, 3>,
    owns: array<i32, 3>,
    ratio: array<vec2<i32>, 3>,
    color: array<array<array<i32, 3>, 4>, 2>,
    coordinate: array<array<array<vec2<i32>, 3>, 4>, 4>,
    fog: array<vec2<i32>, 3>,
    fog_byte: i32,
    depth: array<vec2<i32>, 3>,
    depth_difference: array<array<vec2<i32>, 3>, 3>,
    offset: vec2<u32>,
    offset_exponent: i32,
}

// What the surface and its depth buffer hold after a pixel, and whether the fragment was stored.
struct NinebitWhole {
    stored: bool,
    word: u32,
    depth: u32,
}

fn ninebit_binary(mantissa: i32, exponent: i32) -> vec2<i32> { return vec2<i32>(mantissa, exponent); }
fn ninebit_wide(a: i32) -> vec2<u32> { return vec2<u32>(u32(a), u32(a >> 31u)); }
fn ninebit_narrow(a: vec2<u32>) -> i32 { return i32(a.x); }
fn ninebit_add(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    return vec2<u32>(low, a.y + b.y + select(0u, 1u, low < a.x));
}
fn ninebit_subtract(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return vec2<u32>(a.x - b.x, a.y - b.y - select(0u, 1u, a.x < b.x));
}
fn ninebit_multiply(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = (a.x & 0xffffu) * (b.x & 0xffffu);
    let first = (a.x >> 16u) * (b.x & 0xffffu) + (low >> 16u);
    let second = (a.x & 0xffffu) * (b.x >> 16u) + (first & 0xffffu);
    let high = (a.x >> 16u) * (b.x >> 16u) + (first >> 16u) + (second >> 16u);
    return vec2<u32>((second << 16u) | (low & 0xffffu), high + a.x * b.y + a.y * b.x);
}
fn ninebit_below(a: vec2<u32>, b: vec2<u32>) -> bool {
    return i32(a.y) < i32(b.y) || (a.y == b.y && a.x < b.x);
}
fn ninebit_least(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> { return select(b, a, ninebit_below(a, b)); }
fn ninebit_greatest(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> { return select(a, b, ninebit_below(a, b)); }
fn ninebit_bits(a: vec2<u32>) -> i32 {
    return i32(select(32u - countLeadingZeros(a.x), 64u - countLeadingZeros(a.y), a.y != 0u));
}
fn ninebit_raise(a: vec2<u32>, by: i32) -> vec2<u32> {
    let n = u32(by);
    if n >= 32u { return vec2<u32>(0u, a.x << (n - 32u)); }
    if n == 0u { return a; }
    return vec2<u32>(a.x << n, (a.y << n) | (a.x >> (32u - n)));
}
fn ninebit_lower(a: vec2<u32>, by: i32) -> vec2<u32> {
    let n = u32(by);
    let high = i32(a.y);
    if n >= 32u { return vec2<u32>(u32(high >> (n - 32u)), u32(high >> 31u)); }
    if n == 0u { return a; }
    return vec2<u32>((a.x >> n) | (a.y << (32u - n)), u32(high >> n));
}
fn ninebit_divide(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    if a.y == 0u && b.y == 0u { return vec2<u32>(a.x / b.x, 0u); }
    var rest = vec2<u32>(0u, 0u);
    var quotient = vec2<u32>(0u, 0u);
    for (var bit = ninebit_bits(a) - 1; bit >= 0; bit--) {
        rest = ninebit_raise(rest, 1);
        rest.x |= ninebit_lower(a, bit).x & 1u;
        quotient = ninebit_raise(quotient, 1);
        if !ninebit_below(rest, b) {
            rest = ninebit_subtract(rest, b);
            quotient.x |= 1u;
        }
    }
    return quotient;
}
";

const GLSL_HEAD: &str = "
struct NinebitTriangle {
    int edge_x[3];
    int edge_y[3];
    uvec2 edge[3];
    int owns[3];
    ivec2 ratio[3];
    int color[2][4][3];
    ivec2 coordinate[4][4][3];
    ivec2 fog[3];
    int fog_byte;
    ivec2 depth[3];
    ivec2 depth_difference[3][3];
    uvec2 offset;
    int offset_exponent;
};

ivec2 ninebit_binary(int mantissa, int exponent) { return ivec2(mantissa, exponent); }
uvec2 ninebit_wide(int a) { return uvec2(uint(a), uint(a >> 31)); }
int ninebit_narrow(uvec2 a) { return int(a.x); }
uvec2 ninebit_add(uvec2 a, uvec2 b)
{
    uint low = a.x + b.x;
    return uvec2(low, a.y + b.y + (low < a.x ? 1u : 0u));
}
uvec2 ninebit_subtract(uvec2 a, uvec2 b) { return uvec2(a.x - b.x, a.y - b.y - (a.x < b.x ? 1u : 0u)); }
uvec2 ninebit_multiply(uvec2 a, uvec2 b)
{
    uint low = (a.x & 0xffffu) * (b.x & 0xffffu);
    uint first = (a.x >> 16) * (b.x & 0xffffu) + (low >> 16);
    uint second = (a.x & 0xffffu) * (b.x >> 16) + (first & 0xffffu);
    uint high = (a.x >> 16) * (b.x >> 16) + (first >> 16) + (second >> 16);
    return uvec2((second << 16) | (low & 0xffffu), high + a.x * b.y + a.y * b.x);
}
bool ninebit_below(uvec2 a, uvec2 b) { return int(a.y) < int(b.y) || (a.y == b.y && a.x < b.x); }
uvec2 ninebit_least(uvec2 a, uvec2 b) { return ninebit_below(a, b) ? a : b; }
uvec2 ninebit_greatest(uvec2 a, uvec2 b) { return ninebit_below(a, b) ? b : a; }
int ninebit_bits(uvec2 a) { return a.y != 0u ? 33 + findMSB(a.y) : 1 + findMSB(a.x); }
uvec2 ninebit_raise(uvec2 a, int n)
{
    if (n >= 32) return uvec2(0u, a.x << (n - 32));
    if (n == 0) return a;
    return uvec2(a.x << n, (a.y << n) | (a.x >> (32 - n)));
}
uvec2 ninebit_lower(uvec2 a, int n)
{
    int high = int(a.y);
    if (n >= 32) return uvec2(uint(high >> (n - 32)), uint(high >> 31));
    if (n == 0) return a;
    return uvec2((a.x >> n) | (a.y << (32 - n)), uint(high >> n));
}
uvec2 ninebit_divide(uvec2 a, uvec2 b)
{
    if (a.y == 0u && b.y == 0u) return uvec2(a.x / b.x, 0u);
    uvec2 rest = uvec2(0u), quotient = uvec2(0u);
    for (int bit = ninebit_bits(a) - 1; bit >= 0; bit--) {
        rest = ninebit_raise(rest, 1);
        rest.x |= ninebit_lower(a, bit).x & 1u;
        quotient = ninebit_raise(quotient, 1);
        if (!ninebit_below(rest, b)) {
            rest = ninebit_subtract(rest, b);
            quotient.x |= 1u;
        }
    }
    return quotient;
}
";

/// Prints an operation of numbers of which some, or the result, are pairs. `pair` and `shift` write a pair of constants and a distance of shifts.
pub(super) fn wide(operation: Wide, operands: &[(String, bool)], result: bool, is_wgsl: bool) -> Text {
    let is_pair = |(_, is_wide): &(String, bool)| *is_wide;
    // The first operand of a selection is its test.
    let from = usize::from(operation == Wide::Select);
    let any = operands[from..].iter().any(is_pair);
    let pair = |(text, is_wide): &(String, bool)| if *is_wide { text.clone() } else { format!("ninebit_wide({text})") };
    let plain: Vec<&str> = operands.iter().map(|(text, _)| text.as_str()).collect();
    let distance = |by: &str| if is_wgsl { format!("u32({by})") } else { by.to_string() };
    if !any && !result {
        return match operation {
            Wide::Length => Text::Term(format!("ninebit_bits(ninebit_wide({}))", plain[0])),
            Wide::Raise => Text::Open(format!("{} << {}", plain[0], distance(plain[1]))),
            _ => Text::Open(format!("{} >> {}", plain[0], distance(&format!("min({}, 31)", plain[1])))),
        };
    }
    let of = match operation {
        Wide::Length => return Text::Term(format!("ninebit_bits({})", pair(&operands[0]))),
        Wide::Raise => format!("ninebit_raise({}, {})", pair(&operands[0]), plain[1]),
        Wide::Lower => format!("ninebit_lower({}, {})", pair(&operands[0]), plain[1]),
        Wide::Select if is_wgsl => format!("select({}, {}, {})", pair(&operands[2]), pair(&operands[1]), plain[0]),
        Wide::Select => format!("({} ? {} : {})", plain[0], pair(&operands[1]), pair(&operands[2])),
        Wide::Bits => format!("({} & {})", pair(&operands[0]), pair(&operands[1])),
        _ => {
            let name = match operation {
                Wide::Add => "add",
                Wide::Subtract => "subtract",
                Wide::Multiply => "multiply",
                Wide::Least => "least",
                Wide::Greatest => "greatest",
                _ => "divide",
            };
            format!("ninebit_{name}({}, {})", pair(&operands[0]), pair(&operands[1]))
        }
    };
    Text::Term(if result { of } else { format!("ninebit_narrow({of})") })
}

/// Prints a comparison of numbers of which some are pairs.
pub(super) fn compare(a: (String, bool), operator: &str, b: (String, bool), is_wgsl: bool) -> String {
    let pair = |(text, is_wide): (String, bool)| if is_wide { text } else { format!("ninebit_wide({text})") };
    let (a, b) = (pair(a), pair(b));
    match operator {
        "<" => format!("ninebit_below({a}, {b})"),
        ">" => format!("ninebit_below({b}, {a})"),
        "<=" => format!("!ninebit_below({b}, {a})"),
        ">=" => format!("!ninebit_below({a}, {b})"),
        "==" if is_wgsl => format!("all({a} == {b})"),
        _ if is_wgsl => format!("any({a} != {b})"),
        operator => format!("{a} {operator} {b}"),
    }
}

/// Prints a constant that needs more than 32 bits.
pub(super) fn constant(value: i64, pair: &str) -> String {
    format!("{pair}({:#x}u, {:#x}u)", value as u32, (value >> 32) as u32)
}

/// Returns the types of values: number, wide number, word, binary number.
fn type_of(kind: Kind, range: Range, [number, wide, word, binary]: [&'static str; 4]) -> &'static str {
    match kind {
        Kind::Number if is_wide(range) => wide,
        Kind::Number => number,
        Kind::Word => word,
        Kind::Binary => binary,
    }
}

const WGSL: [&str; 4] = ["i32", "vec2<u32>", "u32", "vec2<i32>"];
const GLSL: [&str; 4] = ["int", "uvec2", "uint", "ivec2"];

/// Returns the type of a line in GLSL.
pub(super) fn glsl_type(line: &Line) -> &'static str {
    type_of(line.operation.kind(), line.range, GLSL)
}

/// Returns the parameters of a helper.
fn parameters(helper: Helper, print: impl Fn(Local) -> String) -> String {
    let all = helper.parameters().iter().enumerate();
    all.map(|(at, (kind, range))| print(helper.parameter(at, *kind, *range))).collect::<Vec<_>>().join(", ")
}

impl WholeSyntax for wgsl::Wgsl {
    fn whole_head(&self) -> String {
        ABOUT.to_string() + WGSL_HEAD
    }
    fn helper(&self, helper: Helper) -> String {
        let (name, about, rules) = helper.about();
        let parameters =
            parameters(helper, |local| format!("{}: {}", local.name, type_of(local.kind, local.range, WGSL)));
        let result = type_of(helper.kind(), helper.range(), WGSL);
        format!("\n// {about} ({rules}).\nfn ninebit_{name}({parameters}) -> {result} {{\n")
    }
    fn table(&self, name: &str, Table(table): Table) -> String {
        let (count, entries) = (table.len(), table.iter().map(u8::to_string).collect::<Vec<_>>().join(", "));
        format!("\nvar<private> ninebit_{name}: array<i32, {count}> = array<i32, {count}>({entries});\n")
    }
    fn coverage(&self, lines: &str, test: &str) -> String {
        format!(
            "\n// Whether a triangle covers a pixel (RAS-2, RAS-3).\n\
             fn ninebit_covers(triangle: NinebitTriangle, x: i32, y: i32) -> bool {{\n{lines}    return {test} != 0;\n}}\n"
        )
    }
    fn setup(&self, _: &Draw<'_>) -> String {
        String::new()
    }
}

impl WholeSyntax for glsl::Glsl {
    fn whole_head(&self) -> String {
        format!(
            "{ABOUT}// For GLSL 4.30 and GLSL ES 3.10: the line that tells the version stands above.\nprecision highp int;\n\nuint ninebit_texel(int unit, int at);\n{GLSL_HEAD}"
        )
    }
    fn helper(&self, helper: Helper) -> String {
        let (name, about, rules) = helper.about();
        let parameters =
            parameters(helper, |local| format!("{} {}", type_of(local.kind, local.range, GLSL), local.name));
        let result = type_of(helper.kind(), helper.range(), GLSL);
        format!("\n// {about} ({rules}).\n{result} ninebit_{name}({parameters})\n{{\n")
    }
    fn table(&self, name: &str, Table(table): Table) -> String {
        let (count, entries) = (table.len(), table.iter().map(u8::to_string).collect::<Vec<_>>().join(", "));
        format!("\nconst int ninebit_{name}[{count}] = int[{count}]({entries});\n")
    }
    fn coverage(&self, lines: &str, test: &str) -> String {
        format!(
            "\n// Whether a triangle covers a pixel (RAS-2, RAS-3).\n\
             bool ninebit_covers(NinebitTriangle triangle, int x, int y)\n{{\n{lines}    return {test} != 0;\n}}\n"
        )
    }
    fn setup(&self, _: &Draw<'_>) -> String {
        String::new()
    }
}
