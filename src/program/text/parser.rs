//! Statements of the language, one after the other. What cannot be read is recorded and passed over, so that one run shows all.

use std::ops::Range;

use super::Program;
use super::final_part::Final;
use super::portion::PortionReader;
use super::words::{find, registers};
use crate::cursor::Cursor;
pub(super) use crate::cursor::{GivenUp, Read};
use crate::finding::{finding, foreign, header};
use crate::lexer::{Kind, Language};
use crate::spelling::closest;
use crate::{Place, Places};
use ninebit::diagnostic::{Diagnostic, Severity, shorten};
use ninebit::number::convert::constant;
use ninebit::state::{Combiners, Component, FinalRegister, GeneralStage, MuxSelect, Portion};

/// Findings beyond this many are not looked for.
const MAX_FINDINGS: usize = 64;

/// A register as an input names it.
pub(super) struct Source {
    pub(super) register: FinalRegister,
    /// The component and its place, if it is written.
    pub(super) component: Option<(Component, Range<usize>)>,
    pub(super) span: Range<usize>,
}

/// What is known while a program is read.
pub(super) struct Parser<'t> {
    pub(super) cursor: Cursor<'t>,
    findings: Vec<Diagnostic>,
    pub(super) places: Places,
}

/// A constant that is written, and where.
type Written = Option<([u8; 4], Range<usize>)>;

/// What may stand beside stages.
const STATEMENTS: &[&str] =
    &["const0", "const1", "mux_by_least_significant_bit", "final_product", "color_sum", "clamp_color_sum", "out"];

