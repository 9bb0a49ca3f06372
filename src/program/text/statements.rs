//! Reads the statements of the language one after the other. Those that cannot be read are reported and skipped, so that one run shows all errors.

use super::Program;
use super::final_part::Final;
use super::parser::{Parser, Read};
use super::portion::PortionReader;
use crate::finding::{finding, warning};
use crate::{Place, Span};
use ninebit::diagnostic::{Diagnostic, Severity, shorten};
use ninebit::number::convert::constant;
use ninebit::state::{Combiners, GeneralStage, MuxSelect, Portion};

/// Number of findings after which reading stops.
const MAX_FINDINGS: usize = 64;

/// A constant with its place, if it is written.
type ConstantSlot = Option<([u8; 4], Span)>;

/// Statements outside stages.
const STATEMENTS: &[&str] =
    &["const0", "const1", "mux_by_least_significant_bit", "final_product", "color_sum", "clamp_color_sum", "out"];

impl Parser<'_> {
    /// Reads the whole text.
    pub(super) fn program(mut self) -> Result<Program, Vec<Diagnostic>> {
        if !self.findings.is_empty() {
            return Err(self.findings);
        }
        let mut shared: [ConstantSlot; 2] = [None, None];
        let mut stages: Vec<(GeneralStage, [ConstantSlot; 2])> = Vec::new();
        let mut mux: Option<Span> = None;
        let mut last = Final::default();
        while self.cursor.kind().is_some() && self.findings.len() < MAX_FINDINGS {
            let outcome = match self.cursor.word() {
                _ if self.cursor.is('{') => self.stage(&mut stages),
                "const0" => self.constant(&mut shared[0]),
                "const1" => self.constant(&mut shared[1]),
                "mux_by_least_significant_bit" => {
                    let span = self.cursor.span();
                    self.call().map(|()| self.once(&mut mux, span))
                }
                "out" | "final_product" | "color_sum" | "clamp_color_sum" => last.statement(&mut self),
                _ => Err(self.unknown_statement("a stage `{ ... }` or a statement", STATEMENTS)),
            };
            if outcome.is_err() {
                self.recover();
                // No bracket is open outside stages.
                while self.cursor.take('}') {}
            }
        }
        let end = self.cursor.text.trim_end().len();
        self.places.set(Place::Stages, self.before(end));
        let shared = shared.map(|written| written.map_or([0; 4], |(bytes, _)| bytes));
        if stages.is_empty() && last.is_written() {
            // The final combiner stands alone: the chip needs at least one stage, so one is added that changes nothing.
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

    /// Reads `{ const0 = ...; rgb { ... } alpha { ... } }`.
    fn stage(&mut self, stages: &mut Vec<(GeneralStage, [ConstantSlot; 2])>) -> Read<()> {
        let opening = self.cursor.span();
        self.cursor.advance();
        let index = stages.len();
        self.places.set(Place::Stage(index), opening.clone());
        let mut own: [ConstantSlot; 2] = [None, None];
        let mut portions: [Option<(Portion, Span)>; 2] = [None, None];
        self.body(opening, |parser| match parser.cursor.word() {
            "const0" => parser.constant(&mut own[0]),
            "const1" => parser.constant(&mut own[1]),
            "rgb" => parser.portion(index, false, &mut portions[0]),
            "alpha" => parser.portion(index, true, &mut portions[1]),
            _ => Err(parser.unknown_statement(
                "`rgb { ... }`, `alpha { ... }` or a constant",
                &["rgb", "alpha", "const0", "const1"],
            )),
        })?;
        let first = own.iter().flatten().map(|(_, span)| span.start).min();
        let last = own.iter().flatten().map(|(_, span)| span.end).max();
        if let (Some(first), Some(last)) = (first, last) {
            self.places.set(Place::StageConstants(index), first..last);
        }
        let [rgb, alpha] = portions.map(|portion| portion.map(|(portion, _)| portion));
        let idle = GeneralStage::idle([[0; 4]; 2]);
        let stage = GeneralStage { rgb: rgb.unwrap_or(idle.rgb), alpha: alpha.unwrap_or(idle.alpha), ..idle };
        stages.push((stage, own));
        Ok(())
    }

    /// Reads statements up to the bracket that closes `opening`.
    fn body(&mut self, opening: Span, mut statement: impl FnMut(&mut Self) -> Read<()>) -> Read<()> {
        while !self.cursor.is('}') && self.findings.len() < MAX_FINDINGS {
            if self.cursor.kind().is_none() {
                return Err(self.unclosed(opening));
            }
            if statement(self).is_err() {
                self.recover();
            }
        }
        self.cursor.advance();
        Ok(())
    }

    /// Reads `rgb { ... }` or `alpha { ... }`.
    fn portion(&mut self, stage: usize, alpha: bool, slot: &mut Option<(Portion, Span)>) -> Read<()> {
        let name = self.cursor.span();
        self.cursor.advance();
        let opening = self.cursor.span();
        self.sign('{')?;
        let mut reader = PortionReader::new(stage, alpha);
        self.body(opening, |parser| reader.statement(parser))?;
        self.set(slot, reader.portion, name.clone(), name, "this portion");
        Ok(())
    }

    /// Reads `const0 = (1.0, 0.5, 0.0, 1.0);` or `const0 = bytes(255, 128, 0, 255);`.
    fn constant(&mut self, slot: &mut ConstantSlot) -> Read<()> {
        let name = self.cursor.span();
        self.cursor.advance();
        self.sign('=')?;
        let bytes = self.cursor.word() == "bytes";
        if bytes {
            self.cursor.advance();
        }
        let opening = self.cursor.span().start;
        self.sign('(')?;
        let mut values = Vec::new();
        loop {
            let start = self.cursor.span().start;
            let Some((negative, digits)) = self.cursor.signed_number() else { return Err(self.expected("a number")) };
            values.push(self.number(start..digits.end, negative, bytes));
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
        // Values out of range have been reported.
        let bytes = values.map(Option::unwrap_or_default);
        self.set(slot, bytes, name.start..span.end, name, "this constant");
        Ok(())
    }

    /// Converts a number into a byte of a colour. Numbers outside 0.0 to 1.0 are clamped, as the extension specifies.
    fn number(&mut self, span: Span, negative: bool, byte: bool) -> Option<u8> {
        let written = self.cursor.text(&span);
        let digits = written.trim_start_matches(['+', '-']).trim_start();
        // NUM-0. Digits and a point are always a number, though it may be infinite.
        let value = match digits.parse::<f32>() {
            _ if byte => digits.parse::<u8>().ok().filter(|byte| !negative || *byte == 0),
            Ok(value) if value == 0.0 || !negative && value <= 1.0 => Some(constant(value)),
            Ok(_) => {
                let (limit, byte, help) = match negative {
                    true => (0, 0, "write 0; registers hold negative numbers, constants do not"),
                    false => (1, 255, "write 1; for bytes write `bytes(255, 128, 0, 255)`"),
                };
                let message = format!("`{}` is limited to {limit}", shorten(written));
                let label = "a part of a colour is 0.0 to 1.0";
                self.findings.push(warning("NB0916", span, message, label, help).rule("NUM-0"));
                return Some(byte);
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
            self.findings.push(finding("NB0206", span, message, "out of range", help).note(range));
        }
        value
    }
}
