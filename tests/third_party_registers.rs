//! Tests all register words of `vectors/third-party`: which ones the chip accepts, which ones it derives from the state of older
//! interfaces, and their results.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::repository::at;
use std::collections::BTreeSet;
use std::path::Path;

use ninebit::engine::{RenderOptions, render};
use ninebit::legality::check;
use ninebit::limits::Limits;
use ninebit::state::*;
use ninebit_program::Places;
use ninebit_program::registers::{RegisterWords, Word, decode, encode, refusal, stored};
use ninebit_program::text::words::Words;
use ninebit_program::text::{print, read};
use ninebit_scene as scene;

/// Returns the rows of a table as lists of columns.
fn rows(name: &str) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(at("vectors/third-party").join(name)).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split('\t').map(str::to_owned).collect()).collect()
}

fn hex(text: &str) -> u32 {
    u32::from_str_radix(text, 16).unwrap()
}

fn word(name: &str) -> Word {
    match name {
        "rc_in_alpha" => Word::RcInAlpha,
        "rc_in_color" => Word::RcInRgb,
        "rc_out_alpha" => Word::RcOutAlpha,
        "rc_out_color" => Word::RcOutRgb,
        "rc_final_a" => Word::RcFinal0,
        "rc_final_b" => Word::RcFinal1,
        other => panic!("{other}"),
    }
}

/// Returns the words of one stage that shows SPARE0.
fn one_stage() -> RegisterWords {
    let mut words = RegisterWords::new(Profile::Nv10);
    words.set(Word::RcOutRgb, 1, 0x1800_0000);
    words.set(Word::RcFinal0, 0, 0x0000_000c);
    words.set(Word::RcFinal1, 0, 0x0000_1c80);
    words
}

#[test]
fn words_are_taken_and_kept_as_the_chip_does() {
    let document = std::fs::read_to_string(at("docs/evidence/known-differences.md")).unwrap();
    let section = document.split("## Register words").nth(1).unwrap().split("\n## ").next().unwrap();
    let listed: BTreeSet<(String, String)> = section
        .lines()
        .filter(|line| line.starts_with("| rc_"))
        .map(|line| {
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            (cells[1].to_owned(), cells[2].to_owned())
        })
        .collect();
    let mut refused = BTreeSet::new();
    let rows = rows("register-words.tsv");
    assert_eq!(rows.len(), 21);
    for row in rows {
        let [_, name, index, value, accepted, kept] = &row[..] else { panic!("{row:?}") };
        let (word, index, value) = (word(name), index.parse().unwrap(), hex(value));
        let found = refusal(word, index, value, Profile::Nv10);
        assert_eq!(found.is_none(), accepted == "yes", "{row:?}: {found:?}");
        assert_eq!(stored(word, index, value, Profile::Nv10), hex(kept), "{row:?}");
        if found.is_some() {
            continue;
        }
        // A program with this word keeps all of its bits.
        let mut words = one_stage();
        words.set(word, index, value);
        if word == Word::RcInAlpha || word == Word::RcInRgb {
            let output = if word == Word::RcInAlpha { Word::RcOutAlpha } else { Word::RcOutRgb };
            words.set(output, 0, 0xc00);
        }
        let program = decode(&words).unwrap();
        assert_eq!(encode(&program, Profile::Nv10), words, "{row:?}");
        let checked = check(&program, Profile::Nv10, &Places::default(), &Words);
        refused.extend(
            checked.findings.into_iter().map(|finding| (format!("{name} {value:08x}"), finding.code.to_owned())),
        );
    }
    assert_eq!(refused, listed, "docs/evidence/known-differences.md lists what is refused as a program");
}

