//! Prints draws whole in GLSL and WGSL, which have no integers of 64 bits: numbers that need them are pairs of words, the lower one first.

use super::whole::WholeSyntax;
use super::*;
use crate::input::Local;

/// What hosts of shaders of whole pixels have to know.
pub(crate) const ABOUT: &str = "\
// Numbers that need more than 32 bits are pairs of words, the lower one first. The host provides ninebit_texel(unit, at): word `at` of the memory of
// a unit, with one word for each texel: palettes looked up, and blocks decoded to A8R8G8B8. It makes the constants of triangles, as the C text does.
";

const WGSL_HEAD: &str = "
struct NinebitTriangle {
    edge_x: array<i32, 3>,
    edge_y: array<i32, 3>,
    edge: array<vec2<u32>, 3>,
    ratio: array<vec2<i32>, 3>,
    coordinate: array<array<array<vec2<i32>, 3>, 4>, 4>,
    fog: array<vec2<i32>, 3>,
    depth: array<vec2<i32>, 3>,
    depth_difference: array<array<vec2<i32>, 3>, 3>,
    depth_ratio: array<vec2<i32>, 3>,
    offset: vec2<u32>,
    color: array<array<array<i32, 3>, 4>, 2>,
    owns: array<i32, 3>,
    fog_byte: i32,
    offset_exponent: i32,
    sprite: array<i32, 2>,
    sprite_size: i32,
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
fn ninebit_times(a: i32, b: i32) -> vec2<u32> {
    let product = ninebit_multiply(vec2<u32>(u32(a), 0u), vec2<u32>(u32(b), 0u));
    return vec2<u32>(product.x, product.y - (u32(b) & u32(a >> 31u)) - (u32(a) & u32(b >> 31u)));
}
// The product with a number of 0 to 65535.
fn ninebit_scaled(a: i32, by: i32) -> vec2<u32> {
    let low = (u32(a) & 0xffffu) * u32(by);
    let high = (a >> 16u) * by + i32(low >> 16u);
    return vec2<u32>((u32(high) << 16u) | (low & 0xffffu), u32(high >> 16u));
}
fn ninebit_length(a: i32) -> i32 { return i32(32u - countLeadingZeros(u32(a))); }
fn ninebit_bits(a: vec2<u32>) -> i32 {
    let is_high = a.y != 0u;
    return i32(select(32u, 64u, is_high) - countLeadingZeros(select(a.x, a.y, is_high)));
}
fn ninebit_raise(a: vec2<u32>, by: i32) -> vec2<u32> {
    let n = u32(by) & 31u;
    let low = a.x << n;
    return select(vec2<u32>(low, (a.y << n) | ((a.x >> 1u) >> (31u - n))), vec2<u32>(0u, low), by >= 32);
}
fn ninebit_lower(a: vec2<u32>, by: i32) -> vec2<u32> {
    let n = u32(by) & 31u;
    let high = u32(i32(a.y) >> n);
    let low = (a.x >> n) | ((a.y << 1u) << (31u - n));
    return select(vec2<u32>(low, high), vec2<u32>(high, u32(i32(a.y) >> 31u)), by >= 32);
}
// A rest and a quotient, after the quotient's next 14 bits at least, or all but 1. `above` is more than the first 16 of the divisor's bits, by less than one.
fn ninebit_shortened(n: vec4<u32>, b: vec2<u32>, above: u32, bits: i32) -> vec4<u32> {
    let down = ninebit_bits(n.xy) - 32;
    let first = select(ninebit_raise(n.xy, max(-down, 0)), ninebit_lower(n.xy, max(down, 0)), down >= 0).x;
    let up = down - bits + 16;
    let digits = vec2<u32>(first / above, 0u);
    let part = select(ninebit_lower(digits, max(-up, 0)), ninebit_raise(digits, max(up, 0)), up >= 0);
    return vec4<u32>(ninebit_subtract(n.xy, ninebit_multiply(part, b)), ninebit_add(n.zw, part));
}
fn ninebit_divide(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let bits = ninebit_bits(b);
    let above = (ninebit_raise(b, 64 - bits).y >> 16u) + 1u;
    var n = vec4<u32>(a, 0u, 0u);
    for (var k = 0; k < 5; k++) { n = ninebit_shortened(n, b, above, bits); }
    return select(ninebit_add(n.zw, vec2<u32>(1u, 0u)), n.zw, ninebit_below(n.xy, b));
}
// A rest and a quotient, after 2^by times b if the rest has it.
fn ninebit_divided(n: vec3<u32>, b: vec2<u32>, by: i32) -> vec3<u32> {
    let part = ninebit_raise(b, by);
    let rest = ninebit_subtract(n.xy, part);
    return select(vec3<u32>(rest, n.z + (1u << u32(by))), n, ninebit_below(n.xy, part));
}
// A quotient below 2^31 by a divisor below 2^58: its first 32 bits, one step of Newton for 2^62 through them, and the exact rest. The estimate is at
// most 8 too small, or 1 too large.
fn ninebit_quotient(a: vec2<u32>, b: vec2<u32>) -> i32 {
    let bits = ninebit_bits(b);
    let first = ninebit_raise(b, 64 - bits).y;
    let start = 0xffffffffu / (first >> 16u);
    let error = ninebit_subtract(vec2<u32>(0u, 0x10000u), ninebit_multiply(vec2<u32>(first, 0u), vec2<u32>(start, 0u)));
    let correction = ninebit_times(i32(start), ninebit_narrow(ninebit_lower(error, 4)));
    let inverse = vec2<u32>((start << 14u) + ninebit_lower(correction, 30).x, 0u);
    let estimate = ninebit_lower(ninebit_multiply(vec2<u32>(ninebit_lower(a, bits - 1).x, 0u), inverse), 31).x;
    let low = estimate - min(estimate, 2u);
    let rest = ninebit_subtract(a, ninebit_multiply(b, vec2<u32>(low, 0u)));
    let three = ninebit_divided(vec3<u32>(rest, low), b, 3);
    return i32(ninebit_divided(ninebit_divided(ninebit_divided(three, b, 2), b, 1), b, 0).z);
}
";

const GLSL_HEAD: &str = "
struct NinebitTriangle {
    int edge_x[3];
    int edge_y[3];
    uvec2 edge[3];
    ivec2 ratio[3];
    ivec2 coordinate[4][4][3];
    ivec2 fog[3];
    ivec2 depth[3];
    ivec2 depth_difference[3][3];
    ivec2 depth_ratio[3];
    uvec2 offset;
    int color[2][4][3];
    int owns[3];
    int fog_byte;
    int offset_exponent;
    int sprite[2];
    int sprite_size;
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
uvec2 ninebit_times(int a, int b)
{
    uvec2 product = ninebit_multiply(uvec2(uint(a), 0u), uvec2(uint(b), 0u));
    return uvec2(product.x, product.y - (uint(b) & uint(a >> 31)) - (uint(a) & uint(b >> 31)));
}
// The product with a number of 0 to 65535.
uvec2 ninebit_scaled(int a, int by)
{
    uint low = (uint(a) & 0xffffu) * uint(by);
    int high = (a >> 16) * by + int(low >> 16);
    return uvec2((uint(high) << 16) | (low & 0xffffu), uint(high >> 16));
}
int ninebit_length(int a) { return 1 + findMSB(uint(a)); }
int ninebit_bits(uvec2 a) { return a.y != 0u ? 33 + findMSB(a.y) : 1 + findMSB(a.x); }
uvec2 ninebit_raise(uvec2 a, int by)
{
    int n = by & 31;
    uint low = a.x << n;
    return by >= 32 ? uvec2(0u, low) : uvec2(low, (a.y << n) | ((a.x >> 1) >> (31 - n)));
}
uvec2 ninebit_lower(uvec2 a, int by)
{
    int n = by & 31;
    uint high = uint(int(a.y) >> n);
    uint low = (a.x >> n) | ((a.y << 1) << (31 - n));
    return by >= 32 ? uvec2(high, uint(int(a.y) >> 31)) : uvec2(low, high);
}
// A rest and a quotient, after the quotient's next 14 bits at least, or all but 1. `above` is more than the first 16 of the divisor's bits, by less than one.
uvec4 ninebit_shortened(uvec4 n, uvec2 b, uint above, int bits)
{
    int down = ninebit_bits(n.xy) - 32;
    uint first = (down >= 0 ? ninebit_lower(n.xy, max(down, 0)) : ninebit_raise(n.xy, max(-down, 0))).x;
    int up = down - bits + 16;
    uvec2 digits = uvec2(first / above, 0u);
    uvec2 part = up >= 0 ? ninebit_raise(digits, max(up, 0)) : ninebit_lower(digits, max(-up, 0));
    return uvec4(ninebit_subtract(n.xy, ninebit_multiply(part, b)), ninebit_add(n.zw, part));
}
uvec2 ninebit_divide(uvec2 a, uvec2 b)
{
    int bits = ninebit_bits(b);
    uint above = (ninebit_raise(b, 64 - bits).y >> 16) + 1u;
    uvec4 n = uvec4(a, 0u, 0u);
    for (int k = 0; k < 5; k++) n = ninebit_shortened(n, b, above, bits);
    return ninebit_below(n.xy, b) ? n.zw : ninebit_add(n.zw, uvec2(1u, 0u));
}
// A rest and a quotient, after 2^by times b if the rest has it.
uvec3 ninebit_divided(uvec3 n, uvec2 b, int by)
{
    uvec2 part = ninebit_raise(b, by);
    return ninebit_below(n.xy, part) ? n : uvec3(ninebit_subtract(n.xy, part), n.z + (1u << by));
}
// A quotient below 2^31 by a divisor below 2^58: its first 32 bits, one step of Newton for 2^62 through them, and the exact rest. The estimate is at
// most 8 too small, or 1 too large.
int ninebit_quotient(uvec2 a, uvec2 b)
{
    int bits = ninebit_bits(b);
    uint first = ninebit_raise(b, 64 - bits).y;
    uint start = 0xffffffffu / max(first >> 16, 1u);
    uvec2 error = ninebit_subtract(uvec2(0u, 0x10000u), ninebit_multiply(uvec2(first, 0u), uvec2(start, 0u)));
    uvec2 correction = ninebit_times(int(start), ninebit_narrow(ninebit_lower(error, 4)));
    uvec2 inverse = uvec2((start << 14) + ninebit_lower(correction, 30).x, 0u);
    uint estimate = ninebit_lower(ninebit_multiply(uvec2(ninebit_lower(a, bits - 1).x, 0u), inverse), 31).x;
    uint low = estimate - min(estimate, 2u);
    uvec2 rest = ninebit_subtract(a, ninebit_multiply(b, uvec2(low, 0u)));
    uvec3 three = ninebit_divided(uvec3(rest, low), b, 3);
    return int(ninebit_divided(ninebit_divided(ninebit_divided(three, b, 2), b, 1), b, 0).z);
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
            Wide::Length => Text::Term(format!("ninebit_length({})", plain[0])),
            Wide::Raise => Text::Open(format!("{} << {}", plain[0], distance(plain[1]))),
            Wide::ShortLower => Text::Open(format!("{} >> {}", plain[0], distance(plain[1]))),
            _ => Text::Open(format!("{} >> {}", plain[0], distance(&format!("min({}, 31)", plain[1])))),
        };
    }
    let of = match operation {
        Wide::Length => return Text::Term(format!("ninebit_bits({})", pair(&operands[0]))),
        Wide::Quotient => {
            return Text::Term(format!("ninebit_quotient({}, {})", pair(&operands[0]), pair(&operands[1])));
        }
        Wide::Scale => format!("ninebit_scaled({}, {})", plain[0], plain[1]),
        Wide::Multiply if !any => format!("ninebit_times({}, {})", plain[0], plain[1]),
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
        ABOUT.to_string() + &self.functions("")
    }
    fn functions(&self, structures: &str) -> String {
        structures.to_string() + WGSL_HEAD
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
}

impl WholeSyntax for glsl::Glsl {
    fn whole_head(&self) -> String {
        format!(
            "{ABOUT}// For GLSL 4.30 and GLSL ES 3.10: the line that tells the version stands above.\nprecision highp int;\n\n{}",
            self.functions("")
        )
    }
    fn functions(&self, structures: &str) -> String {
        format!("{structures}uint ninebit_texel(int unit, int at);\n{GLSL_HEAD}")
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::helper::Helper;

    /// WGSL refuses two functions of one name.
    #[test]
    fn functions_of_heads_have_names_of_their_own() {
        for helper in Helper::ALL {
            let name = format!("ninebit_{}(", helper.about().0);
            let declares = |line: &str| !line.starts_with(' ') && line.contains(&name);
            for head in [WGSL_HEAD, GLSL_HEAD] {
                assert!(!head.lines().any(declares), "{name} is a function of every shader, too");
            }
        }
    }
}
