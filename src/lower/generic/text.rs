//! Prints the generic text: the functions that call pieces.

use std::fmt::Write as _;

use ninebit::combiner::general::component_channel;
use ninebit::combiner::registers::channel_name;
use ninebit::state::{FinalRegister, Named, Profile};
use ninebit_program::registers::layout::{self, Field};
use ninebit_program::registers::unit::{self, Words};
use ninebit_program::registers::{Word, component, raster, register_code as code};

use super::pieces::{Write, initial_spare0, pieces, writes};
use super::print::FILLED;
use super::translation::translated;
use super::{Generic, Sources};
use crate::language::{Language, ROUNDING, Syntax};

/// Returns the words that a chip has: those of the combiners and of blending.
pub(super) fn words(chip: Profile) -> impl Iterator<Item = Words> {
    let of = |name, count, method| Words { name, method, elements: (count, 4), words: 1 };
    let words = Word::ALL.iter().map(move |word| of(word.name(), word.count(chip), word.method(chip)));
    let raster = raster::Method::ALL.iter().map(move |method| of(method.name(), 1, method.number()));
    words.chain(raster).filter(|words| words.elements.0 > 0)
}

/// How inputs are mapped: shaders compute the mapping, but on a processor a table is faster.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Mapped {
    Computed,
    Looked,
}

pub(super) struct Printer<'g> {
    pub(super) generic: &'g Generic,
    pub(super) language: Language,
    pub(super) syntax: &'static dyn Syntax,
    words: Vec<Words>,
    /// Length of a value's text above which it has a line of its own.
    pub(super) longest: usize,
}

const DECLARATIONS: &str = "/* Writes the word of a method. 0: it is none of these. */\nint nb_method(struct nb_state *state, uint32_t method, uint32_t word);\n\
         /* R, G, B, A as they leave the final combiner: 0 to 255. */\n\
         void nb_fragment(const struct nb_state *state, const struct nb_inputs *inputs, int32_t fragment[4]);\n\
         /* Alpha test (ROP-1): 0 if the fragment is dropped. */\n\
         int nb_kept(const struct nb_state *state, const int32_t fragment[4]);\n\
         /* What a surface that holds a word holds after a fragment that was not dropped. */\n\
         uint32_t nb_stored(const struct nb_state *state, const int32_t fragment[4], uint32_t destination);\n\
         /* All of it: what the surface holds after the pixel. */\n\
         uint32_t nb_pixel(const struct nb_state *state, const struct nb_inputs *inputs);\n";

const LIMITS: &str = "static inline int32_t ninebit_least(int32_t a, int32_t b) { return a < b ? a : b; }
static inline int32_t ninebit_greatest(int32_t a, int32_t b) { return a > b ? a : b; }

";

pub(super) fn c99(generic: &Generic) -> Sources {
    let printer = Printer::new(generic, Language::C99);
    let header = printer.header("The combiners and raster operations", "NINEBIT_COMBINERS_H", "", "");
    Sources { header, source: printer.source("ninebit_combiners.h", LIMITS), name: "ninebit_combiners" }
}

pub(super) fn glsl(generic: &Generic) -> String {
    let printer = Printer::new(generic, Language::Glsl);
    let head = printer.shader("The combiners and raster operations", "GLSL 3.30 and GLSL ES 3.00", "");
    head + &translated(&printer.body(Mapped::Computed), Language::Glsl)
}

const C99_INPUTS: &str = "    int32_t primary[4];    /* interpolated diffuse, 0 to 255 */
    int32_t secondary[4];  /* interpolated specular, 0 to 255 */
    int32_t fog[4];        /* fog colour and, in alpha, factor: 0 to 255 */
    int32_t texture[4][4]; /* what each unit yields: 0 to 255, signed channels -256 to 254; a unit that is off: 0, 0, 0, 255 */
    uint32_t destination;  /* the word that the surface holds */
