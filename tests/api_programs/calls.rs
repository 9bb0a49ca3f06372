//! Tests OpenGL calls as pasted text: register combiners and the texture environment.

use ninebit::diagnostic::Severity;
use ninebit::legality::check;
use ninebit::state::*;
use ninebit_program::texture_environment::{self as environment, Function, Mode, Operand, TextureEnvironment, Unit};
use ninebit_program::texture_environment::{EnvironmentSource as Source, parse as parse_environment};
use ninebit_program::{combiner_calls, text};
use proptest::prelude::*;

fn combiners(text: &str) -> Combiners {
    combiner_calls::parse(text).unwrap_or_else(|findings| panic!("{text}: {findings:?}")).program.combiners
}

fn environment(text: &str) -> TextureEnvironment {
    parse_environment(text).unwrap_or_else(|findings| panic!("{text}: {findings:?}")).program
}

/// The initial state is that of NV_register_combiners, tables 5 and 6.
#[test]
fn without_calls_it_is_the_initial_state() {
    let initial = Combiners {
        stages: vec![GeneralStage::initial([[0; 4]; 2])],
        mux_select: MuxSelect::Msb,
        final_combiner: FinalCombiner::initial([[0; 4]; 2]),
    };
    assert_eq!(combiners(""), initial);
    assert_eq!(
        combiners("glEnable(GL_REGISTER_COMBINERS_NV); /* draw */ glDisable(GL_REGISTER_COMBINERS_NV);"),
        initial
    );
    assert_eq!(environment(""), TextureEnvironment::default());
}

/// The same program, written as calls and in the combiner language, yields the same combiners.
#[test]
fn combiners_by_calls_are_those_of_the_language() {
    let calls = r#"
        static const GLfloat half[4] = { 0.5f, 0.25f, 1, 0 };
        GLint whole[] = { 2147483647, 0, -5, 1073741823 };
        qglCombinerParameteriNV( GL_NUM_GENERAL_COMBINERS_NV, 2 );
        qglCombinerParameterfvNV( GL_CONSTANT_COLOR0_NV, half );
        glCombinerParameterivNV(GL_CONSTANT_COLOR1_NV, &whole[0]);
        glCombinerParameterfNV(GL_COLOR_SUM_CLAMP_NV, 0.0f);
        glCombinerInputNV(GL_COMBINER0_NV, GL_RGB, GL_VARIABLE_A_NV, GL_TEXTURE0_ARB, GL_EXPAND_NORMAL_NV, GL_RGB);
        glCombinerInputNV(GL_COMBINER0_NV, GL_RGB, GL_VARIABLE_B_NV, GL_PRIMARY_COLOR_NV, GL_EXPAND_NEGATE_NV, GL_RGB);
        glCombinerInputNV(GL_COMBINER0_NV, GL_RGB, GL_VARIABLE_C_NV, GL_TEXTURE1_ARB, GL_SIGNED_IDENTITY_NV, GL_ALPHA);
        glCombinerInputNV(GL_COMBINER0_NV, GL_RGB, GL_VARIABLE_D_NV, GL_CONSTANT_COLOR1_NV, GL_HALF_BIAS_NORMAL_NV, GL_RGB);
        glCombinerOutputNV(GL_COMBINER0_NV, GL_RGB, GL_SPARE1_NV, GL_SPARE0_NV, GL_DISCARD_NV, GL_SCALE_BY_TWO_NV,
            GL_BIAS_BY_NEGATIVE_ONE_HALF_NV, GL_TRUE, GL_FALSE, GL_FALSE);
        glCombinerOutputNV(GL_COMBINER0_NV, GL_ALPHA, GL_DISCARD_NV, GL_DISCARD_NV, GL_DISCARD_NV, GL_NONE, GL_NONE, 0, 0, 0);
        for (int i = 0; i < 1; i++) {
            glCombinerInputNV(GL_COMBINER0_NV + 1, GL_RGB, GL_VARIABLE_A_NV, GL_SPARE0_NV, GL_UNSIGNED_IDENTITY_NV, GL_RGB);
        }
        glCombinerInputNV(GL_COMBINER1_NV, GL_RGB, GL_VARIABLE_B_NV, GL_SPARE1_NV, GL_UNSIGNED_INVERT_NV, GL_RGB);
        glCombinerInputNV(GL_COMBINER1_NV, GL_RGB, GL_VARIABLE_C_NV, GL_SPARE1_NV, GL_SIGNED_NEGATE_NV, GL_RGB);
        glCombinerInputNV(GL_COMBINER1_NV, GL_RGB, GL_VARIABLE_D_NV, GL_ZERO, GL_UNSIGNED_INVERT_NV, GL_RGB);
        glCombinerOutputNV(GL_COMBINER1_NV, GL_RGB, GL_DISCARD_NV, GL_DISCARD_NV, GL_SPARE0_NV, GL_NONE, GL_NONE, GL_FALSE, GL_FALSE, GL_TRUE);
        glCombinerInputNV(GL_COMBINER1_NV, GL_ALPHA, GL_VARIABLE_A_NV, GL_SPARE0_NV, GL_UNSIGNED_IDENTITY_NV, GL_BLUE);
        glFinalCombinerInputNV(GL_VARIABLE_A_NV, GL_SPARE0_NV, GL_UNSIGNED_INVERT_NV, GL_ALPHA);
        glFinalCombinerInputNV(GL_VARIABLE_B_NV, GL_E_TIMES_F_NV, GL_UNSIGNED_IDENTITY_NV, GL_RGB);
        glFinalCombinerInputNV(GL_VARIABLE_C_NV, GL_SPARE0_PLUS_SECONDARY_COLOR_NV, GL_UNSIGNED_IDENTITY_NV, GL_RGB);
        glFinalCombinerInputNV(GL_VARIABLE_D_NV, GL_FOG, GL_UNSIGNED_IDENTITY_NV, GL_RGB);
        glFinalCombinerInputNV(GL_VARIABLE_E_NV, GL_SECONDARY_COLOR_NV, GL_UNSIGNED_IDENTITY_NV, GL_RGB);
        glFinalCombinerInputNV(GL_VARIABLE_F_NV, GL_CONSTANT_COLOR0_NV, GL_UNSIGNED_IDENTITY_NV, GL_RGB);
        glFinalCombinerInputNV(GL_VARIABLE_G_NV, GL_SPARE1_NV, GL_UNSIGNED_IDENTITY_NV, GL_BLUE);
    "#;
    let language = "
        const0 = bytes(128, 64, 255, 0);
        const1 = bytes(255, 0, 0, 127);
        {
            rgb {
                spare1 = expand(tex0) . -expand(col0);
                spare0 = tex1.a * half_bias(const1);
                bias_by_negative_one_half_scale_by_two();
            }
            alpha { discard = unsigned(col0) * unsigned_invert(zero.a); }
        }
        {
            rgb {
                discard = unsigned(spare0) * unsigned_invert(spare1);
                discard = -spare1 * unsigned_invert(zero);
                spare0 = mux();
            }
            alpha {
                discard = unsigned(spare0.b) * unsigned_invert(zero.a);
                discard = unsigned(zero.a) * unsigned(zero.a);
                spare0 = sum();
            }
        }
        final_product = col1 * const0;
        out.rgb = lerp(unsigned_invert(spare0.a), final_product, color_sum) + fog;
        out.a = spare1.b;";
    let (found, expected) = (combiners(calls), text::read(language).unwrap().combiners);
    assert_eq!(found, expected, "{}", text::print(&found));
}

