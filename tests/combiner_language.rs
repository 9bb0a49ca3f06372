//! Tests the combiner language: combiners survive printing and reading, every text has one printed form, and garbage is refused.
#![allow(clippy::float_arithmetic, clippy::unwrap_used, missing_docs, unreachable_pub, reason = "a test binary")]

use crate::repository::at;
use ninebit_test_support::random_program;
use ninebit_test_support::random_scene;

use ninebit::combiner::registers::Registers;
use ninebit::diagnostic::Diagnostic;
use ninebit::engine::{RenderOptions, render};
use ninebit::limits::Limits;
use ninebit::state::*;
use ninebit_program::text::{parse, print, read};
use ninebit_program::{combiner_calls, pixel_shader};
use ninebit_scene as scene;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

fn refused(text: &str) -> Vec<Diagnostic> {
    read(text).map(|program| panic!("{text} is {program:?}")).unwrap_err()
}

fn codes(text: &str) -> Vec<&'static str> {
    refused(text).iter().map(|finding| finding.code).collect()
}

/// Returns the combiners as they are read back. A program needs at least one general stage on every chip, so a final combiner alone gets a
/// stage that changes nothing.
fn with_a_stage(mut combiners: Combiners) -> Combiners {
    if combiners.stages.is_empty() {
        combiners.stages.push(GeneralStage::idle(combiners.final_combiner.constants));
    }
    combiners
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn any_state_reads_back_from_what_is_printed(combiners in random_program::combiners()) {
        let text = print(&combiners);
        let found = read(&text).unwrap_or_else(|findings| panic!("{text}\n{findings:?}")).combiners;
        let expected = with_a_stage(combiners);
        prop_assert_eq!(&found, &expected, "{}", text);
        prop_assert_eq!(read(&print(&found)).map(|program| program.combiners), Ok(found));
    }

    #[test]
    fn garbage_is_read_or_refused(text in "\\PC{0,80}") {
        if let Err(findings) = read(&text) {
            prop_assert!(!findings.is_empty() && findings.len() <= 65);
        }
    }

    #[test]
    fn shuffled_words_are_read_or_refused(
        words in prop::collection::vec(prop::sample::select(vec![
            "{", "}", "rgb", "alpha", "(", ")", ";", "=", ".", "*", "+", "-", ",", "out", "rgb", "a", "tex0", "spare0", "expand",
            "const0", "bytes", "1", "0.5", "sum", "mux", "lerp", "final_product", "color_sum", "discard", "zero", "blue_to_alpha",
            "scale_by_two", "clamp_color_sum", "unsigned_invert", ".2", "+0.5", "-1.0", "!!TS1.0", "/*", "//", "#", "\n", "!!RC1.0",
        ]), 0..60),
        space in prop::sample::select(vec![" ", ""]),
    ) {
        let text = words.join(space);
        match read(&text) {
            Ok(program) => {
                let normal = print(&program.combiners);
                prop_assert_eq!(read(&normal).unwrap().combiners, with_a_stage(program.combiners));
            }
            Err(findings) => {
                for finding in findings {
                    let span = finding.span.unwrap();
                    prop_assert!(text.get(span.clone()).is_some(), "{:?} in {:?}", span, text);
                }
            }
        }
    }
}

#[test]
fn legal_programs_stay_legal() {
    let mut runner = TestRunner::deterministic();
    let mut stages = 0;
    for _ in 0..300 {
        let scene = random_scene::scene().new_tree(&mut runner).unwrap().current();
        for draw in &scene.draws {
            let text = print(&draw.combiners);
            let program = parse(&text, scene.profile).unwrap_or_else(|findings| panic!("{text}\n{findings:?}"));
            assert_eq!(program.combiners, draw.combiners, "{text}");
            stages += draw.combiners.stages.len();
        }
    }
    assert!(stages > 300, "{stages}");
}

