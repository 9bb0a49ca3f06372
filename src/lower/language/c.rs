//! Prints C99, and the structures and helpers that it needs.

use super::*;

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
    fn head(&self, functions: &[Named<'_>]) -> String {
        let mut out = format!("/* {}\n   {}\n   {} */\n#include <stdint.h>\n\n", ROUNDING[0], ROUNDING[1], ROUNDING[2]);
        out.push_str(PIXEL);
        if reads_constants(functions) {
            out.push_str(CONSTANTS);
        }
        out + HELPERS
    }

    fn opening(&self, named: &Named<'_>) -> String {
        let constants = if named.function.uniform { ", const struct ninebit_constants *constants" } else { "" };
        let (name, about) = (&named.name, comment(&named.about));
        let given = format!("const struct ninebit_pixel *pixel{constants}");
        let mut out = match named.function.result {
            Result::Fragment(_) => format!(
                "/* {about}: R, G, B, A of the fragment, 0 to 255. */\n\
                 static inline void {name}({given}, int32_t fragment[4])\n{{\n"
            ),
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
        }
    }

    fn call(&self, call: Call, operands: &[String]) -> Text {
        match (call, operands) {
            (Call::Least, [a, b]) => Text::Term(format!("ninebit_least({a}, {b})")),
            (Call::Greatest, [a, b]) => Text::Term(format!("ninebit_greatest({a}, {b})")),
            (Call::Select, [test, then, otherwise]) => Text::Open(format!("{test} ? {then} : {otherwise}")),
            (Call::Number, operands) => Text::Term(format!("(int32_t)({})", operands.join(""))),
            (_, operands) => Text::Term(format!("(uint32_t)({})", operands.join(""))),
        }
    }

    fn declare(&self, name: &str, line: &Line, value: &str, comment: &str) -> String {
        let kind = match line.operation.kind() {
            Kind::Number => "int32_t",
            Kind::Word => "uint32_t",
        };
        format!("const {kind} {name} = {value}; /* {comment} */")
    }
}