#[test]
fn constants_of_stages_need_their_switch() {
    let set = "glCombinerStageParameterfvNV(GL_COMBINER0_NV, GL_CONSTANT_COLOR1_NV, {1, 0, 0, 1});";
    let pasted = combiner_calls::parse(set).unwrap();
    assert_eq!(pasted.program.combiners.stages[0].constants, [[0; 4]; 2]);
    assert_eq!(pasted.asides.len(), 1);
    let both = format!("glEnable(GL_PER_STAGE_CONSTANTS_NV); {set}");
    let program = combiner_calls::parse(&both).unwrap().program;
    assert_eq!(program.combiners.stages[0].constants[1], [255, 0, 0, 255]);
    let found = check(&program.combiners, Profile::Nv10, &program.places, &combiner_calls::Words).findings;
    assert_eq!(found.iter().map(|finding| finding.code).collect::<Vec<_>>(), ["NB0303"]);
    assert!(found[0].span.is_some());
}

#[test]
fn the_environment_by_calls() {
    let text = r#"
        float color[] = { 1.0f, 0.5f, 0.0f, 2.0f };
        glActiveTextureARB(GL_TEXTURE1_ARB);
        glEnable(GL_TEXTURE_2D);
        glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_COMBINE4_NV);
        glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_RGB_EXT, GL_ADD_SIGNED_EXT);
        glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_ALPHA_EXT, GL_ADD);
        glTexEnvi(GL_TEXTURE_ENV, GL_SOURCE3_RGB_NV, GL_TEXTURE0_ARB);
        glTexEnvi(GL_TEXTURE_ENV, GL_OPERAND3_RGB_NV, GL_ONE_MINUS_SRC_ALPHA);
        glTexEnvf(GL_TEXTURE_ENV, GL_RGB_SCALE_EXT, 4.0f);
        glTexEnvi(GL_TEXTURE_ENV, GL_ALPHA_SCALE, 2);
        glTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, color);
        glActiveTexture(GL_TEXTURE0 + 0);
        glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_COMBINE);
        glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_RGB, GL_DOT3_RGB_EXT);
        glTexEnvi(GL_TEXTURE_ENV, GL_SRC1_ALPHA, GL_PRIMARY_COLOR);
        glLightModeli(GL_LIGHT_MODEL_COLOR_CONTROL, GL_SEPARATE_SPECULAR_COLOR);
        glBindTexture(GL_TEXTURE_2D, name);
    "#;
    let program = environment(text);
    assert!(program.color_sum);
    let [first, second] = &program.units[..] else { panic!("{program:?}") };
    assert_eq!((first.mode, first.rgb.function.value), (Mode::Combine, Function::Dot3RgbExt));
    assert_eq!(first.alpha.sources[1].value, Source::PrimaryColor);
    assert_eq!(second.mode, Mode::Combine4);
    assert_eq!((second.rgb.function.value, second.alpha.function.value), (Function::AddSigned, Function::Add));
    assert_eq!(
        (second.rgb.sources[3].value, second.rgb.operands[3].value),
        (Source::Texture0, Operand::OneMinusSourceAlpha)
    );
    assert_eq!((second.rgb.scale, second.alpha.scale), (Scale::Four, Scale::Two));
    assert_eq!(second.color, [255, 128, 0, 255]);
    for (name, function) in [("GL_DOT3_RGB_ARB", Function::Dot3RgbArb), ("GL_DOT3_RGBA", Function::Dot3RgbaArb)] {
        let program = environment(&format!("glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_RGB_ARB, {name});"));
        assert_eq!(program.units[0].rgb.function.value, function);
        assert_eq!(program.units[0].mode, Unit::initial().mode);
    }
}

