//! Reads the text of a shader into instructions.

use super::words::Word;
use super::*;
use crate::cursor::Cursor;
use crate::finding::{finding, foreign, header, warning};
use crate::lexer::{Kind, Language};
use crate::spelling::closest;
use ninebit::diagnostic::shorten;

/// Number of findings after which reading stops.
const MAX_FINDINGS: usize = 32;

/// Reads the notation, without checking the rules.
pub(super) fn read(text: &str) -> (PixelShader, Vec<Diagnostic>) {
    let program =
        PixelShader { version: Version::Ps11, definitions: Vec::new(), textures: Vec::new(), arithmetic: Vec::new() };
    let mut parser = Parser { cursor: Cursor::new(text, Language::ASSEMBLER), findings: Vec::new(), program };
    if let Some(span) = header(text) {
        parser.findings.push(foreign(text, span, "NB0370", "a pixel shader begins with `ps.1.1`"));
    } else if parser.version().is_some() {
        while !parser.cursor.is_done() && parser.findings.len() < MAX_FINDINGS {
            if parser.instruction().is_none() {
                parser.recover();
            }
        }
    }
    (parser.program, parser.findings)
}

pub(super) struct Parser<'t> {
    pub(super) cursor: Cursor<'t>,
    findings: Vec<Diagnostic>,
    program: PixelShader,
}

