//! Prints Verilog-2001, with a combinational module for each function.

use super::*;
use crate::code::Range;

pub(super) struct Verilog;

/// Returns the number of bits of two's complement that hold a range.
fn width((low, high): Range) -> u32 {
    let bits = |value: i64| 64 - if value < 0 { !value } else { value }.leading_zeros() + 1;
    bits(low).max(bits(high))
}

/// Returns the type of a port or wire.
pub(crate) fn port(kind: Kind, range: Range) -> String {
    match kind {
        Kind::Number => format!("signed [{}:0]", width(range) - 1),
        Kind::Word | Kind::Binary => "[31:0]".to_string(),
    }
}

impl Syntax for Verilog {
    fn head(&self, _functions: &[NamedFunction<'_>]) -> String {
        let lines = ROUNDING.map(|line| format!("// {line}\n")).concat();
        lines
            + "// Ports are what the pixel brings, as far as the module reads it: colours of 9 bits, of which textures alone are ever negative; weights\n\
               // of 256ths; words of 32 bits. Constants of the draw, where they are ports, are bytes in 9 bits.\n"
    }

    fn opening(&self, named: &NamedFunction<'_>) -> String {
        let inputs = named.function.inputs().into_iter();
        let mut ports: Vec<String> =
            inputs.map(|input| format!("input {} {}", port(input.kind(), input.range()), self.input(input))).collect();
        match named.function.result {
            Result::Fragment(_) => ports.extend((0..4).map(|n| format!("output [7:0] out_{}", letter(n)))),
            Result::Stored { .. } | Result::Pixel { .. } => {
                ports.extend(["output passed", "output [31:0] word"].map(str::to_owned))
            }
        }
        format!("// {}\nmodule {} (\n    {}\n);\n", comment(&named.about), named.name, ports.join(",\n    "))
    }

    fn fragment(&self, channels: [String; 4]) -> String {
        let lines = channels.iter().enumerate().map(|(n, value)| format!("    assign out_{} = {value};\n", letter(n)));
        lines.collect::<String>() + "endmodule\n"
    }

    fn stored(&self, word: String, test: Option<String>) -> String {
        let (passed, word) = match test {
            Some(test) => (format!("{test}; // ROP-1"), format!("passed ? {word} : destination")),
            None => ("1'b1;".to_owned(), word),
        };
        format!("    assign passed = {passed}\n    assign word = {word};\nendmodule\n")
    }

    /// Whole pixels are not printed in Verilog: set-up and memories are no combinational module.
    fn pixel(&self, word: String, _depth: Option<String>, test: Option<String>) -> String {
        self.stored(word, test)
    }

    fn wide(&self, operation: Wide, operands: &[(String, bool)], _result: bool) -> Text {
        let operator = match operation {
            Wide::Raise => "<<<",
            _ => ">>>",
        };
        let terms: Vec<&str> = operands.iter().map(|(text, _)| text.as_str()).collect();
        Text::Open(terms.join(&format!(" {operator} ")))
    }

    fn input(&self, input: Input) -> String {
        match input {
            Input::Primary(c) => format!("primary_{}", letter(c)),
            Input::Secondary(c) => format!("secondary_{}", letter(c)),
            Input::Fog(c) => format!("fog_{}", letter(c)),
            Input::Texture(n, c) => format!("texture{n}_{}", letter(c)),
            Input::Texel(n, at) => format!("texel{n}_{at}"),
            Input::Weight(n, of) => format!("weight{n}_{}", of.name()),
            Input::Outside(n) => format!("outside{n}"),
            Input::Destination => "destination".to_string(),
            Input::StageConstant(stage, n, c) => format!("stage{stage}_constant{n}_{}", letter(c)),
            Input::FinalConstant(n, c) => format!("final_constant{n}_{}", letter(c)),
            Input::FogColor(c) => format!("fog_color_{}", letter(c)),
            Input::BlendConstant(c) => format!("blend_constant_{}", letter(c)),
            Input::AlphaReference => "alpha_reference".to_string(),
            Input::BorderColor(n, c) => format!("border{n}_{}", letter(c)),
            Input::X | Input::Y | Input::Held | Input::Depth | Input::Triangle(_) | Input::Vertex(..) => {
                super::glsl::Glsl.input(input)
            }
            // A port cannot be an element of an array.
            Input::Local(local) => local.name.replace(['[', ']'], ""),
        }
    }

    fn constant(&self, value: i64, kind: Kind) -> String {
        match kind {
            Kind::Number | Kind::Binary => value.to_string(),
            Kind::Word if value > 255 => format!("32'h{value:x}"),
            Kind::Word => format!("32'd{value}"),
        }
    }

    fn call(&self, call: Call, operands: &[String]) -> Text {
        match (call, operands) {
            (Call::Least, [a, b]) => Text::Term(format!("({a} < {b} ? {a} : {b})")),
            (Call::Greatest, [a, b]) => Text::Term(format!("({a} > {b} ? {a} : {b})")),
            (Call::Select, [test, then, otherwise]) => Text::Term(format!("({test} ? {then} : {otherwise})")),
            (Call::Number, operands) => Text::Term(format!("$signed({{1'b0, {}}})", operands.join(""))),
            (_, operands) => Text::Term(format!("(32'd0 | $unsigned({}))", operands.join(""))),
        }
    }

    fn declare(&self, name: &str, line: &Line, value: &str, comment: &str) -> String {
        format!("wire {} {name} = {value}; // {comment}", port(line.operation.kind(), line.range))
    }

    fn compares_names(&self) -> bool {
        true
    }
}
