//! Reads operands of instructions: registers with their modifiers, and numbers.

use super::parser::Parser;
use super::*;
use crate::lexer::Kind;
use ninebit::diagnostic::shorten;

impl Parser<'_> {
    fn register(&mut self, word: &str, span: Span) -> Option<ShaderRegister> {
        match words::register(word) {
            Some(Ok(register)) => Some(register),
            Some(Err(bank)) => {
                let (name, last) = (bank.name(), bank.count() - 1);
                let message = format!("there is no register {}", shorten(word));
                let help = format!("ps.1.1 has {name}0 to {name}{last}");
                self.push("NB0206", span, message, "out of range", help);
                None
            }
            None => {
                let message = format!("there is no register `{}`", shorten(word));
                let help = "registers: c0 to c7, r0 and r1, t0 to t3, v0 and v1";
                self.push("NB0204", span, message, "not known", help);
                None
            }
        }
    }

    /// Reads a register without modifiers.
    pub(super) fn plain_register(&mut self, bank: Bank, what: &str, why: &str) -> Option<Spanned<u8>> {
        let pieces = self.word(&format!("a register {}n", bank.name()))?;
        let (name, span) = pieces.first()?.clone();
        let register = self.register(&name, span.clone())?;
        if register.bank != bank {
            let message = format!("{what} takes {why}, not {register}");
            self.push("NB0371", span, message, "not here", format!("write a register {}n", bank.name()));
            return None;
        }
        if let Some((modifier, span)) = pieces.get(1) {
            let message = format!("{what} takes no `_{}` here", shorten(modifier));
            self.push("NB0371", span.clone(), message, "not here", "leave it out");
        }
        if self.cursor.is('.') {
            let span = self.cursor.span();
            self.cursor.advance();
            let word = self.word("channels")?;
            let end = word.last().map_or(span.end, |(_, span)| span.end);
            if word.first().is_none_or(|(word, _)| words::mask(word) != Some(Mask::All)) {
                let message = format!("{what} takes all channels of {register}");
                self.push("NB0371", span.start..end, message, "not here", "leave it out");
            }
        }
        Some(Spanned { value: register.index, span })
    }

    pub(super) fn number(&mut self) -> Option<f32> {
        let from = self.cursor.span().start;
        let Some((negative, span)) = self.cursor.signed_number() else { return self.expected("a number") };
        let digits = self.cursor.text(&span).trim_end_matches(['f', 'F']);
        let value = format!("{}{digits}", if negative { "-" } else { "" }).parse::<f32>().ok();
        let value = value.filter(|value| value.is_finite());
        if value.is_none() {
            let message = "this number is not finite".to_owned();
            self.push("NB0207", from..span.end, message, "too large", "constants are limited to -1..1");
        }
        value
    }

    pub(super) fn texture_source(&mut self, operation: TextureOperation) -> Option<Spanned<TextureSource>> {
        let at = self.source()?;
        let Spanned { value: Source { register, selector, modifier, negate }, span } = at;
        let name = operation.name();
        if register.bank != Bank::Texture {
            let message = format!("{name} reads a texture register, not {register}");
            let help = "write t0, t1 or t2, loaded before";
            self.push("NB0371", span, message, "not here", help);
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
            self.push("NB0371", span.clone(), message, "modified here", help);
        }
        Some(Spanned { value: TextureSource { unit: register.index, signed_scale }, span })
    }

    pub(super) fn target(&mut self) -> Option<Spanned<Target>> {
        let pieces = self.word("a register to write")?;
        let (name, mut whole) = pieces.first()?.clone();
        let register = self.register(&name, whole.clone())?;
        if let Some((modifier, span)) = pieces.get(1) {
            let message = format!("a destination takes no `_{}`", shorten(modifier));
            let help = "write scales and `_sat` behind the instruction's name";
            self.push("NB0371", span.clone(), message, "not here", help);
        }
        let mut mask = Mask::All;
        if self.cursor.take('.') {
            let span = self.cursor.span();
            let word = self.word("the channels to write")?;
            whole.end = span.end;
            match word.first().and_then(|(word, _)| words::mask(word)) {
                Some(found) if word.len() == 1 => mask = found,
                _ => {
                    let message = format!("`.{}` cannot be written alone", shorten(self.cursor.text(&span)));
                    let help = "write `.rgb` or `.a`, or no channels for all four";
                    self.push("NB0371", span, message, "not these channels", help);
                }
            }
        }
        Some(Spanned { value: Target { register, mask }, span: whole })
    }

    pub(super) fn source(&mut self) -> Option<Spanned<Source>> {
        let from = self.cursor.span().start;
        let negate = self.cursor.take('-');
        let mut modifier = Modifier::Plain;
        if self.cursor.kind() == Some(Kind::Number) {
            let span = self.cursor.span();
            if self.cursor.text(&span).parse::<f32>().ok() != Some(1.0) {
                let message = format!("`{}` is no source", shorten(self.cursor.text(&span)));
                let help = "write `1-` before a register, or `def c0, ...` and c0";
                self.push("NB0205", span, message, "a number", help);
                return None;
            }
            self.cursor.advance();
            if !self.cursor.take('-') {
                return self.expected("`-`");
            }
            modifier = Modifier::Invert;
        }
        let mut pieces = self.word("a register to read")?.into_iter();
        let (name, span) = pieces.next()?;
        let register = self.register(&name, span.clone());
        let mut selector = None;
        let mut suffixes: Vec<_> = pieces.collect();
        while self.cursor.take('.') {
            let mut pieces = self.word("the channels to read")?.into_iter();
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
        let end = self.cursor.end();
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
        Some(Spanned { value: Source { register: register?, selector, modifier, negate }, span: from..end })
    }
}
