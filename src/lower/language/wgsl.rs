//! Prints WGSL, and the structures that it needs.

use super::*;

pub(super) struct Wgsl;

impl Syntax for Wgsl {
    fn head(&self, functions: &[NamedFunction<'_>]) -> String {
        let mut out = ROUNDING.map(|line| format!("// {line}\n")).concat();
        out.push_str("\n// What one pixel brings. Colours are R, G, B, A. A function reads what it needs; the rest may be anything.\n");
        out.push_str("struct NinebitPixel {\n    primary: vec4<i32>,   // interpolated diffuse, 0 to 255\n");
        out.push_str("    secondary: vec4<i32>, // interpolated specular, 0 to 255\n");
        out.push_str("    fog: vec4<i32>,       // fog colour and, in alpha, factor: 0 to 255\n");
        out.push_str("    // What each unit yields: 0 to 255, signed channels -256 to 254.\n");
        (0..4).for_each(|n| out.push_str(&format!("    texture{n}: vec4<i32>,\n")));
        out.push_str("    // Fetched words of each unit: the footprint of a level row by row, then that of the next; palettes looked up and blocks\n");
        out.push_str("    // decoded to A8R8G8B8. A single texel is the first, with weights 0.\n");
        (0..4).for_each(|n| out.push_str(&format!("    texel{n}: array<u32, 8>,\n")));
        out.push_str("    // Weights of right and lower texels, of the same on the next level, of that level: 0 to 255 of 256.\n");
        (0..4).for_each(|n| out.push_str(&format!("    weight{n}: array<i32, 5>,\n")));
        out.push_str("    outside: vec4<i32>,   // bit n of a unit's: its texel n is the border colour\n");
        out.push_str("    destination: u32,     // the word that the surface holds\n}\n");
        if reads_constants(functions) {
            out.push_str("\n// Constants of a draw: R, G, B, A, 0 to 255.\nstruct NinebitConstants {\n");
            out.push_str("    stage: array<vec4<i32>, 16>,       // constant colours 0 and 1 of each general stage\n");
            out.push_str(
                "    final_combiner: array<vec4<i32>, 2>,\n    fog: vec4<i32>,                    // fog colour\n",
            );
            out.push_str("    blend: vec4<i32>,                  // blend constant\n");
            out.push_str(
                "    border: array<vec4<i32>, 4>,       // border colour of each unit\n    alpha_reference: i32,\n}\n",
            );
        }
        if functions.iter().any(|named| matches!(named.function.result, Result::Stored { .. })) {
            out.push_str("\n// The word that the surface holds afterwards, and whether the alpha test passed.\n");
            out.push_str("struct NinebitStored {\n    passed: bool,\n    word: u32,\n}\n");
        }
        out
    }

    fn opening(&self, named: &NamedFunction<'_>) -> String {
        let constants = if named.function.uniform { ", constants: NinebitConstants" } else { "" };
        let (result, about) = match named.function.result {
            Result::Fragment(_) => ("vec4<i32>", "R, G, B, A of the fragment, 0 to 255"),
            Result::Pixel { .. } => {
                return format!(
                    "// {}: a pixel that a triangle covers. Depths have the stencil in the upper byte.\n\
                     fn {}(triangle: NinebitTriangle, x: i32, y: i32, held_word: u32, held_depth: u32) -> NinebitWhole {{\n",
                    comment(&named.about),
                    named.name
                );
            }
            Result::Stored { .. } => ("NinebitStored", "the word that the surface holds afterwards"),
        };
        let (name, function) = (&named.name, comment(&named.about));
        format!("// {function}: {about}.\nfn {name}(pixel: NinebitPixel{constants}) -> {result} {{\n")
    }

    fn fragment(&self, channels: [String; 4]) -> String {
        format!("    return vec4<i32>({});\n}}\n", channels.join(", "))
    }

    fn stored(&self, word: String, test: Option<String>) -> String {
        let dropped = "        return NinebitStored(false, pixel.destination);\n    }\n";
        let test = test.map(|test| format!("    if !({test}) {{ // ROP-1\n{dropped}")).unwrap_or_default();
        format!("{test}    return NinebitStored(true, {word});\n}}\n")
    }

    fn pixel(&self, word: String, depth: Option<String>, test: Option<String>) -> String {
        let depth = depth.unwrap_or("held_depth".to_string());
        let test = test.unwrap_or("true".to_string());
        format!(
            "    let kept = {test};\n    return NinebitWhole(kept, select(held_word, {word}, kept), {depth});\n}}\n"
        )
    }

    fn wide(&self, operation: Wide, operands: &[(String, bool)], result: bool) -> Text {
        shader::wide(operation, operands, result, true)
    }

    fn compare(&self, a: (String, bool), operator: &str, b: (String, bool)) -> String {
        shader::compare(a, operator, b, true)
    }

    fn narrowed(&self, text: String) -> String {
        format!("ninebit_narrow({text})")
    }

    fn widened(&self, text: String) -> String {
        format!("ninebit_wide({text})")
    }

    fn constant(&self, value: i64, kind: Kind) -> String {
        if kind == Kind::Number && is_wide((value, value)) {
            return shader::constant(value, "vec2<u32>");
        }
        super::glsl::Glsl.constant(value, kind)
    }

    fn input(&self, input: Input) -> String {
        match input {
            Input::FinalConstant(n, c) => format!("constants.final_combiner[{n}].{}", letter(c)),
            // All other inputs are written as in GLSL.
            input => super::glsl::Glsl.input(input),
        }
    }

    fn call(&self, call: Call, operands: &[String]) -> Text {
        Text::Term(match (call, operands) {
            (Call::Least, operands) => format!("min({})", operands.join(", ")),
            (Call::Greatest, operands) => format!("max({})", operands.join(", ")),
            (Call::Select, [test, then, otherwise]) => format!("select({otherwise}, {then}, {test})"),
            (Call::Number, operands) => format!("i32({})", operands.join("")),
            (Call::Named(name), operands) => format!("ninebit_{name}({})", operands.join(", ")),
            (_, operands) => format!("u32({})", operands.join("")),
        })
    }

    fn declare(&self, name: &str, _line: &Line, value: &str, comment: &str) -> String {
        format!("let {name} = {value}; // {comment}")
    }
}
