//! Prints GLSL 3.30 and GLSL ES 3.00, and the structures that they need.

use super::*;

pub(super) struct Glsl;

impl Syntax for Glsl {
    fn head(&self, functions: &[NamedFunction<'_>]) -> String {
        let mut out = ROUNDING.map(|line| format!("// {line}\n")).concat();
        out.push_str("// For GLSL 3.30 and GLSL ES 3.00: the line that tells the version stands above.\nprecision highp int;\n\n");
        out.push_str("// What one pixel brings. Colours are R, G, B, A. A function reads what it needs; the rest may be anything.\n");
        out.push_str("struct NinebitPixel {\n    ivec4 primary;   // interpolated diffuse, 0 to 255\n");
        out.push_str("    ivec4 secondary; // interpolated specular, 0 to 255\n");
        out.push_str("    ivec4 fog;       // fog colour and, in alpha, factor: 0 to 255\n");
        out.push_str("    // What each unit yields: 0 to 255, signed channels -256 to 254.\n");
        (0..4).for_each(|n| out.push_str(&format!("    ivec4 texture{n};\n")));
        out.push_str("    // Fetched words of each unit: the footprint of a level row by row, then that of the next; palettes looked up and blocks\n");
        out.push_str("    // decoded to A8R8G8B8. A single texel is the first, with weights 0.\n");
        (0..4).for_each(|n| out.push_str(&format!("    uint texel{n}[8];\n")));
        out.push_str("    // Weights of right and lower texels, of the same on the next level, of that level: 0 to 255 of 256.\n");
        (0..4).for_each(|n| out.push_str(&format!("    int weight{n}[5];\n")));
        out.push_str("    ivec4 outside;    // bit n of a unit's: its texel n is the border colour\n");
        out.push_str("    uint destination; // the word that the surface holds\n};\n");
        if reads_constants(functions) {
            out.push_str("\n// Constants of a draw: R, G, B, A, 0 to 255.\nstruct NinebitConstants {\n");
            out.push_str("    ivec4 stage[16]; // constant colours 0 and 1 of each general stage\n");
            out.push_str("    ivec4 final[2];  // of the final combiner\n    ivec4 fog;       // fog colour\n");
            out.push_str(
                "    ivec4 blend;     // blend constant\n    ivec4 border[4]; // border colour of each unit\n",
            );
            out.push_str("    int alpha_reference;\n};\n");
        }
        out
    }

    fn opening(&self, named: &NamedFunction<'_>) -> String {
        let constants = if named.function.uniform { ", NinebitConstants constants" } else { "" };
        let (name, about) = (&named.name, comment(&named.about));
        match named.function.result {
            Result::Fragment(_) => format!(
                "// {about}: R, G, B, A of the fragment, 0 to 255.\nivec4 {name}(NinebitPixel pixel{constants})\n{{\n"
            ),
            Result::Pixel { .. } => format!(
                "// {about}: a pixel that a triangle covers. word and depth, which has the stencil in its upper byte, become what the surface and its\n\
                 // depth buffer hold afterwards; false where the fragment is dropped.\n\
                 bool {name}(NinebitTriangle triangle, int x, int y, inout uint word, inout uint depth)\n{{\n    \
                 uint held_word = word, held_depth = depth;\n"
            ),
            Result::Stored { .. } => format!(
                "// {about}: the word that the surface holds afterwards; false where the alpha test drops the fragment.\n\
                 bool {name}(NinebitPixel pixel{constants}, out uint word)\n{{\n"
            ),
        }
    }

    fn fragment(&self, channels: [String; 4]) -> String {
        format!("    return ivec4({});\n}}\n", channels.join(", "))
    }

    fn stored(&self, word: String, test: Option<String>) -> String {
        let dropped = "        word = pixel.destination;\n        return false;\n    }\n";
        let test = test.map(|test| format!("    if (!({test})) {{ // ROP-1\n{dropped}")).unwrap_or_default();
        format!("{test}    word = {word};\n    return true;\n}}\n")
    }

    fn pixel(&self, word: String, depth: Option<String>, test: Option<String>) -> String {
        let depth = depth.map(|depth| format!("    depth = {depth};\n")).unwrap_or_default();
        let test = test.map(|test| format!("    if (!({test})) return false;\n")).unwrap_or_default();
        format!("{depth}{test}    word = {word};\n    return true;\n}}\n")
    }

    fn wide(&self, operation: Wide, operands: &[(String, bool)], result: bool) -> Text {
        shader::wide(operation, operands, result, false)
    }

    fn compare(&self, a: (String, bool), operator: &str, b: (String, bool)) -> String {
        shader::compare(a, operator, b, false)
    }

    fn narrowed(&self, text: String) -> String {
        format!("ninebit_narrow({text})")
    }

    fn widened(&self, text: String) -> String {
        format!("ninebit_wide({text})")
    }

    fn constant(&self, value: i64, kind: Kind) -> String {
        match kind {
            Kind::Word if value > 255 => format!("{value:#x}u"),
            Kind::Word => format!("{value}u"),
            _ if is_wide((value, value)) => shader::constant(value, "uvec2"),
            _ => value.to_string(),
        }
    }

    fn input(&self, input: Input) -> String {
        match input {
            Input::Primary(c) => format!("pixel.primary.{}", letter(c)),
            Input::Secondary(c) => format!("pixel.secondary.{}", letter(c)),
            Input::Fog(c) => format!("pixel.fog.{}", letter(c)),
            Input::Texture(n, c) => format!("pixel.texture{n}.{}", letter(c)),
            Input::Texel(n, at) => format!("pixel.texel{n}[{at}]"),
            Input::Weight(n, of) => format!("pixel.weight{n}[{}]", of as usize),
            Input::Outside(n) => format!("pixel.outside[{n}]"),
            Input::Destination => "pixel.destination".to_string(),
            Input::StageConstant(stage, n, c) => format!("constants.stage[{}].{}", 2 * stage + n, letter(c)),
            Input::FinalConstant(n, c) => format!("constants.final[{n}].{}", letter(c)),
            Input::FogColor(c) => format!("constants.fog.{}", letter(c)),
            Input::BlendConstant(c) => format!("constants.blend.{}", letter(c)),
            Input::AlphaReference => "constants.alpha_reference".to_string(),
            Input::BorderColor(n, c) => format!("constants.border[{n}].{}", letter(c)),
            Input::Local(local) => local.name.to_string(),
            Input::X => "x".to_string(),
            Input::Y => "y".to_string(),
            Input::Held => "held_word".to_string(),
            Input::Depth => "held_depth".to_string(),
            Input::Triangle(field) => format!("triangle.{}", field.member()),
            Input::Vertex(k, attribute) => format!("vertex[{k}].{}", attribute.member()),
        }
    }

    fn call(&self, call: Call, operands: &[String]) -> Text {
        match (call, operands) {
            (Call::Least, operands) => Text::Term(format!("min({})", operands.join(", "))),
            (Call::Greatest, operands) => Text::Term(format!("max({})", operands.join(", "))),
            (Call::Select, [test, then, otherwise]) => Text::Open(format!("{test} ? {then} : {otherwise}")),
            (Call::Number, operands) => Text::Term(format!("int({})", operands.join(""))),
            (Call::Named(name), operands) => Text::Term(format!("ninebit_{name}({})", operands.join(", "))),
            (_, operands) => Text::Term(format!("uint({})", operands.join(""))),
        }
    }

    fn declare(&self, name: &str, line: &Line, value: &str, comment: &str) -> String {
        format!("{} {name} = {value}; // {comment}", shader::glsl_type(line))
    }
}
