//! Texture stages as pasted text: calls of SetTextureStageState and SetRenderState, and lines of effect files.
//!
//! Calls may have anything before the name (`pDevice->`, `hr = `) and the C form's device as an extra first argument. Nothing is
//! compiled: a value is a number, a name of the API, or several joined by `|`.

mod token;
mod value;

use std::ops::Range;

use super::{CoordinateIndex, STAGES, TextureStages};
use crate::diagnostic::Diagnostic;
use crate::program::At;
use crate::program::finding::finding;
use crate::spelling::closest;
use token::{Token, TokenKind, tokens};
use value::Value;

/// Findings beyond this many are not gathered.
const MOST_FINDINGS: usize = 32;

/// Reads the text over the API's initial state.
///
/// # Errors
/// Everything that is not a statement, or sets something that is not known.
pub fn parse(text: &str) -> Result<TextureStages, Vec<Diagnostic>> {
    let mut findings = Vec::new();
    let tokens = tokens(text, &mut findings);
    let mut parser = Parser { text, tokens, at: 0, findings, program: TextureStages::default() };
    while parser.at < parser.tokens.len() && parser.findings.len() < MOST_FINDINGS {
        if parser.statement().is_none() {
            parser.recover();
        }
    }
    if parser.findings.is_empty() { Ok(parser.program) } else { Err(parser.findings) }
}

/// The states of a stage that are read here, by their names without prefix, with their D3DTSS values.
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
/// States of the same calls that belong to the sampler: name, value, and what the draw calls it.
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
/// Render states that belong to the program.
const RENDER_STATES: &[(&str, u32)] = &[("SpecularEnable", 29), ("TextureFactor", 60)];

struct Parser<'t> {
    text: &'t str,
    tokens: Vec<Token>,
    at: usize,
    findings: Vec<Diagnostic>,
    program: TextureStages,
}

impl<'t> Parser<'t> {
    fn peek(&self) -> Option<TokenKind> {
        self.tokens.get(self.at).map(|token| token.kind)
    }

    fn next(&mut self) -> Option<Token> {
        let token = self.tokens.get(self.at).cloned();
        self.at += usize::from(token.is_some());
        token
    }

    /// The place of the token at hand; the end of the text after the last.
    fn place(&self) -> Range<usize> {
        match (self.tokens.get(self.at), self.tokens.last()) {
            (Some(token), _) => token.place.clone(),
            (None, Some(last)) => last.place.end..last.place.end,
            (None, None) => 0..0,
        }
    }

