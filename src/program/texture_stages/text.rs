//! Reads texture stages from pasted text: calls of SetTextureStageState and SetRenderState, and lines of effect files.

mod draw_state;
mod value;

use super::*;
use crate::calls::{self, PastedProgram, Reader, Statement, Value, Vocabulary, out_of_range};
use crate::finding::finding;
use draw_state::{DrawStates, OTHER_STATES};
use ninebit::diagnostic::Diagnostic;

/// Names of the states of stages, samplers and the program.
const OWN_STATES: &str = "ColorOp ColorArg0 ColorArg1 ColorArg2 AlphaOp AlphaArg0 AlphaArg1 AlphaArg2 \
    BumpEnvMat00 BumpEnvMat01 BumpEnvMat10 BumpEnvMat11 BumpEnvLScale BumpEnvLOffset \
    TexCoordIndex TextureTransformFlags ResultArg Constant Texture Sampler \
    Address AddressU AddressV AddressW BorderColor MagFilter MinFilter MipFilter \
    MipMapLodBias MaxMipLevel MaxAnisotropy SpecularEnable TextureFactor";

/// What is read of Direct3D.
static DIRECT3D: Vocabulary = Vocabulary {
    calls: "SetTextureStageState SetRenderState SetSamplerState",
    silent: "SetTexture",
    states: || OWN_STATES.split(' ').chain(draw_state::names()).chain(OTHER_STATES.split(' ')).collect(),
    instead: &[
        ("SetTransform", "the draw's `vertices: Matrix(...)` and `texture_matrices` have the matrices"),
        ("MultiplyTransform", "the draw's `vertices: Matrix(...)` and `texture_matrices` have the matrices"),
        ("SetViewport", "the draw's `vertices: Matrix(viewport: ...)` has it"),
        ("SetVertexShader", "write a vertex program as the draw's `vertices: Program(text: ...)`"),
        ("SetPixelShader", "write a pixel shader as the draw's `program: PixelShader(...)`"),
        ("SetVertexShaderConstant", "the draw's `vertices: Program(constants: ...)` has them"),
        ("SetPixelShaderConstant", "the draw's `program: PixelShader(constants: ...)` has them"),
        ("SetRenderTarget", "the draw's `target` names it"),
        ("Clear", "the target's `clear` has the colour, its depth buffer the depth"),
        ("Primitive", "the draw's `vertices`, `indices` and `topology` say what is drawn"),
        ("PrimitiveUP", "the draw's `vertices`, `indices` and `topology` say what is drawn"),
        ("SetLight", "give the vertices the colours that they have once they are lit"),
        ("SetMaterial", "give the vertices the colours that they have once they are lit"),
    ],
    example: "`SetTextureStageState(0, D3DTSS_COLOROP, D3DTOP_MODULATE);` or `ColorOp[0] = Modulate;`",
    what: "a pixel program",
};

/// Reads the text, starting from the API's initial state.
///
/// # Errors
/// Findings about whatever is not a statement, or sets something that the API does not have.
pub fn parse(text: &str) -> Result<PastedProgram<TextureStages>, Vec<Diagnostic>> {
    let reader = Reader::new(text, &DIRECT3D);
    let mut parser = Parser { reader, program: TextureStages::default(), draw: DrawStates::default() };
    while let Some(statement) = parser.reader.next() {
        // What is wrong with a statement has been recorded.
        let _ = match statement {
            Statement::Call { name, arguments } => parser.call(&name, &arguments),
            Statement::State { name, index: Some(stage), value } => parser.stage_state(&stage, &name, &value, false),
            Statement::State { name, index: None, value } => parser.render_state(&name, &value, false),
        };
    }
    let Parser { mut reader, program, draw } = parser;
    reader.asides.extend(draw.asides());
    reader.finish(program)
}

