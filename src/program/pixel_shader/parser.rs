//! From text to instructions.

use std::ops::Range;

use super::lexer::{Kind, Token, tokens};
use super::words::{self, Word};
use super::*;
use crate::diagnostic::shorten;
use crate::program::finding::finding;
use crate::spelling::closest;

/// Findings beyond this many are not gathered.
const MOST_FINDINGS: usize = 32;

/// Reads the notation alone.
pub(super) fn read(text: &str) -> (PixelShader, Vec<Diagnostic>) {
    let program =
        PixelShader { version: Version::Ps11, definitions: Vec::new(), textures: Vec::new(), arithmetic: Vec::new() };
    let mut parser = Parser { text, tokens: tokens(text), at: 0, findings: Vec::new(), program };
    if parser.version().is_some() {
        while parser.at < parser.tokens.len() && parser.findings.len() < MOST_FINDINGS {
            if parser.instruction().is_none() {
                parser.recover();
            }
        }
    }
    (parser.program, parser.findings)
}

struct Parser<'t> {
    text: &'t str,
    tokens: Vec<Token>,
    at: usize,
    findings: Vec<Diagnostic>,
    program: PixelShader,
}

/// A word in lower case, cut at its underscores, and where each piece stands.
struct Pieces {
    pieces: Vec<(String, Range<usize>)>,
}

impl<'t> Parser<'t> {
    fn kind(&self) -> Option<Kind> {
        self.tokens.get(self.at).map(|token| token.kind)
    }

    fn is(&self, sign: char) -> bool {
        self.kind() == Some(Kind::Sign(sign))
    }

    fn take(&mut self, sign: char) -> bool {
        let found = self.is(sign);
        self.at += usize::from(found);
        found
    }

    /// Place of the token at hand; behind the last one, of the last one.
    fn place(&self) -> Range<usize> {
        let token = self.tokens.get(self.at).or(self.tokens.last());
        token.map_or(0..0, |token| token.place.clone())
    }

    fn push(&mut self, code: &'static str, place: Range<usize>, message: String, label: &str, help: impl Into<String>) {
        self.findings.push(finding(code, place, message, label, help));
    }

    fn expected<T>(&mut self, what: &str) -> Option<T> {
        let place = self.place();
        let (found, label) = match self.kind() {
            None => ("the end of the text".to_owned(), "behind this"),
            Some(_) => (format!("`{}`", shorten(&self.text[place.clone()])), "not expected here"),
        };
        let help = "an instruction is written `mad_x2_sat r0.rgb, t0_bx2, 1-v0.a, c0`";
        self.push("NB0103", place, format!("expected {what}, found {found}"), label, help);
        None
    }

    /// Skips to the next line, or to a `+`.
    fn recover(&mut self) {
        while self.at < self.tokens.len() {
            self.at += 1;
            if self.is('+') || self.tokens.get(self.at).is_some_and(|token| token.first) {
                return;
            }
        }
    }

    /// The word at hand, taken.
    fn word(&mut self, what: &str) -> Option<Pieces> {
        if self.kind() != Some(Kind::Word) {
            return self.expected(what);
        }
        let place = self.place();
        self.at += 1;
        let mut start = place.start;
        let pieces = self.text[place].split('_').map(|piece| {
            let span = start..start + piece.len();
            start = span.end + 1;
            (piece.to_ascii_lowercase(), span)
        });
        Some(Pieces { pieces: pieces.collect() })
    }

    /// The version, if the text starts with one; without one it is 1.1. `None`: a version that is not read.
    fn version(&mut self) -> Option<()> {
        let place = self.place();
        let word = match self.kind() {
            Some(Kind::Word) => self.text[place.clone()].to_ascii_lowercase(),
            None => return self.expected("a pixel shader"),
            Some(_) => String::new(),
        };
        match words::version(&word) {
            Some(Ok(version)) => {
                self.at += 1;
                self.program.version = version;
            }
            Some(Err(())) => {
                let message = format!("`{}` is not read", shorten(&word));
                let help = "this reads ps.1.0 and ps.1.1, and what ps.1.2 and ps.1.3 have in common with them";
                self.push("NB0370", place, message, "another kind of shader", help);
                return None;
            }
            None => {
                let warning =
                    Diagnostic::warning("NB0906", place, "this shader does not say its version: read as ps.1.1");
                self.findings.push(warning.label("before this").help("write `ps.1.1` in the first line"));
            }
        }
        Some(())
    }