";
const GLSL_INPUTS: &str = "    ivec4 primary;    /* interpolated diffuse, 0 to 255 */
    ivec4 secondary;  /* interpolated specular, 0 to 255 */
    ivec4 fog;        /* fog colour and, in alpha, factor: 0 to 255 */
    ivec4 texture[4]; /* what each unit yields: 0 to 255, signed channels -256 to 254; a unit that is off: 0, 0, 0, 255 */
    uint destination; /* the word that the surface holds */
";

const WGSL_INPUTS: &str = "    primary: vec4<i32>, // interpolated diffuse, 0 to 255
    secondary: vec4<i32>, // interpolated specular, 0 to 255
    fog: vec4<i32>, // fog colour and, in alpha, factor: 0 to 255
    texture: array<vec4<i32>, 4>, // what each unit yields: 0 to 255, signed channels -256 to 254; a unit that is off: 0, 0, 0, 255
    destination: u32, // the word that the surface holds
";

/// Returns an expression for a field of a word.
pub(super) fn field(word: &str, field: Field) -> String {
    match (field.shift, field.shift + field.bits) {
        (0, _) => format!("{word} & {}u", field.most()),
        (shift, 32) => format!("{word} >> {shift}"),
        (shift, _) => format!("({word} >> {shift}) & {}u", field.most()),
    }
}

/// Returns a condition that a field is not 0.
fn is_set(word: &str, name: Field) -> String {
    format!("({}) != 0u", field(word, name))
}