/// The states of a stage that belong to the program: names without prefix, and D3DTSS values.
const STATES: &[(&str, u32)] = &[
    ("ColorOp", 1),
    ("ColorArg1", 2),
    ("ColorArg2", 3),
    ("AlphaOp", 4),
    ("AlphaArg1", 5),
    ("AlphaArg2", 6),
    ("BumpEnvMat00", 7),
    ("BumpEnvMat01", 8),
    ("BumpEnvMat10", 9),
    ("BumpEnvMat11", 10),
    ("TexCoordIndex", 11),
    ("BumpEnvLScale", 22),
    ("BumpEnvLOffset", 23),
    ("TextureTransformFlags", 24),
    ("ColorArg0", 26),
    ("AlphaArg0", 27),
    ("ResultArg", 28),
    ("Constant", 32),
];
/// States of the same calls that belong to the sampler: name, value, and the field of a unit in a scene.
const SAMPLER_STATES: &[(&str, u32, &str)] = &[
    ("Address", 12, "address"),
    ("AddressU", 13, "address_s"),
    ("AddressV", 14, "address_t"),
    ("BorderColor", 15, "border_color"),
    ("MagFilter", 16, "mag_filter"),
    ("MinFilter", 17, "min_filter"),
    ("MipFilter", 18, "mip_filter"),
    ("MipMapLodBias", 19, "lod_bias"),
    ("MaxMipLevel", 20, "min_lod"),
    ("MaxAnisotropy", 21, "anisotropy"),
    ("AddressW", 25, "address"),
];
/// Render states that belong to the program: names without prefix, and D3DRS values.
const RENDER_STATES: &[(&str, u32)] = &[("SpecularEnable", 29), ("TextureFactor", 60)];

struct Parser<'t> {
    reader: Reader<'t>,
    program: TextureStages,
    draw: DrawStates,
}