#[test]
fn findings_point_at_words_and_say_what_was_meant() {
    let combiner: fn(&str) -> Vec<_> = |text| combiner_calls::parse(text).unwrap_err();
    let environment: fn(&str) -> Vec<_> = |text| parse_environment(text).unwrap_err();
    for (parse, text, code, marked, help) in [
        (
            combiner,
            "glFinalCombinerInputNV(GL_VARIABLE_D_NV, GL_SPAR0_NV, GL_UNSIGNED_IDENTITY_NV, GL_RGB);",
            "NB0204",
            "GL_SPAR0_NV",
            "GL_SPARE0",
        ),
        (
            combiner,
            "glFinalCombinerInputNV(GL_VARIABLE_D_NV, GL_SPARE0_NV, GL_EXPAND_NORMAL_NV, GL_RGB);",
            "NB0311",
            "GL_EXPAND_NORMAL_NV",
            "general stage",
        ),
        (
            combiner,
            "glCombinerInputNV(GL_COMBINER0_NV, GL_RGB, GL_VARIABLE_A_NV, GL_E_TIMES_F_NV, GL_SIGNED_NEGATE_NV, GL_RGB);",
            "NB0313",
            "GL_E_TIMES_F_NV",
            "glFinalCombinerInputNV",
        ),
        (combiner, "glCombinerParameteriNV(GL_NUM_GENERAL_COMBINERS_NV, 9);", "NB0206", "9", "1 to 8"),
        (combiner, "glCombinerParameteriNV(GL_NUM_GENERAL_COMBINERS_NV);", "NB0211", "glCombinerParameteriNV", "all"),
        (combiner, "glCombinerParameterfvNV(GL_CONSTANT_COLOR0_NV, light);", "NB0205", "light", "GLfloat color[4]"),
        (combiner, "glCombinerParameterfvNV(GL_CONSTANT_COLOR0_NV, {1, 0});", "NB0211", "{1, 0}", "GLfloat"),
        (combiner, "glCombinerInptNV(1);", "NB0204", "glCombinerInptNV", "CombinerInputNV"),
        (environment, "glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_RGB, GL_MODULAT);", "NB0204", "GL_MODULAT", "GL_MODULATE"),
        (environment, "glTexEnvi(GL_TEXTURE_ENV, GL_RGB_SCALE, 3);", "NB0206", "3", "4.0"),
        (environment, "glActiveTexture(GL_TEXTURE7);", "NB0206", "GL_TEXTURE7", "GL_TEXTURE3"),
        (environment, "glTexEnvi(GL_TEXTURE, GL_RGB_SCALE, 2);", "NB0205", "GL_TEXTURE", "GL_TEXTURE_ENV"),
    ] {
        let found = parse(text);
        assert_eq!(found.len(), 1, "{text}: {found:?}");
        assert_eq!((found[0].code, &text[found[0].span.clone().unwrap()]), (code, marked), "{text}");
        assert!(found[0].help.as_deref().is_some_and(|text| text.contains(help)), "{text}: {found:?}");
    }
}

