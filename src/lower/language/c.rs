//! Prints C99, and the structures and helpers that it needs.

use super::*;
use crate::input::Local;
use crate::setup::Setup;

pub(super) struct C99;

const PIXEL: &str = "\
#ifndef NINEBIT_PIXEL
#define NINEBIT_PIXEL

/* What one pixel brings. Colours are R, G, B, A. A function reads what it needs; the rest may be anything. */
struct ninebit_pixel {
    int32_t primary[4];     /* interpolated diffuse, 0 to 255 */
    int32_t secondary[4];   /* interpolated specular, 0 to 255 */
    int32_t fog[4];         /* fog colour and, in alpha, factor: 0 to 255 */
    int32_t texture[4][4];  /* what each unit yields: 0 to 255, signed channels -256 to 254 */
    uint32_t texel[4][8];   /* fetched words of each unit: the footprint of a level row by row, then that of the next; palettes looked
                               up and blocks decoded to A8R8G8B8. A single texel is the first, with weights 0. */
    int32_t weight[4][5];   /* of right and lower texels, of the same on the next level, of that level: 0 to 255 of 256 */
    int32_t outside[4];     /* bit n: texel n is the border colour */
    uint32_t destination;   /* the word that the surface holds */
};
";

const CONSTANTS: &str = "
/* Constants of a draw: R, G, B, A, 0 to 255. */
struct ninebit_constants {
    int32_t stage[8][2][4]; /* constant colours 0 and 1 of each general stage */
    int32_t final[2][4];    /* of the final combiner */
    int32_t fog[4];         /* fog colour */
    int32_t blend[4];       /* blend constant */
    int32_t border[4][4];   /* border colour of each unit */
    int32_t alpha_reference;
};
";

const HELPERS: &str = "
static inline int32_t ninebit_least(int32_t a, int32_t b) { return a < b ? a : b; }
static inline int32_t ninebit_greatest(int32_t a, int32_t b) { return a > b ? a : b; }

#endif
";