impl<'t> Parser<'t> {
    fn word(&self, span: &Span) -> &'t str {
        self.reader.word(span)
    }

    fn call(&mut self, name: &Span, arguments: &[Value<'t>]) -> Option<()> {
        let function = self.word(name);
        let render = function.ends_with("SetRenderState");
        let count = if render { 2 } else { 3 };
        // In C the device is the first argument.
        let arguments = match arguments.len().checked_sub(count) {
            Some(extra @ (0 | 1)) => &arguments[extra..],
            _ => {
                let message = format!("{function} has {count} arguments, not {}", arguments.len());
                let help =
                    if render { "write the state and its value" } else { "write the stage, the state and its value" };
                self.reader.findings.push(finding("NB0211", name.clone(), message, "this call", help));
                return None;
            }
        };
        match arguments {
            [_, state, _] if function.ends_with("SetSamplerState") => self.sampler_state(name, state),
            [stage, state, value] => self.stage_state(stage, &state.span.clone(), value, true),
            [state, value] => self.render_state(&state.span.clone(), value, true),
            _ => None,
        }
    }

    /// Processes SetSamplerState: Direct3D 9 moved these states from stages to samplers.
    fn sampler_state(&mut self, name: &Span, state: &Value<'t>) -> Option<()> {
        let function = self.word(name);
        let message = "`SetSamplerState` is Direct3D 9's: the interfaces of these chips set samplers by stage";
        let help =
            "the draw's `textures` have filters and address modes: `textures: [(texture: ..., min_filter: Linear)]`";
        self.reader.pass(name.clone(), function, message, "passed over", help);
        let bare = calls::without_prefix(self.word(&state.span), &["D3DSAMP_"]).1;
        let (name, _, field) = SAMPLER_STATES.iter().find(|(name, ..)| name.eq_ignore_ascii_case(bare))?;
        self.sampler(name, field, state.span.clone());
        Some(())
    }

    fn sampler(&mut self, name: &'static str, field: &str, span: Span) {
        let message = format!("{name} is a state of the sampler");
        let help = format!("write it in the draw: `textures: [(texture: ..., {field}: ...)]`");
        self.reader.pass(span, name, &message, "no part of a pixel program", &help);
    }

    /// Finds a state by name or value. Returns its name without the prefix, or `None` after recording that there is no such state.
    fn state(
        &mut self,
        span: &Span,
        prefixes: &[&str],
        known: &[(&'static str, u32)],
        call: bool,
    ) -> Option<&'static str> {
        let word = self.word(span);
        let value = calls::integer(word);
        let (prefix, bare) = calls::without_prefix(word, prefixes);
        let found = known.iter().find(|(name, number)| name.eq_ignore_ascii_case(bare) || value == Some(*number));
        if let Some((name, _)) = found
            && (value.is_some() || call != prefix.is_empty())
        {
            return Some(name);
        }
        let spelled = |name: &str| match (call, prefixes) {
            (true, [prefix, ..]) => format!("{prefix}{}", name.to_uppercase()),
            _ => name.to_owned(),
        };
        let (message, help) =
            (format!("there is no state `{word}` of a pixel program"), calls::meant(bare, known, spelled));
        self.reader.findings.push(finding("NB0204", span.clone(), message, "not known", help));
        None
    }

    fn stage_state(&mut self, stage: &Value<'t>, state: &Span, value: &Value<'t>, call: bool) -> Option<()> {
        let prefixes: &[&str] = if call { &["D3DTSS_"] } else { &[] };
        let bare = calls::without_prefix(self.word(state), prefixes).1;
        let number = calls::integer(bare);
        let sampler = SAMPLER_STATES.iter().find(|(name, n, _)| name.eq_ignore_ascii_case(bare) || number == Some(*n));
        if let Some((name, _, field)) = sampler {
            self.sampler(name, field, state.clone());
            return None;
        }
        if !call && ["Texture", "Sampler"].iter().any(|name| name.eq_ignore_ascii_case(bare)) {
            // As with SetTexture, the draw's `textures` say what is bound.
            return None;
        }
        let name = self.state(state, prefixes, STATES, call)?;
        let index = value::number(stage, &mut self.reader.findings)?;
        let Some(target) = self.program.stage_mut(index as usize) else {
            let help = format!("write 0 to {}", STAGES - 1);
            return out_of_range(&stage.span, "texture stage", index, &help, &mut self.reader.findings);
        };
        if target.span.is_empty() {
            target.span = state.clone();
        }
        let findings = &mut self.reader.findings;
        let span = value.span.clone();
        let half = if name.starts_with("Color") { &mut target.color } else { &mut target.alpha };
        match name {
            "ColorOp" | "AlphaOp" => half.operation = Spanned { value: value::operation(value, call, findings)?, span },
            "ResultArg" => target.result = value::result(value, call, findings)?,
            "Constant" => target.constant = value::color(value, findings)?,
            "TexCoordIndex" => {
                let bits = value::coordinate_index(value, findings)?;
                let value = CoordinateIndex { set: bits & 0xffff, generation: bits >> 16 };
                target.coordinate_index = Some(Spanned { value, span });
            }
            "TextureTransformFlags" => {
                target.transform_flags = Spanned { value: value::transform_flags(value, findings)?, span };
            }
            "BumpEnvMat00" => target.bump_matrix[0] = value::float(value, findings)?,
            "BumpEnvMat01" => target.bump_matrix[1] = value::float(value, findings)?,
            "BumpEnvMat10" => target.bump_matrix[2] = value::float(value, findings)?,
            "BumpEnvMat11" => target.bump_matrix[3] = value::float(value, findings)?,
            "BumpEnvLScale" => target.bump_luminance[0] = value::float(value, findings)?,
            "BumpEnvLOffset" => target.bump_luminance[1] = value::float(value, findings)?,
            argument => {
                let slot = usize::from(argument.as_bytes()[argument.len() - 1] - b'0').min(2);
                half.arguments[slot] = Spanned { value: value::argument(value, call, findings)?, span };
            }
        }
        Some(())
    }

    fn render_state(&mut self, state: &Span, value: &Value<'t>, call: bool) -> Option<()> {
        let prefixes: &[&str] = if call { &["D3DRS_", "D3DRENDERSTATE_"] } else { &[] };
        let word = self.word(state);
        let (prefix, bare) = calls::without_prefix(word, prefixes);
        let number = calls::integer(word);
        if call != prefix.is_empty() || number.is_some() {
            if self.draw.take(bare, number, state, value) {
                return Some(());
            }
            if let Some(other) = OTHER_STATES.split(' ').find(|name| name.eq_ignore_ascii_case(bare)) {
                let message = format!("{} is passed over", other.to_uppercase());
                let help = draw_state::instead(other);
                self.reader.pass(state.clone(), other, &message, "no part of a pixel program", help);
                return Some(());
            }
        }
        match self.state(state, prefixes, RENDER_STATES, call)? {
            "SpecularEnable" => self.program.specular_enable = value::flag(value, &mut self.reader.findings)?,
            _ => self.program.texture_factor = value::color(value, &mut self.reader.findings)?,
        }
        Some(())
    }
}
