//! Prints whole pixels of every draw as one text: the state of a draw is words that are read while it runs.
//!
//! [`frame`], [`mod@unit`] and [`stage`] make the pieces, by reading the rules of a draw's function for each value of a field. `pixel.text` passes
//! values from one piece to the next.

mod frame;
mod reader;
mod stage;
mod unit;

use ninebit::state::*;
use ninebit_program::registers::layout::Field as Bits;
use ninebit_program::registers::unit as words;

use super::pieces::{Maker, Piece};
use super::print::pieces_text;
use super::text::{Mapped, Printer, field};
use super::translation::{global, replaced, translated};
use super::{Generic, Sources};
use crate::code::Line;
use crate::draw::QUAD;
use crate::input::{Input, Local};
use crate::language::{ABOUT, Language, STRUCTURES, TRIANGLES, shared, statements};
use crate::number::Number;
use crate::order::Block;
use crate::setup::{Setup, SetupState};
use crate::triangle::{ANY_UNIT, Field, Part};
use crate::truth::Truth;

/// The codes of stages, with their names in the text.
const STAGES: [(&str, u32, ShaderOperation); 16] = {
    use ShaderOperation as Op;
    [
        ("STAGE_TWO", words::STAGE_TWO, Op::Sample),
        ("STAGE_THREE", words::STAGE_THREE, Op::Sample),
        ("STAGE_CUBE", words::STAGE_CUBE, Op::Sample),
        ("STAGE_PASS_THROUGH", words::STAGE_PASS_THROUGH, Op::PassThrough),
        ("STAGE_CULL", words::STAGE_CULL, Op::CullFragment { drops_not_negative: [false; 4] }),
        ("STAGE_BUMP", words::STAGE_BUMP, Op::BumpEnvironment { matrix: [0.0; 4], luminance: None }),
        (
            "STAGE_BUMP_LUMINANCE",
            words::STAGE_BUMP_LUMINANCE,
            Op::BumpEnvironment { matrix: [0.0; 4], luminance: None },
        ),
        ("STAGE_DOT_2D", words::STAGE_DOT_2D, Op::DotProduct2D),
        ("STAGE_REFLECT_DIFFUSE", words::STAGE_REFLECT_DIFFUSE, Op::DotReflectDiffuse),
        ("STAGE_REFLECT_SPECULAR", words::STAGE_REFLECT_SPECULAR, Op::DotReflectSpecular),
        ("STAGE_DOT_3D", words::STAGE_DOT_3D, Op::DotProduct3D),
        ("STAGE_DOT_CUBE", words::STAGE_DOT_CUBE, Op::DotProductCube),
        ("STAGE_ALPHA_RED", words::STAGE_ALPHA_RED, Op::DependentAlphaRed),
        ("STAGE_GREEN_BLUE", words::STAGE_GREEN_BLUE, Op::DependentGreenBlue),
        ("STAGE_DOT", words::STAGE_DOT, Op::DotProduct),
        ("STAGE_REFLECT_CONSTANT", words::STAGE_REFLECT_CONSTANT, Op::DotReflectConstantEye { eye: [0.0; 3] }),
    ]
};

/// The fields of words, with their names in the text.
const FIELDS: [(&str, Bits); 30] = [
    ("ENABLE", words::ENABLE),
    ("CUBE", words::CUBE),
    ("BORDER_COLOR", words::BORDER_COLOR),
    ("DIMENSIONS", words::DIMENSIONS),
    ("FORMAT", words::FORMAT),
    ("LEVELS", words::LEVELS),
    ("SIZES0", words::SIZES[0]),
    ("SIZES1", words::SIZES[1]),
    ("SIZES2", words::SIZES[2]),
    ("RECTANGLE0", words::RECTANGLE[0]),
    ("RECTANGLE1", words::RECTANGLE[1]),
    ("MODES0", words::MODES[0]),
    ("MODES1", words::MODES[1]),
    ("MODES2", words::MODES[2]),
    ("COLOR_KEY", words::COLOR_KEY),
    ("ANISOTROPY", words::ANISOTROPY),
    ("MAX_LOD", words::MAX_LOD),
    ("MIN_LOD", words::MIN_LOD),
    ("LOD_BIAS", words::LOD_BIAS),
    ("MIN_FILTER", words::MIN_FILTER),
    ("MAG_FILTER", words::MAG_FILTER),
    ("PREVIOUS0", words::PREVIOUS[0]),
    ("PREVIOUS1", words::PREVIOUS[1]),
    ("STENCIL_WRITE", words::STENCIL_WRITE),
    ("FLOAT_DEPTH", words::FLOAT_DEPTH),
    ("W_BUFFER", words::W_BUFFER),
    ("PERSPECTIVE", words::PERSPECTIVE),
    ("CONVERSION", words::CONVERSION),
    ("CLAMPS_DEPTH", words::CLAMPS_DEPTH),
    ("SURFACE_DEPTH", words::SURFACE_DEPTH),
];

