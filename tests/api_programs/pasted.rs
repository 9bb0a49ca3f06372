//! Tests texture stages as pasted text.

use super::Choices;
use super::direct3d::stages;
use ninebit::state::Named;
use ninebit_program::texture_stages::{ArgumentSource, Operation, ResultArgument, StageArgument, TextureStages, parse};
use proptest::prelude::*;
use std::fmt::Write;

/// The notation of a text: calls with names, calls with numbers, or an effect file.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Calls,
    Numbers,
    Effect,
}

fn upper(name: &str) -> String {
    let name = if name.starts_with("Modulate") { name.replace("Add", "_Add") } else { name.to_owned() };
    name.to_uppercase()
}

fn argument(argument: &StageArgument, form: Form) -> String {
    let number = ArgumentSource::ALL.iter().position(|source| *source == argument.source).unwrap()
        + if argument.complement { 16 } else { 0 }
        + if argument.alpha_replicate { 32 } else { 0 };
    let name = if argument.source == ArgumentSource::TextureFactor { "TFactor" } else { argument.source.name() };
    let mut words = vec![name];
    words.extend(argument.complement.then_some("Complement"));
    words.extend(argument.alpha_replicate.then_some("AlphaReplicate"));
    match form {
        Form::Numbers => format!("{number:#x}"),
        Form::Calls => words.iter().map(|word| format!("D3DTA_{}", upper(word))).collect::<Vec<_>>().join(" | "),
        Form::Effect => words.join("|"),
    }
}

fn operation(operation: Operation, form: Form) -> String {
    match form {
        Form::Numbers => (1 + Operation::ALL.iter().position(|known| *known == operation).unwrap()).to_string(),
        Form::Calls => format!("D3DTOP_{}", upper(operation.name())),
        Form::Effect => operation.name().to_owned(),
    }
}

fn text(program: &TextureStages, form: Form) -> String {
    let mut text = String::from("/* pasted */\n");
    let set = |text: &mut String, stage: usize, state: &str, value: String| {
        let _ = match form {
            Form::Effect => writeln!(text, "{state}[{stage}] = {value};"),
            _ => writeln!(
                text,
                "  pDev->SetTextureStageState ({stage},D3DTSS_{}, {value} ) ; // set",
                state.to_uppercase()
            ),
        };
    };
    for (index, stage) in program.stages.iter().enumerate() {
        for (name, half) in [("Color", &stage.color), ("Alpha", &stage.alpha)] {
            set(&mut text, index, &format!("{name}Op"), operation(half.operation.value, form));
            for (slot, value) in half.arguments.iter().enumerate() {
                set(&mut text, index, &format!("{name}Arg{slot}"), argument(&value.value, form));
            }
        }
        let result = match (stage.result, form) {
            (ResultArgument::Current, Form::Numbers) => "1",
            (ResultArgument::Temp, Form::Numbers) => "5",
            (ResultArgument::Current, Form::Calls) => "D3DTA_CURRENT",
            (ResultArgument::Temp, Form::Calls) => "D3DTA_TEMP",
            (result, Form::Effect) => result.name(),
        };
        set(&mut text, index, "ResultArg", result.to_owned());
        let [r, g, b, a] = stage.constant;
        set(&mut text, index, "Constant", format!("0x{a:02x}{r:02X}{g:02x}{b:02x}"));
    }
    let [r, g, b, a] = program.texture_factor;
    let _ = match form {
        Form::Effect => write!(
            text,
            "TextureFactor = 0x{a:02x}{r:02x}{g:02x}{b:02x}; SpecularEnable = {};",
            program.specular_enable
        ),
        Form::Calls => write!(
            text,
            "hr = g_dev.SetRenderState(D3DRS_TEXTUREFACTOR, D3DCOLOR_ARGB({a}, {r}, {g}, {b}))\n;;\
             IDirect3DDevice7_SetRenderState(dev, D3DRENDERSTATE_SPECULARENABLE, {})",
            if program.specular_enable { "TRUE" } else { "FALSE" }
        ),
        Form::Numbers => write!(
            text,
            "d->SetRenderState(60, (DWORD)0x{a:02x}{r:02x}{g:02x}{b:02x}UL);d->SetRenderState(29,{})",
            u32::from(program.specular_enable)
        ),
    };
    text
}