/// Reads a program in the style of the well-known assembler, with its header, real constants and short forms.
#[test]
fn a_program_in_the_common_style() {
    let text = "!!RC1.0
        // diffuse bump mapping
        const1 = (0.2, 0.2, 0.2, 1.0);
        {
            rgb { spare0 = expand(tex0) . expand(tex1); scale_by_two(); }
            alpha { spare0 = tex0; }
        }
        {
            const0 = (1, 1, 0, 0.5);
            rgb {
                discard = unsigned(spare0) * tex1;
                discard = const1;
                spare0.rgb = sum();
            }
        }
        final_product = spare0 * col1.a;
        out.rgb = final_product + spare1;
        out.a = unsigned_invert(zero);";
    let program = parse(text, Profile::Nv2a).unwrap();
    let combiners = &program.combiners;
    assert_eq!(combiners.stages[0].constants, [[0; 4], [51, 51, 51, 255]]);
    assert_eq!(combiners.stages[1].constants, [[255, 255, 0, 128], [51, 51, 51, 255]]);
    let rgb = &combiners.stages[0].rgb;
    assert!(rgb.ab_dot_product && rgb.scale == Scale::Two && rgb.ab_output == Register::Spare0);
    let alpha = &combiners.stages[0].alpha;
    assert_eq!(alpha.inputs[0].component, Component::Alpha);
    assert_eq!(alpha.inputs[0].mapping, InputMapping::SignedIdentity);
    assert_eq!(alpha.inputs[1].mapping, InputMapping::UnsignedInvert);
    let last = &combiners.final_combiner;
    assert_eq!(last.inputs[0].register, FinalRegister::ETimesF);
    assert!(last.inputs[1].register == FinalRegister::Zero && last.inputs[1].invert);
    assert_eq!(last.inputs[3].register, FinalRegister::Spare1);
    assert!(!last.color_sum_clamp);
    assert_eq!(program.warnings.len(), 1, "spare1 is read and not written");
    assert_eq!(read(&print(combiners)).unwrap().combiners, *combiners);
}

#[test]
fn a_point_is_a_component_or_a_dot_product() {
    let stage = |text: &str| {
        read(&format!("{{ rgb {{ spare0 = {text}; }} }} out.rgb = zero;")).unwrap().combiners.stages[0].rgb
    };
    for text in ["tex0 . col0", "tex0.col0", "tex0 .col0", "tex0. col0", "tex0.rgb.col0.rgb"] {
        let rgb = stage(text);
        assert!(rgb.ab_dot_product, "{text}");
        assert_eq!([rgb.inputs[0].component, rgb.inputs[1].component], [Component::Rgb; 2]);
    }
    let rgb = stage("tex0.a.col0.a");
    assert!(rgb.ab_dot_product && rgb.inputs.iter().take(2).all(|input| input.component == Component::Alpha));
    assert!(!stage("tex0.a").ab_dot_product);
}

#[test]
fn without_a_final_combiner_it_is_opengls_initial_one() {
    let combiners = read("{ }").unwrap().combiners;
    assert_eq!(combiners.final_combiner, FinalCombiner::initial([[0; 4]; 2]));
    assert!(combiners.final_combiner.color_sum_clamp);
}

/// The assembler sets G to zero if the text has no `out.a`, and A to D if it has no `out.rgb`.
#[test]
fn an_output_that_is_not_written_is_zero() {
    for text in ["!!RC1.0 { rgb { spare0 = tex0; } } out.rgb = spare0;", "{} out.rgb = spare0;"] {
        let program = read(text).unwrap();
        assert_eq!(program.combiners.final_combiner.g, FinalInput::zero(Component::Alpha), "{text}");
        assert_eq!(program.warnings.iter().map(|finding| finding.code).collect::<Vec<_>>(), ["NB0915"], "{text}");
    }
    let program = read("{} out.a = spare0;").unwrap();
    let last = &program.combiners.final_combiner;
    assert_eq!(last.inputs, [FinalInput::zero(Component::Rgb); 6]);
    assert_eq!((last.g.register, program.warnings[0].code), (FinalRegister::Spare0, "NB0915"));
    assert!(read("{} out.rgb = spare0; out.a = zero;").unwrap().warnings.is_empty());
}

/// As in the assembler, numbers may have signs, and a point without digits on one side. As in the extension, values outside 0.0 to 1.0 are
/// clamped.
#[test]
fn numbers_of_constants() {
    let program = read("const0 = (.2, +0.5, -1.0, 2); const1 = (- 0.0, 1., 0, +1); {}").unwrap();
    assert_eq!(program.combiners.final_combiner.constants, [[51, 128, 0, 255], [0, 255, 0, 255]]);
    assert_eq!(program.warnings.iter().map(|finding| finding.code).collect::<Vec<_>>(), ["NB0916", "NB0916"]);
    assert_eq!(codes("const0 = bytes(-1, 0, 0, 0);"), ["NB0206"]);
    assert_eq!(codes("const0 = (+, 0, 0, 0);"), ["NB0104"]);
}

#[test]
fn the_final_combiner_alone_is_a_program() {
    let program = parse("!!RC1.0 out.rgb = tex0 * col0; out.a = tex0;", Profile::Nv10).unwrap();
    assert_eq!(program.combiners.stages, [GeneralStage::idle([[0; 4]; 2])]);
    assert!(program.warnings.is_empty(), "{:?}", program.warnings);
}