/// Returns the statements, in the combiner language, of a Direct3D 5 texture blend as its documentation defines it: RGB, then alpha.
fn direct3d5(mode: u32) -> (&'static str, &'static str) {
    match mode {
        1 | 7 => ("unsigned(tex0) * unsigned_invert(zero);", "unsigned(tex0.a) * unsigned_invert(zero.b);"),
        2 => ("unsigned(tex0) * unsigned(col0);", "unsigned(tex0.a) * unsigned_invert(zero.b);"),
        3 => (
            "unsigned(tex0) * unsigned(tex0.a); discard = unsigned(col0) * unsigned_invert(tex0.a);",
            "unsigned(col0.a) * unsigned_invert(zero.b);",
        ),
        4 => ("unsigned(tex0) * unsigned(col0);", "unsigned(tex0.a) * unsigned(col0.a);"),
        5 => (
            "unsigned(col0) * unsigned_invert(zero); discard = unsigned(tex0) * unsigned_invert(zero);",
            "unsigned(col0.a) * unsigned_invert(zero.b); discard = unsigned(col0.a) * unsigned_invert(zero.b);",
        ),
        6 => (
            "unsigned(col0) * unsigned_invert(zero); discard = unsigned(col0) * unsigned(tex0);",
            "unsigned(col0.a) * unsigned_invert(zero.b); discard = unsigned(col0.a) * unsigned_invert(zero.b);",
        ),
        8 => (
            "unsigned(tex0) * unsigned_invert(zero); discard = unsigned(col0) * unsigned_invert(zero);",
            "unsigned(col0.a) * unsigned_invert(zero.b);",
        ),
        other => panic!("{other}"),
    }
}

/// Returns the stage of a Direct3D 5 texture blend.
fn direct3d5_stage(mode: u32) -> GeneralStage {
    let (rgb, alpha) = direct3d5(mode);
    let third = if matches!(mode, 5 | 6) { "mux" } else { "sum" };
    let text = format!(
        "{{ rgb {{ discard = {rgb} spare0 = {third}(); }} alpha {{ discard = {alpha} spare0 = {third}(); }} }}"
    );
    let mut stage = read(&text).unwrap().combiners.stages[0];
    // Inputs that are 0 in the words of the alpha portion mean the blue of ZERO.
    for input in &mut stage.alpha.inputs {
        if *input == CombinerInput::zero(Component::Alpha) {
            input.component = Component::Blue;
        }
    }
    stage
}

/// Returns a portion of a Direct3D 6 combine word, which has four arguments of a byte each, then the operation.
fn direct3d6(state: u32, stage: u32, alpha: bool) -> Portion {
    let inputs = [0, 8, 16, 24].map(|shift| {
        let byte = state >> shift & if shift == 24 { 0x1f } else { 0xff };
        let register = match byte >> 2 {
            1 => Register::Zero,
            2 => Register::ConstantColor1,
            3 => Register::PrimaryColor,
            4 if stage == 0 => Register::Texture0,
            4 => Register::Spare0,
            5 => Register::Texture0,
            6 => Register::Texture1,
            other => panic!("argument {other}"),
        };
        // The alpha portion reads alpha whatever the argument says.
        let component = if alpha || byte >> 1 & 1 == 1 { Component::Alpha } else { Component::Rgb };
        let mapping = [InputMapping::UnsignedIdentity, InputMapping::UnsignedInvert][(byte & 1) as usize];
        CombinerInput { register, component, mapping }
    });
    let (mux, bias, scale) = match state >> 29 {
        1 | 6 => (false, Bias::None, Scale::One),
        2 => (false, Bias::None, Scale::Two),
        3 => (false, Bias::None, Scale::Four),
        4 => (false, Bias::NegativeHalf, Scale::One),
        5 => (true, Bias::None, Scale::One),
        7 => (false, Bias::NegativeHalf, Scale::Two),
        other => panic!("operation {other}"),
    };
    Portion { inputs, sum_output: Register::Spare0, mux, bias, scale, ..Portion::idle(Component::Rgb) }
}