/// Returns the program without the places in its text, so that programs from different texts compare equal.
fn bare(mut program: TextureStages) -> TextureStages {
    for stage in &mut program.stages {
        stage.span = 0..0;
        for half in [&mut stage.color, &mut stage.alpha] {
            half.operation.span = 0..0;
            half.arguments.iter_mut().for_each(|argument| argument.span = 0..0);
        }
    }
    program
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read(seed in any::<u64>()) {
        let program = stages(&mut Choices::new(seed), 8);
        for form in [Form::Calls, Form::Numbers, Form::Effect] {
            let text = text(&program, form);
            let read = parse(&text).map(|pasted| bare(pasted.program));
            prop_assert_eq!(read.as_ref(), Ok(&program), "{}", text);
        }
    }

    /// Any text is either read or refused with places inside the text.
    #[test]
    fn nothing_makes_it_fail(text in "(?s)([A-Za-z_0-9x.,;()\\[\\]|= \n-]|SetTextureStageState\\(|SetRenderState\\(|FAILED\\(|if|\\{|\\}|<t>|#define |\"|D3DRS_SRCBLEND|CullMode = |D3DTSS_COLOROP|ColorOp\\[0\\]|/\\*|//|->|\\PC){0,40}") {
        let findings = match parse(&text) {
            Ok(pasted) => pasted.asides.into_iter().map(|aside| aside.finding).collect(),
            Err(findings) => findings,
        };
        {
            for finding in findings {
                let span = finding.span.unwrap();
                prop_assert!(span.end <= text.len() && text.is_char_boundary(span.start) && text.is_char_boundary(span.end));
            }
        }
    }
}

/// Returns the code, the marked text and the help of every finding.
fn said(text: &str) -> Vec<(&'static str, String, String)> {
    let findings = parse(text).unwrap_err();
    findings
        .into_iter()
        .map(|finding| (finding.code, text[finding.span.unwrap()].to_owned(), finding.help.unwrap_or_default()))
        .collect()
}

#[test]
fn findings_point_at_words_and_say_what_was_meant() {
    for (text, code, marked, help) in [
        (
            "p->SetTextureStageState(0, D3DTSS_COLOROP, D3DTOP_DOTPRODUCT);",
            "NB0204",
            "D3DTOP_DOTPRODUCT",
            "`D3DTOP_DOTPRODUCT3`",
        ),
        ("SetTextureStageState(0, D3DTSS_COLOUROP, 4);", "NB0204", "D3DTSS_COLOUROP", "`D3DTSS_COLOROP`"),
        ("SetTextureStageState(0, D3DTSS_COLORARG1, D3DTA_TEXTUR | 16);", "NB0204", "D3DTA_TEXTUR", "`D3DTA_TEXTURE`"),
        ("SetTextureStageState(8, D3DTSS_COLOROP, 4);", "NB0206", "8", "0 to 7"),
        ("SetTextureStageState(0, D3DTSS_COLOROP, 27);", "NB0206", "27", "1 to 26"),
        ("SetTextureStageState(n, D3DTSS_COLOROP, 4);", "NB0205", "n", "number"),
        ("ColorOp[0] = ModulateAlpha_AddColour;", "NB0204", "ModulateAlpha_AddColour", "`ModulateAlpha_AddColor`"),
        ("ColorArg1[1] = Texture | Current;", "NB0205", "Texture | Current", "one"),
        ("SetTexturStageState(0, 1, 2);", "NB0204", "SetTexturStageState", "`SetTextureStageState`"),
        ("SetTextureStageState(0, D3DTSS_COLOROP);", "NB0211", "SetTextureStageState", "value"),
        ("ColorOp[0] Modulate;", "NB0103", "Modulate", "ColorOp[0] = Modulate;"),
        ("/* no end", "NB0103", "/*", "*/"),
    ] {
        let found = said(text);
        assert_eq!(found.len(), 1, "{text}: {found:?}");
        assert_eq!((found[0].0, found[0].1.as_str()), (code, marked), "{text}");
        assert!(found[0].2.contains(help), "{text}: {}", found[0].2);
    }
}