impl Parser<'_> {
    pub(super) fn push(
        &mut self,
        code: &'static str,
        span: Span,
        message: String,
        label: &str,
        help: impl Into<String>,
    ) {
        self.findings.push(finding(code, span, message, label, help));
    }

    pub(super) fn expected<T>(&mut self, what: &str) -> Option<T> {
        let (span, label) = match self.cursor.is_done() {
            true => (self.cursor.span_at(self.cursor.count().saturating_sub(1)), "behind this"),
            false => (self.cursor.span(), "not expected here"),
        };
        let help = "an instruction is written `mad_x2_sat r0.rgb, t0_bx2, 1-v0.a, c0`";
        let message = format!("expected {what}, found {}", self.cursor.current_token("the end of the text"));
        self.push("NB0103", span, message, label, help);
        None
    }

    /// Skips to the next line, or to a `+`.
    fn recover(&mut self) {
        self.cursor.advance();
        self.cursor.skip_to(|cursor| cursor.is('+') || cursor.is_new_line());
    }

    /// Takes the current word. Returns its pieces between underscores, in lower case, with their places.
    pub(super) fn word(&mut self, what: &str) -> Option<Vec<(String, Span)>> {
        if self.cursor.kind() != Some(Kind::Word) {
            return self.expected(what);
        }
        let span = self.cursor.span();
        self.cursor.advance();
        let mut start = span.start;
        let pieces = self.cursor.text(&span).split('_').map(|piece| {
            let span = start..start + piece.len();
            start = span.end + 1;
            (piece.to_ascii_lowercase(), span)
        });
        Some(pieces.collect())
    }

    /// Reads the version that the text starts with; without one it is 1.1. Returns `None` after recording that the version is not supported.
    fn version(&mut self) -> Option<()> {
        let span = self.cursor.span();
        let word = match self.cursor.kind() {
            Some(Kind::Word) => self.cursor.text(&span).to_ascii_lowercase(),
            None => return self.expected("a pixel shader"),
            Some(_) => String::new(),
        };
        match words::version(&word) {
            Some(Ok(version)) => {
                self.cursor.advance();
                self.program.version = version;
            }
            Some(Err(())) => {
                let message = format!("`{}` is not read", shorten(&word));
                let help = "this reads ps.1.0 and ps.1.1, and what ps.1.2 and ps.1.3 have in common with them";
                self.push("NB0370", span, message, "another kind of shader", help);
                return None;
            }
            None => {
                let message = "this shader does not say its version: read as ps.1.1";
                let help = "write `ps.1.1` in the first line";
                self.findings.push(warning("NB0906", span, message, "before this", help));
            }
        }
        Some(())
    }

    /// Reads one instruction. Returns `None` after recording what is wrong.
    fn instruction(&mut self) -> Option<()> {
        let paired = self.cursor.take('+');
        let start = self.cursor.at;
        let mut pieces = self.word("an instruction")?.into_iter();
        let (name, span) = pieces.next()?;
        let Some(word) = words::find(&name) else {
            return self.unknown(start, &name);
        };
        let modifiers: Vec<_> = pieces.collect();
        if !matches!(word, Word::Arithmetic(_))
            && let Some((modifier, span)) = modifiers.first()
        {
            let message = format!("{name} takes no `_{modifier}`");
            let help = "scales and `_sat` belong to arithmetic instructions";
            self.push("NB0371", span.clone(), message, "not here", help);
        }
        if paired && !matches!(word, Word::Arithmetic(_) | Word::Nothing) {
            let message = format!("{name} cannot be issued together with another instruction");
            let help = "leave the `+` out: only arithmetic instructions are paired";
            self.push("NB0376", span.clone(), message, "no arithmetic instruction", help);
        }
        match word {
            Word::Nothing => {}
            Word::Define => self.definition()?,
            Word::Texture(operation) => self.texture(operation, span)?,
            Word::Arithmetic(operation) => {
                let (scale, saturate) = self.scale(&name, &modifiers);
                self.arithmetic(operation, scale, saturate, paired, span)?;
            }
        }
        match self.cursor.token() {
            Some(token) if token.kind == Kind::Sign(',') => self.too_many(&name, start),
            Some(token) if !token.first && token.kind == Kind::Sign('.') => self.expected("the next instruction"),
            _ => Some(()),
        }
    }

    fn unknown(&mut self, token: usize, name: &str) -> Option<()> {
        let span = self.cursor.span_at(token);
        if let Some((version, help)) = words::later(name) {
            let message = format!("`{name}` is an instruction of ps.{version}, which ps.1.1 does not have");
            self.push("NB0370", span, message, "not in this language", help);
            return None;
        }
        if words::version(name).is_some() {
            let message = "a version in the middle of a shader".to_owned();
            self.push("NB0373", span, message, "belongs in the first line", "keep one shader in a text");
            return None;
        }
        let help = match closest(name, words::names()) {
            Some(known) => format!("did you mean `{known}`?"),
            None => format!("instructions: {}", words::names().collect::<Vec<_>>().join(", ")),
        };
        self.push("NB0204", span, format!("there is no instruction `{}`", shorten(name)), "not known", help);
        None
    }

    /// Reads `_x2`, `_x4`, `_d2` and `_sat`, in any order.
    fn scale(&mut self, name: &str, modifiers: &[(String, Span)]) -> (Scale, bool) {
        let (mut scale, mut saturate) = (None, false);
        for (modifier, span) in modifiers {
            let found = words::SCALES.iter().find(|(known, _)| known == modifier);
            let again = if found.is_some() { scale.is_some() } else { saturate };
            match (modifier.as_str(), found) {
                (_, Some((_, value))) => scale = Some(*value),
                ("sat", None) => saturate = true,
                _ => {
                    let message = format!("there is no instruction modifier `_{}`", shorten(modifier));
                    let help = format!("write `{name}_x2`, `_x4`, `_d2`, and `_sat` with any of them or alone");
                    self.push("NB0204", span.clone(), message, "not known", help);
                    continue;
                }
            }
            if again {
                let message = format!("`_{modifier}` beside another modifier of its kind");
                self.push("NB0371", span.clone(), message, "one too many", "keep one scale and one `_sat`");
            }
        }
        (scale.unwrap_or(Scale::One), saturate)
    }

    fn comma(&mut self, what: &str, start: usize, wanted: usize, found: usize) -> Option<()> {
        if self.cursor.take(',') {
            return Some(());
        }
        if self.cursor.is_new_line() || self.cursor.is('+') {
            let token = self.cursor.span_at(start);
            let message = format!("{what} has {wanted} operands, not {found}");
            self.push("NB0211", token, message, "this instruction", operands(what));
            return None;
        }
        self.expected("`,`")
    }

    fn too_many(&mut self, what: &str, start: usize) -> Option<()> {
        let span = self.cursor.span();
        let first = self.cursor.span_at(start);
        let wanted = match words::find(what) {
            Some(Word::Arithmetic(operation)) => 1 + operation.sources(),
            Some(Word::Texture(operation)) => operation.operands(),
            Some(Word::Define) => 5,
            Some(Word::Nothing) | None => 0,
        };
        let message = format!("{what} has {wanted} operands, not more");
        let finding = finding("NB0211", span, message, "one too many", operands(what));
        self.findings.push(finding.related(first, "this instruction"));
        None
    }

    fn definition(&mut self) -> Option<()> {
        let start = self.cursor.at - 1;
        let Spanned { value: index, span } = self.plain_register(Bank::Constant, "def", "a constant")?;
        let mut value = [0.0; 4];
        for (n, slot) in value.iter_mut().enumerate() {
            self.comma("def", start, 5, n + 1)?;
            *slot = self.number()?;
        }
        self.program.definitions.push(Definition { index, value, span });
        Some(())
    }

    fn texture(&mut self, operation: TextureOperation, span: Span) -> Option<()> {
        let start = self.cursor.at - 1;
        let name = operation.name();
        let unit = self.plain_register(Bank::Texture, name, "a texture register")?;
        let wanted = operation.operands();
        let (mut source, mut eye) = (None, None);
        if operation.has_source() {
            self.comma(name, start, wanted, 1)?;
            source = Some(self.texture_source(operation)?);
        }
        if operation == TextureOperation::Texm3x3spec {
            self.comma(name, start, wanted, 2)?;
            eye = Some(self.plain_register(Bank::Constant, name, "the eye from a constant")?);
        }
        self.program.textures.push(TextureInstruction { operation, unit, source, eye, span });
        Some(())
    }

    fn arithmetic(
        &mut self,
        operation: Operation,
        scale: Scale,
        saturate: bool,
        paired: bool,
        span: Span,
    ) -> Option<()> {
        let start = self.cursor.at - 1;
        let target = self.target()?;
        let mut sources = Vec::with_capacity(operation.sources());
        while sources.len() < operation.sources() {
            self.comma(operation.name(), start, 1 + operation.sources(), 1 + sources.len())?;
            sources.push(self.source()?);
        }
        self.program.arithmetic.push(Arithmetic { operation, scale, saturate, target, sources, paired, span });
        Some(())
    }
}

/// Returns the help that shows how an instruction is written.
fn operands(name: &str) -> String {
    match words::find(name) {
        Some(Word::Define) => "write `def c0, 1, 0.5, 0, 1`".to_owned(),
        Some(Word::Arithmetic(operation)) => {
            let sources = ["t0", "v0", "c0"][..operation.sources().min(3)].join(", ");
            let sources = if operation == Operation::Cnd { "r0.a, t0, v0" } else { &sources };
            format!("write `{name} r0, {sources}`")
        }
        Some(Word::Texture(TextureOperation::Texm3x3spec)) => format!("write `{name} t3, t0_bx2, c0`"),
        Some(Word::Texture(operation)) if operation.has_source() => format!("write `{name} t1, t0`"),
        _ => format!("write `{name} t0`"),
    }
}