/// A sum means the same with D in front.
#[test]
fn the_addend_stands_on_either_side() {
    let last = |rgb: &str| read(&format!("{{}} out.rgb = {rgb}; out.a = zero;")).unwrap().combiners.final_combiner;
    assert_eq!(last("spare1 + lerp(fog.a, spare0, fog)"), last("lerp(fog.a, spare0, fog) + spare1"));
    assert_eq!(last("spare1 + tex0 * col0"), last("tex0 * col0 + spare1"));
    let sum = last("spare0 + col1");
    assert_eq!(
        (sum.inputs[0].register, sum.inputs[3].register),
        (FinalRegister::Spare0, FinalRegister::SecondaryColor)
    );
}

#[test]
fn no_word_is_suggested_for_itself() {
    for text in [
        "out.rgb = lerp(lerp(zero, zero, zero), zero, zero);",
        "out.rgb = zero + lerp(zero, lerp, zero);",
        "out.a = lerp;",
    ] {
        let finding = &refused(text)[0];
        assert_eq!((finding.code, finding.message.as_str()), ("NB0104", "`lerp` is not an input"), "{text}");
    }
    for name in ["lerp", "out", "rgb", "discard", "sum", "mux", "expand", "bytes", "blue_to_alpha"] {
        for text in
            [format!("{{ rgb {{ spare0 = {name}; }} }}"), format!("{name};"), format!("{{ rgb {{ {name} = tex0; }} }}")]
        {
            for finding in read(&text).map(|_| ()).err().unwrap_or_default() {
                let help = finding.help.unwrap_or_default();
                assert!(!help.contains(&format!("did you mean `{name}`")), "{text}: {help}");
            }
        }
    }
}

#[test]
fn languages_beside_it_are_refused_by_name() {
    for (text, name, help) in [
        ("!!TS1.0\ntexture_2d();", "`!!TS1.0` begins a program of texture shaders", "texture_shader"),
        (" !!VP1.0 MOV o[HPOS], v[OPOS]; END", "`!!VP1.0` begins a program of NV_vertex_program", "vs.1.1"),
        ("!!ARBfp1.0", "`!!ARBfp1.0` begins a program of ARB_fragment_program, of later chips", "CombinerText"),
        ("!!XY", "`!!XY` begins a program of a language that is not known", "!!RC1.0"),
    ] {
        let found = refused(text);
        assert_eq!(found.len(), 1, "{text}");
        assert_eq!((found[0].code, found[0].message.as_str()), ("NB0104", name));
        assert!(found[0].help.as_deref().is_some_and(|text| text.contains(help)), "{found:?}");
    }
}

#[test]
fn findings_have_codes_and_come_together() {
    assert_eq!(codes("{"), ["NB0104"]);
    assert_eq!(codes("}"), ["NB0104"]);
    assert_eq!(codes("{ rgb { spare0 = tex0 * ; } } out.rgb = ;"), ["NB0104", "NB0104"]);
    assert_eq!(codes("{ rgb { spare0 = texx0; spare9 = tex0; } rbg { } }"), ["NB0204", "NB0204", "NB0204"]);
    assert_eq!(codes("{ rgb { spare0 = color_sum; } alpha { spare0.rgb = tex0; } }"), ["NB0313", "NB0311"]);
    assert_eq!(codes("{ rgb { spare0 = -unsigned(tex0); } } out.rgb = expand(tex0);"), ["NB0311", "NB0311"]);
    assert_eq!(codes("const0 = (1, 2, 0, 0); const1 = bytes(256, 0, 0, 0); const0 = (1, 1);"), ["NB0206", "NB0211"]);
    assert_eq!(codes("{ rgb { } rgb { } } out.a = zero; out.a = zero; out.rgb = zero;"), ["NB0364", "NB0364"]);
    assert_eq!(
        codes("{ rgb { discard = zero; discard = zero; discard = zero; discard = sum(); discard = mux(); } }"),
        ["NB0364", "NB0364"]
    );
    assert_eq!(codes("{} clamp_color_sum();"), ["NB0202"]);
    assert_eq!(codes("{} final_product = spare0 * spare0;"), ["NB0202"]);
    assert_eq!(codes("color_sum = spare1 + col1; out.rgb = color_sum;"), ["NB0104"]);
    assert_eq!(codes("{ rgb { scale_by_two(); scale_by_four(); blue(); } }"), ["NB0364", "NB0204"]);
    assert_eq!(refused(&"x; ".repeat(1000)).len(), 64);
    assert_eq!(refused(&"{ ".repeat(1000)).len(), 2);
    assert_eq!(
        refused(&"{ rgb { ((((((((".repeat(1000)).len().min(64),
        refused(&"{ rgb { ((((((((".repeat(1000)).len()
    );
}