#[test]
fn several_findings_come_together() {
    let text = "ColorOp[0] = Modulat;\nColorOp[1] = = Add;\nAlphaOp[1] = Ad;";
    assert_eq!(said(text).iter().map(|finding| finding.0).collect::<Vec<_>>(), ["NB0204", "NB0103", "NB0204"]);
}

#[test]
fn bump_states_are_floats_or_their_bits() {
    let text = "d->SetTextureStageState(0, D3DTSS_BUMPENVMAT00, F2DW(-0.5f)); d->SetTextureStageState(0, D3DTSS_BUMPENVMAT01, 0x3f800000);\n\
                BumpEnvLScale[0] = 1.5; d->SetTextureStageState(0, D3DTSS_TEXCOORDINDEX, D3DTSS_TCI_PASSTHRU | 1);";
    let program = parse(text).unwrap().program;
    let stage = &program.stages[0];
    assert_eq!((stage.bump_matrix, stage.bump_luminance), ([-0.5, 1.0, 0.0, 0.0], [1.5, 0.0]));
    assert_eq!(stage.coordinate_index.as_ref().unwrap().value.set, 1);
}

/// Returns the marked text, the code and the help of everything that is skipped.
fn aside(text: &str) -> Vec<(String, &'static str, String)> {
    let pasted = parse(text).unwrap_or_else(|findings| panic!("{text}: {findings:?}"));
    let findings = pasted.asides.into_iter().map(|aside| aside.finding);
    findings.map(|found| (text[found.span.unwrap()].to_owned(), found.code, found.help.unwrap_or_default())).collect()
}

/// Reads a whole function as programs of the time contain it. The texture stages in it are read, and everything else is reported once for
/// each name.
#[test]
fn a_whole_block_is_read() {
    let text = r#"
        HRESULT hr = S_OK;
        D3DXMATRIX matWorld;
        pDevice->SetTransform( D3DTS_WORLD, &matWorld );
        pDevice->SetTransform( D3DTS_VIEW, &matView );
        pDevice->SetRenderState( D3DRS_LIGHTING, FALSE );
        if( FAILED( hr = pDevice->SetTextureStageState( 0, D3DTSS_COLOROP, D3DTOP_ADD ) ) )
        {
            OutputDebugString( "SetTextureStageState(0, D3DTSS_COLOROP, 4);\n" );
            return hr;
        }
        if( caps.MaxTextureBlendStages > 2 ) {
            V( pDevice->SetTextureStageState( 1, D3DTSS_COLOROP, (DWORD)D3DTOP_MODULATE2X ) );
        }
        pDevice->SetRenderState( D3DRS_TEXTUREFACTOR, D3DCOLOR_COLORVALUE( 0.5f, 1.0f, 0.0f, 0.25f ) );
        pDevice->SetTexture( 0, g_pTexture );
        Texture[0] = <t0>;
        AlphaBlendEnable = False;
    "#;
    let program = parse(text).unwrap().program;
    assert_eq!(program.stages[0].color.operation.value, Operation::Add);
    assert_eq!(program.stages[1].color.operation.value, Operation::Modulate2X);
    assert_eq!(program.texture_factor, [127, 255, 0, 63]);
    let said: Vec<String> = aside(text).into_iter().map(|(marked, code, _)| format!("{code} {marked}")).collect();
    assert_eq!(
        said,
        [
            "NB0917 hr",
            "NB0917 matWorld",
            "NB0917 SetTransform",
            "NB0917 D3DRS_LIGHTING",
            "NB0917 if",
            "NB0917 OutputDebugString",
        ]
    );
}

