//! Translates the text that C, GLSL and WGSL share.

use std::fmt::Write as _;

use super::wgsl;
use crate::language::Language;

/// Words in which languages differ. The text is written with the words on the left; C, GLSL and WGSL replace them by those on the right.
const WORDS: [(&str, [&str; 3]); 35] = [
    ("@triangle", ["const struct ninebit_triangle *triangle", "NinebitTriangle triangle", ""]),
    ("@textures", ["const uint32_t *const texture[4], ", "", ""]),
    ("@texture, ", ["texture, ", "", ""]),
    ("@texel(unit", ["nb_texel(texture, unit", "ninebit_texel(int(unit)", "ninebit_texel(i32(unit)"]),
    ("@t.", ["triangle->", "triangle.", ""]),
    ("@surface", ["uint32_t *word, uint32_t *depth", "inout uint word, inout uint depth", ""]),
    ("@word", ["*word", "word", "*word"]),
    ("@depth", ["*depth", "depth", "*depth"]),
    ("@shared\n", ["\n", "nb_work nb_shared;\n\n", "var<private> nb_shared: nb_work;\n\n"]),
    ("@memory", ["struct nb_work memory = {0}, *const work = &memory;", "", ""]),
    ("@work", ["struct nb_work *work", "", ""]),
    ("@w.", ["work->", "nb_shared.", "nb_shared."]),
    ("@given", ["struct nb_inputs", "NinebitInputs", ""]),
    ("@&", ["&", "", "&"]),
    ("@binary", ["struct ninebit_binary", "ivec2", ""]),
    ("@long(", ["(int64_t)(", "nb_long(", "nb_long("]),
    ("@long", ["int64_t", "uvec2", ""]),
    ("@greatest(", ["ninebit_greatest(", "max(", "max("]),
    ("@narrow(", ["(int32_t)(", "ninebit_narrow(", "ninebit_narrow("]),
    ("@flatten", ["NB_FLATTEN ", "", ""]),
    ("@fn ", ["static inline ", "", ""]),
    ("@uint(", ["(uint32_t)(", "uint(", "u32("]),
    ("@int(", ["(int32_t)(", "int(", "i32("]),
    ("@uint", ["uint32_t", "uint", ""]),
    ("@int", ["int32_t", "int", ""]),
    ("@in ", ["const ", "", ""]),
    ("@out ", ["", "out ", ""]),
    ("@both ", ["", "inout ", ""]),
    ("@registers", ["int32_t r[16][4]", "ivec4 r[16]", ""]),
    ("@changed", ["int32_t r[16][4]", "inout ivec4 r[16]", ""]),
    ("@state", ["const struct nb_state *state", "NinebitState state", ""]),
    ("@s.", ["state->", "state.", ""]),
    ("@inputs", ["const struct nb_inputs *inputs", "NinebitInputs inputs", ""]),
    ("@i.", ["inputs->", "inputs.", "inputs."]),
    ("@public ", ["", "", ""]),
];

/// Translates the text.
pub(super) fn translated(text: &str, language: Language) -> String {
    let unrolled = unrolled(text);
    let (column, text) = match language {
        Language::Wgsl => (2, wgsl::translated(&unrolled.replace("@textures", "").replace("@texture, ", ""))),
        Language::Glsl => (1, unrolled),
        _ => (0, unrolled),
    };
    let text = selected(&text, language == Language::Wgsl);
    WORDS.iter().fold(text, |text, (word, words)| text.replace(word, words[column]))
}

/// Returns the text with state, triangles and what functions share as variables of the module, for languages that would copy parameters.
pub(super) fn global(text: &str) -> String {
    const CHANGES: [(&str, &str); 9] = [
        ("@state, ", ""),
        ("@state)", ")"),
        ("@work, ", ""),
        ("(state, ", "("),
        ("(work, ", "("),
        ("@s.", "ninebit_state."),
        ("triangle.", "@t."),
        ("@triangle", "@int triangle"),
        ("@t.", "ninebit_triangles[triangle]."),
    ];
    CHANGES.iter().fold(text.to_string(), |text, (from, to)| text.replace(from, to))
}

/// Replaces each `start` of a text, which ends in a parenthesis, and what follows up to the other parenthesis.
pub(super) fn replaced(text: &str, start: &str, of: impl Fn(&str) -> String) -> String {
    let (mut out, mut rest) = (String::new(), text);
    while let Some((before, after)) = rest.split_once(start) {
        let end = top_level(after, ')').next().unwrap_or(after.len());
        out.push_str(before);
        out.push_str(&of(&after[..end]));
        rest = after.get(end + 1..).unwrap_or_default();
    }
    out + rest
}

/// Returns where a character stands outside of parentheses.
pub(super) fn top_level(text: &str, wanted: char) -> impl Iterator<Item = usize> {
    let mut depth = 0;
    text.char_indices().filter_map(move |(at, c)| {
        let found = depth == 0 && c == wanted;
        depth += i32::from(c == '(') - i32::from(c == ')');
        found.then_some(at)
    })
}

/// Splits a text at a character that stands outside of parentheses.
pub(super) fn pieces_of(text: &str, at: char) -> impl Iterator<Item = &str> {
    let mut start = 0;
    top_level(text, at).chain([text.len()]).map(move |end| {
        let from = std::mem::replace(&mut start, end + 1);
        &text[from..end]
    })
}

/// Prints selections.
fn selected(text: &str, is_call: bool) -> String {
    replaced(text, "@select(", |of| {
        let of = selected(of, is_call);
        match pieces_of(&of, ',').map(str::trim).collect::<Vec<_>>()[..] {
            [test, then, otherwise] if is_call => format!("select({otherwise}, {then}, {test})"),
            [test, then, otherwise] => format!("({test} ? {then} : {otherwise})"),
            _ => of,
        }
    })
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
