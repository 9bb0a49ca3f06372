//! Translates the text that C and GLSL share.

use std::fmt::Write as _;

/// Words in which C and GLSL differ. The text is written with the words on the left; C and GLSL replace them by those on the right.
const WORDS: [(&str, [&str; 2]); 31] = [
    ("@triangle", ["const struct ninebit_triangle *triangle", "NinebitTriangle triangle"]),
    ("@textures", ["const uint32_t *const texture[4], ", ""]),
    ("@texture, ", ["texture, ", ""]),
    ("@texel(unit", ["nb_texel(texture, unit", "ninebit_texel(int(unit)"]),
    ("@t.", ["triangle->", "triangle."]),
    ("@surface", ["uint32_t *word, uint32_t *depth", "inout uint word, inout uint depth"]),
    ("@word", ["*word", "word"]),
    ("@depth", ["*depth", "depth"]),
    ("@image", ["struct nb_image", "nb_image"]),
    ("@given", ["struct nb_inputs", "NinebitInputs"]),
    ("@&", ["&", ""]),
    ("@binary", ["struct ninebit_binary", "ivec2"]),
    ("@long(", ["(int64_t)(", "nb_long("]),
    ("@long", ["int64_t", "uvec2"]),
    ("@narrow(", ["(int32_t)(", "ninebit_narrow("]),
    ("@flatten", ["NB_FLATTEN ", ""]),
    ("@fn ", ["static inline ", ""]),
    ("@uint(", ["(uint32_t)(", "uint("]),
    ("@int(", ["(int32_t)(", "int("]),
    ("@uint", ["uint32_t", "uint"]),
    ("@int", ["int32_t", "int"]),
    ("@in ", ["const ", ""]),
    ("@out ", ["", "out "]),
    ("@both ", ["", "inout "]),
    ("@registers", ["int32_t r[16][4]", "ivec4 r[16]"]),
    ("@changed", ["int32_t r[16][4]", "inout ivec4 r[16]"]),
    ("@state", ["const struct nb_state *state", "NinebitState state"]),
    ("@s.", ["state->", "state."]),
    ("@inputs", ["const struct nb_inputs *inputs", "NinebitInputs inputs"]),
    ("@i.", ["inputs->", "inputs."]),
    ("@public ", ["", ""]),
];

/// Translates the text into C (0) or GLSL (1).
pub(super) fn translated(text: &str, language: usize) -> String {
    WORDS.iter().fold(unrolled(text), |text, (word, words)| text.replace(word, words[language]))
}

/// Unrolls loops over R, G and B: compilers do not unroll them, which costs a third more time.
fn unrolled(text: &str) -> String {
    const LOOP: &str = "for (@int c = 0; c < 3; c++) ";
    let mut out = String::with_capacity(2 * text.len());
    for line in text.lines() {
        match line.split_once(LOOP) {
            Some((indent, statement)) => {
                (0..3).for_each(|c| _ = writeln!(out, "{indent}{}", statement.replace("[c]", &format!("[{c}]"))))
            }
            None => _ = writeln!(out, "{line}"),
        }
    }
    out
}