impl<'g> Printer<'g> {
    fn new(generic: &'g Generic, language: Language) -> Printer<'g> {
        Printer {
            generic,
            language,
            syntax: language.syntax(),
            words: words(generic.chip).collect(),
            longest: usize::MAX,
        }
    }

    /// Prints texts of whole pixels.
    pub(super) fn whole(generic: &'g Generic, language: Language) -> Printer<'g> {
        let words = words(generic.chip).chain(unit::WORDS).collect();
        Printer { words, longest: FILLED, ..Printer::new(generic, language) }
    }

    /// Prints the header of C.
    pub(super) fn header(&self, what: &str, guard: &str, structures: &str, declarations: &str) -> String {
        format!(
            "/* {what} of the {} class, from register words to the stored word. Integers only; nothing is allocated. */\n\
             #ifndef {guard}\n#define {guard}\n\n#include <stdint.h>\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n\
             /* Words as a driver writes them, with the methods that write them. What is not written is 0. */\nstruct nb_state {{\n{}}};\n\n\
             /* What one pixel brings. Colours are R, G, B, A. */\nstruct nb_inputs {{\n{C99_INPUTS}}};\n\n{structures}{DECLARATIONS}{declarations}\n\
             #ifdef __cplusplus\n}}\n#endif\n\n#endif\n",
            self.chip(),
            translated(&self.members(), Language::C99),
        )
    }

    /// Prints the beginning of a text of GLSL or WGSL, up to what stands before all functions.
    pub(super) fn shader(&self, what: &str, versions: &str, first: &str) -> String {
        let rounding = ROUNDING.map(|line| format!("// {line}\n")).concat();
        let state = format!("struct NinebitState {{\n{}}};", self.members());
        let (is_wgsl, chip) = (self.language == Language::Wgsl, self.chip());
        let (version, inputs) = if is_wgsl {
            (String::new(), WGSL_INPUTS)
        } else {
            (
                format!("// For {versions}: the line that tells the version stands above.\nprecision highp int;\n"),
                GLSL_INPUTS,
            )
        };
        format!(
            "// {what} of the {chip} class, from register words to the stored word.\n{rounding}{version}\n\
             /* Words as a driver writes them, with the methods that write them. What is not written is 0. */\n{}\n\
             /* What one pixel brings. Colours are R, G, B, A. */\nstruct NinebitInputs {{\n{inputs}}}{}\n\n{first}",
            translated(&state, self.language),
            if is_wgsl { "" } else { ";" },
        )
    }

    /// Prints the source of C, with what stands before all functions.
    pub(super) fn source(&self, header: &str, first: &str) -> String {
        let rounding = ROUNDING.join("\n   ");
        format!(
            "/* {rounding} */\n#include \"{header}\"\n\n{first}\
             /* All of a pixel in one function: calls would take half of its time. */\n\
             #if defined(__GNUC__)\n#define NB_FLATTEN __attribute__((flatten))\n#else\n#define NB_FLATTEN\n#endif\n\n{}{}",
            self.method(),
            translated(&self.body(Mapped::Looked), Language::C99),
        )
    }

    /// Returns whether statements share lines.
    pub(super) fn is_dense(&self) -> bool {
        self.longest != usize::MAX
    }

    fn chip(&self) -> &'static str {
        match self.generic.chip {
            Profile::Nv10 => "NV10 (Celsius)",
            Profile::Nv2a => "NV20 (Kelvin, NV2A)",
        }
    }

    fn members(&self) -> String {
        let lines = self.words.iter().map(|words| {
            let size = |count: usize| if count > 1 { format!("[{count}]") } else { String::new() };
            let name = format!("{}{}{};", words.name, size(words.elements.0), size(words.words));
            format!("    @uint {name:<24} /* {:#06x} */\n", words.method)
        });
        lines.collect()
    }

    fn method(&self) -> String {
        let mut out = "int nb_method(struct nb_state *state, uint32_t method, uint32_t word)\n{\n".to_string();
        for Words { name, method, elements: (count, step), words } in self.words.iter().copied() {
            let last = method + step * (count as u32 - 1) + 4 * (words as u32 - 1);
            let from = format!("(method - {method:#x}u)");
            let place = match (count, words) {
                (1, 1) => continue,
                (1, _) => format!("{from} / 4u"),
                (_, 1) => format!("{from} / {step}u"),
                _ => format!("{from} / {step}u][{from} % {step}u / 4u"),
            };
            let is_element = match step {
                4 => "method % 4u == 0u".to_string(),
                _ => format!("{from} % {step}u <= {}u && method % 4u == 0u", 4 * (words - 1)),
            };
            let _ = writeln!(
                out,
                "    if (method >= {method:#x}u && method <= {last:#x}u && {is_element}) {{ state->{name}[{place}] = word; return 1; }}"
            );
        }
        out.push_str("    switch (method) {\n");
        for Words { name, method, .. } in self.words.iter().filter(|words| words.elements.0 * words.words == 1) {
            let _ = writeln!(out, "    case {method:#x}u: state->{name} = word; return 1;");
        }
        out + "    default: return 0;\n    }\n}\n\n"
    }

    /// Returns all functions, each declared before it is called.
    pub(super) fn body(&self, inputs: Mapped) -> String {
        let mut out = String::new();
        for piece in pieces(self.generic.policies) {
            match (inputs, piece.name) {
                (Mapped::Looked, "nb_mapped") => out.push_str(&self.table(&piece)),
                (Mapped::Looked, "nb_mapped_rgb") => {}
                _ => out.push_str(&self.piece(&piece)),
            }
        }
        for part in [operands(inputs), self.stage(), self.fragment(), store()] {
            out.push_str(&part);
            out.push('\n');
        }
        out.truncate(out.trim_end().len());
        out + "\n"
    }

    /// Returns an expression for the word with the number of stages.
    fn config(&self) -> String {
        let chip = self.generic.chip;
        let (word, index) = layout::config(chip);
        if word.count(chip) > 1 { format!("@s.{}[{index}]", word.name()) } else { format!("@s.{}", word.name()) }
    }

    /// Prints the function of a general stage.
    fn stage(&self) -> String {
        let by_most = field(&self.config(), layout::mux_by_msb(self.generic.chip));
        let [ab, cd, sum] = layout::OUTPUTS;
        let (rgb, alpha) = ("out_rgb", "out_alpha");
        let mut out = "/* A general stage: all of it is read, then all of it is written (CMB-1). What is ZERO throughout or has no destination is left out. */\n\
             @fn void nb_stage(@state, @uint stage, @changed)\n{\n"
            .to_string();
        for (name, word) in
            [("in_rgb", Word::RcInRgb), (rgb, Word::RcOutRgb), ("in_alpha", Word::RcInAlpha), (alpha, Word::RcOutAlpha)]
        {
            let _ = writeln!(out, "    @in @uint {name} = @s.{}[stage];", word.name());
        }
        out.push_str("    @int a[3], b[3], ab[3], cd[3], third[3], takes_cd = 0, alpha_ab = 0, alpha_cd = 0;\n");
        out.push_str("    for (@int c = 0; c < 3; c++) cd[c] = 0;\n    for (@int c = 0; c < 3; c++) third[c] = 0;\n");
        let spare0 = code(FinalRegister::Spare0);
        let takes_cd = format!("        takes_cd = nb_takes_cd({by_most}, r[{spare0}][3]);\n");
        let any_alpha = format!("    if (({alpha} & {}u) != 0u) {{\n", ab.put(15) | cd.put(15) | sum.put(15));
        out.push_str(&any_alpha);
        for (n, result) in ["alpha_ab", "alpha_cd"].into_iter().enumerate() {
            let [x, y] = [2 * n, 2 * n + 1].map(|n| field("in_alpha", layout::BYTES[n]));
            let _ = writeln!(out, "        {result} = nb_product(nb_operand({x}, r), nb_operand({y}, r));");
        }
        let _ = writeln!(out, "{takes_cd}    }}");
        let product = |n: usize, result: &str, indent: &str| {
            let [x, y] = [2 * n, 2 * n + 1].map(|n| field("in_rgb", layout::BYTES[n]));
            let dot = field(rgb, layout::DOT_PRODUCTS[n]);
            format!(
                "{indent}nb_operands({x}, r, a);\n{indent}nb_operands({y}, r, b);\n{indent}nb_products({dot}, a, b, {result});\n"
            )
        };
        let any_second = format!("    if (({rgb} & {}u) != 0u) {{\n", cd.put(15) | sum.put(15));
        let read = layout::BYTES[2].put(255) | layout::BYTES[3].put(255);
        let _ = write!(
            out,
            "{}{any_second}        if ((in_rgb & {read}u) != 0u) {{\n{}        }}\n\
             {takes_cd}        for (@int c = 0; c < 3; c++) third[c] = nb_third({}, takes_cd, ab[c], cd[c]);\n    }}\n",
            product(0, "ab", "    "),
            product(1, "cd", "            "),
            field(rgb, layout::MUX)
        );
        out + &stage_outputs([rgb, alpha], &any_alpha)
    }

    /// Prints the loading of the constants of a stage, or of the final combiner, which is skipped if they have not changed.
    fn constants(&self, stage: bool, indent: &str) -> String {
        let chip = self.generic.chip;
        let mut out = String::new();
        for (n, register) in [FinalRegister::ConstantColor0, FinalRegister::ConstantColor1].into_iter().enumerate() {
            let word = match (chip, stage) {
                (Profile::Nv2a, true) => {
                    let word = [Word::RcConstantColor0, Word::RcConstantColor1][n].name();
                    format!("@s.{word}[stage & own{n}]")
                }
                _ => format!("@s.{}[{n}]", Word::RcColor.name()),
            };
            let _ = write!(
                out,
                "{indent}word = {word};\n{indent}if (word != loaded{n}) {{\n{indent}    loaded{n} = word;\n{indent}    nb_color(word, constant);\n\
                 {indent}    for (@int c = 0; c < 4; c++) r[{}][c] = constant[c];\n{indent}}}\n",
                code(register)
            );
        }
        out
    }

    /// Prints the function from inputs to the fragment.
    fn fragment(&self) -> String {
        let given = [
            (FinalRegister::PrimaryColor, "@i.primary[c]"),
            (FinalRegister::SecondaryColor, "@i.secondary[c]"),
            (FinalRegister::Fog, "@i.fog[c]"),
            (FinalRegister::Texture0, "@i.texture[0][c]"),
            (FinalRegister::Texture1, "@i.texture[1][c]"),
            (FinalRegister::Texture2, "@i.texture[2][c]"),
            (FinalRegister::Texture3, "@i.texture[3][c]"),
        ];
        let (chip, config) = (self.generic.chip, self.config());
        // All bits are set if each stage has its own constants, and none if all stages have those of the first.
        let [own0, own1] = layout::OWN_CONSTANTS.map(|each| field(&config, each));
        let own = format!("    @in @uint own0 = 0u - ({own0}), own1 = 0u - ({own1});\n");
        let mut out = format!(
            "@public void nb_fragment(@state, @inputs, @out @int fragment[4])\n{{\n    @int x[3], y[3], a[3], b[3], constant[4];\n    @registers;\n\
             \x20   @in @uint final0 = @s.{}, final1 = @s.{};\n    @uint word, loaded0 = 0u, loaded1 = 0u, stages = {};\n{}    for (@int c = 0; c < 4; c++) {{\n",
            Word::RcFinal0.name(),
            Word::RcFinal1.name(),
            field(&config, layout::stages(chip)),
            if chip == Profile::Nv2a { own } else { String::new() },
        );
        for number in 0..16 {
            let value = given.iter().find(|(register, _)| code(*register) == number).map_or("0", |(_, value)| value);
            let _ = writeln!(out, "        r[{number}][c] = {value};");
        }
        out.push_str("    }\n");
        let spare0 = code(FinalRegister::Spare0);
        for (channel, from) in initial_spare0().into_iter().enumerate() {
            if let Some(from) = from {
                let texture0 = code(FinalRegister::Texture0);
                let _ = writeln!(out, "    r[{spare0}][{channel}] = r[{texture0}][{from}]; /* CMB-13 */");
            }
        }
        let most = self.generic.chip.general_stages();
        let _ = write!(
            out,
            "    if (stages > {most}u) stages = {most}u;\n    for (@uint stage = 0u; stage < stages; stage++) {{\n{}        nb_stage(state, stage, r);\n    }}\n{}",
            self.constants(true, "        "),
            self.constants(false, "    ")
        );
        let secondary = code(FinalRegister::SecondaryColor);
        let [sum, product] = [FinalRegister::Spare0PlusSecondary, FinalRegister::ETimesF].map(code);
        let [e, f, g, _] = layout::BYTES.map(|byte| field("final1", byte));
        let [a, b, c, d] = layout::BYTES.map(|byte| field("final0", byte));
        let inverted = |register: u32, by: Field| format!("nb_final_input({}, r[{register}][c])", field("final1", by));
        // The bits that both codes have; no other register has all of them.
        let both = layout::REGISTER.put(sum & product);
        let lowest = layout::BYTES.iter().fold(0, |all, byte| all | byte.put(both & both.wrapping_neg()));
        let others = (1..both.count_ones()).map(|n| format!("(final0 >> {n}) & ")).collect::<String>();
        let lerp = !layout::BYTES[3].put(255);
        let _ = write!(
            out,
            "    /* Where A to D may read what exists only here: SPARE0 + SECONDARY and E times F. */\n\
             \x20   if ((final0 & {others}{lowest:#x}u) != 0u) {{\n\
             \x20       for (@int c = 0; c < 3; c++) r[{sum}][c] = nb_color_sum({}, {}, {});\n\
             \x20       nb_final_operands({e}, r, x);\n        nb_final_operands({f}, r, y);\n\
             \x20       for (@int c = 0; c < 3; c++) r[{product}][c] = nb_final_product(x[c], y[c]);\n    }}\n\
             \x20   nb_final_operands({d}, r, b);\n    if ((final0 & {lerp:#x}u) != 0u) {{\n\
             \x20       nb_final_operands({a}, r, x);\n        nb_final_operands({b}, r, y);\n        nb_final_operands({c}, r, a);\n\
             \x20       for (@int c = 0; c < 3; c++) fragment[c] = nb_final_rgb(x[c], y[c], a[c], b[c]);\n    }} else {{\n\
             \x20       for (@int c = 0; c < 3; c++) fragment[c] = nb_final_rgb(0, 0, 0, b[c]);\n    }}\n\
             \x20   fragment[3] = nb_final_alpha({g}, r);\n}}\n",
            field("final1", layout::COLOR_SUM_CLAMP),
            inverted(spare0, layout::INVERT_SPARE0),
            inverted(secondary, layout::INVERT_SECONDARY),
        );
        out
    }
}

/// Prints how a general stage writes its outputs, and the end of its function. The words of its portions have these names; `any_alpha` begins what only a
/// portion of alpha needs.
fn stage_outputs([rgb, alpha]: [&str; 2], any_alpha: &str) -> String {
    let mut out = String::new();
    let mut open: Option<(usize, bool)> = None;
    for write in writes() {
        let (output, channel) = match write {
            Write::Channel { output, channel } => (output, channel),
            Write::BlueToAlpha { output } => (output, 2),
        };
        let is_alpha = matches!(write, Write::Channel { channel: 3, .. });
        let word = if is_alpha { alpha } else { rgb };
        let destination = field(word, layout::OUTPUTS[output]);
        let (operation, raw) = (field(word, layout::OPERATION), ["ab", "cd", "third"][output]);
        if open != Some((output, is_alpha)) {
            out.push_str(if open.is_some() { "    }\n" } else { "" });
            // The alpha portion is idle in many stages, so that is tested once for all of its outputs.
            match (open.is_some_and(|(_, alphas)| alphas), is_alpha) {
                (false, true) => out.push_str(any_alpha),
                (true, false) => out.push_str("    }\n"),
                _ => {}
            }
            let _ = writeln!(out, "    if (({destination}) != 0u) {{");
            // The channels of a dot product are equal.
            match layout::DOT_PRODUCTS.get(output).filter(|_| !is_alpha) {
                Some(dot) => {
                    let _ = write!(
                        out,
                        "        if ({}) {{\n            {raw}[0] = nb_output({operation}, {raw}[0]);\n            {raw}[1] = {raw}[0];\n            {raw}[2] = {raw}[0];\n\
                         \x20       }} else {{\n            nb_output_rgb({operation}, {raw});\n        }}\n",
                        is_set(word, *dot)
                    );
                }
                None if is_alpha => {}
                None => _ = writeln!(out, "        nb_output_rgb({operation}, {raw});"),
            }
            open = Some((output, is_alpha));
        }
        let value = match (is_alpha, output) {
            (false, _) => format!("{raw}[{channel}]"),
            (true, 2) => {
                format!("nb_output({operation}, nb_third({}, takes_cd, alpha_ab, alpha_cd))", field(alpha, layout::MUX))
            }
            (true, _) => format!("nb_output({operation}, alpha_{raw})"),
        };
        let (guard, to) = match write {
            Write::Channel { channel, .. } => (String::new(), channel),
            Write::BlueToAlpha { output } => (format!("if ({}) ", is_set(word, layout::BLUE_TO_ALPHA[output])), 3),
        };
        let _ = writeln!(out, "        {guard}r[{destination}][{to}] = {value};");
    }
    let closes = if open.is_some_and(|(_, alphas)| alphas) { "    }\n    }\n}\n" } else { "    }\n}\n" };
    out + closes
}

/// Prints the functions that read inputs.
fn operands(inputs: Mapped) -> String {
    let channel = |is_alpha: bool, portion_alpha: bool, own: usize| {
        component_channel(component(layout::ALPHA.put(is_alpha.into()), portion_alpha), own)
    };
    let (alpha, blue) = (channel(true, false, 0), channel(false, true, 3));
    let register = field("byte", layout::REGISTER);
    let is_alpha = is_set("byte", layout::ALPHA);
    let (mapping, invert) = (field("byte", layout::MAPPING), field("byte", layout::INVERT));
    let one = format!("r[{register}][@select({is_alpha}, {alpha}, {blue})]");
    // The input of an RGB portion, where `of` returns the expression for a channel.
    let all = |of: &dyn Fn(&str) -> String| {
        let each = |channel: &str| format!("for (@int c = 0; c < 3; c++) x[c] = {};", of(channel));
        let (same, own) = (each(&alpha.to_string()), each("c"));
        format!("    if ({is_alpha}) {{\n        {same}\n    }} else {{\n        {own}\n    }}\n")
    };
    let plain = all(&|channel| format!("r[{register}][{channel}]"));
    let looked = format!("nb_mapping[{mapping}][{one} + 256]");
    // One pointer goes to the result of the mapping for 0, another to the register, so that the fields are extracted once for three channels.
    let looked_rgb = format!(
        "    const int16_t *mapped = nb_mapping[{mapping}] + 256;\n    @in @int *given = r[{register}];\n{}",
        all(&|channel| format!("mapped[given[{channel}]]"))
    );
    let (mapped_rgb, mapped) = match inputs {
        Mapped::Computed => {
            (format!("{plain}    nb_mapped_rgb({mapping}, x);\n"), format!("nb_mapped({mapping}, {one})"))
        }
        Mapped::Looked => (looked_rgb, looked),
    };
    format!(
        "/* An input of an RGB portion: register, component, mapping. */\n\
         @fn void nb_operands(@uint byte, @registers, @out @int x[3])\n{{\n{mapped_rgb}}}\n\n\
         /* An input of an alpha portion: {} unless it is {}. */\n\
         @fn @int nb_operand(@uint byte, @registers)\n{{\n    return {mapped};\n}}\n\n\
         /* An input of the final combiner. */\n\
         @fn void nb_final_operands(@uint byte, @registers, @out @int x[3])\n{{\n{plain}    nb_final_input_rgb({invert}, x);\n}}\n\n\
         /* The alpha of the fragment. */\n\
         @fn @int nb_final_alpha(@uint byte, @registers)\n{{\n    return nb_final_input({invert}, {one});\n}}\n",
        channel_name(blue),
        channel_name(alpha),
    )
}

/// Prints the functions from the fragment to the stored word.
fn store() -> String {
    use raster::Method;
    let name = |method: Method| format!("@s.{}", method.name());
    let format = field(&name(Method::SurfaceFormat), raster::SURFACE_COLOR);
    let [tests, compare, reference] = [Method::AlphaTestEnable, Method::AlphaFunc, Method::AlphaRef].map(name);
    let [blends, equation, constant] = [Method::BlendEnable, Method::BlendEquation, Method::BlendColor].map(name);
    let [source, destination] = [Method::BlendFuncSfactor, Method::BlendFuncDfactor].map(name);
    let mask = name(Method::ColorMask);
    let all = raster::COLOR_MASK.iter().fold(0, |all, field| all | field.put(1));
    format!(
        "@public int nb_kept(@state, @in @int fragment[4])\n{{\n    if ({tests} == 0u) return 1;\n    return nb_passes({compare}, fragment[3], @int({reference} & 255u));\n}}\n\n\
         @public @uint nb_stored(@state, @in @int fragment[4], @uint destination)\n{{\n    @uint format = {format}, mask;\n\
         \x20   @int channels[4], source[4], held[4], constant[4], factors[4], other[4];\n\
         \x20   if ({blends} == 0u && ({mask} & {all:#x}u) == {all:#x}u && nb_whole(format) != 0) return nb_packed(format, fragment); /* ROP-6 */\n\
         \x20   mask = nb_write_mask(format, {mask});\n    for (@int c = 0; c < 4; c++) channels[c] = fragment[c];\n\
         \x20   if ({blends} != 0u && nb_blends(format) != 0) {{\n        nb_truncated(format, fragment, source);\n        nb_channels(format, destination, held);\n\
         \x20       nb_color({constant}, constant);\n        nb_blend_factors({source}, source, held, constant, factors);\n        nb_blend_factors({destination}, source, held, constant, other);\n\
         \x20       for (@int c = 0; c < 4; c++) channels[c] = nb_blended({equation}, source[c], held[c], factors[c], other[c]);\n    }}\n\
         \x20   return (destination & ~mask) | (nb_packed(format, channels) & mask); /* ROP-6 */\n}}\n\n\
         @flatten@public @uint nb_pixel(@state, @inputs)\n{{\n    @int fragment[4];\n    nb_fragment(state, inputs, fragment);\n\
         \x20   return @select(nb_kept(state, fragment) != 0, nb_stored(state, fragment, @i.destination), @i.destination);\n}}\n",
    )
}