#[test]
fn what_is_not_the_program_is_told_once() {
    let text = "glEnable(GL_BLEND); glBlendFunc(GL_ONE, GL_ONE); glEnable(GL_LIGHTING); glEnable(GL_LIGHTING); glVertex3f(0, 0, 0);\n\
                glDisable(GL_FOG); glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_ADD);";
    let pasted = combiner_calls::parse(text).unwrap();
    let said: Vec<_> =
        pasted.asides.iter().map(|aside| (&text[aside.finding.span.clone().unwrap()], aside.field)).collect();
    assert_eq!(
        said,
        [
            ("GL_BLEND", Some("blend")),
            ("glBlendFunc", None),
            ("GL_LIGHTING", None),
            ("glVertex3f", None),
            ("glTexEnvi", None)
        ]
    );
}

const WORDS: &[&str] = &[
    "glCombinerInputNV",
    "glCombinerOutputNV",
    "glFinalCombinerInputNV",
    "glCombinerParameterfvNV",
    "glCombinerParameteriNV",
    "glCombinerStageParameterfvNV",
    "glTexEnvi",
    "glTexEnvfv",
    "glActiveTexture",
    "glEnable",
    "GL_COMBINER0_NV",
    "GL_RGB",
    "GL_ALPHA",
    "GL_VARIABLE_A_NV",
    "GL_SPARE0_NV",
    "GL_TEXTURE0",
    "GL_UNSIGNED_INVERT_NV",
    "GL_NONE",
    "GL_TRUE",
    "GL_DISCARD_NV",
    "GL_CONSTANT_COLOR0_NV",
    "GL_NUM_GENERAL_COMBINERS_NV",
    "GL_TEXTURE_ENV",
    "GL_TEXTURE_ENV_MODE",
    "GL_COMBINE4_NV",
    "GL_SOURCE0_RGB",
    "GL_PER_STAGE_CONSTANTS_NV",
    "if",
    "FAILED",
    "return",
    "float",
    "c",
    "#define",
    "(",
    ")",
    "(",
    ")",
    ",",
    ",",
    ";",
    "{",
    "}",
    "[",
    "]",
    "=",
    "+",
    "|",
    "&",
    "*",
    "<",
    ">",
    "->",
    ".",
    ":",
    "-",
    "1",
    "0.5f",
    "0x10",
    "99999999999",
    "\"",
    "\n",
    "/*",
    "//",
    "\u{e4}",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Any sequence of tokens is either read or refused with places inside the text, and a program that is read either becomes combiners or
    /// is refused.
    #[test]
    fn nothing_makes_them_fail(words in prop::collection::vec(prop::sample::select(WORDS), 0..60), space in prop::sample::select(vec![" ", ""])) {
        let text = words.join(space);
        let inside = |finding: &ninebit::diagnostic::Diagnostic| finding.span.clone().is_some_and(|span| text.get(span).is_some());
        match combiner_calls::parse(&text) {
            Ok(pasted) => {
                prop_assert!(pasted.asides.iter().all(|aside| inside(&aside.finding) && aside.finding.severity == Severity::Warning));
                prop_assert!((1..=8).contains(&pasted.program.combiners.stages.len()));
                let found = check(&pasted.program.combiners, Profile::Nv10, &pasted.program.places, &combiner_calls::Words);
                prop_assert!(found.findings.iter().all(|finding| finding.span.as_ref().is_none_or(|span| text.get(span.clone()).is_some())));
            }
            Err(findings) => prop_assert!(!findings.is_empty() && findings.iter().all(inside)),
        }
        match parse_environment(&text) {
            Ok(pasted) => {
                prop_assert!(pasted.asides.iter().all(|aside| inside(&aside.finding)));
                let context = environment::Context {
                    profile: Profile::Nv2a,
                    textures: [Some(environment::BaseFormat::Rgba); 4],
                    signed: [false; 4],
                    fog: false,
                };
                if let Err(findings) = environment::lower(&pasted.program, &context) {
                    prop_assert!(!findings.is_empty());
                }
            }
            Err(findings) => prop_assert!(!findings.is_empty() && findings.iter().all(inside)),
        }
    }
}