/// Returns the bits of the codes of stages of which `of` holds.
fn mask(of: impl Fn(&ShaderOperation) -> bool) -> u32 {
    STAGES.iter().filter(|(.., operation)| of(operation)).map(|(_, code, _)| 1 << code).sum()
}

/// Returns the constants of the text.
fn constants() -> Vec<(String, u32)> {
    let code =
        |all: &[(AddressMode, u32)], mode| all.iter().find(|(other, _)| *other == mode).map_or(0, |(_, code)| *code);
    let [cube_mode, _] = reader::planned(TextureKind::Cube, TextureFormat::A8R8G8B8).modes();
    let linear = words::MAG_FILTERS.iter().find(|(filter, _)| *filter == Filter::Linear).map_or(0, |(_, code)| *code);
    let mut all = vec![
        ("STAGE_BITS", words::STAGE_BITS),
        ("STAGE_MASK", (1 << words::STAGE_BITS) - 1),
        ("MAPPING_BITS", words::MAPPING_BITS),
        ("MAPPING_MASK", (1 << words::MAPPING_BITS) - 1),
        ("CLIP_BITS", words::CLIP_BITS),
        ("SAMPLING", mask(ShaderOperation::samples)),
        ("DOTS", mask(ShaderOperation::is_dot)),
        ("CUBE_MODE", code(&words::ADDRESS_MODES, cube_mode)),
        ("MAG_LINEAR", linear),
        ("BIAS_SIGN", 1 << (words::LOD_BIAS.bits - 1)),
        ("SPRITE_UNIT", SPRITE_UNIT as u32),
    ];
    all.extend(STAGES.iter().map(|(name, code, _)| (*name, *code)));
    all.extend(unit::WAYS.iter().map(|(way, name, _)| (*name, *way as u32)));
    // A name that begins with another comes first.
    all.sort_by_key(|(name, _)| std::cmp::Reverse(name.len()));
    all.into_iter().map(|(name, value)| (format!("${name}"), value)).collect()
}

/// Returns the text with the numbers of its fields and codes.
fn numbered(text: &str) -> String {
    let signed = words::SIGNED.iter().enumerate().map(|(n, bits)| (format!("SIGNED{n}"), *bits));
    let fields = FIELDS.iter().map(|(name, bits)| (name.to_string(), *bits)).chain(signed);
    let text = fields.fold(text.to_string(), |text, (name, bits)| {
        replaced(&text, &format!("${name}("), |word| format!("({})", field(word, bits)))
    });
    let text = replaced(&text, "$QUAD(", |at| format!("({at} & {QUAD})"));
    constants().into_iter().fold(text, |text, (name, value)| text.replace(&name, &format!("{value}u")))
}

fn pieces(generic: &Generic) -> Vec<Piece> {
    let maker = Maker { policies: generic.policies, block: Block::Raster };
    [frame::pieces(&maker), unit::pieces(&maker), stage::pieces(&maker)].into_iter().flatten().collect()
}

/// The fields that set-up makes once, and those of each unit.
fn fields() -> [Vec<Field>; 2] {
    let is_once = |field: &Field| !matches!(field, Field::Coordinate(..));
    let of_unit = (0..4).flat_map(|n| Part::ALL.map(|part| Field::Coordinate(ANY_UNIT, n, part))).collect();
    [Field::all().into_iter().filter(is_once).collect(), of_unit]
}

fn set_ups(generic: &Generic) -> [Setup; 2] {
    fields().map(|fields| {
        Setup::of_any(generic.chip, &fields, |code| {
            let given = |name, range| {
                let local = Local { name, kind: crate::code::Kind::Number, range };
                Number::new(code, code.input(Input::Local(local), range))
            };
            let flag =
                |name| Truth::new(code, given(name, (0, 1)).compared(CompareFunction::NotEqual, Number::Constant(0)));
            let fixed_fog = given("fixed_fog", (-1, 255));
            SetupState { holds_w: flag("holds_w"), perspective: flag("perspective"), is_far: false, fixed_fog }
        })
    })
}