    fn word(&self, place: &Range<usize>) -> &'t str {
        self.text.get(place.clone()).unwrap_or("")
    }

    fn expected(&mut self, what: &str) {
        let place = self.place();
        let found = match self.word(&place) {
            "" => "the end of the text".to_owned(),
            word => format!("`{word}`"),
        };
        self.findings.push(finding(
            "NB0103",
            place,
            format!("expected {what}, found {found}"),
            "not a statement from here",
            "write `SetTextureStageState(0, D3DTSS_COLOROP, D3DTOP_MODULATE);` or `ColorOp[0] = Modulate;`",
        ));
    }

    fn symbol(&mut self, symbol: char) -> Option<()> {
        if self.peek() == Some(TokenKind::Symbol(symbol)) {
            self.at += 1;
            return Some(());
        }
        self.expected(&format!("`{symbol}`"));
        None
    }

    /// Skips to the next statement: behind a semicolon, or at the start of a line.
    fn recover(&mut self) {
        while let Some(token) = self.next() {
            if token.kind == TokenKind::Symbol(';') || self.tokens.get(self.at).is_some_and(|next| next.first) {
                return;
            }
        }
    }

    /// One statement; `None` once the reason that it is none has been recorded.
    fn statement(&mut self) -> Option<()> {
        if self.peek() == Some(TokenKind::Symbol(';')) {
            self.at += 1;
            return Some(());
        }
        if self.peek() != Some(TokenKind::Word) {
            self.expected("a call or an assignment");
            return None;
        }
        let name = self.next()?;
        match self.peek() {
            Some(TokenKind::Symbol('(')) => self.call(&name.place)?,
            Some(TokenKind::Symbol('[')) => {
                self.at += 1;
                let stage = self.value()?;
                self.symbol(']')?;
                self.symbol('=')?;
                let value = self.value()?;
                self.stage_state(&stage, &name.place, &value, false);
            }
            Some(TokenKind::Symbol('=')) if self.is_render_state(&name.place) => {
                self.at += 1;
                let value = self.value()?;
                self.render_state(&name.place, &value, false);
            }
            // What stands before a call: a pointer, a result.
            Some(TokenKind::Arrow | TokenKind::Symbol('=' | '.' | ':')) => {
                while matches!(self.peek(), Some(TokenKind::Arrow | TokenKind::Symbol('=' | '.' | ':'))) {
                    self.at += 1;
                }
                return self.statement_after_prefix();
            }
            _ => {
                self.expected("`(`, `[` or `=`");
                return None;
            }
        }
        self.end()
    }

    fn statement_after_prefix(&mut self) -> Option<()> {
        if self.peek() == Some(TokenKind::Word) {
            // Each turn takes at least one token; the nesting is that of the prefixes, which are few: go on in the loop of `parse`.
            return Some(());
        }
        self.expected("a call");
        None
    }

    /// A semicolon, or nothing where the next statement begins a line.
    fn end(&mut self) -> Option<()> {
        match self.tokens.get(self.at) {
            None => Some(()),
            Some(token) if token.kind == TokenKind::Symbol(';') => {
                self.at += 1;
                Some(())
            }
            Some(token) if token.first => Some(()),
            Some(_) => {
                self.expected("`;`");
                None
            }
        }
    }

    fn call(&mut self, name: &Range<usize>) -> Option<()> {
        let function = self.word(name);
        self.symbol('(')?;
        if function.ends_with("SetTexture") {
            return self.skip_arguments();
        }
        let stage = function.ends_with("SetTextureStageState");
        if !stage && !function.ends_with("SetRenderState") {
            let known = ["SetTextureStageState", "SetRenderState"];
            let help = match closest(function, known) {
                Some(known) => format!("did you mean `{known}`?"),
                None => "this reads SetTextureStageState and SetRenderState, and passes over SetTexture".to_owned(),
            };
            self.findings.push(finding(
                "NB0204",
                name.clone(),
                format!("`{function}` is no call that is read here"),
                "not known",
                help,
            ));
            return None;
        }
        let mut arguments = Vec::new();
        loop {
            arguments.push(self.value()?);
            if self.peek() != Some(TokenKind::Symbol(',')) {
                break;
            }
            self.at += 1;
        }
        self.symbol(')')?;
        let count = 2 + usize::from(stage);
        // The C form has the device first.
        let arguments = match arguments.len().checked_sub(count) {
            Some(extra @ (0 | 1)) => &arguments[extra..],
            _ => {
                let message = format!("{function} has {count} arguments, not {}", arguments.len());
                let help = "write the stage, the state and its value";
                self.findings.push(finding("NB0211", name.clone(), message, "this call", help));
                return Some(());
            }
        };
        match arguments {
            [stage, state, value] => self.stage_state(stage, &state.place.clone(), value, true),
            [state, value] => self.render_state(&state.place.clone(), value, true),
            _ => {}
        }
        Some(())
    }

    fn skip_arguments(&mut self) -> Option<()> {
        let mut depth = 1;
        while depth > 0 {
            match self.next() {
                Some(token) if token.kind == TokenKind::Symbol('(') => depth += 1,
                Some(token) if token.kind == TokenKind::Symbol(')') => depth -= 1,
                Some(_) => {}
                None => {
                    self.expected("`)`");
                    return None;
                }
            }
        }
        Some(())
    }

    fn is_render_state(&self, place: &Range<usize>) -> bool {
        RENDER_STATES.iter().any(|(name, _)| name.eq_ignore_ascii_case(self.word(place)))
    }

    /// The state's name without its prefix, in its own spelling: by name, or by its value.
    fn state(
        &mut self,
        place: &Range<usize>,
        prefixes: &[&str],
        known: &[(&'static str, u32)],
        call: bool,
    ) -> Option<&'static str> {
        let word = self.word(place);
        let value = value::integer(word);
        let (prefix, bare) = value::without_prefix(word, prefixes);
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
        let help = match closest(bare, known.iter().map(|(name, _)| *name)) {
            Some(name) => format!("did you mean `{}`?", spelled(name)),
            None => {
                let all: Vec<String> = known.iter().map(|(name, _)| spelled(name)).collect();
                format!("known: {}", all.join(", "))
            }
        };
        let message = format!("there is no state `{word}` of a pixel program");
        self.findings.push(finding("NB0204", place.clone(), message, "not known", help));
        None
    }

    fn stage_state(&mut self, stage: &Value<'t>, state: &Range<usize>, value: &Value<'t>, call: bool) {
        let prefixes: &[&str] = if call { &["D3DTSS_"] } else { &[] };
        let bare = value::without_prefix(self.word(state), prefixes).1;
        let number = value::integer(bare);
        let sampler = SAMPLER_STATES.iter().find(|(name, n, _)| name.eq_ignore_ascii_case(bare) || number == Some(*n));
        if let Some((name, _, field)) = sampler {
            let message = format!("{name} is no part of the pixel program");
            let help = format!("write it in the draw: `textures: [(texture: ..., {field}: ...)]`");
            self.findings.push(finding("NB0354", state.clone(), message, "a state of the sampler", help));
            return;
        }
        let Some(name) = self.state(state, prefixes, STATES, call) else { return };
        let Some(index) = value::number(stage, &mut self.findings) else { return };
        let Some(target) = self.program.stage_mut(index as usize) else {
            let message = format!("there is no texture stage {index}");
            let help = format!("write 0 to {}", STAGES - 1);
            self.findings.push(finding("NB0206", stage.place.clone(), message, "out of range", help));
            return;
        };
        if target.place.is_empty() {
            target.place = state.clone();
        }
        let findings = &mut self.findings;
        let place = value.place.clone();
        let at = |argument| At { value: argument, place: place.clone() };
        match name {
            "ColorOp" | "AlphaOp" => {
                let half = if name == "ColorOp" { &mut target.color } else { &mut target.alpha };
                if let Some(operation) = value::operation(value, call, findings) {
                    half.operation = At { value: operation, place };
                }
            }
            "ResultArg" => {
                if let Some(result) = value::result(value, call, findings) {
                    target.result = result;
                }
            }
            "Constant" => {
                if let Some(color) = value::color(value, findings) {
                    target.constant = color;
                }
            }
            "TexCoordIndex" => {
                if let Some(bits) = value::coordinate_index(value, findings) {
                    let index = CoordinateIndex { set: bits & 0xffff, generation: bits >> 16 };
                    target.coordinate_index = Some(At { value: index, place });
                }
            }
            "TextureTransformFlags" => {
                if let Some(flags) = value::transform_flags(value, findings) {
                    target.transform_flags = At { value: flags, place };
                }
            }
            _ if name.ends_with("Arg0") || name.ends_with("Arg1") || name.ends_with("Arg2") => {
                let half = if name.starts_with("Color") { &mut target.color } else { &mut target.alpha };
                let slot = usize::from(name.as_bytes()[name.len() - 1] - b'0').min(2);
                if let Some(argument) = value::argument(value, call, findings) {
                    half.arguments[slot] = at(argument);
                }
            }
            _ => {
                let slot = match name {
                    "BumpEnvMat00" => &mut target.bump_matrix[0],
                    "BumpEnvMat01" => &mut target.bump_matrix[1],
                    "BumpEnvMat10" => &mut target.bump_matrix[2],
                    "BumpEnvMat11" => &mut target.bump_matrix[3],
                    "BumpEnvLScale" => &mut target.bump_luminance[0],
                    _ => &mut target.bump_luminance[1],
                };
                if let Some(float) = value::float(value, findings) {
                    *slot = float;
                }
            }
        }
    }

    fn render_state(&mut self, state: &Range<usize>, value: &Value<'t>, call: bool) {
        let prefixes: &[&str] = if call { &["D3DRS_", "D3DRENDERSTATE_"] } else { &[] };
        match self.state(state, prefixes, RENDER_STATES, call) {
            Some("SpecularEnable") => {
                if let Some(enable) = value::flag(value, &mut self.findings) {
                    self.program.specular_enable = enable;
                }
            }
            Some(_) => {
                if let Some(color) = value::color(value, &mut self.findings) {
                    self.program.texture_factor = color;
                }
            }
            None => {}
        }
    }
}