impl Syntax for C99 {
    fn head(&self, functions: &[NamedFunction<'_>]) -> String {
        let mut out = format!("/* {}\n   {}\n   {} */\n#include <stdint.h>\n\n", ROUNDING[0], ROUNDING[1], ROUNDING[2]);
        out.push_str(PIXEL);
        if reads_constants(functions) {
            out.push_str(CONSTANTS);
        }
        out + HELPERS
    }

    fn opening(&self, named: &NamedFunction<'_>) -> String {
        let constants = if named.function.uniform { ", const struct ninebit_constants *constants" } else { "" };
        let (name, about) = (&named.name, comment(&named.about));
        let given = format!("const struct ninebit_pixel *pixel{constants}");
        let mut out = match named.function.result {
            Result::Fragment(_) => format!(
                "/* {about}: R, G, B, A of the fragment, 0 to 255. */\n\
                 static inline void {name}({given}, int32_t fragment[4])\n{{\n"
            ),
            Result::Pixel { .. } => {
                return format!(
                    "/* {about}: a pixel that a triangle covers. *word and *depth, which has the stencil in its upper byte, become what the surface and\n   \
                     its depth buffer hold afterwards. 0 where the fragment is dropped; its stencil may change nevertheless. */\n\
                     static inline int {name}(const struct ninebit_triangle *triangle, const uint32_t *const texture[4], int32_t x, int32_t y,\n    \
                     uint32_t *word, uint32_t *depth)\n{{\n    const uint32_t held_word = *word, held_depth = *depth;\n    \
                     (void)triangle; (void)texture; (void)x; (void)y; (void)held_word; (void)held_depth;\n"
                );
            }
            Result::Stored { .. } => format!(
                "/* {about}: the word that the surface holds afterwards; 0 where the alpha test drops the fragment. */\n\
                 static inline int {name}({given}, uint32_t *word)\n{{\n"
            ),
        };
        let inputs = named.function.inputs();
        if inputs.iter().all(|input| input.is_constant()) {
            out.push_str("    (void)pixel;\n");
        }
        if named.function.uniform && !inputs.iter().any(|input| input.is_constant()) {
            out.push_str("    (void)constants;\n");
        }
        out
    }

    fn fragment(&self, channels: [String; 4]) -> String {
        let lines = channels.iter().enumerate().map(|(n, value)| format!("    fragment[{n}] = {value};\n"));
        lines.collect::<String>() + "}\n"
    }

    fn stored(&self, word: String, test: Option<String>) -> String {
        let dropped = "        *word = pixel->destination;\n        return 0;\n    }\n";
        let test = test.map(|test| format!("    if (!({test})) {{ /* ROP-1 */\n{dropped}")).unwrap_or_default();
        format!("{test}    *word = {word};\n    return 1;\n}}\n")
    }

    fn pixel(&self, word: String, depth: Option<String>, test: Option<String>) -> String {
        let depth = depth.map(|depth| format!("    *depth = {depth};\n")).unwrap_or_default();
        let test = test.map(|test| format!("    if (!({test})) return 0;\n")).unwrap_or_default();
        format!("{depth}{test}    *word = {word};\n    return 1;\n}}\n")
    }

    fn input(&self, input: Input) -> String {
        match input {
            Input::Primary(c) => format!("pixel->primary[{c}]"),
            Input::Secondary(c) => format!("pixel->secondary[{c}]"),
            Input::Fog(c) => format!("pixel->fog[{c}]"),
            Input::Texture(n, c) => format!("pixel->texture[{n}][{c}]"),
            Input::Texel(n, at) => format!("pixel->texel[{n}][{at}]"),
            Input::Weight(n, of) => format!("pixel->weight[{n}][{}]", of as usize),
            Input::Outside(n) => format!("pixel->outside[{n}]"),
            Input::Destination => "pixel->destination".to_string(),
            Input::StageConstant(stage, n, c) => format!("constants->stage[{stage}][{n}][{c}]"),
            Input::FinalConstant(n, c) => format!("constants->final[{n}][{c}]"),
            Input::FogColor(c) => format!("constants->fog[{c}]"),
            Input::BlendConstant(c) => format!("constants->blend[{c}]"),
            Input::AlphaReference => "constants->alpha_reference".to_string(),
            Input::BorderColor(n, c) => format!("constants->border[{n}][{c}]"),
            Input::Local(local) => local.name.to_string(),
            Input::X => "x".to_string(),
            Input::Y => "y".to_string(),
            Input::Held => "held_word".to_string(),
            Input::Depth => "held_depth".to_string(),
            Input::Triangle(field) => format!("triangle->{}", field.member()),
            Input::Vertex(k, attribute) => format!("vertex[{k}].{}", attribute.member()),
        }
    }

    fn constant(&self, value: i64, kind: Kind) -> String {
        match kind {
            Kind::Word if value > 255 => format!("{value:#x}u"),
            Kind::Word => format!("{value}u"),
            _ if is_wide((value, value)) => format!("INT64_C({value})"),
            _ => value.to_string(),
        }
    }

    fn call(&self, call: Call, operands: &[String]) -> Text {
        match (call, operands) {
            (Call::Least, [a, b]) => Text::Term(format!("ninebit_least({a}, {b})")),
            (Call::Greatest, [a, b]) => Text::Term(format!("ninebit_greatest({a}, {b})")),
            (Call::Select, [test, then, otherwise]) => Text::Open(format!("{test} ? {then} : {otherwise}")),
            (Call::Number, operands) => Text::Term(format!("(int32_t)({})", operands.join(""))),
            (Call::Named(name), operands) => Text::Term(format!("ninebit_{name}({})", operands.join(", "))),
            (_, operands) => Text::Term(format!("(uint32_t)({})", operands.join(""))),
        }
    }

    fn declare(&self, name: &str, line: &Line, value: &str, comment: &str) -> String {
        format!("const {} {name} = {value}; /* {comment} */", type_of(line.operation.kind(), line.range))
    }

    fn wide(&self, operation: Wide, operands: &[(String, bool)], result: bool) -> Text {
        let mut terms: Vec<String> = operands.iter().map(|(term, _)| term.clone()).collect();
        let is_wide = operands.iter().any(|(_, is_wide)| *is_wide);
        let infix = |terms: &[String], operator: &str| Text::Open(format!("{} {operator} {}", terms[0], terms[1]));
        let suffix = if is_wide || result { "64" } else { "" };
        let is_short = matches!(operation, Wide::Add | Wide::Subtract | Wide::Multiply | Wide::Scale) && !is_wide;
        if is_short && result {
            terms[0] = format!("(int64_t){}", terms[0]);
        }
        match operation {
            Wide::Add => infix(&terms, "+"),
            Wide::Subtract => infix(&terms, "-"),
            Wide::Multiply | Wide::Scale => infix(&terms, "*"),
            Wide::Bits => infix(&terms, "&"),
            Wide::Divide | Wide::Quotient => infix(&terms, "/"),
            Wide::Least => Text::Term(format!("ninebit_least{suffix}({})", terms.join(", "))),
            Wide::Greatest => Text::Term(format!("ninebit_greatest{suffix}({})", terms.join(", "))),
            Wide::Select => Text::Open(format!("{} ? {} : {}", terms[0], terms[1], terms[2])),
            Wide::Length => Text::Term(format!("ninebit_bits({})", terms[0])),
            Wide::Raise => Text::Term(format!("ninebit_raise({})", terms.join(", "))),
            Wide::ShortLower => infix(&terms, ">>"),
            Wide::Lower if is_wide => infix(&terms, ">>"),
            Wide::Lower => Text::Open(format!("(int64_t){} >> {}", terms[0], terms[1])),
        }
    }

    fn part(&self, binary: String, is_exponent: bool) -> String {
        format!("{binary}.{}", if is_exponent { "exponent" } else { "mantissa" })
    }

    fn word(&self, unit: usize, at: String) -> String {
        format!("texture[{unit}][{at}]")
    }
}

/// Returns the type of values.
fn type_of(kind: Kind, range: Range) -> &'static str {
    match kind {
        Kind::Number if is_wide(range) => "int64_t",
        Kind::Number => "int32_t",
        Kind::Word => "uint32_t",
        Kind::Binary => "struct ninebit_binary",
    }
}