const DECLARATIONS: &str = "/* Words of units, fog, depth and stencil are those of the NV20 class, whichever the chip. Of fog with mode 0 the vertices have factors. A unit
   without a texture, or whose stage in SHADER_STAGE_PROGRAM is 0, is off. Windows, patterns, clipping and culling are whoever draws', and so is
   what a depth range does to whole triangles. */

/* Sets up a triangle. Its offset (DEP-5) and its point are 0 and none: whoever draws sets them. */
void nb_set_up(const struct nb_state *state, const struct ninebit_vertex vertex[3], struct ninebit_triangle *triangle);
/* Whether a triangle covers a pixel (RAS-2, RAS-3). */
int nb_covers(const struct ninebit_triangle *triangle, int32_t x, int32_t y);
/* Draws a pixel that a triangle covers. `texture` has the memories of the four units: one word for each texel, level after level, face after face,
   row by row, palettes looked up and blocks decoded to A8R8G8B8. *word and *depth, which has the stencil in its upper byte, become what the
   surface and its depth buffer hold. 0 where the fragment is dropped; its stencil may change nevertheless. */
int nb_draw_pixel(const struct nb_state *state, const struct ninebit_triangle *triangle, const uint32_t *const texture[4], int32_t x, int32_t y,
    uint32_t *word, uint32_t *depth);
";

pub(super) fn c99(generic: &Generic) -> Sources {
    let printer = Printer::whole(generic, Language::C99);
    let pieces = pieces(generic);
    let [once, of_unit] = set_ups(generic);
    let lines = || lines(&pieces).chain(&once.lines).chain(&of_unit.lines);
    let header = printer.header("Whole pixels", "NINEBIT_PIXELS_H", STRUCTURES, DECLARATIONS);
    let (once, of_unit) = (statements(&once), statements(&of_unit).replace("\n    ", "\n        "));
    let bit = |name: &str| numbered(&format!("(int32_t)(${name}(state->control0))"));
    let set_up = format!(
        "void nb_set_up(const struct nb_state *state, const struct ninebit_vertex vertex[3], struct ninebit_triangle *triangle)\n{{\n    \
         const int32_t perspective = {}, holds_w = {}, fixed_fog = nb_fixed_fog(state->fog_mode);\n{once}    \
         for (uint32_t unit = 0u; unit < 4u; unit++) {{\n        {}    }}\n}}\n\n\
         int nb_covers(const struct ninebit_triangle *triangle, int32_t x, int32_t y) {{ return ninebit_covers(triangle, x, y); }}\n\n",
        bit("PERSPECTIVE"),
        bit("W_BUFFER"),
        of_unit.trim_start().trim_end_matches(' '),
    );
    let source = printer.source("ninebit_pixels.h", &shared(Language::C99, lines))
        + "static inline uint32_t nb_texel(const uint32_t *const texture[4], uint32_t unit, int32_t at) { return texture[unit][at]; }\n\n"
        + &translated(&pieces_text(&printer, &pieces), Language::C99)
        + &set_up
        + &translated(&numbered(include_str!("pixel.text")), Language::C99);
    Sources { header, source, name: "ninebit_pixels" }
}

pub(super) fn shader(generic: &Generic, language: Language) -> String {
    let printer = Printer::whole(generic, language);
    let pieces = pieces(generic);
    let calls = format!("{ABOUT}{}\n", shared(language, || lines(&pieces)));
    let text =
        printer.body(Mapped::Computed) + "\n" + &pieces_text(&printer, &pieces) + &numbered(include_str!("pixel.text"));
    let before = match language {
        Language::Wgsl => calls + VARIABLES,
        _ => calls + TRIANGLES + BUFFERS,
    };
    printer.shader("Whole pixels", "GLSL 4.30 and GLSL ES 3.10", &before) + &translated(&global(&text), language)
}

const VARIABLES: &str =
    "// Variables of the host: ninebit_triangles, an array of NinebitTriangle, and ninebit_state, a NinebitState.
fn nb_long(word: u32) -> vec2<u32> { return vec2<u32>(word, 0u); }

";

const BUFFERS: &str = "layout(std430, binding = 2) readonly buffer NinebitDraw { NinebitState ninebit_state; };
uvec2 nb_long(uint word) { return uvec2(word, 0u); }

";

fn lines(pieces: &[Piece]) -> impl Iterator<Item = &Line> {
    pieces.iter().flat_map(|piece| &piece.cases).flat_map(|case| &case.lines)
}