#[test]
fn legality_is_that_of_every_language() {
    let codes = |text: &str, profile| -> Vec<&str> {
        let findings = parse(text, profile).map(|program| panic!("{program:?}")).unwrap_err();
        let mut codes: Vec<_> = findings.iter().map(|finding| finding.code).collect();
        assert!(findings.iter().all(|finding| finding.span.is_some()), "{findings:?}");
        codes.sort_unstable();
        codes
    };
    let nv2a = "{ const0 = (1, 0, 0, 1); rgb { spare0 = tex2 . tex3, blue_to_alpha; } alpha { spare1 = col1; } } out.rgb = spare0; out.a = spare0;";
    assert!(parse(nv2a, Profile::Nv2a).unwrap().warnings.is_empty());
    assert_eq!(codes(nv2a, Profile::Nv10), ["NB0302", "NB0302", "NB0303", "NB0304", "NB0309"]);
    let wrong =
        "{ rgb { const0 = tex0.b * fog.a; tex0 = tex0; tex0 = sum(); scale_by_four(); bias_by_negative_one_half(); }
                   alpha { spare0 = tex0.rgb . tex0, blue_to_alpha; } } out.rgb = color_sum.a; out.a = final_product;";
    assert_eq!(
        codes(wrong, Profile::Nv2a),
        ["NB0306", "NB0306", "NB0307", "NB0308", "NB0310", "NB0311", "NB0311", "NB0312", "NB0313", "NB0313"]
    );
    assert_eq!(codes("{} {} {}", Profile::Nv10), ["NB0301"]);
    assert_eq!(codes("", Profile::Nv10), ["NB0323"]);
    let both = "{ rgb { spare0 = tex0 . tex1, blue_to_alpha; } alpha { spare0 = tex0; } }";
    assert_eq!(codes(both, Profile::Nv2a), ["NB0305"]);
}

#[test]
fn the_same_program_in_every_language_draws_the_same_bytes() {
    let frame = |name: &str| {
        let path = at("vectors/scenes/programs").join(name);
        let loaded = scene::load(&path, &Limits::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(loaded.render_warnings(false), "");
        (loaded.scene.draws[0].combiners.clone(), render(&loaded.plan, &RenderOptions::default()))
    };
    let (program, picture) = frame("lit-combiners.ron");
    let (words, words_picture) = frame("lit-words.ron");
    assert!(picture.surfaces[0].words.iter().any(|word| *word != picture.surfaces[0].words[0]));
    assert_eq!(words_picture, picture);
    for name in ["lit-text.ron", "lit-text-file.ron"] {
        let (text, text_picture) = frame(name);
        assert_eq!((&text, &text_picture), (&program, &picture), "{name}");
    }
    assert_eq!(words, program);
}

/// The steps of text to combiners, back to text, and running the result, as code in three languages writes them.
#[test]
fn programs_are_read_printed_and_run_by_code() {
    let text = "{ rgb { spare0 = expand(tex0) . expand(col0); } } out.rgb = unsigned(spare0); out.a = spare0.a;";
    let program = parse(text, Profile::Nv10).expect("a sound program").combiners;
    assert!(program.stages[0].rgb.ab_dot_product);
    assert_eq!(parse(&print(&program), Profile::Nv10).expect("what is printed can be read").combiners, program);
    let mut registers = Registers::new();
    registers.load(Register::Texture0, [128, 128, 255, 255]);
    registers.load(Register::PrimaryColor, [128, 200, 230, 255]);
    assert_eq!(program.run(registers, &Policies::DEFAULT), [203, 203, 203, 255]);

    let text = "glFinalCombinerInputNV(GL_VARIABLE_D_NV, GL_PRIMARY_COLOR_NV, GL_UNSIGNED_IDENTITY_NV, GL_RGB);";
    let program = combiner_calls::parse(text).expect("a sound call").program.combiners;
    assert_eq!(program.final_combiner.inputs[3].register, FinalRegister::PrimaryColor);

    let text = "ps.1.1\ntex t0 // normals\ntex t1\ndp3_sat r1, t0_bx2, v0_bx2\nmul r0, t1, r1";
    let shader = pixel_shader::parse(text).expect("a sound program").program;
    let lowered = pixel_shader::lower(&shader, &pixel_shader::Context::new(Profile::Nv2a)).expect("two general stages");
    assert_eq!(lowered.combiners.stages.len(), 2);
    let printed = pixel_shader::print(&shader);
    assert_eq!(pixel_shader::parse(&printed).map(|again| pixel_shader::print(&again.program)), Ok(printed));
}