impl<'t> Parser<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        let cursor = Cursor::new(text, Language::COMBINERS);
        let mut parser = Parser { cursor, findings: Vec::new(), places: Places::default() };
        parser.header();
        parser
    }

    /// Passes over what programs of the assembler start with, and refuses the languages beside it by name.
    fn header(&mut self) {
        // Comments may stand before it.
        let start = self.cursor.place().start;
        let Some(place) = header(self.cursor.text.get(start..).unwrap_or("")) else { return };
        let place = start + place.start..start + place.end;
        if self.cursor.text(&place).starts_with("!!RC1.0") {
            let end = place.start + "!!RC1.0".len();
            self.cursor.skip_to(|cursor| cursor.place().start >= end);
            return;
        }
        self.give_up(foreign(self.cursor.text, place, "NB0104", "a combiner program starts with `!!RC1.0`"));
        self.cursor.skip_to(|_| false);
    }

    /// Reads the whole text.
    pub(super) fn program(mut self) -> Result<Program, Vec<Diagnostic>> {
        if !self.findings.is_empty() {
            return Err(self.findings);
        }
        let mut shared: [Written; 2] = [None, None];
        let mut stages: Vec<(GeneralStage, [Written; 2])> = Vec::new();
        let mut mux: Option<Range<usize>> = None;
        let mut last = Final::default();
        while self.cursor.kind().is_some() && self.findings.len() < MAX_FINDINGS {
            let outcome = match self.cursor.word() {
                _ if self.cursor.is('{') => self.stage(&mut stages),
                "const0" => self.constant(&mut shared[0]),
                "const1" => self.constant(&mut shared[1]),
                "mux_by_least_significant_bit" => {
                    let span = self.cursor.place();
                    self.call().map(|()| self.once(&mut mux, span))
                }
                "out" | "final_product" | "color_sum" | "clamp_color_sum" => last.statement(&mut self),
                _ => Err(self.unknown_statement("a stage `{ ... }` or a statement", STATEMENTS)),
            };
            if outcome.is_err() {
                self.recover();
                // Nothing outside a stage can be closed.
                while self.cursor.take('}') {}
            }
        }
        let end = self.cursor.text.trim_end().len();
        self.places.set(Place::Stages, self.before(end));
        let shared = shared.map(|written| written.map_or([0; 4], |(bytes, _)| bytes));
        if stages.is_empty() && last.is_written() {
            // The final combiner alone: the chip has at least one stage, which changes nothing then.
            stages.push((GeneralStage::idle([[0; 4]; 2]), [None, None]));
        }
        let final_combiner = last.finish(&mut self, shared);
        if self.findings.iter().any(|finding| finding.severity == Severity::Error) {
            self.findings.retain(|finding| finding.severity == Severity::Error);
            return Err(self.findings);
        }
        let mux_select = if mux.is_some() { MuxSelect::Lsb } else { MuxSelect::Msb };
        let stages = stages.into_iter().map(|(mut stage, own)| {
            stage.constants = shared;
            for (slot, own) in stage.constants.iter_mut().zip(own) {
                if let Some((bytes, _)) = own {
                    *slot = bytes;
                }
            }
            stage
        });
        let combiners = Combiners { stages: stages.collect(), mux_select, final_combiner };
        Ok(Program { combiners, places: self.places, warnings: self.findings })
    }

    /// `{ const0 = ...; rgb { ... } alpha { ... } }`
    fn stage(&mut self, stages: &mut Vec<(GeneralStage, [Written; 2])>) -> Read<()> {
        let opening = self.cursor.place();
        self.cursor.advance();
        let index = stages.len();
        self.places.set(Place::Stage(index), opening.clone());
        let mut own: [Written; 2] = [None, None];
        let mut portions: [Option<(Portion, Range<usize>)>; 2] = [None, None];
        while !self.cursor.is('}') && self.findings.len() < MAX_FINDINGS {
            if self.cursor.kind().is_none() {
                return Err(self.unclosed(opening));
            }
            let outcome = match self.cursor.word() {
                "const0" => self.constant(&mut own[0]),
                "const1" => self.constant(&mut own[1]),
                "rgb" => self.portion(index, false, &mut portions[0]),
                "alpha" => self.portion(index, true, &mut portions[1]),
                _ => Err(self.unknown_statement(
                    "`rgb { ... }`, `alpha { ... }` or a constant",
                    &["rgb", "alpha", "const0", "const1"],
                )),
            };
            if outcome.is_err() {
                self.recover();
            }
        }
        self.cursor.advance();
        let first = own.iter().flatten().map(|(_, span)| span.start).min();
        let last = own.iter().flatten().map(|(_, span)| span.end).max();
        if let (Some(first), Some(last)) = (first, last) {
            self.places.set(Place::StageConstants(index), first..last);
        }
        let [rgb, alpha] = portions.map(|portion| portion.map(|(portion, _)| portion));
        let stage = GeneralStage {
            rgb: rgb.unwrap_or(Portion::idle(Component::Rgb)),
            alpha: alpha.unwrap_or(Portion::idle(Component::Alpha)),
            constants: [[0; 4]; 2],
        };
        stages.push((stage, own));
        Ok(())
    }

    /// `rgb { ... }` or `alpha { ... }`
    fn portion(&mut self, stage: usize, alpha: bool, slot: &mut Option<(Portion, Range<usize>)>) -> Read<()> {
        let name = self.cursor.place();
        self.cursor.advance();
        let opening = self.cursor.place();
        self.sign('{')?;
        let mut reader = PortionReader::new(stage, alpha);
        while !self.cursor.is('}') && self.findings.len() < MAX_FINDINGS {
            if self.cursor.kind().is_none() {
                return Err(self.unclosed(opening));
            }
            if reader.statement(self).is_err() {
                self.recover();
            }
        }
        self.cursor.advance();
        self.set(slot, reader.portion, name.clone(), name, "this portion");
        Ok(())
    }

    /// `const0 = (1.0, 0.5, 0.0, 1.0);` or `const0 = bytes(255, 128, 0, 255);`
    fn constant(&mut self, slot: &mut Written) -> Read<()> {
        let name = self.cursor.place();
        self.cursor.advance();
        self.sign('=')?;
        let bytes = self.cursor.word() == "bytes";
        if bytes {
            self.cursor.advance();
        }
        let opening = self.cursor.place().start;
        self.sign('(')?;
        let mut values = Vec::new();
        loop {
            let start = self.cursor.place().start;
            let negative = self.cursor.take('-');
            if !negative {
                self.cursor.take('+');
            }
            if self.cursor.kind() != Some(Kind::Number) {
                return Err(self.expected("a number"));
            }
            let place = start..self.cursor.place().end;
            self.cursor.advance();
            values.push(self.number(place, negative, bytes));
            if !self.cursor.take(',') {
                break;
            }
        }
        self.sign(')')?;
        let span = opening..self.cursor.end();
        self.sign(';')?;
        let Ok(values) = <[_; 4]>::try_from(values) else {
            let message = "a constant colour has four numbers: R, G, B and A";
            let help = "write `(1.0, 0.5, 0.0, 1.0)` or `bytes(255, 128, 0, 255)`";
            self.findings.push(finding("NB0211", span, message, "not four", help));
            return Ok(());
        };
        // What is out of range has been recorded.
        let bytes = values.map(Option::unwrap_or_default);
        self.set(slot, bytes, name.start..span.end, name, "this constant");
        Ok(())
    }

    /// A number as a byte of a colour. What is beyond 0.0 to 1.0 is limited to it, as the extension has it.
    fn number(&mut self, place: Range<usize>, negative: bool, byte: bool) -> Option<u8> {
        let written = self.cursor.text(&place);
        let digits = written.trim_start_matches(['+', '-']).trim_start();
        let limited = if negative { "0" } else { "1" };
        // NUM-0. Digits and a point are a number, at most infinite.
        let value = match digits.parse::<f32>() {
            _ if byte => digits.parse::<u8>().ok().filter(|byte| !negative || *byte == 0),
            Ok(value) if value == 0.0 || !negative && value <= 1.0 => Some(constant(value)),
            Ok(_) => {
                let message = format!("`{}` is limited to {limited}", shorten(written));
                let finding = Diagnostic::warning("NB0916", place, message).label("a part of a colour is 0.0 to 1.0");
                self.findings.push(finding.rule("NUM-0").help(match negative {
                    true => "write 0; registers hold negative numbers, constants do not",
                    false => "write 1; for bytes write `bytes(255, 128, 0, 255)`",
                }));
                return Some(if negative { 0 } else { 255 });
            }
            Err(_) => None,
        };
        if value.is_none() {
            let (range, help) = if byte {
                ("a byte of a colour is a whole number from 0 to 255", "for 0.0 to 1.0 leave `bytes` out")
            } else {
                ("a part of a colour is a number from 0.0 to 1.0", "for bytes write `bytes(255, 128, 0, 255)`")
            };
            let message = format!("`{}` is not a part of this colour", shorten(written));
            self.findings
                .push(Diagnostic::error("NB0206", place, message).label("out of range").note(range).help(help));
        }
        value
    }

    /// A register, perhaps with a component: `tex0`, `tex0.a`.
    pub(super) fn register(&mut self) -> Read<Source> {
        let span = self.cursor.place();
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

    /// `.rgb`, `.a` or `.b` without a space before the point: anything else is an operator.
    pub(super) fn component(&mut self) -> Option<(Component, Range<usize>)> {
        if !self.cursor.is('.') || self.cursor.place().start != self.cursor.end() {
            return None;
        }
        let place = self.cursor.place_at(self.cursor.at + 1);
        if place.start != self.cursor.place().end {
            return None;
        }
        let component = match self.cursor.text(&place) {
            "rgb" => Component::Rgb,
            "a" => Component::Alpha,
            "b" => Component::Blue,
            _ => return None,
        };
        self.cursor.advance();
        self.cursor.advance();
        Some((component, place))
    }

    // What all statements share.

    /// Takes the sign, or says that it is missing.
    pub(super) fn sign(&mut self, sign: char) -> Read<()> {
        if self.cursor.take(sign) { Ok(()) } else { Err(self.expected(&format!("`{sign}`"))) }
    }

    /// `name();`
    pub(super) fn call(&mut self) -> Read<()> {
        self.cursor.advance();
        self.sign('(')?;
        self.sign(')')?;
        self.sign(';')
    }

    /// Keeps the place of a statement that may be there once.
    pub(super) fn once(&mut self, slot: &mut Option<Range<usize>>, span: Range<usize>) {
        match slot {
            Some(first) => self.twice(span, first.clone(), "this"),
            None => *slot = Some(span),
        }
    }

    /// Keeps what a statement says that may be there once: its place, and where it is found again.
    pub(super) fn set<T>(
        &mut self,
        slot: &mut Option<(T, Range<usize>)>,
        value: T,
        place: Range<usize>,
        again: Range<usize>,
        what: &str,
    ) {
        match slot {
            Some((_, first)) => self.twice(again, first.clone(), what),
            None => *slot = Some((value, place)),
        }
    }

    /// Records what is probably not meant.
    pub(super) fn warn(&mut self, finding: Diagnostic) {
        self.findings.push(finding);
    }

    pub(super) fn give_up(&mut self, finding: Diagnostic) -> GivenUp {
        self.findings.push(finding);
        GivenUp
    }

    pub(super) fn expected(&mut self, what: &str) -> GivenUp {
        let found = self.cursor.found("the end of the program");
        // What is missing at the end of a line is missing there, not where the next one starts.
        let between = self.cursor.text.get(self.cursor.end()..self.cursor.place().start).unwrap_or("");
        let (span, label) = if self.cursor.kind().is_none() || between.contains('\n') {
            (self.before(self.cursor.end()), "behind this")
        } else {
            (self.cursor.place(), "not expected here")
        };
        self.give_up(Diagnostic::error("NB0104", span, format!("expected {what}, found {found}")).label(label))
    }

    /// The finding that a word is none of the known ones.
    pub(super) fn unknown(&mut self, what: &str, known: &[&str]) -> GivenUp {
        let word = self.cursor.word();
        let list = known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let help = match closest(word, known.iter().copied().filter(|name| *name != word)) {
            Some(name) => format!("did you mean `{name}`? All of them: {list}"),
            None => format!("write one of {list}"),
        };
        let message = format!("there is no {what} `{}`", shorten(word));
        self.give_up(finding("NB0204", self.cursor.place(), message, "not known", help))
    }

    /// A word that is not known, or something that is no word.
    pub(super) fn unknown_or_expected(&mut self, what: &str, known: &[&str]) -> GivenUp {
        if self.cursor.kind() == Some(Kind::Word) {
            self.unknown(what, known)
        } else {
            self.expected(&format!("a {what}"))
        }
    }

    fn unknown_statement(&mut self, expected: &str, known: &[&str]) -> GivenUp {
        if self.cursor.kind() == Some(Kind::Word) { self.unknown("statement", known) } else { self.expected(expected) }
    }

    /// Records that a statement, which has been read to its end, was there before.
    pub(super) fn twice(&mut self, span: Range<usize>, first: Range<usize>, what: &str) {
        self.findings.push(
            Diagnostic::error("NB0364", span, format!("{what} is given twice"))
                .label("again here")
                .related(first, "first here")
                .help("keep one of them"),
        );
    }

    /// The character that ends at a place.
    fn before(&self, end: usize) -> Range<usize> {
        let start =
            self.cursor.text.get(..end).and_then(|text| text.char_indices().next_back()).map_or(0, |(start, _)| start);
        start..end
    }

    fn unclosed(&mut self, opening: Range<usize>) -> GivenUp {
        self.give_up(finding("NB0104", opening, "this bracket is not closed", "opened here", "close it with `}`"))
    }

    /// Passes over what is left of a statement, with the blocks in it: to behind its semicolon, or to a closing brace.
    fn recover(&mut self) {
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