pub(crate) const STRUCTURES: &str = "\
/* The number mantissa times 2^exponent. */
struct ninebit_binary {
    int32_t mantissa, exponent;
};

/* A vertex as set-up takes it. */
struct ninebit_vertex {
    int32_t position[2];       /* x and y in 1/16 pixel, toward zero (RAS-1) */
    uint32_t z, w;             /* binary32: z in steps of the depth buffer (DEP-1), w */
    int32_t color[2][4];       /* diffuse and specular: R, G, B, A, 0 to 255 (NUM-4); of a flat triangle those of its provoking vertex */
    uint32_t coordinate[4][4]; /* binary32: s, t, r, q of each unit's coordinates, after CYL-1 */
    uint32_t fog;              /* binary32: d', e, or a factor within 0 and 1 (INT-5n) */
};

/* Constants of a triangle. Numbers of vertices are that of the second, and the differences of the first and the third from it. The buffers of printed
   shaders have the same layout. */
struct ninebit_triangle {
    int32_t edge_x[3], edge_y[3];  /* slopes of the edge functions, in 1/256 square pixel */
    int64_t edge[3];               /* the edge functions at the centre of pixel (0, 0) */
    struct ninebit_binary ratio[3];
    struct ninebit_binary coordinate[4][4][3];
    struct ninebit_binary fog[3];
    struct ninebit_binary depth[3], depth_difference[3][3], depth_ratio[3]; /* of w for a w buffer (DEP-6) */
    int64_t offset;                /* of depths, times 2^offset_exponent (DEP-5): of whoever draws */
    int32_t color[2][4][3];        /* diffuse and specular: channel, vertex */
    int32_t owns[3];               /* 1 where pixels exactly on the edge belong to the triangle (RAS-3) */
    int32_t fog_byte;              /* the fog of all pixels, or -1 (FOG-5) */
    int32_t offset_exponent;
    int32_t sprite[2], sprite_size; /* of a point: x and y in 1/16 pixel, size in 1/8 pixel (PNT-2), or -1 */
};

";

const FUNCTIONS: &str = "\
static inline struct ninebit_binary ninebit_binary(int32_t mantissa, int32_t exponent)
{
    const struct ninebit_binary binary = {mantissa, exponent};
    return binary;
}
static inline int32_t ninebit_least(int32_t a, int32_t b) { return a < b ? a : b; }
static inline int32_t ninebit_greatest(int32_t a, int32_t b) { return a > b ? a : b; }
static inline int64_t ninebit_least64(int64_t a, int64_t b) { return a < b ? a : b; }
static inline int64_t ninebit_greatest64(int64_t a, int64_t b) { return a > b ? a : b; }
static inline int64_t ninebit_raise(int64_t a, int32_t by) { return (int64_t)((uint64_t)a << by); }

/* The number of significant bits of a number that is not negative. */
static inline int32_t ninebit_bits(int64_t n)
{
#if defined(__GNUC__)
    return n ? 64 - __builtin_clzll((unsigned long long)n) : 0;
#else
    int32_t bits = 0;
    for (int32_t by = 32; by > 0; by >>= 1) {
        if (n >> by) {
            n >>= by;
            bits += by;
        }
    }
    return bits + (n != 0);
#endif
}

/* a - b in binary32, to nearest; a difference below 2^-126 is 0, one that is too large the largest number (WGT-1). */
static inline uint32_t ninebit_difference(uint32_t a, uint32_t b)
{
    float x, y;
    memcpy(&x, &a, 4);
    memcpy(&y, &b, 4);
    volatile float difference = x - y;
    x = difference;
    memcpy(&a, &x, 4);
    if ((a & 0x7f800000) == 0x7f800000) a = (a & 0x80000000) | 0x7f7fffff;
    return a & 0x7f800000 ? a : 0;
}
";