    /// One instruction; `None` once the reason that it is none has been recorded.
    fn instruction(&mut self) -> Option<()> {
        let paired = self.take('+');
        let start = self.at;
        let Pieces { pieces } = self.word("an instruction")?;
        let mut pieces = pieces.into_iter();
        let (name, place) = pieces.next()?;
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
            self.push("NB0376", place.clone(), message, "no arithmetic instruction", help);
        }
        match word {
            Word::Nothing => {}
            Word::Define => self.definition()?,
            Word::Texture(operation) => self.texture(operation, place)?,
            Word::Arithmetic(operation) => {
                let (scale, saturate) = self.scale(&name, &modifiers);
                self.arithmetic(operation, scale, saturate, paired, place)?;
            }
        }
        match self.tokens.get(self.at) {
            Some(token) if token.kind == Kind::Sign(',') => self.too_many(&name, start),
            Some(token) if !token.first && token.kind == Kind::Sign('.') => self.expected("the next instruction"),
            _ => Some(()),
        }
    }

    fn unknown(&mut self, token: usize, name: &str) -> Option<()> {
        let place = self.tokens[token].place.clone();
        if let Some((version, help)) = words::later(name) {
            let message = format!("`{name}` is an instruction of ps.{version}, which ps.1.1 does not have");
            self.push("NB0370", place, message, "not in this language", help);
            return None;
        }
        if words::version(name).is_some() {
            let message = "a version in the middle of a shader".to_owned();
            self.push("NB0373", place, message, "belongs in the first line", "keep one shader in a text");
            return None;
        }
        let help = match closest(name, words::names()) {
            Some(known) => format!("did you mean `{known}`?"),
            None => format!("instructions: {}", words::names().collect::<Vec<_>>().join(", ")),
        };
        self.push("NB0204", place, format!("there is no instruction `{}`", shorten(name)), "not known", help);
        None
    }

    /// `_x2`, `_x4`, `_d2` and `_sat`, in any order.
    fn scale(&mut self, name: &str, modifiers: &[(String, Range<usize>)]) -> (Scale, bool) {
        let (mut scale, mut saturate) = (None, false);
        for (modifier, place) in modifiers {
            let found = words::SCALES.iter().find(|(known, _)| known == modifier);
            let again = if found.is_some() { scale.is_some() } else { saturate };
            match (modifier.as_str(), found) {
                (_, Some((_, value))) => scale = Some(*value),
                ("sat", None) => saturate = true,
                _ => {
                    let message = format!("there is no instruction modifier `_{}`", shorten(modifier));
                    let help = format!("write `{name}_x2`, `_x4`, `_d2`, and `_sat` with any of them or alone");
                    self.push("NB0204", place.clone(), message, "not known", help);
                    continue;
                }
            }
            if again {
                let message = format!("`_{modifier}` beside another modifier of its kind");
                self.push("NB0371", place.clone(), message, "one too many", "keep one scale and one `_sat`");
            }
        }
        (scale.unwrap_or(Scale::One), saturate)
    }

    fn comma(&mut self, what: &str, start: usize, wanted: usize, found: usize) -> Option<()> {
        if self.take(',') {
            return Some(());
        }
        let next = self.tokens.get(self.at);
        if next.is_none_or(|token| token.first || token.kind == Kind::Sign('+')) {
            let token = self.tokens[start].place.clone();
            let message = format!("{what} has {wanted} operands, not {found}");
            self.push("NB0211", token, message, "this instruction", operands(what));
            return None;
        }
        self.expected("`,`")
    }

    fn too_many(&mut self, what: &str, start: usize) -> Option<()> {
        let place = self.place();
        let first = self.tokens[start].place.clone();
        let wanted = match words::find(what) {
            Some(Word::Arithmetic(operation)) => 1 + operation.sources(),
            Some(Word::Texture(operation)) => operation.operands(),
            Some(Word::Define) => 5,
            Some(Word::Nothing) | None => 0,
        };
        let message = format!("{what} has {wanted} operands, not more");
        let finding = finding("NB0211", place, message, "one too many", operands(what));
        self.findings.push(finding.related(first, "this instruction"));
        None
    }

    fn register(&mut self, word: &str, place: Range<usize>) -> Option<ShaderRegister> {
        match words::register(word) {
            Some(Ok(register)) => Some(register),
            Some(Err(bank)) => {
                let (name, last) = (bank.name(), bank.count() - 1);
                let message = format!("there is no register {}", shorten(word));
                let help = format!("ps.1.1 has {name}0 to {name}{last}");
                self.push("NB0206", place, message, "out of range", help);
                None
            }
            None => {
                let message = format!("there is no register `{}`", shorten(word));
                let help = "registers: c0 to c7, r0 and r1, t0 to t3, v0 and v1";
                self.push("NB0204", place, message, "not known", help);
                None
            }
        }
    }

    /// A register without anything around it.
    fn plain_register(&mut self, bank: Bank, what: &str, why: &str) -> Option<At<u8>> {
        let Pieces { pieces } = self.word(&format!("a register {}n", bank.name()))?;
        let (name, place) = pieces.first()?.clone();
        let register = self.register(&name, place.clone())?;
        if register.bank != bank {
            let message = format!("{what} takes {why}, not {register}");
            self.push("NB0371", place, message, "not here", format!("write a register {}n", bank.name()));
            return None;
        }
        if let Some((modifier, span)) = pieces.get(1) {
            let message = format!("{what} takes no `_{}` here", shorten(modifier));
            self.push("NB0371", span.clone(), message, "not here", "leave it out");
        }
        if self.is('.') {
            let place = self.place();
            self.at += 1;
            let word = self.word("channels")?;
            let end = word.pieces.last().map_or(place.end, |(_, span)| span.end);
            if word.pieces.first().is_none_or(|(word, _)| words::mask(word) != Some(Mask::All)) {
                let message = format!("{what} takes all channels of {register}");
                self.push("NB0371", place.start..end, message, "not here", "leave it out");
            }
        }
        Some(At { value: register.index, place })
    }

    fn definition(&mut self) -> Option<()> {
        let start = self.at - 1;
        let At { value: index, place } = self.plain_register(Bank::Constant, "def", "a constant")?;
        let mut value = [0.0; 4];
        for (n, slot) in value.iter_mut().enumerate() {
            self.comma("def", start, 5, n + 1)?;
            *slot = self.number()?;
        }
        self.program.definitions.push(Definition { index, value, place });
        Some(())
    }

    fn number(&mut self) -> Option<f32> {
        let from = self.place().start;
        let negative = self.take('-');
        if !negative {
            self.take('+');
        }
        if self.kind() != Some(Kind::Number) {
            return self.expected("a number");
        }
        let place = self.place();
        self.at += 1;
        let digits = self.text[place.clone()].trim_end_matches(['f', 'F']);
        let value = format!("{}{digits}", if negative { "-" } else { "" }).parse::<f32>().ok();
        let value = value.filter(|value| value.is_finite());
        if value.is_none() {
            let message = "this number is not finite".to_owned();
            self.push("NB0207", from..place.end, message, "too large", "constants are limited to -1..1");
        }
        value
    }

    fn texture(&mut self, operation: TextureOperation, place: Range<usize>) -> Option<()> {
        let start = self.at - 1;
        let name = operation.name();
        let unit = self.plain_register(Bank::Texture, name, "a texture register")?;
        let wanted = operation.operands();
        let source = match operation.has_source() {
            true => {
                self.comma(name, start, wanted, 1)?;
                Some(self.texture_source(operation)?)
            }
            false => None,
        };
        let eye = match operation {
            TextureOperation::Texm3x3spec => {
                self.comma(name, start, wanted, 2)?;
                Some(self.plain_register(Bank::Constant, name, "the eye from a constant")?)
            }
            _ => None,
        };
        self.program.textures.push(TextureInstruction { operation, unit, source, eye, place });
        Some(())
    }

    fn texture_source(&mut self, operation: TextureOperation) -> Option<At<TextureSource>> {
        let at = self.source()?;
        let At { value: Source { register, selector, modifier, negate }, place } = at;
        let name = operation.name();
        if register.bank != Bank::Texture {
            let message = format!("{name} reads a texture register, not {register}");
            let help = "write t0, t1 or t2, loaded before";
            self.push("NB0371", place, message, "not here", help);
            return None;
        }
        let signed_scale = modifier == Modifier::SignedScale;
        if negate || selector != Selector::All || modifier != Modifier::Plain && !(signed_scale && operation.is_row()) {
            let (message, help) = match operation.is_row() {
                true => {
                    (format!("{name} reads its source as it is, or `_bx2`"), "write the register alone, or with `_bx2`")
                }
                false => (
                    format!("{name} reads its source as it is"),
                    "write the register alone; the rows of matrices take `_bx2`",
                ),
            };
            self.push("NB0371", place.clone(), message, "modified here", help);
        }
        Some(At { value: TextureSource { unit: register.index, signed_scale }, place })
    }

    fn arithmetic(
        &mut self,
        operation: Operation,
        scale: Scale,
        saturate: bool,
        paired: bool,
        place: Range<usize>,
    ) -> Option<()> {
        let start = self.at - 1;
        let target = self.target()?;
        let mut sources = Vec::with_capacity(operation.sources());
        while sources.len() < operation.sources() {
            self.comma(operation.name(), start, 1 + operation.sources(), 1 + sources.len())?;
            sources.push(self.source()?);
        }
        self.program.arithmetic.push(Arithmetic { operation, scale, saturate, target, sources, paired, place });
        Some(())
    }

    fn target(&mut self) -> Option<At<Target>> {
        let Pieces { pieces } = self.word("a register to write")?;
        let (name, mut place) = pieces.first()?.clone();
        let register = self.register(&name, place.clone())?;
        if let Some((modifier, span)) = pieces.get(1) {
            let message = format!("a destination takes no `_{}`", shorten(modifier));
            let help = "write scales and `_sat` behind the instruction's name";
            self.push("NB0371", span.clone(), message, "not here", help);
        }
        let mut mask = Mask::All;
        if self.take('.') {
            let span = self.place();
            let word = self.word("the channels to write")?;
            place.end = span.end;
            match word.pieces.first().and_then(|(word, _)| words::mask(word)) {
                Some(found) if word.pieces.len() == 1 => mask = found,
                _ => {
                    let message = format!("`.{}` cannot be written alone", shorten(&self.text[span.clone()]));
                    let help = "write `.rgb` or `.a`, or no channels for all four";
                    self.push("NB0371", span, message, "not these channels", help);
                }
            }
        }
        Some(At { value: Target { register, mask }, place })
    }

    fn source(&mut self) -> Option<At<Source>> {
        let from = self.place().start;
        let negate = self.take('-');
        let mut modifier = Modifier::Plain;
        if self.kind() == Some(Kind::Number) {
            let place = self.place();
            if self.text[place.clone()].parse::<f32>().ok() != Some(1.0) {
                let message = format!("`{}` is no source", shorten(&self.text[place.clone()]));
                let help = "write `1-` before a register, or `def c0, ...` and c0";
                self.push("NB0205", place, message, "a number", help);
                return None;
            }
            self.at += 1;
            if !self.take('-') {
                return self.expected("`-`");
            }
            modifier = Modifier::Invert;
        }
        let Pieces { pieces } = self.word("a register to read")?;
        let mut pieces = pieces.into_iter();
        let (name, place) = pieces.next()?;
        let register = self.register(&name, place.clone());
        let mut selector = None;
        let mut suffixes: Vec<_> = pieces.collect();
        while self.take('.') {
            let Pieces { pieces } = self.word("the channels to read")?;
            let mut pieces = pieces.into_iter();
            let (word, span) = pieces.next()?;
            match (words::selector(&word), selector) {
                (Some(found), None) => selector = Some(found),
                _ => {
                    let message = format!("`.{}` cannot be read for all channels", shorten(&word));
                    let help = "write `.a`, or `.b` where alpha is written, or no channels";
                    self.push("NB0371", span, message, "not these channels", help);
                }
            }
            suffixes.extend(pieces);
        }
        let end = self.at.checked_sub(1).and_then(|at| self.tokens.get(at)).map_or(place.end, |token| token.place.end);
        for (word, span) in suffixes {
            match words::modifier(&word) {
                Some(found) if modifier == Modifier::Plain => modifier = found,
                Some(_) => {
                    let message = format!("`_{word}` does not go with another modifier");
                    let help = "keep one of `1-`, `_bias` and `_bx2`; the latter two go with a minus";
                    self.push("NB0371", span, message, "one too many", help);
                }
                None => {
                    let message = format!("there is no source modifier `_{}`", shorten(&word));
                    let help = "write `_bias` for x - 1/2 or `_bx2` for 2x - 1";
                    self.push("NB0204", span, message, "not known", help);
                }
            }
        }
        if negate && modifier == Modifier::Invert {
            let help = "write x - 1 as `sub` of the two, or `-x_bias` for 1/2 - x";
            self.push("NB0371", from..end, "`1-` does not go with a minus".to_owned(), "both here", help);
        }
        let selector = selector.unwrap_or(Selector::All);
        Some(At { value: Source { register: register?, selector, modifier, negate }, place: from..end })
    }
}

/// How an instruction is written.
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