#[test]
fn colours_by_every_macro() {
    for (value, expected) in [
        ("RGBA_MAKE(1, 2, 3, 4)", [1, 2, 3, 4]),
        ("RGB_MAKE(1, 2, 3)", [1, 2, 3, 0]),
        ("D3DRGBA(0.5, 1.0, 0, 1)", [127, 255, 0, 255]),
        ("D3DRGB(0.5f, 0.25f, 1)", [127, 63, 255, 255]),
        ("D3DXCOLOR(0.5f, 0.25f, 0.0f, 1.0f)", [128, 64, 0, 255]),
        ("D3DCOLOR_XRGB(9, 8, 7)", [9, 8, 7, 255]),
        ("D3DCOLOR_RGBA(9, 8, 7, 6)", [9, 8, 7, 6]),
    ] {
        let text = format!("SetRenderState(D3DRS_TEXTUREFACTOR, {value});");
        assert_eq!(parse(&text).unwrap().program.texture_factor, expected, "{value}");
    }
    for value in [
        "D3DCOLOR_COLORVALUE(1.5f, 0, 0, 0)",
        "RGBA_MAKE(256, 0, 0, 0)",
        "RGBA_MAKE(1, 2, 3)",
        "RGB_MAKE(1, 2, 3, 4)",
        "MAKE(1)",
    ] {
        let text = format!("SetRenderState(D3DRS_TEXTUREFACTOR, {value});");
        assert_eq!(said(&text)[0].0, "NB0205", "{value}");
    }
}

#[test]
fn states_of_the_draw_are_pointed_at() {
    for (text, help) in [
        (
            "SetRenderState(D3DRS_ALPHABLENDENABLE, TRUE); SetRenderState(D3DRS_SRCBLEND, D3DBLEND_SRCALPHA); SetRenderState(D3DRS_DESTBLEND, 6);",
            "`blend: (source: SourceAlpha, destination: OneMinusSourceAlpha)`",
        ),
        (
            "AlphaTestEnable = True; AlphaFunc = GreaterEqual; AlphaRef = 0x80;",
            "`alpha_test: (function: GreaterOrEqual, reference: 128)`",
        ),
        ("SetRenderState(D3DRS_CULLMODE, D3DCULL_CCW);", "`cull: Back, front_face: Clockwise`"),
        ("SetRenderState(D3DRS_CULLMODE, D3DCULL_CW);", "`cull: Back`"),
        ("SetRenderState(D3DRS_SHADEMODE, D3DSHADE_FLAT);", "`shade_model: Flat, provoking_vertex: First`"),
        (
            "SetRenderState(D3DRS_ZENABLE, D3DZB_TRUE); ZWriteEnable = FALSE;",
            "`depth_test: (function: LessOrEqual, write: false)`",
        ),
        ("ColorWriteEnable = 7;", "`color_mask: (true, true, true, false)`"),
        (
            "SetRenderState(D3DRS_FOGENABLE, TRUE); SetRenderState(D3DRS_FOGCOLOR, 0xff8040); SetRenderState(D3DRS_FOGTABLEMODE, D3DFOG_LINEAR);",
            "`fog: (mode: Linear, start: ..., end: ..., evaluation: PerPixel, coordinate_source: W, color: (255, 128, 64))`",
        ),
    ] {
        let found = aside(text);
        assert_eq!(found.len(), 1, "{text}: {found:?}");
        assert_eq!(
            (found[0].1, found[0].2.as_str()),
            ("NB0918", format!("write it in the draw: {help}").as_str()),
            "{text}"
        );
    }
    // These settings are the defaults of a draw, so there is nothing to report.
    let text = "AlphaBlendEnable = False; SetRenderState(D3DRS_FOGENABLE, FALSE); CullMode = None; ShadeMode = Gouraud; ZEnable = 0;";
    assert_eq!(aside(text), []);
    let sampler = aside(
        "d->SetSamplerState(0, D3DSAMP_MINFILTER, D3DTEXF_LINEAR); d->SetTextureStageState(1, D3DTSS_ADDRESSU, 3);",
    );
    assert_eq!(
        sampler.iter().map(|(marked, ..)| marked.as_str()).collect::<Vec<_>>(),
        ["SetSamplerState", "D3DSAMP_MINFILTER", "D3DTSS_ADDRESSU"]
    );
    assert!(sampler[1].2.contains("min_filter"), "{sampler:?}");
}