/// Prints the statements that make the constants of a triangle.
pub(crate) fn statements(setup: &Setup) -> String {
    let results: Vec<Operand> = setup.outputs.iter().map(|output| output.1).collect();
    let body = Body::within(whole::LONGEST, &C99, &setup.lines, (&results, &[]));
    let mut out = body.printed();
    for (field, operand) in &setup.outputs {
        let value = body.operand(*operand, field.kind()).open();
        out.push_str(&format!("    {} = {value};\n", C99.input(Input::Triangle(*field))));
    }
    out
}

impl whole::WholeSyntax for C99 {
    fn functions(&self, structures: &str) -> String {
        format!("#include <string.h>\n\n{structures}{FUNCTIONS}")
    }

    fn whole_head(&self) -> String {
        let head = "Numbers are two's complement, and >> of a negative number is the floor, as in every compiler of today. Each line has its rules and its range.";
        format!("/* {head} */\n#include <stdint.h>\n{}", self.functions(STRUCTURES))
    }

    fn helper(&self, helper: Helper) -> String {
        let (name, about, rules) = helper.about();
        let parameters = helper.parameters().iter().enumerate().map(|(at, (kind, range))| {
            let Local { name, kind, range } = helper.parameter(at, *kind, *range);
            format!("{} {name}", type_of(kind, range))
        });
        let parameters: Vec<String> = parameters.collect();
        let kind = type_of(helper.kind(), helper.range());
        format!("\n/* {about} ({rules}). */\nstatic inline {kind} ninebit_{name}({})\n{{\n", parameters.join(", "))
    }

    fn table(&self, name: &str, Table(table): Table) -> String {
        let entries: Vec<String> = table.iter().map(u8::to_string).collect();
        format!("\nstatic const uint8_t ninebit_{name}[{}] = {{{}}};\n", table.len(), entries.join(", "))
    }

    fn coverage(&self, lines: &str, test: &str) -> String {
        format!(
            "\n/* Whether a triangle covers a pixel (RAS-2, RAS-3). */\n\
             static inline int ninebit_covers(const struct ninebit_triangle *triangle, int32_t x, int32_t y)\n{{\n{lines}    return {test};\n}}\n"
        )
    }

    fn setup(&self, draw: &Draw<'_>) -> String {
        let (name, statements) = (&draw.name, statements(draw.setup));
        format!(
            "\n/* Sets up a triangle of it. */\n\
             static inline void {name}_set_up(const struct ninebit_vertex vertex[3], struct ninebit_triangle *triangle)\n{{\n{statements}}}\n"
        )
    }

    /// A processor waits for the weights of a pixel, which are a chain of some forty operations. With the lines of two pixels in turn it has enough to
    /// do meanwhile.
    fn row(&self, draw: &Draw<'_>) -> String {
        const NEXT: &str = "_next";
        let (name, inputs) = (&draw.name, draw.function.inputs());
        let Result::Pixel { word, depth, test } = draw.function.result else { return String::new() };
        let mut out = format!(
            "\n/* The same of `count` pixels of a row, two at a time: (x, y) is the first. */\n\
             static inline void {name}_row(const struct ninebit_triangle *triangle, const uint32_t *const texture[4], int32_t x, int32_t y,\n    \
             int32_t count, uint32_t *word, uint32_t *depth)\n{{\n    \
             for (; count > 1; count -= 2, x += 2, word += 2, depth += 2) {{\n"
        );
        if inputs.contains(&Input::X) {
            out += &format!("        const int32_t x{NEXT} = x + 1;\n");
        }
        for (input, of) in [(Input::Held, "word"), (Input::Depth, "depth")] {
            if inputs.contains(&input) {
                out += &format!("        const uint32_t held_{of} = {of}[0], held_{of}{NEXT} = {of}[1];\n");
            }
        }
        let bodies = ["", NEXT].map(|suffix| Body::of_function(&C99, draw.function, suffix));
        for (first, next) in bodies[0].declarations.iter().zip(&bodies[1].declarations) {
            let next = next.split(" /* ").next().unwrap_or_default();
            out += &format!("        {first}\n        {next}\n");
        }
        for (n, body) in bodies.iter().enumerate() {
            if let Some(depth) = depth {
                out += &format!("        depth[{n}] = {};\n", body.operand(depth, Kind::Word).open());
            }
            let test = test.map(|test| format!("if ({}) ", body.test(test))).unwrap_or_default();
            out += &format!("        {test}word[{n}] = {};\n", body.operand(word, Kind::Word).open());
        }
        out + &format!("    }}\n    if (count > 0) (void){name}(triangle, texture, x, y, word, depth);\n}}\n")
    }
}