#[test]
fn states_of_older_interfaces_become_the_chips_words_and_back() {
    let rows = rows("register-translations.tsv");
    assert_eq!(rows.len(), 22);
    for row in rows {
        let [_, state, stage, portion, inputs, outputs] = &row[..] else { panic!("{row:?}") };
        let (version, state) = state.split_once(' ').unwrap();
        let stage: u32 = stage.parse().unwrap();
        let alpha = portion == "alpha";
        let wanted = if version == "d3d5" {
            let stage = direct3d5_stage(state.parse().unwrap());
            if alpha { stage.alpha } else { stage.rgb }
        } else {
            direct3d6(hex(state), stage, alpha)
        };
        let [input_word, output_word] =
            if alpha { [Word::RcInAlpha, Word::RcOutAlpha] } else { [Word::RcInRgb, Word::RcOutRgb] };
        let mut words = one_stage();
        words.set(input_word, 0, hex(inputs));
        words.set(output_word, 0, hex(outputs));
        let program = decode(&words).unwrap();
        let found = if alpha { program.stages[0].alpha } else { program.stages[0].rgb };
        assert_eq!(found, wanted, "{row:?}: {}", print(&program));
        assert_eq!(encode(&program, Profile::Nv10), words, "{row:?}");
    }
}

/// The words that are known for all Direct3D 5 modes: the mode, the inputs of alpha and of RGB, and the output word of both.
const DIRECT3D5: [(u32, u32, u32, u32); 8] = [
    (1, 0x1820_0000, 0x0820_0000, 0xc00),
    (2, 0x1820_0000, 0x0804_0000, 0xc00),
    (3, 0x1420_0000, 0x0818_0438, 0xc00),
    (4, 0x1814_0000, 0x0804_0000, 0xc00),
    (5, 0x1420_1420, 0x0420_0820, 0x4c00),
    (6, 0x1420_1420, 0x0420_0408, 0x4c00),
    (7, 0x1820_0000, 0x0820_0000, 0xc00),
    (8, 0x1420_0000, 0x0820_0420, 0xc00),
];

#[test]
fn all_direct3d5_modes_decode_to_their_equations_and_encode_to_their_words() {
    for (mode, alpha, rgb, out) in DIRECT3D5 {
        let mut words = one_stage();
        words.set(Word::RcInAlpha, 0, alpha);
        words.set(Word::RcInRgb, 0, rgb);
        words.set(Word::RcOutAlpha, 0, out);
        words.set(Word::RcOutRgb, 0, out);
        for (fog, specular) in [(false, false), (false, true), (true, false), (true, true)] {
            let source = if specular { 0x0e } else { 0x0c };
            words.set(Word::RcFinal0, 0, if fog { 0x1300_0300 | source << 16 } else { source });
            let program = decode(&words).unwrap();
            let stage = direct3d5_stage(mode);
            assert_eq!(program.stages, [stage], "mode {mode}");
            let shown = if specular { "color_sum" } else { "spare0" };
            let rgb = if fog { format!("out.rgb = lerp(fog.a, {shown}, fog);") } else { format!("out.rgb = {shown};") };
            let text = print(&program);
            assert!(
                text.contains(&rgb) && text.contains("clamp_color_sum();") && text.contains("out.a = spare0.a;"),
                "{text}"
            );
            assert_eq!(encode(&program, Profile::Nv10), words, "mode {mode}");
        }
    }
}

