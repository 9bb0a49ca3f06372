//! What the statements of the language share: the cursor, findings, registers, signs.

use super::words::{find, registers};
use crate::cursor::Cursor;
pub(super) use crate::cursor::{GivenUp, Read};
use crate::finding::{finding, foreign, header};
use crate::lexer::{Kind, Language};
use crate::spelling::closest;
use crate::{Places, Span};
use ninebit::diagnostic::{Diagnostic, shorten};
use ninebit::shown;
use ninebit::state::{Component, FinalRegister};

/// A register in an input.
pub(super) struct Source {
    pub(super) register: FinalRegister,
    /// The component with its place, if it is written.
    pub(super) component: Option<(Component, Span)>,
    pub(super) span: Span,
}

/// State while a program is read.
pub(super) struct Parser<'t> {
    pub(super) cursor: Cursor<'t>,
    pub(super) findings: Vec<Diagnostic>,
    pub(super) places: Places,
}

impl<'t> Parser<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        let cursor = Cursor::new(text, Language::COMBINERS);
        let mut parser = Parser { cursor, findings: Vec::new(), places: Places::default() };
        parser.header();
        parser
    }

    /// Skips the header of programs of the assembler, and refuses the headers of other languages.
    fn header(&mut self) {
        // Comments may precede it.
        let start = self.cursor.span().start;
        let Some(span) = header(self.cursor.text.get(start..).unwrap_or("")) else { return };
        let span = start + span.start..start + span.end;
        if self.cursor.text(&span).starts_with("!!RC1.0") {
            let end = span.start + "!!RC1.0".len();
            self.cursor.skip_to(|cursor| cursor.span().start >= end);
            return;
        }
        self.give_up(foreign(self.cursor.text, span, "NB0104", "a combiner program starts with `!!RC1.0`"));
        self.cursor.skip_to(|_| false);
    }

    /// Reads a register, perhaps with a component: `tex0`, `tex0.a`.
    pub(super) fn register(&mut self) -> Read<Source> {
        let span = self.cursor.span();
        if self.cursor.kind() != Some(Kind::Word) {
            return Err(self.expected("a register"));
        }
        let Some(register) = find(self.cursor.word()) else {
            let known: Vec<&str> = registers().collect();
            return Err(self.unknown("register", &known));
        };
        self.cursor.advance();
        let component = self.component();
        Ok(Source { register, component, span: span.start..self.cursor.end() })
    }

    /// Takes `.rgb`, `.a` or `.b`, if there is no space around the point: with spaces the point is an operator.
    pub(super) fn component(&mut self) -> Option<(Component, Span)> {
        if !self.cursor.is('.') || self.cursor.span().start != self.cursor.end() {
            return None;
        }
        let span = self.cursor.span_at(self.cursor.at + 1);
        if span.start != self.cursor.span().end {
            return None;
        }
        let component = match self.cursor.text(&span) {
            "rgb" => Component::Rgb,
            "a" => Component::Alpha,
            "b" => Component::Blue,
            _ => return None,
        };
        self.cursor.at += 2;
        Some((component, span))
    }

    /// Takes a sign, or records that it is missing.
    pub(super) fn sign(&mut self, sign: char) -> Read<()> {
        if self.cursor.take(sign) { Ok(()) } else { Err(self.expected(&format!("`{sign}`"))) }
    }

    /// Takes `name();`, beginning at the name.
    pub(super) fn call(&mut self) -> Read<()> {
        self.cursor.advance();
        self.sign('(')?;
        self.sign(')')?;
        self.sign(';')
    }

    /// Keeps the place of a statement, and refuses it if it is given twice.
    pub(super) fn once(&mut self, slot: &mut Option<Span>, span: Span) {
        match slot {
            Some(first) => self.twice(span, first.clone(), "this"),
            None => *slot = Some(span),
        }
    }

    /// Keeps what a statement sets, with its place, and refuses it if it is set twice. `again` is the place of the repetition.
    pub(super) fn set<T>(&mut self, slot: &mut Option<(T, Span)>, value: T, span: Span, again: Span, what: &str) {
        match slot {
            Some((_, first)) => self.twice(again, first.clone(), what),
            None => *slot = Some((value, span)),
        }
    }

    pub(super) fn give_up(&mut self, finding: Diagnostic) -> GivenUp {
        self.findings.push(finding);
        GivenUp
    }

    pub(super) fn expected(&mut self, what: &str) -> GivenUp {
        let found = self.cursor.current_token("the end of the program");
        // What is missing at the end of a line is reported there, not where the next line starts.
        let between = self.cursor.text.get(self.cursor.end()..self.cursor.span().start).unwrap_or("");
        let (span, label) = if self.cursor.kind().is_none() || between.contains('\n') {
            (self.before(self.cursor.end()), "behind this")
        } else {
            (self.cursor.span(), "not expected here")
        };
        self.give_up(Diagnostic::error("NB0104", span, format!("expected {what}, found {found}")).label(label))
    }

    /// Records that a word is none of the known ones.
    pub(super) fn unknown(&mut self, what: &str, known: &[&str]) -> GivenUp {
        let word = self.cursor.word();
        let list = known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let help = match closest(word, known.iter().copied().filter(|name| *name != word)) {
            Some(name) => format!("did you mean `{name}`? All of them: {list}"),
            None => format!("write one of {list}"),
        };
        let message = format!("there is no {what} `{}`", shorten(word));
        self.give_up(finding("NB0204", self.cursor.span(), message, "not known", help))
    }

    /// Records that a word is unknown, or that it is not a word.
    pub(super) fn unknown_or_expected(&mut self, what: &str, known: &[&str]) -> GivenUp {
        if self.cursor.kind() == Some(Kind::Word) { self.unknown(what, known) } else { self.expected(&shown::a(what)) }
    }

    pub(super) fn unknown_statement(&mut self, expected: &str, known: &[&str]) -> GivenUp {
        if self.cursor.kind() == Some(Kind::Word) { self.unknown("statement", known) } else { self.expected(expected) }
    }

    /// Records that a statement, which has been read to its end, was given before.
    pub(super) fn twice(&mut self, span: Span, first: Span, what: &str) {
        let finding = finding("NB0364", span, format!("{what} is given twice"), "again here", "keep one of them");
        self.findings.push(finding.related(first, "first here"));
    }

    /// Returns the place of the character that ends at `end`.
    pub(super) fn before(&self, end: usize) -> Span {
        let start =
            self.cursor.text.get(..end).and_then(|text| text.char_indices().next_back()).map_or(0, |(start, _)| start);
        start..end
    }

    pub(super) fn unclosed(&mut self, opening: Span) -> GivenUp {
        self.give_up(finding("NB0104", opening, "this bracket is not closed", "opened here", "close it with `}`"))
    }

    /// Skips the rest of a statement, with the blocks in it: past its semicolon, or up to a closing brace.
    pub(super) fn recover(&mut self) {
        let mut depth = 0usize;
        loop {
            match self.cursor.kind() {
                None => return,
                Some(Kind::Sign(';')) if depth == 0 => return self.cursor.advance(),
                Some(Kind::Sign('{')) => depth += 1,
                Some(Kind::Sign('}')) if depth == 0 => return,
                Some(Kind::Sign('}')) => {
                    depth -= 1;
                    if depth == 0 {
                        return self.cursor.advance();
                    }
                }
                _ => {}
            }
            self.cursor.advance();
        }
    }
}