#[test]
fn words_make_of_colours_what_is_expected() {
    let rows = rows("register-results.tsv");
    assert_eq!(rows.len(), 18);
    for row in rows {
        let [_, in_alpha, in_rgb, out_alpha, out_rgb, primary, tex0, expected, tolerance] = &row[..] else {
            panic!("{row:?}")
        };
        let color = |text: &str| text.replace(' ', ", ");
        let text = format!(
            "(version: 1, profile: Nv10, targets: [(name: \"frame\", width: 1, height: 1)], \
             textures: {{ \"t\": (source: Solid(width: 1, height: 1, color: ({}))) }}, \
             draws: [(vertices: Window([(position: (0, 0), diffuse: ({p})), (position: (2, 0), diffuse: ({p})), \
             (position: (0, 2), diffuse: ({p}))]), textures: [\"t\"], program: RegisterWords(nv10: (\
             rc_in_alpha: [0x{in_alpha}], rc_in_rgb: [0x{in_rgb}], rc_out_alpha: [0x{out_alpha}], \
             rc_out_rgb: [0x{out_rgb}, 0x18000000], rc_final0: 0x0000000c, rc_final1: 0x00001c80)))])",
            color(tex0),
            p = color(primary),
        );
        let loaded = scene::parse(&text, Path::new("words.ron"), &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
        let frame = render(&loaded.plan, &RenderOptions::default());
        let [b, g, r, a] = frame.surfaces[0].words[0].to_le_bytes();
        let tolerance: i32 = tolerance.parse().unwrap();
        for (found, expected) in [r, g, b, a].into_iter().zip(expected.split(' ')) {
            let expected: i32 = expected.parse().unwrap();
            assert!((i32::from(found) - expected).abs() <= tolerance, "{row:?}: {:?}", [r, g, b, a]);
        }
    }
}

/// Operations of NV20's texture shader: the code, the operation in a scene, and the texture that the unit needs.
const SHADER_OPERATIONS: [(u32, &str, &str); 19] = [
    (0x00, "None", "Unbound"),
    (0x01, "Sample", "\"flat\""),
    (0x02, "VolumeTexture", "Unbound"),
    (0x03, "Sample", "\"cube\""),
    (0x04, "PassThrough", "Unbound"),
    (0x05, "CullFragment()", "Unbound"),
    (0x06, "BumpEnvironment(matrix: (1, 0, 0, 1))", "\"flat\""),
    (0x07, "BumpEnvironment(matrix: (1, 0, 0, 1), luminance: (1, 0))", "\"flat\""),
    (0x08, "Brdf", "Unbound"),
    (0x09, "DotProduct2D", "\"flat\""),
    (0x0a, "DotProductDepth", "Unbound"),
    (0x0b, "DotReflectDiffuse", "\"cube\""),
    (0x0c, "DotReflectSpecular", "\"cube\""),
    (0x0d, "DotProduct3D", "\"flat\""),
    (0x0e, "DotProductCube", "\"cube\""),
    (0x0f, "DependentAlphaRed", "\"flat\""),
    (0x10, "DependentGreenBlue", "\"flat\""),
    (0x11, "DotProduct", "Unbound"),
    (0x12, "DotReflectConstantEye(eye: (0, 0, 1))", "\"cube\""),
];

#[test]
fn texture_shaders_are_taken_as_the_chip_does() {
    let document = std::fs::read_to_string(at("docs/evidence/known-differences.md")).unwrap();
    let rows = rows("texture-shader-words.tsv");
    assert_eq!(rows.len(), 14);
    for row in rows {
        let [_, value, accepted] = &row[..] else { panic!("{row:?}") };
        let operations = [0, 5, 10, 15].map(|shift| {
            let code = hex(value) >> shift & 31;
            SHADER_OPERATIONS.iter().find(|(known, _, _)| *known == code).unwrap()
        });
        let solid = "Solid(width: 1, height: 1, color: (1, 2, 3))";
        let faces = ["positive_x", "negative_x", "positive_y", "negative_y", "positive_z", "negative_z"];
        let faces = faces.map(|face| format!("{face}: {solid}")).join(", ");
        let text = format!(
            "(version: 1, profile: Nv2a, textures: {{ \"flat\": (source: {solid}), \
             \"cube\": (kind: Cube, source: Faces({faces})) }}, draws: [(vertices: Window([]), textures: [{}], texture_shader: [{}])])",
            operations.map(|(_, _, texture)| *texture).join(", "),
            // Another register selects the earlier unit that is read. The first unit is suitable for all of these.
            operations
                .map(|(code, operation, _)| match code {
                    0x00..=0x05 | 0x08 | 0x0a | 0x0d => (*operation).to_owned(),
                    _ => format!("(operation: {operation}, previous: 0)"),
                })
                .join(", "),
        );
        let found = scene::parse(&text, Path::new("shader.ron"), &Limits::default());
        let listed = document.contains(&format!("| tex_shader_op {value} |"));
        let agree = found.is_ok() == (accepted == "yes");
        assert_eq!(agree, !listed, "{row:?}: {:?}", found.map(|_| ()).map_err(|error| error.to_string()));
    }
}
